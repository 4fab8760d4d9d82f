//! PostgreSQL's own tools, which copy a database consistently while others write. They receive the password in an
//! environment variable, so that it is not in the list of processes.
use anyhow::{Context, Result, bail};
use std::{path::Path, process::Stdio};
use tokio::process::Command;
use url::{Url, form_urlencoded};

/// Splits a URL into the URL without its password, and the password.
fn split_password(address: &str) -> Result<(Url, String)> {
    // The text may contain a password, so the error does not repeat it.
    let mut url = Url::parse(address).ok().context("the database's address is invalid")?;
    let form = format!("password={}", url.password().unwrap_or_default().replace('+', "%2B"));
    let fields = form_urlencoded::parse(form.as_bytes()).into_owned().chain(url.query_pairs().into_owned());
    let (passwords, rest): (Vec<_>, Vec<_>) = fields.partition(|(name, _)| name == "password");
    if passwords.len() > 1 {
        url.query_pairs_mut().clear().extend_pairs(rest);
    }
    let unset = url.host_str().is_some_and(|host| !host.is_empty()).then(|| url.set_password(None));
    if unset == Some(Err(())) {
        bail!("the database's address is invalid");
    }
    Ok((url, passwords.into_iter().next_back().map(|(_, password)| password).unwrap_or_default()))
}

async fn run_tool(program: &str, address: &str, arguments: &[&str], file: &Path) -> Result<()> {
    let (url, password) = split_password(address)?;
    let mut command = Command::new(program);
    command.arg(format!("--dbname={url}")).args(arguments).arg(file).env("PGPASSWORD", password);
    let output = command.stdin(Stdio::null()).stdout(Stdio::null()).kill_on_drop(true).output().await;
    let output =
        output.with_context(|| format!("cannot start {program}: install PostgreSQL's client (postgresql-client)"))?;
    if !output.status.success() {
        bail!("{program} failed: {}", String::from_utf8_lossy(&output.stderr).trim());
    }
    Ok(())
}

/// Copies a PostgreSQL database into a file, with `pg_dump`.
pub(super) async fn dump(address: &str, file: &Path) -> Result<()> {
    run_tool("pg_dump", address, &["--format=custom", "--no-owner", "--no-privileges", "--file"], file).await
}

/// Restores a database copy into an empty database, in one transaction.
pub(super) async fn load(address: &str, file: &Path) -> Result<()> {
    let arguments = ["--no-owner", "--no-privileges", "--single-transaction", "--exit-on-error"];
    run_tool("pg_restore", address, &arguments, file).await
}

#[cfg(test)]
mod tests {
    use super::split_password;

    #[test]
    fn an_address_shows_no_password() {
        for (address, shown, password) in [
            (
                "postgres://me:a%40b+c@db:5433/course?sslmode=require",
                "postgres://me@db:5433/course?sslmode=require",
                "a@b+c",
            ),
            ("postgres://db/course?password=x%20y&user=me", "postgres://db/course?user=me", "x y"),
            ("postgresql:///course?host=/run/postgresql", "postgresql:///course?host=/run/postgresql", ""),
        ] {
            let (url, found) = split_password(address).expect("an address");
            assert_eq!((url.as_str(), found.as_str()), (shown, password));
        }
        let error = split_password("postgres//me:geheim@db").expect_err("no address").to_string();
        assert!(!error.contains("geheim"), "{error}");
    }
}
