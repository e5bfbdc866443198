//! Bristles of a head: thin ribbons, the lower ones first, each lit as hair and coloured by its paint.

use eframe::egui::{Mesh, Pos2, Vec2, vec2};
use glam::Vec3;
use maulstick_brush::HeadPose;
use maulstick_brush::file::sections::Hair;

use crate::render::brush::paint_colour::PaintColour;
use crate::render::view_light::{ViewLight, smoothstep};

/// Bristles in the light, and how dark those in the depth of the tuft are, sRGB.
#[must_use]
pub(crate) const fn tones(hair: Hair) -> [[f32; 3]; 2] {
    let dark = match hair {
        Hair::Hog => [112.0, 82.0, 52.0],
        Hair::Sable => [62.0, 30.0, 18.0],
        Hair::Badger => [72.0, 66.0, 62.0],
        Hair::Steel => [136.0, 141.0, 148.0],
    };
    [hair.srgb(), dark]
}

/// Bristles farther below the middle of the tuft than this, by its radius, are under others.
const UNDER: f32 = -0.5;
/// Half the width of the soft edge of a ribbon, points.
const SOFT: f32 = 0.5;
/// From this half width on, points, a ribbon shows several hairs.
const HAIRS: f32 = 2.5;
/// Ribbons a point of the head's width: where more bristles stand there, some are drawn for all.
const DENSITY: f32 = 3.0;
/// Fewest ribbons of a head.
const FEWEST: usize = 48;
/// A head shorter than this, points, bends at every second station.
const SHORT: f32 = 90.0;
/// Opacity of the very point of a ribbon, and how much of it is left to a dry brush's splitting.
const POINT: f32 = 0.55;
/// The share of a full film from which paint hides the play of light in the hair.
const HIDES: f32 = 0.3;

/// Appearance of the bristles of a head.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bristles<'a> {
    /// Width of a strip at its root, m, and the share of it that is lost up to the point.
    pub width_m: f32,
    /// See `width_m`.
    pub taper: f32,
    pub hair: Hair,
    /// Linear light of bristles in the light and in the depth of the tuft, as the display takes it.
    pub tones: [Vec3; 2],
    /// The paint on them, if it is known.
    pub coat: Option<&'a PaintColour>,
}

/// The ribbons of a pose with this number of strips, as one mesh.
#[must_use]
pub(crate) fn ribbons(
    pose: &HeadPose,
    strips: usize,
    bristles: &Bristles<'_>,
    sight: &ViewLight<'_>,
) -> Mesh {
    let mut mesh = Mesh::default();
    if strips == 0 || pose.x.len() < 2 * strips {
        return mesh;
    }
    let tuft = Tuft::of(pose, strips, sight);
    let some = tuft.some(sight);
    let kept = tuft.kept(some, sight);
    // Fewer ribbons are wider ones.
    let wider = (strips as f32 / some as f32).sqrt();
    let half = 0.5 * bristles.width_m * sight.scale * wider;
    let columns = columns(half);
    let mut segments = Vec::with_capacity(kept.len() * tuft.middles.len());
    for strip in kept {
        let first = mesh.vertices.len() as u32;
        let row = columns.len() as u32;
        let points: Vec<Pos2> = tuft.line(strip).map(|p| (sight.to_window)(p)).collect();
        for (i, point) in points.iter().enumerate() {
            let along = tuft.along(i);
            let colour = tuft.colour(strip, i, bristles, sight);
            let across = across(&points, i);
            let narrow = 1.0 - bristles.taper * along;
            let fade = if i + 1 == points.len() { POINT } else { 1.0 };
            for (column, (reach, soft, cover)) in columns.iter().enumerate() {
                let place = *point + across * (reach * narrow + soft);
                let shade = hair_shade(strip, column, columns.len());
                mesh.colored_vertex(place, sight.vertex(colour * shade, cover * fade));
            }
        }
        for i in 1..points.len() {
            let height = tuft.height(strip, i - 1) + tuft.height(strip, i);
            segments.push((height, first + row * (i as u32 - 1)));
        }
    }
    segments.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    let row = columns.len() as u32;
    for (_, first) in segments {
        for a in first..first + row - 1 {
            mesh.add_triangle(a, a + 1, a + row);
            mesh.add_triangle(a + 1, a + row + 1, a + row);
        }
    }
    mesh
}

/// Across a ribbon of this half width: how far from its middle, how much farther for its soft edge,
/// points, and the cover there.
fn columns(half: f32) -> Vec<(f32, f32, f32)> {
    let cover = (2.0 * half).clamp(0.35, 1.0);
    if half <= 2.0 * SOFT {
        return vec![(-half, -SOFT, 0.0), (0.0, 0.0, cover), (half, SOFT, 0.0)];
    }
    let inner: &[f32] = if half > HAIRS { &[-0.4, 0.0, 0.4] } else { &[] };
    let mut columns = vec![(-half, -SOFT, 0.0), (-half, SOFT, cover)];
    columns.extend(inner.iter().map(|share| (share * half, 0.0, cover)));
    columns.extend([(half, -SOFT, cover), (half, SOFT, 0.0)]);
    columns
}

/// Of a wide ribbon the hairs differ.
fn hair_shade(strip: usize, column: usize, columns: usize) -> f32 {
    match columns {
        7.. => 1.0 + 0.34 * unruly(7 * strip + 3 * column),
        _ => 1.0,
    }
}

/// The stations of a pose that are drawn.
struct Tuft<'a> {
    pose: &'a HeadPose,
    strips: usize,
    stations: Vec<usize>,
    middles: Vec<Middle>,
}

impl<'a> Tuft<'a> {
    fn of(pose: &'a HeadPose, strips: usize, sight: &ViewLight<'_>) -> Self {
        let all = pose.x.len() / strips;
        let ends = [0, all - 1].map(|station| Middle::of(pose, strips, station, sight));
        let length = (ends[1].at - ends[0].at).length() * sight.scale;
        let step = if length < SHORT && all % 2 == 1 { 2 } else { 1 };
        let stations: Vec<usize> = (0..all).step_by(step).collect();
        let middles = stations
            .iter()
            .map(|station| Middle::of(pose, strips, *station, sight))
            .collect();
        Self {
            pose,
            strips,
            stations,
            middles,
        }
    }

    fn at(&self, strip: usize, i: usize) -> Vec3 {
        point(self.pose, self.stations[i] * self.strips + strip)
    }

    fn line(&self, strip: usize) -> impl Iterator<Item = Vec3> {
        (0..self.stations.len()).map(move |i| self.at(strip, i))
    }

    /// The place of a station along a strip, 0 at the ferrule to 1.
    fn along(&self, i: usize) -> f32 {
        i as f32 / (self.stations.len() - 1) as f32
    }

    fn height(&self, strip: usize, i: usize) -> f32 {
        self.middles[i].up.dot(self.at(strip, i))
    }

    /// Number of strips that stand for all at this size.
    fn some(&self, sight: &ViewLight<'_>) -> usize {
        let widest = self.middles.iter().map(|m| m.radius).fold(0.0, f32::max);
        let enough = (2.0 * widest * sight.scale * DENSITY) as usize;
        enough.max(FEWEST).min(self.strips)
    }

    /// The strips that are drawn: every n-th of an even sequence is an even sequence too, and the underside of a tuft
    /// that touches nothing is not seen.
    fn kept(&self, some: usize, sight: &ViewLight<'_>) -> Vec<usize> {
        let below = |i: usize, strip: usize| {
            let off = self.at(strip, i) - self.middles[i].at;
            off.dot(sight.up) < UNDER * self.middles[i].radius
        };
        (0..some)
            .map(|k| k * self.strips / some)
            .filter(|strip| (1..self.middles.len()).any(|i| !below(i, *strip)))
            .collect()
    }

    /// Light that a strip sends from a station.
    fn colour(
        &self,
        strip: usize,
        i: usize,
        bristles: &Bristles<'_>,
        sight: &ViewLight<'_>,
    ) -> Vec3 {
        let (at, middle, along) = (self.at(strip, i), &self.middles[i], self.along(i));
        let last = self.stations.len() - 1;
        let way = self.at(strip, (i + 1).min(last)) - self.at(strip, i.saturating_sub(1));
        let way = way.normalize_or(-sight.up);
        let out = (at - middle.at) / middle.radius;
        // The tuft is round: a strip faces away from its middle, and the viewer sees the upper side.
        let upper = out + 0.55 * sight.up;
        let n = (upper - upper.dot(way) * way).normalize_or(sight.up);
        let depth = 0.55 + 0.45 * smoothstep(-0.7, 0.6, out.dot(sight.up));
        let root = 0.68 + 0.32 * smoothstep(0.0, 0.22, along);
        let own = match bristles.hair {
            Hair::Steel => 0.0,
            Hair::Hog | Hair::Sable | Hair::Badger => 0.24 * unruly(strip),
        };
        let lit = (0.5 + 0.5 * n.dot(sight.toward)) * depth * root;
        let tone = |own: f32| {
            let t = (lit * (0.85 + 0.15 * along) + own).clamp(0.0, 1.0);
            t * (0.3 + 0.7 * t)
        };
        let [bright, dark] = bristles.tones;
        let hair = dark + (bright - dark) * tone(own);
        let (paint, film) = bristles
            .coat
            .and_then(|coat| coat.at(strip, along))
            .unwrap_or((bright, 0.0));
        let cover = smoothstep(0.0, HIDES, film);
        // A thin film tints the hair, a thick one has the tuft's relief and no hair of its own.
        let tinted = hair * paint / bright.max(Vec3::splat(0.01));
        let coated = paint * (0.34 + 0.74 * tone(0.35 * own));
        // Hair shines across its own direction (Kajiya and Kay 1989); wet paint more, and sharper.
        let half = sight.half();
        let square = (1.0 - way.dot(half) * way.dot(half)).max(0.0);
        let facing = n.dot(half).max(0.0);
        let dry = 0.22 * square.powi(12) * facing.powi(8) * root;
        let wet = 0.55 * square.powi(24) * facing.powi(28);
        let shine = (bright * dry * (1.0 - cover)) + Vec3::splat(wet * cover * film.min(1.0));
        tinted + (coated - tinted) * cover + shine
    }
}

fn point(pose: &HeadPose, i: usize) -> Vec3 {
    Vec3::new(pose.x[i], pose.y[i], pose.z[i])
}

/// The tuft at a station: its middle and its radius.
struct Middle {
    at: Vec3,
    radius: f32,
    up: Vec3,
}

impl Middle {
    fn of(pose: &HeadPose, strips: usize, station: usize, sight: &ViewLight<'_>) -> Self {
        let points = || (0..strips).map(|strip| point(pose, station * strips + strip));
        let at = points().sum::<Vec3>() / strips.max(1) as f32;
        let far = points()
            .map(|p| p.distance_squared(at))
            .fold(1e-12, f32::max);
        Self {
            at,
            radius: far.sqrt(),
            up: sight.up,
        }
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

#[cfg(test)]
mod tests {
    use eframe::egui::pos2;

    use super::*;
    use crate::render::brush::paint_colour::tests::coat_of;

    /// Two strips that lie beside each other along x, 1 mm apart, the second one higher.
    fn pose() -> HeadPose {
        HeadPose {
            x: vec![0.0, 0.0, 0.01, 0.01, 0.02, 0.02],
            y: vec![0.0, 1e-3, 0.0, 1e-3, 0.0, 1e-3],
            z: vec![0.0, 2e-4, 0.0, 2e-4, 0.0, 2e-4],
            ..HeadPose::default()
        }
    }

    fn drawn(pose: &HeadPose, toward: [f32; 3], coat: Option<&PaintColour>) -> Mesh {
        let to_window = |p: Vec3| pos2(10_000.0 * p.x, -10_000.0 * p.y);
        let sight = ViewLight {
            to_window: &to_window,
            scale: 10_000.0,
            up: Vec3::Z,
            toward: Vec3::from_array(toward),
            light: 1.0,
        };
        let bristles = Bristles {
            width_m: 4e-4,
            taper: 0.0,
            hair: Hair::Hog,
            tones: [Vec3::new(0.8, 0.7, 0.4), Vec3::new(0.2, 0.1, 0.05)],
            coat,
        };
        ribbons(pose, 2, &bristles, &sight)
    }

    const ABOVE: [f32; 3] = [0.0, 0.0, 1.0];

    #[test]
    fn ribbons_follow_the_strips_the_lower_first_with_soft_edges() {
        let mesh = drawn(&pose(), ABOVE, None);
        assert_eq!((mesh.vertices.len(), mesh.indices.len()), (24, 72));
        assert!(mesh.is_valid());
        let middle = |from: usize| {
            let row = &mesh.vertices[from..from + 4];
            row.iter().map(|v| v.pos.y).sum::<f32>() / 4.0
        };
        assert!(middle(0).abs() < 1e-3 && (middle(12) + 10.0).abs() < 1e-3);
        for row in mesh.vertices.chunks(4) {
            assert!(row[0].color.a() == 0 && row[3].color.a() == 0 && row[1].color.a() > 50);
        }
        let first = |mesh: &Mesh| mesh.indices[0] < 12;
        assert!(first(&mesh), "the lower strip is under the other");
        let mut turned = pose();
        turned.z = turned.z.iter().map(|z| 2e-4 - z).collect();
        assert!(!first(&drawn(&turned, ABOVE, None)), "a fault would pass");
        let nothing = drawn(&HeadPose::default(), ABOVE, None);
        assert_eq!(nothing, Mesh::default());
    }

    #[test]
    fn the_side_toward_the_lamp_is_lighter() {
        let lightness = |toward: [f32; 3], strip: usize| {
            let mesh = drawn(&pose(), toward, None);
            u32::from(mesh.vertices[12 * strip + 5].color.r())
        };
        let difference =
            |toward: [f32; 3]| i64::from(lightness(toward, 1)) - i64::from(lightness(toward, 0));
        let (far, near) = (difference([0.0, -0.7, 0.7]), difference([0.0, 0.7, 0.7]));
        assert!(near > far + 40, "{near} {far}");
    }

    #[test]
    fn a_strip_has_the_colour_of_its_paint_and_a_bare_one_that_of_its_hair() {
        let blue = [0.02, 0.05, 0.5, 1.0];
        let coat = coat_of(
            2,
            2,
            &[[0.8, 0.7, 0.4, 0.0], [0.8, 0.7, 0.4, 0.0], blue, blue],
        );
        let mesh = drawn(&pose(), ABOVE, Some(&coat));
        let seen = |strip: usize| mesh.vertices[12 * strip + 5].color;
        assert!(seen(0).r() > seen(0).b() + 20, "{:?}", seen(0));
        assert!(seen(1).b() > seen(1).r() + 60, "{:?}", seen(1));
        let bare = drawn(&pose(), ABOVE, None);
        assert_eq!(bare.vertices[5].color, seen(0), "no film is no paint");
        assert_ne!(bare.vertices[17].color, seen(1), "a fault would pass");
        // A coat of another brush's strips says nothing.
        let other = coat_of(1, 2, &[blue, blue]);
        let strange = drawn(&pose(), ABOVE, Some(&other));
        assert_eq!(strange.vertices[17].color, bare.vertices[17].color);
    }

    #[test]
    fn a_small_head_takes_fewer_ribbons_of_the_same_width_together() {
        let strips = 400;
        let spread = |i: usize| 0.01 * ((i % strips) as f32 / strips as f32 - 0.5);
        let pose = HeadPose {
            x: (0..3 * strips).map(spread).collect(),
            y: (0..3 * strips)
                .map(|i| (i / strips) as f32 * 0.01)
                .collect(),
            z: vec![0.01; 3 * strips],
            ..HeadPose::default()
        };
        let width = |scale: f32| {
            let to_window = |p: Vec3| pos2(scale * p.x, -scale * p.y);
            let sight = ViewLight {
                to_window: &to_window,
                scale,
                up: Vec3::Z,
                toward: Vec3::Z,
                light: 1.0,
            };
            let bristles = Bristles {
                width_m: 2e-4,
                taper: 0.0,
                hair: Hair::Sable,
                tones: [Vec3::ONE, Vec3::ZERO],
                coat: None,
            };
            let mesh = ribbons(&pose, strips, &bristles, &sight);
            let xs = || mesh.vertices.iter().map(|v| v.pos.x);
            let across = xs().fold(f32::MIN, f32::max) - xs().fold(f32::MAX, f32::min);
            (mesh.vertices.len(), across / scale)
        };
        let ((small, narrow), (large, wide)) = (width(2000.0), width(40_000.0));
        assert!(small < large / 4, "{small} {large}");
        assert!((narrow / wide - 1.0).abs() < 0.15, "{narrow} {wide}");
    }
}
