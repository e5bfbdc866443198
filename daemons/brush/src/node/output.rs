//! States on their way to the painting, and reports to the devices of the samples that went into them.

mod progress;

use maulstick_bus::credit::Stamp;
use maulstick_bus::typed::Sender;
use maulstick_bus::{Bus, BusError, CreditSender, Qos, Wake};
use maulstick_types::brush::{BrushConsumed, BrushState};
use maulstick_types::paint::BrushCredit;
use maulstick_types::wire::topics::Topics;
use maulstick_types::{Flags, Origin};

use progress::Progress;

use super::solver::Solved;
use crate::outbox::Outbox;
use crate::path_simplifier::PathSimplifier;

/// Age of the oldest unpainted state from which a live brush merges its samples, ns.
const OLDEST_NS: u64 = 50_000_000;

/// The states that a brush sends.
pub(super) struct Output {
    states: CreditSender<BrushState>,
    outbox: Outbox,
    /// Number of the newest state that touches.
    newest_contact: Option<u64>,
    progress: Progress,
    reports: Sender<BrushConsumed>,
}

impl Output {
    /// The output of the brush of this name.
    ///
    /// # Errors
    /// [`BusError`].
    pub(super) fn new(
        bus: &dyn Bus,
        topics: &Topics,
        brush: &str,
        me: Origin,
        wake: &Wake,
    ) -> Result<Self, BusError> {
        Ok(Self {
            states: CreditSender::new(bus, topics, &topics.brush_state(brush), me, wake)?,
            outbox: Outbox::default(),
            newest_contact: None,
            progress: Progress::default(),
            reports: Sender::new(bus, &topics.brush_consumed(brush), Qos::Control, me)?,
        })
    }

    /// Number of states sent.
    pub(super) fn sent(&self) -> u64 {
        self.states.next_seq()
    }

    /// Messages that wait for credit.
    pub(super) fn waiting(&self) -> usize {
        self.outbox.len()
    }

    /// True if the painting takes another state at once.
    pub(super) fn has_room(&self) -> bool {
        self.outbox.is_empty() && self.states.has_credit()
    }

    /// True if there is credit, whatever waits.
    pub(super) fn has_credit(&self) -> bool {
        self.states.has_credit()
    }

    /// True if the painting is behind: samples are merged.
    pub(super) fn is_late(&self, now_ns: u64) -> bool {
        self.states.oldest_age_ns(now_ns) > OLDEST_NS
    }

    /// True while a state that touches is not painted.
    pub(super) fn has_contact_under_way(&self) -> bool {
        let painted = self.states.next_seq() - self.states.outstanding();
        self.newest_contact.is_some_and(|state| state >= painted)
    }

    /// Source of the states.
    pub(super) fn source(&self) -> u32 {
        self.states.origin().source
    }

    /// Notes how many states are painted.
    pub(super) fn on_credit(&mut self, credit: &BrushCredit, now_ns: u64) {
        self.states.consumed(credit.epoch, credit.next, now_ns);
    }

    /// Gives all credit back: a take that is played anew owes nothing.
    pub(super) fn reset_credit(&mut self) {
        self.states.reset_credit();
    }

    /// True if samples of a device went into the brush.
    pub(super) fn follows(&self, device: &str) -> bool {
        self.progress.follows(device)
    }

    /// Notes that a sample of a device is consumed.
    pub(super) fn note_consumed(&mut self, device: &str, origin: Origin, seq: u64) {
        let (epoch, next) = (self.states.origin().epoch, self.states.next_seq());
        self.progress.note(device, origin, seq, epoch, next);
    }

    /// Reports again to a device that may have missed the last report.
    pub(super) fn report_again(&mut self, device: &str) {
        self.progress.forget_report(device);
    }

    /// Queues what a turn solved.
    pub(super) fn post_solved(&mut self, solved: Solved) {
        let number = self.post(Flags::NONE, Flags::NONE, Flags::NONE, solved.state);
        for device in solved.devices {
            self.progress.posted(device, number);
        }
    }

    /// Queues a state: `flags` go with each of its messages, `first` and `last` with those. Returns the number of its
    /// last message.
    pub(super) fn post(
        &mut self,
        flags: Flags,
        first: Flags,
        last: Flags,
        state: BrushState,
    ) -> u64 {
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

    /// Sends what waits while there is credit.
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

    /// Sends states again that the painting missed.
    pub(super) fn serve(&mut self, now_ns: u64) -> Result<(), BusError> {
        self.states.serve(now_ns)
    }

    /// Reports consumed samples to their devices; those in the backlog are not consumed.
    pub(super) fn report(&mut self, now_ns: u64, backlog: &PathSimplifier) -> Result<(), BusError> {
        let first = |device: Origin| backlog.first_of(device);
        self.progress.publish(now_ns, &mut self.reports, first)
    }

    /// Takes the solves that wait.
    #[cfg(test)]
    pub(super) fn drain(&mut self) -> Vec<maulstick_types::brush::Solve> {
        let states = std::iter::from_fn(|| self.outbox.pop());
        states.flat_map(|(_, state)| state.solves).collect()
    }
}
