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
use maulstick_ui_kit::background_task::BackgroundTask;

use crate::reference::picture::Picture;
use crate::widgets::context::PanelContext;
use projection::Slide;

/// A tracing picture while it loads.
#[derive(Debug, Default)]
enum Slot {
    /// No picture.
    #[default]
    Empty,
    /// It is being read.
    Coming(PathBuf, BackgroundTask<Result<Slide, String>>),
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
                Some(Err(words)) => failed(work, path, &words),
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

#[cfg(test)]
mod tests;
