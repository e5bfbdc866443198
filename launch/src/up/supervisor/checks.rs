//! Checking and saving of paintings in the background, because both may wait for a disk, or for the paint node.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, mpsc};

use maulstick_bus::Wake;
use maulstick_document::DocumentError;
use maulstick_rig::command_client::CommandClient;
use maulstick_rig::config::{RigConfig, is_path};
use maulstick_rig::files::{Kind, check_writable};
use maulstick_rig::{Sketches, Stop, UserError};
use maulstick_types::Mixture;
use maulstick_types::command::{FileCommand, NewCanvas, SaveAs};
use tokio::task::spawn_blocking;

use maulstick_painting_setup::cells::check_memory;
use maulstick_painting_setup::document::{measure, read, round, wrong};
use maulstick_painting_setup::{library_from, painting_setup, refused};

use super::sketch;
use super::switch::{Asker, Plan, SwitchEvent};
use crate::up::first_load;

/// A painting is in another file within this time.
const SAVE_TIME: std::time::Duration = std::time::Duration::from_secs(3600);

/// Work beside the supervisor: its outcomes.
pub(super) struct Checks {
    send: mpsc::Sender<(Asker, SwitchEvent)>,
    outcomes: mpsc::Receiver<(Asker, SwitchEvent)>,
    wake: Wake,
}

impl Checks {
    /// Background work that rings `wake` when it is done.
    pub(super) fn new(wake: &Wake) -> Self {
        let (send, outcomes) = mpsc::channel();
        Self {
            send,
            outcomes,
            wake: wake.clone(),
        }
    }

    /// A finished result with its client.
    pub(super) fn next(&self) -> Option<(Asker, SwitchEvent)> {
        self.outcomes.try_recv().ok()
    }

    /// Checks that a painting can be opened.
    pub(super) fn open(&self, asker: Asker, mut config: RigConfig, path: PathBuf) {
        self.beside(asker, move || {
            let checked = opened(&mut config, path);
            SwitchEvent::Checked(checked.map(|()| Box::new(Plan { config, load: None })))
        });
    }

    /// Checks that a painting can be begun: without a path in a sketch, where there are such.
    pub(super) fn begin(
        &self,
        asker: Asker,
        mut config: RigConfig,
        (path, canvas): (Option<PathBuf>, NewCanvas),
        sketches: Option<Sketches>,
    ) {
        self.beside(asker, move || {
            let path = path.or_else(|| sketches.as_ref().and_then(sketch::begin));
            let checked = begun(&mut config, path, &canvas);
            let plan = checked.map(|load| {
                let load = Some(load);
                Box::new(Plan { config, load })
            });
            SwitchEvent::Checked(plan)
        });
    }

    /// Makes the paint node move the painting to another file, until it has ended, or the rig does.
    pub(super) fn save(
        &self,
        asker: Asker,
        mut client: CommandClient,
        save_as: SaveAs,
        (has_gone, stop): (Arc<AtomicBool>, Stop),
    ) {
        self.beside(asker, move || {
            let stops = || stop.requested() || has_gone.load(Ordering::SeqCst);
            let saved = client.send(FileCommand::SaveAs(save_as), None, SAVE_TIME, &stops);
            SwitchEvent::Saved(saved.map(drop))
        });
    }

    fn beside(&self, asker: Asker, work: impl FnOnce() -> SwitchEvent + Send + 'static) {
        let (send, wake) = (self.send.clone(), self.wake.clone());
        let report = Report { asker, send, wake };
        spawn_blocking(move || report.send(work()));
    }
}

/// Channel of a result to the supervisor; dropping it in a panic reports that.
struct Report {
    asker: Asker,
    send: mpsc::Sender<(Asker, SwitchEvent)>,
    wake: Wake,
}

impl Report {
    fn send(self, outcome: SwitchEvent) {
        self.send.send((self.asker, outcome)).ok();
    }
}

impl Drop for Report {
    fn drop(&mut self) {
        if std::thread::panicking() {
            self.send.send((self.asker, SwitchEvent::Fallen)).ok();
        }
        self.wake.ring();
    }
}

/// Checks that a painting can be opened, and reads its canvas.
fn opened(config: &mut RigConfig, path: PathBuf) -> Result<(), UserError> {
    if !path.exists() {
        return Err(wrong(&path, &DocumentError::Missing));
    }
    let (document, opened) = read(&path)?;
    measure(&mut config.canvas, &opened.snapshot().scene);
    drop(opened);
    document.close().map_err(|error| wrong(&path, &error))?;
    config.paint.document = Some(path);
    Ok(())
}

/// Checks that a painting can be created, and returns the load of its brushes.
fn begun(
    config: &mut RigConfig,
    path: Option<PathBuf>,
    canvas: &NewCanvas,
) -> Result<Mixture, UserError> {
    if is_path(&canvas.ground) && !Path::new(canvas.ground.as_str()).is_absolute() {
        return Err(
            UserError::usage("the path of the ground does not begin at the root")
                .help("give the whole path, because each program has its own working folder"),
        );
    }
    let section = &mut config.canvas;
    [section.width_mm, section.height_mm, section.cell_mm] =
        [canvas.width_m, canvas.height_m, canvas.cell_m].map(|m| round(m * 1e3));
    section.stain_um = round(canvas.stain_m * 1e6);
    section.tooth_seed = canvas.tooth_seed;
    section.ground = canvas.ground.to_string();
    section.tooth = canvas.tooth.to_string();
    match &path {
        Some(path) if path.exists() => return Err(wrong(path, &DocumentError::Taken)),
        Some(path) => {
            check_writable(path, Kind::Own).map_err(|error| UserError::writing(path, &error))?;
        }
        None => check_memory(&config.canvas)?,
    }
    config.paint.document = path;
    let library = library_from(config.paint.paints.as_deref())?;
    painting_setup(config, &library)?
        .check(&library)
        .map_err(refused)?;
    Ok(first_load(&library))
}
