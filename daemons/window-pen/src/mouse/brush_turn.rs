//! Turn of the brush that the mouse moves, over a stroke.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::DVec2;
use maulstick_num::{atan2, sin_cos};

use super::Pointer;
use super::grip::Grip;
use super::pixel_path::PixelPath;

/// Travel of the pointer after which the direction of a stroke is known, m, and in pixels: a shorter path in whole
/// pixels hardly has one.
const KNOWN_M: f64 = 2.5e-3;
const KNOWN_PIXELS: f64 = 8.0;
/// Time for which a stroke waits for its direction, ns; after it a path of this length suffices, m and in pixels.
const WAIT_NS: u64 = 80_000_000;
const TELLING_M: f64 = 0.8e-3;
const TELLING_PIXELS: f64 = 3.0;
/// Longest wait of a stroke for its direction, ns: a hand is slow to start, and a dab has none.
const LONGEST_NS: u64 = 250_000_000;
/// Length of the string at which the pointer draws the turning point behind it, m and in pixels.
const STRING_M: f64 = 6e-3;
const STRING_PIXELS: f64 = 16.0;
/// Distance of the pointer from its line before the brush turns, m and in pixels: a path in whole pixels has steps.
const SLACK_M: f64 = 0.4e-3;
const SLACK_PIXELS: f64 = 1.2;

/// The turn of the brush over a stroke.
#[derive(Debug, Default)]
pub struct BrushTurn {
    /// Turn of the broad side across the stroke, rad, without the painter's own turn.
    across_rad: f64,
    /// End of the string that the pointer draws, desk, m; `None` between strokes.
    turning_point: Option<DVec2>,
    /// Start of a stroke, ns, and its places, while its direction is unknown.
    waiting: Option<(u64, Vec<Pointer>)>,
    path: PixelPath,
}

impl BrushTurn {
    /// The places with the turn of the brush there, of a pointer that goes in pixels of `pixel_m`. The first of a stroke
    /// wait until its direction is known, so that the brush is set down across it; meanwhile it hovers where the stroke
    /// begins.
    pub fn turned(
        &mut self,
        now_ns: u64,
        places: &[Pointer],
        grip: &Grip,
        pixel_m: f64,
    ) -> Vec<Pointer> {
        let mut turned = Vec::new();
        // Fingers or navigation took over: the waiting places were no stroke.
        if places.is_empty() {
            (self.waiting, self.turning_point) = (None, None);
            self.path = PixelPath::default();
        }
        for place in places {
            let at = point(place);
            if !place.pressed {
                self.release(&mut turned, grip, pixel_m);
                self.turning_point = None;
                self.path = PixelPath::default();
            } else if !grip.follows {
                self.release(&mut turned, grip, pixel_m);
            } else if let Some(point) = self.turning_point {
                self.draw(point, at, pixel_m);
            } else {
                self.turning_point = Some(at);
                self.waiting = Some((now_ns, Vec::new()));
            }
            match &mut self.waiting {
                Some((_, waiting)) => waiting.push(*place),
                None => turned.push(self.with_turn(place, grip, pixel_m)),
            }
        }
        if let Some((since_ns, waiting)) = &self.waiting {
            let ends = waiting.first().zip(waiting.last());
            let way = ends.map_or(DVec2::ZERO, |(first, last)| point(last) - point(first));
            let waits_ns = now_ns.saturating_sub(*since_ns);
            let is_known = way.length() >= KNOWN_M.max(KNOWN_PIXELS * pixel_m);
            let telling_m = TELLING_M.max(TELLING_PIXELS * pixel_m);
            let tells = waits_ns > WAIT_NS && way.length() >= telling_m;
            if is_known || tells || waits_ns > LONGEST_NS {
                self.release(&mut turned, grip, pixel_m);
            } else if let Some(first) = waiting.first() {
                let hovers = Pointer {
                    pressed: false,
                    ..*first
                };
                turned.push(self.with_turn(&hovers, grip, pixel_m));
            }
        }
        turned
    }

    /// True while the start of a stroke waits for its direction.
    #[must_use]
    pub fn is_waiting(&self) -> bool {
        self.waiting.is_some()
    }

    /// Draws the turning point to a place, and turns the brush across the string.
    fn draw(&mut self, turning_point: DVec2, at: DVec2, pixel_m: f64) {
        let string = at - turning_point;
        let length = string.length();
        if self.waiting.is_none() && length >= KNOWN_M.max(KNOWN_PIXELS * pixel_m) {
            let across = atan2(string.y, string.x) + FRAC_PI_2;
            // Within a stroke the brush turns the shorter way, and is not flipped by a reversal.
            let off = self.off(across, PI);
            let slack = SLACK_M.max(SLACK_PIXELS * pixel_m) / length;
            self.across_rad += off.signum() * (off.abs() - slack).max(0.0);
        }
        let longest = STRING_M.max(STRING_PIXELS * pixel_m);
        self.turning_point = Some(at - string * (longest / length.max(longest)));
    }

    /// Rotation from the present one to `across` or, if nearer, whole periods beside it, rad.
    fn off(&self, across: f64, period: f64) -> f64 {
        let turns = ((self.across_rad - across) / period).round();
        across + turns * period - self.across_rad
    }

    fn with_turn(&mut self, place: &Pointer, grip: &Grip, pixel_m: f64) -> Pointer {
        let across = if grip.follows { self.across_rad } else { 0.0 };
        let at = if place.pressed {
            self.path.smooth(point(place), pixel_m)
        } else {
            point(place)
        };
        Pointer {
            at: [at.x, at.y, place.at[2]],
            twist_rad: across + grip.turn_deg.to_radians(),
            ..*place
        }
    }

    /// Sets the brush down across the path of the waiting places.
    fn release(&mut self, into: &mut Vec<Pointer>, grip: &Grip, pixel_m: f64) {
        let Some((_, waiting)) = self.waiting.take() else {
            return;
        };
        if let Some(along) = direction(&waiting, TELLING_M.max(TELLING_PIXELS * pixel_m)) {
            // A stroke begins by its direction alone, so that the colours of a double load keep their sides.
            self.across_rad += self.off(along + FRAC_PI_2, TAU);
            let (sine, cosine) = sin_cos(along);
            self.path.begin(DVec2::new(cosine, sine));
        }
        for place in &waiting {
            into.push(self.with_turn(place, grip, pixel_m));
        }
    }
}

fn point(place: &Pointer) -> DVec2 {
    DVec2::new(place.at[0], place.at[1])
}

/// Direction of places, rad: that of the line nearest to them all, from the first to the last; `None` where these are
/// less than `least_m` apart.
fn direction(places: &[Pointer], least_m: f64) -> Option<f64> {
    let way = point(places.last()?) - point(places.first()?);
    if way.length() < least_m {
        return None;
    }
    let mean = places.iter().map(point).sum::<DVec2>() / places.len() as f64;
    let [mut xx, mut xy, mut yy] = [0.0; 3];
    for place in places {
        let off = point(place) - mean;
        (xx, xy, yy) = (xx + off.x * off.x, xy + off.x * off.y, yy + off.y * off.y);
    }
    let along = 0.5 * atan2(2.0 * xy, xx - yy);
    let (sine, cosine) = sin_cos(along);
    if DVec2::new(cosine, sine).dot(way) < 0.0 {
        Some(along + PI)
    } else {
        Some(along)
    }
}

#[cfg(test)]
mod tests {
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
        let mut all = turn.turned(0, &[at(0.0, 0.0, false)], grip, 0.0);
        for frame in 0..40_u32 {
            let [x, y] = to(f64::from(frame) * 1e-3);
            all.extend(turn.turned(
                FRAME_NS * u64::from(frame + 1),
                &[at(x, y, true)],
                grip,
                0.0,
            ));
        }
        let [x, y] = to(0.04);
        all.extend(turn.turned(FRAME_NS * 41, &[at(x, y, false)], grip, 0.0));
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

    /// The pointer of a hand that moves straight, on a display with large or small pixels, fast or slowly: the brush is
    /// set down across the stroke and stays so, and its path does not leave the hand's.
    #[test]
    fn a_straight_stroke_in_whole_pixels_is_straight_from_its_beginning() {
        let (mut slanted, mut turns, mut steps, mut aside) = (0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64);
        for pixel_m in [0.2e-3, 0.4e-3, 0.8e-3] {
            for speed_m_s in [0.03, 0.1, 0.4] {
                for degree in (0..360).step_by(7) {
                    let along = f64::from(degree).to_radians();
                    let (sine, cosine) = sin_cos(along);
                    let whole = |m: f64| (m / pixel_m).round() * pixel_m;
                    let mut turn = BrushTurn::default();
                    let mut all = Vec::new();
                    // A mouse of 125 Hz in frames of two.
                    for frame in 0..400_u32 {
                        let place = |number: u32| {
                            let way = speed_m_s * 8e-3 * f64::from(2 * frame + number);
                            at(whole(way * cosine), whole(way * sine), true)
                        };
                        let now_ns = FRAME_NS * u64::from(frame + 1);
                        let places = [place(0), place(1)];
                        all.extend(turn.turned(now_ns, &places, &FOLLOWS, pixel_m));
                        if speed_m_s * 16e-3 * f64::from(frame) > 0.06 {
                            break;
                        }
                    }
                    let places = pressed(&all);
                    let off = |place: &&&Pointer| between(place.twist_rad, along + FRAC_PI_2);
                    slanted = slanted.max(places.first().map_or(0.0, |first| off(&first)));
                    turns = turns.max(places.iter().map(|place| off(&place)).fold(0.0, f64::max));
                    let beside = |place: &Pointer| {
                        (place.at[1] * cosine - place.at[0] * sine).abs() / pixel_m
                    };
                    aside = aside.max(places.iter().map(|place| beside(place)).fold(0.0, f64::max));
                    let late = places
                        .iter()
                        .filter(|place| place.at[0] * cosine + place.at[1] * sine > 0.02);
                    steps = steps.max(late.map(|place| beside(place)).fold(0.0, f64::max));
                }
            }
        }
        println!(
            "slanted {slanted:.3}, turned {turns:.3} rad; {aside:.2}, later {steps:.2} pixels beside"
        );
        assert!(slanted < 0.15 && turns < 0.15, "{slanted} {turns} rad");
        assert!(aside < 0.75 && steps < 0.75, "{aside} {steps} pixels");
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
        let first = turn.turned(0, &[at(0.0, 0.0, true)], &FOLLOWS, 0.0);
        assert_eq!(first, [at(0.0, 0.0, false)], "it hovers meanwhile");
        assert!(turn.is_waiting());
        let later = turn.turned(LONGEST_NS + 1, &[at(0.0, 0.0, true)], &FOLLOWS, 0.0);
        assert_eq!(later, [at(0.0, 0.0, true); 2]);
        let click = [at(0.0, 0.0, true), at(0.0, 0.0, false)];
        let mut turn = BrushTurn::default();
        assert_eq!(turn.turned(0, &click, &FOLLOWS, 0.0), click);
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
