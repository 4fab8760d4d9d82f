//! Reads artifacts in pieces, so that large artifacts need no more memory than small ones.
use super::{Digest, KEPT_FOLDER, Store, StoreError, TRASH_FOLDER};
use crate::secret::to_hex;
use axum::body::Bytes;
use futures_util::{StreamExt, TryStreamExt, stream::BoxStream};
use object_store::ObjectStoreExt;
use sha2::{Digest as _, Sha256};
use std::path::Path;
use tokio::io::AsyncWriteExt;

/// An artifact that is being read.
pub struct OpenArtifact {
    /// The size of the whole artifact, in bytes.
    pub size: u64,
    /// The artifact's bytes, in pieces.
    pub pieces: BoxStream<'static, Result<Bytes, StoreError>>,
}

impl Store {
    /// Opens an artifact. The last piece is returned only if the bytes match the digest, so a reader that gets all
    /// pieces has the right bytes. An artifact that is a single piece is checked before that piece is returned.
    ///
    /// # Errors
    ///
    /// Fails if there is no such artifact, it is damaged, or the store fails.
    pub async fn open(&self, digest: &Digest) -> Result<OpenArtifact, StoreError> {
        let mut found = self.objects.get(&digest.key(KEPT_FOLDER)).await;
        // The sweep may have moved the file to the trash before the database referred to it again, so it is moved back.
        if matches!(found, Err(object_store::Error::NotFound { .. })) {
            found = self.objects.get(&digest.key(TRASH_FOLDER)).await;
        }
        let found = match found {
            Err(object_store::Error::NotFound { .. }) => return Err(StoreError::Missing(digest.clone())),
            found => found?,
        };
        let size = found.meta.size;
        let pieces = found.into_stream().map_err(StoreError::from).boxed();
        let mut pieces = verify(pieces, digest.clone());
        let first = pieces.next().await.transpose()?;
        let pieces = futures_util::stream::iter(first.map(Ok)).chain(pieces).boxed();
        Ok(OpenArtifact { size, pieces })
    }

    /// Writes an artifact into a new file.
    ///
    /// # Errors
    ///
    /// Fails if there is no such artifact, if it is damaged, if the file can't be written, or if the store fails. No
    /// file is left behind if the artifact is missing or damaged.
    pub async fn fetch(&self, digest: &Digest, file: &Path) -> Result<(), StoreError> {
        let mut output = tokio::fs::File::create_new(file).await?;
        let copying = async {
            let mut pieces = self.open(digest).await?.pieces;
            while let Some(piece) = pieces.next().await {
                output.write_all(&piece?).await?;
            }
            Ok(output.flush().await?)
        };
        let result = copying.await;
        if result.is_err() {
            drop(tokio::fs::remove_file(file).await);
        }
        result
    }
}

/// Passes the pieces on. The last piece is passed on only if all pieces together match the digest.
fn verify(
    pieces: BoxStream<'static, Result<Bytes, StoreError>>,
    digest: Digest,
) -> BoxStream<'static, Result<Bytes, StoreError>> {
    let state = (pieces, Sha256::new(), None, false, digest);
    futures_util::stream::try_unfold(state, async |(mut pieces, mut hasher, mut held, mut ended, digest)| {
        while !ended {
            let next = pieces.try_next().await?;
            if let Some(piece) = &next {
                hasher.update(piece);
            } else if to_hex(&hasher.finalize_reset()) != digest.as_str() {
                return Err(StoreError::Damaged(digest));
            }
            ended = next.is_none();
            if let Some(piece) = std::mem::replace(&mut held, next) {
                return Ok(Some((piece, (pieces, hasher, held, ended, digest))));
            }
        }
        Ok(None)
    })
    .boxed()
}
