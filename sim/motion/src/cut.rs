//! A part of a motion.

use std::ops::RangeInclusive;

use crate::MotionError;
use crate::strokes::{Stroke, strokes};
use crate::take_sample::{TakeSample, checked};

/// Part of a motion to keep.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Part {
    /// From a time since its beginning to another, ns.
    Times([u64; 2]),
    /// From a stroke to another, by their numbers from 1, with half of the pauses around them: successive parts share
    /// no sample and leave none out.
    Strokes(RangeInclusive<usize>),
}

/// Cuts a part out of a motion; its times begin at 0.
///
/// # Errors
/// [`MotionError::NothingLeft`], [`MotionError::NoStroke`].
pub fn cut(
    samples: &[TakeSample],
    part: &Part,
    head_m: f64,
) -> Result<Vec<TakeSample>, MotionError> {
    let begin_ns = samples.first().map_or(0, |first| first.time_ns);
    let length_ns = samples.last().map_or(0, |last| last.time_ns - begin_ns);
    let [from_ns, to_ns] = match part {
        Part::Times(times) => *times,
        Part::Strokes(numbers) => times_of(&strokes(samples, head_m), numbers, length_ns)?,
    };
    let is_kept = |sample: &&TakeSample| (from_ns..=to_ns).contains(&(sample.time_ns - begin_ns));
    let kept: Vec<&TakeSample> = samples.iter().filter(is_kept).collect();
    let Some(first_ns) = kept.first().map(|first| first.time_ns) else {
        let [from_s, to_s, length_s] = [from_ns, to_ns, length_ns].map(|ns| ns as f64 * 1e-9);
        return Err(MotionError::NothingLeft {
            from_s,
            to_s,
            length_s,
        });
    };
    let rebased = |sample: &TakeSample| TakeSample {
        time_ns: sample.time_ns - first_ns,
        sample: sample.sample.clone(),
    };
    checked(kept.into_iter().map(rebased).collect())
}

/// Times of a range of strokes, ns.
fn times_of(
    strokes: &[Stroke],
    numbers: &RangeInclusive<usize>,
    length_ns: u64,
) -> Result<[u64; 2], MotionError> {
    let count = strokes.len();
    let missing = [*numbers.start(), *numbers.end()]
        .into_iter()
        .find(|number| !(1..=count).contains(number));
    let asked = missing.or(numbers.is_empty().then_some(*numbers.end()));
    if let Some(asked) = asked {
        return Err(MotionError::NoStroke { asked, count });
    }
    // In the middle of the pause before a stroke.
    let before = |index: usize| {
        let end_ns = strokes[index - 1].start_ns + strokes[index - 1].length_ns;
        end_ns.midpoint(strokes[index].start_ns)
    };
    let from_ns = match numbers.start() - 1 {
        0 => 0,
        first => before(first),
    };
    let to_ns = match *numbers.end() {
        last if last == count => length_ns,
        next => before(next) - 1,
    };
    Ok([from_ns, to_ns])
}
