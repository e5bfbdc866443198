//! Light panel: direction, strength and spectrum of the lamp; exposure.
//!
//! | module | holds |
//! | --- | --- |
//! | `environment_file` | surroundings from a picture |
//! | `lamp_undo` | changes of the light, as undo takes them |
//! | `pad` | pad on which the lamp is dragged |
//! | `sphere` | a ball lit by the lamp |

use std::path::Path;

use eframe::egui::{CollapsingHeader, TextEdit, TextureHandle, TextureOptions, Ui};
use maulstick_appearance::light::changes_colour;
use maulstick_optics::cie::ILLUMINANTS;
use maulstick_painting::edits::Relight;
use maulstick_types::scene::{
    Environment, Exposure, Intensity, Light, RULES, Relief, Softness, Wavelengths,
};
use maulstick_types::values::ValueError;
use maulstick_ui_kit::pending::Pending;
use maulstick_ui_kit::rows::{Number, Sliders, below, choice, note, row, wrong};

use crate::panels::Panel;
use crate::spectrum_file;
use crate::widgets::context::{PanelContext, ask};

pub(crate) mod environment_file;
pub(crate) mod lamp_undo;
mod pad;
mod sphere;

/// Descriptions of the CIE's illuminants, in their order.
const LIKE: [&str; ILLUMINANTS.len()] = [
    tr_noop!("A, light bulb"),
    tr_noop!("D50, warm daylight"),
    tr_noop!("D65, daylight"),
    tr_noop!("FL2, cool white tube"),
    tr_noop!("FL8, broad-band tube"),
    tr_noop!("FL11, three-band tube"),
];
/// Surroundings that need no file, in the order of their names, and those of a picture.
const AROUND: [&str; Environment::NAMES.len()] =
    [tr_noop!("Even"), tr_noop!("Studio"), tr_noop!("Window")];
/// Years of the observers.
const OBSERVERS: [(&str, u32); 2] = [("1931, 2°", 1931), ("1964, 10°", 1964)];

const STRENGTH: Number<'_> = Number::of::<Intensity>(tr_noop!("Strength"), 2);
const EXPOSURE: Number<'_> = Number::of::<Exposure>(tr_noop!("Exposure"), 2);
const RELIEF: Number<'_> = Number::of::<Relief>(tr_noop!("Relief"), 2);
const SOFTNESS: Number<'_> = Number::of::<Softness>(tr_noop!("Softness"), 2);
const WAVELENGTHS: Number<'_> = Number::of::<Wavelengths>(tr_noop!("Samples"), 0);

#[derive(Default)]
pub(crate) struct LightPanel {
    asked: Pending<Light>,
    sliders: Sliders,
    sphere: Option<(Light, TextureHandle)>,
    /// Path of a spectrum, and what is wrong with it.
    file: String,
    told: String,
}

impl Panel for LightPanel {
    fn title(&self) -> &'static str {
        tr_noop!("Light")
    }

    fn show(&mut self, ui: &mut Ui, work: &mut PanelContext<'_>) {
        let Some(actual) = work
            .rig
            .live
            .scene
            .as_ref()
            .map(|scene| scene.light.clone())
        else {
            return;
        };
        let now_s = ui.input(|input| input.time);
        let before = self.asked.shown(now_s, &actual);
        let mut light = before.clone();
        let mut expose = self.lamp(ui, &mut light);
        self.spectrum(ui, &mut light);
        surroundings(ui, &mut light, work);
        self.sliders.rows(
            ui,
            [
                (&RELIEF, &mut light.relief),
                (&SOFTNESS, &mut light.softness),
            ],
        );
        CollapsingHeader::new(tr!("Advanced colour")).show(ui, |ui| self.research(ui, &mut light));
        if light == before && !expose {
            return;
        }
        // Another spectrum is as bright as the last one.
        expose |= changes_colour(&light, &before);
        let relight = Relight {
            light: light.clone(),
            expose,
        };
        let relight = light.check().map(|()| relight).map_err(ValueError::from);
        if ask(work, relight) && !expose {
            self.asked.hold(now_s, light);
        } else {
            self.asked.release();
        }
    }
}

impl LightPanel {
    /// Direction and strength of the lamp; `true` if the exposure has to be chosen again.
    fn lamp(&mut self, ui: &mut Ui, light: &mut Light) -> bool {
        let texture = self.ball(ui, light);
        ui.vertical_centered(|ui| {
            if let Some(direction) = pad::show(ui, texture, light.direction) {
                light.direction = direction;
            }
            note(ui, pad::words(light.direction));
        });
        self.sliders.rows(
            ui,
            [
                (&STRENGTH, &mut light.intensity),
                (&EXPOSURE, &mut light.exposure),
            ],
        );
        below(ui, |ui| {
            let button = ui.button(tr!("Auto exposure"));
            let button =
                button.on_hover_text(tr!("So that the bare canvas is as bright as it can be"));
            button.clicked()
        })
    }

    /// The ball under the lamp, drawn again when the light changes.
    fn ball(&mut self, ui: &Ui, light: &Light) -> eframe::egui::TextureId {
        let known = self.sphere.as_ref();
        if known.is_none_or(|(drawn, _)| drawn != light) {
            let image = sphere::draw(light);
            let texture = match self.sphere.take() {
                Some((_, mut texture)) => {
                    texture.set(image, TextureOptions::LINEAR);
                    texture
                }
                None => ui.ctx().load_texture("lamp", image, TextureOptions::LINEAR),
            };
            self.sphere = Some((light.clone(), texture));
        }
        let texture = self.sphere.as_ref().map(|(_, texture)| texture.id());
        texture.unwrap_or_default()
    }

    /// Spectrum of the lamp.
    fn spectrum(&mut self, ui: &mut Ui, light: &mut Light) {
        let known = ILLUMINANTS
            .iter()
            .position(|name| *name == light.illuminant);
        let known = known.filter(|_| light.spectrum.is_empty());
        let shown = known.map_or(light.illuminant.as_str(), |place| LIKE[place]);
        let chosen = choice(ui, tr!("Light"), shown, LIKE);
        if let Some(place) = chosen.and_then(|chosen| LIKE.iter().position(|l| **l == chosen)) {
            ILLUMINANTS[place].clone_into(&mut light.illuminant);
            light.spectrum.clear();
        }
        ui.checkbox(&mut light.adapted, tr!("White-balance to this light"))
            .on_hover_text(tr!(
                "White looks white; else the light's own colour is seen"
            ));
    }

    /// A measured lamp, and the conversion of its light to colour.
    fn research(&mut self, ui: &mut Ui, light: &mut Light) {
        row(ui, tr!("Light from"), |ui| {
            let edit =
                TextEdit::singleline(&mut self.file).hint_text(tr!("a file of measurements"));
            let edit = ui.add(edit.desired_width(f32::INFINITY));
            let entered = ui.input(|input| input.key_pressed(eframe::egui::Key::Enter));
            if edit.lost_focus() && entered && !self.file.trim().is_empty() {
                self.told.clear();
                match spectrum_file::light(Path::new(self.file.trim())) {
                    Ok(found) => {
                        light.illuminant = found.name;
                        light.spectrum = found.power.0.to_vec();
                    }
                    Err(fault) => self.told = spectrum_file::told(&fault),
                }
            }
            edit.on_hover_text(tr!(
                "The whole path of a measured lamp, a line for each wavelength in nm and its power; Enter reads it"
            ))
        });
        if !self.told.is_empty() {
            wrong(ui, &self.told);
        }
        let year = OBSERVERS.iter().find(|(_, year)| *year == light.observer);
        let (shown, _) = year.unwrap_or(&OBSERVERS[0]);
        let chosen = choice(ui, tr!("Observer"), shown, OBSERVERS.map(|(name, _)| name));
        let year = OBSERVERS
            .iter()
            .find(|(name, _)| chosen.as_deref() == Some(name));
        light.observer = year.map_or(light.observer, |(_, year)| *year);
        if let Some(rule) = choice(ui, tr!("Rule"), &light.rule.clone(), RULES) {
            light.rule = rule;
        }
        if light.rule == "reference" {
            note(ui, tr!("All 101 wavelengths: slow, and exact."));
            return;
        }
        let change = self.sliders.row(ui, &WAVELENGTHS, f64::from(light.samples));
        if let Some(samples) = change.settled {
            light.samples = samples.clamp(0.0, 1e6) as u32;
        }
    }
}

/// What the gloss mirrors besides the lamp.
fn surroundings(ui: &mut Ui, light: &mut Light, work: &mut PanelContext<'_>) {
    let picture = tr_noop!("A picture…");
    let name = light.environment.name();
    let known = Environment::NAMES.iter().position(|own| *own == name);
    let known = known.filter(|_| !matches!(light.environment, Environment::Picture { .. }));
    let shown = known.map_or(name, |place| AROUND[place]);
    let names = AROUND.into_iter().chain([picture]);
    let Some(chosen) = choice(ui, tr!("Surroundings"), shown, names) else {
        return;
    };
    match AROUND.iter().position(|own| **own == chosen) {
        Some(place) => {
            let named = Environment::named(Environment::NAMES[place]);
            light.environment = named.unwrap_or_default();
        }
        None => work.requests.choose_environment(),
    }
}

#[cfg(test)]
mod tests;
