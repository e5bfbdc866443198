//! The daemon: opens its device, reads it, and publishes to the rig.

mod connection;
mod output;
mod status_publisher;

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use maulstick_bus::{Bus, Wake};
use maulstick_rig::config::{CanvasSection, DeviceSection};
use maulstick_rig::{NodeHandle, UserError};
use maulstick_types::Origin;
use maulstick_types::node::NodeWork;
use maulstick_types::wire::topics::Topics;

use connection::{Attempt, Connection, FoundDevice};
use output::Output;
use status_publisher::StatusPublisher;

use crate::device_source::Ports;
use crate::open::{self, Kind};
use crate::recorder::Recorder;
use crate::report_stream::StreamItem;

/// Longest time between two turns.
const LONGEST_TURN: Duration = Duration::from_millis(20);

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
        let wait = daemon.poll()?;
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

/// A device in a rig.
pub struct Daemon {
    bus: Arc<dyn Bus>,
    settings: HidSettings,
    connection: Connection,
    recorder: Option<Recorder>,
    output: Output,
    status: StatusPublisher,
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
        let mut connection = Connection::new(Arc::clone(&bus), wake, kind, settings, ports)?;
        let output = Output::new(kind, &bus, topics, settings, (origin, wake))?;
        connection.wait_for(topics, &device.brush)?;
        let record = settings.record.as_deref();
        Ok(Self {
            connection,
            recorder: record.map(Recorder::begin).transpose()?,
            output,
            status: StatusPublisher::new(&*bus, topics, &device.name, origin)?,
            settings: settings.clone(),
            bus,
        })
    }

    /// Does the work that is due; returns the time until there is more, unless the wake rings.
    ///
    /// # Errors
    /// A [`UserError`] where the rig is gone.
    pub fn poll(&mut self) -> Result<Duration, UserError> {
        let now_ns = self.bus.now_ns();
        if self.connection.is_due(now_ns) {
            self.open(now_ns)?;
        }
        let report_ns = self.drain_reports(now_ns)?;
        self.output.serve(now_ns)?;
        let (sent, dropped) = (self.output.sent(), self.connection.dropped());
        self.status.publish(sent, dropped, now_ns)?;
        let next_ns = [report_ns, self.output.due_ns()]
            .into_iter()
            .flatten()
            .min();
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
        let lifted = self.output.lift(now_ns, now_ns);
        self.connection.close();
        let ended = self.recorder.take().map_or(Ok(()), Recorder::end);
        lifted.map_err(UserError::from).and(ended)
    }

    /// Work since the start.
    #[must_use]
    pub fn work(&self) -> NodeWork {
        self.status.work()
    }

    /// Publishes the device's reports; returns the time of the next one, if that is known.
    fn drain_reports(&mut self, now_ns: u64) -> Result<Option<u64>, UserError> {
        let name = &self.settings.device.name;
        while let Some(item) = self.connection.next(now_ns) {
            match item {
                StreamItem::Report(event) => {
                    if let Some(recorder) = &mut self.recorder {
                        recorder.event(&event);
                    }
                    self.output.report(&event.report, event.time_ns, now_ns)?;
                }
                StreamItem::Nothing(due_ns) => {
                    self.output.silent(now_ns)?;
                    return Ok(due_ns);
                }
                StreamItem::Over => {
                    // At its last report's time, whenever this turn is.
                    self.output.lift(self.connection.heard_ns(), now_ns)?;
                    tracing::info!("{name}: the recording is over");
                }
                StreamItem::Lost(fault) => {
                    self.output.lift(now_ns, now_ns)?;
                    self.status.report_missing(&fault);
                }
            }
        }
        Ok(None)
    }

    /// Tries to open the device, or begins to play the recording in its place.
    fn open(&mut self, now_ns: u64) -> Result<(), UserError> {
        let found = match self.connection.find(now_ns)? {
            Attempt::Waiting => return Ok(()),
            Attempt::Missing(fault) => {
                self.status.report_missing(&fault);
                return Ok(());
            }
            Attempt::Found(found) => found,
        };
        let FoundDevice {
            identity,
            descriptor,
            means,
            source,
        } = found;
        match &means {
            Ok(means) => {
                self.status.report_open();
                let name = &self.settings.device.name;
                tracing::info!("{name}: {}", open::description(&identity, means));
            }
            Err(fault) => self.status.report_missing(fault),
        }
        if let Some(recorder) = &mut self.recorder {
            recorder.device(&identity, &descriptor);
        }
        match means {
            Ok(means) => self
                .output
                .begin(means, &identity, &self.settings, now_ns)?,
            Err(_) if self.recorder.is_none() => return Ok(()),
            // An unknown device can still be recorded, for support in a later version.
            Err(_) => {}
        }
        self.connection.start(source, now_ns)
    }
}
