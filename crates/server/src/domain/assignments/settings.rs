//! The settings of an assignment.
use crate::domain::assignments::suites::{Suites, is_file_name};
use crate::{
    calendar,
    db::DbError,
    late_policy::LatePolicy,
    problem::{Problem, ensure, format_size},
    store::Digest,
    task::{Form, Input, Suite, Task},
};
use chrono_tz::{TZ_VARIANTS, Tz};
use serde::{Deserialize, Deserializer, Serialize, de::Error};
use serde_json::{Map, Value};
use std::{collections::BTreeSet, ops::RangeInclusive};
use utoipa::{
    ToSchema,
    openapi::{KnownFormat, ObjectBuilder, OneOfBuilder, Schema, SchemaFormat, Type},
};

/// The rules for uploads to an assignment, and for grading them.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Settings {
    /// The name of a suite of the grader, such as `t2m2`. An empty name means the grader's default suite. An uploaded
    /// suite has precedence.
    #[schema(pattern = "^([A-Za-z0-9_][A-Za-z0-9._-]*(@[A-Za-z0-9_][A-Za-z0-9._-]*)?)?$", max_length = 100)]
    pub suite: String,
    /// The digest of an uploaded archive with a `suite.toml`. The archive is uploaded by a separate request.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(value_type = Option<crate::schema::Digest>)]
    pub suite_archive: Option<String>,
    /// The rule books by which traces are judged: `parity`, `fair` or `both`. With null, the suite chooses.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(pattern = "^(parity|fair|both)$")]
    pub rules: Option<String>,
    /// The level of detail in reports for students: `none`, `where`, `what` or `full`. With null, the suite chooses.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(pattern = "^(none|where|what|full)$")]
    pub hints: Option<String>,
    /// Whether reports show the smallest scenes on which a program is still wrong.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub smallest: bool,
    /// The accepted forms of submissions: `program`, `sources`, `traces`.
    #[schema(value_type = Vec<Form>, min_items = 1)]
    pub forms: Vec<String>,
    /// The name of the executable that a submission of sources builds.
    #[schema(value_type = crate::schema::FileName)]
    pub program: String,
    /// The number of seconds after which a grading is stopped, at most 3600. The results until then count.
    #[schema(minimum = 1, maximum = 3600)]
    pub seconds: u64,
    /// The maximum size of an upload, in bytes, at most a gigabyte.
    #[schema(minimum = 1, maximum = 1_073_741_824)]
    pub max_bytes: u64,
    /// The maximum number of submissions per student. With 0 there is no limit.
    #[schema(maximum = 4_294_967_295_i64)]
    pub attempts: u32,
    /// The maximum number of submissions per student within an hour. With 0 there is no limit.
    #[schema(maximum = 4_294_967_295_i64)]
    pub per_hour: u32,
    /// The due date, in milliseconds since 1970, or as a date with its time zone (ISO 8601). Students cannot submit
    /// later than `late_days` after it.
    #[serde(skip_serializing_if = "Option::is_none", deserialize_with = "read_moment")]
    #[schema(schema_with = time_schema)]
    pub due_at: Option<i64>,
    /// The number of days after the due date in which uploads are still accepted, with a deduction.
    #[schema(maximum = 365)]
    pub late_days: u32,
    /// The percentage of the grader's points that a submission loses for each started day after the due date.
    #[schema(maximum = 100)]
    pub late_percent: u32,
    /// The time zone whose calendar ends late days, such as `Europe/Berlin`; null for days of 24 hours.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(schema_with = zone_schema)]
    pub time_zone: Option<Tz>,
}

/// The settings that cannot be null.
const REQUIRED_SETTINGS: [&str; 9] =
    ["suite", "forms", "program", "seconds", "max_bytes", "attempts", "per_hour", "late_days", "late_percent"];

/// Reads a time, given as a number of milliseconds or as a date.
pub(crate) fn read_moment<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<i64>, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged, expecting = "milliseconds since 1970, or a date such as 2026-12-01T23:59:00+01:00")]
    enum TimeValue {
        Number(i64),
        Text(String),
    }
    match Option::deserialize(deserializer)? {
        None => Ok(None),
        Some(TimeValue::Number(number)) => Ok(Some(number)),
        Some(TimeValue::Text(text)) => calendar::parse(&text).map(Some).ok_or_else(|| {
            Error::custom(format!("{text:?} is not a date with a time zone, such as 2026-12-01T23:59:00+01:00"))
        }),
    }
}

pub(crate) fn time_schema() -> Schema {
    let number = |range: RangeInclusive<i64>| {
        ObjectBuilder::new().schema_type(Type::Integer).minimum(Some(*range.start())).maximum(Some(*range.end()))
    };
    let date = SchemaFormat::KnownFormat(KnownFormat::DateTime);
    let date =
        ObjectBuilder::new().schema_type(Type::String).format(Some(date)).pattern(Some("^(199|2[0-9]{2})[0-9]-"));
    let description = "The due date of students, in milliseconds since 1970, or as a date with its time zone.";
    let [early, late] = calendar::MILLISECOND_RANGES;
    let null = ObjectBuilder::new().schema_type(Type::Null);
    OneOfBuilder::new()
        .item(number(early))
        .item(number(late))
        .item(date)
        .item(null)
        .description(Some(description))
        .into()
}

fn zone_schema() -> Schema {
    let names = ObjectBuilder::new().schema_type(Type::String).enum_values(Some(TZ_VARIANTS.map(Tz::name)));
    let null = ObjectBuilder::new().schema_type(Type::Null);
    let description = "The time zone in which late days end. Without it, each late day has 24 hours.";
    OneOfBuilder::new().item(names).item(null).description(Some(description)).into()
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            suite: String::new(),
            suite_archive: None,
            rules: None,
            hints: None,
            smallest: false,
            forms: vec!["program".to_owned()],
            program: "FOSSSim".to_owned(),
            seconds: 600,
            max_bytes: 128 << 20,
            attempts: 0,
            per_hour: 20,
            due_at: None,
            late_days: 0,
            late_percent: 0,
            time_zone: None,
        }
    }
}

impl Settings {
    /// Reads settings in the database's form.
    ///
    /// # Errors
    ///
    /// Fails if another version of the program wrote them.
    pub(in crate::domain) fn from_json(text: &str) -> Result<Self, DbError> {
        let invalid = |error| DbError::Other(format!("the settings of an assignment can't be read: {error}"));
        serde_json::from_str(text).map_err(invalid)
    }

    /// Describes the settings that differ from earlier ones. `suite` is the name of the uploaded suite.
    pub(in crate::domain) fn describe_changes(&self, before: &Self, suite: &str) -> String {
        let fields = |settings: &Self| match serde_json::to_value(settings) {
            Ok(Value::Object(fields)) => fields,
            _ => Map::new(),
        };
        let (new, old) = (fields(self), fields(before));
        let names: BTreeSet<&String> = new.keys().chain(old.keys()).collect();
        let describe = |name: &String| {
            let label = name.replace('_', " ");
            match (name.as_str(), new.get(name)) {
                ("suite_archive", Some(_)) => format!("uploaded suite \"{suite}\""),
                ("suite_archive", None) => "no uploaded suite".to_owned(),
                (_, None) => format!("no {label}"),
                ("due_at", Some(Value::Number(due))) => {
                    format!("{label} {} UTC", calendar::format_minute(due.as_i64().unwrap_or_default()))
                }
                ("late_percent", Some(value)) => format!("late penalty {value} %"),
                ("max_bytes", Some(value)) => {
                    format!("largest upload {}", format_size(value.as_u64().unwrap_or_default()))
                }
                ("forms", _) => format!("{label} {}", self.forms.join(" or ")),
                (_, Some(Value::String(text))) => format!("{label} {text}"),
                (_, Some(value)) => format!("{label} {value}"),
            }
        };
        names.into_iter().filter(|name| new.get(*name) != old.get(*name)).map(describe).collect::<Vec<_>>().join(", ")
    }

    /// Returns the settings with changed fields; fields that are null are removed.
    ///
    /// # Errors
    ///
    /// Fails if a field is unknown, or has the wrong type.
    pub fn with_changes(&self, changes: &Map<String, Value>) -> Result<Self, Problem> {
        let Ok(Value::Object(mut fields)) = serde_json::to_value(self) else { return Err(Problem::fault()) };
        // A named suite replaces an uploaded one.
        if changes.contains_key("suite") {
            fields.remove("suite_archive");
        }
        for (name, value) in changes {
            match value {
                Value::Null if REQUIRED_SETTINGS.contains(&name.as_str()) => {
                    return Err(Problem::invalid(format!("{name} must not be null")));
                }
                Value::Null => drop(fields.remove(name)),
                value => drop(fields.insert(name.clone(), value.clone())),
            }
        }
        serde_json::from_value(Value::Object(fields)).map_err(|error| Problem::invalid(error.to_string()))
    }

    /// Returns these settings with the grading rules of `other`.
    pub(in crate::domain) fn with_grading_of(&self, other: &Self) -> Self {
        let Self { suite, suite_archive, rules, hints, smallest, program, seconds, .. } = other.clone();
        Self { suite, suite_archive, rules, hints, smallest, program, seconds, ..self.clone() }
    }

    /// Returns the settings as JSON, as the database stores them.
    pub fn to_json(&self) -> String {
        serde_json::to_string(self).unwrap_or_default()
    }

    /// Returns the settings with the suite's full name, if all settings are valid.
    ///
    /// # Errors
    ///
    /// Fails with a message about the first invalid setting.
    pub fn validate(&self, suites: &Suites) -> Result<Self, Problem> {
        let settings = Self { suite: suites.name_or_default(&self.suite), ..self.clone() };
        settings.check(suites)?;
        Ok(settings)
    }

    fn check(&self, suites: &Suites) -> Result<(), Problem> {
        let check_choice = |name: &str, value: &Option<String>, known: &[&str]| match value {
            Some(value) if !known.contains(&value.as_str()) => {
                Err(Problem::invalid(format!("{name} must be one of {}", known.join(", "))))
            }
            _ => Ok(()),
        };
        check_choice("rules", &self.rules, &["parity", "fair", "both"])?;
        check_choice("hints", &self.hints, &["none", "where", "what", "full"])?;
        suites.check(&self.suite)?;
        if let Some(archive) = &self.suite_archive {
            archive.parse::<Digest>().map_err(|error| Problem::invalid(format!("suite_archive: {error}")))?;
        }
        if self.forms.is_empty() || self.forms.iter().any(|form| Form::from_name(form).is_none()) {
            return Err(Problem::invalid("choose the accepted forms (forms): program, sources or traces"));
        }
        let program = "the program's name (program) must be a plain file name";
        ensure(is_file_name(&self.program), Problem::invalid(program))?;
        if let Some(due) = self.due_at.filter(|due| !calendar::is_plausible(*due)) {
            return Err(Problem::invalid(format!(
                "the due date (due_at) must be milliseconds since 1970, but {due} looks like seconds; write \
                 milliseconds, or a date such as 2026-12-01T23:59:00+01:00"
            )));
        }
        let late = "late days (late_days) must be at most 365, and the late penalty (late_percent) at most 100 %";
        ensure(self.late_days <= 365 && self.late_percent <= 100, Problem::invalid(late))?;
        let seconds = "the time limit (seconds) must be between 1 and 3600 seconds";
        ensure((1..=3600).contains(&self.seconds), Problem::invalid(seconds))?;
        let size = "the largest upload (max_bytes) must be between 1 byte and 1 GiB";
        ensure((1..=1 << 30).contains(&self.max_bytes), Problem::invalid(size))?;
        Ok(())
    }

    /// Returns the part of the settings that applies to late submissions.
    pub(crate) fn late_policy(&self) -> LatePolicy {
        let Self { due_at, late_days, late_percent, time_zone, .. } = *self;
        LatePolicy { due_at, late_days, late_percent, time_zone }
    }

    /// Returns whether submissions in the form with this name are accepted.
    pub fn has_form(&self, form: &str) -> bool {
        self.forms.iter().any(|name| name == form)
    }

    /// Returns a list of the accepted kinds of upload for a message, such as `a program or an archive`.
    pub fn describe_forms(&self) -> String {
        let accepted = Form::ALL.into_iter().filter(|form| self.accepts_form(*form));
        accepted.map(Form::describe).collect::<Vec<_>>().join(" or ")
    }

    /// Returns the rejection of an uploaded file. The remedy names the file to choose instead.
    pub(crate) fn reject_file(&self, detail: impl Into<String>) -> Problem {
        let files = Form::ALL.into_iter().filter(|form| self.accepts_form(*form)).map(|form| match form {
            Form::Program => format!("the file {} in your build folder", self.program),
            archive => archive.describe().to_owned(),
        });
        let files = files.collect::<Vec<_>>().join(" or ");
        Problem { remedy: format!("choose {files}; this did not count as an attempt"), ..Problem::unusable(detail) }
    }

    /// Returns whether submissions in this form are accepted.
    pub fn accepts_form(&self, form: Form) -> bool {
        self.has_form(form.name())
    }

    /// Returns the task with which a worker grades this input.
    pub(in crate::domain) fn task(&self, submission: Input) -> Task {
        Task {
            submission,
            suite: self.suite(),
            rules: self.rules.clone(),
            hints: self.hints.clone(),
            smallest: self.smallest,
            program: self.program.clone(),
            seconds: self.seconds,
        }
    }

    /// Returns whether `other` has the same suite.
    pub(crate) fn has_suite_of(&self, other: &Self) -> bool {
        (&self.suite, &self.suite_archive) == (&other.suite, &other.suite_archive)
    }

    pub(in crate::domain) fn suite(&self) -> Suite {
        match self.suite_archive.as_ref().and_then(|digest| digest.parse().ok()) {
            Some(digest) => Suite::Archive(digest),
            None => Suite::Named(self.suite.clone()),
        }
    }
}
