//! Messages of the brush node: the brush file, solved states, and credit to devices.

use crate::Flags;
use crate::pose::Pose;
use crate::values::{Quantity, Zoom};
use crate::wire::define::{message, wire_struct};

/// Bits of [`Solve::flags`].
pub mod solve_flags {
    /// The solver began anew at this pose: nothing is painted between it and the one before.
    pub const RESTARTED: u32 = 1;
    /// The solver did not converge and kept its last good state.
    pub const NOT_CONVERGED: u32 = 2;
    /// Pose at a sample between two solves of the path: to be shown, not to be painted.
    pub const PREVIEW: u32 = 4;
    /// The way to it is painted in steps twice as long as the brush's own, for painting was late.
    pub const TWICE: u32 = 8;
    /// As [`TWICE`], four times.
    pub const FOUR_TIMES: u32 = 16;
}

/// Brushes of a painting at most.
pub const BRUSHES_MOST: usize = 64;

wire_struct! {
    /// A joint that touches a surface.
    pub struct Contact {
        /// Number of the spine.
        pub spine: u16,
        /// Number of the joint's far end, 1 at the end of the first segment.
        pub joint: u16,
        /// Normal force, N.
        pub force_n: f32,
    }
}

wire_struct! {
    /// One solved pose.
    pub struct Solve {
        /// Time of the stylus's pose, rig clock, ns.
        pub event_ns: u64,
        /// The stroke, from 1 in the brush's epoch; 0 while nothing touches.
        pub stroke: u64,
        /// The surface whose frame the pose is in.
        pub surface: u32,
        /// See [`solve_flags`].
        pub flags: u32,
        /// Brush frame to surface frame; lengths are divided by the zoom.
        pub pose: Pose,
        /// Zoom of the surface as it was then: it may have changed until this is painted.
        pub zoom: f64,
        /// θ and φ of each joint, rad, spine after spine. Of a head in the air that keeps a bend those of its core
        /// follow, and then, for all spines and the core, those of the directions to which friction draws the segments,
        /// each as seen from the segment before.
        pub angles_rad: Vec<[f32; 2]>,
        /// Joints in contact.
        pub contacts: Vec<Contact>,
    }
}

message! {
    /// The brush at a stylus sample, with all sub-solves since the sample before.
    pub struct BrushState [version 2, at most 61440 bytes] {
        /// The device followed: the source of its samples.
        pub device: u32,
        /// Its epoch.
        pub device_epoch: u32,
        /// The newest of its samples that this message consumes.
        pub device_seq: u64,
        /// In order of time.
        pub solves: Vec<Solve>,
    }
}

/// Limit on the distance of a pose from its surface's origin along each axis, m.
pub const FARTHEST_M: f64 = 100.0;

impl BrushState {
    /// Bytes of a message beside its solves.
    pub const WIRE_BYTES: usize = 2 * 4 + 2 * 8;

    /// Fault of the numbers, if there is one: a path over them would never end, and one that is longer than a message could
    /// neither be sent nor kept.
    #[must_use]
    pub fn fault(&self) -> Option<&'static str> {
        if self.wire_bytes() > <Self as crate::Message>::MAX_BYTES {
            return Some("its solves are longer than a message");
        }
        self.solves.iter().find_map(Solve::fault)
    }

    /// Bytes of its message.
    #[must_use]
    pub fn wire_bytes(&self) -> usize {
        let solves = self.solves.iter().map(Solve::wire_bytes);
        Self::WIRE_BYTES + solves.sum::<usize>()
    }

    /// The state as messages that fit, in order, each with its flags: at least one, and one that may have no solve. `first`
    /// and `last` are flags that the first and the last message have beside `flags`; all but the last say that they continue.
    ///
    /// Whoever solves a brush hands its states on like this, with a bus and without: so the same messages are painted,
    /// recorded and kept.
    #[must_use]
    pub fn messages(self, flags: Flags, first: Flags, last: Flags) -> Vec<(Flags, Self)> {
        let (device, device_epoch, device_seq) = (self.device, self.device_epoch, self.device_seq);
        let runs = runs_that_fit(self.solves);
        let count = runs.len();
        let runs = runs.into_iter().enumerate();
        runs.map(|(place, solves)| {
            let flags = match place {
                0 => flags.with(first),
                _ => flags,
            };
            let flags = flags.with(if place + 1 == count {
                last
            } else {
                Flags::CONTINUES
            });
            let part = Self {
                device,
                device_epoch,
                device_seq,
                solves,
            };
            (flags, part)
        })
        .collect()
    }
}

/// Cuts solves into runs that each fit into one message; at least one run, which may be empty.
fn runs_that_fit(solves: Vec<Solve>) -> Vec<Vec<Solve>> {
    let (mut runs, mut run) = (Vec::new(), Vec::new());
    let mut bytes = BrushState::WIRE_BYTES;
    for solve in solves {
        let more = solve.wire_bytes();
        if bytes + more > <BrushState as crate::Message>::MAX_BYTES && !run.is_empty() {
            runs.push(std::mem::take(&mut run));
            bytes = BrushState::WIRE_BYTES;
        }
        bytes += more;
        run.push(solve);
    }
    runs.push(run);
    runs
}

impl Solve {
    /// Number of doublings of the step length on the way to it: 0, 1 or 2.
    #[must_use]
    pub const fn doublings(&self) -> u32 {
        if self.flags & solve_flags::FOUR_TIMES != 0 {
            2
        } else {
            (self.flags & solve_flags::TWICE != 0) as u32
        }
    }

    /// Bytes that it takes in a message.
    #[must_use]
    pub fn wire_bytes(&self) -> usize {
        // Two times 8 for time and stroke, 4 for surface and flags, the pose, the zoom, the two lengths.
        let fixed = 2 * 8 + 2 * 4 + 7 * 8 + 8 + 2 * 8;
        fixed + 8 * self.angles_rad.len() + 8 * self.contacts.len()
    }

    /// Fault of its numbers, if there is one.
    #[must_use]
    pub fn fault(&self) -> Option<&'static str> {
        let near = |metres: &f64| metres.abs() <= FARTHEST_M;
        if !self.pose.is_valid() {
            Some("a pose is not finite or its quaternion is not a unit one")
        } else if Zoom::check(self.zoom).is_err() {
            Some("a zoom is out of range")
        } else if !self.pose.position_m.iter().all(near) {
            Some("a pose is more than 100 m away from its surface")
        } else if !self
            .angles_rad
            .iter()
            .flatten()
            .all(|angle| angle.is_finite())
        {
            Some("an angle is not finite")
        } else if !self
            .contacts
            .iter()
            .all(|contact| contact.force_n.is_finite())
        {
            Some("a force is not finite")
        } else {
            None
        }
    }
}

message! {
    /// A brush file; cached for late joiners.
    pub struct BrushDef [version 2, at most 1048576 bytes] {
        /// Name of the brush in the rig.
        pub brush: String,
        /// The file, TOML.
        pub toml: String,
        /// FNV-1a of the file.
        pub hash: u32,
        /// Length of its head, from where it meets the ferrule to its tip, m.
        pub head_length_m: f64,
    }
}

message! {
    /// Credit to a device: what the brush node has consumed of its samples.
    pub struct BrushConsumed [version 1, at most 256 bytes] {
        /// The device: the source of its samples.
        pub device: u32,
        /// Its epoch.
        pub device_epoch: u32,
        /// All samples below this number are consumed.
        pub next: u64,
        /// The brush's epoch.
        pub brush_epoch: u32,
        /// The brush state that holds the newest of them.
        pub state: u64,
    }
}

message! {
    /// Appearance of the paint on a brush, at most fifteen times a second and only after a change; cached for late
    /// joiners.
    pub struct BrushLook [version 2, at most 263172 bytes] {
        /// Strips of the head: all of its file, or the first of them, each of which stands for those nearest to it.
        pub strips: u32,
        /// Samples along a strip, each the mean of its part, from the ferrule.
        pub along: u32,
        /// Strip after strip four half floats a sample, little endian: linear red, green, blue (sRGB
        /// primaries, unclamped) of the film over the hair under the painting's light, unexposed;
        /// then the film's thickness by that of a full one.
        pub samples: serde_bytes::ByteBuf,
        /// The paint on and inside the head by that of a fully loaded one, 0 to 1.
        pub load_share: f32,
    }
}

message! {
    /// Relief of the surface below a brush, for the hand; while its states come, at most each 15 ms, and again each .5 s
    /// where it stays as it is.
    pub struct BrushRelief [version 1, at most 4096 bytes] {
        /// The surface.
        pub surface: u32,
        /// Side of a cell in the surface's own lengths, m.
        pub cell_m: f64,
        /// Cells along a side.
        pub side: u32,
        /// Column and row of the first cell, counted from the surface's corner.
        pub first: [i32; 2],
        /// Height of each cell in µm of the surface's own lengths, little endian i16, row after row; 0 is the level of the
        /// highest peaks of its bare ground.
        pub heights_um: serde_bytes::ByteBuf,
    }
}

impl BrushRelief {
    /// Cells along a side at most.
    pub const SIDE_MOST: u32 = 32;
    /// Sides of a cell in the surface's own lengths, m.
    pub const CELLS_M: std::ops::RangeInclusive<f64> = 1e-6..=1.0;

    /// Fault of its numbers, if there is one.
    #[must_use]
    pub fn fault(&self) -> Option<&'static str> {
        let side = self.side as usize;
        if !(1..=Self::SIDE_MOST).contains(&self.side) || self.heights_um.len() != 2 * side * side {
            Some("a relief has other heights than its side says")
        } else if !Self::CELLS_M.contains(&self.cell_m) {
            Some("a cell of a relief is not of 1 µm to 1 m")
        } else {
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn state(x: f64, angle: f32, force_n: f32) -> BrushState {
        let contact = Contact {
            spine: 0,
            joint: 1,
            force_n,
        };
        let solve = Solve {
            event_ns: 1,
            stroke: 1,
            surface: 0,
            flags: 0,
            pose: Pose {
                position_m: [x, 0.0, 0.0],
                ..Pose::IDENTITY
            },
            zoom: 1.0,
            angles_rad: vec![[0.0, angle]],
            contacts: vec![contact],
        };
        BrushState {
            device: 1,
            device_epoch: 1,
            device_seq: 1,
            solves: vec![solve],
        }
    }

    #[test]
    fn a_message_is_as_long_as_its_parts_say() {
        let origin = crate::Origin {
            source: 1,
            epoch: 1,
        };
        let mut state = state(1.0, 0.1, 0.1);
        state.solves[0].angles_rad = vec![[0.0; 2]; 5];
        state.solves.push(state.solves[0].clone());
        let bytes = crate::encode(&origin, crate::Flags::NONE, 0, 0, 0, &state).expect("encoded");
        let said: usize = state.solves.iter().map(Solve::wire_bytes).sum();
        assert_eq!(
            bytes.len() - crate::HEADER_BYTES,
            BrushState::WIRE_BYTES + said
        );
    }

    #[test]
    fn a_state_of_any_length_is_messages_that_fit_and_no_solve_is_lost() {
        let origin = crate::Origin {
            source: 1,
            epoch: 1,
        };
        for (count, joints) in [(0, 0), (1, 1536), (300, 15), (1025, 60), (40, 1536)] {
            let mut state = state(0.0, 0.1, 0.1);
            let mut solve = state.solves.remove(0);
            solve.angles_rad = vec![[0.0; 2]; joints];
            state.solves = vec![solve; count];
            for (number, solve) in state.solves.iter_mut().enumerate() {
                solve.event_ns = number as u64;
            }
            let whole = state.wire_bytes() <= <BrushState as crate::Message>::MAX_BYTES;
            assert_eq!(state.fault().is_none(), whole, "{count} of {joints}");
            let parts = state.messages(Flags::REPLAY, Flags::FIRST, Flags::LAST);
            assert_eq!(parts.len() == 1, whole);
            let mut times = Vec::new();
            for (place, (flags, part)) in parts.iter().enumerate() {
                assert!(crate::encode(&origin, *flags, 0, 0, 0, part).is_ok());
                assert_eq!(part.fault(), None);
                assert_eq!(flags.has(Flags::FIRST), place == 0);
                assert_eq!(flags.has(Flags::CONTINUES), place + 1 < parts.len());
                assert_eq!(flags.has(Flags::LAST), place + 1 == parts.len());
                times.extend(part.solves.iter().map(|solve| solve.event_ns));
            }
            assert_eq!(times, (0..count as u64).collect::<Vec<_>>());
        }
    }

    #[test]
    fn numbers_that_no_brush_has_are_a_fault() {
        assert_eq!(state(1.0, 0.1, 0.1).fault(), None);
        assert!(state(1e30, 0.1, 0.1).fault().is_some());
        assert!(state(f64::NAN, 0.1, 0.1).fault().is_some());
        assert!(state(1.0, f32::NAN, 0.1).fault().is_some());
        assert!(state(1.0, 0.1, f32::INFINITY).fault().is_some());
        let zoomed = |zoom: f64| {
            let mut state = state(1.0, 0.1, 0.1);
            state.solves[0].zoom = zoom;
            state.fault()
        };
        assert_eq!((zoomed(0.01), zoomed(100.0)), (None, None));
        for zoom in [0.0, 0.009, 101.0, f64::NAN, f64::INFINITY] {
            assert!(zoomed(zoom).is_some(), "{zoom}");
        }
    }
}
