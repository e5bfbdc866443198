//! Light on a relief: what a lamp makes of unlit colour, gloss and height.
//!
//! One definition for the export and the view, whose shader holds the same terms
//! (`ui/src/shaders/light_surface.wgsl`). With the surface z = ρ·h(x, y), ρ the strength of the
//! relief, its normal n = (−ρ·∂h/∂x, −ρ·∂h/∂y, 1)/|…|, the unit vector l toward the lamp, the viewer
//! straight above at v = (0, 0, 1), and the half vector b = (l + v)/|l + v|:
//!
//! ```text
//! incidence i = V·max(n·l, 0)/l_z
//! diffuse   d = a + (1 − a)·i
//! lobe      λ(m) = (m + 8)/8·max((n·b)^m − b_z^m, 0)
//! highlight s = F(l·b)·(g²·λ(64) + g·(1 − g)·λ(8))·i
//! lit         = E·(d·unlit + w·(k₁ + s))
//! ```
//!
//! d is Lambert's law with a share a of light from all around. V is the share of the lamp that the
//! relief does not hide ([`shadow`]). λ is the lobe of Blinn (1977, *Models of light reflection for
//! computer synthesized pictures*), normalised as in Akenine-Möller, Haines and Hoffman 2008
//! (*Real-Time Rendering*, § 7.6); the gloss g moves the reflection from the broad lobe of a dull film
//! into the sharp one of a wet film, and F is Fresnel's share of it ([`fresnel`]). The highlight has
//! the colour w of the light, white to an adapted eye (Baxter 2004, § 7.8.2). The films' colour leaves
//! the surface's own reflection k₁ out; here it is added, once. d and s are relative to a flat surface,
//! which so looks as a spectrometer reads it, gloss included, times E, wherever the lamp stands, and does
//! not change when its gloss dries away.

mod fresnel;
mod relief;
pub mod shadow;

pub use fresnel::fresnel;
pub use relief::HeightField;

use crate::surface::SurfaceCorrection;

/// Share a of the light that comes from all around.
pub const AMBIENT: f32 = 0.25;
/// Exponents m of the sharp and of the broad highlight, as powers of two: 2⁶ and 2³.
pub const SHARPNESS: [u32; 2] = [6, 3];
/// k₁, the share of the light that a surface reflects by itself.
pub const SURFACE: f32 = SurfaceCorrection::STANDARD.k1 as f32;
/// The lowest lamp, as the z of its direction: below it a flat surface would hardly be lit, and
/// everything relative to it would have no bound.
pub const LOWEST: f64 = 0.1;
/// The brightest that [`starting_exposure`] lets a ground be.
pub const BARE: f64 = 0.98;

/// What a lamp is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LampSetup {
    /// Toward it, of any length, in the frame of the surface. A lamp lower than [`LOWEST`] is raised
    /// to it; a direction that is none means straight above.
    pub toward: [f64; 3],
    /// Factor on the light's strength, 0 or more.
    pub intensity: f64,
    /// Factor of the eye that looks at it, 0 or more.
    pub exposure: f64,
    /// Factor ρ on the heights of the relief, 0 or more.
    pub relief: f64,
    /// Tangent of half the angle under which the lamp is seen: how soft shadows are, 0 or more.
    pub softness: f64,
    /// w, the light's own colour, linear.
    pub colour: [f64; 3],
}

impl Default for LampSetup {
    /// Straight above.
    fn default() -> Self {
        Self {
            toward: [0.0, 0.0, 1.0],
            intensity: 1.0,
            exposure: 1.0,
            relief: 1.0,
            softness: 0.1,
            colour: [1.0; 3],
        }
    }
}

/// A lamp, far away.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lamp {
    /// Unit vector l toward it, in the frame of the surface.
    pub toward: [f32; 3],
    /// Unit half vector b between it and the viewer.
    pub half: [f32; 3],
    /// E: its strength and the exposure.
    pub intensity: f32,
    /// ρ.
    pub relief: f32,
    /// F·(m + 8)/8 of the sharp and the broad lobe.
    pub peak: [f32; 2],
    /// b_z^m of both: the lobes of a flat surface, which are left out.
    pub flat: [f32; 2],
    /// Tangent of half the angle under which it is seen.
    pub softness: f32,
    /// w.
    pub colour: [f32; 3],
}

impl Lamp {
    /// A lamp; numbers of `setup` that are none are those of the default.
    #[must_use]
    pub fn new(setup: &LampSetup) -> Self {
        let or = |value: f64, default: f64| match value.is_finite() {
            true => value.max(0.0),
            false => default,
        };
        let default = LampSetup::default();
        let l = raised(setup.toward);
        let b = unit([l[0], l[1], l[2] + 1.0]);
        let half = b.map(|v| v as f32);
        // A viewer straight above sees at b the angle under which the lamp's light falls on b.
        let share = fresnel(SurfaceCorrection::default().k1, b[2]);
        let intensity = or(setup.intensity, default.intensity);
        Self {
            toward: l.map(|v| v as f32),
            half,
            intensity: (intensity * or(setup.exposure, default.exposure)) as f32,
            relief: or(setup.relief, default.relief) as f32,
            peak: SHARPNESS.map(|m| (share * (f64::from(1u32 << m) + 8.0) / 8.0) as f32),
            flat: SHARPNESS.map(|m| sharpened(half[2], m)),
            softness: or(setup.softness, default.softness) as f32,
            colour: setup.colour.map(|v| v as f32),
        }
    }
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

/// x to the power 2^`squarings`; 0 for x < 0.
fn sharpened(x: f32, squarings: u32) -> f32 {
    let mut power = x.max(0.0);
    for _ in 0..squarings {
        power *= power;
    }
    power
}

/// A point of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// Linear colour before light, without k₁.
    pub unlit: [f32; 3],
    /// g, 0 to 1.
    pub gloss: f32,
    /// ∂h/∂x and ∂h/∂y.
    pub slope: [f32; 2],
    /// V, 0 to 1: [`shadow::Shadows`] tells it.
    pub seen: f32,
}

/// What `lamp` makes of a point.
#[must_use]
pub fn lit(spot: &Spot, lamp: &Lamp) -> [f32; 3] {
    let slope = spot.slope.map(|rise| rise * lamp.relief);
    let length = (slope[0] * slope[0] + slope[1] * slope[1] + 1.0).sqrt();
    let n = [-slope[0] / length, -slope[1] / length, 1.0 / length];
    let along = |v: &[f32; 3]| n[0] * v[0] + n[1] * v[1] + n[2] * v[2];
    let incidence = spot.seen * along(&lamp.toward).max(0.0) / lamp.toward[2];
    let diffuse = AMBIENT + (1.0 - AMBIENT) * incidence;
    let facing = along(&lamp.half);
    let lobe = |i: usize| lamp.peak[i] * (sharpened(facing, SHARPNESS[i]) - lamp.flat[i]).max(0.0);
    let gloss = spot.gloss;
    let highlight = (gloss * gloss * lobe(0) + gloss * (1.0 - gloss) * lobe(1)) * incidence;
    let shine = SURFACE + highlight;
    [0, 1, 2].map(|i| (diffuse * spot.unlit[i] + lamp.colour[i] * shine) * lamp.intensity)
}

/// Gloss g of oil paint: `wetness` leads from .3, an eggshell of dry paint, to .75, stiff paint from
/// the tube, whose pigment roughens the surface; the share of thinner in it leads either to 1, a level
/// film. Both 0 to 1.
#[must_use]
pub fn gloss(thinner_share: f32, wetness: f32) -> f32 {
    let own = 0.3 + (0.75 - 0.3) * wetness.clamp(0.0, 1.0);
    own + (1.0 - own) * thinner_share.clamp(0.0, 1.0)
}

/// The exposure with which a painting begins: the largest, of at most 1, under which no channel of the
/// bare ground is brighter than [`BARE`] in light of this intensity. 1 where that is no number.
#[must_use]
pub fn starting_exposure(ground_rgb: [f64; 3], intensity: f64) -> f64 {
    let brightest = ground_rgb.into_iter().fold(0.0, f64::max) * intensity;
    if brightest > BARE {
        BARE / brightest
    } else {
        1.0
    }
}

#[cfg(test)]
mod tests;
