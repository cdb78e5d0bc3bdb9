//! The operations of a formula as it is read, and the dimension of each of its parts.

use std::ops::Range;

use crate::input::quantity::{PLAIN, dimension_name};
use crate::input::source::Diagnostic;
use model::units::Powers;
use model::{Combination, Function, Operation};

/// Result of the reading of a part of the text.
pub struct Part {
    /// Its place.
    pub range: Range<usize>,
    /// Its first operation.
    pub first: usize,
    /// Its dimension.
    pub powers: Powers,
    /// Its value, if that is the same everywhere; then it is one operation.
    pub constant: Option<f64>,
    /// True if it is a temperature whose zero is that of Celsius.
    pub celsius: bool,
}

impl Part {
    /// True if it is a plain zero, which stands for that of any dimension.
    pub fn is_zero(&self) -> bool {
        self.constant == Some(0.0) && self.powers == PLAIN
    }

    /// With its article, for messages.
    pub fn name(&self) -> String {
        dimension_name(self.powers).to_owned()
    }
}

/// The operations so far; of constants, the constant that they make.
#[derive(Default)]
pub struct Code(pub Vec<Operation>);

impl Code {
    /// True if the last operation puts a number on the stack.
    pub fn ends_with_number(&self) -> bool {
        matches!(self.0.last(), Some(Operation::Number(_)))
    }

    /// A number.
    pub fn number(
        &mut self,
        range: Range<usize>,
        value: f64,
        powers: Powers,
        celsius: bool,
    ) -> Part {
        Part {
            powers,
            celsius,
            constant: Some(value),
            ..self.length(range, Operation::Number(value))
        }
    }

    /// Something of the place, which is a length unless its caller knows better.
    pub fn length(&mut self, range: Range<usize>, operation: Operation) -> Part {
        self.0.push(operation);
        Part {
            range,
            first: self.0.len() - 1,
            powers: [1, 0, 0, 0, 0],
            constant: None,
            celsius: false,
        }
    }

    /// Two parts that must have one dimension.
    pub fn alike(
        &mut self,
        how: Combination,
        [left, right]: [Part; 2],
        wrong: impl Fn(&Part, &Part) -> String,
    ) -> Result<Part, Diagnostic> {
        if left.powers != right.powers && !left.is_zero() && !right.is_zero() {
            let title = wrong(&left, &right);
            return Err(Diagnostic::new(left.range.start..right.range.end, title));
        }
        let celsius = match how {
            Combination::Plus if !(left.celsius && right.celsius) => left.celsius || right.celsius,
            Combination::Less if left.celsius => !right.celsius,
            Combination::Min | Combination::Max => left.celsius || right.celsius,
            _ => {
                no_celsius([&left, &right])?;
                false
            }
        };
        let powers = if left.is_zero() {
            right.powers
        } else {
            left.powers
        };
        let powers = if how == Combination::Atan2 {
            PLAIN
        } else {
            powers
        };
        let part = self.combine(how, [left, right], powers)?;
        Ok(Part { celsius, ..part })
    }

    /// An operation on two parts.
    pub fn combine(
        &mut self,
        how: Combination,
        [left, right]: [Part; 2],
        powers: Powers,
    ) -> Result<Part, Diagnostic> {
        let constant = left.constant.zip(right.constant).map(|(x, y)| how.of(x, y));
        self.made(
            left.first,
            left.range.start..right.range.end,
            powers,
            constant,
            Operation::Two(how),
        )
    }

    /// A function of a part.
    pub fn apply(
        &mut self,
        function: Function,
        part: Part,
        powers: Powers,
    ) -> Result<Part, Diagnostic> {
        no_celsius([&part, &part])?;
        let constant = part.constant.map(|x| function.of(x));
        self.made(
            part.first,
            part.range,
            powers,
            constant,
            Operation::One(function),
        )
    }

    /// The part that an operation makes of all from `first` on; of constants, a constant.
    fn made(
        &mut self,
        first: usize,
        range: Range<usize>,
        powers: Powers,
        constant: Option<f64>,
        operation: Operation,
    ) -> Result<Part, Diagnostic> {
        if constant.is_some_and(|value| !value.is_finite()) {
            return Err(Diagnostic::new(range, "this is no finite number"));
        }
        // A dimension that none has, far from where powers would overflow.
        if powers.iter().any(|power| power.abs() > 99) {
            let title = "a quantity of such a dimension does not exist";
            return Err(Diagnostic::new(range, title));
        }
        if let Some(value) = constant {
            self.0.truncate(first);
            return Ok(self.number(range, value, powers, false));
        }
        self.0.push(operation);
        Ok(Part {
            range,
            first,
            powers,
            constant,
            celsius: false,
        })
    }
}

/// The dimension of a function of a part.
pub fn powers_of(function: Function, part: &Part) -> Result<Powers, Diagnostic> {
    match function {
        Function::Minus | Function::Abs => Ok(part.powers),
        Function::Step => Ok(PLAIN),
        Function::Sqrt if part.powers.iter().all(|power| power % 2 == 0) => {
            Ok(part.powers.map(|power| power / 2))
        }
        Function::Sqrt => {
            let title = format!("the square root of {} is no quantity", part.name());
            Err(Diagnostic::new(part.range.clone(), title))
        }
        _ if part.powers == PLAIN => Ok(PLAIN),
        _ => {
            let (name, found) = (function.name(), part.name());
            let title = format!("`{name}` takes a plain number, found {found}");
            Err(Diagnostic::new(part.range.clone(), title)
                .help("divide by a quantity of the same dimension"))
        }
    }
}

/// Refuses temperatures of Celsius where it matters which zero they have.
pub fn no_celsius(parts: [&Part; 2]) -> Result<(), Diagnostic> {
    match parts.into_iter().find(|part| part.celsius) {
        None => Ok(()),
        Some(part) => Err(Diagnostic::new(
            part.range.clone(),
            "a temperature in °C can only be added to a difference",
        )
        .help("write differences, and what is multiplied, in K")),
    }
}
