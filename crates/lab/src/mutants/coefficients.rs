//! Wrong polynomials.
use super::{Mutant, row};
use fosssim_num::vector::Vec2;
use fosssim_oracle::student::{
    Area,
    hooks::{Change, Encounter, MovingBody},
};

const PP: &str = "particle-particle";
const PE: &str = "particle-edge";
const PH: &str = "particle-half-plane";

/// Changes the lists of two particles, given the vectors between them and the radii.
macro_rules! particles {
    (|$x:ident, $d:ident, $r1:ident, $r2:ident, $lists:ident| $body:expr) => {
        Change::Polynomials(|encounter, $lists| {
            let Encounter::Particles(one, two) = encounter else { return };
            #[allow(unused_variables)]
            let ($x, $d) = (two.start - one.start, two.displacement - one.displacement);
            #[allow(unused_variables)]
            let ($r1, $r2) = (one.radius, two.radius);
            if $lists.len() > 1 && $lists[0].len() == 3 {
                $body
            }
        })
    };
}

/// Changes the lists of a particle and an edge.
macro_rules! edges {
    (|$v:ident, $r:ident, $lists:ident| $body:expr) => {
        Change::Polynomials(|encounter, $lists| {
            let Encounter::Edge(bodies, edge_radius) = encounter else { return };
            #[allow(unused_variables)]
            let ($v, $r) = (Vectors::new(bodies), (bodies[0].radius, *edge_radius));
            $body
        })
    };
}

/// Changes the lists of a particle and a half-plane.
macro_rules! half_planes {
    (|$w:ident, $d:ident, $n:ident, $r:ident, $lists:ident| $body:expr) => {
        Change::Polynomials(|encounter, $lists| {
            let Encounter::HalfPlane(one, point, normal) = encounter else { return };
            #[allow(unused_variables)]
            let ($w, $d, $n, $r) = (*point - one.start, one.displacement, *normal, one.radius);
            $body
        })
    };
}

/// The vectors of a particle and an edge.
struct Vectors {
    x12: Vec2,
    x32: Vec2,
    d12: Vec2,
    d32: Vec2,
}

impl Vectors {
    fn new([one, two, three]: &[MovingBody; 3]) -> Self {
        Self {
            x12: one.start - two.start,
            x32: three.start - two.start,
            d12: one.displacement - two.displacement,
            d32: three.displacement - two.displacement,
        }
    }
}

pub(super) const MUTANTS: &[Mutant] = &[
    row(
        "pp-radii-halved",
        Area::ParticleParticle,
        PP,
        "the sum of the radii is halved before squaring",
        &["(r1 + r2)^2"],
        particles!(|x, d, r1, r2, lists| lists[0][2] -= 0.75 * (r1 + r2) * (r1 + r2)),
    ),
    row(
        "pp-radii-difference",
        Area::ParticleParticle,
        PP,
        "the difference of the radii stands for their sum",
        &["r1 r2", "r1 - r2"],
        particles!(|x, d, r1, r2, lists| lists[0][2] += (r1 - r2) * (r1 - r2) - (r1 + r2) * (r1 + r2)),
    ),
    row(
        "pp-linear-from-end",
        Area::ParticleParticle,
        PP,
        "the linear coefficient takes the offset at the end of the step",
        &["d21.d21", "end"],
        particles!(|x, d, r1, r2, lists| lists[0][1] = -2.0 * (x + d).dot(&d)),
    ),
    row(
        "pp-squares-apart",
        Area::ParticleParticle,
        PP,
        "the squares of both displacements are added, without their product",
        &["dx1.dx2", "d1.d2", "dx1.dx1"],
        Change::Polynomials(|encounter, lists| {
            let Encounter::Particles(one, two) = encounter else { return };
            let (d1, d2) = (one.displacement, two.displacement);
            lists[0][0] = -(d1.dot(&d1) + d2.dot(&d2));
        }),
    ),
    row(
        "pp-approach-second-only",
        Area::ParticleParticle,
        PP,
        "the approach's constant has the second displacement only",
        &["dx1", "dx2"],
        Change::Polynomials(|encounter, lists| {
            let Encounter::Particles(one, two) = encounter else { return };
            lists[1][1] = -(two.start - one.start).dot(&two.displacement);
        }),
    ),
    row(
        "pp-three-for-two",
        Area::ParticleParticle,
        PP,
        "the linear coefficient of the overlap has 3 for 2",
        &["1.5", "3 x21", "3/2"],
        particles!(|x, d, r1, r2, lists| lists[0][1] *= 1.5),
    ),
    row(
        "pe-quartic-no-cc",
        Area::ParticleEdge,
        PE,
        "c^2 is missing in t^4",
        &["c^2", "c c"],
        edges!(|v, r, lists| lists[0][0] -= v.d12.dot(&v.d32) * v.d12.dot(&v.d32)),
    ),
    row(
        "pe-cubic-di-for-ei",
        Area::ParticleEdge,
        PE,
        "d i stands for e i in t^3",
        &["d i", "e i", "letter"],
        edges!(|v, r, lists| {
            let (d, e, i) = (v.x12.dot(&v.x12), v.d12.dot(&v.x12), v.d32.dot(&v.d32));
            lists[0][1] += 2.0 * e * i - 2.0 * d * i;
        }),
    ),
    row(
        "pe-square-cb-for-ca",
        Area::ParticleEdge,
        PE,
        "c b stands for c a in t^2",
        &["c a", "a c", "b c", "letter"],
        edges!(|v, r, lists| {
            let (a, c) = (v.x12.dot(&v.x32), v.d12.dot(&v.d32));
            let b = v.x12.dot(&v.d32) + v.d12.dot(&v.x32);
            lists[0][2] += 2.0 * c * b - 2.0 * c * a;
        }),
    ),
    row(
        "pe-linear-dg-for-dh",
        Area::ParticleEdge,
        PE,
        "d g stands for d h in t",
        &["d h", "d g", "letter"],
        edges!(|v, r, lists| {
            let (d, g, h) = (v.x12.dot(&v.x12), v.x32.dot(&v.x32), v.d32.dot(&v.x32));
            lists[0][3] += 2.0 * d * h - 2.0 * d * g;
        }),
    ),
    row(
        "pe-edge-diameter",
        Area::ParticleEdge,
        PE,
        "the edge's diameter stands for its radius",
        &["re", "r1 + 2"],
        edges!(|v, r, lists| {
            let extra = (r.0 + 2.0 * r.1) * (r.0 + 2.0 * r.1) - (r.0 + r.1) * (r.0 + r.1);
            let (g, h, i) = (v.x32.dot(&v.x32), v.d32.dot(&v.x32), v.d32.dot(&v.d32));
            lists[0][2] += extra * i;
            lists[0][3] += 2.0 * extra * h;
            lists[0][4] += extra * g;
        }),
    ),
    row(
        "pe-radii-multiplied",
        Area::ParticleEdge,
        PE,
        "the radii are multiplied instead of added, in the constant coefficient",
        &["r1", "re", "(r1 + re)^2"],
        edges!(|v, r, lists| {
            let extra = r.0 * r.1 * r.0 * r.1 - (r.0 + r.1) * (r.0 + r.1);
            lists[0][4] += extra * v.x32.dot(&v.x32);
        }),
    ),
    row(
        "pe-alpha-low-difference",
        Area::ParticleEdge,
        PE,
        "the linear coefficient of alpha > 0 subtracts its second product",
        &["d12.x32", "(dx1-dx2).x32"],
        edges!(|v, r, lists| lists[1][1] = v.x12.dot(&v.d32) - v.d12.dot(&v.x32)),
    ),
    row(
        "pe-alpha-high-constant-sign",
        Area::ParticleEdge,
        PE,
        "the constant of alpha < 1 has the wrong sign",
        &["sign", "-1", "x13.x23", "(x1-x3).(x2-x3)"],
        edges!(|v, r, lists| lists[2][2] = -lists[2][2]),
    ),
    row(
        "pe-alpha-high-two",
        Area::ParticleEdge,
        PE,
        "alpha < 1 is alpha < 2",
        &["x32.x32", "g", "1 - "],
        edges!(|v, r, lists| {
            lists[2][0] += v.d32.dot(&v.d32);
            lists[2][1] += 2.0 * v.d32.dot(&v.x32);
            lists[2][2] += v.x32.dot(&v.x32);
        }),
    ),
    row(
        "pe-approach-no-square",
        Area::ParticleEdge,
        PE,
        "the approach's t^2 coefficient is zero",
        &["t^2"],
        edges!(|v, r, lists| lists[3][3] = 0.0),
    ),
    row(
        "pe-approach-halved-linear",
        Area::ParticleEdge,
        PE,
        "the approach's linear coefficient is halved",
        &["t^1", "t:"],
        edges!(|v, r, lists| lists[3][4] *= 0.5),
    ),
    row(
        "ph-whole-displacement",
        Area::ParticleHalfPlane,
        PH,
        "the quadratic coefficient has the whole displacement, not its part along the normal",
        &["dx.dx", "d.d"],
        half_planes!(|w, d, n, r, lists| lists[0][0] = -d.dot(&d)),
    ),
    row(
        "ph-linear-unprojected",
        Area::ParticleHalfPlane,
        PH,
        "the linear coefficient has offset and displacement without the normal",
        &["(p-x).dx", "w.d", "t^1", "t:"],
        half_planes!(|w, d, n, r, lists| lists[0][1] = 2.0 * w.dot(&d)),
    ),
    row(
        "ph-offset-normalised",
        Area::ParticleHalfPlane,
        PH,
        "the offset is divided by the normal's length in the constant coefficient, the radius term is not",
        &["n.n", "|n|"],
        half_planes!(|w, d, n, r, lists| {
            lists[0][2] = r * r * n.dot(&n) - w.dot(&n) * w.dot(&n) / n.dot(&n);
        }),
    ),
    row(
        "ph-approach-modulus",
        Area::ParticleHalfPlane,
        PH,
        "the approach has the modulus of the distance",
        &["side", "modulus", "approach"],
        half_planes!(|w, d, n, r, lists| lists[1][1] = w.dot(&n).abs() * d.dot(&n)),
    ),
];
