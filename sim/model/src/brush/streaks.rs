//! Streaks: variation of the paint that bristles take up, so that no two loads paint the same stroke.
//!
//! A bristle's share is part its own (its place and kind, from the brush file), part random: patches of good and bad
//! contact with the heap, and single bristles. The seed is the painting's number of strokes.

use maulstick_brush::Head;
use maulstick_brush::head::disorder::{noise, unit};

/// Share of a bristle's own unevenness that is left beside the chance of a load.
const OWN: f32 = 0.6;
/// Width of random patches, as a share of half the head, and greatest variation of patches and of single bristles, as a
/// share of the mean.
const PATCH: f32 = 0.16;
const PATCHES: f32 = 1.0;
const SINGLE: f32 = 1.2;
/// The least and the most that a bristle takes of the mean.
const SHARE_RANGE: [f32; 2] = [0.08, 3.0];

/// Share of each strip over the mean of all, for the load with this seed: the head as a whole takes the same.
#[must_use]
pub fn streaks(head: &Head, seed: u64) -> Vec<f32> {
    let strips = head.roots().iter().zip(head.capacity());
    let taken = strips.enumerate().map(|(strip, (root, capacity))| {
        let own = 1.0 + OWN * (capacity - 1.0);
        let patch = noise(seed, [root[0] / PATCH, 0.5 * root[1] / PATCH]);
        let single = unit(seed, [strip as i64, i64::MIN]);
        let chance =
            PATCHES * (2.0 * patch - 1.0) + head.single_share() * SINGLE * (2.0 * single - 1.0);
        (own * (1.0 + chance)).clamp(SHARE_RANGE[0], SHARE_RANGE[1])
    });
    let mut taken: Vec<f32> = taken.collect();
    let mean = taken.iter().sum::<f32>() / taken.len() as f32;
    taken.iter_mut().for_each(|taken| *taken /= mean);
    taken
}

#[cfg(test)]
mod tests {
    use maulstick_brush::BrushFile;

    use super::*;

    #[test]
    fn each_load_is_its_own_and_all_are_as_large() {
        let file = BrushFile::library("flat").expect("flat");
        let mean = |of: &[f32]| of.iter().sum::<f32>() / of.len() as f32;
        for strips in [24, 1000] {
            let head = Head::of(&file.thinned_to(strips));
            assert!((1..9).all(|seed| (mean(&streaks(&head, seed)) - 1.0).abs() < 1e-5));
        }
        let head = Head::of(&file);
        let (one, again, other) = (streaks(&head, 5), streaks(&head, 5), streaks(&head, 6));
        assert_eq!(one, again);
        let off = |of: &[f32]| of.iter().map(|v| v - mean(of)).collect::<Vec<_>>();
        let (a, b) = (off(&one), off(&other));
        let dot = |a: &[f32], b: &[f32]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f32>();
        let correlation = dot(&a, &b) / (dot(&a, &a) * dot(&b, &b)).sqrt();
        assert!(correlation.abs() < 0.5, "{correlation}");
    }
}
