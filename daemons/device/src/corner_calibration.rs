//! The corners of the canvas, as a hand shows them one after the other: samples in, corners out.
//!
//! A device that senses a touch (a pen's pressure, a switch that is held down) means the corner for
//! as long as it touches, and the corner is the mean of the touch. One that does not means it by
//! keeping still: the corner is the mean of a second within a millimetre. A pen on its stand keeps
//! still too; so keeping still counts only after a motion, and away from the corners before.

use glam::DVec3;

/// Touch of the hand, as the device senses it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Touch {
    /// It does.
    Down,
    /// It does not.
    Up,
    /// The device does not sense it: keeping still counts as a touch.
    Unknown,
}

/// A sample of the hand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HandSample {
    /// Position, device frame, m.
    pub point: DVec3,
    /// Direction of the handle, away from the canvas, device frame; `None` if that is not sensed.
    pub handle: Option<DVec3>,
    /// Touch signal of the device.
    pub touch: Touch,
    /// When, s.
    pub time_s: f64,
}

/// Reading of the hand at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum HandReading {
    /// A sample.
    Sample(HandSample),
    /// It is out of range, or the device says nothing.
    Away,
}

/// A corner of the canvas, in the order in which they are shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Corner {
    /// Lower left.
    LowerLeft,
    /// Lower right.
    LowerRight,
    /// Upper left.
    UpperLeft,
}

impl Corner {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::LowerLeft, Self::LowerRight, Self::UpperLeft];
}

impl std::fmt::Display for Corner {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::LowerLeft => "lower left",
            Self::LowerRight => "lower right",
            Self::UpperLeft => "upper left",
        })
    }
}

/// Progress by a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Progress {
    /// Nothing yet.
    Going,
    /// A corner: the mean of where the hand was, m.
    Found(Corner, DVec3),
    /// A rejected touch.
    Rejected(TouchRejection),
}

/// Reason why a touch was rejected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TouchRejection {
    /// The hand moved in it.
    Moved,
    /// It is where another corner is.
    SamePlace,
}

impl std::fmt::Display for TouchRejection {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Moved => "the hand moved; touch the corner again and keep still",
            Self::SamePlace => "this is the corner before; go on to the next",
        })
    }
}

/// A hand keeps still within this of where it began, m.
const STILL_M: f64 = 1e-3;
/// Time for which it keeps still, s.
const STILL_S: f64 = 1.0;
/// CornerCalibration are at least as far apart, and a hand has moved that has gone so far, m.
const APART_M: f64 = 5e-3;
/// Samples that are farther apart are not of one touch, s.
const GAP_S: f64 = 0.25;

/// Samples since the hand came to a place.
#[derive(Clone, Copy, Debug)]
struct Stay {
    first: DVec3,
    sum: DVec3,
    handle: DVec3,
    count: f64,
    since_s: f64,
    last_s: f64,
    /// It has left the place within a touch.
    moved: bool,
}

impl Stay {
    fn at(sample: &HandSample) -> Self {
        Self {
            first: sample.point,
            sum: sample.point,
            handle: sample.handle.unwrap_or_default(),
            count: 1.0,
            since_s: sample.time_s,
            last_s: sample.time_s,
            moved: false,
        }
    }

    fn add(&mut self, sample: &HandSample) {
        self.moved |= sample.point.distance(self.first) > STILL_M;
        self.sum += sample.point;
        self.count += 1.0;
        self.last_s = sample.time_s;
    }

    fn mean(&self) -> DVec3 {
        self.sum / self.count
    }
}

/// Calibration by the three corners that a hand touches.
#[derive(Clone, Copy, Debug)]
pub struct CornerCalibration {
    found: [DVec3; 3],
    /// Sum over the found corners of where the handle pointed.
    handle: DVec3,
    count: usize,
    touch: Touch,
    stay: Option<Stay>,
    /// Position of the hand when the corner was requested; `None` once it has moved away.
    start: Option<DVec3>,
    begun: bool,
}

impl Default for CornerCalibration {
    fn default() -> Self {
        Self::new()
    }
}

impl CornerCalibration {
    /// None is found.
    #[must_use]
    pub fn new() -> Self {
        Self {
            found: [DVec3::ZERO; 3],
            handle: DVec3::ZERO,
            count: 0,
            touch: Touch::Up,
            stay: None,
            start: None,
            begun: false,
        }
    }

    /// The corner to show next; `None` once all are found.
    #[must_use]
    pub fn wanted(&self) -> Option<Corner> {
        Corner::ALL.get(self.count).copied()
    }

    /// The corners, once all are found, m.
    #[must_use]
    pub fn all(&self) -> Option<[DVec3; 3]> {
        (self.count == 3).then_some(self.found)
    }

    /// Direction of the handle at the corners, of any length; 0 if that is not sensed.
    #[must_use]
    pub fn handle(&self) -> DVec3 {
        self.handle
    }

    /// The hand is out of sight: what it began is void.
    pub fn lose(&mut self) {
        (self.stay, self.touch) = (None, Touch::Up);
    }

    /// Takes in a sample. One that is no number, or is not after the one before, ends what the hand began.
    pub fn see(&mut self, sample: &HandSample) -> Progress {
        let Some(corner) = self.wanted() else {
            return Progress::Going;
        };
        if !sample.point.is_finite() || !sample.time_s.is_finite() {
            self.lose();
            return Progress::Going;
        }
        if !self.begun {
            (self.start, self.begun) = (Some(sample.point), true);
        }
        if self
            .start
            .is_some_and(|start| start.distance(sample.point) > APART_M)
        {
            self.start = None;
        }
        let goes_on = self.stay.is_some_and(|stay| {
            let passed_s = sample.time_s - stay.last_s;
            (0.0..=GAP_S).contains(&passed_s)
        });
        let ended = self.touch == Touch::Down && sample.touch != Touch::Down;
        let touched = self.stay.take().filter(|_| goes_on);
        if self.touch != sample.touch {
            self.touch = sample.touch;
            self.stay = (sample.touch != Touch::Up).then(|| Stay::at(sample));
            return match touched.filter(|_| ended) {
                Some(stay) => self.judge(corner, &stay),
                None => Progress::Going,
            };
        }
        match sample.touch {
            Touch::Up => {}
            Touch::Down => {
                // A touch that was out of sight for a while is judged by none of its parts.
                self.stay = touched;
                if let Some(stay) = &mut self.stay {
                    stay.add(sample);
                }
            }
            Touch::Unknown => return self.wait(corner, touched, sample),
        }
        Progress::Going
    }

    /// A hand that cannot say that it touches.
    fn wait(&mut self, corner: Corner, stay: Option<Stay>, sample: &HandSample) -> Progress {
        let mut stay = stay.unwrap_or_else(|| Stay::at(sample));
        stay.add(sample);
        if stay.moved {
            stay = Stay::at(sample);
        }
        let still = sample.time_s - stay.since_s >= STILL_S;
        if still && self.start.is_none() && self.is_apart(stay.mean()) {
            return self.find(corner, &stay);
        }
        self.stay = Some(stay);
        Progress::Going
    }

    /// A touch that has ended.
    fn judge(&mut self, corner: Corner, stay: &Stay) -> Progress {
        if stay.moved {
            return Progress::Rejected(TouchRejection::Moved);
        }
        if self.is_apart(stay.mean()) {
            self.find(corner, stay)
        } else {
            Progress::Rejected(TouchRejection::SamePlace)
        }
    }

    fn is_apart(&self, place: DVec3) -> bool {
        let before = &self.found[..self.count];
        before.iter().all(|other| other.distance(place) > APART_M)
    }

    fn find(&mut self, corner: Corner, stay: &Stay) -> Progress {
        let place = stay.mean();
        self.handle += stay.handle;
        self.found[self.count] = place;
        self.count += 1;
        (self.start, self.stay) = (Some(place), None);
        Progress::Found(corner, place)
    }
}

#[cfg(test)]
mod tests {
    use maulstick_num::sin;
    use proptest::prelude::*;

    use super::*;

    const PLACES: [DVec3; 3] = [
        DVec3::new(-0.06, -0.05, 0.01),
        DVec3::new(0.07, -0.05, 0.01),
        DVec3::new(-0.06, 0.05, 0.02),
    ];
    const REST: DVec3 = DVec3::new(0.1, 0.1, 0.1);

    /// A hand that comes by places at 1 kHz, with a tremor of 10 Hz.
    struct Hand {
        corners: CornerCalibration,
        time_s: f64,
        at: DVec3,
        tremor_m: f64,
        told: Vec<Progress>,
    }

    impl Hand {
        fn new(tremor_m: f64) -> Self {
            Self {
                corners: CornerCalibration::new(),
                time_s: 0.0,
                at: REST,
                tremor_m,
                told: Vec::new(),
            }
        }

        fn sample(&mut self, point: DVec3, touch: Touch) {
            self.time_s += 1e-3;
            let shake = self.tremor_m * sin(2.0 * std::f64::consts::PI * 10.0 * self.time_s);
            let sample = HandSample {
                point: point + DVec3::new(shake, 0.0, -shake),
                handle: Some(DVec3::Z),
                touch,
                time_s: self.time_s,
            };
            match self.corners.see(&sample) {
                Progress::Going => {}
                told => self.told.push(told),
            }
        }

        fn stay(&mut self, seconds: f64, touch: Touch) {
            for _ in 0..(seconds * 1e3) as u32 {
                self.sample(self.at, touch);
            }
        }

        fn go(&mut self, to: DVec3, seconds: f64, touch: Touch) {
            let from = self.at;
            let ticks = (seconds * 1e3) as u32;
            for tick in 1..=ticks {
                self.sample(from.lerp(to, f64::from(tick) / f64::from(ticks)), touch);
            }
            self.at = to;
        }

        fn all_near(&self, off_m: f64) -> bool {
            let found = self.corners.all().expect("all three");
            found.iter().zip(PLACES).all(|(a, b)| a.distance(b) < off_m)
        }
    }

    #[test]
    fn a_hand_that_keeps_still_at_three_places_shows_the_corners() {
        let mut hand = Hand::new(1e-4);
        hand.stay(5.0, Touch::Unknown);
        assert_eq!(hand.told, [], "a pen on its stand shows nothing");
        for place in PLACES {
            hand.go(place, 0.7, Touch::Unknown);
            hand.stay(0.8, Touch::Unknown);
            let before = hand.told.len();
            hand.stay(0.3, Touch::Unknown);
            assert_eq!(hand.told.len(), before + 1, "after a second");
            hand.stay(3.0, Touch::Unknown);
            assert_eq!(hand.told.len(), before + 1, "and once");
        }
        assert!(hand.all_near(1e-4), "{:?}", hand.told);
        // The seeded fault: a hand that trembles by 2 mm shows none.
        let mut hand = Hand::new(2e-3);
        for place in PLACES {
            hand.go(place, 0.7, Touch::Unknown);
            hand.stay(3.0, Touch::Unknown);
        }
        assert_eq!(hand.told, []);
    }

    #[test]
    fn a_slow_hand_is_not_a_still_one() {
        let mut hand = Hand::new(0.0);
        hand.go(PLACES[0], 60.0, Touch::Unknown);
        // 3.4 mm a second.
        assert_eq!(hand.told, []);
    }

    #[test]
    fn touches_are_corners_where_they_do_not_move_and_not_twice_the_same() {
        let mut hand = Hand::new(1e-4);
        hand.go(PLACES[0] + DVec3::X * 0.003, 0.5, Touch::Up);
        hand.go(PLACES[0], 0.2, Touch::Down);
        hand.stay(0.1, Touch::Up);
        assert_eq!(hand.told, [Progress::Rejected(TouchRejection::Moved)]);
        hand.stay(0.2, Touch::Down);
        hand.stay(0.1, Touch::Up);
        hand.stay(0.2, Touch::Down);
        hand.stay(2.0, Touch::Up);
        assert!(
            matches!(
                hand.told[1..],
                [
                    Progress::Found(Corner::LowerLeft, _),
                    Progress::Rejected(TouchRejection::SamePlace)
                ]
            ),
            "{:?}",
            hand.told
        );
        for place in &PLACES[1..] {
            hand.go(*place, 0.5, Touch::Up);
            hand.stay(0.2, Touch::Down);
            assert_eq!(hand.corners.all(), None, "not before it is lifted");
            hand.stay(0.01, Touch::Up);
        }
        assert!(hand.all_near(1e-4), "{:?}", hand.told);
    }

    /// A device that cannot tell a touch, but has a switch.
    #[test]
    fn a_switch_that_is_pressed_shows_a_corner_at_once() {
        let mut hand = Hand::new(1e-4);
        for place in PLACES {
            hand.go(place, 0.7, Touch::Unknown);
            hand.stay(0.1, Touch::Down);
            hand.stay(0.01, Touch::Unknown);
        }
        assert!(hand.all_near(1e-4), "{:?}", hand.told);
    }

    #[test]
    fn a_hand_that_was_out_of_sight_begins_again() {
        let mut hand = Hand::new(0.0);
        hand.go(PLACES[0], 0.5, Touch::Unknown);
        hand.stay(0.7, Touch::Unknown);
        hand.time_s += 1.0;
        hand.stay(0.7, Touch::Unknown);
        assert_eq!(hand.told, [], "a second that nobody saw");
        hand.corners.lose();
        hand.stay(0.7, Touch::Unknown);
        assert_eq!(hand.told, []);
        hand.sample(DVec3::NAN, Touch::Unknown);
        hand.stay(0.7, Touch::Unknown);
        assert_eq!(hand.told, []);
        hand.stay(0.5, Touch::Unknown);
        assert_eq!(hand.told.len(), 1);
        let mut hand = Hand::new(0.0);
        hand.go(PLACES[0], 0.5, Touch::Up);
        hand.stay(0.2, Touch::Down);
        hand.corners.lose();
        hand.stay(0.2, Touch::Up);
        assert_eq!(hand.told, [], "a touch of which the end was not seen");
    }

    proptest! {
        /// Whatever comes in, corners are numbers, apart from each other, and near to where the hand was.
        #[test]
        fn no_mutation_of_a_hand_makes_corners_that_are_none(
            steps in prop::collection::vec(
                (0u8..8, 0u8..3, -0.1..0.1f64, -0.5..2.0f64, 1u8..20), 1..40),
        ) {
            let mut corners = CornerCalibration::new();
            let (mut at, mut time_s) = (DVec3::ZERO, 0.0);
            for (kind, touch, by, passed_s, times) in steps {
                match kind {
                    0 => at.x += by,
                    1 => at.y += by,
                    2 => at.z = f64::NAN,
                    3 => at = DVec3::ZERO,
                    4 => corners.lose(),
                    _ => at.x += 1e-3 * by,
                }
                let touch = [Touch::Down, Touch::Up, Touch::Unknown][usize::from(touch)];
                for _ in 0..times {
                    time_s += if kind == 5 { passed_s } else { 0.1 };
                    corners.see(&HandSample { point: at, handle: None, touch, time_s });
                }
            }
            if let Some(found) = corners.all() {
                for (i, place) in found.iter().enumerate() {
                    prop_assert!(place.is_finite() && place.length() < 10.0);
                    let others = found[..i].iter();
                    prop_assert!(others.fold(f64::MAX, |d, o| d.min(o.distance(*place))) > APART_M);
                }
            }
        }
    }
}
