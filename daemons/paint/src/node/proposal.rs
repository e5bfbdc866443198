//! Proposal of a lighter paint model where painting falls behind: made once, never carried out.

use maulstick_models::{AutoRole, auto_model};
use maulstick_painting::Sequencer;
use maulstick_types::paint::Decision;
use maulstick_types::scene::CANVAS;

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

    /// Makes the proposal in the journal and the log where it is due; true if it did.
    pub(super) fn poll(&mut self, sequencer: &mut Sequencer) -> bool {
        let [own, lighter] = [AutoRole::First, AutoRole::Lighter].map(|role| auto_model(role).name);
        let painting = sequencer.painting();
        if painting.model(CANVAS) != Some(own) || !self.note(painting.longer()) {
            return false;
        }
        tracing::info!(
            "painting with {own} falls behind on this machine; `maulstick canvas convert {lighter}` converts this painting \
             to a lighter model, which can be undone"
        );
        let model = lighter.to_owned();
        sequencer.decide(Decision::LighterModel { model });
        true
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
