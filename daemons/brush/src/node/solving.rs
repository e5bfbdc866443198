//! From samples that wait to states that go to the painting.

use std::collections::BTreeSet;

use maulstick_bus::BusError;
use maulstick_bus::credit::Stamp;
use maulstick_types::brush::{BrushState, Solve};
use maulstick_types::{Flags, Origin};

use super::{BrushNode, OLDEST_NS};
use crate::path_simplifier::{Place, Start};

impl BrushNode {
    /// Sends what is solved while there is credit, and solves what waits, if paint keeps up: what
    /// has waited is one state.
    pub(super) fn flush(&mut self, now_ns: u64) -> Result<(), BusError> {
        self.send(now_ns)?;
        let late = self.states.oldest_age_ns(now_ns) > OLDEST_NS;
        let busy = !self.outbox.is_empty() || !self.states.has_credit();
        if late || busy {
            return Ok(());
        }
        self.solve(now_ns);
        self.send(now_ns)
    }

    /// Solves what waits, as one state, as far as this turn allows, but for a stroke that begins after something was asked
    /// for that is not done yet.
    pub(super) fn solve(&mut self, now_ns: u64) {
        let since_ns = self.pending_since_ns(now_ns);
        let mut touching = self.touching;
        let (mut solves, mut newest) = (Vec::new(), None);
        let mut devices = BTreeSet::new();
        while self.solves_left > 0
            && let Some(next) = self.backlog.first()
        {
            let begins = next.place == Place::Surface && !touching;
            if begins && since_ns.is_some_and(|since_ns| next.event_ns > since_ns) {
                self.holds = true;
                break;
            }
            if std::mem::take(&mut self.holds) {
                // It was not the paint that was late.
                self.pace.forget_wait();
            }
            let Some((start, waiting)) = self.backlog.pop() else {
                break;
            };
            let mut more = match start {
                Start::AfterLoss => self.model.begin_anew(),
                _ => Vec::new(),
            };
            let (origin, event_ns) = (waiting.origin, waiting.event_ns);
            more.extend(self.model.follow(origin, event_ns, &waiting.sample));
            self.solves_left = self.solves_left.saturating_sub(more.len().max(1));
            if let Some(last) = more.last() {
                touching = !last.contacts.is_empty();
            }
            devices.insert((origin.source, origin.epoch));
            newest = Some((origin, waiting.seq));
            solves.extend::<Vec<Solve>>(more);
        }
        let Some((origin, device_seq)) = newest else {
            return;
        };
        self.pace.flag(now_ns, &mut solves);
        if self.backlog.is_empty() {
            self.pace.forget_wait();
        }
        self.tell_haste();
        let state = BrushState {
            device: origin.source,
            device_epoch: origin.epoch,
            device_seq,
            solves,
        };
        if !state.solves.is_empty() {
            let number = self.post(Flags::NONE, Flags::NONE, Flags::NONE, state);
            for (source, epoch) in devices {
                self.progress.posted(Origin { source, epoch }, number);
            }
        }
    }

    /// Puts a state into the outbox; the number by which its last part will go.
    pub(super) fn post(
        &mut self,
        flags: Flags,
        first: Flags,
        last: Flags,
        state: BrushState,
    ) -> u64 {
        if let Some(newest) = state.solves.last() {
            self.touching = !newest.contacts.is_empty();
        }
        let touches = state.solves.iter().any(|solve| solve.stroke != 0);
        let origin = Origin {
            source: state.device,
            epoch: state.device_epoch,
        };
        self.outbox.push(flags, first, last, state);
        let number = self.states.next_seq() + self.outbox.len() as u64 - 1;
        if touches {
            self.newest_contact = Some(number);
        }
        self.progress.posted(origin, number);
        number
    }

    /// Sends what waits in the outbox while there is credit.
    pub(super) fn send(&mut self, now_ns: u64) -> Result<(), BusError> {
        while self.states.has_credit() {
            let Some((flags, state)) = self.outbox.pop() else {
                return Ok(());
            };
            let event_ns = state.solves.last().map_or(now_ns, |last| last.event_ns);
            self.states
                .send(flags, Stamp { now_ns, event_ns }, &state)?;
        }
        Ok(())
    }
}
