//! Sums over fields. Every sum is of 8 partial sums of f64 in a fixed order, so all registers give the same bytes.

use maulstick_num::wide;

/// Partial sums.
const PARTS: usize = 8;

wide! {
    fn add_products(sums: &mut [f64; PARTS], a: &[f32], b: &[f32]) {
        let (a, a_rest) = a.as_chunks::<PARTS>();
        let (b, b_rest) = b.as_chunks::<PARTS>();
        let mut local = *sums;
        for (a, b) in a.iter().zip(b) {
            for part in 0..PARTS {
                local[part] += f64::from(a[part]) * f64::from(b[part]);
            }
        }
        for (part, (a, b)) in a_rest.iter().zip(b_rest).enumerate() {
            local[part] += f64::from(*a) * f64::from(*b);
        }
        *sums = local;
    }
}

wide! {
    /// Adds a multiple of a field.
    pub fn add_scaled(into: &mut [f32], by: f32, other: &[f32]) {
        for (into, other) in into.iter_mut().zip(other) {
            *into += by * *other;
        }
    }
}

wide! {
    /// Multiplies by a number and adds a field.
    pub fn scale_and_add(into: &mut [f32], by: f32, other: &[f32]) {
        for (into, other) in into.iter_mut().zip(other) {
            *into = by * *into + *other;
        }
    }
}

/// Scalar product.
#[must_use]
pub fn dot(a: &[f32], b: &[f32]) -> f64 {
    let mut sums = [0.0; PARTS];
    add_products(&mut sums, a, b);
    sums.iter().sum()
}

/// Euclidean norm.
#[must_use]
pub fn norm(a: &[f32]) -> f64 {
    dot(a, a).sqrt()
}
