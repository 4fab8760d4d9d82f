//! Wakes waiting tasks of this process when something changes. Notifications only save time. Without one, for example
//! after a change by another process, a task notices the change a little later.
use crate::db::{DbError, Transaction};
use std::{sync::Arc, time::Duration};
use tokio::sync::watch;

/// The notifier of this process. Clones share their subscribers.
#[derive(Debug, Clone, Default)]
pub struct Notifier {
    changes: Arc<watch::Sender<u64>>,
}

/// A task that waits for the notifier. Changes between two waits are not missed.
#[derive(Debug, Clone)]
pub struct Subscription(watch::Receiver<u64>);

impl Notifier {
    /// Commits a transaction, and wakes all subscribers.
    ///
    /// # Errors
    /// Fails if the transaction can't be committed.
    pub async fn commit(&self, transaction: Transaction) -> Result<(), DbError> {
        transaction.commit().await?;
        self.wake();
        Ok(())
    }

    /// Wakes all subscribers.
    pub fn wake(&self) {
        self.changes.send_modify(|changes| *changes += 1);
    }

    /// Returns a subscription to all later changes.
    pub fn subscribe(&self) -> Subscription {
        Subscription(self.changes.subscribe())
    }
}

impl Subscription {
    /// Waits for a change, but not longer than `max_wait`. Returns whether there was a change.
    pub async fn wait(&mut self, max_wait: Duration) -> bool {
        match tokio::time::timeout(max_wait, self.0.changed()).await {
            Ok(Ok(())) => true,
            Err(_) => false,
            // The notifier was dropped, so there will be no changes. Wait anyway, so that the caller does not loop
            // without a pause.
            Ok(Err(_)) => {
                tokio::time::sleep(max_wait).await;
                false
            }
        }
    }
}
