//! Proposal of a lighter paint model where painting falls behind: told once, never carried out.

use maulstick_models::{AutoRole, auto_model};
use maulstick_types::paint::Decision;
use maulstick_types::scene::CANVAS;

use super::PaintNode;

/// Late strokes after which it is made: one may be late because a program begins beside it.
const LATE_STROKES: u32 = 3;

/// Late strokes so far.
#[derive(Debug, Default)]
pub(super) struct Proposal {
    strokes: u32,
    is_late: bool,
}

impl Proposal {
    /// Notes the length of the present strokes' steps by the brush's own, 1 where none is late; true once enough strokes
    /// were late.
    fn note(&mut self, longer: u32) -> bool {
        let is_late = longer > 1;
        if is_late && !self.is_late {
            self.strokes += 1;
        }
        self.is_late = is_late;
        self.strokes >= LATE_STROKES
    }
}

impl PaintNode {
    /// Proposes a lighter model for the canvas once painting falls behind: in the journal, which the window shows, and in
    /// the log.
    #[must_use]
    pub fn proposing_models(mut self) -> Self {
        self.proposal = Some(Proposal::default());
        self
    }

    /// Makes the proposal where it is due.
    pub(super) fn propose_model(&mut self) {
        let [own, lighter] = [AutoRole::First, AutoRole::Lighter].map(|role| auto_model(role).name);
        let painting = self.sequencer.painting();
        if self.session.is_some() || painting.model(CANVAS) != Some(own) {
            return;
        }
        let longer = painting.longer();
        if self.proposal.as_mut().is_some_and(|it| it.note(longer)) {
            self.proposal = None;
            tracing::info!(
                "painting with {own} falls behind on this machine; `maulstick canvas convert {lighter}` converts this painting \
                 to a lighter model, which can be undone"
            );
            let model = lighter.to_owned();
            self.sequencer.decide(Decision::LighterModel { model });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_made_once_three_strokes_were_late() {
        let mut proposal = Proposal::default();
        let strokes = [1, 2, 4, 4, 1, 1, 2, 2, 1, 4];
        let due: Vec<bool> = strokes.map(|longer| proposal.note(longer)).into();
        assert_eq!(due.iter().position(|due| *due), Some(9));
    }
}
