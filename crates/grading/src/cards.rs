//! Cards: the parts of a report that show a wrong trace in detail. A card is drawn while the trace is available, and
//! stored under the digest of its contents. Its name is stored with the result, so the trace itself need not be stored.
use super::{config::Hints, result::SceneResult};
use fosssim_evidence::StepRuling;
use fosssim_files::FilePlace;
use fosssim_judge::{Outcome, Rules};
use fosssim_mistakes::{diagnose::Explanation, together::disclosure::limit_explanations};
use fosssim_model::scene::Scene;
use std::io;

/// The compression level of cards for zstd. A higher level gains little, because most of a card is compressed already.
const COMPRESSION_LEVEL: i32 = 3;

/// The maximum size of a card, in bytes. Larger files are not cards.
const MAX_CARD_BYTES: u64 = 64 << 20;

/// A trace that was judged and is still available, for a card.
#[derive(Debug, Clone, Copy)]
pub struct JudgedTrace<'a> {
    /// The scene that the trace belongs to.
    pub scene: &'a Scene,
    /// The name of the scene, in the form that commands accept.
    pub name: &'a str,
    /// The likely mistakes that the reader may see.
    pub explanations: &'a [Explanation],
    /// The outcome of judging. It contains more than the reader may see.
    pub outcome: &'a Outcome,
    /// The rulings on each step by the rule books.
    pub rulings: &'a [StepRuling],
    /// The whole trace, or its beginning.
    pub trace: &'a [u8],
    /// Whether `trace` contains only the beginning of the trace.
    pub is_cut: bool,
    /// The rule books by which the trace was judged.
    pub rules: Rules,
    /// The level of detail that the reader may see.
    pub hints: Hints,
}

/// A function that draws the card of a trace; `None` if there is nothing to show.
pub type DrawCard<'a> = dyn Fn(&JudgedTrace<'_>) -> Option<String> + Sync + 'a;

/// The folder in which cards are stored, and the function that draws them.
#[derive(Clone, Copy)]
pub struct Cards<'a> {
    /// The folder in which cards are stored. It is created when it is needed.
    pub folder: &'a FilePlace,
    /// The function that draws a card.
    pub draw: &'a DrawCard<'a>,
    /// Whether cards for students are drawn as well.
    pub for_students: bool,
}

/// The names of a trace's two cards: the one for staff, and the one for students. Both are the same card if students
/// may see as much as staff. A card that was not drawn is `None`.
pub type CardNames = (Option<String>, Option<String>);

impl Cards<'_> {
    /// Draws the cards of a trace and stores them. `students` is the level of detail for students.
    ///
    /// # Errors
    ///
    /// Fails if a card can't be written.
    pub fn store_cards(&self, judged_trace: &JudgedTrace<'_>, students: Hints) -> io::Result<CardNames> {
        let card = self.store_card(judged_trace)?;
        if students >= judged_trace.hints {
            return Ok((card.clone(), card));
        }
        if !self.for_students {
            return Ok((card, None));
        }
        let explanations = limit_explanations(students, judged_trace.explanations.to_vec());
        Ok((card, self.store_card(&JudgedTrace { explanations: &explanations, hints: students, ..*judged_trace })?))
    }

    fn store_card(&self, judged: &JudgedTrace<'_>) -> io::Result<Option<String>> {
        (self.draw)(judged).map(|card| store_card_file(self.folder, &card)).transpose()
    }

    /// Returns whether a card that an earlier result needs is missing. `students` is the level of detail for students.
    pub(super) fn lacks_card(&self, result: &SceneResult, students: Hints) -> bool {
        let is_missing = |name: &String| !card_location(self.folder, name).is_file();
        let shows_students = self.for_students && students > Hints::None;
        result.card.as_ref().is_some_and(|card| {
            is_missing(card) || shows_students && result.card_for_students.as_ref().is_none_or(is_missing)
        })
    }
}

/// Stores a card in a folder, and returns the card's name.
///
/// # Errors
///
/// Fails if the card can't be written.
pub fn store_card_file(folder: &FilePlace, card: &str) -> io::Result<String> {
    let name = blake3::hash(card.as_bytes()).to_hex()[..32].to_owned();
    let path = card_location(folder, &name);
    if !path.is_file() {
        // The file gets its name after it is complete, because another job may write the same card.
        path.write(&zstd::encode_all(card.as_bytes(), COMPRESSION_LEVEL)?)?;
    }
    Ok(name)
}

/// Reads a stored card from a folder; `None` if there is none, or if it was changed.
pub fn read_card(folder: &FilePlace, name: &str) -> Option<String> {
    let is_name = name.len() == 32 && name.bytes().all(|byte| byte.is_ascii_hexdigit());
    let (packed, _) = is_name.then(|| card_location(folder, name).open_file(MAX_CARD_BYTES).ok()).flatten()?;
    let mut text = String::new();
    io::Read::read_to_string(&mut io::Read::take(zstd::Decoder::new(packed).ok()?, MAX_CARD_BYTES), &mut text).ok()?;
    // The digest of a card is its name. If they differ, the file was changed and is ignored.
    (blake3::hash(text.as_bytes()).to_hex()[..32] == *name).then_some(text)
}

fn card_location(folder: &FilePlace, name: &str) -> FilePlace {
    folder.join(format!("{name}.zst"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Verdict, result::Reason};
    use fosssim_judge::replay;
    use fosssim_mistakes::together::disclosure::limit_result;
    use fosssim_model::scene::original;

    /// Returns a scene, the outcome of judging a trace of it, and the result.
    fn wrong() -> (Scene, Outcome, SceneResult) {
        let xml = b"<scene><duration time=\"0\"/><integrator type=\"explicit-euler\" dt=\"1\"/></scene>";
        let scene = original::read(xml).expect("a scene").scene;
        let outcome = replay::judge(&scene, &[][..], &replay::Options::default(), &mut ());
        let result = SceneResult::without_run("a/b", 0, Verdict::WrongAnswer, Reason::Right);
        (scene, outcome, result)
    }

    fn judged<'a>(scene: &'a Scene, outcome: &'a Outcome) -> JudgedTrace<'a> {
        let (rules, hints) = (Rules::Fair, Hints::Full);
        JudgedTrace {
            scene,
            name: "a/b",
            explanations: &[],
            outcome,
            rulings: &[],
            trace: &[],
            is_cut: false,
            rules,
            hints,
        }
    }

    #[test]
    fn a_card_is_kept_once_and_only_what_was_kept_is_read() {
        let (scene, outcome, result) = wrong();
        let judged = judged(&scene, &outcome);
        let folder = tempfile::tempdir().expect("a folder");
        let cards = FilePlace::new(folder.path(), "cards");
        let keep = |text: &'static str| {
            let draw = move |_: &JudgedTrace<'_>| (!text.is_empty()).then(|| text.to_owned());
            let cards = Cards { folder: &cards, draw: &draw, for_students: false };
            cards.store_cards(&judged, Hints::Full).expect("written").0
        };
        assert_eq!(keep(""), None);
        assert!(!cards.path().exists(), "no folder for nothing");
        let (one, again, other) = (keep("one").expect("a card"), keep("one"), keep("other").expect("a card"));
        assert_eq!((again.as_ref(), one == other), (Some(&one), false));
        assert_eq!(cards.list_names().expect("a folder").len(), 2);
        assert_eq!(
            (read_card(&cards, &one).as_deref(), read_card(&cards, &other).as_deref()),
            (Some("one"), Some("other"))
        );
        let lacks = |card: &str| {
            let result = SceneResult { card: Some(card.to_owned()), ..result.clone() };
            Cards { folder: &cards, draw: &|_| None, for_students: false }.lacks_card(&result, Hints::What)
        };
        assert!(!lacks(&one));
        card_location(&cards, &one).write(&zstd::encode_all(&b"another"[..], 1).expect("packed")).expect("written");
        card_location(&cards, &other).remove().expect("removed");
        assert_eq!((read_card(&cards, &one), read_card(&cards, &other), read_card(&cards, "../x")), (None, None, None));
        assert!(lacks(&other));
    }

    /// A card for staff never replaces the card for students.
    #[test]
    fn students_have_a_separate_card_if_they_see_less() {
        let (scene, outcome, result) = wrong();
        let judged = judged(&scene, &outcome);
        let folder = tempfile::tempdir().expect("a folder");
        let place = FilePlace::new(folder.path(), "cards");
        let draw = |judged: &JudgedTrace<'_>| (judged.hints > Hints::None).then(|| format!("{:?}", judged.hints));
        for (for_students, students, expected) in [
            (false, Hints::Full, Some("Full")),
            (false, Hints::Where, None),
            (true, Hints::Where, Some("Where")),
            (true, Hints::None, None),
        ] {
            let cards = Cards { folder: &place, draw: &draw, for_students };
            let (card, own) = cards.store_cards(&judged, students).expect("written");
            let text = |name: Option<&String>| name.and_then(|name| read_card(&place, name));
            assert_eq!(text(card.as_ref()).as_deref(), Some("Full"));
            assert_eq!(text(own.as_ref()).as_deref(), expected, "{for_students} {students:?}");
            let mut told = SceneResult { card, card_for_students: own.clone(), ..result.clone() };
            assert!(!cards.lacks_card(&told, students));
            limit_result(students, &mut told);
            assert_eq!(told.card, own);
            // If a grading made no pages for students, its results are graded again for such pages.
            let kept = SceneResult { card_for_students: None, ..told };
            let kept = SceneResult { card: cards.store_cards(&judged, students).expect("written").0, ..kept };
            assert_eq!(cards.lacks_card(&kept, students), for_students && students > Hints::None);
        }
    }
}
