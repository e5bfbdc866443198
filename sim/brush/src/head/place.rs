//! Positions of the strips in the ferrule (Baxter 2004, § 3.5.2): at random along a line, or in the Delaunay
//! triangles between the spines and the ferrule's edge.

use delaunator::{Point, triangulate};
use glam::DVec2;
use maulstick_num::{powf, sin_cos};
use rand_pcg::Pcg32;
use rand_pcg::rand_core::Rng as _;

use crate::file::BrushFile;
use crate::file::sections::Outline;

/// Number of points on the ferrule's edge.
const EDGE: usize = 32;
/// Exponent of the superellipse of a flat ferrule.
const FLAT: f64 = 8.0;
/// Powers of the root of x⁴ = x + 1, for a low-discrepancy sequence in three dimensions (Roberts 2018).
const EVEN: [f64; 3] = [
    0.819_172_513_396_164_4,
    0.671_043_606_703_789_2,
    0.549_700_477_901_970_2,
];

/// A seeded source of numbers in 0..1.
#[derive(Debug)]
pub struct Random(Pcg32);

impl Random {
    /// The source of a seed.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self(Pcg32::new(seed, 1))
    }

    /// The next number.
    pub fn unit(&mut self) -> f64 {
        f64::from(self.0.next_u32()) / 4_294_967_296.0
    }
}

/// A point of the ferrule's edge in the direction `turn`, in shares of half its width and thickness.
#[must_use]
pub fn edge(outline: Outline, turn: f64) -> DVec2 {
    let (sine, cosine) = sin_cos(turn);
    match outline {
        Outline::Round => DVec2::new(cosine, sine),
        Outline::Flat => {
            let bulge = |v: f64| powf(v.abs(), 2.0 / FLAT) * v.signum();
            DVec2::new(bulge(cosine), bulge(sine))
        }
    }
}

/// The roots of the strips of a brush whose spines stand at `spines`, in shares of half the
/// ferrule's width and thickness.
#[must_use]
pub fn roots(file: &BrushFile, spines: &[DVec2], random: &mut Random) -> Vec<DVec2> {
    let count = file.strips.count;
    if file.is_line() {
        let place = |i: usize, jitter: f64| 2.0 * (i as f64 + jitter) / count as f64 - 1.0;
        return (0..count)
            .map(|i| DVec2::new(place(i, random.unit()), 0.0))
            .collect();
    }
    let edge = (0..EDGE).map(|i| {
        let turn = 2.0 * std::f64::consts::PI * i as f64 / EDGE as f64;
        edge(file.head.outline, turn)
    });
    let points: Vec<DVec2> = edge.chain(spines.iter().copied()).collect();
    let corners: Vec<Point> = points.iter().map(|p| Point { x: p.x, y: p.y }).collect();
    let triangles = triangulate(&corners).triangles;
    let triangles: Vec<[DVec2; 3]> = triangles
        .chunks_exact(3)
        .map(|t| [points[t[0]], points[t[1]], points[t[2]]])
        .collect();
    if triangles.is_empty() {
        return vec![DVec2::ZERO; count];
    }
    let area = |t: &[DVec2; 3]| (t[1] - t[0]).perp_dot(t[2] - t[0]).abs();
    let mut up_to = Vec::with_capacity(triangles.len());
    let mut whole = 0.0;
    for triangle in &triangles {
        whole += area(triangle);
        up_to.push(whole);
    }
    let start: [f64; 3] = std::array::from_fn(|_| random.unit());
    (0..count)
        .map(|i| {
            let at = |axis: usize| (start[axis] + (i as f64 + 1.0) * EVEN[axis]).fract();
            let chosen = up_to.partition_point(|end| *end < at(0) * whole);
            let [a, b, c] = triangles[chosen.min(triangles.len() - 1)];
            // A point of the square is folded into the triangle.
            let (mut s, mut t) = (at(1), at(2));
            if s + t > 1.0 {
                (s, t) = (1.0 - s, 1.0 - t);
            }
            a + (b - a) * s + (c - a) * t
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(kind: &str) -> Vec<DVec2> {
        let file = BrushFile::library(kind).expect(kind);
        roots(&file, &[DVec2::ZERO], &mut Random::new(7))
    }

    #[test]
    fn they_fill_the_ferrule_evenly() {
        let round = of("round");
        let within = |p: &&DVec2| p.length() < std::f64::consts::FRAC_1_SQRT_2;
        let inner = round.iter().filter(within).count() as f64 / round.len() as f64;
        assert!((inner - 0.5).abs() < 0.04, "half the area: {inner}");
        assert!(round.iter().all(|p| p.length() <= 1.0));
        let flat = of("flat");
        let corner = |p: &&DVec2| p.x.abs() > 0.7 && p.y.abs() > 0.7;
        assert!(flat.iter().filter(corner).count() > flat.len() / 40);
    }

    #[test]
    fn a_thin_ferrule_is_a_line() {
        let blade = of("knife");
        assert!(blade.iter().all(|p| p.y == 0.0 && p.x.abs() <= 1.0));
    }
}
