//! The pen on the desk: touches, samples, what the window hears of it.

use std::sync::Arc;

use maulstick_bus::typed::Sender;
use maulstick_bus::{Bus, BusError, CreditSender, Qos, Wake};
use maulstick_device::pen::{End, Presence, Reading, STEEPEST_RAD};
use maulstick_device::pen_stream::{DeskFit, GONE_NS, PenStream};
use maulstick_rig::UserError;
use maulstick_rig::config::PEN_PRIORITY;
use maulstick_types::Origin;
use maulstick_types::limits::FARTHEST_M;
use maulstick_types::stylus::{
    DEFAULT_TILT_RAD, StylusInfo, StylusPose, StylusSample, StylusStatus, Trouble, axes, switch,
};
use maulstick_types::wire::topics::Topics;

use crate::clock::WindowClock;
use crate::reading::{Axes, PenReading, Tool};
use crate::window::{PenLink, PointerEvent};

/// Interval at which lost samples are answered for, ns, for [`GONE_NS`] after the last reading.
const SERVE_NS: u64 = 50_000_000;
/// Samples a second of most pens, which do not say.
const RATE_HZ: f64 = 200.0;

/// Target of a touch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum TouchTarget {
    Desk,
    Panel,
}

/// The pens of a window, as one stylus: the first that is near is followed until it leaves.
pub struct WindowStylus {
    bus: Arc<dyn Bus>,
    link: PenLink,
    stream: PenStream,
    desk: Desk,
    info: Sender<StylusInfo>,
    status: Sender<StylusStatus>,
    sent_info: StylusInfo,
    clock: WindowClock,
    tool: Option<Tool>,
    touched: Option<TouchTarget>,
    /// The newest reading, and when it was read, ns.
    newest: Option<(PenReading, u64)>,
}

/// Where a reading lies on the desk.
#[derive(Debug)]
struct Desk {
    axes: Axes,
    /// Newest point of the desk, m.
    point_m: [f64; 3],
    mirrored: bool,
}

impl DeskFit for Desk {
    fn sample(&mut self, reading: &Reading) -> StylusSample {
        let side = if self.mirrored { -1.0 } else { 1.0 };
        let steep = |tilt: f64| {
            if tilt.is_finite() {
                tilt.clamp(-STEEPEST_RAD, STEEPEST_RAD)
            } else {
                0.0
            }
        };
        let tilt_rad = reading.tilt_rad.filter(|_| self.axes.tilt);
        let twist_rad = reading
            .twist_rad
            .filter(|twist| self.axes.twist && twist.is_finite());
        let eraser = match reading.end {
            End::Tip => 0,
            End::Eraser => switch::ERASER,
        };
        StylusSample {
            senses: self.axes.bits(),
            pose: StylusPose::Contact {
                point_m: self.point_m.map(|at| at.clamp(-FARTHEST_M, FARTHEST_M)),
                tilt_rad: tilt_rad.map_or(DEFAULT_TILT_RAD, |[x, y]| [side * steep(x), steep(y)]),
                twist_rad: side * twist_rad.unwrap_or(0.0),
                pressure: match reading.presence {
                    Presence::Touching => reading.pressure.clamp(0.0, 1.0),
                    _ => 0.0,
                },
            },
            switches: reading.switches | eraser,
            in_range: reading.presence != Presence::Away,
            ..StylusSample::away()
        }
    }
}

impl WindowStylus {
    /// A stylus that is called `name` on the bus.
    ///
    /// # Errors
    /// [`BusError::Topic`].
    pub fn new(
        bus: Arc<dyn Bus>,
        topics: &Topics,
        (name, me): (&str, Origin),
        link: PenLink,
    ) -> Result<Self, BusError> {
        let wake = Wake::new();
        let samples = CreditSender::new(&*bus, topics, &topics.sample(name), me, &wake)?;
        let sent_info = StylusInfo {
            device: name.to_owned(),
            driver: "window".into(),
            brush: String::new(),
            priority: PEN_PRIORITY,
            senses: axes::POSITION,
            drives: 0,
            rate_hz: RATE_HZ,
            max_force_n: 0.0,
            max_stiffness_n_m: 0.0,
            workspace_m: [-0.5, -0.5, 0.0, 0.5, 0.5, 0.0],
        };
        Ok(Self {
            info: Sender::new(&*bus, &topics.stylus_info(name), Qos::Cached, me)?,
            status: Sender::new(&*bus, &topics.stylus_status(name), Qos::Background, me)?,
            bus,
            link,
            stream: PenStream::new(samples),
            desk: Desk {
                axes: Axes::default(),
                point_m: [0.0; 3],
                mirrored: false,
            },
            sent_info,
            clock: WindowClock::default(),
            tool: None,
            touched: None,
            newest: None,
        })
    }

    /// Its link to the window.
    #[must_use]
    pub fn link(&self) -> &PenLink {
        &self.link
    }

    /// A reading.
    ///
    /// # Errors
    /// [`BusError`].
    pub fn read(&mut self, read: &PenReading) -> Result<(), BusError> {
        let now_ns = self.bus.now_ns();
        let event_ns = self.clock.event_ns(read.time_ms, now_ns);
        if !read.point_px.iter().all(|at| at.is_finite()) {
            return Ok(());
        }
        let other = self.tool.is_some_and(|tool| tool != read.tool);
        if other && self.touched.is_some() {
            // Another pen waits until this one is lifted.
            return Ok(());
        }
        if other {
            self.away(event_ns, now_ns)?;
        }
        self.tool = match read.reading.presence {
            Presence::Away => None,
            _ => Some(read.tool),
        };
        self.introduce(read.axes, now_ns)?;
        let reading = self.place(read);
        self.newest = Some((*read, now_ns));
        let pressure = read.reading.pressure;
        self.link.tell(now_ns, read.reading.presence, pressure);
        self.stream
            .read(reading, (event_ns, now_ns), &mut self.desk)
    }

    /// The pen and its brush, where the window or another tool has changed them.
    fn introduce(&mut self, axes: Axes, now_ns: u64) -> Result<(), BusError> {
        let brush = self.link.brush();
        let senses = axes.bits();
        self.desk.axes = axes;
        if self.sent_info.brush == brush && self.sent_info.senses == senses {
            return Ok(());
        }
        if self.sent_info.brush != brush {
            // The brush that was in the hand is lifted first.
            self.stream.leave(now_ns, now_ns, &mut self.desk)?;
        }
        (self.sent_info.brush, self.sent_info.senses) = (brush, senses);
        self.link.senses(senses);
        self.info.send(now_ns, now_ns, &self.sent_info)
    }

    /// Finds a reading on the desk: over a panel, and while it operates one, the brush is away.
    fn place(&mut self, read: &PenReading) -> Reading {
        let reading = read.reading;
        let seen = self.link.desk(read.point_px);
        let is_desk = seen.is_some_and(|seen| seen.is_desk);
        if let Some(seen) = seen {
            (self.desk.point_m, self.desk.mirrored) = (seen.point_m, seen.is_mirrored);
        }
        let before = self.touched;
        self.touched = match (reading.presence, before) {
            (Presence::Touching, Some(touched)) => Some(touched),
            (Presence::Touching, None) if seen.is_some_and(|seen| seen.takes_strokes) => {
                Some(TouchTarget::Desk)
            }
            (Presence::Touching, None) => Some(TouchTarget::Panel),
            _ => None,
        };
        self.point(read, before);
        let on_desk = match self.touched {
            Some(touched) => touched == TouchTarget::Desk,
            None => is_desk || before == Some(TouchTarget::Desk),
        };
        if on_desk && seen.is_some() {
            Reading {
                pressure: self.link.given(reading.pressure),
                ..reading
            }
        } else {
            Reading {
                presence: Presence::Away,
                ..reading
            }
        }
    }

    /// Tells the window what the pen's pointer does: on the desk it presses nothing.
    fn point(&self, read: &PenReading, before: Option<TouchTarget>) {
        let panel = Some(TouchTarget::Panel);
        if read.reading.presence != Presence::Away {
            self.link.point(PointerEvent::Moved(read.point_px));
        }
        if (before == panel) != (self.touched == panel) {
            let presses = self.touched == panel;
            self.link
                .point(PointerEvent::Pressed(read.point_px, presses));
        }
        if read.reading.presence == Presence::Away {
            self.link.point(PointerEvent::Gone);
        }
    }

    /// The tool is gone, or another is there.
    fn away(&mut self, event_ns: u64, now_ns: u64) -> Result<(), BusError> {
        let touched = self.touched.take();
        if let (Some(_), Some((newest, _))) = (self.tool.take(), self.newest) {
            let mut gone = newest;
            gone.reading.presence = Presence::Away;
            self.point(&gone, touched);
        }
        self.link.tell(now_ns, Presence::Away, 0.0);
        self.stream.leave(event_ns, now_ns, &mut self.desk)
    }

    /// All tools are gone: their window or its system is.
    ///
    /// # Errors
    /// [`BusError`].
    pub fn end(&mut self) -> Result<(), BusError> {
        let now_ns = self.bus.now_ns();
        self.away(now_ns, now_ns)
    }

    /// Tells why no pen is read, and what to do.
    pub fn fail(&mut self, fault: &UserError) {
        let trouble = Trouble {
            what: &fault.what,
            help: fault.help.as_deref().unwrap_or_default(),
        };
        tracing::warn!("{trouble}");
        let mut status = StylusStatus {
            samples: self.stream.sent(),
            ..StylusStatus::fresh(0)
        };
        status.report(trouble);
        let now_ns = self.bus.now_ns();
        if let Err(error) = self.status.send(now_ns, now_ns, &status) {
            tracing::debug!("its status is not sent: {error}");
        }
    }

    /// Nothing came until now.
    ///
    /// # Errors
    /// [`BusError`].
    pub fn rest(&mut self) -> Result<(), BusError> {
        let now_ns = self.bus.now_ns();
        self.stream.silent(now_ns, now_ns, &mut self.desk)?;
        if self.gone_ns().is_some_and(|gone_ns| gone_ns <= now_ns) {
            self.away(now_ns, now_ns)?;
        }
        Ok(())
    }

    /// Answers for lost samples.
    ///
    /// # Errors
    /// [`BusError`].
    pub fn serve(&mut self) -> Result<(), BusError> {
        self.stream.serve(self.bus.now_ns())
    }

    /// Time at which a pen that hovers in silence counts as away, also over a panel, ns; `None` if that will be said.
    fn gone_ns(&self) -> Option<u64> {
        let (newest, read_ns) = self.newest?;
        let hovers = self.tool.is_some() && newest.reading.presence == Presence::Hovering;
        (hovers && !newest.axes.range).then_some(read_ns + GONE_NS)
    }

    /// Time until [`rest`](Self::rest) is due, ns; `None` while no pen is near and no sample may be asked for.
    #[must_use]
    pub fn due_in_ns(&self) -> Option<u64> {
        let now_ns = self.bus.now_ns();
        let read_ns = self.newest.map(|(_, read_ns)| read_ns);
        let serves = read_ns.is_some_and(|read_ns| now_ns < read_ns + GONE_NS);
        let due_ns = [
            self.stream.due_ns(),
            self.gone_ns(),
            serves.then_some(now_ns + SERVE_NS),
        ];
        let due_ns = due_ns.into_iter().flatten().min()?;
        Some(due_ns.saturating_sub(now_ns))
    }
}

impl std::fmt::Debug for WindowStylus {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("WindowStylus")
            .field("sent_info", &self.sent_info)
            .field("tool", &self.tool)
            .field("touched", &self.touched)
            .finish_non_exhaustive()
    }
}
