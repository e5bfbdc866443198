//! The sequencer: it decides what enters the journal and in which order; nothing else does.

mod dispatch;
mod layers;
mod records;

pub use records::{Accepted, NO_ZOOM, Record};

use std::collections::{BTreeMap, BTreeSet};

use maulstick_canvas::EditError;
use maulstick_types::advice::parted;
use maulstick_types::brush::BrushState;
use maulstick_types::command::{Command, CommandRequest, Outcome};
use maulstick_types::paint::{Entry, JournalEntry};
use maulstick_types::{Flags, Header, Mixture, Origin};

use crate::painting::Painting;
use crate::snapshot::{ReplySnapshot, TakeSnapshot};
use dispatch::elsewhere;

/// Clients whose last reply is cached, so that a repeated command is done once. A client repeats within seconds; beyond
/// this number the client answered longest ago is forgotten.
const CLIENTS: usize = 256;

/// Effect of a command on the outside world; carried out at once by the caller of the sequencer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Effect {
    /// Write the picture and, if asked, the ledger.
    Snapshot {
        /// A PNG.
        path: String,
        /// A JSON file.
        ledger: Option<String>,
    },
}

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
    waiting: Vec<CommandRequest>,
    answered: BTreeMap<u64, ReplySnapshot>,
    answers: u64,
    ignored: u64,
    serial: u64,
    /// Accepted records, if they are saved.
    records: Option<Vec<Record>>,
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
            waiting: Vec::new(),
            answered: BTreeMap::new(),
            answers: 0,
            ignored: 0,
            serial: 0,
            records: None,
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

    /// The painting, for what is not journalled: committing, counting, defining brushes.
    pub fn painting_mut(&mut self) -> &mut Painting {
        &mut self.painting
    }

    /// Index of the next journal entry.
    #[must_use]
    pub fn journal_next(&self) -> u64 {
        self.next
    }

    /// States that were dropped: of unannounced takes, or live ones during a take.
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
    /// these and of it. A state that does not fit is refused, and consumed all the same.
    ///
    /// A state of an unannounced replayed take paints nothing, nor does a live one from the announcement of a take to
    /// its last state: a take paints the same whatever else moves.
    #[must_use = "effects of the commands are still to be done"]
    pub fn state(
        &mut self,
        brush: &str,
        header: &Header,
        state: &BrushState,
    ) -> (Vec<Replied>, Result<(), EditError>) {
        let may_paint = self.may_paint(brush, header, state);
        let result = if let Some(fault) = state.fault() {
            Err(EditError::new(
                format!("a state of brush '{brush}' is wrong: {fault}"),
                "restart the program that sends it, or report its fault",
            ))
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
        match may_paint {
            true => self.consume(brush, header),
            false => self.pass(header),
        }
        (self.release(), result)
    }

    /// A live stroke takes up no loads of a take that was played before.
    fn paint(&mut self, brush: &str, header: &Header, state: &BrushState) -> Result<(), EditError> {
        if !header.flags.has(Flags::REPLAY) {
            self.painting.forget_loads(brush);
        }
        let painted = self.painting.state(brush, header.epoch, state);
        self.tell_fall();
        self.painting.note_contact(brush);
        painted
    }

    /// Notes that a state is consumed.
    fn pass(&mut self, header: &Header) {
        self.consumed
            .retain(|origin, _| origin.source != header.source || origin.epoch == header.epoch);
        self.consumed.insert(header.origin(), header.seq + 1);
    }

    /// Notes that a state that may paint is consumed; the last one of a take ends it.
    fn consume(&mut self, brush: &str, header: &Header) {
        if header.flags.has(Flags::REPLAY.with(Flags::LAST))
            && let Some(take) = self.announced.get_mut(brush)
        {
            take.ended = true;
        }
        self.pass(header);
    }

    /// True if a state is of the announced take, or live while no take has its brush.
    fn may_paint(&self, brush: &str, header: &Header, state: &BrushState) -> bool {
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

    /// A player is there, or there again.
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
    pub fn decide(&mut self, what: &str) {
        let entry = Entry::Decision {
            what: what.to_owned(),
        };
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
        // Whatever is answered may be quoted, and is journalled: it has to fit.
        if let Err(line) = request.command.check() {
            let (what, help) = parted(&line);
            let other = "see the messages of `maulstick schema` for what a command may say";
            return reply(Outcome::Refused {
                what: what.to_owned(),
                help: help.unwrap_or(other).to_owned(),
            });
        }
        if let Some(answered) = self.answered.get(&client) {
            if answered.number == number {
                return reply(answered.outcome.clone());
            }
            if answered.number > number {
                return reply(Outcome::Refused {
                    what: format!("command {number} comes after command {}", answered.number),
                    help: "number commands upward".to_owned(),
                });
            }
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

    /// Does the waiting commands whose state has come.
    fn release(&mut self) -> Vec<Replied> {
        let mut replies = Vec::new();
        let mut place = 0;
        while place < self.waiting.len() {
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
        let mut effect = None;
        let done = match &request.command {
            Command::Load { brush, mixture } => {
                self.painting.load(brush, mixture).map(|()| String::new())
            }
            Command::LoadBeside { brush, left, right } => self
                .painting
                .load_beside(brush, left, right)
                .map(|()| String::new()),
            Command::Tune { tuning } => self.painting.tune(tuning).map(|()| String::new()),
            Command::Clean { brush } => self.painting.clean(brush).map(|()| String::new()),
            Command::Take {
                brush,
                device,
                device_epoch,
                loads,
                again,
            } => self.begin_take(brush, [*device, *device_epoch], loads, *again),
            Command::Undo { brush } => self.painting.undo(brush.as_deref()),
            Command::Redo { brush } => self.painting.redo(brush.as_deref()),
            Command::Snapshot { path, ledger } => {
                effect = Some(Effect::Snapshot {
                    path: path.clone(),
                    ledger: ledger.clone(),
                });
                Ok(path.clone())
            }
            Command::Relight { light, expose } => self.painting.relight(light).map(|()| {
                if *expose {
                    self.painting.expose();
                }
                String::new()
            }),
            Command::Ground { surface, ground } => self
                .painting
                .set_ground(*surface, ground)
                .map(|()| String::new()),
            Command::Tooth {
                surface,
                tooth,
                seed,
            } => self
                .painting
                .set_tooth(*surface, tooth, *seed)
                .map(|()| String::new()),
            Command::Fill {
                surface,
                mixture,
                thickness_m,
            } => self
                .painting
                .lay(*surface, mixture, *thickness_m)
                .map(|()| String::new()),
            Command::Keep { name } => self.painting.keep(name).map(|()| String::new()),
            Command::Return { name } => self.painting.return_to(name).map(|()| String::new()),
            Command::Branch { from, name } => {
                self.painting.branch(from, name).map(|()| String::new())
            }
            Command::Forget { name } => self.painting.forget(name).map(|()| String::new()),
            Command::Mark => Ok(String::new()),
            command @ (Command::Dry { .. }
            | Command::DryRegion { .. }
            | Command::DryOver { .. }
            | Command::StopDrying { .. }
            | Command::Wet { .. }
            | Command::Opacity { .. }
            | Command::LayerOpacity { .. }
            | Command::NameLayer { .. }) => self.layers(command),
            command @ (Command::Place { .. }
            | Command::Handle { .. }
            | Command::FillWith { .. }
            | Command::Size { .. }
            | Command::Piles { .. }
            | Command::Wells { .. }
            | Command::GroundSpectrum { .. }) => self.ways(command),
            command @ (Command::Define { .. }
            | Command::Open { .. }
            | Command::New { .. }
            | Command::SaveAs { .. }
            | Command::Export { .. }
            | Command::StopExport) => Err(elsewhere(command)),
        };
        let (client, number) = (request.client, request.number);
        let outcome = match done {
            Ok(detail) => {
                let command = request.command.clone();
                let entry = Entry::Command {
                    client,
                    number,
                    command,
                };
                let journal = self.enter(entry.clone());
                self.note(journal, || Accepted::Entry(entry));
                Outcome::Done { journal, detail }
            }
            Err(EditError { what, help }) => Outcome::Refused { what, help },
        };
        self.remember(client, number, outcome.clone());
        Replied {
            client,
            number,
            outcome,
            effect,
        }
    }

    /// Begins a take; what was painted of one that begins again is undone.
    fn begin_take(
        &mut self,
        brush: &str,
        [device, epoch]: [u32; 2],
        loads: &[Mixture],
        again: bool,
    ) -> Result<String, EditError> {
        let before = self.announced.get(brush).filter(|_| again);
        if let Some(step) = before.map(|take| take.step) {
            self.painting.undo_to(brush, step)?;
        }
        self.painting.take(brush, loads)?;
        let step = self.painting.newest_step();
        // A step that may have to be taken back is not merged with earlier ones.
        self.painting.part_history(step);
        let take = TakeSnapshot {
            device,
            epoch,
            ended: false,
            step,
        };
        self.gone.remove(&device);
        self.announced.insert(brush.to_owned(), take);
        Ok(String::new())
    }

    /// Keeps what became of a command, also when its effect failed after all.
    pub fn remember(&mut self, client: u64, number: u64, outcome: Outcome) {
        if self.answered.len() >= CLIENTS && !self.answered.contains_key(&client) {
            let oldest = self.answered.iter().min_by_key(|(_, reply)| reply.age);
            if let Some(oldest) = oldest.map(|(client, _)| *client) {
                self.answered.remove(&oldest);
            }
        }
        self.answers += 1;
        let age = self.answers;
        let reply = ReplySnapshot {
            number,
            outcome,
            age,
        };
        self.answered.insert(client, reply);
    }
}
