//! Explains students with one mistake each on random motions. The explanation must name the mistake and reproduce
//! everything.
mod catalog;
mod radius;

use super::*;
use crate::diagnose::{CoefficientGuess, ExamplePlace, Substitute, Weight};
use fosssim_model::sim::{Pair, PairMotion, PointMotion};
use fosssim_num::{polynomial::trim, vector::Vec2};
use fosssim_student::assignments::t2m2::{Input, Reading};

/// A generator of numbers without a pattern, the same in every run.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self, size: f64) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0) * size
    }

    fn vector(&mut self, size: f64) -> Vec2 {
        Vec2::new(self.next(size), self.next(size))
    }

    fn body(&mut self) -> PointMotion {
        PointMotion { start: self.vector(3.0), shift: self.vector(0.7) }
    }

    fn radius(&mut self) -> f64 {
        0.3 + self.next(0.2)
    }

    fn motion(&mut self, kind: PairKind) -> PairMotion {
        match kind {
            PairKind::ParticleParticle => {
                PairMotion::Particles { centers: [self.body(), self.body()], radii: [self.radius(), self.radius()] }
            }
            PairKind::ParticleEdge => PairMotion::Edge {
                center: self.body(),
                ends: [self.body(), self.body()],
                radii: [self.radius(), self.radius()],
            },
            PairKind::ParticleHalfPlane => PairMotion::HalfPlane {
                center: self.body(),
                radius: self.radius(),
                point: self.vector(3.0),
                normal: self.vector(2.0),
            },
        }
    }
}

type Lists = Vec<Vec<f64>>;

/// Returns samples of one kind with a student's polynomials, trimmed like in the course's library.
fn samples(kind: PairKind, count: u32, student: impl Fn(&PairMotion) -> Lists) -> Vec<Sample> {
    let mut numbers = Numbers(11);
    (0..count)
        .map(|index| {
            let motion = numbers.motion(kind);
            let polynomials = student(&motion).iter().map(|list| trim(list).to_vec()).collect();
            let pair = Pair { kind, first: 0, second: 1 };
            Sample { step: 1 + index / 4, pass: index % 2, pair, motion, polynomials }
        })
        .collect()
}

/// The letters of the quartic, in plain arithmetic.
#[derive(Clone, Copy)]
struct Letters {
    a: f64,
    b: f64,
    c: f64,
    d: f64,
    e: f64,
    f: f64,
    g: f64,
    h: f64,
    i: f64,
    s: f64,
}

fn letters(motion: &PairMotion) -> Letters {
    let PairMotion::Edge { center: one, ends: [two, three], radii: [r1, re] } = motion else { panic!("no edge") };
    let (w0, w1) = (one.start - two.start, one.shift - two.shift);
    let (e0, e1) = (three.start - two.start, three.shift - two.shift);
    Letters {
        a: w0.dot(&e0),
        b: w0.dot(&e1) + w1.dot(&e0),
        c: w1.dot(&e1),
        d: w0.dot(&w0),
        e: w0.dot(&w1),
        f: w1.dot(&w1),
        g: e0.dot(&e0),
        h: e0.dot(&e1),
        i: e1.dot(&e1),
        s: (r1 + re) * (r1 + re),
    }
}

fn quartic(l: &Letters) -> Vec<f64> {
    let &Letters { a, b, c, d, e, f, g, h, i, s } = l;
    vec![
        c * c - f * i,
        2.0 * b * c - 2.0 * e * i - 2.0 * f * h,
        2.0 * c * a + b * b - d * i - f * g - 4.0 * e * h + s * i,
        2.0 * a * b - 2.0 * d * h - 2.0 * e * g + 2.0 * s * h,
        a * a - d * g + s * g,
    ]
}

/// Returns the supplied quintic, or with `slip` false the mathematically right one. `d` is an argument because one
/// student confuses it with another letter.
fn quintic(l: &Letters, d: f64, slip: bool) -> Vec<f64> {
    let (a, b, c, e, f, g, h) = (l.g, l.h, l.i, l.e, l.a, l.b, l.c);
    let (i, j) = (-g, -h);
    let (k, el, m, n, o) = (a * f, a * g + 2.0 * b * f, a * h + 2.0 * b * g + c * f, c * g + 2.0 * b * h, c * h);
    let second = if slip { f * g * c } else { f * h * c };
    vec![
        -h * h * c - c * c * d - 2.0 * o * j,
        -h * h * b - 2.0 * g * h * c - 4.0 * b * c * d - c * c * e - o * i - 2.0 * n * j,
        -2.0 * g * h * b
            - 2.0 * second
            - g * g * c
            - 2.0 * a * c * d
            - 4.0 * b * b * d
            - 4.0 * b * c * e
            - n * i
            - 2.0 * m * j,
        -2.0 * f * h * b
            - g * g * b
            - 2.0 * f * g * c
            - 4.0 * a * b * d
            - 2.0 * a * c * e
            - 4.0 * b * b * e
            - m * i
            - 2.0 * el * j,
        -2.0 * f * g * b - f * f * c - a * a * d - 4.0 * a * b * e - el * i - 2.0 * k * j,
        -f * f * b - a * a * e - k * i,
    ]
}

fn edge_lists(motion: &PairMotion) -> Lists {
    let l = letters(motion);
    let high = vec![l.i - l.c, 2.0 * l.h - l.b, l.g - l.a];
    vec![quartic(&l), vec![l.c, l.b, l.a], high, quintic(&l, l.f, true)]
}

fn particle_lists(motion: &PairMotion) -> Lists {
    let PairMotion::Particles { centers: [one, two], radii: [r1, r2] } = motion else { panic!("no particles") };
    let (x, d, r) = (two.start - one.start, two.shift - one.shift, r1 + r2);
    vec![vec![-d.dot(&d), -2.0 * x.dot(&d), r * r - x.dot(&x)], vec![-d.dot(&d), -d.dot(&x)]]
}

fn half_plane_lists(motion: &PairMotion) -> Lists {
    let PairMotion::HalfPlane { center: body, radius, point, normal } = motion else { panic!("no half-plane") };
    let (s, w) = (body.shift.dot(normal), (*point - body.start).dot(normal));
    vec![vec![-s * s, 2.0 * w * s, radius * radius * normal.dot(normal) - w * w], vec![-s * s, w * s]]
}

fn right_lists(motion: &PairMotion) -> Lists {
    match motion.kind() {
        PairKind::ParticleParticle => particle_lists(motion),
        PairKind::ParticleEdge => edge_lists(motion),
        PairKind::ParticleHalfPlane => half_plane_lists(motion),
    }
}

/// Checks that a student has only one explanation, which reproduces everything and has this key and a matching detail.
fn only(
    kind: PairKind,
    key: &str,
    is_told: impl Fn(&PolynomialDetail) -> bool,
    student: impl Fn(&PairMotion) -> Lists,
) -> Explanation {
    let found = explain_polynomials(&samples(kind, 300, student));
    let [one] = &found[..] else { panic!("{key}: {found:#?}") };
    assert_eq!(one.key, key, "{one:#?}");
    assert_eq!(one.reproduced, one.samples, "{one:#?}");
    assert!(has(one, is_told) && one.example.is_some(), "{key}: {one:#?}");
    one.clone()
}

/// Returns whether one of the explanation's details matches.
fn has(one: &Explanation, is_told: impl Fn(&PolynomialDetail) -> bool) -> bool {
    one.details.iter().any(|detail| matches!(detail, Detail::Polynomial(detail) if is_told(detail)))
}

/// Returns a test whether the product of these letters has another weight in the coefficient of this power.
fn weight(power: usize, letters: &str, actual: f64, expected: f64) -> impl Fn(&PolynomialDetail) -> bool {
    move |detail| {
        let PolynomialDetail::Weight(weight) = detail else { return false };
        let told = Weight { power, actual, expected, ..weight.clone() };
        *weight == told && weight.letters.join(" ") == letters
    }
}

/// Returns a test for the guess that another quantity replaces this letter of the assignment's formula.
fn stands(subject: Subject, letter: &'static str, stand: Substitute) -> impl Fn(&PolynomialDetail) -> bool {
    let reading = Reading { subject, number: 0 };
    move |detail| *detail == PolynomialDetail::StandsFor { reading, letter: letter.into(), stand: stand.clone() }
}

/// Returns a test for exactly this detail.
fn is(told: PolynomialDetail) -> impl Fn(&PolynomialDetail) -> bool {
    move |detail| *detail == told
}

#[test]
fn right_polynomials_need_no_explanation() {
    for kind in PairKind::ALL {
        assert_eq!(explain_polynomials(&samples(kind, 300, right_lists)), []);
        for scale in [3.0, 1e-3, 1e6] {
            let scaled = explain_polynomials(&samples(kind, 300, |motion| {
                right_lists(motion).iter().map(|list| list.iter().map(|value| value * scale).collect()).collect()
            }));
            assert_eq!(scaled, [], "{scale}");
        }
        let each_its_own = explain_polynomials(&samples(kind, 300, |motion| {
            let scale = |list: &[f64]| 0.1 + list.iter().map(|value| value.abs()).sum::<f64>();
            right_lists(motion).iter().map(|list| list.iter().map(|value| value / scale(list)).collect()).collect()
        }));
        assert_eq!(each_its_own, []);
    }
}

#[test]
fn the_right_quintic_is_as_good_as_the_supplied_one() {
    let student = |motion: &PairMotion| {
        let l = letters(motion);
        let mut lists = edge_lists(motion);
        lists[3] = quintic(&l, l.f, false);
        lists
    };
    assert_eq!(explain_polynomials(&samples(PairKind::ParticleEdge, 300, student)), []);
}

#[test]
fn one_wrong_term_of_the_quartic_is_named() {
    type Change = fn(&Letters) -> f64;
    let changes: [(usize, &str, &str, f64, f64, Change); 14] = [
        (4, "term-missing", "f i", 0.0, -1.0, |l| l.f * l.i),
        (4, "term-sign", "f i", 1.0, -1.0, |l| 2.0 * l.f * l.i),
        (3, "term-factor", "b c", 1.0, 2.0, |l| -l.b * l.c),
        (3, "term-factor", "e i", -1.0, -2.0, |l| l.e * l.i),
        (3, "term-sign", "f h", 2.0, -2.0, |l| 4.0 * l.f * l.h),
        (2, "term-missing", "e h", 0.0, -4.0, |l| 4.0 * l.e * l.h),
        (2, "term-factor", "e h", -2.0, -4.0, |l| 2.0 * l.e * l.h),
        (2, "term-missing", "b b", 0.0, 1.0, |l| -l.b * l.b),
        (2, "term-factor", "a c", 1.0, 2.0, |l| -l.c * l.a),
        (2, "term-factor", "i R^2", 2.0, 1.0, |l| l.s * l.i),
        (1, "term-missing", "d h", 0.0, -2.0, |l| 2.0 * l.d * l.h),
        (1, "term-factor", "h R^2", 1.0, 2.0, |l| -l.s * l.h),
        (0, "term-sign", "a a", -1.0, 1.0, |l| -2.0 * l.a * l.a),
        (0, "term-foreign", "a g", 1.0, 0.0, |l| l.a * l.g),
    ];
    for (power, key, product, actual, expected, change) in changes {
        only(PairKind::ParticleEdge, key, weight(power, product, actual, expected), |motion| {
            let mut lists = edge_lists(motion);
            lists[0][4 - power] += change(&letters(motion));
            lists
        });
    }
}

#[test]
fn mistakes_in_two_coefficients_are_both_named_whatever_the_scale() {
    for scale in [1.0, 7.0] {
        let student = |motion: &PairMotion| {
            let l = letters(motion);
            let mut lists = edge_lists(motion);
            lists[0][1] = 2.0 * l.b * l.c - 2.0 * l.e * l.i + 2.0 * l.f * l.h;
            lists[0][2] += l.s * l.i;
            lists[0].iter_mut().for_each(|value| *value *= scale);
            lists
        };
        let one = only(PairKind::ParticleEdge, "coefficients", weight(3, "f h", 2.0, -2.0), student);
        assert!(has(&one, weight(2, "i R^2", 2.0, 1.0)), "{one:#?}");
        let (subjects, wrong) = (vec![Subject::EdgeOverlap], CoefficientGuess::Several);
        let found = PolynomialEvidence::Guess(Guess::Coefficients { powers: vec![3, 2], wrong });
        assert_eq!(one.topic, ExplanationTopic::Polynomials { subjects, found });
    }
}

#[test]
fn a_scale_of_its_own_for_every_polynomial_hides_no_term() {
    only(PairKind::ParticleEdge, "term-missing", weight(2, "e h", 0.0, -4.0), |motion| {
        let l = letters(motion);
        let mut lists = edge_lists(motion);
        lists[0][2] += 4.0 * l.e * l.h;
        lists[0].iter_mut().for_each(|value| *value /= l.g);
        lists
    });
}

#[test]
fn one_wrong_letter_is_named() {
    let square = Substitute::Dot { vectors: ["x21".into(), "x21".into()], negated: false };
    only(PairKind::ParticleEdge, "letter", stands(Subject::EdgeApproach, "d", square), |motion| {
        let l = letters(motion);
        let mut lists = edge_lists(motion);
        lists[3] = quintic(&l, l.d, true);
        lists
    });
    only(
        PairKind::ParticleEdge,
        "letter-factor",
        stands(Subject::EdgeOverlap, "h", Substitute::Scaled(0.5)),
        |motion| {
            let mut l = letters(motion);
            let mut lists = edge_lists(motion);
            l.h *= 0.5;
            lists[0] = quartic(&l);
            lists
        },
    );
}

#[test]
fn wrong_radii_are_named() {
    type Square = fn(f64, f64) -> f64;
    let squares: [(&str, Square); 6] = [
        ("radii-squared-apart", |r1, r2| r1 * r1 + r2 * r2),
        ("radius-not-squared", |r1, r2| r1 + r2),
        ("first-radius-only", |r1, _| r1 * r1),
        ("second-radius-only", |_, r2| r2 * r2),
        ("no-radius", |_, _| 0.0),
        ("diameters", |r1, r2| 4.0 * (r1 + r2) * (r1 + r2)),
    ];
    for (key, square) in squares {
        only(
            PairKind::ParticleEdge,
            key,
            is(PolynomialDetail::Named { key: key.into(), has_only_edge_pairs: true }),
            |motion| {
                let PairMotion::Edge { radii: [r1, re], .. } = motion else { panic!("no edge") };
                let mut lists = edge_lists(motion);
                lists[0] = quartic(&Letters { s: square(*r1, *re), ..letters(motion) });
                lists
            },
        );
        only(
            PairKind::ParticleParticle,
            key,
            is(PolynomialDetail::Named { key: key.into(), has_only_edge_pairs: false }),
            |motion| {
                let PairMotion::Particles { radii: [r1, r2], .. } = motion else { panic!("no particles") };
                let mut lists = particle_lists(motion);
                lists[0][2] += square(*r1, *r2) - (r1 + r2) * (r1 + r2);
                lists
            },
        );
    }
}

/// A mistake in the inputs appears in several polynomials, and is reported once.
#[test]
fn wrong_inputs_are_one_explanation_for_all_polynomials() {
    type Change = fn(&mut [PointMotion; 3]);
    let changes: [(&str, Change); 5] = [
        ("end-positions", |bodies| bodies.iter_mut().for_each(|body| body.start += body.shift)),
        ("edge-still", |bodies| bodies[1..].iter_mut().for_each(|body| body.shift = Vec2::zeros())),
        ("first-displacement-twice", |bodies| bodies[2].shift = bodies[1].shift),
        ("displacements-swapped", |[_, two, three]| std::mem::swap(&mut two.shift, &mut three.shift)),
        ("end-for-displacement", |bodies| bodies.iter_mut().for_each(|body| body.shift += body.start)),
    ];
    for (key, change) in changes {
        let one = only(
            PairKind::ParticleEdge,
            key,
            |_| true,
            |motion| {
                let mut motion = *motion;
                if let PairMotion::Edge { center, ends: [first, second], .. } = &mut motion {
                    let mut points = [*center, *first, *second];
                    change(&mut points);
                    [*center, *first, *second] = points;
                }
                edge_lists(&motion)
            },
        );
        assert_eq!(one.samples, 1200, "{one:#?}");
        let ExplanationTopic::Polynomials { subjects, .. } = &one.topic else { panic!("{one:#?}") };
        assert_eq!(subjects[..], *Subject::all_of_kind(PairKind::ParticleEdge), "{one:#?}");
    }
}

#[test]
fn lists_handed_over_wrongly_are_named() {
    type Change = fn(&mut Lists);
    let changes: [(&str, Change); 6] = [
        ("reversed", |lists| lists.iter_mut().for_each(|list| list.reverse())),
        ("negated", |lists| lists.iter_mut().flatten().for_each(|value| *value *= -1.0)),
        ("all-zero", |lists| lists.iter_mut().flatten().for_each(|value| *value = 0.0)),
        ("all-equal", |lists| lists.iter_mut().flatten().for_each(|value| *value = 1e-11)),
        ("single-precision", |lists| lists.iter_mut().flatten().for_each(|value| *value = f64::from(*value as f32))),
        ("monic", |lists| {
            for list in lists {
                let leading = list[0];
                list.iter_mut().for_each(|value| *value /= leading);
            }
        }),
    ];
    for kind in PairKind::ALL {
        for (key, change) in changes {
            let found = explain_polynomials(&samples(kind, 300, |motion| {
                let mut lists = right_lists(motion);
                change(&mut lists);
                lists
            }));
            assert_eq!(found.len(), 1, "{key}: {found:#?}");
            assert_eq!((found[0].key.as_str(), found[0].reproduced), (key, found[0].samples), "{found:#?}");
        }
        // NaN proves nothing about a formula.
        let nan = |motion: &PairMotion| right_lists(motion).iter().map(|list| vec![f64::NAN; list.len()]).collect();
        assert_eq!(explain_polynomials(&samples(kind, 300, nan)), []);
    }
}

#[test]
fn exchanged_cut_and_constant_polynomials_are_named() {
    let high = PolynomialDetail::InPlaceOf { used: Subject::AlphaHigh, expected: Subject::AlphaLow };
    let swapped = only(PairKind::ParticleEdge, "other-polynomial", is(high), |motion| {
        let mut lists = edge_lists(motion);
        lists.swap(1, 2);
        lists
    });
    assert_eq!(swapped.samples, 600);
    only(PairKind::ParticleEdge, "cut", is(PolynomialDetail::LastOnly(3)), |motion| {
        let mut lists = edge_lists(motion);
        lists[0].drain(..2);
        lists
    });
    only(PairKind::ParticleEdge, "constant", is(PolynomialDetail::Holds(1.0)), |motion| {
        let mut lists = edge_lists(motion);
        lists[3] = vec![1.0];
        lists
    });
    only(PairKind::ParticleParticle, "cut", is(PolynomialDetail::LastOnly(1)), |motion| {
        let mut lists = particle_lists(motion);
        lists[1].remove(0);
        lists
    });
    let is_scale = |detail: &PolynomialDetail| matches!(detail, PolynomialDetail::Displacements(_));
    only(PairKind::ParticleEdge, "displacement-scale", is_scale, |motion| {
        let mut lists = edge_lists(motion);
        let mut power = 1.0;
        for value in lists[0].iter_mut().rev() {
            *value *= power;
            power *= 100.0;
        }
        lists
    });
}

#[test]
fn small_slips_in_quadratics_are_named() {
    type Told<'a> = &'a dyn Fn(&PolynomialDetail) -> bool;
    let overlap = |key: &str, told: Told, change: &dyn Fn(&mut Lists)| {
        only(PairKind::ParticleParticle, key, told, |motion| {
            let mut lists = particle_lists(motion);
            change(&mut lists);
            lists
        })
    };
    overlap("term-factor", &weight(1, "x21.d21", -1.0, -2.0), &|lists| lists[0][1] *= 0.5);
    overlap("term-sign", &weight(2, "d21.d21", 1.0, -1.0), &|lists| lists[0][0] *= -1.0);
    overlap("cut", &is(PolynomialDetail::LastOnly(2)), &|lists| lists[0][0] = 0.0);
    let is_tiny = |detail: &PolynomialDetail| match detail {
        PolynomialDetail::Factor { power: 0, factor } => (factor - 1.0 - 1e-9).abs() < 1e-14,
        _ => false,
    };
    overlap("coefficient-factor", &is_tiny, &|lists| lists[0][2] *= 1.0 + 1e-9);
    overlap("coefficient-sign", &is(PolynomialDetail::Factor { power: 0, factor: -1.0 }), &|lists| lists[0][2] *= -1.0);
    overlap("term-sign", &weight(0, "x21.d21", 1.0, -1.0), &|lists| lists[1][1] *= -1.0);
    overlap("term-factor", &weight(1, "d21.d21", -2.0, -1.0), &|lists| lists[1][0] *= 2.0);
    let half_plane = |key: &str, told: Told, change: &dyn Fn(&PairMotion, &mut Lists)| {
        only(PairKind::ParticleHalfPlane, key, told, |motion| {
            let mut lists = half_plane_lists(motion);
            change(motion, &mut lists);
            lists
        })
    };
    let n_square = |motion: &PairMotion| match motion {
        PairMotion::HalfPlane { normal, radius, .. } => (normal.dot(normal), radius * radius),
        _ => panic!("no half-plane"),
    };
    let exchange = |key: &'static str| is(PolynomialDetail::Named { key: key.into(), has_only_edge_pairs: false });
    half_plane("no-normal-square", &exchange("no-normal-square"), &|motion, lists| {
        let (n, r) = n_square(motion);
        lists[0][2] += r - r * n;
    });
    half_plane("normal-length", &exchange("normal-length"), &|motion, lists| {
        let (n, r) = n_square(motion);
        lists[0][2] += r * n.sqrt() - r * n;
    });
    half_plane("letter", &stands(Subject::HalfPlaneApproach, "(dx.n)", Substitute::One), &|motion, lists| {
        let PairMotion::HalfPlane { center: body, point, normal, .. } = motion else { panic!("no half-plane") };
        lists[1] = vec![-1.0, (*point - body.start).dot(normal)];
    });
    only(PairKind::ParticleEdge, "term-missing", weight(1, "d13.x23", 0.0, 1.0), |motion| {
        let PairMotion::Edge { center: one, ends: [two, three], .. } = motion else { panic!("no edge") };
        let mut lists = edge_lists(motion);
        lists[2][1] = (one.start - three.start).dot(&(two.shift - three.shift));
        lists
    });
    only(
        PairKind::ParticleEdge,
        "one-unscaled",
        is(PolynomialDetail::Named { key: "one-unscaled".into(), has_only_edge_pairs: true }),
        |motion| {
            let mut lists = edge_lists(motion);
            lists[2] = lists[1].iter().map(|value| -value).collect();
            lists[2][2] += 1.0;
            lists
        },
    );
}

/// A mistake in only half of the pairs is reported with its share. An error that is no simple mistake is reported as
/// unexplained.
#[test]
fn partly_reproduced_mistakes_are_marked() {
    let partly = explain_polynomials(&samples(PairKind::ParticleEdge, 300, |motion| {
        let mut lists = edge_lists(motion);
        if lists[1][2] > 0.0 {
            lists[0].reverse();
        }
        lists
    }));
    assert_eq!(partly.len(), 1);
    assert_eq!(partly[0].key, "reversed");
    assert!(partly[0].reproduced > 50 && partly[0].reproduced < partly[0].samples, "{partly:#?}");
    let noise = explain_polynomials(&samples(PairKind::ParticleEdge, 300, |motion| {
        let mut lists = edge_lists(motion);
        lists[0][2] += (lists[0][4] * 100.0).abs().sqrt();
        lists
    }));
    assert_eq!((noise[0].key.as_str(), noise[0].reproduced), ("unexplained", 0));
}

#[test]
fn hostile_samples_do_no_harm() {
    let strange = [f64::NAN, f64::INFINITY, 1e300, -0.0, 5e-324];
    for kind in PairKind::ALL {
        let mut list = samples(kind, 40, right_lists);
        for (index, sample) in list.iter_mut().enumerate() {
            let value = strange[index % strange.len()];
            match index % 4 {
                0 => sample.polynomials.clear(),
                1 => sample.polynomials[0] = vec![value; index],
                2 => sample.polynomials[1].clear(),
                _ => {
                    let (PairMotion::HalfPlane { center: body, .. }
                    | PairMotion::Particles { centers: [body, _], .. }
                    | PairMotion::Edge { center: body, .. }) = &mut sample.motion;
                    body.start.x = value;
                }
            }
        }
        for explanation in explain_polynomials(&list) {
            assert!(explanation.reproduced <= explanation.samples);
        }
    }
    assert_eq!(explain_polynomials(&[]), []);
}

/// The example has the shortest numbers, and then the earliest step.
#[test]
fn the_example_is_the_roundest_one() {
    let mut list = samples(PairKind::ParticleParticle, 50, |motion| {
        let mut lists = particle_lists(motion);
        lists[0].reverse();
        lists
    });
    let still = |x: f64, dx: f64| PointMotion { start: Vec2::new(x, 0.0), shift: Vec2::new(dx, 0.0) };
    list[20].motion = PairMotion::Particles { centers: [still(0.0, 1.0), still(4.0, -1.0)], radii: [1.0, 1.0] };
    list[20].polynomials = vec![vec![-12.0, 16.0, -4.0], vec![-4.0, 8.0]];
    let found = explain_polynomials(&list);
    let example = found[0].example.as_ref().expect("there is a wrong sample");
    let place = ExamplePlace::Given { pair: list[20].pair, pass: 0, subject: Subject::ParticleOverlap };
    assert_eq!(example.place, place);
    assert_eq!((&example.expected[..], &example.actual[..]), (&[-4.0, 16.0, -12.0][..], &[-12.0, 16.0, -4.0][..]));
    assert_eq!((example.given[0].input, &example.given[0].value[..]), (Input::X1, &[0.0, 0.0][..]));
}
