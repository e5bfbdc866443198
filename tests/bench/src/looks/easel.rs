//! A canvas, a brush and a hand for the measurements of looks, and the resulting films.

use maulstick_brush::BrushFile;
use maulstick_canvas::quantum::QUANTUM_M;
use maulstick_num::atan2;
use maulstick_optics::PaintLibrary;
use maulstick_painting::edits::{Dry, Load};
use maulstick_painting::{EditError, Painting, PaintingSetup};
use maulstick_rig::UserError;
use maulstick_session::Offline;
use maulstick_types::Edit;
use maulstick_types::paint::TILE;
use maulstick_types::scene::CANVAS;
use maulstick_types::stylus::{StylusPose, StylusSample, axes};
use maulstick_types::values::BrushName;

const RATE_HZ: f64 = 250.0;
/// Speed of the hand, mm/s.
const SPEED: f64 = 100.0;
/// Share of the head's length by which full pressure presses a brush in.
const DEPTH_SHARE: f64 = 0.5;
/// Name of the first brush.
const BRUSH: &str = "main";

/// A straight stroke.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stroke {
    /// Ends, mm from the lower left corner.
    pub(crate) from: [f64; 2],
    /// As `from`.
    pub(crate) to: [f64; 2],
    /// Pressure, 0 to 1.
    pub(crate) pressure: f64,
    /// Lean of the handle along the path, degrees.
    pub(crate) lean_deg: f64,
}

impl Stroke {
    /// Along x at a height.
    pub(crate) fn along(y: f64, from: f64, to: f64, pressure: f64) -> Self {
        Self {
            from: [from, y],
            to: [to, y],
            pressure,
            lean_deg: 25.0,
        }
    }
}

/// A canvas with a hand over it.
pub(crate) struct Easel {
    pub(crate) offline: Offline,
    size_mm: [f64; 2],
    pub(crate) cell_mm: f64,
    now_s: f64,
}

fn refused(refusal: EditError) -> UserError {
    UserError::failure(format!("{refusal}; {}", refusal.advice()))
}

/// A brush of the library, so wide.
pub(crate) fn brush(kind: &str, width_mm: f64) -> Result<BrushFile, UserError> {
    let found = BrushFile::library(kind).map_err(|error| UserError::failure(error.to_string()))?;
    found
        .scaled_to(width_mm)
        .map_err(|error| UserError::failure(error.to_string()))
}

impl Easel {
    /// A canvas with a tooth and a brush.
    pub(crate) fn new(
        size_mm: [f64; 2],
        cell_mm: f64,
        tooth: &str,
        file: BrushFile,
    ) -> Result<Self, UserError> {
        let library =
            PaintLibrary::measured().map_err(|error| UserError::failure(error.to_string()))?;
        let setup = PaintingSetup {
            tooth: tooth.to_owned(),
            cells: size_mm.map(|mm| (mm / cell_mm).round() as u32),
            cell_m: 1e-3 * cell_mm,
            ..PaintingSetup::default()
        };
        let painting = Painting::new(&setup, library).map_err(refused)?;
        let offline =
            Offline::new(painting, BRUSH, file, DEPTH_SHARE, Vec::new()).map_err(refused)?;
        Ok(Self {
            offline,
            size_mm,
            cell_mm,
            now_s: 1.0,
        })
    }

    pub(crate) fn edit(&mut self, edit: impl Into<Edit>) -> Result<(), UserError> {
        self.offline.edit(edit).map(drop).map_err(refused)
    }

    pub(crate) fn take_up(&mut self, name: &str, file: BrushFile) -> Result<(), UserError> {
        self.offline
            .take_up(name, file, DEPTH_SHARE)
            .map_err(refused)
    }

    pub(crate) fn load(&mut self, mixture: &str) -> Result<(), UserError> {
        let mixture = mixture
            .parse()
            .map_err(|error| UserError::failure(format!("{error}")))?;
        let brush = self.offline.brush().to_owned();
        self.edit(Load {
            mixture,
            beside: None,
            brush: BrushName::new(brush)?,
        })
    }

    pub(crate) fn dry(&mut self) -> Result<(), UserError> {
        self.edit(Dry::whole(CANVAS))
    }

    pub(crate) fn stroke(&mut self, stroke: &Stroke) -> Result<(), UserError> {
        let way = [0, 1].map(|i| stroke.to[i] - stroke.from[i]);
        let length = (way[0] * way[0] + way[1] * way[1]).sqrt();
        let samples = (length / SPEED * RATE_HZ).ceil().max(2.0) as usize;
        let unit = way.map(|v| v / length);
        // The broad side of a flat brush is across the path.
        let twist = atan2(-unit[0], unit[1]);
        for i in 0..=samples + 1 {
            let t = (i as f64 / samples as f64).min(1.0);
            let ramp = (t * length / 4.0)
                .min((1.0 - t) * length / 4.0)
                .clamp(0.02, 1.0);
            let pressure = if i > samples {
                0.0
            } else {
                stroke.pressure * ramp
            };
            let desk = |k: usize| 1e-3 * (stroke.from[k] + t * way[k] - 0.5 * self.size_mm[k]);
            let lean = stroke.lean_deg.to_radians();
            let sample = StylusSample {
                senses: axes::POSITION | axes::PRESSURE,
                in_range: true,
                pose: StylusPose::Contact {
                    point_m: [desk(0), desk(1), 0.0],
                    tilt_rad: unit.map(|v| v * lean),
                    twist_rad: twist,
                    pressure,
                },
                ..StylusSample::away()
            };
            let event_ns = (self.now_s * 1e9) as u64;
            self.offline.sample(event_ns, &sample).map_err(refused)?;
            self.now_s += 1.0 / RATE_HZ;
        }
        self.now_s += 0.3;
        Ok(())
    }

    /// Thickness of the wet paint, µm, of one slot or of all.
    pub(crate) fn film(&mut self, slot: Option<usize>) -> Map {
        let painting = self.offline.painting_mut();
        painting.commit();
        let mut map = Map::new(self.size_mm, self.cell_mm);
        if let Some(store) = painting.store(CANVAS) {
            for (id, version) in store.iter() {
                let Some(tile) = &version.tile else { continue };
                for (at, plane) in &*tile.wet() {
                    if slot.is_none_or(|slot| slot == *at) {
                        map.add([id.x, id.y], plane, 1e6 * QUANTUM_M as f32);
                    }
                }
            }
        }
        map
    }

    /// Height of tooth and dry relief, µm.
    pub(crate) fn ground(&mut self) -> Map {
        let painting = self.offline.painting_mut();
        painting.commit();
        let mut map = Map::new(self.size_mm, self.cell_mm);
        if let (Some(store), Some(bare)) = (painting.store(CANVAS), painting.bare(CANVAS)) {
            for (id, version) in store.iter() {
                map.add([id.x, id.y], &bare.relief.tile(id), 1e6);
                let dry = version.tile.as_ref().and_then(|tile| tile.dry().cloned());
                if let Some(dry) = dry {
                    map.add([id.x, id.y], &dry.height(), 1e6 * QUANTUM_M as f32);
                }
            }
        }
        map
    }
}

/// A number a cell, row after row from the bottom.
#[derive(Clone, Debug)]
pub(crate) struct Map {
    pub(crate) size: [usize; 2],
    pub(crate) cell_mm: f64,
    pub(crate) cells: Vec<f32>,
}

impl Map {
    fn new(size_mm: [f64; 2], cell_mm: f64) -> Self {
        let size = size_mm.map(|mm| (mm / cell_mm).round() as usize);
        Self {
            size,
            cell_mm,
            cells: vec![0.0; size[0] * size[1]],
        }
    }

    /// The same value in all cells.
    #[cfg(test)]
    pub(crate) fn level(size: [usize; 2], cell_mm: f64, value: f32) -> Self {
        Self {
            size,
            cell_mm,
            cells: vec![value; size[0] * size[1]],
        }
    }

    fn add(&mut self, tile: [u32; 2], plane: &[f32], scale: f32) {
        let [left, bottom] = tile.map(|place| place as usize * TILE);
        for (row, cells) in plane.chunks_exact(TILE).enumerate() {
            let y = bottom + row;
            if y >= self.size[1] {
                break;
            }
            let width = TILE.min(self.size[0].saturating_sub(left));
            let to = &mut self.cells[y * self.size[0] + left..][..width];
            to.iter_mut()
                .zip(cells)
                .for_each(|(to, value)| *to += value * scale);
        }
    }

    /// Cells of a rectangle in mm, as columns and rows.
    fn span(&self, from: [f64; 2], to: [f64; 2]) -> [std::ops::Range<usize>; 2] {
        let cell =
            |mm: f64, i: usize| ((mm / self.cell_mm).round().max(0.0) as usize).min(self.size[i]);
        [0, 1].map(|i| cell(from[i], i)..cell(to[i], i))
    }

    /// A rectangle in mm.
    pub(crate) fn cut(&self, from: [f64; 2], to: [f64; 2]) -> Self {
        let [across, up] = self.span(from, to);
        let size = [across.len(), up.len()];
        let rows = up.map(|y| &self.cells[y * self.size[0]..][across.clone()]);
        Self {
            size,
            cell_mm: self.cell_mm,
            cells: rows.flatten().copied().collect(),
        }
    }

    /// Less the mean of each row.
    pub(crate) fn less_rows(mut self) -> Self {
        let means = self.profile(1);
        for (row, mean) in self.cells.chunks_exact_mut(self.size[0]).zip(means) {
            row.iter_mut().for_each(|value| *value -= mean as f32);
        }
        self
    }

    pub(crate) fn mean(&self) -> f64 {
        self.cells.iter().map(|v| f64::from(*v)).sum::<f64>() / self.cells.len().max(1) as f64
    }

    pub(crate) fn plus(&self, other: &Self) -> Self {
        let mut sum = self.clone();
        sum.cells
            .iter_mut()
            .zip(&other.cells)
            .for_each(|(a, b)| *a += b);
        sum
    }

    /// Means of the columns (0) or rows (1).
    pub(crate) fn profile(&self, axis: usize) -> Vec<f64> {
        let mut sums = vec![0.0; self.size[axis]];
        for (i, value) in self.cells.iter().enumerate() {
            let place = if axis == 0 {
                i % self.size[0]
            } else {
                i / self.size[0]
            };
            sums[place] += f64::from(*value);
        }
        let count = self.size[1 - axis] as f64;
        sums.iter().map(|sum| sum / count).collect()
    }
}

/// Slope of y by x, least squares.
pub(crate) fn slope(x: &[f32], y: &[f32]) -> f64 {
    let count = x.len() as f64;
    let mean = |v: &[f32]| v.iter().map(|v| f64::from(*v)).sum::<f64>() / count;
    let (mx, my) = (mean(x), mean(y));
    let (mut sxy, mut sxx) = (0.0, 0.0);
    for (x, y) in x.iter().zip(y) {
        sxy += (f64::from(*x) - mx) * (f64::from(*y) - my);
        sxx += (f64::from(*x) - mx) * (f64::from(*x) - mx);
    }
    sxy / sxx
}

/// Correlation of two profiles.
pub(crate) fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let count = a.len() as f64;
    let (ma, mb) = (a.iter().sum::<f64>() / count, b.iter().sum::<f64>() / count);
    let (mut ab, mut aa, mut bb) = (0.0, 0.0, 0.0);
    for (x, y) in a.iter().zip(b) {
        ab += (x - ma) * (y - mb);
        aa += (x - ma) * (x - ma);
        bb += (y - mb) * (y - mb);
    }
    ab / (aa * bb).sqrt()
}
