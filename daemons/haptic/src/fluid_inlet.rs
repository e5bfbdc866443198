//! Forces of paint from the rig, for the servo.

use maulstick_bus::typed::Receiver;
use maulstick_bus::{Bus, BusError, Qos, Queue, Wake};
use maulstick_haptics::{Fluid, Recipient};
use maulstick_types::haptics::FluidForce;

use crate::servo::channels::Delivery;

/// The way in of forces of paint.
pub(crate) struct FluidInlet {
    forces: Receiver<FluidForce>,
    /// How many times as strong as they are they are felt.
    scale: f64,
    deliveries: u64,
    /// True once a bad one has been logged.
    warned: bool,
}

/// What came.
pub(crate) enum FluidArrival {
    /// Nothing.
    Nothing,
    /// Something that is not for this device, or is refused.
    Foreign,
    /// A force for the servo.
    Delivery(Delivery<Fluid>),
}

impl FluidInlet {
    /// Listens on a topic.
    ///
    /// # Errors
    /// [`BusError`].
    pub(crate) fn new(
        bus: &dyn Bus,
        topic: &str,
        scale: f64,
        wake: &Wake,
    ) -> Result<Self, BusError> {
        Ok(Self {
            forces: Receiver::new(bus, topic, Qos::RealTime, Queue::Ring(64), wake)?,
            scale,
            deliveries: 0,
            warned: false,
        })
    }

    /// The newest force, if one has come.
    pub(crate) fn newest(&mut self, recipient: &Recipient) -> FluidArrival {
        let Some(received) = self.forces.newest() else {
            return FluidArrival::Nothing;
        };
        if !recipient.accepts_fluid(&received.message) {
            return FluidArrival::Foreign;
        }
        match Fluid::new(&received.message, self.scale) {
            Ok(fluid) => {
                self.deliveries += 1;
                FluidArrival::Delivery(Delivery {
                    model: Some(fluid),
                    sender: Some(received.header.origin()),
                    number: self.deliveries,
                })
            }
            Err(what) => {
                if !self.warned {
                    self.warned = true;
                    tracing::warn!("{}: a force of paint is dropped: {what}", received.key);
                }
                FluidArrival::Foreign
            }
        }
    }
}
