//! Which scenes see that a program is wrong: the measure of suites and probe scenes.
use crate::{
    mutants::mutants,
    operators::{equivalent, mutations},
    runs::Watched,
};
use fosssim_oracle::student::{CATALOGUE, RowKind, Student};

/// A program with one mistake.
#[derive(Debug)]
pub struct WrongProgram {
    /// The name of its mistake: of a row, of a mutant, or place and operator of a mutation.
    pub name: String,
    /// The student who writes it.
    pub student: Student,
}

/// All programs that the scenes have to refuse: those of the catalogue, of the mutants, and every mutation that changes
/// something.
#[must_use]
pub fn wrong_programs() -> Vec<WrongProgram> {
    let rows = CATALOGUE.iter().filter(|row| row.kind == RowKind::Wrong);
    let rows = rows.map(|row| WrongProgram { name: row.id.to_owned(), student: Student::new(Some(row.mistake)) });
    let mutants = mutants().map(|mutant| WrongProgram {
        name: mutant.id.to_owned(),
        student: Student::default().with_change(&mutant.change),
    });
    let changed = mutations().into_iter().filter(|mutation| equivalent(*mutation).is_none());
    let changed = changed.map(|mutation| WrongProgram {
        name: mutation.to_string(),
        student: Student::default().with_mutation(mutation),
    });
    rows.chain(mutants).chain(changed).collect()
}

/// The names of the first scenes that refuse a program; no more are looked for than `enough`.
#[must_use]
pub fn witnesses(scenes: &[Watched], student: Student, enough: usize) -> Vec<&str> {
    scenes.iter().filter(|scene| scene.refuses(student)).map(|scene| scene.name.as_str()).take(enough).collect()
}

#[cfg(test)]
mod tests;
