//! The stability grid: the whole servo against hands, walls, rates of models, losses and moving planes, on a virtual
//! clock.
//!
//! A hand comes down, presses, is kicked, holds still, and lifts. The criteria are the motion of the tip while the hand
//! holds still, the steady force, and the energy given to the hand beyond that of the models without sampling: at the
//! grip, with the device's own friction and mass, and without the work of a plane that moves or changes its stiffness.
//! A wall of stiffness K is passive while K < 2b/T (Colgate and Schenkel 1997): up to there the steady force is judged
//! too. Beside the wall a guide may hold the hand to a line; then the hand is kicked across that too.

pub mod fluid;
mod ledger;
pub(crate) mod link;
pub mod painting;
pub mod relief;

use glam::DVec3;
use maulstick_num::geometry::rotation;
use maulstick_num::{cos, sin};
use maulstick_types::haptics::{ContactModel, ForceLaw, GuideModel};

use maulstick_haptics::contact::Contact;
use maulstick_haptics::extent::Extent;
use maulstick_haptics::guide::{Guide, GuideBounds};
use maulstick_haptics::plant::{Hand, Plant};
use maulstick_haptics::servo::Servo;
use maulstick_haptics::servo::fault::Fault;
use maulstick_haptics::servo::limits::Limits;
use maulstick_haptics::servo::tick::Sender;

use self::link::Link;

/// The hands of the grid.
pub const HANDS: [Hand; 3] = [Hand::FINGERTIP, Hand::PEN_GRIP, Hand::ARM];
/// Largest stiffness of its device, N/m.
pub const MAX_STIFFNESS_N_M: f64 = 500.0;
/// Largest force of its device, N.
pub const MAX_FORCE_N: f64 = 3.3;
/// Viscous friction of its device, N·s/m.
pub const DAMPING_N_S_M: f64 = 0.3;
/// Period of its servo, s.
pub(crate) const DT: f64 = 1e-3;
/// Below this stiffness the steady force is judged, 2b/T, N/m.
pub const BOUND_N_M: f64 = 2.0 * DAMPING_N_S_M / DT;
/// A tip that wobbles by less is still, m.
pub const STILL_M: f64 = 1e-4;
/// Negligible energy, J.
pub const NO_ENERGY_J: f64 = 1e-6;
/// The steady force may be off by this share.
pub const FORCE_ERROR: f64 = 0.1;

pub(crate) const HEAD_M: f64 = 0.025;
/// Friction of the wall without a guide.
const FRICTION: f64 = 0.2;
const RECOVERY_S: f64 = 0.015;
/// Time from which the hand touches, s; planes move until the second time; the hand holds still between the third and
/// the fourth, and is away at the end.
const TOUCH_S: f64 = 0.6;
const MOVED_S: f64 = 3.1;
const STILL_S: [f64; 2] = [3.6, 4.1];
const END_S: f64 = 4.6;

/// Motion of the plane while the hand is kicked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// The plane rests.
    Still,
    /// It tilts to and fro.
    Tilting,
    /// It is tilted and slides to and fro.
    Sliding,
    /// It rests, and its stiffness goes up and down.
    Stiffening,
}

/// Guide beside the wall: a straight line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GuideLine {
    /// Normal of the plane in which it acts.
    pub normal: DVec3,
    /// Stiffness, N/m.
    pub stiffness: f64,
    /// Damping, N·s/m.
    pub damping: f64,
    /// Largest force, N.
    pub most_n: f64,
}

/// Distance of a kicked and of a still hand from the line, m.
const ASIDE_M: [f64; 2] = [0.001, 0.003];

impl GuideLine {
    /// The stiffest and strongest guide allowed.
    #[must_use]
    pub fn strongest(normal: DVec3, damping: f64) -> Self {
        let limits = Limits::default();
        Self {
            normal,
            stiffness: limits.guide.stiffness_n_m,
            damping,
            most_n: limits.guide.force_n,
        }
    }

    /// Direction of its pull: the line lies along y, through the hand's point of contact.
    fn across(&self) -> DVec3 {
        DVec3::Y.cross(self.normal)
    }

    fn stored(&self, tip: DVec3) -> f64 {
        let distance = tip.dot(self.across()).abs();
        let cut = distance.min(self.most_n / self.stiffness);
        self.stiffness * cut * (distance - 0.5 * cut)
    }

    fn force(&self, tip: DVec3) -> DVec3 {
        let aside = tip.dot(self.across()) * self.stiffness;
        self.across() * -aside.clamp(-self.most_n, self.most_n)
    }

    fn guide(&self, time_to_live_s: f64) -> Result<Guide, &'static str> {
        Guide::new(&GuideModel {
            device: 0,
            device_epoch: 0,
            points_m: vec![[0.0, -0.1, 0.0], [0.0, 0.1, 0.0]],
            normal: self.normal.to_array(),
            head_length_m: HEAD_M,
            stiffness_n_m: self.stiffness,
            damping_n_s_m: self.damping,
            max_force_n: self.most_n,
            time_to_live_ns: (time_to_live_s * 1e9) as u64,
        })
    }
}

/// Path of the force to the motors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Path {
    /// The servo beside the device.
    Servo,
    /// A servo elsewhere, whose force is sent 60 times a second.
    Sent,
    /// A servo without force.
    Nothing,
}

impl Path {
    /// True if the force of this tick reaches the motors.
    fn reaches(self, tick: usize) -> bool {
        match self {
            Self::Servo => true,
            Self::Sent => tick.is_multiple_of(16),
            Self::Nothing => false,
        }
    }
}

/// One hand at one wall.
#[derive(Clone, Copy, Debug)]
pub struct Run {
    /// The hand.
    pub hand: Hand,
    /// Stiffness of the wall, N/m.
    pub stiffness: f64,
    /// Rate of models, Hz.
    pub rate_hz: f64,
    /// Models are late by up to this share of their period, and as often are lost.
    pub jitter: f64,
    /// Motion of the plane.
    pub motion: Motion,
    /// Guide, sent with the models, if there is one.
    pub guide: Option<GuideLine>,
    /// Path of the force to the motors.
    pub path: Path,
}

/// Result of a run.
#[derive(Clone, Copy, Debug)]
pub struct Outcome {
    /// Movement of the tip while the hand holds still, peak to peak, m.
    pub wobble_m: f64,
    /// Greatest energy given to the hand without a source, J.
    pub net_j: f64,
    /// Steady force along the normal, without the guide's, by stiffness times depth.
    pub share: f64,
    /// Stiffness that the servo reported, N/m.
    pub reported_n_m: f64,
    /// Fault that latched the force at zero, if any.
    pub fault: Option<Fault>,
}

/// A plane and its stiffness.
#[derive(Clone, Copy)]
struct Wall {
    point: DVec3,
    normal: DVec3,
    stiffness: f64,
}

impl Wall {
    fn depth(&self, tip: DVec3) -> f64 {
        (self.point - tip).dot(self.normal).max(0.0)
    }

    fn force(&self, tip: DVec3) -> DVec3 {
        self.normal * (self.stiffness * self.depth(tip))
    }

    fn stored(&self, tip: DVec3) -> f64 {
        0.5 * self.stiffness * self.depth(tip) * self.depth(tip)
    }

    fn contact(&self, friction: f64, time_to_live_s: f64) -> Result<Contact, &'static str> {
        let law = ForceLaw::Rigid {
            stiffness_n_m: self.stiffness,
        };
        Contact::new(&ContactModel {
            plane_point_m: self.point.to_array(),
            plane_normal: self.normal.to_array(),
            friction_static: friction,
            friction_kinetic: friction,
            time_to_live_ns: (time_to_live_s * 1e9) as u64,
            recovery_ns: (RECOVERY_S * 1e9) as u64,
            ..ContactModel::bare(law, HEAD_M)
        })
    }
}

/// The wall of the models, without sampling: a change is spread over the recovery time.
struct WallModel {
    wall: Wall,
    correction: DVec3,
    speed: f64,
}

impl WallModel {
    fn age(&mut self) {
        let (size, shrunk) = (self.correction.length(), self.speed * DT);
        if size > shrunk {
            self.correction *= (size - shrunk) / size;
        } else {
            (self.correction, self.speed) = (DVec3::ZERO, 0.0);
        }
    }

    fn change(&mut self, wall: Wall, tip: DVec3) {
        let before = self.wall.force(tip) + self.correction;
        self.wall = wall;
        self.correction = before - wall.force(tip);
        self.speed = self.speed.max(self.correction.length() / RECOVERY_S);
    }
}

impl Run {
    /// Plane and stiffness at a time.
    fn wall(&self, s: f64) -> Wall {
        let turn = 2.0 * std::f64::consts::PI * 0.8 * (s.clamp(TOUCH_S, MOVED_S) - TOUCH_S);
        let mut wall = Wall {
            point: DVec3::ZERO,
            normal: DVec3::Z,
            stiffness: self.stiffness,
        };
        match self.motion {
            Motion::Still => {}
            Motion::Tilting => {
                wall.point = DVec3::new(-0.02, 0.0, 0.0);
                wall.normal = rotation(DVec3::Y, 0.09 * sin(turn)) * DVec3::Z;
            }
            Motion::Sliding => {
                wall.normal = rotation(DVec3::Y, 0.14) * DVec3::Z;
                wall.point = DVec3::new(0.01 * sin(turn), 0.0, 0.0);
            }
            Motion::Stiffening => wall.stiffness *= 0.75 + 0.25 * cos(turn),
        }
        wall
    }

    /// Target of the hand at a time.
    fn target(&self, s: f64) -> DVec3 {
        let kicked = (1.0..2.4).contains(&s) && (s * 10.0) as u64 % 2 == 1;
        let depth = match s {
            s if s < TOUCH_S => -0.004,
            s if s >= STILL_S[1] => -0.01,
            _ if kicked => 0.001,
            _ => 0.003,
        };
        let tip = DVec3::Z * -depth;
        let tip = match self.guide {
            None => tip,
            Some(guide) if s >= TOUCH_S => tip + guide.across() * ASIDE_M[usize::from(!kicked)],
            // On the line, where its force may begin.
            Some(guide) => tip - guide.across() * tip.dot(guide.across()),
        };
        tip + DVec3::Z * HEAD_M
    }

    fn limits(&self) -> Limits {
        // A force that is sent elsewhere shows its effect without the guards that would stop it.
        let guarded = match self.path {
            Path::Servo | Path::Nothing => Limits::default(),
            Path::Sent => Limits {
                oscillation_m: f64::INFINITY,
                max_speed_m_s: f64::INFINITY,
                ..Limits::default()
            },
        };
        let limits = Limits {
            max_force_n: MAX_FORCE_N,
            continuous_force_n: MAX_FORCE_N,
            max_stiffness_n_m: MAX_STIFFNESS_N_M,
            damping_n_s_m: DAMPING_N_S_M,
            ..guarded
        };
        match self.guide {
            Some(guide) => Limits {
                guide: GuideBounds {
                    force_n: guide.most_n,
                    stiffness_n_m: guide.stiffness,
                    ..limits.guide
                },
                ..limits
            },
            None => limits,
        }
    }

    /// Sends the models of a wall, and of the guide beside it.
    fn send(&self, wall: &Wall, servo: &mut Servo) -> Result<(), &'static str> {
        // The wall's friction across the kick would hide the guide's gain.
        let friction = match self.guide {
            Some(_) => 0.0,
            None => FRICTION,
        };
        let live_s = (6.0 / self.rate_hz).max(0.1);
        servo.receive(wall.contact(friction, live_s)?, Sender::Same);
        if let Some(guide) = self.guide {
            servo.receive_guide(guide.guide(live_s)?, Sender::Same);
        }
        Ok(())
    }

    /// Runs the hand.
    ///
    /// # Errors
    /// The defect of a wall that makes no contact model.
    pub fn go(&self) -> Result<Outcome, &'static str> {
        let limits = self.limits();
        let mut servo = Servo::new(limits);
        let mut plant = Plant::omni(self.hand, self.target(0.0));
        let tip = |plant: &Plant| plant.true_position() - DVec3::Z * HEAD_M;
        let mut model_wall = WallModel {
            wall: self.wall(0.0),
            correction: DVec3::ZERO,
            speed: 0.0,
        };
        let mut link = Link::new(self.rate_hz, self.jitter, 1);
        let (mut extent, mut force) = (Extent::NONE, DVec3::ZERO);
        let (mut push, mut depth, mut reported_n_m) = (0.0, 0.0, f64::MAX);
        let (mut net_j, mut most_j): (f64, f64) = (0.0, 0.0);
        let mut fault = None;
        for number in 0..(END_S / DT) as usize {
            let s = number as f64 * DT;
            let handle = plant.handle();
            model_wall.age();
            if let Some(wall) = link.newest(s, |s| self.wall(s)) {
                self.send(&wall, &mut servo)?;
                let given = Wall {
                    stiffness: wall.stiffness.min(limits.max_stiffness_n_m),
                    ..wall
                };
                model_wall.change(given, handle.position - DVec3::Z * HEAD_M);
            }
            let (wanted, tick) = servo.step(&handle, DT);
            fault = fault.or(tick.fault);
            if self.path.reaches(number) {
                force = wanted;
            }
            let (from, before_j) = (tip(&plant), plant.given_j());
            plant.advance(force, self.target(s), DT);
            let to = tip(&plant);
            let models = model_wall.wall.stored(from) - model_wall.wall.stored(to)
                + model_wall.correction.dot(to - from);
            let guided = self
                .guide
                .map_or(0.0, |guide| guide.stored(from) - guide.stored(to));
            net_j += plant.given_j() - before_j - models - guided;
            most_j = most_j.max(net_j);
            if (STILL_S[0]..STILL_S[1]).contains(&s) {
                extent.include(to);
                let guided = self.guide.map_or(DVec3::ZERO, |guide| guide.force(to));
                push += (force - guided).dot(model_wall.wall.normal);
                depth += model_wall.wall.depth(to);
                reported_n_m = reported_n_m.min(tick.stiffness_n_m);
            }
        }
        Ok(Outcome {
            wobble_m: extent.peak_to_peak_m(),
            net_j: most_j,
            share: push / (self.stiffness * depth),
            reported_n_m,
            fault,
        })
    }

    /// Share by which the steady force is off, where the wall is soft enough to be judged.
    #[must_use]
    pub fn force_error(&self, outcome: &Outcome) -> Option<f64> {
        (self.stiffness < BOUND_N_M).then(|| (outcome.share - 1.0).abs())
    }

    /// True if the hand is still, is given no energy, and feels its wall.
    #[must_use]
    pub fn is_good(&self, outcome: &Outcome) -> bool {
        let felt = self.force_error(outcome);
        outcome.wobble_m <= STILL_M
            && outcome.net_j <= NO_ENERGY_J
            && outcome.fault.is_none()
            && felt.is_none_or(|error| error <= FORCE_ERROR)
    }
}

/// The worst of some runs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Worst {
    /// Number of runs.
    pub runs: usize,
    /// Number of runs that are not good.
    pub fails: usize,
    /// Greatest [`Outcome::wobble_m`], m.
    pub wobble_m: f64,
    /// Greatest [`Outcome::net_j`], J.
    pub net_j: f64,
    /// Greatest [`Run::force_error`].
    pub force_error: f64,
}

impl Worst {
    /// The worst of runs and their outcomes.
    #[must_use]
    pub fn of<'a>(all: impl IntoIterator<Item = &'a (Run, Outcome)>) -> Self {
        let mut worst = Self::default();
        for (run, outcome) in all {
            worst.runs += 1;
            worst.fails += usize::from(!run.is_good(outcome));
            worst.wobble_m = worst.wobble_m.max(outcome.wobble_m);
            worst.net_j = worst.net_j.max(outcome.net_j);
            let error = run.force_error(outcome).unwrap_or(0.0);
            worst.force_error = worst.force_error.max(error);
        }
        worst
    }
}

/// The runs of the grid with the strongest guide beside the wall, within its plane and in one tilted by 45°.
#[must_use]
pub fn guided_grid() -> Vec<Run> {
    let tilted = DVec3::new(1.0, 0.0, 1.0).normalize();
    let mut runs = Vec::new();
    for normal in [DVec3::Z, tilted] {
        for run in grid(Path::Servo) {
            // From none to as much as there may be.
            let guide = Some(GuideLine::strongest(normal, 4.0 * run.jitter));
            runs.push(Run { guide, ..run });
        }
    }
    runs
}

/// All runs of the grid, by one path of the force: 360 for each of [`HANDS`].
#[must_use]
pub fn grid(path: Path) -> Vec<Run> {
    let mut runs = Vec::new();
    for hand in HANDS {
        for stiffness in (1..=10).map(|i| 100.0 * f64::from(i)) {
            for rate_hz in [30.0, 60.0, 250.0] {
                for jitter in [0.0, 0.1, 0.2] {
                    for motion in [
                        Motion::Still,
                        Motion::Tilting,
                        Motion::Sliding,
                        Motion::Stiffening,
                    ] {
                        runs.push(Run {
                            hand,
                            stiffness,
                            rate_hz,
                            jitter,
                            motion,
                            guide: None,
                            path,
                        });
                    }
                }
            }
        }
    }
    runs
}

#[cfg(test)]
mod tests;
