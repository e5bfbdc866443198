//! Undo ahead of the paint: a stroke that still waits to be painted is dropped, for it would be undone.

use maulstick_types::brush::{BrushState, solve_flags};
use maulstick_types::command::{Command, CommandRequest, Outcome};
use maulstick_types::edits::{Edit, Undo};
use maulstick_types::paint::Entry;
use maulstick_types::{Flags, Header, Origin, name_hash};

use super::{Replied, Sequencer};
use crate::snapshot::CutStates;

/// An undo drops a stroke whose oldest waiting sample is so much older than its newest, ns; below it waits.
const CUT_NS: u64 = 500_000_000;

/// The stroke that ends a queue of states.
struct Last {
    number: u64,
    /// First and last state that have nothing of another stroke.
    states: [u64; 2],
    /// True if a state before these has some of it.
    is_begun: bool,
}

impl Sequencer {
    /// Accepts a command, as [`command`](Self::command) does; `queued` are the states that wait of the brush behind
    /// which it goes, in order.
    ///
    /// An undo that is more than [`CUT_NS`] ahead of the paint drops the newest stroke from the queue: what is painted
    /// of it is undone, the rest is never painted, and no redo brings it back.
    pub fn command_behind<'a>(
        &mut self,
        request: CommandRequest,
        queued: impl Iterator<Item = (&'a Header, &'a BrushState)>,
    ) -> Replied {
        let (client, number) = (request.client, request.number);
        match self.cut_by(&request, queued) {
            None => self.command(request),
            Some(outcome) => {
                self.remember(client, number, outcome.clone());
                Replied {
                    client,
                    number,
                    outcome,
                    effect: None,
                }
            }
        }
    }

    /// Drops the stroke that an undo would undo, as far as it waits. The outcome, if nothing of it was painted.
    fn cut_by<'a>(
        &mut self,
        request: &CommandRequest,
        queued: impl Iterator<Item = (&'a Header, &'a BrushState)>,
    ) -> Option<Outcome> {
        let Command::Edit(Edit::Undo(Undo { brush: of })) = &request.command else {
            return None;
        };
        let after = request.after.as_ref()?;
        let origin = Origin {
            source: after.brush,
            epoch: after.epoch,
        };
        let brush = self.painting.brush_of(origin.source)?.to_owned();
        let is_another = of.as_ref().is_some_and(|of| name_hash(of) != origin.source);
        if is_another || self.is_known(request) {
            return None;
        }
        let before: Vec<_> = queued
            .filter(|(header, _)| {
                header.seq <= after.sequence
                    && !header.flags.has(Flags::REPLAY)
                    && !self.is_cut(origin, header.seq)
            })
            .collect();
        let times = [before.first()?, before.last()?].map(|(header, _)| header.event_ns);
        let last = last_stroke(&before).filter(|_| times[1] >= times[0] + CUT_NS)?;
        if self.waits_within(origin, last.states[0]) {
            return None;
        }
        let begun = self.painting.newest_stroke(origin.source);
        let is_begun = last.is_begun || begun == Some((origin.epoch, last.number));
        let journal = self.next;
        self.drop_states(&brush, origin.epoch, last.states);
        (!is_begun).then(|| Outcome::Done {
            journal,
            detail: "a stroke that was not painted yet".to_owned(),
        })
    }

    /// True if a command waits that is not undone with a stroke that begins with this state.
    fn waits_within(&self, origin: Origin, state: u64) -> bool {
        self.waiting.iter().any(|request| {
            let after = request.after.as_ref();
            let is_undo = matches!(request.command, Command::Edit(Edit::Undo(_)));
            let own = |after: &&maulstick_types::command::After| {
                (after.brush, after.epoch) == (origin.source, origin.epoch)
            };
            !is_undo
                && after
                    .filter(own)
                    .is_some_and(|after| after.sequence >= state)
        })
    }

    /// True for a command that was answered, or waits.
    fn is_known(&self, request: &CommandRequest) -> bool {
        let same =
            |own: &CommandRequest| (own.client, own.number) == (request.client, request.number);
        self.replies.find(request).is_some() || self.waiting.iter().any(same)
    }

    /// Drops states that are still to come.
    pub(super) fn drop_states(&mut self, brush: &str, epoch: u32, [from, to]: [u64; 2]) {
        self.cut.push(CutStates {
            source: name_hash(brush),
            epoch,
            from,
            to,
        });
        let entry = Entry::Cut {
            brush: brush.to_owned(),
            epoch,
            from,
            to,
        };
        let index = self.enter(entry.clone());
        self.note(index, || super::Accepted::Entry(entry));
    }

    /// True if an undo has dropped a state.
    pub(super) fn is_cut(&self, origin: Origin, sequence: u64) -> bool {
        self.cut.iter().any(|cut| cut.has(origin, sequence))
    }
}

/// The newest stroke of states in order.
fn last_stroke(states: &[(&Header, &BrushState)]) -> Option<Last> {
    let strokes = |state: &BrushState| -> Vec<u64> {
        let painting = state.solves.iter();
        let painting = painting.filter(|solve| solve.flags & solve_flags::PREVIEW == 0);
        painting
            .map(|solve| solve.stroke)
            .filter(|stroke| *stroke > 0)
            .collect()
    };
    let mut strokes = states
        .iter()
        .map(|(header, state)| (header.seq, strokes(state)));
    let number = *strokes
        .clone()
        .rev()
        .find_map(|(_, own)| own.last().copied())
        .as_ref()?;
    let alone = |(_, own): &(u64, Vec<u64>)| {
        own.contains(&number) && own.iter().all(|stroke| *stroke == number)
    };
    let is_begun = strokes
        .clone()
        .any(|own| own.1.contains(&number) && !alone(&own));
    let first = strokes.clone().find(alone)?.0;
    let last = strokes.rfind(alone)?.0;
    Some(Last {
        number,
        states: [first, last],
        is_begun,
    })
}
