//! The process of the paint node.

use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use maulstick_document::{Document, DocumentError};
use maulstick_gpu::{Choice, Device, GpuFilms};
use maulstick_models::AUTO;
use maulstick_num::fork_join::with_cores_beyond;
use maulstick_optics::backend::{CpuFilms, FilmBackend};
use maulstick_paint_node::frames::FrameServer;
use maulstick_paint_node::worker::WorkerPanicked;
use maulstick_paint_node::{PaintNode, Worker};
use maulstick_painting::{Painting, Sequencer};
use maulstick_rig::config::RigConfig;
use maulstick_rig::{NodeHandle, UserError};
use maulstick_types::paint::Decision;
use nix::sys::signal::Signal;

use maulstick_painting_setup::backend::choose_backend;
use maulstick_painting_setup::destination::{VIEW, export};
use maulstick_painting_setup::document::{go_on_in_rig, wrong};
use maulstick_painting_setup::{library_from, painting_setup, refused};

use super::NodeOptions;

/// Greatest number of turns of a paint node after the request to stop, for which the launcher waits.
const LAST_TURNS: u32 = 8;

/// Options of the paint node.
#[derive(clap::Args, Debug)]
pub(crate) struct PaintOptions {
    #[command(flatten)]
    node: NodeOptions,
}

pub(super) fn run(options: &PaintOptions) -> Result<i32, UserError> {
    let mut member = options.node.join("paint", Signal::SIGKILL)?;
    let (document, mut sequencer, since) = painting(&member.config)?;
    choose_backend(&mut sequencer, &member.config.paint.backend)?;
    let origin = member.origin("paint");
    let bus = Arc::clone(&member.bus);
    let (topics, wake) = (&member.topics, &member.wake);
    let mut node = PaintNode::resume(Arc::clone(&bus), topics, wake, origin, sequencer)?
        .exporting(export(&member.config.view, VIEW)?);
    let (topic, feed) = (member.topics.frame(), node.feed());
    let mut frames =
        FrameServer::new(bus, &topic, feed.clone(), &member.wake, origin)?.telling_brushes(topics);
    let room = member.config.paint.room();
    let room = room.map_err(|error| UserError::usage(error.to_string()))?;
    node = node.with_memory(usize::try_from(room.memory).unwrap_or(usize::MAX));
    if let Some(document) = document {
        frames = frames.with_tile_cache(document.tile_cache());
        node = node.keeping(document, since);
    }
    if member.config.paint.model == AUTO {
        node = node.proposing_models();
    }
    let stop = member.stop.clone();
    let backend = member.config.paint.backend.clone();
    let run = move || frames.with_films(film_backend(&backend)).run(&stop);
    let mut thread =
        Worker::start("frames", run).map_err(|error| UserError::failure(error.to_string()))?;
    let fallen = |error: WorkerPanicked| UserError::failure(error.to_string());
    let work = member.work.clone();
    let mut turn = |node: &mut PaintNode| {
        thread.check().map_err(fallen)?;
        let wait = node.poll()?;
        work.set(node.work());
        match (node.fault(), node.document_path()) {
            (Some(what), Some(path)) => Err(wrong(path, &DocumentError::Damaged(what.to_owned()))),
            _ => Ok(wait),
        }
    };
    // Its token promises that commands to the rig's brushes and takes work, so it must know their files.
    let run = || {
        wait_for_brushes(&member, &mut node, &mut turn)
            .and_then(|()| member.ready())
            .and_then(|()| member.run(|| turn(&mut node)))
            .and_then(|()| paint_what_has_come(&mut node, &mut turn))
    };
    // The brush uses one core already; the window and the frames run between steps.
    let result = with_cores_beyond(1, run);
    member.stop.request();
    feed.ring();
    let ended = thread.join().map_err(fallen);
    let path = node.document_path().map(Path::to_owned);
    let closed = node.close().map_err(|error| match &path {
        Some(path) => wrong(path, &error),
        None => UserError::failure(error.to_string()),
    });
    member.leave();
    result.and(ended).and(closed).map(|()| 0)
}

/// Runs the node until it has painted all messages received before the request to stop.
fn paint_what_has_come(
    node: &mut PaintNode,
    turn: &mut impl FnMut(&mut PaintNode) -> Result<Duration, UserError>,
) -> Result<(), UserError> {
    let mut left = LAST_TURNS;
    while left > 0 && turn(node)?.is_zero() {
        left -= 1;
    }
    Ok(())
}

/// The painting that the settings ask for: in its document, or in memory.
fn painting(config: &RigConfig) -> Result<(Option<Document>, Sequencer, u64), UserError> {
    if let Some(path) = &config.paint.document {
        let (document, sequencer, since) = go_on_in_rig(config, path)?;
        return Ok((Some(document), sequencer, since));
    }
    let library = library_from(config.paint.paints.as_deref())?;
    let setup = painting_setup(config, &library)?;
    let mut sequencer = Sequencer::new(Painting::new(&setup, library).map_err(refused)?);
    sequencer.decide(Decision::Backend { name: "cpu".into() });
    Ok((None, sequencer, 0))
}

/// Backend of the colours of frames, as rig.toml says: `auto` takes a real GPU, `gpu` any.
fn film_backend(name: &str) -> Box<dyn FilmBackend> {
    let choice = match name {
        "cpu" => return Box::new(CpuFilms::new()),
        "gpu" => Choice::Forced,
        _ => Choice::Auto,
    };
    match Device::open(choice).and_then(GpuFilms::new) {
        Ok(gpu) => {
            tracing::info!("colour is computed by {}", gpu.name());
            Box::new(gpu)
        }
        Err(error) => {
            if matches!(choice, Choice::Forced) {
                tracing::warn!("{error}; colour is computed by the processor");
            }
            Box::new(CpuFilms::new())
        }
    }
}

/// Runs the node until it knows every brush of rig.toml, or is asked to stop.
fn wait_for_brushes(
    member: &NodeHandle,
    node: &mut PaintNode,
    turn: &mut impl FnMut(&mut PaintNode) -> Result<Duration, UserError>,
) -> Result<(), UserError> {
    let brushes = &member.config.brush;
    while !brushes.iter().all(|brush| node.knows_brush(&brush.name)) && !member.stop.requested() {
        let wait = turn(node)?;
        member.wake.wait(wait);
    }
    Ok(())
}
