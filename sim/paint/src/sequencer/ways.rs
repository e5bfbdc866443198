//! The commands about how brushes are used and surfaces are prepared.

use maulstick_types::command::Command;

use super::Sequencer;
use crate::painting::PaintRefusal;

impl Sequencer {
    /// Does a command about ways of painting; any other asks nothing of the painting.
    pub(super) fn ways(&mut self, command: &Command) -> Result<String, PaintRefusal> {
        let painting = &mut self.painting;
        let done = match command {
            Command::Handle { handling } => painting.handle(handling),
            Command::FillWith {
                surface,
                brush,
                thickness_m,
            } => painting.fill_with(*surface, brush, *thickness_m),
            Command::Size { surface, stain_m } => painting.size(*surface, *stain_m),
            Command::Piles { surface, last } => painting.piles(*surface, *last),
            _ => Ok(()),
        };
        done.map(|()| String::new())
    }
}
