//! Bodies that move as a linear field.

use material::{Eos, Linear, LinearForm, Strength};
use model::{Axis, Case, Shape, SphForm, Vec3};
use nalgebra::Matrix3;

use crate::common::{SPACING, body, case, make_elastic, planes};

/// A block of 12 spacings along each axis on this side of the mirrors, without stress, and a linear
/// velocity field (1/s) that the mirrors allow.
pub fn free_block(dimension: usize, mirrors: &[Axis], form: SphForm) -> (Case, Matrix3<f64>) {
    let below = if mirrors.is_empty() { 0.0 } else { -12.0 };
    let corner = |at: f64| {
        let along = |a: usize| if a < dimension { at * SPACING } else { 0.0 };
        Vec3::new(along(0), along(1), along(2))
    };
    let shape = Shape::Box {
        lower: corner(below),
        upper: corner(12.0),
    };
    let bodies = vec![body("block", shape, SPACING, Vec3::zeros())];
    let mut case = case(dimension, bodies, 1.0);
    make_elastic(&mut case);
    case.materials[0].eos = Eos::Linear(Linear {
        bulk_modulus: 1e-30,
        form: LinearForm::Logarithmic,
    });
    case.materials[0].strength = Strength::None;
    case.sph.form = form;
    (case.sph.alpha, case.sph.beta) = (0.0, 0.0);
    case.symmetry = planes(mirrors);
    case.time_step.max = 4e-4;
    case.domain.balance_every = 3;
    let mut field = Matrix3::new(40.0, -90.0, 25.0, 70.0, -15.0, 30.0, -35.0, 10.0, 20.0);
    for a in 0..3 {
        for b in 0..3 {
            let odd = |c: usize| mirrors.iter().any(|axis| axis.index() == c);
            if a >= dimension || b >= dimension || (a != b && (odd(a) || odd(b))) {
                field[(a, b)] = 0.0;
            }
        }
    }
    (case, field)
}
