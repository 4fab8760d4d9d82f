//! The part of a grade that a format tells its reader.
use super::Format;
use crate::page::Audience;
use fosssim_findings::Grade;
use fosssim_mistakes::together::{for_students, told_to_students};
use std::borrow::Cow;

/// The warning of a report that leaves groups out.
const OTHERS: &str =
    "points, verdict and likely mistakes are those of the groups shown here; the grade has others, too";

impl Format {
    /// The part of a grade that goes into a document for this reader. Reports for students leave out the groups that
    /// students do not see at once, unless the platform that asks for them hides these itself (`platform_hides`).
    #[must_use]
    pub fn told(self, grade: &Grade, reader: Audience, platform_hides: bool) -> Cow<'_, Grade> {
        match (self, reader) {
            // Students read these in any case. They hide what is hidden on their own; so does a page.
            (Self::Gradescope | Self::Prairielearn, _) | (Self::Html, Audience::Student) => told_to_students(grade),
            (_, Audience::Staff) => Cow::Borrowed(grade),
            (_, Audience::Student) if platform_hides => told_to_students(grade),
            (_, Audience::Student) => {
                let mut shown = for_students(grade);
                if shown.groups.len() < grade.groups.len() {
                    shown.to_mut().warnings.push(OTHERS.to_owned());
                }
                shown
            }
        }
    }
}
