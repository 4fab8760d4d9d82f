//! Wrong polynomials.
use super::{Mutant, mutant};
use fosssim_num::vector::Vec2;
use fosssim_oracle::student::{
    Area::{ParticleEdge, ParticleHalfPlane, ParticleParticle},
    hooks::{Change, Encounter, MovingBody},
};

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
    mutant("pp-radii-halved", ParticleParticle, "the sum of the radii is halved before squaring")
        .told_by(&["(r1 + r2)^2"])
        .by(particles!(|x, d, r1, r2, lists| lists[0][2] -= 0.75 * (r1 + r2) * (r1 + r2))),
    mutant("pp-radii-difference", ParticleParticle, "the difference of the radii stands for their sum")
        .told_by(&["r1 r2", "r1 - r2"])
        .by(particles!(|x, d, r1, r2, lists| lists[0][2] += (r1 - r2) * (r1 - r2) - (r1 + r2) * (r1 + r2))),
    mutant("pp-linear-from-end", ParticleParticle, "the linear coefficient takes the offset at the end of the step")
        .told_by(&["d21.d21", "end"])
        .by(particles!(|x, d, r1, r2, lists| lists[0][1] = -2.0 * (x + d).dot(&d))),
    mutant("pp-squares-apart", ParticleParticle, "the squares of both displacements are added, without their product")
        .told_by(&["dx1.dx2", "d1.d2", "dx1.dx1"])
        .by(Change::Polynomials(|encounter, lists| {
            let Encounter::Particles(one, two) = encounter else { return };
            let (d1, d2) = (one.displacement, two.displacement);
            lists[0][0] = -(d1.dot(&d1) + d2.dot(&d2));
        })),
    mutant("pp-approach-second-only", ParticleParticle, "the approach's constant has the second displacement only")
        .told_by(&["dx1", "dx2"])
        .by(Change::Polynomials(|encounter, lists| {
            let Encounter::Particles(one, two) = encounter else { return };
            lists[1][1] = -(two.start - one.start).dot(&two.displacement);
        })),
    mutant("pp-three-for-two", ParticleParticle, "the linear coefficient of the overlap has 3 for 2")
        .told_by(&["1.5", "3 x21", "3/2"])
        .by(particles!(|x, d, r1, r2, lists| lists[0][1] *= 1.5)),
    mutant("pe-quartic-no-cc", ParticleEdge, "c^2 is missing in t^4")
        .told_by(&["c^2", "c c"])
        .by(edges!(|v, r, lists| lists[0][0] -= v.d12.dot(&v.d32) * v.d12.dot(&v.d32))),
    mutant("pe-cubic-di-for-ei", ParticleEdge, "d i stands for e i in t^3").told_by(&["d i", "e i", "letter"]).by(
        edges!(|v, r, lists| {
            let (d, e, i) = (v.x12.dot(&v.x12), v.d12.dot(&v.x12), v.d32.dot(&v.d32));
            lists[0][1] += 2.0 * e * i - 2.0 * d * i;
        }),
    ),
    mutant("pe-square-cb-for-ca", ParticleEdge, "c b stands for c a in t^2")
        .told_by(&["c a", "a c", "b c", "letter"])
        .by(edges!(|v, r, lists| {
            let (a, c) = (v.x12.dot(&v.x32), v.d12.dot(&v.d32));
            let b = v.x12.dot(&v.d32) + v.d12.dot(&v.x32);
            lists[0][2] += 2.0 * c * b - 2.0 * c * a;
        })),
    mutant("pe-linear-dg-for-dh", ParticleEdge, "d g stands for d h in t").told_by(&["d h", "d g", "letter"]).by(
        edges!(|v, r, lists| {
            let (d, g, h) = (v.x12.dot(&v.x12), v.x32.dot(&v.x32), v.d32.dot(&v.x32));
            lists[0][3] += 2.0 * d * h - 2.0 * d * g;
        }),
    ),
    mutant("pe-edge-diameter", ParticleEdge, "the edge's diameter stands for its radius")
        .told_by(&["re", "r1 + 2"])
        .by(edges!(|v, r, lists| {
            let extra = (r.0 + 2.0 * r.1) * (r.0 + 2.0 * r.1) - (r.0 + r.1) * (r.0 + r.1);
            let (g, h, i) = (v.x32.dot(&v.x32), v.d32.dot(&v.x32), v.d32.dot(&v.d32));
            lists[0][2] += extra * i;
            lists[0][3] += 2.0 * extra * h;
            lists[0][4] += extra * g;
        })),
    mutant(
        "pe-radii-multiplied",
        ParticleEdge,
        "the radii are multiplied instead of added, in the constant coefficient",
    )
    .told_by(&["r1", "re", "(r1 + re)^2"])
    .by(edges!(|v, r, lists| {
        let extra = r.0 * r.1 * r.0 * r.1 - (r.0 + r.1) * (r.0 + r.1);
        lists[0][4] += extra * v.x32.dot(&v.x32);
    })),
    mutant("pe-alpha-low-difference", ParticleEdge, "the linear coefficient of alpha > 0 subtracts its second product")
        .told_by(&["d12.x32", "(dx1-dx2).x32"])
        .by(edges!(|v, r, lists| lists[1][1] = v.x12.dot(&v.d32) - v.d12.dot(&v.x32))),
    mutant("pe-alpha-high-constant-sign", ParticleEdge, "the constant of alpha < 1 has the wrong sign")
        .told_by(&["sign", "-1", "x13.x23", "(x1-x3).(x2-x3)"])
        .by(edges!(|v, r, lists| lists[2][2] = -lists[2][2])),
    mutant("pe-alpha-high-two", ParticleEdge, "alpha < 1 is alpha < 2").told_by(&["x32.x32", "g", "1 - "]).by(edges!(
        |v, r, lists| {
            lists[2][0] += v.d32.dot(&v.d32);
            lists[2][1] += 2.0 * v.d32.dot(&v.x32);
            lists[2][2] += v.x32.dot(&v.x32);
        }
    )),
    mutant("pe-approach-no-square", ParticleEdge, "the approach's t^2 coefficient is zero")
        .told_by(&["t^2"])
        .by(edges!(|v, r, lists| lists[3][3] = 0.0)),
    mutant("pe-approach-halved-linear", ParticleEdge, "the approach's linear coefficient is halved")
        .told_by(&["t^1", "t:"])
        .by(edges!(|v, r, lists| lists[3][4] *= 0.5)),
    mutant(
        "ph-whole-displacement",
        ParticleHalfPlane,
        "the quadratic coefficient has the whole displacement, not its part along the normal",
    )
    .told_by(&["dx.dx", "d.d"])
    .by(half_planes!(|w, d, n, r, lists| lists[0][0] = -d.dot(&d))),
    mutant(
        "ph-linear-unprojected",
        ParticleHalfPlane,
        "the linear coefficient has offset and displacement without the normal",
    )
    .told_by(&["(p-x).dx", "w.d", "t^1", "t:"])
    .by(half_planes!(|w, d, n, r, lists| lists[0][1] = 2.0 * w.dot(&d))),
    mutant(
        "ph-offset-normalised",
        ParticleHalfPlane,
        "the offset is divided by the normal's length in the constant coefficient, the radius term is not",
    )
    .told_by(&["n.n", "|n|"])
    .by(half_planes!(|w, d, n, r, lists| {
        lists[0][2] = r * r * n.dot(&n) - w.dot(&n) * w.dot(&n) / n.dot(&n);
    })),
    mutant("ph-approach-modulus", ParticleHalfPlane, "the approach has the modulus of the distance")
        .told_by(&["side", "modulus", "approach"])
        .by(half_planes!(|w, d, n, r, lists| lists[1][1] = w.dot(&n).abs() * d.dot(&n))),
];
