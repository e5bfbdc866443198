//! The fluid force in the hand: a stroke to and fro through paint over a wall, and a hand that then holds still.
//!
//! The paint is a film that the brush carries along: a damper c to a mass c·τ, whose velocity u follows the brush's, f
//! = −c·(v − u), so it stores ½·c·τ·u² and returns no more. A solver sends f at its own rate, late and with losses. The
//! criterion is the energy given to the hand beyond the wall's and the film's.

use glam::DVec3;
use maulstick_num::sin;
use maulstick_types::Pose;
use maulstick_types::haptics::{ContactModel, FluidForce, ForceLaw};

use maulstick_haptics::contact::Contact;
use maulstick_haptics::extent::Extent;
use maulstick_haptics::fluid::Fluid;
use maulstick_haptics::plant::{Hand, Plant};
use maulstick_haptics::servo::Servo;
use maulstick_haptics::servo::fault::Fault;
use maulstick_haptics::servo::limits::Limits;
use maulstick_haptics::servo::tick::Sender;

use super::link::Link;
use super::{DAMPING_N_S_M, DT, HEAD_M, MAX_STIFFNESS_N_M};

/// Stiffness of the wall, N/m.
const WALL_N_M: f64 = 200.0;
/// The stroke continues until then; the hand holds still between the second and the third time, s.
const STROKE_S: f64 = 3.1;
const STILL_S: f64 = 4.6;
const END_S: f64 = 5.1;

/// Output of the solver.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Telling {
    /// Force and Jacobian.
    True,
    /// The force alone, with no Jacobian and no period: it is held between two messages.
    Held,
    /// The force alone by the printed, inward normal: drag pushes the hand.
    Inward,
}

/// A film of paint and its solver.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Film {
    /// Drag, N·s/m.
    pub drag: f64,
    /// Time constant with which the brush carries it along, s; 0 of one that stands.
    pub carried_s: f64,
    /// Rate of messages, Hz.
    pub rate_hz: f64,
    /// Messages are late by up to this share of their period, and as often are lost.
    pub jitter: f64,
    /// Output of the solver.
    pub telling: Telling,
}

/// One hand in one film.
#[derive(Clone, Copy, Debug)]
pub struct FluidRun {
    /// The hand.
    pub hand: Hand,
    /// The film.
    pub film: Film,
    /// Role of the observer.
    pub observer: Observer,
}

/// Role of the servo's passivity observer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Observer {
    /// The observer acts.
    There,
    /// It assumes a device that damps all gains.
    Blind,
}

/// Result of a run.
#[derive(Clone, Copy, Debug)]
pub struct FluidOutcome {
    /// Movement of the tip while the hand holds still, peak to peak, m.
    pub wobble_m: f64,
    /// Greatest rise after some time of the energy given to the hand without a source, J.
    pub net_j: f64,
    /// Energy that the film took from the hand, J.
    pub taken_j: f64,
    /// True if the observer took energy back.
    pub braked: bool,
    /// Fault that latched the force at zero, if any.
    pub fault: Option<Fault>,
}

impl Film {
    /// Output of the solver for a brush and a film of these velocities, m/s.
    pub(super) fn message(&self, velocity: DVec3, carried: DVec3) -> FluidForce {
        let six = |v: DVec3| [v.x, v.y, v.z, 0.0, 0.0, 0.0];
        let force = (velocity - carried) * -self.drag;
        let mut jacobian = [[0.0; 6]; 6];
        if self.telling == Telling::True {
            for (i, row) in jacobian.iter_mut().enumerate().take(3) {
                row[i] = -self.drag;
            }
        }
        let period_ns = (1e9 / self.rate_hz) as u64;
        FluidForce {
            device: 0,
            device_epoch: 0,
            pose: Pose::IDENTITY,
            velocity: six(velocity),
            wrench: six(match self.telling {
                Telling::Inward => -force,
                Telling::True | Telling::Held => force,
            }),
            jacobian,
            time_to_live_ns: 3 * period_ns,
            // The force of a solver that states its period fades after it.
            recovery_ns: match self.telling {
                Telling::Held => 0,
                Telling::True | Telling::Inward => period_ns,
            },
        }
    }

    /// Its velocity a tick later, m/s, under a brush that touches it by a share.
    pub(super) fn follow(&self, carried: DVec3, velocity: DVec3, touch: f64) -> DVec3 {
        if self.carried_s > 0.0 {
            carried + (velocity - carried) * (touch * DT / self.carried_s)
        } else {
            carried
        }
    }

    /// Energy that it keeps at a velocity, J.
    pub(super) fn kept_j(&self, carried: DVec3) -> f64 {
        0.5 * self.drag * self.carried_s * carried.length_squared()
    }
}

/// Target of the hand at a time.
fn target(s: f64) -> DVec3 {
    let depth = if s < 0.6 { -0.002 } else { 0.003 };
    let along = 0.03 * sin(8.0 * (s.clamp(0.8, STROKE_S) - 0.8));
    DVec3::new(along, 0.0, HEAD_M - depth)
}

impl FluidRun {
    /// Runs the hand.
    ///
    /// # Errors
    /// The defect of a wall or a force that is refused.
    pub fn go(&self) -> Result<FluidOutcome, &'static str> {
        let mut servo = Servo::new(Limits {
            max_force_n: 3.3,
            continuous_force_n: 3.3,
            max_stiffness_n_m: MAX_STIFFNESS_N_M,
            damping_n_s_m: match self.observer {
                Observer::There => DAMPING_N_S_M,
                Observer::Blind => 1e9,
            },
            ..Limits::default()
        });
        let law = ForceLaw::Rigid {
            stiffness_n_m: WALL_N_M,
        };
        let wall = Contact::new(&ContactModel::bare(law, HEAD_M))?;
        let mut plant = Plant::omni(self.hand, DVec3::Z * (HEAD_M + 0.002));
        let stored = |plant: &Plant| {
            let depth = (HEAD_M - plant.true_position().z).max(0.0);
            0.5 * WALL_N_M * depth * depth
        };
        let (film, mut carried) = (self.film, DVec3::ZERO);
        let mut link = Link::new(film.rate_hz, film.jitter, 1);
        let mut extent = Extent::NONE;
        let (mut net_j, mut least_j, mut most_j, mut taken_j): (f64, f64, f64, f64) =
            (0.0, 0.0, 0.0, 0.0);
        let (mut braked, mut fault) = (false, None);
        for number in 0..(END_S / DT) as usize {
            let s = number as f64 * DT;
            let velocity = plant.read_velocity();
            carried = film.follow(carried, velocity, 1.0);
            if let Some(message) = link.newest(s, |_| film.message(velocity, carried)) {
                servo.receive_fluid(Fluid::new(&message, 1.0)?);
            }
            if number % 4 == 0 {
                servo.receive(wall, Sender::Same);
            }
            let (force, tick) = servo.step(&plant.handle(), DT);
            (braked, fault) = (braked || tick.braked, fault.or(tick.fault));
            let before = (plant.given_j(), stored(&plant), plant.true_position());
            plant.advance(force, target(s), DT);
            let given = plant.given_j() - before.0 + stored(&plant) - before.1;
            net_j += given;
            let way = plant.true_position() - before.2;
            taken_j -= force.truncate().dot(way.truncate());
            let kept = film.kept_j(carried) + plant.kinetic_j();
            least_j = least_j.min(net_j + kept);
            most_j = most_j.max(net_j + kept - least_j);
            if s >= STILL_S {
                extent.include(plant.true_position());
            }
        }
        Ok(FluidOutcome {
            wobble_m: extent.peak_to_peak_m(),
            net_j: most_j,
            taken_j,
            braked,
            fault,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{HANDS, NO_ENERGY_J, STILL_M};

    fn runs(carried_s: f64, telling: Telling, observer: Observer) -> Vec<(FluidRun, FluidOutcome)> {
        let mut all = Vec::new();
        for hand in HANDS {
            for drag in [0.1, 0.3, 0.8] {
                for rate_hz in [15.0, 30.0, 60.0] {
                    for jitter in [0.0, 0.1, 0.2, 0.5] {
                        let film = Film {
                            drag,
                            carried_s,
                            rate_hz,
                            jitter,
                            telling,
                        };
                        let run = FluidRun {
                            hand,
                            film,
                            observer,
                        };
                        all.push((run, run.go().expect("a film")));
                    }
                }
            }
        }
        all
    }

    fn is_good((_, outcome): &(FluidRun, FluidOutcome)) -> bool {
        outcome.wobble_m <= STILL_M && outcome.net_j <= NO_ENERGY_J && outcome.fault.is_none()
    }

    fn most_net_j(all: &[(FluidRun, FluidOutcome)]) -> f64 {
        all.iter().map(|(_, it)| it.net_j).fold(0.0, f64::max)
    }

    #[test]
    fn paint_takes_energy_from_every_hand_and_gives_none_that_it_had_not_taken() {
        for carried_s in [0.0, 0.05, 0.2] {
            let all = runs(carried_s, Telling::True, Observer::There);
            let wobble_m = all.iter().map(|(_, it)| it.wobble_m).fold(0.0, f64::max);
            println!(
                "{} runs of a film of {carried_s} s: wobble {:.3} mm, energy {:.2} µJ at most",
                all.len(),
                wobble_m * 1e3,
                most_net_j(&all) * 1e6
            );
            for run in &all {
                assert!(is_good(run) && run.1.taken_j > 0.0, "{run:?}");
            }
        }
    }

    /// The seeded faults: drag that pushes the hand, and a force held without its Jacobian. The observer removes all
    /// but a fraction of the first one's gain.
    #[test]
    fn drag_that_pushes_is_found_out_and_the_observer_takes_its_power_back() {
        let refused = Film {
            telling: Telling::Inward,
            ..runs(0.0, Telling::True, Observer::There)[0].0.film
        };
        let mut message = refused.message(DVec3::X * 0.1, DVec3::ZERO);
        message.jacobian[0][0] = refused.drag;
        assert!(
            Fluid::new(&message, 1.0).is_err(),
            "with its Jacobian it is refused"
        );
        for telling in [Telling::Inward, Telling::Held] {
            let [seen, blind] =
                [Observer::There, Observer::Blind].map(|observer| runs(0.0, telling, observer));
            let bad = seen.iter().filter(|run| !is_good(run)).count();
            let (seen_j, blind_j) = (most_net_j(&seen), most_net_j(&blind));
            println!(
                "{telling:?}: {bad} of {} bad, {seen_j} J, unseen {blind_j} J",
                seen.len()
            );
            assert!(bad > 20 && blind_j > 1e-3 && seen_j < 0.15 * blind_j);
        }
    }
}
