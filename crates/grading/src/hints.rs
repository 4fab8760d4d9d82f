//! How much a report tells a student, and what of findings and explanations that lets through.
//!
//! What is not to be told is cut here, before a report or the journal sees it, so that no format can let it out.
use super::told::{Told, ToldBook, ToldFinding, ToldPlace};
use fosssim_judge::{Book, Finding, FindingDetail, Outcome, Rules};
use fosssim_mistakes::{diagnose::Explanation, student::find};
use serde::Deserialize;

/// How much a report tells a student.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Hints {
    /// The verdict only.
    None,
    /// Where: kind, step, pair and polynomial of the first divergence.
    Where,
    /// What: the likely mistake in a sentence, too.
    What,
    /// Everything: expected and actual values, and the mistake in detail. May give a right formula away.
    Full,
}

impl Hints {
    /// Its name in suites, and what it means in a few words.
    #[must_use]
    pub const fn words(self) -> (&'static str, &'static str) {
        match self {
            Self::None => ("none", "the verdict only"),
            Self::Where => ("where", "where the first divergence is"),
            Self::What => ("what", "where the first divergence is, and the likely mistake in a sentence"),
            Self::Full => ("full", "everything, formulas and values included"),
        }
    }

    /// Whether likely mistakes are told at this level.
    #[must_use]
    pub const fn explains(self) -> bool {
        matches!(self, Self::What | Self::Full)
    }

    /// Cuts explanations down to this level: below [`Hints::What`] there is only where numbers end, if they do
    /// ([`Explanation::is_not_finite`]), and at [`Hints::None`] nothing. At that level each says what is wrong, in a
    /// sentence without formulas, and which known mistakes can't be told apart from it; exact forms and examples need
    /// [`Hints::Full`].
    #[must_use]
    pub fn cut(self, explanations: Vec<Explanation>) -> Vec<Explanation> {
        match self {
            Self::None => Vec::new(),
            // Where it is, and nothing that is guessed.
            Self::Where => explanations.into_iter().filter(Explanation::is_not_finite).collect(),
            Self::What => explanations
                .into_iter()
                .map(|mut explanation| {
                    explanation.same_as.retain(|key| find(key).is_some());
                    Explanation { details: Vec::new(), example: None, ..explanation }
                })
                .collect(),
            Self::Full => explanations,
        }
    }

    /// Cuts what judging found down to this level: nothing at [`Hints::None`]; below [`Hints::Full`] where findings
    /// are, and of what kind; there everything.
    #[must_use]
    pub fn tell(self, judged: &Outcome, rules: Rules) -> Option<Told> {
        (self > Self::None).then(|| Told {
            official: rules.official(),
            parity: self.tell_book(judged, Book::Parity),
            fair: judged.fair.is_some().then(|| self.tell_book(judged, Book::Fair)),
            residuals: (self == Self::Full).then_some(judged.parity.residuals),
            damage: judged.damage.clone(),
            trailing_bytes: judged.trailing_bytes,
        })
    }

    fn tell_book(self, judged: &Outcome, book: Book) -> ToldBook {
        let found = judged.findings_by(book);
        ToldBook {
            ruling: judged.ruling(book),
            wrong_steps: found.wrong_steps,
            counts: found.counts,
            first_divergence: found.first_divergence.as_ref().and_then(|first| self.finding(first)),
            examples: found.examples.iter().filter_map(|example| self.finding(example)).collect(),
        }
    }

    /// What of a finding may be told: nothing at [`Hints::None`], no values below [`Hints::Full`].
    #[must_use]
    pub const fn finding(self, finding: &Finding) -> Option<ToldFinding> {
        match self {
            Self::None => None,
            Self::Where | Self::What => {
                Some(ToldFinding::Place { step: finding.step, kind: finding.kind(), place: place(&finding.detail) })
            }
            Self::Full => Some(ToldFinding::Full(*finding)),
        }
    }
}

/// Where in its step a finding lies.
const fn place(detail: &FindingDetail) -> ToldPlace {
    match detail {
        FindingDetail::MissedCollision { expected }
        | FindingDetail::WrongNormal { expected, .. }
        | FindingDetail::ContactTime { expected, .. } => ToldPlace::Pair(expected.pair),
        FindingDetail::PolynomialDegree { place, .. }
        | FindingDetail::VanishingPolynomial { place, .. }
        | FindingDetail::Coefficient { place, .. }
        | FindingDetail::PassPositions { place }
        | FindingDetail::TrimmedDecision { place, .. }
        | FindingDetail::TrimmedTime { place, .. }
        | FindingDetail::MixedForms { place } => ToldPlace::Polynomial(*place),
        FindingDetail::Position { particle, .. }
        | FindingDetail::Velocity { particle, .. }
        | FindingDetail::BeyondReach { particle, .. } => ToldPlace::Particle(*particle),
        FindingDetail::SuperfluousCollision { actual } | FindingDetail::RepeatedCollision { actual } => {
            ToldPlace::Objects(actual.first, actual.second)
        }
        FindingDetail::PolynomialCount { .. }
        | FindingDetail::PassCount { .. }
        | FindingDetail::RecordsDiffer { .. }
        | FindingDetail::ImpossibleLog => ToldPlace::Step,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fosssim_judge::replay;
    use fosssim_mistakes::{
        diagnose::{self, About, Example, ExamplePlace, NanStage, NotFinite},
        student::{self, CATALOGUE, RowKind, Student},
    };
    use fosssim_model::scene::original;
    use fosssim_testing::scenes;

    fn explanation() -> Explanation {
        let example = Example {
            step: 3,
            place: ExamplePlace::ContactCount,
            given: Vec::new(),
            expected: vec![1.0],
            actual: vec![2.0],
        };
        Explanation {
            key: "pe-square-no-eh".to_owned(),
            about: About::Mistake,
            details: vec![diagnose::Detail::Term("pe-square-no-eh")],
            reproduced: 3,
            samples: 3,
            example: Some(example),
            same_as: vec!["other".to_owned(), "pe-square-two-eh".to_owned()],
            denies: Vec::new(),
            claims: Vec::new(),
        }
    }

    #[test]
    fn each_level_tells_more_and_formulas_come_last() {
        let told = |hints: Hints| hints.cut(vec![explanation()]);
        assert_eq!((told(Hints::None), told(Hints::Where)), (Vec::new(), Vec::new()));
        let what = told(Hints::What).remove(0);
        assert_eq!((what.about, what.details.len(), what.example), (About::Mistake, 0, None));
        assert_eq!(what.same_as, ["pe-square-two-eh"], "what is found in polynomials alone may be a formula's name");
        assert_eq!(told(Hints::Full), [explanation()]);
        for hints in [Hints::None, Hints::Where, Hints::What, Hints::Full] {
            assert_eq!(hints.explains(), !told(hints).is_empty(), "{hints:?}");
            // Where numbers end is a place and no guess.
            let end = NotFinite { step: Some(3), stage: NanStage::Zones, is_nan: true };
            let end = Explanation { about: About::NotFinite(end), ..explanation() };
            assert_eq!(hints.cut(vec![end]).len(), usize::from(hints > Hints::None), "{hints:?}");
        }
    }

    #[test]
    fn values_are_told_in_full_only() {
        let detail = FindingDetail::Position { particle: 2, expected: [1.5, 0.0], actual: [1.25, 0.0], residual: 0.25 };
        let finding = Finding { step: 4, frame: 8, detail };
        let place = ToldFinding::Place { step: 4, kind: finding.kind(), place: ToldPlace::Particle(2) };
        assert_eq!(Hints::None.finding(&finding), None);
        assert_eq!(Hints::Where.finding(&finding), Some(place.clone()));
        assert_eq!(Hints::What.finding(&finding), Some(place));
        assert_eq!(Hints::Full.finding(&finding), Some(ToldFinding::Full(finding)));
    }

    #[test]
    fn what_is_told_of_a_trace_grows_with_the_hints_and_holds_no_value_below_full() {
        let scene = original::read(scenes::ALL_KINDS.as_bytes()).expect("a scene").scene;
        let row = CATALOGUE.iter().find(|row| row.kind == RowKind::Wrong).expect("a mistake");
        let trace = student::trace(&scene, Student::new(Some(row.mistake))).unwrap_or_else(|(bytes, _)| bytes);
        let options = replay::Options { fair: true, ..replay::Options::default() };
        let judged = replay::judge(&scene, &trace[..], &options, &mut ());
        assert_eq!(Hints::None.tell(&judged, Rules::Both), None);
        let told = |hints: Hints| hints.tell(&judged, Rules::Both).expect("something");
        assert_eq!(told(Hints::Where), told(Hints::What));
        let (part, full) = (told(Hints::Where), told(Hints::Full));
        assert!(part.residuals.is_none() && full.residuals.is_some());
        for (part, full) in
            [(&part.parity, &full.parity), (part.fair.as_ref().expect("asked"), full.fair.as_ref().expect("asked"))]
        {
            assert!(part.examples.iter().all(|example| matches!(example, ToldFinding::Place { .. })));
            assert_eq!(part.examples.len(), full.examples.len());
            assert_eq!((&part.counts, part.wrong_steps, part.ruling), (&full.counts, full.wrong_steps, full.ruling));
        }
        // The book whose verdict counts speaks first.
        assert_eq!(told(Hints::Full).official(), &full.parity);
        let fair = Hints::Full.tell(&judged, Rules::Fair).expect("something");
        assert_eq!(fair.official(), full.fair.as_ref().expect("asked"));
    }
}
