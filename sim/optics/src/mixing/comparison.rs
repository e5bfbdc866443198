//! One graded mixture by four ways of mixing (Baxter 2004, fig. 7.9).

use crate::colour::delta_e_2000;
use crate::mixture::{Blend, Coat};
use crate::viewing::{Seen, Viewing};

/// Wavelengths for red, green and blue where K-M is computed at three, nm: those whose colour is nearest to sRGB's
/// primaries (dominant wavelengths, IEC 61966-2-1).
pub const THREE_NM: [f64; 3] = [612.0, 549.0, 465.0];

/// Method of mixing paints.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// K-M at all 101 samples.
    Reference,
    /// K-M at the wavelengths of a rule.
    Rule,
    /// K-M at [`THREE_NM`], whose reflectances are taken for red, green and blue.
    Three,
    /// Linear RGB of the masstones, blended.
    LinearRgb,
}

/// A graded mixture by one method.
#[derive(Clone, Debug, PartialEq)]
pub struct Grading {
    /// The way.
    pub way: Way,
    /// The colours, as many as shares.
    pub seen: Vec<Seen>,
    /// Their distance from the reference, ΔE₀₀.
    pub delta_e: Vec<f64>,
}

/// Opaque mixtures of `from` and `to` by four ways; `shares` are those of `to`. `reference` looks
/// with 101 samples, `viewing` with the rule in question, both under one light.
#[must_use]
pub fn compare(
    [from, to]: [&Blend; 2],
    shares: &[f64],
    reference: &Viewing,
    viewing: &Viewing,
) -> [Grading; 4] {
    let coat = Coat::masstone();
    let ends = [from, to].map(|end| reference.coat(end, &coat).linear);
    let look = |way: Way, share: f64| match way {
        Way::Reference => reference.coat(&from.toward(to, share), &coat),
        Way::Rule => viewing.coat(&from.toward(to, share), &coat),
        Way::Three => {
            let mixed = from.toward(to, share);
            reference.display(THREE_NM.map(|nm| mixed.reflectance_at(nm, &coat)))
        }
        Way::LinearRgb => {
            let blend = |i: usize| ends[0][i] + share * (ends[1][i] - ends[0][i]);
            reference.display([0, 1, 2].map(blend))
        }
    };
    let exact: Vec<Seen> = shares.iter().map(|s| look(Way::Reference, *s)).collect();
    [Way::Reference, Way::Rule, Way::Three, Way::LinearRgb].map(|way| {
        let seen: Vec<Seen> = shares.iter().map(|share| look(way, *share)).collect();
        let pairs = seen.iter().zip(&exact);
        let delta_e = pairs.map(|(a, b)| delta_e_2000(a.lab, b.lab)).collect();
        Grading { way, seen, delta_e }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paints::PaintLibrary;
    use crate::studio::{RuleKind, StudioSettings};

    #[test]
    fn pigments_make_green_where_lights_do_not() {
        let library = PaintLibrary::measured().expect("whole");
        let pure = |name: &str| Blend::new(&[(library.find(name).expect("known"), 1.0)]);
        let (ochre, blue) = (pure("Yellow Ochre"), pure("Phthalo Blue Green Shade"));
        let looking = |rule| {
            let settings = StudioSettings {
                rule,
                ..StudioSettings::default()
            };
            Viewing::new(&settings, &[])
        };
        let (exact, gauss) = (looking(RuleKind::Reference), looking(RuleKind::Gauss));
        let shares = [0.0, 0.02, 0.06, 0.2, 1.0];
        let rows = compare([&ochre, &blue], &shares, &exact, &gauss);
        for row in &rows {
            let hues: Vec<_> = row.seen.iter().map(|s| s.hue_deg().round()).collect();
            println!("{:?}: hues {hues:?}, ΔE {:.2?}", row.way, row.delta_e);
        }
        let green = |row: &Grading| (120.0..220.0).contains(&row.seen[2].hue_deg());
        assert!(green(&rows[0]) && green(&rows[1]));
        assert!(!green(&rows[3]), "a fault would pass");
        assert!(rows[0].delta_e.iter().all(|off| *off == 0.0));
        let worst = |row: &Grading| row.delta_e.iter().copied().fold(0.0, f64::max);
        assert!(worst(&rows[1]) < 3.0 && worst(&rows[2]) > 5.0 && worst(&rows[3]) > 10.0);
        // The masstones are the ends of the blend.
        assert!(rows[3].delta_e[0] < 1e-9 && rows[3].delta_e[4] < 1e-9);
    }
}
