//! Volumes below a unit: the rounding error of one cell and step is compensated at those beside and after it.
//!
//! Thresholds are an additive recurrence with the powers of the plastic number over the surface, and with the golden
//! ratio over the steps (M. Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018). The error of n
//! rounded volumes stays near a unit, as with error diffusion, and no cell waits for another.

/// Increments of the recurrence across, up and from step to step.
const STRIDES: [f64; 3] = [
    0.754_877_666_246_692_7,
    0.569_840_290_998_053_2,
    0.618_033_988_749_894_9,
];
/// Odd factor that spreads seeds (Weyl; 2⁶⁴ divided by the golden ratio).
const SPREAD: u64 = 0x9e37_79b9_7f4a_7c15;

/// Thresholds of one blend: 0 ≤ θ < 1.
#[derive(Clone, Copy, Debug)]
pub struct Dither {
    start: f64,
}

impl Dither {
    /// Increase of a threshold from a cell to the next on its right.
    pub const ACROSS: f32 = STRIDES[0] as f32;

    /// Thresholds of the blend of this number with this seed.
    #[must_use]
    pub fn new(seed: u64, blend: u64) -> Self {
        let seeded = (seed.wrapping_add(1).wrapping_mul(SPREAD) >> 11) as f64 / (1u64 << 53) as f64;
        Self {
            start: seeded + fraction(blend as f64 * STRIDES[2]),
        }
    }

    /// Increases of a threshold across and up, in parts of 2⁻⁶⁴ of a turn.
    #[must_use]
    pub fn increases() -> [u64; 2] {
        [0, 1].map(|axis| (STRIDES[axis] * 18_446_744_073_709_551_616.0) as u64)
    }

    /// Threshold of a cell of the surface in parts of 2⁻³² of a turn, for devices without f64.
    #[must_use]
    pub fn parts_at(&self, cell: [i64; 2]) -> u32 {
        (fraction(self.sum(cell)) * 4_294_967_296.0) as u32
    }

    /// Thresholds of a cell and of those on its right.
    #[must_use]
    pub fn along<const N: usize>(&self, [x, y]: [i64; 2]) -> [f32; N] {
        std::array::from_fn(|right| self.at([x + right as i64, y]))
    }

    /// Threshold of a cell of the surface.
    #[must_use]
    pub fn at(&self, cell: [i64; 2]) -> f32 {
        below_one(fraction(self.sum(cell)))
    }

    fn sum(&self, [x, y]: [i64; 2]) -> f64 {
        self.start + x as f64 * STRIDES[0] + y as f64 * STRIDES[1]
    }
}

/// `value − ⌊value⌋` without `floor`, which is a call where the target lacks the instruction.
fn fraction(value: f64) -> f64 {
    let whole = value as i64 as f64;
    let rest = value - whole;
    if rest < 0.0 { rest + 1.0 } else { rest }
}

fn below_one(value: f64) -> f32 {
    (value as f32).min(1.0 - f32::EPSILON)
}

/// Whole units of a volume in units.
#[must_use]
pub(crate) fn whole(units: f32, threshold: f32) -> f32 {
    (units + threshold).floor()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Units of `volume` over a run of cells and of steps, by `threshold`.
    fn sums(volume: f32, threshold: impl Fn(u64, i64) -> f32) -> [f64; 2] {
        let sum = |thresholds: Vec<f32>| -> f64 {
            let units = thresholds
                .into_iter()
                .map(|theta| f64::from(whole(volume, theta)));
            units.sum()
        };
        let along = sum((0..1000).map(|x| threshold(3, x)).collect());
        let after = sum((0..1000).map(|step| threshold(step, 17)).collect());
        [along, after]
    }

    #[test]
    fn small_volumes_add_up_over_cells_and_steps() {
        for volume in [0.003f32, 0.1, 0.37, 0.5, 1.7, 12.25] {
            let sums = sums(volume, |step, x| Dither::new(5, step).at([x, 40]));
            let expected = 1000.0 * f64::from(volume);
            println!("{volume}: {sums:?}, expected {expected}");
            for sum in sums {
                assert!((sum - expected).abs() < 4.0, "{sum} of {expected}");
            }
        }
        let truncated = sums(0.37, |_, _| 0.0);
        assert!(
            truncated.iter().all(|sum| *sum == 0.0),
            "a fault would pass"
        );
    }

    #[test]
    fn thresholds_have_a_seed_and_are_below_one() {
        let at = |seed, x| Dither::new(seed, 9).at([x, -3]);
        assert!((0..200).all(|x| at(1, x) >= 0.0 && at(1, x) < 1.0));
        assert!((0..20).any(|x| at(1, x) != at(2, x)));
    }
}
