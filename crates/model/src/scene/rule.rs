//! Defines the rules of the grammar for one element.

/// The rules for one element.
#[derive(Debug)]
pub(super) struct Rule {
    pub(super) name: &'static str,
    pub(super) attributes: &'static [&'static str],
}
