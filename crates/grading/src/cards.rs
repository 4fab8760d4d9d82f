//! Cards: what a report shows of a wrong trace beyond its result. They are drawn while the trace is at hand and kept
//! under the digest of what they say, so that the journal's result names them and the trace itself need not be kept.
use super::{config::Hints, result::SceneResult, task::SceneTask};
use fosssim_evidence::StepRuling;
use fosssim_files::Place;
use fosssim_judge::{Outcome, Rules};
use std::io;

/// Deflating harder gains little: most of a card is packed already.
const LEVEL: i32 = 3;

/// The greatest size of a card, in bytes; a larger file is not one of our cards.
const LARGEST: u64 = 64 << 20;

/// A judged trace that is at hand.
#[derive(Debug, Clone, Copy)]
pub struct Judged<'a> {
    /// The scene.
    pub task: &'a SceneTask,
    /// The result, cut to what the hints let through.
    pub result: &'a SceneResult,
    /// The outcome of judging; it tells more than hints may let through.
    pub outcome: &'a Outcome,
    /// The ruling of the rule books on each step.
    pub rulings: &'a [StepRuling],
    /// The trace, or its beginning.
    pub trace: &'a [u8],
    /// Whether the trace goes on beyond that.
    pub is_cut: bool,
    /// The rule books that were asked.
    pub rules: Rules,
    /// How much may be told.
    pub hints: Hints,
}

/// Draws the card of a trace, or nothing where there is nothing to show.
pub type Draw<'a> = dyn Fn(&Judged<'_>) -> Option<String> + Sync + 'a;

/// Where cards are kept, and who draws them.
#[derive(Clone, Copy)]
pub struct Cards<'a> {
    /// The folder; made when it is needed.
    pub folder: &'a Place,
    /// Draws.
    pub draw: &'a Draw<'a>,
}

impl Cards<'_> {
    /// Draws a card and keeps it; its name, if there is one.
    ///
    /// # Errors
    /// When it can't be written.
    pub fn keep(&self, judged: &Judged<'_>) -> io::Result<Option<String>> {
        let Some(card) = (self.draw)(judged) else { return Ok(None) };
        let name = blake3::hash(card.as_bytes()).to_hex()[..32].to_owned();
        let path = file(self.folder, &name);
        if !path.is_file() {
            // By rename: another job may draw the same card now.
            path.write(&zstd::encode_all(card.as_bytes(), LEVEL)?)?;
        }
        Ok(Some(name))
    }

    /// Whether the card of an earlier result is missing.
    pub(super) fn lack(&self, result: &SceneResult) -> bool {
        result.card.as_ref().is_some_and(|name| !file(self.folder, name).is_file())
    }
}

/// Reads a card that has been kept in a folder.
#[must_use]
pub fn read(folder: &Place, name: &str) -> Option<String> {
    let is_name = name.len() == 32 && name.bytes().all(|byte| byte.is_ascii_hexdigit());
    let (packed, _) = is_name.then(|| file(folder, name).file(LARGEST).ok()).flatten()?;
    let mut text = String::new();
    io::Read::read_to_string(&mut io::Read::take(zstd::Decoder::new(packed).ok()?, LARGEST), &mut text).ok()?;
    // A file that was changed meanwhile changes no report.
    (blake3::hash(text.as_bytes()).to_hex()[..32] == *name).then_some(text)
}

fn file(folder: &Place, name: &str) -> Place {
    folder.join(format!("{name}.zst"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Verdict, result::Reason};
    use fosssim_judge::replay;
    use fosssim_model::scene::original;

    #[test]
    fn a_card_is_kept_once_and_only_what_was_kept_is_read() {
        let xml = b"<scene><duration time=\"0\"/><integrator type=\"explicit-euler\" dt=\"1\"/></scene>";
        let scene = original::read(xml).expect("a scene").scene;
        let task = SceneTask { name: "a/b".to_owned(), xml: xml.to_vec(), scene, recording: None };
        let outcome = replay::judge(&task.scene, &[][..], &replay::Options::default(), &mut ());
        let result = SceneResult::without_run("a/b", 0, Verdict::WrongAnswer, Reason::Right);
        let judged = Judged {
            task: &task,
            result: &result,
            outcome: &outcome,
            rulings: &[],
            trace: &[],
            is_cut: false,
            rules: Rules::Fair,
            hints: Hints::Full,
        };
        let folder = tempfile::tempdir().expect("a folder");
        let cards = Place::new(folder.path(), "cards");
        let keep = |text: &'static str| {
            let draw = move |_: &Judged<'_>| (!text.is_empty()).then(|| text.to_owned());
            Cards { folder: &cards, draw: &draw }.keep(&judged).expect("written")
        };
        assert_eq!(keep(""), None);
        assert!(!cards.path().exists(), "no folder for nothing");
        let (one, again, other) = (keep("one").expect("a card"), keep("one"), keep("other").expect("a card"));
        assert_eq!((again.as_ref(), one == other), (Some(&one), false));
        assert_eq!(cards.names().expect("a folder").len(), 2);
        assert_eq!((read(&cards, &one).as_deref(), read(&cards, &other).as_deref()), (Some("one"), Some("other")));
        let lacks = |card: &str| {
            let result = SceneResult { card: Some(card.to_owned()), ..result.clone() };
            Cards { folder: &cards, draw: &|_| None }.lack(&result)
        };
        assert!(!lacks(&one));
        file(&cards, &one).write(&zstd::encode_all(&b"another"[..], 1).expect("packed")).expect("written");
        file(&cards, &other).remove().expect("removed");
        assert_eq!((read(&cards, &one), read(&cards, &other), read(&cards, "../x")), (None, None, None));
        assert!(lacks(&other));
    }
}
