//! Path of the handle from one sample to the next: the parabola through both and the one before, walked cell by cell.
//!
//! Straight chords between samples would depend on the sample rate in second order; the parabola does so only in
//! third order.

use glam::{DQuat, DVec3, DVec4};
use maulstick_num::geometry::{Rigid, canonical};

/// Number of chords by which the length of the path is measured.
const CHORDS: usize = 8;
/// Ratio of an interval to the one before it from which it counts as a pause; the speed before a pause says little
/// about the path across it.
const PAUSE: f64 = 4.0;

/// Bend of a path that is always allowed, m: that of a hand which turns round at 1.5 m/s between two frames of a
/// window. More comes from a pointer that leapt before, and would swing far out.
const FREE_BEND_M: f64 = 0.03;

/// A sampled pose and its time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampled {
    /// Brush frame to surface axes.
    pub pose: Rigid,
    /// Rig clock, ns.
    pub event_ns: u64,
}

/// Path of the handle between two samples.
#[derive(Clone, Debug)]
pub struct HandlePath {
    from: Rigid,
    to: Rigid,
    /// Curvature: the second difference of position and quaternion.
    bend: (DVec3, DQuat),
    /// Length up to each of the chords' ends, m.
    lengths: [f64; CHORDS + 1],
}

impl HandlePath {
    /// The path from `from` to `to` of a hand that came from `before`; straight without it. The bend is limited
    /// across a pause, so that the path never runs backward (a fast hand may have stopped meanwhile), and after a
    /// leap, so that it does not swing out. Its length is that of the farther of the ferrule and the point of a head
    /// of `head_m`.
    #[must_use]
    pub fn new(before: Option<&Sampled>, from: &Sampled, to: &Sampled, head_m: f64) -> Self {
        let near = |of: DQuat, q: DQuat| if of.dot(q) < 0.0 { -q } else { q };
        let end = Rigid {
            rotation: near(from.pose.rotation, to.pose.rotation),
            ..to.pose
        };
        let bend = before.map_or(
            (DVec3::ZERO, DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0)),
            |before| {
                let (h1, h2) = (
                    from.event_ns.saturating_sub(before.event_ns).max(1) as f64,
                    to.event_ns.saturating_sub(from.event_ns).max(1) as f64,
                );
                // The second divided difference of three samples, in the parameter of this path.
                let (first, second) = (h2 * h2 / (h1 * (h1 + h2)), h2 / (h1 + h2));
                let start = near(from.pose.rotation, before.pose.rotation);
                let place = (end.translation - from.pose.translation) * second
                    - (from.pose.translation - before.pose.translation) * first;
                let turn = (end.rotation - from.pose.rotation) * second
                    - (from.pose.rotation - start) * first;
                let gone = end.translation - from.pose.translation;
                if h2 > PAUSE * h1 {
                    (
                        limited(place, gone),
                        limited_turn(turn, end.rotation - from.pose.rotation),
                    )
                } else {
                    (without_a_leap(place, gone), turn)
                }
            },
        );
        let mut path = Self {
            from: from.pose,
            to: end,
            bend,
            lengths: [0.0; CHORDS + 1],
        };
        let tip = DVec3::NEG_Z * head_m;
        let mut last = path.at(0.0);
        for chord in 1..=CHORDS {
            let next = path.at(chord as f64 / CHORDS as f64);
            let moved = |p: DVec3| (next.point(p) - last.point(p)).length();
            path.lengths[chord] = path.lengths[chord - 1] + moved(tip).max(moved(DVec3::ZERO));
            last = next;
        }
        path
    }

    /// Length of the path, m.
    #[must_use]
    pub fn length_m(&self) -> f64 {
        self.lengths[CHORDS]
    }

    /// The pose at `s` from 0 to 1.
    #[must_use]
    pub fn at(&self, s: f64) -> Rigid {
        let bent = s * (s - 1.0);
        let straight = self.from.translation.lerp(self.to.translation, s);
        let turned = self.from.rotation * (1.0 - s) + self.to.rotation * s + self.bend.1 * bent;
        Rigid {
            translation: straight + self.bend.0 * bent,
            rotation: canonical(turned),
        }
    }

    /// The parameter at which the path is `length` long, m.
    #[must_use]
    pub fn after(&self, length: f64) -> f64 {
        let chord = (1..CHORDS)
            .find(|chord| self.lengths[*chord] >= length)
            .unwrap_or(CHORDS);
        let (start, end) = (self.lengths[chord - 1], self.lengths[chord]);
        let part = if end > start {
            (length - start) / (end - start)
        } else {
            1.0
        };
        ((chord - 1) as f64 + part.clamp(0.0, 1.0)) / CHORDS as f64
    }
}

/// The bend limited so that neither the path along the surface nor its height turns back.
fn limited(bend: DVec3, path: DVec3) -> DVec3 {
    let along = bend.truncate().clamp_length_max(path.truncate().length());
    along.extend(bend.z.clamp(-path.z.abs(), path.z.abs()))
}

/// The bend along the surface, limited for a path that may follow a leap of the pointer.
fn without_a_leap(bend: DVec3, path: DVec3) -> DVec3 {
    let most = path.truncate().length().max(FREE_BEND_M);
    bend.truncate().clamp_length_max(most).extend(bend.z)
}

/// [`limited`] for a rotation.
fn limited_turn(bend: DQuat, turn: DQuat) -> DQuat {
    let [bend, turn] = [bend, turn].map(DVec4::from);
    DQuat::from_vec4(bend.clamp_length_max(turn.length()))
}

/// A segment of the path between two samples.
#[derive(Clone, Copy, Debug)]
pub struct PathSegment<'a> {
    /// The whole path between the samples.
    pub path: &'a HandlePath,
    /// Its parameter where the piece begins.
    pub from: f64,
    /// Parameter where the piece ends.
    pub to: f64,
    /// Start of the path, rig clock, ns.
    pub start_ns: u64,
    /// End of the path, rig clock, ns.
    pub end_ns: u64,
    /// Path length from the previous solve to the end of this piece, m: the piece's own length unless a sample was in
    /// between.
    pub length_m: f64,
}

impl PathSegment<'_> {
    /// The pose and time at the end.
    #[must_use]
    pub fn end(&self) -> Sampled {
        let whole = (self.end_ns - self.start_ns) as f64;
        Sampled {
            pose: self.path.at(self.to),
            event_ns: self.start_ns + (whole * self.to) as u64,
        }
    }

    /// The two halves of this piece.
    #[must_use]
    pub fn halves(&self) -> [Self; 2] {
        let middle = 0.5 * (self.from + self.to);
        [
            Self {
                to: middle,
                length_m: 0.5 * self.length_m,
                ..*self
            },
            Self {
                from: middle,
                length_m: 0.5 * self.length_m,
                ..*self
            },
        ]
    }
}

#[cfg(test)]
mod tests {
    use maulstick_num::geometry::rotation;
    use maulstick_num::sin_cos;

    use super::*;

    fn sampled(t: f64) -> Sampled {
        let (s, c) = sin_cos(t);
        Sampled {
            pose: Rigid {
                rotation: rotation(DVec3::Z, 0.5 * t),
                translation: DVec3::new(c, s, 0.0),
            },
            event_ns: 1_000 + (t * 1e9) as u64,
        }
    }

    /// Greatest distance of the path from the circle that its samples lie on.
    fn error(h: f64, before: Option<f64>) -> f64 {
        let before = before.map(sampled);
        let path = HandlePath::new(before.as_ref(), &sampled(1.0), &sampled(1.0 + h), 0.1);
        (0..=20)
            .map(|i| (path.at(f64::from(i) / 20.0).translation.length() - 1.0).abs())
            .fold(0.0, f64::max)
    }

    #[test]
    fn it_follows_a_circle_in_third_order() {
        let (coarse, fine) = (error(0.1, Some(0.9)), error(0.05, Some(0.95)));
        assert!(coarse / fine > 7.0, "{coarse:e} {fine:e}");
        assert!(
            error(0.1, Some(0.93)) < 0.2 * error(0.1, None),
            "samples need not be even"
        );
        let (coarse, fine) = (error(0.1, None), error(0.05, None));
        assert!(coarse / fine < 5.0, "straight chords are of second order");
    }

    #[test]
    fn after_a_leap_it_does_not_swing_out_and_a_hand_that_turns_round_is_followed() {
        let at = |x: f64, ms: u64| Sampled {
            pose: Rigid {
                rotation: DQuat::IDENTITY,
                translation: DVec3::X * x,
            },
            event_ns: ms * 1_000_000,
        };
        // 300 mm in 4 ms, and 5 mm in the 12 after that: the parabola would go 160 mm on.
        let path = HandlePath::new(Some(&at(-0.3, 0)), &at(0.0, 4), &at(0.005, 16), 0.02);
        let farthest = (0..=100).map(|i| path.at(f64::from(i) * 0.01).translation.x);
        let farthest = farthest.fold(0.0, f64::max);
        assert!(farthest < 0.011, "{farthest} m");
        assert!(path.length_m() < 0.02, "{} m", path.length_m());
        // A hand of 1.5 m/s that turns round within a frame continues by what the parabola says.
        let turn = HandlePath::new(Some(&at(-0.024, 0)), &at(0.0, 16), &at(0.0, 32), 0.02);
        let [quarter, half] = [0.25, 0.5].map(|s| turn.at(s).translation.x);
        assert!((quarter - 0.00225).abs() < 1e-12 && (half - 0.003).abs() < 1e-12);
    }

    #[test]
    fn across_a_pause_it_goes_nowhere_backward() {
        let at = |x: f64, z: f64, ms: u64| Sampled {
            pose: Rigid {
                rotation: rotation(DVec3::Z, x),
                translation: DVec3::new(x, 0.0, z),
            },
            event_ns: ms * 1_000_000,
        };
        // At the pace before it would go 125 mm, and 25 mm deep; it goes 3 mm, and 1 mm.
        let before = at(-0.002, 0.0004, 996);
        let (from, to) = (at(0.0, 0.0, 1000), at(0.003, -0.001, 1250));
        let monotone = |to: &Sampled| {
            let path = HandlePath::new(Some(&before), &from, to, 0.1);
            let places: Vec<Rigid> = (0..=20).map(|i| path.at(f64::from(i) / 20.0)).collect();
            places.windows(2).all(|pair| {
                let [a, b] = [pair[0], pair[1]];
                let turned = b.rotation.z - a.rotation.z;
                b.translation.x >= a.translation.x - 1e-12
                    && b.translation.z <= a.translation.z + 1e-12
                    && turned >= -1e-12
            })
        };
        assert!(monotone(&to));
        // Within evenly spaced samples a turn back is one.
        let soon = Sampled {
            event_ns: 1_004_000_000,
            ..at(-0.003, -0.001, 0)
        };
        assert!(!monotone(&soon));
    }

    #[test]
    fn its_ends_are_the_samples_and_its_length_is_walked_evenly() {
        let path = HandlePath::new(Some(&sampled(0.9)), &sampled(1.0), &sampled(1.2), 0.1);
        for (s, t) in [(0.0, 1.0), (1.0, 1.2)] {
            let pose = sampled(t).pose;
            assert!((path.at(s).translation - pose.translation).length() < 1e-14);
            assert!(path.at(s).rotation.dot(pose.rotation).abs() > 1.0 - 1e-12);
        }
        for part in [0.0, 0.3, 0.5, 1.0] {
            let s = path.after(part * path.length_m());
            assert!((s - part).abs() < 0.02, "{part}: {s}");
        }
    }
}
