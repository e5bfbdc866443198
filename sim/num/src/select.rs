//! The larger and the smaller of two numbers, for loops over planes: one instruction of a wide register each, where
//! `max` and `min` also test for NaN.

/// The larger of two numbers; the second one where either is no number.
#[must_use]
#[inline(always)]
pub fn larger<T: PartialOrd>(a: T, b: T) -> T {
    if a > b { a } else { b }
}

/// The smaller of two numbers; the second one where either is no number.
#[must_use]
#[inline(always)]
pub fn smaller<T: PartialOrd>(a: T, b: T) -> T {
    if a < b { a } else { b }
}
