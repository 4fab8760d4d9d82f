//! Sign-in at an OpenID Connect provider. The database stores which account belongs to each subject of the provider. An
//! e-mail address can claim an account once, if a course's staff created the account and it has never been used.
use crate::{
    db::Transaction,
    domain::{
        App, LaunchTarget, LoginAnswer, Person, Visitor,
        accounts::{
            identity::{self, SignInMethod},
            newcomer::Newcomer,
            pending_sign_in::UNKNOWN_SIGN_IN,
        },
        view::{self, LogEntry},
    },
    oidc::{Provider, ProviderFault, ProviderPerson, SignInSecrets},
    problem::{Problem, ensure},
    values,
};

/// The name under which pending sign-ins refer to the provider.
const PROVIDER_SERVICE: &str = "provider";

impl From<ProviderFault> for Problem {
    fn from(fault: ProviderFault) -> Self {
        match fault {
            ProviderFault::Unavailable(detail) => Self::unavailable(detail),
            ProviderFault::Rejected(detail) => Self::rejected_sign_in(detail),
        }
    }
}

impl App {
    fn configured_provider(&self) -> Result<&Provider, Problem> {
        self.provider.as_ref().ok_or_else(|| Problem::not_found("provider"))
    }

    /// Returns the URL to which the provider sends people back.
    fn return_url(&self) -> String {
        format!("{}/sign-in/provider/answer", self.public)
    }

    /// Computes the secrets for a sign-in with this state.
    async fn compute_secrets(&self, state: &str) -> Result<SignInSecrets, Problem> {
        let nonce = self.compute_secret("nonce", state).await?;
        Ok(SignInSecrets { state: state.to_owned(), nonce, verifier: self.compute_secret("verifier", state).await? })
    }
}

/// Returns the provider's issuer in its stored form.
fn stored_issuer(provider: &Provider) -> String {
    format!("{PROVIDER_SERVICE} {}", provider.issuer())
}

impl Visitor {
    /// Begins a sign-in at the provider; the page `to` is opened afterwards. If a person is already signed in, their
    /// account is connected to the provider.
    ///
    /// # Errors
    ///
    /// Fails if there is no provider, if the provider does not answer, or if the person lacks the permission.
    pub async fn begin_at_provider(&self, to: &str, connecting: Option<&Person>) -> Result<LoginAnswer, Problem> {
        let provider = self.app.configured_provider()?;
        let account = match connecting {
            Some(person) => person.require_recent_browser().map(|_| person.account.id)?,
            None => 0,
        };
        let browser = (&self.secrets, self.secrets.provider_secret.as_ref());
        let started = self.app.begin_sign_in(PROVIDER_SERVICE, browser, (account, to)).await?;
        let address =
            provider.sign_in_url(&self.app.return_url(), self.app.compute_secrets(&started.state).await?).await?;
        Ok(LoginAnswer { address: address.into(), browser: started.browser })
    }

    /// Signs in the person for whom the provider issued `code`. `state` must belong to a sign-in that this browser
    /// began and that is not used yet.
    ///
    /// # Errors
    /// Fails if the answer does not belong to such a sign-in, or the provider's tokens are not accepted.
    pub async fn sign_in_by_provider(&self, state: &str, code: &str) -> Result<LaunchTarget, Problem> {
        let (app, browser) = (&self.app, self.secrets.provider_secret.as_ref());
        let provider = app.configured_provider()?;
        let pending = app.pending_sign_in(state, browser, Problem::rejected_sign_in).await?;
        ensure(pending.service == PROVIDER_SERVICE, Problem::rejected_sign_in(UNKNOWN_SIGN_IN))?;
        let person = provider.person(&app.return_url(), code.to_owned(), app.compute_secrets(state).await?).await?;
        let connects = match pending.account {
            0 => None,
            account => {
                let connects = app.person(&self.secrets).await.ok().filter(|person| person.account.id == account);
                let signed_out = || Problem::rejected_sign_in("you are not signed in to the account to connect");
                Some(connects.ok_or_else(signed_out)?)
            }
        };
        let mut transaction = app.0.database.begin().await?;
        ensure(pending.mark_used(&mut transaction).await?, Problem::rejected_sign_in(UNKNOWN_SIGN_IN))?;
        let account = match connects {
            Some(connects) => connect(&mut transaction, provider, &person, &connects).await?,
            None => resolve(&mut transaction, provider, &person).await?,
        };
        let session = identity::begin_session(&mut transaction, account, SignInMethod::Own).await?;
        transaction.commit().await?;
        Ok(LaunchTarget { session, path: pending.path })
    }
}

fn describe_newcomer<'a>(issuer: &'a str, person: &'a ProviderPerson) -> Newcomer<'a> {
    let (name, nickname) = (person.name.as_deref(), person.nickname.as_deref());
    Newcomer { issuer, subject: &person.subject, name, nickname }
}

/// Connects an account to the provider. The account becomes the person's own, and its earlier sessions end.
async fn connect(
    transaction: &mut Transaction,
    provider: &Provider,
    person: &ProviderPerson,
    connecting: &Person,
) -> Result<i64, Problem> {
    let account = connecting.account.id;
    let session_from_staff_link = connecting.require_recent_browser()?.from_staff_link;
    let issuer = stored_issuer(provider);
    let statement = "SELECT 1 AS n FROM platform_account WHERE account = ? AND issuer = ?";
    ensure(
        transaction.row(statement, values![account, &issuer]).await?.is_none(),
        Problem::conflict("your account is already connected", "disconnect it first, on the page Account"),
    )?;
    identity::end_sessions(transaction, account).await?;
    identity::end_staff_access(transaction, account).await?;
    // The person may already have another account, from an earlier sign-in at the provider.
    let newcomer = describe_newcomer(&issuer, person);
    let statement = "DELETE FROM platform_account WHERE issuer = ? AND subject = ?";
    transaction.execute(statement, values![&issuer, &person.subject]).await?;
    newcomer.link_account(transaction, account, session_from_staff_link).await?;
    log(transaction, provider, account, &connecting.account.login).await?;
    Ok(account)
}

async fn log(transaction: &mut Transaction, provider: &Provider, account: i64, login: &str) -> Result<(), Problem> {
    let text = format!("connected {login} to {}", provider.label);
    Ok(view::log_event(transaction, &LogEntry::new("account", account, &text)).await?)
}

/// Finds or creates the account of a person who signs in.
async fn resolve(transaction: &mut Transaction, provider: &Provider, person: &ProviderPerson) -> Result<i64, Problem> {
    let issuer = stored_issuer(provider);
    let newcomer = describe_newcomer(&issuer, person);
    if newcomer.find(transaction).await?.is_none()
        && let Some(mailbox) = &person.mailbox
    {
        // The address can claim an account only if staff created the account for it, and if the account was never used.
        let statement = "SELECT id FROM account
            WHERE login = ? AND managed_by IS NOT NULL AND disabled_at IS NULL {for update}";
        if let Some(row) = transaction.row(statement, values![mailbox]).await? {
            let account = row.int("id")?;
            if identity::is_trusted(transaction, account).await? {
                let detail = format!("{mailbox} is staff here: sign in with your link, and connect your account there");
                return Err(Problem::rejected_sign_in(detail));
            }
            // Staff could have signed in as this account.
            identity::end_all_access(transaction, account).await?;
            newcomer.link_account(transaction, account, false).await?;
            log(transaction, provider, account, mailbox).await?;
        }
    }
    let account = newcomer.find_or_make(transaction).await?;
    let row = transaction.one("SELECT disabled_at FROM account WHERE id = ?", values![account]).await?;
    ensure(row.maybe_int("disabled_at")?.is_none(), Problem::rejected_sign_in("your account here is closed"))?;
    Ok(account)
}

impl Person {
    /// Returns whether the person's account is connected to the provider.
    ///
    /// # Errors
    ///
    /// Fails if the database does not answer.
    pub async fn is_connected(&self) -> Result<bool, Problem> {
        let Some(provider) = &self.app.provider else { return Ok(false) };
        let statement = "SELECT 1 AS n FROM platform_account WHERE account = ? AND issuer = ?";
        let mut transaction = self.app.0.database.read().await?;
        Ok(transaction.row(statement, values![self.account.id, stored_issuer(provider)]).await?.is_some())
    }

    /// Disconnects the person's account from the provider.
    ///
    /// # Errors
    ///
    /// Fails if there is no provider, or the person did not sign in recently.
    pub async fn disconnect(&self) -> Result<(), Problem> {
        let issuer = stored_issuer(self.app.configured_provider()?);
        self.require_recent_browser()?;
        let mut transaction = self.app.0.database.begin().await?;
        let statement = "DELETE FROM platform_account WHERE account = ? AND issuer = ?";
        transaction.execute(statement, values![self.account.id, issuer]).await?;
        Ok(transaction.commit().await?)
    }
}
