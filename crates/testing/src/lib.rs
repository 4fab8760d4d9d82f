//! The features of a machine that tests need, and the message if one is missing. Only tests use this crate.
//!
//! A test that cannot run calls [`skip`] and returns. This adds a line to a list, which `cargo test` prints at its end
//! (by the test `skips` of this crate, which comes last because of the crate's name). If `FOSSSIM_REQUIRE` names the
//! need, or is `all`, the test fails instead, so a machine that has something can never pass without it.
#![forbid(unsafe_code)]

pub mod scenes;

use std::{fmt, fs, io::Write, path::PathBuf};

/// The environment variable that lists the needs whose absence makes a test fail, separated by commas.
pub const REQUIRE: &str = "FOSSSIM_REQUIRE";

/// The environment variable that names the file of the list. Without this variable, each run of `cargo test` has its
/// own file.
pub const LIST: &str = "FOSSSIM_SKIPS";

/// Something that not every machine has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Need {
    /// The ground-truth corpus next to the checkout.
    Corpus,
    /// The course's original programs next to the checkout.
    Originals,
    /// A kernel that can run programs safely.
    Sandbox,
    /// Namespaces, control groups and other layers of protection that only some hosts have, and the right to run
    /// without some of them.
    Walls,
    /// A C compiler, `cc`.
    Cc,
    /// A C++ compiler, `c++`.
    Cxx,
    /// `make`.
    Make,
    /// `python3`.
    Python,
    /// `xmllint`.
    Xmllint,
    /// `setpriv`, and the right to use it.
    Setpriv,
    /// The shell `bash`.
    Bash,
    /// The shell `zsh`.
    Zsh,
    /// The shell `fish`.
    Fish,
    /// PostgreSQL's server, `/usr/lib/postgresql/*/bin`.
    Postgres,
    /// `pgbouncer`.
    Pgbouncer,
    /// `systemd-analyze`.
    Systemd,
    /// Python's `yaml`.
    Yaml,
    /// Python's `chevron`.
    Chevron,
    /// The program `moto_server`, which behaves like S3.
    Moto,
    /// The right to mount a file system.
    Mounts,
}

/// All needs with their names in `FOSSSIM_REQUIRE`.
const NAMES: [(Need, &str); 20] = [
    (Need::Corpus, "corpus"),
    (Need::Originals, "originals"),
    (Need::Sandbox, "sandbox"),
    (Need::Walls, "walls"),
    (Need::Cc, "cc"),
    (Need::Cxx, "c++"),
    (Need::Make, "make"),
    (Need::Python, "python3"),
    (Need::Xmllint, "xmllint"),
    (Need::Setpriv, "setpriv"),
    (Need::Bash, "bash"),
    (Need::Zsh, "zsh"),
    (Need::Fish, "fish"),
    (Need::Postgres, "postgres"),
    (Need::Pgbouncer, "pgbouncer"),
    (Need::Systemd, "systemd"),
    (Need::Yaml, "yaml"),
    (Need::Chevron, "chevron"),
    (Need::Moto, "moto"),
    (Need::Mounts, "mounts"),
];

impl Need {
    /// Returns the need's name in `FOSSSIM_REQUIRE`.
    pub fn name(self) -> &'static str {
        NAMES.iter().find(|(need, _)| *need == self).map_or("", |(_, name)| name)
    }
}

impl fmt::Display for Need {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(self.name())
    }
}

/// Reports that the calling test cannot run, and why; the test then returns.
///
/// # Panics
/// Panics if `FOSSSIM_REQUIRE` names the need, or contains an unknown word.
pub fn skip(need: Need, reason: impl fmt::Display) {
    let reason = reason.to_string().replace(['\n', '\t'], " ");
    let required = std::env::var(REQUIRE).unwrap_or_default();
    if let Err(message) = check_allowed(need, &required) {
        panic!("{message}: {reason}");
    }
    let test = std::thread::current().name().unwrap_or("a test").to_owned();
    eprintln!("skipped {test}: {reason}");
    let Some(list) = skip_list() else { return };
    // Each line is one write, because the tests of one run are threads and processes.
    let line = format!("{need}\t{test}\t{reason}\n");
    let file = fs::OpenOptions::new().create(true).append(true).open(list);
    drop(file.and_then(|mut file| file.write_all(line.as_bytes())));
}

/// Returns an error if `FOSSSIM_REQUIRE` forbids that a test is skipped for want of `need`.
fn check_allowed(need: Need, required: &str) -> Result<(), String> {
    for name in required.split(',').map(str::trim).filter(|name| !name.is_empty()) {
        if name == "all" || name == need.name() {
            return Err(format!("{REQUIRE} asks for {need}, and it is not here"));
        }
        if !NAMES.iter().any(|(_, known)| *known == name) {
            let known = NAMES.map(|(_, known)| known).join(", ");
            return Err(format!("{REQUIRE} asks for `{name}`; the known words are all, {known}"));
        }
    }
    Ok(())
}

/// Returns the path of this run's list, or `None` if there is no list. Its name contains the ID of cargo, which is the
/// parent process of the tests and of the summary. Other runners print no summary, and have a list only if the variable
/// is set.
pub fn skip_list() -> Option<PathBuf> {
    if let Some(list) = std::env::var_os(LIST) {
        return Some(list.into());
    }
    let runs_by_cargo = std::env::var_os("CARGO").is_some() && std::env::var_os("NEXTEST").is_none();
    runs_by_cargo.then(|| std::env::temp_dir().join(format!("fosssim-skips-{}", std::os::unix::process::parent_id())))
}

/// Returns a summary of the list: for each need, the tests that were skipped, and the first reason.
pub fn summary(list: &str) -> String {
    let mut lines = String::new();
    let mut total = 0;
    for (_, need) in NAMES {
        let skips: Vec<(&str, &str)> =
            list.lines().filter_map(|line| line.strip_prefix(need)?.strip_prefix('\t')?.split_once('\t')).collect();
        let mut tests: Vec<&str> = skips.iter().map(|(test, _)| *test).collect();
        tests.sort_unstable();
        tests.dedup();
        if let Some((_, reason)) = skips.first() {
            total += tests.len();
            lines += &format!("  {need}: {} ({reason})\n", tests.join(", "));
        }
    }
    match total {
        0 => "no test was skipped\n".to_owned(),
        1 => format!("1 test was skipped, for want of:\n{lines}"),
        total => format!("{total} tests were skipped, for want of:\n{lines}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn required_tests_may_not_be_skipped() {
        assert_eq!(check_allowed(Need::Corpus, ""), Ok(()));
        assert_eq!(check_allowed(Need::Corpus, "sandbox, cc"), Ok(()));
        assert!(check_allowed(Need::Corpus, "sandbox,corpus").is_err());
        assert!(check_allowed(Need::Corpus, "all").is_err());
        let error = check_allowed(Need::Corpus, "sandobx").expect_err("no need");
        assert!(error.contains("`sandobx`") && error.contains("sandbox"), "{error}");
    }

    #[test]
    fn the_list_is_grouped_by_need() {
        let list = "cc\ta::one\tno cc\ncorpus\tb::two\tnothing at x\ncc\ta::three\tno cc\ncc\ta::one\tno cc\n";
        assert_eq!(
            summary(list),
            "3 tests were skipped, for want of:\n  corpus: b::two (nothing at x)\n  cc: a::one, a::three (no cc)\n"
        );
        assert_eq!(summary(""), "no test was skipped\n");
    }
}
