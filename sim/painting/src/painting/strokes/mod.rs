//! Strokes: states of a brush become steps of the paint model on windows of tiles.

pub(crate) mod backend;
mod cells;
mod claims;
pub(crate) mod deferral;
mod models;
mod relaxing;
mod step;
mod stroke;
mod wells;
mod windows;

use maulstick_canvas::EditError;
use maulstick_model::brush::scale::Scale;
use maulstick_model::path::PathStepper;
use maulstick_types::brush::{BrushState, Solve, solve_flags};

use super::Painting;
use stroke::Stroke;

impl Painting {
    /// Paints a state of a brush in its epoch, in each of which strokes are numbered from 1.
    ///
    /// # Errors [`EditError`] for an unknown brush, or a state that does not fit its brush file.
    pub fn state(&mut self, brush: &str, epoch: u32, state: &BrushState) -> Result<(), EditError> {
        let brush = self.brushes.at(brush)?;
        let solved = state.solves.iter();
        let painted = solved.map(|solve| self.solve(brush, epoch, solve));
        let painted: Result<(), EditError> = painted.collect();
        self.book(Some(brush));
        painted
    }

    fn solve(&mut self, brush: usize, epoch: u32, solve: &Solve) -> Result<(), EditError> {
        let own = &self.brushes[brush];
        let fits = solve.stroke == 0 || own.head.fits(solve.angles_rad.len());
        if !fits || solve.fault().is_some() {
            return Err(EditError::Unfit(own.name.clone()));
        }
        self.accounts.note_time(solve.event_ns);
        let Ok(surface) = self.surfaces.at(solve.surface) else {
            return Ok(());
        };
        if solve.flags & solve_flags::PREVIEW != 0 {
            return Ok(());
        }
        if solve.stroke == 0 {
            self.lift(brush);
            self.backend.facts.stroke_ends();
            return Ok(());
        }
        let stroke = Stroke {
            scale: Scale {
                cell_m: self.surfaces[surface].cell_m,
                zoom: solve.zoom,
            },
            painting: self,
            brush,
            surface,
        };
        stroke.follow(epoch, solve)
    }

    /// Ends a brush's contact; its paint relaxes.
    fn lift(&mut self, brush: usize) {
        if let Some((mut stroke, path)) = self.take_path(brush) {
            stroke.finish(path);
            stroke.relax();
        }
    }

    /// Steps the rest of a brush's path, if it is in contact.
    fn end_path(&mut self, brush: usize) {
        if let Some((mut stroke, path)) = self.take_path(brush) {
            stroke.finish(path);
        }
    }

    /// The stroke of a brush in contact, and its path.
    fn take_path(&mut self, brush: usize) -> Option<(Stroke<'_>, PathStepper)> {
        let (surface, path) = self.brushes[brush].path.take()?;
        let stroke = Stroke {
            painting: self,
            brush,
            surface,
            scale: path.scale(),
        };
        Some((stroke, path))
    }
}
