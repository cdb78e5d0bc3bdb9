//! Lanes whose every operation is a call, for builds that emulate fused multiply-add.

use super::{F64x8, LANES, Lanes};

/// [`F64x8`] that never lands inside its callers: where each fused multiply-add of eight lanes is eight calls anyway,
/// sums over pairs would be several times as long, and no faster.
#[derive(Clone, Copy)]
pub struct Portable(F64x8);

/// Operations that stand by themselves, once for the whole program.
macro_rules! apart {
    ($( $name:ident($own:ident $(, $other:ident)*); )+) => {
        $(
            #[inline(always)]
            fn $name(self $(, $other: Self)*) -> Self {
                #[inline(never)]
                fn apart($own: &F64x8 $(, $other: &F64x8)*) -> F64x8 {
                    $own.$name($( *$other ),*)
                }
                Self(apart(&self.0 $(, &$other.0)*))
            }
        )+
    };
}

impl Lanes for Portable {
    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self(F64x8::splat(value))
    }

    #[inline(always)]
    fn load(values: &F64x8) -> Self {
        Self(*values)
    }

    #[inline(always)]
    fn read(values: &[f64; LANES]) -> Self {
        Self(F64x8(*values))
    }

    #[inline(always)]
    fn store(self) -> F64x8 {
        self.0
    }

    #[inline(always)]
    fn columns(rows: [&[f64; 4]; LANES]) -> [Self; 4] {
        let [a, b, c, d] = F64x8::columns(rows);
        [Self(a), Self(b), Self(c), Self(d)]
    }

    apart! {
        add(own, other);
        sub(own, other);
        mul(own, other);
        div(own, other);
        mul_add(own, factor, term);
        neg_mul_add(own, factor, term);
        sqrt(own);
        max(own, other);
        min(own, other);
        min_where_positive(own, other, mask);
    }

    #[inline(always)]
    fn less_than(self, other: Self) -> u8 {
        #[inline(never)]
        fn apart(own: &F64x8, other: &F64x8) -> u8 {
            own.less_than(*other)
        }
        apart(&self.0, &other.0)
    }
}
