//! `maulstick take`: contents of a take, its setup, and the intact part of a damaged one.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use clap::{Args, Subcommand};
use maulstick_device::salvage::salvage;
use maulstick_device::{Take, TakeSetup};
use maulstick_rig::files::Kind;
use maulstick_rig::{RigConfig, UserError};
use maulstick_types::stylus::StylusPose;
use serde_json::json;

use super::from::{self, FromOptions};
use super::session_file::{Event, PAINTING, SessionFile, is_recording};
use crate::cells::picture_settings;
use crate::commands::{print_json, say, write_take};
use crate::document::wrong;
use crate::kit::{kit_of, use_kit};
use crate::outputs::{UsedFile, check_outputs, named_by};
use crate::performance::{KitOptions, library_from, painting_setup, refused};

/// Subcommands of `maulstick take`.
#[derive(Subcommand, Clone, Debug)]
pub enum TakeCommand {
    /// Show what a take holds
    Info {
        /// Take
        take: PathBuf,
        /// Print JSON
        #[arg(long)]
        json: bool,
    },
    /// Make a take of a recorded session: its strokes and commands, and the painting as it was before
    From(FromOptions),
    /// Embed in a take what it is painted with: canvas, palette, brush, paints, light, loads. It then
    /// gives the same painting anywhere
    Embed(EmbedOptions),
    /// Recover the readable samples of a damaged take
    Recover {
        /// Damaged take, which is not changed
        take: PathBuf,
        /// Take to write
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

/// Embeds what a take is painted with.
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
        setup: Some(kit_of(&config, &brush, &loads)?),
        ..take
    };
    write_take(&take, &options.output)?;
    Ok(0)
}

/// Setup embedded in a take, in words; empty if there is none.
fn kit_in_words(kit: &TakeSetup) -> String {
    let bytes: usize = kit.files.values().map(Vec::len).sum();
    let loads = match kit.loads.is_empty() {
        true => "no load".to_owned(),
        false => kit.loads.join("; "),
    };
    format!(
        "canvas, brush, paints and light ({:.1} kB); {loads}",
        bytes as f64 * 1e-3
    )
}

/// Shows what a session holds, once all of it was found.
fn session_info(path: &Path, as_json: bool) -> Result<i32, UserError> {
    let Some(mut session) = SessionFile::open(path)? else {
        return Ok(0);
    };
    let folder = tempfile::tempdir().map_err(|error| UserError::failure(error.to_string()))?;
    let begin = folder.path().join(PAINTING);
    session.write_painting(&begin)?;
    let (document, mut sequencer, _) = from::open_begin(&begin)?;
    let (mut counts, mut devices) = (from::Counts::default(), BTreeMap::<String, u64>::new());
    session.follow(&mut sequencer, u64::MAX, &mut |_, _, event| {
        match event {
            Event::Accepted(record) => counts.note(&record),
            Event::Other { topic, .. } => {
                let device = topic.strip_prefix("stylus/");
                if let Some(device) = device.and_then(|rest| rest.strip_suffix("/sample")) {
                    *devices.entry(device.to_owned()).or_default() += 1;
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
        TakeCommand::Embed(options) => embed(options),
        TakeCommand::From(options) => from::run(options),
        TakeCommand::Info { take, json } if is_recording(take) => session_info(take, *json),
        TakeCommand::Info { take, json } => {
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
        TakeCommand::Recover { take, output } => {
            check_outputs(
                &[UsedFile::new("the recovered take", output).of(Kind::Take)],
                &[UsedFile::new("the damaged take", take)],
            )?;
            let salvage = salvage(take)?;
            salvage.take.write(output)?;
            let damage = salvage
                .damage
                .unwrap_or_else(|| "nothing was damaged".to_owned());
            say!(
                "{}: {} samples ({damage})",
                output.display(),
                salvage.take.samples.len()
            );
            Ok(0)
        }
    }
}
