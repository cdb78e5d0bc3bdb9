//! How laws declare their constants: each once, with its unit.

/// Constants of a law by their keys in the input: value and SI unit (empty for a pure number).
pub type Constants = Vec<(&'static str, f64, &'static str)>;

/// What has constants that the input gives.
pub trait Listed {
    /// The constants, in the order of the input.
    fn constants(&self) -> Constants;
}

/// Declares the constants of a law, each with its SI unit: the struct of them, and their list.
macro_rules! law {
    ($(#[$doc:meta])+ $law:ident { $($(#[$key_doc:meta])+ $key:ident: $unit:literal,)+ }) => {
        $(#[$doc])+
        #[derive(Debug, Clone, Copy, PartialEq)]
        pub struct $law {
            $($(#[$key_doc])+ pub $key: f64,)+
        }

        impl $crate::material::Listed for $law {
            fn constants(&self) -> $crate::material::Constants {
                vec![$((stringify!($key), self.$key, $unit)),+]
            }
        }
    };
}
