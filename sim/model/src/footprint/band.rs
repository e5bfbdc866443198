//! A band of the footprint: the rows of it that one core finds.

use std::ops::Range;

use maulstick_brush::head::STATIONS;
use maulstick_brush::{Head, HeadPose};
use maulstick_canvas::window::Area;
use maulstick_num::lanes::Lanes;
use maulstick_num::wide;

use super::contact::Contact;
use super::rasterizer::{Drawing, Line, Piece};
use crate::brush::traits::TEXELS_PER_STRIP;
use crate::interface::Step;

/// Range of the ranks of strips of the same depth, cells: they overlap in the order of their roots along the direction
/// in which the head is bent (Baxter 2004, § 3.5.2), the last this much higher.
const RANKS: f32 = 0.02;
/// A head that is bent by this share of its length has that order in full.
const BENT: f32 = 0.2;
/// A point of a ribbon's middle line.
#[derive(Clone, Copy, Debug)]
struct Point {
    at: [f32; 3],
    moved: [f32; 2],
    /// Place along the strip in texels.
    along: f32,
}

/// Values that are constant along a ribbon.
#[derive(Clone, Copy, Debug)]
struct Ribbon {
    strip: usize,
    /// Clearance over what it lies on, cells.
    bottom: f32,
    /// Among strips of the same depth it counts as higher by this much, cells.
    rank: f32,
    /// Half its width, cells.
    half: f32,
    /// True where its touching part begins here, and where it ends here.
    ends: [bool; 2],
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
    fn draw_strips<L>(band: &mut Band, step: &Step<'_>, top: f32, loose: f32) {
        let (lift, turned) = (step.head.lift(), step.load.seed() as usize);
        for strip in 0..step.head.strips() {
            let ribbon = Ribbon {
                strip,
                // Another load has other bristles stand out.
                bottom: loose * lift[(strip + turned) % lift.len()],
                rank: rank(step.head, step.sweep.to, strip),
                half: 0.0,
                ends: [false; 2],
            };
            let film = step.load.thickest_of(strip) as f32 * step.traits.film_cells_per_quantum;
            band.draw_strip::<L>(step, ribbon, top + film - ribbon.bottom);
        }
    }
}

/// The rows of a footprint that one core finds.
#[derive(Clone, Debug, Default)]
pub(super) struct Band {
    /// The cells in contact, row after row; their local places are those on the grid.
    pub(super) contacts: Vec<Contact>,
    /// Wet quanta of all paints on each contact, before the step.
    pub(super) wet: Vec<f32>,
    /// Columns and rows of the grid that hold the contacts: from, up to but not with.
    pub(super) reach: ([usize; 2], [usize; 2]),
    /// The whole footprint's cells.
    pub(super) grid: Area,
    /// The surface's coordinates of the grid's lower left corner.
    pub(super) offset: [f32; 2],
    pub(super) drawing: Drawing,
}

impl Band {
    /// The reach of none.
    pub(super) const NOWHERE: ([usize; 2], [usize; 2]) = ([usize::MAX; 2], [0; 2]);

    /// Nothing.
    pub(super) fn clear(&mut self) {
        self.contacts.clear();
        self.wet.clear();
        self.reach = Self::NOWHERE;
    }

    /// Nothing on those rows of a grid.
    pub(super) fn begin(&mut self, grid: Area, offset: [f32; 2], rows: Range<usize>) {
        self.clear();
        self.grid = grid;
        self.offset = offset;
        self.drawing.begin(grid.size, rows);
    }

    /// Draws those parts of the head that, with their paint, come below `top`, cells.
    pub(super) fn draw_head(&mut self, step: &Step<'_>, top: f32) {
        let (traits, to) = (&step.traits, step.sweep.to);
        let film = step.load.thickest() as f32 * traits.film_cells_per_quantum;
        self.draw_skin(step, top + film, traits.recede * to.splay);
        draw_strips(self, step, top, traits.loose(to.press));
    }

    /// Draws those segments of a strip that come below `height`.
    #[inline(always)]
    fn draw_strip<L: Lanes>(&mut self, step: &Step<'_>, mut ribbon: Ribbon, height: f32) {
        let (before, after) = (step.sweep.from, step.sweep.to);
        let strips = step.head.strips();
        let height_at = |i: usize| middle(after.z[i], before.z[i]);
        let point = |station: usize| {
            let i = station * strips + ribbon.strip;
            let moved = [after.x[i] - before.x[i], after.y[i] - before.y[i]];
            Point {
                at: [
                    middle(after.x[i], before.x[i]),
                    middle(after.y[i], before.y[i]),
                    height_at(i),
                ],
                moved,
                along: station as f32 * (TEXELS_PER_STRIP as f32 / (STATIONS - 1) as f32),
            }
        };
        for station in 1..STATIONS {
            let i = station * strips + ribbon.strip;
            let (first, last) = (height_at(i - strips), height_at(i));
            if first.min(last) >= height {
                continue;
            }
            let (p, q) = below(&point(station - 1), &point(station), height);
            ribbon.ends = [first > height, last > height || station == STATIONS - 1];
            ribbon.half = step.traits.half_width_before(station);
            self.draw::<L>(step, &ribbon, &p, &q);
        }
    }

    /// Draws a ribbon from `a` to `b` as it goes over the cells in the step: of each column of cells, or each row where
    /// it goes rather up than across, those that it covers, each by the share of its area and of the path.
    #[inline(always)]
    fn draw<L: Lanes>(&mut self, step: &Step<'_>, ribbon: &Ribbon, a: &Point, b: &Point) {
        let start = [a.at[0] - self.offset[0], a.at[1] - self.offset[1]];
        let d = [b.at[0] - a.at[0], b.at[1] - a.at[1]];
        let way = [0, 1].map(|i| 0.5 * (a.moved[i] + b.moved[i]));
        let (line, [low, high]) = Line::swept(start, d, way, ribbon.half, ribbon.ends);
        let last = self.grid.size[line.major] as f32;
        let column = |edge: f32| ((edge + 0.5).clamp(0.0, last)) as usize;
        let columns = column(low)..column(high);
        if columns.is_empty() {
            return;
        }
        let piece = Piece {
            texel: (ribbon.strip * TEXELS_PER_STRIP) as u32,
            along: [a.along, b.along - a.along],
            z: [a.at[2], b.at[2] - a.at[2]],
            bottom: ribbon.bottom,
            round: 2.0 * step.traits.half_thickness,
            rank: ribbon.rank,
            moved: [a.moved, [0, 1].map(|i| b.moved[i] - a.moved[i])],
            line,
        };
        self.drawing.draw::<L>(&piece, columns);
    }

    /// Finds the covered cells that are touched.
    pub(super) fn touch(&mut self, step: &Step<'_>, lying: &[f32], sink: f32) {
        let window = &*step.window;
        let to_cells = step.traits.cells_per_quantum;
        let film_cells = step.traits.film_cells_per_quantum;
        let films = step.load.films();
        let width = self.grid.size[0];
        let (from, to) = &mut self.reach;
        for y in self.drawing.rows() {
            let row = (self.grid.from[1] + y) * window.width() + self.grid.from[0];
            let lying = &lying[y * width..(y + 1) * width];
            let base = &window.base()[row..row + width];
            let ride = &window.ride()[row..row + width];
            let (mut first, mut last) = (usize::MAX, 0);
            for x in 0..width {
                let Some(over) = self.drawing.over(x, y) else {
                    continue;
                };
                let texel = over.texel();
                let wet = lying[x] * to_cells;
                let reach = base[x] + wet - over.bottom(ride[x], sink);
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
                    gap: (-reach).max(0.0),
                });
            }
            if first <= last {
                *from = [from[0].min(first), from[1].min(y)];
                *to = [to[0].max(last + 1), y + 1];
            }
        }
    }
}

/// Value in the middle of a step from `before` to `after`.
#[must_use]
pub fn middle(after: f32, before: f32) -> f32 {
    after - 0.5 * (after - before)
}

/// Added height of a strip among those of the same depth, cells: of a head bent to one side, the bristles rooted on
/// that side are above the others.
#[must_use]
pub fn rank(head: &Head, pose: &HeadPose, strip: usize) -> f32 {
    let ([x, y], [to_x, to_y]) = (head.roots()[strip], pose.bend);
    let bent = (to_x * to_x + to_y * to_y).sqrt();
    let inner = (x * to_x + y * to_y) / bent.max(BENT);
    RANKS * (0.5 + 0.25 * (inner + head.lift()[strip]))
}

/// The part of a ribbon below `height`.
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
