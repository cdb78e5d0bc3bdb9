//! Contact between pairs of bodies, as chosen by the user.

/// The contact of one pair of bodies.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactPair {
    /// Two indices into [`super::Case::bodies`].
    pub bodies: [usize; 2],
    /// What happens where they meet.
    pub mode: ContactMode,
}

/// What two bodies do to each other.
#[derive(Debug, Clone, PartialEq)]
pub enum ContactMode {
    /// The bodies do not see each other.
    None,
    /// Particles of the other body enter the SPH sums: both act as one continuum.
    Kernel,
    /// Contact potential of Vignjevic, De Vuyst & Campbell (2006), eqs. 20–24.
    Potential(Potential),
    /// Overlap energy of the foreign volume fraction above the touching value.
    Overlap(Overlap),
    /// Penalty between boundary particles (Campbell, Vignjevic & Libersky 2000).
    Penalty(Penalty),
}

impl ContactMode {
    /// The name used in inputs.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Kernel => "kernel",
            Self::Potential(_) => "potential",
            Self::Overlap(_) => "overlap",
            Self::Penalty(_) => "penalty",
        }
    }
}

/// Where the contact potential acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PotentialRange {
    /// Everywhere in the kernel's support, 2h.
    Support,
    /// Closer than the mean particle spacing.
    Spacing,
}

/// Along what contact forces act.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ContactDirection {
    /// The line between two particles, as the gradient of an energy.
    Pair,
    /// The mean normal of both surfaces, in the normalised form of the SPH sums.
    Normal,
}

/// Parameters of [`ContactMode::Potential`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Potential {
    /// Dimensionless stiffness k: K = k M/Δp^d with the smaller p-wave modulus M of the two
    /// bodies and their mean spacing.
    pub stiffness: f64,
    /// Exponent n ≥ 1 of the kernel ratio.
    pub exponent: u32,
    /// Range of the force.
    pub range: PotentialRange,
    /// Along what it acts.
    pub direction: ContactDirection,
}

impl Default for Potential {
    fn default() -> Self {
        Self {
            stiffness: 1.0,
            exponent: 4,
            range: PotentialRange::Support,
            direction: ContactDirection::Pair,
        }
    }
}

/// Contact of a body with itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SelfContact {
    /// Its law.
    pub overlap: Overlap,
    /// Particles of one part are strangers if they began farther from each other than this (spacings).
    pub folds: Option<f64>,
}

/// Parameters of [`ContactMode::Overlap`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Overlap {
    /// Stiffness κ of the overlap energy relative to the p-wave modulus.
    pub stiffness: f64,
    /// Stiffness `κ_c` of the core that keeps lone particles apart.
    pub core_stiffness: f64,
    /// Radius of the core in mean particle spacings.
    pub core_radius: f64,
    /// Along what it acts, but for the core.
    pub direction: ContactDirection,
    /// Friction and damping.
    pub resistance: Resistance,
}

impl Default for Overlap {
    fn default() -> Self {
        Self {
            stiffness: 4.0,
            core_stiffness: 2.2,
            core_radius: 0.6,
            direction: ContactDirection::Pair,
            resistance: Resistance::default(),
        }
    }
}

/// What bodies in contact do against their relative motion.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Resistance {
    /// Coefficient of friction of faces that stick.
    pub static_friction: f64,
    /// Coefficient of friction of faces that slide; at most that of faces that stick.
    pub kinetic_friction: f64,
    /// Share of critical damping, 0 to 1.
    pub damping: f64,
}

impl Resistance {
    /// Whether there is any.
    #[must_use]
    pub fn is_any(&self) -> bool {
        self.static_friction > 0.0 || self.damping > 0.0
    }
}

/// Law of the penalty force (Belytschko & Neal 1991).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PenaltyLaw {
    /// As the depth to the power 3/2, as between spheres: a function of places.
    Hertz,
    /// The smaller of that and what stops the approach in one step; nothing while parting.
    Pinball,
}

/// Parameters of [`ContactMode::Penalty`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Penalty {
    /// Stiffness κ relative to the p-wave modulus.
    pub stiffness: f64,
    /// Law of the force.
    pub law: PenaltyLaw,
    /// Friction and damping.
    pub resistance: Resistance,
}

impl Default for Penalty {
    fn default() -> Self {
        Self {
            stiffness: 2.0,
            law: PenaltyLaw::Hertz,
            resistance: Resistance::default(),
        }
    }
}
