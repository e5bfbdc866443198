//! Dispatch of the commands about handling of brushes, placement and preparation of surfaces, and of those that are not
//! the painting's.

use maulstick_canvas::EditError;
use maulstick_types::command::Command;

use super::Sequencer;

impl Sequencer {
    /// Carries out a command about brush handling; any other has no effect on the painting.
    pub(super) fn ways(&mut self, command: &Command) -> Result<String, EditError> {
        let painting = &mut self.painting;
        let done = match command {
            Command::Place {
                surface,
                pose,
                zoom,
            } => painting.place(*surface, pose, *zoom),
            Command::Handle { handling } => painting.handle(handling),
            Command::FillWith {
                surface,
                brush,
                thickness_m,
            } => painting.fill_with(*surface, brush, *thickness_m),
            Command::Size { surface, stain_m } => painting.size(*surface, *stain_m),
            Command::Piles { surface, last } => painting.piles(*surface, *last),
            Command::GroundSpectrum { surface, spectrum } => {
                painting.set_ground_spectrum(*surface, spectrum)
            }
            Command::Wells { surface, wells } => painting.set_wells(*surface, wells),
            _ => Ok(()),
        };
        done.map(|()| String::new())
    }
}

/// The refusal of a command that changes no painting and is not the sequencer's.
pub(super) fn elsewhere(command: &Command) -> EditError {
    let (what, help) = match command {
        Command::Define { brush, .. } => (
            "a brush file is no matter of the painting",
            format!("send it to the node '{brush}'"),
        ),
        Command::Export { .. } | Command::StopExport => (
            "nothing is exported here",
            "send it to the paint node of a running rig".to_owned(),
        ),
        _ => (
            "in which file a painting is, is no matter of the painting",
            "send it to the launcher of a running rig, 'rig'".to_owned(),
        ),
    };
    EditError::new(what.to_owned(), &help)
}
