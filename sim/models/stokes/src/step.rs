//! One step of Stokes Paint.

use maulstick_canvas::quantum::{CELL_MAX, QUANTUM_M, SLOTS};
use maulstick_canvas::window::{Area, Window};
use maulstick_impasto::stages::bristle_flow::flow;
use maulstick_impasto::stages::exchange::Exchange;
use maulstick_impasto::stages::levelling::HALO;
use maulstick_impasto::stages::rest::level;
use maulstick_impasto::stages::seep::seep;
use maulstick_model::footprint::Footprint;
use maulstick_model::interface::{PaintModel, Rest, Step, StepReport, Transfer};
use maulstick_model::modes::{sample, vacuum};
use maulstick_types::paint::Decision;

use crate::drag::{STEPS, bottoms, drag, follow};
use crate::flow_backend::{BrushFlow, FlowBackend};
use crate::layer_planes::place_of;
use crate::layers::Layers;
use crate::reach::Reach;
use crate::voxels::Voxels;

/// Number of cells around the contacts in which paint flows.
const AROUND: i64 = 5;
/// Thickness of a film from which it is dragged, voxels; from twice that all of it is.
const FLOWS_FROM: f32 = 0.4;

/// The paint model `stokes`, with the buffers of its step.
#[derive(Debug, Default)]
pub struct StokesPaint {
    footprint: Footprint,
    exchange: Exchange,
    reach: Reach,
    flow: BrushFlow,
}

impl PaintModel for StokesPaint {
    fn name(&self) -> &'static str {
        "stokes"
    }

    fn step(&mut self, step: &mut Step<'_>) -> StepReport {
        self.footprint.find(step);
        if self.footprint.contacts.is_empty() {
            return StepReport::default();
        }
        let mut report = self.footprint.report(step);
        match step.handling.transfer {
            Transfer::Sampler => {
                report.from_nowhere = sample(&self.footprint, step).into();
                return report;
            }
            Transfer::Vacuum => {
                let area = self.footprint.around;
                let layers = Layers::of(step.window, cell_m(step));
                let slots = slots_of(step, area);
                let mut voxels = Voxels::read(step.window, area, layers, &slots);
                report.lifted = vacuum(&self.footprint, step).into();
                voxels.follow(step.window);
                voxels.write(step.window);
                step.window.touch(self.footprint.reached());
            }
            _ => self.paint(step, &mut report),
        }
        self.footprint.note_left(step);
        report
    }

    fn backend(&self) -> String {
        self.flow.backend()
    }

    fn take_backend_change(&mut self) -> Option<String> {
        self.flow.take_backend_change()
    }

    fn take_limit(&mut self) -> Option<Decision> {
        self.flow.take_limit()
    }

    fn rest_halo(&self) -> Option<usize> {
        Some(HALO)
    }

    fn rest(&mut self, rest: &mut Rest<'_>) {
        let layers = Layers::of(rest.window, rest.cell_m);
        // Paint also flows in from beyond the area.
        let slots: Vec<usize> = rest.window.planes().map(|(slot, _)| slot).collect();
        let mut voxels = Voxels::read(rest.window, rest.area, layers, &slots);
        level(rest);
        voxels.follow(rest.window);
        voxels.drop_loose();
        voxels.write(rest.window);
    }
}

impl StokesPaint {
    /// A model whose flow around brushes is computed on a device where that is faster, until it is lost.
    #[must_use]
    pub fn on(device: Box<dyn FlowBackend>) -> Self {
        Self {
            flow: BrushFlow::on(device),
            ..Self::default()
        }
    }

    fn paint(&mut self, step: &mut Step<'_>, report: &mut StepReport) {
        let footprint = &mut self.footprint;
        let cell_m = cell_m(step);
        let layers = Layers::of(step.window, cell_m);
        let area = around(footprint, step, layers.side as i64);
        let slots = slots_of(step, area);
        let mut voxels = Voxels::read(step.window, area, layers, &slots);
        let thickest = footprint
            .wet
            .iter()
            .fold(0.0f32, |most, wet| most.max(*wet));
        let flows = step.load.steps().is_multiple_of(u64::from(STEPS));
        if step.handling.push && flows && thickest > FLOWS_FROM * layers.capacity as f32 {
            let bottoms = bottoms(&voxels, footprint, step.window.width());
            let stays = voxels.set_aside(step.stain, 2.0 * FLOWS_FROM);
            drag(
                &mut self.flow,
                &mut voxels,
                (footprint, &bottoms),
                step,
                cell_m,
            );
            voxels.put_back(&stays);
            follow(&voxels, footprint, &bottoms, step.window.width());
        }
        if step.handling.most >= CELL_MAX as f32 {
            self.reach.uncover(&voxels, footprint, step);
        } else {
            self.reach.uncover_all(&voxels, footprint, step);
        }
        // Only the contacts' columns are uncovered.
        report.from_nowhere = self.exchange.run_in_place(footprint, step).into();
        self.reach.cover(&mut voxels, footprint, step.window);
        voxels.write(step.window);
        flow(step);
        seep(step);
        let Area { from, size } = area;
        step.window
            .touch((from, [from[0] + size[0], from[1] + size[1]]));
    }
}

/// Side of a cell, m.
fn cell_m(step: &Step<'_>) -> f64 {
    QUANTUM_M / f64::from(step.traits.cells_per_quantum)
}

/// The cells around the contacts.
fn around(footprint: &Footprint, step: &Step<'_>, side: i64) -> Area {
    let Area { from, size } = footprint.around;
    let origin = step.window.origin();
    let (least, most) = step.bounds;
    let low = [0, 1].map(|i| (from[i] as i64 + origin[i] - AROUND).max(least[i] - 1));
    // Cells of the flow have fixed places, independent of the brush.
    let low = low.map(|low| low.div_euclid(side) * side);
    let high = [0, 1].map(|i| ((from[i] + size[i]) as i64 + origin[i] + AROUND).min(most[i] + 1));
    step.window.area(low, high)
}

/// Slots of the paints on the brush and on an area of the canvas.
fn slots_of(step: &Step<'_>, area: Area) -> Vec<usize> {
    let (on_brush, lies) = (step.load.counts(), slots_in(step.window, area));
    let has = |slot: &usize| on_brush[*slot] > 0 || lies[*slot];
    (0..SLOTS).filter(has).collect()
}

/// True for each paint on an area, including layers that its counts no longer cover.
fn slots_in(window: &Window, area: Area) -> [bool; SLOTS] {
    let mut lies = [false; SLOTS];
    for (slot, plane) in window.planes() {
        let mut rows = area.rows(window.width());
        lies[slot] = rows.any(|row| plane[row].iter().any(|count| *count > 0.0));
    }
    for (shape, bytes) in window.own_planes() {
        if let Some((slot, _)) = place_of(shape)
            && !lies[slot]
        {
            let mut rows = area.rows(window.width());
            lies[slot] = rows.any(|row| {
                bytes[4 * row.start..4 * row.end]
                    .iter()
                    .any(|byte| *byte > 0)
            });
        }
    }
    lies
}
