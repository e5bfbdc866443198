//! `maulstick recording replay`: a recording into a running rig.
//!
//! | module | holds |
//! | --- | --- |
//! | [`orders`] | orders from keys of a terminal, or from lines of another program |
//! | [`reports`] | reports of the player on a terminal, or as lines of JSON |

mod orders;
mod reports;

use std::collections::BTreeMap;
use std::path::PathBuf;

use clap::Args;
use maulstick_device::player::Rate;
use maulstick_recorder::{GuideSettings, Player, ReplaySettings, TakePlace};
use maulstick_rig::UserError;
use tokio::runtime::Handle;

use maulstick_tool_options::motion::{HeadOptions, parse_place};

use self::orders::{Orders, parse_rate, parse_strength};
use self::reports::Reports;
use crate::commands::client::Target;
use crate::runtime::{EndSignals, block_on, exit_code};

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

/// Options of repainting a session.
#[derive(Args, Clone, Debug)]
struct PaintingOptions {
    /// Painting to write, in which a session is painted again [default: RECORDING-replay.maul]
    #[arg(short, long, value_name = "FILE")]
    document: Option<PathBuf>,
    /// Discard the current painting if it is in memory only
    #[arg(long)]
    forget: bool,
}

/// Options of placing a take.
#[derive(Args, Clone, Copy, Debug)]
struct PlaceOptions {
    /// Put the middle of a take's strokes here, mm from the middle of the desk [default: where it was]
    #[arg(long, value_name = "X,Y", value_parser = parse_place, allow_hyphen_values = true)]
    at: Option<[f64; 2]>,
    /// Scale a take by this, .01 to 100; pressures stay [default: 1]
    #[arg(long, value_name = "FACTOR", allow_negative_numbers = true)]
    scale: Option<f64>,
    /// Turn a take by this, degrees, counter-clockwise [default: 0]
    #[arg(long, value_name = "DEG", allow_negative_numbers = true)]
    turn: Option<f64>,
    #[command(flatten)]
    head: HeadOptions,
}

impl PlaceOptions {
    fn place(self) -> Result<Option<TakePlace>, UserError> {
        let is_given = self.at.is_some() || self.scale.is_some() || self.turn.is_some();
        let place = TakePlace {
            at_mm: self.at,
            scale: self.scale,
            turn_deg: self.turn,
            head_m: self.head.given_m()?,
        };
        Ok(is_given.then_some(place))
    }
}

impl ReplayOptions {
    fn settings(&self) -> Result<ReplaySettings, UserError> {
        let guide = self.guide.as_ref().map(|device| GuideSettings {
            device: device.clone(),
            strength: self.strength,
        });
        Ok(ReplaySettings {
            recording: self.recording.clone(),
            rate: self.rate,
            start_s: self.start,
            end_s: self.end,
            repeats: self.again,
            paused: self.step,
            topics: self.topic.clone(),
            renamed: renamed(&self.remap)?,
            device: self.device.clone(),
            drive: self.drive.clone(),
            guide,
            place: self.place.place()?,
            document: self.painting.document.clone(),
            forget: self.painting.forget,
        })
    }
}

/// Topics by the names that they are to have.
fn renamed(pairs: &[String]) -> Result<BTreeMap<String, String>, UserError> {
    let pair = |pair: &String| {
        let (from, to) = pair.split_once('=')?;
        let is_topic =
            |topic: &str| !topic.is_empty() && topic.split('/').all(|part| !part.is_empty());
        (is_topic(from) && is_topic(to)).then(|| (from.to_owned(), to.to_owned()))
    };
    let pairs = pairs.iter().map(|own| {
        pair(own).ok_or_else(|| {
            UserError::usage(format!("--remap {own} is not A=B"))
                .help("two topics, such as stylus/pen/sample=stylus/other/sample")
        })
    });
    pairs.collect()
}

/// Plays a recording into a running rig.
///
/// # Errors
/// A [`UserError`] where no rig runs, the recording lacks something, or the rig refuses it.
pub fn run(options: &ReplayOptions) -> Result<i32, UserError> {
    let settings = options.settings()?;
    block_on(async {
        let mut signals = EndSignals::watch()?;
        let mut player = Player::start(&Handle::current(), options.target.rig(), settings);
        let (mut orders, mut reports) = (Orders::new(options.json), Reports::new(options.json));
        let (mut code, mut shown) = (0, Ok(()));
        loop {
            tokio::select! {
                report = player.events.recv() => match report {
                    Some(report) => {
                        orders.listen(&report);
                        shown = shown.and_then(|()| reports.show(&report, orders.are_keys()));
                    }
                    None => break,
                },
                order = orders.next() => player.order(order),
                signal = signals.next() => {
                    code = exit_code(signal);
                    player.stop();
                }
            }
            // The reader is gone: the player lifts its hands and leaves.
            if shown.is_err() {
                player.stop();
            }
        }
        drop(orders);
        let ended = player.ended().await;
        shown?;
        reports.end(ended.is_ok())?;
        ended?;
        Ok(code)
    })
}
