//! Steps whose records are the reference's but for polynomials that have a factor, or were computed in another way.
//!
//! Nothing of them is decoded: states and impulses are compared as bytes, and of polynomials that are not the same,
//! nearly all are right at once by both books. Where anything hangs on more than that, the step goes the long way, and
//! what is said here is what would be said there.
use super::{
    calls::{Both, Call, Numbers, OF_EDGE, OF_TWO},
    fair::{AlikeStep, Context, Likeness, StepJudgement},
    finding::{PolynomialPlace, Role},
    tally::{self, Pending},
    watch::{SeenPass, Watch},
};
use fosssim_model::{
    scene::Scene,
    sim::{Pair, PairKind, Pairs, pairs},
};
use fosssim_num::tolerances::{LEADING_COEFFICIENT, PARITY_COEFFICIENT, PARITY_ZERO_POLYNOMIAL};

/// Compares steps.
#[derive(Debug)]
pub(super) struct Alike {
    order: Pairs<'static>,
    pairs: usize,
}

impl Alike {
    /// For steps of this scene.
    pub(super) fn new(scene: &Scene) -> Self {
        let order = pairs(scene);
        Self { pairs: order.count(), order }
    }

    /// Whether these polynomials of the trace's mid record and end record will do in the place of the reference's, and
    /// what the fair rules say about that, if they are asked.
    pub(super) fn accepts(
        &self,
        watch: &Watch,
        step: u32,
        context: Option<&Context<'_>>,
        [mid, theirs]: [&[u8]; 2],
        pending: &mut Pending,
    ) -> Option<StepJudgement> {
        let log = watch.bytes.log();
        if !theirs.starts_with(mid) || self.pairs == 0 {
            return None;
        }
        let frame = u64::from(step) * watch.records_per_step;
        let (own, theirs) = (List::new(log.bytes()), List::new(theirs));
        let mut walk = Walk { own, theirs, number: 0, searched: log.searched(), at: (step, frame), pending };
        let mut fair = context.map(|context| AlikeStep::new(context, step, watch));
        for seen in watch.passes() {
            for pair in self.order.iter() {
                let fair = fair.as_mut();
                match pair.kind {
                    PairKind::ParticleEdge => walk.call(pair, OF_EDGE, seen, watch, fair)?,
                    PairKind::ParticleParticle | PairKind::ParticleHalfPlane => {
                        walk.call(pair, OF_TWO, seen, watch, fair)?;
                    }
                }
            }
        }
        if !walk.own.is_over() || !walk.theirs.is_over() {
            return None;
        }
        fair.map_or_else(|| Some(StepJudgement::default()), |fair| fair.finish(watch))
    }
}

/// A list of polynomials, and where the next one begins.
struct List<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> List<'a> {
    fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, at: 0 }
    }

    fn is_over(&self) -> bool {
        self.at == self.bytes.len()
    }

    /// Where the polynomial behind the one that begins here begins.
    #[inline(always)]
    fn behind(&self, at: usize) -> Option<usize> {
        let size = u32::from_le_bytes(*self.bytes.get(at..)?.first_chunk()?);
        Some(at + 4 + 8 * size as usize)
    }

    /// The bytes of the next polynomial's coefficients.
    #[inline(always)]
    fn next(&mut self) -> Option<&'a [u8]> {
        let begin = self.at;
        self.at = self.behind(begin)?;
        self.bytes.get(begin + 4..self.at)
    }
}

/// The way through both lists of polynomials.
struct Walk<'a> {
    own: List<'a>,
    theirs: List<'a>,
    /// The number of the next polynomial.
    number: usize,
    /// The numbers of the first polynomials of the next calls whose zeros were searched.
    searched: &'a [u32],
    /// Numbers of the step and of its end record.
    at: (u32, u64),
    /// What the original finds.
    pending: &'a mut Pending,
}

impl Walk<'_> {
    /// Goes past a call whose complete polynomials have `lengths` coefficients; `None` where it has to be looked at in
    /// another way.
    #[inline(always)]
    fn call<const COUNT: usize>(
        &mut self,
        pair: Pair,
        lengths: [usize; COUNT],
        seen: &SeenPass,
        watch: &Watch,
        fair: Option<&mut AlikeStep<'_>>,
    ) -> Option<()> {
        let index = self.number;
        self.number += COUNT;
        let is_searched = self.searched.first().is_some_and(|&first| first as usize == index);
        if is_searched {
            self.searched = &self.searched[1..];
        }
        let begin = self.own.at;
        let (mut last, mut end) = (begin, begin);
        for _ in 0..COUNT {
            (last, end) = (end, self.own.behind(end)?);
        }
        let own = self.own.bytes.get(begin..end)?;
        if self.theirs.bytes[self.theirs.at..].starts_with(own) {
            self.own.at = end;
            self.theirs.at += end - begin;
            let Some(fair) = fair else { return Some(()) };
            fair.count_same(pair.kind);
            if fair.wants_form(pair) {
                fair.form_of_same(pair, index, seen, own.get(last + 4 - begin..)?)?;
            }
            return Some(());
        }
        self.other_call(&Place { pair, seen, index, lengths, is_searched }, watch, fair)
    }

    /// The same of a call of which a polynomial is not the reference's.
    #[inline(always)]
    fn other_call<const COUNT: usize>(
        &mut self,
        place: &Place<'_, COUNT>,
        watch: &Watch,
        fair: Option<&mut AlikeStep<'_>>,
    ) -> Option<()> {
        let &Place { pair, seen, index, ref lengths, is_searched } = place;
        let mut both: [Both<'_>; COUNT] = [[&[]; 2]; COUNT];
        let mut alike = [Likeness::NONE; COUNT];
        let mut has_lost = false;
        for number in 0..COUNT {
            let (own, theirs) = (self.own.next()?, self.theirs.next()?);
            both[number] = [own, theirs];
            // The course's library logs no small leading coefficients.
            if theirs.first_chunk().is_some_and(|c| f64::from_le_bytes(*c).abs() < LEADING_COEFFICIENT) {
                return None;
            }
            if own.len() == theirs.len() {
                if own.is_empty() {
                    continue;
                }
                alike[number] = likeness([own, theirs]);
                if passes_at_once(&alike[number]) {
                    continue;
                }
            } else {
                has_lost = true;
            }
            let (pass, role) = (seen.pass, Role::of(pair.kind, number));
            self.compare([own, theirs], PolynomialPlace { pass, pair, role, index: index + number });
        }
        let (both, lengths, alike) = (&both[..], &lengths[..], &alike[..]);
        match fair {
            Some(fair) => fair.take(&Call { pair, index, both, lengths, alike, has_lost, is_searched }, seen, watch),
            None => Some(()),
        }
    }

    /// Compares two polynomials as the original does.
    #[inline(never)]
    fn compare(&mut self, both: Both<'_>, place: PolynomialPlace) {
        let [own, theirs] = both.map(Numbers::of);
        if !tally::passes(own.list(), theirs.list()) {
            self.pending.compare(self.at, own.list(), theirs.list(), || place);
        }
    }
}

/// A call among those of a pass.
struct Place<'a, const COUNT: usize> {
    pair: Pair,
    seen: &'a SeenPass,
    /// The number of its first polynomial.
    index: usize,
    lengths: [usize; COUNT],
    is_searched: bool,
}

/// How two polynomials of the same length compare.
#[inline(always)]
fn likeness(both: Both<'_>) -> Likeness {
    match both[0].len() / 8 {
        1 => of::<1>(both),
        2 => of::<2>(both),
        3 => of::<3>(both),
        4 => of::<4>(both),
        5 => of::<5>(both),
        6 => of::<6>(both),
        _ => Likeness::NONE,
    }
}

#[inline(always)]
fn of<const LENGTH: usize>([own, theirs]: Both<'_>) -> Likeness {
    let chunks = |bytes: &[u8]| bytes.as_chunks::<8>().0.first_chunk::<LENGTH>().copied();
    let (Some(own), Some(theirs)) = (chunks(own), chunks(theirs)) else { return Likeness::NONE };
    Likeness::of(own.map(f64::from_le_bytes).into_iter().zip(theirs.map(f64::from_le_bytes)))
}

/// Whether the original finds nothing for certain. What one division for all coefficients rounds otherwise than the
/// original is less than a tenth of the bound among numbers of this size.
#[inline]
fn passes_at_once(likeness: &Likeness) -> bool {
    (likeness.sum >= PARITY_ZERO_POLYNOMIAL) & (likeness.logged <= 1e3) & (likeness.worst <= 0.9 * PARITY_COEFFICIENT)
}
