//! Question before a painting that is only in memory is closed.

use eframe::egui::Ui;

use crate::dialogs::dialog::fault::DialogFault;
use crate::rig::state::RigState;

/// State of the painting that would be closed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct UnsavedState {
    /// True if the painting is only in memory and has paint on it.
    would_go: bool,
    let_go: bool,
}

impl UnsavedState {
    /// The painting on the easel.
    #[must_use]
    pub(crate) fn of(rig: &RigState) -> Self {
        let status = rig.live.paint.as_ref().map(|paint| &paint.status);
        Self {
            would_go: status.is_some_and(|status| status.path.is_empty() && !status.blank),
            let_go: false,
        }
    }

    /// True if the painter agrees to discard it.
    #[must_use]
    pub(crate) fn let_go(self) -> bool {
        self.would_go && self.let_go
    }

    /// Asks, if necessary.
    pub(crate) fn show(&mut self, ui: &mut Ui) {
        if self.would_go {
            ui.add_space(6.0);
            ui.checkbox(
                &mut self.let_go,
                tr!("Let go of the painting on the easel: it is in no file"),
            );
        }
    }

    /// Checks that another painting may replace it.
    ///
    /// # Errors
    /// [`DialogFault::Unsaved`].
    pub(crate) fn check(self) -> Result<(), DialogFault> {
        if self.would_go && !self.let_go {
            Err(DialogFault::Unsaved)
        } else {
            Ok(())
        }
    }
}
