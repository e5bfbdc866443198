//! Loops over planes, compiled for the processor's wide registers where it has them.
//!
//! The compiler fuses no multiplication with an addition that is written beside it, even where the processor could, so
//! each number is added, multiplied and rounded alike in all registers, and all give the same bytes.

use std::sync::atomic::{AtomicU8, Ordering::Relaxed};

/// Registers that loops are compiled for, the narrowest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum Registers {
    /// Those that each processor of its kind has.
    Least,
    /// AVX2.
    Avx2,
    /// AVX-512: F, VL, BW and DQ.
    Avx512,
}

/// The widest registers in use, as a number.
static WIDEST: AtomicU8 = AtomicU8::new(Registers::Avx512 as u8);

impl Registers {
    /// All of them, the narrowest first.
    pub const ALL: [Self; 3] = [Self::Least, Self::Avx2, Self::Avx512];

    /// The widest that the processor has.
    #[must_use]
    #[inline]
    pub fn of_processor() -> Self {
        #[cfg(target_arch = "x86_64")]
        {
            use std::arch::is_x86_feature_detected as has;
            if has!("avx512f") && has!("avx512vl") && has!("avx512bw") && has!("avx512dq") {
                return Self::Avx512;
            }
            if has!("avx2") {
                return Self::Avx2;
            }
        }
        Self::Least
    }

    /// The widest that loops run in: the processor's, or those that [`limit_to`](Self::limit_to) has set.
    #[must_use]
    #[inline]
    pub fn in_use() -> Self {
        let widest = match WIDEST.load(Relaxed) {
            0 => Self::Least,
            1 => Self::Avx2,
            _ => Self::Avx512,
        };
        widest.min(Self::of_processor())
    }

    /// Lets all loops of the program run in no wider registers from now on, to compare them.
    pub fn limit_to(self) {
        WIDEST.store(self as u8, Relaxed);
    }
}

/// Compiles a function for each of the [`Registers`], and calls it for those in use. What it calls must be
/// `#[inline(always)]` to gain from it.
#[macro_export]
macro_rules! wide {
    // With a parameter for the [lanes](crate::lanes) of what it is compiled for.
    ($(#[$meta:meta])* $visible:vis fn $name:ident<$lanes:ident>($($argument:ident: $type:ty),* $(,)?) $body:block) => {
        $crate::wide! {
            @ [$(#[$meta])* $visible] $name [$lanes: $crate::lanes::Lanes]
            [::<$crate::lanes::Plain>] [::<$crate::lanes::Avx>] ($($argument: $type),*) $body
        }
    };
    ($(#[$meta:meta])* $visible:vis fn $name:ident($($argument:ident: $type:ty),* $(,)?) $body:block) => {
        $crate::wide! { @ [$(#[$meta])* $visible] $name [] [] [] ($($argument: $type),*) $body }
    };
    (@ [$($head:tt)*] $name:ident [$($lanes:tt)*] [$($plain:tt)*] [$($avx:tt)*]
        ($($argument:ident: $type:ty),*) $body:block) => {
        $($head)* fn $name($($argument: $type),*) {
            #[inline(always)]
            fn each<$($lanes)*>($($argument: $type),*) $body

            #[cfg(target_arch = "x86_64")]
            {
                #[target_feature(enable = "avx2")]
                fn avx2($($argument: $type),*) {
                    each$($avx)*($($argument),*);
                }
                #[target_feature(enable = "avx512f,avx512vl,avx512bw,avx512dq")]
                fn avx512($($argument: $type),*) {
                    each$($avx)*($($argument),*);
                }
                #[allow(unsafe_code, reason = "the processor has what they are compiled for")]
                match $crate::wide::Registers::in_use() {
                    // SAFETY: registers in use are at most the processor's.
                    $crate::wide::Registers::Avx512 => return unsafe { avx512($($argument),*) },
                    // SAFETY: as above.
                    $crate::wide::Registers::Avx2 => return unsafe { avx2($($argument),*) },
                    $crate::wide::Registers::Least => {}
                }
            }
            each$($plain)*($($argument),*);
        }
    };
}

#[cfg(test)]
mod tests {
    use super::Registers;

    wide! {
        fn polynomial(plane: &mut [f32]) {
            for x in plane {
                *x = (*x * 1.000_123 + 0.1) * *x - 0.7 / (*x + 2.0);
            }
        }
    }

    /// The limit is the whole program's, so all of it is in one test.
    #[test]
    fn all_registers_give_the_same_bytes() {
        let before: Vec<f32> = (0..1003).map(|i| i as f32 * 0.37).collect();
        let after = Registers::ALL.map(|registers| {
            registers.limit_to();
            assert_eq!(
                Registers::in_use(),
                registers.min(Registers::of_processor())
            );
            let mut plane = before.clone();
            polynomial(&mut plane);
            plane
        });
        assert!(after.iter().all(|plane| *plane == after[0]));
        assert_ne!(after[0], before);
    }
}
