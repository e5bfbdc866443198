//! Dialog that moves the painting to another file, where it continues.

use std::path::{Path, PathBuf};

use eframe::egui::Context;
use maulstick_types::command::{self, Command, RigCommand};

use crate::dialogs::browser::{Browser, Purpose};
use crate::dialogs::dialog::fault::{DialogFault, named, writable};
use crate::dialogs::dialog::{self, Answer, Foot};
use crate::dialogs::open::PAINTINGS;
use crate::dialogs::paths;

/// A file that is being chosen.
#[derive(Debug)]
pub(crate) struct SaveAs {
    browser: Browser,
    /// The painting that was found in its place, and whether it may go.
    found: Option<(PathBuf, bool)>,
    wrong: Option<String>,
}

impl SaveAs {
    /// Begins with an unused name in `folder`, starting with `stem`.
    #[must_use]
    pub(crate) fn new(folder: &Path, stem: &str) -> Self {
        Self::at(paths::shown(&paths::free(folder, stem, paths::PAINTING)))
    }

    fn at(path: String) -> Self {
        Self {
            browser: Browser::at(&path, Purpose::Write, PAINTINGS),
            found: None,
            wrong: None,
        }
    }

    /// The dialog with a folder whose entries are known.
    #[cfg(test)]
    pub(crate) fn with(mut self, browser: Browser) -> Self {
        self.browser = browser;
        self
    }

    /// Shows the rig's refusal.
    pub(crate) fn refused(&mut self, words: String) {
        self.wrong = Some(words);
    }

    fn command(&mut self, path: &Path) -> Result<Command, DialogFault> {
        let path = writable(path, paths::PAINTING)?;
        let may_go = |(found, may_go): &(PathBuf, bool)| *found == path && *may_go;
        let replace = self.found.as_ref().is_some_and(may_go);
        if path.exists() && !replace {
            self.found = Some((path.clone(), false));
            return Err(DialogFault::Replaces(path));
        }
        let path = named(&path)?;
        Ok(RigCommand::SaveAs(command::SaveAs { path, replace }).into())
    }

    pub(crate) fn show(&mut self, context: &Context, busy: bool) -> (Answer, Option<Command>) {
        let mut taken = None;
        let answer = dialog::show(context, tr!("Save under another name"), |ui| {
            ui.weak(tr!(
                "History and versions are kept, and painting continues in the new file."
            ));
            ui.add_space(4.0);
            taken = self.browser.show(ui, tr!("File"));
            let now = paths::ending_in(&self.browser.path(), paths::PAINTING);
            if let Some((found, may_go)) = &mut self.found
                && *found == now
            {
                let words = tr!("Replace the painting {file}", file = paths::name(found));
                ui.add_space(6.0);
                ui.checkbox(may_go, words);
            }
            Foot {
                go: tr!("Save"),
                wrong: self.wrong.clone(),
                entered: taken.is_some(),
                busy: busy.then_some(tr!("Writing …")),
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
