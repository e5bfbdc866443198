//! The brush as a raster of the canvas's cells (Baxter 2004, § 4.5.1, 4.5.3): it holds the brush's films, and is
//! blended with the canvas in place of the brush, at one place or several.

use std::ops::Range;

use maulstick_canvas::quantum::SLOTS;
use maulstick_canvas::window::Area;
use maulstick_model::brush::load::BrushLoad;
use maulstick_model::brush::traits::BrushTraits;
use maulstick_model::footprint::drawn::Drawn;
use maulstick_model::footprint::shares_of;
use maulstick_model::interface::Step;
use maulstick_model::transfer::Exchanging;
use maulstick_num::fork_join::each;
use maulstick_num::wide;

use crate::dither::Dither;
use crate::films::Films;
use crate::stroke::Way;
use crate::touching::{Brush, Canvas, Touching, touch};
use crate::transfer::{Limits, Paints, Row, blend};

/// Totals of a blend.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Met {
    /// Number of cells under the raster.
    pub under: u64,
    /// Number of touching cells.
    pub cells: u64,
    /// Wet quanta on the touching cells before.
    pub wet: u64,
    /// Quanta of thinner among them.
    pub thinner: u64,
    /// Cells of the window that may have changed.
    pub reached: Area,
}

/// The brush over the cells below it.
#[derive(Debug, Default)]
pub struct Raster {
    /// The head, drawn over the cells below it.
    pub drawn: Drawn,
    rate: Vec<f32>,
    way: Vec<f32>,
    films: Films,
    /// Contacts of a row, one for each core.
    touching: Vec<Touching>,
}

/// The rows that one core blends.
struct Share<'a> {
    /// Rows of the raster.
    rows: Range<usize>,
    touching: &'a mut Touching,
    brush: Vec<&'a mut [f32]>,
    canvas: Vec<&'a mut [f32]>,
    /// First and last of the touching rows.
    met: Option<[usize; 2]>,
    sums: [f64; 3],
}

/// A raster over a window.
struct Place<'a> {
    /// Planes of the raster: cover, rate, path, height and clearance.
    over: [&'a [f32]; 5],
    /// Planes of the window: height of the surface that catches paint, and height at which bristles ride.
    ground: [&'a [f32]; 2],
    /// Cells from row to row, of the raster and of the window.
    strides: [usize; 2],
    /// First blended cell on the raster.
    on: [usize; 2],
    /// Blended cells on the window.
    under: Area,
    /// The surface's cell at the window's corner.
    origin: [i64; 2],
    sink: f32,
    cells_per_quantum: f32,
    thinner: Option<usize>,
    limits: Limits,
    dither: Dither,
}

impl Met {
    /// Totals of what the cores blended in an area of the window.
    fn of(under: Area, shares: &[Share<'_>]) -> Self {
        let mut met = Self {
            under: under.cells() as u64,
            ..Self::default()
        };
        for share in shares {
            let [cells, wet, thinner] = share.sums.map(|sum| sum as u64);
            met.cells += cells;
            met.wet += wet;
            met.thinner += thinner;
        }
        let rows = shares.iter().filter_map(|share| share.met);
        let rows = rows.reduce(|[first, _], [_, last]| [first, last]);
        if let Some([first, last]) = rows {
            met.reached = Area {
                from: [under.from[0], first],
                size: [under.size[0], last + 1 - first],
            };
        }
        met
    }
}

impl<'a> Share<'a> {
    /// Shares of the cores in an area of the raster, of which the planes of brush and canvas hold the rows.
    fn of_cores(
        area: Area,
        strides: [usize; 2],
        [mut brush, mut canvas]: [Vec<&'a mut [f32]>; 2],
        touching: &'a mut Vec<Touching>,
    ) -> Vec<Self> {
        let count = shares_of(area.cells());
        let buffers = touching.len().max(count);
        touching.resize_with(buffers, Touching::default);
        let parts = area.parts(count).zip(touching);
        let shares = parts.map(|(part, touching)| Self {
            rows: part.from[1]..part.from[1] + part.size[1],
            touching,
            brush: split(&mut brush, part.size[1] * strides[0]),
            canvas: split(&mut canvas, part.size[1] * strides[1]),
            met: None,
            sums: [0.0; 3],
        });
        shares.collect()
    }

    fn blend(&mut self, place: &Place<'_>) {
        let columns = place.under.size[0];
        self.touching.begin(columns);
        for row in self.rows.clone() {
            let y = place.under.from[1] + row - place.on[1];
            let left = [place.on[0], place.under.from[0]];
            // Its planes begin with its own first row.
            let first = row - self.rows.start;
            let starts = [0, 1].map(|i| first * place.strides[i] + left[i]);
            let over = row * place.strides[0] + left[0];
            let [cover, rate, way, height, clearance] = place.over.map(|plane| &plane[over..]);
            let under = y * place.strides[1] + left[1];
            let [base, ride] = place.ground.map(|plane| &plane[under..]);
            let brush = Brush {
                count: columns,
                cover,
                rate,
                way,
                height,
                clearance,
                film: &self.brush,
                start: starts[0],
                sink: place.sink,
            };
            let canvas = Canvas {
                base,
                ride,
                wet: &self.canvas,
                thinner: place.thinner,
                start: starts[1],
                cells_per_quantum: place.cells_per_quantum,
            };
            let before = self.touching.cells;
            touch(&brush, &canvas, self.touching);
            if self.touching.cells == before {
                continue;
            }
            self.met = Some([self.met.map_or(y, |[first, _]| first), y]);
            let found = &*self.touching;
            let meetings = Row {
                rate: &found.rate,
                way: &found.way,
                reach: &found.reach,
                gap: &found.gap,
            };
            let mut paints = Paints {
                brush: &mut self.brush,
                canvas: &mut self.canvas,
                starts,
            };
            let at = [left[1], y];
            let at = [0, 1].map(|i| place.origin[i] + at[i] as i64);
            blend(&meetings, &place.limits, place.dither.at(at), &mut paints);
        }
        let found = &*self.touching;
        self.sums = [found.cells, found.wet[0], found.wet[1]];
    }
}

wide! {
    /// By cell, transferred share and path, both times the cover. The path of a strip is `by` plus
    /// `even` times its motion.
    fn shares(
        exchanging: &Exchanging, by_even: [f32; 2], cover_travel: [&[f32]; 2], rate_way: [&mut [f32]; 2],
    ) {
        let [by, even] = by_even;
        let [cover, travel] = cover_travel;
        let [rate, way] = rate_way;
        let cells = cover.iter().zip(travel).zip(rate.iter_mut().zip(way));
        for ((cover, travel), (rate, way)) in cells {
            let own = travel * by + even;
            *rate = exchanging.share(own) * cover;
            *way = own * cover;
        }
    }
}

impl Raster {
    /// Quanta of a paint on each cell of the raster, as [drawn](Self::drawn).
    #[must_use]
    pub fn film(&self, slot: usize) -> Option<&[f32]> {
        self.films.of(slot)
    }

    /// The strips over the canvas; a strip may occur more than once.
    pub fn strips(&self) -> impl Iterator<Item = usize> + '_ {
        self.films.strips()
    }

    /// Distributes the films of the texels over the canvas to their cells; the load keeps them until they are [given
    /// back](Self::give_back). `slots` are the paints that brush or canvas may have.
    pub fn lend(&mut self, load: &BrushLoad, traits: &BrushTraits, slots: &[usize], way: Way) {
        self.find_ways(traits, way);
        self.films.lend(&self.drawn, load, traits, slots);
    }

    /// Computes the path of each cell of the brush, and the share transferred along it.
    fn find_ways(&mut self, traits: &BrushTraits, way: Way) {
        let cells = self.drawn.texel.len();
        for plane in [&mut self.rate, &mut self.way] {
            plane.clear();
            plane.resize(cells, 0.0);
        }
        shares(
            &traits.exchanging,
            way.factors(traits.cell_per_reference),
            [&self.drawn.cover, &self.drawn.travel],
            [&mut self.rate, &mut self.way],
        );
    }

    /// The cells of a window, of those `within`, that are under the raster moved by whole cells.
    #[must_use]
    pub fn under(&self, origin: [i64; 2], within: Area, shift: [i64; 2]) -> Area {
        let (low, high) = self.drawn.reach;
        let span = [0, 1].map(|i| {
            let from = self.drawn.origin[i] - origin[i] + shift[i];
            let clamped = |at: usize| {
                let (least, most) = (within.from[i], within.from[i] + within.size[i]);
                (from + at as i64).clamp(least as i64, most as i64) as usize
            };
            [clamped(low[i]), clamped(high[i])]
        });
        Area {
            from: span.map(|[from, _]| from),
            size: span.map(|[from, to]| to - from),
        }
    }

    /// Blends brush and canvas with the raster moved by whole cells.
    pub fn blend(&mut self, step: &mut Step<'_>, shift: [i64; 2], dither: Dither) -> Met {
        let limits = Limits::of(step);
        let window = &mut *step.window;
        let within = window.area(step.bounds.0, step.bounds.1);
        let (width, origin) = (window.width(), window.origin());
        let under = self.under(origin, within, shift);
        if under.is_empty() {
            return Met::default();
        }
        let drawn = &self.drawn;
        // Offset of these cells on the raster.
        let on = [0, 1].map(|i| {
            let from = drawn.origin[i] - origin[i] + shift[i];
            (under.from[i] as i64 - from) as usize
        });
        let strides = [drawn.stride, width];
        let films = self.films.in_use();
        for film in &*films {
            window.plane_mut(film.slot);
        }
        let thinner = films
            .iter()
            .position(|film| Some(film.slot) == step.thinner);
        let ([base, ride], planes) = window.ground_and_planes_mut();
        let mut slots = films.iter().map(|film| film.slot).peekable();
        let planes = planes.filter(|(slot, _)| slots.next_if_eq(slot).is_some());
        let canvas = planes.map(|(_, plane)| &mut plane[under.from[1] * width..]);
        let canvas = canvas.collect();
        let brush = films.iter_mut();
        let brush = brush.map(|film| &mut film.plane[on[1] * drawn.stride..]);
        let area = Area {
            from: on,
            size: under.size,
        };
        let planes = [brush.collect(), canvas];
        let mut shares = Share::of_cores(area, strides, planes, &mut self.touching);
        let place = Place {
            over: [
                &drawn.cover,
                &self.rate,
                &self.way,
                &drawn.height,
                &drawn.clearance,
            ],
            ground: [base, ride],
            strides,
            on,
            under,
            origin,
            sink: step.traits.sink * step.sweep.to.press,
            cells_per_quantum: step.traits.cells_per_quantum,
            thinner,
            limits,
            dither,
        };
        each(&mut shares, |share| share.blend(&place));
        Met::of(under, &shares)
    }

    /// Returns the cells' quanta to their texels. By slot, the gain of the brush.
    pub fn give_back(&mut self, load: &mut BrushLoad) -> [i64; SLOTS] {
        self.films.give_back(&self.drawn, load)
    }
}

/// Splits the first `cells` cells off each plane.
fn split<'a>(planes: &mut [&'a mut [f32]], cells: usize) -> Vec<&'a mut [f32]> {
    let first = planes.iter_mut().map(|plane| {
        let cells = cells.min(plane.len());
        plane.split_off_mut(..cells).unwrap_or_default()
    });
    first.collect()
}
