//! Animation of the palette between two places. Only the picture slides: for the brush the palette lies at its
//! end.

use glam::DVec3;
use maulstick_num::geometry::Rigid;
use maulstick_types::scene::{PALETTE, Surface};

/// Duration of a slide, s.
const SLIDE_S: f64 = 0.15;
/// Shortest move that slides; a shorter one is a drag by hand, m.
const LEAP_M: f64 = 0.03;

/// A slide in progress.
#[derive(Clone, Copy, Debug)]
struct Slide {
    from: DVec3,
    began_s: f64,
}

/// Displayed position of the palette.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct PaletteSlide {
    last: Option<DVec3>,
    slide: Option<Slide>,
}

impl PaletteSlide {
    /// Puts the palette of `surfaces` where it is seen at a time of the window, s; whether it slides.
    pub(crate) fn show(&mut self, now_s: f64, surfaces: &mut [Surface]) -> bool {
        let Some(palette) = surfaces.iter_mut().find(|surface| surface.id == PALETTE) else {
            *self = Self::default();
            return false;
        };
        let to = DVec3::from_array(palette.pose.position_m);
        if let Some(last) = self.last.replace(to)
            && last.distance(to) > LEAP_M
        {
            let from = self.slide.map_or(last, |slide| slide.at(now_s, last));
            self.slide = Some(Slide {
                from,
                began_s: now_s,
            });
        }
        let Some(slide) = self.slide.filter(|slide| slide.share(now_s) < 1.0) else {
            self.slide = None;
            return false;
        };
        palette.pose = Rigid {
            translation: slide.at(now_s, to),
            ..Rigid::from(&palette.pose)
        }
        .to_pose();
        true
    }
}

impl Slide {
    fn share(&self, now_s: f64) -> f64 {
        ((now_s - self.began_s) / SLIDE_S).clamp(0.0, 1.0)
    }

    /// Fast at first, then slower: it comes to rest.
    fn at(&self, now_s: f64, to: DVec3) -> DVec3 {
        let left = 1.0 - self.share(now_s);
        to + (self.from - to) * (left * left * left)
    }
}

#[cfg(test)]
mod tests {
    use maulstick_painting::PaintingSetup;

    use super::*;

    #[test]
    fn it_goes_there_in_its_time_and_a_hand_is_followed_at_once() {
        let mut surfaces = PaintingSetup::default().scene().surfaces;
        let (mut palette_slide, rest) = (PaletteSlide::default(), surfaces[1].pose.position_m[0]);
        let mut at = |now, x: f64| {
            surfaces[1].pose.position_m[0] = x;
            let slides = palette_slide.show(now, &mut surfaces);
            (surfaces[1].pose.position_m[0], slides)
        };
        assert_eq!(at(0.0, rest), (rest, false));
        assert_eq!(at(0.1, rest + 0.02), (rest + 0.02, false));
        let out = rest + 0.2;
        let (begins, slides) = at(0.2, out);
        assert!(slides && (begins - rest - 0.02).abs() < 1e-12);
        let (half, _) = at(0.2 + 0.5 * SLIDE_S, out);
        assert!(half > begins && half < out, "{half}");
        // Called back on its way it turns round there.
        let (turned, _) = at(0.2 + 0.6 * SLIDE_S, rest);
        assert!(
            turned >= half - 0.2 && turned < out && turned > rest,
            "{turned}"
        );
        assert_eq!(at(0.2 + 2.0 * SLIDE_S, rest), (rest, false));
    }
}
