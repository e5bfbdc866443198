//! Presses of keys: their actions, and the owner of the keyboard.

use eframe::egui::{
    Context, Event, InputState, Key, KeyboardShortcut, Modifiers, Plugin, RawInput, TextEdit,
};

use crate::input::keymap::Keymap;
use crate::input::keys::Action;

/// Tab alone, which also moves the focus from control to control.
const TAB: KeyboardShortcut = KeyboardShortcut::new(Modifiers::NONE, Key::Tab);

/// True while the key of an action that lasts is down.
#[must_use]
pub(crate) fn is_down(input: &InputState, keymap: &Keymap, act: Action) -> bool {
    let key = keymap.key_of(act);
    key.is_some_and(|key| input.key_down(key.logical_key))
}

/// The action of a single key held at the press of a button, which turns a drag into another function than a stroke.
/// `place` is that of the button's event: a slow frame may contain key, drag and the key's release together.
#[must_use]
pub(crate) fn holds(input: &InputState, keymap: &Keymap, place: usize) -> Option<Action> {
    let Some(Event::PointerButton { modifiers, .. }) = input.events.get(place) else {
        return None;
    };
    let was_down = |act: &Action| {
        let Some(key) = keymap.key_of(*act).map(|key| key.logical_key) else {
            return false;
        };
        let next = input.events[place..].iter().find_map(|event| match event {
            Event::Key {
                key: own,
                pressed,
                repeat,
                ..
            } if *own == key => Some(!*pressed || *repeat),
            _ => None,
        });
        next.unwrap_or_else(|| input.key_down(key))
    };
    let mut acts = [Action::Size, Action::Zoom].into_iter();
    acts.find(|act| modifiers.is_none() && was_down(act))
}

/// Keeps Tab from the first control where no control has the keyboard: there it is a key of the desk.
#[derive(Debug, Default)]
pub(crate) struct TabKey {
    pressed: bool,
    /// True if it is no key of the desk.
    is_free: bool,
    /// True while it is down: key repeats are not flagged by every system.
    down: bool,
}

impl Plugin for TabKey {
    fn debug_name(&self) -> &'static str {
        "tab key"
    }

    fn input_hook(&mut self, context: &Context, input: &mut RawInput) {
        if self.is_free || context.memory(|memory| memory.focused().is_some()) {
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
pub(crate) fn closes_table(input: &mut InputState, keymap: &Keymap) -> bool {
    let own = keymap
        .bindings()
        .filter(|(binding, _)| binding.act == Action::Keys);
    let mut closes = input.consume_key(Modifiers::NONE, Key::Escape);
    for (_, key) in own {
        closes |= key.is_some_and(|key| input.consume_shortcut(&key));
    }
    closes
}

/// Returns the keyboard to the desk after a click on a control without typing.
pub(crate) fn return_keyboard(context: &Context) {
    let clicked = context.input(|input| input.pointer.any_released());
    let focused = context.memory(|memory| memory.focused());
    if let Some(id) = focused.filter(|id| clicked && TextEdit::load_state(context, *id).is_none()) {
        context.memory_mut(|memory| memory.surrender_focus(id));
    }
}

/// True for a key that types, or that a control may need.
fn is_plain(key: &KeyboardShortcut) -> bool {
    let name = key.logical_key.name();
    let is_function = name
        .strip_prefix('F')
        .is_some_and(|number| number.parse::<u8>().is_ok());
    !key.modifiers.command && !is_function
}

/// The one key that acts in all states of the window.
#[must_use]
pub(crate) fn force_off(context: &Context, keymap: &Keymap) -> Vec<Action> {
    let key = keymap.key_of(Action::ForceOff).filter(|key| !is_plain(key));
    let pressed = key.is_some_and(|key| context.input_mut(|input| input.consume_shortcut(&key)));
    pressed.then_some(Action::ForceOff).into_iter().collect()
}

/// Actions of the keys that were pressed, in order. While a control has the keyboard, keys without Ctrl are its own.
#[must_use]
pub(crate) fn pressed(context: &Context, keymap: &Keymap) -> Vec<Action> {
    let typing = context.memory(|memory| memory.focused().is_some());
    let mut bound: Vec<(Action, KeyboardShortcut)> = keymap
        .bindings()
        .filter_map(|(binding, key)| Some((binding.act, key?)))
        .filter(|(act, _)| !act.is_held())
        .collect();
    // A key with more modifiers also matches the same with fewer.
    let fewer = |key: &KeyboardShortcut| !(key.modifiers.shift || key.modifiers.alt);
    bound.sort_by_key(|(_, key)| fewer(key));
    let on_tab = bound.iter().find(|(_, key)| *key == TAB);
    let tab = {
        let plugin = context.plugin_or_default::<TabKey>();
        let mut plugin = plugin.lock();
        plugin.is_free = on_tab.is_none();
        std::mem::take(&mut plugin.pressed)
    };
    let mut acts: Vec<Action> = on_tab
        .filter(|_| tab)
        .map(|(act, _)| *act)
        .into_iter()
        .collect();
    context.input_mut(|input| {
        for (act, shortcut) in &bound {
            let KeyboardShortcut {
                modifiers: own,
                logical_key,
            } = *shortcut;
            // A held key acts once, except cumulative actions.
            if !typing && !act.repeats() {
                input.events.retain(|event| {
                    !matches!(event, Event::Key { key, repeat: true, modifiers, .. }
                        if *key == logical_key && modifiers.matches_logically(own))
                });
            }
            if !(typing && is_plain(shortcut)) && input.consume_shortcut(shortcut) {
                acts.push(*act);
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
    use crate::input::keys::{BINDINGS, written};

    /// Actions of a key under a keymap.
    fn acts_of(keymap: &Keymap, shortcut: &KeyboardShortcut) -> Vec<Action> {
        let acts = RefCell::new(Vec::new());
        let mut harness = Harness::new_ui(|ui| acts.borrow_mut().extend(pressed(ui.ctx(), keymap)));
        harness.run();
        harness.key_press_modifiers(shortcut.modifiers, shortcut.logical_key);
        harness.run();
        drop(harness);
        acts.into_inner()
    }

    #[test]
    fn each_key_does_what_the_table_says() {
        let keymap = Keymap::default();
        for binding in BINDINGS.iter().filter(|binding| !binding.act.is_held()) {
            let acts = acts_of(&keymap, &binding.shortcut);
            assert_eq!(acts, [binding.act], "{}", binding.words);
        }
    }

    #[test]
    fn a_changed_key_acts_in_the_place_of_the_old_one() {
        let place = |act: Action| BINDINGS.iter().position(|binding| binding.act == act);
        let place = |act: Action| place(act).expect("bound");
        let mut keymap = Keymap::default();
        let shift_d = KeyboardShortcut::new(Modifiers::SHIFT, Key::D);
        keymap.set(place(Action::Fit), Some(shift_d));
        let d = BINDINGS[place(Action::Dry)].shortcut;
        let zero = BINDINGS[place(Action::Fit)].shortcut;
        assert_eq!(acts_of(&keymap, &shift_d), [Action::Fit]);
        assert_eq!(acts_of(&keymap, &d), [Action::Dry]);
        assert_eq!(acts_of(&keymap, &zero), []);
        keymap.set(place(Action::Palette), Some(TAB));
        assert_eq!(acts_of(&keymap, &TAB), [Action::Palette]);
    }

    #[test]
    fn signs_are_written_as_themselves() {
        let context = Context::default();
        let words = BINDINGS.map(|binding| written(&context, &binding.shortcut));
        for word in ["[", "]", "?", "Ctrl+Shift+Z", "Space", "Ctrl+,"] {
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
            acts.borrow_mut()
                .extend(pressed(ui.ctx(), &Keymap::default()));
        });
        harness.run();
        harness.key_press(Key::D);
        harness.run();
        drop(harness);
        assert!(acts.into_inner().is_empty());
    }
}
