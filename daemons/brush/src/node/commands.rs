//! Commands to the brush node: a new definition of its brush.

use maulstick_brush::BrushFile;
use maulstick_bus::{Announcer, BusError, Request};
use maulstick_types::brush::BrushDef;
use maulstick_types::command::{BrushCommand, Command, CommandReply, CommandRequest, Outcome};
use maulstick_types::{Flags, encode, name_hash};

use super::BrushNode;
use crate::path_simplifier::Place;

/// A file that the painting does not say it has is told again after this time, ns.
const AGAIN_NS: u64 = 100_000_000;
/// For so long the painting is asked to have a file, ns.
const TELLING_NS: u64 = 500_000_000;

/// A brush that was asked for.
#[derive(Debug)]
pub(super) struct AskedBrush {
    /// Client and number of the command.
    asker: (u64, u64),
    file: BrushFile,
    since_ns: u64,
}

impl AskedBrush {
    /// Strokes that begin later are painted with it, rig clock, ns.
    pub(super) fn since_ns(&self) -> u64 {
        self.since_ns
    }
}

/// A brush file on its way to the painting, which paints what comes before it with the one before.
#[derive(Debug)]
pub(super) struct ToldFile {
    /// Its FNV-1a.
    pub(super) hash: u32,
    file: BrushFile,
    asked_ns: u64,
    /// When it was told first, and when last, ns.
    told_ns: [u64; 2],
}

impl ToldFile {
    /// As of [`AskedBrush::since_ns`]; a painting that does not say that it has the file is not waited for.
    pub(super) fn since_ns(&self, now_ns: u64) -> Option<u64> {
        (now_ns < self.told_ns[0].saturating_add(TELLING_NS)).then_some(self.asked_ns)
    }
}

/// Announces the definition of a brush; returns the FNV-1a of its file.
pub(super) fn define(
    def: &mut Announcer<BrushDef>,
    now_ns: u64,
    name: &str,
    file: &BrushFile,
) -> Result<u32, BusError> {
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
    def.send(now_ns, &message)?;
    Ok(hash)
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
                None if self.waits(&asked) => Outcome::Waiting,
                None => {
                    let outcome = self.command(&asked, now_ns)?;
                    if outcome != Outcome::Waiting {
                        self.replies
                            .keep(asked.client, asked.number, outcome.clone());
                    }
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

    /// True if a brush is asked for again that will be taken up.
    fn waits(&self, asked: &CommandRequest) -> bool {
        let pending = self.asked_brush.as_ref();
        pending.is_some_and(|pending| pending.asker == (asked.client, asked.number))
    }

    /// True while the hand has the brush on a surface: its newest sample says so.
    fn is_down(&self) -> bool {
        match self.backlog.last() {
            Some(newest) if newest.place == Place::Air => false,
            _ => self.touching,
        }
    }

    /// Takes up the brush that was asked for, once the strokes before are painted; true if it was.
    pub(super) fn take_up_asked_brush(&mut self, now_ns: u64) -> Result<bool, BusError> {
        let held_ns = self.hold.since_ns(now_ns);
        if let (Some(asked), Some(held_ns)) = (&mut self.asked_brush, held_ns) {
            // A stroke that is held for it is not one before it, whenever that is heard.
            asked.since_ns = asked.since_ns.min(held_ns);
        }
        // A stroke on its way to the painting belongs to the brush that is in hand.
        let painted = self.states.next_seq() - self.states.outstanding();
        let under_way = self.newest_contact.is_some_and(|state| state >= painted);
        let is_before = |asked: &AskedBrush| {
            let first = self.backlog.first();
            first.is_some_and(|first| first.event_ns <= asked.since_ns)
        };
        if self.touching || under_way || self.asked_brush.as_ref().is_none_or(is_before) {
            return Ok(false);
        }
        let Some(AskedBrush {
            asker,
            file,
            since_ns,
        }) = self.asked_brush.take()
        else {
            return Ok(false);
        };
        let hash = define(&mut self.def, now_ns, &self.settings.name, &file)?;
        self.told_file = Some(ToldFile {
            hash,
            file: file.clone(),
            asked_ns: since_ns,
            told_ns: [now_ns; 2],
        });
        self.backlog.set_head_length(file.length_m());
        self.model.take_up(file);
        self.replies.keep(asker.0, asker.1, Outcome::done(""));
        Ok(true)
    }

    /// Tells a file again that the painting may have missed, and waits for it no longer where nobody says that it is there.
    pub(super) fn tell_file_again(&mut self, now_ns: u64) -> Result<(), BusError> {
        let is_over = |told: &mut ToldFile| told.since_ns(now_ns).is_none();
        self.told_file.take_if(is_over);
        let Some(told) = &mut self.told_file else {
            return Ok(());
        };
        if now_ns >= told.told_ns[1].saturating_add(AGAIN_NS) {
            told.told_ns[1] = now_ns;
            define(&mut self.def, now_ns, &self.settings.name, &told.file)?;
        }
        Ok(())
    }

    /// Does a command; a refused one changes nothing. A brush is taken up at its place among the strokes.
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
        if self.is_down() || self.is_held() {
            let what = "the brush is painting".to_owned();
            return refused(what, "lift it, or let the take end, and ask again");
        }
        let asked = AskedBrush {
            asker: (asked.client, asked.number),
            file,
            since_ns: now_ns,
        };
        // Of two between the same strokes the later one is taken up.
        if let Some(before) = self.asked_brush.replace(asked) {
            let (client, number) = before.asker;
            self.replies.keep(client, number, Outcome::done(""));
        }
        match self.take_up_asked_brush(now_ns)? {
            true => Ok(Outcome::done("")),
            false => Ok(Outcome::Waiting),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{MS, node, order, waiting};
    use super::*;

    #[test]
    fn a_stroke_that_is_held_for_a_brush_is_not_before_it_though_that_is_heard_later() {
        let (mut node, _) = node();
        node.asked_brush = Some(AskedBrush {
            asker: (1, 1),
            file: BrushFile::library("flat").expect("flat"),
            since_ns: 1100 * MS,
        });
        node.backlog.push(waiting(1060 * MS, 0.0, 0.4));
        let taken_up = node.take_up_asked_brush(1110 * MS).expect("a bus");
        assert!(!taken_up, "the stroke is before it");
        node.hold.hear(&order(1), 1050 * MS, 1120 * MS);
        assert!(node.take_up_asked_brush(1130 * MS).expect("a bus"));
        let told = node.told_file.as_ref().map(|told| told.asked_ns);
        assert_eq!(told, Some(1050 * MS), "the stroke waits for the painting");
    }
}
