//! Draws the bristle strips of a head: thin ribbons, the lower ones first.

use eframe::egui::{Color32, Mesh, Pos2, Vec2, vec2};
use maulstick_brush::HeadPose;
use maulstick_brush::file::sections::Hair;

/// Bristles in the light and in the depth of the tuft, sRGB.
#[must_use]
pub const fn tones(hair: Hair) -> [[f32; 3]; 2] {
    match hair {
        Hair::Hog => [[238.0, 214.0, 170.0], [112.0, 82.0, 52.0]],
        Hair::Sable => [[186.0, 112.0, 66.0], [62.0, 30.0, 18.0]],
        Hair::Badger => [[226.0, 222.0, 214.0], [72.0, 66.0, 62.0]],
        Hair::Steel => [[226.0, 230.0, 235.0], [136.0, 141.0, 148.0]],
    }
}

/// Bristles farther below the middle of the tuft than this, by its radius, are under others.
const UNDER: f32 = -0.5;
/// Half the width of the soft edge of a ribbon, points.
const SOFT: f32 = 0.5;

/// How a head is seen.
pub struct HeadView<'a> {
    /// From the surface's frame to the window.
    pub to_window: &'a dyn Fn([f32; 3]) -> Pos2,
    /// Points a metre.
    pub scale: f32,
    /// Width of a strip, m.
    pub bristle_m: f32,
    /// What they are made of.
    pub hair: Hair,
    /// Bristles in the light and in the depth of the tuft, as the display takes it, 0 to 255.
    pub tones: [[f32; 3]; 2],
    /// Unit vector toward the lamp, surface frame.
    pub toward: [f32; 3],
}

/// The ribbons of all strips of a pose, as one mesh.
#[must_use]
pub fn ribbons(pose: &HeadPose, strips: usize, view: &HeadView<'_>) -> Mesh {
    let mut mesh = Mesh::default();
    if strips == 0 || pose.x.len() < 2 * strips {
        return mesh;
    }
    let stations = pose.x.len() / strips;
    let at = |station: usize, strip: usize| {
        let i = station * strips + strip;
        [pose.x[i], pose.y[i], pose.z[i]]
    };
    let middles: Vec<Middle> = (0..stations)
        .map(|station| Middle::of((0..strips).map(|strip| at(station, strip))))
        .collect();
    let height = |strip: usize| (0..stations).map(|s| at(s, strip)[2]).sum::<f32>();
    let mut order: Vec<usize> = (0..strips).collect();
    order.sort_by(|a, b| height(*a).total_cmp(&height(*b)));
    let half = 0.5 * view.bristle_m * view.scale;
    let cover = (2.0 * half).clamp(0.3, 1.0);
    let columns: &[(f32, f32)] = if half > 2.0 * SOFT {
        &[
            (-half - SOFT, 0.0),
            (SOFT - half, cover),
            (half - SOFT, cover),
            (half + SOFT, 0.0),
        ]
    } else {
        &[(-half - SOFT, 0.0), (0.0, cover), (half + SOFT, 0.0)]
    };
    let width = columns.len() as u32;
    // Of a tuft that stands free the underside is not seen.
    let below = |s: usize, strip: usize| middles[s].height(at(s, strip)) < UNDER;
    order.retain(|strip| (1..stations).any(|station| !below(station, *strip)));
    for strip in order {
        let points: Vec<Pos2> = (0..stations)
            .map(|station| (view.to_window)(at(station, strip)))
            .collect();
        let first = mesh.vertices.len() as u32;
        for station in 0..stations {
            let normal = across(&points, station);
            let along = station as f32 / (stations - 1) as f32;
            let light = middles[station].light(at(station, strip), view.toward);
            let own = match view.hair {
                Hair::Steel => 0.0,
                Hair::Hog | Hair::Sable | Hair::Badger => unruly(strip),
            };
            let colour = shade(view.tones, light, along, own);
            for (reach, alpha) in columns {
                let place = points[station] + normal * *reach;
                mesh.colored_vertex(place, with_alpha(colour, *alpha));
            }
        }
        for station in 0..stations as u32 - 1 {
            for column in 0..width - 1 {
                let a = first + width * station + column;
                mesh.add_triangle(a, a + 1, a + width);
                mesh.add_triangle(a + 1, a + width + 1, a + width);
            }
        }
    }
    mesh
}

/// The tuft at a station: its middle and its radius.
struct Middle {
    at: [f32; 3],
    radius: f32,
}

impl Middle {
    fn of(points: impl Iterator<Item = [f32; 3]> + Clone) -> Self {
        let count = points.clone().count().max(1) as f32;
        let sum = points
            .clone()
            .fold([0.0; 3], |sum, p| [0, 1, 2].map(|i| sum[i] + p[i]));
        let at = sum.map(|v: f32| v / count);
        let far = |p: [f32; 3]| {
            [0, 1, 2]
                .map(|i| (p[i] - at[i]) * (p[i] - at[i]))
                .iter()
                .sum::<f32>()
        };
        let radius = points.map(far).fold(1e-12, f32::max).sqrt();
        Self { at, radius }
    }

    /// How high a point is above the middle, by the radius.
    fn height(&self, p: [f32; 3]) -> f32 {
        (p[2] - self.at[2]) / self.radius
    }

    /// How much light a bristle at `p` gets: the tuft is round, and dark within.
    fn light(&self, p: [f32; 3], toward: [f32; 3]) -> f32 {
        let out = [0, 1, 2].map(|i| (p[i] - self.at[i]) / self.radius);
        let facing: f32 = (0..3).map(|i| out[i] * toward[i]).sum();
        (0.5 + 0.5 * facing).clamp(0.0, 1.0)
    }
}

/// The unit vector across a line at one of its points.
fn across(points: &[Pos2], i: usize) -> Vec2 {
    let ahead = points[(i + 1).min(points.len() - 1)] - points[i.saturating_sub(1)];
    let length = ahead.length();
    if length > 1e-3 {
        vec2(-ahead.y, ahead.x) / length
    } else {
        vec2(1.0, 0.0)
    }
}

/// A bristle's own shade, −½ to ½ (Weyl's sequence: evenly spread, the same each time).
fn unruly(strip: usize) -> f32 {
    (strip as f32 * 0.618_034).fract() - 0.5
}

/// The colour in `light` 0 to 1 at a place along a bristle, whose tip is flagged and lighter.
fn shade([bright, dark]: [[f32; 3]; 2], light: f32, along: f32, own: f32) -> [f32; 3] {
    let t = (light * (0.85 + 0.15 * along) + 0.22 * own).clamp(0.0, 1.0);
    std::array::from_fn(|i| dark[i] + (bright[i] - dark[i]) * t)
}

fn with_alpha(colour: [f32; 3], alpha: f32) -> Color32 {
    let [r, g, b] = colour.map(|channel| channel as u8);
    Color32::from_rgba_unmultiplied(r, g, b, (255.0 * alpha) as u8)
}

#[cfg(test)]
mod tests {
    use eframe::egui::pos2;

    use super::*;

    /// Two strips that lie beside each other along x, 1 mm apart, the second one higher.
    fn pose() -> HeadPose {
        HeadPose {
            x: vec![0.0, 0.0, 0.01, 0.01, 0.02, 0.02],
            y: vec![0.0, 1e-3, 0.0, 1e-3, 0.0, 1e-3],
            z: vec![0.0, 2e-4, 0.0, 2e-4, 0.0, 2e-4],
            ..HeadPose::default()
        }
    }

    fn drawn(pose: &HeadPose, toward: [f32; 3]) -> Mesh {
        let to_window = |[x, y, _]: [f32; 3]| pos2(1000.0 * x, -1000.0 * y);
        let view = HeadView {
            to_window: &to_window,
            scale: 1000.0,
            bristle_m: 4e-3,
            hair: Hair::Hog,
            tones: tones(Hair::Hog),
            toward,
        };
        ribbons(pose, 2, &view)
    }

    #[test]
    fn ribbons_follow_the_strips_the_lower_first_with_soft_edges() {
        let mesh = drawn(&pose(), [0.0, 0.0, 1.0]);
        assert_eq!((mesh.vertices.len(), mesh.indices.len()), (24, 72));
        assert!(mesh.is_valid());
        let middle = |from: usize| {
            let row = &mesh.vertices[from..from + 4];
            row.iter().map(|v| v.pos.y).sum::<f32>() / 4.0
        };
        assert!(middle(0).abs() < 1e-3 && (middle(12) + 1.0).abs() < 1e-3);
        for row in mesh.vertices.chunks(4) {
            assert!(row[0].color.a() == 0 && row[3].color.a() == 0 && row[1].color.a() > 50);
        }
        assert_eq!(
            drawn(&HeadPose::default(), [0.0, 0.0, 1.0]),
            Mesh::default()
        );
    }

    #[test]
    fn the_side_toward_the_lamp_is_lighter() {
        let lightness = |toward: [f32; 3], strip: usize| {
            let mesh = drawn(&pose(), toward);
            u32::from(mesh.vertices[12 * strip + 1].color.r())
        };
        let difference =
            |toward: [f32; 3]| i64::from(lightness(toward, 1)) - i64::from(lightness(toward, 0));
        let (far, near) = (difference([0.0, -0.7, 0.7]), difference([0.0, 0.7, 0.7]));
        assert!(near > far + 40, "{near} {far}");
    }
}
