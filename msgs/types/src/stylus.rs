//! Messages of an input device: samples, properties, status, and the position of a played take.

use std::fmt;

use crate::command::After;
use crate::limits::FARTHEST_M;
use crate::pose::Pose;
use crate::wire::define::{message, wire_enum, wire_struct};

/// Bits of [`StylusSample::senses`], [`StylusInfo::senses`] and [`StylusInfo::drives`].
pub mod axes {
    /// Position.
    pub const POSITION: u32 = 1;
    /// Orientation of the handle.
    pub const ORIENTATION: u32 = 2;
    /// Tip pressure.
    pub const PRESSURE: u32 = 4;
    /// Tilt of the pen.
    pub const TILT: u32 = 8;
    /// Rotation of the pen about its axis.
    pub const TWIST: u32 = 16;
    /// Switches on the handle.
    pub const SWITCHES: u32 = 32;
    /// Proximity of the pen.
    pub const PROXIMITY: u32 = 64;
    /// Force (driven by force-feedback devices).
    pub const FORCE: u32 = 128;
    /// Velocity.
    pub const VELOCITY: u32 = 256;
    /// Torque (driven by force-feedback devices).
    pub const TORQUE: u32 = 512;
}

/// Bits of [`StylusSample::switches`] besides the switches of the handle.
pub mod switch {
    /// The pen is turned round: its eraser is near.
    pub const ERASER: u32 = 1 << 31;
}

/// Tilt of a pen that does not sense it: 30° toward the lower right, radians about y and x as in
/// [`StylusPose::Contact`]: atan(tan 30° · cos 45°) and its negative.
pub const DEFAULT_TILT_RAD: [f64; 2] = [0.387_596_686_655_180_66, -0.387_596_686_655_180_66];

/// Longest text of a trouble, bytes: a status has no room for more.
const LONGEST_TEXT: usize = 1024;

wire_enum! {
    /// Pose of a stylus in the desk frame, as its device senses it.
    pub enum StylusPose {
        /// A 6-DOF device: the brush frame (origin where head and ferrule meet, bristles along −z).
        Ferrule {
            /// Brush frame to desk frame.
            pose: Pose,
        },
        /// A pen or a mouse: a contact point with tilt and pressure.
        Contact {
            /// The tip on (or above) the working area, m.
            point_m: [f64; 3],
            /// Angle between z and the projection of the pen's axis, pointing to the far end, onto
            /// the x-z and onto the y-z plane, rad, each within ±85°.
            tilt_rad: [f64; 2],
            /// Rotation about the pen's axis, rad.
            twist_rad: f64,
            /// 0 hovering to 1 full, after the pressure curve.
            pressure: f64,
        },
    }
}

message! {
    /// One sample of an input device; `event_ns` of its header is the time of sampling.
    pub struct StylusSample [contract of hash 0xf567_2178, version 1, at most 512 bytes] {
        /// Axes that the device senses, see [`axes`].
        pub senses: u32,
        /// Pose of the brush.
        pub pose: StylusPose,
        /// Velocity of the ferrule or contact point, m/s, 0 where not sensed.
        pub velocity_m_s: [f64; 3],
        /// Force applied to the hand, N, 0 of a device without force.
        pub force_n: [f64; 3],
        /// A bit a pressed switch.
        pub switches: u32,
        /// True if the stylus is in range.
        pub in_range: bool,
    }
}

impl StylusStatus {
    /// Status of a device that has just been started.
    #[must_use]
    pub fn fresh(bins: usize) -> Self {
        Self {
            samples: 0,
            dropped: 0,
            faults: Vec::new(),
            lateness: vec![0; bins],
            execution: vec![0; bins],
            force_n: 0.0,
            foreign_models: 0,
            trouble: String::new(),
            is_on: true,
            strength: 1.0,
            resting: false,
            asked_n_m: 0.0,
            stiffness_n_m: 0.0,
            cap_n: 0.0,
            motor_temperature: 0.0,
            is_guided: false,
            guidance: 1.0,
            refused_senders: 0,
            help: String::new(),
        }
    }

    /// Reason why there is no device at present; `None` while there is one.
    #[must_use]
    pub fn trouble(&self) -> Option<Trouble<'_>> {
        (!self.trouble.is_empty()).then_some(Trouble {
            what: &self.trouble,
            help: &self.help,
        })
    }

    /// Reports why there is no device, and what to do about it, cut to the room that a status has; false if that was
    /// reported already.
    pub fn report(&mut self, trouble: Trouble<'_>) -> bool {
        let cut = |text: &str| text[..text.floor_char_boundary(LONGEST_TEXT)].to_owned();
        let (what, help) = (cut(trouble.what), cut(trouble.help));
        let is_new = (&what, &help) != (&self.trouble, &self.help);
        (self.trouble, self.help) = (what, help);
        is_new
    }

    /// The device is there.
    pub fn clear_trouble(&mut self) {
        self.trouble.clear();
        self.help.clear();
    }
}

/// Reason why there is no device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Trouble<'a> {
    /// The trouble.
    pub what: &'a str,
    /// Advice; may be empty.
    pub help: &'a str,
}

impl fmt::Display for Trouble<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.what)?;
        if self.help.is_empty() {
            Ok(())
        } else {
            write!(f, "; {}", self.help)
        }
    }
}

impl StylusSample {
    /// A sample out of range at the desk's origin.
    #[must_use]
    pub fn away() -> Self {
        Self {
            senses: axes::POSITION,
            pose: StylusPose::Contact {
                point_m: [0.0; 3],
                tilt_rad: DEFAULT_TILT_RAD,
                twist_rad: 0.0,
                pressure: 0.0,
            },
            velocity_m_s: [0.0; 3],
            force_n: [0.0; 3],
            switches: 0,
            in_range: false,
        }
    }

    /// True if the stylus is in the air by its own word: out of range, or a pen without pressure.
    #[must_use]
    pub fn in_air(&self) -> bool {
        let lifted = matches!(self.pose, StylusPose::Contact { pressure, .. } if pressure <= 0.0);
        lifted || !self.in_range
    }

    /// Fault of the numbers, if there is one: a device in any language may send them.
    #[must_use]
    pub fn fault(&self) -> Option<&'static str> {
        let finite = |values: &[f64]| values.iter().all(|value| value.is_finite());
        let near = |place: &[f64; 3]| place.iter().all(|metres| metres.abs() <= FARTHEST_M);
        if !finite(&self.velocity_m_s) || !finite(&self.force_n) {
            return Some("velocity or force is not finite");
        }
        match &self.pose {
            StylusPose::Ferrule { pose } if !pose.is_valid() => {
                Some("the ferrule pose is not finite or its quaternion is not a unit one")
            }
            StylusPose::Ferrule { pose } if !near(&pose.position_m) => {
                Some("the ferrule is more than 10 m away")
            }
            StylusPose::Contact {
                point_m,
                tilt_rad,
                twist_rad,
                pressure,
            } => {
                if !finite(point_m) || !twist_rad.is_finite() {
                    Some("the contact point or the twist is not finite")
                } else if !near(point_m) {
                    Some("the contact point is more than 10 m away")
                } else if !tilt_rad.iter().all(|tilt| tilt.abs() <= 1.484) {
                    Some("the tilt is not within 85°")
                } else if !(0.0..=1.0).contains(pressure) {
                    Some("the pressure is not within 0 and 1")
                } else {
                    None
                }
            }
            StylusPose::Ferrule { .. } => None,
        }
    }
}

message! {
    /// Properties of a device; cached for late joiners.
    pub struct StylusInfo [contract of hash 0x9885_0be2, version 1, at most 1024 bytes] {
        /// Name of the device as in its topics.
        pub device: String,
        /// The driver that serves it.
        pub driver: String,
        /// The brush that it moves.
        pub brush: String,
        /// Of devices in range the one of highest priority paints.
        pub priority: i32,
        /// Axes that it senses, see [`axes`].
        pub senses: u32,
        /// Axes that it drives, see [`axes`].
        pub drives: u32,
        /// Samples a second.
        pub rate_hz: f64,
        /// Largest force, N; 0 without force.
        pub max_force_n: f64,
        /// Largest stiffness that it renders, N/m.
        pub max_stiffness_n_m: f64,
        /// Working area in the desk frame: least x, y, z, then greatest, m.
        pub workspace_m: [f64; 6],
    }
}

message! {
    /// Status of a device, ten times a second.
    pub struct StylusStatus [contract of hash 0x06b9_def3, version 5, at most 4096 bytes] {
        /// Samples published since the start.
        pub samples: u64,
        /// Samples that did not fit into the ring to the publisher.
        pub dropped: u64,
        /// Latched faults, in words.
        pub faults: Vec<String>,
        /// Lateness of wake-ups: counts of below 50 µs, 100 µs, 200 µs … doubling, the rest.
        pub lateness: Vec<u64>,
        /// Time spent in a tick, in the same bins.
        pub execution: Vec<u64>,
        /// Size of the force now, N.
        pub force_n: f64,
        /// Messages dropped because they named another device, epoch or brush.
        pub foreign_models: u64,
        /// Reason why there is no device at present; empty while there is one.
        pub trouble: String,
        /// True if force is switched on.
        pub is_on: bool,
        /// Share of the models' force, 0 to 1.
        pub strength: f64,
        /// True while the amplifiers rest for want of contact.
        pub resting: bool,
        /// Stiffness that the model asks for, N/m.
        pub asked_n_m: f64,
        /// Stiffness that is given, N/m.
        pub stiffness_n_m: f64,
        /// Largest force as warm as the motors are, N.
        pub cap_n: f64,
        /// The hottest motor, 0 cold to 1 hot.
        pub motor_temperature: f64,
        /// True while a guide of the hand is alive.
        pub is_guided: bool,
        /// Share of the guides' force, 0 to 1.
        pub guidance: f64,
        /// Messages that would move the hand, dropped because their sender is neither the device's brush nor has consent.
        pub refused_senders: u64,
        /// Advice about the trouble; may be empty.
        pub help: String,
    }
}

wire_struct! {
    /// End of a take in a brush's stream.
    pub struct TakeEnd {
        /// The brush state that holds the take's last sample.
        pub after: After,
        /// Samples of the take.
        pub samples: u64,
    }
}

message! {
    /// Position of a played take, ten times a second and at its end.
    pub struct TakeStatus [version 1, at most 1024 bytes] {
        /// Epoch of this playing; a take played again has another.
        pub epoch: u32,
        /// Time in the take of the newest sample sent, ns.
        pub position_ns: u64,
        /// Length of the take, ns.
        pub length_ns: u64,
        /// Samples sent.
        pub sent: u64,
        /// Samples that the brush node has consumed.
        pub consumed: u64,
        /// Set once the brush node has consumed the last sample.
        pub end: Option<TakeEnd>,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn contact(x: f64) -> StylusSample {
        StylusSample {
            pose: StylusPose::Contact {
                point_m: [x, 0.0, 0.0],
                tilt_rad: DEFAULT_TILT_RAD,
                twist_rad: 0.0,
                pressure: 0.5,
            },
            ..StylusSample::away()
        }
    }

    fn ferrule(z: f64) -> StylusSample {
        let pose = Pose {
            position_m: [0.0, 0.0, z],
            ..Pose::IDENTITY
        };
        StylusSample {
            pose: StylusPose::Ferrule { pose },
            ..StylusSample::away()
        }
    }

    #[test]
    fn a_finite_place_beyond_every_desk_is_a_fault() {
        for metres in [10.1, -11.0, 1e30, f64::MAX, f64::INFINITY, f64::NAN] {
            assert!(contact(metres).fault().is_some(), "{metres}");
            assert!(ferrule(metres).fault().is_some(), "{metres}");
        }
        for metres in [0.0, -10.0, 10.0] {
            assert_eq!(contact(metres).fault(), None);
            assert_eq!(ferrule(metres).fault(), None);
        }
    }
}
