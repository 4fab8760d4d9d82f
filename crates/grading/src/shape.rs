//! The shape of a suite file: its keys, and the kind of value of each.
//!
//! Finds all faults together, and removes wrong parts, so that the others can still be checked.
use super::near::closest;
use fosssim_model::assignments::Assignment;
use std::{borrow::Cow, ops::Range};
use toml::{
    Spanned,
    de::{DeTable, DeValue},
};

/// A problem and where it is, in bytes.
pub(super) type Problem = (Range<usize>, String);

/// The points that a group may have.
pub const MOST_POINTS: Range<f64> = 0.0..1e6;

/// The type of a key's value.
enum ValueKind {
    Text,
    Texts,
    /// A number in this range; if it is out of range, the message names its table first.
    Number(&'static str, Range<f64>),
    /// A whole number that is not negative.
    Whole,
    Flag,
    /// One word of these.
    Choice(&'static [&'static str]),
    Table(&'static [Key]),
    Tables(&'static [Key]),
}

/// A key: its name, its kind of value, and whether it is required.
struct Key(&'static str, ValueKind, bool);

const BUILD: &[Key] = &[
    Key("command", ValueKind::Texts, true),
    Key("program", ValueKind::Text, true),
    Key("wall_seconds", ValueKind::Number("build.", 0.01..86_400.0), false),
    Key("memory_mib", ValueKind::Number("build.", 1.0..1e6), false),
];

const LIMITS: &[Key] = &[
    Key("cpu_seconds", ValueKind::Number("", 0.01..86_400.0), false),
    Key("wall_seconds", ValueKind::Number("", 0.01..86_400.0), false),
    Key("memory_mib", ValueKind::Number("", 0.001..1e6), false),
    Key("output_mib", ValueKind::Number("", 0.001..1e6), false),
    Key("trace_mib", ValueKind::Number("", 0.001..1e6), false),
    Key("folder_mib", ValueKind::Number("", 0.001..1e6), false),
    Key("files", ValueKind::Number("", 1.0..1e6), false),
    Key("sanitizers", ValueKind::Flag, false),
    Key("time_outs", ValueKind::Number("", 0.0..1e6), false),
    Key("total_seconds", ValueKind::Number("", 0.01..86_400_000.0), false),
];

const HINTS: &[&str] = &["none", "where", "what", "full"];

/// The keys of the milestones, in the order of the course.
const MILESTONES: [&str; Assignment::ALL.len()] = {
    let mut keys = [""; Assignment::ALL.len()];
    let mut index = 0;
    while index < keys.len() {
        keys[index] = Assignment::ALL[index].key();
        index += 1;
    }
    keys
};

const GROUP: &[Key] = &[
    Key("name", ValueKind::Text, true),
    Key("scenes", ValueKind::Texts, true),
    Key("points", ValueKind::Number("", MOST_POINTS), false),
    Key("extra", ValueKind::Flag, false),
    Key("credit", ValueKind::Choice(&["scenes", "steps", "all"]), false),
    Key("visibility", ValueKind::Choice(&["visible", "hidden", "after_due_date", "after_published"]), false),
    Key("hints", ValueKind::Choice(HINTS), false),
    Key("text", ValueKind::Text, false),
    Key("link", ValueKind::Text, false),
    Key("speed", ValueKind::Table(SPEED), false),
];

const MISTAKE: &[Key] = &[
    Key("key", ValueKind::Text, true),
    Key("text", ValueKind::Text, false),
    Key("link", ValueKind::Text, false),
    Key("points", ValueKind::Number("mistake.", MOST_POINTS), false),
];

const SPEED: &[Key] = &[
    Key("points", ValueKind::Number("speed.", MOST_POINTS), true),
    Key("full_at", ValueKind::Number("speed.", 0.001..1e6), false),
    Key("none_at", ValueKind::Number("speed.", 0.001..1e6), false),
    Key("second", ValueKind::Number("speed.", 0.001..1e4), false),
    Key("runs", ValueKind::Number("speed.", 1.0..101.0), false),
];

const SUITE: &[Key] = &[
    Key("schema", ValueKind::Whole, true),
    Key("name", ValueKind::Text, true),
    Key("milestone", ValueKind::Choice(&MILESTONES), false),
    Key("rules", ValueKind::Choice(&["parity", "fair", "both"]), false),
    Key("hints", ValueKind::Choice(HINTS), false),
    Key("show_output", ValueKind::Flag, false),
    Key("run", ValueKind::Texts, false),
    Key("build", ValueKind::Table(BUILD), false),
    Key("limits", ValueKind::Table(LIMITS), false),
    Key("mistake", ValueKind::Tables(MISTAKE), false),
    Key("group", ValueKind::Tables(GROUP), false),
];

/// The tables to which a misplaced key may belong.
const PLACES: [(&str, &[Key]); 6] = [
    ("[limits]", LIMITS),
    ("[build]", BUILD),
    ("a [[group]]", GROUP),
    ("[group.speed]", SPEED),
    ("a [[mistake]]", MISTAKE),
    ("the top of the file", SUITE),
];

/// Returns the table without its faulty parts, all faults, and whether every line could be read.
pub(super) fn checked(text: &str) -> (Spanned<DeTable<'_>>, Vec<Problem>, bool) {
    let (mut table, errors) = DeTable::parse_recoverable(text);
    let mut problems: Vec<Problem> =
        errors.iter().map(|error| (error.span().unwrap_or(0..0), error.message().trim().replace('\n', " "))).collect();
    let is_readable = problems.is_empty();
    if is_readable {
        clean(table.get_mut(), SUITE, "the suite", 0..0, &mut problems);
    } else {
        // Nobody knows the meaning of a broken line.
        table.get_mut().clear();
    }
    (table, problems, is_readable)
}

/// Takes out of a table what does not belong there.
fn clean(table: &mut DeTable<'_>, keys: &[Key], place: &str, at: Range<usize>, problems: &mut Vec<Problem>) {
    for Key(name, _, required) in keys {
        // A misspelt key is reported at its place.
        let meant = |key: &Spanned<Cow<'_, str>>| {
            key.get_ref() == name || closest(key.get_ref(), keys.iter().map(|Key(name, ..)| *name)) == Some(name)
        };
        if *required && !table.keys().any(meant) {
            problems.push((at.clone(), format!("{place} has no `{name}`")));
        }
    }
    let entries = std::mem::take(table).into_iter().filter_map(|(key, mut value)| {
        let fits = match keys.iter().find(|Key(name, ..)| key.get_ref() == name) {
            Some(Key(name, kind, _)) => fits(name, kind, &mut value, problems),
            None => {
                problems.push((key.span(), unknown(key.get_ref(), keys, place)));
                false
            }
        };
        fits.then_some((key, value))
    });
    *table = entries.collect();
}

/// Returns whether a value is of its kind.
fn fits(name: &str, kind: &ValueKind, value: &mut Spanned<DeValue<'_>>, problems: &mut Vec<Problem>) -> bool {
    let at = value.span();
    let is = value.get_ref().type_str();
    let mut wrong = |wanted: &str| {
        problems.push((at.clone(), format!("{name} must be {wanted}, not {}", article(is))));
        false
    };
    match (kind, value.get_mut()) {
        (ValueKind::Text, DeValue::String(_)) | (ValueKind::Flag, DeValue::Boolean(_)) => true,
        (ValueKind::Number(table, range), given @ (DeValue::Float(_) | DeValue::Integer(_))) => {
            let number = number(given).filter(|number| !range.contains(number));
            if let Some(number) = number {
                let Range { start, end } = range;
                problems.push((at, format!("{table}{name} is {number}: it must be between {start} and {end}")));
            }
            number.is_none()
        }
        (ValueKind::Whole, DeValue::Integer(number)) if number.as_str().parse::<u32>().is_ok() => true,
        (ValueKind::Choice(words), DeValue::String(word)) => {
            let known = words.contains(&word.as_ref());
            if !known {
                problems.push((at, not_among(name, word, words)));
            }
            known
        }
        (ValueKind::Texts, DeValue::Array(list)) => {
            let before = problems.len();
            for item in list.iter().filter(|item| !item.get_ref().is_str()) {
                let is = article(item.get_ref().type_str());
                problems.push((item.span(), format!("each of {name} must be a text in quotes, not {is}")));
            }
            problems.len() == before
        }
        (ValueKind::Table(keys), DeValue::Table(table)) => {
            clean(table, keys, &format!("[{name}]"), at, problems);
            true
        }
        (ValueKind::Tables(keys), DeValue::Array(list)) if list.iter().all(|item| item.get_ref().is_table()) => {
            for item in list.iter_mut() {
                let at = item.span();
                if let DeValue::Table(table) = item.get_mut() {
                    clean(table, keys, &format!("this [[{name}]]"), at, problems);
                }
            }
            true
        }
        (ValueKind::Text, _) => wrong("a text in quotes"),
        (ValueKind::Texts, _) => wrong("a list of texts, [\"...\"]"),
        (ValueKind::Number(..), _) => wrong("a number"),
        (ValueKind::Whole, _) => wrong("a whole number that is not negative"),
        (ValueKind::Flag, _) => wrong("true or false"),
        (ValueKind::Choice(words), _) => wrong(&format!("one of {}", list_words(words, "or"))),
        (ValueKind::Table(_), _) => wrong(&format!("a table, [{name}]")),
        (ValueKind::Tables(_), _) => wrong(&format!("a list of tables, [[{name}]]")),
    }
}

/// Returns a number's value, rounded if it is long; none for a hexadecimal number, which no reader accepts.
fn number(value: &DeValue<'_>) -> Option<f64> {
    match value {
        DeValue::Float(number) => number.as_str().parse().ok(),
        DeValue::Integer(number) if number.radix() == 10 => number.as_str().parse().ok(),
        #[expect(clippy::cast_precision_loss, reason = "what is large is out of every range")]
        DeValue::Integer(number) => Some(i64::from_str_radix(number.as_str(), number.radix()).ok()? as f64),
        _ => None,
    }
}

/// Returns `an integer`, `a string`.
fn article(kind: &str) -> String {
    format!("{} {kind}", if kind.starts_with(['a', 'e', 'i', 'o', 'u']) { "an" } else { "a" })
}

/// Returns the message for a word that is not in the list.
fn not_among(name: &str, word: &str, words: &[&str]) -> String {
    let hint = closest(word, words.iter().copied()).map(|word| format!("; did you mean \"{word}\"?"));
    format!("{name} \"{word}\" is not known: there are {}{}", list_words(words, "and"), hint.unwrap_or_default())
}

/// Returns `"a", "b" and "c"`.
fn list_words(words: &[&str], last: &str) -> String {
    let quoted: Vec<String> = words.iter().map(|word| format!("\"{word}\"")).collect();
    match &quoted[..] {
        [rest @ .., one] if !rest.is_empty() => format!("{} {last} {one}", rest.join(", ")),
        _ => quoted.join(", "),
    }
}

/// Returns the message for a key that does not belong here.
fn unknown(key: &str, keys: &[Key], place: &str) -> String {
    let names = |keys: &'static [Key]| keys.iter().map(|Key(name, ..)| *name);
    let here = keys.iter().map(|Key(name, ..)| *name);
    let hint = match closest(key, here.clone()) {
        Some(name) => format!("did you mean `{name}`?"),
        None => match PLACES.iter().find(|(_, other)| names(other).any(|name| name == key)) {
            Some((other, _)) => format!("it belongs in {other}"),
            None => format!("there are {}", here.collect::<Vec<_>>().join(", ")),
        },
    };
    format!("unknown key `{key}` in {place}: {hint}")
}
