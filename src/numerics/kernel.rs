//! Cubic B-spline kernel with support 2h (Monaghan & Lattanzio 1985; physics page, section 1).

use std::f64::consts::PI;

use crate::lanes::Lanes;

/// Support over smoothing length: no pair farther apart than this many `h_ij` sees each other.
pub const SUPPORT: f64 = 2.0;

/// The kernel of a number of dimensions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Kernel {
    dimension: usize,
    normalisation: f64,
}

impl Kernel {
    /// Kernel in 1, 2 or 3 dimensions.
    ///
    /// # Panics
    /// For any other dimension.
    #[must_use]
    pub fn new(dimension: usize) -> Self {
        let normalisation = match dimension {
            1 => 2.0 / 3.0,
            2 => 10.0 / (7.0 * PI),
            3 => 1.0 / PI,
            _ => panic!("a kernel in {dimension} dimensions"),
        };
        Self {
            dimension,
            normalisation,
        }
    }

    /// Number of dimensions.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.dimension
    }

    /// `σ_d`: 2/3, 10/(7π) or 1/π.
    #[must_use]
    pub fn normalisation(&self) -> f64 {
        self.normalisation
    }

    /// `x^d`.
    #[must_use]
    pub fn power(&self, x: f64) -> f64 {
        match self.dimension {
            1 => x,
            2 => x * x,
            _ => x * x * x,
        }
    }

    /// The kernel of one smoothing length `h` (m).
    #[must_use]
    pub fn of_length(&self, h: f64) -> FixedKernel {
        let height = self.normalisation / self.power(h);
        FixedKernel {
            inverse_length: 1.0 / h,
            height,
            steepness: height / h,
            bend: height / (h * h),
        }
    }

    /// `W(r, h)` (1/m^d).
    #[must_use]
    pub fn value(&self, r: f64, h: f64) -> f64 {
        self.of_length(h).value(r)
    }

    /// `W'(r, h) = dW/dr` (1/m^(d+1)); never positive.
    #[must_use]
    pub fn slope(&self, r: f64, h: f64) -> f64 {
        self.of_length(h).slope(r)
    }
}

/// The kernel of one smoothing length.
#[derive(Debug, Clone, Copy)]
pub struct FixedKernel {
    /// `1/h` (1/m).
    inverse_length: f64,
    /// `σ_d/h^d` (1/m^d).
    height: f64,
    /// `σ_d/h^(d+1)` (1/m^(d+1)).
    steepness: f64,
    /// `σ_d/h^(d+2)` (1/m^(d+2)).
    bend: f64,
}

impl FixedKernel {
    /// `⟨2 − q⟩₊` and `⟨1 − q⟩₊`.
    #[inline]
    fn ramps(&self, r: f64) -> (f64, f64) {
        let q = r * self.inverse_length;
        ((2.0 - q).max(0.0), (1.0 - q).max(0.0))
    }

    /// `W(r)` (1/m^d).
    #[inline]
    #[must_use]
    pub fn value(&self, r: f64) -> f64 {
        let (a, b) = self.ramps(r);
        self.height * (0.25 * (a * a * a) - b * b * b)
    }

    /// `W'(r)` (1/m^(d+1)); never positive.
    #[inline]
    #[must_use]
    pub fn slope(&self, r: f64) -> f64 {
        let (a, b) = self.ramps(r);
        self.steepness * (3.0 * (b * b) - 0.75 * (a * a))
    }

    /// `W''(r)` (1/m^(d+2)).
    #[inline]
    #[must_use]
    pub fn curvature(&self, r: f64) -> f64 {
        let (a, b) = self.ramps(r);
        self.bend * (1.5 * a - 6.0 * b)
    }
}

/// Values of the kernel for eight pairs.
#[derive(Debug, Clone, Copy)]
pub struct PairKernel<V> {
    /// `W'` (1/m^(d+1)); an exact zero outside the support.
    pub slope: V,
    /// Positive inside the support: proportional to `⟨2 − q⟩₊`.
    pub inside: V,
    /// Proportional to `⟨1 − q⟩₊`.
    pub core: V,
    /// `1/h_ij` (1/m), whatever if that is constant.
    pub inverse_h: V,
}

/// Source of `h_ij` for the lanes, and of all that follows from it.
pub trait PairScale: Copy + Sync {
    /// True if smoothing lengths differ.
    const VARIABLE: bool;
    /// True if neighbours are rings about an axis, of which pairs see [points](crate::arc).
    const RING: bool = false;

    /// `h_ij` (m) of receivers of `h_i` and neighbours of `h_j` (m).
    fn length<V: Lanes>(&self, h_i: V, h_j: V) -> V;

    /// For pairs at `distance` (m), with `1/h_ij` (1/m), whatever if that is constant.
    fn kernel<V: Lanes>(&self, distance: V, inverse_h: V) -> PairKernel<V>;

    /// `w = W h^d/σ_d` of these pairs.
    fn shape<V: Lanes>(&self, pairs: &PairKernel<V>) -> V;

    /// `W` of these pairs (1/m^d) from their [`Self::shape`].
    fn value<V: Lanes>(&self, pairs: &PairKernel<V>, shape: V) -> V;
}

/// `w = ¼⟨2 − q⟩₊³ − ⟨1 − q⟩₊³`.
#[inline(always)]
fn shape<V: Lanes>(outer: V, inner: V) -> V {
    let quarter = outer.mul(V::splat(0.25)).mul(outer);
    inner.mul(inner).neg_mul_add(inner, quarter.mul(outer))
}

/// One constant smoothing length for all pairs.
///
/// `W' = 3 f ⟨1 − q⟩₊² − ¾ f ⟨2 − q⟩₊²` with `f = σ_d/h^(d+1)`: both terms are squares of clamped
/// linear functions of the distance.
#[derive(Debug, Clone, Copy)]
pub struct ConstantScale {
    h: f64,
    /// `σ_d/h^d` (1/m^d).
    height: f64,
    inner: Ramp,
    outer: Ramp,
}

/// `⟨height − steepness r⟩₊`.
#[derive(Debug, Clone, Copy)]
struct Ramp {
    height: f64,
    steepness: f64,
}

impl Ramp {
    #[inline(always)]
    fn at<V: Lanes>(self, distance: V) -> V {
        distance
            .neg_mul_add(V::splat(self.steepness), V::splat(self.height))
            .max(V::splat(0.0))
    }
}

impl ConstantScale {
    /// For a smoothing length `h` (m).
    #[must_use]
    pub fn new(kernel: &Kernel, h: f64) -> Self {
        let factor = kernel.normalisation() / (kernel.power(h) * h);
        let ramp = |weight: f64, end: f64| {
            let root = (weight * factor).sqrt();
            Ramp {
                height: end * root,
                steepness: root / h,
            }
        };
        Self {
            h,
            height: factor * h,
            inner: ramp(3.0, 1.0),
            outer: ramp(0.75, 2.0),
        }
    }
}

impl PairScale for ConstantScale {
    const VARIABLE: bool = false;

    #[inline(always)]
    fn length<V: Lanes>(&self, _: V, _: V) -> V {
        V::splat(self.h)
    }

    #[inline(always)]
    fn kernel<V: Lanes>(&self, distance: V, inverse_h: V) -> PairKernel<V> {
        let (inner, outer) = (self.inner.at(distance), self.outer.at(distance));
        PairKernel {
            slope: outer.neg_mul_add(outer, inner.mul(inner)),
            inside: outer,
            core: inner,
            inverse_h,
        }
    }

    #[inline(always)]
    fn shape<V: Lanes>(&self, pairs: &PairKernel<V>) -> V {
        let outer = pairs.inside.mul(V::splat(2.0 / self.outer.height));
        shape(outer, pairs.core.mul(V::splat(1.0 / self.inner.height)))
    }

    #[inline(always)]
    fn value<V: Lanes>(&self, _: &PairKernel<V>, shape: V) -> V {
        shape.mul(V::splat(self.height))
    }
}

/// `h_ij = ½(h_i + h_j)`.
#[derive(Debug, Clone, Copy)]
pub struct MeanScale {
    normalisation: f64,
    dimension: usize,
}

impl MeanScale {
    /// For a kernel.
    #[must_use]
    pub fn new(kernel: &Kernel) -> Self {
        Self {
            normalisation: kernel.normalisation(),
            dimension: kernel.dimension(),
        }
    }

    /// `σ_d base/h^(d−1)` from `1/h` (1/m) and its square.
    #[inline(always)]
    fn height<V: Lanes>(&self, base: V, inverse: V, square: V) -> V {
        let power = match self.dimension {
            1 => V::splat(1.0),
            2 => inverse,
            _ => square,
        };
        base.mul(power).mul(V::splat(self.normalisation))
    }
}

impl PairScale for MeanScale {
    const VARIABLE: bool = true;

    #[inline(always)]
    fn length<V: Lanes>(&self, h_i: V, h_j: V) -> V {
        h_i.add(h_j).mul(V::splat(0.5))
    }

    #[inline(always)]
    fn kernel<V: Lanes>(&self, distance: V, inverse: V) -> PairKernel<V> {
        let square = inverse.mul(inverse);
        let zero = V::splat(0.0);
        let inner = distance.neg_mul_add(inverse, V::splat(1.0)).max(zero);
        let outer = distance.neg_mul_add(inverse, V::splat(2.0)).max(zero);
        let shape = outer
            .mul(V::splat(-0.75))
            .mul_add(outer, inner.mul(inner).mul(V::splat(3.0)));
        PairKernel {
            slope: shape.mul(self.height(square, inverse, square)),
            inside: outer,
            core: inner,
            inverse_h: inverse,
        }
    }

    #[inline(always)]
    fn shape<V: Lanes>(&self, pairs: &PairKernel<V>) -> V {
        shape(pairs.inside, pairs.core)
    }

    #[inline(always)]
    fn value<V: Lanes>(&self, pairs: &PairKernel<V>, shape: V) -> V {
        let inverse = pairs.inverse_h;
        shape.mul(self.height(inverse, inverse, inverse.mul(inverse)))
    }
}

/// `h_ij = ½(h_i + h_j)` between rings.
#[derive(Debug, Clone, Copy)]
pub struct RingScale(MeanScale);

impl RingScale {
    /// For a kernel.
    #[must_use]
    pub fn new(kernel: &Kernel) -> Self {
        Self(MeanScale::new(kernel))
    }
}

impl PairScale for RingScale {
    const VARIABLE: bool = true;
    const RING: bool = true;

    #[inline(always)]
    fn length<V: Lanes>(&self, h_i: V, h_j: V) -> V {
        self.0.length(h_i, h_j)
    }

    #[inline(always)]
    fn kernel<V: Lanes>(&self, distance: V, inverse_h: V) -> PairKernel<V> {
        self.0.kernel(distance, inverse_h)
    }

    #[inline(always)]
    fn shape<V: Lanes>(&self, pairs: &PairKernel<V>) -> V {
        self.0.shape(pairs)
    }

    #[inline(always)]
    fn value<V: Lanes>(&self, pairs: &PairKernel<V>, shape: V) -> V {
        self.0.value(pairs, shape)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integrates_to_one() {
        for d in 1..=3 {
            let kernel = Kernel::new(d);
            let n = 20_000;
            let sum: f64 = (0..n)
                .map(|k| {
                    let r = 2.0 * (f64::from(k) + 0.5) / f64::from(n);
                    let shell = match d {
                        1 => 2.0,
                        2 => 2.0 * PI * r,
                        _ => 4.0 * PI * r * r,
                    };
                    kernel.value(r, 1.0) * shell * 2.0 / f64::from(n)
                })
                .sum();
            assert!((sum - 1.0).abs() < 1e-7, "{d}: {sum}");
        }
    }

    #[test]
    fn ends_at_its_support() {
        for d in 1..=3 {
            let kernel = Kernel::new(d).of_length(0.5);
            let [inside, end] = [0.999, 1.0].map(|part| part * SUPPORT * 0.5);
            assert!(kernel.value(inside) > 0.0 && kernel.slope(inside) < 0.0);
            assert_eq!([kernel.value(end), kernel.slope(end)], [0.0; 2]);
        }
    }

    #[test]
    fn slope_and_curvature_are_the_derivatives() {
        for d in 1..=3 {
            let kernel = Kernel::new(d);
            for r in [0.1, 0.7, 1.2, 1.9, 2.4] {
                let (h, step) = (1.1, 1e-6);
                let slope = (kernel.value(r + step, h) - kernel.value(r - step, h)) / (2.0 * step);
                let curvature =
                    (kernel.slope(r + step, h) - kernel.slope(r - step, h)) / (2.0 * step);
                assert!((slope - kernel.slope(r, h)).abs() < 1e-8);
                assert!((curvature - kernel.of_length(h).curvature(r)).abs() < 1e-8);
            }
        }
    }
}
