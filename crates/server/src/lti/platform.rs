//! A platform, as an administrator registers it.
use crate::{
    db::{DbError, FromRow, Row},
    problem::{Problem, ensure},
    schema::{Host, HttpsUrl, Word},
};
use serde::{Deserialize, Serialize};
use url::Url;
use utoipa::ToSchema;

/// The URLs of a platform. Platforms show them on their pages about external tools.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
#[schema(as = PlatformWish)]
pub struct PlatformSettings {
    /// The issuer of the platform's messages (called "platform ID").
    #[schema(value_type = Word)]
    pub issuer: String,
    /// The platform's name for this service (called "client ID").
    #[schema(value_type = Word)]
    pub client_id: String,
    /// The URL at which the platform signs people in (called "authentication request URL").
    #[schema(value_type = HttpsUrl)]
    pub login_url: String,
    /// The URL at which the platform issues tokens for its services (called "access token URL").
    #[schema(value_type = HttpsUrl)]
    pub token_url: String,
    /// The URL of the platform's public keys (called "public keyset URL").
    #[schema(value_type = HttpsUrl)]
    pub keys_url: String,
    /// The audience in requests for tokens; null if it is the URL that issues tokens.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(value_type = Option<Word>)]
    pub audience: Option<String>,
    /// The deployments from which people may come. If a sign-in from a new deployment is rejected, the page shows the
    /// deployment's ID.
    #[schema(value_type = Vec<Word>, min_items = 1, max_items = 1000)]
    pub deployments: Vec<String>,
    /// Hosts of the platform's services, in addition to the hosts of the other URLs.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schema(value_type = Vec<Host>, max_items = 50)]
    pub hosts: Vec<String>,
}

/// A registered platform.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, ToSchema)]
pub struct Platform {
    /// The platform's ID in the database.
    #[serde(skip)]
    pub(crate) id: i64,
    /// The platform's name on this server.
    pub name: String,
    /// The registered URLs and deployments.
    #[serde(flatten)]
    pub settings: PlatformSettings,
}

/// Parses a URL that this service may call: HTTPS (or HTTP, if `allows_http`) with a host, at most 2,000 characters,
/// and no user name, password or fragment. Returns `None` for other URLs.
pub(super) fn parse_service_url(text: &str, allows_http: bool) -> Option<Url> {
    let url = Url::parse(text).ok()?;
    let is_secure = url.scheme() == "https" || (allows_http && url.scheme() == "http");
    let is_plain = url.username().is_empty() && url.password().is_none() && url.fragment().is_none();
    (is_secure && is_plain && url.has_host() && text.len() <= 2000).then_some(url)
}

/// Returns the host and port of a URL, in the form of an origin.
fn origin(url: &Url) -> String {
    match (url.host_str(), url.port()) {
        (Some(host), Some(port)) => format!("{host}:{port}"),
        (host, _) => host.unwrap_or_default().to_owned(),
    }
}

impl PlatformSettings {
    /// Checks that the registration is valid.
    ///
    /// # Errors
    ///
    /// Fails with a message about the first invalid value.
    pub fn check(&self, allows_http: bool) -> Result<(), Problem> {
        let is_identifier =
            |text: &str| (1..=255).contains(&text.chars().count()) && !text.chars().any(char::is_control);
        for (name, text) in [("issuer", &self.issuer), ("client_id", &self.client_id)] {
            ensure(is_identifier(text), Problem::invalid(format!("{name} must have 1 to 255 characters")))?;
        }
        for (name, text) in
            [("login_url", &self.login_url), ("token_url", &self.token_url), ("keys_url", &self.keys_url)]
        {
            ensure(
                parse_service_url(text, allows_http).is_some(),
                Problem::invalid(format!("{name} must be a URL that begins with https://")),
            )?;
        }
        if self.deployments.is_empty()
            || self.deployments.len() > 1000
            || !self.deployments.iter().all(|d| is_identifier(d))
        {
            return Err(Problem::invalid("deployments must be a list of at least one deployment ID"));
        }
        ensure(
            self.audience.as_deref().is_none_or(is_identifier),
            Problem::invalid("audience must have 1 to 255 characters"),
        )?;
        let is_host = |host: &String| Url::parse(&format!("https://{host}/")).is_ok_and(|url| origin(&url) == *host);
        ensure(
            self.hosts.len() <= 50 && self.hosts.iter().all(is_host),
            Problem::invalid("hosts must be a list of host names, such as lms.example.org"),
        )?;
        Ok(())
    }
}

impl FromRow for Platform {
    fn from_row(row: &Row) -> Result<Self, DbError> {
        let settings = serde_json::from_str(&row.text("settings")?)
            .map_err(|error| DbError::Other(format!("the settings of a platform can't be read: {error}")))?;
        Ok(Self { id: row.int("id")?, name: row.text("name")?, settings })
    }
}

impl Platform {
    /// Returns the hosts of the platform's services.
    fn service_hosts(&self, allows_http: bool) -> Vec<String> {
        let settings = &self.settings;
        let hosts = [&settings.login_url, &settings.token_url, &settings.keys_url, &settings.issuer];
        let hosts = hosts.into_iter().filter_map(|text| parse_service_url(text, allows_http)).map(|url| origin(&url));
        hosts.chain(settings.hosts.iter().cloned()).collect()
    }

    /// Parses a URL of one of the platform's services. Only registered hosts are allowed, so that a message can't
    /// make this service call other hosts, or send its token to them.
    pub(crate) fn parse_registered_url(&self, text: &str, allows_http: bool) -> Option<Url> {
        let url = parse_service_url(text, allows_http)?;
        self.service_hosts(allows_http).contains(&origin(&url)).then_some(url)
    }

    /// Returns the origins whose pages may show a page of this service in a frame.
    pub fn origins(&self, allows_http: bool) -> String {
        let scheme = if allows_http { "http://" } else { "https://" };
        let mut all: Vec<String> =
            self.service_hosts(allows_http).iter().map(|host| format!("{scheme}{host}")).collect();
        all.sort();
        all.dedup();
        all.join(" ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wish() -> PlatformSettings {
        PlatformSettings {
            issuer: "https://lms.example.org".to_owned(),
            client_id: "client".to_owned(),
            login_url: "https://lms.example.org/auth".to_owned(),
            token_url: "https://tokens.example.org/token".to_owned(),
            keys_url: "https://lms.example.org/keys".to_owned(),
            audience: None,
            deployments: vec!["1".to_owned()],
            hosts: vec!["grades.example.org:8443".to_owned()],
        }
    }

    #[test]
    fn addresses_that_lead_elsewhere_are_refused() {
        assert!(wish().check(false).is_ok());
        for address in [
            "http://lms.example.org/auth",
            "file:///etc/passwd",
            "https://user:word@lms.example.org/",
            "https://lms.example.org/#here",
            "//lms.example.org/",
            "lms.example.org",
            "https://",
            "",
        ] {
            let settings = PlatformSettings { keys_url: address.to_owned(), ..wish() };
            assert!(settings.check(false).is_err(), "{address}");
        }
        let open = PlatformSettings { keys_url: "http://127.0.0.1:1/".to_owned(), ..wish() };
        assert!(open.check(false).is_err() && open.check(true).is_ok());
        assert!(PlatformSettings { deployments: vec![], ..wish() }.check(false).is_err());
        assert!(PlatformSettings { hosts: vec!["a/b".to_owned()], ..wish() }.check(false).is_err());
        assert!(PlatformSettings { issuer: "a\nb".to_owned(), ..wish() }.check(false).is_err());
    }

    #[test]
    fn services_are_on_hosts_that_an_administrator_named() {
        let platform = Platform { id: 1, name: "lms".to_owned(), settings: wish() };
        let is_allowed = |text: &str| platform.parse_registered_url(text, false).is_some();
        assert!(is_allowed("https://lms.example.org/lineitems/1?type=2"));
        assert!(is_allowed("https://tokens.example.org/x") && is_allowed("https://grades.example.org:8443/x"));
        for address in [
            "https://169.254.169.254/latest/meta-data",
            "https://grades.example.org/x",
            "https://lms.example.org:444/x",
            "https://lms.example.org@evil.example/x",
            "https://lms.example.org.evil.example/x",
            "http://lms.example.org/x",
        ] {
            assert!(!is_allowed(address), "{address}");
        }
        assert_eq!(
            platform.origins(false),
            "https://grades.example.org:8443 https://lms.example.org https://tokens.example.org"
        );
    }
}
