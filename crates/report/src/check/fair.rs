//! The section about the fair rules in the text of the check report.
use super::super::{
    number::{format_g, group_digits},
    step_share,
    style::{Style, TextStyle},
    table::{Align, Table},
};
use fosssim_findings::{BookFindings, Cause};
use fosssim_judge::{
    Outcome, PairText, PassText,
    fair::{FairRefusal, FairVerdict, Form, Judgement, find_cause},
};

/// Renders the section about the fair rules; `None` if they did not judge.
pub(super) fn render(outcome: &Outcome, style: Style) -> Option<String> {
    let fair = outcome.fair.as_deref()?;
    let mut text = style.paint(TextStyle::Strong, "Fair rules") + "\n";
    let (look, word) = verdict(fair);
    let mut line = |words: String| text += &format!("  {words}\n");
    line(format!("{}: {}", style.paint(look, word), summarize(fair, outcome)));
    if let Some([low, high]) = fair.factor {
        let range = if high / low - 1.0 < 1e-9 {
            format_g(low)
        } else {
            format!("between {} and {}", format_g(low), format_g(high))
        };
        line(format!("factor of the polynomials: {range}; any positive factor is right"));
    }
    match fair.form {
        Form::Either => {}
        Form::Course => line("approach polynomial: the course's form, with its slip in t^3".to_owned()),
        Form::Right => line("approach polynomial: the right form, without the course's slip in t^3".to_owned()),
    }
    if let Some(shares) = describe_shares(fair) {
        line(format!("largest used share of a tolerance: {shares}"));
    }
    if fair.borderline > 0 {
        let (verb, plural) = if fair.borderline == 1 { ("was", "") } else { ("were", "s") };
        line(format!(
            "{} decision{plural} that round-off or small coefficients may change {verb} accepted as in the trace",
            group_digits(fair.borderline)
        ));
        for decision in &fair.borderline_examples {
            let word = if decision.collides { "collides" } else { "does not collide" };
            let (pair, pass) = (PairText(decision.pair), PassText(decision.pass));
            line(format!("  step {}: {pair} ({pass}): the trace {word}", decision.step));
        }
        let more = fair.borderline - fair.borderline_examples.len() as u64;
        if more > 0 {
            line(format!("  and {} more", group_digits(more)));
        }
    }
    if !fair.findings.examples.is_empty() {
        text += &describe_kinds(&fair.findings, style);
    }
    if let Some(cause) = find_cause(outcome) {
        let (heading, sides) = (style.paint(TextStyle::Notice, "The rule books differ:"), describe_acceptance(cause));
        text += &format!("  {heading} {sides}:\n  {cause}\n");
    }
    Some(text)
}

/// Lists the kinds of findings of a rule book, each with its first example.
pub(super) fn describe_kinds(found: &BookFindings, style: Style) -> String {
    let mut table = Table::new([Align::Left, Align::Right, Align::Left]);
    table.add_heading(["kind", "count", "first example"]);
    for example in &found.examples {
        let kind = example.kind();
        table.add_row([
            kind.to_string().into(),
            group_digits(found.counts.get(kind)).into(),
            example.to_string().into(),
        ]);
    }
    table.render(style)
}

/// Returns the text of the verdict and its style.
pub(super) const fn verdict(judgement: &Judgement) -> (TextStyle, &'static str) {
    match judgement.verdict {
        FairVerdict::Accepted => (TextStyle::Right, "accepted"),
        FairVerdict::Rejected => (TextStyle::Wrong, "rejected"),
        FairVerdict::None => (TextStyle::Notice, "undecided"),
    }
}

/// Returns the reason for the fair verdict, in one line.
pub(super) fn summarize(judgement: &Judgement, outcome: &Outcome) -> String {
    let refusal = match judgement.refusal {
        Some(FairRefusal::Stopped) => Some("the trace can't be read to its end"),
        Some(FairRefusal::Damaged) => Some("the trace is damaged"),
        Some(FairRefusal::TrailingBytes) => Some("bytes follow the last record"),
        Some(FairRefusal::Undecided) => {
            Some("most of its decisions differ from the reference's, though only round-off could change them")
        }
        None => None,
    };
    let found = judgement.findings.first_divergence.as_ref().map(|first| {
        let wrong = match judgement.findings.wrong_steps {
            0 => "the first record is wrong".to_owned(),
            many => step_share::describe_wrong(many, outcome.steps, group_digits),
        };
        let first = match first.step {
            0 if judgement.findings.wrong_steps == 0 => String::new(),
            0 => ", and the first record is also wrong".to_owned(),
            _ if outcome.steps == 1 => String::new(),
            step => format!(", the first is step {step}"),
        };
        wrong + &first
    });
    let given_up = judgement.first_unjudged_step.map(|step| format!("judging would take too long from step {step} on"));
    let nothing = (judgement.verdict == FairVerdict::None).then(|| "nothing is wrong so far".to_owned());
    let parts = [refusal.map(str::to_owned), found.or(nothing), given_up];
    match parts.into_iter().flatten().collect::<Vec<_>>() {
        parts if parts.is_empty() => step_share::describe_right_steps(outcome.steps, group_digits),
        parts => parts.join("; "),
    }
}

/// Returns how much of each tolerance was used, such as `coefficients 12 %, positions 3 %`. Tolerances that were not
/// used are left out.
fn describe_shares(judgement: &Judgement) -> Option<String> {
    let shares = judgement.shares;
    let list: Vec<String> = [
        ("coefficients", shares.coefficient),
        ("normals", shares.normal),
        ("positions", shares.position),
        ("velocities", shares.velocity),
    ]
    .into_iter()
    .filter(|(_, share)| *share > 0.0)
    .map(|(name, share)| format!("{name} {}", format_percent(share)))
    .collect();
    (!list.is_empty()).then(|| list.join(", "))
}

fn format_percent(share: f64) -> String {
    if share < 0.01 { "< 1 %".to_owned() } else { format!("{:.0} %", 100.0 * share) }
}

/// Returns a sentence about which rule book accepts the trace, and which one rejects it.
pub(crate) const fn describe_acceptance(cause: Cause) -> &'static str {
    if cause.is_original_too_strict() {
        "the original rejects this trace, but the fair rules accept it"
    } else {
        "the original accepts this trace, but the fair rules reject it"
    }
}
