//! A soft block on a slope, whose weight is a hundredth of its stiffness; two dimensions. Gravity
//! has a component along the slope.

use comm::Comm;
use engine::step::Simulation;

use super::{inline, run_with, slope, start};

/// What the block lies on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ground {
    /// A rigid body, by `overlap` contact.
    Body,
    /// A rigid plane.
    Plane,
    /// A body that is held in place, by `penalty` contact.
    Held,
}

/// What friction is between block and slope, and how they begin.
#[derive(Debug, Clone, Copy)]
pub struct Slope<'a> {
    pub ground: Ground,
    /// As typed.
    pub friction: &'a str,
    /// Angle of the block's lattice (degrees).
    pub angle: f64,
}

impl Slope<'_> {
    /// The input, with gravity along the slope that of a slope of tangent `tangent`.
    pub fn text(&self, tangent: f64) -> String {
        self.text_at(tangent, self.height())
    }

    /// Where a plane is half a spacing below the block (mm).
    fn height(&self) -> f64 {
        if self.ground != Ground::Plane || self.angle == 0.0 {
            return 0.0;
        }
        let free = Self {
            friction: "0",
            ..*self
        };
        let s = start(inline(&free.text_at(0.0, -5.0)));
        let lowest = s
            .particles
            .position
            .iter()
            .map(|x| x[1])
            .fold(1.0, f64::min);
        1e3 * lowest - 0.5
    }

    fn text_at(&self, tangent: f64, height: f64) -> String {
        let down = 200.0;
        let along = tangent * down;
        let Self {
            friction, angle, ..
        } = self;
        let resistance = format!("friction = {friction}\ndamping = 0.2");
        let lattice = format!("{{ kind = \"cubic\", angle = \"{angle} deg\" }}");
        let shape = "shape.box = { lower = [\"-15 mm\", \"-4 mm\"], upper = [\"40 mm\", 0] }";
        let touch = "touch = { body = \"slope\", direction = \"-y\" }";
        let (contact, below, touch) = match self.ground {
            Ground::Body => (
                format!("[contact]\n{resistance}"),
                format!("[[body]]\nname = \"slope\"\nrigid = true\n{shape}"),
                touch,
            ),
            Ground::Held => (
                format!("[contact]\nmode = \"penalty\"\n{resistance}"),
                format!(
                    "[[body]]\nname = \"slope\"\nmaterial = \"soft\"\n{shape}\n[[load]]\n\
                     body = \"slope\"\nvelocity = {{ x = 0, y = 0 }}"
                ),
                touch,
            ),
            Ground::Plane => (
                String::new(),
                format!(
                    "[[plane]]\nnormal = \"+y\"\npoint = [0, \"{height:.9} mm\"]\n{resistance}"
                ),
                "",
            ),
        };
        format!(
            r#"
dimension = 2
spacing = "1 mm"
gravity = ["{along:.12} m/s^2", "-{down} m/s^2"]
run.end_time = "1 s"
[material.soft]
density = "1 g/cm^3"
eos.linear = {{ bulk_modulus = "4 MPa" }}
strength.elastic = {{ shear_modulus = "2 MPa" }}
{contact}
{below}
[[body]]
name = "block"
material = "soft"
lattice = {lattice}
shape.box = {{ lower = ["-10 mm", 0], upper = ["10 mm", "8 mm"] }}
{touch}
"#
        )
    }

    /// The block laid on a slope of tangent `tangent`.
    pub fn laid(&self, tangent: f64) -> Simulation {
        start(inline(&self.text(tangent)))
    }

    /// The same particles on another slope.
    fn tilt(&self, s: &Simulation, tangent: f64) -> Simulation {
        let case = inline(&self.text(tangent));
        let mut particles = s.particles.clone();
        particles.resize_halo(0);
        Simulation::resume(case, &Comm::solo(), s.state.clone(), particles).expect("it resumes")
    }

    /// Tilts the slope in small steps until the block has slid by half a hundredth of a spacing
    /// within one, and returns the tangent. Half of what Coulomb's law gives on the first slope
    /// that is too steep by two hundredths; a block that sticks moves by less than a fifth of it.
    pub fn critical(&self, step: f64) -> f64 {
        let mut tangent = 46.0 * step;
        let mut s = self.laid(0.0);
        run_with(&mut s, 10e-3, |_| {});
        for part in 1..=12 {
            s = self.tilt(&s, f64::from(part) / 12.0 * tangent);
            let end = s.state.time + 3e-3;
            run_with(&mut s, end, |_| {});
        }
        loop {
            tangent += step;
            s = self.tilt(&s, tangent);
            let end = s.state.time + 4e-3;
            let mut way = 0.0;
            run_with(&mut s, end, |s| way += s.state.last_dt * speed(s));
            let sliding = s
                .particles
                .sliding
                .iter()
                .chain(&s.particles.surface_sliding);
            println!(
                "{self:?} {tangent:.4}: way {way:e}, sliding {}, speed {:e}",
                sliding.filter(|&&x| x == 1).count(),
                speed(&s)
            );
            if way > 5e-6 {
                return tangent;
            }
        }
    }
}

/// Mean velocity of the block along the slope (m/s).
pub fn speed(s: &Simulation) -> f64 {
    let block = s.particles.body.iter().copied().max();
    let rows = s.particles.velocity.iter().zip(&s.particles.body);
    let (mut sum, mut count) = (0.0, 0.0);
    for (v, _) in rows.filter(|(_, body)| Some(**body) == block) {
        sum += v[0];
        count += 1.0;
    }
    sum / count
}

/// Acceleration in the 20 ms after the first 5 (m/s²), and the way (m). Prints the friction over
/// the normal force.
pub fn slide(s: &mut Simulation) -> (f64, f64) {
    let (mut normal, mut along) = (0.0, 0.0);
    let from = s.state.time;
    let (mut points, mut way) = (Vec::new(), 0.0);
    run_with(s, from + 25e-3, |s| {
        way += s.state.last_dt * speed(s);
        if s.state.time > from + 5e-3 {
            points.push((s.state.time, speed(s)));
            let ledgers = s.state.pairs.iter().map(|p| p.force.map(|f| -f));
            let [x, y, _] = ledgers
                .chain(s.state.loads.iter().map(|l| l.force))
                .next()
                .expect("a force");
            normal += y;
            along -= x;
        }
    });
    println!("along/normal {:.4}", along / normal);
    (slope(&points), way)
}
