//! The thread that talks to Haply's Inverse service, so that the servo never waits for it.
//!
//! The service answers each message by one state, so a round trip is a force out and a state in. The newest state goes
//! to the servo and its newest force comes back through triple buffers. A force that the servo has not renewed for 20
//! ms is replaced by 0: the servo may have stopped. So is one that the service has not answered for as long: a force of
//! 0 is sent before its answer is there.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU8, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use glam::{DQuat, DVec3};
use thread_priority::unix::{RealtimeThreadSchedulePolicy, ThreadSchedulePolicy};
use thread_priority::{ThreadPriority, ThreadPriorityValue};
use tungstenite::Bytes;

use super::connection::{Connection, End, SILENCE};
use super::message::{Dialect, Hindrance, Update, request};
use super::state::{DeviceTracker, Pose, Seen};
use crate::device::driver::DeviceError;
use crate::servo::clock::monotonic_ns;

/// Age beyond which a state or a force is discarded, ns.
pub const FRESH_NS: u64 = 20_000_000;
/// A round trip begins no sooner after the one before: four states a tick are enough.
const TRIP: Duration = Duration::from_micros(250);
/// `SCHED_FIFO` priority: below the servo's 80.
const PRIORITY: u8 = 70;

/// The newest state.
#[derive(Clone, Copy, Debug)]
pub struct ReceivedState {
    /// Pose of the device.
    pub pose: Pose,
    /// When it came, `CLOCK_MONOTONIC`, ns.
    pub at_ns: u64,
    /// Counts states, from 1.
    pub number: u64,
}

/// The newest force.
#[derive(Clone, Copy, Debug)]
pub struct RequestedForce {
    /// N, device frame.
    pub force: DVec3,
    /// Time of its request, `CLOCK_MONOTONIC`, ns.
    pub at_ns: u64,
}

/// The reason why the link ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Loss {
    Closed,
    Silent,
    Foreign,
    Unplugged,
    Nowhere,
    /// The thread has panicked.
    Failed,
    Hindered(Hindrance),
}

/// All of them, as they are numbered between the threads from 1 on.
const LOSSES: [Loss; 10] = [
    Loss::Closed,
    Loss::Silent,
    Loss::Foreign,
    Loss::Unplugged,
    Loss::Nowhere,
    Loss::Failed,
    Loss::Hindered(Hindrance::NoPower),
    Loss::Hindered(Hindrance::NotCalibrated),
    Loss::Hindered(Hindrance::NotReady),
    Loss::Hindered(Hindrance::UnknownAxes),
];

impl Loss {
    fn number(self) -> u8 {
        let place = LOSSES.iter().position(|loss| *loss == self);
        place.map_or(0, |place| place as u8 + 1)
    }

    fn error(self) -> DeviceError {
        let restart = "look whether it runs: `systemctl status haply-inverse-service`";
        let (what, help) = match self {
            Self::Closed => ("the Inverse service has closed the connection", restart),
            Self::Silent => ("the Inverse service does not answer any more", restart),
            Self::Foreign => (
                "the Inverse service sends what cannot be read",
                "bring the service up to date, or name its own address as the device's `address`",
            ),
            Self::Unplugged => ("the Inverse3 is unplugged", "plug it in again"),
            Self::Nowhere => (
                "the Inverse3 tells places where its cursor cannot be",
                "put the grip into its rest, and switch the Inverse3 off and on",
            ),
            Self::Failed => (
                "the Inverse3's driver has failed",
                "its own message above says why",
            ),
            Self::Hindered(hindrance) => (hindrance.what(), hindrance.help()),
        };
        DeviceError {
            what,
            code: 0,
            help,
        }
    }
}

/// The servo's end of the thread.
#[derive(Debug)]
pub struct Link {
    told: triple_buffer::Output<ReceivedState>,
    asked: triple_buffer::Input<RequestedForce>,
    stop: Arc<AtomicBool>,
    lost: Arc<AtomicU8>,
    thread: Option<JoinHandle<()>>,
}

impl Link {
    /// Starts the thread over a connection.
    ///
    /// # Errors
    /// The system's error if no thread can be started.
    pub fn start(
        connection: Connection,
        tracker: DeviceTracker,
        dialect: Dialect,
    ) -> std::io::Result<Self> {
        let nothing = ReceivedState {
            pose: Pose {
                position: DVec3::ZERO,
                velocity: None,
                orientation: DQuat::IDENTITY,
                switches: 0,
                in_range: false,
            },
            at_ns: 0,
            number: 0,
        };
        let none = RequestedForce {
            force: DVec3::ZERO,
            at_ns: 0,
        };
        let (tell, told) = triple_buffer::triple_buffer(&nothing);
        let (asked, wanted) = triple_buffer::triple_buffer(&none);
        let stop = Arc::new(AtomicBool::new(false));
        let lost = Arc::new(AtomicU8::new(0));
        let mut exchange = Exchange {
            connection,
            tracker,
            dialect,
            tell,
            wanted,
            stop: Arc::clone(&stop),
            number: 0,
            is_owed: false,
        };
        let ending = Ending(Arc::clone(&lost));
        let thread = std::thread::Builder::new()
            .name("inverse3".into())
            .spawn(move || {
                become_real_time();
                if let Some(why) = exchange.run() {
                    ending.tell(why);
                }
                exchange.part();
            })?;
        Ok(Self {
            told,
            asked,
            stop,
            lost,
            thread: Some(thread),
        })
    }

    /// The newest state.
    ///
    /// # Errors
    /// Reason why there will be none any more.
    pub fn newest(&mut self) -> Result<ReceivedState, DeviceError> {
        match usize::from(self.lost.load(Ordering::Acquire)) {
            0 => Ok(*self.told.read()),
            number => Err(LOSSES[(number - 1).min(LOSSES.len() - 1)].error()),
        }
    }

    /// Asks for a force.
    pub fn ask(&mut self, asked: RequestedForce) {
        self.asked.write(asked);
    }
}

/// The thread ends with a message of no force, then closes the connection.
impl Drop for Link {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            thread.join().ok();
        }
    }
}

/// Tells the servo that there is nothing more, also where the thread panics.
struct Ending(Arc<AtomicU8>);

impl Ending {
    fn tell(&self, why: Loss) {
        self.0.store(why.number(), Ordering::Release);
    }
}

impl Drop for Ending {
    fn drop(&mut self) {
        if std::thread::panicking() {
            self.tell(Loss::Failed);
        }
    }
}

/// State of the thread.
struct Exchange {
    connection: Connection,
    tracker: DeviceTracker,
    dialect: Dialect,
    tell: triple_buffer::Input<ReceivedState>,
    wanted: triple_buffer::Output<RequestedForce>,
    stop: Arc<AtomicBool>,
    number: u64,
    /// True if a message that requested no force ahead of time may yet be answered.
    is_owed: bool,
}

impl Exchange {
    /// Exchanges messages until the stop flag is set, or the device is lost.
    fn run(&mut self) -> Option<Loss> {
        let mut seen = Instant::now();
        let mut why = Loss::Silent;
        while !self.stop.load(Ordering::Relaxed) {
            let begun = Instant::now();
            match self.trip() {
                Ok(Seen::Pose(_)) => seen = begun,
                Ok(Seen::Nothing) => why = Loss::Unplugged,
                Ok(Seen::Nowhere) => why = Loss::Nowhere,
                Ok(Seen::Hindered(hindrance)) => return Some(Loss::Hindered(hindrance)),
                Err(Missed::Unread) => why = Loss::Foreign,
                Err(Missed::Ended(end)) => {
                    return match end {
                        End::Stopped => None,
                        End::Closed => Some(Loss::Closed),
                        End::Silent => Some(Loss::Silent),
                        End::Foreign => Some(Loss::Foreign),
                    };
                }
            }
            if seen.elapsed() >= SILENCE {
                return Some(why);
            }
            // The service answers at once, and each answer costs it a core: a few a millisecond are enough.
            std::thread::sleep(TRIP.saturating_sub(begun.elapsed()));
        }
        None
    }

    /// A force out, a state in.
    fn trip(&mut self) -> Result<Seen, Missed> {
        // The answer to a message too many would be one of long ago to each that follows.
        if self.is_owed && self.connection.waiting()?.is_some() {
            self.is_owed = false;
        }
        let asked = *self.wanted.read();
        let is_fresh = monotonic_ns().saturating_sub(asked.at_ns) <= FRESH_NS;
        self.send(if is_fresh {
            self.tracker.basis().to_session(asked.force)
        } else {
            DVec3::ZERO
        })?;
        let bytes = self.answer()?;
        let at_ns = monotonic_ns();
        let update = Update::read(&bytes).map_err(|_| Missed::Unread)?;
        let seen = self.tracker.take(&update, at_ns);
        if let Seen::Pose(pose) = seen {
            self.number += 1;
            self.tell.write(ReceivedState {
                pose,
                at_ns,
                number: self.number,
            });
        }
        Ok(seen)
    }

    /// The service's answer. A force that is not answered in time is taken back.
    fn answer(&mut self) -> Result<Bytes, Missed> {
        let patience = Duration::from_nanos(FRESH_NS);
        match self.connection.receive(&self.stop, patience) {
            Err(End::Silent) => {}
            answer => return Ok(answer?),
        }
        self.send(DVec3::ZERO)?;
        self.is_owed = true;
        Ok(self.connection.receive(&self.stop, SILENCE)?)
    }

    /// Asks for a force, N, in the session's axes.
    fn send(&mut self, force: DVec3) -> Result<(), Missed> {
        let text =
            request(self.tracker.device(), force, self.dialect).map_err(|_| Missed::Unread)?;
        Ok(self.connection.send(text)?)
    }

    /// The last words: no force.
    fn part(mut self) {
        if self.send(DVec3::ZERO).is_ok() {
            self.connection.close();
        }
    }
}

/// The reason why a round trip brought nothing.
enum Missed {
    /// The message cannot be read.
    Unread,
    /// Nothing came, and nothing will.
    Ended(End),
}

impl From<End> for Missed {
    fn from(end: End) -> Self {
        Self::Ended(end)
    }
}

/// A force waits for no picture. Where it is not permitted the servo's thread says so already.
fn become_real_time() {
    let policy = ThreadSchedulePolicy::Realtime(RealtimeThreadSchedulePolicy::Fifo);
    let Ok(priority) = ThreadPriorityValue::try_from(PRIORITY) else {
        return;
    };
    thread_priority::set_thread_priority_and_policy(
        thread_priority::thread_native_id(),
        ThreadPriority::Crossplatform(priority),
        policy,
    )
    .ok();
}
