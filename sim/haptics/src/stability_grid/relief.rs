//! Relief in the hand: the runs of the grid over rough ground, a ridge and an edge, across which the hand is drawn and kicked.
//!
//! Patches are those of a brush node: 16 × 16 cells around where the hand was when the model was made, late and lost as the
//! models are. Judged is what the hand was given beyond the work of the models' own force along its true way, felt without
//! samples, which round a closed way is nothing.

use glam::DVec3;
use maulstick_num::sin;
use maulstick_types::haptics::{ContactModel, ForceLaw, HeightPatch, height_bytes};

use super::extent::Extent;
use super::link::{Link, random};
use super::{
    DAMPING_N_S_M, DT, END_S, FORCE_ERROR, HEAD_M, MAX_STIFFNESS_N_M, MOVED_S, Motion, NO_ENERGY_J,
    Path, RECOVERY_S, Run, STILL_M, STILL_S, TOUCH_S, Wall, grid,
};
use crate::contact::{Contact, HandleState};
use crate::plant::Plant;
use crate::servo::Servo;
use crate::servo::fault::Fault;
use crate::servo::limits::Limits;
use crate::servo::tick::Sender;

/// A way out along the normal that ends beyond all contact, m.
const OUT_M: f64 = 1.2e-2;
/// Side of a cell, m.
const CELL_M: f64 = 1e-3;
/// Coulomb friction of its device, N.
const COULOMB_N: f64 = 0.06;
/// Stiffnesses of its walls, N/m.
const WALLS_N_M: [f64; 5] = [100.0, 300.0, 500.0, 800.0, 1000.0];
/// The hand is drawn across the relief by so much to each side, and holds still on a flank, m.
const DRAWN_M: f64 = 4e-3;
const FLANK_M: f64 = 1.3e-3;

/// What lies on the plane.
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

/// One hand over one ground.
#[derive(Clone, Copy, Debug)]
pub struct ReliefRun {
    /// Hand, wall, rate and losses.
    pub run: Run,
    /// What lies on the wall.
    pub ground: Ground,
    /// Direction of the force that reaches the motors.
    pub tilt: Tilt,
    /// Friction, at rest half as much again.
    pub friction: f64,
    /// Coulomb friction of the device, N, which hides what a hand is given that moves.
    pub coulomb_n: f64,
}

/// How it went.
#[derive(Clone, Copy, Debug)]
pub struct ReliefOutcome {
    /// Movement of the tip while the hand holds still, peak to peak, m.
    pub wobble_m: f64,
    /// Greatest energy given to the hand that nobody put in, J.
    pub net_j: f64,
    /// Greatest energy given to hand and device from some time on, J.
    pub rise_j: f64,
    /// Steady force along the normal by that of the model at the tip's true place.
    pub share: f64,
    /// Greatest force across the normal, N.
    pub across_n: f64,
    /// What latched the force at zero, if anything did.
    pub fault: Option<Fault>,
}

/// The newest model without samples: a change is spread over the recovery time, and a servo that softens it says so.
struct Booked {
    contact: Contact,
    correction: DVec3,
    speed: f64,
    /// Share of the stiffness that the servo gives, and whether the head touched at the last tick.
    softness: f64,
    touched: bool,
}

impl Booked {
    fn force(&self, position: DVec3) -> DVec3 {
        let felt = self
            .contact
            .evaluate(&HandleState::upright(position), MAX_STIFFNESS_N_M);
        felt.conservative
    }

    fn age(&mut self) {
        let (size, shrunk) = (self.correction.length(), self.speed * DT);
        if size > shrunk {
            self.correction *= (size - shrunk) / size;
        } else {
            (self.correction, self.speed) = (DVec3::ZERO, 0.0);
        }
    }

    fn change(&mut self, contact: Contact, position: DVec3) {
        let before = self.force(position) + self.correction;
        self.contact = contact;
        self.correction = before - self.force(position);
        self.speed = self.speed.max(self.correction.length() / RECOVERY_S);
    }

    /// Work on a short straight way, J, by Simpson's rule.
    fn work(&self, from: DVec3, to: DVec3) -> f64 {
        let middle = self.force((from + to) * 0.5);
        let mean = (self.force(from) + middle * 4.0 + self.force(to)) / 6.0;
        (mean + self.correction).dot(to - from) * self.softness
    }

    /// Energy stored in the model at a place without softening, J: its work on a way out along the normal, by Simpson's rule.
    fn stored(&self, position: DVec3) -> f64 {
        const STEPS: u32 = 64;
        let step = self.contact.normal() * (OUT_M / f64::from(STEPS));
        let along = |i: f64| self.force(position + step * i).dot(step);
        let piece = |i: u32| {
            let i = f64::from(i);
            (along(i) + 4.0 * along(i + 0.5) + along(i + 1.0)) / 6.0
        };
        (0..STEPS).map(piece).sum()
    }

    /// Follows the stiffness that the servo says it gives: what is stored more by a wall that grows hard under a hand that
    /// does not move, nobody put in, J.
    fn soften(&mut self, handle: &HandleState, given_n_m: f64, position: DVec3) -> f64 {
        let felt = self.contact.evaluate(handle, MAX_STIFFNESS_N_M);
        let touches = felt.depth_m > 0.0 && felt.stiffness_n_m > 0.0;
        let before = self.softness;
        if touches {
            self.softness = given_n_m / felt.stiffness_n_m;
        }
        let was_in_contact = std::mem::replace(&mut self.touched, touches);
        match touches && was_in_contact && self.softness != before {
            true => (self.softness - before) * self.stored(position),
            false => 0.0,
        }
    }
}

impl ReliefRun {
    fn contact(&self, wall: &Wall, patch: HeightPatch) -> Result<Contact, &'static str> {
        let law = ForceLaw::Rigid {
            stiffness_n_m: wall.stiffness,
        };
        let live_s = (6.0 / self.run.rate_hz).max(0.1);
        Contact::new(&ContactModel {
            plane_point_m: wall.point.to_array(),
            plane_normal: wall.normal.to_array(),
            friction_static: 1.5 * self.friction,
            friction_kinetic: self.friction,
            time_to_live_ns: (live_s * 1e9) as u64,
            recovery_ns: (RECOVERY_S * 1e9) as u64,
            relief: patch,
            ..ContactModel::bare(law, HEAD_M)
        })
    }

    /// Where the hand wants to be at a time.
    fn target(&self, s: f64) -> DVec3 {
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

    /// Lets the hand go through it all.
    ///
    /// # Errors
    /// What is wrong with a wall that makes no contact model.
    pub fn go(&self) -> Result<ReliefOutcome, &'static str> {
        let unguarded = self.run.path == Path::Sent;
        let guard = |usual: f64| if unguarded { f64::INFINITY } else { usual };
        let usual = Limits::default();
        let mut servo = Servo::new(Limits {
            max_force_n: 3.3,
            continuous_force_n: 3.3,
            max_stiffness_n_m: MAX_STIFFNESS_N_M,
            damping_n_s_m: DAMPING_N_S_M,
            oscillation_m: guard(usual.oscillation_m),
            max_speed_m_s: guard(usual.max_speed_m_s),
            ..usual
        });
        let mut plant = Plant::omni(self.run.hand, self.target(0.0));
        plant.coulomb_n = self.coulomb_n;
        let (mut contact, mut sent) = (
            self.contact(&self.run.wall(0.0), HeightPatch::flat())?,
            None,
        );
        let mut booked = Booked {
            contact,
            correction: DVec3::ZERO,
            speed: 0.0,
            softness: 1.0,
            touched: false,
        };
        let mut link = Link::new(self.run.rate_hz, self.run.jitter, 1);
        let (mut extent, mut force) = (Extent::NONE, DVec3::ZERO);
        let (mut push, mut asked, mut across_n): (f64, f64, f64) = (0.0, 0.0, 0.0);
        let (mut net_j, mut most_j, mut least_j, mut rise_j): (f64, f64, f64, f64) =
            (0.0, 0.0, 0.0, 0.0);
        let mut fault = None;
        for number in 0..(END_S / DT) as usize {
            let s = number as f64 * DT;
            let handle = plant.handle();
            let tip = handle.position - DVec3::Z * HEAD_M;
            booked.age();
            if let Some((wall, around)) = link.newest(s, |s| (self.run.wall(s), tip)) {
                let patch = self.ground.patch(&wall, around);
                // Over a wall that rests most patches are the one before.
                if self.run.motion != Motion::Still || sent.as_ref() != Some(&patch) {
                    contact = self.contact(&wall, patch.clone())?;
                    sent = Some(patch);
                }
                servo.receive(contact, Sender::Same);
                booked.change(contact, handle.position);
            }
            let (wanted, tick) = servo.step(&handle, DT);
            fault = fault.or(tick.fault);
            match self.run.path {
                Path::Servo => force = wanted,
                Path::Sent if number % 16 == 0 => force = wanted,
                Path::Sent | Path::Nothing => {}
            }
            let normal = booked.contact.normal();
            let force = match self.tilt {
                Tilt::BySlope => force,
                Tilt::Upright => normal * force.dot(normal),
            };
            let (from, before_j) = (plant.true_position(), plant.given_j());
            if fault.is_none() && self.run.path == Path::Servo {
                net_j += booked.soften(&handle, tick.stiffness_n_m, from);
            }
            plant.advance(force, self.target(s), DT);
            let to = plant.true_position();
            net_j += plant.given_j() - before_j - booked.work(from, to);
            most_j = most_j.max(net_j);
            // What the device's mass keeps it has not given yet.
            let with_motion_j = net_j + plant.kinetic_j();
            least_j = least_j.min(with_motion_j);
            rise_j = rise_j.max(with_motion_j - least_j);
            across_n = across_n.max((force - normal * force.dot(normal)).length());
            if (STILL_S[0]..STILL_S[1]).contains(&s) {
                extent.include(to);
                push += force.dot(normal);
                asked += booked.force(to).dot(normal);
            }
        }
        Ok(ReliefOutcome {
            wobble_m: extent.peak_to_peak_m(),
            net_j: most_j,
            rise_j,
            share: push / asked,
            across_n,
            fault,
        })
    }

    /// Whether the hand is still, is given no energy, and feels its wall. Friction hides what is given, and a wall beyond
    /// 2b/T may be softened.
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
                    });
                }
            }
        }
    }
    runs
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plant::Hand;

    fn went(runs: impl IntoIterator<Item = ReliefRun>) -> Vec<(ReliefRun, ReliefOutcome)> {
        let go = |run: ReliefRun| (run, run.go().expect("a wall"));
        runs.into_iter().map(go).collect()
    }

    fn most(all: &[(ReliefRun, ReliefOutcome)], of: impl Fn(&ReliefOutcome) -> f64) -> f64 {
        all.iter().map(|(_, it)| of(it)).fold(0.0, f64::max)
    }

    fn every_hand_is_still(ground: Ground) {
        let runs = relief_grid(Path::Servo);
        let all = went(runs.into_iter().filter(|run| run.ground == ground));
        let bad: Vec<_> = all.iter().filter(|(run, it)| !run.is_good(it)).collect();
        for (run, outcome) in bad.iter().take(10) {
            println!("{run:?}: {outcome:?}");
        }
        let soft = |(run, it): &(ReliefRun, ReliefOutcome)| match run.run.stiffness {
            k if k < super::super::BOUND_N_M => (it.share - 1.0).abs(),
            _ => 0.0,
        };
        let moved: Vec<_> = all
            .iter()
            .filter(|(run, _)| run.friction == 0.0)
            .copied()
            .collect();
        println!(
            "{ground:?}: {} runs, {} bad: wobble {:.3} mm, energy {:.3} µJ, {:.3} µJ from some time on, force off by {:.2} %, {:.2} N across at most",
            all.len(),
            bad.len(),
            most(&all, |it| it.wobble_m) * 1e3,
            most(&all, |it| it.net_j) * 1e6,
            most(&moved, |it| it.rise_j) * 1e6,
            all.iter().map(soft).fold(0.0, f64::max) * 1e2,
            most(&all, |it| it.across_n)
        );
        assert_eq!((all.len(), bad.len()), (675, 0), "{ground:?}");
    }

    #[test]
    fn every_hand_is_still_on_rough_ground_and_gets_no_energy_of_it() {
        every_hand_is_still(Ground::Rough);
    }

    #[test]
    fn every_hand_is_still_on_a_ridge_and_gets_no_energy_of_it() {
        every_hand_is_still(Ground::Ridge);
    }

    #[test]
    fn every_hand_is_still_at_an_edge_and_gets_no_energy_of_it() {
        every_hand_is_still(Ground::Edge);
    }

    fn some(stiffness: f64, ground: Ground, path: Path) -> impl Iterator<Item = ReliefRun> {
        let runs = relief_grid(path).into_iter();
        runs.filter(move |it| {
            (it.run.stiffness, it.ground, it.friction) == (stiffness, ground, 0.0)
        })
    }

    /// The seeded faults: a force that is sent over a network shakes a fingertip here too, and a servo that does nothing is
    /// found out.
    #[test]
    fn a_force_from_afar_and_none_are_found_out() {
        for ground in [Ground::Rough, Ground::Ridge, Ground::Edge] {
            let sent =
                went(some(500.0, ground, Path::Sent).filter(|it| it.run.hand == Hand::FINGERTIP));
            assert!(sent.iter().all(|(run, it)| !run.is_good(it)), "{ground:?}");
            let nothing = went(some(300.0, ground, Path::Nothing));
            let still = nothing
                .iter()
                .filter(|(it, _)| it.run.motion == Motion::Still);
            assert!(still.clone().count() > 20);
            for (run, outcome) in still {
                assert!(!run.is_good(outcome), "{run:?}: {outcome:?}");
            }
        }
    }

    /// The other seeded fault: a force that is not tilted by the slope, without the friction of the device that would hide it.
    #[test]
    fn an_upright_force_on_relief_gives_energy() {
        for ground in [Ground::Rough, Ground::Ridge, Ground::Edge] {
            let without_friction = |tilt| {
                let runs = some(300.0, ground, Path::Servo).map(move |it| ReliefRun {
                    tilt,
                    coulomb_n: 0.0,
                    ..it
                });
                let still = runs.filter(|it| it.run.motion == Motion::Still);
                let all = went(still);
                most(&all, |it| it.rise_j)
            };
            let [tilted_j, upright_j] = [Tilt::BySlope, Tilt::Upright].map(without_friction);
            println!(
                "{ground:?}: tilted {:.2} µJ, upright {:.0} µJ",
                tilted_j * 1e6,
                upright_j * 1e6
            );
            assert!(tilted_j <= NO_ENERGY_J && upright_j > 10.0 * NO_ENERGY_J);
        }
    }
}
