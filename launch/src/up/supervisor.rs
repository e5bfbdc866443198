//! All processes of the rig: their tokens, their restarts, the table, the end.

mod devices;
mod folder;
mod loads;
mod orders;
mod shown;
pub(super) mod sketch;
mod starts;
mod switch;
mod turns;
mod watchdog;

use std::sync::Arc;
use std::time::{Duration, Instant};

use indicatif::ProgressBar;
use maulstick_bus::sockets::SocketKeeper;
use maulstick_bus::{Bus, Dial, RigClock, RigFolder, Subscription, Wake, ZenohBus};
use maulstick_rig::node_handle::{CONFIG_FILE, HUB};
use maulstick_rig::user_error::EXIT_FAILURE;
use maulstick_rig::{RigConfig, Sketches, Stop, UserError};
use maulstick_types::Mixture;
use maulstick_types::wire::topics::Topics;

use crate::EXIT_INTERRUPTED;
use crate::up::child::{Ended, Failures, Node, State};
use crate::up::conductor::{Conductor, Performance};
use crate::up::plan::{NodeSpec, Role};
use folder::FolderWatch;
use orders::Orders;
use starts::FailedStarts;
use switch::Switch;
use turns::Turns;
use watchdog::Watchdog;

/// Time in which all nodes end when asked; paint that is being written to a file has that of the switch.
const GRACE: Duration = Duration::from_millis(1200);
/// Interval at which children are checked.
const TICK: Duration = Duration::from_millis(20);
/// Pause before a node is started again.
const RESTART_PAUSE: Duration = Duration::from_millis(200);

/// A running rig.
pub struct Supervisor {
    folder: RigFolder,
    config: RigConfig,
    session: Arc<ZenohBus>,
    bus: Arc<dyn Bus>,
    topics: Topics,
    wake: Wake,
    stop: Stop,
    tokens: Subscription,
    nodes: Vec<Node>,
    failures: Failures,
    failed_starts: FailedStarts,
    due: Vec<(String, Instant)>,
    started: Vec<(String, Instant)>,
    conductor: Option<Conductor>,
    first_load: Option<Mixture>,
    bar: Option<ProgressBar>,
    shown: bool,
    /// Paint starts with clean brushes: the painter's are to be loaded.
    unloaded: bool,
    orders: Orders,
    /// A switch to another painting in progress.
    switch: Option<Switch>,
    turns: Turns,
    watchdog: Watchdog,
    folder_watch: FolderWatch,
    /// The sketches, where paintings without a file of their own are such.
    sketches: Option<Sketches>,
}

/// A node whose token is gone for so long is taken for frozen.
const FROZEN: Duration = Duration::from_secs(5);

/// Reason for the end of the rig.
enum End {
    /// With this exit code.
    Code(i32),
    /// With a fault.
    Fault(UserError),
}

impl Supervisor {
    /// Opens the hub and starts the nodes.
    ///
    /// # Errors
    /// A [`UserError`] where the folder, the bus or a process cannot be used.
    pub fn start(
        folder: RigFolder,
        config: &RigConfig,
        specs: Vec<NodeSpec>,
        performance: Option<Performance>,
        first_load: Option<Mixture>,
    ) -> Result<Self, UserError> {
        maulstick_bus::clear_shared_memory();
        let clock = RigClock::start();
        let dial = Dial {
            name: HUB.into(),
            listen: Some(folder.locator(HUB)),
            connect: Vec::new(),
        };
        let session = Arc::new(ZenohBus::open(&dial, clock)?);
        let bus: Arc<dyn Bus> = Arc::clone(&session) as Arc<dyn Bus>;
        let topics = Topics::new(folder.rig());
        let wake = Wake::new();
        let stop =
            Stop::on_signals(&wake).map_err(|error| UserError::failure(error.to_string()))?;
        let tokens = bus.watch(&topics.node("*"), &wake)?;
        let path = folder.path().join(CONFIG_FILE);
        std::fs::write(&path, config.to_toml()?)
            .map_err(|error| UserError::writing(&path, &error))?;
        folder.announce(HUB, clock)?;
        let orders = Orders::new(&*bus, &topics, &wake)?;
        let watchdog = Watchdog::new(&*bus, &topics)?;
        let sockets = SocketKeeper::new(folder.path());
        let conductor = match performance {
            Some(performance) => Some(Conductor::new(&*bus, &topics, performance, &wake)?),
            None => None,
        };
        let mut supervisor = Self {
            nodes: specs.into_iter().map(Node::new).collect(),
            folder,
            config: config.clone(),
            session,
            bus,
            topics,
            wake,
            stop,
            tokens,
            failures: Failures::default(),
            failed_starts: FailedStarts::default(),
            due: Vec::new(),
            started: Vec::new(),
            conductor,
            first_load,
            bar: None,
            shown: false,
            unloaded: true,
            orders,
            switch: None,
            turns: Turns::default(),
            watchdog,
            folder_watch: FolderWatch::new(sockets),
            sketches: None,
        };
        for place in 0..supervisor.nodes.len() {
            supervisor.try_start(place)?;
        }
        Ok(supervisor)
    }

    /// Gives a painting for which nobody names a file one of a sketch.
    #[must_use]
    pub fn with_sketches(mut self, sketches: Option<Sketches>) -> Self {
        self.sketches = sketches;
        self
    }

    /// Starts a node, now or when the system allows it.
    fn start_node(&mut self, place: usize) -> Result<(), UserError> {
        self.try_start(place)
            .or_else(|fault| self.put_off(place, fault))
    }

    fn try_start(&mut self, place: usize) -> Result<(), UserError> {
        // It dials the sockets of the others once.
        self.folder_watch.hasten();
        self.watch_folder();
        let node = &mut self.nodes[place];
        node.start(self.folder.path())?;
        let name = node.spec.name.clone();
        self.failed_starts.forget(&name);
        self.started.retain(|(other, _)| *other != name);
        self.started.push((name, Instant::now()));
        Ok(())
    }

    /// Keeps the rig running until it is told to stop, and returns the exit code.
    ///
    /// # Errors
    /// A [`UserError`] where a node that the rig cannot do without does not stay up.
    pub fn run(&mut self) -> Result<i32, UserError> {
        let end = loop {
            if self.stop.requested() {
                break End::Code(self.stop.exit_code(EXIT_INTERRUPTED));
            }
            match self.turn() {
                Ok(None) => {}
                Ok(Some(code)) => break End::Code(code),
                Err(fault) => break End::Fault(fault),
            }
            self.wake.wait(TICK);
        };
        if let Some(bar) = self.bar.take() {
            bar.finish_and_clear();
        }
        let is_kept = self.stop_all();
        // Of a node that was killed nobody else would.
        maulstick_bus::clear_shared_memory();
        self.folder.withdraw();
        self.session.close();
        self.end_sketch();
        match end {
            // Paint itself said why.
            End::Code(0) if !is_kept => Ok(EXIT_FAILURE),
            End::Code(code) => Ok(code),
            End::Fault(fault) => Err(fault),
        }
    }

    /// One look at everything; an exit code where the rig is to end.
    fn turn(&mut self) -> Result<Option<i32>, UserError> {
        self.begin_turn();
        self.watch_tokens();
        if let Some(code) = self.watch_children()? {
            return Ok(Some(code));
        }
        self.end_frozen();
        self.end_hanging();
        self.watch_folder();
        self.restart_due()?;
        self.watch_starts()?;
        self.show_when_ready();
        self.load_when_ready();
        self.take_orders();
        self.go_on_switching()?;
        self.conduct()
    }

    fn watch_tokens(&mut self) {
        while let Some(arrival) = self.tokens.try_recv() {
            let Some(name) = self
                .topics
                .relative(&arrival.key)
                .and_then(|key| key.strip_prefix("node/"))
            else {
                continue;
            };
            let node = self.nodes.iter_mut().find(|node| node.spec.name == name);
            let Some(node) = node else {
                continue;
            };
            node.missed = (!arrival.present).then(Instant::now);
            if node.state == State::Starting && arrival.present {
                node.state = State::Running;
            }
        }
    }

    fn watch_children(&mut self) -> Result<Option<i32>, UserError> {
        let ended: Vec<(String, Ended)> = self
            .nodes
            .iter_mut()
            .filter_map(|node| node.ended().map(|ended| (node.spec.name.clone(), ended)))
            .collect();
        for (name, ended) in ended {
            // One node's end may have taken others out of the rig.
            let Some(place) = self.nodes.iter().position(|node| node.spec.name == name) else {
                continue;
            };
            let role = self.nodes[place].spec.role;
            if self.nodes[place].leaving_since.is_some() || self.is_opening(role) {
                self.has_left(place, ended)?;
                continue;
            }
            self.give_saving_up(role);
            match ended {
                Ended::Well if self.may_end(role) => {
                    self.nodes[place].state = State::Ended;
                    if role == Role::Window {
                        return Ok(Some(0));
                    }
                }
                Ended::Refused(code) if role == Role::Player => return Ok(Some(code)),
                Ended::Refused(_) => {
                    self.nodes[place].state = State::Failed;
                    if !role.is_spare() {
                        return Err(self.failed(&name));
                    }
                    tracing::error!("node '{name}' failed and is not started again");
                }
                // A node that somebody stopped is missed like one that crashed.
                Ended::Well | Ended::Badly => {
                    let again = self.nodes[place].fail(&mut self.failures);
                    if !again {
                        if role.is_spare() {
                            tracing::error!("node '{name}' failed and is not started again");
                            continue;
                        }
                        return Err(self.failed(&name));
                    }
                    let how = if ended == Ended::Well {
                        "ended"
                    } else {
                        "failed"
                    };
                    tracing::warn!("node '{name}' {how} and is started again");
                    self.due.push((name, Instant::now() + RESTART_PAUSE));
                    self.replay_after(role);
                }
            }
        }
        Ok(None)
    }

    /// True if the rig can do without a node that ended with success.
    fn may_end(&self, role: Role) -> bool {
        match role {
            Role::Paint | Role::Brush | Role::Recorder => false,
            // While its take is conducted it stays, even after the take's end.
            Role::Player => self.conductor.is_none(),
            Role::Device | Role::Window => true,
        }
    }

    fn failed(&self, name: &str) -> UserError {
        UserError::failure(format!("node '{name}' does not stay up"))
            .at(self.topics.node(name))
            .help("its own messages above say why; three failures in ten seconds are the limit")
    }

    /// A take whose brush or paint died is played again from its start; what was painted of it goes.
    fn replay_after(&mut self, role: Role) {
        let Some(conductor) = &mut self.conductor else {
            return;
        };
        if role == Role::Window || role.is_spare() {
            return;
        }
        conductor.begin_again();
        self.give_saving_up(Role::Paint);
        let again = |role: Role| matches!(role, Role::Paint | Role::Brush | Role::Player);
        for node in self.nodes.iter_mut().filter(|node| again(node.spec.role)) {
            if node.pid().is_some() {
                node.kill();
                node.state = State::Restarting;
                self.due.push((node.spec.name.clone(), Instant::now()));
            }
        }
        self.due
            .retain(|(name, _)| name != crate::processes::PLAYER);
        self.nodes.retain(|node| node.spec.role != Role::Player);
    }

    fn restart_due(&mut self) -> Result<(), UserError> {
        let now = Instant::now();
        let due: Vec<String> = self
            .due
            .iter()
            .filter(|(_, when)| *when <= now)
            .map(|(name, _)| name.clone())
            .collect();
        self.due.retain(|(name, _)| !due.contains(name));
        for name in due {
            if let Some(place) = self.nodes.iter().position(|node| node.spec.name == name) {
                self.nodes[place].restarts += 1;
                // A painting in a document comes back with what its brushes carry.
                let forgets = self.config.paint.document.is_none();
                self.unloaded |= forgets && self.nodes[place].spec.role == Role::Paint;
                self.start_node(place)?;
            }
        }
        Ok(())
    }

    /// Kills nodes whose token is gone while their process is not: they are frozen, and started again
    /// as those that crash. Who is asked to leave has as long; paint, which still writes, has longer.
    fn end_frozen(&mut self) {
        for node in &mut self.nodes {
            let long = node
                .leaving_since
                .is_some_and(|since| since.elapsed() > FROZEN);
            if long && node.spec.role != Role::Paint {
                node.strike();
            }
        }
        let running = self
            .nodes
            .iter_mut()
            .filter(|node| node.state == State::Running);
        for node in running {
            let long = node.missed.is_some_and(|since| since.elapsed() > FROZEN);
            if long && node.pid().is_some() {
                tracing::warn!("node '{}' does not answer and is ended", node.spec.name);
                node.missed = None;
                node.strike();
            }
        }
    }

    /// True if no node is still starting; a device that failed for good delays nothing.
    fn ready(&self) -> bool {
        self.nodes
            .iter()
            .all(|node| !matches!(node.state, State::Starting | State::Restarting))
    }

    /// Starts the player when all others are ready; has the picture written at the take's end.
    fn conduct(&mut self) -> Result<Option<i32>, UserError> {
        let ready = self.ready();
        let Some(conductor) = &mut self.conductor else {
            return Ok(None);
        };
        if !self.nodes.iter().any(|node| node.spec.role == Role::Player) {
            if ready {
                let spec = conductor.player(&self.config);
                self.nodes.push(Node::new(spec));
                self.start_node(self.nodes.len() - 1)?;
            }
            return Ok(None);
        }
        let position_ns = conductor.follow();
        if let Some(bar) = &self.bar {
            bar.set_position(position_ns / 1_000_000);
        }
        if !conductor.snapshot(&self.bus, &self.topics)? {
            return Ok(None);
        }
        let window = self.nodes.iter().any(|node| node.spec.role == Role::Window);
        if window && conductor.performance.snapshot.is_none() {
            // The painter looks at what was painted; the window's end is the rig's.
            self.conductor = None;
            return Ok(None);
        }
        Ok(Some(0))
    }

    /// Asks all nodes to end, and ends those that do not; false where paint says that it could not keep
    /// the painting.
    fn stop_all(&mut self) -> bool {
        let for_paint = self.closing_time();
        if for_paint > GRACE {
            tracing::info!("the rig ends when the painting is in its file");
        }
        // The recorder ends last: it has what the others still send.
        let is_kept = self.stop_those(|role| role != Role::Recorder, for_paint);
        self.stop_those(|_| true, GRACE) && is_kept
    }

    /// Asks the nodes of some roles to end, and ends those that do not; false where paint ended badly.
    fn stop_those(&mut self, is_meant: fn(Role) -> bool, for_paint: Duration) -> bool {
        let meant = |node: &&mut Node| is_meant(node.spec.role);
        let nodes = self.nodes.iter_mut().filter(meant);
        nodes.for_each(Node::terminate);
        let asked = Instant::now();
        let mut is_kept = true;
        loop {
            let mut waits = false;
            for node in self.nodes.iter_mut().filter(meant) {
                let failed = matches!(node.ended(), Some(Ended::Refused(_) | Ended::Badly));
                is_kept &= !(failed && node.spec.role == Role::Paint);
                let grace = match node.spec.role {
                    Role::Paint => for_paint,
                    _ => GRACE,
                };
                waits |= node.pid().is_some() && asked.elapsed() < grace;
            }
            if !waits {
                break;
            }
            self.wake.wait(Duration::from_millis(5));
        }
        self.nodes.iter_mut().filter(meant).for_each(Node::kill);
        is_kept
    }
}
