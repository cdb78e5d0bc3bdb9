//! Pair terms of the SPH sums, each off unless a case asks for it: the table from which keys, options and sets of them
//! come.

/// Passes the pair terms to the macro `$then`: meaning, name in sets of options, and the key in `[sph]` as in a row of a
/// table of the input. A term of which zero or `false` is asked is off.
#[macro_export]
macro_rules! pair_terms {
    ($then:ident) => {
        $then! {
            /// Factor of the artificial stress.
            ARTIFICIAL_STRESS { artificial_stress: f64 = 0.0, Within(0.0, 1.0) }
            /// The Balsara switch.
            BALSARA { balsara: bool = false }
            /// Coefficient of the artificial conduction.
            CONDUCTION { conduction: f64 = 0.0, Within(0.0, 2.0) }
            /// Factor of XSPH.
            XSPH { xsph: f64 = 0.0, Within(0.0, 1.0) }
        }
    };
}

macro_rules! declare {
    ($( $(#[$doc:meta])+ $term:ident { $key:ident: $typed:ident $($more:tt)+ } )+) => {
        /// Options of the pair terms.
        #[derive(Debug, Clone, Copy, Default, PartialEq)]
        pub struct TermOptions {
            $( $(#[$doc])+ pub $key: $typed, )+
        }

        impl TermOptions {
            /// Terms that are on: number in the table, and key.
            pub fn acting(&self) -> impl Iterator<Item = (usize, &'static str)> {
                let terms = [$( is_on(&self.$key).then_some(stringify!($key)) ),+];
                let terms = terms.into_iter().enumerate();
                terms.filter_map(|(number, key)| Some((number, key?)))
            }
        }
    };
}
pair_terms!(declare);

fn is_on<T: Default + PartialEq>(asked: &T) -> bool {
    *asked != T::default()
}
