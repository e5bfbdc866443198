//! Time, and the commands about drying.

use maulstick_canvas::EditError;
use maulstick_types::command::Command;
use maulstick_types::paint::Entry;

use super::{Accepted, Sequencer};

impl Sequencer {
    /// A sixtieth of a second goes by: entered where something dries by itself, else nothing happens.
    pub fn tick(&mut self) {
        if !self.painting.is_drying() {
            return;
        }
        self.painting.tick();
        let count = self.painting.clock().ticks;
        let entry = Entry::Tick { count };
        let index = self.enter(entry.clone());
        self.note(index, || Accepted::Entry(entry));
    }

    /// Does a command about layers; any other asks nothing of the painting.
    pub(super) fn layers(&mut self, command: &Command) -> Result<String, EditError> {
        let quietly = |done: Result<(), EditError>| done.map(|()| String::new());
        let painting = &mut self.painting;
        match command {
            Command::Dry {
                surface,
                share,
                name,
            } => painting.dry(*surface, *share, name),
            Command::DryRegion {
                surface,
                share,
                name,
                region,
            } => painting.dry_part(*surface, *share, name, Some(region)),
            Command::DryOver {
                surface,
                ticks,
                name,
                region,
            } => painting.dry_over(*surface, *ticks, name, region.as_ref()),
            Command::StopDrying { surface } => quietly(painting.stop_drying(*surface)),
            Command::Wet {
                surface,
                layers,
                region,
            } => painting.wet(*surface, *layers, region.as_ref()),
            Command::Opacity { layer, opacity } => quietly(painting.set_opacity(*layer, *opacity)),
            Command::LayerOpacity { layer, opacity } => {
                quietly(painting.set_opacity_of(layer, *opacity))
            }
            Command::NameLayer { layer, name } => quietly(painting.name_layer(*layer, name)),
            _ => Ok(String::new()),
        }
    }
}
