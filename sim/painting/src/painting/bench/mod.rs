//! The workbench: the desk with the brushes, their backend, the accounts and the past. Strokes and steps change it.

mod changes;
mod steps;
mod strokes;
mod undo;
mod versions;

use std::sync::Arc;

use maulstick_model::interface::StepReport;

use super::accounts::Accounts;
use super::backend::Backend;
use super::brushes::Brushes;
use super::brushes::handling::UnderBrush;
use super::desk::Desk;
use super::past::Past;

/// The parts of a painting that strokes and steps change.
pub(crate) struct Workbench {
    pub(crate) desk: Desk,
    pub(crate) brushes: Brushes,
    pub(crate) backend: Backend,
    pub(crate) accounts: Accounts,
    pub(crate) past: Past,
}

impl Workbench {
    /// The workbench of a desk that nothing was painted on.
    pub(crate) fn new(desk: Desk) -> Self {
        Self {
            desk,
            brushes: Brushes::default(),
            backend: Backend::default(),
            accounts: Accounts::default(),
            past: Past::default(),
        }
    }

    /// Has the model write back what it holds.
    pub(crate) fn settle(&mut self) {
        if let Some(brush) = self.backend.unsettled.take()
            && let own = &mut self.brushes[brush]
            && let Some((on, window)) = &mut own.window
        {
            let on = *on;
            let surface = &mut self.desk.surfaces[on];
            let model = self.backend.models.of(surface.model);
            let report = model.settle(window, Arc::make_mut(&mut own.load));
            let steps = own.deferral.settle();
            surface.top = surface.top.max(window.top());
            self.note(brush, on, &report, steps);
            self.book(Some(brush));
        }
        self.backend.find_facts();
    }

    /// Notes the effects of a brush's steps on a surface; those of deferred ones are known when they are settled.
    fn note(&mut self, brush: usize, surface: usize, report: &StepReport, steps: u32) {
        self.accounts.note(report);
        let surfaces = &self.desk.surfaces;
        let defers = self.backend.defers(&surfaces[surface], false);
        if !defers || report.footprint_cells > 0 {
            let rheology = &surfaces[surface].model.rheology;
            let under = UnderBrush::mean(report, steps, surfaces.cell_m(), rheology);
            self.brushes[brush].under = under;
        }
    }

    /// Writes what the windows hold back to the tiles.
    pub(crate) fn commit(&mut self) {
        self.settle();
        for brush in self.brushes.iter_mut() {
            if let Some((on, window)) = &mut brush.window {
                self.desk.surfaces.commit(*on, window, |place, before| {
                    let history = &mut self.past.history;
                    history.replaced(Some(&brush.name), place, before);
                });
            }
        }
    }

    /// Writes the windows back and closes them.
    pub(crate) fn close_windows(&mut self) {
        self.commit();
        for brush in self.brushes.iter_mut() {
            if let Some((on, window)) = brush.window.take() {
                window.close(&mut self.desk.surfaces[on].store);
            }
        }
    }
}
