//! PostgreSQL's own tools, which copy a database consistently while others write. They are told the address by
//! variables, so that no list of processes shows the password.
use anyhow::{Context, Result, bail};
use std::{path::Path, process::Stdio};
use tokio::process::Command;
use url::Url;

/// An address as variables of PostgreSQL's tools.
fn variables(address: &str) -> Result<Vec<(String, String)>> {
    // The text may hold a password: it is not repeated.
    let url = Url::parse(address).ok().context("the database's address is not understood")?;
    let plain = |text: &str| -> Result<String> {
        let bytes: Vec<u8> = url::form_urlencoded::parse(format!("x={}", text.replace('+', "%2B")).as_bytes())
            .next()
            .map(|(_, value)| value.into_owned().into_bytes())
            .unwrap_or_default();
        Ok(String::from_utf8(bytes)?)
    };
    let mut found = Vec::new();
    let mut set = |name: &str, value: &str| -> Result<()> {
        if !value.is_empty() {
            found.push((name.to_owned(), plain(value)?));
        }
        Ok(())
    };
    set("PGHOST", url.host_str().unwrap_or_default())?;
    set("PGPORT", &url.port().map(|port| port.to_string()).unwrap_or_default())?;
    set("PGUSER", url.username())?;
    set("PGPASSWORD", url.password().unwrap_or_default())?;
    set("PGDATABASE", url.path().trim_start_matches('/'))?;
    for (name, value) in url.query_pairs() {
        let variable = match name.as_ref() {
            "host" | "hostaddr" | "port" | "user" | "password" | "sslmode" | "sslrootcert" | "sslcert" | "sslkey"
            | "options" => format!("PG{}", name.to_uppercase()),
            "dbname" => "PGDATABASE".to_owned(),
            _ => continue,
        };
        found.push((variable, value.into_owned()));
    }
    Ok(found)
}

async fn run(program: &str, address: &str, words: &[&std::ffi::OsStr]) -> Result<()> {
    let mut command = Command::new(program);
    command.args(words).envs(variables(address)?).stdin(Stdio::null()).stdout(Stdio::null()).kill_on_drop(true);
    let ended = command
        .output()
        .await
        .with_context(|| format!("cannot start {program}: install PostgreSQL's client (postgresql-client)"))?;
    if !ended.status.success() {
        bail!("{program} failed: {}", String::from_utf8_lossy(&ended.stderr).trim());
    }
    Ok(())
}

/// Copies a database into a file.
pub(super) async fn dump(address: &str, file: &Path) -> Result<()> {
    let words = ["--format=custom", "--no-owner", "--no-privileges", "--file"].map(std::ffi::OsStr::new);
    run("pg_dump", address, &[&words[..], &[file.as_os_str()]].concat()).await
}

/// Brings such a copy into an empty database, all of it or nothing.
pub(super) async fn load(address: &str, file: &Path) -> Result<()> {
    let name = variables(address)?.into_iter().rfind(|(name, _)| name == "PGDATABASE").map(|(_, value)| value);
    let name = format!("--dbname={}", name.context("the address names no database")?);
    let words = ["--no-owner", "--no-privileges", "--single-transaction", "--exit-on-error", name.as_str()];
    run("pg_restore", address, &[&words.map(std::ffi::OsStr::new)[..], &[file.as_os_str()]].concat()).await
}

#[cfg(test)]
mod tests {
    use super::variables;

    #[test]
    fn an_address_is_told_by_variables() {
        let found = variables("postgres://me:a%40b+c@db.example.org:5433/course?sslmode=require").expect("variables");
        let of = |name: &str| found.iter().find(|(known, _)| known == name).map(|(_, value)| value.as_str());
        assert_eq!((of("PGHOST"), of("PGPORT"), of("PGUSER")), (Some("db.example.org"), Some("5433"), Some("me")));
        assert_eq!((of("PGPASSWORD"), of("PGDATABASE")), (Some("a@b+c"), Some("course")));
        assert_eq!(of("PGSSLMODE"), Some("require"));
        let found = variables("postgresql:///course?host=/run/postgresql").expect("variables");
        assert!(found.contains(&("PGHOST".to_owned(), "/run/postgresql".to_owned())), "{found:?}");
        let error = variables("postgres//me:geheim@db").expect_err("no address").to_string();
        assert!(!error.contains("geheim"), "{error}");
    }
}
