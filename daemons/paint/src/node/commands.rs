//! Commands to the paint node: most are the sequencer's, some run in the background.

use std::path::Path;

use maulstick_bus::Request;
use maulstick_bus::typed::Received;
use maulstick_painting::Effect;
use maulstick_painting::sequencer::Replied;
use maulstick_types::brush::BrushState;
use maulstick_types::command::{
    Command, CommandReply, CommandRequest, FileCommand, Outcome, SaveAs,
};
use maulstick_types::{Flags, Origin, encode, name_hash};

use super::PaintNode;
use crate::refusal::Refusal;
use crate::snapshots::Snapshot;

impl PaintNode {
    pub(super) fn serve_commands(&mut self, now_ns: u64) {
        while let Some(request) = self.commands.try_recv() {
            let asked = match self.reader.read_command(&request.key, &request.bytes) {
                Ok(asked) => asked,
                Err(reply) => {
                    if let Some(reply) = reply {
                        self.answer(request, now_ns, reply);
                    }
                    continue;
                }
            };
            let number = asked.number;
            let outcome = match self.beside(&asked, now_ns) {
                Some(outcome) => outcome,
                None if self.snapshots.has((asked.client, number)) => Outcome::Waiting,
                None => {
                    let replied = self.sequence(asked);
                    self.complete(replied)
                }
            };
            self.answer(request, now_ns, CommandReply { number, outcome });
        }
    }

    /// Hands a command to the sequencer, with the states that wait of the brush behind which it goes.
    fn sequence(&mut self, asked: CommandRequest) -> Replied {
        self.take_up_brushes();
        let brush = asked.after.as_ref().map(|after| Origin {
            source: after.brush,
            epoch: after.epoch,
        });
        let waiting = brush
            .into_iter()
            .flat_map(|brush| self.states.waiting(brush));
        // A stranger may use a brush's number on a topic of its own.
        let is_own = |state: &&Received<BrushState>| {
            let brush = self.topics.middle(&state.key).unwrap_or_default();
            name_hash(brush) == state.header.source
        };
        let queued = waiting.filter(is_own);
        let queued = queued.map(|state| (&state.header, &state.message));
        self.sequencer.command_behind(asked, queued)
    }

    /// Answers a command. Nothing that a client sends may end the node: what cannot be told in
    /// full is told in short.
    pub(super) fn answer(&self, request: Request, now_ns: u64, reply: CommandReply) {
        let write = |reply: &CommandReply| {
            encode(&self.me, Flags::NONE, 0, now_ns, self.bus.now_ns(), reply)
        };
        let bytes = write(&reply).or_else(|error| {
            tracing::warn!("{}: {error}", request.key);
            write(&CommandReply {
                number: reply.number,
                outcome: Outcome::refused(
                    "the answer to this command is too long",
                    "send shorter names",
                ),
            })
        });
        match bytes.map(|bytes| request.answer(bytes)) {
            Ok(Ok(())) => {}
            Ok(Err(error)) => tracing::debug!("a client is gone: {error}"),
            Err(error) => tracing::error!("a command cannot be answered: {error}"),
        }
    }

    /// Carries out a command about files; `None` if it is the sequencer's.
    fn beside(&mut self, asked: &CommandRequest, now_ns: u64) -> Option<Outcome> {
        let command = match &asked.command {
            Command::File(command) => command,
            Command::Session(command) => return Some(self.repeat(command, now_ns)),
            Command::Edit(_) | Command::Take(_) | Command::Brush(_) | Command::Rig(_) => {
                return None;
            }
        };
        if let Some(outcome) = self.replies.find(asked) {
            return Some(outcome);
        }
        let outcome = self.begin_beside(asked, command, now_ns);
        let outcome = outcome.unwrap_or_else(Outcome::from);
        self.replies
            .keep(asked.client, asked.number, outcome.clone());
        Some(outcome)
    }

    fn begin_beside(
        &mut self,
        asked: &CommandRequest,
        command: &FileCommand,
        now_ns: u64,
    ) -> Result<Outcome, Refusal> {
        if asked.after.is_some() {
            return Err(Refusal::say(
                "this command has no place in the journal",
                "ask without a place in it",
            ));
        }
        let asker = (asked.client, asked.number);
        match command {
            FileCommand::Export(order) => {
                let still = self.sequencer.painting_mut().still();
                self.exporter
                    .begin(asker, order, still, &self.export, now_ns)?;
                Ok(Outcome::Waiting)
            }
            FileCommand::SaveAs(SaveAs { path, replace }) => {
                self.save_as(asker, Path::new(path.as_str()), *replace)
            }
            FileCommand::Copy { path } => self.copy(asker, Path::new(path.as_str())),
            FileCommand::StopExport => {
                self.exporter.stop()?;
                Ok(Outcome::done(""))
            }
        }
    }

    /// Checks the progress of background work.
    pub(super) fn go_on_beside(&mut self, now_ns: u64) {
        if let Some(((client, number), outcome)) = self.exporter.ended() {
            self.replies.keep(client, number, outcome);
        }
        if let Some(((client, number), outcome)) = self.snapshots.turn() {
            self.sequencer.remember(client, number, outcome);
        }
        self.go_on_saving(now_ns);
        self.go_on_copying();
    }

    /// Does what a command still asks for.
    pub(super) fn complete(&mut self, replied: Replied) -> Outcome {
        let Some(Effect::Snapshot { path, ledger }) = &replied.effect else {
            return replied.outcome;
        };
        let painting = self.sequencer.painting_mut();
        let ledger = ledger.as_ref();
        let added = self.snapshots.add(Snapshot {
            asker: (replied.client, replied.number),
            path: path.into(),
            ledger: ledger.map(|path| (path.into(), painting.report())),
            still: painting.still(),
            export: self.export.clone(),
        });
        match added {
            Ok(()) => Outcome::Waiting,
            Err(refusal) => {
                let outcome = Outcome::from(refusal);
                self.sequencer
                    .remember(replied.client, replied.number, outcome.clone());
                outcome
            }
        }
    }
}
