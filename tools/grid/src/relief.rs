//! Relief in the hand: the runs of the grid over rough ground, a ridge and an edge, across which the hand is drawn and kicked.
//!
//! Patches are those of a brush node: 16 × 16 cells around the hand's place at the making of the model, delayed and
//! lost like the models. The criterion is the hand's gain beyond the work of the models' own force along the true path
//! without sampling, which vanishes along a closed path.

use glam::DVec3;
use maulstick_num::sin;
use maulstick_types::haptics::{ContactModel, FluidForce, ForceLaw, HeightPatch, height_bytes};

use maulstick_haptics::contact::Contact;
use maulstick_haptics::extent::Extent;
use maulstick_haptics::fluid::Fluid;
use maulstick_haptics::friction::ramp;
use maulstick_haptics::guide::Guide;
use maulstick_haptics::plant::Plant;
use maulstick_haptics::servo::Servo;
use maulstick_haptics::servo::fault::Fault;
use maulstick_haptics::servo::tick::{Sender, Tick};

use super::fluid::Film;
use super::ledger::Ledger;
use super::link::{Link, random};
use super::{
    DT, END_S, FORCE_ERROR, GuideLine, HEAD_M, MOVED_S, Motion, NO_ENERGY_J, Path, RECOVERY_S, Run,
    STILL_M, STILL_S, TOUCH_S, Wall, grid,
};

/// Side of a cell, m.
const CELL_M: f64 = 1e-3;
/// Coulomb friction of its device, N.
pub(super) const COULOMB_N: f64 = 0.06;
/// Stiffnesses of its walls, N/m.
const WALLS_N_M: [f64; 5] = [100.0, 300.0, 500.0, 800.0, 1000.0];
/// Amplitude of a hand that is drawn across the relief, and holds still on a flank, m.
const DRAWN_M: f64 = 4e-3;
const FLANK_M: f64 = 1.3e-3;
/// Amplitude of painting along a guide, m.
const STROKE_M: f64 = 0.03;
/// Initial height above bare relief, m, and time of its descent, s.
const ABOVE_M: f64 = 6e-3;
const DESCENT_S: f64 = 0.3;
/// Time that an arm that has painted needs beyond the usual to come to rest, s.
const SETTLE_S: f64 = 1.0;

/// Relief on the plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ground {
    /// Lumps without order, 4 mm wide, to .8 mm up and down.
    Rough,
    /// A ridge of .9 mm.
    Ridge,
    /// An edge of 3 mm.
    Edge,
}

impl Ground {
    /// Height of a cell, µm.
    fn height_um(self, column: i64, row: i64) -> i16 {
        match self {
            Self::Rough => {
                let lump = [column, row].map(|cell| cell.div_euclid(4));
                let mut state = (lump[0] * 7919 + lump[1] * 104_729) as u64;
                random(&mut state);
                random(&mut state);
                (1600.0 * random(&mut state) - 800.0) as i16
            }
            Self::Ridge => match column {
                -1 | 0 => 900,
                -2 | 1 => 450,
                _ => 0,
            },
            Self::Edge => 3000 * i16::from(column >= 0),
        }
    }

    /// The patch on a wall around a place.
    fn patch(self, wall: &Wall, around: DVec3) -> HeightPatch {
        let along = DVec3::Y.cross(wall.normal).normalize();
        let up = wall.normal.cross(along);
        let place = around - wall.point;
        let first = [along, up].map(|axis| (axis.dot(place) / CELL_M).floor() as i64 - 8);
        let corner =
            wall.point + along * (first[0] as f64 * CELL_M) + up * (first[1] as f64 * CELL_M);
        let side = HeightPatch::SIDE as i64;
        let cells = (0..side).flat_map(|j| (0..side).map(move |i| (i, j)));
        HeightPatch {
            corner_m: corner.to_array(),
            along: along.to_array(),
            cell_m: CELL_M,
            heights_um: height_bytes(
                cells.map(|(i, j)| self.height_um(first[0] + i, first[1] + j)),
            ),
        }
    }
}

/// Direction of the force on relief.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tilt {
    /// Tilted by the slope.
    BySlope,
    /// Along the normal of the plane alone.
    Upright,
}

impl Tilt {
    /// The force that reaches the motors.
    fn of(self, force: DVec3, normal: DVec3) -> DVec3 {
        match self {
            Self::BySlope => force,
            Self::Upright => normal * force.dot(normal),
        }
    }
}

/// One hand over one ground.
#[derive(Clone, Copy, Debug)]
pub struct ReliefRun {
    /// Hand, wall, rate and losses.
    pub run: Run,
    /// Relief on the wall.
    pub ground: Ground,
    /// Direction of the force that reaches the motors.
    pub tilt: Tilt,
    /// Friction, at rest half as much again.
    pub friction: f64,
    /// Coulomb friction of the device, N, which hides gains of a moving hand.
    pub coulomb_n: f64,
    /// Film of paint, if the hand goes through one.
    pub film: Option<Film>,
}

/// Result of a run.
#[derive(Clone, Copy, Debug)]
pub struct ReliefOutcome {
    /// Movement of the tip while the hand holds still, peak to peak, m.
    pub wobble_m: f64,
    /// Greatest energy given to the hand without a source, J.
    pub net_j: f64,
    /// Greatest energy given to hand and device from some time on, J.
    pub rise_j: f64,
    /// Steady force along the normal by that of the model at the tip's true place.
    pub share: f64,
    /// Greatest force across the normal, N.
    pub across_n: f64,
    /// Greatest force, N.
    pub most_n: f64,
    /// Fastest change of it, N/s.
    pub slew_n_s: f64,
    /// True if the observer took energy back.
    pub braked: bool,
    /// Fault that latched the force at zero, if any.
    pub fault: Option<Fault>,
}

/// Target of a hand that paints along a guide and across it.
fn painting(run: &Run, guide: &GuideLine, s: f64) -> DVec3 {
    let painted_s = s.clamp(TOUCH_S, MOVED_S) - TOUCH_S;
    let drawn = DVec3::new(
        DRAWN_M * sin(5.0 * painted_s),
        STROKE_M * sin(8.0 * painted_s),
        0.0,
    );
    // Along the guide's normal it comes down from above all relief, so gently that no force is cut.
    let left = 1.0 - ((s - TOUCH_S) / DESCENT_S).clamp(0.0, 1.0);
    let above = guide.normal * (guide.normal.z * ABOVE_M * left);
    let resting_s = if s < MOVED_S {
        s
    } else {
        (s - SETTLE_S).max(MOVED_S)
    };
    run.target(resting_s) + drawn + above
}

/// Models that the servo is sent.
struct Models {
    contact: Contact,
    /// The patch of the contact, once one was sent.
    sent: Option<HeightPatch>,
    guide: Option<Guide>,
}

impl Models {
    fn new(of: &ReliefRun) -> Result<Self, &'static str> {
        let guide = of.run.guide.map(|guide| guide.guide(of.live_s()));
        Ok(Self {
            contact: of.contact(&of.run.wall(0.0), HeightPatch::flat())?,
            sent: None,
            guide: guide.transpose()?,
        })
    }

    /// Those of a wall around a place.
    fn renew(&mut self, of: &ReliefRun, wall: &Wall, around: DVec3) -> Result<(), &'static str> {
        let patch = of.ground.patch(wall, around);
        // Over a wall that rests most patches are the one before.
        if of.run.motion != Motion::Still || self.sent.as_ref() != Some(&patch) {
            self.contact = of.contact(wall, patch.clone())?;
            self.sent = Some(patch);
        }
        Ok(())
    }

    fn send(&self, servo: &mut Servo) {
        servo.receive(self.contact, Sender::Same);
        if let Some(guide) = self.guide {
            servo.receive_guide(guide, Sender::Same);
        }
    }
}

/// A hand that holds still: the places of its tip, and the sums of the force along the normal and of the model's own, N.
struct Steady {
    extent: Extent,
    push: f64,
    asked: f64,
}

impl Steady {
    const NONE: Self = Self {
        extent: Extent::NONE,
        push: 0.0,
        asked: 0.0,
    };

    fn note(&mut self, tip: DVec3, push: f64, asked: f64) {
        self.extent.include(tip);
        self.push += push;
        self.asked += asked;
    }
}

/// Forces that the servo asked for.
#[derive(Default)]
struct Wishes {
    newest: DVec3,
    most_n: f64,
    slew_n_s: f64,
    braked: bool,
    fault: Option<Fault>,
}

impl Wishes {
    fn note(&mut self, force: DVec3, tick: &Tick) {
        self.most_n = self.most_n.max(force.length());
        self.slew_n_s = self.slew_n_s.max((force - self.newest).length() / DT);
        self.newest = force;
        self.braked |= tick.braked;
        self.fault = self.fault.or(tick.fault);
    }
}

/// A film that the brush carries along, and the link from its solver.
struct Paint {
    film: Film,
    link: Link<FluidForce>,
    carried: DVec3,
}

impl Paint {
    fn new(film: Film) -> Self {
        Self {
            film,
            link: Link::new(film.rate_hz, film.jitter, 2),
            carried: DVec3::ZERO,
        }
    }

    /// The message that arrives at a time, under a brush that touches the film by a share.
    fn newest(&mut self, s: f64, velocity: DVec3, touch: f64) -> Option<FluidForce> {
        self.carried = self.film.follow(self.carried, velocity, touch);
        let (film, carried) = (self.film, self.carried);
        self.link.newest(s, |_| film.message(velocity, carried))
    }

    fn kept_j(&self) -> f64 {
        self.film.kept_j(self.carried)
    }
}

impl ReliefRun {
    /// When the hand is judged to hold still, s.
    fn still_s(&self) -> [f64; 2] {
        STILL_S.map(|s| s + self.settle_s())
    }

    /// Time that a hand needs to come to rest beyond the usual, s.
    fn settle_s(&self) -> f64 {
        match self.run.guide {
            Some(_) => SETTLE_S,
            None => 0.0,
        }
    }

    /// Time to live of models and guides, s, long enough that losses do not fade.
    fn live_s(&self) -> f64 {
        (6.0 / self.run.rate_hz).max(0.1)
    }

    fn contact(&self, wall: &Wall, patch: HeightPatch) -> Result<Contact, &'static str> {
        let law = ForceLaw::Rigid {
            stiffness_n_m: wall.stiffness,
        };
        Contact::new(&ContactModel {
            plane_point_m: wall.point.to_array(),
            plane_normal: wall.normal.to_array(),
            friction_static: 1.5 * self.friction,
            friction_kinetic: self.friction,
            time_to_live_ns: (self.live_s() * 1e9) as u64,
            recovery_ns: (RECOVERY_S * 1e9) as u64,
            relief: patch,
            ..ContactModel::bare(law, HEAD_M)
        })
    }

    /// Target of the hand at a time.
    fn target(&self, s: f64) -> DVec3 {
        if let Some(guide) = &self.run.guide {
            return painting(&self.run, guide, s);
        }
        let aside = match s {
            s if s < TOUCH_S => -DRAWN_M,
            s if s < MOVED_S => -DRAWN_M * maulstick_num::cos(5.0 * (s - TOUCH_S)),
            _ => FLANK_M,
        };
        let kicked = (1.0..2.4).contains(&s) && (s * 10.0) as u64 % 2 == 1;
        let kick = if kicked {
            DVec3::new(0.0, 2e-3, 0.0)
        } else {
            DVec3::ZERO
        };
        self.run.target(s) + DVec3::X * aside + kick + DVec3::Y * (1e-3 * sin(3.0 * s.min(MOVED_S)))
    }

    /// Force of the guide on a tip at a place.
    fn guided(&self, tip: DVec3) -> DVec3 {
        let guide = self.run.guide;
        guide.map_or(DVec3::ZERO, |it| it.force(tip - DVec3::Z * HEAD_M))
    }

    /// Runs the hand.
    ///
    /// # Errors
    /// The defect of a wall, a guide or a film that is refused.
    pub fn go(&self) -> Result<ReliefOutcome, &'static str> {
        let mut servo = Servo::new(self.run.limits());
        let mut plant = Plant::omni(self.run.hand, self.target(0.0));
        plant.coulomb_n = self.coulomb_n;
        let mut models = Models::new(self)?;
        let mut ledger = Ledger::new(models.contact, self.run.guide);
        let mut link = Link::new(self.run.rate_hz, self.run.jitter, 1);
        let mut paint = self.film.map(Paint::new);
        let (mut force, mut across_n) = (DVec3::ZERO, 0.0f64);
        let (mut steady, mut wishes) = (Steady::NONE, Wishes::default());
        let still_s = self.still_s();
        for number in 0..((END_S + self.settle_s()) / DT) as usize {
            let s = number as f64 * DT;
            let handle = plant.handle();
            let tip = handle.position - DVec3::Z * HEAD_M;
            ledger.age();
            if let Some((wall, around)) = link.newest(s, |s| (self.run.wall(s), tip)) {
                models.renew(self, &wall, around)?;
                models.send(&mut servo);
                ledger.change(models.contact, handle.position);
            }
            if let Some(paint) = &mut paint {
                let touch = ramp(ledger.depth(handle.position));
                if let Some(message) = paint.newest(s, handle.velocity, touch) {
                    servo.receive_fluid(Fluid::new(&message, 1.0)?);
                }
            }
            let (wanted, tick) = servo.step(&handle, DT);
            wishes.note(wanted, &tick);
            if self.run.path.reaches(number) {
                force = wanted;
            }
            let normal = ledger.normal();
            let force = self.tilt.of(force, normal);
            let before = plant;
            if wishes.fault.is_none() && self.run.path == Path::Servo {
                ledger.soften(&handle, tick.stiffness_n_m, before.true_position());
            }
            plant.advance(force, self.target(s), DT);
            ledger.book(&before, &plant, paint.as_ref().map_or(0.0, Paint::kept_j));
            across_n = across_n.max((force - normal * force.dot(normal)).length());
            if (still_s[0]..still_s[1]).contains(&s) {
                let to = plant.true_position();
                let push = (force - self.guided(to)).dot(normal);
                steady.note(to, push, ledger.force(to).dot(normal));
            }
        }
        Ok(ReliefOutcome {
            wobble_m: steady.extent.peak_to_peak_m(),
            net_j: ledger.most_j,
            rise_j: ledger.rise_j,
            share: steady.push / steady.asked,
            across_n,
            most_n: wishes.most_n,
            slew_n_s: wishes.slew_n_s,
            braked: wishes.braked,
            fault: wishes.fault,
        })
    }

    /// True if the hand is still, gains no energy, and feels its wall. Friction hides gains, and a wall beyond 2b/T may
    /// be softened.
    #[must_use]
    pub fn is_good(&self, outcome: &ReliefOutcome) -> bool {
        let judged = self.run.stiffness < super::BOUND_N_M;
        outcome.wobble_m <= STILL_M
            && outcome.net_j <= NO_ENERGY_J
            && outcome.fault.is_none()
            && (!judged || (outcome.share - 1.0).abs() <= FORCE_ERROR)
    }
}

/// All runs of the grid over each ground, and those over a wall that rests again with friction.
#[must_use]
pub fn relief_grid(path: Path) -> Vec<ReliefRun> {
    let mut runs = Vec::new();
    for ground in [Ground::Rough, Ground::Ridge, Ground::Edge] {
        let walls = grid(path).into_iter();
        for run in walls.filter(|run| WALLS_N_M.contains(&run.stiffness)) {
            for friction in [0.0, 0.2] {
                if friction == 0.0 || run.motion == Motion::Still {
                    runs.push(ReliefRun {
                        run,
                        ground,
                        tilt: Tilt::BySlope,
                        friction,
                        coulomb_n: COULOMB_N,
                        film: None,
                    });
                }
            }
        }
    }
    runs
}

#[cfg(test)]
mod tests;
