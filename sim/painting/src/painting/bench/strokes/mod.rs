//! Strokes: states of a brush become steps of the paint model on windows of tiles.

mod cells;
mod relaxing;
mod step;
mod stroke;
mod tiles;
mod timing;
mod wells;

use std::sync::Arc;

use maulstick_model::brush::scale::Scale;
use maulstick_model::path::PathStepper;
use maulstick_types::brush::{BrushState, Solve, solve_flags};

use crate::error::{BrushError, EditError};

use stroke::Stroke;

use super::Workbench;

impl Workbench {
    /// Paints what a brush did in its epoch: strokes are numbered from 1 in each.
    ///
    /// # Errors
    /// [`EditError`] for an unknown brush, or a state that does not fit its brush file.
    pub(crate) fn state(
        &mut self,
        brush: &str,
        epoch: u32,
        state: &BrushState,
    ) -> Result<(), EditError> {
        let brush = self.brushes.at(brush)?;
        let solved = state.solves.iter();
        let painted = solved.map(|solve| self.solve(brush, epoch, solve));
        let painted: Result<(), EditError> = painted.collect();
        self.book(Some(brush));
        painted
    }

    fn solve(&mut self, brush: usize, epoch: u32, solve: &Solve) -> Result<(), EditError> {
        let own = &self.brushes[brush];
        if let Some(fault) = solve.fault() {
            let brush = own.name.clone();
            return Err(BrushError::State { brush, fault }.into());
        }
        let angles = own.head.angles(solve);
        if solve.stroke != 0 && angles.is_none() {
            return Err(BrushError::Unfit(own.name.clone()).into());
        }
        self.accounts.note_time(solve.event_ns);
        let Ok(surface) = self.desk.surfaces.at(solve.surface) else {
            return Ok(());
        };
        if solve.flags & solve_flags::PREVIEW != 0 {
            return Ok(());
        }
        if solve.stroke == 0 {
            if angles.is_some_and(|angles| angles.len() < solve.angles_rad.len()) {
                self.note_set(brush, &solve.angles_rad);
            }
            self.lift(brush);
            self.backend.stroke_ends();
            return Ok(());
        }
        let stroke = Stroke {
            scale: Scale {
                cell_m: self.desk.surfaces[surface].cell_m,
                zoom: solve.zoom,
            },
            bench: self,
            brush,
            surface,
        };
        stroke.follow(epoch, solve)
    }

    /// Notes the bend that stays in a brush in the air.
    fn note_set(&mut self, brush: usize, set: &[[f32; 2]]) {
        let own = &mut self.brushes[brush];
        if own.load.set != set {
            self.desk.scene.note_set(&own.name, set);
            Arc::make_mut(&mut own.load).set = set.to_vec();
        }
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
            bench: self,
            brush,
            surface,
            scale: path.scale(),
        };
        Some((stroke, path))
    }
}
