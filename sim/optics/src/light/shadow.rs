//! Soft shadows of a relief: the visible share of the lamp over the cells toward it.
//!
//! From a cell at height h₀, a point of the relief h at the distance s toward the lamp stands, in the
//! plane of both, at an angle α above the middle of the lamp; with l = (c, l_z) there,
//!
//! ```text
//! tan α = ((h − h₀)·c − s·l_z)/(s·c + (h − h₀)·l_z)
//! V     = u²·(3 − 2u),  u = ½ − ½·clamp(max tan α/w, −1, 1)
//! ```
//!
//! w, the softness, is the tangent of half the angle under which the lamp is seen; u is the visible height of its disc
//! over the horizon, and V the visible share of its area, to .01. So a shadow is sharp at the foot of its object and
//! soft far from it. A lamp never reaches below the horizon of a flat surface, where V is exactly 1.
//!
//! The path to the lamp is sampled at the lines of the grid that it crosses, to [`REACH_M`] or [`REACH`] cells, and
//! heights are interpolated between the two cells of each. Beyond [`TAPS`] lines, the last strides span two lines and
//! use the mean of both: leaving lines out would miss ridges of one cell at every other distance, which shows as
//! stripes. Toward the end of the path the lamp is gradually raised, so that a shadow too long for the reach fades out.

use super::{HeightField, Lamp};

/// Number of samples toward the lamp.
pub const TAPS: usize = 16;
/// The farthest, m: four times the height of the thickest impasto.
pub const REACH_M: f64 = 4e-3;
/// Greatest distance, cells along the axis nearest to the path.
pub const REACH: u32 = 24;
/// Share of the path over which shadows fade.
const FADING: f64 = 0.375;
/// Least softness of a lamp.
const LEAST_SOFTNESS: f64 = 1e-3;
/// Least denominator of tan α: an obstacle at a right angle to the lamp or lower hides nothing.
pub const LEAST_DENOMINATOR: f32 = 1e-6;

/// A place on the path to the lamp, relative to a cell.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tap {
    /// The two cells that it lies between: columns and rows.
    pub cells: [[i32; 2]; 2],
    /// Share of the second one.
    pub weight: f32,
    /// s·c and s·l_z, in cells.
    pub run: [f32; 2],
}

/// Direction and length of a lamp's shadows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shadows {
    /// Samples of the path, from the nearest place.
    pub taps: [Tap; TAPS],
    /// c and l_z.
    pub toward: [f32; 2],
    /// Cells that a metre of relief is high: ρ over the side of a cell.
    pub rise: f32,
    /// 1/w.
    pub sharpness: f32,
}

impl Shadows {
    /// Shadows over cells of side `cell_m`.
    #[must_use]
    pub fn new(lamp: &Lamp, cell_m: f32) -> Self {
        let [x, y, z] = lamp.toward.map(f64::from);
        let across = (x * x + y * y).sqrt();
        // Above the middle any direction will do.
        let [x, y] = if across > 1e-6 {
            [x / across, y / across]
        } else {
            [1.0, 0.0]
        };
        let major = x.abs().max(y.abs());
        let lines = (REACH_M / f64::from(cell_m)).round();
        let lines = lines.clamp(TAPS as f64, f64::from(REACH)) as usize;
        let single = 2 * TAPS - lines;
        let tap = |k: usize| {
            // Lines and strides of two lines: a stride is the mean of two lines, or of two cells of one.
            let double = k >= single;
            let first = if double { single + 2 * (k - single) } else { k } + 1;
            let far = first as f64 + if double { 0.5 } else { 0.0 };
            let faded = (far / lines as f64 - (1.0 - FADING)).max(0.0) / FADING;
            // Rounding above a whole number would reach one cell farther.
            let exactly = |v: f64| (v * 1e6).round() * 1e-6;
            let crossed = |line: usize| [x, y].map(|v| exactly(v / major * line as f64));
            let [low, high, weight] = if double {
                let [near, next] = [first, first + 1].map(|line| crossed(line).map(f64::round));
                [near, next, [0.5; 2]]
            } else {
                let at = crossed(first);
                let minor = usize::from(x.abs() >= y.abs());
                let (mut low, mut high) = (at.map(f64::round), at.map(f64::round));
                (low[minor], high[minor]) = (at[minor].floor(), at[minor].ceil());
                [low, high, [at[minor] - at[minor].floor(); 2]]
            };
            let s = far / major;
            Tap {
                cells: [low, high].map(|cell| cell.map(|v| v as i32)),
                weight: weight[0] as f32,
                run: [(s * across) as f32, (s * (z + faded)) as f32],
            }
        };
        Self {
            taps: std::array::from_fn(tap),
            toward: [across as f32, z as f32],
            rise: lamp.relief / cell_m,
            sharpness: (1.0 / f64::from(lamp.softness).max(LEAST_SOFTNESS)) as f32,
        }
    }

    /// Reach of a changed cell's shadow, cells: columns and rows to the lower and to
    /// the higher side.
    #[must_use]
    pub fn reach(&self) -> [[u32; 2]; 2] {
        let mut reach = [[0; 2]; 2];
        for cell in self.taps.iter().flat_map(|tap| &tap.cells) {
            for axis in 0..2 {
                let side = usize::from(cell[axis] < 0);
                reach[side][axis] = reach[side][axis].max(cell[axis].unsigned_abs());
            }
        }
        reach
    }

    /// V of the cells of row `y` from column `x` on, as many as `seen` takes. Beyond the border the
    /// relief continues at the border's height.
    pub fn row(&self, field: &HeightField<'_>, [x, y]: [usize; 2], seen: &mut [f32]) {
        let width = field.cells[0];
        let row = |dy: i32| field.row(y as i64 + i64::from(dy));
        let own = &row(0)[x..][..seen.len()];
        seen.fill(-1.0);
        for tap in &self.taps {
            let [low, high] = tap
                .cells
                .map(|[dx, dy]| (row(dy), x as i64 + i64::from(dx)));
            let inside = |at: i64| at >= 0 && at as usize + seen.len() <= width;
            if inside(low.1) && inside(high.1) {
                let low = &low.0[low.1 as usize..][..seen.len()];
                let high = &high.0[high.1 as usize..][..seen.len()];
                for (((least, own), low), high) in seen.iter_mut().zip(own).zip(low).zip(high) {
                    *least = least.max(self.horizon(tap, *own, *low, *high));
                }
            } else {
                let at = |(row, from): (&[f32], i64), i: usize| {
                    row[(from + i as i64).clamp(0, width as i64 - 1) as usize]
                };
                for (i, (least, own)) in seen.iter_mut().zip(own).enumerate() {
                    *least = least.max(self.horizon(tap, *own, at(low, i), at(high, i)));
                }
            }
        }
        for horizon in seen.iter_mut() {
            let u = 0.5 - 0.5 * horizon.min(1.0);
            *horizon = u * u * (3.0 - 2.0 * u);
        }
    }

    /// tan α/w of a place whose two cells have the heights `low` and `high`.
    #[inline]
    fn horizon(&self, tap: &Tap, own: f32, low: f32, high: f32) -> f32 {
        let rise = (low - own + (high - low) * tap.weight) * self.rise;
        let above = rise * self.toward[0] - tap.run[1];
        let ahead = rise * self.toward[1] + tap.run[0];
        above / ahead.max(LEAST_DENOMINATOR) * self.sharpness
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::light::LampSetup;

    const CELL_M: f32 = 2.5e-4;
    const SIDE: usize = 48;

    fn lamp(toward: [f64; 3], softness: f64) -> Lamp {
        Lamp::new(&LampSetup {
            toward,
            softness,
            ..Default::default()
        })
    }

    /// V of a whole square of heights.
    fn seen(heights: &[f32], lamp: &Lamp) -> Vec<f32> {
        let field = HeightField {
            heights,
            cells: [SIDE, SIDE],
            cell_m: CELL_M,
        };
        let shadows = Shadows::new(lamp, CELL_M);
        let mut seen = vec![0.0; SIDE * SIDE];
        for (y, row) in seen.chunks_exact_mut(SIDE).enumerate() {
            let (left, right) = row.split_at_mut(20);
            shadows.row(&field, [0, y], left);
            shadows.row(&field, [20, y], right);
        }
        seen
    }

    fn plane(height: impl Fn(usize, usize) -> f32) -> Vec<f32> {
        (0..SIDE * SIDE)
            .map(|i| height(i % SIDE, i / SIDE))
            .collect()
    }

    #[test]
    fn a_wall_casts_a_shadow_as_long_as_the_lamp_is_low() {
        // A wall four cells high, 3 wide; the lamp to the left at 45° and lower.
        let wall = plane(|x, _| f32::from(u8::from((10..13).contains(&x))) * 4.0 * CELL_M);
        let edge = |z: f64| {
            let row = seen(&wall, &lamp([-1.0, 0.0, z], 0.05));
            assert!(row[..10].iter().all(|v| *v == 1.0), "the lamp's side");
            // The half-visible lamp, between two cells.
            let dark = (13..SIDE).find(|x| row[*x] > 0.5).expect("an end");
            dark as f32 - (row[dark] - 0.5) / (row[dark] - row[dark - 1])
        };
        // The wall's top is over its last cell, 12: its shadow ends 4/z from there.
        for z in [1.0, 0.7, 0.5] {
            let (got, expected) = (edge(z), 12.0 + 4.0 / z as f32);
            println!("{got:.2} expected {expected:.2}");
            assert!((got - expected).abs() < 0.6, "{got} {expected}");
            assert!((edge(z * 0.7) - expected).abs() > 0.6, "a fault would pass");
        }
    }

    #[test]
    fn a_large_lamp_has_soft_shadows_and_the_foot_stays_dark() {
        let wall = plane(|x, _| f32::from(u8::from((10..13).contains(&x))) * 8.0 * CELL_M);
        let width = |softness: f64| {
            let row = seen(&wall, &lamp([-1.0, 0.0, 1.0], softness));
            assert!(row[13] < 0.05, "{}", row[13]);
            assert!(row[13..SIDE].is_sorted(), "one penumbra");
            row[..SIDE]
                .iter()
                .filter(|v| **v > 0.02 && **v < 0.98)
                .count()
        };
        let widths = [0.0, 0.1, 0.3].map(width);
        println!("cells of penumbra: {widths:?}");
        assert!(widths[0] <= 1 && widths[1] > widths[0] && widths[2] > widths[1]);
    }

    #[test]
    fn shadows_fall_away_from_the_lamp_and_no_farther_than_told() {
        let post = plane(|x, y| f32::from(u8::from((x, y) == (24, 24))) * 40.0 * CELL_M);
        for toward in [
            [-1.0, 0.0, 0.2],
            [0.7, -0.3, 0.2],
            [0.2, 0.9, 0.4],
            [-0.5, 0.5, 0.3],
        ] {
            let lamp = lamp(toward, 0.1);
            let seen = seen(&post, &lamp);
            let [below, above] = Shadows::new(&lamp, CELL_M).reach();
            let mut dark = 0;
            for (i, v) in seen.iter().enumerate() {
                let (x, y) = (i % SIDE, i / SIDE);
                if *v == 1.0 {
                    continue;
                }
                dark += 1;
                let off = [x as f64 - 24.0, y as f64 - 24.0];
                assert!(off[0] * toward[0] + off[1] * toward[1] < 0.0, "{off:?}");
                let near = |at: usize, below: u32, above: u32| {
                    at + below as usize >= 24 && at <= 24 + above as usize
                };
                assert!(near(x, below[0], above[0]) && near(y, below[1], above[1]));
            }
            assert!(dark > 10, "{dark}");
            assert!(below.iter().chain(&above).all(|reach| *reach <= REACH));
        }
    }

    #[test]
    fn relief_strength_lengthens_shadows() {
        let wall = plane(|x, _| f32::from(u8::from((10..13).contains(&x))) * 2.0 * CELL_M);
        let dark = |relief: f64| {
            let lamp = Lamp::new(&LampSetup {
                toward: [-1.0, 0.0, 0.5],
                relief,
                ..Default::default()
            });
            seen(&wall, &lamp).iter().filter(|v| **v < 0.5).count()
        };
        assert_eq!(dark(0.0), 0);
        assert!(dark(2.0) > dark(1.0) && dark(1.0) > 0);
    }

    proptest! {
        #[test]
        fn a_flat_surface_sees_all_of_the_lamp(
            toward in prop::array::uniform3(-1.0..1.0f64),
            softness in 0.0..1.0f64,
            height in 0.0f32..1e-3,
        ) {
            let seen = seen(&vec![height; SIDE * SIDE], &lamp(toward, softness));
            prop_assert!(seen.iter().all(|v| *v == 1.0));
        }

        #[test]
        fn no_relief_leaves_the_range(
            seed in 0u32..1000,
            toward in prop::array::uniform3(-1.0..1.0f64),
            softness in 0.0..1.0f64,
        ) {
            let rough = plane(|x, y| {
                let n = (x as u32).wrapping_mul(747_796_405) ^ (y as u32 + seed).wrapping_mul(2_891_336_453);
                (n.wrapping_mul(277_803_737) >> 8) as f32 * 1e-10
            });
            let seen = seen(&rough, &lamp(toward, softness));
            prop_assert!(seen.iter().all(|v| (0.0..=1.0).contains(v)));
        }
    }
}
