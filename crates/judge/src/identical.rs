//! Steps whose records are the reference's byte for byte: most of them, and nothing of them has to be decoded.
//!
//! The reference makes the step's records in the trace's own layout, from the trace's own state, and they are compared
//! with what is read. Where they are equal, every comparison of the two books is known to find nothing; where anything
//! hangs on more than that, or differs, the step goes the long way.
use super::{
    fair::{Context, StepJudgement},
    tally::{SAFE_SUM, rejects_itself},
};
use fosssim_model::{
    scene::Scene,
    sim::{RootSearch, SearchCounts, Simulation, State, SweepOrder},
    trace::{Layout, Lenient, StepBytes},
};
use fosssim_num::polynomial::MAX_COEFFICIENTS;
use std::io::Read;

/// The greatest number of steps that go the long way at once after a step that differs.
const LONGEST_PAUSE: u32 = 63;

/// Looks for such steps.
pub(super) struct Identical {
    simulation: Simulation,
    /// The order of bodies from which the reference begins the step, in a contest. It depends on all steps before, so
    /// that no step of a contest is skipped here.
    order: SweepOrder,
    /// The reference's records of the step.
    records: StepBytes,
    /// The number of steps in a row that differed. After the first of them no step is skipped, and then about twice as
    /// many with each.
    misses: u32,
    /// How many steps are still not tried.
    skipped: u32,
    /// Counts of the steps that were found.
    searches: SearchCounts,
}

/// A step that was found.
pub(super) struct Found {
    /// The reference's work on it.
    pub(super) work: u64,
    /// Bytes of its records.
    pub(super) bytes: usize,
    /// The judgement of the fair rules about it, if they are asked.
    pub(super) fair: Option<StepJudgement>,
}

impl Identical {
    /// Has tried no step yet.
    pub(super) fn new(scene: &Scene, root_search: RootSearch) -> Self {
        Self {
            simulation: Simulation::new(scene, root_search),
            order: SweepOrder::default(),
            records: StepBytes::new(Layout::of(scene)),
            misses: 0,
            skipped: 0,
            searches: SearchCounts::default(),
        }
    }

    /// Tries no step.
    pub(super) fn give_up(&mut self) {
        self.skipped = u32::MAX;
    }

    /// The order of bodies from which the reference begins the step that was asked for last; empty but in a contest.
    pub(super) fn order(&self) -> &SweepOrder {
        &self.order
    }

    /// Counts of root searches, of the steps that were found.
    pub(super) fn searches(&self) -> SearchCounts {
        self.searches
    }

    /// The state at the end of the step that was found.
    pub(super) fn state(&self) -> &State {
        self.simulation.state()
    }

    /// Steps from `before`, spending `most_work` at most, and goes past the step's records if they are the reference's;
    /// otherwise nothing is read.
    pub(super) fn find<R: Read>(
        &mut self,
        reader: &mut Lenient<R>,
        step: u32,
        before: &State,
        context: Option<&Context<'_>>,
        most_work: u64,
    ) -> Option<Found> {
        let has_order = self.simulation.penalty_pairs().is_some_and(|pairs| pairs.order(&mut self.order));
        let is_skipped = self.skipped > 0;
        if is_skipped {
            self.skipped -= 1;
            if !has_order {
                return None;
            }
        }
        let (counts, work) = (self.simulation.search_counts(), self.simulation.work());
        let is_ordinary = |state: &State| context.is_none_or(|context| context.ordinary.holds(state));
        let is_found = (has_order || is_ordinary(before))
            && self.step(step, before, work.saturating_add(most_work))
            && !is_skipped
            && is_ordinary(before)
            && self.records.is_finite()
            && self.records.mid().is_none_or(is_ordinary)
            && is_ordinary(self.simulation.state())
            && !self.hangs_on_size()
            && reader.passes(&self.records);
        if is_skipped {
            return None;
        }
        if !is_found {
            self.skipped = ((1 << self.misses) - 1).min(LONGEST_PAUSE);
            self.misses = (self.misses + 1).min(LONGEST_PAUSE.ilog2() + 1);
            return None;
        }
        self.misses = 0;
        self.searches += self.simulation.search_counts() - counts;
        let fair = context.map(|context| StepJudgement::identical(context, step, self.records.polynomials()));
        Some(Found { work: self.simulation.work() - work, bytes: self.records.len(), fair })
    }

    /// Whether the step has a result.
    fn step(&mut self, step: u32, before: &State, most_work: u64) -> bool {
        self.simulation.state_mut().clone_from(before);
        self.simulation.set_steps_done(step - 1);
        self.simulation.limit_work(most_work);
        self.simulation.step(&mut self.records).is_ok()
    }

    /// Whether the original rejects a polynomial although it is the reference's.
    fn hangs_on_size(&self) -> bool {
        // Written so that what is not small for certain is looked at, one by one.
        let all_small = self.records.largest() < SAFE_SUM / MAX_COEFFICIENTS as f64;
        !all_small && self.records.any(rejects_itself)
    }
}

#[cfg(test)]
mod tests {
    use crate::{
        options::Options,
        replay,
        samples::{BOUNCE, ZONES, changed, relog, scene},
    };
    use fosssim_model::{scene::Scene, sim::RootSearch, trace::Frame};

    /// A ball beside a half-plane, so far away that the original rejects its own polynomials.
    const LARGE: &str = r#"<scene>
        <duration time="1"/><integrator type="explicit-euler" dt="0.1"/><collision type="continuous-time" COR="1"/>
        <particle m="1" px="0" py="7654321.123" vx="0" vy="-1" fixed="0" radius="0.25"/>
        <particle m="1" px="0.1" py="1.321" vx="0.3" vy="-1.7" fixed="0" radius="0.25"/>
        <halfplane px="0" py="0" nx="0.37" ny="1.23"/>
    </scene>"#;

    /// An edge that turns while balls hit it and each other, so that both forms of its approach polynomials differ.
    const SPIN: &str = r#"<scene>
        <duration time="0.8"/><integrator type="explicit-euler" dt="0.1"/>
        <collision type="continuous-time" COR="0.7"/>
        <particle m="1" px="0" py="0" vx="0.3" vy="-1" fixed="0" radius="0.1"/>
        <particle m="2" px="1" py="0.1" vx="0.1" vy="1.3" fixed="0" radius="0.1"/>
        <particle m="1" px="0.4" py="0.5" vx="0.2" vy="-2" fixed="0" radius="0.1"/>
        <particle m="1" px="0.7" py="0.9" vx="-0.3" vy="-2" fixed="0" radius="0.1"/>
        <edge i="0" j="1" radius="0.1"/><halfplane px="0" py="-0.3" nx="0.1" ny="1"/>
    </scene>"#;

    /// Everything that both ways say, as text: it compares NaN, too.
    fn judged(scene: &Scene, trace: &[u8]) -> [String; 2] {
        [false, true].map(|one_by_one| {
            let options = Options { fair: true, threads: 1, one_by_one, ..Options::default() };
            format!("{:?}", replay::judge(scene, trace, &options, &mut ()))
        })
    }

    type Change = fn(&mut Vec<Frame>);

    /// Coefficients that are off by some roundings, each in its own direction.
    fn rounded(own: &[f64], roundings: f64) -> Vec<f64> {
        let signs = [1.0, -1.0, 0.5, 1.0, -0.5, -1.0];
        own.iter().zip(signs).map(|(c, sign)| c * (1.0 + sign * roundings * f64::EPSILON)).collect()
    }

    /// Coefficients with this factor, as the course's library keeps them.
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
            |frames| frames.iter_mut().for_each(|frame| relog(frame, |_, own| own.iter().map(|c| 3.0 * c).collect())),
            |frames| relog(&mut frames[1], |_, own| own.iter().map(|c| c + 1e-3).collect()),
            |frames| frames[2].impulses.clear(),
            |frames| frames.iter_mut().for_each(|frame| relog(frame, |_, own| own.iter().map(|c| c / 3.0).collect())),
            |frames| frames.iter_mut().for_each(|frame| relog(frame, |_, own| own.iter().map(|c| -c).collect())),
            |frames| relog(&mut frames[1], |index, own| own[usize::from(index == 1).min(own.len())..].to_vec()),
            |frames| {
                relog(&mut frames[3], |index, own| {
                    own.iter().map(|c| if index == 0 { f64::NAN } else { c * 1.25 }).collect()
                })
            },
            // Other roundings, in one polynomial or in all of them.
            |frames| frames.iter_mut().for_each(|frame| relog(frame, |_, own| rounded(own, 1.0))),
            |frames| frames[2..4].iter_mut().for_each(|frame| relog(frame, |_, own| rounded(own, 40.0))),
            // Factors with which leading coefficients are lost, here and there or everywhere.
            |frames| frames.iter_mut().for_each(|frame| relog(frame, |_, own| lost(own, 1e-12))),
            |frames| {
                let small = |index: usize, own: &[f64]| lost(own, if index.is_multiple_of(3) { 1e-11 } else { 1.0 });
                frames.iter_mut().for_each(|frame| relog(frame, small));
            },
            // A polynomial that differs in the mid record only.
            |frames| relog(&mut frames[1], |index, own| rounded(own, if index == 1 { 1.0 } else { 0.0 })),
            |frames| frames.iter_mut().for_each(|frame| relog(frame, |_, own| own.iter().map(|c| 2e4 * c).collect())),
        ];
        for text in [BOUNCE, ZONES, LARGE, SPIN] {
            let scene = scene(text);
            for (number, change) in changes.into_iter().enumerate() {
                let trace = changed(&scene, change);
                let [quickly, slowly] = judged(&scene, &trace);
                assert!(quickly == slowly, "change {number}: {quickly}\n{slowly}");
            }
            let mut cut = changed(&scene, |_| {});
            cut.truncate(cut.len() - 5);
            let [quickly, slowly] = judged(&scene, &cut);
            assert!(quickly == slowly, "{quickly}\n{slowly}");
        }
    }

    /// Two balls far apart that move alike: their relative motion is round-off, from which the root finder makes a
    /// collision with some factors and none with others. None is what the reference has, and no program misses anything
    /// then.
    #[test]
    fn what_only_the_root_finder_sees_is_no_missed_collision() {
        let scene = scene(
            r#"<scene><duration time="3"/><integrator type="explicit-euler" dt="1"/>
            <collision type="continuous-time" COR="0.7"/>
            <particle m="0.1" px="171.82559248514963" py="-60.16720174685872" vx="2.715313873993024"
                vy="-0.6812726629071891" fixed="0" radius="0.05025431610929919"/>
            <particle m="5" px="-35.39295066098373" py="247.57697859297167" vx="2.715313873993024"
                vy="-0.6812726629071891" fixed="0" radius="14.158818287407597"/></scene>"#,
        );
        let factors = [0.751_233_916_835_469, 0.962_163_694_423_374_3];
        let trace = changed(&scene, |frames| {
            let scaled = |index: usize, own: &[f64]| own.iter().map(|c| factors[index % 2] * c).collect();
            frames.iter_mut().for_each(|frame| relog(frame, scaled));
        });
        for one_by_one in [false, true] {
            let options = Options { fair: true, threads: 1, one_by_one, ..Options::default() };
            let fair = replay::judge(&scene, &trace[..], &options, &mut ()).fair.expect("asked");
            assert_eq!(fair.findings.first_divergence, None, "one by one: {one_by_one}");
        }
    }

    /// To search all roots changes no verdict, by either book.
    #[test]
    fn audited_searches_judge_the_same() {
        let changes: [Change; 4] = [
            |_| {},
            |frames| frames.iter_mut().for_each(|frame| relog(frame, |_, own| own.iter().map(|c| 3.0 * c).collect())),
            |frames| frames.iter_mut().for_each(|frame| relog(frame, |_, own| rounded(own, 40.0))),
            |frames| relog(&mut frames[1], |_, own| own.iter().map(|c| c + 1e-3).collect()),
        ];
        for scene in [BOUNCE, ZONES, SPIN].map(scene) {
            for change in changes {
                let trace = changed(&scene, change);
                let [needed, audited] = [RootSearch::WhereNeeded, RootSearch::Audit].map(|root_search| {
                    let options = Options { fair: true, threads: 1, root_search, ..Options::default() };
                    let mut outcome = replay::judge(&scene, &trace[..], &options, &mut ());
                    (std::mem::take(&mut outcome.searches), format!("{outcome:?}"))
                });
                assert_eq!((audited.0.searched, audited.0.disagreements), (needed.0.calls, 0));
                assert!(audited.1 == needed.1, "{}\n{}", audited.1, needed.1);
            }
        }
    }

    #[test]
    fn what_the_original_rejects_of_itself_is_found() {
        let scene = scene(LARGE);
        let trace = changed(&scene, |_| {});
        let outcome = replay::judge(&scene, &trace[..], &Options::default(), &mut ());
        assert!(outcome.parity.findings.counts.total() > 0, "{outcome:?}");
    }
}
