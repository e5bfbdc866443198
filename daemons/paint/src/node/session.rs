//! A recorded session that is painted again, in batches of a client.

use maulstick_bus::Bus;
use maulstick_document::journal;
use maulstick_painting::Sequencer;
use maulstick_types::command::{Outcome, SessionCommand};

/// Time without a command after which the hands have the painting again, ns.
const SILENCE_NS: u64 = 10_000_000_000;

/// A session that is being painted.
#[derive(Clone, Debug)]
struct Running {
    /// Number of the player; `None` until it comes.
    number: Option<u64>,
    /// Number of the next batch.
    batch: u64,
    /// Answer to the batch before it, which is asked again where it was lost.
    answer: Outcome,
    /// When something came of it last, ns.
    heard_ns: u64,
}

impl Running {
    /// A session at its beginning.
    fn new(number: Option<u64>, now_ns: u64) -> Self {
        Self {
            number,
            batch: 0,
            answer: Outcome::done(""),
            heard_ns: now_ns,
        }
    }
}

/// The session that is painted again, if one is.
#[derive(Debug)]
pub(super) struct RepeatedSession(Option<Running>);

impl RepeatedSession {
    /// The session of a node that begins, perhaps in the middle of one.
    pub(super) fn new(is_repeating: bool, now_ns: u64) -> Self {
        Self(is_repeating.then(|| Running::new(None, now_ns)))
    }

    /// True while the hands do not have the painting.
    pub(super) fn is_running(&self) -> bool {
        self.0.is_some()
    }

    /// Carries out a command about a session.
    pub(super) fn carry_out(
        &mut self,
        command: &SessionCommand,
        sequencer: &mut Sequencer,
        bus: &dyn Bus,
    ) -> Outcome {
        let own = self.0.as_ref().and_then(|session| session.number);
        match command {
            SessionCommand::Begin { session } if own.is_none_or(|own| own == *session) => {
                if own.is_none() {
                    self.0 = Some(Running::new(Some(*session), bus.now_ns()));
                }
                sequencer.begin_repeating();
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
                self.accept(*batch, records, sequencer, bus)
            }
            SessionCommand::End { session } => {
                if own == Some(*session) {
                    self.end(sequencer);
                }
                Outcome::done("")
            }
        }
    }

    /// Paints a batch, unless that is done already.
    fn accept(
        &mut self,
        batch: u64,
        records: &[u8],
        sequencer: &mut Sequencer,
        bus: &dyn Bus,
    ) -> Outcome {
        let Some(session) = &mut self.0 else {
            return Outcome::done("");
        };
        if batch >= session.batch {
            session.batch = batch + 1;
            session.answer = repeat(records, sequencer);
        }
        // A batch may have taken long.
        session.heard_ns = bus.now_ns();
        session.answer.clone()
    }

    fn end(&mut self, sequencer: &mut Sequencer) {
        self.0 = None;
        sequencer.end_repeating();
    }

    /// Gives the painting back to the hands where the player is gone.
    pub(super) fn check(&mut self, sequencer: &mut Sequencer, now_ns: u64) {
        let silent_ns = |session: &Running| now_ns.saturating_sub(session.heard_ns);
        if self.0.as_ref().map(silent_ns) > Some(SILENCE_NS) {
            tracing::warn!("the player of the session is silent: the hands paint again");
            self.end(sequencer);
        }
    }
}

/// Paints records of a session.
fn repeat(records: &[u8], sequencer: &mut Sequencer) -> Outcome {
    let records = match journal::read(0, records) {
        Ok(records) => records,
        Err(error) => {
            return Outcome::refused(error.to_string(), "send records as this version has them");
        }
    };
    for record in records {
        if let Err(error) = sequencer.repeat(record) {
            return error.into();
        }
    }
    Outcome::done("")
}
