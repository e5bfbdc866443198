//! Publisher of contact models for the devices that move the brush.

use maulstick_bus::typed::Sender;
use maulstick_bus::{BusError, Qos};
use maulstick_types::Origin;

use super::{BrushNode, Painter};
use crate::contact_model::{SurfaceFeel, contact_model, law};

/// Least time between two contact models, ns.
const MODEL_PERIOD_NS: u64 = 4_000_000;

impl BrushNode {
    /// Gives a force-feedback device its contact model.
    pub(super) fn feel(
        &mut self,
        device: &str,
        origin: Origin,
        now_ns: u64,
    ) -> Result<(), BusError> {
        let drives_force = self
            .devices
            .get(device)
            .is_some_and(|told| told.drives_force);
        if !drives_force || self.painter == Painter::Gone {
            return Ok(());
        }
        let Some(plane) = self.model.plane().copied() else {
            return Ok(());
        };
        if !self.models.has(device) {
            let topic = self.topics.contact_model(device);
            let me = self.states.origin();
            let sender = Sender::new(&*self.bus, &topic, Qos::RealTime, me)?;
            self.models.set(device, (sender, 0));
        }
        let Some((sender, sent_ns)) = self.models.get_mut(device) else {
            return Ok(());
        };
        if now_ns < *sent_ns + MODEL_PERIOD_NS {
            return Ok(());
        }
        *sent_ns = now_ns;
        let kind = self
            .settings
            .devices
            .laws
            .get(device)
            .copied()
            .unwrap_or_default();
        let felt = SurfaceFeel {
            law: law(kind, &mut self.model, &plane),
            drag_n_s_m: self.drag_n_s_m,
            grain: self.grain.clone(),
        };
        let name = &self.settings.name;
        let model = contact_model(origin, name, self.model.file(), &plane, felt);
        sender.send(now_ns, now_ns, &model)?;
        Ok(())
    }
}
