//! Presets taken up, and made of the brush in the hand.

use maulstick_painting::edits::common;
use maulstick_rig::UserError;
use maulstick_types::command::Command;
use maulstick_types::scene::BrushMode;

use crate::settings::brush_library::is_of_library;
use crate::settings::presets::{BeforePreset, Preset};
use crate::widgets::context::PanelContext;

impl PanelContext<'_> {
    /// A preset of the brush in hand with its current settings; `None` until it is known.
    #[must_use]
    pub(crate) fn preset_in_hand(&self, name: &str) -> Option<Preset> {
        let file = self.in_hand()?;
        let (tuning, handling) = (self.rig.tuning(), self.rig.handling());
        let text = if is_of_library(file) {
            String::new()
        } else {
            file.to_toml().ok()?
        };
        let mut modes = BrushMode::NAMES.iter();
        let mode = modes.find(|(_, mode)| *mode == handling.mode);
        Some(Preset {
            name: name.to_owned(),
            kind: file.kind.clone(),
            width_mm: file.head.width_mm,
            file: text,
            stiffness: tuning.stiffness,
            wetness: tuning.wetness,
            mode: mode.map_or("normal", |(name, _)| name).to_owned(),
            flow: handling.flow,
            most_m: handling.most_m,
            loading: self.preferences.brushes.loading.clone(),
            clean: false,
            pressure: Some(self.preferences.brushes.mouse.pressure),
        })
    }

    /// Takes up a preset: the brush, its settings, and then its paint.
    ///
    /// # Errors
    /// A [`UserError`] for an invalid part; nothing is changed then.
    pub(crate) fn take_up_preset(&mut self, preset: &Preset) -> Result<(), UserError> {
        if !self.may_change_brush() {
            return Ok(());
        }
        let file = preset.brush()?;
        let brush = self.rig.brush_name().to_owned();
        let [tune, handle] = preset.edits(&brush)?;
        let mut loading = preset.loading.clone();
        if loading.paint.is_empty() && loading.thinner > 0.0 {
            loading
                .paint
                .clone_from(&self.preferences.brushes.loading.paint);
        }
        let load: Option<Command> = match loading.paint.is_empty() {
            true if preset.clean => Some(common::clean(&brush)?.into()),
            true => None,
            false => Some(loading.command(&brush, &self.rig.library)?),
        };
        let (tuning, pressure) = (self.rig.tuning(), self.preferences.brushes.mouse.pressure);
        let before = &mut self.preferences.brushes.before_preset;
        before.take_if(|before| before.brush != brush);
        before.get_or_insert(BeforePreset {
            brush: brush.clone(),
            pressure,
            stiffness: tuning.stiffness,
            wetness: tuning.wetness,
        });
        self.take_up(file);
        self.requests.send(tune);
        self.requests.send(handle);
        if let Some(pressure) = preset.pressure {
            self.preferences.brushes.mouse.pressure = pressure;
            self.preferences.brushes.mouse = self.preferences.brushes.mouse.sane();
        }
        if loading.paint.is_empty() && loading.thinner > 0.0 {
            let percent = 100.0 * loading.thinner;
            let words = tr!(
                "The next paint that you load is thinned by {percent} %",
                percent = format_args!("{percent:.0}")
            );
            self.notifications.note(words);
            self.preferences.brushes.loading.thinner = loading.thinner;
        }
        if !loading.paint.is_empty() {
            self.preferences.brushes.loading = loading;
        }
        if let Some(load) = load {
            self.then(load);
        }
        Ok(())
    }
}
