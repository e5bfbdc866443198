//! Commands to the paint node: most are the sequencer's, some run in the background.

use maulstick_painting::Effect;
use maulstick_painting::sequencer::Replied;
use maulstick_types::Origin;
use maulstick_types::command::{Command, CommandReply, CommandRequest, FileCommand, Outcome};

use super::PaintNode;

impl PaintNode {
    /// Answers what is asked of the painting.
    pub(super) fn serve_commands(&mut self, now_ns: u64) {
        while let Some((request, asked)) = self.commands.next(&*self.bus) {
            let number = asked.number;
            let outcome = match &asked.command {
                Command::File(command) => self.on_file_command(&asked, command, now_ns),
                Command::Session(command) => {
                    let (session, sequencer) = (&mut self.session, &mut self.sequencer);
                    session.carry_out(command, sequencer, &*self.bus)
                }
                Command::Edit(_) | Command::Take(_) | Command::Brush(_) | Command::Rig(_) => {
                    if self.files.has_snapshot((asked.client, number)) {
                        Outcome::Waiting
                    } else {
                        let replied = self.sequence(asked);
                        self.complete(replied)
                    }
                }
            };
            let reply = CommandReply { number, outcome };
            self.commands.answer(&*self.bus, request, &reply);
        }
    }

    /// Hands a command to the sequencer, with the states that wait of the brush behind which it goes.
    fn sequence(&mut self, asked: CommandRequest) -> Replied {
        self.adopt_brushes();
        let brush = asked.after.as_ref().map(|after| Origin {
            source: after.brush,
            epoch: after.epoch,
        });
        let queued = brush
            .into_iter()
            .flat_map(|brush| self.inputs.queued(brush));
        self.sequencer.command_behind(asked, queued)
    }

    /// Begins what a command about files asks for; it goes on in the background.
    fn on_file_command(
        &mut self,
        asked: &CommandRequest,
        command: &FileCommand,
        now_ns: u64,
    ) -> Outcome {
        if let Some(outcome) = self.commands.find(asked) {
            return outcome;
        }
        let begun = self
            .files
            .begin(asked, command, &mut self.sequencer, now_ns);
        let outcome = begun.unwrap_or_else(Outcome::from);
        let asker = (asked.client, asked.number);
        self.commands.keep(asker, outcome.clone());
        outcome
    }

    /// Keeps the outcomes of background work that has ended.
    pub(super) fn poll_background(&mut self, now_ns: u64) {
        let exported = self.files.poll_export();
        if let Some(((client, number), outcome)) = self.files.poll_snapshots() {
            self.sequencer.remember(client, number, outcome);
        }
        let home = self.files.home_mut();
        let moved = home.poll_move(&mut self.sequencer, now_ns);
        if moved.is_some() {
            self.outputs.hasten_status();
        }
        for (asker, outcome) in [exported, moved, home.poll_copy()].into_iter().flatten() {
            self.commands.keep(asker, outcome);
        }
    }

    /// Does what a command still asks for.
    pub(super) fn complete(&mut self, replied: Replied) -> Outcome {
        let Some(Effect::Snapshot { path, ledger }) = &replied.effect else {
            return replied.outcome;
        };
        let asker = (replied.client, replied.number);
        let paths = (path.as_str(), ledger.as_deref());
        match self.files.snapshot(asker, paths, &mut self.sequencer) {
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
