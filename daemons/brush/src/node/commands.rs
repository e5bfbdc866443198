//! Commands to the brush node: a new definition of its brush.

use maulstick_brush::BrushFile;
use maulstick_bus::{Announcer, BusError};
use maulstick_types::brush::BrushDef;
use maulstick_types::command::{BRUSH_FILE_MAX, Command, CommandReply, CommandRequest, Outcome};
use maulstick_types::{Flags, encode, name_hash};

use super::BrushNode;
use super::pace::Pace;
use crate::path_simplifier::PathSimplifier;

/// The reason why a command was not done, with advice.
struct Refusal {
    what: String,
    help: &'static str,
}

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
    };
    def.send(now_ns, &message)
}

impl BrushNode {
    /// Answers what is asked of this brush.
    pub(super) fn serve_commands(&mut self, now_ns: u64) -> Result<(), BusError> {
        while let Some(request) = self.commands.try_recv() {
            let read = self
                .reader
                .read::<CommandRequest>(&request.key, &request.bytes);
            let Some((_, asked)) = read else { continue };
            let outcome = match self.replies.find(&asked) {
                Some(outcome) => outcome,
                None => {
                    let outcome = match self.command(&asked, now_ns)? {
                        Ok(()) => Outcome::Done {
                            journal: 0,
                            detail: String::new(),
                        },
                        Err(refusal) => Outcome::Refused {
                            what: refusal.what,
                            help: refusal.help.to_owned(),
                        },
                    };
                    self.replies
                        .keep(asked.client, asked.number, outcome.clone());
                    outcome
                }
            };
            let reply = CommandReply {
                number: asked.number,
                outcome,
            };
            let me = self.states.origin();
            match encode(&me, Flags::NONE, 0, now_ns, now_ns, &reply) {
                Ok(bytes) => {
                    if let Err(error) = request.answer(bytes) {
                        tracing::debug!("a client is gone: {error}");
                    }
                }
                Err(error) => tracing::error!("a command cannot be answered: {error}"),
            }
        }
        Ok(())
    }

    /// Does a command; a refused one changes nothing.
    fn command(
        &mut self,
        asked: &CommandRequest,
        now_ns: u64,
    ) -> Result<Result<(), Refusal>, BusError> {
        let refused = |what: String, help| Ok(Err(Refusal { what, help }));
        if asked.after.is_some() {
            let what = "a brush has no journal in which to wait".to_owned();
            return refused(what, "ask without a place in it");
        }
        let checked = asked.command.check();
        let toml = match &asked.command {
            _ if checked.is_err() => {
                return refused(checked.err().unwrap_or_default(), "correct the command");
            }
            Command::Define { brush, toml } if *brush == self.settings.name => toml,
            Command::Define { brush, .. } => {
                let what = format!("this is brush '{}', not '{brush}'", self.settings.name);
                return refused(what, "send it to that brush's node");
            }
            _ => {
                let what = "this is no matter of the brush".to_owned();
                return refused(what, "send it to the paint node");
            }
        };
        let file = match BrushFile::parse(toml) {
            Ok(file) => file,
            Err(error) => return refused(error.to_string(), "correct the brush file"),
        };
        let told = file.to_toml().map_or(usize::MAX, |toml| toml.len());
        if told > BRUSH_FILE_MAX {
            let what = format!("the brush file would be {told} bytes long");
            return refused(what, "make its skin of fewer faces and weights");
        }
        // A stroke on its way to the painting belongs to the brush that is in hand.
        let painted = self.states.next_seq() - self.states.outstanding();
        let under_way = self.newest_contact.is_some_and(|state| state >= painted);
        if self.touching || self.is_held() || under_way || !self.backlog.is_empty() {
            let what = "the brush is painting".to_owned();
            return refused(what, "lift it, or let the take end, and ask again");
        }
        define(&mut self.def, now_ns, &self.settings.name, &file)?;
        (self.backlog, self.pace) = (PathSimplifier::new(file.length_m()), Pace::default());
        self.model.take_up(file);
        Ok(Ok(()))
    }
}
