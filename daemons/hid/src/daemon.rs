//! The daemon: opens its device, reads it, and publishes to the rig.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use glam::DQuat;
use maulstick_bus::typed::Sender;
use maulstick_bus::{Bus, Qos, Subscription, Wake};
use maulstick_device::device_missing::report_missing;
use maulstick_device::node_watch::NodeWatch;
use maulstick_num::geometry::canonical;
use maulstick_rig::config::{BRUSH_NODE, CanvasSection, DeviceSection};
use maulstick_rig::{NodeHandle, UserError};
use maulstick_types::Origin;
use maulstick_types::node::NodeWork;
use maulstick_types::stylus::StylusStatus;
use maulstick_types::wire::topics::Topics;

use crate::device_source::{Identity, Ports};
use crate::open::{self, Address, Kind, Means};
use crate::recorder::Recorder;
use crate::recording::{self, Recorded};
use crate::report_stream::{Live, Played, ReportStream, StreamItem};
use crate::spacemouse::SpaceMouse;
use crate::spacemouse_node::SpaceMouseNode;
use crate::stylus::Stylus;
use crate::tablet::Tablet;

/// Time between two statuses, ns.
const STATUS_PERIOD_NS: u64 = 100_000_000;
/// Time between two attempts to open a device that is not there, ns.
const ATTEMPT_PERIOD_NS: u64 = 1_000_000_000;
/// Quiet after news of a node until it is opened, ns: udev gives a device's nodes to the user one after the other.
const SETTLING_NS: u64 = 100_000_000;
/// Longest time between two turns.
const LONGEST_TURN: Duration = Duration::from_millis(20);
/// Histogram bins in the status of a daemon without a servo.
const NO_BINS: usize = 0;

/// Settings of a HID daemon.
#[derive(Clone, Debug)]
pub struct HidSettings {
    /// The device's section of `rig.toml`.
    pub device: DeviceSection,
    /// The canvas that a tablet is fitted to.
    pub canvas: CanvasSection,
    /// A recording that is played in the device's place.
    pub replay: Option<PathBuf>,
    /// File for a recording of the device.
    pub record: Option<PathBuf>,
}

/// Runs a device in the rig of `member`.
///
/// # Errors
/// A [`UserError`] where the device or the rig cannot be used.
pub fn run(member: &mut NodeHandle, settings: &HidSettings) -> Result<(), UserError> {
    warn_of_twins(&settings.device, &member.config.device);
    let origin = member.origin(&settings.device.name);
    let mut daemon = Daemon::new(
        Arc::clone(&member.bus),
        &member.topics,
        &member.wake,
        origin,
        settings,
        Kind::of_section(&settings.device)?.ports(),
    )?;
    member.ready()?;
    let result = member.run(|| {
        let wait = daemon.turn()?;
        member.work.set(daemon.work());
        Ok(wait)
    });
    result.and(daemon.end())
}

/// Warns of another section before this one that opens the same device.
fn warn_of_twins(device: &DeviceSection, all: &[DeviceSection]) {
    let before = all.iter().take_while(|other| other.name != device.name);
    let is_twin = |other: &&DeviceSection| {
        other.driver == device.driver
            && other.address == device.address
            && other.replay.is_none()
            && device.replay.is_none()
    };
    if let Some(twin) = before.filter(is_twin).last() {
        let names = format!("{} and {}", twin.name, device.name);
        tracing::warn!("{names} read the same device: give each an `address` in rig.toml");
    }
}

/// The device's side of the bus.
#[derive(Debug)]
enum Output {
    Stylus(Box<Stylus>),
    SpaceMouse(Box<SpaceMouseNode>),
}

/// A device in a rig.
pub struct Daemon {
    bus: Arc<dyn Bus>,
    wake: Wake,
    settings: HidSettings,
    kind: Kind,
    address: Address,
    ports: Box<dyn Ports>,
    /// Has a device that is plugged in opened before the next attempt is due.
    nodes: Option<NodeWatch>,
    /// The recording to be played, until it starts.
    replay: Option<Recorded>,
    /// Token of the brush that a played pen waits for: without it the first stroke would be lost.
    brush: Option<Subscription>,
    recorder: Option<Recorder>,
    output: Output,
    /// The device's reports, while it is open.
    stream: Option<ReportStream>,
    /// Time of the next attempt to open the device, ns; `None` while a recording takes its place.
    attempt_ns: Option<u64>,
    status: Sender<StylusStatus>,
    told: StylusStatus,
    status_ns: u64,
    /// Reports dropped with devices that are gone.
    dropped_before: u64,
    heard_ns: u64,
}

impl Daemon {
    /// A daemon on `bus` that sends as `origin` and finds its device at `ports`.
    ///
    /// # Errors
    /// A [`UserError`] where the settings are wrong, the recording cannot be read, or the bus is closed.
    pub fn new(
        bus: Arc<dyn Bus>,
        topics: &Topics,
        wake: &Wake,
        origin: Origin,
        settings: &HidSettings,
        ports: Box<dyn Ports>,
    ) -> Result<Self, UserError> {
        let device = &settings.device;
        let kind = Kind::of_section(device)?;
        let replay = settings.replay.as_ref().or(device.replay.as_ref());
        let replay = match replay {
            Some(path) => Some(
                recording::playable(kind, recording::read(path)?)
                    .map_err(|fault| fault.at(path.display().to_string()))?,
            ),
            None => None,
        };
        let output = match kind {
            Kind::Pen | Kind::EventPen => {
                let stylus = Stylus::new(&bus, topics, device, origin, wake)?;
                Output::Stylus(Box::new(stylus))
            }
            Kind::SpaceMouse => {
                let mouse = SpaceMouseNode::new(&bus, topics, device, origin)?;
                Output::SpaceMouse(Box::new(mouse))
            }
        };
        let node = topics.node(&format!("{BRUSH_NODE}{}", device.brush));
        let brush = match (kind, &replay) {
            (Kind::Pen | Kind::EventPen, Some(_)) => Some(bus.watch(&node, wake)?),
            _ => None,
        };
        let topic = topics.stylus_status(&device.name);
        Ok(Self {
            brush,
            kind,
            address: Address::parse(device.address.as_deref())?,
            nodes: ports.dev().and_then(NodeWatch::of),
            ports,
            replay,
            recorder: settings
                .record
                .as_deref()
                .map(Recorder::begin)
                .transpose()?,
            output,
            stream: None,
            attempt_ns: Some(0),
            status: Sender::new(&*bus, &topic, Qos::Background, origin)?,
            told: StylusStatus {
                // It has no force.
                is_on: false,
                strength: 0.0,
                ..StylusStatus::fresh(NO_BINS)
            },
            status_ns: 0,
            dropped_before: 0,
            heard_ns: 0,
            settings: settings.clone(),
            wake: wake.clone(),
            bus,
        })
    }

    /// Does the work that is due; returns the time until there is more, unless the wake rings.
    ///
    /// # Errors
    /// A [`UserError`] where the rig is gone.
    pub fn turn(&mut self) -> Result<Duration, UserError> {
        let now_ns = self.bus.now_ns();
        if self.stream.is_none() {
            if self.nodes.as_ref().is_some_and(NodeWatch::has_news) {
                self.attempt_ns = self.attempt_ns.map(|_| now_ns + SETTLING_NS);
            }
            if self.attempt_ns.is_some_and(|at| now_ns >= at) {
                self.attempt(now_ns)?;
            }
        }
        let due_ns = self.listen(now_ns)?;
        if let Output::Stylus(stylus) = &mut self.output {
            stylus.serve(now_ns)?;
        }
        if now_ns >= self.status_ns + STATUS_PERIOD_NS {
            self.status_ns = now_ns;
            self.told.dropped = self.dropped();
            self.told.samples = match &self.output {
                Output::Stylus(stylus) => stylus.sent(),
                Output::SpaceMouse(mouse) => mouse.sent(),
            };
            self.status.send(now_ns, now_ns, &self.told)?;
        }
        let again_ns = match &self.output {
            Output::Stylus(stylus) => stylus.due_ns(),
            Output::SpaceMouse(mouse) => mouse.due_ns(),
        };
        let next_ns = [due_ns, again_ns].into_iter().flatten().min();
        let wait = next_ns.map_or(LONGEST_TURN, |at| {
            Duration::from_nanos(at.saturating_sub(now_ns))
        });
        Ok(wait.min(LONGEST_TURN))
    }

    /// Ends the daemon: lifts the pen and completes the recording.
    ///
    /// # Errors
    /// A [`UserError`] where the recording could not be written or the rig is gone.
    pub fn end(mut self) -> Result<(), UserError> {
        let now_ns = self.bus.now_ns();
        let lifted = self.lift(now_ns, now_ns);
        self.stream = None;
        let ended = self.recorder.take().map_or(Ok(()), Recorder::end);
        lifted.and(ended)
    }

    /// What it has done since its start.
    #[must_use]
    pub fn work(&self) -> NodeWork {
        NodeWork {
            produced: self.told.samples,
            lost: self.told.dropped,
            ..NodeWork::default()
        }
    }

    fn dropped(&self) -> u64 {
        self.dropped_before + self.stream.as_ref().map_or(0, ReportStream::dropped)
    }

    /// Takes in the device's reports; returns the time of the next one, if that is known.
    fn listen(&mut self, now_ns: u64) -> Result<Option<u64>, UserError> {
        loop {
            let Some(stream) = &mut self.stream else {
                return Ok(None);
            };
            match stream.next(now_ns) {
                StreamItem::Report(event) => {
                    if let Some(recorder) = &mut self.recorder {
                        recorder.event(&event);
                    }
                    self.heard_ns = event.time_ns;
                    let (report, event_ns) = (&event.report, event.time_ns);
                    match &mut self.output {
                        Output::Stylus(stylus) => stylus.report(report, event_ns, now_ns)?,
                        Output::SpaceMouse(mouse) => mouse.report(report, event_ns, now_ns)?,
                    }
                }
                StreamItem::Nothing(due_ns) => {
                    match &mut self.output {
                        Output::Stylus(stylus) => stylus.silent(now_ns, now_ns)?,
                        Output::SpaceMouse(mouse) => mouse.silent(now_ns, now_ns)?,
                    }
                    return Ok(due_ns);
                }
                StreamItem::Over => {
                    // At its last report's time, whenever this turn is.
                    self.lift(self.heard_ns, now_ns)?;
                    self.stream = None;
                    tracing::info!("{}: the recording is over", self.settings.device.name);
                }
                StreamItem::Lost(fault) => {
                    self.lift(now_ns, now_ns)?;
                    self.dropped_before = self.dropped();
                    self.stream = None;
                    self.attempt_ns = Some(now_ns + ATTEMPT_PERIOD_NS);
                    report_missing(&self.settings.device.name, &fault, &mut self.told);
                }
            }
        }
    }

    fn lift(&mut self, event_ns: u64, now_ns: u64) -> Result<(), UserError> {
        match &mut self.output {
            Output::Stylus(stylus) => stylus.end(event_ns, now_ns)?,
            Output::SpaceMouse(mouse) => mouse.end(event_ns, now_ns)?,
        }
        Ok(())
    }

    /// Tries to open the device, or begins to play the recording in its place.
    fn attempt(&mut self, now_ns: u64) -> Result<(), UserError> {
        if let Some(brush) = &self.brush {
            // Tokens come and go, and the newest counts; the wake rings for the next.
            let newest = std::iter::from_fn(|| brush.try_recv()).last();
            if !newest.is_some_and(|token| token.present) {
                return Ok(());
            }
            self.brush = None;
        }
        if let Some(recorded) = self.replay.take() {
            self.attempt_ns = None;
            let Recorded {
                identity,
                descriptor,
                events,
            } = recorded;
            let means = open::means(self.kind, &identity, &descriptor)?;
            self.begin(means, &identity, &descriptor, now_ns)?;
            // One without reports is over when it begins.
            self.heard_ns = now_ns;
            self.stream = Some(ReportStream::Played(Played::start(events, now_ns)));
            return Ok(());
        }
        self.attempt_ns = Some(now_ns + ATTEMPT_PERIOD_NS);
        let opened = match open::open(&mut *self.ports, self.kind, &self.address) {
            Ok(opened) => opened,
            Err(fault) => {
                report_missing(&self.settings.device.name, &fault, &mut self.told);
                return Ok(());
            }
        };
        let (identity, descriptor) = (opened.identity, opened.source.descriptor().to_vec());
        match (opened.means, &mut self.recorder) {
            (Ok(means), _) => {
                self.told.clear_trouble();
                self.begin(means, &identity, &descriptor, now_ns)?;
            }
            (Err(fault), None) => {
                report_missing(&self.settings.device.name, &fault, &mut self.told);
                return Ok(());
            }
            // An unknown device can still be recorded, for support in a later version.
            (Err(fault), Some(recorder)) => {
                recorder.device(&identity, &descriptor);
                report_missing(&self.settings.device.name, &fault, &mut self.told);
            }
        }
        self.stream = Some(ReportStream::Live(Live::start(
            opened.source,
            Arc::clone(&self.bus),
            &self.wake,
        )?));
        Ok(())
    }

    fn begin(
        &mut self,
        means: Means,
        identity: &Identity,
        descriptor: &[u8],
        now_ns: u64,
    ) -> Result<(), UserError> {
        let device = &self.settings.device;
        tracing::info!("{}: {}", device.name, open::description(identity, &means));
        if let Some(recorder) = &mut self.recorder {
            recorder.device(identity, descriptor);
        }
        match (means, &mut self.output) {
            (Means::Pen(decoder), Output::Stylus(stylus)) => {
                let (area_m, senses) = (decoder.area_m(), decoder.senses());
                let tablet = Tablet::fit(area_m, senses, device, &self.settings.canvas)?;
                stylus.begin(decoder, tablet, device, now_ns)?;
            }
            (Means::SpaceMouse, Output::SpaceMouse(node)) => {
                let to_desk = canonical(DQuat::from_array(device.orientation));
                let mouse = SpaceMouse::new(identity.vendor, identity.product, to_desk);
                node.begin(mouse, device, now_ns)?;
            }
            // A kind has one output.
            (Means::Pen(_), Output::SpaceMouse(_)) | (Means::SpaceMouse, Output::Stylus(_)) => {}
        }
        Ok(())
    }
}
