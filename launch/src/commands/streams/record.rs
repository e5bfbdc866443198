//! `maulstick recording record`: the streams of a running rig into a file, which no node waits for.

use std::path::PathBuf;
use std::time::Duration;

use clap::Args;
use maulstick_recorder::{Division, LEAST_LAST, Recorder, RecorderSettings, Ring};
use maulstick_rig::UserError;
use maulstick_rig::files::Kind;
use maulstick_rig::log::print_beside;
use tokio::runtime::Handle;

use maulstick_painting_setup::outputs::{UsedFile, check_outputs};

use super::recorder_words::LogFormat;
use crate::commands::client::Target;
use crate::runtime::{EndSignals, block_on};

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
/// A [`UserError`] where no rig runs, or the file cannot be written: its earlier part is readable.
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
        topic: options.topic.clone(),
        length: lasts,
        division: Division {
            most_bytes: options.split_mb.map(bytes),
            after: bounded("split-seconds", options.split_seconds)?,
            last,
            quota_bytes: options.quota_mb.map(bytes),
        },
        json_hz: options.json_hz,
        ..RecorderSettings::default()
    };
    let output = UsedFile::new("the recording", &options.output).of(Kind::Take);
    check_outputs(&[output], &[])?;
    let format = if options.json {
        LogFormat::Json
    } else {
        LogFormat::Words
    };
    let ring = Ring::new(&options.output, settings.division);
    block_on(async {
        let mut signals = EndSignals::watch()?;
        let runtime = Handle::current();
        let mut recorder = Recorder::start(&runtime, options.target.rig(), settings, ring);
        let mut shown = Ok(());
        loop {
            tokio::select! {
                event = recorder.events.recv() => match event {
                    Some(event) => shown = shown.and_then(|()| format.show(&event)),
                    None => break,
                },
                _ = signals.next() => recorder.stop(),
            }
            // The reader is gone: the file is finished.
            if shown.is_err() {
                recorder.stop();
            }
        }
        recorder.ended().await?;
        shown.map(|()| 0)
    })
}
