//! The shape of a suite file: its keys, and the type of each value.
//!
//! All errors are reported together. Wrong parts are removed, so that the rest can still be checked.
use super::suggestions::find_closest;
use fosssim_findings::{Hints, Visibility};
use fosssim_judge::Rules;
use fosssim_model::assignments::Assignment;
use serde::{Deserialize, Serialize};
use std::{borrow::Cow, ops::Range};
use toml::{
    Spanned,
    de::{DeTable, DeValue},
};

/// A problem, and the range of bytes in the file that it is about.
pub(super) type Problem = (Range<usize>, String);

/// The range in which a group's points must be.
pub const POINTS_RANGE: Range<f64> = 0.0..1e6;

/// The rule for partial success within a group.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Credit {
    /// The group gets the share of its points that corresponds to the share of accepted scenes.
    Scenes,
    /// A scene that is not accepted still gets the share of its points that corresponds to its steps without a finding.
    Steps,
    /// The group gets points only if all scenes are accepted.
    All,
}

/// The type that the value of a key must have.
enum ValueKind {
    Text,
    TextList,
    /// A number in a range. The string is the name of the table, for messages about numbers out of range.
    Number(&'static str, Range<f64>),
    /// A whole number that is at least 0.
    WholeNumber,
    Flag,
    /// One of several words.
    Choice(&'static [&'static str]),
    Table(&'static [TableKey]),
    Tables(&'static [TableKey]),
}

/// A key: its name, the type of its value, and whether the key is required.
struct TableKey(&'static str, ValueKind, bool);

const HINT_NAMES: &[&str] = &["none", "where", "what", "full"];

/// The names of the milestones, in the order of the course.
const MILESTONE_NAMES: [&str; Assignment::ALL.len()] = {
    let mut keys = [""; Assignment::ALL.len()];
    let mut index = 0;
    while index < keys.len() {
        keys[index] = Assignment::ALL[index].key();
        index += 1;
    }
    keys
};

/// Declares the tables of the file. Each has its keys, and a struct into which the table is read after its keys and
/// their types have been checked.
macro_rules! tables {
    ($($raw:ident $keys:ident { $($key:ident: $value:ty = $kind:expr, $is_required:literal;)+ })+) => {
        $(
            #[derive(Deserialize, Default)]
            pub(super) struct $raw { $(pub(super) $key: Option<$value>,)+ }

            const $keys: &[TableKey] = &[$(TableKey(stringify!($key), $kind, $is_required)),+];
        )+
    };
}

tables! {
    RawBuild BUILD {
        command: Vec<String> = ValueKind::TextList, true;
        program: String = ValueKind::Text, true;
        wall_seconds: f64 = ValueKind::Number("build.", 0.01..86_400.0), false;
        memory_mib: f64 = ValueKind::Number("build.", 1.0..1e6), false;
    }
    RawLimits LIMITS {
        cpu_seconds: f64 = ValueKind::Number("", 0.01..86_400.0), false;
        wall_seconds: f64 = ValueKind::Number("", 0.01..86_400.0), false;
        memory_mib: f64 = ValueKind::Number("", 0.001..1e6), false;
        output_mib: f64 = ValueKind::Number("", 0.001..1e6), false;
        trace_mib: f64 = ValueKind::Number("", 0.001..1e6), false;
        folder_mib: f64 = ValueKind::Number("", 0.001..1e6), false;
        files: f64 = ValueKind::Number("", 1.0..1e6), false;
        sanitizers: bool = ValueKind::Flag, false;
        time_outs: f64 = ValueKind::Number("", 0.0..1e6), false;
        total_seconds: f64 = ValueKind::Number("", 0.01..86_400_000.0), false;
    }
    RawGroup GROUP {
        name: Spanned<String> = ValueKind::Text, true;
        scenes: Spanned<Vec<Spanned<String>>> = ValueKind::TextList, true;
        points: f64 = ValueKind::Number("", POINTS_RANGE), false;
        extra: bool = ValueKind::Flag, false;
        credit: Credit = ValueKind::Choice(&["scenes", "steps", "all"]), false;
        visibility: Visibility = ValueKind::Choice(&["visible", "hidden", "after_due_date", "after_published"]), false;
        hints: Hints = ValueKind::Choice(HINT_NAMES), false;
        text: String = ValueKind::Text, false;
        link: Spanned<String> = ValueKind::Text, false;
        speed: Spanned<RawSpeed> = ValueKind::Table(SPEED), false;
    }
    RawMistake MISTAKE {
        key: Spanned<String> = ValueKind::Text, true;
        text: String = ValueKind::Text, false;
        link: Spanned<String> = ValueKind::Text, false;
        points: f64 = ValueKind::Number("mistake.", POINTS_RANGE), false;
    }
    RawSpeed SPEED {
        points: f64 = ValueKind::Number("speed.", POINTS_RANGE), true;
        full_at: f64 = ValueKind::Number("speed.", 0.001..1e6), false;
        none_at: f64 = ValueKind::Number("speed.", 0.001..1e6), false;
        second: f64 = ValueKind::Number("speed.", 0.001..1e4), false;
        runs: f64 = ValueKind::Number("speed.", 1.0..101.0), false;
    }
    RawSuite SUITE {
        schema: Spanned<u32> = ValueKind::WholeNumber, true;
        name: Spanned<String> = ValueKind::Text, true;
        milestone: String = ValueKind::Choice(&MILESTONE_NAMES), false;
        rules: Rules = ValueKind::Choice(&["parity", "fair", "both"]), false;
        hints: Hints = ValueKind::Choice(HINT_NAMES), false;
        show_output: bool = ValueKind::Flag, false;
        run: Spanned<Vec<String>> = ValueKind::TextList, false;
        build: Spanned<RawBuild> = ValueKind::Table(BUILD), false;
        limits: RawLimits = ValueKind::Table(LIMITS), false;
        mistake: Vec<RawMistake> = ValueKind::Tables(MISTAKE), false;
        group: Vec<Spanned<RawGroup>> = ValueKind::Tables(GROUP), false;
    }
}

/// The tables to which a key in a wrong table may belong.
const TABLE_KEYS: [(&str, &[TableKey]); 6] = [
    ("[limits]", LIMITS),
    ("[build]", BUILD),
    ("a [[group]]", GROUP),
    ("[group.speed]", SPEED),
    ("a [[mistake]]", MISTAKE),
    ("the top of the file", SUITE),
];

/// Returns the table without its wrong parts, all problems, and whether every line could be parsed.
pub(super) fn check_shape(text: &str) -> (Spanned<DeTable<'_>>, Vec<Problem>, bool) {
    let (mut table, errors) = DeTable::parse_recoverable(text);
    let mut problems: Vec<Problem> =
        errors.iter().map(|error| (error.span().unwrap_or(0..0), error.message().trim().replace('\n', " "))).collect();
    let is_readable = problems.is_empty();
    if is_readable {
        remove_unknown(table.get_mut(), SUITE, "the suite", 0..0, &mut problems);
    } else {
        // If a line cannot be parsed, it may contain any key, so nothing else is checked.
        table.get_mut().clear();
    }
    (table, problems, is_readable)
}

/// Removes unknown keys and values of wrong types from a table, and reports them.
fn remove_unknown(
    table: &mut DeTable<'_>,
    keys: &[TableKey],
    place: &str,
    at: Range<usize>,
    problems: &mut Vec<Problem>,
) {
    for TableKey(name, _, required) in keys {
        // A missing key may be a misspelled one, which has already been reported.
        let is_this_key = |key: &Spanned<Cow<'_, str>>| {
            key.get_ref() == name
                || find_closest(key.get_ref(), keys.iter().map(|TableKey(name, ..)| *name)) == Some(name)
        };
        if *required && !table.keys().any(is_this_key) {
            problems.push((at.clone(), format!("{place} has no `{name}`")));
        }
    }
    let entries = std::mem::take(table).into_iter().filter_map(|(key, mut value)| {
        let is_valid = match keys.iter().find(|TableKey(name, ..)| key.get_ref() == name) {
            Some(TableKey(name, kind, _)) => has_type(name, kind, &mut value, problems),
            None => {
                problems.push((key.span(), describe_unknown(key.get_ref(), keys, place)));
                false
            }
        };
        is_valid.then_some((key, value))
    });
    *table = entries.collect();
}

/// Returns whether a value has the given type. If it does not, a problem is reported. Wrong parts of a table are
/// removed.
fn has_type(name: &str, kind: &ValueKind, value: &mut Spanned<DeValue<'_>>, problems: &mut Vec<Problem>) -> bool {
    let at = value.span();
    let actual_type = value.get_ref().type_str();
    let mut wrong = |wanted: &str| {
        problems.push((at.clone(), format!("{name} must be {wanted}, not {}", with_article(actual_type))));
        false
    };
    match (kind, value.get_mut()) {
        (ValueKind::Text, DeValue::String(_)) | (ValueKind::Flag, DeValue::Boolean(_)) => true,
        (ValueKind::Number(table, range), given @ (DeValue::Float(_) | DeValue::Integer(_))) => {
            let number = read_number(given).filter(|number| !range.contains(number));
            if let Some(number) = number {
                let Range { start, end } = range;
                problems.push((at, format!("{table}{name} is {number}: it must be between {start} and {end}")));
            }
            number.is_none()
        }
        (ValueKind::WholeNumber, DeValue::Integer(number)) if number.as_str().parse::<u32>().is_ok() => true,
        (ValueKind::Choice(words), DeValue::String(word)) => {
            let is_choice = words.contains(&word.as_ref());
            if !is_choice {
                problems.push((at, describe_choices(name, word, words)));
            }
            is_choice
        }
        (ValueKind::TextList, DeValue::Array(list)) => {
            let count_before = problems.len();
            for item in list.iter().filter(|item| !item.get_ref().is_str()) {
                let actual_type = with_article(item.get_ref().type_str());
                problems.push((item.span(), format!("each of {name} must be a text in quotes, not {actual_type}")));
            }
            problems.len() == count_before
        }
        (ValueKind::Table(keys), DeValue::Table(table)) => {
            remove_unknown(table, keys, &format!("[{name}]"), at, problems);
            true
        }
        (ValueKind::Tables(keys), DeValue::Array(list)) if list.iter().all(|item| item.get_ref().is_table()) => {
            for item in list.iter_mut() {
                let at = item.span();
                if let DeValue::Table(table) = item.get_mut() {
                    remove_unknown(table, keys, &format!("this [[{name}]]"), at, problems);
                }
            }
            true
        }
        (ValueKind::Text, _) => wrong("a text in quotes"),
        (ValueKind::TextList, _) => wrong("a list of texts, [\"...\"]"),
        (ValueKind::Number(..), _) => wrong("a number"),
        (ValueKind::WholeNumber, _) => wrong("a whole number that is not negative"),
        (ValueKind::Flag, _) => wrong("true or false"),
        (ValueKind::Choice(words), _) => wrong(&format!("one of {}", list_words(words, "or"))),
        (ValueKind::Table(_), _) => wrong(&format!("a table, [{name}]")),
        (ValueKind::Tables(_), _) => wrong(&format!("a list of tables, [[{name}]]")),
    }
}

/// Returns the value of a number, rounded if it has many digits; `None` for a hexadecimal number, which no reader
/// accepts.
fn read_number(value: &DeValue<'_>) -> Option<f64> {
    match value {
        DeValue::Float(number) => number.as_str().parse().ok(),
        DeValue::Integer(number) if number.radix() == 10 => number.as_str().parse().ok(),
        #[expect(clippy::cast_precision_loss, reason = "a large value is out of every range")]
        DeValue::Integer(number) => Some(i64::from_str_radix(number.as_str(), number.radix()).ok()? as f64),
        _ => None,
    }
}

/// Returns the name of a type with its article, such as `an integer`.
fn with_article(kind: &str) -> String {
    format!("{} {kind}", if kind.starts_with(['a', 'e', 'i', 'o', 'u']) { "an" } else { "a" })
}

/// Returns the message about a word that is not one of the allowed words.
fn describe_choices(name: &str, word: &str, words: &[&str]) -> String {
    let hint = find_closest(word, words.iter().copied()).map(|word| format!("; did you mean \"{word}\"?"));
    format!("{name} \"{word}\" is unknown; choose {}{}", list_words(words, "or"), hint.unwrap_or_default())
}

/// Joins words into a list, such as `"a", "b" and "c"`. `last` is the word before the last entry.
fn list_words(words: &[&str], last: &str) -> String {
    let quoted: Vec<String> = words.iter().map(|word| format!("\"{word}\"")).collect();
    match &quoted[..] {
        [rest @ .., one] if !rest.is_empty() => format!("{} {last} {one}", rest.join(", ")),
        _ => quoted.join(", "),
    }
}

/// Returns the message about an unknown key in a table.
fn describe_unknown(key: &str, keys: &[TableKey], place: &str) -> String {
    let names = |keys: &'static [TableKey]| keys.iter().map(|TableKey(name, ..)| *name);
    let own_keys = keys.iter().map(|TableKey(name, ..)| *name);
    let hint = match find_closest(key, own_keys.clone()) {
        Some(name) => format!("did you mean `{name}`?"),
        None => match TABLE_KEYS.iter().find(|(_, other)| names(other).any(|name| name == key)) {
            Some((other, _)) => format!("it belongs in {other}"),
            None => format!("the keys are {}", own_keys.collect::<Vec<_>>().join(", ")),
        },
    };
    format!("unknown key `{key}` in {place}: {hint}")
}
