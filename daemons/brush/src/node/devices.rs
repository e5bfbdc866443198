//! The devices that may move the brush: their claims, their presence, and which of them has it.

use maulstick_bus::Recent;
use maulstick_bus::sender_arbiter::Once;
use maulstick_types::stylus::{StylusInfo, axes};
use maulstick_types::{Flags, Header, Origin};

use super::settings::BrushDevices;
use crate::arbiter::{Arbiter, Range, Stroke};
use crate::contact_model::ForceKind;

/// Claims of a device about itself.
#[derive(Clone, Debug)]
struct Claims {
    /// The brush that it moves; any if empty.
    brush: String,
    drives_force: bool,
}

/// A take that plays, from its first sample to its last: no other device moves the brush meanwhile, however long it is
/// silent.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Take {
    device: String,
    origin: Origin,
}

/// Claim of a take to the brush.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum TakeClaim {
    /// Another take has the brush.
    Rejected,
    /// The take begins.
    Begins,
    /// The take had the brush before.
    Continues,
}

/// The devices of a brush.
#[derive(Debug)]
pub(super) struct Devices {
    brush: String,
    settings: BrushDevices,
    claims: Recent<Claims>,
    /// Devices that are gone: their takes have ended.
    gone: Recent<()>,
    arbiter: Arbiter,
    take: Option<Take>,
    /// Devices of whose faulty samples the log has a line.
    faulty: Once,
}

impl Devices {
    /// The devices of the brush of this name.
    pub(super) fn new(brush: String, settings: BrushDevices) -> Self {
        Self {
            brush,
            settings,
            claims: Recent::default(),
            gone: Recent::default(),
            arbiter: Arbiter::default(),
            take: None,
            faulty: Once::default(),
        }
    }

    /// Replaces priorities and force laws.
    pub(super) fn configure(&mut self, settings: BrushDevices) {
        self.settings = settings;
    }

    /// Notes what a device says of itself.
    pub(super) fn on_info(&mut self, device: &str, info: StylusInfo) {
        let claims = Claims {
            brush: info.brush,
            drives_force: info.drives & axes::FORCE != 0,
        };
        self.claims.set(device, claims);
    }

    /// Notes that a device came or went.
    pub(super) fn on_presence(&mut self, device: &str, is_present: bool) {
        if is_present {
            self.gone.remove(device);
        } else {
            self.gone.set(device, ());
        }
    }

    /// Priority of a device, if it moves this brush.
    pub(super) fn priority(&self, device: &str) -> Option<i32> {
        let claims = self.claims.get(device);
        let moves = claims.map_or("", |claims| claims.brush.as_str());
        self.settings.priority(&self.brush, device, moves)
    }

    /// True for a device that says it drives a force.
    pub(super) fn drives_force(&self, device: &str) -> bool {
        let claims = self.claims.get(device);
        claims.is_some_and(|claims| claims.drives_force)
    }

    /// Force law of a device.
    pub(super) fn law(&self, device: &str) -> ForceKind {
        let law = self.settings.laws.get(device).copied();
        law.unwrap_or_default()
    }

    /// True for the first faulty sample of a device, which the log names.
    pub(super) fn is_first_fault(&mut self, device: &str) -> bool {
        self.faulty.say(device)
    }

    /// True if a live sample moves the brush, by the priorities of the devices in range.
    pub(super) fn admits(
        &mut self,
        (device, priority): (&str, i32),
        range: Range,
        stroke: Stroke,
        now_ns: u64,
    ) -> bool {
        self.arbiter.admit(device, priority, range, stroke, now_ns)
    }

    /// True if a take has exclusive use of the brush.
    pub(super) fn is_held(&self) -> bool {
        let is_there = |take: &Take| !self.gone.has(&take.device);
        self.take.as_ref().is_some_and(is_there)
    }

    /// Claims the brush for the take of a sample.
    pub(super) fn claim(&mut self, device: &str, header: &Header) -> TakeClaim {
        let take = Take {
            device: device.to_owned(),
            origin: header.origin(),
        };
        if self.take.as_ref() == Some(&take) {
            return TakeClaim::Continues;
        }
        if self.is_held() && !header.flags.has(Flags::FIRST) {
            return TakeClaim::Rejected;
        }
        self.gone.remove(device);
        self.take = Some(take);
        TakeClaim::Begins
    }

    /// Ends the take.
    pub(super) fn end_take(&mut self) {
        self.take = None;
    }
}
