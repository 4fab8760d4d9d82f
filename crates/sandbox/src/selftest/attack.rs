//! Parses the first lines of an attack's source, which contain the promise and how the run should end.
//!
//! The first lines of the C file are comments of the form `// key: value`. The keys `promise` and `expect` are
//! required. The keys `policy`, `wall` (milliseconds), `needs` and `leaves` are optional.

use std::time::Duration;

use crate::{
    job::Policy,
    layers::{Layer, LayerReport, is_active},
    outcome::RunEnd,
};

/// A requirement of an attack. On a host that does not meet it, the attack proves nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct AttackRequirement {
    pub(super) name: &'static str,
    /// The layers that stop the attack. One of them is enough.
    layers: &'static [Layer],
    /// Whether the processor offers what the attack needs.
    is_met_by_processor: bool,
}

impl AttackRequirement {
    const DENIAL_REQUIREMENTS: [Self; 7] = [
        Self::new("file rules", &[Layer::FileRules]),
        // Files of the host cannot be read, or cannot be seen.
        Self::new("hidden files", &[Layer::FileRules, Layer::Namespaces]),
        // The run has mounts of its own.
        Self::new("private mounts", &[Layer::Namespaces]),
        Self::new("private processes", &[Layer::Namespaces]),
        Self::new("signal scope", &[Layer::Scopes, Layer::OwnUser]),
        Self::new("named violations", &[Layer::NamedCalls]),
        Self { name: "x86_64", layers: &[], is_met_by_processor: cfg!(target_arch = "x86_64") },
    ];

    const fn new(name: &'static str, layers: &'static [Layer]) -> Self {
        Self { name, layers, is_met_by_processor: false }
    }

    /// Returns whether a host with these layers offers what the attack needs.
    pub(super) fn is_met(self, layers: &[LayerReport]) -> bool {
        self.is_met_by_processor || self.layers.iter().any(|wall| is_active(layers, *wall))
    }
}

/// A result that the run may have.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct ExpectedEnd {
    kind: String,
    detail: Option<String>,
}

impl ExpectedEnd {
    /// Returns whether the run ended in this way.
    pub(super) fn matches(&self, end: &RunEnd) -> bool {
        let detail = match end {
            RunEnd::Exited(code) => code.to_string(),
            RunEnd::Signaled(signal) => signal.to_string(),
            // Usually the forbidden call is named. If calls cannot be named on this host, any violation is accepted.
            RunEnd::Violation { call } if call.contains("of another architecture") => return self.kind == "violation",
            RunEnd::Violation { call } => call.split(' ').next().unwrap_or_default().into(),
            _ => String::new(),
        };
        self.kind == end.kind() && self.detail.as_ref().is_none_or(|expected| *expected == detail)
    }
}

/// A hostile program that tests one promise of the sandbox.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Attack {
    pub(super) name: String,
    pub(super) promise: String,
    pub(super) expected_ends: Vec<ExpectedEnd>,
    pub(super) policy: Policy,
    pub(super) wall: Option<Duration>,
    pub(super) requirements: Vec<AttackRequirement>,
    /// The trace that the attack should leave: `nothing`, `refused`, or the text of `trace.bin`.
    pub(super) left_trace: Option<String>,
}

impl Attack {
    /// Returns whether the run must end because of a forbidden call.
    pub(super) fn expects_violation(&self) -> bool {
        self.expected_ends.iter().any(|expected| expected.kind == "violation")
    }

    /// Returns whether the run may end by itself, with an exit code.
    pub(super) fn expects_exit(&self) -> bool {
        self.expected_ends.iter().any(|expected| expected.kind == "exited")
    }

    /// Parses the first lines of an attack's source.
    pub(super) fn parse(name: &str, source: &str) -> Result<Self, String> {
        let mut attack = Self {
            name: name.into(),
            promise: String::new(),
            expected_ends: Vec::new(),
            policy: Policy::Submission,
            wall: None,
            requirements: Vec::new(),
            left_trace: None,
        };
        for line in source.lines().map_while(|line| line.strip_prefix("// ")) {
            let (key, value) = line.split_once(": ").ok_or_else(|| format!("{line:?} is not KEY: VALUE"))?;
            match key {
                "promise" => attack.promise = value.into(),
                "expect" => attack.expected_ends = value.split(" or ").map(parse_expected).collect(),
                "policy" if value == "tools" => attack.policy = Policy::Tools,
                "wall" => {
                    let milliseconds = value.parse().map_err(|_| format!("wall must be a number, not {value:?}"))?;
                    attack.wall = Some(Duration::from_millis(milliseconds));
                }
                "needs" => {
                    let need = AttackRequirement::DENIAL_REQUIREMENTS.into_iter().find(|need| need.name == value);
                    attack.requirements.push(need.ok_or_else(|| format!("unknown need: {value}"))?);
                }
                "leaves" => attack.left_trace = Some(value.into()),
                _ => return Err(format!("unknown: {line}")),
            }
        }
        if !attack.promise.ends_with('.') || attack.expected_ends.is_empty() {
            return Err("an attack needs a promise (a sentence) and an expectation".into());
        }
        Ok(attack)
    }
}

fn parse_expected(text: &str) -> ExpectedEnd {
    match text.split_once(' ') {
        Some((kind, detail)) => ExpectedEnd { kind: kind.into(), detail: Some(detail.into()) },
        None => ExpectedEnd { kind: text.into(), detail: None },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_head_is_read_up_to_the_code() {
        let text = "// promise: It holds.\n// expect: exited 0 or violation ptrace\n// policy: tools\n// wall: 300\n\
                    // needs: file rules\n// leaves: honest\n#include <x>\n// other: comment\n";
        let attack = Attack::parse("a", text).unwrap();
        assert_eq!(attack.policy, Policy::Tools);
        assert_eq!(attack.wall, Some(Duration::from_millis(300)));
        assert_eq!(attack.requirements, [AttackRequirement::DENIAL_REQUIREMENTS[0]]);
        let matches = |ended: &RunEnd| attack.expected_ends.iter().any(|expected| expected.matches(ended));
        assert!(matches(&RunEnd::Exited(0)) && !matches(&RunEnd::Exited(66)));
        assert!(matches(&RunEnd::Violation { call: "ptrace".into() }));
        assert!(!matches(&RunEnd::Violation { call: "bpf".into() }));
    }

    #[test]
    fn a_head_without_promise_is_rejected() {
        assert!(Attack::parse("a", "// expect: cpu\n").is_err());
        assert!(Attack::parse("a", "// promise: It holds.\n").is_err());
        assert!(Attack::parse("a", "// promise: It holds.\n// expect: cpu\n// nonsense: 1\n").is_err());
    }
}
