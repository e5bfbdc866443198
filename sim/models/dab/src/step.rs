//! One step of dAb.

use maulstick_brush::HeadPose;
use maulstick_canvas::quantum::SLOTS;
use maulstick_canvas::window::Area;
use maulstick_model::brush::head::low_bounds;
use maulstick_model::footprint::Footprint;
use maulstick_model::footprint::lying::Lying;
use maulstick_model::interface::{PaintModel, Step, StepReport, Sweep, Transfer};
use maulstick_model::modes::{sample, vacuum};

use crate::dither::Dither;
use crate::raster::Raster;
use crate::reservoir::{Refill, refill};
use crate::stroke::{Stroker, Way, each_drawing};

/// Greatest number of blends of a step, for their numbering.
const BLENDS: u64 = 256;

/// The number of the first blend of the brush's step `step`, for its [thresholds](Dither::new).
#[must_use]
pub fn first_blend(step: u64) -> u64 {
    step.wrapping_mul(BLENDS)
}

/// The paint model `dab`, with the buffers of its step.
#[derive(Debug, Default)]
pub struct Dab {
    footprint: Footprint,
    lying: Lying,
    raster: Raster,
    poses: [HeadPose; 2],
    /// Stroking algorithm of all steps; chosen by the load on the machine if absent.
    stroker: Option<Stroker>,
    blended: u64,
}

impl PaintModel for Dab {
    fn name(&self) -> &'static str {
        "dab"
    }

    fn step(&mut self, step: &mut Step<'_>) -> StepReport {
        match step.handling.transfer {
            Transfer::Sampler | Transfer::Vacuum => self.without_paint(step),
            _ => {
                let report = self.stroke(step);
                step.load.count_step();
                report
            }
        }
    }
}

impl Stroker {
    /// Algorithm for a step: a parabola where steps are doubled, a fixed footprint where they are doubled twice.
    #[must_use]
    pub fn of(step: &Step<'_>) -> Self {
        match step.traits.doublings {
            0 => Self::Better,
            1 => Self::Spline,
            _ => Self::Faster,
        }
    }
}

/// Shared state of the blends of a step.
struct Stroke {
    /// Height of wet paint before the step, cells: only lower parts of the head can touch it.
    top: f32,
    /// Slots of the paints on brush or canvas there.
    slots: Vec<usize>,
    /// Number of the next blend.
    number: u64,
    /// Cells that may have changed.
    reached: Area,
    /// By strip, true if it was over the canvas.
    strips: Vec<bool>,
    report: StepReport,
}

impl Dab {
    /// A model with a fixed stroking algorithm, whatever the load.
    #[must_use]
    pub fn stroking(stroker: Stroker) -> Self {
        Self {
            stroker: Some(stroker),
            ..Self::default()
        }
    }

    /// Number of cells of all footprints blended so far, touched or not: the texels of Baxter 2004 (§ 6.10: 116
    /// footprints of 26² cells are 77,000).
    #[must_use]
    pub fn texels(&self) -> u64 {
        self.blended
    }

    fn without_paint(&mut self, step: &mut Step<'_>) -> StepReport {
        let footprint = &mut self.footprint;
        footprint.find(step);
        if footprint.contacts.is_empty() {
            return StepReport::default();
        }
        let mut report = footprint.report(step);
        if step.handling.transfer == Transfer::Sampler {
            report.from_nowhere = sample(footprint, step).into();
            return report;
        }
        report.lifted = vacuum(footprint, step).into();
        step.load.count_step();
        footprint.note_left(step);
        step.window.touch(footprint.reached());
        report
    }

    fn stroke(&mut self, step: &mut Step<'_>) -> StepReport {
        let within = step.window.area(step.bounds.0, step.bounds.1);
        if within.is_empty() {
            return StepReport::default();
        }
        let number = first_blend(step.load.steps());
        let mut stroke = Stroke {
            top: self.lying.weigh(within, step),
            slots: paints(step, within),
            number,
            reached: Area::default(),
            strips: vec![false; step.head.strips()],
            report: StepReport::default(),
        };
        let stroker = self.stroker.unwrap_or_else(|| Stroker::of(step));
        let (sweep, mut poses) = (step.sweep, std::mem::take(&mut self.poses));
        let cells = each_drawing(&sweep, stroker, &mut poses, |motion, places, way| {
            self.blend(step, motion, places, way, &mut stroke);
        });
        self.poses = poses;
        if stroke.report.footprint_cells == 0 {
            return StepReport::default();
        }
        if step.handling.transfer != Transfer::Sponge {
            let dither = Dither::new(step.load.seed(), number);
            let strips = stroke.strips.iter().enumerate().filter(|(_, over)| **over);
            let refilled = Refill::of(&step.traits, cells);
            refill(step.load, &refilled, strips.map(|(strip, _)| strip), dither);
            step.load.count_films();
        }
        self.lying.weigh(stroke.reached, step);
        let Area { from, size } = stroke.reached;
        step.window
            .touch((from, [from[0] + size[0], from[1] + size[1]]));
        stroke.report
    }

    /// Draws the head in the middle of a motion, and blends it with the canvas at places beside it.
    fn blend(
        &mut self,
        step: &mut Step<'_>,
        sweep: Sweep<'_>,
        places: &[[i64; 2]],
        way: Way,
        stroke: &mut Stroke,
    ) {
        let traits = &step.traits;
        // The pressed head may lie below its solved height by the depth of the ride.
        let low = stroke.top + traits.sink * sweep.to.press + step.window.ride_below();
        let Some((from, size)) = low_part(step, sweep, low) else {
            return;
        };
        let mut part = Step {
            window: &mut *step.window,
            head: step.head,
            sweep,
            load: &mut *step.load,
            ..*step
        };
        self.raster.drawn.draw(&part, from, size, low);
        if self.raster.drawn.is_empty() {
            return;
        }
        let sponge = part.handling.transfer == Transfer::Sponge;
        let counted = sponge || part.lasting;
        let under = self.under(&part, places);
        let before = if counted {
            lying(&part, under)
        } else {
            [0; SLOTS]
        };
        let slots = &stroke.slots;
        self.raster.lend(part.load, &part.traits, slots, way);
        if !self.blend_at(&mut part, places, stroke) {
            return;
        }
        let mut from_nowhere = [0; SLOTS];
        if !sponge {
            from_nowhere = self.raster.give_back(part.load);
            for strip in self.raster.strips() {
                stroke.strips[strip] = true;
            }
        }
        if counted {
            let after = lying(&part, under);
            for slot in 0..SLOTS {
                stroke.report.from_nowhere[slot] += after[slot] - before[slot] + from_nowhere[slot];
            }
        }
    }

    /// The cells of the window that the raster covers at any of some places.
    fn under(&self, step: &Step<'_>, places: &[[i64; 2]]) -> Area {
        let within = step.window.area(step.bounds.0, step.bounds.1);
        let origin = step.window.origin();
        let under = places.iter();
        let under = under.map(|place| self.raster.under(origin, within, *place));
        under.reduce(joined).unwrap_or_default()
    }

    /// Blends the drawn head with the canvas at some places; true if it touched anything.
    fn blend_at(&mut self, step: &mut Step<'_>, places: &[[i64; 2]], stroke: &mut Stroke) -> bool {
        let seed = step.load.seed();
        let mut touched = false;
        for place in places {
            let dither = Dither::new(seed, stroke.number);
            stroke.number = stroke.number.wrapping_add(1);
            let met = self.raster.blend(step, *place, dither);
            self.blended += met.under;
            if met.cells == 0 {
                continue;
            }
            touched = true;
            stroke.reached = joined(stroke.reached, met.reached);
            stroke.report.footprint_cells += met.cells;
            stroke.report.wet += met.wet;
            stroke.report.thinner += met.thinner;
        }
        touched
    }
}

/// Corner and size of the step's cells over which the head, with its film, lies below a height.
fn low_part(step: &Step<'_>, sweep: Sweep<'_>, low: f32) -> Option<([i64; 2], [usize; 2])> {
    let film = step.load.thickest() as f32 * step.traits.film_cells_per_quantum;
    let (from, to) = low_bounds(step.head, sweep.to, &step.traits, low + film)?;
    let from = [0, 1].map(|i| from[i].max(step.bounds.0[i]));
    let size = [0, 1].map(|i| (to[i].min(step.bounds.1[i]) - from[i]).max(0) as usize);
    (!size.contains(&0)).then_some((from, size))
}

/// The paints on the brush's surface or on an area of the canvas.
fn paints(step: &Step<'_>, area: Area) -> Vec<usize> {
    let lies = |slot: usize| {
        step.window.plane(slot).is_some_and(|plane| {
            let mut rows = area.rows(step.window.width());
            rows.any(|row| plane[row].iter().any(|count| *count > 0.0))
        })
    };
    let carried = |slot: usize| {
        let film = step.load.film_of(slot);
        film.is_some_and(|film| film.iter().any(|count| *count > 0))
    };
    (0..SLOTS)
        .filter(|slot| lies(*slot) || carried(*slot))
        .collect()
}

/// The smallest area that contains both.
fn joined(one: Area, other: Area) -> Area {
    if other.is_empty() {
        return one;
    }
    if one.is_empty() {
        return other;
    }
    let from = [0, 1].map(|i| one.from[i].min(other.from[i]));
    let to = [0, 1].map(|i| (one.from[i] + one.size[i]).max(other.from[i] + other.size[i]));
    Area {
        from,
        size: [0, 1].map(|i| to[i] - from[i]),
    }
}

/// Wet quanta on an area, by slot.
fn lying(step: &Step<'_>, area: Area) -> [i64; SLOTS] {
    let mut counts = [0; SLOTS];
    for (slot, plane) in step.window.planes() {
        let rows = area.rows(step.window.width());
        let cells = rows.flat_map(|row| &plane[row]);
        counts[slot] = cells.map(|count| *count as i64).sum();
    }
    counts
}
