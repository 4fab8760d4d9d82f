//! The URL of the database, which is printed only without its password.
use std::{fmt, path::PathBuf, str::FromStr};

/// A database's URL as given: `sqlite:FILE` or `postgres://USER:PASSWORD@HOST/NAME`.
#[derive(Clone, PartialEq, Eq)]
pub enum Address {
    /// A SQLite database file.
    Sqlite(PathBuf),
    /// The whole URL of a PostgreSQL database, which may contain a password.
    Postgres(String),
}

impl FromStr for Address {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text.starts_with("postgres://") || text.starts_with("postgresql://") {
            return Ok(Self::Postgres(text.to_owned()));
        }
        let file =
            text.strip_prefix("sqlite://").or_else(|| text.strip_prefix("sqlite:")).filter(|file| !file.is_empty());
        match file {
            Some(file) => Ok(Self::Sqlite(file.into())),
            // The text may contain a password, so the error does not repeat it.
            None => Err("a database must be sqlite:FILE or postgres://USER:PASSWORD@HOST/NAME".to_owned()),
        }
    }
}

impl fmt::Display for Address {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Sqlite(file) => write!(f, "sqlite:{}", file.display()),
            Self::Postgres(url) => {
                // The password may contain an @; the host's name can't.
                let rest = url.split_once("://").map_or("", |(_, rest)| rest);
                let host = rest.rsplit_once('@').map_or(rest, |(_, host)| host);
                // The query may also contain the password, as `password=...`.
                write!(f, "postgres://{}", host.split('?').next().unwrap_or_default())
            }
        }
    }
}

impl fmt::Debug for Address {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

#[cfg(test)]
mod tests {
    use super::Address;

    #[test]
    fn an_address_is_read_and_shown_without_its_password() {
        let print = |text: &str| {
            let address: Address = text.parse().expect("an address");
            assert_eq!(format!("{address}"), format!("{address:?}"));
            address.to_string()
        };
        assert_eq!(print("sqlite:data/fosssim.db"), "sqlite:data/fosssim.db");
        assert_eq!(print("sqlite:///srv/fosssim.db"), "sqlite:/srv/fosssim.db");
        assert_eq!(print("postgres://me:geheim@db.example.org/course"), "postgres://db.example.org/course");
        assert_eq!(print("postgresql://me:a@b@db/course?password=geheim&sslmode=require"), "postgres://db/course");
        let error = "mysql://me:geheim@db/course".parse::<Address>().expect_err("no such engine");
        assert!(!error.contains("geheim"), "{error}");
        assert!("sqlite:".parse::<Address>().is_err());
    }
}
