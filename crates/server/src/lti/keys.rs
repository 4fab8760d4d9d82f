//! The service's own keys for signatures. The first key is created when it is needed. A new key is used after an hour,
//! so that platforms have time to read it, and the previous key is published until another one is created.
use super::crypto;
use crate::{
    db::{Database, DbError, Row, Transaction},
    secret, values,
};
use base64::{Engine as _, engine::general_purpose::URL_SAFE_NO_PAD};
use rsa::{RsaPrivateKey, pkcs1::EncodeRsaPrivateKey, rand_core::OsRng, traits::PublicKeyParts};
use serde::Serialize;
use serde_json::{Value, json};

/// The number of bits of a key, which every platform accepts.
const KEY_BITS: usize = 2048;

/// The time for which a new key is published before it is used for signatures, in milliseconds.
const PUBLICATION_TIME: i64 = 3600 * 1000;

/// A key of the service for signatures.
pub(super) struct SigningKey {
    kid: String,
    der: Vec<u8>,
}

impl SigningKey {
    /// Signs claims with this key.
    pub(super) fn sign(&self, claims: &impl Serialize) -> Result<String, DbError> {
        crypto::sign(claims, &self.kid, &self.der).map_err(|error| DbError::Other(format!("a token: {error}")))
    }
}

/// Creates a key for signatures. It is used after an hour, or immediately if it is the first key.
///
/// # Errors
///
/// Fails if the key cannot be generated or stored.
pub async fn new_key(database: &Database) -> Result<(), DbError> {
    let generated = tokio::task::spawn_blocking(generate).await.map_err(|error| DbError::Other(error.to_string()))?;
    let (private, modulus, exponent) = generated?;
    let mut transaction = database.begin().await?;
    let statement =
        "INSERT INTO platform_key (kid, private_key, modulus, exponent, created_at) VALUES (?, ?, ?, ?, {now})";
    transaction.execute(statement, values![secret::random_hex(), private, modulus, exponent]).await?;
    // Keep only the new key, and the key that is used at present.
    let statement = "UPDATE platform_key SET retired_at = {now} WHERE retired_at IS NULL
        AND id NOT IN (SELECT id FROM platform_key WHERE retired_at IS NULL ORDER BY id DESC LIMIT 2)";
    transaction.execute(statement, values![]).await?;
    transaction.commit().await
}

fn generate() -> Result<(String, String, String), DbError> {
    let other = |error: String| DbError::Other(format!("no key can be created: {error}"));
    let key = RsaPrivateKey::new(&mut OsRng, KEY_BITS).map_err(|error| other(error.to_string()))?;
    let der = key.to_pkcs1_der().map_err(|error| other(error.to_string()))?;
    let text = |bytes: &[u8]| URL_SAFE_NO_PAD.encode(bytes);
    Ok((text(der.as_bytes()), text(&key.n().to_bytes_be()), text(&key.e().to_bytes_be())))
}

async fn read_rows(transaction: &mut Transaction) -> Result<Vec<Row>, DbError> {
    let statement = "SELECT kid, private_key, modulus, exponent,
           CAST(CASE WHEN created_at <= {now} - ? THEN 1 ELSE 0 END AS {int}) AS is_known
        FROM platform_key WHERE retired_at IS NULL ORDER BY id DESC";
    transaction.rows(statement, values![PUBLICATION_TIME]).await
}

/// Returns all keys, the newest first. If there are no keys, the first one is created.
async fn load_or_create_keys(database: &Database) -> Result<Vec<Row>, DbError> {
    let found = read_rows(&mut database.read().await?).await?;
    if !found.is_empty() {
        return Ok(found);
    }
    new_key(database).await?;
    read_rows(&mut database.read().await?).await
}

/// Returns the key for signatures: the newest one that platforms had time to read, or otherwise the oldest.
pub(super) async fn signing_key(database: &Database) -> Result<SigningKey, DbError> {
    let rows = load_or_create_keys(database).await?;
    let ready = rows.iter().find(|row| matches!(row.flag("is_known"), Ok(true)));
    let row = ready.or(rows.last()).ok_or_else(|| DbError::Other("the server has no signing key".to_owned()))?;
    let der = URL_SAFE_NO_PAD
        .decode(row.text("private_key")?)
        .map_err(|error| DbError::Other(format!("the key is damaged: {error}")))?;
    Ok(SigningKey { kid: row.text("kid")?, der })
}

/// Returns the public parts of the keys as a JSON Web Key Set (RFC 7517).
///
/// # Errors
/// Fails if the keys cannot be read, or the first key cannot be created.
pub async fn public_keys(database: &Database) -> Result<Value, DbError> {
    let mut keys = Vec::new();
    for row in &load_or_create_keys(database).await? {
        keys.push(json!({
            "kty": "RSA", "alg": "RS256", "use": "sig",
            "kid": row.text("kid")?, "n": row.text("modulus")?, "e": row.text("exponent")?,
        }));
    }
    Ok(json!({ "keys": keys }))
}
