//! Which scenes see that a program is wrong: the measure of suites and probe scenes.
use crate::{
    mutants::mutants,
    operators::{equivalent, mutations},
};
use fosssim_oracle::{
    judge::{
        fair::FairVerdict,
        replay::{Options, judge},
    },
    scene::Scene,
    student::{self, CATALOGUE, RowKind, Student},
};

/// A scene with the trace of a right program.
#[derive(Debug)]
pub struct Watched {
    /// Its name.
    pub name: String,
    /// The scene.
    pub scene: Scene,
    right: Vec<u8>,
}

impl Watched {
    /// Prepares a scene.
    #[must_use]
    pub fn new(name: String, scene: Scene) -> Self {
        let right = trace(&scene, Student::default());
        Self { name, scene, right }
    }

    /// Whether the fair rules refuse what this program writes; a program that does not come to an end has written less.
    #[must_use]
    pub fn refuses(&self, student: Student) -> bool {
        let trace = trace(&self.scene, student);
        let options = Options { threads: 1, fair: true, ..Options::default() };
        let refused = || judge(&self.scene, &trace[..], &options, &mut ()).fair.map(|fair| fair.verdict);
        trace != self.right && refused() != Some(FairVerdict::Accepted)
    }

    /// How long it takes to look at the scene, roughly.
    #[must_use]
    pub fn work(&self) -> usize {
        self.right.len()
    }
}

fn trace(scene: &Scene, student: Student) -> Vec<u8> {
    student::trace(scene, student).unwrap_or_else(|(bytes, _)| bytes)
}

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
