//! Publisher of contact models, and of the paint's drag, for the devices that move the brush.

use std::sync::Arc;

use glam::DVec3;
use maulstick_brush::BrushModel;
use maulstick_bus::typed::Sender;
use maulstick_bus::{Bus, BusError, Qos, Recent};
use maulstick_num::geometry::Rigid;
use maulstick_types::Origin;
use maulstick_types::brush::BrushRelief;
use maulstick_types::haptics::{ContactModel, FluidForce, Grain, HeightPatch};
use maulstick_types::paint::BrushCredit;
use maulstick_types::scene::Scene;
use maulstick_types::wire::topics::Topics;

use crate::contact_model::{ForceKind, NO_GRAIN, SurfaceFeel, contact_model, grain, law};
use crate::fluid_force::{Held, PERIOD_NS, drag, fluid_force};
use crate::relief::height_patch;

/// Least time between two contact models, ns.
const MODEL_PERIOD_NS: u64 = 4_000_000;

/// A hand that feels the brush.
pub(super) struct Hand<'a> {
    /// Name of its device.
    pub(super) device: &'a str,
    pub(super) origin: Origin,
    pub(super) held: Held,
    /// Force law of the device.
    pub(super) law: ForceKind,
}

/// Contact models sent to a device.
struct ModelsSent {
    models: Sender<ContactModel>,
    sent_ns: u64,
}

/// Drag sent to a device.
struct DragSent {
    forces: Sender<FluidForce>,
    sent_ns: u64,
    drag_n_s_m: f64,
}

/// Presence of the paint node: without it nothing is painted and there is no force.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Painter {
    /// It is there, or never sent anything.
    There,
    /// It has gone.
    Gone,
}

/// Publisher for the hands that feel the brush, with what the paint node said of the surface under it.
pub(super) struct ContactPublisher {
    bus: Arc<dyn Bus>,
    topics: Topics,
    brush: String,
    me: Origin,
    models: Recent<ModelsSent>,
    drags: Recent<DragSent>,
    painter: Painter,
    /// Drag of the paint under the brush, N·s/m.
    drag_n_s_m: f64,
    /// Grain of the canvas.
    grain: Grain,
    /// The newest relief below the brush.
    relief: Option<BrushRelief>,
}

impl ContactPublisher {
    /// A publisher of the brush of this name.
    pub(super) fn new(bus: Arc<dyn Bus>, topics: &Topics, brush: &str, me: Origin) -> Self {
        Self {
            bus,
            topics: topics.clone(),
            brush: brush.to_owned(),
            me,
            models: Recent::default(),
            drags: Recent::default(),
            painter: Painter::There,
            drag_n_s_m: 0.0,
            grain: NO_GRAIN,
            relief: None,
        }
    }

    /// Notes that the paint node came or went.
    pub(super) fn on_painter(&mut self, is_present: bool) {
        self.painter = if is_present {
            Painter::There
        } else {
            Painter::Gone
        };
    }

    /// Notes the paint under the brush.
    pub(super) fn on_credit(&mut self, credit: &BrushCredit) {
        self.drag_n_s_m = drag(credit);
    }

    /// Notes the relief below the brush.
    pub(super) fn on_relief(&mut self, relief: BrushRelief) {
        self.relief = Some(relief);
    }

    /// Notes the grain of a scene's canvas.
    pub(super) fn set_scene(&mut self, scene: &Scene) {
        self.grain = grain(scene);
    }

    /// Sends a hand its contact model and the drag, each once its period is over.
    ///
    /// # Errors
    /// [`BusError`].
    pub(super) fn publish(
        &mut self,
        hand: &Hand<'_>,
        model: &mut BrushModel,
        now_ns: u64,
    ) -> Result<(), BusError> {
        if self.painter == Painter::Gone {
            return Ok(());
        }
        let Some(plane) = model.plane().copied() else {
            return Ok(());
        };
        self.publish_drag(hand, plane.normal(), now_ns)?;
        if !self.models.has(hand.device) {
            let topic = self.topics.contact_model(hand.device);
            let models = Sender::new(&*self.bus, &topic, Qos::RealTime, self.me)?;
            let sent_ns = 0;
            self.models.set(hand.device, ModelsSent { models, sent_ns });
        }
        let Some(sent) = self.models.get_mut(hand.device) else {
            return Ok(());
        };
        if now_ns < sent.sent_ns + MODEL_PERIOD_NS {
            return Ok(());
        }
        sent.sent_ns = now_ns;
        let head = DVec3::NEG_Z * model.file().length_m();
        let tip = Rigid::from(&hand.held.pose).point(head);
        let relief = model.desk().map_or_else(HeightPatch::flat, |desk| {
            height_patch(desk, &plane, tip, self.relief.as_ref())
        });
        let feel = SurfaceFeel {
            law: law(hand.law, model, &plane),
            grain: self.grain.clone(),
            relief,
        };
        let head = (model.file(), tip);
        let contact = contact_model(hand.origin, &self.brush, head, &plane, feel);
        sent.models.send(now_ns, now_ns, &contact)
    }

    /// Sends the drag of the paint; where there is none any more, once.
    fn publish_drag(
        &mut self,
        hand: &Hand<'_>,
        normal: DVec3,
        now_ns: u64,
    ) -> Result<(), BusError> {
        let drag_n_s_m = self.drag_n_s_m;
        if !self.drags.has(hand.device) {
            let topic = self.topics.fluid_force(hand.device);
            let sent = DragSent {
                forces: Sender::new(&*self.bus, &topic, Qos::RealTime, self.me)?,
                sent_ns: 0,
                drag_n_s_m: 0.0,
            };
            self.drags.set(hand.device, sent);
        }
        let Some(sent) = self.drags.get_mut(hand.device) else {
            return Ok(());
        };
        let is_none = drag_n_s_m == 0.0 && sent.drag_n_s_m == 0.0;
        if is_none || now_ns < sent.sent_ns + PERIOD_NS {
            return Ok(());
        }
        (sent.sent_ns, sent.drag_n_s_m) = (now_ns, drag_n_s_m);
        let force = fluid_force(hand.origin, &hand.held, drag_n_s_m, normal);
        sent.forces.send(now_ns, now_ns, &force)
    }
}
