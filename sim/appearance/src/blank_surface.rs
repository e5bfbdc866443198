//! A surface without brush strokes: its ground, its relief, and the paint in its wells.
//!
//! A well's paint is booked when a brush first comes to it; until then it is only displayed.

use std::sync::Arc;

use maulstick_canvas::relief::Relief;
use maulstick_canvas::tile::TileId;
use maulstick_optics::{FilmPlanes, Studio, Under};
use maulstick_types::paint::TILE;

use crate::ground::Ground;
use crate::heap::{HeapCells, WELL_M};

/// Number of thicknesses with tabulated colour, evenly from zero to [`MOST_M`].
const LEVELS: usize = 17;
/// Greatest thickness of a heap, m.
const MOST_M: f64 = 2.0 * WELL_M;

/// Display of a well.
#[derive(Clone, Debug, PartialEq)]
pub struct WellLook {
    /// Its middle, cells.
    pub center: [f64; 2],
    /// Its radius, cells.
    pub radius: f64,
    /// Shape and colour.
    pub shape: WellShape,
}

/// Kind of a well for its display. Colours are unlit, linear sRGB.
#[derive(Clone, Debug, PartialEq)]
pub enum WellShape {
    /// Paint from the tube.
    Heap(HeapCells, HeapColours),
    /// A glass jar of this colour, seen from above. It hides all that brushes leave in it.
    Jar([f32; 3]),
}

/// Colours of a heap by its thickness.
#[derive(Clone, Debug, PartialEq)]
pub struct HeapColours(Arc<[[f32; 3]; LEVELS]>);

impl HeapColours {
    /// Colours of a paint over a ground, from its slots and shares in `studio`.
    #[must_use]
    pub fn of(studio: &Studio, shares: &[(usize, f64)], ground: &[f32]) -> Self {
        let thickness = |level: usize| MOST_M * level as f64 / (LEVELS - 1) as f64;
        let films: Vec<(usize, [f32; LEVELS])> = shares
            .iter()
            .map(|(slot, share)| {
                let film = std::array::from_fn(|level| (share * thickness(level)) as f32);
                (*slot, film)
            })
            .collect();
        let paints: Vec<(usize, &[f32])> = films.iter().map(|(slot, d)| (*slot, &d[..])).collect();
        let mut rgb = [[0.0f32; LEVELS]; 3];
        let [red, green, blue] = &mut rgb;
        let planes = FilmPlanes {
            paints: &paints,
            opacity: 1.0,
            under: Under::Even(ground),
        };
        studio.shade(&planes, [red, green, blue]);
        let level = |level: usize| rgb.map(|channel| channel[level]);
        Self(Arc::new(std::array::from_fn(level)))
    }

    /// Colour at a thickness, m.
    fn at(&self, thickness_m: f64) -> [f32; 3] {
        let at = (thickness_m / MOST_M * (LEVELS - 1) as f64).clamp(0.0, (LEVELS - 1) as f64);
        let below = (at as usize).min(LEVELS - 2);
        let share = (at - below as f64) as f32;
        [0, 1, 2].map(|i| self.0[below][i] * (1.0 - share) + self.0[below + 1][i] * share)
    }
}

/// Colour of the cleaner: spirits, linear sRGB.
pub const CLEANER_RGB: [f32; 3] = [0.30, 0.37, 0.40];
/// The medium: oil, linear sRGB.
pub const MEDIUM_RGB: [f32; 3] = [0.62, 0.36, 0.07];
/// Colour of a jar's wall, glass seen on end, linear sRGB.
const GLASS_RGB: [f32; 3] = [0.50, 0.60, 0.58];
/// Inner radius of a jar's wall as a share of the outer one.
const WALL: f64 = 0.84;
/// Heights of a jar's wall, and of its contents, m.
const JAR_M: [f32; 2] = [2.5e-3, 1e-3];

impl WellLook {
    /// Its heap; `None` for a jar.
    #[must_use]
    pub fn heap(&self) -> Option<&HeapCells> {
        match &self.shape {
            WellShape::Heap(heap, _) => Some(heap),
            WellShape::Jar(_) => None,
        }
    }

    /// Its height in a cell of the surface, m, and its colour. Light from the upper left shines through the far side of
    /// a jar's contents.
    fn at(&self, cell: [i64; 2]) -> (f32, [f32; 3]) {
        let rgb = match &self.shape {
            WellShape::Heap(heap, colours) => {
                let thickness_m = heap.thickness_m(cell);
                return (thickness_m, colours.at(thickness_m.into()));
            }
            WellShape::Jar(rgb) => rgb,
        };
        let [x, y] = [0, 1].map(|i| (cell[i] as f64 + 0.5 - self.center[i]) / self.radius);
        if x * x + y * y > WALL * WALL {
            return (JAR_M[0], GLASS_RGB);
        }
        let through = 1.0 + 0.45 * (x - y) / WALL;
        (JAR_M[1], rgb.map(|channel| channel * through as f32))
    }
}

/// A cell of a tile that is in a well.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WellCell {
    /// Its place in the tile.
    pub cell: usize,
    /// True if the well hides the traces of brushes there.
    pub hides: bool,
    /// Its unlit colour, linear sRGB.
    pub rgb: [f32; 3],
    /// Its height, m; 0 beside a heap that does not fill its well.
    pub height_m: f32,
}

/// A surface without its painting.
#[derive(Clone, Debug)]
pub struct BlankSurface {
    /// Columns and rows of its cells.
    pub cells: [u32; 2],
    /// Ground of the primed surface.
    pub ground: Ground,
    /// Heights of the ground under the paint.
    pub relief: Arc<Relief>,
    /// Its wells.
    pub wells: Vec<WellLook>,
}

impl BlankSurface {
    /// Columns and rows of a tile's cells that lie on it.
    pub(crate) fn cells_of(&self, id: TileId) -> [usize; 2] {
        let before = [id.x, id.y].map(|tile| tile as usize * TILE);
        [0, 1].map(|i| (self.cells[i] as usize).saturating_sub(before[i]).min(TILE))
    }

    /// The places in a tile of its cells that lie in a well.
    pub fn cells_in_wells(&self, id: TileId) -> impl Iterator<Item = usize> {
        let wells = self.wells.iter();
        wells.flat_map(move |well| cells_in_circle(well.center, well.radius, id))
    }

    /// The cells of a tile that lie in a well.
    pub fn in_wells(&self, id: TileId) -> impl Iterator<Item = WellCell> {
        let corner = [id.x, id.y].map(|tile| i64::from(tile) * TILE as i64);
        let wells = self.wells.iter();
        wells.flat_map(move |well| {
            cells_in_circle(well.center, well.radius, id).map(move |cell| {
                let within = [cell % TILE, cell / TILE].map(|at| at as i64);
                let (height_m, rgb) = well.at([0, 1].map(|i| corner[i] + within[i]));
                WellCell {
                    cell,
                    hides: matches!(well.shape, WellShape::Jar(_)),
                    rgb,
                    height_m,
                }
            })
        })
    }
}

/// Cells of a tile whose middle is within a circle, whose center and radius are in cells.
pub fn cells_in_circle(center: [f64; 2], radius: f64, id: TileId) -> impl Iterator<Item = usize> {
    let corner = [f64::from(id.x), f64::from(id.y)].map(|tile| tile * TILE as f64);
    let span = move |i: usize| {
        let inside = |cell: f64| (cell - corner[i]).clamp(0.0, TILE as f64) as usize;
        inside((center[i] - radius).floor())..inside((center[i] + radius).ceil())
    };
    span(1)
        .flat_map(move |y| span(0).map(move |x| (x, y)))
        .filter(move |(x, y)| {
            let dx = corner[0] + *x as f64 + 0.5 - center[0];
            let dy = corner[1] + *y as f64 + 0.5 - center[1];
            dx * dx + dy * dy < radius * radius
        })
        .map(|(x, y)| y * TILE + x)
}
