//! People whom another service identifies, by an issuer and a subject. The service is a learning platform, or a
//! provider.
use crate::{
    db::{DbError, Transaction},
    domain::accounts::identity,
    secret::random_hex,
    values,
};

/// A person, as the issuer describes them.
pub(in crate::domain) struct Newcomer<'a> {
    /// The platform's issuer. A provider's issuer has a prefix here, so that no platform can claim to be the provider.
    pub(in crate::domain) issuer: &'a str,
    pub(in crate::domain) subject: &'a str,
    pub(in crate::domain) name: Option<&'a str>,
    /// The name from which a new account's login is made. Only the part of an e-mail address before the @ is used.
    pub(in crate::domain) nickname: Option<&'a str>,
}

impl Newcomer<'_> {
    /// Returns the person's account, if there is one.
    pub(in crate::domain) async fn find(&self, transaction: &mut Transaction) -> Result<Option<i64>, DbError> {
        let statement = "SELECT account FROM platform_account WHERE issuer = ? AND subject = ?";
        let identity = transaction.row(statement, values![self.issuer, self.subject]).await?;
        identity.map(|row| row.int("account")).transpose()
    }

    /// Assigns an account to the person. If the session began with a staff link, this is stored with the assignment.
    pub(in crate::domain) async fn link_account(
        &self,
        transaction: &mut Transaction,
        account: i64,
        session_from_staff_link: bool,
    ) -> Result<(), DbError> {
        let statement = "INSERT INTO platform_account (issuer, subject, account, vouched, created_at)
            VALUES (?, ?, ?, ?, {now})";
        transaction
            .execute(statement, values![self.issuer, self.subject, account, session_from_staff_link])
            .await
            .map(drop)
    }

    /// Finds the person's account, or creates it with the issuer's name. An existing account with the same name or
    /// address is never used, because people choose names and addresses themselves.
    pub(in crate::domain) async fn find_or_make(&self, transaction: &mut Transaction) -> Result<i64, DbError> {
        let name = self.name.map(clean_name).filter(|name| !name.is_empty());
        if let Some(account) = self.find(transaction).await? {
            if let Some(name) = name {
                let statement = "UPDATE account SET name = ? WHERE id = ? AND name <> ?";
                transaction.execute(statement, values![&name, account, &name]).await?;
            }
            return Ok(account);
        }
        let mailbox = self.nickname.and_then(|nickname| nickname.split('@').next());
        let base = login_from_name(mailbox.or(name.as_deref()).unwrap_or_default());
        for number in 1.. {
            let login = match number {
                1 => base.clone(),
                2..=9 => format!("{base}-{number}"),
                _ => format!("{base}-{}", &random_hex()[..8]),
            };
            let statement = "INSERT INTO account (login, name, created_at) VALUES (?, ?, {now})
                ON CONFLICT (login) DO NOTHING RETURNING id";
            let created = transaction.row(statement, values![&login, name.as_ref().unwrap_or(&login)]).await?;
            let Some(made) = created else { continue };
            let account = made.int("id")?;
            self.link_account(transaction, account, false).await?;
            return Ok(account);
        }
        Err(DbError::Other("cannot find a free login".to_owned()))
    }
}

/// Returns a shortened name without invisible characters.
fn clean_name(name: &str) -> String {
    let plain: String = name.chars().map(|c| if identity::is_control(c) { ' ' } else { c }).collect();
    plain.trim().chars().take(200).collect::<String>().trim().to_owned()
}

/// Creates a valid login from any name.
fn login_from_name(name: &str) -> String {
    let plain = |c: char| match c.to_ascii_lowercase() {
        c if c.is_ascii_lowercase() || c.is_ascii_digit() || matches!(c, '-' | '_' | '.') => Some(c),
        c if c.is_whitespace() => Some('.'),
        _ => None,
    };
    let login: String = name.chars().filter_map(plain).take(40).collect();
    let login = login.trim_matches(['-', '.', '_']);
    if login.is_empty() { "user".to_owned() } else { login.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn logins_are_made_of_what_people_are_called() {
        for (word, login) in [
            ("Ada.Lovelace", "ada.lovelace"),
            ("Ada Lovelace", "ada.lovelace"),
            ("-x-", "x"),
            ("\u{5d0}\u{5d3}\u{5d4}", "user"),
            ("a'; DROP TABLE", "a.drop.table"),
            ("", "user"),
        ] {
            assert_eq!(login_from_name(word), login, "{word}");
            assert!(identity::check_slug("a login", &login_from_name(word)).is_ok());
        }
        assert_eq!(clean_name(" A\nB\u{0} "), "A B");
    }
}
