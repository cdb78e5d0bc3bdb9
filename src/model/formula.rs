//! Quantities by place: a constant, or a formula of the coordinates in SI units.
//!
//! A formula is a list of operations on a stack, so that it is followed without recursion and without
//! memory of its own. Functions are those of `libm`: the same bits on every machine.

use super::Vec3;

/// Most numbers that the stack of a formula holds.
const DEPTH: usize = 32;
/// Whole powers up to this are products.
const MOST_PRODUCTS: f64 = 16.0;

/// The arguments of a formula at a place (m): its coordinates, its distance from the centre of the
/// body's shape, and the coordinates of that.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place([f64; 7]);

impl Place {
    /// Names of what it holds, in order; the last three belong to the centre.
    pub const NAMES: [&'static str; 7] = ["x", "y", "z", "r", "x0", "y0", "z0"];

    /// A place in a body with a centre (m).
    #[must_use]
    pub fn new(position: &Vec3, centre: &Vec3) -> Self {
        let [x, y, z] = [0, 1, 2].map(|a| position[a]);
        let r = (position - centre).norm();
        Self([x, y, z, r, centre[0], centre[1], centre[2]])
    }
}

/// One operation of a formula.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Operation {
    /// Puts a number on the stack.
    Number(f64),
    /// Puts one of [`Place::NAMES`] on the stack.
    Of(usize),
    /// Changes the number on top.
    One(Function),
    /// Makes one of the two numbers on top.
    Two(Combination),
}

macro_rules! functions {
    ($(#[$doc:meta])* $kind:ident($($x:ident),+) { $($(#[$function_doc:meta])* $function:ident $name:literal = $value:expr;)+ }) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum $kind { $($(#[$function_doc])* $function,)+ }

        impl $kind {
            /// All of them.
            pub const ALL: &'static [Self] = &[$(Self::$function),+];

            /// As it is written.
            #[must_use]
            pub fn name(self) -> &'static str {
                match self { $(Self::$function => $name,)+ }
            }

            /// Its value.
            #[must_use]
            pub fn of(self, $($x: f64),+) -> f64 {
                match self { $(Self::$function => $value,)+ }
            }
        }
    };
}

functions! {
    /// A function of one number.
    Function(x) {
        /// With the other sign.
        Minus "-" = -x;
        /// Square root.
        Sqrt "sqrt" = libm::sqrt(x);
        /// Without its sign.
        Abs "abs" = x.abs();
        /// Zero below zero, else one.
        Step "step" = if x.is_nan() { x } else { f64::from(u8::from(x >= 0.0)) };
        /// Exponential.
        Exp "exp" = libm::exp(x);
        /// Natural logarithm.
        Ln "ln" = libm::log(x);
        /// Decimal logarithm.
        Log10 "log10" = libm::log10(x);
        /// Sine of radians.
        Sin "sin" = libm::sin(x);
        /// Cosine of radians.
        Cos "cos" = libm::cos(x);
        /// Tangent of radians.
        Tan "tan" = libm::tan(x);
        /// Inverse of the sine.
        Asin "asin" = libm::asin(x);
        /// Inverse of the cosine.
        Acos "acos" = libm::acos(x);
        /// Inverse of the tangent.
        Atan "atan" = libm::atan(x);
        /// Hyperbolic sine.
        Sinh "sinh" = libm::sinh(x);
        /// Hyperbolic cosine.
        Cosh "cosh" = libm::cosh(x);
        /// Hyperbolic tangent.
        Tanh "tanh" = libm::tanh(x);
    }
}

functions! {
    /// A function of two numbers, or an operator between them.
    Combination(x, y) {
        /// Sum.
        Plus "+" = x + y;
        /// Difference.
        Less "-" = x - y;
        /// Product.
        Times "*" = x * y;
        /// Quotient.
        Over "/" = x / y;
        /// Power.
        Power "^" = power(x, y);
        /// The smaller one; NaN if any is.
        Min "min" = if y.is_nan() || y < x { y } else { x };
        /// The larger one; NaN if any is.
        Max "max" = if y.is_nan() || y > x { y } else { x };
        /// Angle (rad) of a vector whose components are the second and the first.
        Atan2 "atan2" = libm::atan2(x, y);
        /// Length of a vector of two components.
        Hypot "hypot" = libm::hypot(x, y);
    }
}

/// Powers; those of small whole numbers are products, as they are written by hand.
fn power(x: f64, y: f64) -> f64 {
    if y.trunc() != y || y.abs() > MOST_PRODUCTS {
        return libm::pow(x, y);
    }
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // whole and small
    let count = y.abs() as u32;
    let product = (0..count).fold(1.0, |product, _| product * x);
    if y < 0.0 { 1.0 / product } else { product }
}

/// A quantity (SI) as a formula of the place.
#[derive(Debug, Clone, PartialEq)]
pub struct Formula(Vec<Operation>);

impl Formula {
    /// A formula that leaves one number on the stack and never takes from an empty one; `None` of
    /// other operations, and of such as would hold too many numbers at a time.
    #[must_use]
    pub fn new(operations: Vec<Operation>) -> Option<Self> {
        let mut held = 0_usize;
        for operation in &operations {
            let (takes, sound) = match operation {
                Operation::Number(_) => (0, true),
                Operation::Of(index) => (0, *index < Place::NAMES.len()),
                Operation::One(_) => (1, true),
                Operation::Two(_) => (2, true),
            };
            held = held.checked_sub(takes).filter(|_| sound)? + 1;
            if held > DEPTH {
                return None;
            }
        }
        (held == 1).then_some(Self(operations))
    }

    /// Its value at a place.
    #[must_use]
    pub fn at(&self, place: &Place) -> f64 {
        let mut stack = [0.0; DEPTH];
        let mut held = 0;
        for operation in &self.0 {
            let value = match *operation {
                Operation::Number(number) => number,
                Operation::Of(index) => place.0[index],
                Operation::One(function) => {
                    held -= 1;
                    function.of(stack[held])
                }
                Operation::Two(combination) => {
                    held -= 2;
                    combination.of(stack[held], stack[held + 1])
                }
            };
            stack[held] = value;
            held += 1;
        }
        stack[0]
    }
}

/// A quantity (SI) of each place of a body.
#[derive(Debug, Clone, PartialEq)]
pub enum Profile {
    /// The same everywhere.
    Constant(f64),
    /// By place.
    Formula(Formula),
}

impl Default for Profile {
    fn default() -> Self {
        Self::Constant(0.0)
    }
}

impl Profile {
    /// Its value at a place.
    #[must_use]
    pub fn at(&self, place: &Place) -> f64 {
        match self {
            Self::Constant(value) => *value,
            Self::Formula(formula) => formula.at(place),
        }
    }

    /// The value everywhere, if it is the same.
    #[must_use]
    pub fn constant(&self) -> Option<f64> {
        match self {
            Self::Constant(value) => Some(*value),
            Self::Formula(_) => None,
        }
    }

    /// The same with a constant added.
    #[must_use]
    pub fn plus(self, more: f64) -> Self {
        match self {
            Self::Constant(value) => Self::Constant(value + more),
            Self::Formula(Formula(mut operations)) if more != 0.0 => {
                operations.push(Operation::Number(more));
                operations.push(Operation::Two(Combination::Plus));
                Self::Formula(Formula(operations))
            }
            formula @ Self::Formula(_) => formula,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use Operation::{Number, Of, One, Two};

    #[test]
    fn formulas_follow_their_operations() {
        let place = Place::new(&Vec3::new(1.0, 2.0, 4.0), &Vec3::new(1.0, 2.0, 1.0));
        let of = |operations: &[Operation]| Formula::new(operations.to_vec()).unwrap().at(&place);
        assert_eq!(of(&[Of(3)]), 3.0);
        assert_eq!(of(&[Of(2), Of(6), Two(Combination::Less)]), 3.0);
        assert_eq!(of(&[Of(1), Number(3.0), Two(Combination::Power)]), 8.0);
        assert_eq!(of(&[Of(1), Number(-2.0), Two(Combination::Power)]), 0.25);
        assert_eq!(of(&[Of(2), Number(0.5), Two(Combination::Power)]), 2.0);
        assert_eq!(of(&[Number(-1.0), One(Function::Step)]), 0.0);
        assert_eq!(of(&[Number(0.0), One(Function::Step)]), 1.0);
        for pair in [[f64::NAN, 1.0], [1.0, f64::NAN]] {
            for combination in [Combination::Min, Combination::Max] {
                assert!(of(&[Number(pair[0]), Number(pair[1]), Two(combination)]).is_nan());
            }
        }
        let deep = |count| {
            let mut operations = vec![Of(0); count];
            operations.extend(vec![Two(Combination::Plus); count - 1]);
            Formula::new(operations)
        };
        assert_eq!(deep(DEPTH).unwrap().at(&place), 32.0);
        for wrong in [
            vec![],
            vec![Of(7)],
            vec![Of(0), Of(1)],
            vec![Two(Combination::Plus)],
        ] {
            assert_eq!(Formula::new(wrong), None);
        }
        assert_eq!(deep(DEPTH + 1), None);
        // A formula of full depth leaves room for what is added behind it.
        let profile = Profile::Formula(deep(DEPTH).unwrap()).plus(0.5);
        assert_eq!(profile.at(&place), 32.5);
    }
}
