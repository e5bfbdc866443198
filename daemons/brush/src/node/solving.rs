//! From samples that wait to states that go to the painting.

use std::collections::BTreeSet;

use maulstick_bus::BusError;
use maulstick_bus::credit::Stamp;
use maulstick_types::brush::BrushState;
use maulstick_types::{Flags, Origin};

use super::{BrushNode, OLDEST_NS};
use crate::path_simplifier::{Place, Waiting};

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

    /// Solves what waits, but for strokes that begin after something was asked for that is not done yet.
    pub(super) fn solve(&mut self, now_ns: u64) {
        let Some(since_ns) = self.pending_since_ns(now_ns) else {
            if std::mem::take(&mut self.holds) {
                // It was not the paint that was late.
                self.pace.forget_wait();
            }
            let waiting = self.backlog.take();
            return self.solve_all(now_ns, &waiting);
        };
        let before = self.backlog.take_until(since_ns);
        self.solve_all(now_ns, &before);
        while let Some(next) = self.backlog.first() {
            if next.place == Place::Surface && !self.touching {
                self.holds = true;
                break;
            }
            let next = self.backlog.take_first();
            self.solve_all(now_ns, &next);
        }
    }

    /// Solves samples as one state.
    fn solve_all(&mut self, now_ns: u64, waiting: &[Waiting]) {
        let Some(last) = waiting.last() else {
            return;
        };
        let devices: BTreeSet<(u32, u32)> = waiting
            .iter()
            .map(|w| (w.origin.source, w.origin.epoch))
            .collect();
        let mut solves: Vec<_> = waiting
            .iter()
            .flat_map(|w| self.model.follow(w.origin, w.event_ns, &w.sample))
            .collect();
        self.pace.flag(now_ns, &mut solves);
        let state = BrushState {
            device: last.origin.source,
            device_epoch: last.origin.epoch,
            device_seq: last.seq,
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
