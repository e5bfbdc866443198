//! Rows of a panel: a word on the left, a control on the right, each named for screen readers.

use std::collections::BTreeMap;
use std::ops::RangeInclusive;

use eframe::egui::{
    Align, ComboBox, Layout, Response, RichText, Slider, SliderClamping, TextWrapMode, Ui,
    UiBuilder, vec2,
};

use maulstick_types::values::Quantity;

use crate::language::{known, translated};
use crate::pending::Pending;
use crate::units::Units;

/// Width of the words at the left, points.
const WORDS: f32 = 84.0;
/// A slider whose ends are this far apart goes by factors.
const ORDERS: f64 = 20.0;

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

/// A number of a slider. Range, unit and hint are those of its type, and cannot be given otherwise:
///
/// ```compile_fail
/// let number = maulstick_ui_kit::rows::Number { word: "Width", range: 0.0..=50.0 };
/// ```
#[derive(Clone, Debug)]
pub struct Number<'a> {
    word: &'a str,
    help: &'a str,
    /// Hint in the language of the window, where it is more than the help.
    hint: Option<&'a str>,
    range: RangeInclusive<f64>,
    unit: &'a str,
    /// Displayed units in one of the type's.
    scale: f64,
    decimals: usize,
    has_digits: bool,
}

impl<'a> Number<'a> {
    /// A number of a type, as the word at its left calls it, with this many digits after the point at most.
    #[must_use]
    pub const fn of<Q: Quantity>(word: &'a str, decimals: usize) -> Self {
        Self {
            word,
            help: Q::HELP,
            hint: None,
            range: Q::USUAL,
            unit: Q::UNIT,
            scale: 1.0,
            decimals,
            has_digits: true,
        }
    }

    /// A share, shown in per cent.
    #[must_use]
    pub const fn percent<Q: Quantity>(word: &'a str) -> Self {
        Self {
            unit: " %",
            scale: 100.0,
            ..Self::of::<Q>(word, 0)
        }
    }

    /// A length in mm, shown in the painter's unit.
    #[must_use]
    pub fn length<Q: Quantity>(word: &'a str, units: Units) -> Self {
        let (unit_mm, decimals, unit) = units.small();
        Self {
            unit,
            scale: 1.0 / unit_mm,
            ..Self::of::<Q>(word, decimals)
        }
    }

    /// The part of the range that can be had here.
    #[must_use]
    pub fn within(mut self, range: &RangeInclusive<f64>) -> Self {
        let [least, most] = [range.start(), range.end()];
        self.range = least.max(*self.range.start())..=most.min(*self.range.end());
        self
    }

    /// With a hint that says more than the help, in the language of the window.
    #[must_use]
    pub fn hint(mut self, hint: &'a str) -> Self {
        self.hint = Some(hint);
        self
    }

    /// Without its digits beside the slider.
    #[must_use]
    pub fn without_digits(mut self) -> Self {
        self.has_digits = false;
        self
    }

    /// True for a range over orders of magnitude.
    fn is_by_factors(&self) -> bool {
        *self.range.start() > 0.0 && self.range.end() / self.range.start() >= ORDERS
    }
}

/// A change of a number; `None` if there was none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Change {
    /// New value while it is dragged, typed or stepped.
    pub moved: Option<f64>,
    /// Final value that differs from the rig's.
    pub settled: Option<f64>,
    /// The displayed value, in the displayed unit.
    pub shown: f64,
    /// True while the slider is dragged.
    pub is_dragged: bool,
}

/// The sliders of a panel, by name, with the value being dragged.
#[derive(Clone, Debug, Default)]
pub struct Sliders {
    held: BTreeMap<String, Pending<f64>>,
}

impl Sliders {
    /// A row with a slider whose number is `actual` in the rig, in the type's unit.
    pub fn row(&mut self, ui: &mut Ui, number: &Number<'_>, actual: f64) -> Change {
        self.keyed(ui, number, number.word, actual)
    }

    /// As [`row`](Self::row), of several of the same word the one of this `key`.
    pub fn keyed(&mut self, ui: &mut Ui, number: &Number<'_>, key: &str, actual: f64) -> Change {
        let mut change = Change::default();
        row(ui, translated(number.word), |ui| {
            let (response, changed) = self.bare(ui, number, key, actual);
            change = changed;
            response
        });
        change
    }

    /// Rows of numbers that take effect while they are dragged; true if one was moved.
    pub fn rows<'n>(
        &mut self,
        ui: &mut Ui,
        numbers: impl IntoIterator<Item = (&'n Number<'n>, &'n mut f64)>,
    ) -> bool {
        let mut is_moved = false;
        for (number, value) in numbers {
            if let Some(moved) = self.row(ui, number, *value).moved {
                (*value, is_moved) = (moved, true);
            }
        }
        is_moved
    }

    /// As [`row`](Self::row), without the word, for a number of this `key`.
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
        let actual = rounded(actual * number.scale);
        let shown = held.shown(now_s, &actual);
        let mut value = shown;
        let ends = [number.range.start(), number.range.end()].map(|end| end * number.scale);
        let slider = Slider::new(&mut value, ends[0]..=ends[1])
            .suffix(number.unit)
            .show_value(number.has_digits)
            .max_decimals(number.decimals)
            .logarithmic(number.is_by_factors())
            .smallest_positive(0.5 / fine)
            .clamping(SliderClamping::Never)
            .update_while_editing(false);
        let response = ui.push_id(key, |ui| ui.add(slider)).inner;
        let hint = number.hint.unwrap_or_else(|| translated(number.help));
        let response = response.on_hover_text(hint);
        let value = rounded(value);
        let moved = (response.changed() && value != shown).then_some(value);
        if moved.is_some() || response.dragged() {
            held.hold(now_s, value);
        }
        let is_done = response.drag_stopped() || moved.is_some() && !response.dragged();
        let settled = (is_done && value != actual).then_some(value);
        let in_unit = |value: f64| value / number.scale;
        let change = Change {
            moved: moved.map(in_unit),
            settled: settled.map(in_unit),
            shown: value,
            is_dragged: response.dragged(),
        };
        (response, change)
    }
}
