//! Messages that move the hand, from the senders that may: contact models, guides, forces of paint.

use maulstick_bus::typed::Receiver;
use maulstick_bus::{Bus, BusError, Qos, Queue, Wake};
use maulstick_haptics::{Contact, Fluid, Guide, Recipient};
use maulstick_rig::config::DeviceSection;
use maulstick_types::Origin;
use maulstick_types::brush::BrushConsumed;
use maulstick_types::haptics::{ContactModel, FluidForce, GuideModel};
use maulstick_types::stylus::StylusStatus;
use maulstick_types::wire::topics::Topics;

use crate::inlet::Inlet;
use crate::senders::{Consent, Means, Senders};
use crate::servo::servo_thread::ServoThread;

/// The ways in, and who may use them.
pub(super) struct ForceInlets {
    recipient: Recipient,
    senders: Senders,
    models: Inlet<ContactModel, Contact>,
    guides: Inlet<GuideModel, Guide>,
    fluids: Inlet<FluidForce, Fluid>,
    /// Samples that brushes have consumed.
    consumed: Receiver<BrushConsumed>,
}

impl ForceInlets {
    /// Listens for the device that sends its samples as `me`.
    ///
    /// # Errors
    /// [`BusError`].
    pub(super) fn new(
        bus: &dyn Bus,
        topics: &Topics,
        device: &DeviceSection,
        me: Origin,
        wake: &Wake,
    ) -> Result<Self, BusError> {
        let (paint_drag, relief) = (device.paint_drag, device.relief);
        let models = topics.contact_model(&device.name);
        let guides = topics.guide(&device.name);
        let fluids = topics.fluid_force(&device.name);
        let consumed = topics.brush_consumed(&device.brush);
        Ok(Self {
            recipient: Recipient {
                device: me,
                brush: device.brush.clone(),
            },
            senders: Senders::new(&device.brush, &device.driven_by),
            models: Inlet::new(
                (bus, &models),
                Means::Contact,
                Recipient::accepts,
                move |model| Contact::with_relief(model, relief),
                wake,
            )?,
            guides: Inlet::new(
                (bus, &guides),
                Means::Guide,
                Recipient::accepts_guide,
                Guide::new,
                wake,
            )?,
            fluids: Inlet::new(
                (bus, &fluids),
                Means::Paint,
                Recipient::accepts_fluid,
                move |force| Fluid::new(force, paint_drag),
                wake,
            )?,
            consumed: Receiver::new(bus, &consumed, Qos::Control, Queue::Ring(64), wake)?,
        })
    }

    /// Lets a sender move the hand for a while.
    pub(super) fn consent(&mut self, sender: Origin, now_ns: u64) -> Consent {
        self.senders.consent(sender, now_ns)
    }

    /// Hands the newest messages to the servo; without one they are judged and dropped.
    pub(super) fn deliver(
        &mut self,
        servo: Option<&mut ServoThread>,
        status: &mut StylusStatus,
        now_ns: u64,
    ) {
        while let Some(received) = self.consumed.try_recv() {
            let (me, consumed) = (self.recipient.device, &received.message);
            if (consumed.device, consumed.device_epoch) == (me.source, me.epoch) {
                self.senders.consumed_by(received.header.origin(), now_ns);
            }
        }
        let (to, senders) = (&self.recipient, &mut self.senders);
        let model = self.models.newest(to, senders, status, now_ns);
        let guide = self.guides.newest(to, senders, status, now_ns);
        let fluid = self.fluids.newest(to, senders, status, now_ns);
        let Some(servo) = servo else {
            return;
        };
        if let Some(model) = model {
            servo.models.write(model);
        }
        if let Some(guide) = guide {
            servo.guides.write(guide);
        }
        if let Some(fluid) = fluid {
            servo.fluids.write(fluid);
        }
    }
}
