//! `maulstick recording replay`: a recording into a running rig.
//!
//! | module | holds |
//! | --- | --- |
//! | [`session`] | a session is painted again |
//! | [`streams`] | messages of chosen topics are sent again |
//! | [`pacing`] | no faster than brushes follow |
//! | [`driven`] | the device whose hand feels it |
//! | [`consent`] | its consent |
//! | [`guide`], [`traced`] | its strokes guide a hand that paints |
//! | [`place`] | a take elsewhere on the desk |
//! | [`transport`], [`orders`] | pause, seek, step, rate |
//! | [`events`] | what is to come |

mod consent;
mod driven;
mod events;
mod guide;
mod orders;
mod pacing;
mod place;
mod session;
mod streams;
mod traced;
mod transport;

use std::path::PathBuf;
use std::time::{Duration, Instant};

use clap::Args;
use maulstick_bus::RigFolder;
use maulstick_device::player::Rate;
use maulstick_rig::{NodeArgs, NodeHandle, UserError};
use maulstick_streams::Recording;
use serde_json::json;

use self::orders::{KEYS, Orders};
use self::place::PlaceOptions;
use self::transport::{Order, Transport, parse_rate, parse_strength};
use crate::EXIT_INTERRUPTED;
use crate::commands::client::Target;
use crate::commands::print_json_line;
use crate::commands::takes::session_file::{PAINTING, SessionFile};

/// Options of `maulstick recording replay`.
#[derive(Args, Clone, Debug)]
pub struct ReplayOptions {
    /// Recording, or take
    recording: PathBuf,
    /// Rate: .1 to 100 (1 = real time), or 'max'
    #[arg(long, value_name = "R|max", default_value = "1", value_parser = parse_rate)]
    rate: Rate,
    /// From so many seconds after its beginning
    #[arg(long, value_name = "S", default_value_t = 0.0)]
    start: f64,
    /// To so many seconds after its beginning [default: its end]
    #[arg(long, value_name = "S")]
    end: Option<f64>,
    /// Begin anew at the end
    #[arg(long = "loop")]
    again: bool,
    /// Begin paused: the key . goes on by one event
    #[arg(long)]
    step: bool,
    /// Send the messages of these topics again, such as stylus/*/sample; may be given several times [default: a session is
    /// painted again; of any other recording the samples of the hands]
    #[arg(short, long, value_name = "TOPIC")]
    topic: Vec<String>,
    /// Send topic A as B; may be given several times
    #[arg(long, value_name = "A=B")]
    remap: Vec<String>,
    /// Send samples of a stylus as this device's
    #[arg(long = "as", value_name = "DEVICE")]
    device: Option<String>,
    /// Let recorded contact models move the hand that holds this device
    #[arg(long, value_name = "DEVICE")]
    drive: Option<String>,
    /// Guide the hand that holds this device along the recorded strokes; it paints, and nothing is played
    #[arg(long, value_name = "DEVICE", conflicts_with_all = ["drive", "device", "remap", "rate", "step", "at", "scale", "turn"])]
    guide: Option<String>,
    /// Strength of the guide, 0 to 1
    #[arg(long, value_name = "P", default_value_t = 0.5, value_parser = parse_strength, requires = "guide")]
    strength: f64,
    #[command(flatten)]
    place: PlaceOptions,
    #[command(flatten)]
    painting: PaintingOptions,
    /// Read orders from the standard input (pause, step, seek S, skip S, rate R, strength P, end), and print the position as lines of JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    target: Target,
}

/// Where a session is painted again.
#[derive(Args, Clone, Debug)]
struct PaintingOptions {
    /// Painting to write, in which a session is painted again [default: RECORDING-replay.maul]
    #[arg(short, long, value_name = "FILE")]
    document: Option<PathBuf>,
    /// Discard the current painting if it is in memory only
    #[arg(long)]
    forget: bool,
}

/// Time between two lines that say where it is.
const REPORT_PERIOD: Duration = Duration::from_millis(200);
/// Longest wait for the next event while orders may come.
const TURN: Duration = Duration::from_millis(20);

impl ReplayOptions {
    /// Start and end of what is played of a recording of this length, ns.
    fn range_ns(&self, length_ns: u64) -> Result<[u64; 2], UserError> {
        let length_s = length_ns as f64 * 1e-9;
        let end_s = self.end.unwrap_or(length_s);
        if !(self.start >= 0.0 && self.start < end_s && self.start < length_s) {
            let what = format!("--start {} is not before the end", self.start);
            return Err(UserError::usage(what)
                .at(self.recording.display().to_string())
                .help(format!("it is {length_s:.1} s long")));
        }
        Ok([
            (self.start * 1e9) as u64,
            ((end_s * 1e9) as u64).min(length_ns),
        ])
    }

    /// Joins the rig as a member of its own.
    fn join(&self) -> Result<NodeHandle, UserError> {
        let (folder, _) = RigFolder::join(self.target.rig())?;
        NodeHandle::join(&NodeArgs {
            folder: folder.path().to_owned(),
            node: format!("replay-{}", std::process::id()),
            guarded: false,
        })
    }
}

/// Plays a recording into a running rig.
///
/// # Errors
/// A [`UserError`] where no rig runs, the recording lacks something, or the rig refuses it.
pub fn run(options: &ReplayOptions) -> Result<i32, UserError> {
    if let Some(device) = &options.guide {
        return guide::guide(options, device);
    }
    let sends = !options.topic.is_empty()
        || options.device.is_some()
        || options.drive.is_some()
        || options.place.is_given();
    let recording = Recording::open(&options.recording)?;
    if !sends
        && recording.attachments().contains_key(PAINTING)
        && let Some(session) = SessionFile::of(recording.clone())?
    {
        return session::replay(options, &session);
    }
    streams::replay(options, &recording)
}

/// What plays: the transport, its orders, and what is told of them.
struct Playback {
    transport: Transport,
    orders: Orders,
    begun: Instant,
    reported: Option<Instant>,
    json: bool,
}

/// A leap of a replay.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Leap {
    /// To before what was played.
    Back,
    /// Over what is between.
    Forth,
}

/// What an order asks of a player.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Turn {
    /// To play on.
    On,
    /// To go on elsewhere.
    Leap(Leap),
    /// To end.
    End,
}

impl Playback {
    fn new(options: &ReplayOptions, range_ns: [u64; 2]) -> Result<Self, UserError> {
        let orders = Orders::listen(options.json)?;
        if orders.are_keys() {
            eprintln!("{KEYS}");
        }
        Ok(Self {
            transport: Transport::new(range_ns, options.rate, options.step),
            orders,
            begun: Instant::now(),
            reported: None,
            json: options.json,
        })
    }

    /// Carries out the orders that came, and lets the transport go on; the times are those of the next event, and of the
    /// newest one that was played.
    fn turn(&mut self, next_ns: Option<u64>, played_ns: u64) -> Result<Turn, UserError> {
        self.transport.look(self.begun.elapsed().as_nanos() as u64);
        let mut leaps = false;
        while let Some(order) = self.orders.next() {
            if order == Order::End {
                return Ok(Turn::End);
            }
            leaps |= matches!(order, Order::Seek(_) | Order::Skip(_));
            self.transport.wait_for(next_ns);
            self.transport.order(order, next_ns);
            self.reported = None;
            if order == Order::Step {
                break;
            }
        }
        self.report(next_ns)?;
        Ok(match (leaps, self.transport.position_ns() < played_ns) {
            (false, _) => Turn::On,
            (true, true) => Turn::Leap(Leap::Back),
            (true, false) => Turn::Leap(Leap::Forth),
        })
    }

    /// Says where it is, at most five times a second.
    fn report(&mut self, next_ns: Option<u64>) -> Result<(), UserError> {
        if self
            .reported
            .is_some_and(|reported| reported.elapsed() < REPORT_PERIOD)
        {
            return Ok(());
        }
        self.reported = Some(Instant::now());
        let position_ns = self.transport.position_ns();
        let s = next_ns.map_or(position_ns, |next_ns| position_ns.min(next_ns)) as f64 * 1e-9;
        let (rate, paused) = (self.transport.rate(), self.transport.is_paused());
        if self.json {
            let end_s = self.transport.end_ns() as f64 * 1e-9;
            return print_json_line(&json!({
                "position_s": s,
                "length_s": end_s,
                "rate": rate.to_string(),
                "paused": paused,
            }));
        }
        if self.orders.are_keys() {
            let paused = if paused { "  paused" } else { "        " };
            eprint!("\r{s:8.1} s  × {rate}{paused}  ");
        }
        Ok(())
    }

    /// The exit code, after the line of the position.
    fn end(self, member: &NodeHandle) -> i32 {
        if self.orders.are_keys() {
            eprintln!();
        }
        member.stop.exit_code(EXIT_INTERRUPTED)
    }
}
