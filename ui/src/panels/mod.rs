//! The panels, hidden until they are wanted.
//!
//! | module | panel |
//! | --- | --- |
//! | [`brush`] | shape, width, stiffness and wetness of the brush; mode, load, presets |
//! | [`paints`] | the measured paints, and the wells of the palette |
//! | [`layers`] | dry layers; drying |
//! | [`light`] | the lamp |
//! | [`canvas`] | size, tooth, ground; tilt, turn, zoom |
//! | [`history`] | undo, redo, versions |
//! | [`device`] | styluses and their force |
//!
//! Edits that keys, gestures and dialogs ask for are in [`common`](maulstick_painting::edits::common).

use eframe::egui::Ui;

use crate::widgets::context::PanelContext;

pub(crate) trait Panel {
    /// Title of the panel.
    fn title(&self) -> &'static str;

    /// Shows it in a column of the window.
    fn show(&mut self, ui: &mut Ui, work: &mut PanelContext<'_>);
}

/// All panels, from the top.
#[must_use]
pub(crate) fn all() -> Vec<Box<dyn Panel>> {
    vec![
        Box::<brush::BrushPanel>::default(),
        Box::<paints::PaintsPanel>::default(),
        Box::<layers::LayersPanel>::default(),
        Box::<light::LightPanel>::default(),
        Box::<canvas::CanvasPanel>::default(),
        Box::<history::HistoryPanel>::default(),
        Box::<device::DevicePanel>::default(),
    ]
}

pub(crate) mod brush;
pub(crate) mod canvas;
pub(crate) mod device;
pub(crate) mod history;
pub(crate) mod layers;
pub(crate) mod light;
pub(crate) mod paints;
