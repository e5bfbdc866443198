//! Sweeps of a square probe through a fluid at rest.

use maulstick_num::{cos, sin, sin_cos};

use crate::geometry::{Boundary, ProbeState, Vessel};
use crate::grid::Grid;
use crate::polygon::Shape;
use crate::solver::{Bench, Flow};
use crate::stress::{Fluid, Wrench};

/// Side of the vessel, m.
pub const VESSEL_M: f64 = 1.0;
/// Side of the square, m.
pub const SQUARE_M: f64 = 0.2;
/// Steps of the solver a second (Baxter 2004, § 8.8.6: 40 to 70).
pub const RATE_HZ: f64 = 60.0;
/// The fluid of § 8.9.2: a Reynolds number of 10³ by the vessel and 1 m/s.
pub const FLUID: Fluid = Fluid {
    density_kg_m3: 1.0,
    viscosity_m2_s: 1e-3,
};

/// Radius of the arc, its half angle and how far the square turns on it, m and rad.
const ARC: [f64; 3] = [0.3, 1.0, 1.5];
/// Middle of the arc's circle, m.
const ARC_MIDDLE_M: [f64; 2] = [0.5, 0.3];

/// Duration of the arc's sweep there and back, s.
pub const ARC_S: f64 = 4.0;

/// The probe on its arc at a time: it starts from rest, sweeps the arc, stops at its end, and sweeps it back.
#[must_use]
pub fn arc(time_s: f64) -> ProbeState {
    let [radius, half, turn] = ARC;
    let pulse = 2.0 * std::f64::consts::PI / ARC_S;
    // From 0 to 1 and back.
    let share = 0.5 - 0.5 * cos(pulse * time_s);
    let speed = 0.5 * pulse * sin(pulse * time_s);
    let (sine, cosine) = sin_cos(half * (2.0 * share - 1.0));
    let [x, y] = ARC_MIDDLE_M;
    let along = 2.0 * half * radius * speed;
    ProbeState {
        place_m: [x + radius * sine, y + radius * cosine],
        angle_rad: turn * share,
        velocity_m_s: [along * cosine, -along * sine],
        spin_rad_s: turn * speed,
    }
}

/// Direction of the forward motion at a place of the arc.
fn tangent(state: &ProbeState) -> [f64; 2] {
    let [radius, ..] = ARC;
    let [x, y] = ARC_MIDDLE_M;
    [
        (state.place_m[1] - y) / radius,
        -(state.place_m[0] - x) / radius,
    ]
}

/// A bench of `cells` by `cells` cells with a square probe.
#[must_use]
pub fn bench(cells: usize, boundary: Boundary, fluid: Fluid) -> Bench {
    Bench {
        grid: Grid {
            cells: [cells; 2],
            cell_m: VESSEL_M / cells as f64,
        },
        vessel: Vessel::Box,
        fluid,
        shape: Shape::square(SQUARE_M),
        boundary,
    }
}

/// A step of a sweep; force and torque are those for a metre of depth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Time, s.
    pub time_s: f64,
    /// The probe.
    pub state: ProbeState,
    /// Force along the arc's forward direction, N/m: drag is against the motion.
    pub drag_n: f64,
    /// Force to the left of it, N/m.
    pub across_n: f64,
    /// Torque, N·m/m.
    pub torque_n_m: f64,
}

/// The sweep along the arc, a sample a step; `done` receives the number of steps done.
#[must_use]
pub fn arc_sweep(cells: usize, boundary: Boundary, mut done: impl FnMut(usize)) -> Vec<Sample> {
    let mut flow = Flow::new(bench(cells, boundary, FLUID), arc(0.0));
    (1..=arc_steps())
        .map(|step| {
            let time_s = step as f64 / RATE_HZ;
            let state = arc(time_s);
            flow.step(state, 1.0 / RATE_HZ);
            done(step);
            sample(time_s, state, flow.wrench())
        })
        .collect()
}

/// Number of steps of [`arc_sweep`].
#[must_use]
pub fn arc_steps() -> usize {
    (ARC_S * RATE_HZ).round() as usize
}

fn sample(time_s: f64, state: ProbeState, wrench: Wrench<2>) -> Sample {
    let [tx, ty] = tangent(&state);
    let [fx, fy] = wrench.force_n;
    Sample {
        time_s,
        state,
        drag_n: fx * tx + fy * ty,
        across_n: fy * tx - fx * ty,
        torque_n_m: wrench.torque_n_m[2],
    }
}

/// Mean and noise of the drag along a slow straight sweep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Noise {
    /// Mean drag against the motion, N/m.
    pub drag_n: f64,
    /// Root mean square of the force about its smooth part, N/m.
    pub noise_n: f64,
}

/// Number of measured steps of [`noise`], and of those before them, in which the flow develops.
const STEPS: usize = 120;
const RUN_UP: usize = 24;
/// Path of these steps, m, across the grid at an angle with an irrational tangent.
const WAY_M: f64 = 0.24;
const WAY_RAD: f64 = 0.36;
/// Steady speed, m/s; the flow is viscous (Re 1 by the square).
const SPEED_M_S: f64 = 0.05;
const SLOW_FLUID: Fluid = Fluid {
    density_kg_m3: 1.0,
    viscosity_m2_s: 0.01,
};
/// Degree of the polynomial that is the force's smooth part.
const SMOOTH: usize = 6;

/// Noise of the force on a square at an angle, swept slowly and steadily through the middle of the vessel.
#[must_use]
pub fn noise(cells: usize, boundary: Boundary) -> Noise {
    let (sine, cosine) = sin_cos(WAY_RAD);
    let at = |step: f64| {
        let way = WAY_M * (step / STEPS as f64 - 0.5);
        ProbeState {
            place_m: [0.5 + way * cosine, 0.5 + way * sine],
            angle_rad: 0.2,
            velocity_m_s: [SPEED_M_S * cosine, SPEED_M_S * sine],
            spin_rad_s: 0.0,
        }
    };
    let dt_s = WAY_M / STEPS as f64 / SPEED_M_S;
    let first = -(RUN_UP as f64);
    let mut flow = Flow::new(bench(cells, boundary, SLOW_FLUID), at(first));
    let mut forces = Vec::new();
    for step in 1..=RUN_UP + STEPS {
        flow.step(at(first + step as f64), dt_s);
        let [fx, fy] = flow.wrench().force_n;
        forces.push([fx * cosine + fy * sine, fy * cosine - fx * sine]);
    }
    let counted = &forces[RUN_UP..];
    let parts = [0, 1].map(|part| {
        let values: Vec<f64> = counted.iter().map(|force| force[part]).collect();
        about_smooth(&values)
    });
    let squares = parts[0].1 * parts[0].1 + parts[1].1 * parts[1].1;
    Noise {
        drag_n: -parts[0].0,
        noise_n: squares.sqrt(),
    }
}

/// Mean of values, and the root mean square of their residual about the polynomial of degree [`SMOOTH`].
fn about_smooth(values: &[f64]) -> (f64, f64) {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let mut rest: Vec<f64> = values.to_vec();
    // Gram and Schmidt on the powers: each is made orthogonal to those before and taken out.
    let mut basis: Vec<Vec<f64>> = Vec::new();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    for degree in 0..=SMOOTH {
        let place = |i: usize| 2.0 * (i as f64 + 0.5) / count - 1.0;
        let mut power: Vec<f64> = (0..values.len())
            .map(|i| (0..degree).fold(1.0, |product, _| product * place(i)))
            .collect();
        for before in &basis {
            let share = dot(&power, before);
            for (own, before) in power.iter_mut().zip(before) {
                *own -= share * before;
            }
        }
        let length = dot(&power, &power).sqrt();
        power.iter_mut().for_each(|own| *own /= length);
        let share = dot(&rest, &power);
        for (rest, own) in rest.iter_mut().zip(&power) {
            *rest -= share * own;
        }
        basis.push(power);
    }
    (mean, (dot(&rest, &rest) / count).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_falls_with_resolution_and_a_covered_square_has_a_quarter_of_a_staircases() {
        let of = |boundary| {
            [24, 48].map(|cells| {
                let noise = noise(cells, boundary);
                println!(
                    "{boundary:?} {cells}: drag {:.5} N, noise {:.3} %",
                    noise.drag_n,
                    100.0 * noise.noise_n / noise.drag_n
                );
                assert!(noise.drag_n > 0.0, "drag is against the motion");
                noise.noise_n
            })
        };
        let (staircase, covered) = (of(Boundary::Staircase), of(Boundary::Covered));
        for (covered, staircase) in covered.iter().zip(staircase) {
            assert!(*covered < 0.25 * staircase);
        }
        assert!(staircase[1] < 0.7 * staircase[0] && covered[1] < 0.7 * covered[0]);
    }

    #[test]
    fn on_the_arc_drag_is_against_the_motion_there_and_back() {
        for boundary in [Boundary::Staircase, Boundary::Covered] {
            let sweep = arc_sweep(32, boundary, |_| {});
            let part = |from: f64, to: f64| {
                let within = sweep.iter().filter(|it| (from..to).contains(&it.time_s));
                let (count, sum) =
                    within.fold((0.0, 0.0), |(n, sum), it| (n + 1.0, sum + it.drag_n));
                sum / count
            };
            let (there, back) = (part(0.4, 1.2), part(2.4, 3.2));
            println!("{boundary:?}: {there:.4} N, {back:.4} N");
            assert!(there < -0.01 && back > 0.01);
            let torque: f64 = sweep[30..60].iter().map(|it| it.torque_n_m).sum();
            assert!(torque < 0.0, "it turns forward");
        }
    }

    #[test]
    fn the_probe_moves_as_its_velocity_says() {
        for step in 0..40 {
            let time = f64::from(step) * 0.1;
            let [before, now, after] = [time - 1e-5, time, time + 1e-5].map(arc);
            for i in 0..2 {
                let speed = (after.place_m[i] - before.place_m[i]) / 2e-5;
                assert!((speed - now.velocity_m_s[i]).abs() < 1e-6);
            }
            let spin = (after.angle_rad - before.angle_rad) / 2e-5;
            assert!((spin - now.spin_rad_s).abs() < 1e-6);
        }
    }

    #[test]
    fn a_smooth_curve_has_no_noise_and_a_jag_has() {
        let curve = |i: i32| f64::from(i * i) * 1e-3 + 2.0;
        let smooth: Vec<f64> = (0..100).map(curve).collect();
        let jag: Vec<f64> = (0..100).map(|i| curve(i) + f64::from(i % 2)).collect();
        assert!(about_smooth(&smooth).1 < 1e-10);
        assert!((about_smooth(&jag).1 - 0.5).abs() < 0.02);
    }
}
