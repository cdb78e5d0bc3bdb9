//! Constants of a pair of size classes of particles: those that all modes share, and those that each mode has beside
//! them.

use std::cmp::Ordering;
use std::fmt::Debug;

use super::friction::Law;
use model::{Body, Case, ContactLaw, ContactMode, Resistance, contact_modes};
use numerics::kernel::{FixedKernel, Kernel};
use particles::{HaloPhase, Owner};

/// Reference constants of an ordered pair of size classes (receiver, other).
#[derive(Debug, Clone, Copy)]
pub struct Pair {
    /// Mean smoothing length `h_ij` (m).
    pub h: f64,
    /// The kernel of that length.
    pub kernel: FixedKernel,
    /// Mean particle spacing (m).
    pub spacing: f64,
    /// One over it (1/m).
    pub inverse_spacing: f64,
    /// Friction and damping over volume: a spring of `¼ M/Δp²` (Pa/m²), a dashpot of `ζ √(M ρ₀)/Δp`
    /// (Pa s/m²).
    pub friction: Law,
    /// Share of heat that goes to the receiver: ½ of what is alike, else all to the softer one.
    pub heat_share: f64,
}

/// Two size classes of particles whose constants are wanted.
pub(crate) struct Between<'a> {
    pub case: &'a Case,
    pub kernel: &'a Kernel,
    /// Receiver and other, with the spacings of their size classes.
    pub bodies: [&'a Body; 2],
    /// Their places in the case.
    pub indices: [usize; 2],
    /// The smaller p-wave modulus (Pa).
    pub modulus: f64,
    /// That of the case (m/s): what two others drive may press these, however slow they are.
    pub impact_speed: f64,
    pub pair: &'a Pair,
}

/// The constants of a mode, and what it needs.
pub(crate) trait Constants: ContactLaw {
    /// Its constants of an ordered pair of size classes.
    type Pair: Debug + Clone + Default;

    /// Fields that halo particles receive for it before the forces, beside the stresses.
    const HALO: HaloPhase = HaloPhase::empty();

    /// The option of the table of fields that holds fields of this mode alone.
    const OWNER: Owner = Owner::empty();

    /// Its constants of two size classes.
    fn pair(&self, of: &Between) -> Self::Pair;
}

/// Access to the constants of a mode.
pub(crate) trait Listed: Constants {
    fn list(pairs: &ModePairs) -> &[Self::Pair];
}

macro_rules! pairs {
    ($($name:ident: $Mode:ident,)+) => {
        /// Constants of each mode for every ordered pair of size classes; zeros where the mode is
        /// another.
        #[derive(Debug, Clone, Default)]
        pub(crate) struct ModePairs {
            $($name: Vec<<model::$Mode as Constants>::Pair>,)+
        }

        impl ModePairs {
            pub fn push(&mut self, of: &Between, mode: &ContactMode) {
                $(self.$name.push(match mode {
                    ContactMode::$Mode(law) => law.pair(of),
                    _ => Default::default(),
                });)+
            }
        }

        $(
            impl Listed for model::$Mode {
                #[inline(always)]
                fn list(pairs: &ModePairs) -> &[Self::Pair] {
                    &pairs.$name
                }
            }
        )+

        /// Needs of a mode.
        pub(super) fn needs(mode: &ContactMode) -> (HaloPhase, Owner) {
            match mode {
                ContactMode::None | ContactMode::Kernel => (HaloPhase::empty(), Owner::empty()),
                $(ContactMode::$Mode(_) => (
                    <model::$Mode as Constants>::HALO,
                    <model::$Mode as Constants>::OWNER,
                ),)+
            }
        }
    };
}
contact_modes!(pairs);

impl Pair {
    pub(super) fn new(
        case: &Case,
        kernel: &Kernel,
        [a, b]: [&Body; 2],
        mode: &ContactMode,
    ) -> Self {
        let spacing = 0.5 * (a.lattice.spacing + b.lattice.spacing);
        let h = 0.5 * (a.smoothing_length + b.smoothing_length);
        let law = |input: &Resistance| friction(case, [a, b], spacing, input);
        Self {
            h,
            kernel: kernel.of_length(h),
            spacing,
            inverse_spacing: 1.0 / spacing,
            friction: mode.resistance().map_or_else(Law::default, law),
            heat_share: match softness(a).cmp(&softness(b)) {
                Ordering::Equal => 0.5,
                Ordering::Greater => 1.0,
                Ordering::Less => 0.0,
            },
        }
    }
}

/// Order of what takes heat: bodies that deform, rigid ones that forces move, and driven ones.
fn softness(body: &Body) -> u8 {
    u8::from(body.driven().is_none()) + u8::from(body.rigid.is_none())
}

/// Friction and damping of bodies that resist as `input` says. The softer body gives modulus and
/// density.
fn friction(case: &Case, bodies: [&Body; 2], spacing: f64, input: &Resistance) -> Law {
    let facts = bodies.map(|body| {
        let modulus = case.contact_modulus(body);
        (modulus, case.initial_density(body))
    });
    let softer = usize::from(facts[1].0 < facts[0].0);
    let (modulus, density) = facts[softer];
    Law {
        static_friction: input.static_friction,
        kinetic_friction: input.kinetic_friction,
        stiffness: 0.25 * modulus / (spacing * spacing),
        dashpot: input.damping * (modulus * density).sqrt() / spacing,
    }
}
