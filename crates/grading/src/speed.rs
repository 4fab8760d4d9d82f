//! Times a submission and the reference program, if a suite gives points for speed.
//!
//! Both run alternately in the same sandbox, on the same scene and the same machine. Their traces are judged, so that a
//! program that omits work in timed runs gets no points. The reference is this program itself, in the role of the
//! course's original.
use super::{
    config,
    grader::{SubmissionGrading, program_name},
    result::SceneResult,
    runner::Runner,
    staging::StagedProgram,
    task::SceneTask,
    verdict::Verdict,
};
use fosssim_findings::{
    Hints,
    speed::SpeedMarking,
    timing::{TimedRun, Timing},
};
use std::{fs, time::Instant};

impl SubmissionGrading<'_> {
    /// Times the scenes of each group that gives points for speed, if all scenes of the group are accepted. Earlier
    /// times of the same program on this machine are reused. All timed runs together may take as long as the graded
    /// runs. When this time is used up, each further scene is timed only once.
    pub(super) fn time_scenes(&self, results: &mut [(SceneResult, bool)]) {
        let mut rest = results;
        let begin = Instant::now();
        for group in &self.grader.plan.groups {
            let (own, others) = rest.split_at_mut(group.scenes.len());
            rest = others;
            let Some(marking) = group.marking.speed else { continue };
            if !own.iter().all(|(result, _)| result.verdict.is_accepted()) {
                continue;
            }
            for ((result, cached), scene) in own.iter_mut().zip(&group.scenes) {
                if result.timing.as_ref().is_some_and(|timing| is_from_this_machine(timing, marking)) {
                    continue;
                }
                result.timing = self.time_scene(scene, marking, begin + self.grader.plan.skip_limits.total);
                *cached = false;
                self.store_timed(scene, result);
                // The time for timed runs is used up.
                if result.timing.as_ref().is_none_or(|timing| timing.failed.is_some()) {
                    break;
                }
            }
        }
    }

    /// Stores a result again, after its times were added.
    fn store_timed(&self, scene: &SceneTask, result: &SceneResult) {
        if let (Some(_), Ok(staged)) = (&result.timing, &*self.staged_program()) {
            let students = self.grader.plan.student_hints(&scene.name);
            let key = self.shared.key(&staged.digest, scene, &program_name(&staged.program), students);
            self.shared.store_result(&key, self.submission, result);
        }
    }

    /// Times a scene. After the time `end`, only one run is made. Returns `None` if the grader failed or was stopped.
    fn time_scene(&self, scene: &SceneTask, marking: SpeedMarking, end: Instant) -> Option<Timing> {
        let (staged, reference) = (self.staged_program(), self.shared.reference(self.grader.reference?));
        let (Ok(staged), Ok(reference)) = (&*staged, &*reference) else { return None };
        let mut timing = Timing { machine: machine_name(), runs: Vec::new(), failed: None };
        let run = |program: &StagedProgram, command: &[String]| {
            let runner = Runner {
                command,
                hints: Hints::Where,
                student_hints: Hints::Where,
                trace_location: None,
                cards: None,
                ..self.new_runner(scene, None)
            };
            let result = runner.grade(program, scene, &mut |_| {});
            (result.verdict, result.measured.cpu)
        };
        for round in 0..marking.runs {
            if round > 0 && Instant::now() > end {
                break;
            }
            let submission = || run(staged, &self.grader.plan.command);
            let other = || run(reference, &config::default_command());
            // The order alternates, so that neither program always profits from warm caches.
            let ((verdict, submission), (sound, reference)) = match round % 2 {
                0 => (submission(), other()),
                _ => {
                    let other = other();
                    (submission(), other)
                }
            };
            match (verdict, sound) {
                (Verdict::JudgeError | Verdict::NotRun, _) => return None,
                (_, sound) if !sound.is_accepted() => return None,
                (Verdict::Accepted, _) => timing.runs.push(TimedRun { submission, reference }),
                (verdict, _) => {
                    timing.failed = Some(verdict);
                    return Some(timing);
                }
            }
        }
        Some(timing)
    }
}

/// Returns whether the times were measured on this machine. There must be enough runs, unless one failed.
fn is_from_this_machine(timing: &Timing, marking: SpeedMarking) -> bool {
    timing.machine == machine_name() && (timing.failed.is_some() || timing.runs.len() >= marking.runs as usize)
}

/// Returns a name for this machine and its processor.
fn machine_name() -> String {
    let name = fs::read_to_string("/proc/sys/kernel/hostname").unwrap_or_default();
    let processor = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = processor.lines().find_map(|line| line.strip_prefix("model name")).unwrap_or_default();
    format!("{}, {}", name.trim(), model.trim_start_matches([' ', '\t', ':']).trim())
}
