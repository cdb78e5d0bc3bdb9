//! The table of particle fields: each is declared once, here, with its type, unit, meaning and
//! uses. Storage, sort, migration, halo exchange, symmetry planes, checkpoints and snapshots walk
//! this table.

/// What one particle holds in a field; it says what becomes of it behind a symmetry plane.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FieldKind {
    /// One `f64`, the same in a mirror.
    Scalar,
    /// A place, three `f64`: x, y, z. Its image is as far behind the plane.
    Position,
    /// Three `f64`: x, y, z. In a mirror the component normal to the plane changes its sign.
    Vector,
    /// Six `f64`: xx, yy, zz, xy, xz, yz. Components with one index normal to the plane change sign.
    Symmetric,
    /// Nine `f64`, row-major, mirrored like a symmetric one.
    Tensor,
    /// One `u64`, the same in a mirror.
    Id,
    /// One `u32`, the same in a mirror.
    Index,
}

impl FieldKind {
    /// Numbers per particle.
    #[must_use]
    pub const fn components(self) -> usize {
        match self {
            Self::Scalar | Self::Id | Self::Index => 1,
            Self::Position | Self::Vector => 3,
            Self::Symmetric => 6,
            Self::Tensor => 9,
        }
    }

    /// Bytes per particle.
    #[must_use]
    pub const fn bytes(self) -> usize {
        match self {
            Self::Index => 4,
            _ => 8 * self.components(),
        }
    }

    /// Whether the numbers are `f64`.
    #[must_use]
    pub const fn is_real(self) -> bool {
        !matches!(self, Self::Id | Self::Index)
    }
}

/// When a field is carried along: a set of the constants below.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct FieldUse(u32);

impl FieldUse {
    /// Read by a step before it is written: in checkpoints, and moved between ranks.
    pub const STATE: Self = Self(1);
    /// Alive while particles change ranks within a step, though not state.
    pub const MIGRATED: Self = Self(2);
    /// Halo particles need it before the neighbour search and the velocity gradient.
    pub const HALO_MOTION: Self = Self(4);
    /// Halo particles need it before the forces.
    pub const HALO_STRESS: Self = Self(8);
    /// Halo particles need it before the contact forces.
    pub const HALO_CONTACT: Self = Self(16);
    /// In snapshots by default.
    pub const SNAPSHOT: Self = Self(32);
    /// In snapshots on demand.
    pub const ON_DEMAND: Self = Self(64);
    /// Every field.
    pub const ALL: Self = Self(u32::MAX);
    /// Of contact: held only where bodies have contact beyond the SPH sums.
    pub const CONTACT: Self = Self(128);
    /// Held only with the Balsara switch.
    pub const BALSARA: Self = Self(256);
    /// Held only with artificial conduction.
    pub const CONDUCTION: Self = Self(512);
    /// Held only with XSPH.
    pub const XSPH: Self = Self(1024);
    /// Held only where loads or rigid bodies prescribe velocities.
    pub const LOADS: Self = Self(2048);
    /// Held only where bodies in contact have friction or damping.
    pub const FRICTION: Self = Self(4096);
    /// Held only in the normalised form of the sums.
    pub const NORMALISED: Self = Self(16384);
    /// Held only with `penalty` contact.
    pub const PENALTY: Self = Self(32768);
    /// Held only where rigid surfaces have friction or damping.
    pub const SURFACE_FRICTION: Self = Self(1 << 16);
    /// Held only with self-contact.
    pub const SELF_CONTACT: Self = Self(1 << 17);
    /// Held only where folds are in self-contact.
    pub const FOLDS: Self = Self(1 << 18);
    /// Halo particles need it when parts are told.
    pub const HALO_PARTS: Self = Self(1 << 19);
    /// Held only where particles in trouble are frozen.
    pub const FREEZE: Self = Self(1 << 20);
    /// Held only where stress points carry the stress.
    pub const STRESS_POINTS: Self = Self(1 << 21);
    /// Kept of a frozen particle; all else of it is zero.
    pub const REMAINS: Self = Self(1 << 22);
    /// Held only where the case has use for it.
    pub const OPTIONAL: Self = Self::CONTACT
        .with(Self::BALSARA)
        .with(Self::CONDUCTION)
        .with(Self::XSPH)
        .with(Self::LOADS)
        .with(Self::FRICTION)
        .with(Self::NORMALISED)
        .with(Self::PENALTY)
        .with(Self::SURFACE_FRICTION)
        .with(Self::SELF_CONTACT)
        .with(Self::FOLDS)
        .with(Self::FREEZE)
        .with(Self::STRESS_POINTS);
    /// In snapshots at all.
    pub const SNAPSHOT_OR_ON_DEMAND: Self = Self(32 | 64);
    /// What a rank sends with a particle that leaves it.
    pub const LEAVING: Self = Self(1 | 2);
    /// Whatever halo particles need before forces of stress and contact.
    pub const HALO_FORCES: Self = Self(8 | 16);
    /// Whatever a halo particle has at any time.
    pub const ANY_HALO: Self = Self(4 | 8 | 16 | 8192);
    /// Halo particles need it before the contact forces, if these have friction.
    pub const HALO_FRICTION: Self = Self(8192);

    /// Whether this set and `other` have a use in common.
    #[must_use]
    pub const fn meets(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }

    /// This set and `other` together.
    #[must_use]
    pub const fn with(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// This set without `other`.
    #[must_use]
    pub const fn without(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }
}

/// One row of the table.
#[derive(Debug, Clone, Copy)]
pub struct FieldInfo {
    /// Which field.
    pub id: FieldId,
    /// Its name in the store, in files and on the command line.
    pub name: &'static str,
    /// Type.
    pub kind: FieldKind,
    /// SI unit; empty for none.
    pub unit: &'static str,
    /// One sentence for users.
    pub description: &'static str,
    /// When it is carried along.
    pub uses: FieldUse,
}

macro_rules! kind_type {
    (Scalar) => {
        f64
    };
    (Position) => {
        [f64; 3]
    };
    (Vector) => {
        [f64; 3]
    };
    (Symmetric) => {
        [f64; 6]
    };
    (Tensor) => {
        [f64; 9]
    };
    (Id) => {
        u64
    };
    (Index) => {
        u32
    };
}

macro_rules! particle_fields {
    ($( $(#[doc = $doc:literal])+ $name:ident: $kind:ident, $unit:literal, $($flag:ident)|*; )+) => {
        /// Names a field of the table.
        #[allow(non_camel_case_types, reason = "variants carry the field's own name")]
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum FieldId { $( $(#[doc = $doc])+ $name, )+ }

        /// The table.
        pub const FIELDS: &[FieldInfo] = &[ $( FieldInfo {
            id: FieldId::$name,
            name: stringify!($name),
            kind: FieldKind::$kind,
            unit: $unit,
            description: concat!($($doc),+).trim_ascii(),
            uses: FieldUse(0)$(.with(FieldUse::$flag))*,
        }, )+ ];

        /// The particles of one rank: owned ones first, then halo copies of other ranks'
        /// particles (only in fields that halo particles need).
        #[derive(Debug, Clone, Default)]
        pub struct ParticleStore {
            pub(super) owned: usize,
            pub(super) halo: usize,
            pub(super) dropped: FieldUse,
            $( $(#[doc = $doc])+ pub $name: Vec<kind_type!($kind)>, )+
        }

        impl ParticleStore {
            /// A field's values as bytes: owned particles, then (where halo particles have it)
            /// halo particles. Empty for a field that is not held.
            #[must_use]
            pub fn bytes(&self, field: FieldId) -> &[u8] {
                match field { $( FieldId::$name => bytemuck::cast_slice(&self.$name), )+ }
            }

            /// Mutable form of [`Self::bytes`].
            pub fn bytes_mut(&mut self, field: FieldId) -> &mut [u8] {
                match field { $( FieldId::$name => bytemuck::cast_slice_mut(&mut self.$name), )+ }
            }

            pub(super) fn resize_field(&mut self, field: FieldId, length: usize) {
                match field { $( FieldId::$name => {
                    super::store::resize(&mut self.$name, length);
                } )+ }
            }

            pub(super) fn free_field(&mut self, field: FieldId) {
                match field { $( FieldId::$name => self.$name = Vec::new(), )+ }
            }

            pub(super) fn gather_field(&mut self, field: FieldId, order: &[u32], scratch: &mut [u64]) {
                match field { $( FieldId::$name => super::store::gather(&mut self.$name, order, scratch), )+ }
            }

            pub(super) fn capacity_bytes(&self) -> usize {
                0 $( + self.$name.capacity() * FieldKind::$kind.bytes() )+
            }
        }
    };
}

particle_fields! {
    /// Identity: body index and lattice site; the same for any ranks.
    id: Id, "", STATE | HALO_MOTION | SNAPSHOT | REMAINS;
    /// Index of the body in the input.
    body: Index, "", STATE | HALO_MOTION | SNAPSHOT | REMAINS;
    /// Mass.
    mass: Scalar, "kg", STATE | HALO_MOTION | ON_DEMAND | REMAINS;
    /// Position.
    position: Position, "m", STATE | HALO_MOTION | REMAINS;
    /// Velocity.
    velocity: Vector, "m/s", STATE | SNAPSHOT;
    /// Density.
    density: Scalar, "kg/m^3", STATE | HALO_STRESS | SNAPSHOT | REMAINS;
    /// Specific internal energy.
    specific_energy: Scalar, "J/kg", STATE | SNAPSHOT | REMAINS;
    /// Deviatoric stress, tension positive.
    deviatoric_stress: Symmetric, "Pa", STATE | HALO_STRESS | SNAPSHOT;
    /// Equivalent plastic strain.
    plastic_strain: Scalar, "", STATE | SNAPSHOT | REMAINS;
    /// Velocity gradient, row i column j is the derivative of velocity i along j.
    velocity_gradient: Tensor, "1/s", STATE | ON_DEMAND;
    /// Acceleration by stress and viscosity.
    acceleration: Vector, "m/s^2", STATE | ON_DEMAND;
    /// Acceleration by contact.
    contact_acceleration: Vector, "m/s^2", STATE | ON_DEMAND | CONTACT;
    /// Rate of specific internal energy at the particle's velocity.
    d_specific_energy_dt: Scalar, "W/kg", STATE | ON_DEMAND;
    /// Foreign volume fraction above the touching value at the start, which contact forgives.
    touch_relief: Scalar, "", STATE | ON_DEMAND | CONTACT;
    /// How long the foreign fraction with current volumes has stayed above one half.
    enclosed_time: Scalar, "s", STATE | ON_DEMAND | CONTACT;
    /// Elastic tangential displacement against the other bodies, by which friction holds.
    slip: Vector, "m", STATE | ON_DEMAND | FRICTION;
    /// Tangential velocity against the other bodies.
    slip_rate: Vector, "m/s", STATE | ON_DEMAND | FRICTION;
    /// Whether friction is kinetic (1) or static (0).
    sliding: Index, "", STATE | ON_DEMAND | FRICTION;
    /// Elastic tangential displacement against rigid surfaces, by which their friction holds.
    surface_slip: Vector, "m", STATE | ON_DEMAND | SURFACE_FRICTION;
    /// Tangential velocity against rigid surfaces.
    surface_slip_rate: Vector, "m/s", STATE | ON_DEMAND | SURFACE_FRICTION;
    /// Whether friction of rigid surfaces is kinetic (1) or static (0).
    surface_sliding: Index, "", STATE | ON_DEMAND | SURFACE_FRICTION;
    /// Smallest id among the particles that it is connected with.
    part: Id, "", STATE | HALO_MOTION | HALO_PARTS | SNAPSHOT | SELF_CONTACT;
    /// Symmetry planes that the part reaches across: a set of bits.
    part_planes: Index, "", STATE | HALO_MOTION | HALO_PARTS | SELF_CONTACT;
    /// Position at the start.
    reference_position: Position, "m", STATE | HALO_MOTION | FOLDS;
    /// Which loads and rigid bodies prescribe its velocity: a set of bits, in the input's order.
    load: Index, "", STATE | ON_DEMAND | LOADS;
    /// Whether it left the range of its state and stands still, outside of all sums (1).
    frozen: Index, "", STATE | ON_DEMAND | FREEZE;
    /// Mass of the material whose stress a stress point carries; zero for velocity particles.
    stress_mass: Scalar, "kg", STATE | HALO_MOTION | ON_DEMAND | STRESS_POINTS;
    /// Acceleration of a stress point, which follows the velocity particles about it.
    drift_acceleration: Vector, "m/s^2", STATE | ON_DEMAND | STRESS_POINTS;
    /// Stress of a stress point, that of viscosity included, over its density.
    specific_stress: Symmetric, "J/kg", STATE | ON_DEMAND | STRESS_POINTS;
    /// Velocity at the end of the step as predicted from the last accelerations.
    predicted_velocity: Vector, "m/s", MIGRATED | HALO_MOTION;
    /// Density at the end of the step as predicted from the last velocity gradient.
    predicted_density: Scalar, "kg/m^3", MIGRATED | HALO_MOTION;
    /// Smoothing length of the SPH sums.
    smoothing_length: Scalar, "m", MIGRATED | HALO_MOTION | SNAPSHOT;
    /// Pressure, compression positive.
    pressure: Scalar, "Pa", HALO_STRESS | SNAPSHOT;
    /// Longitudinal sound speed.
    sound_speed: Scalar, "m/s", HALO_STRESS | ON_DEMAND;
    /// Volume fraction of foreign bodies in the contact support.
    foreign_fraction: Scalar, "", HALO_CONTACT | SNAPSHOT | CONTACT;
    /// Foreign fraction above the touching value.
    contact_excess: Scalar, "", HALO_CONTACT | ON_DEMAND | CONTACT;
    /// Fraction-weighted contact modulus.
    contact_modulus: Scalar, "Pa", HALO_CONTACT | CONTACT;
    /// Fraction-weighted touching value.
    touching_value: Scalar, "", HALO_CONTACT | CONTACT;
    /// Sum of kernel gradients over foreign volume where there is excess, for the time step.
    contact_slope: Scalar, "1/m", HALO_CONTACT | CONTACT;
    /// Normal of contact as the particle sees it, times the square of the foreign fraction.
    contact_normal: Vector, "", HALO_CONTACT | FRICTION;
    /// Friction and damping of the particle against what it lies on.
    friction_force: Vector, "N", HALO_FRICTION | FRICTION;
    /// Sum of its shares of the pair forces that they rest on.
    friction_load: Scalar, "N", HALO_FRICTION | FRICTION;
    /// What they turn into heat.
    friction_power: Scalar, "W", HALO_FRICTION | FRICTION;
    /// Energy of sticking friction.
    friction_energy: Scalar, "J", FRICTION;
    /// Outward normal of a boundary particle, shorter at corners, zero inside: of `penalty` contact.
    boundary_normal: Vector, "", HALO_CONTACT | ON_DEMAND | PENALTY;
    /// Contact energy.
    contact_energy: Scalar, "J", ON_DEMAND | CONTACT;
    /// Largest approach speed towards a neighbour, for the time step.
    approach_speed: Scalar, "m/s", ON_DEMAND;
    /// Stiffness of contact, for the time step.
    contact_stiffness: Scalar, "N/m", ON_DEMAND | CONTACT;
    /// Factor of the Balsara switch on artificial viscosity.
    viscosity_limiter: Scalar, "", HALO_STRESS | ON_DEMAND | BALSARA;
    /// Specific internal energy at the end of the step as predicted from its last rate.
    predicted_energy: Scalar, "J/kg", HALO_STRESS | CONDUCTION;
    /// What XSPH adds to the velocity when it moves the particle.
    velocity_correction: Vector, "m/s", STATE | ON_DEMAND | XSPH;
    /// Matrix of the correction that makes gradients of linear fields exact, row-major.
    gradient_correction: Tensor, "", HALO_STRESS | ON_DEMAND | NORMALISED;
    /// Gradient of the kernel sum over the kernel sum; it points into the body.
    gradient_shift: Vector, "1/m", HALO_STRESS | ON_DEMAND | NORMALISED;
    /// How much the correction enlarges gradients; 0 where it is ill-conditioned and left out.
    correction_norm: Scalar, "", ON_DEMAND | NORMALISED;
    /// Velocity gradient at a stress point at the predicted velocities.
    predicted_gradient: Tensor, "1/s", STRESS_POINTS;
    /// How steep the gradients at a stress point are: 1.4 in a cubic lattice at h = 1.3 Δp.
    fit_norm: Scalar, "", ON_DEMAND | STRESS_POINTS;
    /// What a stress point takes over of the energy of velocity particles, over the sum of weights.
    stress_heat: Scalar, "J", HALO_STRESS | STRESS_POINTS;
    /// Force of a stress point on velocity particles by their distance from their weighted mean,
    /// row-major.
    stress_moment: Tensor, "N/m", HALO_STRESS | STRESS_POINTS;
    /// Its product with the distance of that mean from the stress point.
    stress_offset: Vector, "N", HALO_STRESS | STRESS_POINTS;
    /// Work of the last step, in neighbours of the pair sums, for the balance between ranks.
    work: Index, "", MIGRATED;
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(which: impl Fn(&FieldInfo) -> bool) -> Vec<&'static str> {
        let rows = FIELDS.iter().filter(|field| which(field));
        rows.map(|field| field.name).collect()
    }

    /// A place is no vector: one that is declared as such would be mirrored about the origin.
    #[test]
    fn places_are_declared_as_such() {
        let places = names(|field| field.name.contains("position"));
        assert_eq!(places, names(|field| field.kind == FieldKind::Position));
        assert_eq!(places, ["position", "reference_position"]);
    }

    /// What stays of a frozen particle is held in every case that may freeze one.
    #[test]
    fn remains_are_in_every_store() {
        let remains = names(|field| field.uses.meets(FieldUse::REMAINS));
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
        let optional = names(|field| field.uses.meets(FieldUse::OPTIONAL));
        assert!(remains.iter().all(|name| !optional.contains(name)));
    }
}
