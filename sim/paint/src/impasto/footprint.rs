//! Stage 1: the cells that the head touches, what touches them and how deep it reaches.
//!
//! Strips are ribbons that turn their flat side to the surface (Baxter 2004, § 3.5.2). In each cell
//! the deepest one counts. It touches where it, with the film of paint that it carries, reaches the
//! top of what lies there: tooth, dry relief and wet paint. All lengths are in cells.

use maulstick_brush::head::STATIONS;
use maulstick_brush::{Head, HeadPose};

use maulstick_num::wide;

use super::drawing::{Drawing, Line, Piece};
use crate::load::ALONG;
use crate::model::{Step, StepReport};
use crate::window::{Area, Window};

/// Strips of the same depth lie over each other in the order of their roots along the way that the
/// head is bent (Baxter 2004, § 3.5.2), the last this much higher, cells.
const RANKS: f32 = 0.02;
/// A head that is bent by this share of its length has that order in full.
const BENT: f32 = 0.2;
/// A cell in contact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Contact {
    /// Its place in the window's planes.
    pub cell: u32,
    /// Its place in the planes of the cells [around](Footprint::around).
    pub local: u32,
    /// The brush texel that touches it: `strip · ALONG + along`.
    pub texel: u32,
    /// Share of the cell that is covered, 0 to 1.
    pub cover: f32,
    /// How far the strip went since the step before, cells.
    pub moved: [f32; 2],
    /// How deep it reaches below the top of the wet paint, cells; at most its thickness.
    pub depth: f32,
    /// `depth` by the thickness of the wet paint, 0 to 1.
    pub fraction: f32,
}

/// The footprint of one step.
#[derive(Clone, Debug, Default)]
pub struct Footprint {
    /// The cells in contact, row after row.
    pub contacts: Vec<Contact>,
    /// The cells of the window on which the head is drawn.
    pub grid: Area,
    /// The contacts and one cell more to each side, as far as the surface goes: where paint may move.
    pub around: Area,
    /// Wet quanta of all paints on each contact, before the step.
    pub wet: Vec<f32>,
    /// The same on the cells of the grid, and afterwards on those around.
    lying: Vec<f32>,
    /// The surface's coordinates of the grid's lower left corner.
    pub(super) offset: [f32; 2],
    pub(super) drawing: Drawing,
}

/// A point of a ribbon's middle line.
#[derive(Clone, Copy, Debug)]
struct Point {
    at: [f32; 3],
    moved: [f32; 2],
    /// Place along the strip in texels.
    along: f32,
}

/// What of a ribbon is the same along it.
#[derive(Clone, Copy, Debug)]
struct Ribbon {
    strip: usize,
    /// Its lower side above the middle line, cells.
    bottom: f32,
    /// Among strips of the same depth it counts as higher by this much, cells.
    rank: f32,
    /// How far it goes on past its end, cells.
    past: f32,
}

impl Point {
    fn toward(&self, other: &Self, t: f32) -> Self {
        let mix = |a: f32, b: f32| a + (b - a) * t;
        Self {
            at: [0, 1, 2].map(|i| mix(self.at[i], other.at[i])),
            moved: [0, 1].map(|i| mix(self.moved[i], other.moved[i])),
            along: mix(self.along, other.along),
        }
    }
}

wide! {
    fn draw_strips(footprint: &mut Footprint, step: &Step<'_>, top: f32, loose: f32, pressed: f32) {
        for strip in 0..step.head.strips() {
            let ribbon = Ribbon {
                strip,
                bottom: loose * step.head.lift()[strip] - pressed,
                rank: rank(step.head, step.sweep.to, strip),
                past: 0.0,
            };
            let film = step.load.thickest_of(strip) as f32 * step.traits.film_cells_per_quantum;
            footprint.draw_strip(step, ribbon, top + film - ribbon.bottom);
        }
    }
}

impl Footprint {
    /// Finds what the head touches after the step's motion.
    pub fn find(&mut self, step: &mut Step<'_>) {
        self.contacts.clear();
        let traits = step.traits;
        let pressed = traits.half_thickness + traits.sink * step.sweep.to.press;
        self.lay_grid(step.window, step.bounds.0, step.bounds.1);
        if self.grid.is_empty() {
            return;
        }
        step.window.weigh(&self.grid, &mut self.lying);
        // Of the cells around the brush alone: what else the window holds must not matter.
        let top = self.highest(&self.grid, step.window, traits.cells_per_quantum);
        step.window.note_top(top / traits.cells_per_quantum);
        let loose = traits.lift * (1.0 - step.sweep.to.press);
        let film = step.load.thickest() as f32 * traits.film_cells_per_quantum;
        self.draw_skin(
            step,
            top + film,
            traits.recede * step.sweep.to.splay - pressed,
        );
        draw_strips(self, step, top, loose, pressed);
        self.touch(step);
    }

    /// Draws those segments of a strip that come below `height`.
    #[inline(always)]
    fn draw_strip(&mut self, step: &Step<'_>, mut ribbon: Ribbon, height: f32) {
        let (before, after) = (step.sweep.from, step.sweep.to);
        let strips = step.head.strips();
        let point = |station: usize| {
            let i = station * strips + ribbon.strip;
            Point {
                at: [after.x[i], after.y[i], after.z[i]],
                moved: [after.x[i] - before.x[i], after.y[i] - before.y[i]],
                along: station as f32 * (ALONG as f32 / (STATIONS - 1) as f32),
            }
        };
        for station in 1..STATIONS {
            let i = station * strips + ribbon.strip;
            if after.z[i - strips].min(after.z[i]) >= height {
                continue;
            }
            let (p, q) = below(&point(station - 1), &point(station), height);
            ribbon.past = if station == STATIONS - 1 { 0.5 } else { 0.0 };
            let half_width = step.traits.half_width_before(station);
            self.draw(&ribbon, half_width, &p, &q);
        }
    }

    /// The grid around the cells `from`..`to` of the surface, cut to the window and the surface.
    fn lay_grid(&mut self, window: &Window, from: [i64; 2], to: [i64; 2]) {
        self.grid = window.area(from, to);
        self.drawing.begin(self.grid.size);
        // Strips are drawn in the coordinates of the surface.
        let origin = window.origin();
        self.offset = [0, 1].map(|i| (origin[i] + self.grid.from[i] as i64) as f32);
    }

    /// Draws a ribbon from `a` to `b`: of each column of cells, or each row where it goes rather up
    /// than across, those whose middle it covers, and with a soft edge half a cell to either side.
    #[inline(always)]
    fn draw(&mut self, ribbon: &Ribbon, half_width: f32, a: &Point, b: &Point) {
        let start = [a.at[0] - self.offset[0], a.at[1] - self.offset[1]];
        let d = [b.at[0] - a.at[0], b.at[1] - a.at[1]];
        let major = usize::from(d[1].abs() > d[0].abs());
        let length = d[major].abs();
        // Segments of a strip share their ends: each has the columns from its first up to its last,
        // and the last segment goes on past the tip.
        let (low, high) = if d[major] >= 0.0 {
            (start[major], start[major] + length + ribbon.past)
        } else {
            (start[major] - length - ribbon.past, start[major])
        };
        let last = self.grid.size[major] as f32;
        let column = |edge: f32| ((edge + 0.5).clamp(0.0, last)) as usize;
        let columns = column(low)..column(high);
        if columns.is_empty() {
            return;
        }
        let inverse = if length > 1e-4 { 1.0 / d[major] } else { 0.0 };
        let slope = d[1 - major] * inverse;
        let piece = Piece {
            texel: (ribbon.strip * ALONG) as u32,
            along: [a.along, b.along - a.along],
            z: [a.at[2], b.at[2] - a.at[2]],
            bottom: ribbon.bottom,
            rank: ribbon.rank,
            moved: [a.moved, [0, 1].map(|i| b.moved[i] - a.moved[i])],
            line: Line {
                major,
                start,
                inverse,
                slope,
                cosine: 1.0 / (1.0 + slope * slope).sqrt(),
                reach: half_width + 0.5,
            },
        };
        self.drawing.draw(&piece, columns);
    }

    /// The highest that paint stands on a cell of an area on which `lying` was weighed, cells; 0 where
    /// none does.
    fn highest(&self, area: &Area, window: &Window, to_cells: f32) -> f32 {
        let rows = area.rows(window.width());
        let lying = self.lying.chunks_exact(area.size[0].max(1));
        rows.zip(lying).fold(0.0, |most, (row, lying)| {
            highest_of(lying, &window.base()[row], to_cells).max(most)
        })
    }

    /// Notes how high paint stands where the brush has left it.
    pub fn note_left(&mut self, step: &mut Step<'_>) {
        step.window.weigh(&self.around, &mut self.lying);
        let top = self.highest(&self.around, step.window, step.traits.cells_per_quantum);
        step.window.note_top(top / step.traits.cells_per_quantum);
    }

    /// Which of the covered cells are touched.
    fn touch(&mut self, step: &Step<'_>) {
        self.wet.clear();
        let window: &Window = step.window;
        let to_cells = step.traits.cells_per_quantum;
        let film_cells = step.traits.film_cells_per_quantum;
        let films = step.load.films();
        let [width, height] = self.grid.size;
        let (mut from, mut to) = ([usize::MAX; 2], [0; 2]);
        for y in 0..height {
            let row = (self.grid.from[1] + y) * window.width() + self.grid.from[0];
            let lying = &self.lying[y * width..(y + 1) * width];
            let base = &window.base()[row..row + width];
            let (mut first, mut last) = (usize::MAX, 0);
            for x in 0..width {
                let Some(over) = self.drawing.over(x, y) else {
                    continue;
                };
                let texel = over.texel();
                let wet = lying[x] * to_cells;
                let reach = base[x] + wet - over.bottom();
                if reach + films[texel as usize] as f32 * film_cells <= 0.0 {
                    continue;
                }
                (first, last) = (first.min(x), x);
                let depth = reach.clamp(0.0, wet);
                self.wet.push(lying[x]);
                self.contacts.push(Contact {
                    cell: (row + x) as u32,
                    local: (y * width + x) as u32,
                    texel,
                    cover: over.cover,
                    moved: over.moved(),
                    depth,
                    fraction: if wet > 0.0 { depth / wet } else { 0.0 },
                });
            }
            if first <= last {
                from = [from[0].min(first), from[1].min(y)];
                to = [to[0].max(last + 1), y + 1];
            }
        }
        self.lay_around(window, from, to);
    }

    /// The cells around the contacts, which lie in `from`..`to` of the grid.
    fn lay_around(&mut self, window: &Window, from: [usize; 2], to: [usize; 2]) {
        self.around = Area::default();
        if self.contacts.is_empty() {
            return;
        }
        let limit = window.limit();
        let from = [0, 1].map(|i| (self.grid.from[i] + from[i]).saturating_sub(1));
        let size = [0, 1].map(|i| (self.grid.from[i] + to[i] + 1).min(limit[i]) - from[i]);
        self.around = Area { from, size };
        let inset = [0, 1].map(|i| self.grid.from[i] as i64 - from[i] as i64);
        let (width, row) = (self.grid.size[0] as u32, size[0] as i64);
        for contact in &mut self.contacts {
            let (x, y) = (contact.local % width, contact.local / width);
            let place = (i64::from(y) + inset[1]) * row + i64::from(x) + inset[0];
            contact.local = place as u32;
        }
    }

    /// How much wet paint lies under the brush before the step.
    #[must_use]
    pub fn report(&self, step: &Step<'_>) -> StepReport {
        let wet = self.wet.iter().map(|quanta| *quanta as u64);
        let thinner = step.thinner.and_then(|slot| step.window.plane(slot));
        let thinner = thinner.map_or(0, |plane| {
            let cells = self.contacts.iter().map(|contact| contact.cell as usize);
            cells.map(|cell| plane[cell] as u64).sum()
        });
        StepReport {
            footprint_cells: self.contacts.len() as u64,
            wet: wet.sum(),
            thinner,
            ..StepReport::default()
        }
    }

    /// The cells of the window that the step may have changed: from, up to but not with.
    #[must_use]
    pub fn reached(&self) -> ([usize; 2], [usize; 2]) {
        let Area { from, size } = self.around;
        (from, [from[0] + size[0], from[1] + size[1]])
    }
}

/// The highest that paint of `lying` quanta stands on `base`, cells; 0 where none does.
fn highest_of(lying: &[f32], base: &[f32], to_cells: f32) -> f32 {
    let mut highest = [0.0f32; 8];
    let (runs, bases) = (lying.chunks_exact(8), base.chunks_exact(8));
    let rest = runs.remainder().iter().zip(bases.remainder());
    for (lying, base) in runs.zip(bases) {
        for i in 0..8 {
            let height = base[i] + lying[i] * to_cells;
            highest[i] = if height > highest[i] {
                height
            } else {
                highest[i]
            };
        }
    }
    let rest = rest.map(|(lying, base)| base + lying * to_cells);
    rest.chain(highest).fold(0.0, f32::max)
}

/// By how much a strip counts as higher among those of the same depth, cells: of a head that lies to
/// one side, the bristles rooted on that side lie on the others.
#[must_use]
pub fn rank(head: &Head, pose: &HeadPose, strip: usize) -> f32 {
    let ([x, y], [to_x, to_y]) = (head.roots()[strip], pose.bend);
    let bent = (to_x * to_x + to_y * to_y).sqrt();
    let inner = (x * to_x + y * to_y) / bent.max(BENT);
    RANKS * (0.5 + 0.25 * (inner + head.lift()[strip]))
}

/// The part of a ribbon that lies below `height`.
fn below(a: &Point, b: &Point, height: f32) -> (Point, Point) {
    let (za, zb) = (a.at[2], b.at[2]);
    if za > height {
        (a.toward(b, (za - height) / (za - zb)), *b)
    } else if zb > height {
        (*a, a.toward(b, (height - za) / (zb - za)))
    } else {
        (*a, *b)
    }
}
