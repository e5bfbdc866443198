//! Paint and guides in the hand.

use maulstick_haptics::Fluid;
use maulstick_types::Pose;
use maulstick_types::haptics::{FluidForce, GuideModel};

use super::*;

#[test]
fn a_force_of_paint_follows_the_hand_in_contact_alone() {
    let row = [-0.3, 0.0, 0.0, 0.0, 0.0, 0.0];
    let paint = FluidForce {
        device: 0,
        device_epoch: 0,
        pose: Pose::IDENTITY,
        // Computed for another velocity than the hand's.
        velocity: [0.4, 0.0, 0.0, 0.0, 0.0, 0.0],
        wrench: [-0.12, 0.0, 0.0, 0.0, 0.0, 0.0],
        jacobian: [row, [0.0; 6], [0.0; 6], [0.0; 6], [0.0; 6], [0.0; 6]],
        time_to_live_ns: 1_000_000_000,
        recovery_ns: 10_000_000,
    };
    for (height_m, expected) in [(0.021, DVec3::new(-0.03, 0.0, 0.4)), (0.026, DVec3::ZERO)] {
        let still = Still {
            handle: HandleState {
                position: DVec3::new(0.0, 0.0, height_m),
                orientation: DQuat::IDENTITY,
                velocity: DVec3::X * 0.1,
            },
            written: Arc::default(),
        };
        let limits = Limits {
            engage_s: 1e-3,
            engage_n: f64::INFINITY,
            longest_tick_s: 1e3,
            ..Limits::default()
        };
        let mut servo = start(placed(still, Rigid::IDENTITY, 1.0), limits);
        let dry = ContactModel::bare(
            ForceLaw::Rigid {
                stiffness_n_m: 100.0,
            },
            0.025,
        );
        let mut contact = Contact::new(&dry).expect("a model");
        contact.time_to_live_s = f64::INFINITY;
        servo.models.write(Delivery {
            model: Some(contact),
            sender: None,
            number: 1,
        });
        let pressed = |record: &TickRecord| (record.force.z - expected.z).abs() < 1e-9;
        let dry = tick(&mut servo, |record| !record.tick.waiting && pressed(record));
        assert_eq!(dry.expect("the wall").force.x, 0.0, "a dry wall");
        servo.fluids.write(Delivery {
            model: Some(Fluid::new(&paint, 1.0).expect("a force")),
            sender: None,
            number: 1,
        });
        let mut seen = 0;
        let felt = tick(&mut servo, |record| {
            seen += u32::from((record.force - expected).length() < 1e-9);
            seen == 20
        });
        assert!(felt.is_some(), "{expected}");
    }
}

/// A guide along x through a place, which nobody sends again.
fn guide(y: f64) -> Guide {
    let mut guide = Guide::new(&GuideModel {
        device: 0,
        device_epoch: 0,
        points_m: vec![[0.1, y, 0.1], [0.3, y, 0.1]],
        normal: [0.0, 0.0, 1.0],
        head_length_m: 0.0,
        stiffness_n_m: 100.0,
        damping_n_s_m: 0.0,
        max_force_n: 0.6,
        time_to_live_ns: 0,
    })
    .expect("a guide");
    guide.time_to_live_s = f64::INFINITY;
    guide
}

#[test]
fn the_simulated_hand_feels_a_guide_until_force_or_guidance_is_off() {
    let off = ForceControl {
        switch: Switch::Off,
        ..ForceControl::default()
    };
    let unguided = ForceControl {
        guidance: 0.0,
        ..ForceControl::default()
    };
    let limits = Limits {
        longest_tick_s: 1e3,
        ..Limits::default()
    };
    for control in [off, unguided] {
        let device = placed(Simulated::at_rest(), Rigid::IDENTITY, 1.0);
        let mut servo = start(device, limits);
        let put = |servo: &mut ServoThread, y: f64, number: u64| {
            servo.guides.write(Delivery {
                model: Some(guide(y)),
                sender: None,
                number,
            });
        };
        // Where the hand rests, and 8 mm aside of it.
        put(&mut servo, -0.2, 1);
        tick(&mut servo, |record| record.tick.guided).expect("a guide");
        let mut ticks = 0;
        let begun = tick(&mut servo, |_| {
            ticks += 1;
            ticks > 20
        });
        assert!(begun.is_some_and(|record| record.force.length() < 0.1));
        put(&mut servo, -0.192, 2);
        let felt = tick(&mut servo, |record| record.force.y > 0.3).expect("the guide");
        assert!(felt.tick.guided && !felt.tick.contact && felt.force.x.abs() < 1e-9);
        servo.controls.write(control);
        let is_free = |record: &TickRecord| record.force == DVec3::ZERO;
        assert!(tick(&mut servo, is_free).is_some(), "{control:?}");
    }
}
