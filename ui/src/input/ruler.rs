//! Straight strokes: one that begins while Shift is held follows a ruler, from its first place in its initial
//! direction.

use eframe::egui::{Pos2, Vec2};

/// Distance after which the direction is known, points: that of a shorter one is mostly the shaking of the hand.
const KNOWN: f32 = 20.0;

/// The ruler under a stroke.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Ruler {
    from: Option<Pos2>,
    /// Unit vector, once the direction is known.
    along: Option<Vec2>,
}

impl Ruler {
    /// Places it at the first place of a stroke.
    pub(crate) fn lay(&mut self, from: Pos2) {
        *self = Self {
            from: Some(from),
            along: None,
        };
    }

    /// Takes it away.
    pub(crate) fn lift(&mut self) {
        *self = Self::default();
    }

    /// The nearest place on its edge; without a ruler the place itself. Until the direction is known that is the first
    /// place.
    pub(crate) fn nearest(&mut self, at: Pos2) -> Pos2 {
        let Some(from) = self.from else {
            return at;
        };
        let way = at - from;
        if self.along.is_none() && way.length() >= KNOWN {
            self.along = Some(way.normalized());
        }
        match self.along {
            Some(along) => from + along * way.dot(along),
            None => from,
        }
    }
}

#[cfg(test)]
mod tests {
    use eframe::egui::pos2;

    use super::*;

    #[test]
    fn a_shaking_hand_draws_a_straight_line_in_the_direction_it_sets_out() {
        let mut ruler = Ruler::default();
        let shaken = |i: u8| pos2(10.0 + f32::from(i), 20.0 + f32::from(i % 3));
        assert_eq!(ruler.nearest(shaken(2)), shaken(2), "no ruler lies");
        ruler.lay(shaken(0));
        let places: Vec<Pos2> = (0..90).map(|i| ruler.nearest(shaken(i))).collect();
        assert_eq!(places[..20], [shaken(0); 20], "its direction is not known");
        let along = (places[89] - places[0]).normalized();
        for place in &places {
            let off = (*place - places[0]).rot90().dot(along);
            assert!(off.abs() < 1e-3, "{place} is {off} beside the line");
        }
        assert!(places[89].x - places[0].x > 85.0, "it follows the hand");
        assert!(
            (shaken(50) - places[50]).length() > 0.3,
            "a fault would pass"
        );
        ruler.lift();
        assert_eq!(ruler.nearest(shaken(7)), shaken(7));
    }
}
