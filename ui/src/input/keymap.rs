//! The painter's keys: the table of [`BINDINGS`], with stored changes.

use eframe::egui::{Context, Key, KeyboardShortcut, Modifiers};
use maulstick_ui_kit::language::translated;
use serde::{Deserialize, Serialize};
use toml::{Table, Value};

use crate::input::keys::{Action, BINDINGS, Binding, written};

/// Keys that cannot be assigned, and their functions.
const FIXED: [(KeyboardShortcut, &str); 5] = [
    (
        KeyboardShortcut::new(Modifiers::NONE, Key::Escape),
        tr_noop!("Close, or leave"),
    ),
    (
        KeyboardShortcut::new(Modifiers::COMMAND, Key::Plus),
        tr_noop!("Larger text"),
    ),
    (
        KeyboardShortcut::new(Modifiers::COMMAND, Key::Equals),
        tr_noop!("Larger text"),
    ),
    (
        KeyboardShortcut::new(Modifiers::COMMAND, Key::Minus),
        tr_noop!("Smaller text"),
    ),
    (
        KeyboardShortcut::new(Modifiers::COMMAND, Key::Num0),
        tr_noop!("Text at 100 %"),
    ),
];

/// Present function of a key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Holder {
    /// The binding at this place of the table.
    Binding(usize),
    /// Something that keeps it: these words.
    Fixed(&'static str),
}

impl Holder {
    /// Its description.
    #[must_use]
    pub(crate) fn words(self) -> &'static str {
        match self {
            Self::Binding(place) => BINDINGS
                .get(place)
                .map_or("", |binding| translated(binding.words)),
            Self::Fixed(words) => translated(words),
        }
    }
}

/// The key of each binding.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(from = "Value", into = "Table")]
pub struct Keymap {
    /// By the place in the table; `None` if another has taken it.
    keys: Vec<Option<KeyboardShortcut>>,
    /// Entries of the file with an unknown action or key, or one in use; they are written back.
    unknown: Table,
}

impl Default for Keymap {
    fn default() -> Self {
        let keys = BINDINGS.iter().map(|binding| Some(binding.shortcut));
        Self {
            keys: keys.collect(),
            unknown: Table::new(),
        }
    }
}

impl From<Value> for Keymap {
    fn from(value: Value) -> Self {
        let mut keymap = Self::default();
        let entries = match value {
            Value::Table(entries) => entries,
            other => Table::from_iter([("keys".to_owned(), other)]),
        };
        let mut changed = Vec::new();
        for (name, value) in entries {
            let known = known(&name).zip(value.as_str().and_then(parsed));
            let is_taken = |key: Option<KeyboardShortcut>| {
                let mut others = changed.iter();
                key.is_some() && others.any(|(_, other)| *other == key)
            };
            match known {
                Some((place, key)) if !is_taken(key) && fits(place, key) => {
                    changed.push((place, key));
                }
                _ => drop(keymap.unknown.insert(name, value)),
            }
        }
        for (place, key) in changed {
            keymap.set(place, key);
        }
        keymap
    }
}

impl From<Keymap> for Table {
    fn from(keymap: Keymap) -> Self {
        let mut entries = keymap.unknown.clone();
        for place in 0..BINDINGS.len() {
            if keymap.is_changed(place) {
                let text = keymap.key(place).map_or_else(String::new, |key| text(&key));
                entries.insert(name(place), Value::String(text));
            }
        }
        entries
    }
}

impl Keymap {
    /// The key of the binding at a place of the table; `None` if it has none.
    #[must_use]
    pub(crate) fn key(&self, place: usize) -> Option<KeyboardShortcut> {
        self.keys.get(place).copied().flatten()
    }

    /// The bindings in the order of the table, with their keys.
    pub(crate) fn bindings(
        &self,
    ) -> impl Iterator<Item = (&'static Binding, Option<KeyboardShortcut>)> {
        BINDINGS.iter().zip(self.keys.iter().copied())
    }

    /// The first key of an action; `None` if it has none.
    #[must_use]
    pub(crate) fn key_of(&self, act: Action) -> Option<KeyboardShortcut> {
        let mut own = self.bindings().filter(|(binding, _)| binding.act == act);
        own.find_map(|(_, key)| key)
    }

    /// Text of the key; empty without one.
    #[must_use]
    pub(crate) fn written(&self, context: &Context, act: Action) -> String {
        let key = self.key_of(act);
        key.map_or_else(String::new, |key| written(context, &key))
    }

    /// A tooltip that ends in the keys of these actions.
    #[must_use]
    pub(crate) fn hint(&self, context: &Context, words: &str, acts: &[Action]) -> String {
        let keys = acts.iter().map(|act| self.written(context, *act));
        let keys: Vec<String> = keys.filter(|key| !key.is_empty()).collect();
        if keys.is_empty() {
            words.to_owned()
        } else {
            format!("{words}  {}", keys.join(tr!(" and ")))
        }
    }

    /// Other holder of a key than the binding at this place.
    #[must_use]
    pub(crate) fn holder(&self, place: usize, key: &KeyboardShortcut) -> Option<Holder> {
        let mut fixed = FIXED.iter();
        if let Some((_, words)) = fixed.find(|(fixed, _)| fixed == key) {
            return Some(Holder::Fixed(words));
        }
        let mut places = 0..BINDINGS.len();
        let other = places.find(|other| *other != place && self.key(*other).as_ref() == Some(key));
        other.map(Holder::Binding)
    }

    /// Assigns a key, or none, to the binding at a place; its earlier holder loses it.
    pub(crate) fn set(&mut self, place: usize, key: Option<KeyboardShortcut>) {
        for own in &mut self.keys {
            if *own == key {
                *own = None;
            }
        }
        if let Some(own) = self.keys.get_mut(place) {
            *own = key;
        }
    }

    /// True if the binding at this place has not the key of a new painter.
    #[must_use]
    pub(crate) fn is_changed(&self, place: usize) -> bool {
        let usual = BINDINGS.get(place).map(|binding| binding.shortcut);
        self.key(place) != usual
    }

    /// A sentence about unknown entries of the file; `None` without any.
    #[must_use]
    pub(crate) fn fault(&self) -> Option<String> {
        let entries = self.unknown.iter();
        let entries: Vec<String> = entries
            .map(|(name, value)| format!("{name} = {value}"))
            .collect();
        (!entries.is_empty()).then(|| {
            tr!(
                "The preferences have keys that are unknown or used twice: {entries}",
                entries = entries.join(", ").replace('\n', " ")
            )
        })
    }
}

/// True if a key can be given to the binding at this place.
#[must_use]
pub(crate) fn fits(place: usize, key: Option<KeyboardShortcut>) -> bool {
    let is_held = BINDINGS
        .get(place)
        .is_some_and(|binding| binding.act.is_held());
    key.is_none_or(|key| {
        let is_fixed = FIXED.iter().any(|(fixed, _)| *fixed == key);
        !(is_fixed || is_held && key.modifiers != Modifiers::NONE)
    })
}

/// Name of the binding at a place of the table, as preferences have it: that of its action; a second key of an action has
/// a 2 behind it.
fn name(place: usize) -> String {
    let Some(binding) = BINDINGS.get(place) else {
        return String::new();
    };
    let name = match Value::try_from(binding.act) {
        Ok(Value::String(name)) => name,
        _ => String::new(),
    };
    let before = BINDINGS[..place].iter();
    match before.filter(|other| other.act == binding.act).count() {
        0 => name,
        more => format!("{name}_{}", more + 1),
    }
}

/// Place in the table of a name.
fn known(wanted: &str) -> Option<usize> {
    (0..BINDINGS.len()).find(|place| name(*place) == wanted)
}

/// A key as preferences have it: "Ctrl+Shift+Z".
fn text(key: &KeyboardShortcut) -> String {
    let KeyboardShortcut {
        modifiers,
        logical_key,
    } = key;
    let mut text = String::new();
    for (word, is_there) in [
        ("Ctrl+", modifiers.command),
        ("Shift+", modifiers.shift),
        ("Alt+", modifiers.alt),
    ] {
        text += if is_there { word } else { "" };
    }
    text + logical_key.name()
}

/// The key of such a text; the inner `None` for an empty one, an action without a key. `None` if it is neither.
fn parsed(text: &str) -> Option<Option<KeyboardShortcut>> {
    if text.is_empty() {
        return Some(None);
    }
    let mut parts: Vec<&str> = text.split('+').map(str::trim).collect();
    let logical_key = Key::from_name(parts.pop()?)?;
    let mut modifiers = Modifiers::NONE;
    for part in parts {
        modifiers |= match part {
            "Ctrl" => Modifiers::COMMAND,
            "Shift" => Modifiers::SHIFT,
            "Alt" => Modifiers::ALT,
            _ => return None,
        };
    }
    Some(Some(KeyboardShortcut {
        modifiers,
        logical_key,
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Keymap {
        Keymap::from(Value::Table(text.parse().expect("TOML")))
    }

    fn place(act: Action) -> usize {
        let mut all = BINDINGS.iter();
        all.position(|binding| binding.act == act).expect("bound")
    }

    #[test]
    fn each_binding_has_a_name_and_each_key_a_text_that_is_read_again() {
        for (place, binding) in BINDINGS.iter().enumerate() {
            assert_eq!(known(&name(place)), Some(place), "{}", binding.words);
            let text = text(&binding.shortcut);
            assert_eq!(parsed(&text), Some(Some(binding.shortcut)), "{text}");
        }
        assert_eq!(parsed("Hyper+Z"), None);
        assert_eq!(parsed("Ctrl+Nosuch"), None);
    }

    #[test]
    fn no_key_is_there_twice_at_the_start() {
        let keymap = Keymap::default();
        for (place, binding) in BINDINGS.iter().enumerate() {
            let holder = keymap.holder(place, &binding.shortcut);
            assert_eq!(holder, None, "{}", binding.words);
        }
    }

    #[test]
    fn changes_are_kept_and_what_had_the_key_has_none() {
        let mut keymap = Keymap::default();
        let [dry, next] = [Action::Dry, Action::NextBrush].map(place);
        let b = keymap.key(next).expect("B");
        assert_eq!(keymap.holder(dry, &b), Some(Holder::Binding(next)));
        keymap.set(dry, Some(b));
        assert_eq!((keymap.key(dry), keymap.key(next)), (Some(b), None));
        let written = Table::from(keymap.clone());
        assert_eq!(written.to_string(), "dry = \"B\"\nnext_brush = \"\"\n");
        assert_eq!(Keymap::from(Value::Table(written)), keymap);
        assert_eq!(Table::from(Keymap::default()), Table::new());
    }

    #[test]
    fn what_a_file_names_wrongly_is_said_in_one_line_and_kept_and_the_rest_holds() {
        let text = "dry = \"Q\"\nfly = \"F\"\nredo = \"Hyper+Z\"\nundo = 7\nfit = \"Q\"\nclean = \"Ctrl+K\"\n\
                    new = \"Escape\"\n";
        let keymap = read(text);
        assert_eq!(
            keymap.key(place(Action::Dry)).map(|key| key.logical_key),
            Some(Key::Q)
        );
        for act in [Action::Redo, Action::Undo, Action::Clean, Action::Fit] {
            assert!(!keymap.is_changed(place(act)), "{act:?}");
        }
        let fault = keymap.fault().expect("a fault");
        for part in ["fly = \"F\"", "Hyper+Z", "undo = 7", "fit", "clean", "new"] {
            assert!(fault.contains(part), "{part}: {fault}");
        }
        assert!(!fault.contains("dry") && !fault.contains('\n'), "{fault}");
        let again = Keymap::from(Value::Table(Table::from(keymap.clone())));
        assert_eq!(again, keymap);
        assert_eq!(read("").fault(), None);
        assert!(Keymap::from(Value::Integer(7)).fault().is_some());
    }
}
