//! `maulstick render` of a session: accepts its records again.

use std::time::Instant;

use maulstick_paint_node::snapshots::write_snapshot;
use maulstick_recorder::paintings::open_begin;
use maulstick_recorder::session_file::{Event, PAINTING, SessionFile};
use maulstick_rig::{RigConfig, UserError};
use maulstick_session::{Autosave, RecordedSession};

use maulstick_painting_setup::backend::choose_backend;
use maulstick_painting_setup::destination::export;
use maulstick_painting_setup::document::{Presence, presence, wrong};
use maulstick_painting_setup::{KitOptions, refused};

use super::from::Counts;
use super::render_options::RenderOptions;
use crate::commands::{progress_bar, say};

/// Paints a session.
///
/// # Errors
/// A [`UserError`] for an incomplete session, for options that do not apply, or where a file cannot be
/// written.
pub(super) fn render_session(
    options: &RenderOptions,
    mut session: SessionFile,
    config: &RigConfig,
) -> Result<i32, UserError> {
    let painting = &options.painting;
    let sizes = [&painting.memory, &painting.history, &painting.record];
    let is_sized = sizes.iter().any(|size| size.is_some());
    if painting.kit != KitOptions::default() || painting.model.is_some() || is_sized {
        return Err(UserError::usage("a session is painted with its own brushes and paints")
            .help("leave out canvas, brush, loads, paints, light, model and sizes: only --profile, --gamut, --backend, --document and --ledger apply"));
    }
    let export = export(&config.view, "--profile, --gamut")?;
    let folder = tempfile::tempdir().map_err(|error| UserError::failure(error.to_string()))?;
    let path = match &options.document {
        Some(path) if presence(path, painting)? == Presence::There => {
            return Err(UserError::usage("a session has its own painting")
                .at(path.display().to_string())
                .help("give the name of a new file"));
        }
        Some(path) => path.clone(),
        None => folder.path().join(PAINTING),
    };
    session.write_painting(&path)?;
    let (document, mut sequencer, since) = open_begin(&path)?;
    // New decisions would be additional entries of the journal.
    let recorded = RecordedSession::after(&sequencer).until(options.until.unwrap_or(u64::MAX));
    let backend = painting.backend.as_ref().unwrap_or(&config.paint.backend);
    choose_backend(&mut sequencer, backend)?;
    let mut autosave = Autosave::new(document, &mut sequencer, since);
    let bar = progress_bar(session.length_ns()).with_message("painting");
    sequencer.begin_repeating();
    let (begun, mut counts) = (Instant::now(), Counts::default());
    session.follow(
        recorded,
        &mut sequencer,
        u64::MAX,
        &mut |sequencer, at_ns, event| {
            if let Event::Accepted(record) = event {
                counts.note(&record);
                sequencer.repeat(record).map_err(refused)?;
                sequencer.drain_journal();
                autosave.turn(sequencer, begun.elapsed().as_nanos() as u64);
                bar.set_position(at_ns / 1_000_000);
            }
            Ok(())
        },
    )?;
    bar.finish_and_clear();
    sequencer.end_repeating();
    let ledger = painting.ledger.as_deref();
    write_snapshot(sequencer.painting_mut(), &options.output, ledger, &export)
        .map_err(|(path, error)| UserError::writing(&path, &error))?;
    autosave
        .close(&mut sequencer)
        .map_err(|error| wrong(&path, &error))?;
    say!("painted as it was recorded: {}", counts.in_words());
    Ok(0)
}
