//! What a live brush does while it may not send: it keeps the path. Samples that lie within half a
//! cell of the chord between their neighbours are joined; in the air the newest one is enough.

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
}

/// Samples that wait for credit, in order.
#[derive(Clone, Debug, Default)]
pub struct Backlog {
    kept: Vec<Waiting>,
    /// Joined since the sample before the last one kept.
    joined: Vec<[f64; 3]>,
}

/// Half a cell, m.
const TOLERANCE_M: f64 = 1.25e-4;
/// Half a percent of the pressure counts as on the chord.
const TOLERANCE_PRESSURE: f64 = 5e-3;

fn point(sample: &StylusSample) -> [f64; 3] {
    match &sample.pose {
        StylusPose::Ferrule { pose } => pose.position_m,
        StylusPose::Contact { point_m, .. } => *point_m,
    }
}

fn pressure(sample: &StylusSample) -> f64 {
    match &sample.pose {
        StylusPose::Ferrule { .. } => 1.0,
        StylusPose::Contact { pressure, .. } => *pressure,
    }
}

fn in_air(sample: &StylusSample) -> bool {
    !sample.in_range || pressure(sample) == 0.0
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

impl Backlog {
    /// Adds the newest sample.
    pub fn push(&mut self, waiting: Waiting) {
        let count = self.kept.len();
        let same = self
            .kept
            .last()
            .is_some_and(|last| last.origin == waiting.origin);
        if same && in_air(&self.kept[count - 1].sample) && in_air(&waiting.sample) {
            self.kept[count - 1] = waiting;
            self.joined.clear();
            return;
        }
        if same && count >= 2 {
            let (a, m) = (&self.kept[count - 2], &self.kept[count - 1]);
            let touching = ![a, m, &waiting].iter().any(|w| in_air(&w.sample));
            let (start, middle, end) = (point(&a.sample), point(&m.sample), point(&waiting.sample));
            let span = waiting.event_ns.saturating_sub(a.event_ns).max(1) as f64;
            let share = m.event_ns.saturating_sub(a.event_ns) as f64 / span;
            let expected = pressure(&a.sample) * (1.0 - share) + pressure(&waiting.sample) * share;
            let even = (pressure(&m.sample) - expected).abs() <= TOLERANCE_PRESSURE;
            let near = |p: &[f64; 3]| off_chord(*p, start, end) <= TOLERANCE_M * TOLERANCE_M;
            let soon = waiting.event_ns - a.event_ns < 50_000_000;
            if touching && even && soon && near(&middle) && self.joined.iter().all(near) {
                self.joined.push(middle);
                self.kept[count - 1] = waiting;
                return;
            }
        }
        self.joined.clear();
        self.kept.push(waiting);
    }

    /// Takes all that waits.
    pub fn take(&mut self) -> Vec<Waiting> {
        self.joined.clear();
        std::mem::take(&mut self.kept)
    }

    /// Whether nothing waits.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.kept.is_empty()
    }

    /// Time of the oldest sample that waits.
    #[must_use]
    pub fn oldest_ns(&self) -> Option<u64> {
        self.kept.first().map(|waiting| waiting.event_ns)
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
            sample: StylusSample {
                pose,
                in_range: true,
                ..StylusSample::away()
            },
        }
    }

    #[test]
    fn a_straight_line_becomes_its_ends() {
        let mut backlog = Backlog::default();
        (0..40).for_each(|i| backlog.push(sample(i, 1e-4 * i as f64, 0.0, 0.5)));
        let seqs: Vec<u64> = backlog.take().iter().map(|w| w.seq).collect();
        assert_eq!(seqs, vec![0, 39]);
    }

    #[test]
    fn in_the_air_the_newest_is_enough_but_a_touch_is_kept() {
        let mut backlog = Backlog::default();
        for (seq, pressure) in [0.0, 0.0, 0.3, 0.0, 0.0].into_iter().enumerate() {
            backlog.push(sample(seq as u64, 0.01 * seq as f64, 0.0, pressure));
        }
        let seqs: Vec<u64> = backlog.take().iter().map(|w| w.seq).collect();
        assert_eq!(seqs, vec![1, 2, 4]);
    }

    proptest! {
        /// Whatever was drawn, no sample lies farther than half a cell from what is kept.
        #[test]
        fn the_path_is_kept(points in prop::collection::vec((-5e-4..5e-4f64, -5e-4..5e-4f64), 2..80)) {
            let mut backlog = Backlog::default();
            let (mut x, mut y) = (0.0, 0.0);
            let mut drawn = Vec::new();
            for (i, (dx, dy)) in points.into_iter().enumerate() {
                (x, y) = (x + dx, y + dy);
                drawn.push([x, y, 0.0]);
                backlog.push(sample(i as u64, x, y, 0.5));
            }
            let kept: Vec<[f64; 3]> = backlog.take().iter().map(|w| point(&w.sample)).collect();
            prop_assert_eq!(kept.last(), drawn.last());
            for p in drawn {
                let nearest = kept.windows(2).map(|c| off_chord(p, c[0], c[1])).fold(f64::MAX, f64::min);
                prop_assert!(nearest <= TOLERANCE_M * TOLERANCE_M * (1.0 + 1e-9));
            }
        }
    }
}
