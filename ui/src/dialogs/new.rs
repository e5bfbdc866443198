//! Dialog for a new painting: size, resolution, ground, and file.

use std::path::Path;

use eframe::egui::{ComboBox, Context, Grid, Key, TextEdit, Ui};
use maulstick_canvas::relief::tooth::Tooth;
use maulstick_types::command::{Command, NewCanvas, RigCommand};
use maulstick_types::scene::default_stain_m;
use maulstick_types::values::{MaterialName, WholePath};
use maulstick_ui_kit::language::{capitalized, known, translated};
use maulstick_ui_kit::units::Units;

use crate::dialogs::dialog::fault::{DialogFault, named, number, writable};
use crate::dialogs::dialog::{self, Answer, Foot, line};
use crate::dialogs::open::discard_prompt::UnsavedState;
use crate::dialogs::paths;

/// Sizes for choosing with a click: name, width and height, cm.
const SIZES: [(&str, f64, f64); 3] = [("A5", 21.0, 14.8), ("A4", 29.7, 21.0), ("A3", 42.0, 29.7)];
/// Sizes that are usual in a unit, in that unit.
const fn usual(units: Units) -> [(&'static str, &'static str, &'static str); 2] {
    match units {
        Units::Metric => [("20 × 20", "20", "20"), ("30 × 40", "30", "40")],
        Units::Inches => [("8 × 10", "8", "10"), ("12 × 16", "12", "16")],
    }
}
/// Grounds by name; the last is a file.
const GROUNDS: [(&str, &str); 4] = [
    ("gesso", tr_noop!("Gesso, white")),
    ("grey", tr_noop!("Grey")),
    ("black", tr_noop!("Black")),
    (FILE, tr_noop!("A file …")),
];
const FILE: &str = "";
/// Memory of a cell painted with three paints, bytes: their counts, its displayed colour and height, and the same in
/// the window.
const CELL_BYTES: f64 = 3.0 * 4.0 + 14.0 + 16.0;

/// Form for a new painting.
#[derive(Debug)]
pub(crate) struct NewPainting {
    /// Units of width and height.
    units: Units,
    width: String,
    height: String,
    fine: String,
    ground: &'static str,
    ground_file: String,
    tooth: String,
    as_sketch: bool,
    path: String,
    unkept: UnsavedState,
    /// True if the painter accepts that painting on it is slow.
    may_be_slow: bool,
    wrong: Option<String>,
}

impl NewPainting {
    /// A form for a painting in `folder`.
    #[must_use]
    pub(crate) fn new(folder: &Path, units: Units, unkept: UnsavedState) -> Self {
        let free = paths::free(folder, tr!("Painting"), paths::PAINTING);
        Self::kept_in(paths::shown(&free), units, unkept)
    }

    fn kept_in(path: String, units: Units, unkept: UnsavedState) -> Self {
        Self {
            units,
            width: units.typed(29.7),
            height: units.typed(21.0),
            fine: "4".to_owned(),
            ground: GROUNDS[0].0,
            ground_file: String::new(),
            tooth: "linen".to_owned(),
            as_sketch: false,
            path,
            unkept,
            may_be_slow: false,
            wrong: None,
        }
    }

    /// Shows the rig's refusal.
    pub(crate) fn refused(&mut self, words: String) {
        self.wrong = Some(words);
    }

    /// The canvas.
    ///
    /// # Errors
    /// [`DialogFault`].
    fn canvas(&self) -> Result<NewCanvas, DialogFault> {
        let width = number(tr!("Width"), &self.width)?;
        let height = number(tr!("Height"), &self.height)?;
        let fine = number(tr!("Cells per mm"), &self.fine)?;
        if fine <= 0.0 {
            return Err(DialogFault::NoCells);
        }
        let ground = match self.ground {
            FILE if self.ground_file.trim().is_empty() => return Err(DialogFault::NoGround),
            FILE => paths::whole(&self.ground_file).display().to_string(),
            name => name.to_owned(),
        };
        let (unit_m, _) = self.units.large();
        let canvas = NewCanvas {
            width_m: width * unit_m,
            height_m: height * unit_m,
            cell_m: 1e-3 / fine,
            ground: MaterialName::new(ground)?,
            tooth: MaterialName::new(&*self.tooth)?,
            tooth_seed: 1,
            stain_m: default_stain_m(),
        };
        canvas.check()?;
        Ok(canvas)
    }

    /// The command.
    ///
    /// # Errors
    /// As [`canvas`](Self::canvas), and if the file cannot be created there.
    fn command(&self) -> Result<Command, DialogFault> {
        let canvas = self.canvas()?;
        if canvas.is_slow() && !self.may_be_slow {
            return Err(DialogFault::Slow);
        }
        self.unkept.check()?;
        let path = (!self.as_sketch).then(|| self.file()).transpose()?;
        Ok(RigCommand::New {
            path,
            canvas,
            forget: self.unkept.let_go(),
        }
        .into())
    }

    /// The whole path of its file.
    fn file(&self) -> Result<WholePath, DialogFault> {
        if self.path.trim().is_empty() || self.path.trim().ends_with('/') {
            return Err(DialogFault::NoPaintingName);
        }
        let path = paths::ending_in(&paths::whole(&self.path), paths::PAINTING);
        if path.exists() {
            return Err(DialogFault::Taken(path));
        }
        named(&writable(&path, paths::PAINTING)?)
    }

    pub(crate) fn show(&mut self, context: &Context, busy: bool) -> (Answer, Option<Command>) {
        let answer = dialog::show(context, tr!("New painting"), |ui| {
            let entered = self.fields(ui);
            let canvas = self.canvas();
            let estimate = canvas.map(|canvas| (estimate(&canvas), canvas.is_slow()));
            ui.add_space(6.0);
            let wrong = match estimate {
                Ok((words, is_slow)) => {
                    ui.weak(words);
                    if is_slow {
                        let words = tr!("It may be slow: the paint falls behind the hand");
                        ui.checkbox(&mut self.may_be_slow, words);
                    }
                    self.wrong.clone()
                }
                Err(fault) => Some(fault.to_string()),
            };
            self.unkept.show(ui);
            Foot {
                go: tr!("Create"),
                wrong,
                entered,
                busy: busy.then_some(tr!("Laying out the canvas …")),
                ..Foot::default()
            }
        });
        let asked = (answer == Answer::Go).then(|| self.command());
        dialog::decided(answer, asked, &mut self.wrong)
    }

    fn fields(&mut self, ui: &mut Ui) -> bool {
        let mut entered = false;
        let mut changed = false;
        let (_, unit) = self.units.large();
        changed |= self.sizes(ui);
        ui.add_space(4.0);
        let grid = Grid::new("new painting")
            .num_columns(2)
            .spacing([12.0, 8.0]);
        grid.show(ui, |ui| {
            ui.label(tr!("Size"));
            ui.horizontal(|ui| {
                entered |= line(ui, tr!("Width"), &mut self.width, true, 56.0);
                ui.label(unit);
                ui.add_space(8.0);
                entered |= line(ui, tr!("Height"), &mut self.height, false, 56.0);
                ui.label(unit);
            });
            ui.end_row();
            ui.label(tr!("Detail"));
            ui.horizontal(|ui| {
                entered |= line(ui, tr!("Cells per mm"), &mut self.fine, false, 56.0);
                ui.weak(tr!("4 for most, 8 for miniatures"));
            });
            ui.end_row();
            entered |= self.materials(ui);
            let keep = ui.label(tr!("Keep in"));
            ui.vertical(|ui| {
                ui.add_enabled_ui(!self.as_sketch, |ui| {
                    let edit = TextEdit::singleline(&mut self.path).desired_width(f32::INFINITY);
                    let field = ui.add(edit).labelled_by(keep.id);
                    let enter = ui.input(|input| input.key_pressed(Key::Enter));
                    entered |= field.lost_focus() && enter;
                    changed |= field.changed();
                });
                ui.checkbox(
                    &mut self.as_sketch,
                    tr!("As a sketch: without a name for now"),
                );
            });
            ui.end_row();
        });
        if changed || entered {
            self.wrong = None;
        }
        entered
    }

    /// Buttons of usual sizes; true if one was chosen.
    fn sizes(&mut self, ui: &mut Ui) -> bool {
        let mut is_chosen = false;
        let (_, unit) = self.units.large();
        ui.horizontal(|ui| {
            let paper = SIZES.map(|(name, width, height)| {
                (name, [width, height].map(|cm| self.units.typed(cm)))
            });
            let usual = usual(self.units)
                .map(|(name, width, height)| (name, [width, height].map(str::to_owned)));
            for (name, size) in paper.into_iter().chain(usual) {
                let hover = format!("{} × {} {unit}", size[0], size[1]);
                if ui.button(name).on_hover_text(hover).clicked() {
                    [self.width, self.height] = size;
                    is_chosen = true;
                }
            }
            let turn = ui.button(tr!("Swap width and height"));
            if turn.clicked() {
                std::mem::swap(&mut self.width, &mut self.height);
            }
        });
        is_chosen
    }

    /// Rows of ground and tooth; true if Enter was pressed.
    fn materials(&mut self, ui: &mut Ui) -> bool {
        let mut entered = false;
        let ground = ui.label(tr!("Ground"));
        ui.horizontal(|ui| {
            let name = |known: &str| GROUNDS.iter().find(|(name, _)| *name == known);
            let shown = name(self.ground).map_or("", |(_, shown)| translated(shown));
            let combo = ComboBox::from_id_salt("ground")
                .width(120.0)
                .selected_text(shown);
            let combo = combo.show_ui(ui, |ui| {
                for (name, shown) in GROUNDS {
                    ui.selectable_value(&mut self.ground, name, translated(shown));
                }
            });
            combo.response.labelled_by(ground.id);
            if self.ground == FILE {
                entered |= line(ui, tr!("Path"), &mut self.ground_file, false, 120.0);
            }
        });
        ui.end_row();
        let tooth = ui.label(tr!("Tooth"));
        let combo = ComboBox::from_id_salt("tooth")
            .width(120.0)
            .selected_text(capitalized(known(&self.tooth)));
        let combo = combo.show_ui(ui, |ui| {
            for name in Tooth::names() {
                let words = capitalized(known(name));
                ui.selectable_value(&mut self.tooth, name.to_owned(), words);
            }
        });
        combo.response.labelled_by(tooth.id);
        ui.end_row();
        entered
    }
}

/// Estimate of size and memory, in words.
fn estimate(canvas: &NewCanvas) -> String {
    let side = |length: f64| (length / canvas.cell_m).round().max(1.0);
    let [across, up] = [side(canvas.width_m), side(canvas.height_m)];
    let cells = across * up;
    let count = match cells {
        cells if cells < 1e5 => format!("{cells:.0}"),
        cells => tr!(
            "{count} million",
            count = format_args!("{:.1}", cells * 1e-6)
        ),
    };
    let bytes = cells * CELL_BYTES;
    let room = match bytes {
        bytes if bytes < 1e6 => tr!("less than 1 MB").to_owned(),
        bytes if bytes < 1e9 => tr!(
            "about {size} MB",
            size = format_args!("{:.0}", bytes * 1e-6)
        ),
        bytes => tr!(
            "about {size} GB",
            size = format_args!("{:.1}", bytes * 1e-9)
        ),
    };
    tr!(
        "{across} × {up} cells, {count} in all; {room} of memory when all of it is painted.",
        across = format_args!("{across:.0}"),
        up = format_args!("{up:.0}"),
        count,
        room
    )
}

#[cfg(test)]
mod tests;
