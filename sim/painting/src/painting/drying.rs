//! Paint that dries over time.
//!
//! Time is the journal's ticks of 1/60 s. A drying goes over its tiles in rounds, of which there are 32 at most, half a
//! second or more apart: in a round each tile's film dries by the share of the remaining time that has elapsed since
//! the round before, so that paint applied meanwhile dries in the rest. A tick dries 32 tiles at most, and none while a
//! brush paints: time goes on, and due tiles are dried when the brush is lifted.

use std::sync::Arc;

use maulstick_canvas::EditError;
use maulstick_types::edits::{Dry, StopDrying};
use maulstick_types::values::Ticks;

use super::Painting;
use super::layers::{Changed, Part};
use crate::apply::{Applied, Apply};
use crate::clock::{Clock, Drying, Round, TICKS_A_SECOND};

/// Most tiles that dry in a tick.
const TILES_A_TICK: usize = 32;
/// A brush counts as painting for so many ticks after it was last in contact, .2 s: contacts less than
/// 150 ms apart are one stroke.
const LIFTED_TICKS: u32 = 12;
/// Ticks for which a brush in contact counts as painting although no state arrives.
const STILL_TICKS: u32 = 120;
/// Name of its steps.
const STEP: &str = "drying";

impl Apply for StopDrying {
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        let count = painting.clock.dryings.len();
        painting.let_stay_wet(Some(self.surface));
        match painting.clock.dryings.len() < count {
            true => Ok(Applied::Done),
            false => Err(EditError::NotDrying),
        }
    }
}

impl Painting {
    /// Has the wet paint of a part dry evenly into one new layer over a time.
    ///
    /// # Errors
    /// [`EditError`] for an unknown surface, a part beside it, where nothing is wet, and where a
    /// drying goes on.
    pub(super) fn dry_over(&mut self, edit: &Dry, over: Ticks) -> Result<Applied, EditError> {
        let (surface, region) = (edit.surface, edit.region.as_ref());
        let part = self.part(surface, region)?;
        if self.clock.dryings.iter().any(|it| it.surface == surface) {
            return Err(EditError::Drying);
        }
        self.commit();
        if !self.is_wet(&part) {
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

    /// Ends the drying of a surface, if one goes on there, or of all surfaces: what is wet still stays wet.
    pub(super) fn let_stay_wet(&mut self, surface: Option<u32>) {
        let stays = |drying: &Drying| surface.is_some_and(|surface| drying.surface != surface);
        self.clock.dryings.retain(stays);
    }

    /// True while time is to advance: something dries.
    #[must_use]
    pub fn is_drying(&self) -> bool {
        !self.clock.dryings.is_empty()
    }

    /// The dryings that go on, and the ticks so far.
    #[must_use]
    pub fn clock(&self) -> &Clock {
        &self.clock
    }

    /// Notes that a brush did something: whether it is in contact says whether paint may dry.
    pub(crate) fn note_contact(&mut self, brush: &str) {
        let track = self.brushes.get(brush);
        if track.is_some_and(|track| track.path.is_some()) {
            self.clock.quiet = 0;
        }
    }

    /// True while a brush paints: then no tile dries under it, and no stroke is split.
    fn is_painted_on(&self) -> bool {
        let in_contact = self.brushes.values().any(|track| track.path.is_some());
        let patience = if in_contact {
            STILL_TICKS
        } else {
            LIFTED_TICKS
        };
        self.clock.quiet < patience
    }

    /// A sixtieth of a second goes by.
    pub fn tick(&mut self) {
        let clock = &mut self.clock;
        clock.ticks += 1;
        clock.quiet = clock.quiet.saturating_add(1);
        for drying in &mut clock.dryings {
            drying.elapsed = (drying.elapsed + 1).min(drying.ticks);
        }
        if self.is_painted_on() {
            return;
        }
        let due = self.clock.dryings.iter().filter_map(|drying| {
            let round = drying.due()?;
            Some((drying.surface, round))
        });
        for (surface, round) in due.collect::<Vec<_>>() {
            self.go_on_drying(surface, round);
        }
    }

    /// Dries the next tiles of a round.
    fn go_on_drying(&mut self, surface: u32, mut round: Round) {
        let found = self
            .clock
            .dryings
            .iter()
            .position(|it| it.surface == surface);
        let Some(place) = found else {
            return;
        };
        let drying = self.clock.dryings[place].clone();
        // It was found when the drying began, and surfaces stay as large as they are.
        let Ok(part) = self.part(surface, drying.region.as_ref()) else {
            self.clock.dryings.remove(place);
            return;
        };
        self.close_windows();
        let known = |number: &u32| {
            self.scene
                .layers
                .iter()
                .any(|layer| layer.number == *number)
        };
        let layer = drying.layer.filter(known);
        let number = layer.unwrap_or_else(|| self.next_layer());
        let (dried, next) = self.some_dried(&part, number, drying.share(round), round.next);
        if !dried.is_empty() {
            if self.history.open_of(None).is_none() {
                self.begin_step(STEP, None);
            }
            self.put_changed(surface, dried);
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

    /// So many tiles as dry in a tick, from the one with number `first` on, and which is next.
    fn some_dried(
        &self,
        part: &Part,
        number: u32,
        share: f32,
        first: u32,
    ) -> (Changed, Option<u32>) {
        let store = &self.sheets[part.sheet].store;
        let across = store.grid()[0];
        let mut dried = Vec::new();
        let mut seen = 0;
        for (id, version) in store.iter().skip(first as usize) {
            let Some(tile) = version
                .tile
                .as_ref()
                .filter(|tile| tile.wet_page().is_some())
            else {
                continue;
            };
            let Some(stays) = self.staying(part, id) else {
                continue;
            };
            if seen == TILES_A_TICK {
                return (dried, Some(id.y * across + id.x));
            }
            seen += 1;
            if let Some(tile) = tile.dried(number, share, &stays) {
                dried.push((id, Arc::new(tile)));
            }
        }
        (dried, None)
    }
}
