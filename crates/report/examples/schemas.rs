//! Writes the schemas of the JSON documents into a folder:
//! `cargo run -p fosssim-report --example schemas -- schemas`.
#![forbid(unsafe_code)]
use std::{env, fs, path::PathBuf};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = PathBuf::from(env::args().nth(1).ok_or("which folder?")?);
    for (name, schema) in fosssim_report::schemas::all() {
        fs::write(folder.join(format!("{name}.schema.json")), format!("{:#}\n", schema.as_value()))?;
    }
    Ok(())
}
