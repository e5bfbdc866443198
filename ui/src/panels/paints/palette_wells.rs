//! Mixtures in the wells of the palette.

use maulstick_brush::palette_place::{mirrored, size_m};
use maulstick_painting::edits::Wells;
use maulstick_painting::setup::wells_of;
use maulstick_types::Mixture;
use maulstick_types::scene::{Surface, WellKind};

use crate::widgets::context::PanelContext;

/// Largest number of paints on a palette: more would make the wells too small for a brush.
pub(crate) const MOST: usize = 24;

/// Mixtures in the wells of a palette, from the top; without the jars.
#[must_use]
pub(crate) fn mixtures(palette: &Surface) -> Vec<Mixture> {
    let held = palette.wells.iter().map(|well| match &well.kind {
        WellKind::Paint { mixture } => Some(mixture.clone()),
        WellKind::Cleaner | WellKind::Medium => None,
    });
    held.flatten().collect()
}

impl PanelContext<'_> {
    /// Mixtures in the wells of the palette, from the top; empty before there is a palette.
    #[must_use]
    pub(crate) fn wells(&self) -> Vec<Mixture> {
        self.rig.live.palette().map_or_else(Vec::new, mixtures)
    }

    /// Lays these mixtures in the palette's wells, from the top.
    pub(crate) fn lay_wells(&mut self, mixtures: &[Mixture]) {
        if mixtures.len() > MOST {
            return self.notifications.fault(
                tr!("A palette holds at most {most} paints.", most = MOST),
                tr!("Take one off the palette first."),
            );
        }
        let Some(palette) = self.rig.live.palette() else {
            return;
        };
        let wells = wells_of(mixtures, palette.cells, palette.cell_m);
        let wells = if self.preferences.window.left_handed {
            mirrored(&wells, size_m(palette))
        } else {
            wells
        };
        match Wells::new(palette.id, wells) {
            Ok(edit) => self.requests.send(edit),
            Err(error) => self.notifications.fault(error.to_string(), String::new()),
        }
    }
}
