//! The products that a wrong coefficient may contain: those of the formula's letters, and some that do not belong.
use super::{
    formulas::{Formula, Letter, product},
    sample::{Inputs, Subject},
};
use fosssim_num::{bounded::Bounded, bounded::Bounded2};

/// A product of letters.
pub(super) struct Product {
    /// Indices into the dictionary's letters, ascending.
    pub letters: Vec<usize>,
    /// Its degree in the displacements.
    pub order: u8,
    /// Whether it takes a quantity from outside the formula.
    pub foreign: bool,
}

/// The products of one formula.
pub(super) struct Dictionary {
    letters: Vec<&'static Letter>,
    /// The candidates for terms.
    pub products: Vec<Product>,
}

impl Dictionary {
    /// The dictionary of a way to write a polynomial down.
    pub fn new(subject: Subject, formula: &'static Formula) -> Self {
        let own = formula.letters.len();
        let is_new = |extra: &&'static Letter| {
            let bare = extra.name.trim_matches(['(', ')']);
            formula.letters.iter().all(|letter| letter.name != bare && letter.meaning != bare)
        };
        let letters: Vec<&Letter> = formula.letters.iter().chain(extras(subject).iter().filter(is_new)).collect();
        let mut lists: Vec<Vec<usize>> = Vec::new();
        let longest = formula.terms.iter().map(|term| term.letters.len()).max().unwrap_or(1);
        match longest {
            1 => lists.extend((0..letters.len()).map(|one| vec![one])),
            2 => {
                lists.extend(products_of_two(0..own));
                lists.extend((0..own).map(|one| vec![one]));
                lists.extend(foreign_products(subject, own));
            }
            _ => lists.extend(products_of_three(own)),
        }
        let products = lists
            .into_iter()
            .map(|list| Product {
                order: list.iter().map(|&index| letters[index].order).sum(),
                foreign: list.iter().any(|&index| index >= own),
                letters: list,
            })
            .collect();
        Self { letters, products }
    }

    /// The values of all products, in their order.
    pub fn values(&self, inputs: &Inputs) -> Vec<Bounded> {
        let letters: Vec<Bounded> = self.letters.iter().map(|letter| (letter.value)(inputs)).collect();
        self.products.iter().map(|entry| product(&letters, &entry.letters)).collect()
    }

    /// The weight that the formula gives to a product in a coefficient.
    pub fn weight(&self, formula: &Formula, power: usize, product: usize) -> f64 {
        let letters = &self.products[product].letters;
        let same = formula.terms.iter().filter(|term| term.power == power && term.letters == letters);
        same.fold(0.0, |sum, term| sum + term.weight)
    }

    /// The name of a product, such as `e h`.
    pub fn name(&self, product: usize) -> String {
        let names: Vec<&str> = self.products[product].letters.iter().map(|&index| self.letters[index].name).collect();
        names.join(" ")
    }

    /// What its letters mean, such as `e = d21.x21`; empty where the names say it.
    pub fn meanings(&self, product: usize) -> Vec<String> {
        let mut list: Vec<String> = self.products[product]
            .letters
            .iter()
            .map(|&index| self.letters[index])
            .filter(|letter| !letter.meaning.is_empty())
            .map(|letter| format!("{} = {}", letter.name, letter.meaning))
            .collect();
        list.dedup();
        list
    }
}

fn products_of_two(range: std::ops::Range<usize>) -> impl Iterator<Item = Vec<usize>> {
    let end = range.end;
    range.flat_map(move |one| (one..end).map(move |two| vec![one, two]))
}

fn products_of_three(count: usize) -> impl Iterator<Item = Vec<usize>> {
    (0..count)
        .flat_map(move |one| (one..count).flat_map(move |two| (two..count).map(move |three| vec![one, two, three])))
}

/// The products with letters from outside: those of [`QUARTIC_EXTRAS`] and [`HALF_PLANE_EXTRAS`], which stand behind the
/// formula's own `own` letters.
fn foreign_products(subject: Subject, own: usize) -> Vec<Vec<usize>> {
    let mut lists = Vec::new();
    match subject {
        Subject::EdgeOverlap => {
            let (first, second) = (own, own + 1);
            for letter in 0..9 {
                lists.extend([vec![letter, first], vec![letter, second]]);
            }
            lists.extend([vec![first, first], vec![first, second], vec![second, second]]);
            for radius in own + 2..own + 6 {
                lists.extend([6, 7, 8].map(|letter| vec![letter, radius]));
            }
        }
        _ => {
            for (index, letter) in HALF_PLANE_EXTRAS.iter().enumerate() {
                let extra = own + index;
                lists.push(vec![extra]);
                if letter.name != "1" {
                    lists.extend((0..own).map(|letter| vec![letter, extra]));
                }
            }
        }
    }
    lists
}

fn extras(subject: Subject) -> &'static [Letter] {
    match subject {
        Subject::ParticleOverlap | Subject::ParticleApproach => PARTICLE_EXTRAS,
        Subject::EdgeOverlap => QUARTIC_EXTRAS,
        Subject::AlphaLow | Subject::AlphaHigh => ALPHA_EXTRAS,
        Subject::EdgeApproach => &[],
        Subject::HalfPlaneOverlap | Subject::HalfPlaneApproach => HALF_PLANE_EXTRAS,
    }
}

fn root(square: Bounded) -> Bounded {
    let value = square.value.sqrt();
    Bounded { value, bound: value + if value > 0.0 { square.bound / value } else { 0.0 } }
}

fn length(vector: Bounded2) -> Bounded {
    root(vector.dot(vector))
}

const fn letter(name: &'static str, order: u8, value: fn(&Inputs) -> Bounded) -> Letter {
    Letter { name, meaning: "", order, value }
}

const PARTICLE_EXTRAS: &[Letter] = &[
    letter("r1^2", 0, |inputs| inputs.radii[0] * inputs.radii[0]),
    letter("r2^2", 0, |inputs| inputs.radii[1] * inputs.radii[1]),
    letter("r1 r2", 0, |inputs| inputs.radii[0] * inputs.radii[1]),
    letter("r1", 0, |inputs| inputs.radii[0]),
    letter("r2", 0, |inputs| inputs.radii[1]),
    letter("|x21|", 0, |inputs| length(inputs.x21())),
    letter("|d21|", 1, |inputs| length(inputs.d21())),
    letter("1", 0, |_| Bounded::exact(1.0)),
    letter("x1.x1", 0, |inputs| inputs.x[0].dot(inputs.x[0])),
    letter("x1.x2", 0, |inputs| inputs.x[0].dot(inputs.x[1])),
    letter("x2.x2", 0, |inputs| inputs.x[1].dot(inputs.x[1])),
    letter("x1.d1", 1, |inputs| inputs.x[0].dot(inputs.d[0])),
    letter("x1.d2", 1, |inputs| inputs.x[0].dot(inputs.d[1])),
    letter("x2.d1", 1, |inputs| inputs.x[1].dot(inputs.d[0])),
    letter("x2.d2", 1, |inputs| inputs.x[1].dot(inputs.d[1])),
    letter("d1.d1", 2, |inputs| inputs.d[0].dot(inputs.d[0])),
    letter("d1.d2", 2, |inputs| inputs.d[0].dot(inputs.d[1])),
    letter("d2.d2", 2, |inputs| inputs.d[1].dot(inputs.d[1])),
    letter("x21.x x21.x", 0, |inputs| inputs.x21().x * inputs.x21().x),
    letter("x21.x d21.x", 1, |inputs| inputs.x21().x * inputs.d21().x),
    letter("d21.x d21.x", 2, |inputs| inputs.d21().x * inputs.d21().x),
];

const QUARTIC_EXTRAS: &[Letter] = &[
    letter("(x12.d32)", 1, |inputs| inputs.x12().dot(inputs.d32())),
    letter("(d12.x32)", 1, |inputs| inputs.d12().dot(inputs.x32())),
    letter("R", 0, |inputs| inputs.radii[0] + inputs.radii[1]),
    letter("r1^2", 0, |inputs| inputs.radii[0] * inputs.radii[0]),
    letter("re^2", 0, |inputs| inputs.radii[1] * inputs.radii[1]),
    letter("r1 re", 0, |inputs| inputs.radii[0] * inputs.radii[1]),
];

const ALPHA_EXTRAS: &[Letter] = &[
    letter("1", 0, |_| Bounded::exact(1.0)),
    letter("x21.x21", 0, |inputs| inputs.x21().dot(inputs.x21())),
    letter("d21.x21", 1, |inputs| inputs.d21().dot(inputs.x21())),
    letter("d21.d21", 2, |inputs| inputs.d21().dot(inputs.d21())),
    letter("(x32.x32)", 0, |inputs| inputs.x32().dot(inputs.x32())),
    letter("(d32.x32)", 1, |inputs| inputs.d32().dot(inputs.x32())),
    letter("(d32.d32)", 2, |inputs| inputs.d32().dot(inputs.d32())),
    letter("(x12.x32)", 0, |inputs| inputs.x12().dot(inputs.x32())),
    letter("(x12.d32)", 1, |inputs| inputs.x12().dot(inputs.d32())),
    letter("(d12.x32)", 1, |inputs| inputs.d12().dot(inputs.x32())),
    letter("(d12.d32)", 2, |inputs| inputs.d12().dot(inputs.d32())),
    letter("R^2", 0, |inputs| inputs.square),
    letter("x1.x2", 0, |inputs| inputs.x[0].dot(inputs.x[1])),
    letter("x1.x3", 0, |inputs| inputs.x[0].dot(inputs.x[2])),
    letter("x2.x3", 0, |inputs| inputs.x[1].dot(inputs.x[2])),
    letter("x2.x2", 0, |inputs| inputs.x[1].dot(inputs.x[1])),
    letter("x3.x3", 0, |inputs| inputs.x[2].dot(inputs.x[2])),
];

const HALF_PLANE_EXTRAS: &[Letter] = &[
    letter("|n|", 0, |inputs| length(inputs.normal())),
    letter("r", 0, |inputs| inputs.radii[0]),
    letter("1", 0, |_| Bounded::exact(1.0)),
    letter("(x.n)", 0, |inputs| inputs.x[0].dot(inputs.normal())),
    letter("(p.n)", 0, |inputs| inputs.x[1].dot(inputs.normal())),
    letter("(dx.dx)", 2, |inputs| inputs.d[0].dot(inputs.d[0])),
    letter("((p-x).(p-x))", 0, |inputs| inputs.x21().dot(inputs.x21())),
    letter("((p-x).dx)", 1, |inputs| inputs.x21().dot(inputs.d[0])),
];
