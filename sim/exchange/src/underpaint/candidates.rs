//! Mixtures from which the search for a colour begins: each paint alone, pairs and triples on a grid of
//! the logarithms of their ratios.

use maulstick_num::exp;

use super::films::{Films, MOST_PAINTS, Shares};

/// Bound on ln of a ratio of shares: one part in 1100.
const LARGEST_LN_RATIO: f64 = 7.0;
/// Number of places of a pair, and of three paints each way.
const PAIR_GRID: i32 = 14;
const TRIPLE_GRID: i32 = 8;

/// A mixture and its colour.
#[derive(Clone, Copy, Debug)]
struct Candidate {
    paints: [u8; 3],
    shares: [f32; 3],
    lab: [f32; 3],
}

/// All of them over one ground.
#[derive(Clone, Debug)]
pub(crate) struct Candidates(Vec<Candidate>);

impl Candidates {
    /// Candidates of all paints of `films`, over a ground.
    pub(crate) fn new(films: &Films, ground: &[f64]) -> Self {
        let count = films.paints();
        let mut all = Vec::new();
        let mut add = |paints: [usize; 3], logs: [f64; 3]| {
            let parts = logs.map(exp);
            let whole: f64 = parts.iter().sum();
            let mut shares: Shares = [0.0; MOST_PAINTS];
            for (paint, part) in paints.iter().zip(parts) {
                shares[*paint] += part / whole;
            }
            all.push(Candidate {
                paints: paints.map(|paint| paint as u8),
                shares: parts.map(|part| (part / whole) as f32),
                lab: films.lab(&shares, ground).map(|v| v as f32),
            });
        };
        let on = |grid: i32, i: i32| {
            2.0 * LARGEST_LN_RATIO * f64::from(i) / f64::from(grid) - LARGEST_LN_RATIO
        };
        for a in 0..count {
            add([a; 3], [0.0, f64::NEG_INFINITY, f64::NEG_INFINITY]);
            for b in a + 1..count {
                for i in 0..=PAIR_GRID {
                    add([a, b, b], [0.0, on(PAIR_GRID, i), f64::NEG_INFINITY]);
                }
                for c in b + 1..count {
                    for i in 0..=TRIPLE_GRID {
                        for j in 0..=TRIPLE_GRID {
                            add([a, b, c], [0.0, on(TRIPLE_GRID, i), on(TRIPLE_GRID, j)]);
                        }
                    }
                }
            }
        }
        Self(all)
    }

    /// The nearest to a colour in CIELAB of different paints, the nearest first.
    pub(crate) fn nearest<const N: usize>(&self, target: [f64; 3]) -> Vec<Shares> {
        let target = target.map(|v| v as f32);
        let mut best: Vec<(f32, &Candidate)> = Vec::with_capacity(N + 1);
        for candidate in &self.0 {
            let off = [0, 1, 2].map(|i| candidate.lab[i] - target[i]);
            let far = off[0] * off[0] + off[1] * off[1] + off[2] * off[2];
            if best.len() == N && best.last().is_some_and(|(worst, _)| far >= *worst) {
                continue;
            }
            match best.iter().position(|(_, b)| b.paints == candidate.paints) {
                Some(place) if best[place].0 <= far => continue,
                Some(place) => drop(best.remove(place)),
                None => {}
            }
            let place = best.partition_point(|(other, _)| *other <= far);
            best.insert(place, (far, candidate));
            best.truncate(N);
        }
        best.iter()
            .map(|(_, candidate)| {
                let mut shares = [0.0; MOST_PAINTS];
                for (paint, share) in candidate.paints.iter().zip(candidate.shares) {
                    shares[usize::from(*paint)] += f64::from(share);
                }
                shares
            })
            .collect()
    }
}
