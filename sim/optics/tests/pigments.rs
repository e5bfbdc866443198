//! Common knowledge of painters about some paints, which mixing light would contradict. Beside each mixture stands the
//! linear RGB blend of the same masstones, which must fail.

use maulstick_optics::{Blend, Coat, Paint, PaintLibrary, RuleKind, Seen, StudioSettings, Viewing};

type Parts<'a> = &'a [(&'a str, f64)];
/// Conversion of paints to a colour.
type Mixing<'a> = &'a dyn Fn(Parts<'_>) -> Seen;

struct Paints {
    library: PaintLibrary,
    viewing: Viewing,
}

impl Paints {
    fn new() -> Self {
        let settings = StudioSettings {
            rule: RuleKind::Reference,
            ..StudioSettings::default()
        };
        Self {
            library: PaintLibrary::measured().expect("whole"),
            viewing: Viewing::new(&settings, &[]),
        }
    }

    /// As pigments: K and S add.
    fn mixed(&self, parts: Parts<'_>) -> Seen {
        let find = |(name, share): &(&str, f64)| (self.library.find(name).expect("known"), *share);
        let parts: Vec<(&Paint, f64)> = parts.iter().map(find).collect();
        let seen = self.viewing.coat(&Blend::new(&parts), &Coat::masstone());
        show("pigments", &seen);
        seen
    }

    /// As lights: linear RGB adds.
    fn as_lights(&self, parts: Parts<'_>) -> Seen {
        let mut sum = [0.0; 3];
        for (name, share) in parts {
            let pure = [(self.library.find(name).expect("known"), 1.0)];
            let masstone = self.viewing.coat(&Blend::new(&pure), &Coat::masstone());
            for (sum, channel) in sum.iter_mut().zip(masstone.linear) {
                *sum += share * channel;
            }
        }
        let seen = self.viewing.display(sum);
        show("lights  ", &seen);
        seen
    }
}

fn show(how: &str, seen: &Seen) {
    let (l, c, h) = (seen.lab[0], seen.chroma(), seen.hue_deg());
    println!("{how}: L* {l:5.1}, C* {c:5.1}, hue {h:5.1}°");
}

/// A property that pigments have and lights lack.
fn of_pigments_alone(holds: impl Fn(Mixing<'_>) -> bool) {
    let paints = Paints::new();
    assert!(holds(&|parts| paints.mixed(parts)));
    assert!(
        !holds(&|parts| paints.as_lights(parts)),
        "a fault would pass"
    );
}

#[test]
fn yellow_ochre_with_bone_black_turns_green() {
    of_pigments_alone(|mix| {
        let ochre = mix(&[("Yellow Ochre", 1.0)]).hue_deg();
        let olive = mix(&[("Yellow Ochre", 0.7), ("Bone Black", 0.3)]);
        println!("turned by {:.1}°", olive.hue_deg() - ochre);
        // The hue angle rises from yellow (90°) toward green (180°).
        olive.hue_deg() - ochre >= 10.0 && olive.chroma() > 15.0
    });
}

#[test]
fn phthalo_blue_is_violet_black_and_its_tint_cyan() {
    of_pigments_alone(|mix| {
        let masstone = mix(&[("Phthalo Blue Green Shade", 1.0)]);
        let tint = mix(&[("Phthalo Blue Green Shade", 0.02), ("Titanium White", 0.98)]);
        let violet_black = masstone.lab[0] < 30.0 && (280.0..330.0).contains(&masstone.hue_deg());
        let cyan = (215.0..250.0).contains(&tint.hue_deg()) && tint.chroma() > 20.0;
        violet_black && cyan && tint.lab[0] > 70.0
    });
}

#[test]
fn quinacridone_magenta_gains_chroma_with_a_little_white_and_loses_it_with_much() {
    of_pigments_alone(|mix| {
        let chroma = [0.0, 0.1, 0.2, 0.95].map(|white| {
            mix(&[
                ("Quinacridone Magenta", 1.0 - white),
                ("Titanium White", white),
            ])
            .chroma()
        });
        let [pure, little, more, much] = chroma;
        little > pure + 5.0 && more > little && much < pure - 5.0
    });
}

/// The least chroma that two paints with a share of white have at any ratio of theirs.
fn greyest(mix: Mixing<'_>, two: [&str; 2], white: f64) -> f64 {
    let at = |percent: u32| {
        let share = (1.0 - white) * 0.01 * f64::from(percent);
        let parts = [
            (two[0], share),
            (two[1], 1.0 - white - share),
            ("Titanium White", white),
        ];
        mix(&parts).chroma()
    };
    let least = (20..=80).step_by(10).map(at).fold(f64::INFINITY, f64::min);
    println!("{two:?} with {white} white: least chroma {least:.1}");
    least
}

#[test]
fn burnt_sienna_and_ultramarine_with_white_are_nearly_neutral() {
    let earth = ["Burnt Sienna", "Ultramarine Blue"];
    of_pigments_alone(|mix| {
        [0.05, 0.1, 0.3, 0.6]
            .iter()
            .all(|white| greyest(mix, earth, *white) < 5.0)
    });
    // A blue that is not its complement gives no grey.
    let paints = Paints::new();
    let mix = |parts: Parts<'_>| paints.mixed(parts);
    let other = ["Burnt Sienna", "Dioxazine Purple"];
    assert!(greyest(&mix, other, 0.3) > 5.0);
}
