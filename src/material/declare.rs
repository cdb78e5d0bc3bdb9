//! Declaration of the constants of laws: each once, with its unit.

/// The value of a constant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Value {
    /// A number in an SI unit (empty for a pure number).
    Number(f64, &'static str),
    /// A choice.
    Word(&'static str),
}

/// Constants of a law by their keys in the input.
pub type Constants = Vec<(&'static str, Value)>;

/// Object with constants that the input gives.
pub trait Listed {
    /// The constants, in the order of the input.
    fn constants(&self) -> Constants;
}

/// Type of a constant: a number with an SI unit, or a choice.
macro_rules! constant_type {
    ($unit:literal) => {
        f64
    };
    ($choice:ident) => {
        $choice
    };
}

/// A constant as users see it.
macro_rules! constant_value {
    ($value:expr, $unit:literal) => {
        $crate::Value::Number($value, $unit)
    };
    ($value:expr, $choice:ident) => {
        $crate::Value::Word($value.name())
    };
}

/// Declares the constants of a law, each with its SI unit or as a choice: the struct of them, and
/// their list.
macro_rules! law {
    ($(#[$doc:meta])+ $law:ident { $($(#[$key_doc:meta])+ $key:ident: $unit:tt,)+ }) => {
        $(#[$doc])+
        #[derive(Debug, Clone, Copy, PartialEq)]
        pub struct $law {
            $($(#[$key_doc])+ pub $key: constant_type!($unit),)+
        }

        impl $crate::Listed for $law {
            fn constants(&self) -> $crate::Constants {
                vec![$((stringify!($key), constant_value!(self.$key, $unit))),+]
            }
        }
    };
}
