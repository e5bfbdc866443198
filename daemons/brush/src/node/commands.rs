//! Commands to the brush node: a new definition of its brush.

use maulstick_brush::BrushFile;
use maulstick_bus::BusError;
use maulstick_types::command::{BrushCommand, Command, CommandReply, CommandRequest, Outcome};

use super::BrushNode;

impl BrushNode {
    /// Answers what is asked of this brush.
    pub(super) fn serve_commands(&mut self, now_ns: u64) -> Result<(), BusError> {
        while let Some((request, asked)) = self.commands.next(&*self.bus) {
            let asker = (asked.client, asked.number);
            let outcome = match self.commands.find(&asked) {
                Some(outcome) => outcome,
                None if self.definition.is_waiting(asker) => Outcome::Waiting,
                None => {
                    let outcome = self.command(&asked, now_ns)?;
                    if outcome != Outcome::Waiting {
                        self.commands.keep(asker, outcome.clone());
                    }
                    outcome
                }
            };
            let number = asked.number;
            let reply = CommandReply { number, outcome };
            self.commands.answer(&*self.bus, request, &reply);
        }
        Ok(())
    }

    /// Does a command; a refused one changes nothing. A brush is adopted at its place among the strokes.
    fn command(&mut self, asked: &CommandRequest, now_ns: u64) -> Result<Outcome, BusError> {
        if asked.after.is_some() {
            return Ok(Outcome::refused(
                "a brush has no journal in which to wait",
                "send the command without a position in the journal",
            ));
        }
        let BrushCommand::Define { brush, toml } = match &asked.command {
            Command::Brush(command) => command,
            command @ (Command::Edit(_)
            | Command::Take(_)
            | Command::File(_)
            | Command::Rig(_)
            | Command::Session(_)) => return Ok(command.misaddressed()),
        };
        if brush != self.definition.brush() {
            return Ok(asked.command.misaddressed());
        }
        let file = match BrushFile::parse(toml) {
            Ok(file) => file,
            Err(error) => {
                return Ok(Outcome::refused(
                    error.to_string(),
                    "correct the brush file",
                ));
            }
        };
        if self.solver.is_down() || self.devices.is_held() {
            return Ok(Outcome::refused(
                "the brush is painting",
                "lift it, or let the take end, and ask again",
            ));
        }
        let asker = (asked.client, asked.number);
        if let Some(earlier) = self.definition.request(asker, file, now_ns) {
            self.commands.keep(earlier, Outcome::done(""));
        }
        Ok(if self.adopt_brush(now_ns)? {
            Outcome::done("")
        } else {
            Outcome::Waiting
        })
    }

    /// Adopts the requested brush once the strokes before it are painted; true if it did.
    pub(super) fn adopt_brush(&mut self, now_ns: u64) -> Result<bool, BusError> {
        self.definition.hold_from(self.hold.since_ns(now_ns));
        // A stroke on its way to the painting belongs to the brush that is in hand.
        if self.solver.is_touching() || self.output.has_contact_under_way() {
            return Ok(false);
        }
        let oldest_ns = self.solver.oldest_ns();
        let Some((asker, file)) = self.definition.adopt(oldest_ns, now_ns)? else {
            return Ok(false);
        };
        self.solver.adopt(file);
        self.commands.keep(asker, Outcome::done(""));
        Ok(true)
    }
}
