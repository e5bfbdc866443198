//! A paint model that only deposits: the first and the last stage of IMPaSTo.

use crate::footprint::Footprint;
use crate::model::{PaintModel, Step, StepReport};
use crate::quantum::{CELL_MAX, QUANTA_PER_UNIT, REFERENCE_CELL_M, SLOTS};
use crate::transfer::transfer;

/// Room for a step.
#[derive(Debug, Default)]
pub struct Deposit {
    footprint: Footprint,
    demands: Vec<u32>,
}

impl PaintModel for Deposit {
    fn name(&self) -> &'static str {
        "deposit"
    }

    fn step(&mut self, step: &mut Step<'_>) -> StepReport {
        self.footprint.find(step.sweep, step.window, step.cells);
        if !self.footprint.cells.is_empty() {
            self.demand(step);
            self.grant(step);
        }
        StepReport {
            footprint_cells: self.footprint.cells.len() as u64,
        }
    }
}

impl Deposit {
    /// What each cell would receive, quanta.
    fn demand(&mut self, step: &Step<'_>) {
        let on_brush = step.load.film_units(step.head_cells) as f32;
        let cell_per_reference = (step.cell_m / REFERENCE_CELL_M) as f32;
        let unit_per_cell = (step.cell_m / crate::quantum::UNIT_M) as f32;
        let to_units = (1.0 / QUANTA_PER_UNIT) as f32;
        self.demands.clear();
        let rows = self.footprint.cells.iter().zip(&self.footprint.penetration);
        for ((cell, depth), travel) in rows.zip(&self.footprint.travel) {
            let lying = step.window.total(*cell as usize);
            let film = lying * to_units;
            let reached = film.min(depth * unit_per_cell);
            let given = transfer(on_brush, reached, travel * cell_per_reference).max(0.0);
            let quanta = (given * QUANTA_PER_UNIT as f32) as u32;
            self.demands.push(quanta.min(CELL_MAX - lying as u32));
        }
    }

    /// Scales the demands to what the brush holds and moves the paint.
    fn grant(&mut self, step: &mut Step<'_>) {
        let demanded: u64 = self.demands.iter().map(|demand| u64::from(*demand)).sum();
        let held = step.load.total();
        if demanded == 0 || held == 0 {
            return;
        }
        let scale = if demanded > held {
            held as f64 / demanded as f64
        } else {
            1.0
        };
        for slot in 0..SLOTS {
            let of_slot = step.load.counts()[slot];
            if of_slot == 0 {
                continue;
            }
            let share = of_slot as f64 / held as f64 * scale;
            let mut left = of_slot;
            let plane = step.window.plane_mut(slot);
            for (cell, demand) in self.footprint.cells.iter().zip(&self.demands) {
                let moved = ((f64::from(*demand) * share) as u64).min(left);
                left -= moved;
                plane[*cell as usize] += moved as f32;
            }
            step.load.take(slot, of_slot - left);
        }
        step.window.touch(self.footprint.from, self.footprint.to);
    }
}

#[cfg(test)]
mod tests {
    use maulstick_brush::BrushFile;

    use super::*;
    use crate::head::{Ball, HeadPose};
    use crate::load::{BrushLoad, head_cells};
    use crate::path::Sweep;
    use crate::store::{TileRect, TileStore};
    use crate::window::Window;

    fn head(x: f32) -> HeadPose {
        let ball = |x: f32| Ball {
            at: [x, 32.0, 2.0],
            radius: 9.0,
        };
        HeadPose {
            balls: vec![ball(x), ball(x + 10.0)],
        }
    }

    /// Strokes across a tile with a load of two paints; counts on brush and canvas after it.
    fn stroke(film_um: f64) -> ([u64; 2], [u64; 2], [u64; 2]) {
        let mut store = TileStore::new([128, 64]);
        let rect = TileRect {
            from: [0, 0],
            to: [2, 1],
        };
        let mut window = Window::open(&mut store, rect).expect("free");
        let mut file = BrushFile::library("round").expect("round");
        file.load.film_um = film_um;
        let head_cells = head_cells(&file, 2.5e-4);
        let mut load = BrushLoad::clean();
        let given = load.fill(&file, &[(0, 0.7), (5, 0.3)], 2.5e-4);
        let mut model = Deposit::default();
        for x in 20..90 {
            let (from, to) = (head(x as f32), head(x as f32 + 1.0));
            model.step(&mut Step {
                window: &mut window,
                cells: [128, 64],
                cell_m: 2.5e-4,
                sweep: Sweep {
                    from: &from,
                    to: &to,
                },
                load: &mut load,
                head_cells,
            });
        }
        let mut number = 0;
        window.commit(&mut store, &mut number, |_, _| {});
        let pick = |counts: &[u64; SLOTS]| [counts[0], counts[5]];
        (pick(&given), pick(load.counts()), pick(&store.counts()))
    }

    #[test]
    fn what_leaves_the_brush_lies_on_the_canvas() {
        for film_um in [0.0, 5.0, 150.0, 3000.0] {
            let (given, brush, canvas) = stroke(film_um);
            for i in 0..2 {
                assert_eq!(given[i], brush[i] + canvas[i], "film {film_um} µm");
            }
            assert_eq!(canvas[0] > 0, film_um > 0.0);
        }
    }

    #[test]
    fn the_mixture_keeps_its_shares() {
        let (_, _, canvas) = stroke(150.0);
        let share = canvas[0] as f64 / (canvas[0] + canvas[1]) as f64;
        assert!((share - 0.7).abs() < 1e-3, "{share}");
    }

    #[test]
    fn a_fuller_brush_gives_more() {
        let canvas = |film_um: f64| stroke(film_um).2.iter().sum::<u64>();
        assert!(canvas(50.0) < canvas(150.0) && canvas(150.0) < canvas(500.0));
    }
}
