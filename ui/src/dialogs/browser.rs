//! File chooser: a path is typed, and the matching files are listed below it. ↓ and ↑ go through the list,
//! → completes, Enter opens a folder or takes the file.

pub(super) mod folder;
pub(super) mod pictures;

use std::path::{Path, PathBuf};

use eframe::egui::text::{CCursor, CCursorRange};
use eframe::egui::text_edit::TextEditState;
use eframe::egui::{
    Align, Align2, Context, Id, Key, Modifiers, Response, Role, ScrollArea, Sense, TextEdit,
    TextStyle, Ui, Vec2, WidgetInfo, vec2,
};

use folder::{Entry, Folder};
use pictures::Pictures;

use crate::dialogs::dialog;
use crate::dialogs::paths;

/// Height of the list, points.
const HEIGHT: f32 = 176.0;
/// Size of a painting's small picture, points.
pub(super) const PICTURE: Vec2 = vec2(40.0, 30.0);

/// Purpose of the path: an existing file to read, or a file to write.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Purpose {
    /// An existing file is read.
    Read,
    /// A file is written, new or existing.
    Write,
}

/// A path that is being chosen.
#[derive(Debug)]
pub(crate) struct Browser {
    purpose: Purpose,
    text: String,
    folder: Folder,
    /// Index of the marked entry among those that match.
    marked: Option<usize>,
    /// The one that was marked when the list was last drawn: a newly marked one is brought into sight.
    seen: Option<usize>,
    /// Pictures of the files, where the list shows them.
    pictures: Option<Pictures>,
}

impl Browser {
    /// Begins at a path: a folder ends in `/`. Files that end in `kinds` are listed.
    #[must_use]
    pub(crate) fn at(path: &str, purpose: Purpose, kinds: &'static [&'static str]) -> Self {
        Self {
            purpose,
            text: path.to_owned(),
            folder: Folder::new(split(path).0, kinds),
            marked: None,
            seen: None,
            pictures: None,
        }
    }

    /// The same with a small picture of each file.
    #[must_use]
    pub(crate) fn with_pictures(mut self) -> Self {
        self.pictures = Some(Pictures::default());
        self
    }

    /// The pictures of the files, where the list shows them.
    pub(crate) fn pictures(&mut self) -> Option<&mut Pictures> {
        self.pictures.as_mut()
    }

    /// The chooser with a folder whose entries are known.
    #[cfg(test)]
    pub(crate) fn listing(mut self, entries: Vec<Entry>, kinds: &'static [&'static str]) -> Self {
        self.folder = Folder::of(self.folder.path, kinds, entries);
        self
    }

    /// The text as typed.
    #[cfg(test)]
    pub(crate) fn text(&self) -> &str {
        &self.text
    }

    /// Writes a path into the field.
    pub(crate) fn set(&mut self, text: String) {
        self.text = text;
        self.marked = None;
        self.folder.go(split(&self.text).0);
    }

    #[must_use]
    pub(crate) fn path(&self) -> PathBuf {
        paths::whole(&self.text)
    }

    /// True if a file of this path is listed.
    pub(crate) fn lists(&mut self, context: &Context, path: &Path) -> bool {
        if path.parent() != Some(self.folder.path.as_path()) {
            return false;
        }
        let name = paths::name(path);
        let entries = self.folder.entries(context).and_then(Result::ok);
        entries.is_some_and(|entries| entries.iter().any(|entry| entry.name == name))
    }

    /// Shows field and list; the path that was taken, by Enter or two clicks.
    pub(crate) fn show(&mut self, ui: &mut Ui, label: &str) -> Option<PathBuf> {
        let fitting = self.fitting(ui.ctx());
        let keys = Keys::heard(ui, fitting.len(), &mut self.marked);
        if keys == Keys::Complete {
            self.complete(ui, &fitting);
        }
        let name = ui.label(label);
        let edit = TextEdit::singleline(&mut self.text)
            .id(dialog::first())
            .desired_width(f32::INFINITY);
        let field = ui.add(edit).labelled_by(name.id);
        if field.changed() {
            self.marked = None;
            self.folder.go(split(&self.text).0);
        }
        let entered = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        let chosen = self.list(ui, &fitting);
        if chosen.is_some() {
            return chosen;
        }
        if !entered {
            return None;
        }
        match self.marked.and_then(|marked| fitting.get(marked)).cloned() {
            Some(entry) => self.take(ui, &entry),
            None if self.text.ends_with('/') => None,
            None => Some(self.path()),
        }
    }

    /// The entries that begin with the typed text; for writing, all entries if none does.
    fn fitting(&mut self, context: &Context) -> Vec<Entry> {
        let typed = split(&self.text).1.to_lowercase();
        let Some(Ok(entries)) = self.folder.entries(context) else {
            return Vec::new();
        };
        let begins = |entry: &&Entry| entry.name.to_lowercase().starts_with(&typed);
        let fitting: Vec<Entry> = entries.iter().filter(begins).cloned().collect();
        if fitting.is_empty() && self.purpose == Purpose::Write {
            entries.to_vec()
        } else {
            fitting
        }
    }

    /// Completes the typed text as far as all matches agree.
    fn complete(&mut self, ui: &Ui, fitting: &[Entry]) {
        let marked = self.marked.and_then(|marked| fitting.get(marked));
        let common = match marked {
            Some(entry) => as_typed(entry),
            None => common_start(fitting),
        };
        let typed = split(&self.text).1.to_owned();
        if common.to_lowercase().starts_with(&typed.to_lowercase()) && common.len() > typed.len() {
            let kept = self.text.len() - typed.len();
            let text = format!("{}{common}", &self.text[..kept]);
            self.write(ui, text);
        }
    }

    /// Writes into the field, the cursor at its end.
    fn write(&mut self, ui: &Ui, text: String) {
        let end = CCursor::new(text.chars().count());
        let mut state = TextEditState::load(ui.ctx(), dialog::first()).unwrap_or_default();
        state.cursor.set_char_range(Some(CCursorRange::one(end)));
        state.store(ui.ctx(), dialog::first());
        self.set(text);
    }

    /// Enters a folder, or chooses a file.
    fn take(&mut self, ui: &Ui, entry: &Entry) -> Option<PathBuf> {
        let kept = self.text.len() - split(&self.text).1.len();
        let text = format!("{}{}", &self.text[..kept], as_typed(entry));
        self.write(ui, text);
        (!entry.is_folder).then(|| self.path())
    }

    /// Reason why there is nothing to list, in words.
    fn lack(&mut self, context: &Context, fitting: &[Entry]) -> Option<String> {
        match self.folder.entries(context) {
            None => Some(tr!("Looking …").to_owned()),
            Some(Err(error)) => Some(dialog::in_words(&paths::unlisted(error), "")),
            Some(Ok(_)) if fitting.is_empty() && self.purpose == Purpose::Read => {
                Some(tr!("No file here starts with that.").to_owned())
            }
            Some(Ok(_)) => None,
        }
    }

    fn list(&mut self, ui: &mut Ui, fitting: &[Entry]) -> Option<PathBuf> {
        if let Some(pictures) = &mut self.pictures {
            pictures.take_in(ui.ctx());
        }
        let lack = self.lack(ui.ctx(), fitting);
        let mut taken = None;
        let frame = eframe::egui::Frame::group(ui.style());
        frame.show(ui, |ui| {
            ui.set_min_size(vec2(ui.available_width(), HEIGHT));
            if let Some(lack) = lack {
                ui.weak(lack);
                return;
            }
            let above = self.folder.path.parent().is_some().then(|| Entry {
                name: "..".to_owned(),
                is_folder: true,
                age: tr!("the folder above").to_owned(),
            });
            ScrollArea::vertical()
                .max_height(HEIGHT)
                .auto_shrink(false)
                .show(ui, |ui| {
                    ui.spacing_mut().item_spacing.y = 0.0;
                    if let Some(above) = &above
                        && row(
                            ui,
                            above,
                            false,
                            self.pictures.as_mut().map(|own| (own, Path::new(""))),
                        )
                        .clicked()
                    {
                        self.up(ui);
                    }
                    for (place, entry) in fitting.iter().enumerate() {
                        let is_marked = self.marked == Some(place);
                        let path = self.folder.path.join(&entry.name);
                        let pictures = self.pictures.as_mut();
                        let picture = pictures.map(|pictures| (pictures, path.as_path()));
                        let response = row(ui, entry, is_marked, picture);
                        if is_marked && self.seen != self.marked {
                            response.scroll_to_me(Some(Align::Center));
                        }
                        if response.double_clicked() || (response.clicked() && entry.is_folder) {
                            taken = self.take(ui, entry);
                        } else if response.clicked() {
                            self.take(ui, entry);
                        }
                    }
                });
        });
        self.seen = self.marked;
        taken
    }

    fn up(&mut self, ui: &Ui) {
        let above = self.folder.path.parent().unwrap_or(Path::new("/"));
        let name = match self.purpose {
            Purpose::Read => "",
            Purpose::Write => split(&self.text).1,
        };
        let text = format!("{}/{name}", paths::shown(above).trim_end_matches('/'));
        self.write(ui, text);
    }
}

/// Effect of the keys on the list while the field has the keyboard.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Keys {
    Nothing,
    Complete,
}

impl Keys {
    fn heard(ui: &Ui, count: usize, marked: &mut Option<usize>) -> Self {
        let id: Id = dialog::first();
        if !ui.memory(|memory| memory.has_focus(id)) {
            return Self::Nothing;
        }
        let pressed = |key: Key| ui.input_mut(|input| input.consume_key(Modifiers::NONE, key));
        if pressed(Key::ArrowDown) && count > 0 {
            *marked = Some(marked.map_or(0, |marked| (marked + 1).min(count - 1)));
        }
        if pressed(Key::ArrowUp) {
            *marked = marked.and_then(|marked| marked.checked_sub(1));
        }
        let state = TextEditState::load(ui.ctx(), id);
        let range = state.and_then(|state| state.cursor.char_range());
        let is_at_end = range.is_none_or(|range| {
            let prefers = CCursorRange::one(range.primary);
            range == prefers
        });
        if is_at_end && pressed(Key::ArrowRight) {
            Self::Complete
        } else {
            Self::Nothing
        }
    }
}

/// The folder of the typed text, and the rest after its last `/`.
fn split(text: &str) -> (PathBuf, &str) {
    match text.rfind('/') {
        Some(at) => (paths::whole(&text[..=at]), &text[at + 1..]),
        None => (paths::home(), text),
    }
}

fn as_typed(entry: &Entry) -> String {
    if entry.is_folder {
        format!("{}/", entry.name)
    } else {
        entry.name.clone()
    }
}

/// The longest beginning of all names; whole where there is but one.
fn common_start(entries: &[Entry]) -> String {
    let Some((first, rest)) = entries.split_first() else {
        return String::new();
    };
    let mut common = as_typed(first);
    for entry in rest {
        let name = as_typed(entry);
        let same = common
            .char_indices()
            .zip(name.chars())
            .find(|((_, a), b)| a.to_lowercase().ne(b.to_lowercase()))
            .map_or(common.len().min(name.len()), |((at, _), _)| at);
        let whole = (0..=same).rev().find(|at| common.is_char_boundary(*at));
        common.truncate(whole.unwrap_or(0));
    }
    common
}

/// A row of the list. It takes clicks but not the keyboard, which stays in the field.
fn row(
    ui: &mut Ui,
    entry: &Entry,
    is_marked: bool,
    picture: Option<(&mut Pictures, &Path)>,
) -> Response {
    let mut height = ui.text_style_height(&TextStyle::Body) + 6.0;
    if picture.is_some() && !entry.is_folder {
        height = height.max(PICTURE.y + 4.0);
    }
    let (area, response) = ui.allocate_exact_size(vec2(ui.available_width(), height), Sense::CLICK);
    let label = as_typed(entry);
    response
        .widget_info(|| WidgetInfo::selected(Role::ListBoxOption, true, is_marked, label.clone()));
    let visuals = ui.style().interact_selectable(&response, is_marked);
    if is_marked || response.hovered() {
        ui.painter().rect_filled(area, 3.0, visuals.weak_bg_fill);
    }
    let mut inner = area.shrink2(vec2(6.0, 0.0));
    if let Some((pictures, path)) = picture {
        let place = Align2::LEFT_CENTER.align_size_within_rect(PICTURE, inner);
        if !entry.is_folder {
            pictures.draw(ui, place, path);
        }
        inner.min.x += PICTURE.x + 8.0;
    }
    let font = TextStyle::Body.resolve(ui.style());
    let small = TextStyle::Small.resolve(ui.style());
    let weak = ui.visuals().weak_text_color();
    let aged = ui.painter().text(
        inner.right_center(),
        Align2::RIGHT_CENTER,
        &entry.age,
        small,
        weak,
    );
    let room = (aged.left() - inner.left() - 8.0).max(20.0);
    let mut job =
        eframe::egui::text::LayoutJob::simple_singleline(label, font, visuals.text_color());
    job.wrap = eframe::egui::text::TextWrapping::truncate_at_width(room);
    let galley = ui.painter().layout_job(job);
    let at = inner.left_center() - vec2(0.0, 0.5 * galley.size().y);
    ui.painter().galley(at, galley, visuals.text_color());
    response
}

#[cfg(test)]
mod tests {
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable as _;

    use super::*;

    fn entry(name: &str, is_folder: bool) -> Entry {
        Entry {
            name: name.to_owned(),
            is_folder,
            age: String::new(),
        }
    }

    struct Chosen {
        browser: Browser,
        taken: Vec<PathBuf>,
    }

    fn harness(purpose: Purpose) -> Harness<'static, Chosen> {
        let kinds = &[paths::PAINTING];
        let entries = vec![
            entry("studies", true),
            entry("Sea at dawn.maul", false),
            entry("Sea at dusk.maul", false),
        ];
        let chosen = Chosen {
            browser: Browser::at("/p/", purpose, kinds).listing(entries, kinds),
            taken: Vec::new(),
        };
        let show = |ui: &mut Ui, chosen: &mut Chosen| {
            let taken = chosen.browser.show(ui, "File");
            chosen.taken.extend(taken);
        };
        let mut harness = Harness::builder()
            .with_size([420.0, 300.0])
            .build_ui_state(show, chosen);
        harness.get_by_label("File").focus();
        harness.run();
        harness
    }

    #[test]
    fn what_is_typed_is_completed_and_taken_by_keys_alone() {
        let mut harness = harness(Purpose::Read);
        harness.get_by_label("File").type_text("sea");
        harness.run();
        assert!(harness.query_by_label("studies/").is_none());
        harness.key_press(Key::ArrowRight);
        harness.run();
        assert_eq!(harness.state().browser.text(), "/p/Sea at d");
        for key in [Key::ArrowDown, Key::ArrowDown, Key::ArrowDown, Key::Enter] {
            harness.key_press(key);
            harness.run();
        }
        let taken = [PathBuf::from("/p/Sea at dusk.maul")];
        assert_eq!(harness.state().taken, taken);
    }

    #[test]
    fn a_click_writes_a_file_and_goes_into_a_folder() {
        let mut harness = harness(Purpose::Read);
        harness.get_by_label("Sea at dawn.maul").click();
        harness.run();
        assert_eq!(harness.state().browser.text(), "/p/Sea at dawn.maul");
        assert!(harness.state().taken.is_empty());
        let browser = &mut harness.state_mut().browser;
        browser.set("/p/".to_owned());
        harness.run();
        harness.get_by_label("studies/").click();
        harness.run_steps(2);
        assert_eq!(harness.state().browser.text(), "/p/studies/");
    }

    #[test]
    fn a_name_that_is_not_there_is_taken_to_be_written() {
        for (purpose, listed) in [(Purpose::Write, true), (Purpose::Read, false)] {
            let mut harness = harness(purpose);
            harness.get_by_label("File").type_text("moor.maul");
            harness.run();
            let is_listed = harness.query_by_label("studies/").is_some();
            assert_eq!(is_listed, listed);
            harness.key_press(Key::Enter);
            harness.run();
            assert_eq!(harness.state().taken, [PathBuf::from("/p/moor.maul")]);
        }
    }

    #[test]
    fn names_agree_as_far_as_they_do() {
        assert_eq!(common_start(&[]), "");
        assert_eq!(common_start(&[entry("a", true)]), "a/");
        let two = [entry("Öl auf Holz", false), entry("öl auf Pappe", false)];
        assert_eq!(common_start(&two), "Öl auf ");
    }
}
