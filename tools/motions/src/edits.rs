//! Operations on the motion of a take, which keep its setup.

use std::path::PathBuf;

use maulstick_device::{Take, TakeSample, TakeSetup};
use maulstick_motion::{
    Mirror, MotionError, Pace, Part, Placement, joined, mirrored, retimed, strokes,
};
use maulstick_rig::UserError;
use maulstick_rig::files::Kind;

use maulstick::commands::write_take;
use maulstick_painting_setup::outputs::{UsedFile, check_outputs};
use maulstick_tool_options::motion::refused;
use maulstick_tool_options::motions::{
    CutOptions, JoinOptions, MirrorAxis, MirrorOptions, MoveOptions, RetimeOptions, RotateOptions,
    ScaleOptions, TakeFiles,
};

use crate::recorded::read_motion;

/// Reads a take, has its motion changed and writes it.
fn change(
    files: &TakeFiles,
    change: impl FnOnce(&[TakeSample], f64) -> Result<Vec<TakeSample>, MotionError>,
) -> Result<i32, UserError> {
    change_all(files, None, |take, head_m| {
        let samples = change(&take.samples, head_m)?;
        Ok(Take { samples, ..take })
    })
}

/// As [`change`], with what the take is painted with.
fn change_all(
    files: &TakeFiles,
    device: Option<&str>,
    change: impl FnOnce(Take, f64) -> Result<Take, MotionError>,
) -> Result<i32, UserError> {
    check_outputs(
        &[UsedFile::new("the take", &files.output).of(Kind::Take)],
        &[UsedFile::new("the take that stays as it is", &files.take)],
    )?;
    let take = read_motion(&files.take, device)?;
    let head_m = files.head.length_m(&take, &files.take)?;
    let changed = change(take, head_m).map_err(refused(&files.take))?;
    write_take(&changed, &files.output)?;
    Ok(0)
}

pub(crate) fn cut(options: &CutOptions) -> Result<i32, UserError> {
    let ns = |name: &str, seconds: f64| {
        if seconds >= 0.0 && seconds.is_finite() {
            Ok((seconds * 1e9).round() as u64)
        } else {
            Err(
                UserError::usage(format!("{name} {seconds} is no time of a take"))
                    .help("count seconds from its beginning"),
            )
        }
    };
    let part = match options.strokes {
        Some([first, last]) => Part::Strokes(first..=last),
        None => Part::Times([
            ns("--start", options.start.unwrap_or(0.0))?,
            options.end.map_or(Ok(u64::MAX), |end| ns("--end", end))?,
        ]),
    };
    change_all(&options.files, options.device.as_deref(), |take, head_m| {
        let samples = maulstick_motion::cut(&take.samples, &part, head_m)?;
        let begin_ns = take.samples.first().map_or(0, |first| first.time_ns);
        let before = match part {
            Part::Strokes(numbers) => numbers.start() - 1,
            Part::Times([from_ns, _]) => {
                let all = strokes(&take.samples, head_m).into_iter();
                let end = |stroke: &maulstick_motion::Stroke| {
                    let last = &take.samples[stroke.samples.end - 1];
                    last.time_ns - begin_ns
                };
                all.filter(|stroke| end(stroke) < from_ns).count()
            }
        };
        // Strokes load in turn, and the first that is left keeps its own.
        let setup = take.setup.map(|mut setup| {
            if !setup.loads.is_empty() {
                let by = before % setup.loads.len();
                setup.loads.rotate_left(by);
            }
            setup
        });
        Ok(Take {
            samples,
            setup,
            ..take
        })
    })
}

pub(crate) fn join(options: &JoinOptions) -> Result<i32, UserError> {
    let named = |path: &PathBuf| UsedFile::new("a take that stays as it is", path);
    let inputs: Vec<UsedFile> = options.takes.iter().map(named).collect();
    check_outputs(
        &[UsedFile::new("the take", &options.output).of(Kind::Take)],
        &inputs,
    )?;
    let read: Result<Vec<Take>, UserError> =
        options.takes.iter().map(|path| Take::read(path)).collect();
    let takes: Vec<(&PathBuf, Take)> = options.takes.iter().zip(read?).collect();
    let (mut setup, mut each): (Option<TakeSetup>, Vec<(Vec<String>, usize)>) = (None, Vec::new());
    for (path, take) in &takes {
        let head_m = options.head.length_m(take, path)?;
        let loads = take
            .setup
            .as_ref()
            .map_or_else(Vec::new, |own| own.loads.clone());
        each.push((loads, strokes(&take.samples, head_m).len()));
        match (&setup, &take.setup) {
            (Some(one), Some(other)) if !is_same(one, other) => {
                let what = "the takes embed different canvases, brushes, paints or lights";
                return Err(UserError::usage(what)
                    .at(path.display().to_string())
                    .help("embed the same in all of them: `maulstick take embed`"));
            }
            (None, Some(own)) => setup = Some(own.clone()),
            _ => {}
        }
    }
    if let Some(setup) = &mut setup {
        setup.loads = in_turn(&each);
    }
    let parts: Vec<&[TakeSample]> = takes.iter().map(|(_, take)| &*take.samples).collect();
    let samples = joined(&parts, options.pause).map_err(refused(&options.takes[0]))?;
    let device = takes[0].1.device.clone();
    write_take(
        &Take {
            device,
            samples,
            setup,
        },
        &options.output,
    )?;
    Ok(0)
}

/// True if two takes have the same setup, except for the loads of their strokes.
fn is_same(one: &TakeSetup, other: &TakeSetup) -> bool {
    (&one.settings, &one.files) == (&other.settings, &other.files)
}

/// Loads of the strokes of takes that follow each other; those of the takes where they are the same in all.
fn in_turn(each: &[(Vec<String>, usize)]) -> Vec<String> {
    let mut loading = each.iter().filter(|(loads, _)| !loads.is_empty());
    let Some((first, _)) = loading.next() else {
        return Vec::new();
    };
    let is_one = first.len() == 1 && each.iter().all(|(loads, _)| loads == first);
    if is_one {
        return first.clone();
    }
    let of = |(loads, strokes): &(Vec<String>, usize)| {
        // A take without loads continues with the first of the others.
        let loads = if loads.is_empty() { first } else { loads };
        let own: Vec<String> = loads.iter().cycle().take(*strokes).cloned().collect();
        own
    };
    each.iter().flat_map(of).collect()
}

pub(crate) fn scale(options: &ScaleOptions) -> Result<i32, UserError> {
    change(&options.files, |samples, head_m| {
        let about = options.about.point(samples, head_m);
        Placement::scaled(about, options.by).motion(samples, head_m)
    })
}

pub(crate) fn rotate(options: &RotateOptions) -> Result<i32, UserError> {
    change(&options.files, |samples, head_m| {
        let about = options.about.point(samples, head_m);
        Placement::turned(about, options.by.to_radians()).motion(samples, head_m)
    })
}

pub(crate) fn shift(options: &MoveOptions) -> Result<i32, UserError> {
    let by = options.by.map(|mm| 1e-3 * mm);
    let place = Placement::moved(by);
    change(&options.files, |samples, head_m| {
        place.motion(samples, head_m)
    })
}

pub(crate) fn retime(options: &RetimeOptions) -> Result<i32, UserError> {
    let pace = match (options.rate, options.seconds) {
        (_, Some(seconds)) => Pace::Length(seconds),
        (rate, None) => Pace::Rate(rate.unwrap_or(1.0)),
    };
    change(&options.files, |samples, _| retimed(samples, pace))
}

pub(crate) fn mirror(options: &MirrorOptions) -> Result<i32, UserError> {
    let axis = match options.axis {
        MirrorAxis::X => Mirror::X,
        MirrorAxis::Y => Mirror::Y,
    };
    change(&options.files, |samples, head_m| {
        let about = options.about.point(samples, head_m);
        mirrored(samples, axis, about)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strokes_of_joined_takes_keep_their_loads() {
        let loads = |text: &str| {
            text.split_whitespace()
                .map(str::to_owned)
                .collect::<Vec<_>>()
        };
        let each = [(loads("a b"), 3), (loads("c"), 2)];
        assert_eq!(in_turn(&each), loads("a b a c c"));
        assert_eq!(in_turn(&[(loads("a"), 3), (loads("a"), 2)]), loads("a"));
        assert_eq!(in_turn(&[(Vec::new(), 3), (Vec::new(), 1)]), loads(""));
        assert_eq!(
            in_turn(&[(Vec::new(), 1), (loads("a b"), 2)]),
            loads("a a b")
        );
    }
}
