//! Streaks: how much paint each bristle takes up at a load, so that no two loads paint the same stroke.
//!
//! What a bristle takes is part its own (its place and kind, from the brush file), part chance of the load:
//! patches where the heap was touched well or not, and single bristles. The seed is the painting's number of
//! steps, which the journal has.

use maulstick_brush::Head;

/// Share of a bristle's own unevenness that is left beside the chance of a load.
const OWN: f32 = 0.35;
/// Chance of patches as wide as this share of half the head, and of single bristles: at most so much of the mean.
const PATCH: f32 = 0.16;
const PATCHES: f32 = 0.75;
const SINGLE: f32 = 0.35;
/// The least that a bristle takes of the mean.
const LEAST: f32 = 0.08;

/// What each strip takes up by the mean of all, for the load with this seed.
#[must_use]
pub fn streaks(head: &Head, seed: u64) -> Vec<f32> {
    let strips = head.roots().iter().zip(head.capacity());
    let taken = strips.enumerate().map(|(strip, (root, capacity))| {
        let own = 1.0 + OWN * (capacity - 1.0);
        let patch = noise(seed, [root[0] / PATCH, 0.5 * root[1] / PATCH]);
        let single = unit(seed, [strip as i64, i64::MIN]);
        let chance = PATCHES * (2.0 * patch - 1.0) + SINGLE * (2.0 * single - 1.0);
        (own * (1.0 + chance)).max(LEAST)
    });
    taken.collect()
}

/// Smooth noise on a lattice of side 1, 0 to 1.
fn noise(seed: u64, [x, y]: [f32; 2]) -> f32 {
    let (i, j) = (x.floor(), y.floor());
    let ease = |t: f32| t * t * (3.0 - 2.0 * t);
    let (u, v) = (ease(x - i), ease(y - j));
    let corner = |di: i64, dj: i64| unit(seed, [i as i64 + di, j as i64 + dj]);
    let row = |dj: i64| corner(0, dj) + (corner(1, dj) - corner(0, dj)) * u;
    row(0) + (row(1) - row(0)) * v
}

/// A number in 0 to 1 of a place (finaliser of Murmur 3, Appleby).
fn unit(seed: u64, place: [i64; 2]) -> f32 {
    let mut h = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x2545_f491_4f6c_dd1d;
    for v in place {
        h = (h ^ v as u64).wrapping_mul(0xff51_afd7_ed55_8ccd);
        h ^= h >> 33;
        h = h.wrapping_mul(0xc4ce_b9fe_1a85_ec53);
        h ^= h >> 33;
    }
    (h >> 40) as f32 / 16_777_216.0
}

#[cfg(test)]
mod tests {
    use maulstick_brush::BrushFile;

    use super::*;

    #[test]
    fn each_load_is_its_own_and_their_means_agree() {
        let head = Head::of(&BrushFile::library("flat").expect("flat"));
        let mean = |of: &[f32]| of.iter().sum::<f32>() / of.len() as f32;
        let (one, again, other) = (streaks(&head, 5), streaks(&head, 5), streaks(&head, 6));
        assert_eq!(one, again);
        assert!((mean(&one) / mean(&other) - 1.0).abs() < 0.25);
        let off = |of: &[f32]| of.iter().map(|v| v - mean(of)).collect::<Vec<_>>();
        let (a, b) = (off(&one), off(&other));
        let dot = |a: &[f32], b: &[f32]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f32>();
        let correlation = dot(&a, &b) / (dot(&a, &a) * dot(&b, &b)).sqrt();
        assert!(correlation.abs() < 0.5, "{correlation}");
    }
}
