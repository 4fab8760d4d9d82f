//! Observes the reference's run of a scene, and records every event.
use super::{
    Coverage,
    axes::{
        ContactCount, Ends, Forces, Hits, Links, LoopEnd, Penalty, Position, Rounds, Size, ZoneAnchor, ZoneCount,
        ZoneEdge, ZoneOrigin,
    },
    events,
    families::{
        ContinuousStep, EdgeContact, Event, HalfPlaneContact, HybridStep, MovedZone, NoContact, ParticleContact,
    },
};
use fosssim_model::{
    scene::{Collision, Force, Scene},
    sim::{Decision, Detection, Observer, Pair, PairKind, Pass, Stage, State, Zone},
};
use std::collections::BTreeSet;

/// The bodies of a contact in the current pass, and its event in two forms: for bodies that have no other contact, and
/// for bodies that have several. Which form applies is known at the end of the pass.
type WatchedContact = (Vec<usize>, [Event; 2]);

/// A zone of the previous round, and whether it was moved.
type EarlierZone = (Vec<usize>, bool);

pub(super) struct CoverageObserver<'a> {
    scene: &'a Scene,
    coverage: &'a mut Coverage,
    stage: Stage,
    step: StepEvents,
}

/// The events of the current step that are still incomplete.
#[derive(Default)]
struct StepEvents {
    /// The positions of bodies at the start and at the end of the step, as the current pass uses them.
    q_start: Vec<f64>,
    q_end: Vec<f64>,
    contacts: Vec<WatchedContact>,
    /// The number of hits in each pass of the impulse rounds, or in the only pass of the step.
    hits: Vec<usize>,
    /// All contacts in the passes that search for zones.
    zone_contacts: BTreeSet<Pair>,
    /// The zones that are moved in this round.
    zones: Vec<EarlierZone>,
    /// The zones of the previous round, and whether each was moved.
    previous_zones: Vec<EarlierZone>,
    rounds: u32,
}

impl<'a> CoverageObserver<'a> {
    pub(super) fn new(scene: &'a Scene, coverage: &'a mut Coverage) -> Self {
        Self { scene, coverage, stage: Stage::Simple, step: StepEvents::default() }
    }

    fn contact_event(&self, detection: &Detection<'_>, bodies: &[usize], time: f64, company: ContactCount) -> Event {
        let scene = self.scene;
        let (found, when) = (events::stage_value(self.stage), events::time_range(time));
        let (restitution, integrator) = (events::restitution(scene), events::integrator(scene));
        let masses = events::masses(scene, bodies);
        match detection.pair.kind {
            PairKind::ParticleParticle => {
                let (fixed, radii) = (events::count_fixed_of_two(scene, bodies), events::radii(scene, bodies, None));
                ParticleContact { found, when, fixed, masses, radii, company, restitution, integrator }.event()
            }
            PairKind::ParticleEdge => {
                let edge = &scene.edges[detection.pair.second as usize];
                let contact = EdgeContact {
                    found,
                    when,
                    fixed: events::count_fixed_of_three(scene, bodies),
                    place: events::classify_contact_place(detection, bodies, time),
                    ends: events::classify_ends(edge),
                    motion: events::classify_edge_motion(detection, bodies),
                    masses,
                    radii: events::radii(scene, bodies, Some(edge)),
                    company,
                    restitution,
                    integrator,
                };
                contact.event()
            }
            PairKind::ParticleHalfPlane => {
                let fixed = events::fixed_single(scene, bodies);
                let (side, normal) = (events::find_side(scene, detection), events::find_normal(scene, detection.pair));
                HalfPlaneContact { found, when, fixed, side, normal, company, restitution, integrator }.event()
            }
        }
    }

    /// Records the contacts of a pass. Only at the end of the pass is it known which of them have bodies in common.
    fn record_contacts(&mut self) {
        let contacts = std::mem::take(&mut self.step.contacts);
        for (index, (bodies, [alone, several])) in contacts.iter().enumerate() {
            let shares = |other: &WatchedContact| other.0.iter().any(|body| bodies.contains(body));
            let is_alone = contacts.iter().enumerate().all(|(other, contact)| other == index || !shares(contact));
            self.coverage.record_event(if is_alone { alone } else { several });
        }
    }

    fn zone_events(&self, particles: &[usize], half_plane: bool) -> Vec<MovedZone> {
        let scene = self.scene;
        let is_known = |zone: &&EarlierZone| zone.0.iter().any(|particle| particles.contains(particle));
        let age = match self.step.previous_zones.iter().find(is_known) {
            _ if self.step.rounds == 1 => ZoneOrigin::First,
            None => ZoneOrigin::New,
            Some((same, flag)) if same == particles && *flag == half_plane => ZoneOrigin::Same,
            Some(_) => ZoneOrigin::Grown,
        };
        let index = self.step.zones.iter().position(|zone| zone.0 == particles).unwrap_or(0);
        let position = match (index, self.step.zones.len()) {
            (_, 0 | 1) => Position::Only,
            (0, _) => Position::First,
            (last, all) if last + 1 == all => Position::Last,
            _ => Position::Between,
        };
        let size = match particles.len() {
            1 => Size::One,
            2 => Size::Two,
            3 => Size::Three,
            _ => Size::More,
        };
        let anchor = match (particles.iter().any(|&particle| scene.particles[particle].fixed), half_plane) {
            (false, false) => ZoneAnchor::Nothing,
            (true, false) => ZoneAnchor::Fixed,
            (false, true) => ZoneAnchor::HalfPlane,
            (true, true) => ZoneAnchor::Both,
        };
        let contacts = || self.step.zone_contacts.iter().filter(|pair| particles.contains(&(pair.first as usize)));
        let links = if contacts().count() > 1 { Links::Several } else { Links::One };
        let zone = MovedZone {
            size,
            held: anchor,
            motion: events::classify_zone_motion(scene, particles, &self.step.q_start, &self.step.q_end),
            age,
            position,
            edge: ZoneEdge::None,
            links,
            masses: events::masses(scene, particles),
            radii: events::radii(scene, particles, None),
            limit: events::limit(scene),
            integrator: events::integrator(scene),
        };
        let edge = |pair: &Pair| match events::classify_ends(&scene.edges[pair.second as usize]) {
            Ends::Next => ZoneEdge::Next,
            Ends::Previous => ZoneEdge::Previous,
            Ends::Up | Ends::Down => ZoneEdge::Apart,
        };
        let edges = contacts().filter(|pair| pair.kind == PairKind::ParticleEdge).map(edge);
        let with_edges: Vec<MovedZone> = edges.map(|edge| MovedZone { edge, ..zone }).collect();
        if with_edges.is_empty() { vec![zone] } else { with_edges }
    }

    fn hybrid_step_value(&self, max_iterations: i32, stiffness: f64) -> HybridStep {
        let limit = usize::try_from(max_iterations).unwrap_or(0);
        let ends_empty = self.step.hits.last() == Some(&0);
        let end = match self.step.hits.len() {
            0 => LoopEnd::NotAllowed,
            1 if ends_empty => LoopEnd::Nothing,
            rounds if ends_empty && rounds == limit => LoopEnd::JustEnough,
            _ if ends_empty => LoopEnd::Within,
            _ => LoopEnd::RunOut,
        };
        HybridStep {
            end,
            zones: match self.step.zones.len() {
                0 => ZoneCount::None,
                1 => ZoneCount::One,
                _ => ZoneCount::Several,
            },
            rounds: match self.step.rounds {
                0 => Rounds::None,
                1 => Rounds::One,
                2 => Rounds::Two,
                _ => Rounds::More,
            },
            limit: events::limit(self.scene),
            restitution: events::restitution(self.scene),
            forces: force_events(&self.scene.forces),
            penalty: if stiffness == 0.0 { Penalty::Off } else { Penalty::On },
            integrator: events::integrator(self.scene),
        }
    }
}

const fn force_events(forces: &[Force]) -> Forces {
    if forces.is_empty() { Forces::None } else { Forces::Some }
}

impl Observer for CoverageObserver<'_> {
    fn begin_step(&mut self, _step: u32) {
        self.step = StepEvents::default();
    }

    fn begin_pass(&mut self, pass: Pass) {
        self.stage = pass.stage;
        if let Stage::Geometric { round } = pass.stage {
            self.step.rounds = round;
        }
    }

    fn observe_positions(&mut self, q_start: &[f64], q_end: &[f64]) {
        (self.step.q_start, self.step.q_end) = (q_start.to_vec(), q_end.to_vec());
    }

    fn observe_detection(&mut self, detection: &Detection<'_>) {
        let bodies = events::bodies(self.scene, detection.pair);
        match detection.decision {
            Decision::Hit { time, .. } => {
                if matches!(self.stage, Stage::Geometric { .. }) {
                    self.step.zone_contacts.insert(detection.pair);
                }
                let contact_with = |company| self.contact_event(detection, &bodies, time, company);
                let both = [ContactCount::Alone, ContactCount::Several].map(contact_with);
                self.step.contacts.push((bodies, both));
            }
            Decision::Miss { .. } => {
                let no_contact = NoContact {
                    kind: events::convert_kind(detection.pair.kind),
                    why: events::find_miss_reason(detection.pair.kind, detection.polynomials),
                    found: events::stage_value(self.stage),
                    fixed: events::any_fixed(self.scene, &bodies),
                };
                self.coverage.record_event(&no_contact.event());
            }
        }
    }

    fn end_pass(&mut self, pass: Pass, hits: usize) {
        self.record_contacts();
        if !matches!(pass.stage, Stage::Geometric { .. }) {
            self.step.hits.push(hits);
        }
    }

    fn observe_zones(&mut self, _round: u32, zones: &[Zone<'_>]) {
        let zone_members =
            |zone: &Zone<'_>| (zone.particles.iter().map(|&particle| particle as usize).collect(), zone.half_plane);
        self.step.previous_zones = std::mem::replace(&mut self.step.zones, zones.iter().map(zone_members).collect());
    }

    fn observe_failsafe(&mut self, round: u32, zone: &Zone<'_>) {
        self.step.rounds = round;
        let particles: Vec<usize> = zone.particles.iter().map(|&particle| particle as usize).collect();
        for zone in self.zone_events(&particles, zone.half_plane) {
            self.coverage.record_event(&zone.event());
        }
    }

    fn end_step(&mut self, _step: u32, _state: &State) {
        match self.scene.collision {
            Collision::Hybrid { max_iterations, stiffness, .. } => {
                let step = self.hybrid_step_value(max_iterations, stiffness);
                self.coverage.record_event(&step.event());
            }
            Collision::ContinuousTime { .. } => {
                let hits = match self.step.hits.first().copied().unwrap_or(0) {
                    0 => Hits::None,
                    1 => Hits::One,
                    _ => Hits::Several,
                };
                let (restitution, integrator) = (events::restitution(self.scene), events::integrator(self.scene));
                let step = ContinuousStep { hits, restitution, forces: force_events(&self.scene.forces), integrator };
                self.coverage.record_event(&step.event());
            }
            Collision::None | Collision::Simple { .. } | Collision::Penalty { .. } => {}
        }
    }
}
