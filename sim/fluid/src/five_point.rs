//! Symmetric five-point systems, solved by conjugate gradients with a modified incomplete Cholesky preconditioner
//! (Kershaw 1978; Bridson, "Fluid Simulation for Computer Graphics", 2008, ch. 4).

/// Share of the dropped fill that the preconditioner adds to its diagonal.
const MODIFIED: f64 = 0.97;
/// A pivot below this share of the diagonal is replaced by it.
const LEAST_PIVOT: f64 = 0.25;

/// The system `diagonal·x − Σ coupling·x' = b` over a grid, row after row.
#[derive(Clone, Debug)]
pub(crate) struct FivePoint {
    /// Nodes of a row.
    pub(crate) width: usize,
    /// Diagonal; 0 where there is no unknown.
    pub(crate) diagonal: Vec<f64>,
    /// Coupling of each node with the next one of its row.
    pub(crate) right: Vec<f64>,
    /// Coupling of each node with the one above.
    pub(crate) up: Vec<f64>,
}

impl FivePoint {
    pub(crate) fn new(width: usize, height: usize) -> Self {
        let zero = vec![0.0; width * height];
        Self {
            width,
            diagonal: zero.clone(),
            right: zero.clone(),
            up: zero,
        }
    }

    fn times(&self, x: &[f64], out: &mut [f64]) {
        let w = self.width;
        let n = x.len();
        for i in 0..n {
            let mut sum = self.diagonal[i] * x[i];
            if i + 1 < n {
                sum -= self.right[i] * x[i + 1];
            }
            if i >= 1 {
                sum -= self.right[i - 1] * x[i - 1];
            }
            if i + w < n {
                sum -= self.up[i] * x[i + w];
            }
            if i >= w {
                sum -= self.up[i - w] * x[i - w];
            }
            out[i] = sum;
        }
    }

    /// Inverse square roots of the pivots.
    fn factor(&self) -> Vec<f64> {
        let w = self.width;
        let mut inverse = vec![0.0; self.diagonal.len()];
        for i in 0..inverse.len() {
            let own = self.diagonal[i];
            if own <= 0.0 {
                continue;
            }
            let mut pivot = own;
            if i >= 1 {
                let (c, p) = (self.right[i - 1], inverse[i - 1]);
                pivot -= c * p * p * (c + MODIFIED * self.up[i - 1]);
            }
            if i >= w {
                let (c, p) = (self.up[i - w], inverse[i - w]);
                pivot -= c * p * p * (c + MODIFIED * self.right[i - w]);
            }
            if pivot < LEAST_PIVOT * own {
                pivot = own;
            }
            inverse[i] = 1.0 / pivot.sqrt();
        }
        inverse
    }

    fn precondition(&self, inverse: &[f64], r: &[f64], z: &mut [f64]) {
        let w = self.width;
        let n = r.len();
        for i in 0..n {
            let mut sum = r[i];
            if i >= 1 {
                sum += self.right[i - 1] * inverse[i - 1] * z[i - 1];
            }
            if i >= w {
                sum += self.up[i - w] * inverse[i - w] * z[i - w];
            }
            z[i] = sum * inverse[i];
        }
        for i in (0..n).rev() {
            let mut sum = z[i];
            if i + 1 < n {
                sum += self.right[i] * inverse[i] * z[i + 1];
            }
            if i + w < n {
                sum += self.up[i] * inverse[i] * z[i + w];
            }
            z[i] = sum * inverse[i];
        }
    }

    /// Solves for `x`, whose initial value is a guess, until the residual is `tolerance` of the right side, or for
    /// `most` iterations; returns their number.
    pub(crate) fn solve(&self, b: &[f64], x: &mut [f64], tolerance: f64, most: usize) -> usize {
        let inverse = self.factor();
        let mut r = vec![0.0; b.len()];
        self.times(x, &mut r);
        for (r, b) in r.iter_mut().zip(b) {
            *r = b - *r;
        }
        let target = tolerance * tolerance * dot(b, b);
        let mut z = vec![0.0; b.len()];
        self.precondition(&inverse, &r, &mut z);
        let mut direction = z.clone();
        let mut product = vec![0.0; b.len()];
        let mut rho = dot(&r, &z);
        for iteration in 0..most {
            if dot(&r, &r) <= target || rho <= 0.0 {
                return iteration;
            }
            self.times(&direction, &mut product);
            let curvature = dot(&direction, &product);
            if curvature <= 0.0 {
                return iteration;
            }
            let step = rho / curvature;
            for i in 0..x.len() {
                x[i] += step * direction[i];
                r[i] -= step * product[i];
            }
            self.precondition(&inverse, &r, &mut z);
            let next = dot(&r, &z);
            let turn = next / rho;
            rho = next;
            for (direction, z) in direction.iter_mut().zip(&z) {
                *direction = z + turn * *direction;
            }
        }
        most
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_known_solution_is_found_and_nodes_without_an_unknown_stay() {
        let (width, height) = (17, 11);
        let mut system = FivePoint::new(width, height);
        let mut expected = vec![0.0; width * height];
        for j in 0..height {
            for i in 0..width {
                let at = j * width + i;
                if i == 5 && j == 5 {
                    continue;
                }
                expected[at] = (i * i) as f64 - 3.0 * j as f64;
                system.diagonal[at] = 4.1 + i as f64;
                let open = |i: usize, j: usize| i < width && j < height && (i, j) != (5, 5);
                system.right[at] = if open(i + 1, j) { 1.0 } else { 0.0 };
                system.up[at] = if open(i, j + 1) { 1.0 } else { 0.0 };
            }
        }
        let mut b = vec![0.0; width * height];
        system.times(&expected, &mut b);
        let mut x = vec![0.0; width * height];
        let count = system.solve(&b, &mut x, 1e-12, 100);
        println!("{count} iterations");
        for (x, expected) in x.iter().zip(&expected) {
            assert!((x - expected).abs() < 1e-8, "{x} {expected}");
        }
        assert!(count < 20);
    }
}
