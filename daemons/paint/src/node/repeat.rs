//! A recorded session that is painted again, in batches of a client.

use maulstick_document::journal;
use maulstick_types::command::{CommandRequest, Outcome, SessionCommand};

use super::PaintNode;

/// Time without a batch after which the hands have the painting again, ns.
const SILENCE_NS: u64 = 10_000_000_000;

impl PaintNode {
    /// Carries out a command about a session, once.
    pub(super) fn repeat(
        &mut self,
        asked: &CommandRequest,
        command: &SessionCommand,
        now_ns: u64,
    ) -> Outcome {
        if let Some(outcome) = self.replies.find(asked) {
            return outcome;
        }
        let outcome = match command {
            SessionCommand::Repeat { records } => self.repeat_batch(records, now_ns),
            SessionCommand::End => {
                self.sequencer.end_repeating();
                Outcome::done("")
            }
        };
        self.replies
            .keep(asked.client, asked.number, outcome.clone());
        outcome
    }

    fn repeat_batch(&mut self, records: &[u8], now_ns: u64) -> Outcome {
        let records = match journal::read(0, records) {
            Ok(records) => records,
            Err(error) => {
                return Outcome::refused(
                    error.to_string(),
                    "send records as this version has them",
                );
            }
        };
        self.repeated_ns = now_ns;
        for record in records {
            if let Err(error) = self.sequencer.repeat(record) {
                return error.into();
            }
        }
        Outcome::done("")
    }

    /// Gives the painting back to the hands where the client is gone.
    pub(super) fn check_repeating(&mut self, now_ns: u64) {
        let is_silent = now_ns.saturating_sub(self.repeated_ns) > SILENCE_NS;
        if self.sequencer.is_repeating() && is_silent {
            tracing::warn!("the player of the session is silent: the hands paint again");
            self.sequencer.end_repeating();
        }
    }
}
