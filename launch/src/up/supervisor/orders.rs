//! Requests to the rig as a whole: another painting, another file.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use maulstick_bus::typed::{Reader, Receiver, random_epoch};
use maulstick_bus::{Bus, BusError, Qos, Queue, Request, Server, Wake};
use maulstick_rig::UserError;
use maulstick_types::command::advice::Advice;
use maulstick_types::command::reply_cache::ReplyCache;
use maulstick_types::command::{
    Command, CommandReply, CommandRequest, Outcome, RIG_NODE, RigCommand,
};
use maulstick_types::paint::PaintStatus;
use maulstick_types::wire::topics::Topics;
use maulstick_types::{Flags, Origin, encode, name_hash};

use super::Supervisor;
use super::switch::{Ask, Switch};

/// Requests to the rig, and its replies.
pub(super) struct Orders {
    server: Server,
    reader: Reader,
    me: Origin,
    pub(super) replies: ReplyCache,
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
        Ok(Self {
            server: bus.serve(&topics.command(RIG_NODE), 64, wake)?,
            reader: Reader::default(),
            me: Origin {
                source: name_hash(RIG_NODE),
                epoch: random_epoch(),
            },
            replies: ReplyCache::default(),
            statuses: Receiver::new(bus, &topic, Qos::Background, Queue::Ring(4), wake)?,
            status: None,
            status_ns: 0,
            leaving: Leaving::default(),
        })
    }

    fn answer(&self, bus: &dyn Bus, request: Request, reply: &CommandReply) {
        let now_ns = bus.now_ns();
        match encode(&self.me, Flags::NONE, 0, now_ns, now_ns, reply) {
            Ok(bytes) => {
                if let Err(error) = request.answer(bytes) {
                    tracing::debug!("a client is gone: {error}");
                }
            }
            Err(error) => tracing::error!("a command cannot be answered: {error}"),
        }
    }

    /// True if the paint node has reported its status since this was first requested, where that matters.
    fn has_heard(&mut self, asked: &CommandRequest, now_ns: u64) -> bool {
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

    /// The paint node is another one: what the one before said holds no more.
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

/// True if two names lead to the same file.
pub(super) fn is_same(one: &Path, other: &Path) -> bool {
    let real = |path: &Path| std::fs::canonicalize(path).ok();
    one == other || real(one).is_some_and(|path| real(other) == Some(path))
}

impl Supervisor {
    /// A painting whose file was gone goes on in another one: there it is found again after a crash. One
    /// status alone may be of the node before.
    fn follow_painting(&mut self, path: &str) {
        let before = self.orders.status.as_ref();
        let is_said = before.is_some_and(|before| before.path == path) && !path.is_empty();
        let document = self.config.paint.document.as_deref();
        if !is_said || self.switch.is_some() || document.is_none_or(|own| own == Path::new(path)) {
            return;
        }
        tracing::info!("painting in {path}");
        self.config.paint.document = Some(path.into());
        if let Err(fault) = self.write_config() {
            tracing::warn!("{}: {}", fault.place.unwrap_or_default(), fault.what);
        }
    }

    /// Answers what is asked of the rig.
    pub(super) fn take_orders(&mut self) {
        let bus = Arc::clone(&self.bus);
        while let Some(status) = self.orders.statuses.try_recv() {
            self.follow_painting(&status.message.path);
            self.orders.status = Some(status.message);
            self.orders.status_ns = status.header.event_ns;
        }
        while let Some(request) = self.orders.server.try_recv() {
            let orders = &mut self.orders;
            let asked = match orders.reader.read_command(&request.key, &request.bytes) {
                Ok(asked) => asked,
                Err(reply) => {
                    if let Some(reply) = reply {
                        orders.answer(&*bus, request, &reply);
                    }
                    continue;
                }
            };
            let outcome = match self.orders.replies.find(&asked) {
                Some(outcome) => outcome,
                // It is asked again, and done when its turn comes.
                None if self.switch.is_some() || !self.orders.has_heard(&asked, bus.now_ns()) => {
                    Outcome::Waiting
                }
                None => {
                    self.orders.leaving.0.clear();
                    let outcome = self.order(&asked).unwrap_or_else(refusal);
                    // The rig itself says when a switch is done; a removal is looked at each time.
                    if self.switch.is_some() || outcome != Outcome::Waiting {
                        let replies = &mut self.orders.replies;
                        replies.keep(asked.client, asked.number, outcome.clone());
                    }
                    outcome
                }
            };
            let reply = CommandReply {
                number: asked.number,
                outcome,
            };
            self.orders.answer(&*bus, request, &reply);
        }
    }

    /// Begins to do what is asked.
    fn order(&mut self, asked: &CommandRequest) -> Result<Outcome, UserError> {
        if asked.after.is_some() {
            return Err(UserError::usage("the rig has no journal in which to wait")
                .help("ask without a place in it"));
        }
        let here = self.config.paint.document.clone();
        let command = match &asked.command {
            Command::Rig(command) => command,
            command @ (Command::Edit(_)
            | Command::Take(_)
            | Command::File(_)
            | Command::Brush(_)
            | Command::Session(_)) => return Ok(command.misaddressed()),
        };
        let ask = match command {
            RigCommand::Open { path, forget } => {
                let path = PathBuf::from(path.as_str());
                if here.is_some_and(|here| is_same(&here, &path)) {
                    return Ok(Outcome::done(format!("{} is open already", path.display())));
                }
                self.may_leave(*forget)?;
                Ask::Open(path, *forget)
            }
            RigCommand::New {
                path,
                canvas,
                forget,
            } => {
                self.may_leave(*forget)?;
                let path = path.as_ref().map(|path| PathBuf::from(path.as_str()));
                Ask::New(path, canvas.clone(), *forget)
            }
            RigCommand::PutDevice { toml } => return self.put_device(toml.as_str()),
            RigCommand::RemoveDevice { name } => return self.remove_device(name.as_str()),
            RigCommand::SaveAs(save_as) => {
                if !self.paint_runs() {
                    return Ok(starts_again());
                }
                Ask::SaveAs(save_as.clone())
            }
        };
        self.switch = Some(Switch::begin(self, (asked.client, asked.number), ask)?);
        Ok(Outcome::Waiting)
    }

    /// Sees that the painting may be left.
    pub(super) fn may_leave(&self, forget: bool) -> Result<(), UserError> {
        let status = self.orders.status.as_ref();
        if self.conductor.is_some() || status.is_some_and(|status| status.take) {
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
        let in_memory = self.config.paint.document.is_none();
        let is_blank = status.is_some_and(|status| status.blank);
        match in_memory && !is_blank && !forget {
            true => Err(
                UserError::usage("what was painted is in memory alone, and would be gone")
                    .advise(Advice::SaveOrForget),
            ),
            false => Ok(()),
        }
    }
}

/// Nothing can be asked of a painting that is not there.
pub(super) fn starts_again() -> Outcome {
    Outcome::refused(
        "the paint node is being started just now",
        "wait until the painting is there, and ask again",
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
