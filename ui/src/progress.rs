//! What the paint node has to say: how far a long work is, and that the painting cannot be written.
//! A line over the desk, gone when it is over.

use eframe::egui;
use maulstick_bus::typed::Receiver;
use maulstick_bus::{Bus, BusError, Class, Queue, Wake};
use maulstick_types::paint::PaintStatus;
use maulstick_types::topics::Topics;

/// What the paint node said of its work.
#[derive(Debug)]
pub struct WorkProgress {
    statuses: Receiver<PaintStatus>,
    baking: u32,
    baked: u32,
    fault: String,
}

impl WorkProgress {
    /// Follows the paint node.
    ///
    /// # Errors
    /// [`BusError::Topic`].
    pub fn new(bus: &dyn Bus, topics: &Topics, wake: &Wake) -> Result<Self, BusError> {
        let topic = topics.paint_status();
        Ok(Self {
            statuses: Receiver::new(bus, &topic, Class::Background, Queue::Ring(4), wake)?,
            baking: 0,
            baked: 0,
            fault: String::new(),
        })
    }

    /// Takes in what has come.
    pub fn take_in(&mut self) {
        if let Some(status) = self.statuses.newest() {
            let PaintStatus {
                baking,
                baked,
                fault,
                ..
            } = status.message;
            (self.baking, self.baked, self.fault) = (baking, baked, fault);
        }
    }

    /// The line; none where nothing is to be said. What cannot be saved comes first.
    #[must_use]
    pub fn line(&self) -> Option<String> {
        if !self.fault.is_empty() {
            return Some(format!("The painting is not being saved: {}", self.fault));
        }
        let share = 100 * u64::from(self.baked) / u64::from(self.baking.max(1));
        (self.baked < self.baking).then(|| format!("Relighting dry layers: {share} %"))
    }

    /// Shows the line at the lower edge.
    pub fn show(&self, context: &egui::Context) {
        let Some(line) = self.line() else {
            return;
        };
        egui::Area::new(egui::Id::unique("progress"))
            .anchor(egui::Align2::CENTER_BOTTOM, [0.0, -12.0])
            .interactable(false)
            .show(context, |ui| {
                egui::Frame::popup(ui.style()).show(ui, |ui| ui.label(line));
            });
    }
}
