//! Eight numbers at a time: in one register with AVX2 or AVX-512, otherwise by the `wide` crate. Both round alike.

use std::ops::{Add, Div, Mul, Sub};

use wide::f32x8;

/// Eight numbers.
pub trait Lanes:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// The same eight times.
    fn splat(value: f32) -> Self;
    /// Lanes with the values of an array.
    fn of(values: &[f32; 8]) -> Self;
    /// Values of the lanes, as an array.
    fn values(self) -> [f32; 8];
    /// Without their signs.
    fn abs(self) -> Self;
    /// The largest whole number that is not above.
    fn floor(self) -> Self;
    /// The smaller of each two; none of them is NaN.
    fn least(self, other: Self) -> Self;
    /// The larger of each two; none of them is NaN.
    fn most(self, other: Self) -> Self;
    /// A mask of where these are less.
    fn less(self, other: Self) -> Self;
    /// As a mask: `one` where set, otherwise `other`.
    fn choose(self, one: Self, other: Self) -> Self;
    /// As a mask: true if any is set.
    fn any(self) -> bool;
}

impl Lanes for f32x8 {
    #[inline(always)]
    fn splat(value: f32) -> Self {
        Self::splat(value)
    }

    #[inline(always)]
    fn of(values: &[f32; 8]) -> Self {
        Self::from(*values)
    }

    #[inline(always)]
    fn values(self) -> [f32; 8] {
        self.to_array()
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self::abs(self)
    }

    #[inline(always)]
    fn floor(self) -> Self {
        Self::floor(self)
    }

    #[inline(always)]
    fn least(self, other: Self) -> Self {
        self.fast_min(other)
    }

    #[inline(always)]
    fn most(self, other: Self) -> Self {
        self.fast_max(other)
    }

    #[inline(always)]
    fn less(self, other: Self) -> Self {
        self.simd_lt(other)
    }

    #[inline(always)]
    fn choose(self, one: Self, other: Self) -> Self {
        self.select(one, other)
    }

    #[inline(always)]
    fn any(self) -> bool {
        Self::any(self)
    }
}

/// Eight of a plane from `start` on; all of a plane of fewer, in turn.
#[inline(always)]
#[must_use]
pub fn run<L: Lanes>(plane: &[f32], start: usize) -> L {
    match plane[start..].first_chunk() {
        Some(run) => L::of(run),
        None => L::of(&std::array::from_fn(|i| plane[i % plane.len()])),
    }
}

#[cfg(target_arch = "x86_64")]
mod avx {
    use std::arch::x86_64::*;
    use std::ops::{Add, Div, Mul, Sub};

    use super::Lanes;

    /// Eight numbers in an AVX2 register, which all processors with AVX-512 have too; only [`wide!`](crate::wide!) uses
    /// it, in code for such processors.
    #[doc(hidden)]
    #[derive(Clone, Copy, Debug)]
    pub struct Avx(__m256);

    /// An operation of AVX2.
    macro_rules! avx {
        ($operation:expr) => {{
            #[allow(unsafe_code, reason = "the processor has AVX2 where there is an `Avx`")]
            // SAFETY: `Avx` is named alone in code that runs after AVX2 was detected.
            unsafe {
                $operation
            }
        }};
    }

    impl Add for Avx {
        type Output = Self;

        #[inline(always)]
        fn add(self, other: Self) -> Self {
            Self(avx!(_mm256_add_ps(self.0, other.0)))
        }
    }

    impl Sub for Avx {
        type Output = Self;

        #[inline(always)]
        fn sub(self, other: Self) -> Self {
            Self(avx!(_mm256_sub_ps(self.0, other.0)))
        }
    }

    impl Mul for Avx {
        type Output = Self;

        #[inline(always)]
        fn mul(self, other: Self) -> Self {
            Self(avx!(_mm256_mul_ps(self.0, other.0)))
        }
    }

    impl Div for Avx {
        type Output = Self;

        #[inline(always)]
        fn div(self, other: Self) -> Self {
            Self(avx!(_mm256_div_ps(self.0, other.0)))
        }
    }

    impl Lanes for Avx {
        #[inline(always)]
        fn splat(value: f32) -> Self {
            Self(avx!(_mm256_set1_ps(value)))
        }

        #[inline(always)]
        fn of(values: &[f32; 8]) -> Self {
            Self(avx!(_mm256_loadu_ps(values.as_ptr())))
        }

        #[inline(always)]
        fn values(self) -> [f32; 8] {
            bytemuck::cast(self.0)
        }

        #[inline(always)]
        fn abs(self) -> Self {
            Self(avx!(_mm256_andnot_ps(_mm256_set1_ps(-0.0), self.0)))
        }

        #[inline(always)]
        fn floor(self) -> Self {
            Self(avx!(_mm256_floor_ps(self.0)))
        }

        #[inline(always)]
        fn least(self, other: Self) -> Self {
            Self(avx!(_mm256_min_ps(self.0, other.0)))
        }

        #[inline(always)]
        fn most(self, other: Self) -> Self {
            Self(avx!(_mm256_max_ps(self.0, other.0)))
        }

        #[inline(always)]
        fn less(self, other: Self) -> Self {
            Self(avx!(_mm256_cmp_ps::<_CMP_LT_OQ>(self.0, other.0)))
        }

        #[inline(always)]
        fn choose(self, one: Self, other: Self) -> Self {
            Self(avx!(_mm256_blendv_ps(other.0, one.0, self.0)))
        }

        #[inline(always)]
        fn any(self) -> bool {
            avx!(_mm256_movemask_ps(self.0)) != 0
        }
    }
}

#[cfg(target_arch = "x86_64")]
pub use avx::Avx;
/// Eight numbers at a time without AVX2.
pub type Plain = f32x8;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wide::Registers;

    fn all<L: Lanes>(a: &[f32; 8], b: &[f32; 8]) -> ([[u32; 8]; 9], [bool; 2]) {
        let (x, y) = (L::of(a), L::of(b));
        let results = [
            x + y,
            x - y,
            x * y,
            x / y,
            x.abs(),
            x.floor(),
            x.least(y),
            x.most(y),
            x.less(y).choose(x, L::splat(0.5)),
        ];
        let any = [x.less(y).any(), x.less(x).any()];
        (results.map(|lanes| lanes.values().map(f32::to_bits)), any)
    }

    #[test]
    fn both_kinds_give_the_same_bits() {
        #[cfg(target_arch = "x86_64")]
        for case in 0..200u32 {
            let number = |i: usize, by: u32| {
                let mixed = (case * 8 + i as u32)
                    .wrapping_mul(2_654_435_761)
                    .rotate_left(by);
                (mixed as f32 / 1e9 - 2.0) * 10f32.powi((mixed % 7) as i32 - 3)
            };
            let a: [f32; 8] = std::array::from_fn(|i| number(i, 3));
            let b: [f32; 8] = std::array::from_fn(|i| if i == 3 { a[3] } else { number(i, 17) });
            if Registers::of_processor() >= Registers::Avx2 {
                assert_eq!(all::<Avx>(&a, &b), all::<Plain>(&a, &b));
            }
        }
    }
}
