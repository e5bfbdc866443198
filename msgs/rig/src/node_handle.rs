//! Joining a rig, living in it, leaving it.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use maulstick_bus::bus::Token;
use maulstick_bus::typed::random_epoch;
use maulstick_bus::{Bus, Dial, Participant, RigClock, RigFolder, Wake, ZenohBus};
use maulstick_types::node::NodeStatus;
use maulstick_types::wire::topics::Topics;
use maulstick_types::{Origin, name_hash};

use crate::config::RigConfig;
use crate::pulse::{Pulse, WorkCount};
use crate::stop::Stop;
use crate::user_error::UserError;

/// Socket of the launcher, to which every other process connects first.
pub const HUB: &str = "hub";
/// Nodes that exchange pictures through shared memory.
const SHARING: [&str; 2] = ["paint", "ui"];
/// The settings in the rig's folder, as the nodes read them.
pub const CONFIG_FILE: &str = "rig.toml";

/// Longest time between two turns: the status of a node that rests is due then.
const LONGEST_WAIT: Duration = Duration::from_nanos(NodeStatus::PERIOD_NS / 2);

/// Place of a process in a rig.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NodeArgs {
    /// The rig's folder.
    pub folder: PathBuf,
    /// Name of the node.
    pub node: String,
    /// True if a launcher holds the standard input open.
    pub guarded: bool,
}

/// A process in a rig.
pub struct NodeHandle {
    /// Its name.
    pub node: String,
    /// The bus.
    pub bus: Arc<dyn Bus>,
    /// The rig's topics.
    pub topics: Topics,
    /// The rig's folder.
    pub folder: PathBuf,
    /// The rig's settings.
    pub config: RigConfig,
    /// The rig's clock.
    pub clock: RigClock,
    /// Signalled when there is something to do.
    pub wake: Wake,
    /// Stop flag.
    pub stop: Stop,
    /// Work done so far, for its status.
    pub work: WorkCount,
    session: Arc<ZenohBus>,
    token: Option<Token>,
}

impl NodeHandle {
    /// Joins a running rig as one of its processes: signals, and the end of its launcher, stop it.
    ///
    /// # Errors
    /// A [`UserError`] where the rig does not run or cannot be reached.
    pub fn join(args: &NodeArgs) -> Result<Self, UserError> {
        let mut member = Self::guest(&args.folder, &args.node)?;
        let system = |error: std::io::Error| UserError::failure(error.to_string());
        member.stop = Stop::on_signals(&member.wake).map_err(system)?;
        if args.guarded {
            member.stop.on_launcher_end(&member.wake).map_err(system)?;
        }
        Ok(member)
    }

    /// Joins a running rig for a part of a process: only [`Stop::request`] stops it.
    ///
    /// # Errors
    /// A [`UserError`] where the rig does not run or cannot be reached.
    pub fn guest(folder: &Path, node: &str) -> Result<Self, UserError> {
        let (folder, info) = RigFolder::join_at(folder)?;
        let config = RigConfig::read(&folder.path().join(CONFIG_FILE))?;
        let dial = Dial {
            name: node.to_owned(),
            listen: Some(folder.locator(node)),
            connect: vec![info.endpoint.clone()],
        };
        let clock = RigClock::with_offset(info.clock_offset_ns);
        let open = if SHARING.contains(&node) {
            ZenohBus::open_sharing
        } else {
            ZenohBus::open
        };
        let session = Arc::new(open(&dial, clock)?);
        Ok(Self {
            node: node.to_owned(),
            bus: Arc::clone(&session) as Arc<dyn Bus>,
            topics: Topics::new(&info.rig),
            folder: folder.path().to_owned(),
            config,
            clock,
            wake: Wake::new(),
            stop: Stop::default(),
            work: WorkCount::default(),
            session,
            token: None,
        })
    }

    /// Origin of this process when it sends as `name`.
    #[must_use]
    pub fn origin(&self, name: &str) -> Origin {
        Origin {
            source: name_hash(name),
            epoch: random_epoch(),
        }
    }

    /// Tells the rig that this node is ready.
    ///
    /// # Errors
    /// A [`UserError`] where the bus is closed.
    pub fn ready(&mut self) -> Result<(), UserError> {
        self.token = Some(self.bus.token(&self.topics.node(&self.node))?);
        Ok(())
    }

    /// Calls `turn` whenever there is something to do, or after the time that it returned, until the stop flag is set.
    /// Each turn is a beat of the node's pulse.
    ///
    /// # Errors
    /// The error of `turn`.
    pub fn run(
        &self,
        mut turn: impl FnMut() -> Result<Duration, UserError>,
    ) -> Result<(), UserError> {
        let mut pulse = self.pulse()?;
        while !self.stop.requested() {
            let wait = turn()?;
            pulse.poll(self.bus.now_ns())?;
            self.wake.wait(wait.min(LONGEST_WAIT));
        }
        Ok(())
    }

    /// The pulse of this node, for a loop of its own.
    ///
    /// # Errors
    /// A [`UserError`] where the bus is closed.
    pub fn pulse(&self) -> Result<Pulse, UserError> {
        let work = self.work.clone();
        Ok(Pulse::new(&*self.bus, &self.topics, &self.node, work)?)
    }

    /// Has a thread send the status of a node whose loop may rest, as that of a window does while nobody sees it: it shows
    /// that the process is alive, until it leaves the rig.
    ///
    /// # Errors
    /// A [`UserError`] where the bus is closed, or there is no thread.
    pub fn pulse_beside(&self) -> Result<(), UserError> {
        let (mut pulse, bus) = (self.pulse()?, Arc::clone(&self.bus));
        let stop = self.stop.clone();
        let beat = move || {
            while !stop.requested() && pulse.poll(bus.now_ns()).is_ok() {
                std::thread::sleep(Duration::from_nanos(NodeStatus::PERIOD_NS));
            }
        };
        crate::thread::start("pulse", beat).map(drop)
    }

    /// The other programs of the rig, and what each sends, receives and answers.
    ///
    /// # Errors
    /// A [`UserError`] where the bus is closed.
    pub fn participants(&self) -> Result<Vec<Participant>, UserError> {
        Ok(self.session.participants()?)
    }

    /// Leaves the rig.
    pub fn leave(mut self) {
        self.token = None;
        self.session.close();
    }
}
