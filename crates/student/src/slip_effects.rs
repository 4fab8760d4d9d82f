//! The effects of a student's slips on the quantities that the program computes.
use super::{
    Mistake, StepMistake,
    author::Student,
    world::{World, add, subtract},
};
use crate::assignments::states::{Edit, Slip, Term};
use fosssim_num::vector::{Vec2, set_vector};

/// A particle's part of a quantity, and the data on which its slips may depend.
#[derive(Clone, Copy)]
pub struct TermPart {
    pub term: Term,
    pub particle: usize,
    /// The first body of the pair.
    pub first: usize,
    /// The role of the body: 0 for the first body of a pair, 1 and 2 for the others.
    pub role: usize,
    /// The distance between the bodies.
    pub length: f64,
    /// Whether the part is subtracted.
    pub is_negative: bool,
}

impl TermPart {
    /// Returns a particle's part of a quantity without pairs. The part is added.
    pub const fn from_term(term: Term, particle: usize) -> Self {
        Self { term, particle, first: particle, role: 0, length: 1.0, is_negative: false }
    }
}

impl Student {
    /// Returns the slips in a quantity, or in a quantity of which it is a part.
    pub fn slips(&self, term: Term) -> impl Iterator<Item = Slip> {
        self.edits().filter(move |edit| edit.term.covers(term)).map(|edit| edit.slip)
    }

    /// Returns whether the student makes this slip in the quantity.
    pub fn makes_slip(&self, term: Term, slip: Slip) -> bool {
        self.edits().any(|edit| edit.slip == slip && edit.term.covers(term))
    }

    fn edits(&self) -> impl Iterator<Item = Edit> {
        self.mistakes().take_while(|_| self.has_slips).filter_map(|mistake| match mistake {
            Mistake::Step(StepMistake::Edit(edit)) => Some(edit),
            _ => None,
        })
    }
}

impl World {
    /// Returns the factor by which the student's slips multiply a quantity. Slips in larger quantities that contain it
    /// do not count. `length` is the distance between the bodies.
    pub fn weight(&self, term: Term, length: f64) -> f64 {
        let own = self.student.edits().filter(|edit| edit.term == term);
        own.map(|edit| self.factor(edit, 0, length)).product()
    }

    /// Returns the factor by which the student's slips multiply a particle's part of a quantity. Slips in larger
    /// quantities that contain it count as well.
    pub fn whole_weight(&self, term: Term, particle: usize, length: f64) -> f64 {
        let all = self.student.edits().filter(|edit| edit.term.covers(term));
        all.map(|edit| self.factor(edit, particle, length)).product()
    }

    /// Returns the factor by which a slip multiplies a quantity, or 1 if the slip has another effect.
    fn factor(&self, Edit { term, slip }: Edit, particle: usize, length: f64) -> f64 {
        let mass = self.masses[2 * particle];
        let mass_factor = |used: f64| if term.row().mass < 0 { mass / used } else { used / mass };
        let power = |base: f64, by: i8| {
            let product: f64 = (0..by.unsigned_abs()).map(|_| base).product();
            if by < 0 { 1.0 / product } else { product }
        };
        match slip {
            Slip::Missing => 0.0,
            Slip::Sign => -1.0,
            Slip::Doubled => 2.0,
            Slip::Halved => 0.5,
            Slip::Mass(by) => power(mass, by),
            Slip::WholeMass => mass_factor(mass.trunc()),
            Slip::MassIndex => mass_factor(self.masses[particle]),
            Slip::MassOfFirst => mass_factor(self.masses[0]),
            Slip::Step(by) => power(self.scene.time_step, by),
            Slip::Length(by) => power(length, by),
            _ => 1.0,
        }
    }

    /// Adds a part to a sum over all particles, or subtracts it, as this student's program does.
    pub fn contribute(&self, sum: &mut [f64], part: TermPart, value: Vec2) {
        let TermPart { term, particle, first, role, length, is_negative } = part;
        let last = self.scene.particles.len() - 1;
        let (mut value, mut is_assigned) = (value, false);
        for edit in self.student.edits().filter(|edit| edit.term.covers(term)) {
            match edit.slip {
                Slip::FirstOnly if role > 0 => return,
                Slip::SecondOnly if role == 0 => return,
                Slip::WithoutFirstParticle if particle == 0 => return,
                Slip::WithoutLastParticle if particle == last => return,
                Slip::OnlyFirstParticle if particle > 0 => return,
                Slip::OneEnd if role == 2 => return,
                Slip::Missing => return,
                // If one statement assigns the whole force, its first part overwrites the previous value.
                Slip::Assigned => is_assigned = term != Term::SpringDamping || edit.term == term,
                Slip::SameSign if role > 0 => value = -value,
                Slip::XOnly => value.y = 0.0,
                Slip::YOnly => value.x = 0.0,
                Slip::Exchanged => value = Vec2::new(value.y, value.x),
                Slip::FirstMass => value *= self.masses[2 * first],
                Slip::XForBoth => value.y = value.x,
                Slip::YForBoth => value.x = value.y,
                _ => value *= self.factor(edit, particle, length),
            }
        }
        match (is_assigned, is_negative) {
            (true, _) => set_vector(sum, particle, if is_negative { -value } else { value }),
            (false, true) => subtract(sum, particle, value),
            (false, false) => add(sum, particle, value),
        }
    }

    /// Adds opposite forces to the gradient of two particles. `push` is the second particle's part.
    pub fn contribute_opposite(&self, g: &mut [f64], term: Term, ends: (usize, usize), push: Vec2, length: f64) {
        let part = |role, particle| {
            let first = ends.0;
            TermPart { first, role, length, is_negative: role == 0, ..TermPart::from_term(term, particle) }
        };
        self.contribute(g, part(0, ends.0), push);
        self.contribute(g, part(1, ends.1), push);
    }

    /// Adds `h` times each rate to the number at the same index of `target`, with the student's slips in this term.
    pub fn advance(&self, term: Term, target: &mut Vec<f64>, h: f64, rates: &[f64]) {
        if self.student.slips(term).next().is_none() {
            *target = self.student.add_scaled_lists(target, h, rates);
            return;
        }
        for particle in 0..target.len() / 2 {
            let value = h * Vec2::new(rates[2 * particle], rates[2 * particle + 1]);
            self.contribute(target, TermPart::from_term(term, particle), value);
        }
    }
}
