//! The strips of a head as pieces of ribbons on a grid (Baxter 2004, § 3.5.2). They are found once, by strips, and drawn
//! by rows.

use std::ops::Range;

use maulstick_brush::head::STATIONS;
use maulstick_brush::{Head, HeadPose};
use maulstick_canvas::window::Area;
use maulstick_num::fork_join::each;
use maulstick_num::select::smaller;
use maulstick_num::wide;

use super::piece::{Line, Piece};
use super::shares_of;
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
}

/// A piece on the grid.
#[derive(Clone, Debug)]
pub(super) struct Laid {
    pub(super) piece: Piece,
    /// The columns that it covers, or the rows where it goes rather up than across.
    pub(super) columns: Range<usize>,
    /// The rows.
    pub(super) rows: Range<usize>,
}

/// The strips drawn by one core.
#[derive(Clone, Debug, Default)]
struct Share {
    strips: Range<usize>,
    /// Height of the lowest point of each strip, cells.
    lowest: Vec<f32>,
    laid: Vec<Laid>,
}

/// The pieces of all strips of a head that come low enough.
#[derive(Clone, Debug, Default)]
pub(super) struct Ribbons {
    shares: Vec<Share>,
    used: usize,
}

/// The grid, and the surface's coordinates of its lower left corner.
#[derive(Clone, Copy)]
struct Under {
    grid: Area,
    offset: [f32; 2],
}

impl Point {
    fn of(step: &Step<'_>, strip: usize, station: usize) -> Self {
        let (before, after) = (step.sweep.from, step.sweep.to);
        let i = station * step.head.strips() + strip;
        Self {
            at: [
                middle(after.x[i], before.x[i]),
                middle(after.y[i], before.y[i]),
                middle(after.z[i], before.z[i]),
            ],
            moved: [after.x[i] - before.x[i], after.y[i] - before.y[i]],
            along: station as f32 * (TEXELS_PER_STRIP as f32 / (STATIONS - 1) as f32),
        }
    }

    fn toward(&self, other: &Self, t: f32) -> Self {
        let mix = |a: f32, b: f32| a + (b - a) * t;
        Self {
            at: [0, 1, 2].map(|i| mix(self.at[i], other.at[i])),
            moved: [0, 1].map(|i| mix(self.moved[i], other.moved[i])),
            along: mix(self.along, other.along),
        }
    }
}

impl Ribbons {
    /// Lays out the parts of the strips on a grid that, with their paint, are below `top`, cells.
    pub(super) fn lay(&mut self, step: &Step<'_>, grid: Area, offset: [f32; 2], top: f32) {
        let strips = step.head.strips();
        self.used = shares_of(grid.cells()).min(strips.max(1));
        let shares = self.shares.len().max(self.used);
        self.shares.resize_with(shares, Share::default);
        let shares = &mut self.shares[..self.used];
        let count = shares.len();
        for (i, share) in shares.iter_mut().enumerate() {
            share.strips = strips * i / count..strips * (i + 1) / count;
        }
        let under = Under { grid, offset };
        each(shares, |share| share.lay(step, under, top));
    }

    /// All pieces: strip after strip, from the root on.
    pub(super) fn laid(&self) -> impl Iterator<Item = &Laid> {
        self.shares[..self.used]
            .iter()
            .flat_map(|share| &share.laid)
    }

    /// One of them.
    #[inline]
    pub(super) fn piece(&self, mut number: usize) -> Option<&Piece> {
        for share in &self.shares[..self.used] {
            match share.laid.get(number) {
                Some(laid) => return Some(&laid.piece),
                None => number -= share.laid.len(),
            }
        }
        None
    }
}

impl Share {
    fn lay(&mut self, step: &Step<'_>, under: Under, top: f32) {
        self.laid.clear();
        let (lift, turned) = (step.head.lift(), step.load.seed() as usize);
        let loose = step.traits.loose(step.sweep.to.press);
        let film = |quanta: u32| quanta as f32 * step.traits.film_cells_per_quantum;
        let most = top + film(step.load.thickest());
        let Self { strips, lowest, .. } = self;
        find_lowest(step, strips.clone(), lowest);
        for strip in self.strips.clone() {
            let lowest = self.lowest[strip - self.strips.start];
            if lowest >= most {
                continue;
            }
            // Another load has other bristles stand out.
            let bottom = loose * lift[(strip + turned) % lift.len()];
            let height = top + film(step.load.thickest_of(strip)) - bottom;
            if lowest < height {
                let rank = rank(step.head, step.sweep.to, strip);
                let ribbon = Ribbon {
                    strip,
                    bottom,
                    rank,
                };
                self.lay_strip(step, under, ribbon, height);
            }
        }
    }

    /// Lays out the segments of a strip below `height`.
    fn lay_strip(&mut self, step: &Step<'_>, under: Under, ribbon: Ribbon, height: f32) {
        let (z, strips) = ([&step.sweep.to.z, &step.sweep.from.z], step.head.strips());
        let z = |station: usize| {
            let [after, before] = z.map(|z| z[station * strips + ribbon.strip]);
            middle(after, before)
        };
        let mut begins = z(0);
        for station in 1..STATIONS {
            let ends = z(station);
            if begins.min(ends) < height {
                let point = |station| Point::of(step, ribbon.strip, station);
                let both = below(&point(station - 1), &point(station), height);
                let ends = [begins > height, ends > height || station == STATIONS - 1];
                let half = step.traits.half_width_before(station);
                let round = 2.0 * step.traits.half_thickness;
                self.laid
                    .extend(under.piece(ribbon, &both, [half, round], ends));
            }
            begins = ends;
        }
    }
}

wide! {
    /// Height of the lowest point of each strip in the middle of a step.
    fn find_lowest(step: &Step<'_>, strips: Range<usize>, lowest: &mut Vec<f32>) {
        let sweep = &step.sweep;
        lowest.clear();
        lowest.resize(strips.len(), f32::MAX);
        for station in 0..STATIONS {
            let from = station * step.head.strips();
            let row = from + strips.start..from + strips.end;
            let heights = sweep.to.z[row.clone()].iter().zip(&sweep.from.z[row]);
            for (lowest, (after, before)) in lowest.iter_mut().zip(heights) {
                *lowest = smaller(*lowest, middle(*after, *before));
            }
        }
    }
}

impl Under {
    /// A ribbon between two points during the motion of the step: for each column of cells, or each row for a rather
    /// upright ribbon, the covered cells, each by the share of its area and of the path. `ends` is true where its
    /// touching part begins here, and where it ends here.
    fn piece(
        &self,
        ribbon: Ribbon,
        [a, b]: &[Point; 2],
        [half, round]: [f32; 2],
        ends: [bool; 2],
    ) -> Option<Laid> {
        let start = [a.at[0] - self.offset[0], a.at[1] - self.offset[1]];
        let d = [b.at[0] - a.at[0], b.at[1] - a.at[1]];
        let way = [0, 1].map(|i| 0.5 * (a.moved[i] + b.moved[i]));
        let (line, [low, high]) = Line::swept(start, d, way, half, ends);
        let last = self.grid.size[line.major] as f32;
        let column = |edge: f32| ((edge + 0.5).clamp(0.0, last)) as usize;
        let columns = column(low)..column(high);
        if columns.is_empty() {
            return None;
        }
        let rows = match line.major {
            0 => line.rows(&columns, self.grid.size[1]),
            _ => columns.clone(),
        };
        let piece = Piece {
            texel: (ribbon.strip * TEXELS_PER_STRIP) as u32,
            along: [a.along, b.along - a.along],
            z: [a.at[2], b.at[2] - a.at[2]],
            bottom: ribbon.bottom,
            round,
            rank: ribbon.rank,
            moved: [a.moved, [0, 1].map(|i| b.moved[i] - a.moved[i])],
            line,
        };
        Some(Laid {
            piece,
            columns,
            rows,
        })
    }
}

/// Value in the middle of a step from `before` to `after`.
#[must_use]
#[inline(always)]
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
fn below(a: &Point, b: &Point, height: f32) -> [Point; 2] {
    let (za, zb) = (a.at[2], b.at[2]);
    if za > height {
        [a.toward(b, (za - height) / (za - zb)), *b]
    } else if zb > height {
        [*a, a.toward(b, (height - za) / (zb - za))]
    } else {
        [*a, *b]
    }
}
