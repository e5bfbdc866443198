//! Commands to a node, repeated with the same number until they are answered.

use std::sync::Arc;
use std::time::{Duration, Instant};

use maulstick_bus::typed::{ask, random_epoch, random_u64};
use maulstick_bus::{Bus, BusError, Qos};
use maulstick_types::command::{
    After, Command, CommandReply, CommandRequest, Detail, Outcome, TakeCommand,
};
use maulstick_types::wire::topics::Topics;
use maulstick_types::{Origin, name_hash};

use crate::user_error::UserError;

/// Time after which an unanswered command is sent again.
const ASK: Duration = Duration::from_secs(2);

/// A command that is done.
#[derive(Clone, Debug, PartialEq)]
pub struct Done {
    /// Its index in the painting's journal; 0 of one that is not in it.
    pub journal: u64,
    /// File that it wrote, or value that it found.
    pub detail: Detail,
}

/// Client that sends commands to a node.
pub struct CommandClient {
    bus: Arc<dyn Bus>,
    topic: String,
    client: u64,
    number: u64,
    me: Origin,
    ask: Duration,
}

impl CommandClient {
    /// Client of the paint node, with a number of its own.
    #[must_use]
    pub fn new(bus: Arc<dyn Bus>, topics: &Topics) -> Self {
        Self::of(bus, topics, "paint")
    }

    /// Client of another node.
    #[must_use]
    pub fn of(bus: Arc<dyn Bus>, topics: &Topics, node: &str) -> Self {
        let me = Origin {
            source: name_hash("commander"),
            epoch: random_epoch(),
        };
        Self {
            bus,
            topic: topics.command(node),
            client: random_u64(),
            number: 0,
            me,
            ask: ASK,
        }
    }

    /// Sends again after `ask` instead of two seconds, for a process that may have to stop soon.
    #[must_use]
    pub fn asking(mut self, ask: Duration) -> Self {
        self.ask = ask;
        self
    }

    /// Sends a command and waits until it is done or refused, at most for `patience`; gives up early on `stop`.
    ///
    /// # Errors
    /// A [`UserError`] with the node's own words if it is refused, or if nobody answers.
    pub fn send(
        &mut self,
        command: impl Into<Command>,
        after: Option<After>,
        patience: Duration,
        stop: &dyn Fn() -> bool,
    ) -> Result<Detail, UserError> {
        let done = self.carry_out(command, after, patience, stop)?;
        Ok(done.detail)
    }

    /// The same, with the place that the command has in the painting's journal.
    ///
    /// # Errors
    /// As [`Self::send`].
    pub fn carry_out(
        &mut self,
        command: impl Into<Command>,
        after: Option<After>,
        patience: Duration,
        stop: &dyn Fn() -> bool,
    ) -> Result<Done, UserError> {
        self.number += 1;
        let request = CommandRequest {
            client: self.client,
            number: self.number,
            after,
            command: command.into(),
        };
        let give_up = Instant::now() + patience;
        loop {
            let asked = Instant::now();
            match self.outcome(&request, self.ask.min(patience))? {
                Outcome::Done { journal, detail } => return Ok(Done { journal, detail }),
                Outcome::Refused { what, advice } => {
                    let refusal = refusal(&request.command, what);
                    return Err(refusal.at(self.topic.clone()).advise(advice));
                }
                Outcome::Waiting => {}
            }
            if Instant::now() >= give_up || stop() {
                return Err(UserError::failure("the node does not answer")
                    .at(self.topic.clone())
                    .help("check that it is running"));
            }
            // A node that is not there yet answers at once with nothing.
            std::thread::sleep(Duration::from_millis(20).saturating_sub(asked.elapsed()));
        }
    }

    /// Outcome of a request within a time; one without an answer waits.
    fn outcome(&self, request: &CommandRequest, limit: Duration) -> Result<Outcome, UserError> {
        let (bus, topic) = (&*self.bus, &self.topic);
        match ask::<_, CommandReply>(bus, topic, Qos::Control, self.me, request, limit) {
            Ok(reply) => Ok(reply.outcome),
            Err(BusError::NoAnswer { .. }) => Ok(Outcome::Waiting),
            Err(error) => Err(error.into()),
        }
    }
}

/// Error of a refused command: a failure at the end of a take, or of a write, is not wrong usage.
fn refusal(command: &Command, what: String) -> UserError {
    match command {
        Command::Take(TakeCommand::Snapshot { .. } | TakeCommand::Mark) => UserError::failure(what),
        Command::Take(TakeCommand::Begin { .. })
        | Command::Edit(_)
        | Command::File(_)
        | Command::Brush(_)
        | Command::Rig(_)
        | Command::Session(_) => UserError::usage(what),
    }
}
