//! Turn of the brush that the mouse moves, over a stroke.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::DVec2;
use maulstick_num::atan2;

use crate::input::mouse_stylus::Pointer;
use crate::settings::grip::Grip;

/// Travel of the pointer after which the direction of a stroke is known, m.
const KNOWN_M: f64 = 1.5e-3;
/// Time for which a stroke waits for its direction, ns: then any way is enough, of which this much tells one, m.
const WAIT_NS: u64 = 80_000_000;
const TELLING_M: f64 = 0.4e-3;
/// Longest time for which it waits, ns: a hand is slow to start, and a dab has no direction.
const LONGEST_NS: u64 = 250_000_000;
/// Length of the string at which the pointer draws the turning point behind it, m.
const STRING_M: f64 = 6e-3;
/// The pointer may be so far beside the way before the brush turns, m: a way drawn in whole pixels has steps.
const SLACK_M: f64 = 0.4e-3;

/// The turn of the brush over a stroke.
#[derive(Debug, Default)]
pub(crate) struct BrushTurn {
    /// Turn of the broad side across the stroke, rad, without the painter's own turn.
    across_rad: f64,
    /// End of the string that the pointer draws, desk, m; `None` between strokes.
    turning_point: Option<DVec2>,
    /// Time at which a stroke began, ns, and its places, while its direction is unknown.
    waiting: Option<(u64, Vec<Pointer>)>,
}

impl BrushTurn {
    /// The places with the turn of the brush there. The first of a stroke wait until its direction is known, so that
    /// the brush is set down across it; meanwhile it hovers where the stroke begins.
    pub(crate) fn turned(&mut self, now_ns: u64, places: &[Pointer], grip: &Grip) -> Vec<Pointer> {
        let mut turned = Vec::new();
        // Fingers or navigation took over: what waits was no stroke.
        if places.is_empty() {
            (self.waiting, self.turning_point) = (None, None);
        }
        for place in places {
            let at = DVec2::new(place.at[0], place.at[1]);
            if !place.pressed {
                self.release(&mut turned, grip);
                self.turning_point = None;
            } else if !grip.follows {
                self.release(&mut turned, grip);
            } else if let Some(point) = self.turning_point {
                self.draw(point, at);
            } else {
                self.turning_point = Some(at);
                self.waiting = Some((now_ns, Vec::new()));
            }
            match &mut self.waiting {
                Some((_, waiting)) => waiting.push(*place),
                None => turned.push(self.with_turn(place, grip)),
            }
        }
        if let Some((since_ns, waiting)) = &self.waiting {
            let ends = waiting.first().zip(waiting.last());
            let way = ends.map_or(DVec2::ZERO, |(first, last)| {
                DVec2::from_array([0, 1].map(|i| last.at[i] - first.at[i]))
            });
            let waits_ns = now_ns.saturating_sub(*since_ns);
            let tells = waits_ns > WAIT_NS && way.length() >= TELLING_M;
            if tells && way.length() < KNOWN_M {
                self.across_rad = atan2(way.y, way.x) + FRAC_PI_2;
            }
            if way.length() >= KNOWN_M || tells || waits_ns > LONGEST_NS {
                self.release(&mut turned, grip);
            } else if let Some(first) = waiting.first() {
                let hovers = Pointer {
                    pressed: false,
                    ..*first
                };
                turned.push(self.with_turn(&hovers, grip));
            }
        }
        turned
    }

    /// True while the start of a stroke waits for its direction.
    #[must_use]
    pub(crate) fn is_waiting(&self) -> bool {
        self.waiting.is_some()
    }

    /// Draws the turning point to a place, and turns the brush across the string.
    fn draw(&mut self, point: DVec2, at: DVec2) {
        let string = at - point;
        let length = string.length();
        if length >= KNOWN_M {
            let across = atan2(string.y, string.x) + FRAC_PI_2;
            // A stroke begins by its direction alone, so that the colours of a double load keep their sides; within it
            // the brush turns the shorter way, and is not flipped where the stroke goes back.
            let period = if self.waiting.is_some() { TAU } else { PI };
            let turns = ((self.across_rad - across) / period).round();
            let off = across + turns * period - self.across_rad;
            let slack = match self.waiting.is_some() {
                true => 0.0,
                false => SLACK_M / length,
            };
            self.across_rad += off.signum() * (off.abs() - slack).max(0.0);
        }
        self.turning_point = Some(at - string * (STRING_M / length.max(STRING_M)));
    }

    fn with_turn(&self, place: &Pointer, grip: &Grip) -> Pointer {
        let across = if grip.follows { self.across_rad } else { 0.0 };
        Pointer {
            twist_rad: across + grip.turn_deg.to_radians(),
            ..*place
        }
    }

    fn release(&mut self, into: &mut Vec<Pointer>, grip: &Grip) {
        if let Some((_, waiting)) = self.waiting.take() {
            into.extend(waiting.iter().map(|place| self.with_turn(place, grip)));
        }
    }
}

#[cfg(test)]
mod tests {
    use maulstick_num::sin_cos;

    use super::*;

    const FOLLOWS: Grip = Grip {
        follows: true,
        turn_deg: 0.0,
        pressure: 0.5,
    };
    const FRAME_NS: u64 = 16_000_000;

    fn at(x: f64, y: f64, pressed: bool) -> Pointer {
        Pointer {
            at: [x, y, 0.0],
            pressed,
            twist_rad: 0.0,
        }
    }

    /// Places of a stroke that begins at the origin, a frame each.
    fn stroke(grip: &Grip, to: impl Fn(f64) -> [f64; 2]) -> Vec<Pointer> {
        let mut turn = BrushTurn::default();
        let mut all = turn.turned(0, &[at(0.0, 0.0, false)], grip);
        for frame in 0..40_u32 {
            let [x, y] = to(f64::from(frame) * 1e-3);
            all.extend(turn.turned(FRAME_NS * u64::from(frame + 1), &[at(x, y, true)], grip));
        }
        let [x, y] = to(0.04);
        all.extend(turn.turned(FRAME_NS * 41, &[at(x, y, false)], grip));
        all
    }

    fn pressed(all: &[Pointer]) -> Vec<&Pointer> {
        all.iter().filter(|place| place.pressed).collect()
    }

    /// Angle between the broad side and a direction, 0 to π/2.
    fn between(twist_rad: f64, along_rad: f64) -> f64 {
        let off = (twist_rad - along_rad).rem_euclid(PI);
        off.min(PI - off)
    }

    #[test]
    fn a_brush_is_set_down_and_stays_across_its_stroke() {
        for degrees in [0.0_f64, 37.0, 90.0, 180.0, -120.0] {
            let along = degrees.to_radians();
            let (sine, cosine) = sin_cos(along);
            let all = stroke(&FOLLOWS, |way| [way * cosine, way * sine]);
            let places = pressed(&all);
            assert_eq!(places.len(), 40, "no place is lost");
            for place in places {
                let off = between(place.twist_rad, along + FRAC_PI_2);
                assert!(off < 1e-9, "{degrees}°: off by {off}");
            }
        }
    }

    #[test]
    fn a_hand_that_is_slow_to_start_sets_it_down_across_too() {
        // 6 mm/s.
        let all = stroke(&FOLLOWS, |way| [0.0, 0.1 * way]);
        let places = pressed(&all);
        assert_eq!(places.len(), 40, "no place is lost");
        for place in places {
            assert!(between(place.twist_rad, 0.0) < 1e-9, "{}", place.twist_rad);
        }
    }

    #[test]
    fn a_way_in_whole_pixels_turns_it_as_little_as_the_way_itself() {
        // A pixel in ten to the side.
        let pixel = 0.38e-3;
        let steps = stroke(&FOLLOWS, |s| [s, pixel * (s / (10.0 * pixel)).floor()]);
        let turns: Vec<f64> = steps
            .iter()
            .filter(|place| place.pressed)
            .map(|place| place.twist_rad)
            .collect();
        let all = turns
            .windows(2)
            .map(|two| (two[1] - two[0]).abs())
            .sum::<f64>();
        assert!(all < 0.2, "{all}: {turns:?}");
    }

    #[test]
    fn in_a_curve_it_turns_evenly_and_by_the_shorter_way() {
        let radius = 0.01;
        let all = stroke(&FOLLOWS, |way| {
            let (sine, cosine) = sin_cos(way / radius);
            [radius * sine, radius * (1.0 - cosine)]
        });
        let places = pressed(&all);
        for pair in places.windows(2) {
            let turned = (pair[1].twist_rad - pair[0].twist_rad).abs();
            assert!(turned < 0.2, "{turned}");
        }
        let whole = places[39].twist_rad - places[0].twist_rad;
        assert!((3.0..4.0).contains(&whole), "{whole} of 3.9 rad");
    }

    #[test]
    fn a_dab_is_painted_with_the_turn_it_had() {
        let mut turn = BrushTurn::default();
        let first = turn.turned(0, &[at(0.0, 0.0, true)], &FOLLOWS);
        assert_eq!(first, [at(0.0, 0.0, false)], "it hovers meanwhile");
        assert!(turn.is_waiting());
        let later = turn.turned(LONGEST_NS + 1, &[at(0.0, 0.0, true)], &FOLLOWS);
        assert_eq!(later, [at(0.0, 0.0, true); 2]);
        let click = [at(0.0, 0.0, true), at(0.0, 0.0, false)];
        let mut turn = BrushTurn::default();
        assert_eq!(turn.turned(0, &click, &FOLLOWS), click);
    }

    #[test]
    fn without_following_the_painter_sets_the_turn() {
        let grip = Grip {
            follows: false,
            turn_deg: 30.0,
            ..FOLLOWS
        };
        let all = stroke(&grip, |way| [0.0, way]);
        assert_eq!(pressed(&all).len(), 40);
        assert!(
            all.iter()
                .all(|place| place.twist_rad == 30_f64.to_radians())
        );
    }
}
