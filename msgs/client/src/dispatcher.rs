//! Dispatcher of requests: a queue and a thread for each process, so that none waits for another and the caller for
//! none.

mod outcomes;

use std::collections::{BTreeMap, VecDeque};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use maulstick_bus::typed::{ask, random_epoch};
use maulstick_bus::{Bus, Qos, Wake};
use maulstick_rig::command_client::CommandClient;
use maulstick_rig::thread::try_start;
use maulstick_rig::{UserError, asker};
use maulstick_types::command::{Command, Detail, FileCommand};
use maulstick_types::haptics::{ForceOrder, ForceReply, ForceRequest};
use maulstick_types::wire::topics::Topics;
use maulstick_types::{Origin, name_hash};

use outcomes::Outcomes;

use crate::request::{Peer, Request};
use crate::stroke_barrier::Ready;

/// Longest wait for a node's answer to a command.
const PATIENCE: Duration = Duration::from_secs(10);
/// Longest wait until another painting is open.
const OPENING: Duration = Duration::from_secs(180);
/// Longest export.
const EXPORTING: Duration = Duration::from_secs(3600);
/// Longest wait for a daemon's answer to a force request.
const ANSWER: Duration = Duration::from_secs(3);
/// Interval after which a command is sent again; the window waits at most so long when it ends.
const ASK: Duration = Duration::from_millis(300);

/// A queue of requests.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Lane {
    /// Exports: each takes long, and other commands to the paint node do not wait for its end.
    Exports,
    /// Request that switches off the force of a device, which waits for no earlier answer.
    ForceOff(String),
    /// All else for a process.
    Ordered(Peer),
}

/// Reason why a request was not carried out.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RequestError {
    /// It was given up before it was sent.
    #[error("it was not sent")]
    NotSent,
    /// The process refused it, or did not answer.
    #[error(transparent)]
    Refused(#[from] UserError),
}

/// Outcome of a request.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The request.
    pub request: Request,
    /// Answer of the process.
    pub result: Result<Detail, RequestError>,
}

/// Requests for one process.
#[derive(Debug, Default)]
struct Queue {
    state: Mutex<QueueState>,
    changed: Condvar,
}

#[derive(Debug, Default)]
struct QueueState {
    waiting: VecDeque<Ready>,
    /// Time at which the request in flight was sent.
    since: Option<Instant>,
    /// When it was asked for, ns, if strokes wait for it.
    asked_ns: Option<u64>,
    /// True if the painter no longer waits for it.
    given_up: bool,
    ended: bool,
}

/// The dispatcher of a front end.
pub struct CommandDispatcher {
    bus: Arc<dyn Bus>,
    topics: Topics,
    wake: Wake,
    outcomes: Arc<Mutex<Outcomes>>,
    queues: BTreeMap<Lane, (Arc<Queue>, Option<JoinHandle<()>>)>,
}

impl CommandDispatcher {
    /// A dispatcher that signals `wake` at each answer.
    #[must_use]
    pub fn new(bus: Arc<dyn Bus>, topics: &Topics, wake: &Wake) -> Self {
        Self {
            bus,
            topics: topics.clone(),
            wake: wake.clone(),
            outcomes: Arc::default(),
            queues: BTreeMap::new(),
        }
    }

    /// Sends a request after those for the same process. One still in the queue is replaced by a newer one that sets
    /// the same value, such as the placement of a surface.
    pub fn send(&mut self, ready: Ready) {
        let (bus, topics, wake, outcomes) = (&self.bus, &self.topics, &self.wake, &self.outcomes);
        let (queue_of, _) = self.queues.entry(lane(&ready.request)).or_insert_with(|| {
            let queue_of = Arc::new(Queue::default());
            let mut worker = Worker {
                bus: Arc::clone(bus),
                topics: topics.clone(),
                commander: None,
                queue_of: Arc::clone(&queue_of),
                outcomes: Arc::clone(outcomes),
                wake: wake.clone(),
            };
            (queue_of, try_start("dispatcher", move || worker.run()))
        });
        let mut queue = queue_of
            .state
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        push(&mut queue.waiting, ready);
        queue_of.changed.notify_one();
    }

    /// Outcomes since the last call.
    #[must_use]
    pub fn outcomes(&self) -> Vec<Outcome> {
        let mut outcomes = self.outcomes.lock().unwrap_or_else(PoisonError::into_inner);
        outcomes.oldest_ns = None;
        std::mem::take(&mut outcomes.list)
    }

    /// When the oldest request for which strokes wait was asked for, ns, of those whose outcome was not
    /// [taken](Self::outcomes).
    #[must_use]
    pub fn oldest_ns(&self) -> Option<u64> {
        let queues = self.queues.values().filter_map(|(queue_of, _)| {
            let queue = queue_of
                .state
                .lock()
                .unwrap_or_else(PoisonError::into_inner);
            let waiting = queue.waiting.iter().filter_map(Ready::holds_strokes_ns);
            waiting.chain(queue.asked_ns).min()
        });
        // In this order: an outcome is reported before its request leaves the queue.
        let queued = queues.min();
        let outcomes = self.outcomes.lock().unwrap_or_else(PoisonError::into_inner);
        queued.into_iter().chain(outcomes.oldest_ns).min()
    }
}

/// Wait from which it is shown.
const LONG: Duration = Duration::from_millis(500);

impl CommandDispatcher {
    /// Processes that have not answered for half a second; an export reports its own progress.
    #[must_use]
    pub fn waits(&self) -> Vec<Peer> {
        let waits = |queue_of: &Queue| {
            let queue = queue_of
                .state
                .lock()
                .unwrap_or_else(PoisonError::into_inner);
            queue.since.is_some_and(|since| since.elapsed() > LONG)
        };
        let late = self
            .queues
            .iter()
            .filter_map(|(lane, (queue_of, _))| match lane {
                Lane::Ordered(peer) if waits(queue_of) => Some(peer.clone()),
                _ => None,
            });
        late.collect()
    }

    /// Gives up: the request in flight is not repeated, and the queue is not sent. Each request is reported as not
    /// done.
    pub fn give_up(&self) {
        let late = self.waits().into_iter().map(Lane::Ordered);
        let mut outcomes = self.outcomes.lock().unwrap_or_else(PoisonError::into_inner);
        for (queue_of, _) in late.filter_map(|lane| self.queues.get(&lane)) {
            let mut queue = queue_of
                .state
                .lock()
                .unwrap_or_else(PoisonError::into_inner);
            queue.given_up = queue.since.is_some();
            for ready in queue.waiting.drain(..) {
                let asked_ns = ready.holds_strokes_ns();
                let result = Err(RequestError::NotSent);
                let request = ready.request;
                outcomes.push(Outcome { request, result }, asked_ns);
            }
        }
        drop(outcomes);
        self.wake.ring();
    }
}

/// Queue of a request.
fn lane(request: &Request) -> Lane {
    match request {
        Request::Command {
            command: Command::File(FileCommand::Export(_)),
            ..
        } => Lane::Exports,
        Request::Force {
            device,
            order: ForceOrder::Off,
        } => Lane::ForceOff(device.clone()),
        _ => Lane::Ordered(request.peer()),
    }
}

/// Longest wait for a command.
fn patience(command: &Command) -> Duration {
    match command {
        Command::Rig(_) | Command::File(FileCommand::SaveAs(_)) => OPENING,
        Command::File(FileCommand::Export(_) | FileCommand::Copy { .. }) => EXPORTING,
        Command::File(FileCommand::StopExport)
        | Command::Edit(_)
        | Command::Take(_)
        | Command::Brush(_)
        | Command::Session(_) => PATIENCE,
    }
}

/// True if the first of two successive requests need not be carried out.
fn replaces(newer: &Request, older: &Request) -> bool {
    // An exposure that was to be chosen anew is chosen by the light that it was requested with.
    let chooses = match older {
        Request::Command {
            command: Command::Edit(edit),
            ..
        } => edit.word("expose") == "true",
        _ => false,
    };
    let set = newer.sets();
    set.is_some() && set == older.sets() && !chooses
}

/// Appends a request; the last one in the queue is dropped if this one makes it needless.
fn push(waiting: &mut VecDeque<Ready>, ready: Ready) {
    let last = waiting.back();
    if last.is_some_and(|last| replaces(&ready.request, &last.request)) {
        waiting.pop_back();
    }
    waiting.push_back(ready);
}

/// Sender of the requests of one queue.
struct Worker {
    bus: Arc<dyn Bus>,
    topics: Topics,
    commander: Option<CommandClient>,
    queue_of: Arc<Queue>,
    outcomes: Arc<Mutex<Outcomes>>,
    wake: Wake,
}

impl Worker {
    fn run(&mut self) {
        while let Some(ready) = self.next() {
            let result = self.deliver(&ready).map_err(RequestError::from);
            let asked_ns = ready.holds_strokes_ns();
            let outcome = Outcome {
                request: ready.request,
                result,
            };
            self.outcomes
                .lock()
                .unwrap_or_else(PoisonError::into_inner)
                .push(outcome, asked_ns);
            self.wake.ring();
        }
    }

    fn next(&self) -> Option<Ready> {
        let mut queue = self.queue();
        (queue.since, queue.asked_ns, queue.given_up) = (None, None, false);
        loop {
            if queue.ended {
                return None;
            }
            if let Some(ready) = queue.waiting.pop_front() {
                queue.since = Some(Instant::now());
                queue.asked_ns = ready.holds_strokes_ns();
                return Some(ready);
            }
            queue = self
                .queue_of
                .changed
                .wait(queue)
                .unwrap_or_else(PoisonError::into_inner);
        }
    }

    fn queue(&self) -> std::sync::MutexGuard<'_, QueueState> {
        self.queue_of
            .state
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
    }

    fn deliver(&mut self, ready: &Ready) -> Result<Detail, UserError> {
        match &ready.request {
            Request::Command { node, command } => {
                let queue_of = Arc::clone(&self.queue_of);
                let ended = move || {
                    let queue = queue_of
                        .state
                        .lock()
                        .unwrap_or_else(PoisonError::into_inner);
                    queue.ended || queue.given_up
                };
                let (bus, topics) = (&self.bus, &self.topics);
                let commander = self.commander.get_or_insert_with(|| {
                    CommandClient::of(Arc::clone(bus), topics, node).asking(ASK)
                });
                let after = ready.after.clone();
                commander.send(command.clone(), after, patience(command), &ended)
            }
            Request::Force { device, order } => {
                let me = Origin {
                    source: name_hash("ui"),
                    epoch: random_epoch(),
                };
                let topic = self.topics.force(device);
                let request = ForceRequest::by(&asker("the window"), order.clone());
                let reply: ForceReply =
                    ask(&*self.bus, &topic, Qos::Control, me, &request, ANSWER)?;
                if reply.fault.is_empty() {
                    Ok(Detail::Nothing)
                } else {
                    Err(UserError::failure(reply.fault).at(device.clone()))
                }
            }
        }
    }
}

impl Drop for CommandDispatcher {
    fn drop(&mut self) {
        for (queue_of, _) in self.queues.values() {
            let mut queue = queue_of
                .state
                .lock()
                .unwrap_or_else(PoisonError::into_inner);
            queue.ended = true;
            queue_of.changed.notify_all();
        }
        for (_, thread) in self.queues.values_mut() {
            if let Some(thread) = thread.take() {
                thread.join().ok();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use maulstick_types::Pose;
    use maulstick_types::command::TakeCommand;
    use maulstick_types::scene::Light;

    use maulstick_types::Edit;
    use serde_json::json;

    use super::*;

    fn request(command: Command) -> Request {
        Request::Command {
            node: "paint".into(),
            command,
        }
    }

    fn state(waiting: &VecDeque<Ready>) -> Vec<Request> {
        waiting.iter().map(|ready| ready.request.clone()).collect()
    }

    fn place(surface: u32, zoom: f64) -> Request {
        let fields = json!({ "surface": surface, "pose": Pose::IDENTITY, "zoom": zoom });
        request(Edit::named("place", &fields).into())
    }

    #[test]
    fn nothing_waits_for_the_end_of_an_export() {
        let export = Command::from(FileCommand::Export(
            maulstick_types::command::ExportOrder::to("/a.png".parse().expect("whole")),
        ));
        assert!(patience(&export) > patience(&Command::from(TakeCommand::Mark)));
        let (undo, stop) = (
            Command::from(Edit::named("undo", &json!({}))),
            Command::from(FileCommand::StopExport),
        );
        assert_eq!(lane(&request(undo)), lane(&request(stop.clone())));
        assert_ne!(lane(&request(export)), lane(&request(stop)));
    }

    #[test]
    fn of_what_a_slider_asks_for_the_newest_is_sent() {
        let tune = |brush: &str, stiffness: f64| {
            let fields = json!({ "brush": brush, "stiffness": stiffness, "wetness": 0.0 });
            request(Edit::named("tune", &fields).into())
        };
        let mut waiting = VecDeque::new();
        for request in [
            tune("a", 1.0),
            tune("a", 2.0),
            place(0, 1.0),
            tune("a", 3.0),
            tune("b", 4.0),
        ] {
            push(&mut waiting, request.into());
        }
        let expected = [
            tune("a", 2.0),
            place(0, 1.0),
            tune("a", 3.0),
            tune("b", 4.0),
        ];
        assert_eq!(state(&waiting), expected);
    }

    #[test]
    fn of_places_that_wait_the_newest_is_sent_and_nothing_overtakes() {
        let undo = || request(Command::from(Edit::named("undo", &json!({}))));
        let mut waiting = VecDeque::new();
        for request in [
            place(0, 1.0),
            place(0, 2.0),
            place(1, 1.0),
            undo(),
            place(1, 3.0),
            undo(),
        ] {
            push(&mut waiting, request.into());
        }
        let expected = [place(0, 2.0), place(1, 1.0), undo(), place(1, 3.0), undo()];
        assert_eq!(state(&waiting), expected);
    }

    #[test]
    fn of_lights_that_wait_the_newest_is_sent_and_each_choice_of_an_exposure() {
        let relight = |intensity: f64, expose: bool| {
            let light = Light {
                intensity,
                ..Light::default()
            };
            let fields = json!({ "light": light, "expose": expose });
            request(Edit::named("relight", &fields).into())
        };
        let mut waiting = VecDeque::new();
        for request in [
            relight(1.0, false),
            relight(2.0, true),
            relight(3.0, false),
            relight(4.0, false),
        ] {
            push(&mut waiting, request.into());
        }
        assert_eq!(state(&waiting), [relight(2.0, true), relight(4.0, false)]);
    }

    #[test]
    fn of_strengths_that_wait_the_newest_is_sent_and_force_off_stays() {
        let force = |order: ForceOrder| Request::Force {
            device: "arm".into(),
            order,
        };
        let strength = |share: f64| force(ForceOrder::Strength { share });
        let mut waiting = VecDeque::new();
        for request in [
            strength(0.1),
            strength(0.2),
            force(ForceOrder::Off),
            strength(0.3),
        ] {
            push(&mut waiting, request.into());
        }
        let expected = [strength(0.2), force(ForceOrder::Off), strength(0.3)];
        assert_eq!(state(&waiting), expected);
    }
}
