//! The shape of paint squeezed onto a palette.
//!
//! Stiff paint keeps the shape in which it left the tube: a coil of a strand that rises to a tip. With much thinner it
//! runs level to a puddle.

use std::f64::consts::TAU;
use std::sync::Arc;

use maulstick_num::{atan2, exp, sin, sin_cos};
use maulstick_optics::THINNER;
use maulstick_types::Mixture;

/// Mean thickness of the paint in a well, m.
pub const WELL_M: f64 = 2e-3;
/// Shares of thinner from which paint begins to run, and from which it is level.
const RUNS: [f64; 2] = [0.1, 0.4];
/// Mean radius of the outline, and amplitudes of its second and third harmonic, in radii of the well.
const OUTLINE: [f64; 3] = [0.93, 0.035, 0.02];
/// Least and greatest number of turns of a strand from the outline to the middle.
const TURNS: [f64; 2] = [1.5, 2.4];
/// Depth of the groove between two turns, relative to the height there.
const GROOVE: f64 = 0.3;
/// Fall from the middle to the rim, relative to the height in the middle.
const FALL: f64 = 0.2;
/// Tip: distance from the middle and radius, in radii of the well; height, in heights of the heap.
const TIP: [f64; 3] = [0.1, 0.13, 0.16];
/// Height in the middle without the tip, relative to the mean height: of a heap, of a puddle.
const RISE: [f64; 2] = [1.754, 1.240];

/// Shape of a heap in a well.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Heap {
    /// Orientation, rad.
    turn: f64,
    /// Number of turns of its strand.
    turns: f64,
    /// 0 for a level puddle, 1 for a heap as squeezed.
    stiffness: f64,
}

impl Heap {
    /// The heap of a mixture; each paint has a different one.
    #[must_use]
    pub fn of(mixture: &Mixture) -> Self {
        let thinner = mixture.parts.iter().filter(|part| part.paint == THINNER);
        let thinner: f64 = thinner.map(|part| part.share).sum();
        let names = mixture.parts.iter().flat_map(|part| part.paint.bytes());
        // FNV-1a.
        let hash = names.fold(0x811c_9dc5_u32, |hash, byte| {
            (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193)
        });
        let runs = ((thinner - RUNS[0]) / (RUNS[1] - RUNS[0])).clamp(0.0, 1.0);
        Self {
            turn: f64::from(hash >> 16) / f64::from(1 << 16) * TAU,
            turns: TURNS[0] + (TURNS[1] - TURNS[0]) * f64::from(hash & 0xffff) / f64::from(0xffff),
            stiffness: 1.0 - runs,
        }
    }

    /// Thickness at a place relative to the well's middle, in the well's radii, m.
    #[must_use]
    pub fn thickness_m(&self, [x, y]: [f64; 2]) -> f64 {
        let out = (x * x + y * y).sqrt();
        let round = atan2(y, x) + self.turn;
        let [mean, two, three] = OUTLINE;
        let outline = mean + two * sin(2.0 * round) + three * sin(3.0 * round + self.turn);
        let rho = out / outline;
        if rho >= 1.0 {
            return 0.0;
        }
        let inside = 1.0 - rho * rho;
        // Flat, with a round rim.
        let puddle = (1.0 - rho.powi(16)).sqrt();
        // Grooves between the turns of the strand.
        let strand = self.turns * rho + round / TAU;
        let across = 2.0 * (strand - strand.floor()) - 1.0;
        let bead = (1.0 - across * across).sqrt();
        let (tip_y, tip_x) = sin_cos(-self.turn);
        let [dx, dy] = [x - TIP[0] * tip_x, y - TIP[0] * tip_y].map(|d| d / TIP[1]);
        let tip = TIP[2] * exp(-(dx * dx + dy * dy));
        let dome = inside.sqrt().sqrt() * (1.0 - FALL * rho);
        let coil = dome * (1.0 - GROOVE + GROOVE * bead) + tip;
        let [heap, level] = RISE;
        WELL_M * (self.stiffness * heap * coil + (1.0 - self.stiffness) * level * puddle)
    }
}

/// A heap by cells of a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct HeapCells {
    /// Lower left cell of its grid.
    corner: [i64; 2],
    across: usize,
    thickness_m: Arc<[f32]>,
}

impl HeapCells {
    /// The heap of a well whose middle and radius are in cells.
    #[must_use]
    pub fn of(heap: &Heap, center: [f64; 2], radius: f64) -> Self {
        let corner = center.map(|at| (at - radius).floor() as i64);
        let size = [0, 1].map(|i| ((center[i] + radius).ceil() as i64 - corner[i]).max(0) as usize);
        let thickness = |at: usize| {
            let cell = [at % size[0], at / size[0]].map(|at| at as f64 + 0.5);
            let offset = [0, 1].map(|i| (corner[i] as f64 + cell[i] - center[i]) / radius);
            heap.thickness_m(offset) as f32
        };
        Self {
            corner,
            across: size[0],
            thickness_m: (0..size[0] * size[1]).map(thickness).collect(),
        }
    }

    /// Thickness in a cell, m; 0 beside the well.
    #[must_use]
    pub fn thickness_m(&self, cell: [i64; 2]) -> f32 {
        let [x, y] = [0, 1].map(|i| usize::try_from(cell[i] - self.corner[i]));
        match (x, y) {
            (Ok(x), Ok(y)) if x < self.across => {
                let at = self.thickness_m.get(y * self.across + x);
                at.copied().unwrap_or_default()
            }
            _ => 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use maulstick_types::mixture::Part;

    fn heap(parts: &[(&str, f64)]) -> Heap {
        let part = |(paint, share): &(&str, f64)| Part {
            paint: (*paint).to_owned(),
            share: *share,
        };
        Heap::of(&Mixture {
            parts: parts.iter().map(part).collect(),
        })
    }

    /// Thicknesses over the circle of a well, m, on a grid of 401 × 401 places.
    fn thicknesses(heap: &Heap) -> Vec<f64> {
        let at = |i: i32| f64::from(i) / 200.0;
        let places = (-200..=200).flat_map(|y| (-200..=200).map(move |x| [at(x), at(y)]));
        places
            .filter(|[x, y]| x * x + y * y < 1.0)
            .map(|place| heap.thickness_m(place))
            .collect()
    }

    #[test]
    fn heaps_and_puddles_hold_what_a_well_holds() {
        for parts in [
            &[("Titanium White", 1.0)][..],
            &[("Yellow Ochre", 1.0)],
            &[("Yellow Ochre", 0.75), (THINNER, 0.25)],
            &[("Ultramarine Blue", 0.3), (THINNER, 0.7)],
        ] {
            let all = thicknesses(&heap(parts));
            let mean = all.iter().sum::<f64>() / all.len() as f64;
            assert!((mean - 2e-3).abs() < 4e-5, "{parts:?}: {mean}");
            let most = all.iter().copied().fold(0.0, f64::max);
            assert!(most < 4e-3, "{parts:?}: {most}");
        }
    }

    #[test]
    fn its_cells_have_the_thickness_of_their_middles() {
        let heap = heap(&[("Titanium White", 1.0)]);
        let cells = HeapCells::of(&heap, [10.25, -3.0], 6.0);
        for cell in [[10, -3], [6, -5], [13, 1]] {
            let middle = [0, 1].map(|i| cell[i] as f64 + 0.5 - [10.25, -3.0][i]);
            let own = heap.thickness_m(middle.map(|at| at / 6.0)) as f32;
            assert_eq!(cells.thickness_m(cell), own, "{cell:?}");
        }
        for beside in [[3, -3], [17, -3], [10, 4], [10, -10]] {
            assert_eq!(cells.thickness_m(beside), 0.0, "{beside:?}");
        }
    }

    #[test]
    fn stiff_paint_stands_and_thin_paint_lies_level() {
        let most = |parts: &[(&str, f64)]| {
            let all = thicknesses(&heap(parts));
            all.into_iter().fold(0.0, f64::max)
        };
        assert!(most(&[("Titanium White", 1.0)]) > 3.5e-3);
        assert!(most(&[("Ultramarine Blue", 0.3), (THINNER, 0.7)]) < 2.6e-3);
    }
}
