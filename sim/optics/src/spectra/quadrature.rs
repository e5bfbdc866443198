//! Gauss rules of any weight: discretised Stieltjes, then Golub and Welsch.
//!
//! Source: W. Gautschi, *Orthogonal Polynomials*, 2004, § 2.2 (Stieltjes) and § 3.1 (Golub-Welsch).

/// Nodes in rising order and positive weights.
#[derive(Clone, Debug, PartialEq)]
pub struct GaussRule {
    /// Points of evaluation.
    pub nodes: Vec<f64>,
    /// Weights of the points.
    pub weights: Vec<f64>,
}

/// The coefficients of the three-term recurrence
/// π_{k+1}(x) = (x − α_k)·π_k(x) − β_k·π_{k−1}(x), with β_0 the integral of the weight.
#[derive(Clone, Debug, PartialEq)]
pub struct Recurrence {
    /// α_0 … α_{n−1}.
    pub alpha: Vec<f64>,
    /// β_0 … β_{n−1}.
    pub beta: Vec<f64>,
}

impl Recurrence {
    /// The recurrence of the discrete measure `weights` at `points`; n is at most the number of
    /// points of positive weight.
    #[must_use]
    pub fn of_measure(points: &[f64], weights: &[f64], n: usize) -> Self {
        let mut alpha = Vec::with_capacity(n);
        let mut beta = Vec::with_capacity(n);
        let mut before = vec![0.0; points.len()];
        let mut now = vec![1.0; points.len()];
        let mut norm_before = 0.0;
        for k in 0..n {
            let norm: f64 = now.iter().zip(weights).map(|(p, w)| p * p * w).sum();
            let moment: f64 = now
                .iter()
                .zip(weights)
                .zip(points)
                .map(|((p, w), x)| p * p * w * x)
                .sum();
            let a = moment / norm;
            let b = if k == 0 { norm } else { norm / norm_before };
            alpha.push(a);
            beta.push(b);
            let drop = if k == 0 { 0.0 } else { b };
            for ((p, q), x) in now.iter_mut().zip(before.iter_mut()).zip(points) {
                let next = (x - a) * *p - drop * *q;
                *q = *p;
                *p = next;
            }
            norm_before = norm;
        }
        Self { alpha, beta }
    }

    /// The n-point Gauss rule: eigenvalues of the Jacobi matrix, and β_0 times the squared first
    /// components of its eigenvectors.
    #[must_use]
    pub fn gauss(&self) -> GaussRule {
        let mut diagonal = self.alpha.clone();
        let mut off: Vec<f64> = self.beta[1..].iter().map(|b| b.sqrt()).collect();
        off.push(0.0);
        let mut first = vec![0.0; diagonal.len()];
        first[0] = 1.0;
        symmetric_ql(&mut diagonal, &mut off, &mut first);
        let mut pairs: Vec<(f64, f64)> = diagonal
            .into_iter()
            .zip(first.into_iter().map(|v| self.beta[0] * v * v))
            .collect();
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (nodes, weights) = pairs.into_iter().unzip();
        GaussRule { nodes, weights }
    }
}

/// Eigenvalues of a symmetric tridiagonal matrix by implicit QL with Wilkinson's shift; `first`
/// becomes the first components of the eigenvectors.
fn symmetric_ql(diagonal: &mut [f64], off: &mut [f64], first: &mut [f64]) {
    let n = diagonal.len();
    for l in 0..n {
        for _ in 0..60 {
            let m = (l..n - 1)
                .find(|&m| {
                    off[m].abs() <= f64::EPSILON * (diagonal[m].abs() + diagonal[m + 1].abs())
                })
                .unwrap_or(n - 1);
            if m == l {
                break;
            }
            let half = (diagonal[l + 1] - diagonal[l]) / (2.0 * off[l]);
            let root = (half * half + 1.0).sqrt();
            let mut g = diagonal[m] - diagonal[l] + off[l] / (half + root.copysign(half));
            let (mut s, mut c, mut p) = (1.0, 1.0, 0.0);
            for i in (l..m).rev() {
                let (f, b) = (s * off[i], c * off[i]);
                let r = (f * f + g * g).sqrt();
                off[i + 1] = r;
                if r == 0.0 {
                    diagonal[i + 1] -= p;
                    off[m] = 0.0;
                    break;
                }
                s = f / r;
                c = g / r;
                g = diagonal[i + 1] - p;
                let t = (diagonal[i] - g) * s + 2.0 * c * b;
                p = s * t;
                diagonal[i + 1] = g + p;
                g = c * t - b;
                let f = first[i + 1];
                first[i + 1] = s * first[i] + c * f;
                first[i] = c * first[i] - s * f;
            }
            diagonal[l] -= p;
            off[l] = g;
            off[m] = 0.0;
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use maulstick_num::cos;

    use super::*;

    /// Fejér's first rule: a discrete measure that is exact for the Legendre weight.
    fn legendre_measure(n: usize) -> (Vec<f64>, Vec<f64>) {
        let angle = |k: usize| PI * (2 * k + 1) as f64 / (2 * n) as f64;
        let weight = |k: usize| {
            let sum: f64 = (1..=n / 2)
                .map(|j| cos(2.0 * j as f64 * angle(k)) / (4 * j * j - 1) as f64)
                .sum();
            2.0 / n as f64 * (1.0 - 2.0 * sum)
        };
        (
            (0..n).map(|k| cos(angle(k))).collect(),
            (0..n).map(weight).collect(),
        )
    }

    #[test]
    fn legendre_of_eight_points() {
        let (points, weights) = legendre_measure(64);
        let rule = Recurrence::of_measure(&points, &weights, 8).gauss();
        // Abramowitz and Stegun, table 25.4.
        let expected = [
            (0.183_434_642_495_649, 0.362_683_783_378_361),
            (0.525_532_409_916_328, 0.313_706_645_877_887),
            (0.796_666_477_413_626, 0.222_381_034_453_374),
            (0.960_289_856_497_536, 0.101_228_536_290_376),
        ];
        for (k, (node, weight)) in expected.into_iter().enumerate() {
            for (place, sign) in [(3 - k, -1.0), (4 + k, 1.0)] {
                let (x, w) = (rule.nodes[place], rule.weights[place]);
                println!(
                    "{x} {w}, expected {node} {weight}, error {:e}",
                    x - sign * node
                );
                assert!((x - sign * node).abs() < 1e-13 && (w - weight).abs() < 1e-13);
                assert!(
                    (x + 1e-12 - sign * node).abs() > 1e-13,
                    "a fault would pass"
                );
            }
        }
    }

    #[test]
    fn chebyshev_recurrence() {
        let n = 40;
        let points: Vec<f64> = (0..n)
            .map(|k| cos(PI * (2 * k + 1) as f64 / (2 * n) as f64))
            .collect();
        let weights = vec![PI / n as f64; n];
        let recurrence = Recurrence::of_measure(&points, &weights, 8);
        let expected = [PI, 0.5, 0.25, 0.25, 0.25, 0.25, 0.25, 0.25];
        for (got, want) in recurrence.beta.iter().zip(expected) {
            assert!((got - want).abs() < 1e-13, "{got} {want}");
        }
        assert!(recurrence.alpha.iter().all(|a| a.abs() < 1e-13));
    }

    #[test]
    fn nodes_interlace_and_a_custom_weight_is_exact_to_degree_fifteen() {
        let points: Vec<f64> = (0..101).map(|i| -1.0 + 0.02 * f64::from(i)).collect();
        let weights: Vec<f64> = points
            .iter()
            .map(|x| (1.0 + x) * (2.0 - x * x) + 0.1)
            .collect();
        let rule = |n: usize| Recurrence::of_measure(&points, &weights, n).gauss();
        let (eight, nine) = (rule(8), rule(9));
        for i in 0..8 {
            assert!(nine.nodes[i] < eight.nodes[i] && eight.nodes[i] < nine.nodes[i + 1]);
        }
        assert!(eight.weights.iter().all(|w| *w > 0.0));
        for degree in 0..=16i32 {
            let exact: f64 = points
                .iter()
                .zip(&weights)
                .map(|(x, w)| w * x.powi(degree))
                .sum();
            let got: f64 = eight
                .nodes
                .iter()
                .zip(&eight.weights)
                .map(|(x, w)| w * x.powi(degree))
                .sum();
            let scale: f64 = points
                .iter()
                .zip(&weights)
                .map(|(x, w)| w * x.abs().powi(degree))
                .sum();
            let error = (got - exact).abs() / scale;
            assert_eq!(error < 1e-12, degree <= 15, "degree {degree}: {error:e}");
        }
    }
}
