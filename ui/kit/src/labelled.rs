//! Rows of a panel: a name on the left, and the control it names; and values that the rig has not confirmed.

use std::ops::RangeInclusive;

use eframe::egui::{Align, Layout, Response, RichText, Slider, SliderClamping, Ui, Widget, vec2};

/// Width of the column of names, points.
const NAMES: f32 = 74.0;
/// Time for which a requested value is shown although the rig says otherwise, s.
const ANSWER_S: f64 = 1.5;

/// A row: a name in the left column, and the control that it names.
pub fn named(ui: &mut Ui, name: &str, hover: &str, control: impl Widget) -> Response {
    ui.horizontal(|ui| {
        let label = label(ui, name, hover);
        let shown = ui.add(control).labelled_by(label.id);
        if hover.is_empty() {
            shown
        } else {
            shown.on_hover_text(hover)
        }
    })
    .inner
}

/// A name in the left column.
pub fn label(ui: &mut Ui, name: &str, hover: &str) -> Response {
    let height = ui.spacing().interact_size.y;
    let layout = Layout::left_to_right(Align::Center);
    let shown = ui
        .allocate_ui_with_layout(vec2(NAMES, height), layout, |ui| {
            ui.set_width(NAMES);
            ui.label(name)
        })
        .inner;
    if hover.is_empty() {
        shown
    } else {
        shown.on_hover_text(hover)
    }
}

/// A slider over a range; one over orders of magnitude goes by factors.
pub fn slider<'a>(value: &'a mut f64, range: RangeInclusive<f64>, unit: &'a str) -> Slider<'a> {
    let factor = range.end() / range.start();
    let by_factors = *range.start() > 0.0 && factor >= 20.0;
    Slider::new(value, range)
        .logarithmic(by_factors)
        .max_decimals(2)
        .clamping(SliderClamping::Edits)
        .suffix(unit)
}

/// True if a [`slider`] was moved, and did not only round its value.
#[must_use]
pub fn is_moved(from: f64, to: f64) -> bool {
    const ROUNDED: f64 = 0.5001e-2;
    (to - from).abs() > ROUNDED
}

/// Error in the typed text, shown below it.
pub fn wrong(ui: &mut Ui, what: &str) {
    ui.label(RichText::new(what).color(ui.visuals().warn_fg_color));
}

/// A value of the rig that a control changes: the requested value is shown until the rig has it, so that a dragged
/// control does not jump back.
#[derive(Clone, Debug)]
pub struct PendingValue<T> {
    asked: Option<(T, f64)>,
}

impl<T> Default for PendingValue<T> {
    fn default() -> Self {
        Self { asked: None }
    }
}

impl<T: Clone + PartialEq> PendingValue<T> {
    /// The value to show where the rig's is `actual`.
    pub fn shown(&mut self, ui: &Ui, actual: T) -> T {
        let now = ui.input(|input| input.time);
        match &self.asked {
            Some((asked, at)) if *asked != actual && now - at < ANSWER_S => {
                let left = ANSWER_S - (now - at);
                ui.ctx().request_repaint_after_secs(left as f32);
                asked.clone()
            }
            _ => {
                self.asked = None;
                actual
            }
        }
    }

    /// Stores a requested value.
    pub fn ask(&mut self, ui: &Ui, value: T) {
        self.asked = Some((value, ui.input(|input| input.time)));
    }
}
