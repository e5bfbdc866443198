//! Connection to the device, or to the recording that is played in its place.

use std::path::PathBuf;
use std::sync::Arc;

use maulstick_bus::{Bus, BusError, Subscription, Wake};
use maulstick_device::node_watch::NodeWatch;
use maulstick_rig::UserError;
use maulstick_rig::config::BRUSH_NODE;
use maulstick_types::wire::topics::Topics;

use super::HidSettings;
use crate::device_source::{HidSource, Identity, Ports};
use crate::open::{self, Address, Kind, Means};
use crate::recording::{self, Event, Recorded};
use crate::report_stream::{Live, Played, ReportStream, StreamItem};

/// Time between two attempts to open a device that is not there, ns.
const ATTEMPT_PERIOD_NS: u64 = 1_000_000_000;
/// Quiet after news of a node until it is opened, ns: udev gives a device's nodes to the user one after the other.
const SETTLING_NS: u64 = 100_000_000;

/// Origin of the reports of a device that was found.
pub(super) enum Source {
    /// Its node.
    Live(Box<dyn HidSource>),
    /// A recording.
    Played(Vec<Event>),
}

/// A device that was found.
pub(super) struct FoundDevice {
    pub(super) identity: Identity,
    pub(super) descriptor: Vec<u8>,
    /// Means of reading it; one that cannot be read may still be recorded.
    pub(super) means: Result<Means, UserError>,
    pub(super) source: Source,
}

/// Result of an attempt to open the device.
pub(super) enum Attempt {
    /// The brush that a played pen moves is not there.
    Waiting,
    /// The device is not there.
    Missing(UserError),
    /// It is there.
    Found(FoundDevice),
}

/// The device of a section of `rig.toml`.
pub(super) struct Connection {
    bus: Arc<dyn Bus>,
    wake: Wake,
    kind: Kind,
    address: Address,
    ports: Box<dyn Ports>,
    /// Has a device that is plugged in opened before the next attempt is due.
    nodes: Option<NodeWatch>,
    /// The recording to be played, until it starts.
    replay: Option<Recorded>,
    /// Token of the brush that a played pen waits for: without it the first stroke would be lost.
    brush: Option<Subscription>,
    /// The device's reports, while it is open.
    stream: Option<ReportStream>,
    /// Time of the next attempt, ns; `None` while a recording takes the device's place.
    attempt_ns: Option<u64>,
    /// Reports dropped with devices that are gone.
    dropped_before: u64,
    /// Time of the newest report, ns.
    heard_ns: u64,
}

impl Connection {
    /// A connection that is not open.
    ///
    /// # Errors
    /// A [`UserError`] where the settings are wrong, or the recording cannot be read.
    pub(super) fn new(
        bus: Arc<dyn Bus>,
        wake: &Wake,
        kind: Kind,
        settings: &HidSettings,
        ports: Box<dyn Ports>,
    ) -> Result<Self, UserError> {
        let device = &settings.device;
        let replay = settings.replay.as_ref().or(device.replay.as_ref());
        let read = |path: &PathBuf| {
            recording::playable(kind, recording::read(path)?)
                .map_err(|fault| fault.at(path.display().to_string()))
        };
        Ok(Self {
            bus,
            wake: wake.clone(),
            kind,
            address: Address::parse(device.address.as_deref())?,
            nodes: ports.dev().and_then(NodeWatch::of),
            ports,
            replay: replay.map(read).transpose()?,
            brush: None,
            stream: None,
            attempt_ns: Some(0),
            dropped_before: 0,
            heard_ns: 0,
        })
    }

    /// Has a played pen wait for the brush of this name.
    ///
    /// # Errors
    /// [`BusError`].
    pub(super) fn wait_for(&mut self, topics: &Topics, brush: &str) -> Result<(), BusError> {
        let is_pen = matches!(self.kind, Kind::Pen | Kind::EventPen);
        if is_pen && self.replay.is_some() {
            let node = topics.node(&format!("{BRUSH_NODE}{brush}"));
            self.brush = Some(self.bus.watch(&node, &self.wake)?);
        }
        Ok(())
    }

    /// Reports dropped so far.
    pub(super) fn dropped(&self) -> u64 {
        self.dropped_before + self.stream.as_ref().map_or(0, ReportStream::dropped)
    }

    /// Time of the newest report, ns.
    pub(super) fn heard_ns(&self) -> u64 {
        self.heard_ns
    }

    /// True if the device is closed and an attempt to open it is due.
    pub(super) fn is_due(&mut self, now_ns: u64) -> bool {
        if self.stream.is_some() {
            return false;
        }
        if self.nodes.as_ref().is_some_and(NodeWatch::has_news) {
            self.attempt_ns = self.attempt_ns.map(|_| now_ns + SETTLING_NS);
        }
        self.attempt_ns.is_some_and(|at| now_ns >= at)
    }

    /// Looks for the device, or takes the recording in its place.
    ///
    /// # Errors
    /// A [`UserError`] where the recording cannot be played.
    pub(super) fn find(&mut self, now_ns: u64) -> Result<Attempt, UserError> {
        if let Some(brush) = &self.brush {
            // Tokens come and go, and the newest counts; the wake rings for the next.
            let newest = std::iter::from_fn(|| brush.try_recv()).last();
            if !newest.is_some_and(|token| token.present) {
                return Ok(Attempt::Waiting);
            }
            self.brush = None;
        }
        if let Some(recorded) = self.replay.take() {
            self.attempt_ns = None;
            let (identity, descriptor) = (recorded.identity, recorded.descriptor);
            return Ok(Attempt::Found(FoundDevice {
                means: Ok(open::means(self.kind, &identity, &descriptor)?),
                identity,
                descriptor,
                source: Source::Played(recorded.events),
            }));
        }
        self.attempt_ns = Some(now_ns + ATTEMPT_PERIOD_NS);
        Ok(
            match open::open(&mut *self.ports, self.kind, &self.address) {
                Ok(opened) => Attempt::Found(FoundDevice {
                    identity: opened.identity,
                    descriptor: opened.source.descriptor().to_vec(),
                    means: opened.means,
                    source: Source::Live(opened.source),
                }),
                Err(fault) => Attempt::Missing(fault),
            },
        )
    }

    /// Starts to read a device that was found.
    ///
    /// # Errors
    /// A [`UserError`] where the system has no thread for it.
    pub(super) fn start(&mut self, source: Source, now_ns: u64) -> Result<(), UserError> {
        self.stream = Some(match source {
            Source::Live(source) => {
                let bus = Arc::clone(&self.bus);
                ReportStream::Live(Live::start(source, bus, &self.wake)?)
            }
            Source::Played(events) => {
                // One without reports is over when it begins.
                self.heard_ns = now_ns;
                ReportStream::Played(Played::start(events, now_ns))
            }
        });
        Ok(())
    }

    /// The next item of the reports; absent while the device is closed. It is closed after the last one.
    pub(super) fn next(&mut self, now_ns: u64) -> Option<StreamItem> {
        let item = self.stream.as_mut()?.next(now_ns);
        match &item {
            StreamItem::Report(event) => self.heard_ns = event.time_ns,
            StreamItem::Nothing(_) => {}
            StreamItem::Over => self.close(),
            StreamItem::Lost(_) => {
                self.close();
                self.attempt_ns = Some(now_ns + ATTEMPT_PERIOD_NS);
            }
        }
        Some(item)
    }

    /// Closes the device.
    pub(super) fn close(&mut self) {
        self.dropped_before = self.dropped();
        self.stream = None;
    }
}
