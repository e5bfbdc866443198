//! Light on a relief: what a lamp makes of unlit colour, gloss and height.
//!
//! One definition for the export and the view, whose shader holds the same terms
//! (`ui/src/shaders/light_surface.wgsl`). With the surface z = h(x, y), its normal
//! n = (−∂h/∂x, −∂h/∂y, 1)/|…|, the unit vector l toward the lamp, the viewer straight above at
//! v = (0, 0, 1), and the half vector b = (l + v)/|l + v|:
//!
//! ```text
//! diffuse   d = a + (1 − a)·max(n·l, 0)/l_z
//! highlight s = g·k₁·(m + 8)/8·max((n·b)^m − b_z^m, 0)·max(n·l, 0)/l_z
//! lit         = E·(d·unlit + s)
//! ```
//!
//! d is Lambert's law with a share a of light from all around. s is the lobe of Blinn (1977, *Models
//! of light reflection for computer synthesized pictures*), normalised so that it reflects the share
//! k₁ at normal incidence (Akenine-Möller, Haines and Hoffman 2008, *Real-Time Rendering*, § 7.6);
//! g is the gloss. Both are relative to a flat surface, whose own reflection of the lamp is left out
//! as a spectrometer leaves it out: a flat surface keeps its unlit colour exactly, times E.

use crate::surface::SurfaceCorrection;

/// Share a of the light that comes from all around.
pub const AMBIENT: f32 = 0.25;
/// Exponent m of the highlight, as a power of two: 2⁶.
pub const SHARPNESS: u32 = 6;
/// The lowest lamp, as the z of its direction: below it a flat surface would hardly be lit, and
/// everything relative to it would have no bound.
pub const LOWEST: f64 = 0.1;

/// A lamp, far away.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lamp {
    /// Unit vector l toward it, in the frame of the surface.
    pub toward: [f32; 3],
    /// Unit half vector b between it and the viewer.
    pub half: [f32; 3],
    /// Factor E on the light's strength.
    pub intensity: f32,
    /// k₁·(m + 8)/8: the highlight where n = b, before the angle of incidence.
    pub peak: f32,
    /// b_z^m: the lobe of a flat surface, which is left out.
    pub flat: f32,
}

impl Lamp {
    /// A lamp in the direction `toward`, of any length. One lower than [`LOWEST`] is raised to it;
    /// a direction that is none means straight above, and so does an intensity that is none mean 1.
    #[must_use]
    pub fn new(toward: [f64; 3], intensity: f64) -> Self {
        let l = raised(toward);
        let b = unit([l[0], l[1], l[2] + 1.0]);
        let half = b.map(|v| v as f32);
        let lobe = f32::from(1u16 << SHARPNESS);
        let intensity = if intensity.is_finite() {
            intensity.max(0.0)
        } else {
            1.0
        };
        Self {
            toward: l.map(|v| v as f32),
            half,
            intensity: intensity as f32,
            peak: SurfaceCorrection::default().k1 as f32 * (lobe + 8.0) / 8.0,
            flat: sharpened(half[2]),
        }
    }
}

/// Exposure.
#[must_use]
pub fn starting_exposure(ground: [f64; 3], intensity: f64) -> f64 {
    let most = ground.iter().copied().fold(0.0, f64::max) * intensity;
    if most > 0.98 { 0.98 / most } else { 1.0 }
}

/// Gloss.
#[must_use]
pub fn gloss(thinner: f32, wetness: f32) -> f32 {
    let base = 0.3 + 0.45 * wetness;
    base + (1.0 - base) * thinner
}

fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
    v.map(|x| x / length)
}

fn raised(toward: [f64; 3]) -> [f64; 3] {
    let l = unit(toward);
    if !l.iter().all(|v| v.is_finite()) {
        return [0.0, 0.0, 1.0];
    }
    let across = (l[0] * l[0] + l[1] * l[1]).sqrt();
    if l[2] >= LOWEST {
        return l;
    }
    if across < 1e-9 {
        return [0.0, 0.0, 1.0];
    }
    let scale = (1.0 - LOWEST * LOWEST).sqrt() / across;
    [l[0] * scale, l[1] * scale, LOWEST]
}

/// x^m by squaring; 0 for x < 0.
fn sharpened(x: f32) -> f32 {
    let mut power = x.max(0.0);
    for _ in 0..SHARPNESS {
        power *= power;
    }
    power
}

/// A plane of heights.
#[derive(Clone, Copy, Debug)]
pub struct HeightField<'a> {
    /// m, row after row from the lowest.
    pub heights: &'a [f32],
    /// Cells across and up.
    pub cells: [usize; 2],
    /// Side of a cell, m.
    pub cell_m: f32,
}

impl HeightField<'_> {
    /// ∂h/∂x and ∂h/∂y at a cell: central differences, one-sided at the border, 0 where the plane
    /// is one cell wide.
    #[must_use]
    pub fn slope(&self, x: usize, y: usize) -> [f32; 2] {
        let [width, height] = self.cells;
        let (left, right) = (x.saturating_sub(1), (x + 1).min(width - 1));
        let (below, above) = (y.saturating_sub(1), (y + 1).min(height - 1));
        let at = |x: usize, y: usize| self.heights[y * width + x];
        let span = |cells: usize| cells.max(1) as f32 * self.cell_m;
        [
            (at(right, y) - at(left, y)) / span(right - left),
            (at(x, above) - at(x, below)) / span(above - below),
        ]
    }
}

/// What `lamp` makes of a point of linear colour `unlit`, without k₁, and of `gloss` 0 to 1, where
/// the surface rises by `slope` (∂h/∂x, ∂h/∂y).
#[must_use]
pub fn lit(unlit: [f32; 3], gloss: f32, slope: [f32; 2], lamp: &Lamp) -> [f32; 3] {
    let length = (slope[0] * slope[0] + slope[1] * slope[1] + 1.0).sqrt();
    let n = [-slope[0] / length, -slope[1] / length, 1.0 / length];
    let along = |v: &[f32; 3]| n[0] * v[0] + n[1] * v[1] + n[2] * v[2];
    let incidence = along(&lamp.toward).max(0.0) / lamp.toward[2];
    let diffuse = AMBIENT + (1.0 - AMBIENT) * incidence;
    let lobe = (sharpened(along(&lamp.half)) - lamp.flat).max(0.0);
    let highlight = gloss * lamp.peak * lobe * incidence;
    unlit.map(|channel| (diffuse * channel + highlight) * lamp.intensity)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const GREY: [f32; 3] = [0.2, 0.2, 0.2];

    /// From the upper left, as on most desks.
    fn upper_left() -> Lamp {
        Lamp::new([-0.5, 0.5, 0.5f64.sqrt()], 1.0)
    }

    /// Light on the two flanks of a ridge that runs up, left flank first.
    fn ridge(light: impl Fn([f32; 3], f32, [f32; 2], &Lamp) -> [f32; 3]) -> [f32; 2] {
        let heights: Vec<f32> = (0..9)
            .map(|x: i32| 1e-4 * (4 - (x - 4).abs()) as f32)
            .collect();
        let field = HeightField {
            heights: &heights,
            cells: [9, 1],
            cell_m: 2.5e-4,
        };
        [2, 6].map(|x| light(GREY, 1.0, field.slope(x, 0), &upper_left())[0])
    }

    fn is_lit_from_the_left([left, right]: [f32; 2]) -> bool {
        left > 1.1 * GREY[0] && right < 0.9 * GREY[0]
    }

    #[test]
    fn a_ridge_is_brighter_on_the_lamps_side_and_darker_on_the_other() {
        assert!(is_lit_from_the_left(ridge(lit)), "{:?}", ridge(lit));
        let turned = |unlit, gloss, slope: [f32; 2], lamp: &Lamp| {
            lit(unlit, gloss, slope.map(|rise| -rise), lamp)
        };
        assert!(!is_lit_from_the_left(ridge(turned)), "a fault would pass");
    }

    #[test]
    fn gloss_shines_most_where_the_normal_halves_the_angle_to_the_lamp() {
        let lamp = upper_left();
        let shine = |slope: f32| lit([0.0; 3], 1.0, [slope, -slope], &lamp)[0];
        let half = lamp.half[0] / -lamp.half[2];
        let steps = (0..2000).map(|i| i as f32 * 1e-3 - 1.0);
        let best = steps
            .max_by(|a, b| shine(*a).total_cmp(&shine(*b)))
            .expect("one");
        // The angle of incidence draws the maximum a little toward the lamp.
        assert!((best - half).abs() < 0.03, "{best} for {half}");
        assert!(shine(best) > 0.2 && shine(best) < 1.0, "{}", shine(best));
        assert_eq!(lit([0.0; 3], 0.0, [best, -best], &lamp), [0.0; 3]);
    }

    #[test]
    fn heights_beyond_the_border_are_not_guessed() {
        let heights = [0.0, 1.0, 3.0, 0.0, 1.0, 3.0];
        let field = HeightField {
            heights: &heights,
            cells: [3, 2],
            cell_m: 2.0,
        };
        let rises = [0, 1, 2].map(|x| field.slope(x, 0)[0]);
        assert_eq!(rises, [0.5, 0.75, 1.0]);
        let one = HeightField {
            heights: &heights[..1],
            cells: [1, 1],
            cell_m: 2.0,
        };
        assert_eq!(one.slope(0, 0), [0.0; 2]);
    }

    #[test]
    fn lamps_that_are_none_still_shine() {
        let above = Lamp::new([0.0, 0.0, 1.0], 1.0);
        for toward in [[0.0; 3], [f64::NAN, 0.0, 1.0], [0.0, 0.0, -1.0]] {
            assert_eq!(Lamp::new(toward, f64::NAN), above);
        }
        let low = Lamp::new([1.0, 0.0, -1.0], -1.0);
        assert_eq!((low.toward[2], low.intensity), (LOWEST as f32, 0.0));
        assert!((low.toward[0] * low.toward[0] + 0.01 - 1.0).abs() < 1e-6);
    }

    proptest! {
        #[test]
        fn a_flat_surface_keeps_its_unlit_colour(
            unlit in prop::array::uniform3(-0.2f32..1.5),
            gloss in 0.0f32..=1.0,
            toward in prop::array::uniform3(-1.0..1.0f64),
        ) {
            prop_assert_eq!(lit(unlit, gloss, [0.0; 2], &Lamp::new(toward, 1.0)), unlit);
            prop_assert!(lit(unlit, gloss, [0.1, 0.0], &Lamp::new([0.0, 0.0, 1.0], 1.0)) != unlit);
        }

        #[test]
        fn mirrored_light_mirrors(
            slope in prop::array::uniform2(-3.0f32..3.0),
            toward in prop::array::uniform3(-1.0..1.0f64),
        ) {
            let [x, y, z] = toward;
            let one = lit(GREY, 1.0, slope, &Lamp::new(toward, 0.8));
            let other = lit(GREY, 1.0, [-slope[0], slope[1]], &Lamp::new([-x, y, z], 0.8));
            prop_assert_eq!(one, other);
        }

        #[test]
        fn no_slope_breaks_the_light(slope in prop::array::uniform2(-1e4f32..1e4)) {
            let out = lit(GREY, 1.0, slope, &upper_left());
            prop_assert!(out.iter().all(|v| v.is_finite() && *v >= AMBIENT * GREY[0] * 0.999));
        }
    }
}
