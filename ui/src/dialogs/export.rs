//! Dialog for an export.

pub(super) mod progress;

use std::path::Path;

use eframe::egui::{ComboBox, Context, Grid, Ui};
use maulstick_types::command::{Command, ExportOrder, FileCommand};
use maulstick_ui_kit::language::{known, translated};

use crate::dialogs::browser::{Browser, Purpose};
use crate::dialogs::dialog::fault::{DialogFault, named, number, writable};
use crate::dialogs::dialog::{self, Answer, Foot, line};
use crate::dialogs::paths;

/// A file format: its name in the command, its file ending, its description.
struct Format {
    name: &'static str,
    ending: &'static str,
    words: &'static str,
}

const FORMATS: [Format; 7] = [
    Format {
        name: "png",
        ending: "png",
        words: tr_noop!("Picture under its light (PNG)"),
    },
    Format {
        name: "ora",
        ending: "ora",
        words: tr_noop!("Layers (OpenRaster)"),
    },
    Format {
        name: "exr",
        ending: "exr",
        words: tr_noop!("Unlit colour, height, each paint (OpenEXR)"),
    },
    Format {
        name: "height",
        ending: "png",
        words: tr_noop!("Heights in grey (PNG)"),
    },
    Format {
        name: "gloss",
        ending: "png",
        words: tr_noop!("Gloss in grey (PNG)"),
    },
    Format {
        name: "stl",
        ending: "stl",
        words: tr_noop!("Relief to print (STL)"),
    },
    Format {
        name: "glb",
        ending: "glb",
        words: tr_noop!("Relief in colour (glTF)"),
    },
];
/// File endings of exports.
const ENDINGS: &[&str] = &["png", "ora", "exr", "stl", "glb"];
const DEPTHS: [(u32, &str); 2] = [
    (8, tr_noop!("8 bits a channel")),
    (16, tr_noop!("16 bits a channel")),
];
const PROFILES: [(&str, &str); 3] = [
    ("", tr_noop!("As the window")),
    ("srgb", "sRGB"),
    ("display-p3", "Display P3"),
];

/// Form for an export.
#[derive(Debug)]
pub(crate) struct ExportPicture {
    browser: Browser,
    format: usize,
    bits: u32,
    profile: &'static str,
    base_mm: String,
    exaggeration: String,
    wrong: Option<String>,
}

impl ExportPicture {
    /// Begins with a PNG called as the painting, in `folder`.
    #[must_use]
    pub(crate) fn new(folder: &Path, stem: &str) -> Self {
        Self::at(paths::shown(&folder.join(format!("{stem}.png"))))
    }

    fn at(path: String) -> Self {
        Self {
            browser: Browser::at(&path, Purpose::Write, ENDINGS),
            format: 0,
            bits: 8,
            profile: PROFILES[0].0,
            base_mm: "2".to_owned(),
            exaggeration: "1".to_owned(),
            wrong: None,
        }
    }

    /// The dialog with a folder whose entries are known.
    #[cfg(test)]
    pub(crate) fn with(mut self, browser: Browser) -> Self {
        self.browser = browser;
        self
    }

    /// The command.
    ///
    /// # Errors
    /// [`DialogFault`].
    fn command(&self, path: &Path) -> Result<Command, DialogFault> {
        let ending = paths::ending(path);
        let format = &FORMATS[self.format];
        if !ending.is_empty() && ending != format.ending {
            return Err(DialogFault::NoFormat(ending));
        }
        let path = writable(path, format.ending)?;
        let mut order = ExportOrder {
            format: format.name.to_owned(),
            ..ExportOrder::to(named(&path)?)
        };
        match format.name {
            "png" => (order.bits, order.profile) = (self.bits, self.profile.to_owned()),
            "stl" | "glb" => {
                let base_mm = number(tr!("Base"), &self.base_mm)?;
                order.exaggeration = number(tr!("Heights"), &self.exaggeration)?;
                order.base_m = base_mm * 1e-3;
                if base_mm <= 0.0 || order.exaggeration <= 0.0 {
                    return Err(DialogFault::Flat);
                }
            }
            _ => {}
        }
        Ok(FileCommand::Export(order).into())
    }

    /// Follows the ending that was typed.
    fn follow(&mut self) {
        let ending = paths::ending(&self.browser.path());
        if FORMATS[self.format].ending != ending
            && let Some(format) = FORMATS.iter().position(|format| format.ending == ending)
        {
            self.format = format;
        }
    }

    pub(crate) fn show(&mut self, context: &Context, busy: bool) -> (Answer, Option<Command>) {
        let mut taken = None;
        let answer = dialog::show(context, tr!("Export"), |ui| {
            taken = self.browser.show(ui, tr!("File"));
            self.follow();
            ui.add_space(6.0);
            let entered = self.options(ui);
            let path = paths::ending_in(&self.browser.path(), FORMATS[self.format].ending);
            if self.browser.lists(ui.ctx(), &path) {
                ui.weak(tr!("{file} will be replaced.", file = paths::name(&path)));
            }
            Foot {
                go: tr!("Export"),
                wrong: self.wrong.clone(),
                entered: taken.is_some() || entered,
                busy: busy.then_some(tr!("Beginning …")),
                ..Foot::default()
            }
        });
        let asked = (answer == Answer::Go).then(|| {
            let path = taken.unwrap_or_else(|| self.browser.path());
            self.command(&path)
        });
        dialog::decided(answer, asked, &mut self.wrong)
    }

    fn options(&mut self, ui: &mut Ui) -> bool {
        let mut entered = false;
        let grid = Grid::new("export").num_columns(2).spacing([12.0, 8.0]);
        grid.show(ui, |ui| {
            let format = ui.label(tr!("Format"));
            let before = self.format;
            let combo = ComboBox::from_id_salt("format")
                .width(300.0)
                .selected_text(translated(FORMATS[self.format].words));
            let combo = combo.show_ui(ui, |ui| {
                for (place, format) in FORMATS.iter().enumerate() {
                    ui.selectable_value(&mut self.format, place, translated(format.words));
                }
            });
            combo.response.labelled_by(format.id);
            if before != self.format {
                let path = self
                    .browser
                    .path()
                    .with_extension(FORMATS[self.format].ending);
                self.browser.set(paths::shown(&path));
            }
            ui.end_row();
            match FORMATS[self.format].name {
                "png" => {
                    choice(ui, tr!("Depth"), &DEPTHS, &mut self.bits);
                    choice(ui, tr!("Colours"), &PROFILES, &mut self.profile);
                }
                "stl" | "glb" => {
                    ui.label(tr!("Solid"));
                    ui.horizontal(|ui| {
                        entered |= line(ui, tr!("Base"), &mut self.base_mm, false, 48.0);
                        ui.label("mm");
                        ui.add_space(8.0);
                        entered |= line(ui, tr!("Heights"), &mut self.exaggeration, false, 48.0);
                        ui.label(tr!("times"));
                    });
                    ui.end_row();
                }
                _ => {}
            }
        });
        entered
    }
}

fn choice<T: Copy + PartialEq>(ui: &mut Ui, label: &str, all: &[(T, &str)], chosen: &mut T) {
    let name = ui.label(label);
    let shown = all.iter().find(|(value, _)| value == chosen);
    let combo = ComboBox::from_id_salt(label)
        .width(140.0)
        .selected_text(shown.map_or("", |(_, words)| known(words)));
    let combo = combo.show_ui(ui, |ui| {
        for (value, words) in all {
            ui.selectable_value(chosen, *value, known(words));
        }
    });
    combo.response.labelled_by(name.id);
    ui.end_row();
}

#[cfg(test)]
mod tests;
