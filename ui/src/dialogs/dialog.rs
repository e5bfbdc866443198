//! The frame of a dialog: title, questions, errors, two buttons. Enter confirms, Escape cancels. `fault` says what is
//! wrong with what is written in one.

use eframe::egui::text_edit::TextEditState;
use eframe::egui::{
    Align, Color32, Context, Frame, Id, Key, Layout, Margin, Modal, RichText, Ui, Visuals,
};

use fault::DialogFault;

pub(crate) mod fault;

/// Width of a dialog, points.
pub(crate) const WIDTH: f32 = 420.0;

/// The lower part of a dialog: error, buttons, pending request.
#[derive(Debug, Default)]
pub(crate) struct Foot {
    /// Label of the confirming button.
    pub go: &'static str,
    /// The error, with advice.
    pub wrong: Option<String>,
    /// True if Enter was pressed to confirm.
    pub entered: bool,
    /// The pending work; it cannot be started twice.
    pub busy: Option<&'static str>,
    /// Request for the missing choice, where nothing can be confirmed yet.
    pub lacks: Option<&'static str>,
}

/// Decision of the painter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Answer {
    /// The dialog stays open.
    Stay,
    /// The dialog is cancelled.
    Leave,
    /// The dialog is confirmed.
    Go,
}

/// The control that has the keyboard when a dialog opens.
#[must_use]
pub(crate) fn first() -> Id {
    Id::unique("first of the dialog")
}

/// Colour of faults.
#[must_use]
pub(crate) fn wrong(visuals: &Visuals) -> Color32 {
    if visuals.dark_mode {
        Color32::from_rgb(240, 150, 90)
    } else {
        Color32::from_rgb(166, 62, 0)
    }
}

pub(crate) fn show(
    context: &Context,
    title: &str,
    content: impl FnOnce(&mut Ui) -> Foot,
) -> Answer {
    let frame = Frame::window(&context.global_style()).inner_margin(Margin::same(16));
    let modal = Modal::new(Id::unique("dialog"))
        .frame(frame)
        .show(context, |ui| {
            ui.set_width(WIDTH);
            ui.heading(RichText::new(title).strong());
            ui.add_space(8.0);
            let foot = content(ui);
            ui.add_space(8.0);
            below(ui, &foot)
        });
    let answer = match modal.inner {
        Answer::Stay if modal.should_close() => Answer::Leave,
        answer => answer,
    };
    // A dialog without the keyboard could not be left by it.
    if context.memory(|memory| memory.focused().is_none()) {
        context.memory_mut(|memory| memory.request_focus(first()));
        // Typed text is appended, wherever the cursor was in another dialog.
        TextEditState::default().store(context, first());
    }
    answer
}

/// The request, once the painter confirms; on an error the dialog stays and shows it.
pub(crate) fn decided<T>(
    answer: Answer,
    asked: Option<Result<T, DialogFault>>,
    wrong: &mut Option<String>,
) -> (Answer, Option<T>) {
    match asked {
        None => (answer, None),
        Some(Ok(asked)) => {
            *wrong = None;
            (answer, Some(asked))
        }
        Some(Err(fault)) => {
            *wrong = Some(fault.to_string());
            (Answer::Stay, None)
        }
    }
}

fn below(ui: &mut Ui, foot: &Foot) -> Answer {
    if let Some(wrong_words) = &foot.wrong {
        let colour = wrong(ui.visuals());
        ui.label(RichText::new(wrong_words).color(colour));
        ui.add_space(4.0);
    }
    let can = foot.busy.is_none() && foot.lacks.is_none();
    let mut answer = if foot.entered && can {
        Answer::Go
    } else {
        Answer::Stay
    };
    ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
        let go = RichText::new(foot.go).strong();
        let button = eframe::egui::Button::new(go).min_size([96.0, 28.0].into());
        let mut go = ui.add_enabled(can, button);
        if let Some(lacks) = foot.lacks {
            go = go.on_disabled_hover_text(lacks);
        }
        if go.clicked() {
            answer = Answer::Go;
        }
        let cancel = eframe::egui::Button::new(tr!("Cancel")).min_size([80.0, 28.0].into());
        if ui.add(cancel).clicked() {
            answer = Answer::Leave;
        }
        if let Some(busy) = foot.busy {
            ui.spinner();
            ui.label(busy);
        }
    });
    answer
}

/// A line of text with its label; the first of a dialog has the keyboard when it opens. Returns true if Enter was
/// pressed in it.
pub(crate) fn line(
    ui: &mut Ui,
    label: &str,
    text: &mut String,
    is_first: bool,
    width: f32,
) -> bool {
    let name = ui.label(label);
    let mut edit = eframe::egui::TextEdit::singleline(text).desired_width(width);
    if is_first {
        edit = edit.id(first());
    }
    let response = ui.add(edit).labelled_by(name.id);
    response.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter))
}

/// Error and advice of a node in a painter's words.
#[must_use]
pub(crate) fn in_words(what: &str, help: &str) -> String {
    let sentence = |text: &str| {
        let mut letters = text.trim().chars();
        let Some(first) = letters.next() else {
            return String::new();
        };
        let end = if text.trim_end().ends_with(['.', '!', '?']) {
            ""
        } else {
            "."
        };
        format!("{}{}{end}", first.to_uppercase(), letters.as_str())
    };
    format!("{} {}", sentence(what), sentence(help))
        .trim()
        .to_owned()
}
