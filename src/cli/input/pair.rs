//! Parses pairs that a user typed, with their points and radii, or by their names in a scene.
use crate::{
    num::vector::Vec2,
    scene::Scene,
    sim::{Pair, PairKind, PairMotion, PointMotion},
    suite::suggestions,
};
use anyhow::{Context, Result, anyhow, bail};

/// Parses a pair and its motion, such as `pe:3,1+4,1:5,9+2,6:5,3+5,8`.
///
/// # Errors
///
/// Fails if the text does not describe a pair and its motion.
pub(in crate::cli) fn parse_motion(text: &str, radii: Option<&str>) -> Result<PairMotion> {
    let mut points = text.split(':').collect::<Vec<_>>();
    let kind_name = points.remove(0);
    let kind = parse_kind(kind_name)?;
    let moving = |index: usize| parse_moving(points[index]);
    let fixed = |index: usize| parse_vector(points[index]);
    let expect = |count: usize, what: &str| {
        if points.len() == count {
            return Ok(());
        }
        bail!("{kind_name} takes {count} points ({what}), not {}", points.len())
    };
    let radii = || radii.context("the radii are missing: add --radii, as in --radii 1,0.5");
    Ok(match kind {
        PairKind::ParticleParticle => {
            expect(2, "the two centers")?;
            PairMotion::Particles { centers: [moving(0)?, moving(1)?], radii: parse_radii(radii()?)? }
        }
        PairKind::ParticleEdge => {
            expect(3, "the particle's center and the ends of the edge")?;
            let ends = [moving(1)?, moving(2)?];
            PairMotion::Edge { center: moving(0)?, ends, radii: parse_radii(radii()?)? }
        }
        PairKind::ParticleHalfPlane => {
            expect(3, "the particle's center, a point on the boundary, the normal")?;
            let radii = radii()?;
            let radius = parse_number(radii).with_context(|| format!("the radius `{radii}`"))?;
            let normal = fixed(2)?;
            if normal == Vec2::zeros() {
                bail!("the half-plane's normal is zero");
            }
            PairMotion::HalfPlane { center: moving(0)?, radius: require_nonnegative(radius)?, point: fixed(1)?, normal }
        }
    })
}

/// Parses a pair of a scene, such as `pe:3,1`.
///
/// # Errors
///
/// Fails if the scene has no such pair, or detection never checks it.
pub(in crate::cli) fn find_pair(argument: &str, scene: &Scene) -> Result<Pair> {
    let (kind, indices) = argument.split_once(':').context("write pp:I,J, pe:I,J or ph:I,J")?;
    let kind = parse_kind(kind)?;
    let (first, second) = indices.split_once(',').context("two indices are needed, as in pe:3,1")?;
    let index = |text: &str, count: usize, what: &str| -> Result<u32> {
        let index: u32 = text.trim().parse().with_context(|| format!("`{text}` is not an index"))?;
        if (index as usize) < count {
            return Ok(index);
        }
        match count.checked_sub(1) {
            Some(last) => bail!("there is no {what} {index}; the scene's last {what} is {last}"),
            None => bail!("there is no {what} {index}; the scene has none"),
        }
    };
    let first = index(first, scene.particles.len(), "particle")?;
    let count = match kind {
        PairKind::ParticleParticle => scene.particles.len(),
        PairKind::ParticleEdge => scene.edges.len(),
        PairKind::ParticleHalfPlane => scene.half_planes.len(),
    };
    let second = index(second, count, kind.second_name())?;
    match kind {
        PairKind::ParticleParticle if first == second => bail!("a particle cannot form a pair with itself"),
        // Detection checks each pair only once, with the smaller index first.
        PairKind::ParticleParticle => Ok(Pair { kind, first: first.min(second), second: first.max(second) }),
        PairKind::ParticleEdge => {
            let edge = &scene.edges[second as usize];
            if [edge.first, edge.second].contains(&(first as usize)) {
                bail!("particle {first} is an end of edge {second}; detection never tests this pair");
            }
            Ok(Pair { kind, first, second })
        }
        PairKind::ParticleHalfPlane => Ok(Pair { kind, first, second }),
    }
}

fn parse_kind(text: &str) -> Result<PairKind> {
    PairKind::ALL.into_iter().find(|kind| [kind.short(), kind.name()].contains(&text)).with_context(|| {
        let names = PairKind::ALL.into_iter().flat_map(|kind| [kind.short(), kind.name()]);
        let suggestion = suggestions::suggest(text, names);
        format!(
            "`{text}` is not a kind of pair; there are pp (two particles), pe (particle and edge), ph (particle and \
             half-plane){suggestion}"
        )
    })
}

/// Parses a point and its motion, in the form `X,Y+DX,DY` or `X,Y..X,Y`; `X,Y` is a point at rest.
///
/// # Errors
///
/// Fails if the text has none of these forms.
fn parse_moving(text: &str) -> Result<PointMotion> {
    if let Some((start, end)) = text.split_once("..") {
        // The displacement is the difference of both ends, computed as in the course's code.
        let (start, end) = (parse_vector(start)?, parse_vector(end)?);
        return Ok(PointMotion { start, shift: end - start });
    }
    // A plus sign may also belong to a number or to its exponent, as in `1e+3,+2+4,1`.
    let separates = |&(index, _): &(usize, char)| {
        let before = text[..index].trim_end();
        before.contains(',') && before.ends_with(|c: char| c.is_ascii_digit() || c == '.')
    };
    match text.char_indices().filter(|&(_, c)| c == '+').find(separates) {
        Some((index, _)) => {
            Ok(PointMotion { start: parse_vector(&text[..index])?, shift: parse_vector(&text[index + 1..])? })
        }
        None => Ok(PointMotion { start: parse_vector(text)?, shift: Vec2::zeros() }),
    }
}

/// Parses `X,Y`.
///
/// # Errors
///
/// Fails if the text is not a point with finite coordinates.
fn parse_vector(text: &str) -> Result<Vec2> {
    let advice = || format!("`{text}` is not a point; write X,Y as in 3,-1.5");
    let (x, y) = text.split_once(',').with_context(advice)?;
    Ok(Vec2::new(parse_number(x).with_context(advice)?, parse_number(y).with_context(advice)?))
}

fn parse_radii(argument: &str) -> Result<[f64; 2]> {
    let advice = || format!("`{argument}` is not a pair of radii; write R,R as in 1,0.5");
    let (first, second) = argument.split_once(',').with_context(advice)?;
    let radius = |text| parse_number(text).and_then(require_nonnegative).with_context(advice);
    Ok([radius(first)?, radius(second)?])
}

fn require_nonnegative(radius: f64) -> Result<f64> {
    if radius < 0.0 {
        bail!("a radius is negative");
    }
    Ok(radius)
}

fn parse_number(text: &str) -> Result<f64> {
    let value: f64 = text.trim().parse().map_err(|_| anyhow!("`{text}` is not a number"))?;
    if !value.is_finite() {
        bail!("`{text}` is not finite");
    }
    Ok(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbers(word: &str) -> [f64; 4] {
        let PointMotion { start, shift } = parse_moving(word).unwrap();
        [start.x, start.y, shift.x, shift.y]
    }

    #[test]
    fn points_move_by_a_displacement_or_to_an_end() {
        assert_eq!(numbers("3,1+4,1"), [3.0, 1.0, 4.0, 1.0]);
        assert_eq!(numbers("-3,-.5+-4,1"), [-3.0, -0.5, -4.0, 1.0]);
        assert_eq!(numbers("1e+3,+2+4e+1,+1"), [1000.0, 2.0, 40.0, 1.0]);
        assert_eq!(numbers("3,1..7,2"), [3.0, 1.0, 4.0, 1.0]);
        assert_eq!(numbers("3,1"), [3.0, 1.0, 0.0, 0.0]);
        assert_eq!(numbers(" 3 , 1 + 4 , 1 "), [3.0, 1.0, 4.0, 1.0]);
    }

    #[test]
    fn invalid_points_are_rejected_with_advice() {
        for word in ["", "3", "3;1", "3,x", "3,1+4", "3,1,2", "nan,0", "3,1..", "1e999,0", "3,1+4,1+2,2"] {
            let error = format!("{:#}", parse_moving(word).unwrap_err());
            assert!(error.contains("is not a point"), "{word}: {error}");
        }
    }

    #[test]
    fn the_kind_of_pair_is_checked_before_the_radii() {
        let error = |word: &str| format!("{:#}", parse_motion(word, None).unwrap_err());
        assert!(error("xx:1").contains("`xx` is not a kind of pair"), "{}", error("xx:1"));
        assert!(error("particle-egde:1").ends_with("did you mean particle-edge?"), "{}", error("particle-egde:1"));
        assert!(error("pp:1,0").contains("pp takes 2 points"), "{}", error("pp:1,0"));
        assert!(error("pp:1,0:3,0").contains("the radii are missing"), "{}", error("pp:1,0:3,0"));
    }

    #[test]
    fn each_kind_says_what_it_takes() {
        assert!(parse_motion("pe:3,1+4,1:5,9+2,6:5,3+5,8", Some("1,1")).is_ok());
        assert!(parse_motion("ph:0,1+0,-1:0,0:0,1", Some("0.25")).is_ok());
        for (pair, radii, says) in [
            ("pe:3,1:5,9", "1,1", "pe takes 3 points (the particle's center and the ends of the edge), not 2"),
            ("pq:3,1:5,9", "1,1", "`pq` is not a kind of pair"),
            ("pp:3,1:5,9", "1", "`1` is not a pair of radii"),
            ("pp:3,1:5,9", "1,-1", "a radius is negative"),
            ("ph:3,1:0,0:0,0", "1", "the half-plane's normal is zero"),
        ] {
            let error = format!("{:#}", parse_motion(pair, Some(radii)).unwrap_err());
            assert!(error.contains(says), "{error}");
        }
    }
}
