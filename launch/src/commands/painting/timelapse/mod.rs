//! `maulstick painting timelapse`: a film of how a painting was painted, of its record.

mod film_file;

use std::path::{Path, PathBuf};

use clap::Args;
use clap::builder::PossibleValuesParser;
use indicatif::ProgressBar;
use maulstick_appearance::picture::Picture;
use maulstick_document::DocumentError;
use maulstick_exchange::film::{Film, frame_size};
use maulstick_painting::{Painting, Sequencer};
use maulstick_rig::UserError;
use maulstick_rig::config::BACKENDS;
use maulstick_session::{Reexecution, TilePrints, WorkClock, tile_prints};

use maulstick_painting_setup::backend::choose_backend;
use maulstick_painting_setup::document::{read, wrong};
use maulstick_painting_setup::refused;

use self::film_file::{FilmFile, FilmKind};
use crate::commands::{progress_bar, say};

/// Longest time for which the finished painting is shown at the end, s.
const HOLD_S: f64 = 2.0;
/// Greatest share of a film for its still end.
const HOLD_SHARE: f64 = 0.2;
/// Lengths of a film, s.
const SECONDS: std::ops::RangeInclusive<f64> = 0.1..=3600.0;

/// Options of `maulstick painting timelapse`.
#[derive(Args, Clone, Debug)]
pub struct TimelapseOptions {
    /// Painting
    file: PathBuf,
    /// Film to write: .mp4, for which ffmpeg must be installed, .gif, or a new folder for numbered PNG pictures
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    /// Length of the film, s
    #[arg(long, default_value_t = 30.0, allow_negative_numbers = true)]
    seconds: f64,
    /// Frames a second
    #[arg(long, default_value_t = 30, value_parser = clap::value_parser!(u32).range(1..=60))]
    fps: u32,
    /// Width of the film, pixels, a pixel a cell at most [default: 1920 for the longer side, 640 of a .gif]
    #[arg(long, value_name = "PX", value_parser = clap::value_parser!(u32).range(1..=16384))]
    width: Option<u32>,
    /// Where paint is computed: as it was painted for the same bytes, auto for speed
    #[arg(long, value_name = "NAME", default_value = "cpu", value_parser = PossibleValuesParser::new(BACKENDS))]
    backend: String,
}

/// Error of a painting without a record.
pub(in crate::commands) fn no_record(path: &Path) -> UserError {
    UserError::usage("this painting has no record of how it was painted")
        .at(path.display().to_string())
        .help(
            "what is painted in it from now on is recorded, unless `--record 0` was given; a record of an older version of \
             Maulstick can be used by that version alone",
        )
}

/// Most frames a second of a GIF: it counts hundredths, and viewers take one for ten.
const GIF_FPS: u32 = 50;

/// Writes the film.
///
/// # Errors
/// A [`UserError`] where the painting cannot be read or has no record, or the film not be written.
pub(super) fn run(options: &TimelapseOptions) -> Result<i32, UserError> {
    let kind = FilmKind::of(&options.output)?;
    if !SECONDS.contains(&options.seconds) {
        let what = format!("a film of {} s", options.seconds);
        return Err(UserError::usage(what)
            .at("--seconds")
            .help("give 0.1 to 3600 s"));
    }
    if kind == FilmKind::Gif && options.fps > GIF_FPS {
        let what = format!("a GIF has no {} frames a second", options.fps);
        return Err(UserError::usage(what).at("--fps").help(format!(
            "give {GIF_FPS} at most, or a name that ends in .mp4"
        )));
    }
    let file = FilmFile::new(kind, &options.output, &options.file, options.fps)?;
    let path = &options.file;
    let finished = Finished::read(options, kind)?;
    let (document, opened) = read(path)?;
    let first = Reexecution::new(document, opened).map_err(refused)?;
    let mut first = first.ok_or_else(|| no_record(path))?;
    let (mut clock, mut all_ns) = (WorkClock::default(), 0);
    let looked = first.look_ahead(|record| all_ns = clock.pass(record));
    looked.map_err(|error: DocumentError| wrong(path, &error))?;
    choose_backend(first.sequencer_mut(), &options.backend)?;

    let plan = FramePlan::new(options.seconds, options.fps, all_ns);
    let bar = progress_bar(0).with_message("painting");
    let mut differing = 0;
    let written = file.write([finished.picture.width, finished.picture.height], |add| {
        let result = shoot(options, &mut first, &finished, plan, &bar, add)?;
        differing = finished.differing(&result);
        Ok(())
    });
    bar.finish_and_clear();
    written?;
    say!(
        "{}: {} frames, {:.1} s of work in {:.1} s",
        options.output.display(),
        plan.frames(),
        all_ns as f64 * 1e-9,
        plan.frames() as f64 / f64::from(options.fps)
    );
    if differing > 0 {
        eprintln!(
            "{}: executed again, the record gives other paint on {differing} of {} tiles; the film ends with the painting \
             as its file has it. That happens where a graphics processor or another version of Maulstick painted",
            path.display(),
            finished.prints.len()
        );
    }
    Ok(0)
}

/// The painting as its file has it.
struct Finished {
    cells: [usize; 2],
    prints: TilePrints,
    picture: Picture,
}

impl Finished {
    fn read(options: &TimelapseOptions, kind: FilmKind) -> Result<Self, UserError> {
        let path = &options.file;
        let (document, opened) = read(path)?;
        if opened.beginning().is_none() {
            return Err(no_record(path));
        }
        let mut sequencer = opened.sequencer().map_err(refused)?;
        let painting = sequencer.painting_mut();
        let cells = painting.scene().surfaces[0]
            .cells
            .map(|cells| cells as usize);
        let longer = cells[0].max(cells[1]).max(1);
        let side = kind.side().min(longer);
        let width = options.width.map_or_else(
            || (cells[0] * side).div_ceil(longer),
            |width| width as usize,
        );
        let size = frame_size(cells, width, kind == FilmKind::Mp4);
        let prints = tile_prints(painting);
        let picture = frame(&mut Film::new(cells, size), painting)?;
        match document.pager().fault() {
            Some(what) => Err(wrong(path, &DocumentError::Damaged(what.to_owned()))),
            None => Ok(Self {
                cells,
                prints,
                picture,
            }),
        }
    }

    /// Number of tiles with other paint.
    fn differing(&self, other: &TilePrints) -> usize {
        let here = self.prints.iter();
        let gone = here.filter(|(place, print)| other.get(place) != Some(print));
        let new = other
            .keys()
            .filter(|place| !self.prints.contains_key(place));
        gone.count() + new.count()
    }
}

fn frame(film: &mut Film, painting: &mut Painting) -> Result<Picture, UserError> {
    let frame = film.frame(painting);
    frame.ok_or_else(|| UserError::failure("the canvas has changed its size"))
}

/// Frames of a film: they stand at equal distances of working time.
#[derive(Clone, Copy, Debug)]
struct FramePlan {
    /// Frames in which something happens.
    moving: u64,
    /// Frames of the finished painting.
    hold: u64,
    /// All working time, ns.
    all_ns: u64,
}

impl FramePlan {
    fn new(seconds: f64, fps: u32, all_ns: u64) -> Self {
        let frames = ((seconds * f64::from(fps)).round() as u64).max(2);
        let hold_s = HOLD_S.min(HOLD_SHARE * seconds);
        let hold = ((hold_s * f64::from(fps)).round() as u64).clamp(1, frames - 1);
        Self {
            moving: frames - hold,
            hold,
            all_ns,
        }
    }

    fn frames(self) -> u64 {
        self.moving + self.hold
    }

    /// Working time of a frame, ns; the first shows the beginning.
    fn time_ns(self, frame: u64) -> u64 {
        (u128::from(self.all_ns) * u128::from(frame) / u128::from(self.moving)) as u64
    }
}

/// Executes a record and hands over the frames; returns the paint that it gives.
fn shoot(
    options: &TimelapseOptions,
    reexecution: &mut Reexecution,
    finished: &Finished,
    plan: FramePlan,
    bar: &ProgressBar,
    add: &mut dyn FnMut(&Picture) -> Result<(), UserError>,
) -> Result<TilePrints, UserError> {
    let size = [finished.picture.width, finished.picture.height];
    let mut film = Film::new(finished.cells, size);
    let (mut clock, mut shown) = (WorkClock::default(), 0);
    bar.set_length(plan.moving);
    let mut show = |sequencer: &mut Sequencer, until_ns: u64| {
        while shown < plan.moving && plan.time_ns(shown) < until_ns {
            let picture = frame(&mut film, sequencer.painting_mut())?;
            // Frames between two messages are alike.
            while shown < plan.moving && plan.time_ns(shown) < until_ns {
                add(&picture)?;
                shown += 1;
            }
            bar.set_position(shown);
        }
        Ok(())
    };
    show(reexecution.sequencer_mut(), 1)?;
    let done = reexecution.run(|sequencer, record| {
        let after_ns = clock.pass(record);
        show(sequencer, after_ns).map_err(ShootError::User)
    });
    done.map_err(|error| match error {
        ShootError::User(error) => error,
        ShootError::Document(error) => wrong(&options.file, &error),
    })?;
    show(reexecution.sequencer_mut(), u64::MAX)?;
    let prints = tile_prints(reexecution.sequencer_mut().painting_mut());
    if let Some(what) = reexecution.document().pager().fault() {
        let error = DocumentError::Damaged(what.to_owned());
        return Err(wrong(&options.file, &error));
    }
    (0..plan.hold).try_for_each(|_| add(&finished.picture))?;
    Ok(prints)
}

/// Error of the record, or of the film.
enum ShootError {
    Document(DocumentError),
    User(UserError),
}

impl From<DocumentError> for ShootError {
    fn from(error: DocumentError) -> Self {
        Self::Document(error)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_stand_at_equal_distances_and_the_last_ones_hold() {
        let plan = FramePlan::new(30.0, 30, 280_000);
        assert_eq!((plan.moving, plan.hold, plan.frames()), (840, 60, 900));
        assert_eq!((plan.time_ns(0), plan.time_ns(420)), (0, 140_000));
        let plan = FramePlan::new(1.0, 10, u64::MAX);
        assert_eq!((plan.moving, plan.hold), (8, 2));
        assert!(plan.time_ns(7) < u64::MAX);
        let plan = FramePlan::new(0.1, 1, 0);
        assert_eq!((plan.moving, plan.hold), (1, 1));
    }
}
