//! Paint that dries over time.
//!
//! Time is the journal's ticks of 1/60 s. A drying goes over its tiles in rounds, of which there are 32 at most, half a
//! second or more apart: in a round each tile's film dries by the share of the remaining time that has elapsed since
//! the round before, so that paint applied meanwhile dries in the rest. A tick dries 32 tiles at most, and none while a
//! brush paints: time goes on, and due tiles are dried when the brush is lifted.

use maulstick_types::paint::StepName;

use super::bench::Workbench;
use crate::clock::{Drying, Round};

/// Most tiles that dry in a tick.
const TILES_A_TICK: usize = 32;

impl Drying {
    /// Dries the next tiles of a round; true once the drying is done, or its part is there no more.
    pub(crate) fn go_on(&mut self, mut round: Round, bench: &mut Workbench) -> bool {
        // It was found when the drying began, and surfaces stay as large as they are.
        let surfaces = &bench.desk.surfaces;
        let Ok((on, part)) = surfaces.part(self.surface, self.region.as_ref()) else {
            return true;
        };
        bench.close_windows();
        let mut layers = bench.desk.scene.layers.iter();
        let is_known = |number: &u32| layers.any(|layer| layer.number == *number);
        let layer = self.layer.filter(is_known);
        let number = layer.unwrap_or_else(|| bench.desk.next_layer());
        let film = (number, self.share(round));
        let surface = &bench.desk.surfaces[on];
        let (dried, next) = surface.some_dried(&part, film, TILES_A_TICK, round.next);
        if !dried.is_empty() {
            if bench.past.history.open_of(None).is_none() {
                bench.begin_step(StepName::Drying, None);
            }
            bench.put_changed(on, dried);
            if layer.is_none() {
                bench.desk.add_layer(number, &self.name);
            }
            self.layer = Some(number);
        }
        self.reached = round.to;
        self.round = next.map(|next| {
            round.next = next;
            round
        });
        next.is_none() && round.to >= self.ticks
    }
}
