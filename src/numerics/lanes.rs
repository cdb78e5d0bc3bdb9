//! Eight doubles side by side: one for each receiver of a cluster.
//!
//! Every operation is IEEE-exact and means the same on all instruction sets, so all of them give
//! the same bits. [`F64x8`] is the plain form that everybody may use; the pair sweeps are generic
//! over [`Lanes`] and run on whatever vectors [`super::dispatch`] finds.

pub mod portable;

/// Receivers of a cluster.
pub const LANES: usize = 8;

/// One double for each receiver of a cluster, as plain memory.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C, align(64))]
pub struct F64x8(pub [f64; LANES]);

/// Vectors of eight doubles.
pub trait Lanes: Copy {
    /// The same value in every lane.
    fn splat(value: f64) -> Self;
    /// From aligned memory.
    fn load(values: &F64x8) -> Self;
    /// From memory anywhere.
    fn read(values: &[f64; LANES]) -> Self;
    /// To memory.
    fn store(self) -> F64x8;
    /// Eight rows of four numbers by columns: number c of row k is lane k of vector c.
    fn columns(rows: [&[f64; 4]; LANES]) -> [Self; 4];
    /// Sum of each lane.
    #[must_use]
    fn add(self, other: Self) -> Self;
    /// Difference of each lane.
    #[must_use]
    fn sub(self, other: Self) -> Self;
    /// Product of each lane.
    #[must_use]
    fn mul(self, other: Self) -> Self;
    /// Quotient of each lane.
    #[must_use]
    fn div(self, other: Self) -> Self;
    /// `self · factor + term` with one rounding.
    #[must_use]
    fn mul_add(self, factor: Self, term: Self) -> Self;
    /// `term − self · factor` with one rounding.
    #[must_use]
    fn neg_mul_add(self, factor: Self, term: Self) -> Self;
    /// Square root of each lane.
    #[must_use]
    fn sqrt(self) -> Self;
    /// This lane if it is larger than `other`'s, else `other`'s (also where one is NaN).
    #[must_use]
    fn max(self, other: Self) -> Self;
    /// This lane if it is smaller than `other`'s, else `other`'s (also where one is NaN).
    #[must_use]
    fn min(self, other: Self) -> Self;
    /// The smaller of this lane and `other`'s where `mask` is positive, elsewhere this lane.
    #[must_use]
    fn min_where_positive(self, other: Self, mask: Self) -> Self;
    /// Bit k: lane k is smaller than `other`'s.
    fn less_than(self, other: Self) -> u8;
}

/// A loop, since what array methods call may be compiled apart from the vector code.
macro_rules! each_lane {
    ($k:ident => $value:expr) => {{
        let mut lanes = [0.0; LANES];
        for $k in 0..LANES {
            lanes[$k] = $value;
        }
        Self(lanes)
    }};
}

impl Lanes for F64x8 {
    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self([value; LANES])
    }

    #[inline(always)]
    fn load(values: &F64x8) -> Self {
        *values
    }

    #[inline(always)]
    fn read(values: &[f64; LANES]) -> Self {
        Self(*values)
    }

    #[inline(always)]
    fn store(self) -> F64x8 {
        self
    }

    #[inline(always)]
    fn columns(rows: [&[f64; 4]; LANES]) -> [Self; 4] {
        let mut all = [Self([0.0; LANES]); 4];
        for k in 0..LANES {
            for c in 0..4 {
                all[c].0[k] = rows[k][c];
            }
        }
        all
    }

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        each_lane!(k => self.0[k] + other.0[k])
    }

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        each_lane!(k => self.0[k] - other.0[k])
    }

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        each_lane!(k => self.0[k] * other.0[k])
    }

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        each_lane!(k => self.0[k] / other.0[k])
    }

    #[inline(always)]
    fn mul_add(self, factor: Self, term: Self) -> Self {
        each_lane!(k => self.0[k].mul_add(factor.0[k], term.0[k]))
    }

    #[inline(always)]
    fn neg_mul_add(self, factor: Self, term: Self) -> Self {
        each_lane!(k => (-self.0[k]).mul_add(factor.0[k], term.0[k]))
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        each_lane!(k => self.0[k].sqrt())
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        each_lane!(k => if self.0[k] > other.0[k] { self.0[k] } else { other.0[k] })
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        each_lane!(k => if self.0[k] < other.0[k] { self.0[k] } else { other.0[k] })
    }

    #[inline(always)]
    fn min_where_positive(self, other: Self, mask: Self) -> Self {
        each_lane!(k => if mask.0[k] > 0.0 && other.0[k] < self.0[k] {
            other.0[k]
        } else {
            self.0[k]
        })
    }

    #[inline(always)]
    fn less_than(self, other: Self) -> u8 {
        (0..LANES).fold(0, |bits, k| bits | u8::from(self.0[k] < other.0[k]) << k)
    }
}

/// 512-bit vectors. Only [`super::dispatch`] makes work run on them, after it has found them.
#[cfg(target_arch = "x86_64")]
pub mod avx512 {
    use std::arch::x86_64::{
        __m512d, _CMP_GT_OQ, _CMP_LT_OQ, _mm256_loadu_pd, _mm512_add_pd, _mm512_castpd256_pd512,
        _mm512_cmp_pd_mask, _mm512_div_pd, _mm512_fmadd_pd, _mm512_fnmadd_pd, _mm512_insertf64x4,
        _mm512_load_pd, _mm512_loadu_pd, _mm512_mask_min_pd, _mm512_max_pd, _mm512_min_pd,
        _mm512_mul_pd, _mm512_set1_pd, _mm512_setzero_pd, _mm512_shuffle_f64x2, _mm512_sqrt_pd,
        _mm512_store_pd, _mm512_sub_pd, _mm512_unpackhi_pd, _mm512_unpacklo_pd,
    };

    use super::{F64x8, Lanes};

    /// Eight doubles in one register.
    #[derive(Clone, Copy)]
    pub struct Vector(__m512d);

    // SAFETY (all of this block): this type is only used inside functions that `dispatch` calls
    // after it has found AVX-512F on this processor.
    impl Lanes for Vector {
        #[inline(always)]
        fn splat(value: f64) -> Self {
            Self(unsafe { _mm512_set1_pd(value) })
        }

        #[inline(always)]
        fn load(values: &F64x8) -> Self {
            Self(unsafe { _mm512_load_pd(values.0.as_ptr()) })
        }

        #[inline(always)]
        fn read(values: &[f64; 8]) -> Self {
            Self(unsafe { _mm512_loadu_pd(values.as_ptr()) })
        }

        #[inline(always)]
        fn store(self) -> F64x8 {
            let mut values = F64x8([0.0; 8]);
            unsafe { _mm512_store_pd(values.0.as_mut_ptr(), self.0) };
            values
        }

        #[inline(always)]
        fn columns(rows: [&[f64; 4]; 8]) -> [Self; 4] {
            // Rows 0 and 2, 1 and 3, 4 and 6, 5 and 7. (No closures: they might be called.)
            macro_rules! two {
                ($a:expr) => {
                    _mm512_insertf64x4::<1>(
                        _mm512_castpd256_pd512(_mm256_loadu_pd(rows[$a].as_ptr())),
                        _mm256_loadu_pd(rows[$a + 2].as_ptr()),
                    )
                };
            }
            let (a, b, c, d) = unsafe { (two!(0), two!(1), two!(4), two!(5)) };
            unsafe {
                let (a, b) = (_mm512_unpacklo_pd(a, b), _mm512_unpackhi_pd(a, b));
                let (c, d) = (_mm512_unpacklo_pd(c, d), _mm512_unpackhi_pd(c, d));
                [
                    Self(_mm512_shuffle_f64x2::<0x88>(a, c)),
                    Self(_mm512_shuffle_f64x2::<0x88>(b, d)),
                    Self(_mm512_shuffle_f64x2::<0xdd>(a, c)),
                    Self(_mm512_shuffle_f64x2::<0xdd>(b, d)),
                ]
            }
        }

        #[inline(always)]
        fn add(self, other: Self) -> Self {
            Self(unsafe { _mm512_add_pd(self.0, other.0) })
        }

        #[inline(always)]
        fn sub(self, other: Self) -> Self {
            Self(unsafe { _mm512_sub_pd(self.0, other.0) })
        }

        #[inline(always)]
        fn mul(self, other: Self) -> Self {
            Self(unsafe { _mm512_mul_pd(self.0, other.0) })
        }

        #[inline(always)]
        fn div(self, other: Self) -> Self {
            Self(unsafe { _mm512_div_pd(self.0, other.0) })
        }

        #[inline(always)]
        fn mul_add(self, factor: Self, term: Self) -> Self {
            Self(unsafe { _mm512_fmadd_pd(self.0, factor.0, term.0) })
        }

        #[inline(always)]
        fn neg_mul_add(self, factor: Self, term: Self) -> Self {
            Self(unsafe { _mm512_fnmadd_pd(self.0, factor.0, term.0) })
        }

        #[inline(always)]
        fn sqrt(self) -> Self {
            Self(unsafe { _mm512_sqrt_pd(self.0) })
        }

        #[inline(always)]
        fn max(self, other: Self) -> Self {
            Self(unsafe { _mm512_max_pd(self.0, other.0) })
        }

        #[inline(always)]
        fn min(self, other: Self) -> Self {
            Self(unsafe { _mm512_min_pd(self.0, other.0) })
        }

        #[inline(always)]
        fn min_where_positive(self, other: Self, mask: Self) -> Self {
            unsafe {
                let positive = _mm512_cmp_pd_mask::<_CMP_GT_OQ>(mask.0, _mm512_setzero_pd());
                Self(_mm512_mask_min_pd(self.0, positive, other.0, self.0))
            }
        }

        #[inline(always)]
        fn less_than(self, other: Self) -> u8 {
            unsafe { _mm512_cmp_pd_mask::<_CMP_LT_OQ>(self.0, other.0) }
        }
    }
}

/// Pairs of 256-bit vectors. Only [`super::dispatch`] makes work run on them, after it has found
/// them.
#[cfg(target_arch = "x86_64")]
pub mod avx2 {
    use std::arch::x86_64::{
        __m256d, _CMP_GT_OQ, _CMP_LT_OQ, _mm_loadu_pd, _mm256_add_pd, _mm256_blendv_pd,
        _mm256_castpd128_pd256, _mm256_cmp_pd, _mm256_div_pd, _mm256_fmadd_pd, _mm256_fnmadd_pd,
        _mm256_insertf128_pd, _mm256_load_pd, _mm256_loadu_pd, _mm256_max_pd, _mm256_min_pd,
        _mm256_movemask_pd, _mm256_mul_pd, _mm256_set1_pd, _mm256_setzero_pd, _mm256_sqrt_pd,
        _mm256_store_pd, _mm256_sub_pd, _mm256_unpackhi_pd, _mm256_unpacklo_pd,
    };

    use super::{F64x8, Lanes};

    /// Eight doubles in two registers.
    #[derive(Clone, Copy)]
    pub struct Vector(__m256d, __m256d);

    macro_rules! both {
        ($function:ident($a:expr, $b:expr)) => {
            unsafe { Self($function($a.0, $b.0), $function($a.1, $b.1)) }
        };
    }

    // SAFETY (all of this block): this type is only used inside functions that `dispatch` calls
    // after it has found AVX2 and FMA on this processor.
    impl Lanes for Vector {
        #[inline(always)]
        fn splat(value: f64) -> Self {
            unsafe { Self(_mm256_set1_pd(value), _mm256_set1_pd(value)) }
        }

        #[inline(always)]
        fn load(values: &F64x8) -> Self {
            let pointer = values.0.as_ptr();
            unsafe { Self(_mm256_load_pd(pointer), _mm256_load_pd(pointer.add(4))) }
        }

        #[inline(always)]
        fn read(values: &[f64; 8]) -> Self {
            let pointer = values.as_ptr();
            unsafe { Self(_mm256_loadu_pd(pointer), _mm256_loadu_pd(pointer.add(4))) }
        }

        #[inline(always)]
        fn store(self) -> F64x8 {
            let mut values = F64x8([0.0; 8]);
            let pointer = values.0.as_mut_ptr();
            unsafe {
                _mm256_store_pd(pointer, self.0);
                _mm256_store_pd(pointer.add(4), self.1);
            }
            values
        }

        #[inline(always)]
        fn columns(rows: [&[f64; 4]; 8]) -> [Self; 4] {
            // Numbers c and c + 1 of rows a and a + 2. (No closures: they would be called.)
            macro_rules! two {
                ($a:expr, $c:expr) => {
                    _mm256_insertf128_pd::<1>(
                        _mm256_castpd128_pd256(_mm_loadu_pd(&raw const rows[$a][$c])),
                        _mm_loadu_pd(&raw const rows[$a + 2][$c]),
                    )
                };
            }
            macro_rules! columns {
                ($unpack:ident, $c:expr) => {
                    Self(
                        $unpack(two!(0, $c), two!(1, $c)),
                        $unpack(two!(4, $c), two!(5, $c)),
                    )
                };
            }
            unsafe {
                [
                    columns!(_mm256_unpacklo_pd, 0),
                    columns!(_mm256_unpackhi_pd, 0),
                    columns!(_mm256_unpacklo_pd, 2),
                    columns!(_mm256_unpackhi_pd, 2),
                ]
            }
        }

        #[inline(always)]
        fn add(self, other: Self) -> Self {
            both!(_mm256_add_pd(self, other))
        }

        #[inline(always)]
        fn sub(self, other: Self) -> Self {
            both!(_mm256_sub_pd(self, other))
        }

        #[inline(always)]
        fn mul(self, other: Self) -> Self {
            both!(_mm256_mul_pd(self, other))
        }

        #[inline(always)]
        fn div(self, other: Self) -> Self {
            both!(_mm256_div_pd(self, other))
        }

        #[inline(always)]
        fn mul_add(self, factor: Self, term: Self) -> Self {
            unsafe {
                Self(
                    _mm256_fmadd_pd(self.0, factor.0, term.0),
                    _mm256_fmadd_pd(self.1, factor.1, term.1),
                )
            }
        }

        #[inline(always)]
        fn neg_mul_add(self, factor: Self, term: Self) -> Self {
            unsafe {
                Self(
                    _mm256_fnmadd_pd(self.0, factor.0, term.0),
                    _mm256_fnmadd_pd(self.1, factor.1, term.1),
                )
            }
        }

        #[inline(always)]
        fn sqrt(self) -> Self {
            unsafe { Self(_mm256_sqrt_pd(self.0), _mm256_sqrt_pd(self.1)) }
        }

        #[inline(always)]
        fn max(self, other: Self) -> Self {
            both!(_mm256_max_pd(self, other))
        }

        #[inline(always)]
        fn min(self, other: Self) -> Self {
            both!(_mm256_min_pd(self, other))
        }

        #[inline(always)]
        fn min_where_positive(self, other: Self, mask: Self) -> Self {
            unsafe {
                let zero = _mm256_setzero_pd();
                let smaller = |own, other, mask| {
                    let positive = _mm256_cmp_pd::<_CMP_GT_OQ>(mask, zero);
                    _mm256_blendv_pd(own, _mm256_min_pd(other, own), positive)
                };
                Self(
                    smaller(self.0, other.0, mask.0),
                    smaller(self.1, other.1, mask.1),
                )
            }
        }

        #[inline(always)]
        fn less_than(self, other: Self) -> u8 {
            unsafe {
                let low = _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_LT_OQ>(self.0, other.0));
                let high = _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_LT_OQ>(self.1, other.1));
                #[allow(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    reason = "four bits each"
                )]
                {
                    (low | high << 4) as u8
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{F64x8, LANES, Lanes};
    use crate::dispatch::{Vectorised, available};

    struct Turn<'a>(&'a [[f64; LANES]; LANES]);

    impl Vectorised for Turn<'_> {
        type Output = [F64x8; 4];

        #[inline(always)]
        fn run<V: Lanes>(self) -> Self::Output {
            V::columns(self.0.each_ref().map(|row| row[2..].first_chunk().unwrap())).map(V::store)
        }
    }

    #[test]
    fn rows_become_columns_on_all_instruction_sets() {
        let mut numbers = (0_u8..).map(f64::from);
        let rows: [[f64; LANES]; LANES] =
            std::array::from_fn(|_| std::array::from_fn(|_| numbers.next().unwrap()));
        for set in available() {
            let columns = set.run(Turn(&rows));
            for k in 0..LANES {
                assert!((0..4).all(|c| columns[c].0[k] == rows[k][c + 2]));
            }
        }
    }
}
