//! Strokes: states of a brush become steps of the paint model on windows of tiles.

use maulstick_types::brush::{BrushState, Solve, solve_flags};

use super::{PaintRefusal, Painting};
use crate::head::Waypoint;
use crate::load::head_cells;
use crate::model::Step;
use crate::path::{PathStepper, Sweep};
use crate::window::Window;

/// A window reaches this many cells beyond the head, so that it is not opened anew at each step.
const WINDOW_MARGIN: i64 = 32;

impl Painting {
    /// Paints what a brush did.
    ///
    /// # Errors
    /// [`PaintRefusal`] for an unknown brush, or a state that does not fit its brush file.
    pub fn state(&mut self, brush: &str, state: &BrushState) -> Result<(), PaintRefusal> {
        for solve in &state.solves {
            self.solve(brush, solve)?;
        }
        Ok(())
    }

    pub(super) fn solve(&mut self, name: &str, solve: &Solve) -> Result<(), PaintRefusal> {
        let track = self.brush(name)?;
        if !track.shape.fits(solve) || !solve.pose.is_valid() {
            return Err(PaintRefusal::new(
                format!("a state of brush '{name}' does not fit its brush file"),
                "restart the brush node: it runs with another file",
            ));
        }
        let (first, last) = self.span_ns.unwrap_or((solve.event_ns, solve.event_ns));
        self.span_ns = Some((first, last.max(solve.event_ns)));
        let Some(sheet) = self
            .sheets
            .iter()
            .position(|sheet| sheet.id == solve.surface)
        else {
            return Ok(());
        };
        let track = self.brush(name)?;
        if solve.stroke == 0 {
            track.path = None;
            return Ok(());
        }
        if solve.stroke != track.stroke {
            track.stroke = solve.stroke;
            track.path = None;
            self.begin_stroke(name)?;
        }
        let cell_m = self.sheets[sheet].cell_m;
        let track = self.brush(name)?;
        let waypoint = Waypoint::of(solve);
        let restarted = solve.flags & solve_flags::RESTARTED != 0;
        match track
            .path
            .take()
            .filter(|(on, _)| *on == sheet && !restarted)
        {
            None => {
                let path = PathStepper::begin(&track.shape, waypoint, cell_m);
                track.path = Some((sheet, path));
            }
            Some((_, mut path)) => {
                let shape = track.shape.clone();
                path.advance(&shape, waypoint, |sweep| self.step(name, sheet, sweep));
                if let Some(track) = self.brushes.get_mut(name) {
                    track.path = Some((sheet, path));
                }
            }
        }
        Ok(())
    }

    pub(super) fn begin_stroke(&mut self, name: &str) -> Result<(), PaintRefusal> {
        self.begin_step("stroke");
        let track = self.brush(name)?;
        if track.loads.is_empty() {
            return Ok(());
        }
        let mixture = track.loads[track.next_load % track.loads.len()].clone();
        track.next_load += 1;
        let slots = self.slots(&mixture)?;
        self.fill(name, &slots)
    }

    /// One step of the paint model.
    pub(super) fn step(&mut self, name: &str, sheet: usize, sweep: Sweep<'_>) {
        self.steps += 1;
        let (from, to) = sweep.to.bounds();
        if !self.reach(name, sheet, from, to) {
            return;
        }
        let Some(track) = self.brushes.get_mut(name) else {
            return;
        };
        let Some((_, window)) = &mut track.window else {
            return;
        };
        let cell_m = self.sheets[sheet].cell_m;
        let report = self.model.step(&mut Step {
            window,
            cells: self.sheets[sheet].store.cells(),
            cell_m,
            sweep,
            load: &mut track.load,
            head_cells: head_cells(&track.file, cell_m),
        });
        self.footprint_cells += report.footprint_cells;
    }

    /// Makes sure that the brush's window holds the cells `from`..`to`; false where they all lie
    /// beside the surface.
    pub(super) fn reach(&mut self, name: &str, sheet: usize, from: [i64; 2], to: [i64; 2]) -> bool {
        let Some(needed) = self.sheets[sheet].store.around(from, to) else {
            return false;
        };
        let Some(track) = self.brushes.get(name) else {
            return false;
        };
        if let Some((on, window)) = &track.window
            && *on == sheet
            && window.rect().holds(&needed)
        {
            return true;
        }
        let wide = |edge: [i64; 2], by: i64| edge.map(|cell| cell + by);
        let rect = self.sheets[sheet]
            .store
            .around(wide(from, -WINDOW_MARGIN), wide(to, WINDOW_MARGIN))
            .unwrap_or(needed);
        self.close_window(name);
        let window = Window::open(&mut self.sheets[sheet].store, rect).or_else(|| {
            // Another brush holds some of these tiles: its paint is written back first.
            self.close_windows();
            Window::open(&mut self.sheets[sheet].store, rect)
        });
        let opened = window.is_some();
        if let Some(track) = self.brushes.get_mut(name) {
            track.window = window.map(|window| (sheet, window));
        }
        opened
    }

    /// Writes what the windows hold back to the tiles.
    pub fn commit(&mut self) {
        for track in self.brushes.values_mut() {
            if let Some((sheet, window)) = &mut track.window {
                let sheet = &mut self.sheets[*sheet];
                let (id, history) = (sheet.id, &mut self.history);
                window.commit(&mut sheet.store, &mut self.versions, |tile, version| {
                    history.replaced((id, tile), version);
                });
            }
        }
    }

    pub(super) fn close_window(&mut self, name: &str) {
        self.commit();
        if let Some(track) = self.brushes.get_mut(name)
            && let Some((sheet, window)) = track.window.take()
        {
            window.close(&mut self.sheets[sheet].store);
        }
    }

    pub(super) fn close_windows(&mut self) {
        self.commit();
        for track in self.brushes.values_mut() {
            if let Some((sheet, window)) = track.window.take() {
                window.close(&mut self.sheets[sheet].store);
            }
        }
    }
}
