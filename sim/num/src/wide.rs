//! Loops over planes, compiled for the processor's wide registers where it has them.
//!
//! The compiler does not fuse a multiplication with an addition, even where the processor could, so each number is
//! added, multiplied and rounded alike in all registers, and all give the same bytes.

/// Registers that loops are compiled for, the narrowest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum Registers {
    /// The target's baseline: SSE2 on x86-64.
    Baseline,
    /// AVX2.
    Avx2,
    /// AVX-512: F, VL, BW and DQ.
    Avx512,
}

/// The widest registers that a test lets loops use, as a number.
#[cfg(test)]
static WIDEST: std::sync::atomic::AtomicU8 =
    std::sync::atomic::AtomicU8::new(Registers::Avx512 as u8);

impl Registers {
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
        Self::Baseline
    }

    /// The widest that loops run in.
    #[must_use]
    #[inline]
    pub fn in_use() -> Self {
        #[cfg(test)]
        match WIDEST.load(std::sync::atomic::Ordering::Relaxed) {
            0 => return Self::Baseline,
            1 => return Self::Avx2.min(Self::of_processor()),
            _ => {}
        }
        Self::of_processor()
    }
}

/// Compiles a function for each of the [`Registers`], and calls it for those in use. Its callees must be
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
                    $crate::wide::Registers::Baseline => {}
                }
            }
            each$($plain)*($($argument),*);
        }
    };
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::Ordering::Relaxed;

    use super::{Registers, WIDEST};

    wide! {
        fn polynomial(plane: &mut [f32]) {
            for x in plane {
                *x = (*x * 1.000_123 + 0.1) * *x - 0.7 / (*x + 2.0);
            }
        }
    }

    /// The same with the first sum rounded once, as a fused multiply-add would.
    fn fused(plane: &mut [f32]) {
        for x in plane {
            let sum = (f64::from(*x) * f64::from(1.000_123_f32) + f64::from(0.1_f32)) as f32;
            *x = sum * *x - 0.7 / (*x + 2.0);
        }
    }

    /// The limit is the whole program's, so all of it is in one test.
    #[test]
    fn all_registers_give_the_same_bytes() {
        let plane: Vec<f32> = (0..1003).map(|i| i as f32 * 0.37).collect();
        let all = [Registers::Baseline, Registers::Avx2, Registers::Avx512];
        let after = all.map(|registers| {
            WIDEST.store(registers as u8, Relaxed);
            let used = registers.min(Registers::of_processor());
            assert_eq!(Registers::in_use(), used);
            let mut plane = plane.clone();
            polynomial(&mut plane);
            plane
        });
        assert!(after.iter().all(|plane| *plane == after[0]));
        let mut faulty = plane;
        fused(&mut faulty);
        assert_ne!(faulty, after[0], "a fused sum would be seen");
    }
}
