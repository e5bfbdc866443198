//! Rows of a panel: a word on the left, a control on the right, each named for screen readers.

use std::collections::BTreeMap;
use std::ops::RangeInclusive;

use eframe::egui::{
    Align, ComboBox, Layout, Response, RichText, Slider, SliderClamping, TextWrapMode, Ui,
    UiBuilder, vec2,
};

use crate::language::{known, translated};
use crate::pending::Pending;

/// Width of the words at the left, points.
const WORDS: f32 = 84.0;

/// A cell of this width whose content `add` adds from its left, clipped at its right.
pub fn cell<T>(ui: &mut Ui, width: f32, add: impl FnOnce(&mut Ui) -> T) -> T {
    let height = ui.spacing().interact_size.y;
    let (_, place) = ui.allocate_space(vec2(width, height));
    let layout = Layout::left_to_right(Align::Center);
    let mut cell = ui.new_child(UiBuilder::new().max_rect(place).layout(layout));
    cell.style_mut().wrap_mode = Some(TextWrapMode::Truncate);
    add(&mut cell)
}

/// Controls under those of rows, without a word of their own.
pub fn below<T>(ui: &mut Ui, controls: impl FnOnce(&mut Ui) -> T) -> T {
    ui.horizontal(|ui| {
        cell(ui, WORDS, |_| ());
        controls(ui)
    })
    .inner
}

/// A row: the word at the left names the control that `control` adds.
pub fn row(ui: &mut Ui, word: &str, control: impl FnOnce(&mut Ui) -> Response) -> Response {
    ui.horizontal(|ui| {
        let label = cell(ui, WORDS, |ui| ui.label(word));
        control(ui).labelled_by(label.id)
    })
    .inner
}

/// A line of small words under its subject.
pub fn note(ui: &mut Ui, text: impl Into<String>) {
    ui.label(RichText::new(text).small());
}

/// A line about a fault.
pub fn wrong(ui: &mut Ui, text: impl Into<String>) {
    let colour = ui.visuals().error_fg_color;
    ui.label(RichText::new(text).color(colour));
}

/// The name that the painter chose; `None` if it is the same as before.
pub fn choice<'a>(
    ui: &mut Ui,
    word: &str,
    chosen: &str,
    names: impl IntoIterator<Item = &'a str>,
) -> Option<String> {
    let mut other = None;
    row(ui, word, |ui| {
        let width = ui.available_width();
        let combo = ComboBox::from_id_salt(word)
            .width(width)
            .selected_text(known(chosen))
            .truncate();
        let shown = combo.show_ui(ui, |ui| {
            for name in names {
                let is_it = name == chosen;
                if ui.selectable_label(is_it, known(name)).clicked() && !is_it {
                    other = Some(name.to_owned());
                }
            }
        });
        shown.response
    });
    other
}

/// A number of a slider.
#[derive(Clone, Debug)]
pub struct Number<'a> {
    /// The word at its left.
    pub word: &'a str,
    /// Description in a painter's words, with its unit.
    pub hover: &'a str,
    /// Its range, in the displayed unit.
    pub range: RangeInclusive<f64>,
    /// The unit.
    pub unit: &'a str,
    /// Greatest number of digits after the point.
    pub decimals: usize,
    /// True for a logarithmic slider.
    pub factors: bool,
}

/// A change of a number; `None` if there was none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Change {
    /// New value while it is dragged, typed or stepped.
    pub moved: Option<f64>,
    /// Final value that differs from the rig's.
    pub settled: Option<f64>,
    /// The displayed value.
    pub shown: f64,
}

/// The sliders of a panel, by name, with the value being dragged.
#[derive(Clone, Debug, Default)]
pub struct Sliders {
    held: BTreeMap<String, Pending<f64>>,
}

impl Sliders {
    /// A row with a slider whose number is `actual` in the rig.
    pub fn row(&mut self, ui: &mut Ui, number: &Number<'_>, actual: f64) -> Change {
        let mut change = Change::default();
        row(ui, translated(number.word), |ui| {
            let (response, changed) = self.bare(ui, number, number.word, actual);
            change = changed;
            response
        });
        change
    }

    /// [`row`](Self::row) without the word, for a number of this `key`.
    pub fn bare(
        &mut self,
        ui: &mut Ui,
        number: &Number<'_>,
        key: &str,
        actual: f64,
    ) -> (Response, Change) {
        let now_s = ui.input(|input| input.time);
        let held = self.held.entry(key.to_owned()).or_default();
        // Rounded as displayed, so that the request is recognised in the rig's answer.
        let fine = 10f64.powi(number.decimals as i32);
        let rounded = |value: f64| (value * fine).round() / fine;
        let actual = rounded(actual);
        let shown = held.shown(now_s, &actual);
        let mut value = shown;
        let slider = Slider::new(&mut value, number.range.clone())
            .suffix(number.unit)
            .max_decimals(number.decimals)
            .logarithmic(number.factors)
            .smallest_positive(0.5 / fine)
            .clamping(SliderClamping::Never)
            .update_while_editing(false);
        let response = ui.push_id(key, |ui| ui.add(slider)).inner;
        let response = response.on_hover_text(translated(number.hover));
        let value = rounded(value);
        let moved = (response.changed() && value != shown).then_some(value);
        if moved.is_some() || response.dragged() {
            held.hold(now_s, value);
        }
        let is_done = response.drag_stopped() || moved.is_some() && !response.dragged();
        let settled = (is_done && value != actual).then_some(value);
        let change = Change {
            moved,
            settled,
            shown: value,
        };
        (response, change)
    }
}
