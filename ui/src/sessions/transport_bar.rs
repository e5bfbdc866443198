//! The transport bar while a recording is played, and its keys: those of `maulstick recording replay` in a terminal.

use eframe::egui::{
    Align2, Area, Button, ComboBox, Context, Event, Frame, Id, Key, KeyboardShortcut, Modifiers,
    Order as Layer, Response, Role, Slider, TextWrapMode, Ui, WidgetInfo,
};

use maulstick_device::player::Rate;
use maulstick_recorder::{Order, Position};

use crate::app::sides;
use crate::dialogs::paths;
use crate::input::keymap::Keymap;
use crate::input::keys::written;
use crate::sessions::progress::ReplayProgress;
use crate::sessions::{SessionOrder, clock};
use crate::widgets::context::PanelContext;

/// Time that a button or an arrow key goes, s.
const SKIP_S: f64 = 5.0;
const RATES: [Rate; 6] = [
    Rate::Times(0.25),
    Rate::Times(0.5),
    Rate::Times(1.0),
    Rate::Times(2.0),
    Rate::Times(4.0),
    Rate::Max,
];
/// Distance from the lower edge, above the command bar, points.
const ABOVE: f32 = 48.0;
/// Distance from the lower edge of what lies above the bar, points.
pub(crate) const OVER: f32 = 96.0;
/// Width of all but the slider, and range of the slider's, points.
const REST: f32 = 440.0;
const SLIDER: [f32; 2] = [60.0, 360.0];

/// A button and key of the bar.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Control {
    Back,
    Pause,
    Step,
    Forth,
}

impl Control {
    const ALL: [Self; 4] = [Self::Back, Self::Pause, Self::Step, Self::Forth];

    fn key(self) -> Key {
        match self {
            Self::Back => Key::ArrowLeft,
            Self::Pause => Key::Space,
            Self::Step => Key::Period,
            Self::Forth => Key::ArrowRight,
        }
    }

    fn order(self) -> Order {
        match self {
            Self::Back => Order::Skip(-SKIP_S),
            Self::Pause => Order::Pause,
            Self::Step => Order::Step,
            Self::Forth => Order::Skip(SKIP_S),
        }
    }

    /// The sign on its button, and its description.
    fn words(self, position: &Position) -> (&'static str, &'static str) {
        match self {
            Self::Back => ("−5 s", tr!("Back 5 s")),
            Self::Pause if position.paused => (tr!("Play on"), tr!("Play on")),
            Self::Pause => (tr!("Pause"), tr!("Pause")),
            Self::Step => ("+1", tr!("On by one event")),
            Self::Forth => ("+5 s", tr!("Forth 5 s")),
        }
    }

    /// True if its key is the bar's: while a session is painted again nothing else is painted, and painting keys are free.
    fn has_key(self, replay: &ReplayProgress, keymap: &Keymap) -> bool {
        let own = Some(KeyboardShortcut::new(Modifiers::NONE, self.key()));
        replay.painting.is_some() || !keymap.bindings().any(|(_, key)| key == own)
    }
}

#[derive(Debug, Default)]
pub(crate) struct TransportBar {
    /// Place of the slider while it is dragged, s: a seek backwards paints the session again, so only the place where
    /// it is released counts.
    dragged_s: Option<f64>,
}

impl TransportBar {
    /// Takes the bar's keys, before others have them.
    pub(crate) fn follow_keys(context: &Context, work: &mut PanelContext<'_>) {
        let is_typing = context.memory(|memory| memory.focused().is_some());
        let Some(replay) = work.rig.replay.as_ref().filter(|_| !is_typing) else {
            return;
        };
        for control in Control::ALL {
            if control.has_key(replay, &work.preferences.keys) && is_pressed(context, control.key())
            {
                let order = SessionOrder::Transport(control.order());
                work.requests.session(order);
            }
        }
    }

    /// Shows the bar while something is played, in the middle of what panels and rack leave free.
    pub(crate) fn show(&mut self, context: &Context, work: &mut PanelContext<'_>) {
        let Some(replay) = work.rig.replay.clone() else {
            self.dragged_s = None;
            return;
        };
        let [left, right] = sides::taken(work.preferences);
        let free = context.content_rect().width() - left - right;
        let [least, most] = SLIDER;
        let slider = (free - REST).max(least).min(most);
        Area::new(Id::unique("transport"))
            .order(Layer::Middle)
            .anchor(Align2::CENTER_BOTTOM, [0.5 * (left - right), -ABOVE])
            .accessible_name(tr!("Playing a recording"))
            .show(context, |ui| {
                ui.style_mut().wrap_mode = Some(TextWrapMode::Extend);
                ui.spacing_mut().slider_width = slider;
                Frame::popup(ui.style()).show(ui, |ui| {
                    ui.horizontal(|ui| {
                        if let Some(order) = self.controls(ui, &replay, &work.preferences.keys) {
                            work.requests.session(SessionOrder::Transport(order));
                        }
                    });
                });
            });
    }

    /// The controls; the order that one gives.
    fn controls(&mut self, ui: &mut Ui, replay: &ReplayProgress, keymap: &Keymap) -> Option<Order> {
        let mut order = None;
        match &replay.position {
            Some(position) => {
                for control in Control::ALL {
                    let (sign, words) = control.words(position);
                    let key = KeyboardShortcut::new(Modifiers::NONE, control.key());
                    let key = written(ui.ctx(), &key);
                    let hint = if control.has_key(replay, keymap) {
                        format!("{words}  {key}")
                    } else {
                        tr!("{words} ({key} keeps its use while you paint)", words, key)
                    };
                    if button(ui, sign, words).on_hover_text(hint).clicked() {
                        order = Some(control.order());
                    }
                }
                order = self.slider(ui, position).or(order);
                order = rate(ui, position).or(order);
            }
            None => {
                let name = paths::name(&replay.recording);
                ui.label(tr!("Opening {file} …", file = name));
            }
        }
        let words = tr!("End the replay");
        if button(ui, "×", words).on_hover_text(words).clicked() {
            Some(Order::End)
        } else {
            order
        }
    }

    fn slider(&mut self, ui: &mut Ui, position: &Position) -> Option<Order> {
        let mut place_s = self.dragged_s.unwrap_or(position.position_s);
        let slider = Slider::new(&mut place_s, 0.0..=position.length_s.max(0.0)).show_value(false);
        let words = tr!("Place in the recording");
        let slider = ui.add(slider);
        slider.widget_info(|| WidgetInfo::slider(true, place_s, words));
        let slider = slider.on_hover_text(words);
        self.dragged_s = slider.dragged().then_some(place_s);
        let (now, length) = (clock(place_s), clock(position.length_s));
        ui.label(tr!("{now} of {length}", now, length));
        let is_let_go = slider.drag_stopped() || slider.changed() && !slider.dragged();
        is_let_go.then_some(Order::Seek(place_s))
    }
}

fn button(ui: &mut Ui, sign: &str, words: &str) -> Response {
    let button = ui.add(Button::new(sign).min_size([28.0, 24.0].into()));
    button.widget_info(|| WidgetInfo::labeled(Role::Button, true, words));
    button
}

/// The choice of the rate.
fn rate(ui: &mut Ui, position: &Position) -> Option<Order> {
    let shown = |rate: Rate| match rate {
        Rate::Max => tr!("rate|max").to_owned(),
        Rate::Times(times) => format!("× {times}"),
    };
    let mut order = None;
    let combo = ComboBox::from_id_salt("rate")
        .width(64.0)
        .selected_text(shown(position.rate));
    let combo = combo.show_ui(ui, |ui| {
        for rate in RATES {
            if ui
                .selectable_label(rate == position.rate, shown(rate))
                .clicked()
            {
                order = Some(Order::Rate(rate));
            }
        }
    });
    let words = tr!("Rate of the replay");
    let value = shown(position.rate);
    combo.response.widget_info(|| WidgetInfo {
        current_text_value: Some(value.clone()),
        ..WidgetInfo::labeled(Role::ComboBox, true, words)
    });
    combo.response.on_hover_text(words);
    order
}

/// True if a key was pressed; its presses and repeats are taken.
fn is_pressed(context: &Context, key: Key) -> bool {
    context.input_mut(|input| {
        let is_new = |event: &Event| {
            matches!(event, Event::Key { key: own, pressed: true, repeat: false, modifiers, .. }
                if *own == key && modifiers.is_none())
        };
        let pressed = input.events.iter().any(is_new);
        input.consume_key(Modifiers::NONE, key);
        pressed
    })
}
