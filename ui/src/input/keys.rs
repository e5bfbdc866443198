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

/// A table of actions, modifiers and keys.
macro_rules! bindings {
    ($($act:ident [$($modifier:ident)*] $key:ident $words:literal,)*) => {
        [$(Binding {
            act: Action::$act,
            shortcut: KeyboardShortcut::new(
                Modifiers::NONE$(.plus(Modifiers::$modifier))*,
                Key::$key,
            ),
            words: $words,
        }),*]
    };
}

/// The keys of a new painter.
pub(crate) const BINDINGS: [Binding; 44] = bindings! {
    Palette [] Space "Show or hide the palette",
    Panels [] Tab "Show or hide the panels",
    Smaller [] OpenBracket "Smaller brush",
    Larger [] CloseBracket "Larger brush",
    NextBrush [] B "Next brush",
    LoadFrom [] I "Load the brush with the mixture under it",
    Scrape [] Backspace "Scrape the palette clean",
    TurnLeft [] Comma "Mouse: turn the brush left",
    TurnRight [] Period "Mouse: turn the brush right",
    Follow [] T "Mouse: the brush follows the stroke, or not",
    Lighter [] Minus "Mouse: press lighter",
    Harder [] Equals "Mouse: press harder",
    Dry [] D "Dry the canvas",
    Fit [] Num0 "See the whole canvas",
    Hundred [] Num1 "Actual pixels (1:1)",
    Mirror [] M "Mirror the view",
    Focus [] F6 "Move the keyboard to the panels (Escape returns)",
    FullScreen [] F11 "Full screen",
    Alone [] F10 "Full screen, the canvas alone",
    Redo [COMMAND SHIFT] Z "Redo",
    Redo [COMMAND] Y "Redo",
    Undo [COMMAND] Z "Undo",
    New [COMMAND] N "New painting",
    Open [COMMAND] O "Open a painting",
    SaveAs [COMMAND SHIFT] S "Save under another name",
    Save [COMMAND] S "Save",
    Export [COMMAND] E "Export a picture",
    Reference [COMMAND] R "Show or hide the reference picture",
    ChooseTracing [COMMAND SHIFT] T "Tracing picture…",
    Tracing [COMMAND] T "Show or hide the tracing picture",
    Record [COMMAND SHIFT] R "Record the session",
    Play [COMMAND] P "Play a recording…",
    Motions [COMMAND SHIFT] M "Put down a motion…",
    Keys [SHIFT] Questionmark "Show these keys",
    Keys [] F1 "Show these keys",
    Tutorial [SHIFT] F1 "A first painting, step by step",
    About [COMMAND] F1 "About Maulstick",
    Quit [COMMAND] Q "Quit",
    ForceOff [] F9 "Switch off force on all devices",
    Settings [COMMAND] Comma "Settings",
    Colour [COMMAND] M "Mix a colour that you have in mind",
    Clean [] C "Clean the brush; held, it lifts paint",
    Size [] S "Held, and drag: width of the brush, right is wider",
    Zoom [] Z "Held, and drag: zoom",
};

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
