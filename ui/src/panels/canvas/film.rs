//! An even film of wet paint over the whole canvas.

use eframe::egui::Ui;
use maulstick_painting::edits::{Fill, FillPaint};
use maulstick_types::Mixture;
use maulstick_types::scene::CANVAS;
use maulstick_types::values::{BrushName, FilmThickness, ValueError};
use maulstick_ui_kit::rows::{Number, Sliders, below, choice};

use crate::widgets::context::{PanelContext, ask};

/// The paint that the brush carries.
const CARRIED: &str = tr_noop!("What the brush carries");

const THICKNESS: Number<'_> = Number::of::<FilmThickness>(tr_noop!("Thickness"), 0);

/// Form for the next film.
#[derive(Clone, Debug)]
pub(super) struct FilmForm {
    sliders: Sliders,
    paint: String,
    thickness_um: f64,
}

impl Default for FilmForm {
    fn default() -> Self {
        Self {
            sliders: Sliders::default(),
            paint: CARRIED.to_owned(),
            thickness_um: 50.0,
        }
    }
}

impl FilmForm {
    pub(super) fn show(&mut self, ui: &mut Ui, work: &mut PanelContext<'_>) {
        let library = std::sync::Arc::clone(&work.rig.library);
        let paints = library.paints().iter().map(|paint| paint.name.as_str());
        let names = std::iter::once(CARRIED).chain(paints);
        if let Some(paint) = choice(ui, tr!("Paint"), &self.paint, names) {
            self.paint = paint;
        }
        let change = self.sliders.row(ui, &THICKNESS, self.thickness_um);
        self.thickness_um = change.moved.unwrap_or(self.thickness_um);
        below(ui, |ui| {
            let button = ui.button(tr!("Cover"));
            let button = button.on_hover_text(tr!("Over the whole canvas; it can be undone"));
            if button.clicked() {
                ask(work, self.edit(work.rig.brush_name()));
            }
        });
    }

    fn edit(&self, brush: &str) -> Result<Fill, ValueError> {
        let paint = match self.paint.as_str() {
            CARRIED => FillPaint::Carried {
                brush: BrushName::new(brush)?,
            },
            paint => FillPaint::Mixture {
                mixture: Mixture::pure(paint),
            },
        };
        Ok(Fill {
            paint,
            thickness: FilmThickness::in_unit(self.thickness_um)?,
            surface: CANVAS,
        })
    }
}
