//! From a case to the particles of this rank at time zero, or from saved particles to a run.

use super::candidate::StepControl;
use super::dormant::Dormant;
use super::error::SetupError;
use super::fields::{store_of, unused_fields};
use super::given;
use super::removal::Frozen;
use super::restored::require_own;
use super::simulation::Simulation;
use super::timers::Timers;
use crate::contact::{Connectivity, Contact};
use crate::diagnose::{
    KeptTotals, LoadState, PairState, Passed, Removed, RunState, StepSums, Worst,
    angular_momentum_scale,
};
use crate::domain::{Decomposition, Halo, Outset, Partition};
use crate::fragments::Labels;
use crate::loads::{Absorption, Goal, Loads, Prescribe};
use crate::measure::Measures;
use crate::sph::Sph;
use comm::Comm;
use model::{Body, Case, SphForm, edge};
use numerics::collector::Collector;
use particles::Mirrors;
use particles::neighbours::Lists;
use particles::{Image, ParticleStore};
use populate::{self, Brick};

impl Simulation {
    /// Fills the bodies of a case, each rank its own brick, and evaluates the first forces.
    /// Collective.
    ///
    /// # Errors
    /// The same on all ranks if the case has no particles or too many, or blows up at once.
    pub fn start(case: Case, comm: &Comm) -> Result<Self, SetupError> {
        let outset = Outset::new(&case).ok_or(SetupError::Empty)?;
        let partition = Partition::new(&case, comm, &outset);
        let mut simulation = Self::empty(case, comm, &outset, partition);
        simulation.populate(comm)?;
        simulation.begin(comm)?;
        simulation.open_departures();
        Ok(simulation)
    }

    /// Takes up a run from its saved scalar state and any share of its saved particles.
    /// Collective.
    ///
    /// # Errors
    /// As [`Self::start`].
    pub fn resume(
        case: Case,
        comm: &Comm,
        state: RunState,
        particles: ParticleStore,
    ) -> Result<Self, SetupError> {
        let outset = Outset::new(&case).ok_or(SetupError::Empty)?;
        let partition = Partition::none(&case, comm, &outset);
        let mut simulation = Self::empty(case, comm, &outset, partition);
        require_own(comm, &simulation, &state, &particles)?;
        simulation.particles = particles;
        let unused = unused_fields(&simulation.case, &simulation.contact.table);
        simulation.frozen = Frozen::part(comm, &mut simulation.particles, unused);
        simulation.state = state;
        simulation.open_departures();
        let smoothing = &simulation.sph.smoothing;
        simulation
            .partition
            .begin(comm, &mut simulation.particles, |particles, i| {
                smoothing.reach(particles, i)
            });
        limit_count(comm, simulation.particles.owned() as u64)?;
        Ok(simulation)
    }

    /// Everything but particles, with slabs for them.
    fn empty(case: Case, comm: &Comm, outset: &Outset, partition: Partition) -> Self {
        let contact = Contact::new(&case);
        let measures = Measures::new(&case);
        let table = &contact.table;
        let particles = store_of(&case);
        Self {
            frozen: Frozen::like(&particles),
            leaving: Vec::new(),
            collector: Collector::default(),
            particles,
            state: RunState {
                pairs: vec![PairState::default(); table.active_pairs().len()],
                loads: vec![LoadState::default(); case.load_names().count()],
                passed: vec![Passed::default(); measures.witnesses.ledgers()],
                ..RunState::default()
            },
            timers: Timers::default(),
            poison: false,
            step_control: StepControl::new(&case, table, comm),
            lists: Lists::new(&case, table.groups.clone(), &outset.boxes, outset.longest),
            partition,
            halo: Halo::new(Mirrors::new(&case.symmetry)),
            sph: Sph::new(&case),
            loads: Loads::new(&case),
            sums: StepSums::new(table),
            kept_totals: KeptTotals::default(),
            contact,
            dormant: Dormant::new(&case),
            labels: Labels::default(),
            measures,
            case,
        }
    }

    /// Ledgers of what leaves the box of interest, which a case may have from a restart on.
    fn open_departures(&mut self) {
        if self.case.domain.keep.is_some() {
            let bodies = self.case.bodies.len();
            self.state.departed.resize(bodies, Removed::default());
        }
    }

    /// Creates the particles of this rank's brick, and no others.
    fn populate(&mut self, comm: &Comm) -> Result<(), SetupError> {
        let brick = self.partition.slabs().region(comm.rank());
        let case = &self.case;
        let stressed = case.sph.form == SphForm::StressPoints;
        let count = |body| {
            let (dimension, planes) = (case.dimension, &case.symmetry);
            let points = if stressed {
                populate::stress_count(body, dimension, planes, Some(brick))
            } else {
                0
            };
            points + populate::count(body, dimension, planes, Some(brick))
        };
        let total: u64 = case.bodies.iter().map(count).sum();
        limit_count(comm, total)?;
        self.particles
            .resize_owned(usize::try_from(total).unwrap_or(usize::MAX));
        let mut i = 0;
        let mut first_id = 0_u64;
        let mut unsound = None;
        for (b, body) in case.bodies.iter().enumerate() {
            // Heat and plastic strain of bodies with stress points are those of the points.
            let start = Start::new(case, b, !stressed);
            for site in populate::sites(body, case.dimension, &case.symmetry, Some(brick)) {
                let particles = &mut self.particles;
                let id = first_id + site.index;
                let sound = start.put(particles, i, id, (site.position, site.index));
                unsound = unsound.or_else(|| sound.err().map(|why| (id, why)));
                particles.mass[i] = start.mass * site.share;
                particles.smoothing_length[i] *= edge(site.share, case.dimension);
                given::take_on(body, particles, i, site.index);
                Connectivity::begin(particles, i, first_id);
                if self.loads.has_motions() {
                    let bits = self.loads.bits(case, b, &site.position);
                    let prescribed = self.loads.of(bits);
                    prescribed.set(Goal::End, &mut particles.velocity[i]);
                    prescribed.set(Goal::End, &mut particles.predicted_velocity[i]);
                    particles.load[i] = bits;
                }
                if self.loads.absorb() {
                    particles.absorption[i] = Absorption::rate(case, b, &site.position);
                }
                i += 1;
            }
            first_id = beyond(first_id, populate::index_end(body, case.dimension))?;
        }
        if stressed {
            i = self.populate_stress_points(i, first_id, brick, &mut unsound)?;
        }
        debug_assert_eq!(i, self.particles.owned());
        self.deal_moved(comm);
        all_sound(comm, unsound)
    }

    /// Hands particles that begin outside of their brick to its owner, if there can be such.
    /// Collective.
    fn deal_moved(&mut self, comm: &Comm) {
        if self.case.bodies.iter().any(populate::moves_sites) {
            self.partition.deal(comm, &mut self.particles);
        }
    }

    /// Creates the stress points of a brick from place `i` of the store and `first_id` on, and books the
    /// first that begins out of range; gives the place after the last.
    fn populate_stress_points(
        &mut self,
        mut i: usize,
        mut first_id: u64,
        brick: Brick,
        unsound: &mut Option<(u64, String)>,
    ) -> Result<usize, SetupError> {
        let (case, particles) = (&self.case, &mut self.particles);
        for (b, body) in case.bodies.iter().enumerate() {
            let start = Start::new(case, b, true);
            for site in populate::stress_sites(body, case.dimension, &case.symmetry, Some(brick)) {
                let id = first_id + site.index;
                if let Err(why) = start.put(particles, i, id, (site.position, site.index)) {
                    unsound.get_or_insert((id, why));
                }
                particles.stress_mass[i] = start.mass * site.share;
                if self.loads.absorb() {
                    particles.absorption[i] = Absorption::rate(case, b, &site.position);
                }
                i += 1;
            }
            first_id = beyond(first_id, populate::stress_index_end(body, case.dimension))?;
        }
        Ok(i)
    }

    /// First forces, sums and time step.
    fn begin(&mut self, comm: &Comm) -> Result<(), SetupError> {
        self.migrate(comm);
        // The first search finds which parts bodies are in, and the order of the store.
        self.search(comm);
        let scratch = self.sph.scratch(self.particles.owned());
        let all = (&mut self.particles, &self.dormant.asleep);
        self.lists.restore_order(all, scratch);
        self.search(comm);
        let mut capped = [self.contact.begin(&mut self.particles, &self.lists)];
        comm.sum_i64(&mut capped);
        self.state.capped_reliefs = capped[0];
        self.sum(comm, 0.0);
        let own = self.kick(0.0);
        let candidate = self.book_step(comm, 0.0, own);
        self.state.initial = self.totals(comm);
        self.state.initial.contact_energy = self.state.contact_energy;
        let scale = angular_momentum_scale(&self.particles, &self.loads, comm);
        self.state.angular_momentum_scale = Some(scale);
        self.state.worst = Worst::default();
        self.diagnose(comm);
        self.state.worst.nearest = None;
        self.choose_step(comm, candidate)?;
        self.begin_measures(comm);
        Ok(())
    }
}

/// What all particles of a body begin with.
struct Start<'a> {
    case: &'a Case,
    of: &'a Body,
    body: u32,
    /// Of a whole particle (kg).
    mass: f64,
    /// Whether they hold heat and plastic strain.
    holds_state: bool,
}

impl<'a> Start<'a> {
    fn new(case: &'a Case, b: usize, holds_state: bool) -> Self {
        let body = &case.bodies[b];
        Self {
            case,
            of: body,
            body: u32::try_from(b).unwrap_or(u32::MAX),
            mass: case.particle_mass(body),
            holds_state,
        }
    }

    /// Puts a particle at place `i` of the store, or says what of it is out of range.
    fn put(
        &self,
        particles: &mut ParticleStore,
        i: usize,
        id: u64,
        (position, index): ([f64; 3], u64),
    ) -> Result<(), String> {
        let begins = self.case.beginning_of(self.of, &position.into(), index);
        let velocity = begins.velocity.into();
        particles.id[i] = id;
        particles.body[i] = self.body;
        particles.position[i] = position;
        particles.velocity[i] = velocity;
        particles.predicted_velocity[i] = velocity;
        particles.density[i] = begins.density;
        particles.predicted_density[i] = begins.density;
        particles.smoothing_length[i] = self.of.smoothing_length;
        let held = |value| if self.holds_state { value } else { 0.0 };
        particles.specific_energy[i] = held(begins.specific_energy);
        particles.plastic_strain[i] = held(begins.plastic_strain);
        if begins.fault().is_none() {
            return Ok(());
        }
        let unsound = self.case.unsound(self.of, &position.into());
        Err(unsound.map_or_else(String::new, |(_, why)| why))
    }
}

/// Refuses a case some of whose particles begin out of range, with the words about the first of them;
/// `unsound` is this rank's. Collective.
fn all_sound(comm: &Comm, unsound: Option<(u64, String)>) -> Result<(), SetupError> {
    let mut first = [unsound.as_ref().map_or(u64::MAX, |(id, _)| *id)];
    comm.min_u64(&mut first);
    if first[0] == u64::MAX {
        return Ok(());
    }
    let mine = unsound.filter(|(id, _)| *id == first[0]);
    let mut owner = [mine.as_ref().map_or(u64::MAX, |_| comm.rank() as u64)];
    comm.min_u64(&mut owner);
    let mut words = mine.map_or_else(Vec::new, |(_, why)| why.into_bytes());
    comm.broadcast_from(usize::try_from(owner[0]).unwrap_or(0), &mut words);
    Err(SetupError::Unsound(
        String::from_utf8_lossy(&words).into_owned(),
    ))
}

/// The first id beyond those of a body, as long as ids last.
fn beyond(first_id: u64, sites: u64) -> Result<u64, SetupError> {
    let next = first_id.checked_add(sites).filter(|&id| id < 1 << 62);
    next.ok_or(SetupError::TooManySites)
}

/// Refuses a case without particles, or a rank with more than it can number. Collective.
fn limit_count(comm: &Comm, owned: u64) -> Result<(), SetupError> {
    // Halo particles and images need numbers too.
    let limit = Image::MAX_PARTICLES as u64 / 2;
    let mut most = [owned];
    comm.max_u64(&mut most);
    match most[0] {
        0 => Err(SetupError::Empty),
        count if count > limit => Err(SetupError::TooMany { count, limit }),
        _ => Ok(()),
    }
}
