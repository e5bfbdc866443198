//! Stroking algorithms (Baxter 2004, § 4.3): the blends of a step, from the heads before and after it.

use maulstick_brush::HeadPose;
use maulstick_model::brush::head::motion;
use maulstick_model::interface::Sweep;

/// Height below which a strip counts for the anchor point, cells.
const ANCHOR_HEIGHT_CELLS: f32 = 3.0;
/// Greatest distance of a part near the surface from its place in a drawing, cells.
pub const SLACK: f32 = 0.5;
/// Weight of a change of height relative to one along the surface.
pub const HEIGHT_WEIGHT: f32 = 4.0;

/// Stroking algorithm.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stroker {
    /// Algorithm 1, STROKE-FASTER: the footprint at the end of the step is blended along the path of its anchor point,
    /// cell by cell.
    Faster,
    /// Algorithm 2, STROKE-BETTER: the head is interpolated cell by cell, and each has its footprint. Where all its
    /// parts move alike, one drawing serves for several ([`Course::runs`]).
    Better,
    /// [`Better`](Self::Better) along a parabola through the head of the previous step too: the spline that the text
    /// calls a natural extension.
    Spline,
}

/// Path of the head in a blend.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Way {
    /// The motion of each strip in the step.
    OfStrips,
    /// A number of cells.
    Cells(f32),
}

impl Way {
    /// Path of a cell of the head in reference cells, with `cell_per_reference` reference cells per cell: a factor on
    /// the motion of its strip in the step, and a summand.
    #[must_use]
    pub fn factors(self, cell_per_reference: f32) -> [f32; 2] {
        match self {
            Self::OfStrips => [cell_per_reference, 0.0],
            Self::Cells(cells) => [0.0, cells * cell_per_reference],
        }
    }
}

/// Cuts a step into drawings of the head, and returns the path of its anchor point, cells. `draw` receives for each
/// drawing the motion around it, the places beside it at which it is blended, and the path of each blend; `poses` is a
/// buffer for the heads of a motion.
pub fn each_drawing(
    sweep: &Sweep<'_>,
    stroker: Stroker,
    poses: &mut [HeadPose; 2],
    mut draw: impl FnMut(Sweep<'_>, &[[i64; 2]], Way),
) -> f32 {
    let bend = match stroker {
        Stroker::Spline => bend(sweep),
        Stroker::Faster | Stroker::Better => None,
    };
    let course = Course::of(sweep, bend);
    let [x, y] = course.way;
    let length = (x * x + y * y).sqrt();
    if stroker == Stroker::Faster {
        let places: Vec<[i64; 2]> = places(course.way).collect();
        let rests = Sweep {
            before: None,
            from: sweep.to,
            to: sweep.to,
        };
        draw(rests, &places, Way::Cells(length / places.len() as f32));
        return length;
    }
    let [before, after] = poses;
    for run in course.runs(parts(sweep)) {
        between(sweep, bend, run.part[0], before);
        between(sweep, bend, run.part[1], after);
        let motion = Sweep {
            before: None,
            from: before,
            to: after,
        };
        draw(motion, &run.shifts, Way::OfStrips);
    }
    length
}

/// The head at `t` of its path, 0 to 1: on the chord, or on the parabola through `before`, which it passed at −`ago`.
pub fn between(sweep: &Sweep<'_>, bend: Option<(&HeadPose, f32)>, t: f32, into: &mut HeadPose) {
    let (from, to) = (sweep.from, sweep.to);
    let mix = |a: f32, b: f32| a + (b - a) * t;
    let plane = |of: fn(&HeadPose) -> &Vec<f32>, into: &mut Vec<f32>| {
        let (from, to) = (of(from), of(to));
        into.clear();
        into.extend(from.iter().zip(to).map(|(a, b)| mix(*a, *b)));
        let Some((before, ago)) = bend else { return };
        // c·t·(t − 1) vanishes at both ends; c follows from the head at −ago.
        let factor = t * (t - 1.0) / (ago * (ago + 1.0));
        for (value, (before, (from, to))) in into
            .iter_mut()
            .zip(of(before).iter().zip(from.iter().zip(to)))
        {
            *value += factor * (before - from + ago * (to - from));
        }
    };
    plane(|pose| &pose.x, &mut into.x);
    plane(|pose| &pose.y, &mut into.y);
    plane(|pose| &pose.z, &mut into.z);
    plane(|pose| &pose.skin.x, &mut into.skin.x);
    plane(|pose| &pose.skin.y, &mut into.skin.y);
    plane(|pose| &pose.skin.z, &mut into.skin.z);
    // A head bends round the surface, never into it.
    for z in into.z.iter_mut().chain(&mut into.skin.z) {
        *z = z.max(0.0);
    }
    into.press = mix(from.press, to.press);
    into.splay = mix(from.splay, to.splay);
    into.bend = [0, 1].map(|i| mix(from.bend[i], to.bend[i]));
}

/// The third point of a step's parabola: the head of the previous step, and its time before this one in lengths of this
/// step. `None` where either hardly moves.
#[must_use]
pub fn bend<'a>(sweep: &Sweep<'a>) -> Option<(&'a HeadPose, f32)> {
    let before = sweep.before?;
    let own = motion(sweep.from, sweep.to) as f32;
    let ago = motion(before, sweep.from) as f32 / own.max(1e-3);
    (own > 0.5 && (0.2..5.0).contains(&ago)).then_some((before, ago))
}

/// Motion of a head in a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Course {
    /// Motion of the anchor point, the mean of the parts near the surface after the step, cells.
    pub way: [f32; 2],
    /// Bulge of its parabola: at t it is t·(t − 1) times this beside the chord, cells.
    pub bulge: [f32; 2],
    /// Greatest deviation of a part near the surface from the anchor point's motion, cells; height counts [`HEIGHT_WEIGHT`]
    /// times.
    pub sway: f32,
}

impl Course {
    /// Motion in a step.
    #[must_use]
    pub fn of(sweep: &Sweep<'_>, bend: Option<(&HeadPose, f32)>) -> Self {
        let (from, to) = (sweep.from, sweep.to);
        let near: Vec<usize> = (0..to.z.len().min(from.z.len()))
            .filter(|i| to.z[*i] < ANCHOR_HEIGHT_CELLS)
            .collect();
        let mean = |of: &dyn Fn(usize) -> f32| {
            near.iter().map(|i| of(*i)).sum::<f32>() / (near.len() as f32).max(1.0)
        };
        let chord = |of: fn(&HeadPose) -> &Vec<f32>, i: usize| of(to)[i] - of(from)[i];
        let bulge = |of: fn(&HeadPose) -> &Vec<f32>, i: usize| {
            bend.map_or(0.0, |(before, ago)| {
                (of(before)[i] - of(from)[i] + ago * chord(of, i)) / (ago * (ago + 1.0))
            })
        };
        let axes: [fn(&HeadPose) -> &Vec<f32>; 2] = [|pose| &pose.x, |pose| &pose.y];
        let way = axes.map(|of| mean(&|i| chord(of, i)));
        let bulges = axes.map(|of| mean(&|i| bulge(of, i)));
        let sway = |i: &usize| {
            let aside = |axis: usize| {
                let off = chord(axes[axis], *i) - way[axis];
                off.abs() + (bulge(axes[axis], *i) - bulges[axis]).abs()
            };
            aside(0)
                .max(aside(1))
                .max(HEIGHT_WEIGHT * chord(|pose| &pose.z, *i).abs())
        };
        Self {
            way,
            bulge: bulges,
            sway: near.iter().map(sway).fold(0.0, f32::max),
        }
    }

    /// Place of the anchor point at `t`, 0 to 1, relative to the beginning of the step, cells.
    #[must_use]
    pub fn at(&self, t: f32) -> [f32; 2] {
        [0, 1].map(|i| self.way[i] * t + self.bulge[i] * (t * (t - 1.0)))
    }

    /// The runs of a step of `parts` parts: as many as keep the parts near the surface within [`SLACK`] of their place
    /// in the run's drawing.
    pub fn runs(&self, parts: usize) -> impl Iterator<Item = Run> + use<> {
        let course = *self;
        let runs = ((course.sway * (0.5 / SLACK)).ceil() as usize).clamp(1, parts.max(1));
        (0..runs).map(move |run| {
            let (first, last) = (parts * run / runs, parts * (run + 1) / runs);
            let drawn = (first + last - 1) / 2;
            let middle = |part: usize| course.at((part as f32 + 0.5) / parts as f32);
            let from = middle(drawn);
            let shift = |part| {
                let at = middle(part);
                [0, 1].map(|i| (at[i] - from[i]).round() as i64)
            };
            Run {
                part: [drawn, drawn + 1].map(|part| part as f32 / parts as f32),
                shifts: (first..last).map(shift).collect(),
            }
        })
    }
}

/// Parts of a step with one drawing of the head.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// Beginning and end of the part around the drawing, 0 to 1.
    pub part: [f32; 2],
    /// Place of the head in each of the parts, in whole cells from the drawing.
    pub shifts: Vec<[i64; 2]>,
}

/// Places along the path of an anchor point, in whole cells from its end; none at its beginning, where the previous
/// step ended.
pub fn places(way: [f32; 2]) -> impl Iterator<Item = [i64; 2]> {
    let count = way[0].abs().max(way[1].abs()).ceil().max(1.0);
    (1..=count as usize).map(move |place| {
        let left = place as f32 / count - 1.0;
        way.map(|way| (way * left).round() as i64)
    })
}

/// Number of footprints of an interpolated step, one a cell. Swept footprints of longer steps would keep every other
/// cell of a fine canvas under the same part of a bristle, and leave cells under a higher one bare.
#[must_use]
pub fn parts(sweep: &Sweep<'_>) -> usize {
    // A step that is a cell long, but for rounding, counts as one.
    (motion(sweep.from, sweep.to) - 0.05)
        .ceil()
        .clamp(1.0, 64.0) as usize
}
