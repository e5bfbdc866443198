//! Light on a relief: shading of unlit colour, gloss and height under a lamp.
//!
//! One definition for the export and the view, whose shader has the same terms
//! (`ui/src/render/shaders/light_surface.wgsl`). With the surface z = ρ·h(x, y), ρ the strength of the relief, its
//! slope s = ρ·∇h and normal n = (−s, 1)/|…|, the unit vector l toward the middle of the lamp, the unit vector m at a
//! right angle to it and higher, the viewer straight above at v = (0, 0, 1), and the half vector b = (l + v)/|l + v|:
//!
//! ```text
//! incidence i = V·max(n·l + (1 − V)·w·n·m, 0)/l_z
//! diffuse   d = (1 − a)·i + a·v + (B(v, c) − v)
//! room      r = F₀(n_z)·O·L(s),   O = v²
//! even      L = 1 − e + e·(2n_z² − 1)
//! window    t = V·(1 − a)·F(l·b)·max(π·P(s)·G − π·P₀·G, 0)/(4·b_z⁴·l_z)
//! lit         = E·(d·unlit + w·(r + t))
//! ```
//!
//! The lamp is as broad as a window: V is its share that the relief does not hide ([`shadow`]); a half-hidden lamp
//! shows its upper half, hence the term with m. A share a of the light is ambient; v is the share of it that a place
//! receives, and B includes the light reflected by its surroundings, of its own colour c ([`sky`]): hollows of white
//! paint are bright, those of red paint glow, and no shadow is black. The gloss mirrors its surroundings, an even
//! room that is dimmer lower down or an [`environment`], and the lamp through microfacets ([`mod@gloss`]) whose slopes include those that a cell does not resolve. P₀
//! is the mirrored lamp in a level surface of the same roughness. The highlights have the colour w of the light, white
//! to an adapted eye (Baxter 2004, § 7.8.2).
//!
//! The films' colour leaves the surface's own reflection k₁ out; here it is added, once, as that of
//! Fresnel at normal incidence (Schlick 1994). All terms are relative to a flat open surface, where
//! i = v = B = 1 and, in an even room, r + t = k₁: it looks as a spectrometer reads it, gloss included, times E, wherever
//! the lamp stands, and does not change when its gloss dries away. Before an environment it does: a glossy surface mirrors
//! the viewer's dim side of the room and looks deep, a matt one scatters all of its light.

pub mod environment;
mod facet;
mod fresnel;
pub mod gloss;
mod relief;
pub mod shadow;
pub mod sky;

use std::sync::Arc;

pub use environment::EnvironmentMap;
pub use facet::{Facet, Surroundings};
pub use fresnel::fresnel;
pub use gloss::gloss;
pub use relief::HeightField;

use crate::surface::SurfaceCorrection;

/// Ambient share a of the light where nothing is hidden.
pub const AMBIENT: f32 = 0.3125;
/// Dimming e of the room at the level of the canvas relative to that above it.
pub const DIMMING: f32 = 0.5;
/// Share k₁ of the light that a surface itself reflects.
pub const SURFACE: f32 = SurfaceCorrection::STANDARD.k1 as f32;
/// The lowest lamp, as the z of its direction: below it a flat surface would hardly be lit, and
/// everything relative to it would have no bound.
pub const LOWEST_LAMP: f64 = 0.1;
/// Largest radius of a low lamp by its height, so that it never sets for a flat surface.
const SET: f64 = 0.95;
/// Least albedo of the light itself by which colours are divided.
const LEAST_ALBEDO: f64 = 1e-3;
/// The brightest that [`starting_exposure`] lets a ground be.
pub const BARE: f64 = 0.98;

/// Parameters of a lamp.
#[derive(Clone, Debug, PartialEq)]
pub struct LampSetup {
    /// Toward it, of any length, in the frame of the surface. A lamp lower than [`LOWEST_LAMP`] is raised
    /// to it; a direction that is none means straight above.
    pub toward: [f64; 3],
    /// Factor on the light's strength, 0 or more.
    pub intensity: f64,
    /// Factor of the eye that looks at it, 0 or more.
    pub exposure: f64,
    /// Factor ρ on the heights of the relief, 0 or more.
    pub relief: f64,
    /// Tangent of half the angle of the lamp, the softness of shadows, 0 or more.
    pub softness: f64,
    /// w, the light's own colour, linear.
    pub colour: [f64; 3],
    /// What the gloss mirrors besides; `None` for an even room.
    pub environment: Option<Arc<EnvironmentMap>>,
}

impl Default for LampSetup {
    fn default() -> Self {
        Self {
            toward: [0.0, 0.0, 1.0],
            intensity: 1.0,
            exposure: 1.0,
            relief: 1.0,
            softness: 0.3,
            colour: [1.0; 3],
            environment: None,
        }
    }
}

/// A lamp, far away, and what is around.
#[derive(Clone, Debug, PartialEq)]
pub struct Lamp {
    /// Unit vector l toward it, in the frame of the surface.
    pub toward: [f32; 3],
    /// w·m: from its middle to its upper edge.
    pub upper: [f32; 3],
    /// E: its strength and the exposure.
    pub intensity: f32,
    /// ρ.
    pub relief: f32,
    /// h̃, the slope that mirrors its middle to the viewer.
    pub mirror: [f32; 2],
    /// (1 − a)·F/(4·b_z⁴·l_z).
    pub peak: f32,
    /// tan²θ_l.
    pub graze: f32,
    /// Tangent w of half the angle of the lamp.
    pub softness: f32,
    /// w, its colour.
    pub colour: [f32; 3],
    /// Factor from an unlit colour to an albedo.
    pub albedo: [f32; 3],
    /// What the gloss mirrors besides; `None` for an even room.
    pub environment: Option<Arc<EnvironmentMap>>,
}

impl Lamp {
    /// A lamp; numbers of `setup` that are not finite are those of the default.
    #[must_use]
    pub fn new(setup: &LampSetup) -> Self {
        let or = |value: f64, default: f64| {
            if value.is_finite() {
                value.max(0.0)
            } else {
                default
            }
        };
        let default = LampSetup::default();
        let l = raised(setup.toward);
        let b = unit([l[0], l[1], l[2] + 1.0]);
        // A viewer straight above sees at b the angle under which the lamp's light falls on b.
        let share = fresnel(SurfaceCorrection::default().k1, b[2]);
        let intensity = or(setup.intensity, default.intensity);
        let across = (l[0] * l[0] + l[1] * l[1]).sqrt();
        let softness = or(setup.softness, default.softness).min(SET * l[2] / across.max(1e-6));
        // Straight above, any direction will do.
        let away = if across > 1e-6 {
            [-l[0] / across, -l[1] / across]
        } else {
            [0.0; 2]
        };
        let upper = [away[0] * l[2], away[1] * l[2], across].map(|v| v * softness);
        let square = b[2] * b[2];
        let peak = (1.0 - f64::from(AMBIENT)) * share / (4.0 * square * square * l[2]);
        Self {
            toward: l.map(|v| v as f32),
            upper: upper.map(|v| v as f32),
            intensity: (intensity * or(setup.exposure, default.exposure)) as f32,
            relief: or(setup.relief, default.relief) as f32,
            mirror: [-b[0] / b[2], -b[1] / b[2]].map(|v| v as f32),
            peak: peak as f32,
            graze: ((1.0 - l[2] * l[2]) / (l[2] * l[2])) as f32,
            softness: softness as f32,
            colour: setup.colour.map(|v| v as f32),
            albedo: setup.colour.map(|v| (1.0 / v.max(LEAST_ALBEDO)) as f32),
            environment: setup.environment.clone(),
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
    if l[2] >= LOWEST_LAMP {
        return l;
    }
    if across < 1e-9 {
        return [0.0, 0.0, 1.0];
    }
    let scale = (1.0 - LOWEST_LAMP * LOWEST_LAMP).sqrt() / across;
    [l[0] * scale, l[1] * scale, LOWEST_LAMP]
}

/// A point of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// Linear colour before light, without k₁.
    pub unlit: [f32; 3],
    /// g, 0 to 1.
    pub gloss: f32,
    /// Its facet.
    pub facet: Facet,
}

/// Unit normal of a surface of this slope.
#[must_use]
pub fn normal(slope: [f32; 2]) -> [f32; 3] {
    let length = (slope[0] * slope[0] + slope[1] * slope[1] + 1.0).sqrt();
    [-slope[0] / length, -slope[1] / length, 1.0 / length]
}

/// Colour of a point under `lamp`.
#[must_use]
pub fn lit(spot: &Spot, lamp: &Lamp) -> [f32; 3] {
    let Facet {
        slope,
        spread,
        seen,
        open,
    } = spot.facet;
    let n = normal(slope);
    let along = |v: &[f32; 3]| n[0] * v[0] + n[1] * v[1] + n[2] * v[2];
    let facing = along(&lamp.toward) + (1.0 - seen) * along(&lamp.upper);
    let incidence = seen * facing.max(0.0) / lamp.toward[2];
    let direct = (1.0 - AMBIENT) * incidence + AMBIENT * open;
    let off = [lamp.mirror[0] - slope[0], lamp.mirror[1] - slope[1]];
    let rough = gloss::roughness(spot.gloss);
    let square = rough * rough;
    let own = square + 0.125 * lamp.softness * lamp.softness;
    let level = gloss::density(own, [0.0; 3], lamp.mirror);
    let more = (gloss::density(own, spread, off) - level).max(0.0);
    let window = seen * lamp.peak * gloss::unmasked(square, lamp.graze) * more;
    let grazing = 1.0 - n[2];
    let twice = grazing * grazing;
    let mirrored = SURFACE + (1.0 - SURFACE) * twice * twice * grazing;
    let around = match &lamp.environment {
        None => [1.0 - DIMMING + DIMMING * (2.0 * n[2] * n[2] - 1.0); 3],
        Some(map) => map.mirrored(slope, (square + spread[0] + spread[2]).sqrt()),
    };
    let room = around.map(|light| mirrored * open * open * light);
    [0, 1, 2].map(|i| {
        let albedo = (spot.unlit[i] * lamp.albedo[i]).clamp(0.0, 1.0);
        let diffuse = direct + (sky::bounced(open, albedo) - open);
        (diffuse * spot.unlit[i] + lamp.colour[i] * (room[i] + window)) * lamp.intensity
    })
}

/// The initial exposure of a painting: the largest, of at most 1, under which no channel of the bare ground is brighter
/// than [`BARE`] in light of this intensity. 1 where that is NaN.
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
