//! Claims the exclusive resources of a run, and makes the preparations before it begins.

use std::{io, os::fd::BorrowedFd, rc::Rc};

use landlock::RulesetCreated;

use super::{child, file_rules, filter, group::Group, user_slot};
use crate::{
    mounts,
    sys::{self, Fork, SingleThread},
    wire::{Failure, RunOrder, failure_at},
};

/// The exclusive resources of a run on this machine. They are held until the value is dropped.
pub(super) struct ExclusiveResources {
    /// The run's own user, if it has one.
    pub(super) slot: Option<user_slot::UserSlot>,
    /// The run's control group, if it has one.
    pub(super) group: Option<Group>,
}

impl ExclusiveResources {
    /// Claims the exclusive resources that the order requires.
    pub(super) fn claim(order: &RunOrder) -> Result<Self, Failure> {
        let failed = |error: io::Error| Failure::new(format!("claim a separate user ({error})"), &error);
        let slot = order.layers.own_user.then(user_slot::claim_slot).transpose().map_err(failed)?;
        let group = order.layers.group.then(|| Group::create(order)).transpose();
        Ok(Self { slot, group: group.map_err(failure_at("make a control group"))? })
    }
}

/// Preparations that do not depend on the program. All runs that differ only in the scene and the folder share them.
#[derive(Default)]
pub(super) struct PreparedRun {
    places: Option<file_rules::AllowedPlaces>,
    pub(super) filters: Option<child::Filters>,
    ignored_signals: Option<Rc<[i32]>>,
    /// The proof that the supervisor has only one thread.
    single_thread: Option<SingleThread>,
}

impl PreparedRun {
    /// Makes the preparations for orders like `order`. Their programs have the process ID `number`. The process must
    /// have only one thread.
    pub(super) fn for_order(order: &RunOrder, number: i32, alone: SingleThread) -> Result<Self, Failure> {
        let open = || file_rules::AllowedPlaces::for_order(order).with_high_numbers();
        let purpose = child::find_purpose(order, order.layers.own_user, None, number);
        let filters = filter::compile_filters(purpose).map_err(failure_at("compile the system call filter"))?;
        let places = order.layers.landlock.then(open).flatten();
        let filters = Some(child::Filters::new((purpose, filters)));
        Ok(Self { places, filters, ignored_signals: Some(sys::ignored_signals().into()), single_thread: Some(alone) })
    }

    /// Returns the signals that the supervisor ignores.
    pub(super) fn ignored_signals(&self) -> Rc<[i32]> {
        self.ignored_signals.clone().unwrap_or_else(|| sys::ignored_signals().into())
    }

    /// Forks into new namespaces, given by the flags.
    pub(super) fn fork_into(&self, namespaces: i32) -> io::Result<Fork> {
        let single_thread = self.single_thread.as_ref().ok_or_else(|| io::Error::other("nothing is prepared"))?;
        mounts::fork_into(single_thread, namespaces)
    }

    /// Forks into the same namespaces.
    pub(super) fn fork(&self) -> io::Result<Fork> {
        self.single_thread.as_ref().map_or_else(sys::fork, sys::fork_single_threaded)
    }

    /// Builds the file rules of an order, if it has any.
    pub(super) fn build_file_rules(
        &self,
        order: &RunOrder,
        folder: BorrowedFd<'_>,
    ) -> io::Result<Option<RulesetCreated>> {
        match &self.places {
            _ if !order.layers.landlock => Ok(None),
            Some(places) => file_rules::build_ruleset(order, places, folder).map(Some),
            None => file_rules::build_ruleset(order, &file_rules::AllowedPlaces::for_order(order), folder).map(Some),
        }
    }
}
