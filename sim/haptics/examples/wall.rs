//! Prints force and energy of a hand that presses into a wall, is held by it and lifts, as CSV to be plotted:
//!
//! ```text
//! cargo run --release -p maulstick-haptics --example wall -- 600 > wall.csv
//! ```
//!
//! The number is the stiffness of the wall, N/m. Up to 2b/T, twice the device's own damping by the period of the servo, a
//! sampled wall gives the hand no energy (Colgate and Schenkel 1997): `given_mj` stays below zero.

use std::error::Error;

use glam::DVec3;
use maulstick_haptics::{Contact, Hand, Limits, Plant, Sender, Servo};
use maulstick_types::haptics::{ContactModel, ForceLaw};

/// Period of the servo, s.
const TICK_S: f64 = 1e-3;
/// Ticks from one contact model to the next.
const MODEL_TICKS: u32 = 15;
/// Length of the brush head, m.
const HEAD_M: f64 = 0.025;

/// Depth that the hand aims for at a time: 20 mm above the wall, 8 mm within it, and back, m.
fn wanted_depth_m(time_s: f64) -> f64 {
    let share = (time_s.min(3.0 - time_s) / 0.5).clamp(0.0, 1.0);
    -0.020 + 0.028 * share
}

fn main() -> Result<(), Box<dyn Error>> {
    let stiffness = std::env::args()
        .nth(1)
        .map_or(Ok(400.0), |text| text.parse())?;
    let law = ForceLaw::Rigid {
        stiffness_n_m: stiffness,
    };
    let wall = Contact::new(&ContactModel::bare(law, HEAD_M))?;
    let limits = Limits {
        max_stiffness_n_m: stiffness,
        damping_n_s_m: 0.3,
        ..Limits::default()
    };
    let mut servo = Servo::new(limits);
    let mut hand = Plant::omni(Hand::PEN_GRIP, DVec3::Z * (HEAD_M - wanted_depth_m(0.0)));
    println!("time_s,depth_mm,force_n,given_mj");
    for tick in 0..3000 {
        let time_s = f64::from(tick) * TICK_S;
        if tick % MODEL_TICKS == 0 {
            servo.receive(wall, Sender::Same);
        }
        let (force, _) = servo.step(&hand.handle(), TICK_S);
        hand.advance(force, DVec3::Z * (HEAD_M - wanted_depth_m(time_s)), TICK_S);
        let depth_mm = 1e3 * (HEAD_M - hand.true_position().z);
        let given_mj = 1e3 * hand.given_j();
        println!("{time_s:.3},{depth_mm:.4},{:.4},{given_mj:.5}", force.z);
    }
    Ok(())
}
