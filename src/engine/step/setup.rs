//! The first particles of a case.

use super::error::SetupError;
use super::file_values::set_from_file;
use crate::contact::Connectivity;
use crate::domain::{Decomposition, Partition};
use crate::loads::{Absorption, Loads, Prescribe, VelocityStage};
use comm::Comm;
use model::{Body, Case, SphForm, edge};
use particles::{Image, ParticleStore};
use populate::{self, Brick};

/// The particles of a rank's brick as they are created.
struct Filling<'a> {
    case: &'a Case,
    loads: &'a Loads,
    brick: Brick,
    particles: &'a mut ParticleStore,
    /// Place of the next particle in the store.
    next: usize,
    /// First id of the next body.
    first_id: u64,
    /// The first particle that begins out of range, and why.
    unsound: Option<(u64, String)>,
}

/// Creates the particles of this rank's brick in an empty store, and no others. Collective.
///
/// # Errors
/// The same on all ranks if the case has no particles or too many, or one of them begins out of range.
pub(super) fn populate(
    comm: &Comm,
    case: &Case,
    loads: &Loads,
    partition: &mut Partition,
    particles: &mut ParticleStore,
) -> Result<(), SetupError> {
    let brick = partition.slabs().region(comm.rank());
    let stressed = case.sph.form == SphForm::StressPoints;
    let counts = populate::counts(case, Some(brick));
    let points = |body| {
        let (dimension, planes) = (case.dimension, &case.symmetry);
        if stressed {
            populate::stress_count(body, dimension, planes, Some(brick))
        } else {
            0
        }
    };
    let total = counts.iter().sum::<u64>() + case.bodies.iter().map(points).sum::<u64>();
    limit_count(comm, total)?;
    particles.resize_owned(usize::try_from(total).unwrap_or(usize::MAX));
    let mut filling = Filling {
        case,
        loads,
        brick,
        particles: &mut *particles,
        next: 0,
        first_id: 0,
        unsound: None,
    };
    filling.create_particles(&counts, stressed)?;
    if stressed {
        filling.create_stress_points()?;
    }
    debug_assert_eq!(filling.next, filling.particles.owned());
    let unsound = filling.unsound;
    // Some may begin outside of the brick of their rank.
    if case.bodies.iter().any(populate::moves_sites) {
        partition.distribute(comm, particles);
    }
    all_sound(comm, unsound)
}

impl Filling<'_> {
    /// Creates the particles of all bodies.
    fn create_particles(&mut self, counts: &[u64], stressed: bool) -> Result<(), SetupError> {
        let Self {
            case,
            loads,
            particles,
            ..
        } = self;
        populate::for_each_body(case, Some(self.brick), counts, |b, sites| {
            let body = &case.bodies[b];
            // Heat and plastic strain of bodies with stress points are those of the points.
            let start = Start::new(case, b, !stressed);
            for site in sites {
                let (i, id) = (self.next, self.first_id + site.index);
                let stands = case.stands(&site.position, body.lattice.spacing);
                if let Err(why) = start.put(particles, i, id, stands, site.index) {
                    self.unsound.get_or_insert((id, why));
                }
                particles.mass[i] =
                    start.mass_at(particles, i) * site.share * case.around(&site.position);
                particles.smoothing_length[i] *= edge(site.share, case.dimension);
                set_from_file(body, particles, i, site.index);
                Connectivity::begin(particles, i, self.first_id);
                if loads.has_motions() {
                    let bits = loads.bits(case, b, &site.position);
                    let prescribed = loads.of(bits);
                    prescribed.set(VelocityStage::End, &mut particles.velocity[i]);
                    prescribed.set(VelocityStage::End, &mut particles.predicted_velocity[i]);
                    particles.load[i] = bits;
                }
                if loads.absorb() {
                    particles.absorption[i] = Absorption::rate(case, b, &site.position);
                }
                if let Some(pressed) = particles.pressed.get_mut(i) {
                    *pressed = Loads::pressed(case, b, &site.position);
                }
                if let Some(time) = particles.lighting_time.get_mut(i) {
                    *time = case.lighting_time(b, &site.position.into());
                }
                self.next += 1;
            }
            self.first_id = beyond(self.first_id, populate::index_end(body, case.dimension))?;
            Ok(())
        })
    }

    /// Creates the stress points of all bodies.
    fn create_stress_points(&mut self) -> Result<(), SetupError> {
        let Self {
            case,
            loads,
            particles,
            ..
        } = self;
        for (b, body) in case.bodies.iter().enumerate() {
            let start = Start::new(case, b, true);
            let brick = Some(self.brick);
            for site in populate::stress_sites(body, case.dimension, &case.symmetry, brick) {
                let (i, id) = (self.next, self.first_id + site.index);
                if let Err(why) = start.put(particles, i, id, site.position, site.index) {
                    self.unsound.get_or_insert((id, why));
                }
                particles.stress_mass[i] = start.mass_at(particles, i) * site.share;
                if loads.absorb() {
                    particles.absorption[i] = Absorption::rate(case, b, &site.position);
                }
                if let Some(time) = particles.lighting_time.get_mut(i) {
                    *time = case.lighting_time(b, &site.position.into());
                }
                self.next += 1;
            }
            let ids = populate::stress_index_end(body, case.dimension);
            self.first_id = beyond(self.first_id, ids)?;
        }
        Ok(())
    }
}

/// The start of all particles of a body.
struct Start<'a> {
    case: &'a Case,
    body: &'a Body,
    number: u32,
    /// Of a whole particle (kg).
    mass: f64,
    /// True if they hold heat and plastic strain.
    holds_state: bool,
}

impl<'a> Start<'a> {
    fn new(case: &'a Case, b: usize, holds_state: bool) -> Self {
        let body = &case.bodies[b];
        Self {
            case,
            body,
            number: u32::try_from(b).unwrap_or(u32::MAX),
            mass: case.particle_mass(body),
            holds_state,
        }
    }

    /// Mass (kg) of a whole particle at place `i` of the store: under a stress its volume is that of its site.
    fn mass_at(&self, particles: &ParticleStore, i: usize) -> f64 {
        match self.body.initial.loading {
            Some(_) => self.mass * (particles.density[i] / self.case.initial_density(self.body)),
            None => self.mass,
        }
    }

    /// Puts a particle at place `i` of the store, or says in words how it is out of range.
    fn put(
        &self,
        particles: &mut ParticleStore,
        i: usize,
        id: u64,
        position: [f64; 3],
        index: u64,
    ) -> Result<(), String> {
        let begins = self.case.beginning_of(self.body, &position.into(), index);
        let velocity = begins.velocity.into();
        particles.id[i] = id;
        particles.body[i] = self.number;
        particles.position[i] = position;
        particles.velocity[i] = velocity;
        particles.predicted_velocity[i] = velocity;
        particles.density[i] = begins.density;
        particles.predicted_density[i] = begins.density;
        particles.smoothing_length[i] = self.body.smoothing_length;
        let held = |value| if self.holds_state { value } else { 0.0 };
        particles.specific_energy[i] = held(begins.specific_energy);
        particles.plastic_strain[i] = held(begins.plastic_strain);
        particles.deviatoric_stress[i] = begins.deviatoric_stress.map(held);
        if let Some(compaction) = particles.compaction.get_mut(i) {
            *compaction = held(begins.compaction);
        }
        if let Some(fibres) = &self.body.initial.fibres {
            let [fibre, normal] = fibres.at(&position.into());
            particles.fibre[i] = fibre.into();
            particles.normal[i] = normal.into();
        }
        if begins.fault().is_none() {
            return Ok(());
        }
        let unsound = self.case.unsound(self.body, &position.into());
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
pub(super) fn limit_count(comm: &Comm, owned: u64) -> Result<(), SetupError> {
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
