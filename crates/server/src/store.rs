//! The store of artifacts: submissions, reports, suites. Each is stored under the SHA-256 of its bytes, and is written
//! once and never changed. A reader gets bytes that match the digest, or an error. The store is a folder by default;
//! for several servers it is a bucket of S3 or a compatible service.
//!
//! An artifact is safely stored before the database refers to it, so that a referenced artifact always exists.
mod read;
mod unreferenced;

pub use read::OpenArtifact;

use crate::secret::to_hex;
use futures_util::TryStreamExt;
use object_store::{
    ObjectStore, ObjectStoreExt, PutPayload, WriteMultipart, local::LocalFileSystem, path::Path as Key,
};
use serde::{Deserialize, Serialize};
use sha2::{Digest as _, Sha256};
use std::{
    fmt, io,
    path::{Path, PathBuf},
    str::FromStr,
    sync::Arc,
    time::{Duration, SystemTime, UNIX_EPOCH},
};
use thiserror::Error;
use tokio_util::io::ReaderStream;
use utoipa::ToSchema;

/// The number of bytes that are read at a time, in files and artifacts.
const CHUNK_BYTES: usize = 256 * 1024;

/// The name of the folder that contains the artifacts.
const KEPT_FOLDER: &str = "sha256";
const TRASH_FOLDER: &str = "aside";

/// The age above which an existing artifact is written again when it is stored again. The removal of unreferenced
/// artifacts removes old ones, and must not remove an artifact to which the database will soon refer.
const FRESH_AGE: Duration = Duration::from_secs(6 * 3600);

/// The SHA-256 of an artifact's bytes, in lower-case hexadecimal.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(try_from = "String")]
pub struct Digest(String);

/// The digest and size of an artifact.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub struct Artifact {
    /// The digest under which the artifact is stored.
    pub digest: Digest,
    /// The size of the artifact in bytes.
    #[schema(maximum = 9_007_199_254_740_991_i64)]
    pub size: u64,
}

/// The reason why an artifact can't be stored or read.
#[derive(Debug, Error)]
pub enum StoreError {
    /// The store has no artifact with this digest.
    #[error("the store has no artifact {0}")]
    Missing(Digest),
    /// The artifact's bytes differ from those that were stored, because the disk is damaged or the file was changed.
    #[error("the artifact {0} is damaged in the store")]
    Damaged(Digest),
    /// The store can't be used; the value describes why, such as no space, no permission, or no connection.
    #[error("the store failed: {0}")]
    Failed(String),
}

impl From<object_store::Error> for StoreError {
    fn from(error: object_store::Error) -> Self {
        Self::Failed(error.to_string())
    }
}

impl From<io::Error> for StoreError {
    fn from(error: io::Error) -> Self {
        Self::Failed(error.to_string())
    }
}

impl Digest {
    /// Computes the digest of bytes.
    pub fn from_bytes(bytes: &[u8]) -> Self {
        Self(to_hex(&Sha256::digest(bytes)))
    }

    /// Returns the digest as text.
    pub fn as_str(&self) -> &str {
        &self.0
    }

    /// Returns the first digits of the digest, for display.
    pub fn short(&self) -> &str {
        &self.0[..12]
    }

    /// Returns the key of an artifact in one of the store's two folders.
    fn key(&self, folder: &str) -> Key {
        Key::from(format!("{folder}/{}/{}", &self.0[..2], &self.0[2..]))
    }
}

impl FromStr for Digest {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let is_hex = |c: u8| c.is_ascii_digit() || (b'a'..=b'f').contains(&c);
        if text.len() == 64 && text.bytes().all(is_hex) {
            return Ok(Self(text.to_owned()));
        }
        Err("a digest must be 64 digits of lower-case hexadecimal".to_owned())
    }
}

impl TryFrom<String> for Digest {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl fmt::Display for Digest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// The store of artifacts. Clones are cheap and use the same store.
#[derive(Debug, Clone)]
pub struct Store {
    objects: Arc<dyn ObjectStore>,
    /// The path of the store's folder; `None` if the store is a bucket.
    folder: Option<PathBuf>,
}

impl Store {
    /// Creates a store in a folder, which is created if it does not exist. Stored artifacts survive a power cut.
    ///
    /// # Errors
    ///
    /// Fails if the folder can't be created.
    pub fn folder(folder: &Path) -> Result<Self, StoreError> {
        std::fs::create_dir_all(folder)
            .map_err(|error| StoreError::Failed(format!("cannot create the folder {}: {error}", folder.display())))?;
        let objects = LocalFileSystem::new_with_prefix(folder)?.with_fsync(true);
        Ok(Self { objects: Arc::new(objects), folder: Some(folder.to_owned()) })
    }

    /// Creates a store in a bucket, `s3://BUCKET` or `s3://BUCKET/PREFIX`, configured by the environment variables
    /// `AWS_...`.
    ///
    /// # Errors
    ///
    /// Fails if the URL is invalid, or this program was built without support for buckets.
    pub fn bucket(address: &str) -> Result<Self, StoreError> {
        let location = address.strip_prefix("s3://").unwrap_or_default();
        let (bucket, prefix) = location.split_once('/').unwrap_or((location, ""));
        if bucket.is_empty() {
            return Err(StoreError::Failed(format!("{address} must be s3://BUCKET/PREFIX")));
        }
        Self::s3(bucket, prefix)
    }

    #[cfg(feature = "s3")]
    fn s3(bucket: &str, prefix: &str) -> Result<Self, StoreError> {
        // This fails only if a provider is already installed, so the error is ignored.
        drop(rustls::crypto::ring::default_provider().install_default());
        let objects = object_store::aws::AmazonS3Builder::from_env().with_bucket_name(bucket).build()?;
        let objects = object_store::prefix::PrefixStore::new(objects, prefix);
        Ok(Self { objects: Arc::new(objects), folder: None })
    }

    #[cfg(not(feature = "s3"))]
    fn s3(_: &str, _: &str) -> Result<Self, StoreError> {
        Err(StoreError::Failed("this program was built without buckets: build it with --features s3".to_owned()))
    }

    /// Checks that more can be stored, by writing a small object and removing it.
    ///
    /// # Errors
    ///
    /// Fails if nothing can be written to the folder or bucket.
    pub async fn check_writable(&self) -> Result<(), StoreError> {
        let key = Key::from(format!("{TRASH_FOLDER}/proof-{}", std::process::id()));
        self.objects.put(&key, PutPayload::from_static(b"proof")).await?;
        self.objects.delete(&key).await?;
        Ok(())
    }

    /// Stores a file. It is read in pieces, so that the whole file is never in memory.
    ///
    /// # Errors
    ///
    /// Fails if the file can't be read or changes during the upload, or the store fails.
    pub async fn put_file(&self, file: &Path) -> Result<Artifact, StoreError> {
        let artifact = digest_of_file(file).await?;
        // A stored artifact that will not be removed soon is kept.
        if self.find_age(&artifact.digest.key(KEPT_FOLDER)).await?.is_some_and(|age| age < FRESH_AGE) {
            return Ok(artifact);
        }
        let (mut pieces, mut hasher) = (stream_file(file).await?, Sha256::new());
        // An incomplete upload is never visible under its name.
        let mut upload = WriteMultipart::new(self.objects.put_multipart(&artifact.digest.key(KEPT_FOLDER)).await?);
        while let Some(piece) = pieces.try_next().await? {
            hasher.update(&piece);
            upload.wait_for_capacity(4).await?;
            upload.write(&piece);
        }
        if to_hex(&hasher.finalize()) != artifact.digest.0 {
            upload.abort().await?;
            return Err(StoreError::Failed(format!("{} changed while it was read", file.display())));
        }
        upload.finish().await?;
        Ok(artifact)
    }

    /// Returns whether the store has an artifact with this digest.
    ///
    /// # Errors
    ///
    /// Fails if the folder or bucket cannot be read.
    pub async fn has(&self, digest: &Digest) -> Result<bool, StoreError> {
        Ok(self.find_age(&digest.key(KEPT_FOLDER)).await?.is_some()
            || self.find_age(&digest.key(TRASH_FOLDER)).await?.is_some())
    }

    /// Returns the age of a stored object; `None` if it does not exist.
    async fn find_age(&self, key: &Key) -> Result<Option<Duration>, StoreError> {
        match self.objects.head(key).await {
            Ok(meta) => Ok(Some(age(&meta))),
            Err(object_store::Error::NotFound { .. }) => Ok(None),
            Err(error) => Err(error.into()),
        }
    }
}

fn age(meta: &object_store::ObjectMeta) -> Duration {
    let written = u64::try_from(meta.last_modified.timestamp_millis()).unwrap_or(0);
    let written = UNIX_EPOCH + Duration::from_millis(written);
    SystemTime::now().duration_since(written).unwrap_or(Duration::ZERO)
}

/// Computes the digest and size of a file.
///
/// # Errors
/// Fails if the file can't be read.
pub async fn digest_of_file(file: &Path) -> io::Result<Artifact> {
    let (mut pieces, mut hasher, mut size) = (stream_file(file).await?, Sha256::new(), 0);
    while let Some(piece) = pieces.try_next().await? {
        size += piece.len() as u64;
        hasher.update(&piece);
    }
    Ok(Artifact { digest: Digest(to_hex(&hasher.finalize())), size })
}

/// Returns a stream of a file's pieces, so that the whole file is never in memory.
async fn stream_file(file: &Path) -> io::Result<ReaderStream<tokio::fs::File>> {
    Ok(ReaderStream::with_capacity(tokio::fs::File::open(file).await?, CHUNK_BYTES))
}
