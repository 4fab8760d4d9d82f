//! Kills the processes that a supervisor may have left behind when it was lost.

use std::time::Duration;

use super::{
    processes::{find_by_session, find_by_user, stop_then_kill},
    user_slot,
};

/// Kills the processes that a lost supervisor may have left behind. These are the processes in its child's session, and
/// those of the child's own user. If there was a process namespace, its processes were killed with it, and its session
/// IDs are not valid here.
pub(crate) fn kill_orphans(session: Option<i32>, user: Option<u32>) {
    const MAX_ATTEMPTS: u32 = 1000;
    // The lock on the user ended with the supervisor, so another run may already have this user.
    let slot = user.and_then(user_slot::reclaim_slot);
    let user = slot.as_ref().map(|slot| slot.user);
    for _ in 0..MAX_ATTEMPTS {
        let victims = stop_then_kill(|| {
            let mut victims = session.map(find_by_session).unwrap_or_default();
            victims.extend(user.into_iter().flat_map(find_by_user));
            victims
        });
        if victims.is_empty() {
            return;
        }
        std::thread::sleep(Duration::from_millis(1));
    }
}
