//! Arrow keys on a field that has the keyboard.

use eframe::egui::{EventFilter, Key, Modifiers, Response, Ui, Vec2, vec2};

/// Steps to the right and down by arrow keys, which then do not move the focus; zero while the field lacks the
/// keyboard.
#[must_use]
pub fn arrow_steps(ui: &Ui, response: &Response) -> Vec2 {
    if !response.has_focus() {
        return Vec2::ZERO;
    }
    let filter = EventFilter {
        horizontal_arrows: true,
        vertical_arrows: true,
        ..EventFilter::default()
    };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
    let presses =
        |key: Key| ui.input_mut(|input| input.count_and_consume_key(Modifiers::NONE, key)) as f32;
    vec2(
        presses(Key::ArrowRight) - presses(Key::ArrowLeft),
        presses(Key::ArrowDown) - presses(Key::ArrowUp),
    )
}
