//! The supervisor: all processes of the rig, from their start to its end.
//!
//! One task waits for signals, ends of processes, messages and the next deadline at once, and passes events to its
//! parts; they return actions, which it carries out.
//!
//! | module | holds |
//! | --- | --- |
//! | [`crew`], [`node`] | the nodes as a state machine: restarts, time limits |
//! | [`switch`] | another painting, as a state machine |
//! | [`watchdog`] | nodes that make no progress |
//! | [`turns`] | times during which the launcher was stopped |
//! | [`carry_out`] | actions of these, carried out |
//! | [`requests`], [`orders`] | requests to the rig as a whole, and their server |
//! | [`checks`] | checks of another painting, in the background |
//! | [`settings`], [`sketch`] | the settings and the painting's file |
//! | [`folder`] | the rig's folder and its sockets |
//! | [`loads`], [`shown`] | loads of new brushes; the table and the bar |

mod carry_out;
mod checks;
mod crew;
mod folder;
mod loads;
mod node;
mod orders;
mod requests;
mod settings;
mod shown;
pub(super) mod sketch;
mod switch;
mod turns;
mod watchdog;

use std::sync::Arc;
use std::time::{Duration, Instant};

use maulstick_bus::sockets::SocketKeeper;
use maulstick_bus::typed::Receiver;
use maulstick_bus::{Bus, Dial, Qos, Queue, RigClock, RigFolder, Subscription, Wake, ZenohBus};
use maulstick_rig::node_handle::HUB;
use maulstick_rig::user_error::EXIT_FAILURE;
use maulstick_rig::{RigConfig, Sketches, Stop, UserError};
use maulstick_types::Mixture;
use maulstick_types::node::NodeStatus;
use maulstick_types::wire::topics::Topics;

use checks::Checks;
use crew::Crew;
use folder::FolderWatch;
use loads::Loads;
use orders::Orders;
use settings::Settings;
use shown::Shown;
use switch::{CLOSE_TIME, Switch};
use turns::Turns;
use watchdog::Watchdog;

use crate::runtime::{EndSignals, exit_code};
use crate::up::conductor::{Conductor, Performance};
use crate::up::plan::{Hands, NodeSpec, Role};
use crate::up::processes::{Ended, Processes};

/// Time for all nodes to end on request; paint that writes a file has the switch's time.
const GRACE: Duration = Duration::from_millis(1200);
/// Longest time between two looks at the progress of nodes, the folder, and time limits.
const LOOK: Duration = Duration::from_millis(100);

/// Inputs of a rig's start.
#[derive(Debug)]
pub struct Start {
    /// Its settings.
    pub config: RigConfig,
    /// Its nodes.
    pub nodes: Vec<NodeSpec>,
    /// A take that is played.
    pub performance: Option<Performance>,
    /// Load of the brushes, unless they keep theirs.
    pub first_load: Option<Mixture>,
    /// The sketches, if a painting without a file becomes one.
    pub sketches: Option<Sketches>,
}

/// A running rig.
pub struct Supervisor {
    link: Link,
    settings: Settings,
    processes: Processes,
    crew: Crew,
    watchdog: Watchdog,
    turns: Turns,
    folder_watch: FolderWatch,
    orders: Orders,
    switch: Switch,
    checks: Checks,
    conductor: Option<Conductor>,
    loads: Loads,
    shown: Shown,
}

/// The rig's bus, and its subscriptions for all nodes.
struct Link {
    session: Arc<ZenohBus>,
    bus: Arc<dyn Bus>,
    topics: Topics,
    wake: Wake,
    tokens: Subscription,
    statuses: Receiver<NodeStatus>,
    /// Set at the end of the rig, for work beside it.
    stop: Stop,
}

impl Link {
    fn open(folder: &RigFolder, clock: RigClock) -> Result<Self, UserError> {
        let dial = Dial {
            name: HUB.into(),
            listen: Some(folder.locator(HUB)),
            connect: Vec::new(),
        };
        let session = Arc::new(ZenohBus::open(&dial, clock)?);
        let bus: Arc<dyn Bus> = Arc::clone(&session) as Arc<dyn Bus>;
        let (topics, wake) = (Topics::new(folder.rig()), Wake::new());
        let (status, queue) = (topics.node_status("*"), Queue::Ring(256));
        Ok(Self {
            tokens: bus.watch(&topics.node("*"), &wake)?,
            // They are read in each turn, without waking the task.
            statuses: Receiver::new(&*bus, &status, Qos::Background, queue, &Wake::new())?,
            session,
            bus,
            topics,
            wake,
            stop: Stop::default(),
        })
    }
}

impl Supervisor {
    /// Opens the hub and starts the nodes. It has to run on the main thread: that one lives as long as the nodes.
    ///
    /// # Errors
    /// A [`UserError`] where the folder, the bus or a process cannot be used.
    pub fn start(folder: RigFolder, start: Start) -> Result<Self, UserError> {
        maulstick_bus::clear_shared_memory();
        let clock = RigClock::start();
        let link = Link::open(&folder, clock)?;
        let sockets = SocketKeeper::new(folder.path());
        let settings = Settings {
            folder,
            config: start.config,
            sketches: start.sketches,
        };
        settings.write()?;
        settings.folder.announce(HUB, clock)?;
        let (bus, topics, wake) = (&*link.bus, &link.topics, &link.wake);
        let conductor = start
            .performance
            .map(|performance| Conductor::new(bus, topics, performance, wake));
        let mut supervisor = Self {
            orders: Orders::new(bus, topics, wake)?,
            checks: Checks::new(wake),
            conductor: conductor.transpose()?,
            link,
            settings,
            processes: Processes::new()?,
            crew: Crew::new(start.nodes),
            watchdog: Watchdog::default(),
            turns: Turns::default(),
            folder_watch: FolderWatch::new(sockets),
            switch: Switch::default(),
            loads: Loads {
                first: start.first_load,
                are_due: true,
            },
            shown: Shown::default(),
        };
        let nodes = supervisor.crew.nodes.iter();
        let names: Vec<String> = nodes.map(|node| node.spec.name.clone()).collect();
        for name in names {
            supervisor.try_start(&name, Instant::now())?;
        }
        Ok(supervisor)
    }

    /// Runs the rig until it is told to stop, and returns the exit code.
    ///
    /// # Errors
    /// A [`UserError`] where an indispensable node keeps failing.
    pub async fn run(mut self, mut signals: EndSignals) -> Result<i32, UserError> {
        let end = loop {
            let now = Instant::now();
            let due = self.crew.next_due();
            let rest = due.map_or(LOOK, |due| due.saturating_duration_since(now).min(LOOK));
            let happened = tokio::select! {
                signal = signals.next() => break Ok(exit_code(signal)),
                (name, ended) = self.processes.ended() => self.process_ended(&name, ended),
                () = self.link.wake.ringing() => Ok(None),
                () = tokio::time::sleep(rest) => Ok(None),
            };
            match happened.and_then(|end| match end {
                None => self.turn(),
                end => Ok(end),
            }) {
                Ok(None) => {}
                Ok(Some(code)) => break Ok(code),
                Err(fault) => break Err(fault),
            }
        };
        self.shown.end();
        self.link.stop.request();
        let is_kept = self.stop_all().await;
        // A killed node leaves its shared memory behind.
        maulstick_bus::clear_shared_memory();
        self.settings.folder.withdraw();
        self.link.session.close();
        self.settings.end_sketch();
        match end {
            // Paint itself said why.
            Ok(0) if !is_kept => Ok(EXIT_FAILURE),
            end => end,
        }
    }

    /// One check of everything; an exit code where the rig is to end.
    fn turn(&mut self) -> Result<Option<i32>, UserError> {
        let now = Instant::now();
        if let Some(lost) = self.turns.begin(now) {
            self.watchdog.postpone(lost);
            self.crew.postpone(lost);
            self.switch.postpone(lost);
        }
        self.take_tokens(now);
        self.look(now)?;
        if self.crew.is_ready() {
            self.come_up();
        }
        self.take_requests(now);
        self.follow_switch(now)?;
        self.conduct(now)
    }

    fn take_tokens(&mut self, now: Instant) {
        while let Some(arrival) = self.link.tokens.try_recv() {
            let key = self.link.topics.relative(&arrival.key);
            if let Some(name) = key.and_then(|key| key.strip_prefix("node/")) {
                self.crew.token(name, arrival.present, now);
            }
        }
        while let Some(status) = self.link.statuses.try_recv() {
            let name = self.link.topics.middle(&status.key).unwrap_or_default();
            self.watchdog.hear(name, &status.message, now);
        }
    }

    /// Carries out actions whose time has come.
    fn look(&mut self, now: Instant) -> Result<(), UserError> {
        let config = &self.settings.config;
        let mut actions = self.crew.look(now, config, self.switch.opened());
        // A painting that moves to another file may delay paint.
        let spared = self.switch.is_busy().then_some(Role::Paint);
        actions.extend(self.watchdog.look(&self.crew.nodes, spared, now));
        let folder = &self.settings.folder;
        for name in self.folder_watch.watch(folder, &self.crew.nodes, now) {
            actions.extend(self.crew.renew(&name, now));
        }
        self.carry_out(actions, now)
    }

    /// All nodes run: shows the table, and loads new brushes. A played take brings its own loads.
    fn come_up(&mut self) {
        let take = self.conductor.as_ref();
        let take_ns = take.map(|conductor| conductor.performance.length_ns);
        self.shown.show(&self.crew, &self.settings, take_ns);
        if self.loads.are_due && self.conductor.is_none() {
            let Link {
                bus, topics, stop, ..
            } = &self.link;
            self.loads.send(bus, topics, &self.settings.config, stop);
        }
        self.loads.are_due = false;
    }

    /// Source of the brushes' motion.
    fn hands(&self) -> Hands {
        match self.conductor {
            Some(_) => Hands::Take,
            None => Hands::Devices,
        }
    }

    /// Starts the player when all others are ready; has the picture written at the take's end.
    fn conduct(&mut self, now: Instant) -> Result<Option<i32>, UserError> {
        let Some(conductor) = &mut self.conductor else {
            return Ok(None);
        };
        if self.crew.of_role(Role::Player).is_none() {
            if self.crew.is_ready() {
                let spec = conductor.player(&self.settings.config);
                let name = spec.name.clone();
                self.crew.put(spec);
                self.start_node(&name, now)?;
            }
            return Ok(None);
        }
        self.shown.position(conductor.follow());
        if !conductor.snapshot(&self.link.bus, &self.link.topics)? {
            return Ok(None);
        }
        let has_window = self.crew.of_role(Role::Window).is_some();
        if has_window && conductor.performance.snapshot.is_none() {
            // The painter views the result; the rig ends with the window.
            self.conductor = None;
            return Ok(None);
        }
        Ok(Some(0))
    }

    /// Asks all nodes to end, and kills those that do not; false where paint reports an unsaved painting.
    async fn stop_all(&mut self) -> bool {
        let for_paint = if self.switch.is_saving() {
            tracing::info!("the rig ends when the painting is in its file");
            CLOSE_TIME
        } else {
            GRACE
        };
        // The recorder ends last, so that it records the others' last messages.
        let is_kept = self
            .stop_those(|role| role != Role::Recorder, for_paint)
            .await;
        self.stop_those(|_| true, GRACE).await && is_kept
    }

    /// Asks the nodes of some roles to end, and kills those that do not; false where paint ended badly.
    async fn stop_those(&mut self, is_meant: fn(Role) -> bool, for_paint: Duration) -> bool {
        let nodes = self
            .crew
            .nodes
            .iter()
            .filter(|node| is_meant(node.spec.role));
        let nodes: Vec<(String, Role)> = nodes
            .map(|node| (node.spec.name.clone(), node.spec.role))
            .collect();
        for (name, _) in &nodes {
            self.processes.terminate(name);
        }
        let asked = tokio::time::Instant::now();
        let mut is_kept = true;
        loop {
            let running = nodes.iter().filter(|(name, _)| self.processes.runs(name));
            let graces = running.map(|(_, role)| match role {
                Role::Paint => for_paint,
                _ => GRACE,
            });
            let Some(grace) = graces.max() else {
                return is_kept;
            };
            tokio::select! {
                (name, ended) = self.processes.ended() => {
                    let is_paint = nodes.contains(&(name, Role::Paint));
                    is_kept &= !(is_paint && ended != Ended::Well);
                }
                () = tokio::time::sleep_until(asked + grace) => break,
            }
        }
        for (name, _) in &nodes {
            self.processes.kill(name);
        }
        let dead = async {
            while nodes.iter().any(|(name, _)| self.processes.runs(name)) {
                self.processes.ended().await;
            }
        };
        // A process that waits for a disk dies after that.
        tokio::time::timeout(GRACE, dead).await.ok();
        is_kept
    }
}
