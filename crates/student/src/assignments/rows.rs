//! Everything that a student's program can do differently, one row each.
//!
//! There are two kinds of rows: `wrong` programs have a mistake and write a different trace; `variant`s are correct
//! except for round-off or a positive factor. The code of the simulation in which a mistake is made calls
//! [`Student::makes`](crate::Student::makes). The rows of detection, responses, zones and traces are in
//! [`t2m2`](super::t2m2), those of forces, integrators and their results in [`states`](super::states).
pub use fosssim_findings::explanation::Area;
use fosssim_model::sim::PairKind;

fosssim_num::closed_set! {
    /// The kind of a row.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub enum RowKind {
        /// The program has a mistake, and its result is wrong.
        Wrong = "wrong",
        /// The program is correct, and computes the same mathematics with other arithmetic.
        Variant = "variant",
    }
}

/// One row of a table whose mistakes have type `M`.
#[derive(Debug, Clone, Copy)]
pub struct MistakeRow<M> {
    /// The mistake as a value for programs.
    pub mistake: M,
    /// The mistake's id for users.
    pub id: &'static str,
    /// The kind of the row: wrong or correct.
    pub kind: RowKind,
    /// The area of the assignment in which the mistake is made.
    pub area: Area,
    /// The mistake in one sentence, in a teacher's words, without formulas, symbols or numbers, so that it does not
    /// reveal the solution.
    pub summary: &'static str,
    /// The exact form of the mistake: the wrong and the right expression, in the assignment's notation.
    pub term: &'static str,
}

impl<M> MistakeRow<M> {
    /// Returns the row with its mistake replaced by `mistake`.
    pub fn with_mistake<N>(self, mistake: N) -> MistakeRow<N> {
        let Self { id, kind, area, summary: what, term, .. } = self;
        MistakeRow { mistake, id, kind, area, summary: what, term }
    }

    /// Returns the sentence about the mistake, preceded by the part of the program.
    pub fn sentence(&self) -> String {
        format!("{}: {}", self.program_part(), self.summary)
    }

    /// Returns the kind of pair to which the mistake is limited, if there is only one.
    pub fn pair_kind(&self) -> Option<PairKind> {
        PairKind::ALL.into_iter().find(|kind| kind.name().eq_ignore_ascii_case(self.program_part()))
    }

    /// Returns the part of the program in which the mistake is made: the kind of pair if there is only one, otherwise
    /// the area of the assignment.
    pub fn program_part(&self) -> &'static str {
        match (self.id.split_once('-'), self.area) {
            (Some(("pp", _)), _) => "Particle-particle",
            (Some(("pe", _)), _) => "Particle-edge",
            (Some(("ph", _)), _) => "Particle-half-plane",
            (_, area) => area.name(),
        }
    }
}

/// Returns the rows with their sentences from `text`, which has four lines per row, in order: its id, its two
/// sentences, and an empty line. The compiler reports the row whose id is not next.
pub(super) const fn with_sentences<M: Copy, const N: usize>(
    mut rows: [MistakeRow<M>; N],
    text: &'static str,
) -> [MistakeRow<M>; N] {
    let (mut row, mut rest) = (0, text);
    while row < N {
        let id = split_line(rest);
        let what = split_line(id.1);
        let term = split_line(what.1);
        let end = split_line(term.1);
        assert!(is_equal_text(id.0, rows[row].id) && end.0.is_empty(), "{}", rows[row].id);
        (rows[row].summary, rows[row].term, rest) = (what.0, term.0, end.1);
        row += 1;
    }
    assert!(rest.is_empty(), "{}", rest);
    rows
}

/// Returns the first line of a text, and the rest.
const fn split_line(text: &str) -> (&str, &str) {
    let mut end = 0;
    while text.as_bytes()[end] != b'\n' {
        end += 1;
    }
    (text.split_at(end).0, text.split_at(end + 1).1)
}

const fn is_equal_text(one: &str, other: &str) -> bool {
    let mut at = 0;
    while at < one.len() && at < other.len() && one.as_bytes()[at] == other.as_bytes()[at] {
        at += 1;
    }
    at == one.len() && at == other.len()
}

/// Declares a table of rows and the type of its mistakes. The arguments are the name of the type, the name of the
/// table, further variants that contain mistakes of other tables, and the type of edits. A group may name a file with
/// the sentences of its rows and of the following rows. A mistake in a formula has its edit in brackets, from which the
/// student's program is derived.
macro_rules! rows {
    (
        $(#[$doc:meta])* $type:ident $table:ident [$($of:ident $other:ident),*] [$($edits:ident)?]
        $($kind:ident $area:ident $($sentences:literal)? { $($mistake:ident $id:literal $([$edit:expr])?;)* })*
    ) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum $type {
            $($(#[doc = $id] $mistake,)*)*
            $(#[doc = "A mistake that another table defines."] $of($other),)*
        }

        impl $type {
            /// Returns the area of the assignment to which the mistake belongs.
            pub const fn area(self) -> $crate::assignments::rows::Area {
                match self {
                    $($(Self::$mistake => $crate::assignments::rows::Area::$area,)*)*
                    $(Self::$of(one) => one.area(),)*
                }
            }
        }

        $crate::assignments::rows::rows!(@ $type [$($edits)?] $($($mistake $([$edit])?,)*)*);

        /// All rows of this table, in the order of the assignment.
        pub const $table: &[$crate::assignments::rows::MistakeRow<$type>] = &$crate::assignments::rows::with_sentences(
            [$($($crate::assignments::rows::MistakeRow {
                mistake: $type::$mistake,
                id: $id,
                kind: $crate::assignments::rows::RowKind::$kind,
                area: $crate::assignments::rows::Area::$area,
                summary: "",
                term: "",
            },)*)*],
            concat!($($(include_str!($sentences), "\n",)?)*),
        );
    };
    (@ $type:ident [] $($rest:tt)*) => {};
    (@ $type:ident [$edits:ident] $($mistake:ident $([$edit:expr])?,)*) => {
        impl $type {
            /// Returns the mistake's change of a pair's formulas, if it has one.
            pub fn formula_edit(self) -> Option<$edits> {
                match self {
                    $($(Self::$mistake => Some($edit),)?)*
                    _ => None,
                }
            }
        }
    };
}
pub(super) use rows;
