//! A recorded session that is painted again, in batches of a client.

use maulstick_document::journal;
use maulstick_types::command::{Outcome, SessionCommand};

use super::PaintNode;

/// Time without a command after which the hands have the painting again, ns.
const SILENCE_NS: u64 = 10_000_000_000;

/// A session that is painted again.
#[derive(Clone, Debug)]
pub(super) struct Repetition {
    /// Number of the player; `None` until it comes.
    number: Option<u64>,
    /// Number of the next batch.
    batch: u64,
    /// Answer to the batch before it, which is asked again where it was lost.
    answer: Outcome,
    /// When something came of it last, ns.
    heard_ns: u64,
}

impl Repetition {
    /// A session at its beginning.
    pub(super) fn new(number: Option<u64>, now_ns: u64) -> Self {
        Self {
            number,
            batch: 0,
            answer: Outcome::done(""),
            heard_ns: now_ns,
        }
    }
}

impl PaintNode {
    /// Carries out a command about a session.
    pub(super) fn repeat(&mut self, command: &SessionCommand, now_ns: u64) -> Outcome {
        let own = self.session.as_ref().and_then(|session| session.number);
        match command {
            SessionCommand::Begin { session } if own.is_none_or(|own| own == *session) => {
                match own {
                    Some(_) => {}
                    None => self.session = Some(Repetition::new(Some(*session), now_ns)),
                }
                self.sequencer.begin_repeating();
                Outcome::done("")
            }
            SessionCommand::Begin { .. } => Outcome::refused(
                "another recorded session is being painted",
                "end that `maulstick recording replay` first",
            ),
            SessionCommand::Repeat { session, .. } if own != Some(*session) => Outcome::refused(
                "the painting is not that of this session any more",
                "play the session anew",
            ),
            SessionCommand::Repeat { batch, records, .. } => {
                self.repeat_batch(*batch, records, now_ns)
            }
            SessionCommand::End { session } => {
                if own == Some(*session) {
                    self.end_session();
                }
                Outcome::done("")
            }
        }
    }

    fn repeat_batch(&mut self, batch: u64, records: &[u8], now_ns: u64) -> Outcome {
        let Some(session) = &mut self.session else {
            return Outcome::done("");
        };
        if batch < session.batch {
            session.heard_ns = now_ns;
            return session.answer.clone();
        }
        session.batch = batch + 1;
        let answer = self.accept_batch(records);
        // A batch may have taken long.
        let now_ns = self.bus.now_ns();
        if let Some(session) = &mut self.session {
            (session.answer, session.heard_ns) = (answer.clone(), now_ns);
        }
        answer
    }

    fn accept_batch(&mut self, records: &[u8]) -> Outcome {
        let records = match journal::read(0, records) {
            Ok(records) => records,
            Err(error) => {
                return Outcome::refused(
                    error.to_string(),
                    "send records as this version has them",
                );
            }
        };
        for record in records {
            if let Err(error) = self.sequencer.repeat(record) {
                return error.into();
            }
        }
        Outcome::done("")
    }

    fn end_session(&mut self) {
        self.session = None;
        self.sequencer.end_repeating();
    }

    /// Gives the painting back to the hands where the player is gone.
    pub(super) fn check_repeating(&mut self, now_ns: u64) {
        let silent_ns = |session: &Repetition| now_ns.saturating_sub(session.heard_ns);
        if self.session.as_ref().map(silent_ns) > Some(SILENCE_NS) {
            tracing::warn!("the player of the session is silent: the hands paint again");
            self.end_session();
        }
    }
}
