//! The colour of a film of mixed paints over a ground, and how it changes with the shares.

use maulstick_optics::colour::lab;
use maulstick_optics::km::over_with_slopes;
use maulstick_optics::upsampling::lab_with_slopes;
use maulstick_optics::{Paint, Studio};

/// Most paints that are mixed to a picture.
pub const MOST_PAINTS: usize = 16;

/// Shares of paints by volume, of the sum 1.
pub(crate) type Shares = [f64; MOST_PAINTS];

/// Films of one thickness, of a few paints.
#[derive(Clone, Debug)]
pub(crate) struct Films {
    paints: usize,
    /// K·d and S·d of each paint, a row a wavelength.
    depths: Vec<[[f64; 2]; MOST_PAINTS]>,
    weights: Vec<[f64; 3]>,
    white: [f64; 3],
    k1: f64,
    k2: f64,
}

impl Films {
    /// Films of the first [`MOST_PAINTS`] of `paints`, at the wavelengths of a studio.
    pub(crate) fn new(studio: &Studio, paints: &[Paint], thickness_m: f64) -> Self {
        let rule = studio.rule();
        let depth = |nm: &f64| {
            let mut row = [[0.0; 2]; MOST_PAINTS];
            for (depth, paint) in row.iter_mut().zip(paints) {
                *depth = [paint.k.at(*nm), paint.s.at(*nm)].map(|per_m| per_m * thickness_m);
            }
            row
        };
        Self {
            paints: paints.len().min(MOST_PAINTS),
            depths: rule.wavelengths_nm.iter().map(depth).collect(),
            weights: rule.weights.clone(),
            white: studio.white(),
            k1: studio.surface().k1,
            k2: studio.surface().k2,
        }
    }

    /// Number of paints.
    pub(crate) fn paints(&self) -> usize {
        self.paints
    }

    fn depth(&self, row: &[[f64; 2]; MOST_PAINTS], shares: &Shares) -> [f64; 2] {
        let mut sum = [0.0; 2];
        for (depth, share) in row.iter().zip(shares).take(self.paints) {
            sum[0] += share * depth[0];
            sum[1] += share * depth[1];
        }
        sum
    }

    /// Visible colour of an internal reflectance, gloss included, and its slope.
    fn seen(&self, r: f64) -> [f64; 2] {
        let (open, inside) = ((1.0 - self.k1) * (1.0 - self.k2), 1.0 / (1.0 - self.k2 * r));
        [self.k1 + open * r * inside, open * inside * inside]
    }

    /// CIELAB of a mixture over a ground of internal reflectances, a value a wavelength.
    pub(crate) fn lab(&self, shares: &Shares, ground: &[f64]) -> [f64; 3] {
        let mut xyz = [0.0; 3];
        for ((row, weight), under) in self.depths.iter().zip(&self.weights).zip(ground) {
            let [kd, sd] = self.depth(row, shares);
            let film = maulstick_optics::km::film(kd, sd);
            let [seen, _] = self.seen(maulstick_optics::km::over(film, *under));
            (0..3).for_each(|i| xyz[i] += weight[i] * seen);
        }
        lab(xyz, self.white)
    }

    /// [`lab`](Self::lab), and its slope by the amount of each paint, at a constant total of 1.
    pub(crate) fn lab_with_slopes(
        &self,
        shares: &Shares,
        ground: &[f64],
    ) -> ([f64; 3], [[f64; 3]; MOST_PAINTS]) {
        let mut xyz = [0.0; 3];
        let mut slopes = [[0.0; 3]; MOST_PAINTS];
        for ((row, weight), under) in self.depths.iter().zip(&self.weights).zip(ground) {
            let [kd, sd] = self.depth(row, shares);
            let [r, by_k, by_s] = over_with_slopes(kd, sd, *under);
            let [seen, slope] = self.seen(r);
            (0..3).for_each(|i| xyz[i] += weight[i] * seen);
            for (slopes, depth) in slopes.iter_mut().zip(row).take(self.paints) {
                let by_amount = slope * (by_k * (depth[0] - kd) + by_s * (depth[1] - sd));
                (0..3).for_each(|i| slopes[i] += weight[i] * by_amount);
            }
        }
        let (lab, by_xyz) = lab_with_slopes(xyz, self.white);
        for slopes in slopes.iter_mut().take(self.paints) {
            *slopes = maulstick_optics::colour::apply(&by_xyz, *slopes);
        }
        (lab, slopes)
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use maulstick_optics::{PaintLibrary, StudioSettings};
    use maulstick_painting::setup::PALETTE_PAINTS;

    use super::*;

    pub(crate) fn palette() -> (Studio, Vec<Paint>) {
        let library = PaintLibrary::measured().expect("whole");
        let studio = Studio::new(&StudioSettings::default(), library.paints());
        let find = |name: &str| library.find(name).expect("known").clone();
        (studio, PALETTE_PAINTS.map(find).to_vec())
    }

    #[test]
    fn a_film_looks_as_in_the_studio_and_its_slopes_are_those_of_differences() {
        let (mut studio, paints) = palette();
        for paint in &paints {
            studio.add(paint);
        }
        let films = Films::new(&studio, &paints, 40e-6);
        let ground = vec![0.9f32; studio.wavelengths()];
        let under: Vec<f64> = ground.iter().map(|r| f64::from(*r)).collect();
        let mut shares = [0.0; MOST_PAINTS];
        (shares[0], shares[1], shares[5]) = (0.7, 0.25, 0.05);
        let (lab, slopes) = films.lab_with_slopes(&shares, &under);
        let there = [(0, 0.7), (1, 0.25), (5, 0.05)].map(|(slot, share)| (slot, share * 40e-6));
        let expected = studio.lab(&there, &ground);
        let plain = films.lab(&shares, &under);
        for i in 0..3 {
            // The studio's K and S are in single precision.
            assert!((lab[i] - expected[i]).abs() < 1e-3 && (lab[i] - plain[i]).abs() < 1e-9);
        }
        let mut checked = 0;
        for paint in 0..films.paints() {
            let moved = |by: f64| {
                let mut moved = shares;
                moved[paint] += by;
                let sum: f64 = moved.iter().sum();
                films.lab(&moved.map(|share| share / sum), &under)
            };
            let (up, down) = (moved(1e-6), moved(-1e-6));
            for i in 0..3 {
                let difference = (up[i] - down[i]) / 2e-6;
                let off = |factor: f64| (factor * slopes[paint][i] - difference).abs();
                assert!(off(1.0) < 1e-4 * (1.0 + difference.abs()), "{paint} {i}");
                checked += usize::from(off(1.01) > 1e-4 * (1.0 + difference.abs()));
            }
        }
        assert!(checked > 20, "a fault would pass");
    }
}
