//! Finds several mistakes together: empty stages, and rows that are added one by one.
//!
//! A row is added if the simulation of the wrong steps then follows the log further. A set is an explanation only if it
//! reproduces everything, including right steps, and no row can be omitted.
use super::{applicable_rows::applicable_rows, rank_plausibility, resimulate::ApproachForm, trials::Trials};
use crate::diagnose::sampling::{KeptStep, Reference, Scan};
use fosssim_model::{scene::Scene, sim::pairs, trace::Layout};
use fosssim_student::{Area, Mistake, Row, RowKind};

/// The maximum number of mistakes in a set, in addition to empty stages.
const MAX_MISTAKES: usize = 3;
/// The maximum number of sets of empty stages that are tried.
const MAX_SETS: usize = 1 << 8;
/// The maximum number of computed polynomials. Computing one takes about a microsecond.
const MAX_WORK: u64 = 700_000;

/// Rows that reproduce a trace together.
pub(super) struct RowCombination {
    /// The rows: first the empty stages, then the others in the order in which they were found.
    pub(super) rows: Vec<&'static Row>,
    /// For each row of the combination, the rows that explain as much.
    pub(super) equivalent_rows: Vec<Vec<&'static Row>>,
    /// Other rows that explain the trace without any empty stage.
    pub(super) rival_rows: Vec<&'static Row>,
    /// The number of wrong steps that were tried. All of them are reproduced.
    pub(super) samples: u64,
}

/// Returns the set of rows that reproduces all kept steps, or `None` if no set of at least two rows is found.
pub(super) fn find_row_set(
    reference: &Reference<'_>,
    scene: &Scene,
    scan: &Scan,
    correct: ApproachForm,
) -> Option<RowCombination> {
    let search = Search::new(reference, scene, scan, correct);
    if !Layout::for_scene(scene).has_polynomials {
        return search.find_combination();
    }
    let mut found = search.find_starting_sets().into_iter().find_map(|start| search.complete_set(start))?;
    // An empty stage may look like a mistake in another stage.
    if found.rows.iter().any(|row| is_empty_stage(row))
        && let Some(other) = search.complete_set(Vec::new())
        && other.rows.len() <= found.rows.len()
    {
        let is_new = |row: &&&Row| found.rows.iter().all(|known| known.mistake != row.mistake);
        found.rival_rows =
            other.rows.iter().chain(other.equivalent_rows.iter().flatten()).filter(is_new).copied().collect();
    }
    Some(found)
}

/// Returns whether a row describes a function that was not written.
pub(in crate::diagnose) fn is_empty_stage(row: &Row) -> bool {
    rank_plausibility(row) == 0
}

struct Search<'a> {
    scene: &'a Scene,
    trials: Trials<'a>,
    scan: &'a Scan,
    /// The wrong steps on which rows are compared.
    probes: Vec<&'a KeptStep>,
}

impl<'a> Search<'a> {
    fn new(reference: &'a Reference<'_>, scene: &'a Scene, scan: &'a Scan, correct: ApproachForm) -> Self {
        Self { scene, trials: Trials::new(reference, scene, correct), scan, probes: scan.probes() }
    }

    #[expect(clippy::cast_precision_loss, reason = "a handful")]
    fn full_share(&self) -> f64 {
        self.probes.len() as f64 - 1e-9
    }

    fn reproduced_share(&self, rows: &[&'static Row]) -> f64 {
        let program = self.trials.program(rows);
        self.probes.iter().map(|kept| self.trials.reproduced_share(&program, kept)).sum()
    }

    /// Adds rows to the empty stages in `set` until all probes are reproduced. Returns `None` if `MAX_MISTAKES` more
    /// rows do not suffice, if the complete set has fewer than two rows, if one of its rows can be omitted, if the
    /// other wrong steps do not confirm it, or if one of its rows is a correct variant.
    fn complete_set(&self, mut set: Vec<&'static Row>) -> Option<RowCombination> {
        // For each row of the set, the rows that explained as much when it was added.
        let mut equivalent_rows: Vec<Vec<&'static Row>> = set.iter().map(|_| Vec::new()).collect();
        let mut best = self.reproduced_share(&set);
        while best < self.full_share() && set.iter().filter(|row| !is_empty_stage(row)).count() < MAX_MISTAKES {
            let (row, progress, others) = self.find_next_row(&set, best)?;
            set.push(row);
            best = progress;
            equivalent_rows.push(others);
        }
        if set.len() < 2 || best < self.full_share() || !self.needs_all_rows(&set) {
            return None;
        }
        let samples = self.count_steps_if_confirmed(&set)?;
        let is_variant = |row: &&'static Row| row.kind == RowKind::Variant;
        if set.iter().chain(equivalent_rows.last().into_iter().flatten()).any(is_variant) {
            return None;
        }
        for (index, others) in equivalent_rows.iter_mut().enumerate() {
            let with = |other: &'static Row| {
                let mut set = set.clone();
                set[index] = other;
                set
            };
            let is_last = index + 1 == set.len();
            others.retain(|other| {
                !is_empty_stage(set[index]) && (is_last || self.reproduced_share(&with(other)) >= self.full_share())
            });
        }
        Some(RowCombination { rows: set, equivalent_rows, rival_rows: Vec::new(), samples })
    }

    /// Returns several mistakes that together explain a program whose steps log only states. In such a program, one of
    /// the mistakes alone reproduces nothing more of a step, but all of them together reproduce all of it. Sets of
    /// unwritten functions are tried first, then one mistake with such functions, then two mistakes. Returns `None` if
    /// no set reproduces everything, or if two sets do that differ in more than one row.
    fn find_combination(&self) -> Option<RowCombination> {
        let is_candidate = |row: &&Row| row.kind == RowKind::Wrong && row.area != Area::Trace;
        let rows: Vec<&'static Row> = applicable_rows(self.scene).filter(is_candidate).collect();
        let mut empty = list_subsets(&self.empty_stage_rows());
        let set_count = empty.len().min(MAX_SETS);
        empty.truncate(set_count);
        let explains = |set: &Vec<&'static Row>| self.is_minimal_explanation(set);
        if let Some(rows) = empty.iter().filter(|set| set.len() > 1).find(|set| explains(set)) {
            let same_as = rows.iter().map(|_| Vec::new()).collect();
            return Some(RowCombination {
                rows: rows.clone(),
                equivalent_rows: same_as,
                rival_rows: Vec::new(),
                samples: self.count_steps_if_confirmed(rows)?,
            });
        }
        let with = |set: &Vec<&'static Row>, row| set.iter().copied().chain([row]).collect();
        let next_to_sets = |size: usize| {
            let sets = empty.iter().filter(move |set| set.len() == size);
            sets.flat_map(|set| rows.iter().filter(|row| !is_empty_stage(row)).map(|row| with(set, row)))
        };
        let row_pairs = rows.iter().enumerate().flat_map(|(index, &one)| {
            rows[index + 1..].iter().filter(move |_| !is_empty_stage(one)).map(move |&other| vec![one, other])
        });
        self.find_unique_set(next_to_sets(1))
            .or_else(|| self.find_unique_set(next_to_sets(2)))
            .or_else(|| self.find_unique_set(row_pairs))
    }

    /// Returns the only set that reproduces everything, with the alternatives for one of its rows. Returns `None` if
    /// there is no such set, if there are different ones, or if the work exceeds its limit.
    fn find_unique_set(&self, sets: impl Iterator<Item = Vec<&'static Row>>) -> Option<RowCombination> {
        let mut found: Vec<Vec<&'static Row>> = Vec::new();
        for set in sets {
            if self.trials.exceeds_limit(MAX_WORK) {
                return None;
            }
            if self.is_minimal_explanation(&set) {
                found.push(set);
            }
        }
        let first = found.first()?.clone();
        let samples = self.count_steps_if_confirmed(&first)?;
        let is_in = |set: &[&Row], row: &Row| set.iter().any(|other| other.id == row.id);
        let instead = |own: &&'static Row| -> Vec<&'static Row> {
            let others: Vec<&Row> = first.iter().copied().filter(|row| row.id != own.id).collect();
            let other_sets = found[1..].iter().filter(|set| others.iter().all(|row| is_in(set, row)));
            other_sets.flatten().filter(|row| !is_in(&first, row)).copied().collect()
        };
        let same_as: Vec<Vec<&'static Row>> = first.iter().map(instead).collect();
        let is_unique = found.len() == 1 + same_as.iter().map(Vec::len).sum::<usize>();
        is_unique.then(|| RowCombination { rows: first, equivalent_rows: same_as, rival_rows: Vec::new(), samples })
    }

    /// Returns whether the rows reproduce everything, and none can be omitted.
    fn is_minimal_explanation(&self, set: &[&'static Row]) -> bool {
        let Some(probe) = self.probes.first() else { return false };
        self.trials.reproduced_share(&self.trials.program(set), probe) >= 1.0
            && self.reproduced_share(set) >= self.full_share()
            && self.needs_all_rows(set)
            && self.count_steps_if_confirmed(set).is_some()
    }

    /// Returns the initial sets of empty stages. One is the set that reproduces most. The others are sets of unwritten
    /// detections with which the logged number of polynomials fits whole passes. They are needed if another mistake
    /// hides the first set.
    fn find_starting_sets(&self) -> Vec<Vec<&'static Row>> {
        let mut starts = vec![self.find_empty_stages()];
        let counts: Vec<usize> =
            self.scan.wrong_steps.iter().map(|sample| sample.records.end.polynomials.len()).collect();
        let divides_counts =
            |pass: usize| counts.iter().all(|&count| if pass == 0 { count == 0 } else { count.is_multiple_of(pass) });
        let sizes = self.row_sizes();
        let total: usize = sizes.iter().map(|(_, size)| size).sum();
        if divides_counts(total) {
            return starts;
        }
        let mut sets = list_subsets(&sizes);
        sets.retain(|set| !set.is_empty() && divides_counts(total - set.iter().map(|(_, size)| size).sum::<usize>()));
        starts.extend(sets.into_iter().take(MAX_MISTAKES).map(|set| set.into_iter().map(|(row, _)| row).collect()));
        starts
    }

    /// Returns the rows of unwritten detections on this scene, each with the number of polynomials that the detection
    /// would log in a pass.
    fn row_sizes(&self) -> Vec<(&'static Row, usize)> {
        let counts = pairs(self.scene).counts();
        let size = |row: &Row| row.pair_kind().map_or(0, |kind| counts[kind] * kind.polynomial_count());
        self.empty_stage_rows().into_iter().map(|row| (row, size(row))).filter(|(_, size)| *size > 0).collect()
    }

    /// Returns the smallest set of empty stages that reproduces the largest part of the steps. The set is empty if no
    /// empty stage helps.
    fn find_empty_stages(&self) -> Vec<&'static Row> {
        let mut sets = list_subsets(&self.empty_stage_rows());
        // One variant of an empty loop is enough, and an empty failsafe is not visible if it is never called.
        sets.retain(|set: &Vec<&Row>| {
            let has = |mistake| set.iter().any(|row| row.mistake == mistake);
            let loops = has(Mistake::ImpulsesEmpty) && has(Mistake::ImpulsesEmptySuccess);
            let unseen = has(Mistake::GeometricEmpty) && has(Mistake::FailsafeEmpty);
            !loops && !unseen
        });
        let mut best = (self.reproduced_share(&[]), Vec::new());
        for set in sets.into_iter().skip(1) {
            if self.trials.exceeds_limit(MAX_WORK / 2) {
                break;
            }
            let progress = self.reproduced_share(&set);
            if progress > best.0 + 1e-9 {
                best = (progress, set);
            }
        }
        best.1
    }

    /// Returns the rows of empty stages that may show in the scene. An unwritten detection logs nothing, or zeros.
    fn empty_stage_rows(&self) -> Vec<&'static Row> {
        // For bodies at rest the approach polynomial is zero, too, but not the overlap polynomial before it.
        let logs_zeros = self.scan.wrong_steps.iter().any(|kept| {
            let are_zero = |list: &[f64]| list.iter().all(|&coefficient| coefficient == 0.0);
            let all: Vec<bool> = kept.records.end.polynomials.iter().map(are_zero).collect();
            all.windows(2).any(|two| two == [true, true])
        });
        let is_candidate = |row: &&Row| match row.mistake {
            Mistake::ParticleParticleEmpty | Mistake::ParticleEdgeEmpty | Mistake::HalfPlaneEmpty => !logs_zeros,
            Mistake::ParticleParticleZero | Mistake::ParticleEdgeZero | Mistake::HalfPlaneZero => logs_zeros,
            _ => is_empty_stage(row),
        };
        applicable_rows(self.scene).filter(is_candidate).collect()
    }

    /// Returns the row that increases the reproduced share beyond `reached` the most, the new share, and the other rows
    /// that reach the same share. Returns `None` if no row increases it, or if the work exceeds its limit.
    fn find_next_row(&self, set: &[&'static Row], reached: f64) -> Option<(&'static Row, f64, Vec<&'static Row>)> {
        let mut best: (f64, Vec<&'static Row>) = (reached + 1e-9, Vec::new());
        let rows = applicable_rows(self.scene).filter(|row| set.iter().all(|other| other.mistake != row.mistake));
        for row in rows {
            if self.trials.exceeds_limit(MAX_WORK) {
                return None;
            }
            let with: Vec<&Row> = set.iter().copied().chain([row]).collect();
            let progress = self.reproduced_share(&with);
            if progress > best.0 + 1e-9 {
                best = (progress, vec![row]);
            } else if (progress - best.0).abs() <= 1e-9 && !best.1.is_empty() {
                best.1.push(row);
            }
        }
        let (progress, mut rows) = best;
        // Among rows that reproduce as much, those that make right steps wrong come last.
        let spoils = |row: &&'static Row| {
            let program = self.trials.program(&[set, &[*row]].concat());
            self.scan.right_steps.iter().any(|kept| self.trials.reproduced_share(&program, kept) < 1.0)
        };
        rows.sort_by_cached_key(|row| (spoils(row), rank_plausibility(row)));
        (!rows.is_empty()).then(|| (rows[0], progress, rows[1..].to_vec()))
    }

    /// Returns whether no row can be omitted.
    fn needs_all_rows(&self, set: &[&'static Row]) -> bool {
        (0..set.len()).all(|index| {
            let without: Vec<&Row> =
                set.iter().enumerate().filter(|(other, _)| *other != index).map(|(_, row)| *row).collect();
            self.reproduced_share(&without) < self.full_share()
        })
    }

    /// Returns the number of wrong steps if the set reproduces all of them and all right ones within the allowed work.
    fn count_steps_if_confirmed(&self, set: &[&'static Row]) -> Option<u64> {
        let program = self.trials.program(set);
        let mut samples = 0;
        for sample in self.scan.right_steps.iter().chain(&self.scan.wrong_steps) {
            if self.trials.exceeds_limit(2 * MAX_WORK) && samples > 0 {
                break;
            }
            if self.trials.reproduced_share(&program, sample) < 1.0 {
                return None;
            }
            samples += u64::from(sample.difference.is_some());
        }
        (samples > 0).then_some(samples)
    }
}

/// Returns all subsets, the smallest first.
fn list_subsets<T: Copy>(all: &[T]) -> Vec<Vec<T>> {
    let subset = |bits: u32| (0..all.len()).filter(|bit| bits >> bit & 1 == 1).map(|bit| all[bit]).collect();
    let mut sets: Vec<Vec<T>> = (0..1 << all.len()).map(subset).collect();
    sets.sort_by_key(Vec::len);
    sets
}
