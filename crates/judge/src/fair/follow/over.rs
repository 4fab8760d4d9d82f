//! Takes over what was seen of calls before they are made.
use super::Follower;
use crate::{
    contacts::key,
    fair::{ahead::Likeness, context::Followed},
};
use fosssim_model::sim::{Decision, Pair, Stage, Time};

impl Follower<'_> {
    /// How many calls from this one on leave nothing to look at; what they say is taken over.
    pub(super) fn take_over(&mut self, next: Pair, q_start: &[f64], q_end: &[f64]) -> usize {
        let (Some(index), Some(ahead)) = (self.next, &mut self.ahead) else { return 0 };
        let share = self.judged.shares.coefficient;
        ahead.look(self.context, self.pass.stage, (&self.records.end.polynomials, index), share, [q_start, q_end]);
        let answers_at_once = matches!(self.pass.stage, Stage::ContinuousTime);
        let mut calls = 0;
        while let Some((pair, known)) = ahead.next() {
            let is_open = known.likeness == Likeness::Open
                || known.hangs_on_form && self.judged.course_form.is_none()
                // Responses move particles within the pass.
                || answers_at_once && self.context.particles(pair).into_iter().flatten().any(|p| self.moved[p])
                || answers_at_once
                    && key(pair).is_none_or(|key| self.contacts.about(key).any(|index| !self.used[index]));
            debug_assert!(calls > 0 || pair == next);
            if is_open || calls == 0 && pair != next {
                break;
            }
            if known.likeness == Likeness::Same {
                self.judged.same[pair.kind] += 1;
            }
            if known.likeness == Likeness::Alike {
                self.judged.shares.coefficient = self.judged.shares.coefficient.max(known.share);
                self.judged.lost += u64::from(known.lost);
                for (number, &scale) in known.scales[..pair.kind.polynomials()].iter().enumerate() {
                    if !scale.is_nan() {
                        self.judged.scales[pair.kind][number].take(scale);
                    }
                }
            }
            self.next = self.next.map(|next| next + pair.kind.polynomials());
            let decision = Decision::Miss { time: Time::Excluded };
            self.decisions.push(Followed { pair, pass: self.pass, decision });
            ahead.step_over();
            calls += 1;
        }
        calls
    }
}
