//! Settings of a device of the rig, changed while it paints: its name, brush, force, pressure, switches and place.

use eframe::egui::{CollapsingHeader, Frame, Key, RichText, TextEdit, Ui};
use maulstick_device::pressure_curve::sensed;
use maulstick_rig::config::{ACTIONS, DeviceSection, FORCES, PEN_DRIVERS};
use maulstick_ui_kit::rows::{choice, note, row};

use maulstick_client::state::Device;
use maulstick_device_setup::change::DeviceChange;
use maulstick_device_setup::listing::RigDevice;

use super::pressure_curve::CurveEditor;
use crate::rig::device_order::{DeviceOrder, SetupChange};
use crate::rig::device_setup::fit_event;
use crate::widgets::context::PanelContext;

/// Settings that are being changed.
#[derive(Debug, Default)]
pub(super) struct Edits {
    /// The pressure curve that is being drawn.
    pub(super) curve: CurveEditor,
    /// The device whose name is being typed, and the name so far.
    typed: Option<(String, String)>,
    /// The device that was given another name last, and that name.
    pub(super) renamed: Option<(String, String)>,
}

impl Edits {
    /// The name of one of the user's devices; it is given another one once that is typed.
    fn name(&mut self, ui: &mut Ui, device: &str, work: &mut PanelContext<'_>) {
        let typed = self.typed.take_if(|(own, _)| own == device);
        let mut name = typed.map_or_else(|| device.to_owned(), |(_, name)| name);
        let field = row(ui, tr!("Name"), |ui| {
            let width = ui.available_width();
            let field = ui.add(TextEdit::singleline(&mut name).desired_width(width));
            field.on_hover_text(tr!("The device restarts under the name that you enter"))
        });
        if field.has_focus() {
            self.typed = Some((device.to_owned(), name));
            return;
        }
        let is_left = ui.input(|input| input.key_pressed(Key::Escape)) || !ui.is_enabled();
        let name = name.trim();
        if field.lost_focus() && !is_left && !name.is_empty() && name != device {
            work.requests.change_device(SetupChange::Rename {
                device: device.to_owned(),
                name: name.to_owned(),
            });
            self.renamed = Some((device.to_owned(), name.to_owned()));
        }
    }
}

/// Shows them, folded until they are wanted.
pub(super) fn show(
    ui: &mut Ui,
    known: &RigDevice,
    device: &Device,
    edits: &mut Edits,
    work: &mut PanelContext<'_>,
) {
    let section = &known.section;
    let name = section.name.clone();
    // The name was typed here.
    let is_renamed = edits.renamed.as_ref().is_some_and(|(_, own)| *own == name);
    CollapsingHeader::new(tr!("Settings"))
        .id_salt("settings")
        .default_open(is_renamed)
        .show(ui, |ui| {
            if known.is_own {
                edits.name(ui, &name, work);
            }
            let brushes: Vec<String> = work
                .rig
                .brushes
                .iter()
                .map(|brush| brush.name.clone())
                .collect();
            let mut change = DeviceChange::default();
            if brushes.len() > 1 {
                let names = brushes.iter().map(String::as_str);
                change.brush = choice(ui, tr!("Brush"), &section.brush, names);
            }
            if !PEN_DRIVERS.contains(&&*section.driver) && section.driver != "spacemouse" {
                change.force = choice(ui, tr!("Force"), &section.force, FORCES);
            }
            change.switches = switches(ui, section);
            if PEN_DRIVERS.contains(&&*section.driver) {
                ui.label(tr!("Pressure"));
                let newest = device.samples.newest(work.rig.live.now_ns);
                let given = newest.and_then(|sample| sample.pen).map(|(given, _)| given);
                let sensed = given.map(|given| sensed(&section.pressure_curve, given));
                let curve = &section.pressure_curve;
                change.pressure_curve = edits.curve.show(ui, &name, curve, sensed);
            }
            if change != DeviceChange::default() {
                work.requests.change_device(SetupChange::Use(DeviceChange {
                    device: name,
                    priority: Some(section.priority),
                    ..change
                }));
            }
        });
}

/// Switches of the device, with the meaning of each.
fn switches(ui: &mut Ui, section: &DeviceSection) -> Option<Vec<String>> {
    let actions = section.actions();
    let mut chosen = None;
    for (place, action) in actions.iter().enumerate() {
        let number = place + 1;
        let word = tr!("Switch {number}", number);
        if let Some(other) = choice(ui, &word, action, ACTIONS) {
            let mut changed: Vec<String> = actions.iter().map(|&own| own.to_owned()).collect();
            changed[place] = other;
            chosen = Some(changed);
        }
    }
    chosen
}

/// The fit in progress: the rig has let go of its device meanwhile.
pub(super) fn fit(ui: &mut Ui, work: &mut PanelContext<'_>) {
    let Some(fit) = work.rig.setup.fit.clone() else {
        return;
    };
    Frame::group(ui.style()).show(ui, |ui| {
        ui.set_width(ui.available_width());
        let device = &fit.device;
        ui.label(RichText::new(tr!("Fitting '{device}' to the canvas", device)).strong());
        for (place, event) in fit.events.iter().enumerate() {
            let line = RichText::new(fit_event(event));
            ui.label(if place + 1 == fit.events.len() {
                line.strong()
            } else {
                line
            });
        }
        if ui.button(tr!("Stop fitting")).clicked() {
            work.requests.order_device(DeviceOrder::StopFit);
        }
    });
}

/// Buttons of a device: that it paints, its fit, its end.
pub(super) fn buttons(ui: &mut Ui, known: &RigDevice, work: &mut PanelContext<'_>) {
    let section = &known.section;
    let name = &section.name;
    ui.horizontal_wrapped(|ui| {
        let others = work
            .rig
            .live
            .devices
            .iter()
            .filter(|(other, _)| *other != name);
        let infos = others.filter_map(|(_, other)| other.info.as_ref());
        let rivals = infos.filter(|info| info.brush == section.brush);
        let highest = rivals.map(|info| info.priority).max();
        let is_first = highest.is_none_or(|highest| section.priority > highest);
        let hint = tr!("Where several are in range, this one paints");
        let first = ui.add_enabled(!is_first, eframe::egui::Button::new(tr!("Paint with it")));
        if first.on_hover_text(hint).clicked() {
            work.requests.change_device(SetupChange::Use(DeviceChange {
                device: name.clone(),
                ..DeviceChange::default()
            }));
        }
        let idle = work.rig.setup.fit.is_none();
        if known.is_own && section.driver != "spacemouse" {
            let fit = ui.add_enabled(idle, eframe::egui::Button::new(tr!("Fit to the canvas…")));
            let hint = tr!("Touch three corners of the canvas with it");
            if fit.on_hover_text(hint).clicked() {
                work.requests.order_device(DeviceOrder::Fit(name.clone()));
            }
        }
        let hint = tr!("It moves the brush no more");
        let remove = ui.add_enabled(idle, eframe::egui::Button::new(tr!("Remove")));
        if remove.on_hover_text(hint).clicked() {
            work.requests
                .change_device(SetupChange::Remove(name.clone()));
        }
    });
}

/// The pressure curve of pens over the window.
pub(super) fn window_pen(ui: &mut Ui, curve: &mut CurveEditor, work: &mut PanelContext<'_>) {
    CollapsingHeader::new(tr!("Settings"))
        .id_salt("settings")
        .show(ui, |ui| {
            ui.label(tr!("Pressure"));
            const STRAIGHT: &[[f64; 2]] = &[[0.0, 0.0], [1.0, 1.0]];
            let own = work.preferences.brushes.pen_curve.clone();
            let sensed = work.rig.pen_pressure;
            let actual = if own.is_empty() { STRAIGHT } else { &own };
            if let Some(drawn) = curve.show(ui, "pen", actual, sensed) {
                work.preferences.brushes.pen_curve = drawn;
            }
            note(ui, tr!("Press here: over a panel the pen paints nothing."));
        });
}
