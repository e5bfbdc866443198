//! The head over cells, independent of their paint: for models that draw it once and touch the surface with it at
//! several places.

use maulstick_canvas::window::Area;
use maulstick_num::fork_join::Balance;

use super::band::Band;
use super::ribbons::Ribbons;
use super::shares_of;
use crate::interface::Step;

/// Rows of the planes are padded to a multiple of this number of cells.
const RUN: usize = 16;

/// The lowest part of a head over each cell of a grid. Planes are row by row, each row [`stride`](Self::stride) long;
/// its padding is uncovered.
#[derive(Clone, Debug, Default)]
pub struct Drawn {
    /// The surface's cell at the grid's lower left corner.
    pub origin: [i64; 2],
    /// Columns and rows of the grid.
    pub size: [usize; 2],
    /// Cells from one row to the next.
    pub stride: usize,
    /// Share of each cell that is covered; 0 where nothing is over it.
    pub cover: Vec<f32>,
    /// Height of the middle line of the bristle, cells.
    pub height: Vec<f32>,
    /// Height of the bristle's lower side over that, cells.
    pub clearance: Vec<f32>,
    /// Travel of the bristle in the step, cells.
    pub travel: Vec<f32>,
    /// The brush texel over it: `strip · TEXELS_PER_STRIP + along`; [`ABSENT`](Self::ABSENT) where there is none.
    pub texel: Vec<u32>,
    /// The covered cells: columns and rows from the first up to but not with the second.
    pub reach: ([usize; 2], [usize; 2]),
    /// One for each core, in order of their rows.
    bands: Vec<Band>,
    ribbons: Ribbons,
    balance: Balance,
}

/// The rows that one core draws.
struct Part<'a> {
    band: &'a mut Band,
    rows: std::ops::Range<usize>,
    /// Cover, height, clearance and travel.
    planes: [&'a mut [f32]; 4],
    texel: &'a mut [u32],
    reach: ([usize; 2], [usize; 2]),
}

impl Drawn {
    /// No texel.
    pub const ABSENT: u32 = u32::MAX;

    /// Draws the head in the middle of the step's motion on a grid of `size` columns and rows from `origin` on, below
    /// `top`, cells. The grid may extend beyond the window.
    pub fn draw(&mut self, step: &Step<'_>, origin: [i64; 2], size: [usize; 2], top: f32) {
        (self.origin, self.size) = (origin, size);
        self.stride = size[0].next_multiple_of(RUN);
        let cells = self.stride * size[1];
        let planes = [
            &mut self.cover,
            &mut self.height,
            &mut self.clearance,
            &mut self.travel,
        ];
        let mut planes = planes.map(|plane| {
            plane.clear();
            plane.resize(cells, 0.0);
            &mut plane[..]
        });
        self.texel.clear();
        self.texel.resize(cells, Self::ABSENT);
        let mut texel = &mut self.texel[..];
        let grid = Area { from: [0; 2], size };
        let rows = self.balance.cut(size[1], shares_of(grid.cells()));
        let bands = self.bands.len().max(rows.len());
        self.bands.resize_with(bands, Band::default);
        let offset = origin.map(|at| at as f32);
        let stride = self.stride;
        let parts = self.bands.iter_mut().zip(rows).map(|(band, rows)| {
            let own = rows.len() * stride;
            Part {
                band,
                rows,
                planes: planes
                    .each_mut()
                    .map(|plane| plane.split_off_mut(..own).unwrap_or_default()),
                texel: texel.split_off_mut(..own).unwrap_or_default(),
                reach: Band::NOWHERE,
            }
        });
        let mut parts: Vec<_> = parts.collect();
        self.ribbons.lay(step, grid, offset, top);
        let ribbons = &self.ribbons;
        self.balance.each(&mut parts, |part| {
            part.band.begin(grid, offset, part.rows.clone());
            part.band.draw_head(step, ribbons, top);
            part.resolve(ribbons, grid, stride);
        });
        let joined = parts.iter().fold(Band::NOWHERE, |(from, to), part| {
            let (low, high) = part.reach;
            (
                [0, 1].map(|i| from[i].min(low[i])),
                [0, 1].map(|i| to[i].max(high[i])),
            )
        });
        self.reach = if joined.1 == [0; 2] {
            Default::default()
        } else {
            joined
        };
    }

    /// True if it covers nothing.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.reach.1 == [0; 2]
    }
}

impl Part<'_> {
    /// Stores the part of the head over each cell.
    fn resolve(&mut self, ribbons: &Ribbons, grid: Area, stride: usize) {
        let drawing = &self.band.drawing;
        let [cover, height, clearance, travel] = &mut self.planes;
        let (from, to) = &mut self.reach;
        for y in self.rows.clone() {
            let row = (y - self.rows.start) * stride;
            for x in 0..grid.size[0] {
                let Some(over) = drawing.over(ribbons, x, y) else {
                    continue;
                };
                let place = row + x;
                let [u, v] = over.moved();
                cover[place] = over.cover;
                height[place] = over.height();
                clearance[place] = over.clearance();
                travel[place] = (u * u + v * v).sqrt();
                self.texel[place] = over.texel();
                *from = [from[0].min(x), from[1].min(y)];
                *to = [to[0].max(x + 1), to[1].max(y + 1)];
            }
        }
    }
}
