//! The table of particle fields: each is declared once, here, with its type, unit, meaning and all
//! that becomes of it, one column for each question ([`super::columns`]). Storage, sort, migration,
//! halo exchange, symmetry planes, freezing, checkpoints and snapshots walk this table.

use super::arrays::FieldArray;
use super::columns::{FieldKind, HaloPhase, Life, Mirror, Output, Owner};

/// One row of the table.
#[derive(Debug, Clone, Copy)]
pub struct FieldInfo {
    /// The field.
    pub id: FieldId,
    /// Its name in the store, in files and on the command line.
    pub name: &'static str,
    /// Type.
    pub kind: FieldKind,
    /// Rule for it behind a symmetry plane.
    pub mirror: Mirror,
    /// SI unit; empty for none.
    pub unit: &'static str,
    /// One sentence for users.
    pub description: &'static str,
    /// From when to when its values live.
    pub life: Life,
    /// When halo particles get it.
    pub halo: HaloPhase,
    /// Its use in snapshots.
    pub output: Output,
    /// Options that have use for it; empty for a field of every case.
    pub owner: Owner,
    /// True if a frozen particle keeps it; all else of that is zero.
    pub kept: bool,
}

impl FieldInfo {
    /// True if a particle takes it along to another rank.
    #[must_use]
    pub const fn leaves(&self) -> bool {
        !matches!(self.life, Life::Scratch)
    }

    /// True if a frozen particle keeps it.
    #[must_use]
    pub const fn is_kept(&self) -> bool {
        self.kept
    }

    /// True if it is in snapshots, by default or on demand.
    #[must_use]
    pub const fn is_shown(&self) -> bool {
        !matches!(self.output, Output::Never)
    }

    /// True if only some cases have use for it.
    #[must_use]
    pub const fn is_optional(&self) -> bool {
        !self.owner.is_empty()
    }

    /// True if a case without the options `unused` has use for it.
    #[must_use]
    pub const fn is_held_without(&self, unused: Owner) -> bool {
        self.owner.is_empty() || !unused.contains(self.owner)
    }

    /// Every field.
    #[must_use]
    pub const fn any(&self) -> bool {
        true
    }

    /// Refuses, as the table is compiled, columns that contradict each other.
    const fn check(&self) {
        assert!(
            self.mirror as u8 == self.kind.mirror() as u8
                || matches!(self.mirror, Mirror::Same)
                || matches!((self.mirror, self.kind), (Mirror::Place, FieldKind::Vector)),
            "a mirror rule of another kind"
        );
        assert!(
            !self.kept || matches!(self.life, Life::State) && self.owner.is_empty(),
            "what a frozen particle keeps is state in every case"
        );
        assert!(
            !self.halo.intersects(HaloPhase::CONTACT)
                || Owner::CONTACT
                    .union(Owner::FRICTION)
                    .union(Owner::PENALTY)
                    .union(Owner::GAS_CONTACT)
                    .union(Owner::JOINTS)
                    .contains(self.owner)
                    && !self.owner.is_empty(),
            "the contact message is sent only where there is contact"
        );
        assert!(
            !self.halo.intersects(HaloPhase::FRICTION)
                || self.owner.bits() == Owner::FRICTION.bits(),
            "the message of friction is sent only where there is friction"
        );
    }
}

// A row: name: kind, unit, life, halo, output, owner; then `kept` if a frozen particle keeps it.
// `as` states a mirror rule other than the kind's. Rows stand in files in this order.
particle_fields! {
    /// Identity: body index and lattice site; the same for any ranks.
    id: Id,                               "",       State,    MOTION,         Default,  -, kept;
    /// Index of the body in the input.
    body: Index,                          "",       State,    MOTION,         Default,  -, kept;
    /// Mass.
    mass: Scalar,                         "kg",     State,    MOTION,         Default,  -, kept;
    /// Position.
    position: Vector as Place,            "m",      State,    MOTION,         Never,    -, kept;
    /// Velocity.
    velocity: Vector,                     "m/s",    State,    -,              Default,  -;
    /// Density.
    density: Scalar,                      "kg/m^3", State,    STATE,          Default,  -, kept;
    /// Specific internal energy.
    specific_energy: Scalar,              "J/kg",   State,    -,              Default,  -, kept;
    /// Deviatoric stress, tension positive.
    deviatoric_stress: Symmetric,         "Pa",     State,    STATE,          Default,  -;
    /// Equivalent plastic strain.
    plastic_strain: Scalar,               "",       State,    STRAIN,         Default,  -, kept;
    /// Damage: below one intact, one failed.
    damage: Scalar,                       "",       State,    STRAIN,         IfHeld,   FAILURE;
    /// Elastic energy that tension and shear held when the matter failed.
    failure_energy: Scalar,               "J/kg",   State,    -,              OnDemand, FAILURE;
    /// How far matter that softens before it fails is on its way to the onset of that.
    failure_onset: Scalar,                "",       State,    -,              OnDemand, SOFTENING;
    /// Flaws that have become active.
    flaws: Scalar,                        "",       State,    -,              OnDemand, FLAWS;
    /// Strain at which the weakest flaw becomes active; zero if none has been drawn.
    first_flaw: Scalar,                   "",       State,    -,              Never,    FLAWS;
    /// Strain at which the next flaw becomes active; zero if none has been drawn.
    next_flaw: Scalar,                    "",       State,    -,              Never,    FLAWS;
    /// How far pores have been crushed, along the crush curve; one without pores.
    compaction: Scalar,                   "",       State,    -,              IfHeld,   POROUS;
    /// Distension: density of the matter between pores over the density; zero for materials without porosity.
    distension: Scalar,                   "",       State,    -,              OnDemand, POROUS;
    /// Share of an explosive that has burnt.
    burn: Scalar,                         "",       State,    -,              IfHeld,   EXPLOSIVE;
    /// Time until a detonation lights it, negative since; zero for what is no explosive.
    lighting_time: Scalar,                "s",      State,    -,              OnDemand, EXPLOSIVE;
    /// Pressure by bulking of what is broken.
    bulking_pressure: Scalar,             "Pa",     State,    -,              OnDemand, BULKING;
    /// Direction 1 of matter with directions of its own, along its fibres; zero in other matter.
    fibre: Vector,                        "",       State,    -,              IfHeld,   DIRECTIONS;
    /// Direction 3 of matter with directions of its own, across its layers; zero in other matter.
    normal: Vector,                       "",       State,    -,              OnDemand, DIRECTIONS;
    /// Elastic strain of such matter.
    elastic_strain: Symmetric,            "",       State,    -,              OnDemand, DIRECTIONS;
    /// Strain of open cracks across direction 1 of such matter.
    opening_1: Scalar,                    "",       State,    -,              OnDemand, CRACKS;
    /// Strain of open cracks across its direction 2.
    opening_2: Scalar,                    "",       State,    -,              OnDemand, CRACKS;
    /// Strain of open cracks across its direction 3.
    opening_3: Scalar,                    "",       State,    -,              OnDemand, CRACKS;
    /// Damage of fibres, by cracks across direction 1; of yarns or walls along it the share that is torn.
    fibre_damage: Scalar,                 "",       State,    -,              IfHeld,   CRACKS;
    /// Damage of the matrix, by cracks across direction 2; of yarns or walls along it the share that is torn.
    matrix_damage: Scalar,                "",       State,    -,              IfHeld,   CRACKS;
    /// Damage between layers, by cracks across direction 3; of yarns or walls along it the share that is torn.
    delamination: Scalar,                 "",       State,    -,              IfHeld,   CRACKS;
    /// Plastic work on the matter so far.
    plastic_energy: Scalar,               "J/kg",   State,    -,              OnDemand, YIELD;
    /// Largest pressure so far, compression positive; zero under tension alone.
    peak_pressure: Scalar,                "Pa",     State,    -,              OnDemand, PEAK_PRESSURE;
    /// When the largest pressure so far was reached; zero if there was none.
    peak_pressure_time: Scalar,           "s",      State,    -,              OnDemand, PEAK_PRESSURE;
    /// Largest mean tension so far, the opposite of the pressure.
    peak_tension: Scalar,                 "Pa",     State,    -,              OnDemand, PEAK_TENSION;
    /// Highest temperature so far; zero for materials without thermal constants.
    peak_temperature: Scalar,             "K",      State,    -,              OnDemand, PEAK_TEMPERATURE;
    /// Largest equivalent strain rate so far, of the deviatoric rate of deformation.
    peak_strain_rate: Scalar,             "1/s",    State,    -,              OnDemand, PEAK_STRAIN_RATE;
    /// When pressure first passed the threshold of arrival; zero before.
    arrival_time: Scalar,                 "s",      State,    -,              OnDemand, ARRIVAL;
    /// True if it carries a gauge (bit 0), and the moving regions that it began in (from bit 1 on).
    measure_marks: Index,                 "",       State,    -,              Never,    CARRIERS;
    /// Witness planes that it is beyond: a set of bits, in the input's order.
    witness_sides: Index,                 "",       State,    -,              Never,    WITNESSES;
    /// Velocity gradient, row i column j is the derivative of velocity i along j.
    velocity_gradient: Tensor,            "1/s",    State,    -,              OnDemand, -;
    /// Acceleration by stress and viscosity.
    acceleration: Vector,                 "m/s^2",  State,    -,              OnDemand, -;
    /// Acceleration by contact.
    contact_acceleration: Vector,         "m/s^2",  State,    -,              OnDemand, CONTACT;
    /// Acceleration by self-gravity.
    gravity_acceleration: Vector,         "m/s^2",  State,    -,              OnDemand, SELF_GRAVITY;
    /// Rate of specific internal energy at the particle's velocity.
    d_specific_energy_dt: Scalar,         "W/kg",   State,    -,              OnDemand, -;
    /// Foreign volume fraction above the touching value at the start, which contact forgives.
    touch_relief: Scalar,                 "",       State,    -,              OnDemand, CONTACT;
    /// How long the foreign fraction with current volumes has stayed above one half.
    enclosed_time: Scalar,                "s",      State,    -,              OnDemand, CONTACT;
    /// Share of the joint to other bodies that has come apart.
    joint_damage: Scalar,                 "",       State,    CONTACT,        IfHeld,   JOINTS;
    /// How far pressure moves the particle against what it is joined to, which its bonds do not feel.
    joint_pressed: Vector,                "m",      State,    CONTACT,        Never,    JOINTS;
    /// Elastic tangential displacement against the other bodies, by which friction holds.
    slip: Vector,                         "m",      State,    -,              OnDemand, FRICTION;
    /// Tangential velocity against the other bodies.
    slip_rate: Vector,                    "m/s",    State,    -,              OnDemand, FRICTION;
    /// State of friction: kinetic (1) or static (0).
    sliding: Index,                       "",       State,    -,              OnDemand, FRICTION;
    /// Elastic tangential displacement against rigid surfaces, by which their friction holds.
    surface_slip: Vector,                 "m",      State,    -,              OnDemand, SURFACE_FRICTION;
    /// Tangential velocity against rigid surfaces.
    surface_slip_rate: Vector,            "m/s",    State,    -,              OnDemand, SURFACE_FRICTION;
    /// State of friction of rigid surfaces: kinetic (1) or static (0).
    surface_sliding: Index,               "",       State,    -,              OnDemand, SURFACE_FRICTION;
    /// Smallest id among the particles that it is connected with.
    part: Id,                             "",       State,    MOTION,            Default,  SELF_CONTACT;
    /// Symmetry planes that the part reaches across: a set of bits.
    part_planes: Index,                   "",       State,    MOTION,            Never,    SELF_CONTACT;
    /// Position at the start.
    reference_position: Vector as Place,  "m",      State,    MOTION,         Never,    FOLDS | TOTAL | FREE_RIGID | JOINTS;
    /// Which loads and rigid bodies move it: a set of bits, in the input's order.
    load: Index,                          "",       State,    -,              OnDemand, LOADS;
    /// Rate at which an absorbing zone slows it down and relaxes its stress; zero outside of zones.
    absorption: Scalar,                   "1/s",    State,    -,              OnDemand, ABSORBERS;
    /// Which pressures act on its faces: a set of bits, in the input's order.
    pressed: Index,                       "",       State,    -,              OnDemand, PRESSURES;
    /// Acceleration by a unit of pressure on its free faces: it points into the body, and is next to nothing inside.
    face: Vector,                         "m^2/kg", State,    -,              OnDemand, PRESSURES;
    /// Matrix by which the stress of a pressure of one would act on its neighbours.
    face_correction: Symmetric,           "",       Scratch,  STRESS,         Never,    PRESSURES;
    /// True if it left the range of its state and stands still, outside of all sums (1).
    frozen: Index,                        "",       State,    -,              OnDemand, FREEZE;
    /// Mass of the material whose stress a stress point carries; zero for velocity particles.
    stress_mass: Scalar,                  "kg",     State,    MOTION,         OnDemand, STRESS_POINTS;
    /// Acceleration of a stress point, which follows the velocity particles about it.
    drift_acceleration: Vector,           "m/s^2",  State,    -,              OnDemand, STRESS_POINTS;
    /// Stress of a stress point, that of viscosity included, over its density.
    specific_stress: Symmetric,           "J/kg",   State,    -,              OnDemand, STRESS_POINTS;
    /// Velocity at the end of the step as predicted from the last accelerations.
    predicted_velocity: Vector,           "m/s",    Migrated, MOTION,         Never,    -;
    /// Density at the end of the step as predicted from the last velocity gradient.
    predicted_density: Scalar,            "kg/m^3", Migrated, MOTION,         Never,    -;
    /// Smoothing length of the SPH sums.
    smoothing_length: Scalar,             "m",      Migrated, MOTION,         Default,  -;
    /// Pressure, compression positive.
    pressure: Scalar,                     "Pa",     Scratch,  STATE,          Default,  -;
    /// Longitudinal sound speed.
    sound_speed: Scalar,                  "m/s",    Scratch,  -,              OnDemand, -;
    /// Speed of the linear artificial viscosity: that of sound, none where failed matter bears no pressure.
    viscous_speed: Scalar,                "m/s",    Scratch,  STRESS,         Never,    CONVENTIONAL | NORMALISED;
    /// Potential of self-gravity.
    gravity_potential: Scalar,            "J/kg",   Scratch,  -,              OnDemand, SELF_GRAVITY;
    /// Volume fraction of foreign bodies in the contact support.
    foreign_fraction: Scalar,             "",       Scratch,  CONTACT,        Default,  CONTACT;
    /// Foreign fraction above the touching value.
    contact_excess: Scalar,               "",       Scratch,  CONTACT,        OnDemand, CONTACT;
    /// Fraction-weighted contact modulus.
    contact_modulus: Scalar,              "Pa",     Scratch,  CONTACT,        Never,    CONTACT;
    /// Fraction-weighted touching value.
    touching_value: Scalar,               "",       Scratch,  CONTACT,        Never,    CONTACT;
    /// Sum of kernel gradients over foreign volume where there is excess, for the time step.
    contact_slope: Scalar,                "1/m",    Scratch,  CONTACT,        Never,    CONTACT;
    /// How much matter of its own body a particle in contact lacks: 1 alone, 0 with a corner's or more.
    isolation: Scalar,                    "",       Scratch,  CONTACT,        OnDemand, CONTACT;
    /// Normal of contact as the particle sees it, times the square of the foreign fraction.
    contact_normal: Vector,               "",       Scratch,  CONTACT,        Never,    FRICTION;
    /// Friction and damping of the particle against what it lies on.
    friction_force: Vector,               "N",      Scratch,  FRICTION,       Never,    FRICTION;
    /// Sum of its shares of the pair forces that they rest on.
    friction_load: Scalar,                "N",      Scratch,  FRICTION,       Never,    FRICTION;
    /// What they turn into heat.
    friction_power: Scalar,               "W",      Scratch,  FRICTION,       Never,    FRICTION;
    /// Energy of sticking friction.
    friction_energy: Scalar,              "J",      Scratch,  -,              Never,    FRICTION;
    /// Outward normal of a boundary particle, shorter at corners, zero inside: of `penalty`
    /// contact.
    boundary_normal: Vector,              "",       Scratch,  CONTACT,        OnDemand, PENALTY;
    /// Factor of the stiffness of contact, which follows the pressure of a gas; one of other matter.
    contact_stiffening: Scalar,           "",       Scratch,  CONTACT,        OnDemand, GAS_CONTACT;
    /// Share of the joint that came apart in the last step.
    joint_growth: Scalar,                 "",       Scratch,  CONTACT,        Never,    JOINTS;
    /// How much `joint_pressed` has changed in the last step.
    joint_pressing: Vector,               "m",      Scratch,  CONTACT,        Never,    JOINTS;
    /// Contact energy.
    contact_energy: Scalar,               "J",      Scratch,  -,              OnDemand, CONTACT;
    /// Mean plastic strain of the neighbours without its linear part, for materials that soften where it localises.
    neighbour_strain: Scalar,             "",       Scratch,  -,              OnDemand, LOCALISED;
    /// Largest approach speed towards a neighbour, for the time step.
    approach_speed: Scalar,               "m/s",    Scratch,  -,              OnDemand, -;
    /// Stiffness of contact, for the time step.
    contact_stiffness: Scalar,            "N/m",    Scratch,  -,              OnDemand, CONTACT;
    /// Stress that contact forces carry, tension positive: matter bears it beside its own.
    contact_stress: Symmetric,            "Pa",     Scratch,  SHOWN,           IfHeld,   CONTACT;
    /// Factor of the Balsara switch on artificial viscosity.
    viscosity_limiter: Scalar,            "",       Scratch,  STRESS,         OnDemand, BALSARA;
    /// Specific internal energy at the end of the step as predicted from its last rate.
    predicted_energy: Scalar,             "J/kg",   Scratch,  STRESS,         Never,    CONDUCTION;
    /// What XSPH adds to the velocity when it moves the particle.
    velocity_correction: Vector,          "m/s",    State,    -,              OnDemand, XSPH;
    /// Matrix of the correction that makes gradients of linear fields exact, row-major.
    gradient_correction: Tensor,          "",       Scratch,  STRESS,         OnDemand, NORMALISED;
    /// Gradient of the kernel sum over the kernel sum; it points into the body.
    gradient_shift: Vector,               "1/m",    Scratch,  STRESS,         OnDemand, NORMALISED;
    /// Elastic displacement of a particle against its neighbours that no linear field explains.
    hourglass_displacement: Vector,       "m",      State,    -,              OnDemand, CORRECTED;
    /// How much the correction enlarges gradients; 0 where it is ill-conditioned and left out.
    correction_norm: Scalar,              "",       Scratch,  -,              OnDemand, NORMALISED | TOTAL;
    /// Deformation gradient of a body that has the total form, row i column j is the derivative of position i along j at the
    /// start; zero in other bodies.
    deformation_gradient: Tensor,         "",       Scratch,  STRESS,         IfHeld,   TOTAL;
    /// Modulus of the hourglass control of the total form.
    hourglass_modulus: Scalar,            "Pa",     Scratch,  STRESS,         OnDemand, TOTAL;
    /// Velocity gradient at a stress point at the predicted velocities.
    predicted_gradient: Tensor,           "1/s",    Scratch,  -,              Never,    STRESS_POINTS;
    /// How steep the gradients at a stress point are: 1.4 in a cubic lattice at h = 1.3 Δp.
    fit_norm: Scalar,                     "",       Scratch,  -,              OnDemand, STRESS_POINTS;
    /// What a stress point takes over of the energy of velocity particles, over the sum of weights.
    stress_heat: Scalar,                  "J",      Scratch,  STRESS,         Never,    STRESS_POINTS;
    /// Force of a stress point on velocity particles by their distance from their weighted mean,
    /// row-major.
    stress_moment: Tensor,                "N/m",    Scratch,  STRESS,         Never,    STRESS_POINTS;
    /// Its product with the distance of that mean from the stress point.
    stress_offset: Vector,                "N",      Scratch,  STRESS,         Never,    STRESS_POINTS;
    /// Work of the last step, in neighbours of the pair sums, for the balance between ranks.
    work: Index,                          "",       Migrated, -,              Never,    -;
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(which: impl Fn(&FieldInfo) -> bool) -> Vec<&'static str> {
        let rows = FIELDS.iter().filter(|field| which(field));
        rows.map(|field| field.name).collect()
    }

    /// A place is mirrored as such: as any vector, it would be mirrored about the origin.
    #[test]
    fn places_are_declared_as_such() {
        let places = names(|field| field.name.contains("position"));
        assert_eq!(places, names(|field| field.mirror == Mirror::Place));
        assert_eq!(places, ["position", "reference_position"]);
    }

    /// Remains of a frozen particle are held in every case that may freeze one.
    #[test]
    fn remains_are_in_every_store() {
        let remains = names(|field| field.kept);
        assert_eq!(
            remains,
            [
                "id",
                "body",
                "mass",
                "position",
                "density",
                "specific_energy",
                "plastic_strain"
            ]
        );
        let optional = names(FieldInfo::is_optional);
        assert!(remains.iter().all(|name| !optional.contains(name)));
    }
}
