//! The player: a device that plays a take.
//!
//! It announces the take, sends its samples with the replay flag at their time or as fast as credit allows, and reports
//! the progress of the take. `event_ns` is start + take time at every rate, so the painting does not depend on the
//! rate.

use std::time::Duration;

use maulstick_bus::credit::Stamp;
use maulstick_bus::typed::{Receiver, Sender};
use maulstick_bus::{CreditSender, Qos, Queue};
use maulstick_rig::{NodeHandle, UserError, config};
use maulstick_types::brush::BrushConsumed;
use maulstick_types::command::{After, TakeCommand};
use maulstick_types::node::NodeWork;
use maulstick_types::stylus::{StylusInfo, StylusSample, TakeEnd, TakeStatus, axes};
use maulstick_types::values::BrushName;
use maulstick_types::{Flags, Mixture, Origin, name_hash};

use maulstick_rig::command_client::CommandClient;

use crate::take::Take;

/// Playback rate of a take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rate {
    /// This many seconds of the take a second.
    Times(f64),
    /// As fast as credit allows.
    Max,
}

/// A text that is not a playback rate.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("'{0}' is neither a number above 0 nor 'max'")]
pub struct RateError(pub String);

impl std::str::FromStr for Rate {
    type Err = RateError;

    fn from_str(text: &str) -> Result<Self, RateError> {
        if text == "max" {
            return Ok(Self::Max);
        }
        match text.parse::<f64>() {
            Ok(rate) if rate > 0.0 && rate.is_finite() => Ok(Self::Times(rate)),
            _ => Err(RateError(text.to_owned())),
        }
    }
}

impl std::fmt::Display for Rate {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Times(rate) => write!(f, "{rate}"),
            Self::Max => f.write_str("max"),
        }
    }
}

/// Settings of a player.
#[derive(Clone, Debug)]
pub struct PlayerSettings {
    /// The take.
    pub take: Take,
    /// Playback rate.
    pub rate: Rate,
    /// Take time up to which it plays as fast as it can, ns: where a rig that died had been.
    pub resume_ns: u64,
    /// The brush that it moves.
    pub brush: String,
    /// Loads of the strokes, in turn.
    pub loads: Vec<Mixture>,
    /// True to stay after the end and report it, until stopped.
    pub stay: bool,
    /// True to undo first the strokes of it that were painted before a crash.
    pub again: bool,
}

/// Time between two statuses, ns.
const STATUS_PERIOD_NS: u64 = 100_000_000;
/// Longest wait for a paint node that accepts the take.
const ANNOUNCE: Duration = Duration::from_secs(20);

/// Plays a take in the rig of `member`.
///
/// # Errors
/// A [`UserError`] where the take is refused or the rig is gone.
pub fn run(member: &mut NodeHandle, settings: &PlayerSettings) -> Result<(), UserError> {
    let origin = member.origin(&member.node);
    let mut player = Player::new(member, settings, origin)?;
    let stop = member.stop.clone();
    let mut commander = CommandClient::new(member.bus.clone(), &member.topics);
    let announce = TakeCommand::Begin {
        again: settings.again,
        brush: BrushName::new(&*settings.brush)?,
        device: origin.source,
        device_epoch: origin.epoch,
        loads: settings.loads.clone(),
    };
    commander.send(announce, None, ANNOUNCE, &|| stop.requested())?;
    member.ready()?;
    member.run(|| {
        let wait = player.poll()?;
        member.work.set(player.work());
        if player.ended() && !settings.stay {
            stop.request();
        }
        Ok(wait)
    })
}

/// A take being played.
struct Player<'a> {
    settings: &'a PlayerSettings,
    bus: std::sync::Arc<dyn maulstick_bus::Bus>,
    samples: CreditSender<StylusSample>,
    credit: Receiver<BrushConsumed>,
    status: Sender<TakeStatus>,
    _info: Sender<StylusInfo>,
    start_ns: u64,
    /// Rig time at which the sample of take time `pace_from_ns` is due.
    pace_ns: Option<u64>,
    pace_from_ns: u64,
    sent: usize,
    newest: Option<BrushConsumed>,
    status_ns: u64,
}

impl<'a> Player<'a> {
    fn new(
        member: &NodeHandle,
        settings: &'a PlayerSettings,
        origin: Origin,
    ) -> Result<Self, UserError> {
        let (bus, topics, node) = (&*member.bus, &member.topics, &member.node);
        let consumed = topics.brush_consumed(&settings.brush);
        let mut info = Sender::new(bus, &topics.stylus_info(node), Qos::Cached, origin)?;
        let now = bus.now_ns();
        let told = StylusInfo {
            device: node.clone(),
            driver: "player".into(),
            brush: settings.brush.clone(),
            priority: config::PLAYER_PRIORITY,
            senses: settings
                .take
                .samples
                .iter()
                .fold(axes::POSITION, |all, s| all | s.sample.senses),
            drives: 0,
            rate_hz: settings.take.samples.len() as f64 * 1e9
                / settings.take.length_ns().max(1) as f64,
            max_force_n: 0.0,
            max_stiffness_n_m: 0.0,
            workspace_m: [-0.5, -0.5, 0.0, 0.5, 0.5, 0.5],
        };
        info.send(now, now, &told)?;
        Ok(Self {
            settings,
            samples: CreditSender::new(bus, topics, &topics.sample(node), origin, &member.wake)?,
            credit: Receiver::new(bus, &consumed, Qos::Control, Queue::Ring(256), &member.wake)?,
            status: Sender::new(bus, &topics.take_status(node), Qos::Background, origin)?,
            _info: info,
            start_ns: 0,
            pace_ns: None,
            pace_from_ns: settings.resume_ns,
            sent: 0,
            newest: None,
            status_ns: 0,
            bus: member.bus.clone(),
        })
    }

    /// Take time of a sample since the first one, ns.
    fn time_ns(&self, number: usize) -> u64 {
        let samples = &self.settings.take.samples;
        samples[number].time_ns - samples[0].time_ns
    }

    fn ended(&self) -> bool {
        self.sent == self.settings.take.samples.len() && self.samples.outstanding() == 0
    }

    /// Work done so far.
    fn work(&self) -> NodeWork {
        NodeWork {
            consumed: self.sent as u64 - self.samples.outstanding(),
            produced: self.sent as u64,
            held: self.samples.outstanding(),
            ..NodeWork::default()
        }
    }

    fn poll(&mut self) -> Result<Duration, UserError> {
        let now_ns = self.bus.now_ns();
        if self.sent == 0 {
            self.start_ns = now_ns;
        }
        let me = self.samples.origin();
        while let Some(credit) = self.credit.try_recv() {
            let told = credit.message;
            if told.device == me.source && told.device_epoch == me.epoch {
                self.samples.consumed(told.device_epoch, told.next, now_ns);
                if self
                    .newest
                    .as_ref()
                    .is_none_or(|newest| newest.next <= told.next)
                {
                    self.newest = Some(told);
                }
            }
        }
        let mut wait = Duration::from_millis(20);
        while self.sent < self.settings.take.samples.len() && self.samples.has_credit() {
            let time_ns = self.time_ns(self.sent);
            if let Some(due_ns) = self.due_ns(time_ns, now_ns)
                && due_ns > now_ns
            {
                wait = wait.min(Duration::from_nanos(due_ns - now_ns));
                break;
            }
            let stamp = Stamp {
                now_ns: self.bus.now_ns(),
                event_ns: self.start_ns + time_ns,
            };
            let sample = &self.settings.take.samples[self.sent].sample;
            self.sent += 1;
            let flags = if self.sent == self.settings.take.samples.len() {
                Flags::REPLAY.with(Flags::LAST)
            } else {
                Flags::REPLAY
            };
            self.samples.send(flags, stamp, sample)?;
        }
        self.samples.serve(now_ns)?;
        self.report(now_ns)?;
        Ok(wait)
    }

    /// Time at which the sample of a take time is due; `None` if it is sent as soon as possible.
    fn due_ns(&mut self, time_ns: u64, now_ns: u64) -> Option<u64> {
        let Rate::Times(rate) = self.settings.rate else {
            return None;
        };
        if time_ns < self.settings.resume_ns {
            return None;
        }
        let pace_ns = *self.pace_ns.get_or_insert(now_ns);
        Some(pace_ns + ((time_ns - self.pace_from_ns) as f64 / rate) as u64)
    }

    fn report(&mut self, now_ns: u64) -> Result<(), UserError> {
        if now_ns < self.status_ns + STATUS_PERIOD_NS {
            return Ok(());
        }
        self.status_ns = now_ns;
        let brush = name_hash(&self.settings.brush);
        let end = self
            .newest
            .as_ref()
            .filter(|_| self.ended())
            .map(|newest| TakeEnd {
                after: After {
                    brush,
                    epoch: newest.brush_epoch,
                    sequence: newest.state,
                },
                samples: self.sent as u64,
            });
        let status = TakeStatus {
            epoch: self.samples.origin().epoch,
            position_ns: self
                .sent
                .checked_sub(1)
                .map_or(0, |last| self.time_ns(last)),
            length_ns: self.settings.take.length_ns(),
            sent: self.sent as u64,
            consumed: self.sent as u64 - self.samples.outstanding(),
            end,
        };
        Ok(self.status.send(now_ns, now_ns, &status)?)
    }
}
