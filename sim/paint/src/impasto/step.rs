//! The whole step.

use super::advection::Advection;
use super::exchange::Exchange;
use super::flow::flow;
use super::footprint::Footprint;
use super::velocity::velocity;
use crate::model::{PaintModel, Step, StepReport};

/// The paint model `impasto`, with room for its stages.
#[derive(Debug, Default)]
pub struct Impasto {
    footprint: Footprint,
    advection: Advection,
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
        velocity(footprint);
        self.advection.run(footprint, step.window);
        self.exchange.run(footprint, step);
        flow(footprint, step);
        footprint.note_left(step);
        step.window.touch(footprint.reached());
        StepReport {
            footprint_cells: footprint.contacts.len() as u64,
        }
    }
}
