//! The advection alone: its speed relative to a plain copy of its planes in as many parts.

use std::time::Duration;

use maulstick_canvas::relief::Relief;
use maulstick_canvas::store::TileStore;
use maulstick_canvas::window::{Area, Window};
use maulstick_gpu::Device;
use maulstick_impasto::device::measure::Measured;
use maulstick_impasto::stages::advection::{Advection, Axis, STAIN};
use maulstick_impasto::stages::velocity::Faces;
use maulstick_rig::UserError;

use crate::report::{Report, quantile, sorted};
use crate::thread_cpu::thread_cpu;

/// Cells either way, and paints.
const SIDE: usize = 512;
const PAINTS: usize = 4;
/// Rounds, and advections of a round.
const ROUNDS: usize = 9;
const ADVECTIONS: usize = 16;
/// Cells that paint moves in a step.
const SPEED: f32 = 0.3;

/// Measures and reports: cells × (1 + paints) × 8 bytes a time.
pub(crate) fn run(report: &mut Report, gpu: Option<Device>) -> Result<(), UserError> {
    let mut pairs = Vec::new();
    match gpu {
        Some(gpu) => {
            let fault = |error| UserError::failure(format!("the graphics device: {error}"));
            let mut measured = Measured::new(gpu, SIDE, PAINTS).map_err(fault)?;
            for _ in 0..=ROUNDS {
                let took = measured.advection(ADVECTIONS).map_err(fault)?;
                pairs.push((took, measured.copy(ADVECTIONS).map_err(fault)?));
            }
        }
        None => {
            let mut measured = OnProcessor::new()?;
            for _ in 0..=ROUNDS {
                pairs.push((measured.advection(), measured.copy()));
            }
        }
    }
    // The first round warms up.
    let rounds = pairs.into_iter().skip(1);
    let ratios = rounds.map(|(took, copied)| copied.as_secs_f64() / took.as_secs_f64());
    let ratio = quantile(&sorted(ratios.collect()), 0.5);
    report.row("copy_ratio.512", ratio, "of a copy");
    Ok(())
}

/// A window on which all paint moves.
struct OnProcessor {
    window: Window,
    faces: Faces,
    advection: Advection,
    from: Vec<f32>,
    to: Vec<f32>,
}

impl OnProcessor {
    fn new() -> Result<Self, UserError> {
        let mut store = TileStore::new([SIDE as u32; 2]);
        let window = store
            .around([0; 2], [SIDE as i64; 2])
            .and_then(|all| Window::open(&mut store, all, &Relief::flat(2.5e-4)));
        let mut window = window.ok_or_else(|| UserError::failure("no window opens"))?;
        for slot in 0..PAINTS {
            let cells = window.plane_mut(slot).iter_mut().enumerate();
            cells.for_each(|(i, count)| *count = 26_843.0 + (i * 7919 % 4096) as f32);
        }
        let mut faces = Faces::default();
        let inside = |at: usize| if at + 1 < SIDE { SPEED } else { 0.0 };
        faces.right = (0..SIDE * SIDE).map(|cell| inside(cell % SIDE)).collect();
        faces.above = (0..SIDE * SIDE).map(|cell| -inside(cell / SIDE)).collect();
        Ok(Self {
            window,
            faces,
            advection: Advection::default(),
            from: vec![1.0; SIDE * SIDE * (1 + PAINTS)],
            to: vec![0.0; SIDE * SIDE * (1 + PAINTS)],
        })
    }

    fn advection(&mut self) -> Duration {
        let all = Area {
            from: [0; 2],
            size: [SIDE; 2],
        };
        let begun = thread_cpu();
        for _ in 0..ADVECTIONS {
            self.advection
                .run(all, &self.faces, &mut self.window, Axis::X, STAIN);
        }
        thread_cpu().saturating_sub(begun)
    }

    fn copy(&mut self) -> Duration {
        let begun = thread_cpu();
        for _ in 0..ADVECTIONS {
            self.to.copy_from_slice(std::hint::black_box(&self.from));
            std::hint::black_box(&mut self.to);
        }
        thread_cpu().saturating_sub(begun)
    }
}
