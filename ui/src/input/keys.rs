//! Key bindings, one table for input and for help.

use eframe::egui::{
    Context, Event, InputState, Key, KeyboardShortcut, Modifiers, Plugin, RawInput, TextEdit,
};

/// Action of a key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    /// A new painting.
    New,
    /// Another painting.
    Open,
    /// Save, and confirm that all is saved.
    Save,
    /// The painting under another name.
    SaveAs,
    /// A picture of it for other programs.
    Export,
    /// Show or hide the reference picture beside the canvas.
    Reference,
    /// Choose a picture to paint after on the canvas.
    ChooseTracing,
    /// Show or hide it.
    Tracing,
    /// The newest step back.
    Undo,
    /// The newest undo back.
    Redo,
    /// A smaller brush.
    Smaller,
    /// A larger brush.
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
    /// The mouse's brush across its stroke, or as it is turned.
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
    /// The keyboard goes to the panels.
    Focus,
    /// The whole screen.
    FullScreen,
    /// The whole screen with neither panels, rack nor bar, and back.
    Alone,
    /// Show the keys.
    Keys,
    /// No device gives force any more.
    ForceOff,
}

/// A key and what it does.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Binding {
    /// Its action.
    pub act: Action,
    /// The key.
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

/// Bindings of keys that act once per press. One with more modifiers comes before the same with fewer.
pub(crate) const BINDINGS: [Binding; 31] = [
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
        Action::Keys,
        Modifiers::SHIFT,
        Key::Questionmark,
        "Show these keys",
    ),
    key(Action::Keys, Modifiers::NONE, Key::F1, "Show these keys"),
    key(
        Action::ForceOff,
        Modifiers::NONE,
        Key::F9,
        "Switch off force on all devices",
    ),
];

/// The key that lifts paint while it is held, and cleans the brush at a tap.
pub(crate) const CLEAN: Key = Key::C;

/// The key with which a drag sets the width of the brush.
pub(crate) const SIZE: Key = Key::S;

/// The key with which a drag zooms.
pub(crate) const ZOOM: Key = Key::Z;

/// The key that is held by itself and makes something else of a drag than a stroke.
#[must_use]
pub(crate) fn holds(input: &InputState) -> Option<Key> {
    let mut keys = [SIZE, ZOOM].into_iter();
    keys.find(|key| input.modifiers.is_none() && input.key_down(*key))
}

/// Actions that last while something is held, and their descriptions.
pub(crate) const HELD: [(&str, &str); 8] = [
    ("C", "Clean the brush; held, it lifts paint"),
    ("Shift and drag", "Paint a straight stroke"),
    ("S and drag", "Width of the brush: right is wider"),
    ("Wheel, or Z and drag", "Zoom"),
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

/// A key as it is written: signs as themselves.
#[must_use]
pub(crate) fn written(context: &Context, shortcut: &KeyboardShortcut) -> String {
    match shortcut.logical_key {
        key @ (Key::OpenBracket
        | Key::CloseBracket
        | Key::Questionmark
        | Key::Comma
        | Key::Period
        | Key::Minus
        | Key::Equals) => key.symbol_or_name().to_owned(),
        _ => context.format_shortcut(shortcut),
    }
}

/// Keeps Tab from the first control where no control has the keyboard: there it is a key of the desk.
#[derive(Debug, Default)]
pub(crate) struct TabKey {
    pressed: bool,
    /// True while it is down: key repeats are not flagged by every system.
    down: bool,
}

impl Plugin for TabKey {
    fn debug_name(&self) -> &'static str {
        "tab key"
    }

    fn input_hook(&mut self, context: &Context, input: &mut RawInput) {
        if context.memory(|memory| memory.focused().is_some()) {
            return;
        }
        let is_tab = |event: &Event| matches!(event, Event::Key { key: Key::Tab, modifiers, .. } if modifiers.is_none());
        for event in input.events.iter().filter(|event| is_tab(event)) {
            let down = matches!(event, Event::Key { pressed: true, .. });
            self.pressed |= down && !self.down;
            self.down = down;
        }
        input.events.retain(|event| !is_tab(event));
    }
}

/// Consumes the keys that close the table of keys, also while a control has the focus; true if one was pressed.
pub(crate) fn closes_table(input: &mut InputState) -> bool {
    input.consume_key(Modifiers::NONE, Key::Escape)
        || input.consume_key(Modifiers::SHIFT, Key::Questionmark)
        || input.consume_key(Modifiers::NONE, Key::F1)
}

/// Gives the keyboard back to the desk after a click on a control in which nothing is typed.
pub(crate) fn return_keyboard(context: &Context) {
    let clicked = context.input(|input| input.pointer.any_released());
    let focused = context.memory(|memory| memory.focused());
    if let Some(id) = focused.filter(|id| clicked && TextEdit::load_state(context, *id).is_none()) {
        context.memory_mut(|memory| memory.surrender_focus(id));
    }
}

/// The one key that acts whatever else is open.
#[must_use]
pub(crate) fn force_off(context: &Context) -> Vec<Action> {
    let pressed = context.input_mut(|input| input.consume_key(Modifiers::NONE, Key::F9));
    pressed.then_some(Action::ForceOff).into_iter().collect()
}

/// Actions of the keys that were pressed, in order. While a control has the keyboard, keys without Ctrl are its own.
#[must_use]
pub(crate) fn pressed(context: &Context) -> Vec<Action> {
    let typing = context.memory(|memory| memory.focused().is_some());
    let tab = context.plugin_or_default::<TabKey>();
    let tab = std::mem::take(&mut tab.lock().pressed);
    let mut acts: Vec<Action> = tab.then_some(Action::Panels).into_iter().collect();
    context.input_mut(|input| {
        for binding in &BINDINGS {
            // A key that is kept down acts once, except those whose effect adds up.
            let repeats = matches!(
                binding.act,
                Action::Undo
                    | Action::Redo
                    | Action::Smaller
                    | Action::Larger
                    | Action::TurnLeft
                    | Action::TurnRight
                    | Action::Lighter
                    | Action::Harder
            );
            let KeyboardShortcut {
                modifiers: own,
                logical_key,
            } = binding.shortcut;
            if !typing && !repeats {
                input.events.retain(|event| {
                    !matches!(event, Event::Key { key, repeat: true, modifiers, .. }
                        if *key == logical_key && modifiers.matches_logically(own))
                });
            }
            let is_plain = !binding.shortcut.modifiers.command
                && !matches!(
                    binding.shortcut.logical_key,
                    Key::F1 | Key::F6 | Key::F9 | Key::F10 | Key::F11
                );
            if !(typing && is_plain) && input.consume_shortcut(&binding.shortcut) {
                acts.push(binding.act);
            }
        }
    });
    acts
}

#[cfg(test)]
mod tests {
    use std::cell::RefCell;

    use egui_kittest::Harness;

    use super::*;

    #[test]
    fn each_key_does_what_the_table_says() {
        for binding in &BINDINGS {
            let acts = RefCell::new(Vec::new());
            let mut harness = Harness::new_ui(|ui| acts.borrow_mut().extend(pressed(ui.ctx())));
            harness.run();
            let KeyboardShortcut {
                modifiers,
                logical_key,
            } = binding.shortcut;
            harness.key_press_modifiers(modifiers, logical_key);
            harness.run();
            drop(harness);
            assert_eq!(acts.into_inner(), [binding.act], "{}", binding.words);
        }
    }

    #[test]
    fn signs_are_written_as_themselves() {
        let context = Context::default();
        let words = BINDINGS.map(|binding| written(&context, &binding.shortcut));
        for word in ["[", "]", "?", "Ctrl+Shift+Z", "Space"] {
            assert!(words.iter().any(|own| own == word), "{word}: {words:?}");
        }
    }

    #[test]
    fn while_a_name_is_typed_no_key_acts() {
        let acts = RefCell::new(Vec::new());
        let mut text = String::new();
        let mut harness = Harness::new_ui(|ui| {
            let label = ui.label("Name");
            let edit = ui.text_edit_singleline(&mut text).labelled_by(label.id);
            if !edit.has_focus() {
                edit.request_focus();
            }
            acts.borrow_mut().extend(pressed(ui.ctx()));
        });
        harness.run();
        harness.key_press(Key::D);
        harness.run();
        drop(harness);
        assert!(acts.into_inner().is_empty());
    }
}
