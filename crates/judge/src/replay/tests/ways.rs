//! Traces that are right or wrong in many ways, judged by the fast path and the full path.
use crate::{
    options::Options,
    replay,
    samples::{BOUNCE_SCENE, ZONES_SCENE, changed_reference_trace, replace_polynomials, scene},
};
use fosssim_model::{scene::Scene, sim::RootSearch, trace::Frame};

/// A scene with a ball next to a half-plane, so far from the origin that the original rejects its own polynomials.
const LARGE: &str = r#"<scene>
    <duration time="1"/><integrator type="explicit-euler" dt="0.1"/><collision type="continuous-time" COR="1"/>
    <particle m="1" px="0" py="7654321.123" vx="0" vy="-1" fixed="0" radius="0.25"/>
    <particle m="1" px="0.1" py="1.321" vx="0.3" vy="-1.7" fixed="0" radius="0.25"/>
    <halfplane px="0" py="0" nx="0.37" ny="1.23"/>
</scene>"#;

/// A scene with an edge that turns while balls hit it and each other, so that both forms of its approach polynomials
/// differ.
const SPIN: &str = r#"<scene>
    <duration time="0.8"/><integrator type="explicit-euler" dt="0.1"/>
    <collision type="continuous-time" COR="0.7"/>
    <particle m="1" px="0" py="0" vx="0.3" vy="-1" fixed="0" radius="0.1"/>
    <particle m="2" px="1" py="0.1" vx="0.1" vy="1.3" fixed="0" radius="0.1"/>
    <particle m="1" px="0.4" py="0.5" vx="0.2" vy="-2" fixed="0" radius="0.1"/>
    <particle m="1" px="0.7" py="0.9" vx="-0.3" vy="-2" fixed="0" radius="0.1"/>
    <edge i="0" j="1" radius="0.1"/><halfplane px="0" py="-0.3" nx="0.1" ny="1"/>
</scene>"#;

/// Returns the results of both paths as text, because texts with NaN can be compared.
fn judged(scene: &Scene, trace: &[u8]) -> [String; 2] {
    [false, true].map(|one_by_one| {
        let options =
            Options { uses_fair_rules: true, threads: 1, judges_individually: one_by_one, ..Options::default() };
        format!("{:?}", replay::judge(scene, trace, &options, &mut ()))
    })
}

type Change = fn(&mut Vec<Frame>);

/// Returns coefficients that are off by some rounding errors, each in its own direction.
fn rounded(own: &[f64], roundings: f64) -> Vec<f64> {
    let signs = [1.0, -1.0, 0.5, 1.0, -0.5, -1.0];
    own.iter().zip(signs).map(|(c, sign)| c * (1.0 + sign * roundings * f64::EPSILON)).collect()
}

/// Returns coefficients with this factor, as the course's library keeps them.
fn lost(own: &[f64], factor: f64) -> Vec<f64> {
    own.iter().map(|c| factor * c).skip_while(|c| c.abs() < 1e-12).collect()
}

#[test]
fn both_ways_say_the_same_to_the_last_field() {
    let changes: [Change; 20] = [
        |_| {},
        |frames| frames.truncate(3),
        |frames| frames.push(frames[1].clone()),
        |frames| frames[2].state.velocities[1] += 1e-3,
        |frames| frames[1].state.positions[0] += 1e-13,
        |frames| frames[3].state.positions[1] = f64::NAN,
        |frames| frames[0].state.positions[0] = 1e9,
        |frames| {
            frames
                .iter_mut()
                .for_each(|frame| replace_polynomials(frame, |_, own| own.iter().map(|c| 3.0 * c).collect()))
        },
        |frames| replace_polynomials(&mut frames[1], |_, own| own.iter().map(|c| c + 1e-3).collect()),
        |frames| frames[2].impulses.clear(),
        |frames| {
            frames
                .iter_mut()
                .for_each(|frame| replace_polynomials(frame, |_, own| own.iter().map(|c| c / 3.0).collect()))
        },
        |frames| {
            frames.iter_mut().for_each(|frame| replace_polynomials(frame, |_, own| own.iter().map(|c| -c).collect()))
        },
        |frames| {
            replace_polynomials(&mut frames[1], |index, own| own[usize::from(index == 1).min(own.len())..].to_vec())
        },
        |frames| {
            replace_polynomials(&mut frames[3], |index, own| {
                own.iter().map(|c| if index == 0 { f64::NAN } else { c * 1.25 }).collect()
            })
        },
        // These change coefficients by rounding errors, in all frames or in two.
        |frames| frames.iter_mut().for_each(|frame| replace_polynomials(frame, |_, own| rounded(own, 1.0))),
        |frames| frames[2..4].iter_mut().for_each(|frame| replace_polynomials(frame, |_, own| rounded(own, 40.0))),
        // These factors make the library drop leading coefficients, in some polynomials or in all.
        |frames| frames.iter_mut().for_each(|frame| replace_polynomials(frame, |_, own| lost(own, 1e-12))),
        |frames| {
            let small = |index: usize, own: &[f64]| lost(own, if index.is_multiple_of(3) { 1e-11 } else { 1.0 });
            frames.iter_mut().for_each(|frame| replace_polynomials(frame, small));
        },
        // One polynomial differs, only in the mid record.
        |frames| replace_polynomials(&mut frames[1], |index, own| rounded(own, if index == 1 { 1.0 } else { 0.0 })),
        |frames| {
            frames
                .iter_mut()
                .for_each(|frame| replace_polynomials(frame, |_, own| own.iter().map(|c| 2e4 * c).collect()))
        },
    ];
    for text in [BOUNCE_SCENE, ZONES_SCENE, LARGE, SPIN] {
        let scene = scene(text);
        for (number, change) in changes.into_iter().enumerate() {
            let trace = changed_reference_trace(&scene, change);
            let [quickly, slowly] = judged(&scene, &trace);
            assert!(quickly == slowly, "change {number}: {quickly}\n{slowly}");
        }
        let mut cut = changed_reference_trace(&scene, |_| {});
        cut.truncate(cut.len() - 5);
        let [quickly, slowly] = judged(&scene, &cut);
        assert!(quickly == slowly, "{quickly}\n{slowly}");
    }
}

/// Two distant balls move alike. Their relative motion is round-off, from which the root finder makes a collision with
/// some factors and none with others. The reference has none, and the program misses no real collision.
#[test]
fn collisions_of_the_root_finder_alone_are_not_missed() {
    let scene = scene(
        r#"<scene><duration time="3"/><integrator type="explicit-euler" dt="1"/>
        <collision type="continuous-time" COR="0.7"/>
        <particle m="0.1" px="171.82559248514963" py="-60.16720174685872" vx="2.715313873993024"
            vy="-0.6812726629071891" fixed="0" radius="0.05025431610929919"/>
        <particle m="5" px="-35.39295066098373" py="247.57697859297167" vx="2.715313873993024"
            vy="-0.6812726629071891" fixed="0" radius="14.158818287407597"/></scene>"#,
    );
    let factors = [0.751_233_916_835_469, 0.962_163_694_423_374_3];
    let trace = changed_reference_trace(&scene, |frames| {
        let scaled = |index: usize, own: &[f64]| own.iter().map(|c| factors[index % 2] * c).collect();
        frames.iter_mut().for_each(|frame| replace_polynomials(frame, scaled));
    });
    for one_by_one in [false, true] {
        let options =
            Options { uses_fair_rules: true, threads: 1, judges_individually: one_by_one, ..Options::default() };
        let fair = replay::judge(&scene, &trace[..], &options, &mut ()).fair.expect("asked");
        assert_eq!(fair.findings.first_divergence, None, "one by one: {one_by_one}");
    }
}

/// Searching all roots changes no verdict, in either rule book.
#[test]
fn audited_searches_judge_the_same() {
    let changes: [Change; 4] = [
        |_| {},
        |frames| {
            frames
                .iter_mut()
                .for_each(|frame| replace_polynomials(frame, |_, own| own.iter().map(|c| 3.0 * c).collect()))
        },
        |frames| frames.iter_mut().for_each(|frame| replace_polynomials(frame, |_, own| rounded(own, 40.0))),
        |frames| replace_polynomials(&mut frames[1], |_, own| own.iter().map(|c| c + 1e-3).collect()),
    ];
    for scene in [BOUNCE_SCENE, ZONES_SCENE, SPIN].map(scene) {
        for change in changes {
            let trace = changed_reference_trace(&scene, change);
            let [needed, audited] = [RootSearch::OnDemand, RootSearch::Audit].map(|root_search| {
                let options = Options { uses_fair_rules: true, threads: 1, root_search, ..Options::default() };
                format!("{:?}", replay::judge(&scene, &trace[..], &options, &mut ()))
            });
            assert!(audited == needed, "{audited}\n{needed}");
        }
    }
}

#[test]
fn steps_in_which_the_original_rejects_itself_are_found() {
    let scene = scene(LARGE);
    let trace = changed_reference_trace(&scene, |_| {});
    let outcome = replay::judge(&scene, &trace[..], &Options::default(), &mut ());
    assert!(outcome.parity.findings.counts.total() > 0, "{outcome:?}");
}
