//! Path of a live brush that may not send: samples that are within half a cell of the chord between their neighbours
//! are joined; in the air the newest one is enough.

use glam::DVec3;
use maulstick_num::geometry::Rigid;
use maulstick_types::Origin;
use maulstick_types::stylus::{StylusPose, StylusSample};

/// A sample that waits.
#[derive(Clone, Debug, PartialEq)]
pub struct Waiting {
    /// Its device.
    pub origin: Origin,
    /// Its number.
    pub seq: u64,
    /// When it was taken.
    pub event_ns: u64,
    /// Itself.
    pub sample: StylusSample,
    /// Clearance of the brush over the surfaces.
    pub place: Place,
}

/// Clearance of the brush at a sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// Clear of the surface: it paints nothing.
    Air,
    /// So near that the head may touch.
    Surface,
}

/// Samples that wait for credit, in order.
#[derive(Clone, Debug)]
pub struct PathSimplifier {
    head_length_m: f64,
    kept: Vec<Waiting>,
    /// Joined since the sample before the last one kept.
    joined: Vec<Points>,
}

/// Points of the brush whose paths are kept: of a pen its tip, of a 6-DOF device the ends of the
/// head, for a brush that turns on the spot moves its tip alone.
type Points = [[f64; 3]; 2];

/// Longest time between two samples that others are joined between, ns.
const LONGEST_NS: u64 = 50_000_000;

/// Half a cell, m.
const TOLERANCE_M: f64 = 1.25e-4;
/// Half a percent of the pressure counts as on the chord.
const TOLERANCE_PRESSURE: f64 = 5e-3;

fn points(sample: &StylusSample, head_length_m: f64) -> Points {
    match &sample.pose {
        StylusPose::Ferrule { pose } => {
            let ferrule = Rigid::from(pose);
            let tip = ferrule.point(DVec3::NEG_Z * head_length_m);
            [pose.position_m, tip.to_array()]
        }
        StylusPose::Contact { point_m, .. } => [*point_m; 2],
    }
}

fn pressure(sample: &StylusSample) -> f64 {
    match &sample.pose {
        StylusPose::Ferrule { .. } => 1.0,
        StylusPose::Contact { pressure, .. } => *pressure,
    }
}

/// Squared distance of `p` from the chord `a`-`b`.
fn off_chord(p: [f64; 3], a: [f64; 3], b: [f64; 3]) -> f64 {
    let sub = |u: [f64; 3], v: [f64; 3]| [u[0] - v[0], u[1] - v[1], u[2] - v[2]];
    let dot = |u: [f64; 3], v: [f64; 3]| u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
    let (chord, to) = (sub(b, a), sub(p, a));
    let length = dot(chord, chord);
    let t = if length > 0.0 {
        (dot(to, chord) / length).clamp(0.0, 1.0)
    } else {
        0.0
    };
    let off = sub(to, chord.map(|c| c * t));
    dot(off, off)
}

/// True if `middle` is on the path from `start` to `end`, within half a cell.
fn on_the_way(middle: &Points, start: &Points, end: &Points) -> bool {
    (0..2).all(|i| off_chord(middle[i], start[i], end[i]) <= TOLERANCE_M * TOLERANCE_M)
}

impl PathSimplifier {
    /// An empty one for a brush with a head of this length.
    #[must_use]
    pub fn new(head_length_m: f64) -> Self {
        Self {
            head_length_m,
            kept: Vec::new(),
            joined: Vec::new(),
        }
    }

    /// Adds the newest sample.
    pub fn push(&mut self, waiting: Waiting) {
        let count = self.kept.len();
        let same = self
            .kept
            .last()
            .is_some_and(|last| last.origin == waiting.origin);
        if same && self.kept[count - 1].place == Place::Air && waiting.place == Place::Air {
            self.kept[count - 1] = waiting;
            self.joined.clear();
            return;
        }
        if same && count >= 2 {
            let (a, m) = (&self.kept[count - 2], &self.kept[count - 1]);
            let touching = [a, m, &waiting].iter().all(|w| w.place == Place::Surface);
            let [start, middle, end] =
                [a, m, &waiting].map(|w| points(&w.sample, self.head_length_m));
            // Time that runs backward, or leaps, restarts the brush: such a sample stays.
            let span_ns = waiting.event_ns.checked_sub(a.event_ns);
            let at_ns = m.event_ns.checked_sub(a.event_ns);
            if let (Some(span_ns @ 1..LONGEST_NS), Some(at_ns)) = (span_ns, at_ns)
                && at_ns <= span_ns
                && touching
                && on_the_way(&middle, &start, &end)
                && self.joined.iter().all(|p| on_the_way(p, &start, &end))
            {
                let share = at_ns as f64 / span_ns as f64;
                let expected =
                    pressure(&a.sample) * (1.0 - share) + pressure(&waiting.sample) * share;
                if (pressure(&m.sample) - expected).abs() <= TOLERANCE_PRESSURE {
                    self.joined.push(middle);
                    self.kept[count - 1] = waiting;
                    return;
                }
            }
        }
        self.joined.clear();
        self.kept.push(waiting);
    }

    /// Follows a brush with a head of another length; what waits stays.
    pub fn set_head_length(&mut self, head_length_m: f64) {
        self.head_length_m = head_length_m;
    }

    /// The sample that waits for longest.
    #[must_use]
    pub fn first(&self) -> Option<&Waiting> {
        self.kept.first()
    }

    /// The newest sample.
    #[must_use]
    pub fn last(&self) -> Option<&Waiting> {
        self.kept.last()
    }

    /// Takes the samples before the first that was taken after `until_ns`.
    pub fn take_until(&mut self, until_ns: u64) -> Vec<Waiting> {
        let later = |waiting: &Waiting| waiting.event_ns > until_ns;
        let count = self.kept.iter().position(later);
        self.kept
            .drain(..count.unwrap_or(self.kept.len()))
            .collect()
    }

    /// Takes the sample that waits for longest; none or one.
    pub fn take_first(&mut self) -> Vec<Waiting> {
        self.kept.drain(..self.kept.len().min(1)).collect()
    }

    /// Takes all that waits.
    pub fn take(&mut self) -> Vec<Waiting> {
        self.joined.clear();
        std::mem::take(&mut self.kept)
    }

    /// True if it is empty.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.kept.is_empty()
    }

    /// Number of the first sample of a device that waits.
    #[must_use]
    pub fn first_of(&self, device: Origin) -> Option<u64> {
        let mut own = self.kept.iter().filter(|waiting| waiting.origin == device);
        own.next().map(|waiting| waiting.seq)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn sample(seq: u64, x: f64, y: f64, pressure: f64) -> Waiting {
        let pose = StylusPose::Contact {
            point_m: [x, y, 0.0],
            tilt_rad: [0.0; 2],
            twist_rad: 0.0,
            pressure,
        };
        Waiting {
            origin: Origin {
                source: 1,
                epoch: 1,
            },
            seq,
            event_ns: seq * 1_000_000,
            place: if pressure > 0.0 {
                Place::Surface
            } else {
                Place::Air
            },
            sample: StylusSample {
                pose,
                in_range: true,
                ..StylusSample::away()
            },
        }
    }

    #[test]
    fn a_straight_line_becomes_its_ends() {
        let mut backlog = PathSimplifier::new(0.025);
        (0..40).for_each(|i| backlog.push(sample(i, 1e-4 * i as f64, 0.0, 0.5)));
        let seqs: Vec<u64> = backlog.take().iter().map(|w| w.seq).collect();
        assert_eq!(seqs, vec![0, 39]);
    }

    #[test]
    fn in_the_air_the_newest_is_enough_but_a_touch_is_kept() {
        let mut backlog = PathSimplifier::new(0.025);
        for (seq, pressure) in [0.0, 0.0, 0.3, 0.0, 0.0].into_iter().enumerate() {
            backlog.push(sample(seq as u64, 0.01 * seq as f64, 0.0, pressure));
        }
        let seqs: Vec<u64> = backlog.take().iter().map(|w| w.seq).collect();
        assert_eq!(seqs, vec![1, 2, 4]);
    }

    /// A 6-DOF stylus whose ferrule stays and whose tip swings.
    fn swung(seq: u64, angle: f64) -> Waiting {
        let (sin, cos) = (libm::sin(0.5 * angle), libm::cos(0.5 * angle));
        let pose = StylusPose::Ferrule {
            pose: maulstick_types::Pose {
                position_m: [0.0, 0.0, 0.02],
                orientation: [sin, 0.0, 0.0, cos],
            },
        };
        let mut waiting = sample(seq, 0.0, 0.0, 1.0);
        waiting.sample.pose = pose;
        waiting
    }

    #[test]
    fn a_brush_that_turns_on_the_spot_keeps_its_tips_path() {
        let mut backlog = PathSimplifier::new(0.025);
        // There and back: the chord of the ends is a point, far from the path.
        for (seq, angle) in [0.0, 0.1, 0.2, 0.1, 0.0].into_iter().enumerate() {
            backlog.push(swung(seq as u64, angle));
        }
        let kept = backlog.take();
        assert!(
            kept.iter().any(|w| w.seq == 2),
            "the tip's path is cut short"
        );
        (0..5).for_each(|seq| backlog.push(swung(seq, 0.1)));
        assert_eq!(backlog.take().len(), 2, "a brush that rests is joined");
    }

    #[test]
    fn a_six_dof_stylus_in_the_air_is_joined() {
        let mut backlog = PathSimplifier::new(0.025);
        for seq in 0..5 {
            let mut waiting = swung(seq, 0.3 * (seq % 2) as f64);
            waiting.place = Place::Air;
            backlog.push(waiting);
        }
        assert_eq!(backlog.take().len(), 1);
    }

    #[test]
    fn time_that_runs_backward_is_kept() {
        let mut backlog = PathSimplifier::new(0.025);
        for (seq, event_ns) in [(0, 5_000_000), (1, 6_000_000), (2, 1_000_000)] {
            let waiting = sample(seq, 1e-5 * seq as f64, 0.0, 0.5);
            backlog.push(Waiting {
                event_ns,
                ..waiting
            });
        }
        assert_eq!(backlog.take().len(), 3);
    }

    proptest! {
        /// Whatever was drawn, no sample lies farther than half a cell from what is kept.
        #[test]
        fn the_path_is_kept(moves in prop::collection::vec((-5e-4..5e-4f64, -5e-4..5e-4f64), 2..80)) {
            let mut backlog = PathSimplifier::new(0.025);
            let (mut x, mut y) = (0.0, 0.0);
            let mut drawn = Vec::new();
            for (i, (dx, dy)) in moves.into_iter().enumerate() {
                (x, y) = (x + dx, y + dy);
                drawn.push([x, y, 0.0]);
                backlog.push(sample(i as u64, x, y, 0.5));
            }
            let kept: Vec<[f64; 3]> = backlog.take().iter().map(|w| points(&w.sample, 0.0)[0]).collect();
            prop_assert_eq!(kept.last(), drawn.last());
            for p in drawn {
                let nearest = kept.windows(2).map(|c| off_chord(p, c[0], c[1])).fold(f64::MAX, f64::min);
                prop_assert!(nearest <= TOLERANCE_M * TOLERANCE_M * (1.0 + 1e-9));
            }
        }
    }
}
