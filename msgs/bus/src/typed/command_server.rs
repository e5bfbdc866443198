//! Commands to a process of the rig, read and answered.

use maulstick_types::command::reply_cache::ReplyCache;
use maulstick_types::command::{CommandReply, CommandRequest, Outcome};
use maulstick_types::{Flags, Origin, encode};

use super::{Reader, send};
use crate::bus::{Bus, BusError, Request, Server};
use crate::inbox::Wake;

/// Server of the commands to a process; a command that is sent again is answered from its cache.
pub struct CommandServer {
    server: Server,
    reader: Reader,
    replies: ReplyCache,
    me: Origin,
}

impl CommandServer {
    /// A server of `topic` that answers as `me`; at most `queued` requests wait.
    ///
    /// # Errors
    /// [`BusError::Topic`].
    pub fn new(
        bus: &dyn Bus,
        topic: &str,
        queued: usize,
        me: Origin,
        wake: &Wake,
    ) -> Result<Self, BusError> {
        Ok(Self {
            server: bus.serve(topic, queued, wake)?,
            reader: Reader::default(),
            replies: ReplyCache::default(),
            me,
        })
    }

    /// The next command that can be read; the client of one that cannot is answered at once.
    pub fn next(&mut self, bus: &dyn Bus) -> Option<(Request, CommandRequest)> {
        while let Some(request) = self.server.try_recv() {
            match self.reader.read_command(&request.key, &request.bytes) {
                Ok(asked) => return Some((request, asked)),
                Err(Some(reply)) => self.answer(bus, request, &reply),
                Err(None) => {}
            }
        }
        None
    }

    /// The cached answer to this very command, or the refusal of one that comes too late.
    #[must_use]
    pub fn find(&self, asked: &CommandRequest) -> Option<Outcome> {
        self.replies.find(asked)
    }

    /// Keeps the outcome of a command, by client and number.
    pub fn keep(&mut self, (client, number): (u64, u64), outcome: Outcome) {
        self.replies.keep(client, number, outcome);
    }

    /// Answers a command. Nothing that a client sends may end the process: an answer that is too long is shortened.
    pub fn answer(&self, bus: &dyn Bus, request: Request, reply: &CommandReply) {
        let now_ns = bus.now_ns();
        let write = |reply: &CommandReply| encode(&self.me, Flags::NONE, 0, now_ns, now_ns, reply);
        let bytes = write(reply).or_else(|error| {
            tracing::warn!("{}: {error}", request.key);
            write(&CommandReply {
                number: reply.number,
                outcome: Outcome::refused(
                    "the answer to this command is too long",
                    "send shorter names",
                ),
            })
        });
        send(request, bytes);
    }

    /// Number of requests that could not be read.
    #[must_use]
    pub fn refused(&self) -> u64 {
        self.reader.refused()
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use maulstick_types::command::Detail;
    use maulstick_types::decode;

    use super::*;
    use crate::bus::{Answer, Qos};
    use crate::memory::{Faults, MemoryNet};

    #[test]
    fn an_answer_that_does_not_fit_is_given_in_short() {
        let net = MemoryNet::new(1, 1_000_000_000, Faults::default());
        let (bus, wake) = (net.bus(), Wake::new());
        let me = Origin {
            source: 1,
            epoch: 1,
        };
        let server = CommandServer::new(&bus, "t/command/paint", 16, me, &wake).expect("served");
        let limit = Duration::from_secs(1);
        let pending = bus
            .ask("t/command/paint", Qos::Control, Vec::new(), limit, &wake)
            .expect("asked");
        net.advance(1);
        let request = server.server.try_recv().expect("a question");
        let outcome = Outcome::Done {
            journal: 1,
            detail: Detail::say("x".repeat(70_000)),
        };
        server.answer(&bus, request, &CommandReply { number: 5, outcome });
        net.advance(1);
        let answer = pending.try_recv();
        let Some(Answer::Bytes(bytes)) = answer else {
            unreachable!("{answer:?}");
        };
        let reply = decode::<CommandReply>(&bytes).expect("a reply").1;
        assert_eq!(reply.number, 5);
        assert!(matches!(reply.outcome, Outcome::Refused { .. }));
    }
}
