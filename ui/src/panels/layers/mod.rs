//! Layers panel: dry layers, and drying.
//!
//! | module | holds |
//! | --- | --- |
//! | `drying` | controls for drying |
//! | `eye` | visibility of a layer |
//! | `region` | a part of the canvas |

use std::collections::BTreeMap;

use eframe::egui::accesskit::Role;
use eframe::egui::{Align, Button, Key, Layout, TextEdit, Ui, WidgetInfo};
use maulstick_painting::edits::{LayerRef, NameLayer, Opacity};
use maulstick_types::scene::Layer;
use maulstick_types::values::{LayerName, OpacityFactor, ValueError};
use maulstick_ui_kit::language::layer_name;
use maulstick_ui_kit::pending::Pending;
use maulstick_ui_kit::rows::{Number, Sliders, cell, note};

use crate::panels::Panel;
use crate::widgets::context::{PanelContext, ask};

mod drying;
mod eye;
mod region;

/// Widths of a layer's name and of its slider, points.
const NAME: f32 = 92.0;
const WAY: f32 = 84.0;

const OPACITY: Number<'_> = Number::percent::<OpacityFactor>(tr_noop!("Opacity"));

#[derive(Debug, Default)]
pub(crate) struct LayersPanel {
    sliders: Sliders,
    /// Opacities of layers before they were hidden.
    hidden: BTreeMap<u32, f32>,
    /// Opacities that were asked for, until the rig has them.
    asked: BTreeMap<u32, Pending<f32>>,
    /// The layer that is given a name, and the name as far as it is typed.
    naming: Option<(u32, String)>,
    drying: drying::DryingForm,
}

impl Panel for LayersPanel {
    fn title(&self) -> &'static str {
        tr_noop!("Layers")
    }

    fn show(&mut self, ui: &mut Ui, work: &mut PanelContext<'_>) {
        let Some(scene) = &work.rig.live.scene else {
            return;
        };
        let layers = scene.layers.clone();
        let now_s = ui.input(|input| input.time);
        let is_coming = self.is_coming(now_s, &layers, work);
        ui.horizontal(|ui| {
            ui.checkbox(&mut work.rig.show_wet, tr!("Highlight wet paint"))
                .on_hover_text(tr!("Tints wet paint, to distinguish it from dry paint"));
            if is_coming {
                let layout = Layout::right_to_left(Align::Center);
                ui.with_layout(layout, |ui| ui.spinner())
                    .inner
                    .on_hover_text(tr!("The picture of the layers is on its way"));
            }
        });
        self.hidden
            .retain(|number, _| layers.iter().any(|layer| layer.number == *number));
        for layer in layers.iter().rev() {
            self.layer(ui, work, layer);
        }
        if layers.is_empty() {
            note(ui, tr!("Nothing has dried yet: all paint is wet."));
        }
        ui.separator();
        self.drying.show(ui, work, layers.len());
    }
}

/// Makes a layer more or less opaque.
fn opaque(number: u32, opacity: f32) -> Result<Opacity, ValueError> {
    Ok(Opacity {
        layer: LayerRef::Number { number },
        opacity: OpacityFactor::new(opacity)?,
    })
}

impl LayersPanel {
    /// True while an opacity was asked for and is not in the picture of the canvas.
    fn is_coming(&mut self, now_s: f64, layers: &[Layer], work: &PanelContext<'_>) -> bool {
        self.asked
            .retain(|number, _| layers.iter().any(|layer| layer.number == *number));
        let mut asked = layers.iter().filter_map(|layer| {
            let asked = self.asked.get_mut(&layer.number)?;
            Some(asked.shown(now_s, &layer.opacity) != layer.opacity)
        });
        let is_asked = asked.any(|differs| differs);
        let status = work.rig.live.paint.as_ref().map(|node| &node.status);
        is_asked || status.is_some_and(|status| status.baked < status.baking)
    }

    /// Asks for an opacity, and shows it from now on.
    fn ask(&mut self, now_s: f64, work: &mut PanelContext<'_>, (number, opacity): (u32, f32)) {
        if ask(work, opaque(number, opacity)) {
            let asked = self.asked.entry(number).or_default();
            asked.hold(now_s, opacity);
        }
    }

    /// The row of a layer.
    fn layer(&mut self, ui: &mut Ui, work: &mut PanelContext<'_>, layer: &Layer) {
        let number = layer.number;
        ui.push_id(number, |ui| {
            ui.horizontal(|ui| {
                let now_s = ui.input(|input| input.time);
                let asked = self.asked.entry(number).or_default();
                let layer = &Layer {
                    opacity: asked.shown(now_s, &layer.opacity),
                    ..layer.clone()
                };
                if let Some(opacity) = self.eye(ui, layer) {
                    self.ask(now_s, work, (number, opacity));
                }
                match &self.naming {
                    Some((named, _)) if *named == number => self.name(ui, work),
                    _ => self.title(ui, layer),
                }
                ui.spacing_mut().slider_width = WAY;
                let shown = f64::from(layer.opacity);
                let (slider, change) =
                    self.sliders
                        .bare(ui, &OPACITY, &format!("opacity {number}"), shown);
                slider.widget_info(|| {
                    WidgetInfo::slider(
                        true,
                        change.shown,
                        tr!("Opacity of {layer}", layer = layer_name(layer)),
                    )
                });
                // All layers above are computed anew, and an opacity is a step to undo: once is enough.
                if let Some(opacity) = change.settled {
                    self.ask(now_s, work, (number, opacity as f32));
                }
            });
        });
    }

    /// Hides a layer, or shows it as it was; its opacity from now on.
    fn eye(&mut self, ui: &mut Ui, layer: &Layer) -> Option<f32> {
        let is_shown = layer.opacity > 0.0;
        let button = eye::show(ui, is_shown);
        button.widget_info(|| {
            WidgetInfo::selected(
                Role::CheckBox,
                true,
                is_shown,
                tr!("Show {layer}", layer = layer_name(layer)),
            )
        });
        let button = button.on_hover_text(if is_shown {
            tr!("Hide this layer; its relief stays")
        } else {
            tr!("Show this layer again")
        });
        if !button.clicked() {
            return None;
        }
        if is_shown {
            self.hidden.insert(layer.number, layer.opacity);
            return Some(0.0);
        }
        Some(self.hidden.remove(&layer.number).unwrap_or(1.0))
    }

    /// The name of a layer; a click gives it another one.
    fn title(&mut self, ui: &mut Ui, layer: &Layer) {
        let name = cell(ui, NAME, |ui| {
            let name = layer_name(layer);
            let name = ui.add(Button::new(name).frame(false).truncate());
            name.on_hover_text(tr!("Click to give it another name"))
        });
        if name.clicked() {
            self.naming = Some((layer.number, layer.name.clone()));
        }
    }

    /// The field of the name that is being given.
    fn name(&mut self, ui: &mut Ui, work: &mut PanelContext<'_>) {
        let Some((layer, name)) = &mut self.naming else {
            return;
        };
        let field = ui.add(TextEdit::singleline(name).desired_width(NAME - 8.0));
        field.widget_info(|| WidgetInfo::labeled(Role::TextInput, true, tr!("Name of the layer")));
        if field.lost_focus() {
            let given = !ui.input(|input| input.key_pressed(Key::Escape));
            let (layer, name) = (*layer, LayerName::new(name.trim()));
            if given {
                ask(work, name.map(|name| NameLayer { layer, name }));
            }
            self.naming = None;
        } else if !field.has_focus() {
            field.request_focus();
        }
    }
}

#[cfg(test)]
mod tests;
