//! The whole step of impasto.

use maulstick_model::footprint::Footprint;
use maulstick_model::interface::{PaintModel, Rest, Step, StepReport, Transfer};
use maulstick_model::modes::{sample, vacuum};

use super::advection::{Advection, Axis};
use super::bristle_flow::flow;
use super::exchange::Exchange;
use super::levelling::HALO;
use super::overhang::Overhang;
use super::rest::level;
use super::seep::seep;
use super::velocity::Faces;

/// The paint model `impasto`, with the buffers of its stages.
#[derive(Debug, Default)]
pub struct Impasto {
    footprint: Footprint,
    faces: Faces,
    advection: Advection,
    overhang: Overhang,
    exchange: Exchange,
}

impl PaintModel for Impasto {
    fn name(&self) -> &'static str {
        "impasto"
    }

    fn step(&mut self, step: &mut Step<'_>) -> StepReport {
        let footprint = &mut self.footprint;
        footprint.find(step);
        if footprint.contacts.is_empty() {
            return StepReport::default();
        }
        let mut report = footprint.report(step);
        match step.handling.transfer {
            Transfer::Sampler => {
                report.from_nowhere = sample(footprint, step).into();
                return report;
            }
            Transfer::Vacuum => report.lifted = vacuum(footprint, step).into(),
            _ => {
                self.overhang.find(footprint, step);
                if step.handling.push {
                    self.faces.find(footprint, step);
                    let first = if step.load.steps().is_multiple_of(2) {
                        Axis::X
                    } else {
                        Axis::Y
                    };
                    for _ in 0..step.traits.parts {
                        self.advection.run(
                            footprint.around,
                            &self.faces,
                            step.window,
                            first,
                            step.stain,
                        );
                    }
                }
                self.overhang.weigh(step);
                report.from_nowhere = self.exchange.run(footprint, step).into();
                report.lifted = self.overhang.wipe(step).into();
                flow(step);
                seep(step);
            }
        }
        footprint.note_left(step);
        step.window.touch(footprint.reached());
        report
    }

    fn rest_halo(&self) -> Option<usize> {
        Some(HALO)
    }

    fn rest(&mut self, rest: &mut Rest<'_>) {
        level(rest);
    }
}
