//! Sums over fields. Every sum consists of 16 partial sums of f64, each of a few numbers in f32, in a fixed order, so
//! all registers give the same bytes. Parts of [stretches](Runs) are added up in their order, so the number of threads
//! does not matter.

use maulstick_num::wide;

use crate::runs::Runs;

/// Number of partial sums.
const PARTS: usize = 16;
/// Number of products added up in f32, by eights, before they are in f64.
const BLOCK: usize = 8 * PARTS;

/// An unfinished sum.
pub(crate) type Sum = [f64; PARTS];

wide! {
    pub(crate) fn add_products(sums: &mut Sum, a: &[f32], b: &[f32]) {
        let mut whole = *sums;
        for (a, b) in a.chunks(BLOCK).zip(b.chunks(BLOCK)) {
            let (a, a_rest) = a.as_chunks::<PARTS>();
            let (b, b_rest) = b.as_chunks::<PARTS>();
            let mut few = [0.0; PARTS];
            for (a, b) in a.iter().zip(b) {
                for part in 0..PARTS {
                    few[part] += a[part] * b[part];
                }
            }
            for (part, (a, b)) in a_rest.iter().zip(b_rest).enumerate() {
                few[part] += a * b;
            }
            for part in 0..PARTS {
                whole[part] += f64::from(few[part]);
            }
        }
        *sums = whole;
    }
}

wide! {
    /// Adds a multiple of a field.
    pub fn add_scaled(into: &mut [f32], by: f32, other: &[f32]) {
        let other = &other[..into.len()];
        for i in 0..into.len() {
            into[i] += by * other[i];
        }
    }
}

wide! {
    /// Multiplies by a number and adds a field.
    pub fn scale_and_add(into: &mut [f32], by: f32, other: &[f32]) {
        let other = &other[..into.len()];
        for i in 0..into.len() {
            into[i] = by * into[i] + other[i];
        }
    }
}

/// Scalar product within stretches.
#[must_use]
pub fn dot_in(runs: &Runs, a: &[f32], b: &[f32]) -> f64 {
    let [sum] = runs.sum(|runs| {
        let mut sums = [0.0; PARTS];
        for run in runs {
            add_products(&mut sums, &a[run.clone()], &b[run.clone()]);
        }
        [sums.iter().sum()]
    });
    sum
}
