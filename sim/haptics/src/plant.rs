//! A device in a hand: the plant of the simulated stylus.
//!
//! The device is a point mass with viscous and Coulomb friction whose position is read in encoder counts; the hand is a
//! spring and a damper whose end moves to its target. Semi-implicit Euler with twenty substeps a tick: an explicit
//! scheme would add energy.

use glam::DVec3;

use crate::contact::HandleState;

/// The hand's grip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hand {
    /// Mass that moves with the handle, kg.
    pub mass_kg: f64,
    /// Damping, N·s/m.
    pub damping: f64,
    /// Stiffness, N/m.
    pub stiffness: f64,
}

impl Hand {
    /// A light fingertip, without damping.
    pub const FINGERTIP: Self = Self {
        mass_kg: 0.02,
        damping: 0.2,
        stiffness: 400.0,
    };
    /// A pen grip.
    pub const PEN_GRIP: Self = Self {
        mass_kg: 0.2,
        damping: 3.5,
        stiffness: 200.0,
    };
    /// A heavy arm.
    pub const ARM: Self = Self {
        mass_kg: 0.7,
        damping: 10.0,
        stiffness: 100.0,
    };
}

/// Device and hand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plant {
    /// Grip of the hand.
    pub hand: Hand,
    /// Mass of the device's tip, kg.
    pub mass_kg: f64,
    /// Viscous friction of the device, N·s/m.
    pub damping: f64,
    /// Coulomb friction of the device, N.
    pub coulomb_n: f64,
    /// Step of its encoders, m.
    pub quantum_m: f64,
    /// Largest force of its motors, N.
    pub max_force_n: f64,
    position: DVec3,
    velocity: DVec3,
    read: DVec3,
    read_velocity: DVec3,
    given_j: f64,
}

const SUBSTEPS: usize = 20;
/// Corner frequency of the velocity filter, rad/s (60 Hz).
const VELOCITY_CORNER: f64 = 377.0;

impl Plant {
    /// A Phantom Omni's tip (45 g, encoder step 55 µm) in a grip, at rest at `position`.
    #[must_use]
    pub fn omni(hand: Hand, position: DVec3) -> Self {
        let mut plant = Self {
            hand,
            mass_kg: 0.045,
            damping: 0.3,
            coulomb_n: 0.06,
            quantum_m: 5.5e-5,
            max_force_n: 3.3,
            position,
            velocity: DVec3::ZERO,
            read: position,
            read_velocity: DVec3::ZERO,
            given_j: 0.0,
        };
        plant.read = plant.quantised();
        plant
    }

    fn quantised(&self) -> DVec3 {
        (self.position / self.quantum_m).round() * self.quantum_m
    }

    /// Position that the encoders read, m.
    #[must_use]
    pub fn read_position(&self) -> DVec3 {
        self.read
    }

    /// Velocity from the encoders, filtered at 60 Hz, m/s.
    #[must_use]
    pub fn read_velocity(&self) -> DVec3 {
        self.read_velocity
    }

    /// An upright brush in the hand, from the encoders.
    #[must_use]
    pub fn handle(&self) -> HandleState {
        HandleState {
            velocity: self.read_velocity,
            ..HandleState::upright(self.read)
        }
    }

    /// Exact position of the tip, m.
    #[must_use]
    pub fn true_position(&self) -> DVec3 {
        self.position
    }

    /// Energy given to the hand at the grip so far, J: the work of the motors, less the losses to the device's friction
    /// and the kinetic energy of its mass.
    #[must_use]
    pub fn given_j(&self) -> f64 {
        self.given_j
    }

    /// Energy in the motion of the device's mass, J.
    #[must_use]
    pub fn kinetic_j(&self) -> f64 {
        0.5 * self.mass_kg * self.velocity.length_squared()
    }

    /// Advances by `dt` s with `force` from the motors on the hand, whose target is `target`.
    pub fn advance(&mut self, force: DVec3, target: DVec3, dt: f64) {
        let size = force.length();
        let force = if size > self.max_force_n {
            force * (self.max_force_n / size)
        } else {
            force
        };
        let mass = self.mass_kg + self.hand.mass_kg;
        let step = dt / SUBSTEPS as f64;
        for _ in 0..SUBSTEPS {
            let pull = (target - self.position) * self.hand.stiffness;
            let drag = self.velocity * (self.hand.damping + self.damping);
            let before = self.velocity;
            let mut velocity = before + (force + pull - drag) * (step / mass);
            // Coulomb friction stops the tip without reversing it.
            let lost = self.coulomb_n * step / mass;
            let speed = velocity.length();
            velocity *= if speed > lost {
                (speed - lost) / speed
            } else {
                0.0
            };
            self.velocity = velocity;
            let way = velocity * step;
            self.position += way;
            let stopped = mass * (speed - velocity.length()) / step * way.length();
            let viscous = self.damping * before.dot(way);
            let kept = 0.5 * self.mass_kg * (velocity.length_squared() - before.length_squared());
            self.given_j += force.dot(way) - viscous - stopped - kept;
        }
        let read = self.quantised();
        let raw = (read - self.read) / dt;
        self.read_velocity += (raw - self.read_velocity) * (VELOCITY_CORNER * dt).min(1.0);
        self.read = read;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_hand_gets_is_the_motors_work_less_what_the_device_takes() {
        // A push of 1 N to a place 10 mm further: the hand keeps the energy of its spring and loses that of its damper.
        let mut plant = Plant {
            coulomb_n: 0.0,
            ..Plant::omni(Hand::PEN_GRIP, DVec3::ZERO)
        };
        let mut lost = 0.0;
        for _ in 0..5000 {
            let from = plant.position;
            plant.advance(DVec3::X, DVec3::ZERO, 1e-3);
            let speed = (plant.position - from).length() / 1e-3;
            lost += plant.hand.damping * speed * speed * 1e-3;
        }
        let stored = 0.5 * plant.hand.stiffness * plant.position.length_squared();
        let given = plant.given_j();
        assert!(
            (given - stored - lost).abs() < 0.02 * given,
            "{given} {stored} {lost}"
        );
    }

    #[test]
    fn a_free_hand_reaches_its_target() {
        let mut plant = Plant::omni(Hand::PEN_GRIP, DVec3::ZERO);
        let target = DVec3::new(0.05, 0.0, 0.02);
        for _ in 0..2000 {
            plant.advance(DVec3::ZERO, target, 1e-3);
        }
        let rest = plant.coulomb_n / plant.hand.stiffness;
        assert!((plant.true_position() - target).length() <= rest + 1e-6);
    }
}
