//! Viewing conditions of a reflectance: the light, the observer, the wavelengths that are computed.

use crate::colour::{RgbSpace, apply, lab, solve3, srgb_encode};
use crate::gamut::{Gamut, GamutMapping};
use crate::mixture::{Blend, Coat};
use crate::paints::Paint;
use crate::rule::SamplingRule;
use crate::studio::StudioSettings;

/// Distance beyond 0 to 1 at which a channel still counts as inside the gamut: the rounding of white.
const GAMUT_EDGE: f64 = 1e-9;

/// A light, an observer, and the rule by which reflectances become XYZ.
#[derive(Clone, Debug, PartialEq)]
pub struct Viewing {
    rule: SamplingRule,
    white: [f64; 3],
    to_rgb: [[f64; 3]; 3],
}

/// A visible colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// XYZ, Y = 1 for the perfect diffuser.
    pub xyz: [f64; 3],
    /// CIELAB relative to the light's white.
    pub lab: [f64; 3],
    /// Linear sRGB, outside 0 to 1 where a display cannot show it.
    pub linear: [f64; 3],
}

impl Viewing {
    /// Looks as `settings` say at mixtures of `paints`.
    #[must_use]
    pub fn new(settings: &StudioSettings, paints: &[Paint]) -> Self {
        Self {
            rule: settings.rule(paints),
            white: settings.white(),
            to_rgb: settings.to_rgb(),
        }
    }

    /// The rule.
    #[must_use]
    pub fn rule(&self) -> &SamplingRule {
        &self.rule
    }

    /// XYZ of the perfect diffuser.
    #[must_use]
    pub fn white(&self) -> [f64; 3] {
        self.white
    }

    /// The colour of reflectances at the rule's wavelengths, clamped between black and white.
    #[must_use]
    pub fn see(&self, reflectances: &[f64]) -> Seen {
        let xyz = self.rule.xyz(reflectances);
        self.seen(std::array::from_fn(|i| xyz[i].clamp(0.0, self.white[i])))
    }

    /// The colour of a coat of paint.
    #[must_use]
    pub fn coat(&self, blend: &Blend, coat: &Coat) -> Seen {
        let at = |nm: &f64| blend.reflectance_at(*nm, coat);
        self.see(&self.rule.wavelengths_nm.iter().map(at).collect::<Vec<_>>())
    }

    /// The colour that the display shows for a linear sRGB colour, under this light.
    #[must_use]
    pub fn display(&self, linear: [f64; 3]) -> Seen {
        self.seen(solve3(&self.to_rgb, linear))
    }

    fn seen(&self, xyz: [f64; 3]) -> Seen {
        Seen {
            xyz,
            lab: lab(xyz, self.white),
            linear: apply(&self.to_rgb, xyz),
        }
    }
}

impl Seen {
    /// True if an sRGB display can show it.
    #[must_use]
    pub fn in_gamut(&self) -> bool {
        let inside = -GAMUT_EDGE..=1.0 + GAMUT_EDGE;
        self.linear.iter().all(|channel| inside.contains(channel))
    }

    /// Encoded sRGB, 0 to 1; of the same hue where a display cannot show the colour itself.
    #[must_use]
    pub fn srgb(&self) -> [f64; 3] {
        if self.in_gamut() {
            return self.linear.map(srgb_encode);
        }
        let gamut = Gamut::new(GamutMapping::Soft, &RgbSpace::Srgb.from_working());
        gamut
            .map(self.linear.map(|channel| channel as f32))
            .map(|channel| srgb_encode(f64::from(channel)))
    }

    /// As bytes.
    #[must_use]
    pub fn bytes(&self) -> [u8; 3] {
        self.srgb().map(|channel| (channel * 255.0).round() as u8)
    }

    /// CIELAB's chroma.
    #[must_use]
    pub fn chroma(&self) -> f64 {
        let [_, a, b] = self.lab;
        (a * a + b * b).sqrt()
    }

    /// CIELAB's hue angle, degrees, 0 to 360; 0 red, 90 yellow, 180 green, 270 blue.
    #[must_use]
    pub fn hue_deg(&self) -> f64 {
        let [_, a, b] = self.lab;
        maulstick_num::atan2(b, a).to_degrees().rem_euclid(360.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cie::Illuminant;
    use crate::paints::PaintLibrary;
    use crate::studio::RuleKind;

    fn viewing(light: &str, adapted: bool) -> Viewing {
        let settings = StudioSettings {
            light: Illuminant::named(light).expect("known"),
            rule: RuleKind::Reference,
            adapted,
            ..StudioSettings::default()
        };
        Viewing::new(&settings, &[])
    }

    #[test]
    fn white_is_white_to_the_adapted_eye_and_has_the_lights_cast_to_another() {
        for light in crate::cie::ILLUMINANTS {
            let white = viewing(light, true).see(&[1.0; 101]);
            assert!(white.in_gamut(), "{light}: {:?}", white.linear);
            assert!((white.lab[0] - 100.0).abs() < 1e-9 && white.chroma() < 1e-9);
            assert_eq!(white.bytes(), [255; 3]);
        }
        let [r, _, b] = viewing("A", false).see(&[0.5; 101]).linear;
        assert!(r > 2.0 * b, "a bulb is orange: {r} {b}");
    }

    #[test]
    fn a_displays_colour_comes_back() {
        for adapted in [true, false] {
            for light in ["A", "D65", "FL11"] {
                let viewing = viewing(light, adapted);
                let linear = [0.254, 0.102, 0.045];
                let shown = viewing.display(linear);
                for (got, want) in shown.linear.iter().zip(linear) {
                    assert!((got - want).abs() < 1e-12, "{light}");
                }
                assert!(shown.in_gamut());
                assert!(!viewing.display([0.2, 0.3, 1.0 + 1e-8]).in_gamut());
                assert!(!viewing.display([-1e-8, 0.3, 1.0]).in_gamut());
            }
        }
    }

    #[test]
    fn no_rule_sees_more_than_white_or_less_than_black() {
        let mut viewing = viewing("D65", true);
        let weight = &mut viewing.rule.weights[40];
        *weight = weight.map(|weight| -weight);
        let only = |index: usize| -> Vec<f64> {
            (0..101).map(|i| f64::from(u8::from(i == index))).collect()
        };
        assert_eq!(viewing.see(&only(40)).xyz, [0.0; 3]);
        let all_but = only(40).iter().map(|r| 1.0 - r).collect::<Vec<_>>();
        for (got, white) in viewing.see(&all_but).xyz.iter().zip(viewing.white()) {
            assert!(*got <= white);
        }
    }

    #[test]
    fn what_a_display_cannot_show_is_said_and_brought_to_its_edge() {
        let library = PaintLibrary::measured().expect("whole");
        let look = |name: &str| {
            let blend = Blend::new(&[(library.find(name).expect("known"), 1.0)]);
            viewing("D65", true).coat(&blend, &Coat::masstone())
        };
        let (ochre, phthalo) = (look("Yellow Ochre"), look("Cadmium Orange"));
        println!("{ochre:?}\n{phthalo:?}");
        assert!(ochre.in_gamut() && !phthalo.in_gamut());
        assert!(phthalo.srgb().iter().all(|c| (0.0..=1.0).contains(c)));
    }
}
