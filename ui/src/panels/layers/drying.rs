//! Controls for drying: share, region, at once or over time; and for varnish.

use eframe::egui::{DragValue, ProgressBar, TextEdit, Ui};
use maulstick_painting::clock::TICKS_A_SECOND;
use maulstick_painting::edits::{Dry, Finish, StopDrying, Varnish, Wet};
use maulstick_types::Region;
use maulstick_types::paint::PaintStatus;
use maulstick_types::scene::CANVAS;
use maulstick_types::values::{LayerName, Quantity, Share, Ticks, ValueError};
use maulstick_ui_kit::language::translated;
use maulstick_ui_kit::rows::{Number, Sliders, choice, row};

use super::region;
use crate::widgets::context::{PanelContext, ask};

const PLACES: [&str; 2] = [tr_noop!("Whole canvas"), tr_noop!("A part")];

const SHARE: Number<'_> = Number::percent::<Share>(tr_noop!("How much"));

const SHINE: &str = tr_noop!("A clear coat on the canvas and on what has dried");
/// Buttons of the varnish: what each asks for, its word and what it does.
const VARNISHES: [(Finish, &str, &str); 4] = [
    (Finish::Gloss, tr_noop!("Gloss"), SHINE),
    (Finish::Satin, tr_noop!("Satin"), SHINE),
    (Finish::Matt, tr_noop!("Matt"), SHINE),
    (
        Finish::Off,
        tr_noop!("Off"),
        tr_noop!("Takes off the varnish that lies on top"),
    ),
];

/// A drying in progress.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Drying {
    /// Share of its time that went by, 0 to 1.
    pub share: f32,
    /// Time left, s.
    pub left_s: f64,
    /// Name of its layer; empty where it is called by its number.
    pub layer: String,
}

/// Drying of the canvas as the paint node reports it.
fn drying(status: &PaintStatus) -> Option<Drying> {
    let drying = status.drying.as_ref()?;
    Some(Drying {
        share: drying.share,
        left_s: f64::from(drying.ticks_left) / 60.0,
        layer: drying.layer.clone(),
    })
}

/// Form for the next drying.
#[derive(Clone, Debug)]
pub(super) struct DryingForm {
    sliders: Sliders,
    share: f64,
    name: String,
    /// The region; `None` for all of it.
    part: Option<Region>,
    /// Duration of a drying over time, s.
    time_s: f64,
}

impl Default for DryingForm {
    fn default() -> Self {
        Self {
            sliders: Sliders::default(),
            share: 1.0,
            name: String::new(),
            part: None,
            time_s: 120.0,
        }
    }
}

/// Rejects a part that is empty.
fn checked(part: &Option<Region>) -> Result<(), ValueError> {
    part.as_ref().map_or(Ok(()), Region::check)
}

impl DryingForm {
    /// Shows it; `layers` have dried so far.
    pub(super) fn show(&mut self, ui: &mut Ui, work: &mut PanelContext<'_>, layers: usize) {
        let change = self.sliders.row(ui, &SHARE, self.share);
        self.share = change.moved.unwrap_or(self.share);
        row(ui, tr!("Name"), |ui| {
            let name = TextEdit::singleline(&mut self.name).hint_text(tr!("of the new layer"));
            ui.add(name.desired_width(f32::INFINITY))
        });
        let Some(canvas) = work.rig.live.canvas() else {
            return;
        };
        let size_m = canvas.cells.map(|cells| f64::from(cells) * canvas.cell_m);
        let place = PLACES[usize::from(self.part.is_some())];
        if let Some(chosen) = choice(ui, tr!("Where"), place, PLACES) {
            self.part = (chosen == PLACES[1]).then(|| region::middle(size_m));
        }
        if let Some(region) = &mut self.part {
            region::show(ui, region, size_m, work.preferences.window.units);
        }
        ui.horizontal(|ui| {
            let dry = ui
                .button(tr!("Dry"))
                .on_hover_text(tr!("Wet paint becomes a dry layer at once"));
            if dry.clicked() {
                let share = Share::in_unit(self.share);
                ask(work, share.and_then(|share| self.dry(share, None)));
                self.name.clear();
            }
            let wet = ui.add_enabled(layers > 0, eframe::egui::Button::new(tr!("Wet again")));
            let wet = wet.on_hover_text(tr!("The newest dry layer becomes wet paint again"));
            if wet.clicked() {
                let wet = Wet {
                    surface: CANVAS,
                    layers: Some(1),
                    region: self.part.clone(),
                };
                ask(work, checked(&self.part).map(|()| wet));
            }
        });
        self.in_time(ui, work);
        self.varnish(ui, work);
    }

    /// Varnish on what the form says is dry, or off it.
    fn varnish(&self, ui: &mut Ui, work: &mut PanelContext<'_>) {
        ui.horizontal(|ui| {
            ui.label(tr!("Varnish"));
            for (finish, name, does) in VARNISHES {
                let button = ui.button(translated(name)).on_hover_text(translated(does));
                if button.clicked() {
                    let region = self.part.clone();
                    let asked = checked(&region).map(|()| Varnish { finish, region });
                    ask(work, asked);
                }
            }
        });
    }

    /// The drying of what the form says.
    fn dry(&self, share: Share, over: Option<Ticks>) -> Result<Dry, ValueError> {
        checked(&self.part)?;
        let name = self.name.trim();
        let layer = (!name.is_empty()).then(|| LayerName::new(name));
        Ok(Dry {
            share,
            layer: layer.transpose()?,
            region: self.part.clone(),
            over,
            surface: CANVAS,
        })
    }

    /// Drying while time goes by.
    fn in_time(&mut self, ui: &mut Ui, work: &mut PanelContext<'_>) {
        row(ui, tr!("Dry over"), |ui| {
            let time = DragValue::new(&mut self.time_s)
                .range(Ticks::USUAL)
                .speed(1.0)
                .custom_formatter(|seconds, _| clock(seconds))
                .custom_parser(seconds);
            let time = ui.add(time);
            let start = ui.button(tr!("Start")).on_hover_text(tr!(
                "All that is wet there dries evenly; one may paint meanwhile"
            ));
            if start.clicked() {
                let ticks = (self.time_s * f64::from(TICKS_A_SECOND)).round() as u32;
                let over = Ticks::new(ticks).map(Some);
                ask(work, over.and_then(|over| self.dry(Share::WHOLE, over)));
                self.name.clear();
            }
            let stop = ui
                .button(tr!("Stop"))
                .on_hover_text(tr!("What is wet still stays wet"));
            if stop.clicked() {
                ask(work, Ok(StopDrying { surface: CANVAS }));
            }
            time.on_hover_text(tr!("Minutes and seconds"))
        });
        let status = work.rig.live.paint.as_ref().map(|paint| &paint.status);
        if let Some(goes_on) = status.and_then(drying) {
            let time = clock(goes_on.left_s);
            let text = match goes_on.layer.as_str() {
                "" => tr!("Dries: {time} left", time),
                layer => tr!("{layer}: {time} left", layer, time),
            };
            ui.add(ProgressBar::new(goes_on.share).text(text));
        }
    }
}

/// Seconds as minutes and seconds.
fn clock(seconds: f64) -> String {
    let whole = seconds.round().max(0.0) as u64;
    format!("{}:{:02}", whole / 60, whole % 60)
}

/// Reads minutes and seconds, or seconds.
fn seconds(text: &str) -> Option<f64> {
    let text = text.trim();
    match text.split_once(':') {
        Some((minutes, seconds)) => {
            let part = |text: &str| text.trim().parse::<f64>().ok().filter(|v| *v >= 0.0);
            Some(60.0 * part(minutes)? + part(seconds)?)
        }
        None => text.parse().ok(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_written_as_they_are_read() {
        for (text, time_s) in [("2:00", 120.0), ("0:07", 7.0), ("75:30", 4530.0)] {
            assert_eq!(
                (clock(time_s).as_str(), seconds(text)),
                (text, Some(time_s))
            );
        }
        assert_eq!(seconds("90"), Some(90.0));
        assert_eq!(seconds("a:10"), None);
        assert_eq!(seconds("-1:10"), None);
    }
}
