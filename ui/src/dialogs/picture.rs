//! Dialog for a picture to look at or to trace.

use std::path::{Path, PathBuf};

use eframe::egui::Context;

use crate::dialogs::browser::{Browser, Purpose};
use crate::dialogs::dialog::{self, Answer, Foot};
use crate::dialogs::paths;

/// A picture that is being chosen.
#[derive(Debug)]
pub(crate) struct ChoosePicture {
    title: &'static str,
    browser: Browser,
    wrong: Option<String>,
}

impl ChoosePicture {
    /// One of `folder`; `title` says what it is for.
    #[must_use]
    pub(crate) fn new(folder: &Path, title: &'static str) -> Self {
        let begin = format!("{}/", paths::shown(folder).trim_end_matches('/'));
        Self {
            title,
            browser: Browser::at(&begin, Purpose::Read, &paths::PICTURES),
            wrong: None,
        }
    }

    /// Shows the dialog; the picture that was chosen.
    pub(crate) fn show(&mut self, context: &Context) -> (Answer, Option<PathBuf>) {
        let mut taken = None;
        let answer = dialog::show(context, self.title, |ui| {
            taken = self.browser.show(ui, tr!("Picture"));
            Foot {
                go: tr!("Open"),
                wrong: self.wrong.clone(),
                entered: taken.is_some(),
                busy: None,
            }
        });
        if answer != Answer::Go {
            return (answer, None);
        }
        let path = taken.unwrap_or_else(|| self.browser.path());
        if path.is_file() {
            return (answer, Some(path));
        }
        self.wrong = Some(tr!(
            "{file} is no file. Choose a PNG, JPEG or TIFF of the list.",
            file = paths::shown(&path)
        ));
        (Answer::Stay, None)
    }
}
