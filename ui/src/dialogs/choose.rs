//! Dialog for a file of the user: a picture to look at or to trace, a recording to play.

use std::path::{Path, PathBuf};

use eframe::egui::Context;
use maulstick_exchange::PictureKind;

use crate::dialogs::browser::{Browser, Purpose};
use crate::dialogs::dialog::fault::DialogFault;
use crate::dialogs::dialog::{self, Answer, Foot};
use crate::dialogs::open::discard_prompt::UnsavedState;
use crate::dialogs::paths;
use crate::sessions::RECORDING;

/// A kind of file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Picture,
    Recording,
}

/// A file that is being chosen.
#[derive(Debug)]
pub(crate) struct ChooseFile {
    kind: Kind,
    title: &'static str,
    browser: Browser,
    /// Unsaved state that a recording would replace.
    unkept: UnsavedState,
    wrong: Option<String>,
}

impl ChooseFile {
    /// A picture of `folder`; `title` is its purpose.
    #[must_use]
    pub(crate) fn picture(folder: &Path, title: &'static str) -> Self {
        Self {
            kind: Kind::Picture,
            title,
            browser: Browser::at(&begin(folder), Purpose::Read, &PictureKind::ENDINGS),
            unkept: UnsavedState::default(),
            wrong: None,
        }
    }

    /// A recording of `folder`, which is painted in another painting than the one on the easel.
    #[must_use]
    pub(crate) fn recording(folder: &Path, unkept: UnsavedState) -> Self {
        Self {
            kind: Kind::Recording,
            title: tr!("Play a recording"),
            browser: Browser::at(&begin(folder), Purpose::Read, &[RECORDING]),
            unkept,
            wrong: None,
        }
    }

    /// Writes a path into the field, as if it had been typed.
    pub(crate) fn propose(&mut self, path: &Path) {
        self.browser.set(paths::shown(path));
    }

    /// True if the painter agrees to discard the painting on the easel.
    #[must_use]
    pub(crate) fn forgets(&self) -> bool {
        self.unkept.let_go()
    }

    /// Shows the dialog; the file that was chosen.
    pub(crate) fn show(&mut self, context: &Context) -> (Answer, Option<PathBuf>) {
        let mut taken = None;
        let answer = dialog::show(context, self.title, |ui| {
            let (name, go) = match self.kind {
                Kind::Picture => (tr!("Picture"), tr!("Open")),
                Kind::Recording => (tr!("Recording"), tr!("Play")),
            };
            taken = self.browser.show(ui, name);
            self.unkept.show(ui);
            Foot {
                go,
                wrong: self.wrong.clone(),
                entered: taken.is_some(),
                ..Foot::default()
            }
        });
        let chosen = (answer == Answer::Go).then(|| {
            let path = taken.unwrap_or_else(|| self.browser.path());
            self.check(path)
        });
        dialog::decided(answer, chosen, &mut self.wrong)
    }

    fn check(&self, path: PathBuf) -> Result<PathBuf, DialogFault> {
        self.unkept.check()?;
        match self.kind {
            _ if path.is_file() => Ok(path),
            Kind::Picture => Err(DialogFault::NoPicture(path)),
            Kind::Recording => Err(DialogFault::NoRecording(path)),
        }
    }
}

/// Initial text of the field.
fn begin(folder: &Path) -> String {
    format!("{}/", paths::shown(folder).trim_end_matches('/'))
}
