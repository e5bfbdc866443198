//! Requests to the rig as a whole: another painting, another file.

use std::collections::BTreeMap;
use std::path::PathBuf;

use maulstick_bus::typed::{CommandServer, Receiver, random_epoch};
use maulstick_bus::{Bus, BusError, Qos, Queue, Request, Wake};
use maulstick_rig::{RigConfig, UserError};
use maulstick_types::command::advice::Advice;
use maulstick_types::command::{
    Command, CommandReply, CommandRequest, Outcome, RIG_NODE, RigCommand,
};
use maulstick_types::paint::PaintStatus;
use maulstick_types::wire::topics::Topics;
use maulstick_types::{Origin, name_hash};

use crate::up::plan::Hands;

/// Greatest number of waiting requests.
const QUEUED: usize = 64;

/// Requests to the rig, and its replies.
pub(super) struct Orders {
    pub(super) commands: CommandServer,
    statuses: Receiver<PaintStatus>,
    status: Option<PaintStatus>,
    /// Time of that status, rig clock, ns.
    status_ns: u64,
    leaving: Leaving,
}

/// Clients that want to leave the painting, with the time at which they first asked, ns.
#[derive(Debug, Default)]
struct Leaving(BTreeMap<(u64, u64), u64>);

impl Leaving {
    /// True if the paint node's newest status is later than the client's first request.
    fn has_heard(&mut self, asker: (u64, u64), now_ns: u64, status_ns: u64) -> bool {
        status_ns > *self.0.entry(asker).or_insert(now_ns)
    }
}

impl Orders {
    /// Server of the commands to the rig.
    ///
    /// # Errors
    /// [`BusError::Topic`].
    pub(super) fn new(bus: &dyn Bus, topics: &Topics, wake: &Wake) -> Result<Self, BusError> {
        let topic = topics.paint_status();
        let me = Origin {
            source: name_hash(RIG_NODE),
            epoch: random_epoch(),
        };
        Ok(Self {
            commands: CommandServer::new(bus, &topics.command(RIG_NODE), QUEUED, me, wake)?,
            statuses: Receiver::new(bus, &topic, Qos::Background, Queue::Ring(4), wake)?,
            status: None,
            status_ns: 0,
            leaving: Leaving::default(),
        })
    }

    /// The next request that is none of those answered before.
    pub(super) fn next(&mut self, bus: &dyn Bus) -> Option<(Request, CommandRequest)> {
        loop {
            let (request, asked) = self.commands.next(bus)?;
            let Some(outcome) = self.commands.find(&asked) else {
                return Some((request, asked));
            };
            let number = asked.number;
            self.commands
                .answer(bus, request, &CommandReply { number, outcome });
        }
    }

    /// Reads the statuses of the paint node: returns the painting's file, once two in a row name it. One alone may be
    /// from the previous node.
    pub(super) fn follow_paint(&mut self) -> Option<PathBuf> {
        let mut file = None;
        while let Some(status) = self.statuses.try_recv() {
            let before = self.status.as_ref().map(|before| before.path.clone());
            let path = &status.message.path;
            if before.as_ref() == Some(path) && !path.is_empty() {
                file = Some(PathBuf::from(path));
            }
            self.status_ns = status.header.event_ns;
            self.status = Some(status.message);
        }
        file
    }

    /// Marks a request as carried out; other clients that want to leave ask again.
    pub(super) fn begin(&mut self) {
        self.leaving.0.clear();
    }

    /// Checks that a painting in these settings may be left; `hands` tells whether a take is played.
    ///
    /// # Errors
    /// A [`UserError`] with advice where something would be lost.
    pub(super) fn may_leave(
        &self,
        config: &RigConfig,
        hands: Hands,
        forget: bool,
    ) -> Result<(), UserError> {
        let status = self.status.as_ref();
        if hands == Hands::Take || status.is_some_and(|status| status.take) {
            return Err(
                UserError::usage("a take is being played into this painting")
                    .help("wait for its end, or end its player, and ask again"),
            );
        }
        if let Some(export) = status.and_then(|status| status.export.as_ref()) {
            return Err(
                UserError::usage(format!("{} is being exported", export.path))
                    .advise(Advice::StopExport),
            );
        }
        let in_memory = config.paint.document.is_none();
        let is_blank = status.is_some_and(|status| status.blank);
        if in_memory && !is_blank && !forget {
            return Err(
                UserError::usage("what was painted is in memory alone, and would be gone")
                    .advise(Advice::SaveOrForget),
            );
        }
        Ok(())
    }

    /// True if the paint node has reported its status since this was first requested, where that matters.
    pub(super) fn has_heard(&mut self, asked: &CommandRequest, now_ns: u64) -> bool {
        let asker = (asked.client, asked.number);
        match asked.command {
            Command::Rig(RigCommand::Open { .. } | RigCommand::New { .. }) => {
                self.leaving.has_heard(asker, now_ns, self.status_ns)
            }
            Command::Rig(
                RigCommand::SaveAs(_)
                | RigCommand::PutDevice { .. }
                | RigCommand::RemoveDevice { .. },
            )
            | Command::Edit(_)
            | Command::Take(_)
            | Command::File(_)
            | Command::Brush(_)
            | Command::Session(_) => true,
        }
    }

    /// Forgets the status of the previous paint node.
    pub(super) fn forget_status(&mut self) {
        while self.statuses.try_recv().is_some() {}
        self.status = None;
    }
}

/// A fault as the refusal that a client receives.
pub(super) fn refusal(fault: UserError) -> Outcome {
    let what = match &fault.place {
        Some(place) => format!("{place}: {}", fault.what),
        None => fault.what,
    };
    let advice = fault.advice;
    Outcome::Refused {
        what,
        advice: advice.unwrap_or_else(|| Advice::say(fault.help.unwrap_or_default())),
    }
}

/// Nothing can be asked of a painting that is not there.
pub(super) fn starts_again() -> Outcome {
    Outcome::refused(
        "the paint node is being started just now",
        "wait until the painting is open, then repeat the command",
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_who_want_to_leave_do_not_hold_each_other_up() {
        let mut leaving = Leaving::default();
        assert!(!leaving.has_heard((1, 1), 50, 45) && !leaving.has_heard((2, 1), 60, 45));
        assert!(leaving.has_heard((1, 1), 70, 55) && !leaving.has_heard((2, 1), 70, 55));
        assert!(leaving.has_heard((2, 1), 80, 65));
    }
}
