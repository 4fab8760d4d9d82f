//! The products that a wrong coefficient may contain: products of the formula's letters, and several products with
//! quantities from outside the formula.
use fosssim_num::bounded::BoundedValue;
use fosssim_student::assignments::t2m2::{
    Inputs, Subject,
    extra_letters::{HALF_PLANE_EXTRAS, extra_letters},
    formulas::{Formula, Letter, product},
};
use std::borrow::Cow;

/// A product of letters.
pub(super) struct Product {
    /// The indices of the product's letters in the dictionary, ascending.
    pub letters: Vec<usize>,
    /// The product's degree in the displacements.
    pub order: u8,
    /// Whether the product contains a quantity from outside the formula.
    pub is_foreign: bool,
}

/// The products of one formula.
pub(super) struct Dictionary {
    letters: Vec<&'static Letter>,
    /// The products that are tried as terms of a coefficient.
    pub products: Vec<Product>,
}

impl Dictionary {
    /// Creates the dictionary of a polynomial's formula.
    pub fn new(subject: Subject, formula: &'static Formula) -> Self {
        let own_count = formula.letters.len();
        let is_new = |extra: &&'static Letter| {
            let bare = extra.name.trim_matches(['(', ')']);
            formula.letters.iter().all(|letter| letter.name != bare && letter.meaning != bare)
        };
        let letters: Vec<&Letter> =
            formula.letters.iter().chain(extra_letters(subject).iter().filter(is_new)).collect();
        let mut lists: Vec<Vec<usize>> = Vec::new();
        let longest = formula.terms.iter().map(|term| term.letters.len()).max().unwrap_or(1);
        match longest {
            1 => lists.extend((0..letters.len()).map(|letter| vec![letter])),
            2 => {
                lists.extend(two_letter_products(own_count));
                lists.extend((0..own_count).map(|letter| vec![letter]));
                lists.extend(foreign_products(subject, own_count));
            }
            _ => lists.extend(three_letter_products(own_count)),
        }
        let products = lists
            .into_iter()
            .map(|list| Product {
                order: list.iter().map(|&index| letters[index].order).sum(),
                is_foreign: list.iter().any(|&index| index >= own_count),
                letters: list,
            })
            .collect();
        Self { letters, products }
    }

    /// Returns the values of all products, in order.
    pub fn evaluate(&self, inputs: &Inputs) -> Vec<BoundedValue> {
        let letters: Vec<BoundedValue> = self.letters.iter().map(|letter| (letter.value)(inputs)).collect();
        self.products.iter().map(|entry| product(&letters, &entry.letters)).collect()
    }

    /// Returns the weight of a product in the formula's coefficient of this power.
    pub fn weight(&self, formula: &Formula, power: usize, product: usize) -> f64 {
        let letters = &self.products[product].letters;
        let matching = formula.terms.iter().filter(|term| term.power == power && term.letters == letters);
        matching.fold(0.0, |sum, term| sum + term.weight)
    }

    /// Returns the two letters of a product, as separate products, or `None` for products of another length.
    pub fn find_factors(&self, product: usize) -> Option<[usize; 2]> {
        let &[one, two] = &self.products[product].letters[..] else { return None };
        let find_letter = |letter: usize| self.products.iter().position(|entry| entry.letters == [letter]);
        Some([find_letter(one)?, find_letter(two)?])
    }

    /// Returns the names of a product's letters, such as `e` and `h`.
    pub fn letter_names(&self, product: usize) -> Vec<Cow<'static, str>> {
        self.products[product].letters.iter().map(|&index| self.letters[index].name.into()).collect()
    }
}

fn two_letter_products(count: usize) -> impl Iterator<Item = Vec<usize>> {
    (0..count).flat_map(move |one| (one..count).map(move |two| vec![one, two]))
}

fn three_letter_products(count: usize) -> impl Iterator<Item = Vec<usize>> {
    (0..count)
        .flat_map(move |one| (one..count).flat_map(move |two| (two..count).map(move |three| vec![one, two, three])))
}

/// Returns products with letters from outside the formula, for the quartic and for half-planes. In the dictionary these
/// letters come after the `own` letters of the formula.
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
