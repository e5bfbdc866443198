//! A tracing picture: thrown on the canvas as a projector would, to be painted after. It is of the window alone: no
//! export has it, and no brush picks it up.
//!
//! | module | holds |
//! | --- | --- |
//! | `settings` | the picture of each painting, remembered |
//! | `projection` | the pass that multiplies the canvas by it |

pub(crate) mod projection;
pub mod settings;

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::task::Poll;

use eframe::egui::Context;
use maulstick_exchange::ImportError;
use maulstick_ui_kit::background_task::BackgroundTask;

use projection::Slide;
use settings::Tracing;

use crate::reference::picture::{Picture, unread};
use crate::widgets::context::PanelContext;

/// A tracing picture while it loads.
#[derive(Debug, Default)]
enum Slot {
    #[default]
    Empty,
    /// It is being read.
    Coming(PathBuf, BackgroundTask<Result<Slide, ImportError>>),
    /// It is here.
    Here(PathBuf, Arc<Slide>),
    /// It cannot be shown.
    Failed(PathBuf),
}

impl Slot {
    fn path(&self) -> Option<&Path> {
        match self {
            Self::Empty => None,
            Self::Coming(path, _) | Self::Here(path, _) | Self::Failed(path) => Some(path),
        }
    }
}

/// The tracing picture of the painting that is open.
#[derive(Debug, Default)]
pub(crate) struct TracingPicture {
    slot: Slot,
}

impl TracingPicture {
    /// Reads the picture of the painting that is open, while it is to be seen; the picture and its strength, once it is
    /// here.
    pub(crate) fn follow(
        &mut self,
        context: &Context,
        work: &mut PanelContext<'_>,
    ) -> Option<(Arc<Slide>, f32)> {
        let Some(tracing) = work.tracing() else {
            self.slot = Slot::Empty;
            return None;
        };
        let (path, strength) = (tracing.path.clone(), tracing.sound_strength());
        if !tracing.shown {
            if matches!(self.slot, Slot::Failed(_)) {
                // It may be mended until it is shown again.
                self.slot = Slot::Empty;
            }
            return None;
        }
        if self.slot.path() != Some(&path) {
            let file = path.clone();
            let read = move || Picture::read(&file).map(|picture| Slide::of(&picture));
            let task = BackgroundTask::start(context, "tracing", read);
            self.slot = Slot::Coming(path.clone(), task);
        }
        if let Slot::Coming(_, task) = &self.slot
            && let Poll::Ready(found) = task.poll()
        {
            self.slot = match found {
                Some(Ok(slide)) => Slot::Here(path, Arc::new(slide)),
                Some(Err(error)) => failed(work, path, &unread(&error)),
                None => failed(work, path, tr!("It is damaged. Take another copy of it.")),
            };
        }
        match &self.slot {
            Slot::Here(_, slide) => Some((Arc::clone(slide), strength)),
            _ => None,
        }
    }
}

fn failed(work: &mut PanelContext<'_>, path: PathBuf, words: &str) -> Slot {
    let what = tr!(
        "The tracing picture {picture} is not shown",
        picture = path.display()
    );
    work.notifications.fault(what, words);
    Slot::Failed(path)
}

impl PanelContext<'_> {
    /// File of the painting that is open, by which its tracing picture is remembered; `None` while it is not known.
    fn painting(&self) -> Option<String> {
        let status = self.rig.live.paint.as_ref().map(|node| &node.status);
        status.map(|status| status.path.clone())
    }

    /// The tracing picture of the painting that is open.
    #[must_use]
    pub(crate) fn tracing(&self) -> Option<&Tracing> {
        self.preferences.tracings.0.get(&self.painting()?)
    }

    /// The same, to be changed.
    pub(crate) fn tracing_mut(&mut self) -> Option<&mut Tracing> {
        let painting = self.painting()?;
        self.preferences.tracings.0.get_mut(&painting)
    }

    /// Gives the painting that is open another tracing picture, of the strength of the one before.
    pub(crate) fn trace(&mut self, path: &Path) {
        if let Some(painting) = self.painting() {
            self.preferences.tracings.trace(painting, path);
        }
    }

    /// Takes the tracing picture away.
    pub(crate) fn untrace(&mut self) {
        if let Some(painting) = self.painting() {
            self.preferences.tracings.0.remove(&painting);
        }
    }

    /// The painting continues in another file, and so does its tracing picture.
    pub(crate) fn carry_tracing(&mut self, from: &str, to: &str) {
        let tracings = &mut self.preferences.tracings.0;
        if let Some(tracing) = tracings.remove(from) {
            tracings.insert(to.to_owned(), tracing);
        }
    }

    /// Another sketch begins: the picture of the one before is not its own.
    pub(crate) fn forget_sketch(&mut self) {
        self.preferences.tracings.0.remove("");
    }
}

#[cfg(test)]
mod tests;
