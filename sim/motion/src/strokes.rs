//! Strokes of a motion: touches less than [`GAP_NS`] apart are one, as in the brush's count.

use std::ops::Range;

use maulstick_types::stylus::StylusPose;

use crate::take_sample::TakeSample;

/// Gap below which touches are one stroke, ns, as in `sim/brush/src/follow/stroke_count.rs`.
pub const GAP_NS: u64 = 150_000_000;

/// A stroke of a motion.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Stroke {
    /// Its samples, from the first that touches to the last.
    pub samples: Range<usize>,
    /// Its beginning since that of the motion, ns.
    pub start_ns: u64,
    /// Its duration, ns.
    pub length_ns: u64,
}

impl Stroke {
    /// Path of the brush's point on the surface: x and y, m, and depth of the press, 0 to 1.
    #[must_use]
    pub fn path(&self, samples: &[TakeSample], head_m: f64) -> Vec<[f64; 3]> {
        let along = samples[self.samples.clone()].iter();
        let at = |sample: &TakeSample| {
            let [x, y, _] = sample.point(head_m);
            [x, y, sample.press(head_m)]
        };
        along.map(at).collect()
    }
}

/// True while the brush touches the surface: the pen presses, or the point of a head of `head_m` is below the desk.
fn touches(sample: &TakeSample, head_m: f64) -> bool {
    let lies_below = match &sample.sample.pose {
        StylusPose::Contact { .. } => true,
        StylusPose::Ferrule { .. } => sample.point(head_m)[2] < 0.0,
    };
    lies_below && !sample.sample.in_air()
}

/// The strokes of a motion, in order. `head_m` is the length of the head that a 6-DOF stylus holds, m.
#[must_use]
pub fn strokes(samples: &[TakeSample], head_m: f64) -> Vec<Stroke> {
    let begin_ns = samples.first().map_or(0, |first| first.time_ns);
    let mut found: Vec<Stroke> = Vec::new();
    for (number, sample) in samples.iter().enumerate() {
        if !touches(sample, head_m) {
            continue;
        }
        let at_ns = sample.time_ns - begin_ns;
        let end_ns = |stroke: &Stroke| stroke.start_ns + stroke.length_ns;
        match found.last_mut() {
            Some(stroke) if stroke.samples.end == number || at_ns - end_ns(stroke) < GAP_NS => {
                stroke.samples.end = number + 1;
                stroke.length_ns = at_ns - stroke.start_ns;
            }
            _ => found.push(Stroke {
                samples: number..number + 1,
                start_ns: at_ns,
                length_ns: 0,
            }),
        }
    }
    found
}

/// Least and greatest x and y over the strokes, m; `None` without contact.
#[must_use]
pub fn bounds(samples: &[TakeSample], strokes: &[Stroke], head_m: f64) -> Option<[[f64; 2]; 2]> {
    let paths = strokes
        .iter()
        .flat_map(|stroke| stroke.path(samples, head_m));
    paths.fold(None, |bounds, [x, y, _]| {
        let [least, most] = bounds.unwrap_or([[x, y]; 2]);
        Some([
            [least[0].min(x), least[1].min(y)],
            [most[0].max(x), most[1].max(y)],
        ])
    })
}

/// Middle of the rectangle around the strokes, m; without contact, that of the whole motion.
#[must_use]
pub fn middle(samples: &[TakeSample], head_m: f64) -> [f64; 2] {
    let whole = Stroke {
        samples: 0..samples.len(),
        start_ns: 0,
        length_ns: 0,
    };
    let bounds = bounds(samples, &strokes(samples, head_m), head_m)
        .or_else(|| bounds(samples, &[whole], head_m));
    let [least, most] = bounds.unwrap_or_default();
    [0, 1].map(|axis| 0.5 * (least[axis] + most[axis]))
}
