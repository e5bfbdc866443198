//! A tick of the servo allocates nothing, in any situation.

#[path = "../../num/tests/counting/mod.rs"]
mod counting;

use counting::allocations;
use glam::{DQuat, DVec3};
use maulstick_haptics::contact::HandleState;
use maulstick_haptics::{Contact, Fluid, Guide, Limits, Sender, Servo, Switch};
use maulstick_num::sin;
use maulstick_types::Pose;
use maulstick_types::haptics::{
    ContactModel, FluidForce, ForceLaw, Grain, GuideModel, HeightPatch, HermiteKnot, height_bytes,
};

fn contact(law: ForceLaw) -> Contact {
    Contact::new(&ContactModel {
        friction_static: 0.3,
        friction_kinetic: 0.2,
        viscous_n_s_m: 0.1,
        grain: Grain {
            amplitude: 0.03,
            wavelength_m: 1e-3,
            seed: 1,
        },
        time_to_live_ns: 20_000_000,
        recovery_ns: 15_000_000,
        relief: HeightPatch {
            corner_m: [-8e-3, -8e-3, 0.0],
            along: [1.0, 0.0, 0.0],
            cell_m: 1e-3,
            heights_um: height_bytes((0..256).map(|cell| cell % 7 * 50)),
        },
        ..ContactModel::bare(law, 0.025)
    })
    .expect("a model")
}

fn paint() -> Fluid {
    Fluid::new(
        &FluidForce {
            device: 0,
            device_epoch: 0,
            pose: Pose::IDENTITY,
            velocity: [0.0; 6],
            wrench: [0.1; 6],
            jacobian: [[0.0; 6]; 6],
            time_to_live_ns: 30_000_000,
            recovery_ns: 20_000_000,
        },
        1.0,
    )
    .expect("a force")
}

/// A law of each kind.
fn laws() -> [ForceLaw; 5] {
    let knots = [
        [0.0, 0.0, 12.0],
        [0.06, 0.5, 0.3],
        [0.5, 0.6, 0.2],
        [1.0, 0.8, 0.8],
    ];
    let knots = knots.map(|[depth, force_n, slope_n]| HermiteKnot {
        depth,
        force_n,
        slope_n,
    });
    [
        ForceLaw::None,
        ForceLaw::Linear {
            k1_n: 0.8,
            k2_n: 6.0,
        },
        ForceLaw::Hermite {
            knots: knots.to_vec(),
        },
        ForceLaw::Local {
            pose: Pose::IDENTITY,
            force_n: [0.0, 0.0, 0.5],
            stiffness_n_m: [[0.0; 3], [0.0; 3], [0.0, 0.0, -50.0]],
        },
        ForceLaw::Rigid {
            stiffness_n_m: 900.0,
        },
    ]
}

fn guide() -> Guide {
    Guide::new(&GuideModel {
        device: 0,
        device_epoch: 0,
        points_m: vec![[-0.01, 0.002, 0.0], [0.0, 0.004, 0.0], [0.01, 0.002, 0.0]],
        normal: [0.0, 0.0, 1.0],
        head_length_m: 0.025,
        stiffness_n_m: 80.0,
        damping_n_s_m: 0.5,
        max_force_n: 0.6,
        time_to_live_ns: 20_000_000,
    })
    .expect("a guide")
}

#[test]
fn a_tick_allocates_nothing() {
    let (contacts, guide, paint) = (laws().map(contact), guide(), paint());
    let mut servo = Servo::new(Limits::default());
    let mut pressed = 0;
    let mut run = |servo: &mut Servo| {
        for tick in 0..20_000 {
            let t = f64::from(tick) * 1e-3;
            if tick % 50 == 0 {
                servo.receive(contacts[(tick / 50) as usize % 5], Sender::Same);
            }
            if tick % 30 == 0 {
                servo.receive_guide(guide, Sender::Same);
            }
            if tick % 40 == 0 {
                servo.receive_fluid(paint);
            }
            match tick % 7000 {
                1000 => servo.measure(0.9),
                2000 => servo.switch(Switch::Off),
                2100 => servo.switch(Switch::On),
                3000 => servo.set_strength(0.5),
                4000 => servo.measure(f64::NAN),
                4100 => {
                    servo.measure(0.0);
                    servo.rearm();
                }
                _ => {}
            }
            let shake = 0.002 * sin(130.0 * t);
            let handle = HandleState {
                position: DVec3::new(0.01 * sin(3.0 * t), 0.0, 0.02 + shake),
                orientation: DQuat::IDENTITY,
                velocity: DVec3::X * 0.03,
            };
            let dt = if tick % 3000 == 0 { 0.1 } else { 1e-3 };
            pressed += usize::from(servo.step(&handle, dt).0 != DVec3::ZERO);
        }
    };
    assert_eq!(allocations(|| run(&mut servo)), 0);
    let fault = allocations(|| {
        run(&mut servo);
        std::hint::black_box(Vec::<u8>::with_capacity(1));
    });
    assert_eq!(fault, 1, "an allocation would pass");
    assert!(pressed > 5000, "{pressed} ticks with force");
}
