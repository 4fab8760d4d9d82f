//! Commands whose parsers are made when they are called.
use clap::{
    ArgMatches, Args, Command, Error, FromArgMatches, Subcommand,
    builder::{Resettable, StyledStr},
};
use std::{cell::Cell, ops::Deref};

/// The arguments of a command, which the parser of the whole learns of only when that command is called: to make the
/// parsers of all takes longer than what many commands do.
#[derive(Debug)]
pub(super) struct Later<T>(T);

impl<T> Deref for Later<T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.0
    }
}

impl<T: FromArgMatches> FromArgMatches for Later<T> {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, Error> {
        T::from_arg_matches(matches).map(Self)
    }

    fn from_arg_matches_mut(matches: &mut ArgMatches) -> Result<Self, Error> {
        T::from_arg_matches_mut(matches).map(Self)
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), Error> {
        self.0.update_from_arg_matches(matches)
    }
}

impl<T: Args> Args for Later<T> {
    fn augment_args(command: Command) -> Command {
        later(command, |command| described(command, T::augment_args))
    }

    fn augment_args_for_update(command: Command) -> Command {
        later(command, |command| described(command, T::augment_args_for_update))
    }
}

impl<T: Subcommand> Subcommand for Later<T> {
    fn augment_subcommands(command: Command) -> Command {
        later(command, |command| described(command, T::augment_subcommands))
    }

    fn augment_subcommands_for_update(command: Command) -> Command {
        later(command, |command| described(command, T::augment_subcommands_for_update))
    }

    fn has_subcommand(name: &str) -> bool {
        T::has_subcommand(name)
    }
}

/// Adds to a command when it is called, or at once.
fn later(command: Command, add: fn(Command) -> Command) -> Command {
    if AT_ONCE.get() { add(command) } else { command.defer(add) }
}

/// Adds to a command, and leaves the description that it has: arguments that several commands have in common bring
/// their own.
fn described(command: Command, add: fn(Command) -> Command) -> Command {
    let (about, long) = (command.get_about().cloned(), command.get_long_about().cloned());
    let resettable = |text: Option<StyledStr>| text.map_or(Resettable::Reset, Resettable::Value);
    add(command).about(resettable(about)).long_about(resettable(long))
}

thread_local! {
    static AT_ONCE: Cell<bool> = const { Cell::new(false) };
}

/// Makes a parser with all that belongs to its commands, for who shows it: pages and completions tell of all commands.
pub(super) fn at_once(make: fn() -> Command) -> Command {
    AT_ONCE.set(true);
    let made = make();
    AT_ONCE.set(false);
    made
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::arguments::Arguments;
    use clap::CommandFactory;

    fn assert_alike(late: &mut Command, whole: &mut Command) {
        let name = whole.get_name().to_owned();
        assert_eq!(late.render_long_help().to_string(), whole.render_long_help().to_string(), "{name}");
        assert_eq!(late.get_about().map(ToString::to_string), whole.get_about().map(ToString::to_string), "{name}");
        let names = |command: &Command| {
            let names = command.get_subcommands().map(Command::get_name).filter(|name| *name != "help");
            names.map(str::to_owned).collect::<Vec<_>>()
        };
        assert_eq!(names(late), names(whole));
        for name in names(whole) {
            let inner = |command: &mut Command| command.find_subcommand_mut(&name).expect("its name").clone();
            assert_alike(&mut inner(late), &mut inner(whole));
        }
    }

    #[test]
    fn parsers_that_are_made_later_say_what_they_say_when_made_at_once() {
        let (mut late, mut whole) = (Arguments::command(), at_once(Arguments::command));
        assert!(late.find_subcommand("trace").expect("a command").get_subcommands().next().is_none(), "not made yet");
        assert!(whole.find_subcommand("trace").expect("a command").get_subcommands().next().is_some());
        late.build();
        whole.build();
        assert_alike(&mut late, &mut whole);
    }
}
