//! Actions of keys, and the keys that they have unless the painter chose others.

use eframe::egui::{Context, Key, KeyboardShortcut, Modifiers};
use maulstick_ui_kit::language;
use serde::{Deserialize, Serialize};

/// Action of a key.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Action {
    New,
    Open,
    /// Save, and confirm that all is saved.
    Save,
    /// The painting under another name.
    SaveAs,
    /// A picture of it for other programs.
    Export,
    /// Record the session, or end that.
    Record,
    Play,
    /// Choose a motion, and put it on the canvas.
    Motions,
    /// Show or hide the reference picture beside the canvas.
    Reference,
    /// Choose a picture to trace on the canvas.
    ChooseTracing,
    /// Show or hide it.
    Tracing,
    /// The newest step back.
    Undo,
    /// The newest undo back.
    Redo,
    Smaller,
    Larger,
    /// The next brush of the rack.
    NextBrush,
    /// The brush is loaded with the mixture under it.
    LoadFrom,
    /// Wet paint is scraped off the palette.
    Scrape,
    /// The mouse's brush turned to the left.
    TurnLeft,
    /// The mouse's brush turned to the right.
    TurnRight,
    /// The mouse's brush across its stroke, or at its own rotation.
    Follow,
    /// The mouse presses lighter.
    Lighter,
    /// The mouse presses harder.
    Harder,
    /// All wet paint becomes a dry layer.
    Dry,
    /// The palette over the canvas, and back.
    Palette,
    /// Show or hide the panels.
    Panels,
    /// All of the canvas in the view.
    Fit,
    /// A cell of the canvas a pixel.
    Hundred,
    /// The desk in a mirror, and back.
    Mirror,
    /// The keyboard goes to the panels.
    Focus,
    FullScreen,
    /// The whole screen with neither panels, rack nor bar, and back.
    Alone,
    Keys,
    /// Show the steps of a first painting.
    Tutorial,
    About,
    Quit,
    /// No device gives force any more.
    ForceOff,
    /// Text size, theme, units and keys.
    Settings,
    /// Mixtures of a colour in mind.
    Colour,
    /// A clean brush; held, it lifts paint.
    Clean,
    /// Held: a drag sets the width of the brush.
    Size,
    /// Held: a drag zooms.
    Zoom,
}

impl Action {
    /// True for an action that lasts while its key is held; such a key has no Ctrl, Shift or Alt.
    #[must_use]
    pub(crate) fn is_held(self) -> bool {
        matches!(self, Self::Clean | Self::Size | Self::Zoom)
    }

    /// True for a cumulative action, which repeats while its key is held.
    #[must_use]
    pub(crate) fn repeats(self) -> bool {
        matches!(
            self,
            Self::Undo
                | Self::Redo
                | Self::Smaller
                | Self::Larger
                | Self::TurnLeft
                | Self::TurnRight
                | Self::Lighter
                | Self::Harder
        )
    }
}

/// A key and what it does.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Binding {
    pub act: Action,
    pub shortcut: KeyboardShortcut,
    /// Its description in a painter's words.
    pub words: &'static str,
}

const fn key(act: Action, modifiers: Modifiers, key: Key, words: &'static str) -> Binding {
    Binding {
        act,
        shortcut: KeyboardShortcut::new(modifiers, key),
        words,
    }
}

/// The keys of a new painter.
pub(crate) const BINDINGS: [Binding; 44] = [
    key(
        Action::Palette,
        Modifiers::NONE,
        Key::Space,
        "Show or hide the palette",
    ),
    key(
        Action::Panels,
        Modifiers::NONE,
        Key::Tab,
        "Show or hide the panels",
    ),
    key(
        Action::Smaller,
        Modifiers::NONE,
        Key::OpenBracket,
        "Smaller brush",
    ),
    key(
        Action::Larger,
        Modifiers::NONE,
        Key::CloseBracket,
        "Larger brush",
    ),
    key(Action::NextBrush, Modifiers::NONE, Key::B, "Next brush"),
    key(
        Action::LoadFrom,
        Modifiers::NONE,
        Key::I,
        "Load the brush with the mixture under it",
    ),
    key(
        Action::Scrape,
        Modifiers::NONE,
        Key::Backspace,
        "Scrape the palette clean",
    ),
    key(
        Action::TurnLeft,
        Modifiers::NONE,
        Key::Comma,
        "Mouse: turn the brush left",
    ),
    key(
        Action::TurnRight,
        Modifiers::NONE,
        Key::Period,
        "Mouse: turn the brush right",
    ),
    key(
        Action::Follow,
        Modifiers::NONE,
        Key::T,
        "Mouse: the brush follows the stroke, or not",
    ),
    key(
        Action::Lighter,
        Modifiers::NONE,
        Key::Minus,
        "Mouse: press lighter",
    ),
    key(
        Action::Harder,
        Modifiers::NONE,
        Key::Equals,
        "Mouse: press harder",
    ),
    key(Action::Dry, Modifiers::NONE, Key::D, "Dry the canvas"),
    key(
        Action::Fit,
        Modifiers::NONE,
        Key::Num0,
        "See the whole canvas",
    ),
    key(
        Action::Hundred,
        Modifiers::NONE,
        Key::Num1,
        "Actual pixels (1:1)",
    ),
    key(Action::Mirror, Modifiers::NONE, Key::M, "Mirror the view"),
    key(
        Action::Focus,
        Modifiers::NONE,
        Key::F6,
        "Move the keyboard to the panels (Escape returns)",
    ),
    key(Action::FullScreen, Modifiers::NONE, Key::F11, "Full screen"),
    key(
        Action::Alone,
        Modifiers::NONE,
        Key::F10,
        "Full screen, the canvas alone",
    ),
    key(
        Action::Redo,
        Modifiers::COMMAND.plus(Modifiers::SHIFT),
        Key::Z,
        "Redo",
    ),
    key(Action::Redo, Modifiers::COMMAND, Key::Y, "Redo"),
    key(Action::Undo, Modifiers::COMMAND, Key::Z, "Undo"),
    key(Action::New, Modifiers::COMMAND, Key::N, "New painting"),
    key(Action::Open, Modifiers::COMMAND, Key::O, "Open a painting"),
    key(
        Action::SaveAs,
        Modifiers::COMMAND.plus(Modifiers::SHIFT),
        Key::S,
        "Save under another name",
    ),
    key(Action::Save, Modifiers::COMMAND, Key::S, "Save"),
    key(
        Action::Export,
        Modifiers::COMMAND,
        Key::E,
        "Export a picture",
    ),
    key(
        Action::Reference,
        Modifiers::COMMAND,
        Key::R,
        "Show or hide the reference picture",
    ),
    key(
        Action::ChooseTracing,
        Modifiers::COMMAND.plus(Modifiers::SHIFT),
        Key::T,
        "Tracing picture…",
    ),
    key(
        Action::Tracing,
        Modifiers::COMMAND,
        Key::T,
        "Show or hide the tracing picture",
    ),
    key(
        Action::Record,
        Modifiers::COMMAND.plus(Modifiers::SHIFT),
        Key::R,
        "Record the session",
    ),
    key(
        Action::Play,
        Modifiers::COMMAND,
        Key::P,
        "Play a recording…",
    ),
    key(
        Action::Motions,
        Modifiers::COMMAND.plus(Modifiers::SHIFT),
        Key::M,
        "Put down a motion…",
    ),
    key(
        Action::Keys,
        Modifiers::SHIFT,
        Key::Questionmark,
        "Show these keys",
    ),
    key(Action::Keys, Modifiers::NONE, Key::F1, "Show these keys"),
    key(
        Action::Tutorial,
        Modifiers::SHIFT,
        Key::F1,
        "A first painting, step by step",
    ),
    key(
        Action::About,
        Modifiers::COMMAND,
        Key::F1,
        "About Maulstick",
    ),
    key(Action::Quit, Modifiers::COMMAND, Key::Q, "Quit"),
    key(
        Action::ForceOff,
        Modifiers::NONE,
        Key::F9,
        "Switch off force on all devices",
    ),
    key(Action::Settings, Modifiers::COMMAND, Key::Comma, "Settings"),
    key(
        Action::Colour,
        Modifiers::COMMAND,
        Key::M,
        "Mix a colour that you have in mind",
    ),
    key(
        Action::Clean,
        Modifiers::NONE,
        Key::C,
        "Clean the brush; held, it lifts paint",
    ),
    key(
        Action::Size,
        Modifiers::NONE,
        Key::S,
        "Held, and drag: width of the brush, right is wider",
    ),
    key(
        Action::Zoom,
        Modifiers::NONE,
        Key::Z,
        "Held, and drag: zoom",
    ),
];

/// Functions of the pointer with a held key, with descriptions.
pub(crate) const HELD: [(&str, &str); 6] = [
    ("Shift and drag", "Paint a straight stroke"),
    ("Wheel", "Zoom"),
    (
        "Middle, or Ctrl and drag",
        "Move the canvas, or the palette",
    ),
    ("… with Shift", "Turn the canvas"),
    ("… with Alt", "Tilt the canvas"),
    (
        "Flick the brush off the palette's side",
        "Show or hide the palette",
    ),
];

/// Text of a key, with signs as themselves.
#[must_use]
pub(crate) fn written(context: &Context, shortcut: &KeyboardShortcut) -> String {
    let text = context.format_shortcut(shortcut);
    let key = shortcut.logical_key;
    let text = match key {
        // Shift is what makes it this sign.
        Key::Questionmark => text
            .replace(key.name(), key.symbol_or_name())
            .replace("Shift+", ""),
        Key::OpenBracket
        | Key::CloseBracket
        | Key::Comma
        | Key::Period
        | Key::Minus
        | Key::Equals => text.replace(key.name(), key.symbol_or_name()),
        _ => text,
    };
    match language::chosen() {
        None => text,
        Some(_) => text
            .split('+')
            .map(language::key_name)
            .collect::<Vec<_>>()
            .join("+"),
    }
}
