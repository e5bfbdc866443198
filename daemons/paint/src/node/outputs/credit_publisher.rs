//! Credit of the brushes: painted states, the paint under them, and the files that the painting has.

use std::collections::{BTreeMap, BTreeSet};

use maulstick_bus::typed::Sender;
use maulstick_bus::{Bus, BusError, Qos};
use maulstick_painting::{Painting, Sequencer};
use maulstick_types::Origin;
use maulstick_types::brush::BRUSHES_MOST;
use maulstick_types::paint::{BrushCredit, PaintConsumed};
use maulstick_types::wire::topics::Topics;

/// Publisher of credit.
pub(crate) struct CreditPublisher {
    credit: Sender<PaintConsumed>,
    /// Credit of the last message.
    sent: BTreeMap<Origin, u64>,
    is_due: bool,
    /// Sources of the brushes that sent anything since the node began: a painting may know many more.
    active: BTreeSet<u32>,
    /// FNV-1a of the files with which the next states are painted, by the brushes' sources.
    files: BTreeMap<u32, u32>,
}

impl CreditPublisher {
    /// A publisher that has sent nothing.
    ///
    /// # Errors
    /// [`BusError`].
    pub(crate) fn new(bus: &dyn Bus, topics: &Topics, me: Origin) -> Result<Self, BusError> {
        Ok(Self {
            credit: Sender::new(bus, &topics.paint_consumed(), Qos::Control, me)?,
            sent: BTreeMap::new(),
            is_due: false,
            active: BTreeSet::new(),
            files: BTreeMap::new(),
        })
    }

    /// Notes a brush that sends states.
    pub(crate) fn note(&mut self, source: u32) {
        self.active.insert(source);
    }

    /// Confirms a brush's file, by its FNV-1a.
    pub(crate) fn confirm(&mut self, source: u32, file: u32) {
        self.active.insert(source);
        self.files.insert(source, file);
        self.is_due = true;
    }

    /// Has the next call publish, whether or not anything changed.
    pub(crate) fn send_again(&mut self) {
        self.is_due = true;
    }

    /// Publishes the credit of the active brushes where it changed.
    pub(crate) fn publish(&mut self, sequencer: &Sequencer, now_ns: u64) -> Result<(), BusError> {
        let mut consumed = sequencer.consumed_all();
        consumed.retain(|(brush, _)| self.active.contains(&brush.source));
        let is_new = |(brush, next): &(Origin, u64)| self.sent.get(brush) != Some(next);
        if !std::mem::take(&mut self.is_due) && !consumed.iter().any(is_new) {
            return Ok(());
        }
        self.sent = consumed.iter().copied().collect();
        // A brush may wait for its file to be confirmed before its first state.
        let has_begun = |source: u32| consumed.iter().any(|(brush, _)| brush.source == source);
        let sources = self.files.keys().copied();
        let not_begun = sources.filter(|source| !has_begun(*source));
        let not_begun = not_begun.map(|source| (Origin { source, epoch: 0 }, 0));
        let painting = sequencer.painting();
        let credits: Vec<BrushCredit> = consumed
            .iter()
            .copied()
            .chain(not_begun)
            .map(|(brush, next)| self.credit_of(painting, brush, next))
            .collect();
        // Paintings of before may have more brushes than one has now.
        for brushes in credits.chunks(BRUSHES_MOST) {
            let brushes = brushes.to_vec();
            self.credit
                .send(now_ns, now_ns, &PaintConsumed { brushes })?;
        }
        Ok(())
    }

    fn credit_of(&self, painting: &Painting, brush: Origin, next: u64) -> BrushCredit {
        let under = painting.under_brush(brush.source);
        BrushCredit {
            brush: brush.source,
            epoch: brush.epoch,
            next,
            wetness: painting.fullness(brush.source),
            film_m: under.film_m as f32,
            viscosity_m2_s: under.viscosity_m2_s as f32,
            contact_m: under.contact_m as f32,
            file: self.files.get(&brush.source).copied().unwrap_or(0),
        }
    }
}
