//! Values that the program takes of typed ones, and defaults that rows of tables state.

use serde_json::{Value as Json, json};
use toml::Spanned;

use super::FrictionParams;
use super::short::LevelsParams;
use crate::input::quantity::{Kind, Quantity, quantity};
use crate::input::source::Diagnostic;
use crate::input::validate::check::{Allowed, number, out_of_range};
use model::readable::short;

/// Type that has a value of its own.
pub trait Typed {
    /// Type of a value in a row.
    type Stated;
    /// Type of a value for the program.
    type Value;

    /// The value that a row states.
    fn value(stated: Self::Stated) -> Self::Value;

    /// That value as it would be typed.
    fn written(stated: Self::Stated) -> Json;
}

/// Type that may have any of its values.
pub trait Free: Typed {
    /// The value that is typed.
    fn typed(&self) -> Self::Value;
}

/// Type that may have the values of a range.
pub trait Ranged {
    /// Result within the range.
    type Found;

    /// The value of a key.
    ///
    /// # Errors
    /// Says that the value is none of those.
    fn within(&self, key: &str, allowed: Allowed) -> Result<Self::Found, Diagnostic>;
}

/// Typed value, else that which a row states.
pub fn free<T: Free>(given: Option<&T>, stated: T::Stated) -> T::Value {
    given.map_or_else(|| T::value(stated), T::typed)
}

/// Types of values that are typed as they are.
macro_rules! typed {
    ($($typed:ty: $stated:ty => $value:ty, |$of:ident| $make:expr, $write:expr;)+) => { $(
        impl Typed for $typed {
            type Stated = $stated;
            type Value = $value;

            fn value($of: $stated) -> $value {
                $make
            }

            fn written($of: $stated) -> Json {
                $write
            }
        }
    )+ };
}

typed! {
    bool: bool => bool, |stated| stated, json!(stated);
    // As people write it.
    f64: f64 => f64, |stated| stated, short(stated).parse().map_or(Json::Null, Json::Number);
    i64: u64 => u64, |stated| stated, json!(stated);
    String: &'static str => String, |stated| stated.to_owned(), json!(stated);
    LevelsParams: LevelsParams => LevelsParams, |stated| stated, match stated {
        LevelsParams::Auto(_) => json!("auto"),
        LevelsParams::Number(number) => json!(number),
    };
    // Of faces that stick and of faces that slide.
    FrictionParams: f64 => [f64; 2], |stated| [stated; 2], f64::written(stated);
}

impl<K: Kind> Typed for Quantity<K> {
    type Stated = &'static str;
    type Value = f64;

    fn value(stated: &'static str) -> f64 {
        let read = quantity::<K>(stated).map(|quantity| quantity.si);
        read.unwrap_or_else(|cause| unreachable!("{stated}: {cause}"))
    }

    fn written(stated: &'static str) -> Json {
        stated.parse().map_or(json!(stated), Json::Number)
    }
}

impl<T: Typed> Typed for Spanned<T> {
    type Stated = T::Stated;
    type Value = T::Value;

    fn value(stated: T::Stated) -> T::Value {
        T::value(stated)
    }

    fn written(stated: T::Stated) -> Json {
        T::written(stated)
    }
}

impl<T: Typed> Typed for Option<T> {
    type Stated = T::Stated;
    type Value = T::Value;

    fn value(stated: T::Stated) -> T::Value {
        T::value(stated)
    }

    fn written(stated: T::Stated) -> Json {
        T::written(stated)
    }
}

/// Values that are taken as they are.
macro_rules! free {
    ($($typed:ty),+) => { $(
        impl Free for $typed {
            fn typed(&self) -> Self {
                self.clone()
            }
        }
    )+ };
}
free!(bool, f64, String, LevelsParams);

impl<T: Free> Free for Spanned<T> {
    fn typed(&self) -> T::Value {
        self.get_ref().typed()
    }
}

impl Ranged for Spanned<f64> {
    type Found = f64;

    fn within(&self, key: &str, allowed: Allowed) -> Result<f64, Diagnostic> {
        number(self, key, allowed)
    }
}

impl<K> Ranged for Spanned<Quantity<K>> {
    type Found = f64;

    fn within(&self, key: &str, allowed: Allowed) -> Result<f64, Diagnostic> {
        number(self, key, allowed)
    }
}

impl Ranged for Spanned<i64> {
    type Found = u64;

    fn within(&self, key: &str, allowed: Allowed) -> Result<u64, Diagnostic> {
        let found = u64::try_from(*self.get_ref()).ok();
        let found = found.filter(|&whole| allowed.has_whole(whole));
        found.ok_or_else(|| out_of_range(self.span(), key, &allowed.words()))
    }
}

impl Ranged for Spanned<FrictionParams> {
    type Found = [f64; 2];

    fn within(&self, key: &str, allowed: Allowed) -> Result<[f64; 2], Diagnostic> {
        match self.get_ref() {
            FrictionParams::One(value) => {
                let value = number(&Spanned::new(self.span(), *value), key, allowed)?;
                Ok([value; 2])
            }
            FrictionParams::Two(table) => {
                let [sticking, sliding] = [table.r#static()?, table.kinetic()?];
                if sliding > sticking {
                    let title = "`kinetic` must be at most `static`";
                    return Err(Diagnostic::new(table.kinetic.span(), title).label("out of range"));
                }
                Ok([sticking, sliding])
            }
        }
    }
}

impl<T: Ranged> Ranged for Option<T> {
    type Found = Option<T::Found>;

    fn within(&self, key: &str, allowed: Allowed) -> Result<Self::Found, Diagnostic> {
        self.as_ref()
            .map(|given| given.within(key, allowed))
            .transpose()
    }
}
