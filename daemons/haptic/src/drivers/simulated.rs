//! A simulated device and hand: the hand follows a take and reacts to the force; without a take it rests beside the
//! desk, out of range.

use glam::{DQuat, DVec3};
use maulstick_brush::desk::{ferrule, pen_orientation};
use maulstick_brush::solver::HalfSpace;
use maulstick_device::Take;
use maulstick_device::registration::Registration;
use maulstick_haptics::contact::HandleState;
use maulstick_haptics::{Hand, Plant};
use maulstick_types::stylus::{DEFAULT_TILT_RAD, axes};

use crate::device::driver::{Abilities, DeviceError, Driver, Reading, Wrench};

/// Rest position of the hand, device frame, m.
const REST: DVec3 = DVec3::new(0.2, -0.2, 0.1);

/// Force that its warm motors bear, N: an Omni's.
const CONTINUOUS_N: f64 = 0.88;
/// Temperature of motors that give that force for ever.
const STEADY: f64 = 0.6;
/// Time in which they warm, s.
const WARMING_S: f64 = 60.0;

/// Target position of the hand at a time.
#[derive(Clone, Copy, Debug)]
struct Target {
    time_s: f64,
    position: DVec3,
    orientation: DQuat,
    switches: u32,
    in_range: bool,
}

/// The simulated device.
#[derive(Debug)]
pub struct Simulated {
    plant: Plant,
    force: DVec3,
    targets: Vec<Target>,
    next: usize,
    time_s: f64,
    temperature: f64,
}

impl Simulated {
    /// A hand at rest.
    #[must_use]
    pub fn at_rest() -> Self {
        Self {
            plant: Plant::omni(Hand::PEN_GRIP, REST),
            force: DVec3::ZERO,
            targets: Vec::new(),
            next: 0,
            time_s: 0.0,
            temperature: 0.0,
        }
    }

    /// A hand that follows a take with a brush whose head is `head_length_m` long. A take is in the
    /// desk frame; `fitting` says where the device stands, and which point of it is the ferrule.
    #[must_use]
    pub fn following(
        take: &Take,
        head_length_m: f64,
        depth_share: f64,
        registration: &Registration,
    ) -> Self {
        let start_ns = take.samples.first().map_or(0, |first| first.time_ns);
        let targets: Vec<Target> = take
            .samples
            .iter()
            .map(|s| {
                let on_desk = ferrule(&s.sample, head_length_m, depth_share, &HalfSpace::SURFACE);
                let orientation = registration.to_desk.turned_back(on_desk.rotation);
                let ferrule = registration.to_desk.point_back(on_desk.translation);
                Target {
                    time_s: (s.time_ns - start_ns) as f64 * 1e-9,
                    position: ferrule - orientation * registration.ferrule_m,
                    orientation,
                    switches: s.sample.switches,
                    in_range: s.sample.in_range,
                }
            })
            .collect();
        let start = targets.first().map_or(REST, |first| first.position);
        let mut simulated = Self::at_rest();
        simulated.plant = Plant::omni(Hand::PEN_GRIP, start);
        simulated.targets = targets;
        simulated
    }

    fn target(&mut self) -> Target {
        while self.next + 1 < self.targets.len()
            && self.targets[self.next + 1].time_s <= self.time_s
        {
            self.next += 1;
        }
        let over = self
            .targets
            .last()
            .is_none_or(|last| self.time_s > last.time_s);
        let rest = Target {
            time_s: 0.0,
            position: REST,
            orientation: pen_orientation(DEFAULT_TILT_RAD, 0.0),
            switches: 0,
            in_range: false,
        };
        if over { rest } else { self.targets[self.next] }
    }
}

impl Driver for Simulated {
    fn abilities(&self) -> Abilities {
        Abilities {
            senses: axes::POSITION | axes::ORIENTATION | axes::VELOCITY | axes::SWITCHES,
            drives: axes::FORCE,
            max_force_n: self.plant.max_force_n,
            continuous_force_n: CONTINUOUS_N,
            max_torque_nm: 0.0,
            max_stiffness_n_m: 500.0,
            max_slew_n_s: f64::INFINITY,
            max_speed_m_s: f64::INFINITY,
            damping_n_s_m: self.plant.damping,
            workspace_m: [-0.3, -0.3, -0.05, 0.3, 0.3, 0.3],
        }
    }

    fn read(&mut self, dt: f64) -> Result<Option<Reading>, DeviceError> {
        let target = self.target();
        self.plant.advance(self.force, target.position, dt);
        self.time_s += dt;
        // The heat of the coils goes with the square of the force; at the continuous force they end
        // up where the servo holds the force, between warm and cool.
        let load = self.force.length() / CONTINUOUS_N;
        self.temperature += (STEADY * load * load - self.temperature) * (dt / WARMING_S).min(1.0);
        Ok(Some(Reading {
            handle: HandleState {
                position: self.plant.read_position(),
                orientation: target.orientation,
                velocity: self.plant.read_velocity(),
            },
            switches: target.switches,
            in_range: target.in_range,
            is_permitted: true,
            motor_temperature: self.temperature,
        }))
    }

    fn write(&mut self, wrench: Wrench) -> Result<(), DeviceError> {
        self.force = wrench.force;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use maulstick_device::demo::{Subject, performance};
    use maulstick_device::registration::Similarity;
    use maulstick_num::geometry::{Rigid, rotation};

    use super::*;
    use crate::MountedDevice;

    fn read(device: &mut Simulated) -> Reading {
        device.read(1e-3).expect("there").expect("new")
    }

    fn registration(rigid: Rigid, ferrule_m: DVec3) -> Registration {
        Registration {
            to_desk: Similarity { rigid, scale: 1.0 },
            ferrule_m,
            corners: None,
        }
    }

    #[test]
    fn a_free_hand_follows_its_take_with_the_lag_of_its_grip() {
        let take = performance(Subject::Flower, 1);
        let plain = registration(Rigid::IDENTITY, DVec3::ZERO);
        let mut device = Simulated::following(&take, 0.025, 0.5, &plain);
        let (mut sum, mut count) = (0.0, 0);
        for tick in 0..10_000 {
            let reading = read(&mut device);
            let target = device.target();
            if tick > 500 && reading.in_range {
                sum += (reading.handle.position - target.position).length();
                count += 1;
            }
        }
        // Damping over stiffness is 19 ms of lag, at about 0.1 m/s.
        assert!(
            count > 9000 && sum / f64::from(count) < 0.01,
            "{} m",
            sum / f64::from(count)
        );
    }

    #[test]
    fn a_take_is_followed_on_the_desk_wherever_the_device_stands() {
        let take = performance(Subject::Flower, 1);
        let to_desk = Rigid {
            rotation: rotation(DVec3::new(0.0, 0.6, 0.8), 1.2),
            translation: DVec3::new(0.3, -0.1, 0.2),
        };
        let plain = registration(Rigid::IDENTITY, DVec3::ZERO);
        let to_desk = registration(to_desk, DVec3::new(0.0, 0.01, -0.06));
        let mut plain = Simulated::following(&take, 0.025, 0.5, &plain);
        let turned = Simulated::following(&take, 0.025, 0.5, &to_desk);
        let mut turned = MountedDevice::new(Box::new(turned), to_desk, 0);
        for _ in 0..3000 {
            let plain = read(&mut plain).handle;
            let turned = turned.read(1e-3).expect("there").expect("new").handle;
            // The encoders' steps lie along the device's own axes, and friction follows them.
            assert!((plain.position - turned.position).length() < 1e-3);
            assert!(plain.orientation.angle_between(turned.orientation) < 1e-6);
        }
    }

    #[test]
    fn without_a_take_it_rests_out_of_range() {
        let mut device = Simulated::at_rest();
        let reading = (0..1000)
            .map(|_| read(&mut device))
            .last()
            .expect("a reading");
        assert!(!reading.in_range && (reading.handle.position - REST).length() < 1e-3);
    }
}
