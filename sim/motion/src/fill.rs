//! An outline filled by example: the strokes of a motion, continued as their hand would have (Baxter 2004, § 9.2).

use glam::DVec2;

use crate::MotionError;
use crate::example::{Example, Kind, Mark, Pass};
use crate::join::{PAUSES_S, above, append};
use crate::outline::Outline;
use crate::random::Random;
use crate::take_sample::{TakeSample, checked, point, shifted};

/// Largest length of a stroke, by the longest one of the example; a longer one becomes several.
const STRETCH: f64 = 1.5;
/// A shortened stroke takes at least this share of its time.
const LEAST_TIME_SHARE: f64 = 0.25;
/// Greatest number of strokes.
const MOST_STROKES: usize = 20_000;
/// Longest pause between two strokes, s: a painter may have rested.
const LONGEST_PAUSE_S: f64 = 2.0;
/// Pitch of rows of dabs, which are offset by half a pitch in turn, with the density of a square grid of pitch 1:
/// √(2/√3).
const HEXAGONAL: f64 = 1.074_569_931_823_542;
/// Time that the brush hovers over the first stroke, ns.
const HOVER_NS: u64 = 200_000_000;
/// Shares of the variation across its row that a stroke keeps: the largest with which it stays within the outline.
const VARIATION_SHARES: [f64; 5] = [1.0, 0.75, 0.5, 0.25, 0.0];
/// Tolerance of places within the outline, m.
const TOLERANCE_M: f64 = 1e-9;

/// Options of a fill.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fill {
    /// Seed of the variation.
    pub seed: u64,
    /// Distance of the brush's point from the edge at least, m: half of its width.
    pub clearance_m: f64,
    /// Length of the head that a 6-DOF stylus holds, m.
    pub head_m: f64,
}

/// A place for a stroke.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Slot {
    /// Beginning and end along the direction, m; for a dab, its place twice.
    along: [f64; 2],
    /// Its row, m.
    across: f64,
}

/// Fills an outline with the strokes of an example, in its order: row by row, each stroke taken from the example with
/// the length of its place.
///
/// # Errors
/// As [`Example::of`]; [`MotionError::NoRoom`], [`MotionError::TooMany`].
pub fn filled(
    example: &[TakeSample],
    outline: &Outline,
    fill: &Fill,
) -> Result<Vec<TakeSample>, MotionError> {
    let width_m = 2.0 * fill.clearance_m;
    let measured = Example::of(example, width_m, fill.head_m)?;
    let mut random = Random::new(fill.seed);
    let mut all: Vec<TakeSample> = Vec::new();
    for pass in &measured.passes {
        let [[u0, u1], [v0, v1]] = outline.bounds(pass.frame);
        let estimate = (u1 - u0) * (v1 - v0) / (pass.spacing_m * per_row_m(pass));
        if estimate.is_nan() || estimate >= MOST_STROKES as f64 {
            return Err(MotionError::TooMany {
                count: estimate as usize,
                spacing_mm: 1e3 * pass.spacing_m,
                most: MOST_STROKES,
            });
        }
        let slots = match pass.kind {
            Kind::Hatches => rows(pass, outline, fill, &mut random),
            Kind::Dabs => grid(pass, outline, fill, &mut random),
        };
        let pause_s = pass.pause_s.min(LONGEST_PAUSE_S).max(*PAUSES_S.start());
        for (number, slot) in slots.iter().enumerate() {
            let mark = chosen(pass, number, &mut random);
            let laid = laid(example, pass, mark, slot, (outline, fill));
            append(&mut all, &laid, pause_s);
        }
    }
    if all.is_empty() {
        let width_mm = 1e3 * width_m;
        return Err(MotionError::NoRoom { width_mm });
    }
    checked(hovering(all))
}

/// Length of a row that a stroke takes, m.
fn per_row_m(pass: &Pass) -> f64 {
    match pass.kind {
        Kind::Hatches => longest(pass),
        Kind::Dabs => pass.spacing_m,
    }
}

fn longest(pass: &Pass) -> f64 {
    let lengths = pass.marks.iter().map(Mark::length_m);
    STRETCH * lengths.fold(0.0, f64::max)
}

/// Numbers in the order of the example: rising, or falling.
fn ordered<T>(mut items: Vec<T>, rising: bool) -> Vec<T> {
    if !rising {
        items.reverse();
    }
    items
}

/// Coordinates of rows over a range, evenly about its middle.
fn evenly([from, to]: [f64; 2], spacing: f64) -> Vec<f64> {
    let room = to - from;
    if room < 0.0 {
        return Vec::new();
    }
    let steps = (room / spacing).floor();
    let first = from + 0.5 * (room - steps * spacing);
    let steps = steps as usize;
    (0..=steps)
        .map(|step| first + spacing * step as f64)
        .collect()
}

/// Places of strokes along rows.
fn rows(pass: &Pass, outline: &Outline, fill: &Fill, random: &mut Random) -> Vec<Slot> {
    let clearance = fill.clearance_m;
    let [_, [low, high]] = outline.bounds(pass.frame);
    let places = evenly([low + clearance, high - clearance], pass.spacing_m);
    let forth = pass.marks[0].forth;
    let (most, gap) = (longest(pass), pass.gap_m);
    let mut slots = Vec::new();
    for place in ordered(places, pass.upward) {
        let across = place + random.about(pass.spread_m);
        let spans = outline.spans(pass.frame, across, clearance);
        for span in ordered(spans, forth) {
            let room = span[1] - span[0];
            let count = match gap {
                // The number of a row of the example.
                Some(gap) => {
                    let mean = pass.marks.iter().map(Mark::length_m).sum::<f64>();
                    let mean = mean / pass.marks.len() as f64;
                    ((room + gap) / (mean + gap).max(0.25 * mean)).round()
                }
                None => (room / most).ceil(),
            };
            let count = count.max(1.0);
            // Without a gap strokes overlap by the spacing of the rows.
            let gap = gap.unwrap_or(-pass.spacing_m);
            let each = room / count;
            let mut seams: Vec<f64> = (0..=count as usize)
                .map(|seam| span[0] + each * seam as f64)
                .collect();
            let last = seams.len() - 1;
            for seam in &mut seams[1..last] {
                *seam += random.about(0.1 * each);
            }
            let mut pieces: Vec<[f64; 2]> = seams.windows(2).map(|two| [two[0], two[1]]).collect();
            for (number, piece) in pieces.iter_mut().enumerate() {
                if number > 0 {
                    piece[0] += 0.5 * gap;
                }
                if number + 1 < last {
                    piece[1] -= 0.5 * gap;
                }
                let ragged = |random: &mut Random, room: f64| {
                    random.about(pass.ragged_m).abs().min(0.25 * room.max(0.0))
                };
                let own = piece[1] - piece[0];
                piece[0] = (piece[0] + ragged(random, own)).max(span[0]);
                piece[1] = (piece[1] - ragged(random, own)).min(span[1]);
                if piece[1] < piece[0] {
                    *piece = [0.5 * (piece[0] + piece[1]); 2];
                }
            }
            let slot = |along: [f64; 2]| Slot { along, across };
            slots.extend(ordered(pieces, forth).into_iter().map(slot));
        }
    }
    slots
}

/// Places of dabs: rows in which every other one is shifted by half, each dab somewhat beside its place.
fn grid(pass: &Pass, outline: &Outline, fill: &Fill, random: &mut Random) -> Vec<Slot> {
    let pitch = HEXAGONAL * pass.spacing_m;
    let [[left, right], [low, high]] = outline.bounds(pass.frame);
    let inset = |[from, to]: [f64; 2]| [from + fill.clearance_m, to - fill.clearance_m];
    let rows = evenly(inset([low, high]), pitch * 0.75f64.sqrt());
    let mut slots = Vec::new();
    for (number, row) in ordered(rows, pass.upward).into_iter().enumerate() {
        let shift = if number % 2 == 0 { 0.0 } else { 0.5 * pitch };
        for place in evenly(inset([left, right - pitch]), pitch) {
            let along = place + shift + 0.25 * pitch + random.about(pass.spread_m);
            let across = row + random.about(pass.spread_m);
            let at = pass.frame.to_desk(DVec2::new(along, across));
            if outline.holds(at, fill.clearance_m) {
                slots.push(Slot {
                    along: [along; 2],
                    across,
                });
            }
        }
    }
    slots
}

/// The stroke of the example for the next place: one in the direction of this turn if possible.
fn chosen<'a>(pass: &'a Pass, number: usize, random: &mut Random) -> &'a Mark {
    let forth = pass.marks[number % pass.marks.len()].forth;
    let alike: Vec<&Mark> = pass
        .marks
        .iter()
        .filter(|mark| mark.forth == forth)
        .collect();
    alike[random.below(alike.len())]
}

/// A stroke at its place.
fn laid(
    example: &[TakeSample],
    pass: &Pass,
    mark: &Mark,
    slot: &Slot,
    (outline, fill): (&Outline, &Fill),
) -> Vec<TakeSample> {
    let own = &example[mark.stroke.samples.clone()];
    let places: Vec<DVec2> = own
        .iter()
        .map(|taken| pass.frame.of(point(&taken.sample, fill.head_m).truncate()))
        .collect();
    let middle = 0.5 * (mark.along[0] + mark.along[1]);
    let factor = match pass.kind {
        Kind::Dabs => 1.0,
        Kind::Hatches if mark.length_m() < TOLERANCE_M => 1.0,
        Kind::Hatches => (slot.along[1] - slot.along[0]) / mark.length_m(),
    };
    let centre = 0.5 * (slot.along[0] + slot.along[1]);
    let warped = |kept: f64| -> Vec<DVec2> {
        let at = |place: &DVec2| {
            // Along the row a stroke keeps its place; only a dab is drawn together.
            let along = match pass.kind {
                Kind::Hatches => factor,
                Kind::Dabs => kept,
            };
            let from_middle = DVec2::new(
                along * (place.x - middle),
                kept * factor * (place.y - mark.across),
            );
            pass.frame
                .to_desk(DVec2::new(centre, slot.across) + from_middle)
        };
        places.iter().map(at).collect()
    };
    let clearance = fill.clearance_m - TOLERANCE_M;
    let fits = |kept: &f64| warped(*kept).iter().all(|at| outline.holds(*at, clearance));
    let kept = VARIATION_SHARES.into_iter().find(fits).unwrap_or(0.0);
    let slower = factor.max(LEAST_TIME_SHARE);
    let begin_ns = own.first().map_or(0, |first| first.time_ns);
    let mut last_ns = None;
    let mut stroke = Vec::with_capacity(own.len());
    for ((taken, to), from) in own.iter().zip(warped(kept)).zip(&places) {
        let since_ns = ((taken.time_ns - begin_ns) as f64 * slower).round() as u64;
        let time_ns = last_ns.map_or(since_ns, |last: u64| since_ns.max(last + 1));
        last_ns = Some(time_ns);
        let mut sample = shifted(&taken.sample, to - pass.frame.to_desk(*from));
        for velocity in &mut sample.velocity_m_s[..2] {
            *velocity *= factor / slower;
        }
        stroke.push(TakeSample { time_ns, sample });
    }
    stroke
}

/// The motion between two moments in the air: the brush comes from above, and is lifted at its end.
fn hovering(all: Vec<TakeSample>) -> Vec<TakeSample> {
    let (Some(first), Some(last)) = (all.first().cloned(), all.last().cloned()) else {
        return all;
    };
    let at = |time_ns: u64, under: &TakeSample| TakeSample {
        time_ns,
        sample: above(&under.sample),
    };
    let begin = at(0, &first);
    let end = at(last.time_ns + 2 * HOVER_NS, &last);
    let later = all.into_iter().map(|taken| TakeSample {
        time_ns: taken.time_ns + HOVER_NS,
        ..taken
    });
    std::iter::once(begin).chain(later).chain([end]).collect()
}
