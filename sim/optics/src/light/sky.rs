//! Ambient occlusion of a relief: the share of ambient light that a cell receives, and the light reflected by its
//! surroundings instead.
//!
//! Light of the same radiance comes from everywhere above the plane of the surface. In the direction φ
//! the relief hides it up to the horizon's elevation η; a facet of normal n, with n_φ its component along
//! φ, receives from the rest, of what a level place receives (Max 1988, *Horizon mapping: shadows for
//! bump-mapped surfaces*; Bavoil and Sainz 2008, *Image-space horizon-based ambient occlusion*):
//!
//! ```text
//! v = 1/π·∫dφ ∫_η^{π/2} (n_φ·cos θ + n_z·sin θ)·cos θ dθ
//!   = 2/N·Σ_φ n_φ·(π/4 − η/2 − sin η·cos η/2) + n_z·cos²η/2
//! ```
//!
//! η is the highest of [`RINGS`] places in each of N directions, from the next cell to [`REACH_M`] in geometric steps;
//! far ones count for less, so that the occlusion ends by degrees (ibid.). The sky is usually hidden by lit paint of
//! the same colour: at a share v of ambient light, a concavity of albedo ρ receives, with all reflections between its
//! walls, [`bounced`] (Jimenez, Wu, Pesce and Jarabo 2016, *Practical real-time strategies for accurate indirect
//! occlusion*, eq. 10).

use super::HeightField;

/// N, the directions that are looked into.
pub const DIRECTIONS: usize = 8;
/// Places in each of them.
pub const RINGS: usize = 5;
/// Number of all samples.
pub const TAPS: usize = DIRECTIONS * RINGS;
/// Reach of occlusion, m: twice the height of thick impasto.
pub const REACH_M: f64 = 2e-3;
/// Greatest reach, cells.
pub const REACH: u32 = 16;
/// Share of its elevation by which the farthest place counts.
const FARTHEST_SHARE: f64 = 0.3;

/// A place around a cell.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tap {
    /// Columns and rows.
    pub cell: [i32; 2],
    /// Tangent of its elevation for each metre that it is higher, of relief strength 1.
    pub steepness: f32,
}

/// The places around a cell that may hide the sky.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sky {
    /// Ring by ring in each direction, from the nearest.
    pub taps: [[Tap; RINGS]; DIRECTIONS],
    /// Unit vectors of the directions.
    pub toward: [[f32; 2]; DIRECTIONS],
}

impl Sky {
    /// The sky over cells of side `cell_m`, their heights multiplied by `relief`.
    #[must_use]
    pub fn new(relief: f32, cell_m: f32) -> Self {
        let half = 0.5f64.sqrt();
        let toward = [
            [1.0, 0.0],
            [half, half],
            [0.0, 1.0],
            [-half, half],
            [-1.0, 0.0],
            [-half, -half],
            [0.0, -1.0],
            [half, -half],
        ];
        let cell_m = f64::from(cell_m);
        let farthest = (REACH_M / cell_m).clamp(1.0, f64::from(REACH));
        // The fourth root, so that each ring is by the same factor farther than the last.
        let factor = farthest.sqrt().sqrt();
        let tap = |[x, y]: [f64; 2], ring: usize| {
            let far = (0..ring).fold(1.0, |far, _| far * factor);
            // On the diagonals as many cells both ways, which is between two rings of the others.
            let longer = if x * y == 0.0 { 1.0 } else { 1.0 / half };
            let cell = [x, y].map(|v| (v * (far * longer).min(farthest.max(longer))).round());
            let run = (cell[0] * cell[0] + cell[1] * cell[1]).sqrt();
            let share = ring as f64 / (RINGS - 1) as f64;
            let near = 1.0 - (1.0 - FARTHEST_SHARE) * share * share * share * share;
            Tap {
                cell: cell.map(|v| v as i32),
                steepness: (f64::from(relief) * near / (run * cell_m)) as f32,
            }
        };
        Self {
            taps: toward.map(|way| std::array::from_fn(|ring| tap(way, ring))),
            toward: toward.map(|way| way.map(|v| v as f32)),
        }
    }

    /// Reach of a changed cell, cells to every side.
    #[must_use]
    pub fn reach(&self) -> u32 {
        let cells = self.taps.iter().flatten().flat_map(|tap| tap.cell);
        cells.map(i32::unsigned_abs).max().unwrap_or(0)
    }

    /// v of the cells of row `y` from column `x` on, as many as `open` takes, whose unit normals are
    /// `normals`. Beyond the border the relief continues at the border's height.
    pub fn row(
        &self,
        field: &HeightField<'_>,
        [x, y]: [usize; 2],
        normals: &[[f32; 3]],
        open: &mut [f32],
    ) {
        let own = &field.row(y as i64)[x..][..open.len()];
        open.fill(0.0);
        let mut highest = vec![0.0f32; open.len()];
        for (taps, toward) in self.taps.iter().zip(&self.toward) {
            highest.fill(0.0);
            for tap in taps {
                let [dx, dy] = tap.cell.map(i64::from);
                let row = field.row(y as i64 + dy);
                let (from, last) = (x as i64 + dx, row.len() as i64 - 1);
                let rise = |highest: &mut f32, own: f32, other: f32| {
                    *highest = highest.max((other - own) * tap.steepness);
                };
                if from >= 0 && from as usize + open.len() <= row.len() {
                    let others = &row[from as usize..][..open.len()];
                    for ((highest, own), other) in highest.iter_mut().zip(own).zip(others) {
                        rise(highest, *own, *other);
                    }
                } else {
                    for (i, (highest, own)) in highest.iter_mut().zip(own).enumerate() {
                        rise(
                            highest,
                            *own,
                            row[(from + i as i64).clamp(0, last) as usize],
                        );
                    }
                }
            }
            for ((open, highest), normal) in open.iter_mut().zip(&highest).zip(normals) {
                *open += above(
                    *highest,
                    normal[0] * toward[0] + normal[1] * toward[1],
                    normal[2],
                );
            }
        }
        for open in open.iter_mut() {
            *open = (*open * (2.0 / DIRECTIONS as f32)).clamp(0.0, 1.0);
        }
    }
}

/// Light on a facet from one direction over a horizon of the elevation with tangent `tangent`:
/// n_φ·(π/4 − η/2 − sin η·cos η/2) + n_z·cos²η/2. The arc cosine is Abramowitz and Stegun's 4.4.45,
/// to 7e-5.
#[inline]
#[must_use]
pub fn above(tangent: f32, along: f32, up: f32) -> f32 {
    let square = 1.0 / (1.0 + tangent * tangent);
    let cosine = square.sqrt();
    let sine = tangent * cosine;
    let polynomial = 1.570_728_8 + sine * (-0.212_114_4 + sine * (0.074_261 - 0.018_729_3 * sine));
    let from_zenith = (1.0 - sine).max(0.0).sqrt() * polynomial;
    0.5 * (along * (from_zenith - sine * cosine) + up * square)
}

/// Light on a place that sees the share `open` of the sky, with the reflections of its surroundings of this albedo, 0
/// to 1 each:
///
/// ```text
/// max(v, ((v·a + b)·v + c)·v),  a = 2.0404ρ − .3324,  b = −4.7951ρ + .6417,  c = 2.7552ρ + .6903
/// ```
#[inline]
#[must_use]
pub fn bounced(open: f32, albedo: f32) -> f32 {
    let a = 2.0404 * albedo - 0.3324;
    let b = -4.7951 * albedo + 0.6417;
    let c = 2.7552 * albedo + 0.6903;
    (((open * a + b) * open + c) * open).max(open).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const CELL_M: f32 = 1.25e-4;
    const SIDE: usize = 81;

    /// v of the row in the middle of a relief that is the same along y.
    fn open(height_cells: impl Fn(usize) -> f32) -> Vec<f32> {
        let heights: Vec<f32> = (0..SIDE * SIDE)
            .map(|i| height_cells(i % SIDE) * CELL_M)
            .collect();
        let field = HeightField {
            heights: &heights,
            cells: [SIDE, SIDE],
            cell_m: CELL_M,
        };
        let normals: Vec<[f32; 3]> = (0..SIDE)
            .map(|x| super::super::normal(field.slope(x, SIDE / 2)))
            .collect();
        let mut open = vec![0.0; SIDE];
        Sky::new(1.0, CELL_M).row(&field, [0, SIDE / 2], &normals, &mut open);
        open
    }

    #[test]
    fn the_middle_of_a_trench_sees_what_its_walls_leave() {
        // A trench of depth d and width w, as long as you like: v = cos of the elevation at which the
        // middle sees the rims (the view factor of a strip, Hottel's crossed strings).
        for (depth, half, off) in [(2.0f32, 4usize, 0.03), (4.0, 4, 0.03), (6.0, 3, 0.14)] {
            let middle = SIDE / 2;
            let trench = |x: usize| {
                if x.abs_diff(middle) < half {
                    -depth
                } else {
                    0.0
                }
            };
            let got = open(trench)[middle];
            let run = half as f32;
            let exact = run / (run * run + depth * depth).sqrt();
            println!("{depth} {half}: {got:.3}, without a limit to its reach {exact:.3}");
            // The last trench has its walls between two rings.
            assert!((got - exact).abs() < off, "{got} {exact}");
            let deeper = |x: usize| 2.0 * trench(x);
            assert!(open(deeper)[middle] < got - 0.06, "a fault would pass");
        }
    }

    #[test]
    fn a_facet_under_the_open_sky_sees_what_its_own_plane_leaves() {
        // ∫ over the part of the hemisphere above both planes: (1 + n_z)/2.
        let directions = 720;
        for slope in [0.0f32, 0.3, 1.0, 3.0] {
            let n = super::super::normal([slope, 0.0]);
            let sum: f32 = (0..directions)
                .map(|i| {
                    let angle = std::f64::consts::TAU * f64::from(i) / f64::from(directions);
                    let (sine, cosine) = maulstick_num::sin_cos(angle);
                    let [x, y] = [cosine, sine].map(|v| v as f32);
                    above((slope * x).max(0.0), n[0] * x + n[1] * y, n[2])
                })
                .sum();
            let (got, expected) = (sum * 2.0 / directions as f32, 0.5 * (1.0 + n[2]));
            println!("slope {slope}: {got:.5} expected {expected:.5}");
            assert!((got - expected).abs() < 2e-4);
        }
    }

    #[test]
    fn a_level_place_sees_all_and_nothing_beyond_the_reach_hides_it() {
        assert!(open(|_| 3.0).iter().all(|v| *v == 1.0));
        let step = open(|x| if x < 30 { 8.0 } else { 0.0 });
        assert!(step[30] < 0.7, "{}", step[30]);
        assert!(step[30..].is_sorted(), "{step:?}");
        assert!(step[30 + REACH as usize..].iter().all(|v| *v == 1.0));
        let sky = |cell_m| Sky::new(1.0, cell_m);
        assert_eq!(sky(CELL_M).reach(), REACH);
        assert_eq!(
            [2.5e-4, 2e-3, 1.0].map(|cell_m| sky(cell_m).reach()),
            [8, 1, 1]
        );
    }

    #[test]
    fn a_white_hollow_is_bright_and_a_black_one_is_not() {
        for open in [0.1f32, 0.4, 0.7, 1.0] {
            // Jimenez et al. 2016, fig. 9: no albedo leaves the occlusion about as it is.
            let [black, grey, white] = [0.0, 0.4, 0.9].map(|albedo| bounced(open, albedo));
            assert!((black - open).abs() < 0.06, "{open} {black}");
            assert!(black <= grey && grey <= white && white <= 1.0);
        }
        assert!(bounced(0.5, 0.9) > 0.8);
        assert_eq!([0.0, 0.5, 1.0].map(|albedo| bounced(1.0, albedo)), [1.0; 3]);
        assert_eq!(bounced(0.0, 0.7), 0.0);
    }
}
