//! Links the programs statically if the machine has the C library's archives. A grader is started once for every trace,
//! and loading three shared libraries with 15,000 relocations took half the time of a small scene.
//!
//! Rust's own switch, `-C target-feature=+crt-static`, can't be set for a single package, and if it is set for all
//! packages, procedural macros can't be built. Therefore the linker first searches a folder with linker scripts. They
//! have the names of the shared libraries, but name the archives. If a trial program can't be linked in this way, or if
//! `FOSSSIM_LINK=shared` is set, programs are linked as usual.
//!
//! The script also includes the module of the browser's page, if `FOSSSIM_MODULE` names it.
#![forbid(unsafe_code)]
use std::{
    env, fs, io,
    path::{Path, PathBuf},
    process::{Command, Stdio},
};

/// The shared libraries that Rust's standard library requests from the linker.
const SHARED: [&str; 7] = ["gcc_s", "c", "m", "rt", "pthread", "dl", "util"];

/// The linker script for each shared library. The archives depend on each other, so each script names all of them.
const ARCHIVES: &str = "GROUP(-l:libc.a -l:libm.a -l:libgcc_eh.a -l:libgcc.a)\n";

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rerun-if-env-changed=FOSSSIM_LINK");
    take_module();
    let of = |name: &str| env::var(name).unwrap_or_default();
    let is_gnu = of("CARGO_CFG_TARGET_OS") == "linux" && of("CARGO_CFG_TARGET_ENV") == "gnu";
    let is_ours = of("HOST") == of("TARGET") && env::var_os("RUSTC_LINKER").is_none();
    let is_static_already = of("CARGO_CFG_TARGET_FEATURE").split(',').any(|feature| feature == "crt-static");
    if !is_gnu || !is_ours || is_static_already || of("FOSSSIM_LINK") == "shared" {
        return;
    }
    let folder = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets it")).join("archives");
    if lead(&folder).is_ok_and(|links| links) {
        for argument in arguments(&folder) {
            println!("cargo:rustc-link-arg-bins={argument}");
        }
    }
}

/// Includes the module of the browser's page in the program, if `FOSSSIM_MODULE` names it (`scripts/browser-page`).
/// Other builds do not need the WebAssembly target.
fn take_module() {
    println!("cargo:rerun-if-env-changed=FOSSSIM_MODULE");
    println!("cargo:rustc-check-cfg=cfg(has_module)");
    let Some(module) = env::var_os("FOSSSIM_MODULE").filter(|module| !module.is_empty()) else { return };
    let module =
        fs::canonicalize(&module).unwrap_or_else(|error| panic!("FOSSSIM_MODULE={}: {error}", module.display()));
    println!("cargo:rerun-if-changed={}", module.display());
    println!("cargo:rustc-env=FOSSSIM_MODULE_FILE={}", module.display());
    println!("cargo:rustc-cfg=has_module");
}

/// Returns the linker arguments, which follow Rust's own, because the last one of `-pie` and `-no-pie` counts.
fn arguments(folder: &Path) -> [String; 3] {
    [format!("-L{}", folder.display()), "-static".to_owned(), "-no-pie".to_owned()]
}

/// Writes the linker scripts, and returns whether a trial program can be linked with them and runs.
fn lead(folder: &Path) -> io::Result<bool> {
    fs::create_dir_all(folder)?;
    for shared in SHARED {
        fs::write(folder.join(format!("lib{shared}.so")), ARCHIVES)?;
    }
    let (source, program) = (folder.join("trial.c"), folder.join("trial"));
    fs::write(
        &source,
        "#include <math.h>\nint main(int count, char **words) { return words[0] && sqrt(count) < 0; }\n",
    )?;
    let mut compiler = Command::new("cc");
    compiler.arg(&source).arg("-o").arg(&program).args(["-nodefaultlibs", "-Wl,-Bdynamic"]);
    compiler.args(SHARED.map(|shared| format!("-l{shared}"))).arg("-pie").args(arguments(folder));
    compiler.stdout(Stdio::null()).stderr(Stdio::null());
    Ok(compiler.status()?.success() && Command::new(&program).status()?.success())
}
