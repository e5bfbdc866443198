//! Prints the energy of a spine as CSV while it is pressed onto a surface and then dragged, to be plotted:
//!
//! ```text
//! cargo run -p maulstick-brush --example spine_energy > energy.csv
//! ```

use maulstick_brush::single_spine::{HEADER, SpineFile, follow, poses};
use maulstick_num::sin_cos;

/// Three joints of hog bristle, thinner toward the tip.
const SPINE: &str = "
lengths_m = [0.010, 0.008, 0.007]
stiffness_nm_per_rad = [3e-4, 1.2e-4, 8e-5]
damping_nm = 1e-6
mu = 0.25
c_eta = 0.3
";
/// Length of the spine, m.
const LENGTH_M: f64 = 0.025;
/// Lean of the handle, rad.
const LEAN: f64 = 0.3;
/// Descent of the handle, m.
const DEPTH_M: f64 = 0.008;
/// Length of the drag, m.
const DRAG_M: f64 = 0.020;
/// Number of poses while pressing, and of poses while dragging.
const POSES: u32 = 40;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (sine, cosine) = sin_cos(0.5 * LEAN);
    let mut text = format!("{HEADER}\n");
    for pose in 0..=2 * POSES {
        let pressed = DEPTH_M * f64::from(pose.min(POSES)) / f64::from(POSES);
        let dragged = DRAG_M * f64::from(pose.saturating_sub(POSES)) / f64::from(POSES);
        let (t, z) = (f64::from(pose) * 0.01, LENGTH_M - pressed);
        text += &format!("{t},{dragged},0,{z},0,{sine},0,{cosine}\n");
    }
    println!("t_s,spring_j,friction_j,damping_j,total_j");
    for row in follow(&SpineFile::parse(SPINE)?, &poses(&text)?) {
        let energy = row.energy;
        println!(
            "{},{:e},{:e},{:e},{:e}",
            row.t, energy.spring, energy.friction, energy.damping, energy.total
        );
    }
    Ok(())
}
