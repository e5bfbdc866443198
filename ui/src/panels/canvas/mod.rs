//! Canvas panel: size, tooth, ground, sizing, paint model and placement.
//!
//! | module | holds |
//! | --- | --- |
//! | `film` | a film of wet paint over the whole canvas |
//! | `placement` | tilt, turn and zoom of a surface |
//! | `tracing` | the picture that is traced |

use std::path::Path;

use eframe::egui::{CollapsingHeader, DragValue, Key, TextEdit, Ui};
use maulstick_appearance::ground::GROUNDS;
use maulstick_canvas::assets::{IMAGE, SPECTRUM};
use maulstick_canvas::relief::tooth;
use maulstick_models::model_names;
use maulstick_painting::edits::{Convert, Flip, Ground, Piles, Place, Size, Tooth};
use maulstick_types::scene::{CANVAS, PALETTE, Surface};
use maulstick_types::values::{
    MaterialName, ModelName, StainThickness, Tilt, Turn, ValueError, Zoom,
};
use maulstick_ui_kit::pending::Pending;
use maulstick_ui_kit::rows::{Number, Sliders, below, choice, note, row, wrong};

use crate::input::keys::Action;
use crate::panels::Panel;
use crate::spectrum_file;
use crate::widgets::context::{PanelContext, ask};

mod film;
mod placement;
mod tracing;

use film::FilmForm;
use placement::Posture;

const SIZING: Number<'_> = Number::of::<StainThickness>(tr_noop!("Absorbency"), 1);
const TILT: Number<'_> = Number::of::<Tilt>(tr_noop!("Tilt"), 0);
const TURN: Number<'_> = Number::of::<Turn>(tr_noop!("Turn"), 0);
const ZOOM: Number<'_> = Number::percent::<Zoom>(tr_noop!("Zoom"));

/// Name of a flip among the steps of the history.
const _: &str = tr_noop!("flip");

#[derive(Debug, Default)]
pub(crate) struct CanvasPanel {
    sliders: Sliders,
    posture: Pending<Posture>,
    film: FilmForm,
    /// Path of a measured ground, and what is wrong with it.
    file: String,
    told: String,
}

impl Panel for CanvasPanel {
    fn title(&self) -> &'static str {
        tr_noop!("Canvas")
    }

    fn show(&mut self, ui: &mut Ui, work: &mut PanelContext<'_>) {
        let Some(canvas) = work.rig.live.canvas().cloned() else {
            return;
        };
        size(ui, work, &canvas);
        tooth(ui, work, &canvas);
        ground(ui, work, &canvas);
        let change = self.sliders.row(ui, &SIZING, canvas.stain_m * 1e6);
        if let Some(um) = change.settled {
            let surface = CANVAS;
            let stain = StainThickness::in_unit(um);
            ask(work, stain.map(|stain| Size { stain, surface }));
        }
        model(ui, work, &canvas);
        ui.separator();
        self.place(ui, work, &canvas);
        ui.separator();
        preferences(ui, work);
        ui.separator();
        tracing::show(ui, work, &mut self.sliders);
        CollapsingHeader::new(tr!("Advanced")).show(ui, |ui| self.advanced(ui, work, &canvas));
        CollapsingHeader::new(tr!("Cover the canvas with paint"))
            .show(ui, |ui| self.film.show(ui, work));
    }
}

/// Size of the canvas; another size means another painting.
fn size(ui: &mut Ui, work: &mut PanelContext<'_>, canvas: &Surface) {
    let (unit_m, unit) = work.preferences.window.units.large();
    let [width, height] = canvas
        .cells
        .map(|cells| f64::from(cells) * canvas.cell_m / unit_m);
    let per_mm = 1e-3 / canvas.cell_m;
    ui.horizontal(|ui| {
        ui.label(format!("{width:.1} × {height:.1} {unit}"))
            .on_hover_text(tr!(
                "{across} × {up} cells",
                across = canvas.cells[0],
                up = canvas.cells[1]
            ));
        let tidy = (per_mm * 100.0).round() / 100.0;
        ui.label(tr!("{tidy} cells a mm", tidy));
        let new = ui
            .button(tr!("New…"))
            .on_hover_text(tr!("A canvas of another size is a new painting"));
        if new.clicked() {
            work.requests.act(Action::New);
        }
    });
}

/// Model of the paint; another choice converts the existing paint.
fn model(ui: &mut Ui, work: &mut PanelContext<'_>, canvas: &Surface) {
    let chosen = choice(ui, tr!("Paint model"), &canvas.model, model_names());
    if let Some(model) = chosen {
        let convert = |model| Convert {
            model,
            surface: CANVAS,
        };
        ask(work, ModelName::new(&model).map(convert));
    }
}

/// Display name of an entry of the scene.
fn shown<'a>(name: &'a str, measured: &'a str) -> &'a str {
    if name.starts_with(IMAGE) {
        tr!("a picture")
    } else if name.starts_with(SPECTRUM) {
        measured
    } else {
        name
    }
}

/// Preferences of the painter, the same for every painting.
fn preferences(ui: &mut Ui, work: &mut PanelContext<'_>) {
    ui.checkbox(&mut work.preferences.window.left_handed, tr!("Left-handed"))
        .on_hover_text(tr!(
            "The palette lies at the right, brushes and panels at the left"
        ));
    let Some(mut last) = work.rig.live.palette().map(|palette| palette.piles_last) else {
        return;
    };
    let lasts = ui
        .checkbox(&mut last, tr!("Palette never runs out"))
        .on_hover_text(tr!(
            "Brushes take paint from the palette, and it stays there all the same"
        ));
    if lasts.changed() {
        let surface = PALETTE;
        ask(work, Ok(Piles { last, surface }));
    }
}

/// Gives the canvas a piece of a tooth.
fn tooth_edit(tooth: &str, seed: u64) -> Result<Tooth, ValueError> {
    Ok(Tooth {
        tooth: MaterialName::new(tooth)?,
        seed,
        surface: CANVAS,
    })
}

fn tooth(ui: &mut Ui, work: &mut PanelContext<'_>, canvas: &Surface) {
    let (name, seed) = (&canvas.tooth, canvas.tooth_seed);
    let chosen = choice(ui, tr!("Tooth"), shown(name, name), tooth::Tooth::names());
    if let Some(tooth) = chosen {
        ask(work, tooth_edit(&tooth, seed));
    }
}

fn ground(ui: &mut Ui, work: &mut PanelContext<'_>, canvas: &Surface) {
    let names = GROUNDS.map(|(name, _)| name);
    let shown = shown(&canvas.ground, tr!("a measured one"));
    let chosen = choice(ui, tr!("Ground"), shown, names);
    if let Some(ground) = chosen {
        ask(work, Ground::named(CANVAS, &ground));
    }
}

impl CanvasPanel {
    /// The canvas flipped, the piece of cloth that is the tooth, and a measured ground.
    fn advanced(&mut self, ui: &mut Ui, work: &mut PanelContext<'_>, canvas: &Surface) {
        let hover = tr!("Mirrors the paint, to see the drawing afresh; again, and it is as before");
        let flip = ui.button(tr!("Flip left to right")).on_hover_text(hover);
        if flip.clicked() {
            ask(work, Ok(Flip { surface: CANVAS }));
        }
        let (name, seed) = (&canvas.tooth, canvas.tooth_seed);
        if !name.starts_with(IMAGE) {
            let mut piece = seed;
            let changed = row(ui, tr!("Cloth piece"), |ui| {
                let number = DragValue::new(&mut piece)
                    .speed(0.1)
                    .update_while_editing(false);
                ui.add(number)
                    .on_hover_text(tr!("Another number is another piece of the same cloth"))
            });
            if changed.changed() && piece != seed {
                ask(work, tooth_edit(name, piece));
            }
        }
        row(ui, tr!("Ground from"), |ui| {
            let edit =
                TextEdit::singleline(&mut self.file).hint_text(tr!("a file of measurements"));
            let edit = ui.add(edit.desired_width(f32::INFINITY));
            let entered = ui.input(|input| input.key_pressed(Key::Enter));
            if edit.lost_focus() && entered && !self.file.trim().is_empty() {
                self.told.clear();
                match spectrum_file::reflectance(Path::new(self.file.trim())) {
                    Ok(spectrum) => {
                        ask(work, Ground::spectrum(CANVAS, &spectrum));
                    }
                    Err(fault) => self.told = spectrum_file::told(&fault),
                }
            }
            edit.on_hover_text(tr!(
                "The whole path of a measured ground, a line for each wavelength in nm and its reflectance; Enter reads it"
            ))
        });
        if !self.told.is_empty() {
            wrong(ui, &self.told);
            note(ui, tr!("A picture is a ground only of a new painting."));
        }
    }

    /// Placement of the canvas.
    fn place(&mut self, ui: &mut Ui, work: &mut PanelContext<'_>, canvas: &Surface) {
        let now_s = ui.input(|input| input.time);
        let before = self.posture.shown(now_s, &Posture::of(canvas));
        let mut posture = before.clone();
        self.sliders.rows(
            ui,
            [
                (&TILT, &mut posture.tilt_deg),
                (&TURN, &mut posture.turn_deg),
                (&ZOOM, &mut posture.zoom),
            ],
        );
        below(ui, |ui| {
            let keys = &work.preferences.keys;
            let hover = keys.hint(ui.ctx(), tr!("See the whole canvas"), &[Action::Fit]);
            let fit = ui.button(tr!("Fit")).on_hover_text(hover);
            if fit.clicked() {
                work.requests.act(Action::Fit);
            }
            let words = tr!("A point of the canvas a pixel of the display.");
            let hover = keys.hint(ui.ctx(), words, &[Action::Hundred]);
            let cells = ui.button(tr!("Actual pixels (1:1)")).on_hover_text(hover);
            if cells.clicked() {
                work.requests.act(Action::Hundred);
            }
        });
        if posture != before {
            let (pose, zoom) = posture.laid(canvas);
            if ask(work, Place::new(CANVAS, pose, zoom)) {
                self.posture.hold(now_s, posture);
            }
        }
    }
}

#[cfg(test)]
mod tests;
