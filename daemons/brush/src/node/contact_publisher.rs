//! Publisher of contact models, and of the paint's drag, for the devices that move the brush.

use glam::DVec3;
use maulstick_bus::typed::Sender;
use maulstick_bus::{BusError, Qos};
use maulstick_num::geometry::Rigid;
use maulstick_types::Origin;
use maulstick_types::haptics::{FluidForce, HeightPatch};

use super::{BrushNode, Painter};
use crate::contact_model::{SurfaceFeel, contact_model, law};
use crate::fluid_force::{Held, PERIOD_NS, fluid_force};
use crate::relief::height_patch;

/// Least time between two contact models, ns.
const MODEL_PERIOD_NS: u64 = 4_000_000;

/// Forces of paint to a device, and the newest one.
pub(super) struct DragSent {
    forces: Sender<FluidForce>,
    sent_ns: u64,
    drag_n_s_m: f64,
}

impl BrushNode {
    /// Gives a force-feedback device its contact model.
    pub(super) fn feel(
        &mut self,
        device: &str,
        origin: Origin,
        held: &Held,
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
        self.drag_at(device, origin, held, plane.normal(), now_ns)?;
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
        let head = DVec3::NEG_Z * self.model.file().length_m();
        let tip = Rigid::from(&held.pose).point(head);
        let desk = self.model.desk();
        let relief = desk.map_or_else(HeightPatch::flat, |desk| {
            height_patch(desk, &plane, tip, self.relief.as_ref())
        });
        let felt = SurfaceFeel {
            law: law(kind, &mut self.model, &plane),
            grain: self.grain.clone(),
            relief,
        };
        let name = &self.settings.name;
        let file = self.model.file();
        let model = contact_model(origin, name, (file, tip), &plane, felt);
        sender.send(now_ns, now_ns, &model)?;
        Ok(())
    }

    /// Gives it the drag of the paint; where there is none any more, once.
    fn drag_at(
        &mut self,
        device: &str,
        origin: Origin,
        held: &Held,
        normal: DVec3,
        now_ns: u64,
    ) -> Result<(), BusError> {
        let drag_n_s_m = self.drag_n_s_m;
        if !self.fluids.has(device) {
            let topic = self.topics.fluid_force(device);
            let me = self.states.origin();
            let forces = Sender::new(&*self.bus, &topic, Qos::RealTime, me)?;
            let sent = DragSent {
                forces,
                sent_ns: 0,
                drag_n_s_m: 0.0,
            };
            self.fluids.set(device, sent);
        }
        let Some(sent) = self.fluids.get_mut(device) else {
            return Ok(());
        };
        let is_none = drag_n_s_m == 0.0 && sent.drag_n_s_m == 0.0;
        if is_none || now_ns < sent.sent_ns + PERIOD_NS {
            return Ok(());
        }
        (sent.sent_ns, sent.drag_n_s_m) = (now_ns, drag_n_s_m);
        let force = fluid_force(origin, held, drag_n_s_m, normal);
        sent.forces.send(now_ns, now_ns, &force)?;
        Ok(())
    }
}
