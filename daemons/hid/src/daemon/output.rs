//! The device's side of the bus: a stylus, or a 6-DOF mouse.

use std::sync::Arc;

use glam::DQuat;
use maulstick_bus::{Bus, BusError, Wake};
use maulstick_num::geometry::canonical;
use maulstick_rig::UserError;
use maulstick_types::Origin;
use maulstick_types::wire::topics::Topics;

use super::HidSettings;
use crate::device_source::Identity;
use crate::open::{Kind, Means};
use crate::spacemouse::SpaceMouse;
use crate::spacemouse_node::SpaceMouseNode;
use crate::stylus::Stylus;
use crate::tablet::Tablet;

/// Publisher of what the reports mean.
#[derive(Debug)]
pub(super) enum Output {
    Stylus(Box<Stylus>),
    SpaceMouse(Box<SpaceMouseNode>),
}

impl Output {
    /// The output of a kind of device.
    ///
    /// # Errors
    /// A [`UserError`] where the settings are wrong or the bus is closed.
    pub(super) fn new(
        kind: Kind,
        bus: &Arc<dyn Bus>,
        topics: &Topics,
        settings: &HidSettings,
        (origin, wake): (Origin, &Wake),
    ) -> Result<Self, UserError> {
        let device = &settings.device;
        Ok(match kind {
            Kind::Pen | Kind::EventPen => {
                let stylus = Stylus::new(bus, topics, device, origin, wake)?;
                Self::Stylus(Box::new(stylus))
            }
            Kind::SpaceMouse => {
                let mouse = SpaceMouseNode::new(bus, topics, device, origin)?;
                Self::SpaceMouse(Box::new(mouse))
            }
        })
    }

    /// Begins with a device that was opened.
    ///
    /// # Errors
    /// A [`UserError`] where the tablet does not fit the canvas, or the bus is closed.
    pub(super) fn begin(
        &mut self,
        means: Means,
        identity: &Identity,
        settings: &HidSettings,
        now_ns: u64,
    ) -> Result<(), UserError> {
        let device = &settings.device;
        match (means, self) {
            (Means::Pen(decoder), Self::Stylus(stylus)) => {
                let (area_m, senses) = (decoder.area_m(), decoder.senses());
                let tablet = Tablet::fit(area_m, senses, device, &settings.canvas)?;
                stylus.begin(decoder, tablet, device, now_ns)?;
            }
            (Means::SpaceMouse, Self::SpaceMouse(node)) => {
                let to_desk = canonical(DQuat::from_array(device.orientation));
                let mouse = SpaceMouse::new(identity.vendor, identity.product, to_desk);
                node.begin(mouse, device, now_ns)?;
            }
            // A kind has one output.
            (Means::Pen(_), Self::SpaceMouse(_)) | (Means::SpaceMouse, Self::Stylus(_)) => {}
        }
        Ok(())
    }

    /// Publishes a report.
    ///
    /// # Errors
    /// [`BusError`].
    pub(super) fn report(
        &mut self,
        report: &[u8],
        event_ns: u64,
        now_ns: u64,
    ) -> Result<(), BusError> {
        match self {
            Self::Stylus(stylus) => stylus.report(report, event_ns, now_ns),
            Self::SpaceMouse(mouse) => mouse.report(report, event_ns, now_ns),
        }
    }

    /// Publishes what follows from the silence of an open device.
    ///
    /// # Errors
    /// [`BusError`].
    pub(super) fn silent(&mut self, now_ns: u64) -> Result<(), BusError> {
        match self {
            Self::Stylus(stylus) => stylus.silent(now_ns, now_ns),
            Self::SpaceMouse(mouse) => mouse.silent(now_ns, now_ns),
        }
    }

    /// Lifts the pen, or releases the mouse, of a device that is closed.
    ///
    /// # Errors
    /// [`BusError`].
    pub(super) fn lift(&mut self, event_ns: u64, now_ns: u64) -> Result<(), BusError> {
        match self {
            Self::Stylus(stylus) => stylus.end(event_ns, now_ns),
            Self::SpaceMouse(mouse) => mouse.end(event_ns, now_ns),
        }
    }

    /// Sends missed samples again.
    ///
    /// # Errors
    /// [`BusError`].
    pub(super) fn serve(&mut self, now_ns: u64) -> Result<(), BusError> {
        match self {
            Self::Stylus(stylus) => stylus.serve(now_ns),
            Self::SpaceMouse(_) => Ok(()),
        }
    }

    /// Samples sent.
    pub(super) fn sent(&self) -> u64 {
        match self {
            Self::Stylus(stylus) => stylus.sent(),
            Self::SpaceMouse(mouse) => mouse.sent(),
        }
    }

    /// Time at which a silent device has something to send, ns.
    pub(super) fn due_ns(&self) -> Option<u64> {
        match self {
            Self::Stylus(stylus) => stylus.due_ns(),
            Self::SpaceMouse(mouse) => mouse.due_ns(),
        }
    }
}
