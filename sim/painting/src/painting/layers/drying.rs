//! Paint that dries over time.
//!
//! Time is the journal's ticks of 1/60 s. A drying visits its tiles in at most 32 rounds, half a second or more apart:
//! in a round each tile's film dries by the share of the remaining time that has elapsed since the round before, so
//! that paint applied meanwhile dries in the rest. A tick dries at most 32 tiles, and none while a brush paints: time
//! continues, and due tiles are dried when the brush is lifted.

use std::sync::Arc;

use crate::edits::Dry;
use maulstick_canvas::EditError;
use maulstick_types::paint::StepName;
use maulstick_types::values::Ticks;

use super::next_layer;
use crate::clock::{Clock, Drying, Round, TICKS_A_SECOND};
use crate::edits::Applied;
use crate::painting::Painting;
use crate::painting::surfaces::{Changed, Part, SurfaceState};

/// Most tiles that dry in a tick.
const TILES_A_TICK: usize = 32;

impl Painting {
    /// Begins to dry the wet paint of a part evenly into one new layer over a time.
    ///
    /// # Errors [`EditError`] for an unknown surface, a part beside it, nothing wet, and a drying in progress.
    pub(crate) fn dry_over(&mut self, edit: &Dry, over: Ticks) -> Result<Applied, EditError> {
        let (surface, region) = (edit.surface, edit.region.as_ref());
        let (on, part) = self.surfaces.part(surface, region)?;
        if self.clock.dryings.iter().any(|it| it.surface == surface) {
            return Err(EditError::Drying);
        }
        self.commit();
        if !self.surfaces[on].is_wet(&part) {
            return Err(EditError::NothingWet(edit.region.clone()));
        }
        let ticks = over.get();
        self.clock.dryings.push(Drying {
            surface,
            region: region.cloned(),
            name: edit.layer.clone().map_or(String::new(), Into::into),
            layer: None,
            ticks,
            elapsed: 0,
            reached: 0,
            round: None,
        });
        Ok(Applied::Drying(
            f64::from(ticks) / f64::from(TICKS_A_SECOND),
        ))
    }

    /// True while time is to advance: something dries.
    #[must_use]
    pub fn is_drying(&self) -> bool {
        !self.clock.dryings.is_empty()
    }

    /// Dryings in progress, and the number of ticks.
    #[must_use]
    pub fn clock(&self) -> &Clock {
        &self.clock
    }

    /// Updates the contact of a brush, which decides whether paint may dry.
    pub(crate) fn note_contact(&mut self, brush: &str) {
        if self
            .brushes
            .find(brush)
            .is_some_and(|own| own.path.is_some())
        {
            self.clock.quiet = 0;
        }
    }

    /// A sixtieth of a second goes by.
    pub fn tick(&mut self) {
        for (surface, round) in self.clock.tick(self.brushes.in_contact()) {
            self.resume_drying(surface, round);
        }
    }

    /// Dries the next tiles of a round.
    fn resume_drying(&mut self, surface: u32, mut round: Round) {
        let mut dryings = self.clock.dryings.iter();
        let Some(place) = dryings.position(|it| it.surface == surface) else {
            return;
        };
        let drying = self.clock.dryings[place].clone();
        // The part was found when the drying began, and surfaces keep their size.
        let Ok((on, part)) = self.surfaces.part(surface, drying.region.as_ref()) else {
            self.clock.dryings.remove(place);
            return;
        };
        self.close_windows();
        let mut layers = self.scene.layers.iter();
        let layer = drying
            .layer
            .filter(|number| layers.any(|layer| layer.number == *number));
        let number = layer.unwrap_or_else(|| next_layer(&self.scene));
        let share = drying.share(round);
        let (dried, next) = self.surfaces[on].some_dried(&part, number, share, round.next);
        if !dried.is_empty() {
            if self.history.open_of(None).is_none() {
                self.begin_step(StepName::Drying, None);
            }
            self.put_changed(on, dried);
            if layer.is_none() {
                self.add_layer(number, &drying.name);
            }
            self.clock.dryings[place].layer = Some(number);
        }
        let drying = &mut self.clock.dryings[place];
        drying.reached = round.to;
        drying.round = next.map(|next| {
            round.next = next;
            round
        });
        if next.is_none() && round.to >= drying.ticks {
            self.clock.dryings.remove(place);
            if !self.is_drying() {
                self.end_own_step();
            }
        }
    }
}

impl SurfaceState {
    /// The tiles of one tick, from the one with number `first` on, and the next number.
    fn some_dried(
        &self,
        part: &Part,
        number: u32,
        share: f32,
        first: u32,
    ) -> (Changed, Option<u32>) {
        let mut dried = Vec::new();
        let mut seen = 0;
        for (id, tile) in self.wet_tiles_from(first) {
            let Some(stays) = self.staying(part, id) else {
                continue;
            };
            if seen == TILES_A_TICK {
                return (dried, Some(id.y * self.store.grid()[0] + id.x));
            }
            seen += 1;
            if let Some(tile) = self.dried_tile(tile, (number, share), &stays) {
                dried.push((id, Arc::new(tile)));
            }
        }
        (dried, None)
    }
}
