//! The sequencer, which alone decides about the entries of the journal and their order.

mod cut;
mod records;
mod repeat;

pub use records::{Accepted, Record};

use std::collections::{BTreeMap, BTreeSet};

use maulstick_types::brush::BrushState;
use maulstick_types::command::reply_cache::ReplyCache;
use maulstick_types::command::{Command, CommandRequest, Detail, Outcome, TakeCommand};
use maulstick_types::paint::{Decision, Entry, JournalEntry, StepName};
use maulstick_types::{Flags, Header, Mixture, Origin};

use crate::edits::Applied;
use crate::error::{BrushError, EditError};
use crate::painting::Painting;
use crate::snapshot::{CutStates, TakeSnapshot};

/// Effect of a command on the outside world; carried out at once by the caller of the sequencer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Effect {
    /// Write the picture and, on request, the ledger.
    Snapshot {
        /// A PNG.
        path: String,
        /// A JSON file.
        ledger: Option<String>,
    },
}

/// Report of an undo of a stroke of which nothing was painted.
const NOT_PAINTED: Detail = Detail::Step {
    name: StepName::Unpainted,
};

/// A reply to the command `number` of `client`.
#[derive(Clone, Debug, PartialEq)]
pub struct Replied {
    /// Client that sent it.
    pub client: u64,
    /// The command's number.
    pub number: u64,
    /// Outcome.
    pub outcome: Outcome,
    /// Effect still to be carried out; the outcome holds if that succeeds.
    pub effect: Option<Effect>,
}

/// Orders states and commands, keeps the journal, drives the painting.
#[derive(Debug)]
pub struct Sequencer {
    painting: Painting,
    next: u64,
    journal: Vec<JournalEntry>,
    /// By brush, the take that may paint, and until its end alone.
    announced: BTreeMap<String, TakeSnapshot>,
    /// Players that are gone: their takes hold no brush any more.
    gone: BTreeSet<u32>,
    consumed: BTreeMap<Origin, u64>,
    /// States that an undo dropped, which are still to come.
    cut: Vec<CutStates>,
    waiting: Vec<CommandRequest>,
    replies: ReplyCache,
    ignored: u64,
    serial: u64,
    /// Accepted records, if they are saved.
    records: Option<Vec<Record>>,
    /// A recorded session is painted again.
    repeats: bool,
    /// True if something was accepted that is not among the records.
    is_unrecorded: bool,
}

impl Sequencer {
    /// A sequencer at the beginning of a painting's journal.
    #[must_use]
    pub fn new(painting: Painting) -> Self {
        Self {
            painting,
            next: 0,
            journal: Vec::new(),
            announced: BTreeMap::new(),
            gone: BTreeSet::new(),
            consumed: BTreeMap::new(),
            cut: Vec::new(),
            waiting: Vec::new(),
            replies: ReplyCache::default(),
            ignored: 0,
            serial: 0,
            records: None,
            repeats: false,
            is_unrecorded: false,
        }
    }

    /// The painting.
    #[must_use]
    pub fn painting(&self) -> &Painting {
        &self.painting
    }

    /// The painting, at the end of its journal.
    #[must_use]
    pub fn into_painting(self) -> Painting {
        self.painting
    }

    /// The painting, for operations outside the journal: committing, counting, defining brushes.
    pub fn painting_mut(&mut self) -> &mut Painting {
        &mut self.painting
    }

    /// Index of the next journal entry.
    #[must_use]
    pub fn journal_next(&self) -> u64 {
        self.next
    }

    /// States that were dropped: of unannounced takes, live ones during a take, or by an undo.
    #[must_use]
    pub fn ignored(&self) -> u64 {
        self.ignored
    }

    /// Entries since the last call, ranges of states joined.
    pub fn drain_journal(&mut self) -> Vec<JournalEntry> {
        std::mem::take(&mut self.journal)
    }

    /// First of a brush's states that is not consumed.
    #[must_use]
    pub fn consumed(&self, brush: Origin) -> u64 {
        self.consumed.get(&brush).copied().unwrap_or(0)
    }

    /// First state of each brush that is not consumed.
    #[must_use]
    pub fn consumed_all(&self) -> Vec<(Origin, u64)> {
        self.consumed
            .iter()
            .map(|(origin, next)| (*origin, *next))
            .collect()
    }

    /// Accepts a state, which must come in order, and then the commands that waited for it; returns the outcomes of
    /// all. A state that does not fit is refused, but still consumed.
    ///
    /// A state of an unannounced replayed take paints nothing, and neither does a live one between the announcement of
    /// a take and its last state, so that a take always paints the same. A state dropped by an
    /// [undo](Self::command_behind) paints nothing either.
    #[must_use = "effects of the commands are still to be done"]
    pub fn state(
        &mut self,
        brush: &str,
        header: &Header,
        state: &BrushState,
    ) -> (Vec<Replied>, Result<(), EditError>) {
        let may_paint = self.may_paint(brush, header, state);
        let result = if let Some(fault) = state.fault() {
            Err(BrushError::State {
                brush: brush.to_owned(),
                fault,
            }
            .into())
        } else if !may_paint {
            self.ignored += 1;
            Ok(())
        } else {
            let index = self.enter_states(brush, header.epoch, header.seq);
            self.note(index, || Accepted::State {
                header: *header,
                state: state.clone(),
            });
            self.paint(brush, header, state)
        };
        if may_paint {
            self.consume(brush, header);
        } else {
            self.pass(header);
        }
        (self.release(), result)
    }

    /// A live stroke takes up no loads of a take that was played before.
    fn paint(&mut self, brush: &str, header: &Header, state: &BrushState) -> Result<(), EditError> {
        if !header.flags.has(Flags::REPLAY) {
            self.painting.forget_loads(brush);
        }
        let painted = self.painting.state(brush, header.epoch, state);
        self.publish_backend_change();
        self.painting.note_contact(brush);
        painted
    }

    /// Marks a state as consumed.
    fn pass(&mut self, header: &Header) {
        self.consumed
            .retain(|origin, _| origin.source != header.source || origin.epoch == header.epoch);
        self.consumed.insert(header.origin(), header.seq + 1);
        let is_past = |cut: &CutStates| {
            cut.source == header.source && (cut.epoch != header.epoch || cut.to <= header.seq)
        };
        self.cut.retain(|cut| !is_past(cut));
    }

    /// Marks a state that may paint as consumed; the last one of a take ends it.
    fn consume(&mut self, brush: &str, header: &Header) {
        if header.flags.has(Flags::REPLAY.with(Flags::LAST))
            && let Some(take) = self.announced.get_mut(brush)
        {
            take.ended = true;
        }
        self.pass(header);
    }

    /// True if a state is of the announced take, or live while no take has its brush, and not dropped by an undo.
    fn may_paint(&self, brush: &str, header: &Header, state: &BrushState) -> bool {
        if self.repeats {
            return false;
        }
        if !header.flags.has(Flags::REPLAY) && self.is_cut(header.origin(), header.seq) {
            return false;
        }
        let take = self.announced.get(brush);
        if header.flags.has(Flags::REPLAY) {
            take.is_some_and(|t| (t.device, t.epoch) == (state.device, state.device_epoch))
        } else {
            take.is_none_or(|take| take.ended || self.gone.contains(&take.device))
        }
    }

    /// A player is gone: its take, if it has not ended, holds its brush no more.
    pub fn player_gone(&mut self, device: u32) {
        self.gone.insert(device);
    }

    /// Handles the arrival, or return, of a player.
    pub fn player_there(&mut self, device: u32) {
        self.gone.remove(&device);
    }

    fn enter_states(&mut self, brush: &str, epoch: u32, seq: u64) -> u64 {
        if let Some(JournalEntry {
            index,
            entry:
                Entry::States {
                    brush: b,
                    epoch: e,
                    to,
                    ..
                },
        }) = self.journal.last_mut()
            && b == brush
            && *e == epoch
            && *to + 1 == seq
        {
            *to = seq;
            return *index;
        }
        self.enter(Entry::States {
            brush: brush.to_owned(),
            epoch,
            from: seq,
            to: seq,
        })
    }

    fn enter(&mut self, entry: Entry) -> u64 {
        let index = self.next;
        self.journal.push(JournalEntry { index, entry });
        self.next += 1;
        index
    }

    /// Enters a decision of the node itself.
    pub fn decide(&mut self, what: Decision) {
        let entry = Entry::Decision { what };
        let index = self.enter(entry.clone());
        self.note(index, || Accepted::Entry(entry));
    }

    /// Advances by a sixtieth of a second: entered during a drying, otherwise ignored.
    pub fn tick(&mut self) {
        if self.painting.is_drying() && !self.repeats {
            self.enter_tick();
        }
    }

    fn enter_tick(&mut self) {
        self.painting.tick();
        let count = self.painting.clock().ticks;
        let entry = Entry::Tick { count };
        let index = self.enter(entry.clone());
        self.note(index, || Accepted::Entry(entry));
    }

    /// Accepts a command, at once or when the state that it waits for has come.
    pub fn command(&mut self, request: CommandRequest) -> Replied {
        let (client, number) = (request.client, request.number);
        let reply = |outcome| Replied {
            client,
            number,
            outcome,
            effect: None,
        };
        if let Some(outcome) = self.replies.find(&request) {
            return reply(outcome);
        }
        if self.repeats {
            return reply(Outcome::refused(
                "a recorded session is being painted",
                "wait for its end, or end `maulstick recording replay`",
            ));
        }
        if self
            .waiting
            .iter()
            .any(|w| w.client == client && w.number == number)
        {
            return reply(Outcome::Waiting);
        }
        let due = request.after.as_ref().is_none_or(|after| {
            let origin = Origin {
                source: after.brush,
                epoch: after.epoch,
            };
            self.consumed(origin) > after.sequence
        });
        if due {
            return self.execute(&request);
        }
        self.waiting.push(request);
        reply(Outcome::Waiting)
    }

    /// Does the waiting commands whose state has arrived.
    fn release(&mut self) -> Vec<Replied> {
        let mut replies = Vec::new();
        let mut place = 0;
        while place < self.waiting.len() && !self.repeats {
            let due = self.waiting[place].after.as_ref().is_none_or(|after| {
                let origin = Origin {
                    source: after.brush,
                    epoch: after.epoch,
                };
                self.consumed(origin) > after.sequence
            });
            if due {
                let request = self.waiting.remove(place);
                replies.push(self.execute(&request));
            } else {
                place += 1;
            }
        }
        replies
    }

    fn execute(&mut self, request: &CommandRequest) -> Replied {
        let (client, number) = (request.client, request.number);
        let mut effect = None;
        let done = match &request.command {
            Command::Edit(edit) => self.painting.apply(edit.clone()),
            Command::Take(command) => self.take(command, &mut effect),
            command @ (Command::File(_)
            | Command::Brush(_)
            | Command::Rig(_)
            | Command::Session(_)) => {
                return Replied {
                    client,
                    number,
                    outcome: command.misaddressed(),
                    effect,
                };
            }
        };
        let outcome = match done {
            Ok(applied) => {
                let command = request.command.clone();
                let journal = self.enter_command(client, number, command);
                Outcome::Done {
                    journal,
                    detail: applied.into(),
                }
            }
            Err(error) => error.into(),
        };
        self.remember(client, number, outcome.clone());
        Replied {
            client,
            number,
            outcome,
            effect,
        }
    }

    fn enter_command(&mut self, client: u64, number: u64, command: Command) -> u64 {
        let entry = Entry::Command {
            client,
            number,
            command,
        };
        let index = self.enter(entry.clone());
        self.note(index, || Accepted::Entry(entry));
        index
    }

    /// Carries out a journalled command other than an edit.
    fn take(
        &mut self,
        command: &TakeCommand,
        effect: &mut Option<Effect>,
    ) -> Result<Applied, EditError> {
        match command {
            TakeCommand::Begin {
                brush,
                device,
                device_epoch,
                loads,
                again,
            } => self.begin_take(brush, [*device, *device_epoch], loads, *again)?,
            TakeCommand::Mark => {}
            TakeCommand::Snapshot { path, ledger } => {
                *effect = Some(Effect::Snapshot {
                    path: path.to_string(),
                    ledger: ledger.as_ref().map(ToString::to_string),
                });
                return Ok(Applied::Written(path.to_string()));
            }
        }
        Ok(Applied::Done)
    }

    /// Begins a take; the paint of an earlier run of it is undone.
    fn begin_take(
        &mut self,
        brush: &str,
        [device, epoch]: [u32; 2],
        loads: &[Mixture],
        again: bool,
    ) -> Result<(), EditError> {
        let before = self.announced.get(brush).filter(|_| again).copied();
        if let Some(TakeSnapshot { step, .. }) = before {
            let undone = self.painting.undo_to(brush, step);
            undone.inspect_err(|_| self.painting.break_record())?;
        }
        self.painting.take(brush, loads)?;
        if let Some(TakeSnapshot { strokes, .. }) = before {
            self.painting.bench.accounts.work.strokes = strokes;
        }
        let step = self.painting.newest_step();
        // A step that may have to be taken back is not merged with earlier ones.
        self.painting.part_history(step);
        let take = TakeSnapshot {
            device,
            epoch,
            ended: false,
            step,
            strokes: self.painting.bench.accounts.work.strokes,
        };
        self.gone.remove(&device);
        self.announced.insert(brush.to_owned(), take);
        Ok(())
    }

    /// Stores the outcome of a command, also if its effect failed later.
    pub fn remember(&mut self, client: u64, number: u64, outcome: Outcome) {
        self.replies.keep(client, number, outcome);
    }
}
