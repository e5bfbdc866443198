//! The panels: a list of one file each. They are hidden until they are wanted.

use eframe::egui::Ui;

use crate::work::Work;

/// A panel.
pub trait Panel {
    /// What it is called.
    fn title(&self) -> &'static str;

    /// Shows it in a column of the window.
    fn show(&mut self, ui: &mut Ui, work: &mut Work<'_>);
}

/// All panels, from the top.
#[must_use]
pub fn all() -> Vec<Box<dyn Panel>> {
    vec![
        Box::<brush::BrushPanel>::default(),
        Box::<tubes::TubesPanel>::default(),
        Box::<layers::LayersPanel>::default(),
        Box::<light::LightPanel>::default(),
        Box::<canvas::CanvasPanel>::default(),
        Box::<history::HistoryPanel>::default(),
        Box::<device::DevicePanel>::default(),
    ]
}

pub mod brush;
pub mod canvas;
pub mod device;
pub mod history;
pub mod layers;
pub mod light;
pub mod tubes;
