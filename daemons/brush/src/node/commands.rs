//! Commands to the brush node: a new definition of its brush.

use maulstick_brush::BrushFile;
use maulstick_bus::{Announcer, BusError, Request};
use maulstick_types::brush::BrushDef;
use maulstick_types::command::{BrushCommand, Command, CommandReply, CommandRequest, Outcome};
use maulstick_types::{Flags, encode, name_hash};

use super::BrushNode;
use super::pace::Pace;

/// Announces the definition of a brush.
pub(super) fn define(
    def: &mut Announcer<BrushDef>,
    now_ns: u64,
    name: &str,
    file: &BrushFile,
) -> Result<(), BusError> {
    let toml = file.to_toml().map_err(|error| BusError::Topic {
        topic: name.to_owned(),
        reason: error.to_string(),
    })?;
    let hash = name_hash(&toml);
    let message = BrushDef {
        brush: name.to_owned(),
        toml,
        hash,
        head_length_m: file.length_m(),
    };
    def.send(now_ns, &message)
}

impl BrushNode {
    /// Answers what is asked of this brush.
    pub(super) fn serve_commands(&mut self, now_ns: u64) -> Result<(), BusError> {
        while let Some(request) = self.commands.try_recv() {
            let asked = match self.reader.read_command(&request.key, &request.bytes) {
                Ok(asked) => asked,
                Err(reply) => {
                    if let Some(reply) = reply {
                        self.answer(request, now_ns, &reply);
                    }
                    continue;
                }
            };
            let outcome = match self.replies.find(&asked) {
                Some(outcome) => outcome,
                None => {
                    let outcome = self.command(&asked, now_ns)?;
                    self.replies
                        .keep(asked.client, asked.number, outcome.clone());
                    outcome
                }
            };
            let reply = CommandReply {
                number: asked.number,
                outcome,
            };
            self.answer(request, now_ns, &reply);
        }
        Ok(())
    }

    fn answer(&self, request: Request, now_ns: u64, reply: &CommandReply) {
        let me = self.states.origin();
        match encode(&me, Flags::NONE, 0, now_ns, now_ns, reply) {
            Ok(bytes) => {
                if let Err(error) = request.answer(bytes) {
                    tracing::debug!("a client is gone: {error}");
                }
            }
            Err(error) => tracing::error!("a command cannot be answered: {error}"),
        }
    }

    /// Does a command; a refused one changes nothing.
    fn command(&mut self, asked: &CommandRequest, now_ns: u64) -> Result<Outcome, BusError> {
        let refused = |what: String, help: &str| Ok(Outcome::refused(what, help));
        if asked.after.is_some() {
            let what = "a brush has no journal in which to wait".to_owned();
            return refused(what, "ask without a place in it");
        }
        let command = match &asked.command {
            Command::Brush(command) => command,
            command @ (Command::Edit(_)
            | Command::Take(_)
            | Command::File(_)
            | Command::Rig(_)
            | Command::Session(_)) => {
                return Ok(command.misaddressed());
            }
        };
        let BrushCommand::Define { brush, toml } = command;
        if *brush != *self.settings.name {
            return Ok(asked.command.misaddressed());
        }
        let file = match BrushFile::parse(toml) {
            Ok(file) => file,
            Err(error) => return refused(error.to_string(), "correct the brush file"),
        };
        // A stroke on its way to the painting belongs to the brush that is in hand.
        let painted = self.states.next_seq() - self.states.outstanding();
        let under_way = self.newest_contact.is_some_and(|state| state >= painted);
        if self.touching || self.is_held() || under_way || !self.backlog.is_empty() {
            let what = "the brush is painting".to_owned();
            return refused(what, "lift it, or let the take end, and ask again");
        }
        define(&mut self.def, now_ns, &self.settings.name, &file)?;
        self.backlog.take_up(file.length_m());
        self.pace = Pace::default();
        self.model.take_up(file);
        Ok(Outcome::done(""))
    }
}
