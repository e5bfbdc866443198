//! One step of the marker.

use maulstick_model::footprint::Footprint;
use maulstick_model::interface::{PaintModel, Step, StepReport, Transfer};
use maulstick_model::modes::{sample, vacuum};

use crate::film::Film;

/// The paint model `marker`, with the buffers of its step.
#[derive(Debug, Default)]
pub struct Marker {
    footprint: Footprint,
    film: Film,
}

impl PaintModel for Marker {
    fn name(&self) -> &'static str {
        "marker"
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
            Transfer::Paint | Transfer::Marker { .. } => {
                let given = self.film.lay(footprint, step);
                self.film.draw(&given, step.load);
            }
            Transfer::Sponge => {
                let given = self.film.lay(footprint, step);
                report.from_nowhere = given.map(|count| count as i64).into();
            }
        }
        step.load.count_step();
        footprint.note_left(step);
        step.window.touch(footprint.reached());
        report
    }
}
