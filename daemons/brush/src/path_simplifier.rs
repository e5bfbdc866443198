//! Path of a live brush that may not send: samples that are within half a cell of the chord between their neighbours
//! are joined; in the air the newest one is enough, and among those that are too fast too, for nothing is painted between
//! them. What a hand could not have drawn in a minute is dropped.

use std::collections::VecDeque;

use glam::DVec3;
use maulstick_brush::speed_limit::SpeedLimit;
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

/// Approach of the brush to a sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Start {
    /// From the sample before.
    GoesOn,
    /// It begins anew there, for time did not advance.
    Anew,
    /// It begins anew there, for its hand was too fast.
    TooFast,
    /// It begins anew there, for samples before were dropped.
    AfterLoss,
}

/// Samples that wait for credit, in order. Their number and their way have a bound, whatever comes.
#[derive(Clone, Debug)]
pub struct PathSimplifier {
    head_length_m: f64,
    kept: VecDeque<Kept>,
    /// Joined since the sample before the last one kept.
    joined: Vec<Points>,
    /// The newest sample that came.
    newest: Option<(Origin, u64, Points, Place)>,
    speed: SpeedLimit,
    /// Sum of the ways of those kept, m.
    way_m: f64,
    /// True while what comes is dropped.
    drops: bool,
    superseded: u64,
    dropped: u64,
}

/// A sample that is kept.
#[derive(Clone, Debug)]
struct Kept {
    waiting: Waiting,
    start: Start,
    /// Way from the sample before, m.
    way_m: f64,
}

/// Samples that wait at most: of a path they are a few for each centimetre.
const MOST_KEPT: usize = 8192;
/// Longest way that waits, m: that of a minute of painting.
const LONGEST_M: f64 = 20.0;

/// Points of the brush whose paths are kept: of a pen its tip, of a 6-DOF device the ends of the
/// head, for a brush that turns on the spot moves its tip alone.
type Points = [[f64; 3]; 2];

/// Longest time between two samples that others are joined between, ns.
const LONGEST_NS: u64 = 50_000_000;

/// Samples that are joined between two at most: those of a device of 8 kHz.
const MOST_JOINED: usize = 400;

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

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (DVec3::from_array(a) - DVec3::from_array(b)).length()
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
            kept: VecDeque::new(),
            joined: Vec::new(),
            newest: None,
            speed: SpeedLimit::default(),
            way_m: 0.0,
            drops: false,
            superseded: 0,
            dropped: 0,
        }
    }

    /// Follows a brush with a head of another length; what waits stays.
    pub fn set_head_length(&mut self, head_length_m: f64) {
        self.head_length_m = head_length_m;
        // Points of the other head say nothing of how fast this one is, nor of what lies on its way.
        self.newest = None;
        self.joined.clear();
    }

    /// The sample that waits for longest.
    #[must_use]
    pub fn first(&self) -> Option<&Waiting> {
        self.kept.front().map(|kept| &kept.waiting)
    }

    /// The newest sample.
    #[must_use]
    pub fn last(&self) -> Option<&Waiting> {
        self.kept.back().map(|kept| &kept.waiting)
    }

    /// Adds the newest sample; false where there is no room for it. A sample in the air has room always.
    pub fn push(&mut self, waiting: Waiting) -> bool {
        let (start, way_m) = self.step(&waiting);
        let is_full = self.kept.len() >= MOST_KEPT || self.way_m >= LONGEST_M;
        if is_full && waiting.place == Place::Surface {
            (self.drops, self.dropped) = (true, self.dropped + 1);
            return false;
        }
        let start = if std::mem::take(&mut self.drops) {
            Start::AfterLoss
        } else {
            start
        };
        let mut added = Kept {
            waiting,
            start,
            way_m,
        };
        if self.is_in_the_air(&added) {
            self.replace(added);
            self.joined.clear();
        } else if self.begins_anew_again(&added) {
            self.superseded += u64::from(added.start == Start::TooFast);
            added.start = Start::AfterLoss;
            self.replace(added);
            self.joined.clear();
        } else if let Some(middle) = self.joins(&added) {
            self.joined.push(middle);
            self.replace(added);
        } else {
            self.joined.clear();
            self.way_m += added.way_m;
            self.kept.push_back(added);
        }
        true
    }

    /// Approach of the brush to a sample, and its way on the surface from the one before, m.
    fn step(&mut self, waiting: &Waiting) -> (Start, f64) {
        let here = points(&waiting.sample, self.head_length_m);
        let this = (waiting.origin, waiting.event_ns, here, waiting.place);
        let before = self.newest.replace(this);
        let Some((_, before_ns, there, place)) =
            before.filter(|(origin, ..)| *origin == waiting.origin)
        else {
            return (Start::GoesOn, 0.0);
        };
        let touches = place == Place::Surface && waiting.place == Place::Surface;
        let way_m = if touches {
            (0..2)
                .map(|end| distance(here[end], there[end]))
                .fold(0.0, f64::max)
        } else {
            0.0
        };
        let advances = waiting.event_ns > before_ns;
        let time_ns = waiting.event_ns.saturating_sub(before_ns);
        let start = match advances {
            false => Start::Anew,
            true if self.speed.passes(way_m, time_ns) => Start::GoesOn,
            true => Start::TooFast,
        };
        if start == Start::GoesOn || !touches {
            (Start::GoesOn, way_m)
        } else {
            (start, 0.0)
        }
    }

    /// The last sample and where each of the two is, if it is of the same device.
    fn last_before(&self, added: &Kept) -> Option<(&Kept, [Place; 2])> {
        let last = self.kept.back()?;
        let same = last.waiting.origin == added.waiting.origin;
        same.then_some((last, [last.waiting.place, added.waiting.place]))
    }

    /// True if a sample and the one before it are in the air.
    fn is_in_the_air(&self, added: &Kept) -> bool {
        let last = self.last_before(added);
        last.is_some_and(|(_, places)| places == [Place::Air; 2])
    }

    /// True if the brush begins anew at a sample and at the one before it, which so paints nothing.
    fn begins_anew_again(&self, added: &Kept) -> bool {
        self.last_before(added).is_some_and(|(last, places)| {
            let begin_anew = last.start > Start::GoesOn && added.start > Start::GoesOn;
            begin_anew && places == [Place::Surface; 2]
        })
    }

    /// Puts a sample in the place of the last one.
    fn replace(&mut self, added: Kept) {
        if let Some(last) = self.kept.back_mut() {
            self.way_m += added.way_m;
            *last = Kept {
                start: last.start.max(added.start),
                way_m: last.way_m + added.way_m,
                waiting: added.waiting,
            };
        }
    }

    /// Points of the last sample, if it is on the chord from the one before it to this one.
    fn joins(&self, added: &Kept) -> Option<Points> {
        let count = self.kept.len();
        let before = self.kept.get(count.checked_sub(2)?)?;
        let last = self.kept.back()?;
        let goes_on = [last.start, added.start] == [Start::GoesOn; 2];
        let (a, m, waiting) = (&before.waiting, &last.waiting, &added.waiting);
        if !goes_on || m.origin != waiting.origin || self.joined.len() >= MOST_JOINED {
            return None;
        }
        let touching = [a, m, waiting].iter().all(|w| w.place == Place::Surface);
        let [start, middle, end] = [a, m, waiting].map(|w| points(&w.sample, self.head_length_m));
        // Time that runs backward, or leaps, restarts the brush: such a sample stays.
        let span_ns = waiting.event_ns.checked_sub(a.event_ns)?;
        let at_ns = m.event_ns.checked_sub(a.event_ns)?;
        let is_between = (1..LONGEST_NS).contains(&span_ns) && at_ns <= span_ns;
        if !is_between
            || !touching
            || !on_the_way(&middle, &start, &end)
            || !self.joined.iter().all(|p| on_the_way(p, &start, &end))
        {
            return None;
        }
        let share = at_ns as f64 / span_ns as f64;
        let expected = pressure(&a.sample) * (1.0 - share) + pressure(&waiting.sample) * share;
        ((pressure(&m.sample) - expected).abs() <= TOLERANCE_PRESSURE).then_some(middle)
    }

    /// Takes the oldest one.
    pub fn pop(&mut self) -> Option<(Start, Waiting)> {
        let oldest = self.kept.pop_front()?;
        self.way_m = if self.kept.is_empty() {
            0.0
        } else {
            self.way_m - oldest.way_m
        };
        Some((oldest.start, oldest.waiting))
    }

    /// Forgets all that waits.
    pub fn clear(&mut self) {
        self.joined.clear();
        self.kept.clear();
        (self.newest, self.way_m, self.drops) = (None, 0.0, false);
    }

    /// True if it is empty.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.kept.is_empty()
    }

    /// Samples that wait.
    #[must_use]
    pub fn len(&self) -> usize {
        self.kept.len()
    }

    /// Samples so far that were too fast and took the place of one before them at which the brush began anew too.
    #[must_use]
    pub fn superseded(&self) -> u64 {
        self.superseded
    }

    /// Samples so far for which there was no room.
    #[must_use]
    pub fn dropped(&self) -> u64 {
        self.dropped
    }

    /// Number of the first sample of a device that waits.
    #[must_use]
    pub fn first_of(&self, device: Origin) -> Option<u64> {
        let mut waiting = self.kept.iter().map(|kept| &kept.waiting);
        waiting
            .find(|waiting| waiting.origin == device)
            .map(|waiting| waiting.seq)
    }
}

#[cfg(test)]
mod tests;
