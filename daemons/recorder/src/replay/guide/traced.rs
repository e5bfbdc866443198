//! The strokes of a recording and how far a hand has traced them. It knows no clock and no rig.

use glam::DVec3;
use maulstick_types::haptics::GuideModel;

/// Distance of two points of a stroke, m.
const SPACING_M: f64 = 2e-3;
/// Points of a guide before the place where the hand is.
const BEHIND: usize = 5;
/// A stroke counts as traced from this share of it on.
const TRACED: f64 = 0.8;
/// Of strokes whose beginnings are as near as this, m, the earliest comes first.
const AS_NEAR_M: f64 = 5e-3;

/// Contact of the brush with the canvas.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Touch {
    /// It paints.
    Canvas,
    /// It is lifted.
    Air,
}

/// A recorded stroke: its points along the canvas, m, and when the brush was there, ns since the beginning.
#[derive(Clone, Debug, Default, PartialEq)]
struct Stroke {
    points: Vec<DVec3>,
    times_ns: Vec<u64>,
}

impl Stroke {
    fn is_line(&self) -> bool {
        self.points.len() >= 2
    }

    fn distance(&self, place: usize, tip: DVec3) -> f64 {
        (self.points[place] - tip).truncate().length()
    }

    /// Goes along the stroke as long as it comes nearer to the tip.
    fn follow(&self, mut place: usize, tip: DVec3) -> usize {
        loop {
            let here = self.distance(place, tip);
            let ahead = (place + 1 < self.points.len()).then(|| place + 1);
            let nearer = |other: &usize| self.distance(*other, tip) < here;
            let next = ahead
                .filter(nearer)
                .or_else(|| place.checked_sub(1).filter(nearer));
            match next {
                Some(next) => place = next,
                None => return place,
            }
        }
    }
}

/// Strokes, and how far a hand has traced them.
#[derive(Clone, Debug)]
pub(super) struct Traced {
    strokes: Vec<Stroke>,
    is_traced: Vec<bool>,
    current: Option<usize>,
    /// Where the hand is along the current stroke, and how far it came.
    place: usize,
    farthest: usize,
    touch: Touch,
}

impl Traced {
    /// Of samples in order of time: when, the tip, and whether it paints. A stroke is at least as long as two points are
    /// apart.
    pub(super) fn of(samples: impl IntoIterator<Item = (u64, DVec3, Touch)>) -> Self {
        let (mut strokes, mut newest) = (Vec::new(), Stroke::default());
        for (at_ns, tip, touch) in samples {
            if touch == Touch::Air {
                strokes.push(std::mem::take(&mut newest));
                continue;
            }
            let last = newest.points.last();
            if last.is_none_or(|last: &DVec3| (tip - *last).truncate().length() >= SPACING_M) {
                newest.points.push(tip);
                newest.times_ns.push(at_ns);
            }
        }
        strokes.push(newest);
        strokes.retain(Stroke::is_line);
        Self {
            is_traced: vec![false; strokes.len()],
            strokes,
            current: None,
            place: 0,
            farthest: 0,
            touch: Touch::Air,
        }
    }

    /// Number of strokes, and of those that are traced.
    pub(super) fn counts(&self) -> [usize; 2] {
        let traced = self.is_traced.iter().filter(|traced| **traced);
        [self.strokes.len(), traced.count()]
    }

    /// Counts the strokes before a time as traced, and no others.
    pub(super) fn seek(&mut self, at_ns: u64) {
        for (stroke, traced) in self.strokes.iter().zip(&mut self.is_traced) {
            *traced = stroke.times_ns.last().is_some_and(|end| *end < at_ns);
        }
        self.current = None;
    }

    /// When the recorded hand was where the hand is now, ns.
    pub(super) fn position_ns(&self) -> Option<u64> {
        let stroke = &self.strokes[self.current?];
        stroke.times_ns.get(self.place).copied()
    }

    /// Follows the hand.
    pub(super) fn follow(&mut self, tip: DVec3, touch: Touch) {
        let before = std::mem::replace(&mut self.touch, touch);
        if touch == Touch::Air {
            if before == Touch::Canvas {
                self.lift();
            }
            self.choose(tip);
        } else if before == Touch::Air {
            self.farthest = 0;
        }
        let Some(current) = self.current else {
            return;
        };
        self.place = self.strokes[current].follow(self.place, tip);
        if touch == Touch::Canvas {
            self.farthest = self.farthest.max(self.place);
        }
    }

    /// The brush is lifted: the stroke is traced, if it was followed to about its end.
    fn lift(&mut self) {
        if let Some(current) = self.current {
            let last = self.strokes[current].points.len() - 1;
            self.is_traced[current] |= self.farthest as f64 >= TRACED * last as f64;
        }
        self.farthest = 0;
    }

    /// Chooses the stroke that begins nearest, of those that are left.
    fn choose(&mut self, tip: DVec3) {
        let left = self.strokes.iter().zip(&self.is_traced).enumerate();
        let left = left.filter(|(_, (_, traced))| !**traced);
        let begins: Vec<(usize, f64)> = left
            .map(|(number, (stroke, _))| (number, stroke.distance(0, tip)))
            .collect();
        let nearest = begins.iter().map(|(_, m)| *m).fold(f64::MAX, f64::min);
        let chosen = begins.iter().find(|(_, m)| *m <= nearest + AS_NEAR_M);
        let chosen = chosen.map(|(number, _)| *number);
        if chosen != self.current {
            (self.current, self.place) = (chosen, 0);
        }
    }

    /// The piece of path about the hand, m; `None` once all is traced.
    pub(super) fn piece(&self) -> Option<Vec<[f64; 3]>> {
        let points = &self.strokes[self.current?].points;
        let most = points.len().min(GuideModel::POINTS_MOST);
        let from = self.place.saturating_sub(BEHIND).min(points.len() - most);
        let piece = &points[from..from + most];
        Some(piece.iter().map(DVec3::to_array).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two strokes of 10 cm along x, one above the other, with a lift between them.
    fn two() -> Traced {
        let stroke = |number: u64| {
            (0..=1000u64).map(move |i| {
                let tip = DVec3::new(1e-4 * i as f64, 0.03 * number as f64, -1e-3);
                let touch = if i == 1000 { Touch::Air } else { Touch::Canvas };
                ((number * 2000 + i) * 1_000_000, tip, touch)
            })
        };
        Traced::of(stroke(0).chain(stroke(1)))
    }

    fn trace(traced: &mut Traced, y: f64, from: f64, to: f64) {
        for i in 0..=100 {
            let x = from + (to - from) * f64::from(i) / 100.0;
            traced.follow(DVec3::new(x, y, -1e-3), Touch::Canvas);
        }
    }

    #[test]
    fn strokes_are_cut_where_the_brush_is_lifted_and_a_dab_is_none() {
        let traced = two();
        assert_eq!(traced.counts(), [2, 0]);
        // 2 mm, or a sample more.
        assert!((47..=50).contains(&traced.strokes[0].points.len()));
        let dab = (0..50).map(|i| (i, DVec3::X * 1e-5 * i as f64, Touch::Canvas));
        assert_eq!(Traced::of(dab).counts(), [0, 0]);
    }

    #[test]
    fn the_guide_goes_on_with_the_hand_and_at_the_end_to_the_next_stroke_when_the_brush_lifts() {
        let mut traced = two();
        traced.follow(DVec3::new(-0.02, 0.01, 0.01), Touch::Air);
        let piece = traced.piece().expect("a piece");
        assert_eq!((piece.len(), piece[0]), (16, [0.0, 0.0, -1e-3]));
        trace(&mut traced, 0.002, 0.0, 0.05);
        let piece = traced.piece().expect("a piece");
        assert!((piece[5][0] - 0.05).abs() < 1.1e-3, "{piece:?}");
        let s = traced.position_ns().expect("a stroke") as f64 * 1e-9;
        assert!((s - 0.5).abs() < 0.0111, "{s} s");
        // Lifted in the middle it is still to be traced.
        traced.follow(DVec3::new(0.05, 0.0, 0.01), Touch::Air);
        assert_eq!(traced.counts(), [2, 0]);
        trace(&mut traced, 0.0, 0.05, 0.1);
        assert_eq!(traced.counts(), [2, 0], "not before it lifts");
        traced.follow(DVec3::new(0.1, 0.0, 0.01), Touch::Air);
        assert_eq!(traced.counts(), [2, 1]);
        assert!((traced.piece().expect("a piece")[0][1] - 0.03).abs() < 1e-12);
        trace(&mut traced, 0.03, 0.0, 0.1);
        traced.follow(DVec3::new(0.1, 0.03, 0.01), Touch::Air);
        assert_eq!((traced.counts(), traced.piece()), ([2, 2], None));
        traced.seek(1_500_000_000);
        assert_eq!(traced.counts(), [2, 1]);
        traced.follow(DVec3::ZERO, Touch::Air);
        assert!(traced.piece().is_some());
    }

    #[test]
    fn while_it_paints_no_other_stroke_is_chosen_however_near() {
        let mut traced = two();
        traced.follow(DVec3::new(0.0, 0.0, 0.01), Touch::Air);
        trace(&mut traced, 0.03, 0.0, 0.04);
        assert_eq!(traced.piece().expect("a piece")[0][1], 0.0);
        // In the air it is.
        traced.follow(DVec3::new(0.0, 0.03, 0.01), Touch::Air);
        assert!((traced.piece().expect("a piece")[0][1] - 0.03).abs() < 1e-12);
    }

    #[test]
    fn a_hand_at_rest_stays_where_it_is() {
        let mut traced = two();
        traced.follow(DVec3::new(0.03, 0.002, 0.01), Touch::Air);
        let before = traced.piece();
        for _ in 0..1000 {
            traced.follow(DVec3::new(0.03, 0.002, 0.01), Touch::Air);
        }
        assert_eq!(traced.piece(), before);
    }
}
