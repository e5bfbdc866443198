//! Mixtures of two and three paints nearest to a colour, in ΔE₀₀.
//!
//! Shares are searched by the logarithm of their ratio: a hundredth of a phthalo equals half of an ochre. Proposals can
//! be measured out: shares have as few digits as the colour allows.

use maulstick_num::exp;
use maulstick_types::Mixture;
use maulstick_types::mixture::Part;

use std::collections::BTreeSet;

use crate::colour::{delta_e_2000, lab};
use crate::mixture::{Blend, Coat};
use crate::paints::Paint;
use crate::search::{golden_section, simplex};
use crate::viewing::{Seen, Viewing};

/// Most paints among which triples are sought.
const MOST_IN_TRIPLES: usize = 40;
/// Bound on ln of a ratio of shares: one part in 1100.
const LARGEST_LN_RATIO: f64 = 7.0;
/// Places on which a pair is tried first; between them a colour turns but once.
const PAIR_GRID: i32 = 28;
/// Number of places each way at which three paints are tried first.
const TRIPLE_GRID: i32 = 8;
/// Largest cost of rounding the shares, ΔE₀₀: a quarter of the least difference that an eye sees.
const ROUNDING: f64 = 0.25;
/// Most digits of a share.
const DIGITS: u32 = 4;

/// A mixture, opaque, and how near it comes.
#[derive(Clone, Debug, PartialEq)]
pub struct Proposal {
    /// The paints, the largest share first.
    pub mixture: Mixture,
    /// Distance from the target, ΔE₀₀.
    pub delta_e: f64,
    /// Its colour.
    pub seen: Seen,
}

/// The nearest mixtures, the nearest first.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Proposals {
    /// Proposals of two paints.
    pub pairs: Vec<Proposal>,
    /// Proposals of three paints, each nearer than any two of them.
    pub triples: Vec<Proposal>,
}

impl Proposals {
    /// The nearest of all.
    #[must_use]
    pub fn nearest(&self) -> Option<f64> {
        let all = self.pairs.iter().chain(&self.triples);
        all.map(|proposal| proposal.delta_e).min_by(f64::total_cmp)
    }
}

/// The `count` nearest mixtures of two and of three `paints` to the CIELAB colour `target` (relative
/// to the white of `viewing`): opaque, as the eye sees them, gloss included.
#[must_use]
pub fn propose(paints: &[Paint], viewing: &Viewing, target: [f64; 3], count: usize) -> Proposals {
    let table = Table::new(paints, viewing, target);
    let pairs = table.pairs();
    let triples = table.triples(&pairs);
    Proposals {
        pairs: table.nearest(pairs, count),
        triples: table.nearest(triples, count),
    }
}

/// Paints by number, their shares, ΔE₀₀.
type Found<const N: usize> = ([usize; N], [f64; N], f64);

/// The paints at the wavelengths that are computed.
struct Table<'a> {
    paints: &'a [Paint],
    viewing: &'a Viewing,
    coat: Coat,
    /// K and S of each paint at each wavelength.
    ks: Vec<Vec<[f64; 2]>>,
    target: [f64; 3],
}

impl<'a> Table<'a> {
    fn new(paints: &'a [Paint], viewing: &'a Viewing, target: [f64; 3]) -> Self {
        let at = |paint: &Paint| {
            let nm = viewing.rule().wavelengths_nm.iter();
            nm.map(|nm| [paint.k.at(*nm), paint.s.at(*nm)]).collect()
        };
        Self {
            paints,
            viewing,
            coat: Coat::masstone(),
            ks: paints.iter().map(at).collect(),
            target,
        }
    }

    fn delta_e<const N: usize>(&self, paints: [usize; N], shares: [f64; N]) -> f64 {
        let ks = paints.map(|paint| self.ks[paint].as_slice());
        let mut xyz = [0.0; 3];
        for (i, weight) in self.viewing.rule().weights.iter().enumerate() {
            let (mut k, mut s) = (0.0, 0.0);
            for (ks, share) in ks.iter().zip(shares) {
                k += share * ks[i][0];
                s += share * ks[i][1];
            }
            let r = self.coat.reflectance(k, s);
            for (sum, weight) in xyz.iter_mut().zip(weight) {
                *sum += weight * r;
            }
        }
        let white = self.viewing.white();
        let xyz = std::array::from_fn(|i| xyz[i].clamp(0.0, white[i]));
        delta_e_2000(lab(xyz, white), self.target)
    }

    fn pairs(&self) -> Vec<Found<2>> {
        let mut found = Vec::new();
        for b in 1..self.paints.len() {
            for a in 0..b {
                let at = |u: f64| self.delta_e([a, b], shares_of([0.0, u]));
                let step = 2.0 * LARGEST_LN_RATIO / f64::from(PAIR_GRID);
                let (start, _) = (0..=PAIR_GRID)
                    .map(|i| step * f64::from(i) - LARGEST_LN_RATIO)
                    .map(|u| (u, at(u)))
                    .fold((0.0, f64::INFINITY), nearer);
                let (u, delta_e) = golden_section([start - step, start + step], 16, at);
                found.push(([a, b], shares_of([0.0, u]), delta_e));
            }
        }
        found
    }

    fn triples(&self, pairs: &[Found<2>]) -> Vec<Found<3>> {
        // Pairs stand in the order of b, then a.
        let pair = |a: usize, b: usize| pairs[b * (b - 1) / 2 + a].2;
        let chosen = self.promising(pairs);
        let mut found = Vec::new();
        for (third, &c) in chosen.iter().enumerate() {
            for (second, &b) in chosen[..third].iter().enumerate() {
                for &a in &chosen[..second] {
                    let (shares, delta_e) = self.triple([a, b, c]);
                    if delta_e < pair(a, b).min(pair(a, c)).min(pair(b, c)) {
                        found.push(([a, b, c], shares, delta_e));
                    }
                }
            }
        }
        found
    }

    /// Paints for triples, in their order: all of a common palette; for a large one those of the nearest pairs, since
    /// the search grows with the cube of their number.
    fn promising(&self, pairs: &[Found<2>]) -> Vec<usize> {
        if self.paints.len() <= MOST_IN_TRIPLES {
            return (0..self.paints.len()).collect();
        }
        let mut nearest: Vec<&Found<2>> = pairs.iter().collect();
        nearest.sort_by(|a, b| a.2.total_cmp(&b.2));
        let mut chosen = BTreeSet::new();
        for paint in nearest.iter().flat_map(|(paints, ..)| paints) {
            if chosen.len() < MOST_IN_TRIPLES {
                chosen.insert(*paint);
            }
        }
        chosen.into_iter().collect()
    }

    fn triple(&self, paints: [usize; 3]) -> ([f64; 3], f64) {
        let shares = |[u, v]: [f64; 2]| shares_of([0.0, u, v]);
        let at = |place: [f64; 2]| {
            let outside = place.map(|x| (x.abs() - LARGEST_LN_RATIO).max(0.0));
            self.delta_e(paints, shares(place)) + outside[0] + outside[1]
        };
        let step = 2.0 * LARGEST_LN_RATIO / f64::from(TRIPLE_GRID);
        let on_grid = |i: i32| step * f64::from(i) - LARGEST_LN_RATIO;
        let places = (0..=TRIPLE_GRID)
            .flat_map(|i| (0..=TRIPLE_GRID).map(move |j| [on_grid(i), on_grid(j)]));
        let (start, _) = places
            .map(|place| (place, at(place)))
            .fold(([0.0; 2], f64::INFINITY), nearer);
        let (place, delta_e) = simplex(start, 0.5 * step, 1e-3, 120, at);
        (shares(place), delta_e)
    }

    /// The nearest mixtures, rounded.
    fn nearest<const N: usize>(&self, mut found: Vec<Found<N>>, count: usize) -> Vec<Proposal> {
        found.sort_by(|a, b| a.2.total_cmp(&b.2));
        // Rounding changes the order of neighbours.
        found.truncate(2 * count);
        let mut proposals: Vec<Proposal> = found.iter().map(|found| self.rounded(found)).collect();
        proposals.sort_by(|a, b| a.delta_e.total_cmp(&b.delta_e));
        proposals.truncate(count);
        proposals
    }

    fn rounded<const N: usize>(&self, (paints, shares, exact): &Found<N>) -> Proposal {
        let mut best = ([0; N], f64::INFINITY, 1);
        for digits in 2..=DIGITS {
            let whole = 10i64.pow(digits);
            for parts in neighbours(*shares, whole) {
                let delta_e = self.delta_e(*paints, parts.map(|part| part as f64));
                if delta_e < best.1 {
                    best = (parts, delta_e, whole);
                }
            }
            if best.1 <= exact + ROUNDING {
                break;
            }
        }
        let (shares, delta_e, whole) = best;
        let mut order: Vec<usize> = (0..N).collect();
        order.sort_by_key(|i| -shares[*i]);
        let part = |i: &usize| Part {
            paint: self.paints[paints[*i]].name.clone(),
            share: shares[*i] as f64 / whole as f64,
        };
        let of = |i: &usize| (&self.paints[paints[*i]], shares[*i] as f64);
        let blend = Blend::new(&order.iter().map(of).collect::<Vec<_>>());
        Proposal {
            mixture: Mixture {
                parts: order.iter().map(part).collect(),
            },
            delta_e,
            seen: self.viewing.coat(&blend, &self.coat),
        }
    }
}

fn nearer<T>(best: (T, f64), other: (T, f64)) -> (T, f64) {
    if other.1 < best.1 { other } else { best }
}

/// Shares of the sum 1, of the logarithms of their ratios.
fn shares_of<const N: usize>(logs: [f64; N]) -> [f64; N] {
    let parts = logs.map(|log| exp(log.clamp(-2.0 * LARGEST_LN_RATIO, 2.0 * LARGEST_LN_RATIO)));
    let whole: f64 = parts.iter().sum();
    parts.map(|part| part / whole)
}

/// Whole numbers above 0 of the sum `whole` in the ratio of `shares`: all but the largest once
/// rounded down and once up.
fn neighbours<const N: usize>(shares: [f64; N], whole: i64) -> Vec<[i64; N]> {
    let largest = (0..N)
        .max_by(|a, b| shares[*a].total_cmp(&shares[*b]))
        .unwrap_or(0);
    let mut found = Vec::new();
    for choice in 0..1usize << N {
        if choice >> largest & 1 == 1 {
            continue;
        }
        let mut parts: [i64; N] = std::array::from_fn(|i| {
            let up = (choice >> i & 1) as i64;
            ((shares[i] * whole as f64) as i64 + up).max(1)
        });
        parts[largest] = 0;
        parts[largest] = whole - parts.iter().sum::<i64>();
        if parts[largest] > 0 {
            found.push(parts);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paints::PaintLibrary;
    use crate::studio::{RuleKind, StudioSettings};

    fn library() -> PaintLibrary {
        PaintLibrary::measured().expect("whole")
    }

    fn viewing() -> Viewing {
        let settings = StudioSettings {
            rule: RuleKind::Gauss,
            ..StudioSettings::default()
        };
        Viewing::new(&settings, &[])
    }

    fn colour_of(mixture: &str, coat: &Coat) -> Seen {
        let mixture = mixture.parse().expect("a mixture");
        let blend = Blend::of(&library(), &mixture).expect("known paints");
        viewing().coat(&blend, coat)
    }

    fn chosen(names: &[&str]) -> Vec<Paint> {
        let find = |name: &&str| library().find(name).expect("known").clone();
        names.iter().map(find).collect()
    }

    #[test]
    fn a_mixture_finds_itself() {
        for (text, known) in [
            ("Cobalt Blue=0.7,Titanium White=0.3", 2),
            ("Titanium White=0.98,Phthalo Blue Green Shade=0.02", 2),
            ("Yellow Ochre=0.6,Burnt Umber=0.3,Titanium White=0.1", 3),
            (
                "Titanium White=0.9,Quinacridone Red=0.07,Green Gold=0.03",
                3,
            ),
        ] {
            let mixture: Mixture = text.parse().expect("a mixture");
            let names: Vec<&str> = mixture.parts.iter().map(|p| p.paint.as_str()).collect();
            let target = colour_of(text, &Coat::masstone()).lab;
            let proposals = propose(&chosen(&names), &viewing(), target, 5);
            let own = match known {
                2 => &proposals.pairs,
                _ => &proposals.triples,
            };
            println!("{text}: {} at {:.4}", own[0].mixture, own[0].delta_e);
            assert!(own[0].delta_e < 0.1, "{own:?}");
            // A target without the gloss is another colour.
            let inside = Coat {
                surface: None,
                ..Coat::masstone()
            };
            let faulty = colour_of(text, &inside).lab;
            let proposals = propose(&chosen(&names), &viewing(), faulty, 1);
            assert!(proposals.nearest() > Some(0.1), "a fault would pass");
        }
    }

    #[test]
    fn all_triples_are_searched_and_proposals_can_be_measured_out() {
        let viewing = viewing();
        let brown =
            [0x8a, 0x5a, 0x3c].map(|byte| crate::colour::srgb_decode(f64::from(byte) / 255.0));
        let target = viewing.display(brown).lab;
        let start = std::time::Instant::now();
        let proposals = propose(library().paints(), &viewing, target, 5);
        println!("{:.2} s", start.elapsed().as_secs_f64());
        assert_eq!((proposals.pairs.len(), proposals.triples.len()), (5, 5));
        for list in [&proposals.pairs, &proposals.triples] {
            assert!(list.windows(2).all(|two| two[0].delta_e <= two[1].delta_e));
            for proposal in list {
                println!("{:.3} {}", proposal.delta_e, proposal.mixture);
                let again = delta_e_2000(proposal.seen.lab, target);
                assert!((again - proposal.delta_e).abs() < 1e-9);
                let text = proposal.mixture.to_string();
                let parsed: Mixture = text.parse().expect("what --load takes");
                assert_eq!(parsed, proposal.mixture);
                let units = parsed.parts.iter().map(|part| (part.share * 1e4).round());
                assert_eq!(units.sum::<f64>(), 1e4, "{text}");
            }
        }
        assert!(proposals.triples[0].delta_e < proposals.pairs[0].delta_e);
    }

    #[test]
    fn no_random_mixture_of_a_triple_is_nearer() {
        let names = ["Titanium White", "Phthalo Green Blue Shade", "Pyrrole Red"];
        let paints = chosen(&names);
        let viewing = viewing();
        for target in [[50.0, 5.0, -10.0], [30.0, -20.0, 5.0], [70.0, 30.0, 20.0]] {
            let table = Table::new(&paints, &viewing, target);
            let (shares, found) = table.triple([0, 1, 2]);
            let mut best = f64::INFINITY;
            for i in 0..=200 {
                for j in 0..=200 {
                    let [u, v] = [i, j].map(|x| f64::from(x) * 0.07 - LARGEST_LN_RATIO);
                    best = best.min(table.delta_e([0, 1, 2], shares_of([0.0, u, v])));
                }
            }
            println!("{target:?}: {found:.4} at {shares:?}, by brute force {best:.4}");
            assert!(found < best + 0.01);
        }
    }

    #[test]
    fn far_out_of_the_paints_gamut_the_nearest_is_far() {
        let target = viewing().display([0.0, 1.0, 0.0]).lab;
        let paints = chosen(&[
            "Phthalo Green Yellow Shade",
            "Hansa Yellow Opaque",
            "Titanium White",
        ]);
        let nearest = propose(&paints, &viewing(), target, 1).nearest();
        assert!(nearest > Some(5.0), "{nearest:?}");
        assert_eq!(
            propose(&paints[..1], &viewing(), target, 5),
            Proposals::default()
        );
    }
}
