//! 6-DOF mice of 3Dconnexion, for the free hand.
//!
//! Reports hold little-endian 16-bit deflections, ±350 at the stops or a little beyond: report 1 three pushes
//! and report 2 three turns, or report 1 all six in 13 bytes; report 3 holds the buttons, a bit each. Some
//! descriptors call the axes relative, but they never are. The reports' frame is x right, y toward the
//! hand, z down. At rest a mouse says nothing, so one that falls silent while it is pushed (its
//! receiver was pulled out) comes to rest by itself.

use glam::{DQuat, DVec3};
use maulstick_types::control::ControlSample;

/// Numbers of makers: Logitech, which sold the first of them, and 3Dconnexion.
pub const VENDORS: [u16; 2] = [0x046D, 0x256F];
/// Report that switches the light on.
pub const LIGHT: [u8; 2] = [0x04, 0x01];
/// Deflection at the stops.
const STOP: f64 = 350.0;
/// Dead zone, as a share of the travel to a stop: a hand that rests on the cap.
const DEAD_ZONE: f64 = 0.03;
/// Validity of a deflection without a report, ns.
pub const SILENCE_NS: u64 = 200_000_000;
/// Duration of its decay to rest after that, ns.
pub const DECAY_NS: u64 = 100_000_000;

/// Axes of a product: for each of right, up along the desk and out of it the index of its axis, and its sign.
type Axes = [(usize, f64); 3];

/// The frame of all that are known.
const USUAL: Axes = [(0, 1.0), (1, -1.0), (2, -1.0)];

/// Products, what they are called, and their axes.
const PRODUCTS: [(u16, u16, &str, Axes); 14] = [
    (0x046D, 0xC626, "SpaceNavigator", USUAL),
    (0x046D, 0xC627, "SpaceExplorer", USUAL),
    (0x046D, 0xC628, "SpaceNavigator for Notebooks", USUAL),
    (0x046D, 0xC629, "SpacePilot Pro", USUAL),
    (0x046D, 0xC62B, "SpaceMouse Pro", USUAL),
    (0x256F, 0xC62E, "SpaceMouse Wireless", USUAL),
    (0x256F, 0xC62F, "SpaceMouse Wireless receiver", USUAL),
    (0x256F, 0xC631, "SpaceMouse Pro Wireless", USUAL),
    (0x256F, 0xC632, "SpaceMouse Pro Wireless receiver", USUAL),
    (0x256F, 0xC633, "SpaceMouse Enterprise", USUAL),
    (0x256F, 0xC635, "SpaceMouse Compact", USUAL),
    (0x256F, 0xC638, "SpaceMouse Pro Wireless", USUAL),
    (0x256F, 0xC63A, "SpaceMouse Wireless", USUAL),
    (0x256F, 0xC652, "Universal receiver", USUAL),
];

/// A 6-DOF mouse.
#[derive(Clone, Debug)]
pub struct SpaceMouse {
    axes: Axes,
    /// Rotation to the desk.
    to_desk: DQuat,
    /// Counts, pushes and then turns, device frame.
    counts: [i16; 6],
    switches: u64,
    /// When a deflection was last reported, ns.
    moved_ns: u64,
}

impl SpaceMouse {
    /// A mouse by its numbers, turned on the desk by `to_desk`.
    #[must_use]
    pub fn new(vendor: u16, product: u16, to_desk: DQuat) -> Self {
        let found = PRODUCTS
            .iter()
            .find(|(maker, kind, ..)| (*maker, *kind) == (vendor, product));
        Self {
            axes: found.map_or(USUAL, |(.., axes)| *axes),
            to_desk,
            counts: [0; 6],
            switches: 0,
            moved_ns: 0,
        }
    }

    /// Name of a product, if it is known.
    #[must_use]
    pub fn called(vendor: u16, product: u16) -> Option<&'static str> {
        let found = PRODUCTS
            .iter()
            .find(|(maker, kind, ..)| (*maker, *kind) == (vendor, product));
        found.map(|(_, _, name, _)| *name)
    }

    /// Takes in a report of time `at_ns`; whether it was one of the hand's.
    pub fn follow(&mut self, report: &[u8], at_ns: u64) -> bool {
        let words = |bytes: &[u8], counts: &mut [i16]| {
            for (count, pair) in counts.iter_mut().zip(bytes.chunks_exact(2)) {
                *count = i16::from_le_bytes([pair[0], pair[1]]);
            }
        };
        match report {
            [1, axes @ ..] if axes.len() >= 12 => words(axes, &mut self.counts),
            [1, axes @ ..] if axes.len() >= 6 => words(axes, &mut self.counts[..3]),
            [2, axes @ ..] if axes.len() >= 6 => words(axes, &mut self.counts[3..]),
            [3, bits @ ..] if !bits.is_empty() => {
                let bits = bits.iter().take(8).enumerate();
                self.switches = bits.fold(0, |all, (at, bits)| all | u64::from(*bits) << (8 * at));
                return true;
            }
            _ => return false,
        }
        self.moved_ns = at_ns;
        true
    }

    /// True while it is pushed or turned.
    #[must_use]
    pub fn is_deflected(&self) -> bool {
        self.counts != [0; 6]
    }

    /// The hand's device is gone.
    pub fn leave(&mut self) {
        (self.counts, self.switches) = ([0; 6], 0);
    }

    /// Motion of the hand at a time, ns, in the desk's axes; a deflection that is too old is dropped.
    pub fn sample(&mut self, now_ns: u64) -> ControlSample {
        let silent_ns = now_ns
            .saturating_sub(self.moved_ns)
            .saturating_sub(SILENCE_NS);
        if silent_ns >= DECAY_NS {
            self.counts = [0; 6];
        }
        let share = 1.0 - silent_ns.min(DECAY_NS) as f64 / DECAY_NS as f64;
        let hand = |counts: &[i16]| {
            let along = |(axis, sign): (usize, f64)| sign * deflection(counts[axis]);
            let on_desk = self.to_desk * DVec3::from_array(self.axes.map(along)) * share;
            on_desk.to_array().map(|value| value.clamp(-1.0, 1.0))
        };
        ControlSample {
            push: hand(&self.counts[..3]),
            turn: hand(&self.counts[3..]),
            switches: self.switches,
        }
    }
}

/// Share of the travel to a stop, −1 to 1, which begins at 0 where the dead zone ends.
fn deflection(count: i16) -> f64 {
    let share = (f64::from(count) / STOP).clamp(-1.0, 1.0);
    let beyond = (share.abs() - DEAD_ZONE).max(0.0) / (1.0 - DEAD_ZONE);
    beyond.copysign(share)
}
