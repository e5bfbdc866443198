//! `maulstick take`: making, painting and showing takes, and the intact part of a damaged one.

use std::collections::BTreeMap;
use std::io::Error;
use std::path::{Path, PathBuf};

use clap::{Args, Subcommand};
use maulstick_device::salvage::salvage;
use maulstick_device::{Take, TakeSetup, use_kit};
use maulstick_recorder::paintings::open_begin;
use maulstick_recorder::session_file::{Event, PAINTING, SessionFile};
use maulstick_rig::files::{Kind, write_whole};
use maulstick_rig::{RigConfig, UserError};
use maulstick_session::RecordedSession;
use maulstick_streams::recovery::DamagedRecording;
use maulstick_streams::topic_pattern::{matches, parts};
use maulstick_types::stylus::StylusPose;
use mcap::McapError;
use serde_json::json;

use maulstick_painting_setup::cells::picture_settings;
use maulstick_painting_setup::document::wrong;
use maulstick_painting_setup::outputs::{UsedFile, check_outputs, named_by};
use maulstick_painting_setup::take_setup::take_setup;
use maulstick_painting_setup::{KitOptions, library_from, painting_setup, refused};

use super::from::{self, FromOptions};
use super::import::{self, ImportOptions};
use super::render::{self, RenderOptions};
use crate::commands::{print_json, say, write_take};

/// Topics of the hands.
const HANDS: &str = "stylus/*/sample";
/// Message for a file without damage.
const WHOLE: &str = "nothing was damaged";

/// Subcommands of `maulstick take`.
#[derive(Subcommand, Clone, Debug)]
pub enum TakeCommand {
    /// Paint a take without a rig
    Render(Box<RenderOptions>),
    /// Make a take from a table of strokes
    Import(ImportOptions),
    /// Show what a take holds
    Info {
        /// Take
        take: PathBuf,
        /// Print JSON
        #[arg(long)]
        json: bool,
    },
    /// Make a take of a recorded session, or of what a painting was painted with
    ///
    /// It holds strokes and commands, and the painting as it was before.
    From(FromOptions),
    /// Embed in a take what it is painted with, so that it gives the same painting anywhere
    ///
    /// Embedded are canvas, palette, brush, paints, light and loads.
    Embed(EmbedOptions),
    /// Recover what can be read of a damaged take or recording, such as a crash leaves
    Recover {
        /// Damaged take or recording, which is not changed
        take: PathBuf,
        /// File to write
        #[arg(short, long, value_name = "TAKE")]
        output: PathBuf,
    },
}

/// Options of `maulstick take embed`.
#[derive(Args, Clone, Debug)]
pub struct EmbedOptions {
    /// Take, which is not changed
    take: PathBuf,
    /// Take to write
    #[arg(short, long, value_name = "TAKE")]
    output: PathBuf,
    /// Settings of the rig
    #[arg(long, value_name = "FILE")]
    rig: Option<PathBuf>,
    #[command(flatten)]
    kit: KitOptions,
}

/// Embeds the setup of a take.
fn embed(options: &EmbedOptions) -> Result<i32, UserError> {
    let mut config = match &options.rig {
        Some(path) => RigConfig::read(path)?,
        None => picture_settings(),
    };
    let take = Take::read(&options.take)?;
    let folder = tempfile::tempdir().map_err(|error| UserError::failure(error.to_string()))?;
    let embedded = use_kit(&take, &options.take, folder.path(), &mut config)?;
    let brush = options.kit.apply(&mut config)?;
    let mut inputs = named_by(&config);
    inputs.push(UsedFile::new("the take that stays as it is", &options.take));
    inputs.extend(UsedFile::given("the settings", options.rig.as_ref()));
    check_outputs(
        &[UsedFile::new("the take", &options.output).of(Kind::Take)],
        &inputs,
    )?;
    let library = library_from(config.paint.paints.as_deref())?;
    let loads = options.kit.mixtures(&embedded, &library)?;
    painting_setup(&config, &library)?
        .check(&library)
        .map_err(refused)?;
    let take = Take {
        setup: Some(take_setup(&config, &brush, &loads)?),
        ..take
    };
    write_take(&take, &options.output)?;
    Ok(0)
}

/// Setup embedded in a take, in words; empty if there is none.
fn kit_in_words(kit: &TakeSetup) -> String {
    let bytes: usize = kit.files.values().map(Vec::len).sum();
    let loads = if kit.loads.is_empty() {
        "no load".to_owned()
    } else {
        kit.loads.join("; ")
    };
    format!(
        "canvas, brush, paints and light ({:.1} kB); {loads}",
        bytes as f64 * 1e-3
    )
}

/// Shows the contents of a complete session.
fn session_info(mut session: SessionFile, as_json: bool) -> Result<i32, UserError> {
    let folder = tempfile::tempdir().map_err(|error| UserError::failure(error.to_string()))?;
    let begin = folder.path().join(PAINTING);
    session.write_painting(&begin)?;
    let (document, mut sequencer, _) = open_begin(&begin)?;
    let (mut counts, mut devices) = (from::Counts::default(), BTreeMap::<String, u64>::new());
    let recorded = RecordedSession::after(&sequencer);
    session.follow(recorded, &mut sequencer, u64::MAX, &mut |_, _, event| {
        match event {
            Event::Accepted(record) => counts.note(&record),
            Event::Other { topic, .. } => {
                if let Some([device]) = parts(HANDS, topic).as_deref() {
                    *devices.entry((*device).to_owned()).or_default() += 1;
                }
            }
        }
        Ok(())
    })?;
    document.close().map_err(|error| wrong(&begin, &error))?;
    let seconds = session.length_ns() as f64 * 1e-9;
    if as_json {
        print_json(&json!({
            "kind": "session",
            "seconds": seconds,
            "painted": counts.in_json(),
            "samples": devices,
        }))?;
        return Ok(0);
    }
    say!("session  {seconds:.1} s: {}", counts.in_words());
    for (device, samples) in devices {
        say!("samples  {samples} of {device}");
    }
    Ok(0)
}

/// Runs the subcommand.
///
/// # Errors
/// A [`UserError`] where the take cannot be read or written.
pub fn run(command: &TakeCommand) -> Result<i32, UserError> {
    match command {
        TakeCommand::Render(options) => render::run(options),
        TakeCommand::Import(options) => import::run(options),
        TakeCommand::Embed(options) => embed(options),
        TakeCommand::From(options) => from::run(options),
        TakeCommand::Info { take, json } => {
            if let Some(session) = SessionFile::find(take)? {
                return session_info(session, *json);
            }
            let take = Take::read(take)?;
            let seconds = take.length_ns() as f64 * 1e-9;
            let rate = (take.samples.len() - 1) as f64 / seconds.max(1e-9);
            let pens = take
                .samples
                .iter()
                .any(|s| matches!(s.sample.pose, StylusPose::Contact { .. }));
            if *json {
                print_json(&json!({
                    "device": take.device,
                    "samples": take.samples.len(),
                    "seconds": seconds,
                    "rate_hz": rate,
                    "loads": take.setup.as_ref().map(|kit| &kit.loads),
                    "embeds": take.setup.as_ref().map(|kit| kit.files.keys().collect::<Vec<_>>()),
                    "kind": if pens { "pen" } else { "6-DOF" },
                }))?;
            } else {
                let kind = if pens { "a pen" } else { "a 6-DOF stylus" };
                say!("device   {} ({kind})", take.device);
                say!(
                    "samples  {} over {seconds:.3} s, {rate:.1} a second",
                    take.samples.len()
                );
                if let Some(kit) = &take.setup {
                    say!("embeds   {}", kit_in_words(kit));
                }
            }
            Ok(0)
        }
        TakeCommand::Recover { take, output } => recover(take, output),
    }
}

/// Recovers the readable part of a damaged file.
fn recover(from: &Path, output: &Path) -> Result<i32, UserError> {
    check_outputs(
        &[UsedFile::new("the recovered file", output).of(Kind::Take)],
        &[UsedFile::new("the damaged file", from)],
    )?;
    let recording = DamagedRecording::open(from);
    let is_recording = |recording: &DamagedRecording| {
        let others = recording.topics().any(|topic| !matches(HANDS, topic));
        others || recording.is_of_a_recorder()
    };
    if let Some(recording) = recording.ok().filter(is_recording) {
        let mut recovered = Err(McapError::UnexpectedEof);
        let written = write_whole(output, Kind::Take, |file| {
            recovered = recording.recover(file);
            match &recovered {
                Ok(_) => Ok(()),
                Err(McapError::Io(error)) => Err(Error::new(error.kind(), error.to_string())),
                Err(error) => Err(Error::other(error.to_string())),
            }
        });
        written.map_err(|error| UserError::writing(output, &error))?;
        let recovered = recovered.unwrap_or_default();
        say!(
            "{}: {} messages, {} files ({})",
            output.display(),
            recovered.messages,
            recovered.files,
            recovered.damage.as_deref().unwrap_or(WHOLE)
        );
        return Ok(0);
    }
    let salvage = salvage(from)?;
    salvage.take.write(output)?;
    say!(
        "{}: {} samples ({})",
        output.display(),
        salvage.take.samples.len(),
        salvage
            .damage
            .map_or(WHOLE.to_owned(), |damage| damage.to_string())
    );
    Ok(0)
}
