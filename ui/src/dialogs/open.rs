//! Dialog that opens another painting.

pub(super) mod discard_prompt;
pub(super) mod recent;

use std::path::{Path, PathBuf};

use eframe::egui::Context;
use maulstick_types::command::{Command, RigCommand};

use crate::dialogs::browser::{Browser, Purpose};
use crate::dialogs::dialog::fault::{DialogFault, named};
use crate::dialogs::dialog::{self, Answer, Foot};
use crate::dialogs::open::discard_prompt::UnsavedState;
use crate::dialogs::open::recent::RecentList;
use crate::dialogs::paths;

/// File endings of paintings.
pub(super) const PAINTINGS: &[&str] = &[paths::PAINTING];

/// A painting that is being chosen.
#[derive(Debug)]
pub(crate) struct OpenPainting {
    recent: RecentList,
    browser: Browser,
    unkept: UnsavedState,
    /// The folder of the sketches, if there is one.
    sketches: Option<PathBuf>,
    wrong: Option<String>,
}

impl OpenPainting {
    /// A painting of `folder`, or a recent one.
    #[must_use]
    pub(crate) fn new(folder: &Path, recent: RecentList, unkept: UnsavedState) -> Self {
        let shown = paths::shown(folder);
        let begin = format!("{}/", shown.trim_end_matches('/'));
        Self {
            recent,
            browser: Browser::at(&begin, Purpose::Read, PAINTINGS).with_pictures(),
            unkept,
            sketches: None,
            wrong: None,
        }
    }

    /// Also leads to the sketches, which are in this folder.
    #[must_use]
    pub(crate) fn with_sketches(mut self, folder: Option<&Path>) -> Self {
        self.sketches = folder.filter(|folder| folder.is_dir()).map(Path::to_owned);
        self
    }

    pub(crate) fn list_sketches(&mut self) {
        if let Some(folder) = &self.sketches {
            self.browser.set(format!("{}/", paths::shown(folder)));
        }
    }

    /// Shows the rig's refusal.
    pub(crate) fn refused(&mut self, words: String) {
        self.wrong = Some(words);
    }

    /// Writes a path into the field, as if it had been typed.
    pub(crate) fn propose(&mut self, path: &Path) {
        self.browser.set(paths::shown(path));
    }

    /// The dialog with a folder whose entries are known.
    #[cfg(test)]
    pub(crate) fn with(mut self, browser: Browser) -> Self {
        self.browser = browser.with_pictures();
        self
    }

    fn command(&self, path: &Path) -> Result<Command, DialogFault> {
        self.unkept.check()?;
        if path.is_dir() {
            return Err(DialogFault::Folder);
        }
        if !path.exists() {
            return Err(DialogFault::NoPainting(path.to_owned()));
        }
        Ok(RigCommand::Open {
            path: named(path)?,
            forget: self.unkept.let_go(),
        }
        .into())
    }

    pub(crate) fn show(&mut self, context: &Context, busy: bool) -> (Answer, Option<Command>) {
        let mut taken: Option<PathBuf> = None;
        let answer = dialog::show(context, tr!("Open a painting"), |ui| {
            taken = self.recent.show(ui, self.browser.pictures());
            if taken.is_some() {
                taken
                    .iter()
                    .for_each(|path| self.browser.set(paths::shown(path)));
            }
            if self.sketches.is_some() && ui.button(tr!("Sketches")).clicked() {
                self.list_sketches();
            }
            let typed = self.browser.show(ui, tr!("File"));
            taken = taken.take().or(typed);
            self.unkept.show(ui);
            Foot {
                go: tr!("Open"),
                wrong: self.wrong.clone(),
                entered: taken.is_some(),
                busy: busy.then_some(tr!("Opening …")),
                ..Foot::default()
            }
        });
        let asked = (answer == Answer::Go).then(|| {
            let path = taken.unwrap_or_else(|| self.browser.path());
            self.command(&path)
        });
        dialog::decided(answer, asked, &mut self.wrong)
    }
}

#[cfg(test)]
mod tests;
