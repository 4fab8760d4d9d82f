//! Connects learning platforms by LTI 1.3 and its three services ("LTI Advantage"). People come from a platform's
//! course to an assignment, the course's list of members is read, and scores are sent back. This module implements the
//! protocol: messages, keys, tokens, services. `domain` decides about permissions.
//!
//! The code follows the specifications of 1EdTech: LTI Core 1.3 ("LTI"), Security Framework 1.0 ("SEC"), Deep Linking
//! 2.0 ("DL"), Names and Role Provisioning Services 2.0 ("NRPS"), and Assignment and Grade Services 2.0 ("AGS").

mod client;
mod crypto;
mod keys;
mod message;
mod platform;
mod platform_keys;
mod roster;
pub(crate) mod score;
mod sender;

pub use client::{Client, ServiceFault};
pub use keys::{new_key, public_keys};
pub use message::{
    Arrival, Context, DeepLinking, LtiPerson, LtiRole, Message, Rejection, Resource, deep_linking_response,
};
pub use platform::{Platform, PlatformSettings};
pub use roster::fetch as fetch_roster;
pub use sender::run as send_scores;

pub(crate) use client::scope;

use platform_keys::PlatformKeys;

/// The state that the service keeps for communication with platforms.
#[derive(Debug)]
pub struct Lti {
    /// The client for requests to platforms.
    pub client: Client,
    platform_keys: PlatformKeys,
}

impl Default for Lti {
    fn default() -> Self {
        Self::new(false)
    }
}

impl Lti {
    /// Creates the state. With `allows_http`, platforms without TLS are allowed, for tests on one machine.
    pub fn new(allows_http: bool) -> Self {
        Self { client: Client::new(allows_http), platform_keys: PlatformKeys::default() }
    }

    /// Returns whether plain HTTP is allowed for platforms and for this service.
    pub fn allows_http(&self) -> bool {
        self.client.allows_http
    }

    /// Reads a platform's message about a person who signs in, and makes all checks of SEC 5.1.3.
    ///
    /// # Errors
    ///
    /// Fails if the message is rejected. The error is the reason.
    pub async fn receive(&self, platform: &Platform, token: &str, nonce: &str) -> Result<Message, Rejection> {
        let kid = message::read_key_id(token)?;
        let key = self.platform_keys.fetch(&self.client, platform, &kid).await?;
        message::read(platform, token, &key, nonce)
    }
}
