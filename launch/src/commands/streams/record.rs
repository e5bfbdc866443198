//! `maulstick recording record`: the streams of a running rig into a file, by a process of its own that no node waits for.

use std::fs::{File, TryLockError};
use std::io::{Error, ErrorKind};
use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::Args;
use maulstick_rig::UserError;
use maulstick_rig::files::{Kind, open_private};
use maulstick_rig::log::print_beside;

use super::listener::Listener;
use super::recorder::{Division, LEAST_LAST, RecorderSettings, Ring, Voice, record};
use crate::commands::client::Target;
use crate::commands::open::LONGEST;
use crate::outputs::{UsedFile, check_outputs};

/// Options of `maulstick recording record`.
#[derive(Args, Clone, Debug)]
pub struct RecordOptions {
    /// Recording to write
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// Topics to record, such as stylus/**: * stands for one part, ** for any number
    #[arg(long, value_name = "TOPIC", default_value = "**")]
    topic: String,
    /// End after so long, s; otherwise at Ctrl-C, or with the rig
    #[arg(long, value_name = "S")]
    seconds: Option<f64>,
    /// Begin another file after so many megabytes
    #[arg(long, value_name = "MB", value_parser = clap::value_parser!(u64).range(1..))]
    split_mb: Option<u64>,
    /// Begin another file after so long, s
    #[arg(long, value_name = "S")]
    split_seconds: Option<f64>,
    /// Keep only the newest so many seconds: the oldest of six files goes
    #[arg(long, value_name = "S", conflicts_with = "split_seconds")]
    last: Option<f64>,
    /// Keep at most so many megabytes on the disk: the oldest files go
    #[arg(long, value_name = "MB", value_parser = clap::value_parser!(u64).range(1..))]
    quota_mb: Option<u64>,
    /// Most messages a second of each topic that are written as JSON too, for Foxglove; 0 for none
    #[arg(long, value_name = "HZ", default_value_t = 20, value_parser = clap::value_parser!(u32).range(..=1000))]
    json_hz: u32,
    /// Print a line of JSON where a file begins or ends, and where the painting is in it or cannot be
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    target: Target,
}

/// Records until Ctrl-C, the end of the time, or that of the rig.
///
/// # Errors
/// A [`UserError`] where no rig runs, or the file cannot be written: what was written until then can be read.
pub(super) fn run(options: &RecordOptions) -> Result<i32, UserError> {
    print_beside();
    let bounded = |name: &str, seconds: Option<f64>| match seconds {
        Some(s) if !(0.1..=1e7).contains(&s) => {
            Err(UserError::usage(format!("--{name} {s} is out of range"))
                .help("choose .1 s to 10,000,000 s"))
        }
        seconds => Ok(seconds.map(Duration::from_secs_f64)),
    };
    let lasts = bounded("seconds", options.seconds)?;
    let last = bounded("last", options.last)?;
    if last.is_some_and(|last| last < LEAST_LAST) {
        let what = format!("--last {} is out of range", options.last.unwrap_or(0.0));
        let least = LEAST_LAST.as_secs();
        return Err(UserError::usage(what).help(format!("choose {least} s or more")));
    }
    let bytes = |mb: u64| mb.saturating_mul(1_000_000);
    let settings = RecorderSettings {
        target: options.target.clone(),
        topic: options.topic.clone(),
        lasts,
        division: Division {
            most_bytes: options.split_mb.map(bytes),
            after: bounded("split-seconds", options.split_seconds)?,
            last,
            quota_bytes: options.quota_mb.map(bytes),
        },
        json_hz: options.json_hz,
        longest_wait: LONGEST,
        voice: match options.json {
            true => Voice::Json,
            false => Voice::Words,
        },
    };
    let output = UsedFile::new("the recording", &options.output).of(Kind::Take);
    check_outputs(&[output], &[])?;
    let mut listener = Listener::open(&options.target, &options.topic)?;
    let ring = Ring::new(&options.output, settings.division);
    record(&settings, &mut listener, ring, begin_anew)?;
    Ok(0)
}

/// Opens a file to be written anew, once no other program records into it.
fn begin_anew(path: &Path) -> std::io::Result<File> {
    let file = open_private(path)?;
    file.try_lock().map_err(|error| match error {
        TryLockError::WouldBlock => {
            Error::new(ErrorKind::ResourceBusy, "another program records into it")
        }
        TryLockError::Error(error) => error,
    })?;
    file.set_len(0)?;
    Ok(file)
}
