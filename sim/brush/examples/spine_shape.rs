//! Prints the shape of a spine as CSV while it is pressed onto a surface: the joints from ferrule to tip, x and z, mm.
//!
//! ```text
//! cargo run --release -p maulstick-brush --example spine_shape > shape.csv
//! ```

use std::error::Error;

use glam::DVec3;
use maulstick_brush::single_spine::{SpineFile, TrialPose, follow};
use maulstick_num::geometry::{Rigid, rotation};

/// Four joints of hog bristle, thinner toward the tip.
const SPINE: &str = "
lengths_m = [0.008, 0.007, 0.006, 0.004]
stiffness_nm_per_rad = [3e-4, 1.6e-4, 1e-4, 6e-5]
mu = 0.25
";
/// Length of the spine, m.
const LENGTH_M: f64 = 0.025;
/// Lean of the handle, rad.
const LEAN_RAD: f64 = 0.3;
/// Descent of the handle from one pose to the next, m.
const DESCENT_M: f64 = 1e-3;

fn main() -> Result<(), Box<dyn Error>> {
    let poses: Vec<TrialPose> = (0..=10)
        .map(|pose| TrialPose {
            t: 0.05 * f64::from(pose),
            brush: Rigid {
                rotation: rotation(DVec3::Y, LEAN_RAD),
                translation: DVec3::Z * (LENGTH_M - DESCENT_M * f64::from(pose)),
            },
        })
        .collect();
    println!("descent_mm,joint,x_mm,z_mm,energy_uj");
    for (pose, row) in follow(&SpineFile::parse(SPINE)?, &poses).iter().enumerate() {
        let root = poses[pose].brush.translation.to_array();
        for (joint, [x, _, z]) in std::iter::once(&root).chain(&row.joints).enumerate() {
            let (x_mm, z_mm, energy_uj) = (1e3 * x, 1e3 * z, 1e6 * row.energy.total);
            println!("{pose},{joint},{x_mm:.4},{z_mm:.4},{energy_uj:.3}");
        }
    }
    Ok(())
}
