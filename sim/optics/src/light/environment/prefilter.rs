//! Convolution of surroundings with the lobes of rough paint, by a polar quadrature in the plane of slopes.

use super::{LEVELS, TEXELS, roughness, side};

/// Rings of the quadrature from the viewer to the horizon, its sectors, and rings from the horizon downward.
const RINGS: usize = 64;
const SECTORS: usize = 256;
const BELOW: usize = 16;
/// Rays of a cell of the quadrature either way.
const RAYS: usize = 3;
/// Luminance of linear sRGB.
const LUMA: [f64; 3] = [0.2126, 0.7152, 0.0722];

/// A cell of the quadrature: its middle in paraboloid coordinates, its area there, and its radiance.
struct Cell {
    at: [f64; 2],
    area: f64,
    radiance: [f64; 3],
}

/// Texels of an [`EnvironmentMap`](super::EnvironmentMap); `None` where all is black, negative or not finite.
pub(super) fn texels(radiance: impl Fn([f64; 3]) -> [f64; 3]) -> Option<Vec<[f32; 3]>> {
    let cells = cells(radiance);
    let mean = received(&cells);
    let is_valid = cells
        .iter()
        .all(|cell| cell.radiance.iter().all(|v| *v >= 0.0));
    if !(is_valid && mean.is_finite() && mean > 0.0) {
        return None;
    }
    let mut texels = Vec::with_capacity(TEXELS);
    for level in 0..LEVELS {
        let (side, alpha) = (side(level), roughness(level));
        let step = 2.0 / (side - 1) as f64;
        // Interpolation between texels blurs as well: by a sixth of a step squared along an axis.
        let square = alpha * alpha - step * step / 3.0;
        for texel in 0..side * side {
            let at = [texel % side, texel / side].map(|i| i as f64 * step - 1.0);
            let lobe = lobe(&cells, at, square);
            texels.push(lobe.map(|channel| (channel / mean) as f32));
        }
    }
    Some(texels)
}

/// Mean of the cells under GGX's density of slopes about `at`.
fn lobe(cells: &[Cell], at: [f64; 2], square: f64) -> [f64; 3] {
    let (mut sum, mut all) = ([0.0; 3], 0.0);
    for cell in cells {
        let off = [cell.at[0] - at[0], cell.at[1] - at[1]];
        let tail = 1.0 + (off[0] * off[0] + off[1] * off[1]) / square;
        let weight = cell.area / (tail * tail);
        all += weight;
        for (sum, channel) in sum.iter_mut().zip(cell.radiance) {
            *sum += weight * channel;
        }
    }
    sum.map(|channel| channel / all)
}

/// Mean luminance by the light that a level surface receives.
fn received(cells: &[Cell]) -> f64 {
    let (mut sum, mut all) = (0.0, 0.0);
    for cell in cells {
        let square = cell.at[0] * cell.at[0] + cell.at[1] * cell.at[1];
        // z·dω of a direction, by its paraboloid coordinates.
        let nearness = 1.0 / (1.0 + square);
        let z = (1.0 - square).max(0.0) * nearness;
        let weight = z * 4.0 * nearness * nearness * cell.area;
        let luminance: f64 = cell.radiance.iter().zip(LUMA).map(|(v, own)| v * own).sum();
        (sum, all) = (sum + weight * luminance, all + weight);
    }
    sum / all
}

fn cells(radiance: impl Fn([f64; 3]) -> [f64; 3]) -> Vec<Cell> {
    let step = std::f64::consts::TAU / SECTORS as f64;
    let along = |angle: f64, far: f64| {
        let (sine, cosine) = maulstick_num::sin_cos(angle);
        [far * cosine, far * sine]
    };
    let mut cells = Vec::with_capacity((RINGS + BELOW) * SECTORS);
    for ring in 0..RINGS {
        for sector in 0..SECTORS {
            let ray = |ray: usize| {
                let part = |i: usize| (i as f64 + 0.5) / RAYS as f64;
                let angle = (sector as f64 + part(ray % RAYS)) * step;
                let far = (ring as f64 + part(ray / RAYS)) / RINGS as f64;
                radiance(direction(along(angle, far)))
            };
            let rays: Vec<[f64; 3]> = (0..RAYS * RAYS).map(ray).collect();
            let mean = |c: usize| rays.iter().map(|ray| ray[c]).sum::<f64>() / rays.len() as f64;
            let far = (ring as f64 + 0.5) / RINGS as f64;
            cells.push(Cell {
                at: along((sector as f64 + 0.5) * step, far),
                area: far * step / RINGS as f64,
                radiance: [0, 1, 2].map(mean),
            });
        }
    }
    for ring in 0..BELOW {
        // By 1/far, from the horizon to the steepest slopes.
        let inverse = 1.0 - (ring as f64 + 0.5) / BELOW as f64;
        let far = 1.0 / inverse;
        for sector in 0..SECTORS {
            cells.push(Cell {
                at: along((sector as f64 + 0.5) * step, far),
                area: far * far * far * step / BELOW as f64,
                radiance: cells[(RINGS - 1) * SECTORS + sector].radiance,
            });
        }
    }
    cells
}

/// Unit vector of paraboloid coordinates.
fn direction([x, y]: [f64; 2]) -> [f64; 3] {
    let square = x * x + y * y;
    [2.0 * x, 2.0 * y, 1.0 - square].map(|v| v / (1.0 + square))
}
