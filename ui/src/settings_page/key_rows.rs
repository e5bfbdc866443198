//! The keys, a row each. A click on a key waits for another one to be pressed; one that something has is taken only if
//! the painter says so.

use eframe::egui::{
    Button, Context, Event, EventFilter, Grid, Key, KeyboardShortcut, Modifiers, Role, ScrollArea,
    Ui, WidgetInfo,
};
use maulstick_ui_kit::language::translated;

use crate::dialogs::wrong;
use crate::input::keymap::{Holder, Keymap, fits};
use crate::input::keys::{BINDINGS, Binding, written};

/// Height of the list, and the least in a small window, points.
const HEIGHT: f32 = 220.0;
const LEAST_HEIGHT: f32 = 60.0;

/// State of the rows that wait for an answer.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Waits {
    #[default]
    Nothing,
    /// A key for the binding at this place.
    Key(usize),
    /// An answer: the key that is wanted for a place, and what has it.
    Answer(usize, KeyboardShortcut, Holder),
    /// Nothing more: this key cannot be held.
    NotHeld,
}

#[derive(Debug, Default)]
pub(super) struct KeyRows {
    waits: Waits,
}

impl KeyRows {
    /// Takes the key that a row waits for, before any control can.
    pub(super) fn take_key(&mut self, context: &Context, keymap: &mut Keymap) {
        let Waits::Key(place) = self.waits else {
            return;
        };
        let pressed = context.input_mut(|input| {
            let mut pressed = None;
            input.events.retain(|event| match event {
                Event::Key {
                    key,
                    pressed: true,
                    repeat,
                    modifiers,
                    ..
                } => {
                    if !repeat && pressed.is_none() {
                        pressed = Some(KeyboardShortcut::new(plain(*modifiers), *key));
                    }
                    false
                }
                Event::Text(_) => false,
                _ => true,
            });
            pressed
        });
        match pressed {
            None => {}
            Some(key) if key.logical_key == Key::Escape => self.waits = Waits::Nothing,
            Some(key) => self.wish(place, key, keymap),
        }
    }

    /// Gives a place a key that nothing has; else the painter is asked.
    fn wish(&mut self, place: usize, key: KeyboardShortcut, keymap: &mut Keymap) {
        self.waits = match keymap.holder(place, &key) {
            Some(holder) => Waits::Answer(place, key, holder),
            None if !fits(place, Some(key)) => Waits::NotHeld,
            None => {
                keymap.set(place, Some(key));
                Waits::Nothing
            }
        };
    }

    /// Shows them in a list of at most this height, points.
    pub(super) fn show(&mut self, ui: &mut Ui, most: f32, keymap: &mut Keymap) {
        ui.horizontal(|ui| {
            ui.strong(tr!("Keys"));
            if ui
                .add_enabled(
                    *keymap != Keymap::default(),
                    Button::new(tr!("Reset all keys")).small(),
                )
                .clicked()
            {
                *keymap = Keymap::default();
                self.waits = Waits::Nothing;
            }
        });
        self.answer(ui, keymap);
        let list = ScrollArea::vertical()
            .max_height(most.clamp(LEAST_HEIGHT, HEIGHT))
            .auto_shrink([false, true]);
        list.show(ui, |ui| {
            let grid = Grid::new("keys to change").num_columns(3).striped(true);
            grid.show(ui, |ui| {
                for (place, binding) in BINDINGS.iter().enumerate() {
                    self.row(ui, place, binding, keymap);
                    ui.end_row();
                }
            });
        });
    }

    /// The line above the list: what to do now, or what has the key that is wanted.
    fn answer(&mut self, ui: &mut Ui, keymap: &mut Keymap) {
        match self.waits {
            Waits::Nothing => {
                ui.weak(tr!("Click a key to change it."));
            }
            Waits::Key(_) => {
                ui.label(tr!("Press the new key. Escape: leave it as it is."));
            }
            Waits::NotHeld => {
                let colour = wrong(ui.visuals());
                ui.colored_label(
                    colour,
                    tr!("This one is held: choose a key without Ctrl, Shift or Alt."),
                );
            }
            Waits::Answer(place, key, holder) => {
                ui.horizontal(|ui| {
                    let (key_words, words) = (written(ui.ctx(), &key), holder.words());
                    let colour = wrong(ui.visuals());
                    ui.colored_label(
                        colour,
                        tr!("{key_words} is “{words}” now.", key_words, words),
                    );
                    let can = matches!(holder, Holder::Binding(_)) && fits(place, Some(key));
                    if can && ui.button(tr!("Take it")).clicked() {
                        keymap.set(place, Some(key));
                        self.waits = Waits::Nothing;
                    }
                    if ui.button(tr!("Leave it")).clicked() {
                        self.waits = Waits::Nothing;
                    }
                });
            }
        }
    }

    /// A key, beside it what it does.
    fn row(&mut self, ui: &mut Ui, place: usize, binding: &Binding, keymap: &mut Keymap) {
        let key = keymap.key(place);
        let now = key.map_or_else(|| tr!("none").to_owned(), |key| written(ui.ctx(), &key));
        let is_waiting = self.waits == Waits::Key(place);
        let text = if is_waiting { "…" } else { &now };
        let button = ui.add(
            Button::new(text)
                .selected(is_waiting)
                .min_size([120.0, 0.0].into()),
        );
        button.widget_info(|| {
            let name = tr!(
                "Key of “{words}”: {now}",
                words = translated(binding.words),
                now
            );
            WidgetInfo::selected(Role::Button, true, is_waiting, name)
        });
        if is_waiting {
            // Tab, arrows and Escape are keys like others now.
            let all = EventFilter {
                tab: true,
                horizontal_arrows: true,
                vertical_arrows: true,
                escape: true,
            };
            button.request_focus();
            ui.memory_mut(|memory| memory.set_focus_lock_filter(button.id, all));
        }
        if button.clicked() {
            self.waits = if is_waiting {
                Waits::Nothing
            } else {
                Waits::Key(place)
            };
        }
        ui.label(translated(binding.words));
        if keymap.is_changed(place) {
            let usual = written(ui.ctx(), &binding.shortcut);
            let reset = ui.small_button(tr!("Reset"));
            reset.widget_info(|| {
                let name = tr!(
                    "Reset the key of “{words}”",
                    words = translated(binding.words)
                );
                WidgetInfo::labeled(Role::Button, true, name)
            });
            if reset.on_hover_text(tr!("{usual} again", usual)).clicked() {
                self.wish(place, binding.shortcut, keymap);
            }
        } else {
            ui.label("");
        }
    }
}

/// Modifiers as the table has them.
fn plain(modifiers: Modifiers) -> Modifiers {
    Modifiers {
        alt: modifiers.alt,
        shift: modifiers.shift,
        command: modifiers.command || modifiers.ctrl,
        ..Modifiers::NONE
    }
}
