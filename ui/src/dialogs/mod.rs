//! Files in the window: new, open, save, save as, export, dropped files. Nothing is sent twice, and the desk stays
//! usable while an answer is pending.
//!
//! | module | holds |
//! | --- | --- |
//! | `dialog`, `browser`, `paths` | parts of dialogs: frame, file chooser with the listing of a folder, paths |
//! | `new`, `open`, `save_as`, `export`, `choose` | one dialog each |
//! | `close` | asks before the window closes on a painting without a name |
//! | `sketch_offer` | earlier sketches |
//! | `dropped` | files dropped on the window |
//! | `painting_file` | proposed folder and name, and the result of a command |
//! | `save_status` | line at the lower edge |

mod browser;
mod choose;
mod close;
pub(crate) mod dialog;
mod dropped;
mod export;
mod new;
mod open;
mod painting_file;
pub(crate) mod paths;
mod save_as;
mod save_status;
mod sketch_offer;

use std::path::{Path, PathBuf};
use std::task::Poll;

use eframe::egui::Context;
use maulstick_rig::Sketches;
use maulstick_types::command::{Command, FileCommand, RigCommand};
use maulstick_ui_kit::background_task::BackgroundTask;
use maulstick_ui_kit::language::translated;

use choose::ChooseFile;
use close::{ClosePainting, Decision};
use dialog::fault::named;

use crate::advice;
use crate::input::keys::Action;
use crate::panels::light::environment_file::EnvironmentFile;
use crate::reference::Reference;
use crate::rig::state::RigState;
use crate::sessions::SessionOrder;
use crate::widgets::context::PanelContext;
pub(crate) use dialog::wrong;
use dialog::{Answer, in_words};
use dropped::Dropped;
use export::ExportPicture;
use maulstick_client::dispatcher::Outcome;
use maulstick_client::request::Request;
use new::NewPainting;
use open::OpenPainting;
use open::discard_prompt::UnsavedState;
use open::recent::RecentList;
use painting_file::{done, folder, stem, switches};
use save_as::SaveAs;
use sketch_offer::{Choice, SketchOffer};

/// A dialog that is open.
#[derive(Debug)]
enum Dialog {
    New(NewPainting),
    Open(OpenPainting),
    SaveAs(SaveAs),
    Export(ExportPicture),
    Picture(ChooseFile),
    Tracing(ChooseFile),
    Environment(ChooseFile),
    Recording(ChooseFile),
    Close(ClosePainting),
}

/// Files in the window.
#[derive(Debug, Default)]
pub(crate) struct Files {
    dialog: Option<Dialog>,
    /// The open dialog's request, until it is answered.
    waiting: Option<Request>,
    /// A dropped file that is being examined.
    dropping: Option<BackgroundTask<Dropped>>,
    environment: EnvironmentFile,
    /// The painting that was last seen to be open.
    open: Option<PathBuf>,
    offer: SketchOffer,
    /// True once the painter has agreed to close the window.
    closes: bool,
}

impl Files {
    /// True while a dialog has the keyboard.
    #[must_use]
    pub(crate) fn is_open(&self) -> bool {
        self.dialog.is_some()
    }

    /// True if the window may close now; otherwise the painter is asked.
    pub(crate) fn may_close(&mut self, rig: &RigState) -> bool {
        if self.closes {
            return true;
        }
        match ClosePainting::of(rig) {
            None => true,
            Some(ask) => {
                self.begin(Dialog::Close(ask));
                false
            }
        }
    }

    /// True once the painter has agreed to close the window.
    #[must_use]
    pub(crate) fn closes(&self) -> bool {
        self.closes
    }

    /// Does the action of a key; `false` if it is not about files.
    pub(crate) fn follow(
        &mut self,
        context: &Context,
        act: Action,
        work: &mut PanelContext<'_>,
    ) -> bool {
        match act {
            Action::New => {
                let unkept = UnsavedState::of(work.rig);
                let new = NewPainting::new(&folder(work), work.preferences.window.units, unkept);
                self.begin(Dialog::New(new));
            }
            Action::Open => {
                let open = self.choose(context, work);
                self.begin(Dialog::Open(open));
            }
            Action::Save => self.save(work),
            Action::SaveAs => self.save_as(work),
            Action::Export => {
                let export = ExportPicture::new(&folder(work), &stem(work));
                self.begin(Dialog::Export(export));
            }
            Action::Play => self.choose_recording(None, work),
            Action::Reference => {
                let known = work.preferences.reference.path.as_deref();
                let choose = Self::picture(known, tr!("Pin a reference picture"), work);
                self.begin(Dialog::Picture(choose));
            }
            Action::ChooseTracing => {
                let known = work.tracing().map(|tracing| &*tracing.path);
                let choose = Self::picture(known, tr!("A picture to trace"), work);
                self.begin(Dialog::Tracing(choose));
            }
            _ => return false,
        }
        true
    }

    fn begin(&mut self, dialog: Dialog) {
        self.dialog = Some(dialog);
        self.waiting = None;
    }

    fn choose(&self, context: &Context, work: &PanelContext<'_>) -> OpenPainting {
        let open = self.open.as_deref().unwrap_or(Path::new(""));
        let recent = RecentList::new(context, &work.preferences.recent, open);
        let sketches = work.rig.sketches.as_ref();
        OpenPainting::new(&folder(work), recent, UnsavedState::of(work.rig))
            .with_sketches(sketches.map(Sketches::folder))
    }

    /// The dialog for a picture: beside the known one, else beside the painting.
    fn picture(known: Option<&Path>, title: &'static str, work: &PanelContext<'_>) -> ChooseFile {
        let known = known
            .and_then(Path::parent)
            .filter(|folder| folder.is_dir());
        let folder = known.map_or_else(|| folder(work), Path::to_owned);
        ChooseFile::picture(&folder, title)
    }

    /// Asks for a recording to play, and proposes the known one.
    fn choose_recording(&mut self, known: Option<&Path>, work: &mut PanelContext<'_>) {
        if work.rig.replay.is_some() {
            work.notifications.fault(
                tr!("A recording is being played."),
                tr!("End that first: its bar has a button."),
            );
            return;
        }
        let mut choose = ChooseFile::recording(&folder(work), UnsavedState::of(work.rig));
        known.iter().for_each(|path| choose.propose(path));
        self.begin(Dialog::Recording(choose));
    }

    fn save(&mut self, work: &mut PanelContext<'_>) {
        let Some(node) = &work.rig.live.paint else {
            work.notifications.fault(
                tr!("the painting is not loaded yet"),
                tr!("wait until the painting engine has restarted"),
            );
            return;
        };
        match (node.status.path.as_str(), node.status.all_committed) {
            ("", _) => self.save_as(work),
            _ if work.rig.is_sketch() => self.save_as(work),
            (path, all) => {
                let file = paths::shown(Path::new(path));
                work.notifications.note(if all {
                    tr!("Saved to {file}", file)
                } else {
                    tr!("Saving to {file} …", file)
                });
            }
        }
    }

    fn save_as(&mut self, work: &PanelContext<'_>) {
        let save_as = SaveAs::new(&folder(work), &stem(work));
        self.begin(Dialog::SaveAs(save_as));
    }

    /// Shows the open dialog, and handles dropped files.
    pub(crate) fn show(
        &mut self,
        context: &Context,
        reference: &mut Reference,
        work: &mut PanelContext<'_>,
    ) {
        self.remember(work);
        self.take_dropped(context, reference, work);
        self.environment.take_in(work);
        if work.requests.takes_environment() {
            let choose = Self::picture(None, tr!("A picture of the surroundings"), work);
            self.begin(Dialog::Environment(choose));
        }
        dropped::hint(context);
        if let Some(act) = save_status::show(context, work) {
            self.follow(context, act, work);
        }
        export::progress::show(context, work);
        if self.dialog.is_none() {
            self.offer_sketches(context, work);
        }
        self.show_dialog(context, reference, work);
    }

    fn offer_sketches(&mut self, context: &Context, work: &mut PanelContext<'_>) {
        match self.offer.show(context, work.rig) {
            Some(Choice::Open(path)) => self.open_path(context, &path, work),
            Some(Choice::All) => {
                let mut open = self.choose(context, work);
                open.list_sketches();
                self.begin(Dialog::Open(open));
            }
            None => {}
        }
    }

    fn show_dialog(
        &mut self,
        context: &Context,
        reference: &mut Reference,
        work: &mut PanelContext<'_>,
    ) {
        let busy = self.waiting.is_some();
        let Some(dialog) = &mut self.dialog else {
            return;
        };
        let (answer, command) = match dialog {
            Dialog::New(new) => new.show(context, busy),
            Dialog::Open(open) => open.show(context, busy),
            Dialog::SaveAs(save_as) => save_as.show(context, busy),
            Dialog::Export(export) => export.show(context, busy),
            Dialog::Close(close) => {
                let decision = close.show(context);
                return self.decide(decision, work);
            }
            Dialog::Picture(choose)
            | Dialog::Tracing(choose)
            | Dialog::Environment(choose)
            | Dialog::Recording(choose) => {
                let (answer, path) = choose.show(context);
                let forget = choose.forgets();
                if let Some(path) = path {
                    return self.take(context, (path, forget), reference, work);
                }
                (answer, None)
            }
        };
        match (answer, command) {
            (Answer::Leave, _) => (self.dialog, self.waiting) = (None, None),
            (_, Some(command)) => {
                // An export runs in the background and shows its progress.
                let is_export = matches!(command, Command::File(FileCommand::Export(_)));
                let order = ask(command, work);
                if is_export {
                    self.dialog = None;
                } else {
                    self.waiting = Some(order);
                }
            }
            _ => {}
        }
    }

    /// Takes the file that was chosen; `forget` where the painting on the easel may go.
    fn take(
        &mut self,
        context: &Context,
        (path, forget): (PathBuf, bool),
        reference: &mut Reference,
        work: &mut PanelContext<'_>,
    ) {
        match self.dialog.take() {
            Some(Dialog::Picture(_)) => reference.pin(context, &path, work.preferences),
            Some(Dialog::Tracing(_)) => work.trace(&path),
            Some(Dialog::Environment(_)) => self.environment.read(context, path),
            _ => work.requests.session(SessionOrder::Play {
                recording: path,
                forget,
            }),
        }
    }

    /// Closes the window, or stays, as the painter has decided.
    fn decide(&mut self, decision: Decision, work: &mut PanelContext<'_>) {
        match decision {
            Decision::None => {}
            Decision::Stay => self.dialog = None,
            Decision::Name => self.save_as(work),
            Decision::Close => (self.dialog, self.closes) = (None, true),
        }
    }

    /// Handles the outcome of a request; `false` if it was not about files.
    pub(crate) fn on_reply(&mut self, outcome: &Outcome, work: &mut PanelContext<'_>) -> bool {
        let Request::Command { command, .. } = &outcome.request else {
            return false;
        };
        let Some(done) = done(command) else {
            return false;
        };
        let is_waited_for = self.waiting.as_ref() == Some(&outcome.request);
        if switches(command) {
            work.rig.switching = false;
        }
        match &outcome.result {
            Ok(detail) => {
                self.move_tracing(command, work);
                // Some answers contain only the path, which is shown already.
                let said = detail.to_string();
                let is_told = done.contains(&paths::shown(Path::new(&said)));
                let sentence = (!is_told).then(|| in_words(&said, ""));
                let sentence = sentence.unwrap_or_default();
                work.notifications
                    .note(format!("{done} {sentence}").trim().to_owned());
                if is_waited_for {
                    (self.dialog, self.waiting) = (None, None);
                }
            }
            Err(error) if is_waited_for => {
                let fault = advice::worded(error);
                let words = in_words(&fault.what, fault.help.as_deref().unwrap_or_default());
                self.waiting = None;
                match &mut self.dialog {
                    Some(Dialog::New(new)) => new.refused(words),
                    Some(Dialog::Open(open)) => open.refused(words),
                    Some(Dialog::SaveAs(save_as)) => save_as.refused(words),
                    Some(
                        Dialog::Export(_)
                        | Dialog::Close(_)
                        | Dialog::Picture(_)
                        | Dialog::Tracing(_)
                        | Dialog::Environment(_)
                        | Dialog::Recording(_),
                    )
                    | None => work.notifications.of(&fault),
                }
            }
            Err(error) => work.notifications.of(&advice::worded(error)),
        }
        true
    }

    /// The tracing picture goes with a painting that is saved elsewhere, and not with the next sketch.
    fn move_tracing(&self, done: &Command, work: &mut PanelContext<'_>) {
        match done {
            Command::Rig(RigCommand::SaveAs(save_as))
            | Command::File(FileCommand::SaveAs(save_as)) => {
                let before = self.open.as_ref().map(|path| path.to_string_lossy());
                work.carry_tracing(&before.unwrap_or_default(), &save_as.path);
            }
            Command::Rig(RigCommand::New { path: None, .. }) => work.forget_sketch(),
            _ => {}
        }
    }

    /// Remembers which paintings were open.
    fn remember(&mut self, work: &mut PanelContext<'_>) {
        let Some(node) = &work.rig.live.paint else {
            return;
        };
        // Empty for one in memory: the one before is no longer open then.
        let path = PathBuf::from(&node.status.path);
        if self.open.as_ref() != Some(&path) {
            if !path.as_os_str().is_empty() && !work.rig.is_sketch() {
                work.preferences.opened(&path);
            }
            self.open = Some(path);
        }
    }

    fn take_dropped(
        &mut self,
        context: &Context,
        reference: &mut Reference,
        work: &mut PanelContext<'_>,
    ) {
        let files = context.input(|input| input.raw.dropped_files.clone());
        if let Some(first) = files.first() {
            if files.len() > 1 {
                let what = tr!("{count} files were dropped", count = files.len());
                work.notifications.fault(what, tr!("drop one at a time"));
            } else {
                let path = first.path().to_owned();
                let look = move || dropped::found(&path);
                self.dropping = Some(BackgroundTask::start(context, "dropped", look));
            }
        }
        let Some(task) = &self.dropping else {
            return;
        };
        let found = match task.poll() {
            Poll::Pending => return,
            Poll::Ready(found) => found,
        };
        self.dropping = None;
        match found {
            Some(Dropped::Painting(path)) => self.open_path(context, &path, work),
            Some(Dropped::Picture(path)) => reference.pin(context, &path, work.preferences),
            Some(Dropped::Recording(path)) => self.choose_recording(Some(&path), work),
            Some(Dropped::Brush(file)) => work.take_up(*file),
            Some(Dropped::Nothing { what, help }) => work.notifications.fault(what, help),
            None => work.notifications.fault(
                tr!("the dropped file cannot be read"),
                translated(dropped::KINDS),
            ),
        }
    }

    /// Opens a painting without a dialog, unless there is something to ask.
    fn open_path(&mut self, context: &Context, path: &Path, work: &mut PanelContext<'_>) {
        if let Err(fault) = UnsavedState::of(work.rig).check() {
            let mut open = self.choose(context, work);
            open.propose(path);
            open.refused(fault.to_string());
            self.begin(Dialog::Open(open));
            return;
        }
        work.notifications
            .note(tr!("Opening {file} …", file = paths::name(path)));
        let forget = false;
        match named(path) {
            Ok(path) => drop(ask(RigCommand::Open { path, forget }.into(), work)),
            Err(fault) => work.notifications.fault(fault.to_string(), String::new()),
        }
    }
}

/// Sends a command about files to its node.
fn ask(command: Command, work: &mut PanelContext<'_>) -> Request {
    work.rig.switching |= switches(&command);
    work.requests.send(command.clone());
    Request::of(command)
}

#[cfg(test)]
mod tests;
