//! The normal equations of a rule's least squares.

use super::Target;
use crate::spectrum::SAMPLES;

/// Unknowns: three weights a wavelength.
const SIZE: usize = 3 * SAMPLES;
/// Share of the mean diagonal added to it: reflectances are smooth, and so the equations of neighbouring wavelengths
/// nearly dependent.
const RIDGE: f64 = 1e-9;
/// Wavelengths of a block of products: its sums stay in registers.
const BLOCK: usize = 4;
/// Targets of which two blocks stay in the first cache.
const DEPTH: usize = 256;

/// The minimum of xᵀ·A·x − 2·xᵀ·b is sought over the weights x of chosen wavelengths.
pub(super) struct Normal {
    /// A, SIZE×SIZE; entry 3·wavelength + channel.
    a: Vec<f64>,
    b: Vec<f64>,
    /// Mean of A's diagonal.
    scale: f64,
    pub(super) white: [f64; 3],
}

impl Normal {
    /// The equations among the wavelengths `at`, in ascending order; the others' stay 0.
    pub(super) fn new(targets: &[Target], white: [f64; 3], at: &[usize]) -> Self {
        // A in the channels (i, j) is Σ w·M_ij·R·Rᵀ: six symmetric matrices.
        let panels = Panels::new(targets, at);
        let mut a = vec![0.0; SIZE * SIZE];
        for i in 0..3 {
            for j in 0..=i {
                let weight = |target: &Target| target.weight * target.metric.0[i][j];
                let gram = panels.gram(&targets.iter().map(weight).collect::<Vec<_>>());
                for (row, p) in gram.chunks_exact(at.len().max(1)).zip(at) {
                    for (value, q) in row.iter().zip(at) {
                        a[(3 * p + i) * SIZE + 3 * q + j] = *value;
                        a[(3 * p + j) * SIZE + 3 * q + i] = *value;
                    }
                }
            }
        }
        let mut b = vec![0.0; SIZE];
        let mut trace = 0.0;
        for target in targets {
            let m = &target.metric.0;
            let pull = [0, 1, 2]
                .map(|i| target.weight * (0..3).map(|j| m[i][j] * target.xyz[j]).sum::<f64>());
            for (p, r) in target.reflectance.iter().enumerate() {
                (0..3).for_each(|i| b[3 * p + i] += r * pull[i]);
            }
            let square: f64 = target.reflectance.iter().map(|r| r * r).sum();
            trace += target.weight * (m[0][0] + m[1][1] + m[2][2]) * square;
        }
        let ridge = RIDGE * trace / SIZE as f64;
        for p in at {
            (0..3).for_each(|c| a[(3 * p + c) * (SIZE + 1)] += ridge);
        }
        let scale = trace / SIZE as f64 + ridge;
        Self { a, b, scale, white }
    }

    pub(super) fn a(&self, p: usize, q: usize) -> f64 {
        self.a[p * SIZE + q]
    }

    /// Row `p` of A.
    pub(super) fn row(&self, p: usize) -> &[f64] {
        &self.a[p * SIZE..][..SIZE]
    }

    pub(super) fn b(&self, p: usize) -> f64 {
        self.b[p]
    }

    /// Mean of A's diagonal.
    pub(super) fn scale(&self) -> f64 {
        self.scale
    }
}

/// Reflectances of all targets at some wavelengths, block after block of these.
struct Panels {
    wavelengths: usize,
    targets: usize,
    values: Vec<[f64; BLOCK]>,
}

impl Panels {
    fn new(targets: &[Target], at: &[usize]) -> Self {
        let mut values = Vec::with_capacity(targets.len() * at.len().div_ceil(BLOCK));
        for block in at.chunks(BLOCK) {
            values.extend(targets.iter().map(|target| {
                let r = |i: usize| block.get(i).map_or(0.0, |p| target.reflectance[*p]);
                std::array::from_fn::<f64, BLOCK, _>(r)
            }));
        }
        Self {
            wavelengths: at.len(),
            targets: targets.len(),
            values,
        }
    }

    /// Σ weight·R·Rᵀ over the targets, row after row.
    fn gram(&self, weights: &[f64]) -> Vec<f64> {
        let n = self.wavelengths;
        let mut sums = vec![0.0; n * n];
        let mut weighted = [[0.0; BLOCK]; DEPTH];
        for (run, weights) in weights.chunks(DEPTH).enumerate() {
            let panel =
                |block: usize| &self.values[block * self.targets + run * DEPTH..][..weights.len()];
            for p in 0..n.div_ceil(BLOCK) {
                for ((weighted, r), weight) in weighted.iter_mut().zip(panel(p)).zip(weights) {
                    *weighted = r.map(|r| weight * r);
                }
                for q in 0..=p {
                    let products = products(&weighted[..weights.len()], panel(q));
                    for (i, row) in products.iter().enumerate() {
                        let i = p * BLOCK + i;
                        let to = (q * BLOCK).min(n)..((q + 1) * BLOCK).min(i + 1).min(n);
                        if i < n && !to.is_empty() {
                            let sums = sums[i * n..][to].iter_mut();
                            sums.zip(row).for_each(|(sum, product)| *sum += product);
                        }
                    }
                }
            }
        }
        for i in 0..n {
            for j in 0..i {
                sums[j * n + i] = sums[i * n + j];
            }
        }
        sums
    }
}

/// Σ a·bᵀ.
fn products(a: &[[f64; BLOCK]], b: &[[f64; BLOCK]]) -> [[f64; BLOCK]; BLOCK] {
    let mut sums = [[0.0; BLOCK]; BLOCK];
    for (a, b) in a.iter().zip(b) {
        for i in 0..BLOCK {
            for j in 0..BLOCK {
                sums[i][j] += a[i] * b[j];
            }
        }
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fitted::metric::Metric;

    /// Greatest relative difference of the sums from those in plain order.
    fn off(fault: f64) -> f64 {
        let target = |t: usize| Target {
            reflectance: std::array::from_fn(|i| ((i * 31 + t * 17) % 101) as f64 / 101.0),
            xyz: [0.0; 3],
            metric: Metric([[0.0; 3]; 3]),
            weight: 1.0 + (t % 5) as f64,
        };
        let targets: Vec<Target> = (0..700).map(target).collect();
        let at: Vec<usize> = (0..SAMPLES).step_by(3).collect();
        let weights: Vec<f64> = targets.iter().map(|t| t.weight * (1.0 + fault)).collect();
        let got = Panels::new(&targets, &at).gram(&weights);
        let mut worst = 0.0f64;
        for (i, p) in at.iter().enumerate() {
            for (j, q) in at.iter().enumerate() {
                let of = |t: &Target| t.weight * t.reflectance[*p] * t.reflectance[*q];
                let want: f64 = targets.iter().map(of).sum();
                worst = worst.max((got[i * at.len() + j] / want - 1.0).abs());
            }
        }
        worst
    }

    #[test]
    fn sums_in_blocks_are_the_plain_ones() {
        assert!(off(0.0) < 1e-12, "{:e}", off(0.0));
        assert!(off(1e-11) > 1e-12, "a fault would pass");
    }
}
