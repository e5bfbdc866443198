//! Measures of an example: the direction of its strokes, their spacing and its variation, and the properties of each.
//!
//! Successive differences are measured, so neither the shape of the example nor a trend in it counts as variation.

use glam::DVec2;
use maulstick_num::{atan2, sin_cos};

use crate::MotionError;
use crate::outline::Frame;
use crate::strokes::{Stroke, strokes};
use crate::take_sample::TakeSample;

/// Strokes that are shorter than this share of their distance from each other are dabs.
const DAB: f64 = 0.5;
/// Directions that differ by more than this belong to another pass, rad.
const PASS_RAD: f64 = 0.6;
/// Strokes that a pass has at least: fewer are a variation.
const PASS: usize = 3;
/// Overlap, as a share of the shorter one, from which strokes lie beside each other.
const BESIDE: f64 = 0.25;

/// A stroke of the example, in the frame of its pass.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    /// Its samples.
    pub stroke: Stroke,
    /// Least and greatest coordinate along the direction, m.
    pub along: [f64; 2],
    /// Mean coordinate across it, m.
    pub across: f64,
    /// True if it was drawn along the direction, not against it.
    pub forth: bool,
}

impl Mark {
    /// Its extent along the direction, m.
    #[must_use]
    pub fn length_m(&self) -> f64 {
        self.along[1] - self.along[0]
    }
}

/// Kind of the strokes of a pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Strokes along rows.
    Hatches,
    /// Dabs: each its own place.
    Dabs,
}

/// Strokes of one direction, one after the other.
#[derive(Clone, Debug, PartialEq)]
pub struct Pass {
    /// Kind of its strokes.
    pub kind: Kind,
    /// Its direction.
    pub frame: Frame,
    /// Its strokes, in order.
    pub marks: Vec<Mark>,
    /// Distance of rows, or of dabs, m.
    pub spacing_m: f64,
    /// Standard deviation of it, m.
    pub spread_m: f64,
    /// Standard deviation of the ends along the direction, m.
    pub ragged_m: f64,
    /// Gap between two strokes of a row, negative where they overlap, m; `None` where no row has two.
    pub gap_m: Option<f64>,
    /// True if rows follow each other across the direction, not against it.
    pub upward: bool,
    /// Median pause between two strokes, s.
    pub pause_s: f64,
}

/// Measures of an example.
#[derive(Clone, Debug, PartialEq)]
pub struct Example {
    /// Its passes, in order: hatching across hatching has two.
    pub passes: Vec<Pass>,
}

impl Example {
    /// Measures an example. `width_m` is the width of its brush, by which a single stroke is spaced; `head_m` the length
    /// of the head that a 6-DOF stylus holds.
    ///
    /// # Errors
    /// [`MotionError::NoTouch`]; [`MotionError::NoSpacing`] of one stroke of a brush without a width.
    pub fn of(samples: &[TakeSample], width_m: f64, head_m: f64) -> Result<Self, MotionError> {
        let strokes = strokes(samples, head_m);
        if strokes.is_empty() {
            return Err(MotionError::NoTouch);
        }
        let paths: Vec<Vec<DVec2>> = strokes
            .iter()
            .map(|stroke| {
                let path = stroke.path(samples, head_m).into_iter();
                path.map(|[x, y, _]| DVec2::new(x, y)).collect()
            })
            .collect();
        let pitch_m = pitch(&paths);
        let extents = paths.iter().map(|path| extent(path)).collect();
        let is_dabs = pitch_m.is_some_and(|pitch| median(extents) < DAB * pitch);
        let parts = if is_dabs {
            std::iter::once(0..paths.len()).collect()
        } else {
            parted(&paths)
        };
        let pass = |part: std::ops::Range<usize>| {
            let (strokes, paths) = (&strokes[part.clone()], &paths[part]);
            match (is_dabs, pitch_m) {
                (true, Some(pitch_m)) => Ok(dabs(strokes, paths, pitch_m)),
                _ => hatches(strokes, paths, width_m),
            }
        };
        let passes = parts.into_iter().map(pass).collect::<Result<_, _>>()?;
        Ok(Self { passes })
    }
}

/// Direction of a path, modulo half a turn: that of the greatest spread of its points, rad.
fn direction(paths: &[Vec<DVec2>]) -> f64 {
    let (mut xx, mut xy) = (0.0, 0.0);
    for path in paths {
        let mean = mean_of(path);
        let count = path.len().max(1) as f64;
        for at in path {
            let d = *at - mean;
            xx += (d.x * d.x - d.y * d.y) / count;
            xy += 2.0 * d.x * d.y / count;
        }
    }
    0.5 * atan2(xy, xx)
}

fn mean_of(path: &[DVec2]) -> DVec2 {
    path.iter().sum::<DVec2>() / path.len().max(1) as f64
}

/// Greatest distance of a path from its middle, twice, m.
fn extent(path: &[DVec2]) -> f64 {
    let mean = mean_of(path);
    2.0 * path.iter().map(|at| at.distance(mean)).fold(0.0, f64::max)
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

/// Standard deviation of values whose second differences these are: noise of 1 gives √6.
fn noise(seconds: &[f64]) -> f64 {
    let sum: f64 = seconds.iter().map(|d| d * d).sum();
    (sum / (6.0 * seconds.len().max(1) as f64)).sqrt()
}

fn second_differences(values: &[f64]) -> Vec<f64> {
    let triples = values.windows(3);
    triples.map(|v| v[2] - 2.0 * v[1] + v[0]).collect()
}

/// Distance of strokes if they lay on a square grid, m; `None` of fewer than two. Of n points of a grid of pitch p over a
/// convex area A of circumference P, n ≈ A/p² + P/2p + 1.
fn pitch(paths: &[Vec<DVec2>]) -> Option<f64> {
    let places: Vec<DVec2> = paths.iter().map(|path| mean_of(path)).collect();
    let hull = hull(places);
    let edges = || hull.iter().zip(hull.iter().cycle().skip(1));
    let around: f64 = edges().map(|(a, b)| a.distance(*b)).sum();
    let area = 0.5 * edges().map(|(a, b)| a.perp_dot(*b)).sum::<f64>().abs();
    let more = paths.len() as f64 - 1.0;
    if more < 1.0 || around <= 0.0 {
        return None;
    }
    let half = 0.5 * around;
    let density = if 4.0 * area * more > 1e-9 * half * half {
        ((half * half + 4.0 * area * more).sqrt() - half) / (2.0 * area)
    } else {
        more / half
    };
    Some(1.0 / density)
}

/// Corners of the convex hull, counter-clockwise (Andrew 1979).
fn hull(mut places: Vec<DVec2>) -> Vec<DVec2> {
    places.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    places.dedup();
    if places.len() < 3 {
        return places;
    }
    let half = |places: &mut dyn Iterator<Item = DVec2>| {
        let mut chain: Vec<DVec2> = Vec::new();
        for at in places {
            while let [.., a, b] = chain[..]
                && (b - a).perp_dot(at - a) <= 0.0
            {
                chain.pop();
            }
            chain.push(at);
        }
        chain.pop();
        chain
    };
    let mut lower = half(&mut places.iter().copied());
    lower.extend(half(&mut places.iter().rev().copied()));
    lower
}

/// Parts of the strokes that follow each other and have one direction; all in one where a part would be too small.
fn parted(paths: &[Vec<DVec2>]) -> Vec<std::ops::Range<usize>> {
    let mut parts: Vec<std::ops::Range<usize>> = Vec::new();
    for number in 0..paths.len() {
        let own = direction(&paths[number..=number]);
        match parts.last_mut() {
            Some(part) if apart(own, direction(&paths[part.clone()])) < PASS_RAD => {
                part.end = number + 1;
            }
            _ => parts.push(number..number + 1),
        }
    }
    if parts.iter().all(|part| part.len() >= PASS) {
        parts
    } else {
        std::iter::once(0..paths.len()).collect()
    }
}

/// Angle between two directions modulo half a turn, rad.
fn apart(a: f64, b: f64) -> f64 {
    let (s, c) = sin_cos(2.0 * (a - b));
    0.5 * atan2(s, c).abs()
}

fn mark(stroke: &Stroke, path: &[DVec2], frame: Frame) -> Mark {
    let places: Vec<DVec2> = path.iter().map(|at| frame.of(*at)).collect();
    let along = places
        .iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], at| {
            [a.min(at.x), b.max(at.x)]
        });
    let ends = places.first().zip(places.last());
    Mark {
        stroke: stroke.clone(),
        along,
        across: places.iter().map(|at| at.y).sum::<f64>() / places.len().max(1) as f64,
        forth: ends.is_none_or(|(first, last)| last.x >= first.x),
    }
}

fn pause_s(strokes: &[Stroke]) -> f64 {
    let pair = |pair: &[Stroke]| pair[1].start_ns - (pair[0].start_ns + pair[0].length_ns);
    let pauses = strokes.windows(2).map(|two| pair(two) as f64 * 1e-9);
    median(pauses.collect())
}

/// True if values rise rather than fall.
fn rises(values: impl Iterator<Item = f64>) -> bool {
    let values: Vec<f64> = values.collect();
    let middle = 0.5 * (values.len() as f64 - 1.0);
    let slope: f64 = values
        .iter()
        .enumerate()
        .map(|(number, value)| (number as f64 - middle) * value)
        .sum();
    slope >= 0.0
}

fn dabs(strokes: &[Stroke], paths: &[Vec<DVec2>], pitch_m: f64) -> Pass {
    let frame = Frame::turned(0.0);
    let marks: Vec<Mark> = strokes
        .iter()
        .zip(paths)
        .map(|(stroke, path)| mark(stroke, path, frame))
        .collect();
    let places: Vec<DVec2> = paths.iter().map(|path| mean_of(path)).collect();
    let nearest = |number: usize| {
        let others = places
            .iter()
            .enumerate()
            .filter(|(other, _)| *other != number);
        let distances = others.map(|(_, at)| at.distance(places[number]));
        distances.fold(f64::INFINITY, f64::min)
    };
    let nearest: Vec<f64> = (0..places.len()).map(nearest).collect();
    let mean = nearest.iter().sum::<f64>() / nearest.len() as f64;
    let square = nearest.iter().map(|d| (d - mean) * (d - mean)).sum::<f64>();
    let spread_m = (square / nearest.len() as f64).sqrt();
    Pass {
        kind: Kind::Dabs,
        frame,
        upward: rises(marks.iter().map(|mark| mark.across)),
        marks,
        spacing_m: pitch_m,
        spread_m: spread_m.min(0.5 * pitch_m),
        ragged_m: 0.0,
        gap_m: None,
        pause_s: pause_s(strokes),
    }
}

/// Mean spacing of rows; of a single row that of a brush of this width.
fn spacing_m(rows: &[f64], width_m: f64) -> Result<f64, MotionError> {
    if !rows.is_empty() {
        Ok(rows.iter().sum::<f64>() / rows.len() as f64)
    } else if width_m > 0.0 {
        Ok(0.75 * width_m)
    } else {
        Err(MotionError::NoSpacing)
    }
}

fn hatches(strokes: &[Stroke], paths: &[Vec<DVec2>], width_m: f64) -> Result<Pass, MotionError> {
    let frame = Frame::turned(direction(paths));
    let marks: Vec<Mark> = strokes
        .iter()
        .zip(paths)
        .map(|(stroke, path)| mark(stroke, path, frame))
        .collect();
    let shared = |a: &Mark, b: &Mark| a.along[1].min(b.along[1]) - a.along[0].max(b.along[0]);
    let beside = |a: &Mark, b: &Mark| shared(a, b) > BESIDE * a.length_m().min(b.length_m());
    // The next row above a stroke, and the row that follows in time.
    let mut rows: Vec<f64> = Vec::new();
    for own in &marks {
        let above = marks
            .iter()
            .filter(|other| other.across > own.across && beside(own, other));
        let next = above
            .map(|other| other.across - own.across)
            .min_by(f64::total_cmp);
        rows.extend(next);
    }
    let spacing_m = spacing_m(&rows, width_m)?;
    let is_row = |a: &Mark, b: &Mark| (a.across - b.across).abs() < 0.5 * spacing_m;
    let mut gaps: Vec<f64> = Vec::new();
    for own in &marks {
        let after = marks.iter().filter(|other| {
            is_row(own, other) && other.along[0] > own.along[0] && !beside(own, other)
        });
        let next = after
            .map(|other| other.along[0] - own.along[1])
            .min_by(f64::total_cmp);
        gaps.extend(next);
    }
    let of = |value: &dyn Fn(&Mark) -> f64| -> Vec<f64> { marks.iter().map(value).collect() };
    let (across, starts, ends) = (of(&|m| m.across), of(&|m| m.along[0]), of(&|m| m.along[1]));
    let ragged = if gaps.is_empty() {
        // In a row of several, their ends are no border.
        [second_differences(&starts), second_differences(&ends)].concat()
    } else {
        Vec::new()
    };
    let spread_m = if gaps.is_empty() {
        noise(&second_differences(&across))
    } else {
        noise(&second_differences(&rows))
    };
    let lengths = marks.iter().map(Mark::length_m);
    let shortest = lengths.fold(f64::INFINITY, f64::min);
    Ok(Pass {
        kind: Kind::Hatches,
        frame,
        upward: rises(across.iter().copied()),
        spacing_m,
        spread_m: spread_m.min(0.25 * spacing_m),
        ragged_m: noise(&ragged).min(0.25 * shortest),
        gap_m: (!gaps.is_empty()).then(|| gaps.iter().sum::<f64>() / gaps.len() as f64),
        pause_s: pause_s(strokes),
        marks,
    })
}
