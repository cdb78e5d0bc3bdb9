//! Records of the history of particles that no step needs: a sum, and extremes.

use super::scatter::Scatter;

macro_rules! records {
    (($d:tt) $( $(#[doc = $doc:literal])+ $name:ident, )+) => {
        /// The records of particles, each empty where a case has no use for it.
        pub struct Records<'a> {
            $( $(#[doc = $doc])+ pub $name: Scatter<'a, f64>, )+
        }

        impl Records<'_> {
            /// True if particles keep any.
            #[must_use]
            pub fn any(&self) -> bool {
                $( !self.$name.is_empty() )||+
            }
        }

        /// Borrows [`Records`] of a store, which leaves its other fields free.
        #[macro_export]
        macro_rules! records_of {
            ($d particles:expr) => {
                $crate::Records {
                    $( $name: $crate::Scatter::new(&mut $d particles.$name), )+
                }
            };
        }
    };
}

records! { ($)
    /// Plastic work so far (J/kg).
    plastic_energy,
    /// Largest pressure so far (Pa).
    peak_pressure,
    /// When that was (s).
    peak_pressure_time,
    /// Largest mean tension so far (Pa).
    peak_tension,
    /// Highest temperature so far (K).
    peak_temperature,
    /// Largest equivalent strain rate so far (1/s).
    peak_strain_rate,
    /// When pressure first passed the threshold of arrival (s).
    arrival_time,
}
