//! Packets of elastic waves in a plane, and what of them comes back from a face.

use std::collections::HashMap;

use comm::Comm;
use engine::step::Simulation;

use super::{inline, start};

/// P-wave modulus and shear modulus (Pa), for waves of 6 and 3 km/s.
pub const MODULI: [f64; 2] = [72e9, 18e9];
/// Density (kg/m³).
pub const DENSITY: f64 = 2000.0;
/// The same in an input.
pub const MATERIAL: &str = r#"
material.a.density = "2 g/cm^3"
material.a.eos.linear = { bulk_modulus = "48 GPa", form = "logarithmic" }
material.a.strength.elastic.shear_modulus = "18 GPa"
"#;
/// Spacing (m).
const STEP: f64 = 1e-3;
/// Largest velocity of a packet (m/s).
const SPEED: f64 = 10.0;

/// Kinds of waves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Wave {
    /// Longitudinal.
    P,
    /// Transverse, in the plane.
    S,
}

/// A packet of waves on its way to the face at +x.
#[derive(Debug, Clone, Copy)]
pub struct Packet {
    pub wave: Wave,
    /// Angle from the face's normal (degrees).
    pub angle: f64,
    /// Wave length in spacings.
    pub length: f64,
    /// Depth of the zone in spacings.
    pub depth: f64,
    /// Form of the sums.
    pub form: &'static str,
}

impl Packet {
    /// Speed (m/s).
    fn speed(&self) -> f64 {
        let [p, s] = MODULI;
        let modulus = if self.wave == Wave::P { p } else { s };
        (modulus / DENSITY).sqrt()
    }

    /// Direction of propagation.
    fn direction(&self) -> [f64; 2] {
        let (s, c) = self.angle.to_radians().sin_cos();
        [c, s]
    }

    /// Half length and half width, as standard deviations (m). Waves at a right angle are nearly plane:
    /// a narrow beam has parts at all angles.
    fn extent(&self) -> [f64; 2] {
        let width = if self.angle == 0.0 { 2.5 } else { 1.6 };
        [0.8, width].map(|part| part * self.length * STEP)
    }

    /// Where its middle begins (m): far enough from all faces, and from the zone.
    fn begin(&self) -> [f64; 2] {
        let x = 2.6 * self.length * STEP;
        let [_, wide] = self.extent();
        [x, 2.5 * wide]
    }

    /// Where the zone begins (m).
    fn zone(&self) -> f64 {
        (5.0 * self.length).round() * STEP
    }

    /// How far it goes along the face until it is back where it began (m).
    fn along(&self) -> f64 {
        let [x, y] = self.direction();
        2.0 * (2.4 * self.length + 0.5 * self.depth) * STEP * y / x
    }

    /// Height of the model (m).
    fn height(&self) -> f64 {
        let [_, wide] = self.extent();
        ((5.0 * wide + self.along()) / STEP).round() * STEP
    }

    /// The model, so many spacings long beyond where the zone begins.
    fn model(&self, beyond: f64, zone: &str) -> Simulation {
        let [x, y] = [self.zone() / STEP + beyond, self.height() / STEP];
        let mut s = start(inline(&format!(
            r#"
dimension = 2
spacing = "1 mm"
sph = {{ form = "{}", alpha = 0.2, beta = 0 }}
time_step.max = "0.075 us"
run.end_time = "1 ms"
{MATERIAL}
[[body]]
name = "block"
material = "a"
shape.box = {{ lower = [0, 0], upper = ["{x:.0} mm", "{y:.0} mm"] }}
{zone}
"#,
            self.form
        )));
        let owned = s.particles.owned();
        for i in 0..owned {
            self.put(&mut s, i);
        }
        s
    }

    /// Gives particle `i` its part of the packet.
    fn put(&self, s: &mut Simulation, i: usize) {
        let particles = &mut s.particles;
        let ([nx, ny], [x0, y0]) = (self.direction(), self.begin());
        let (x, y) = (particles.position[i][0] - x0, particles.position[i][1] - y0);
        let (along, across) = (x * nx + y * ny, y * nx - x * ny);
        let [long, wide] = self.extent();
        let envelope = (-0.5 * ((along / long).powi(2) + (across / wide).powi(2))).exp();
        let phase = std::f64::consts::TAU * along / (self.length * STEP);
        let f = SPEED * phase.cos() * envelope;
        let strain = f / self.speed();
        let shear = MODULI[1];
        let (v, stress) = match self.wave {
            Wave::P => {
                particles.density[i] = DENSITY * strain.exp();
                let s = |a: f64, b: f64, same: f64| -2.0 * shear * strain * (a * b - same / 3.0);
                let normal = [s(nx, nx, 1.0), s(ny, ny, 1.0), s(0.0, 0.0, 1.0)];
                (
                    [f * nx, f * ny],
                    [normal[0], normal[1], normal[2], s(nx, ny, 0.0)],
                )
            }
            Wave::S => {
                let (tx, ty) = (-ny, nx);
                let s = |a: f64, b: f64| -shear * strain * (a + b);
                let stress = [
                    s(nx * tx, nx * tx),
                    s(ny * ty, ny * ty),
                    0.0,
                    s(nx * ty, ny * tx),
                ];
                ([f * tx, f * ty], stress)
            }
        };
        particles.velocity[i] = [v[0], v[1], 0.0];
        let [xx, yy, zz, xy] = stress;
        particles.deviatoric_stress[i] = [xx, yy, zz, xy, 0.0, 0.0];
    }
}

/// Amplitude of what comes back of a packet, over that at which it comes: the largest difference of a
/// velocity from that of a model that goes on, before the zone.
pub fn returned(packet: &Packet) -> f64 {
    let zone = format!(
        "[[absorb]]\nbody = \"block\"\nfaces = [\"+x\"]\ndepth = \"{} mm\"",
        packet.depth
    );
    // What comes back from the end of the model that goes on comes too late.
    let mut ours = packet.model(packet.depth, &zone);
    let beyond = match (packet.wave, packet.angle) {
        (Wave::S, 45.0) => 8.0,
        _ => 5.0,
    };
    let mut theirs = packet.model(packet.depth + beyond * packet.length, "");
    let begin = packet.zone();
    let key = |s: &Simulation, i: usize| {
        let place = s.particles.position[i];
        [0, 1].map(|a| (place[a] / STEP).floor().to_bits())
    };
    // What runs along the face of the zone, and does not leave it, has died down a wave length away.
    let near = 0.5 * begin..begin - packet.length * STEP;
    let places = |s: &Simulation| -> HashMap<[u64; 2], u64> {
        let particles = 0..s.particles.owned();
        let near = particles.filter(|&i| near.contains(&s.particles.position[i][0]));
        near.map(|i| (key(s, i), s.particles.id[i])).collect()
    };
    let (own, others) = (places(&ours), places(&theirs));
    let twins: Vec<[u64; 2]> = own.iter().map(|(at, &id)| [id, others[at]]).collect();
    let velocities = |s: &Simulation| -> HashMap<u64, [f64; 3]> {
        let particles = 0..s.particles.owned();
        particles
            .map(|i| (s.particles.id[i], s.particles.velocity[i]))
            .collect()
    };
    let comm = Comm::solo();
    let path = 2.0 * (2.4 * packet.length + 0.5 * packet.depth) * STEP;
    let [long, _] = packet.extent();
    let time = (path / packet.direction()[0] + long) / packet.speed();
    let (mut top, mut off) = (0.0_f64, 0.0_f64);
    while ours.state.time < time {
        ours.advance(&comm).expect("a step");
        theirs.advance(&comm).expect("a step");
        assert_eq!(ours.state.time.to_bits(), theirs.state.time.to_bits());
        if ours.state.step.is_multiple_of(4) {
            let (a, b) = (velocities(&ours), velocities(&theirs));
            for [own, other] in &twins {
                let (v, w) = (a[own], b[other]);
                let size = |v: [f64; 3]| v[0].hypot(v[1]);
                top = top.max(size(w));
                off = off.max(size([v[0] - w[0], v[1] - w[1], 0.0]));
            }
        }
    }
    println!(
        "{packet:?}: {:.4} of {top:.2} m/s, {} and {} particles, {} steps",
        off / top,
        ours.particles.owned(),
        theirs.particles.owned(),
        ours.state.step
    );
    off / top
}
