//! One tick of the servo: evaluate the newest model, age it, limit the force.

use glam::DVec3;

use crate::contact::{Contact, Held};

/// What a force may be, whatever the models say.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Largest force, N: the least of the device's nominal and the configured one.
    pub max_force_n: f64,
    /// Largest stiffness, N/m.
    pub max_stiffness_n_m: f64,
    /// Fastest change of the force, N/s.
    pub slew_n_s: f64,
    /// Time over which a model past its time to live fades to nothing, s.
    pub fade_s: f64,
    /// Time over which force comes up after a start, a fault or another sender, s.
    pub engage_s: f64,
    /// A tick longer than this has stood still: no force, and engage anew, s.
    pub longest_tick_s: f64,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            max_force_n: 3.0,
            max_stiffness_n_m: 400.0,
            slew_n_s: 400.0,
            fade_s: 0.075,
            engage_s: 0.5,
            longest_tick_s: 0.005,
        }
    }
}

/// What happened in a tick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[expect(
    clippy::struct_excessive_bools,
    reason = "each may be so without the others"
)]
pub struct Tick {
    /// A number that was not finite: the servo gives no force until it is re-armed.
    pub fault: bool,
    /// The tick took too long.
    pub late: bool,
    /// The force was cut to its largest size.
    pub clamped: bool,
    /// The model is past its time to live.
    pub stale: bool,
}

/// The servo's state.
#[derive(Clone, Copy, Debug)]
pub struct Servo {
    limits: Limits,
    model: Option<Active>,
    before: Option<Active>,
    engaged_s: f64,
    force: DVec3,
    latched: bool,
}

/// A model and how long ago it arrived.
#[derive(Clone, Copy, Debug)]
struct Active {
    contact: Contact,
    age_s: f64,
}

impl Servo {
    /// A servo without a model.
    #[must_use]
    pub fn new(limits: Limits) -> Self {
        Self {
            limits,
            model: None,
            before: None,
            engaged_s: 0.0,
            force: DVec3::ZERO,
            latched: false,
        }
    }

    /// A new model has arrived. From `another_sender` the force engages anew.
    pub fn receive(&mut self, contact: Contact, another_sender: bool) {
        if another_sender {
            self.engaged_s = 0.0;
        }
        self.before = self.model.take();
        self.model = Some(Active {
            contact,
            age_s: 0.0,
        });
    }

    /// Allows force again after a fault; it engages anew.
    pub fn rearm(&mut self) {
        self.latched = false;
        self.engaged_s = 0.0;
        self.model = None;
        self.before = None;
    }

    /// Whether a fault holds the force at zero.
    #[must_use]
    pub fn is_latched(&self) -> bool {
        self.latched
    }

    /// The force on the hand for the next tick, N, `dt` s after the tick before.
    pub fn step(&mut self, held: &Held, dt: f64) -> (DVec3, Tick) {
        let mut tick = Tick::default();
        let sane = dt.is_finite()
            && held.position.is_finite()
            && held.velocity.is_finite()
            && held.orientation.is_finite();
        if !sane {
            self.latched = true;
        }
        if self.latched {
            self.force = DVec3::ZERO;
            tick.fault = true;
            return (self.force, tick);
        }
        if dt > self.limits.longest_tick_s || dt < 0.0 {
            self.force = DVec3::ZERO;
            self.engaged_s = 0.0;
            tick.late = true;
        }
        let dt = dt.clamp(0.0, self.limits.longest_tick_s);
        self.age(dt);
        let wanted = self.wanted(held, &mut tick);
        if !wanted.is_finite() {
            self.latched = true;
            self.force = DVec3::ZERO;
            tick.fault = true;
            return (self.force, tick);
        }
        let size = wanted.length();
        tick.clamped = size > self.limits.max_force_n;
        let limited = if tick.clamped {
            wanted * (self.limits.max_force_n / size)
        } else {
            wanted
        };
        let change = limited - self.force;
        let most = self.limits.slew_n_s * dt;
        let change = if change.length() > most {
            change.normalize_or_zero() * most
        } else {
            change
        };
        self.force += change;
        (self.force, tick)
    }

    fn age(&mut self, dt: f64) {
        self.engaged_s += dt;
        for active in [&mut self.model, &mut self.before].into_iter().flatten() {
            active.age_s += dt;
        }
    }

    /// The force that the models ask for.
    fn wanted(&mut self, held: &Held, tick: &mut Tick) -> DVec3 {
        let Some(model) = &self.model else {
            return DVec3::ZERO;
        };
        let stiffest = self.limits.max_stiffness_n_m;
        let mut force = model.contact.force(held, stiffest);
        if let Some(before) = &self.before {
            let recovery = model.contact.recovery_s;
            if model.age_s < recovery {
                let share = model.age_s / recovery;
                force = before.contact.force(held, stiffest).lerp(force, share);
            } else {
                self.before = None;
            }
        }
        let overdue = model.age_s - model.contact.time_to_live_s;
        tick.stale = overdue > 0.0;
        let fading = (1.0 - overdue.max(0.0) / self.limits.fade_s).max(0.0);
        force * (fading * (self.engaged_s / self.limits.engage_s).min(1.0))
    }
}

#[cfg(test)]
mod tests {
    use glam::DQuat;
    use maulstick_types::haptics::ForceLaw;
    use proptest::prelude::*;

    use super::*;
    use crate::contact::tests::{linear, model};

    const DT: f64 = 1e-3;

    fn held(depth: f64) -> Held {
        Held {
            position: DVec3::new(0.0, 0.0, 0.025 - depth),
            orientation: DQuat::IDENTITY,
            velocity: DVec3::ZERO,
        }
    }

    fn contact(law: ForceLaw) -> Contact {
        Contact::new(&model(law)).expect("a model")
    }

    /// A servo whose force has come up at `depth`, kept alive by a model a tick.
    fn engaged(depth: f64) -> Servo {
        let mut servo = Servo::new(Limits::default());
        for _ in 0..1000 {
            servo.receive(contact(linear()), false);
            servo.step(&held(depth), DT);
        }
        servo
    }

    #[test]
    fn the_force_comes_up_over_the_ramp_and_reaches_the_model() {
        let mut servo = Servo::new(Limits::default());
        let mut last = 0.0;
        for tick in 1..=600 {
            servo.receive(contact(linear()), tick == 1);
            let (force, _) = servo.step(&held(0.0125), DT);
            assert!(force.z >= last - 1e-12 && force.z <= 0.4 * f64::from(tick) * DT / 0.5 + 1e-9);
            last = force.z;
        }
        assert!((last - 0.4).abs() < 1e-9);
    }

    #[test]
    fn a_silent_sender_loses_its_force_within_time_to_live_and_fade() {
        let mut servo = engaged(0.0125);
        let mut ticks = 0;
        loop {
            ticks += 1;
            let (force, tick) = servo.step(&held(0.0125), DT);
            // The newest model came a tick before the first of these, so the 49th ends its 50 ms.
            assert!(ticks == 49 || tick.stale == (ticks > 49), "{ticks}");
            if force == DVec3::ZERO {
                break;
            }
        }
        assert!(ticks <= 126, "{ticks} ms");
    }

    #[test]
    fn a_jump_of_the_plane_is_spread_over_the_recovery_time() {
        let mut servo = engaged(0.0125);
        let mut higher = model(linear());
        higher.plane_point_m[2] = 0.01;
        servo.receive(Contact::new(&higher).expect("a model"), false);
        let before = servo.force.z;
        let (first, _) = servo.step(&held(0.0125), DT);
        assert!(
            first.z - before < 0.12 * 0.32,
            "{} N at once",
            first.z - before
        );
        for _ in 0..10 {
            servo.step(&held(0.0125), DT);
        }
        assert!((servo.force.z - 0.72).abs() < 1e-9, "{}", servo.force.z);
    }

    #[test]
    fn a_number_that_is_none_latches_the_fault() {
        let mut servo = engaged(0.0125);
        let broken = Held {
            velocity: DVec3::new(f64::NAN, 0.0, 0.0),
            ..held(0.01)
        };
        assert!(servo.step(&broken, DT).1.fault);
        assert_eq!(servo.step(&held(0.0125), DT).0, DVec3::ZERO, "latched");
        servo.rearm();
        servo.receive(contact(linear()), true);
        assert!(servo.step(&held(0.0125), DT).0.z < 0.01, "and engages anew");
    }

    #[test]
    fn a_long_tick_drops_the_force() {
        let mut servo = engaged(0.0125);
        let (force, tick) = servo.step(&held(0.0125), 0.2);
        assert!(tick.late && force.length() < 0.01, "{force}");
    }

    proptest! {
        #[test]
        fn force_and_its_change_stay_within_their_limits(
            moves in prop::collection::vec(
                (-0.06..0.06f64, -3.0..3.0f64, 0.0..0.02f64, 0u8..4, 0.0..2000.0f64), 1..200),
        ) {
            let limits = Limits::default();
            let mut servo = Servo::new(limits);
            let mut last = DVec3::ZERO;
            for (depth, speed, dt, kind, stiffness) in moves {
                match kind {
                    0 => servo.receive(contact(ForceLaw::Rigid { stiffness_n_m: stiffness }), false),
                    1 => servo.receive(contact(linear()), true),
                    _ => {}
                }
                let held = Held { velocity: DVec3::splat(speed), ..held(depth) };
                let (force, tick) = servo.step(&held, dt);
                prop_assert!(force.length() <= limits.max_force_n * (1.0 + 1e-12));
                if !tick.late {
                    let change = (force - last).length();
                    prop_assert!(change <= limits.slew_n_s * dt * (1.0 + 1e-9) + 1e-12);
                }
                last = force;
            }
        }
    }
}
