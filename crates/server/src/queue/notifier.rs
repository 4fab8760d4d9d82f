//! Notifies waiting tasks of this process to check immediately. Notifications only save time: without one, as in
//! another process, a task notices a change a little later.
use crate::db::{DbError, Transaction};
use std::{sync::Arc, time::Duration};
use tokio::sync::watch;

/// The notifier of one process.
#[derive(Debug, Clone, Default)]
pub struct Notifier {
    changes: Arc<watch::Sender<u64>>,
}

/// A task that waits for the notifier. Changes between two waits are not missed.
#[derive(Debug, Clone)]
pub struct Subscription(watch::Receiver<u64>);

impl Notifier {
    /// Commits, and wakes subscribers.
    ///
    /// # Errors
    /// Fails if the transaction can't be committed.
    pub async fn commit(&self, transaction: Transaction) -> Result<(), DbError> {
        transaction.commit().await?;
        self.wake();
        Ok(())
    }

    /// Wakes subscribers.
    pub fn wake(&self) {
        self.changes.send_modify(|changes| *changes += 1);
    }

    /// Returns a subscription to all later changes.
    pub fn subscribe(&self) -> Subscription {
        Subscription(self.changes.subscribe())
    }
}

impl Subscription {
    /// Waits for a change, at most for `patience`, and returns whether there was one.
    pub async fn wait(&mut self, patience: Duration) -> bool {
        match tokio::time::timeout(patience, self.0.changed()).await {
            Ok(Ok(())) => true,
            Err(_) => false,
            // The notifier was dropped, so no change can follow. Wait anyway, so that no caller spins.
            Ok(Err(_)) => {
                tokio::time::sleep(patience).await;
                false
            }
        }
    }
}
