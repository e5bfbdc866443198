//! Stage 1: the cells that the head touches, what touches them and how deep it reaches.
//!
//! Strips are ribbons that turn their flat side to the surface (Baxter 2004, § 3.5.2). In each cell
//! the deepest one counts. It touches where it, with the film of paint that it carries, reaches the
//! top of what lies there: tooth, dry relief and wet paint. All lengths are in cells.

use maulstick_brush::head::STATIONS;
use maulstick_brush::{Head, HeadPose};

use crate::load::ALONG;
use crate::model::Step;
use crate::window::Window;

/// A ribbon that covers a cell only in part counts as higher by this much.
const EDGE_PENALTY: f32 = 0.3;
/// Strips of the same depth lie over each other in the order of their roots along the way that the
/// head is bent (Baxter 2004, § 3.5.2), the last this much higher, cells.
const RANKS: f32 = 0.02;
/// A head that is bent by this share of its length has that order in full.
const BENT: f32 = 0.2;
/// No strip here.
const NOTHING: u32 = u32::MAX;

/// A cell in contact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Contact {
    /// Its place in the window's planes.
    pub cell: u32,
    /// Its place in the footprint's own grid.
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
    /// Where the wet paint goes in this step, cells.
    pub velocity: [f32; 2],
}

/// What of the head reaches a cell: which segment, and where along it. Many are drawn over each other,
/// so the rest is found for those alone that are left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Fragment {
    pub(super) score: f32,
    pub(super) cover: f32,
    /// 0 at the segment's beginning, 1 at its end.
    pub(super) t: f32,
    pub(super) segment: u32,
}

const EMPTY: Fragment = Fragment {
    score: f32::MAX,
    cover: 0.0,
    t: 0.0,
    segment: NOTHING,
};

/// A piece of the head that was drawn: each quantity at its beginning, and how much it changes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Segment {
    /// The first texel of its strip.
    pub(super) texel: u32,
    /// Place along the strip in texels.
    pub(super) along: [f32; 2],
    /// Height of the middle line, cells.
    pub(super) z: [f32; 2],
    /// The lower side above the middle line, cells.
    pub(super) bottom: f32,
    /// How far it went since the step before, cells.
    pub(super) moved: [[f32; 2]; 2],
}

impl Segment {
    fn bottom(&self, t: f32) -> f32 {
        self.z[0] + t * self.z[1] + self.bottom
    }

    fn texel(&self, t: f32) -> u32 {
        let along = (self.along[0] + t * self.along[1]) as usize;
        self.texel + along.min(ALONG - 1) as u32
    }

    fn moved(&self, t: f32) -> [f32; 2] {
        let [from, change] = self.moved;
        [0, 1].map(|i| from[i] + t * change[i])
    }
}

/// The footprint of one step.
#[derive(Clone, Debug, Default)]
pub struct Footprint {
    /// The cells in contact, row after row.
    pub contacts: Vec<Contact>,
    /// Lowest column and row of the window that the footprint's grid holds.
    pub from: [usize; 2],
    /// Columns and rows of the grid.
    pub size: [usize; 2],
    /// The surface's coordinates of the grid's lower left corner.
    pub(super) offset: [f32; 2],
    /// Room for the penetration of the grid.
    pub(super) depth: Vec<f32>,
    pub(super) fragments: Vec<Fragment>,
    pub(super) segments: Vec<Segment>,
    /// Wet quanta of all paints on the grid's cells, before the step.
    wet: Vec<f32>,
    /// Those on the contacts, after it.
    left: Vec<f32>,
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

impl Footprint {
    /// Finds what the head touches after the step's motion.
    pub fn find(&mut self, step: &mut Step<'_>) {
        self.contacts.clear();
        let (head, traits) = (step.head, step.traits);
        let pressed = traits.half_thickness + traits.sink * step.sweep.to.press;
        self.lay_grid(step.window, step.bounds.0, step.bounds.1);
        if self.size.contains(&0) {
            return;
        }
        self.weigh(step.window);
        // Of the cells around the brush alone: what else the window holds must not matter.
        let top = self.highest(step.window, traits.cells_per_quantum);
        step.window.note_top(top / traits.cells_per_quantum);
        let loose = traits.lift * (1.0 - step.sweep.to.press);
        let film = step.load.thickest() as f32 * traits.film_cells_per_quantum;
        self.draw_skin(
            step,
            top + film,
            traits.recede * step.sweep.to.splay - pressed,
        );
        for strip in 0..head.strips() {
            let ribbon = Ribbon {
                strip,
                bottom: loose * head.lift()[strip] - pressed,
                rank: rank(head, step.sweep.to, strip),
                past: 0.0,
            };
            let film = step.load.thickest_of(strip) as f32 * traits.film_cells_per_quantum;
            self.draw_strip(step, ribbon, top + film - ribbon.bottom);
        }
        self.touch(step);
    }

    /// Draws those segments of a strip that come below `height`.
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
        let origin = window.origin();
        let limit = window.limit();
        let inside = |value: i64, i: usize| (value - origin[i]).clamp(0, limit[i] as i64) as usize;
        self.from = [0, 1].map(|i| inside(from[i], i));
        let to = [0, 1].map(|i| inside(to[i], i));
        self.size = [0, 1].map(|i| to[i].saturating_sub(self.from[i]));
        self.segments.clear();
        self.fragments.clear();
        self.fragments.resize(self.size[0] * self.size[1], EMPTY);
        // Strips are drawn in the coordinates of the surface.
        self.offset = [0, 1].map(|i| (origin[i] + self.from[i] as i64) as f32);
    }

    /// Draws a ribbon from `a` to `b`: of each column of cells, or each row where it goes rather up
    /// than across, those whose middle it covers, and with a soft edge half a cell to either side.
    fn draw(&mut self, ribbon: &Ribbon, half_width: f32, a: &Point, b: &Point) {
        let start = [a.at[0] - self.offset[0], a.at[1] - self.offset[1]];
        let d = [b.at[0] - a.at[0], b.at[1] - a.at[1]];
        let major = usize::from(d[1].abs() > d[0].abs());
        let minor = 1 - major;
        let length = d[major].abs();
        let inverse = if length > 1e-4 { 1.0 / d[major] } else { 0.0 };
        let slope = d[minor] * inverse;
        let cosine = 1.0 / (1.0 + slope * slope).sqrt();
        let reach = half_width + 0.5;
        let across = reach / cosine;
        // Segments of a strip share their ends: each has the columns from its first up to its last,
        // and the last segment goes on past the tip.
        let forward = d[major] >= 0.0;
        let (low, high) = if forward {
            (start[major], start[major] + length + ribbon.past)
        } else {
            (start[major] - length - ribbon.past, start[major])
        };
        let last = self.size[major] as f32;
        let column = |edge: f32| ((edge + 0.5).clamp(0.0, last)) as usize;
        let stride = [1, self.size[0]];
        let edge = self.size[minor] as f32;
        let columns = column(low)..column(high);
        if columns.is_empty() {
            return;
        }
        let segment = Segment {
            texel: (ribbon.strip * ALONG) as u32,
            along: [a.along, b.along - a.along],
            z: [a.at[2], b.at[2] - a.at[2]],
            bottom: ribbon.bottom,
            moved: [a.moved, [0, 1].map(|i| b.moved[i] - a.moved[i])],
        };
        let number = self.segments.len() as u32;
        self.segments.push(segment);
        let penalty = |cover: f32| (1.0 - cover) * EDGE_PENALTY;
        let fragments = self.fragments.as_mut_slice();
        for m in columns {
            let off = m as f32 + 0.5 - start[major];
            let t = (off * inverse).clamp(0.0, 1.0);
            let middle = start[minor] + off * slope - 0.5;
            let from = (middle - across + 1.0).clamp(0.0, edge) as usize;
            let to = (middle + across + 1.0).clamp(0.0, edge) as usize;
            let lowest = segment.bottom(t) + ribbon.rank;
            for n in from..to {
                let fragment = &mut fragments[m * stride[major] + n * stride[minor]];
                // However much of the cell it covers: most lie above what was drawn there before.
                if lowest >= fragment.score {
                    continue;
                }
                let cover = (reach - (n as f32 - middle).abs() * cosine).min(1.0);
                let score = lowest + penalty(cover);
                if cover > 0.0 && score < fragment.score {
                    *fragment = Fragment {
                        score,
                        cover,
                        t,
                        segment: number,
                    };
                }
            }
        }
    }

    /// Wet quanta of all paints in the grid's cells.
    fn weigh(&mut self, window: &Window) {
        let [width, height] = self.size;
        self.wet.clear();
        self.wet.resize(width * height, 0.0);
        for (_, plane) in window.planes() {
            for (y, row) in self.wet.chunks_exact_mut(width).enumerate() {
                let start = (self.from[1] + y) * window.width() + self.from[0];
                row.iter_mut()
                    .zip(&plane[start..start + width])
                    .for_each(|(sum, count)| *sum += count);
            }
        }
    }

    /// The highest that paint stands on a cell of the grid, cells; 0 where none does.
    fn highest(&self, window: &Window, to_cells: f32) -> f32 {
        let [width, _] = self.size;
        let mut highest = 0.0f32;
        for (y, row) in self.wet.chunks_exact(width).enumerate() {
            let start = (self.from[1] + y) * window.width() + self.from[0];
            let base = &window.base()[start..start + width];
            let heights = row
                .iter()
                .zip(base)
                .map(|(wet, base)| base + wet * to_cells);
            highest = heights.fold(highest, f32::max);
        }
        highest
    }

    /// Notes how high paint stands where the brush has left it.
    pub fn note_left(&mut self, step: &mut Step<'_>) {
        let quanta_per_cell = 1.0 / step.traits.cells_per_quantum;
        let window: &Window = step.window;
        let cells = self.contacts.iter().map(|contact| contact.cell);
        window.totals(cells, &mut self.left);
        let heights =
            self.contacts.iter().zip(&self.left).map(|(contact, left)| {
                left + window.base()[contact.cell as usize] * quanta_per_cell
            });
        let highest = heights.fold(0.0, f32::max);
        step.window.note_top(highest);
    }

    /// Which of the covered cells are touched.
    fn touch(&mut self, step: &Step<'_>) {
        let window: &Window = step.window;
        let to_cells = step.traits.cells_per_quantum;
        for y in 0..self.size[1] {
            let row = (self.from[1] + y) * window.width() + self.from[0];
            for x in 0..self.size[0] {
                let local = y * self.size[0] + x;
                let fragment = self.fragments[local];
                let Some(segment) = self.segments.get(fragment.segment as usize) else {
                    continue;
                };
                let texel = segment.texel(fragment.t);
                let cell = row + x;
                let wet = self.wet[local] * to_cells;
                let film =
                    step.load.film(texel as usize) as f32 * step.traits.film_cells_per_quantum;
                let reach = window.base()[cell] + wet - segment.bottom(fragment.t);
                if reach + film <= 0.0 {
                    continue;
                }
                let depth = reach.clamp(0.0, wet);
                self.contacts.push(Contact {
                    cell: cell as u32,
                    local: local as u32,
                    texel,
                    cover: fragment.cover,
                    moved: segment.moved(fragment.t),
                    depth,
                    fraction: if wet > 0.0 { depth / wet } else { 0.0 },
                    velocity: [0.0; 2],
                });
            }
        }
    }

    /// The cells of the window that the step may have changed: from, up to but not with.
    #[must_use]
    pub fn reached(&self) -> ([usize; 2], [usize; 2]) {
        let width = self.size[0];
        let (mut from, mut to) = ([usize::MAX; 2], [0; 2]);
        for contact in &self.contacts {
            let local = contact.local as usize;
            let at = [self.from[0] + local % width, self.from[1] + local / width];
            for i in 0..2 {
                from[i] = from[i].min(at[i].saturating_sub(1));
                to[i] = to[i].max(at[i] + 2);
            }
        }
        (from, to)
    }
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
