//! A brush as a picture: head, ferrule and the beginning of its handle, drawn without a graphics
//! device.

use eframe::egui::{Mesh, Pos2, pos2};
use glam::{DQuat, DVec3, Vec3};
use maulstick_brush::{BrushFile, Head, HeadPose, Hold, SpineLayout};
use maulstick_num::geometry::{Rigid, rotation};
use maulstick_optics::colour::srgb_decode;

use crate::render::brush::bristles::{Bristles, ribbons, tones};
use crate::render::brush::geometry::sections;
use crate::render::brush::handle::{Finish, handle};
use crate::render::view_light::ViewLight;

/// Samples of a pixel, each way.
const FINE: usize = 3;
/// Toward the lamp: from the upper left, as over the desk.
const TOWARD: Vec3 = Vec3::new(-0.5, 0.5, std::f32::consts::FRAC_1_SQRT_2);

/// A picture with eight bits of red, green, blue and cover a pixel, from the top row; colours are not
/// multiplied by the cover.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BrushThumbnail {
    /// Pixels across.
    pub width: usize,
    /// Pixels down.
    pub height: usize,
    /// Four bytes a pixel.
    pub rgba: Vec<u8>,
}

/// Draws a brush, point downward, broad side up: `scale` pixels a metre, in a picture of this size whose middle is
/// above the middle of the head.
#[must_use]
pub fn brush_thumbnail(
    file: &BrushFile,
    width: usize,
    height: usize,
    scale: f64,
) -> BrushThumbnail {
    let tuft = SpineLayout::of(file);
    let head = Head::of(file);
    // The brush lies: its axis along y, its point at the bottom, so near that its handle does not fade.
    let brush = Rigid {
        rotation: lying(),
        translation: DVec3::new(0.0, 0.0, 0.03),
    };
    let mut angles = Vec::new();
    for root in &tuft.roots {
        root.at_rest(&brush).angles(&mut angles);
    }
    let mut pose = HeadPose::default();
    let hold = Hold {
        brush: &brush,
        angles: &angles,
        per_m: 1.0,
        wetness: 0.0,
    };
    head.pose(&hold, &mut pose);
    let scale = scale * FINE as f64;
    let (across, down) = (width * FINE, height * FINE);
    // The point of the head is a little above the bottom.
    let bottom = down as f64 - 0.06 * down as f64;
    let to_window = |p: Vec3| -> Pos2 {
        let y = f64::from(p.y) + file.length_m();
        pos2(
            (0.5 * across as f64 + f64::from(p.x) * scale) as f32,
            (bottom - y * scale) as f32,
        )
    };
    let mut canvas = Canvas::new(across, down);
    let sight = ViewLight {
        to_window: &to_window,
        scale: scale as f32,
        up: Vec3::Z,
        toward: TOWARD,
        light: 1.0,
    };
    canvas.draw(&handle(&sections(&brush, file), &Finish::default(), &sight));
    let linear =
        |srgb: [f32; 3]| Vec3::from_array(srgb.map(|v| srgb_decode(f64::from(v) / 255.0) as f32));
    let bristles = Bristles {
        width_m: file.strips.width_mm as f32 * 1e-3,
        taper: file.strips.taper as f32,
        hair: file.head.hair,
        tones: tones(file.head.hair).map(linear),
        coat: None,
    };
    canvas.draw(&ribbons(&pose, head.strips(), &bristles, &sight));
    canvas.reduce()
}

/// Turns the brush frame so that its axis is along y and its broad side looks up.
fn lying() -> DQuat {
    rotation(DVec3::X, -std::f64::consts::FRAC_PI_2)
}

/// A picture that is drawn on: red, green, blue and cover of 0 to 255.
struct Canvas {
    width: usize,
    height: usize,
    pixels: Vec<[f32; 4]>,
}

impl Canvas {
    fn new(width: usize, height: usize) -> Self {
        Self {
            width,
            height,
            pixels: vec![[0.0; 4]; width * height],
        }
    }

    fn draw(&mut self, mesh: &Mesh) {
        for triangle in mesh.indices.chunks_exact(3) {
            let corner = |i: usize| mesh.vertices[triangle[i] as usize];
            let corners = [corner(0), corner(1), corner(2)];
            let colours = corners.map(|v| v.color.to_srgba_unmultiplied().map(f32::from));
            self.triangle(corners.map(|v| v.pos), colours);
        }
    }

    fn triangle(&mut self, [a, b, c]: [Pos2; 3], colours: [[f32; 4]; 3]) {
        let side =
            |p: Pos2, q: Pos2, x: f32, y: f32| (q.x - p.x) * (y - p.y) - (q.y - p.y) * (x - p.x);
        let area = side(a, b, c.x, c.y);
        if area.abs() < 1e-9 {
            return;
        }
        let range = |of: [f32; 3], last: usize| {
            let low = of[0].min(of[1]).min(of[2]).floor().max(0.0) as usize;
            let high = of[0].max(of[1]).max(of[2]).ceil().clamp(0.0, last as f32);
            low..high as usize
        };
        for row in range([a.y, b.y, c.y], self.height) {
            for column in range([a.x, b.x, c.x], self.width) {
                let (x, y) = (column as f32 + 0.5, row as f32 + 0.5);
                let shares = [side(b, c, x, y), side(c, a, x, y), side(a, b, x, y)];
                let shares = shares.map(|share| share / area);
                if shares.iter().any(|share| *share < 0.0) {
                    continue;
                }
                let mix = |i: usize| (0..3).map(|k| shares[k] * colours[k][i]).sum::<f32>();
                self.blend(row * self.width + column, [0, 1, 2, 3].map(mix));
            }
        }
    }

    fn blend(&mut self, at: usize, over: [f32; 4]) {
        let under = self.pixels[at];
        let (above, below) = (over[3] / 255.0, under[3] / 255.0);
        let cover = above + below * (1.0 - above);
        if cover <= 0.0 {
            return;
        }
        let mix = |i: usize| (over[i] * above + under[i] * below * (1.0 - above)) / cover;
        self.pixels[at] = [mix(0), mix(1), mix(2), 255.0 * cover];
    }

    fn reduce(&self) -> BrushThumbnail {
        let (width, height) = (self.width / FINE, self.height / FINE);
        let mut rgba = Vec::with_capacity(4 * width * height);
        for row in 0..height {
            for column in 0..width {
                let mut sum = [0.0f32; 4];
                for fine in 0..FINE * FINE {
                    let (dx, dy) = (fine % FINE, fine / FINE);
                    let at = (row * FINE + dy) * self.width + column * FINE + dx;
                    let [r, g, b, cover] = self.pixels[at];
                    let own = [r * cover, g * cover, b * cover, cover];
                    sum = std::array::from_fn(|i| sum[i] + own[i]);
                }
                let cover = sum[3].max(1e-6);
                let colour = [sum[0] / cover, sum[1] / cover, sum[2] / cover];
                rgba.extend(colour.map(|v| v as u8));
                rgba.push((sum[3] / (FINE * FINE) as f32) as u8);
            }
        }
        BrushThumbnail {
            width,
            height,
            rgba,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn covered(brush_thumbnail: &BrushThumbnail, row: usize) -> usize {
        let row = &brush_thumbnail.rgba
            [4 * row * brush_thumbnail.width..4 * (row + 1) * brush_thumbnail.width];
        row.chunks_exact(4).filter(|pixel| pixel[3] > 127).count()
    }

    #[test]
    fn a_brush_is_as_wide_as_it_is() {
        let file = BrushFile::library("flat").expect("flat");
        let brush_thumbnail = brush_thumbnail(&file, 120, 200, 3000.0);
        // 20 mm at three pixels a millimetre, in the middle of the head.
        let middle = 200.0 * 0.94 - 13.0 * 3.0;
        let wide = covered(&brush_thumbnail, middle as usize);
        assert!((54..=64).contains(&wide), "{wide}");
        assert!(
            covered(&brush_thumbnail, 197) == 0,
            "nothing below the point"
        );
        assert!(covered(&brush_thumbnail, 40) > 20, "the ferrule");
    }

    #[test]
    fn brushes_look_different() {
        let of =
            |kind: &str| brush_thumbnail(&BrushFile::library(kind).expect(kind), 80, 120, 2000.0);
        assert_ne!(of("fan"), of("round"));
        assert_eq!(of("fan"), of("fan"));
    }
}
