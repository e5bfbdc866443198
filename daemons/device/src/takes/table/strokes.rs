//! Strokes of a table, and the times of their samples.

use maulstick_rig::UserError;
use maulstick_types::stylus::{StylusPose, StylusSample};

use super::PAUSE_NS;
use super::columns::Row;
use super::note::Note;
use crate::take::TakeSample;

/// Longest time of a table, ns: a year.
const LONGEST_NS: f64 = 3.2e16;
/// Time from a lift to the contact before or behind it, ns.
const LIFT_NS: u64 = 8_000_000;

/// Parts strokes at which time begins anew: where it falls to the beginning of a stroke or before.
///
/// # Errors
/// A [`UserError`] with the line where it falls back to within a stroke, for then the rows may be out of order.
pub(super) fn part(rows: &mut [Row], name: &str) -> Result<(), UserError> {
    let (mut first, mut more) = (0, 0);
    for at in 1..rows.len() {
        rows[at].stroke += more;
        if rows[at].stroke != rows[at - 1].stroke {
            first = at;
            continue;
        }
        let [begin, last, now] = [first, at - 1, at].map(|row| rows[row].time());
        if now >= last {
            continue;
        }
        if now > begin || last <= begin {
            return Err(
                UserError::usage(format!("time runs backward: {now} after {last}"))
                    .at(format!("{name}:{}", rows[at].line))
                    .help(
                        "sort the table by time; where another stroke begins, put an empty line before it or number the \
                         strokes in a column `stroke`",
                    ),
            );
        }
        rows[at].stroke += 1;
        more += 1;
        first = at;
    }
    Ok(())
}

/// Spreads samples of the same time, as clocks of coarse steps give them, evenly over the time until the next.
///
/// # Errors
/// A [`UserError`] where all samples have the same time.
pub(super) fn spread(rows: &mut [Row], name: &str, notes: &mut Vec<Note>) -> Result<(), UserError> {
    let same = |two: &[Row]| two[0].stroke == two[1].stroke;
    let pairs = rows.windows(2).filter(|two| same(two));
    let steps = pairs.map(|two| two[1].time() - two[0].time());
    let (ties, mut steps): (Vec<f64>, Vec<f64>) = steps.partition(|step| *step == 0.0);
    if ties.is_empty() {
        return Ok(());
    }
    if steps.is_empty() {
        return Err(
            UserError::usage("all samples of a stroke have the same time")
                .at(name)
                .help("give the time of each sample in the column t"),
        );
    }
    let middle = steps.len() / 2;
    let usual = *steps.select_nth_unstable_by(middle, f64::total_cmp).1;
    let is_tied = |one: &Row, other: &Row| one.stroke == other.stroke && one.time() == other.time();
    let most = rows.chunk_by(is_tied).map(<[Row]>::len).max().unwrap_or(1);
    let mut at = 0;
    while at < rows.len() {
        let (time, stroke) = (rows[at].time(), rows[at].stroke);
        let tied = rows[at..].iter().take_while(|row| is_tied(row, &rows[at]));
        let count = tied.count();
        let next = rows.get(at + count).filter(|row| row.stroke == stroke);
        let span = match next {
            Some(next) => usual.min(next.time() - time),
            // The stroke may end before its last step of the clock does: it ends at the pace of the densest step.
            None => usual * count as f64 / most as f64,
        };
        for (place, row) in rows[at..at + count].iter_mut().enumerate() {
            row.values[0] = time + span * place as f64 / count as f64;
        }
        at += count;
    }
    notes.push(Note::Coarse {
        ties: ties.len(),
        samples: rows.len(),
    });
    Ok(())
}

/// Times of the rows since the first, ns; `unit_ns` is the unit of their time. A stroke begins [`PAUSE_NS`] behind the one
/// before at least, and what comes behind it is as much later.
///
/// # Errors
/// A [`UserError`] with the line of a time that is farther from the first than [`LONGEST_NS`].
pub(super) fn times_ns(
    rows: &[Row],
    unit_ns: f64,
    name: &str,
    notes: &mut Vec<Note>,
) -> Result<Vec<u64>, UserError> {
    let begin = rows.first().map_or(0.0, Row::time);
    let (mut shift, mut end) = (0.0, 0.0);
    let mut times = Vec::with_capacity(rows.len());
    for (at, row) in rows.iter().enumerate() {
        let own = (row.time() - begin) * unit_ns;
        if own.abs() > LONGEST_NS {
            let what = format!("the time {} is years from the first", row.time());
            return Err(UserError::usage(what)
                .at(format!("{name}:{}", row.line))
                .help("correct it, or give the unit of t by --time-unit ms, us or ns"));
        }
        if at > 0 && rows[at - 1].stroke != row.stroke {
            shift += (end + PAUSE_NS - own - shift).max(0.0);
        }
        end = own + shift;
        times.push(end.round() as u64);
    }
    let strokes = rows.last().map_or(0, |row| row.stroke + 1);
    if strokes > 1 {
        notes.push(Note::Strokes(strokes));
    }
    Ok(times)
}

/// The samples with the pen lifted between strokes.
pub(super) fn lifted(rows: &[Row], samples: Vec<TakeSample>) -> Vec<TakeSample> {
    let mut all: Vec<TakeSample> = Vec::with_capacity(samples.len());
    for (at, sample) in samples.into_iter().enumerate() {
        if let Some(last) = all
            .last()
            .filter(|_| rows[at - 1].stroke != rows[at].stroke)
        {
            let before = TakeSample {
                time_ns: last.time_ns.saturating_add(LIFT_NS),
                sample: in_air(&last.sample),
            };
            let behind = TakeSample {
                time_ns: sample.time_ns.saturating_sub(LIFT_NS),
                sample: in_air(&sample.sample),
            };
            all.extend(rows[at - 1].touches().then_some(before));
            all.extend(rows[at].touches().then_some(behind));
        }
        all.push(sample);
    }
    all
}

/// The same pen in the air.
fn in_air(sample: &StylusSample) -> StylusSample {
    let mut sample = sample.clone();
    if let StylusPose::Contact { pressure, .. } = &mut sample.pose {
        *pressure = 0.0;
    }
    sample
}
