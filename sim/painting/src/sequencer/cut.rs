//! Undo ahead of the paint: a stroke that still waits to be painted is dropped, for it would be undone.

use maulstick_types::brush::{BrushState, solve_flags};
use maulstick_types::command::{After, Command, CommandRequest, Outcome};
use maulstick_types::paint::Entry;
use maulstick_types::values::BrushName;
use maulstick_types::{Edit, Flags, Header, Origin, name_hash};

use super::{NOT_PAINTED, Replied, Sequencer};
use crate::edits;
use crate::snapshot::CutStates;

/// Sampling time that the waiting states must span for an undo to drop a stroke, ns; below it the undo waits.
const CUT_NS: u64 = 500_000_000;

/// The stroke that ends a queue of states.
struct LastStroke {
    number: u64,
    /// The first state that has some of it.
    first: u64,
    /// First and last state, which belong to no other stroke.
    states: [u64; 2],
}

impl LastStroke {
    /// True if its first state has some of another stroke too, and will be painted.
    fn is_mixed(&self) -> bool {
        self.first < self.states[0]
    }
}

impl Sequencer {
    /// Accepts a command, as [`command`](Self::command) does; `queued` are the waiting states of the brush behind which
    /// it goes, in order.
    ///
    /// An undo that is more than half a second ahead of the paint drops the newest stroke from the queue: its painted
    /// part is undone, the rest is never painted, and redo does not restore it.
    pub fn command_behind<'a>(
        &mut self,
        mut request: CommandRequest,
        queued: impl Iterator<Item = (&'a Header, &'a BrushState)>,
    ) -> Replied {
        match self.cut_by(&request, queued) {
            None => self.command(request),
            Some(Cut::Begun { undo }) => {
                // What another brush did meanwhile is newer, and not meant.
                request.command = undo.into();
                self.command(request)
            }
            Some(Cut::Whole(outcome)) => Replied {
                client: request.client,
                number: request.number,
                outcome,
                effect: None,
            },
        }
    }

    /// Drops the stroke that an undo would undo, as far as it waits.
    fn cut_by<'a>(
        &mut self,
        request: &CommandRequest,
        queued: impl Iterator<Item = (&'a Header, &'a BrushState)>,
    ) -> Option<Cut> {
        let Command::Edit(edit) = &request.command else {
            return None;
        };
        let edit = edits::read(edit).ok()?;
        let after = request.after.as_ref()?;
        let origin = Origin {
            source: after.brush,
            epoch: after.epoch,
        };
        let brush = BrushName::new(self.painting.brush_of(origin.source)?).ok()?;
        let undo = edit.undo_of(&brush).filter(|_| !self.is_known(request))?;
        let before: Vec<_> = queued
            .filter(|(header, state)| {
                header.seq <= after.sequence
                    && !header.flags.has(Flags::REPLAY)
                    && self.may_paint(&brush, header, state)
            })
            .collect();
        let (oldest, newest) = (before.first()?.0, before.last()?.0);
        let spans = newest.event_ns >= oldest.event_ns + CUT_NS;
        // Where states are still to come, the end of the stroke may be among them.
        let last = last_stroke(&before).filter(|_| spans && newest.seq == after.sequence)?;
        if self.waits_within(origin, last.first) {
            return None;
        }
        let newest_stroke = self.painting.newest_stroke(origin.source);
        let is_painted = newest_stroke == Some((origin.epoch, last.number));
        // A later action is undone instead, and the stroke stays whole.
        if is_painted && !self.painting.has_open_step(origin.source) {
            return None;
        }
        let is_begun = last.is_mixed() || is_painted;
        let journal = self.next;
        let [from, to] = last.states;
        self.drop_states(Entry::Cut {
            client: request.client,
            number: request.number,
            brush: brush.to_string(),
            epoch: origin.epoch,
            from,
            to,
            whole: !is_begun,
        });
        if is_begun {
            return Some(Cut::Begun { undo });
        }
        let outcome = Outcome::Done {
            journal,
            detail: NOT_PAINTED,
        };
        self.remember(request.client, request.number, outcome.clone());
        Some(Cut::Whole(outcome))
    }

    /// True if a command other than an undo waits behind this state or a later one.
    fn waits_within(&self, origin: Origin, state: u64) -> bool {
        self.waiting.iter().any(|request| {
            let after = request.after.as_ref();
            let is_undo = match &request.command {
                Command::Edit(edit) => edits::read(edit).is_ok_and(|edit| edit.is_undo()),
                _ => false,
            };
            let own = |after: &&After| (after.brush, after.epoch) == (origin.source, origin.epoch);
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

    /// Drops the states of an entry, which are still to come.
    pub(super) fn drop_states(&mut self, entry: Entry) {
        if let Entry::Cut {
            brush,
            epoch,
            from,
            to,
            ..
        } = &entry
        {
            self.cut.push(CutStates {
                source: name_hash(brush),
                epoch: *epoch,
                from: *from,
                to: *to,
            });
        }
        let index = self.enter(entry.clone());
        self.note(index, || super::Accepted::Entry(entry));
    }

    /// True if an undo has dropped a state.
    pub(super) fn is_cut(&self, origin: Origin, sequence: u64) -> bool {
        self.cut.iter().any(|cut| cut.has(origin, sequence))
    }
}

/// The part dropped by an undo.
enum Cut {
    /// All of a stroke; the undo is answered.
    Whole(Outcome),
    /// The rest of a stroke that is painted in part.
    Begun {
        /// What takes back that part.
        undo: Edit,
    },
}

/// The newest stroke of states in order.
fn last_stroke(states: &[(&Header, &BrushState)]) -> Option<LastStroke> {
    let strokes = |state: &BrushState| -> Vec<u64> {
        let solves = state.solves.iter();
        let painting = solves.filter(|solve| solve.flags & solve_flags::PREVIEW == 0);
        painting
            .map(|solve| solve.stroke)
            .filter(|stroke| *stroke > 0)
            .collect()
    };
    let strokes: Vec<(u64, Vec<u64>)> = states
        .iter()
        .map(|(header, state)| (header.seq, strokes(state)))
        .collect();
    let mut newest = strokes.iter().rev();
    let number = *newest.find_map(|(_, own)| own.last())?;
    let has = |(_, own): &&(u64, Vec<u64>)| own.contains(&number);
    let alone = |(_, own): &&(u64, Vec<u64>)| own.iter().all(|stroke| *stroke == number);
    let mut own = strokes.iter().filter(has);
    let first = own.clone().next()?.0;
    let start = own.clone().find(alone)?.0;
    let end = own.rfind(alone)?.0;
    Some(LastStroke {
        number,
        first,
        states: [start, end],
    })
}
