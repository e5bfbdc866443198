//! Loops over planes, compiled for the processor's wide registers where it has them.
//!
//! AVX2 and AVX-512 add, multiply and round each number as SSE2 does, and nothing here enables fused
//! multiply-add, so all ways give the same bytes.

/// Compiles a function for AVX-512, for AVX2 and without, and calls what the processor has. What it calls
/// must be `#[inline(always)]` to gain from it.
#[macro_export]
macro_rules! wide {
    // With a parameter for the [lanes](crate::lanes) of what it is compiled for.
    ($(#[$meta:meta])* $visible:vis fn $name:ident<$lanes:ident>($($argument:ident: $type:ty),* $(,)?) $body:block) => {
        $(#[$meta])*
        $visible fn $name($($argument: $type),*) {
            #[inline(always)]
            fn narrow<$lanes: $crate::lanes::Lanes>($($argument: $type),*) $body

            #[cfg(target_arch = "x86_64")]
            {
                #[target_feature(enable = "avx2")]
                fn wide($($argument: $type),*) {
                    narrow::<$crate::lanes::Avx>($($argument),*);
                }
                #[target_feature(enable = "avx512f,avx512vl,avx512bw,avx512dq")]
                fn widest($($argument: $type),*) {
                    narrow::<$crate::lanes::Avx>($($argument),*);
                }
                if std::arch::is_x86_feature_detected!("avx512f")
                    && std::arch::is_x86_feature_detected!("avx512vl")
                    && std::arch::is_x86_feature_detected!("avx512bw")
                    && std::arch::is_x86_feature_detected!("avx512dq")
                {
                    #[allow(unsafe_code, reason = "the processor has what `widest` is compiled for")]
                    // SAFETY: its sets of AVX-512 were detected on the lines above.
                    unsafe {
                        widest($($argument),*);
                    }
                    return;
                }
                if std::arch::is_x86_feature_detected!("avx2") {
                    #[allow(unsafe_code, reason = "the processor has what `wide` is compiled for")]
                    // SAFETY: AVX2 was detected on the line above.
                    unsafe {
                        wide($($argument),*);
                    }
                    return;
                }
            }
            narrow::<$crate::lanes::Plain>($($argument),*);
        }
    };
    ($(#[$meta:meta])* $visible:vis fn $name:ident($($argument:ident: $type:ty),* $(,)?) $body:block) => {
        $(#[$meta])*
        $visible fn $name($($argument: $type),*) {
            #[inline(always)]
            fn narrow($($argument: $type),*) $body

            #[cfg(target_arch = "x86_64")]
            {
                #[target_feature(enable = "avx2")]
                fn wide($($argument: $type),*) {
                    narrow($($argument),*);
                }
                #[target_feature(enable = "avx512f,avx512vl,avx512bw,avx512dq")]
                fn widest($($argument: $type),*) {
                    narrow($($argument),*);
                }
                if std::arch::is_x86_feature_detected!("avx512f")
                    && std::arch::is_x86_feature_detected!("avx512vl")
                    && std::arch::is_x86_feature_detected!("avx512bw")
                    && std::arch::is_x86_feature_detected!("avx512dq")
                {
                    #[allow(unsafe_code, reason = "the processor has what `widest` is compiled for")]
                    // SAFETY: its sets of AVX-512 were detected on the lines above.
                    unsafe {
                        widest($($argument),*);
                    }
                    return;
                }
                if std::arch::is_x86_feature_detected!("avx2") {
                    #[allow(unsafe_code, reason = "the processor has what `wide` is compiled for")]
                    // SAFETY: AVX2 was detected on the line above.
                    unsafe {
                        wide($($argument),*);
                    }
                    return;
                }
            }
            narrow($($argument),*);
        }
    };
}

#[cfg(test)]
mod tests {
    #[inline(always)]
    fn polynomial(plane: &mut [f32]) {
        for x in plane {
            *x = (*x * 1.000_123 + 0.1) * *x - 0.7 / (*x + 2.0);
        }
    }

    wide! {
        fn wide_polynomial(plane: &mut [f32]) {
            polynomial(plane);
        }
    }

    #[test]
    fn both_ways_give_the_same_bytes() {
        let before: Vec<f32> = (0..1003).map(|i| i as f32 * 0.37).collect();
        let (mut one, mut two) = (before.clone(), before);
        polynomial(&mut one);
        wide_polynomial(&mut two);
        assert_eq!(one, two);
    }
}
