//! Dialog that chooses a motion of a folder by its picture.

use std::path::PathBuf;

use eframe::egui::{
    Align2, Context, Role, ScrollArea, Sense, StrokeKind, TextStyle, Ui, Vec2, WidgetInfo, vec2,
};

use crate::dialogs::dialog::{self, Answer, Foot};
use crate::dialogs::paths;
use crate::motions::library::{Known, Library, Motion};
use crate::settings::brush_library::of_library;
use crate::settings::preferences::Preferences;
use crate::widgets::context::PanelContext;

/// The guide to motions.
const GUIDE: &str = concat!(env!("CARGO_PKG_REPOSITORY"), "/blob/main/docs/motions.md");
/// Height of the list, points.
const HEIGHT: f32 = 280.0;
/// A picture, and the line below it, points.
const PICTURE: Vec2 = vec2(92.0, 92.0);
const LINE: f32 = 18.0;

#[derive(Debug)]
pub(crate) struct ChooseMotion {
    folder: String,
    library: Option<Library>,
    marked: Option<PathBuf>,
    wrong: Option<String>,
}

/// Result of the dialog in a frame.
#[derive(Debug, Default)]
pub(crate) struct Chosen {
    /// True if it closes.
    pub closes: bool,
    pub chosen: Option<Motion>,
}

impl ChooseMotion {
    /// In the folder that was chosen last.
    #[must_use]
    pub(crate) fn new(preferences: &Preferences) -> Self {
        let folder = preferences.motions.clone();
        let folder = folder.unwrap_or_else(Library::default_folder);
        Self {
            folder: paths::shown(&folder),
            library: None,
            marked: None,
            wrong: None,
        }
    }

    pub(crate) fn show(&mut self, context: &Context, work: &mut PanelContext<'_>) -> Chosen {
        let folder = paths::whole(&self.folder);
        let library = match self.library.take() {
            Some(library) if library.folder == folder => library,
            _ => {
                self.marked = None;
                Library::new(context, folder.clone(), head_m(work))
            }
        };
        let library = self.library.insert(library);
        library.take_in(context);
        let (text, marked, wrong) = (&mut self.folder, &mut self.marked, &self.wrong);
        let mut is_taken = false;
        let answer = dialog::show(context, tr!("Motions"), |ui| {
            dialog::line(ui, tr!("Folder"), text, true, f32::INFINITY);
            ui.add_space(6.0);
            is_taken = list(ui, library, marked);
            Foot {
                go: tr!("Put down"),
                wrong: wrong.clone(),
                entered: is_taken,
                busy: None,
                lacks: marked
                    .is_none()
                    .then_some(tr!("Choose one of the motions.")),
            }
        });
        if answer != Answer::Go {
            return Chosen {
                closes: answer == Answer::Leave,
                chosen: None,
            };
        }
        let Some(chosen) = self.chosen() else {
            // It is still being read.
            self.wrong = Some(tr!("Looking …").to_owned());
            return Chosen::default();
        };
        let is_usual = folder == Library::default_folder();
        work.preferences.motions = (!is_usual).then_some(folder);
        Chosen {
            closes: true,
            chosen: Some(chosen),
        }
    }

    /// The motion that is marked.
    fn chosen(&self) -> Option<Motion> {
        let marked = self.marked.as_ref()?;
        let files = self.library.as_ref()?.files.as_ref().ok()?;
        files.iter().find_map(|(path, known)| match known {
            Known::Here(motion) if path == marked => Some(motion.clone()),
            _ => None,
        })
    }
}

/// Length of the head that a 6-DOF stylus holds, m: of the brush in the hand.
fn head_m(work: &PanelContext<'_>) -> f64 {
    let file = work.in_hand().or_else(|| of_library("round"));
    file.map_or(0.03, |file| file.length_m())
}

/// The motions of the folder; true if one was taken by two clicks.
fn list(ui: &mut Ui, library: &Library, marked: &mut Option<PathBuf>) -> bool {
    let is_usable = |known: &Known| !matches!(known, Known::Unusable);
    let has_none = |files: &Vec<(PathBuf, Known)>| !files.iter().any(|(_, known)| is_usable(known));
    let is_empty = !library.is_coming() && library.files.as_ref().is_ok_and(has_none);
    let told = match &library.files {
        _ if library.is_coming() => Some(tr!("Looking …").to_owned()),
        Err(error) => Some(dialog::in_words(&paths::unlisted(error), "")),
        Ok(_) if is_empty => Some(
            tr!("No motions are here. A motion is a file of recorded strokes, which can be painted again anywhere. Lay some into this folder, or write another folder above.")
                .to_owned(),
        ),
        Ok(_) => None,
    };
    let mut is_taken = false;
    let frame = eframe::egui::Frame::group(ui.style());
    frame.show(ui, |ui| {
        ui.set_min_size(vec2(ui.available_width(), HEIGHT));
        if let Some(told) = told {
            ui.weak(told);
            if is_empty {
                ui.hyperlink_to(tr!("How motions are made"), GUIDE);
            }
            return;
        }
        let scroll = ScrollArea::vertical().max_height(HEIGHT).auto_shrink(false);
        scroll.show(ui, |ui| {
            ui.horizontal_wrapped(|ui| {
                for (path, known) in library.files.iter().flatten() {
                    if is_usable(known) {
                        let (is_clicked, is_twice) =
                            tile(ui, path, known, marked.as_ref() == Some(path));
                        if is_clicked {
                            *marked = Some(path.clone());
                        }
                        is_taken |= is_twice;
                    }
                }
            });
        });
    });
    is_taken
}

/// Picture and name of a motion; whether it was clicked, and twice.
fn tile(ui: &mut Ui, path: &std::path::Path, known: &Known, is_marked: bool) -> (bool, bool) {
    let (area, response) = ui.allocate_exact_size(PICTURE + vec2(0.0, LINE), Sense::CLICK);
    let name = path.file_stem().unwrap_or_default();
    let name = name.to_string_lossy().into_owned();
    response.widget_info(|| WidgetInfo::selected(Role::ListBoxOption, true, is_marked, &*name));
    if !ui.is_rect_visible(area) {
        return (response.clicked(), response.double_clicked());
    }
    let visuals = ui.style().interact_selectable(&response, is_marked);
    if is_marked || response.hovered() {
        ui.painter().rect_filled(area, 4.0, visuals.weak_bg_fill);
    }
    let mut within = area;
    within.max.y -= LINE;
    let line = ui.visuals().widgets.noninteractive.bg_stroke;
    ui.painter()
        .rect_stroke(within, 3.0, line, StrokeKind::Inside);
    let mut hint = name.clone();
    if let Known::Here(motion) = known {
        let colour = visuals.text_color();
        motion.drawn.draw_within(ui.painter(), colour, within);
        let (count, seconds) = (motion.drawn.strokes.len(), format!("{:.1}", motion.seconds));
        let words = match count {
            1 => tr!("1 stroke, {seconds} s", seconds),
            _ => tr!("{count} strokes, {seconds} s", count, seconds),
        };
        hint = format!("{name}: {words}");
    }
    let font = TextStyle::Small.resolve(ui.style());
    let mut job =
        eframe::egui::text::LayoutJob::simple_singleline(name, font, visuals.text_color());
    job.wrap = eframe::egui::text::TextWrapping::truncate_at_width(PICTURE.x - 6.0);
    let galley = ui.painter().layout_job(job);
    let below = eframe::egui::Rect::from_min_max(within.left_bottom(), area.max);
    let at = Align2::CENTER_CENTER.align_size_within_rect(galley.size(), below);
    ui.painter().galley(at.min, galley, visuals.text_color());
    let clicks = (response.clicked(), response.double_clicked());
    response.on_hover_text(hint);
    clicks
}
