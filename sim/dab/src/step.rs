//! One step of dAb.

use maulstick_brush::HeadPose;
use maulstick_canvas::quantum::SLOTS;
use maulstick_canvas::window::Area;
use maulstick_model::footprint::Footprint;
use maulstick_model::interface::{PaintModel, Step, StepReport, Sweep, Transfer};
use maulstick_model::modes::{sample, vacuum};

use crate::dither::Dither;
use crate::raster::{Raster, Way};
use crate::reservoir::refill;
use crate::stroke::{Stroker, anchor_way, bend, between, parts, places};

/// Blends of a step at most, for their numbers.
const BLENDS: u64 = 256;

/// The paint model `dab`, with room for its step.
#[derive(Debug, Default)]
pub struct Dab {
    footprint: Footprint,
    raster: Raster,
    poses: [HeadPose; 2],
    /// The algorithm of all steps; by the load on the machine where there is none.
    stroker: Option<Stroker>,
}

impl PaintModel for Dab {
    fn name(&self) -> &'static str {
        "dab"
    }

    fn step(&mut self, step: &mut Step<'_>) -> StepReport {
        match step.handling.transfer {
            Transfer::Sampler | Transfer::Vacuum => self.without_paint(step),
            _ => {
                let report = match self.stroker.unwrap_or_else(|| Stroker::of(step)) {
                    Stroker::Faster => self.stroke_faster(step),
                    Stroker::Better => self.stroke_better(step, None),
                    Stroker::Spline => self.stroke_better(step, bend(&step.sweep)),
                };
                step.load.count_step();
                report
            }
        }
    }
}

impl Stroker {
    /// By the load: where steps are doubled once they bend, so that none is seen; where twice, the machine falls behind.
    fn of(step: &Step<'_>) -> Self {
        match step.traits.doublings {
            0 => Self::Better,
            1 => Self::Spline,
            _ => Self::Faster,
        }
    }
}

impl Dab {
    /// One that strokes by this algorithm, whatever the load.
    #[must_use]
    pub fn stroking(stroker: Stroker) -> Self {
        Self {
            stroker: Some(stroker),
            ..Self::default()
        }
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

    /// Algorithm 1.
    fn stroke_faster(&mut self, step: &mut Step<'_>) -> StepReport {
        let way = anchor_way(&step.sweep);
        let places: Vec<[i64; 2]> = places(way).collect();
        let each = (way[0] * way[0] + way[1] * way[1]).sqrt() / places.len() as f32;
        let to = step.sweep.to;
        let mut report = StepReport::default();
        let rests = Sweep {
            before: None,
            from: to,
            to,
        };
        self.blend(step, rests, &places, Way::Cells(each), &mut report);
        report
    }

    /// Algorithm 2, along a parabola if there is one.
    fn stroke_better(&mut self, step: &mut Step<'_>, bend: Option<(&HeadPose, f32)>) -> StepReport {
        let whole = step.sweep;
        let parts = parts(&whole);
        let mut report = StepReport::default();
        let [mut before, mut after] = std::mem::take(&mut self.poses);
        between(&whole, bend, 0.0, &mut before);
        for part in 1..=parts {
            between(&whole, bend, part as f32 / parts as f32, &mut after);
            let sweep = Sweep {
                before: None,
                from: &before,
                to: &after,
            };
            self.blend(step, sweep, &[[0; 2]], Way::OfStrips, &mut report);
            std::mem::swap(&mut before, &mut after);
        }
        self.poses = [before, after];
        report
    }

    /// Blends the footprint of a motion at places beside it, and adds to the report.
    fn blend(
        &mut self,
        step: &mut Step<'_>,
        sweep: Sweep<'_>,
        places: &[[i64; 2]],
        way: Way,
        report: &mut StepReport,
    ) {
        let lasting = step.lasting;
        let sponge = step.handling.transfer == Transfer::Sponge;
        let number = step.load.steps().wrapping_mul(BLENDS) + report.footprint_cells % BLENDS;
        let seed = step.load.seed();
        let mut part = Step {
            window: &mut *step.window,
            head: step.head,
            sweep,
            load: &mut *step.load,
            ..*step
        };
        self.footprint.find(&mut part);
        if self.footprint.contacts.is_empty() {
            return;
        }
        let first = self.footprint.report(&part);
        let (around, within) = (
            self.footprint.around,
            part.window.area(part.bounds.0, part.bounds.1),
        );
        let places_of = places.iter().map(|place| moved(around, *place, within));
        let reached = places_of.fold(around, joined);
        let counted = sponge || lasting;
        let before = if counted {
            lying(&part, reached)
        } else {
            [0; SLOTS]
        };
        self.raster.lend(&self.footprint, &part, way);
        for (blend, place) in places.iter().enumerate() {
            let dither = Dither::new(seed, number.wrapping_add(blend as u64));
            self.raster.blend(&mut part, *place, dither);
        }
        let mut from_nowhere = [0; SLOTS];
        if !sponge {
            from_nowhere = self.raster.give_back(&self.footprint, &mut part);
            refill(&mut part, self.raster.texels(), Dither::new(seed, number));
        }
        report.add(&StepReport {
            footprint_cells: first.footprint_cells * places.len() as u64,
            ..first
        });
        if counted {
            let after = lying(&part, reached);
            for slot in 0..SLOTS {
                report.from_nowhere[slot] += after[slot] - before[slot] + from_nowhere[slot];
            }
        }
        self.footprint.around = reached;
        self.footprint.note_left(&mut part);
        part.window.touch(self.footprint.reached());
    }
}

/// An area moved by whole cells, as far as it is within another.
fn moved(area: Area, by: [i64; 2], within: Area) -> Area {
    let ends = [0, 1].map(|i| {
        let (low, high) = (within.from[i], within.from[i] + within.size[i]);
        let place = |at: usize| (at as i64 + by[i]).clamp(low as i64, high as i64) as usize;
        [place(area.from[i]), place(area.from[i] + area.size[i])]
    });
    Area {
        from: ends.map(|[from, _]| from),
        size: ends.map(|[from, to]| to - from),
    }
}

/// The least area that holds both.
fn joined(one: Area, other: Area) -> Area {
    if other.is_empty() {
        return one;
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
