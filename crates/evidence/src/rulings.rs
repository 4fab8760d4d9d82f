//! Records the wrong steps while the judge runs.
use fosssim_judge::{
    Outcome,
    replay::{Progress, Remark, WrongStep},
};

/// The rulings of both rule books on one step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct StepRuling {
    /// Whether the original's rules find a fault in the step.
    pub wrong_by_parity: bool,
    /// Whether the fair rules find a fault in the step; `false` if the fair rules did not judge the step.
    pub wrong_by_fair: bool,
    /// Whether the step's records, or earlier ones, are damaged, so that its numbers prove nothing.
    pub is_damaged: bool,
}

/// An observer that keeps the rulings on all steps.
#[derive(Debug, Default)]
pub struct StepRulings {
    steps: Vec<StepRuling>,
}

impl StepRulings {
    /// Returns the rulings in the order of the steps, after the trace has been judged.
    pub fn into_steps(mut self, outcome: &Outcome) -> Vec<StepRuling> {
        // All records after a damaged one count as damaged.
        let sound = outcome.steps_judged.saturating_sub(outcome.damaged_steps) as usize;
        self.steps.iter_mut().skip(sound).for_each(|step| step.is_damaged = true);
        self.steps
    }
}

impl Progress for StepRulings {
    fn observe_step_end(&mut self, _step: u32, _remarks: &[Remark]) {
        self.steps.push(StepRuling::default());
    }

    fn observe_wrong_step(&mut self, wrong: &WrongStep<'_>) {
        if let Some(last) = self.steps.last_mut() {
            last.wrong_by_parity = !wrong.parity.first_findings.is_empty();
            last.wrong_by_fair = !wrong.fair.first_findings.is_empty();
        }
    }
}
