//! Motions: a folder of takes, chosen by their pictures and put on the canvas where one points.
//!
//! | module | holds |
//! | --- | --- |
//! | [`library`] | the takes of a folder, read one after the other beside the window |
//! | [`drawn_paths`] | strokes of a take as lines |
//! | [`choose_motion`] | the dialog |
//! | [`placing`] | the one that follows the pointer until it is put down |

mod choose_motion;
mod drawn_paths;
mod library;
mod placing;
#[cfg(test)]
mod tests;

use eframe::egui::{Context, Painter};
use maulstick_types::scene::Surface;

use choose_motion::ChooseMotion;
use placing::Placing;

use crate::input::keys::Action;
use crate::view::camera::View;
use crate::widgets::context::PanelContext;

/// Motions in the window.
#[derive(Debug, Default)]
pub(crate) struct Motions {
    dialog: Option<ChooseMotion>,
    placing: Option<Placing>,
}

impl Motions {
    pub(crate) fn open(&mut self, work: &mut PanelContext<'_>) {
        if work.rig.replay.is_some() {
            work.notifications.fault(
                tr!("A recording is being played."),
                tr!("End that first: its bar has a button."),
            );
            return;
        }
        self.placing = None;
        self.dialog = Some(ChooseMotion::new(work.preferences));
    }

    /// True while the dialog has the keyboard.
    #[must_use]
    pub(crate) fn is_open(&self) -> bool {
        self.dialog.is_some()
    }

    /// True while a motion follows the pointer, which is no brush then.
    #[must_use]
    pub(crate) fn is_placing(&self) -> bool {
        self.placing.is_some()
    }

    /// Has a key change the motion that follows the pointer; false where it is not about that.
    pub(crate) fn follow(&mut self, act: Action) -> bool {
        self.placing
            .as_mut()
            .is_some_and(|placing| placing.follow(act))
    }

    /// Shows the dialog, if it is open.
    pub(crate) fn show(&mut self, context: &Context, work: &mut PanelContext<'_>) {
        let Some(dialog) = &mut self.dialog else {
            return;
        };
        let answer = dialog.show(context, work);
        if answer.closes {
            self.dialog = None;
        }
        if let Some(motion) = answer.chosen {
            work.notifications.note(
                tr!(
                    "Click where it is to be painted; the wheel scales it, with Shift it turns it, Escape lets it go."
                )
                .to_owned(),
            );
            self.placing = Some(Placing::new(motion));
        }
    }

    /// Has the motion follow the pointer over the desk, and draws it there; where the pointer clicks it is put down.
    pub(crate) fn place(
        &mut self,
        context: &Context,
        painter: &Painter,
        (view, surfaces): (&View, &[Surface]),
        work: &mut PanelContext<'_>,
    ) {
        // A click in the dialog that has just closed puts nothing down.
        let is_free = self.dialog.is_none();
        let Some(placing) = self.placing.as_mut().filter(|_| is_free) else {
            return;
        };
        if placing.poll(context, painter, (view, surfaces), work.requests) {
            self.placing = None;
        }
    }
}
