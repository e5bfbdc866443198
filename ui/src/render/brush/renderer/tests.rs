use eframe::egui::{Color32, Rect, pos2, vec2};
use eframe::egui_wgpu::wgpu::util::DeviceExt as _;
use glam::DVec2;
use maulstick_appearance::lamp::lamp_over;
use maulstick_brush::{BrushFile, BrushModel};
use maulstick_painting::PaintingSetup;
use maulstick_types::Origin;
use maulstick_types::scene::Scene;
use maulstick_types::stylus::{DEFAULT_TILT_RAD, StylusPose, StylusSample};

use super::*;
use crate::render::brush::paint_colour::tests::coat_of;
use crate::render::gpu::testing::read;
use crate::render::offscreen::Offscreen;

/// A brush as a hand holds it over a point of the desk.
struct InHand {
    file: BrushFile,
    head: Head,
    plane: Plane,
    brush: Rigid,
    angles: Vec<[f32; 2]>,
    coat: Option<Arc<PaintColour>>,
}

impl InHand {
    /// With its point at a place, m, pressed so hard, 0 to 1; its handle leans toward the lamp, so that
    /// it does not hide its shadow.
    fn new(kind: &str, at: [f64; 2], pressure: f64, scene: &Scene) -> Self {
        let file = BrushFile::library(kind).expect(kind);
        let mut model = BrushModel::new(file.clone(), 0.5);
        model.set_scene(scene);
        let pen = Origin {
            source: 1,
            epoch: 1,
        };
        // It slides a little, so that it bends to one side.
        let states = [0.0, 0.4, 0.7, 1.0].into_iter().enumerate();
        let states: Vec<_> = states
            .filter_map(|(seq, share)| {
                let sample = StylusSample {
                    pose: StylusPose::Contact {
                        point_m: [at[0] - 0.004 * (1.0 - share), at[1], 0.0],
                        tilt_rad: DEFAULT_TILT_RAD.map(|tilt| -tilt),
                        twist_rad: 0.0,
                        pressure,
                    },
                    in_range: true,
                    ..StylusSample::away()
                };
                let now = 1_000_000_000 + seq as u64 * 10_000_000;
                model.state(pen, seq as u64, now, &sample)
            })
            .collect();
        let solves = states.last().map(|state| &state.solves);
        let solve = solves.and_then(|solves| solves.last()).expect("a solve");
        Self {
            head: Head::of(&file),
            file,
            plane: *Desk::of(scene).plane(solve.surface).expect("a surface"),
            brush: Rigid::from(&solve.pose),
            angles: solve.angles_rad.clone(),
            coat: None,
        }
    }

    fn lifted(mut self, by_m: f64) -> Self {
        self.brush.translation.z += by_m;
        self
    }

    /// Loaded with one paint on its left and another on its right, each linear light and a film by a
    /// full one.
    fn loaded(mut self, left: [f32; 4], right: [f32; 4]) -> Self {
        let roots = self.head.roots();
        let samples: Vec<[f32; 4]> = roots
            .iter()
            .flat_map(|root| {
                let own = if root[0] < 0.0 { left } else { right };
                let [r, g, b, film] = own;
                // As a brush is dipped: the nearer to the ferrule, the thinner.
                [0.15, 0.6, 1.0, 1.0].map(|share| {
                    let hair = self.file.head.hair.srgb().map(|v| (v / 255.0).powi(2));
                    let over = |own: f32, hair: f32| own * share + hair * (1.0 - share);
                    [
                        over(r, hair[0]),
                        over(g, hair[1]),
                        over(b, hair[2]),
                        film * share,
                    ]
                })
            })
            .collect();
        self.coat = Some(Arc::new(coat_of(roots.len() as u32, 4, &samples)));
        self
    }

    fn held(&self) -> BrushPose<'_> {
        BrushPose {
            name: &self.file.kind,
            file: &self.file,
            plane: self.plane,
            brush: self.brush,
            angles: self.angles.clone(),
            wetness: if self.coat.is_some() { 0.8 } else { 0.0 },
            coat: self.coat.clone(),
        }
    }
}

/// Areas of the view and their greys, the lower ones first.
type Greys<'a> = &'a [(Rect, u8)];

/// A picture of brushes over even greys, one pixel a point.
struct RigState {
    scene: Scene,
    view: View,
    picture: Offscreen,
}

impl RigState {
    /// An image of `size` pixels with `scale` pixels a metre.
    fn new(size: [u32; 2], scale: f64) -> Self {
        let picture = Offscreen::new(size).expect("a Vulkan driver");
        Self {
            scene: PaintingSetup::default().scene(),
            view: View {
                area: picture.area(),
                middle: DVec2::ZERO,
                room: DVec2::ONE,
                scale,
                mirrored: false,
            },
            picture,
        }
    }

    /// The desk as the shadows see it.
    fn desk(&self, greys: Greys<'_>) -> wgpu::TextureView {
        let [width, height] = [self.view.area.width(), self.view.area.height()];
        let mut bytes = Vec::new();
        for y in 0..height as u32 {
            for x in 0..width as u32 {
                let at = pos2(x as f32 + 0.5, y as f32 + 0.5);
                let own = greys.iter().rev().find(|(area, _)| area.contains(at));
                let grey = own.map_or(60, |(_, grey)| *grey);
                bytes.extend([grey, grey, grey, 255]);
            }
        }
        let Gpu { device, queue, .. } = self.picture.gpu();
        let texture = device.create_texture_with_data(
            queue,
            &wgpu::TextureDescriptor {
                label: Some("desk"),
                size: wgpu::Extent3d {
                    width: width as u32,
                    height: height as u32,
                    depth_or_array_layers: 1,
                },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: wgpu::TextureFormat::Rgba8Unorm,
                usage: wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            },
            wgpu::util::TextureDataOrder::LayerMajor,
            &bytes,
        );
        texture.create_view(&wgpu::TextureViewDescriptor::default())
    }

    /// The pixels of hands over greys; what the shadows take for these may be others.
    fn draw(&mut self, hands: &[InHand], greys: Greys<'_>, taken: Greys<'_>) -> Pixels {
        let desk = Desk::of(&self.scene);
        let pixels = self.desk(taken);
        let grey =
            |(area, grey): &(Rect, u8)| Shape::rect_filled(*area, 0.0, Color32::from_gray(*grey));
        let mut shapes: Vec<Shape> = greys.iter().map(grey).collect();
        for hand in hands {
            let gpu = self.picture.gpu();
            let lamp = lamp_over(&self.scene, hand.plane.id);
            let below = Below {
                view: &self.view,
                pixels_per_point: 1.0,
                desk: &desk,
                pixels: Some(&pixels),
            };
            let mut brushes = BrushRenderer::new(gpu, &Export::default());
            shapes.extend(brushes.shapes(gpu, &hand.held(), &hand.head, &lamp, &below));
        }
        self.picture.draw(shapes).expect("drawn");
        Pixels {
            bytes: read(self.picture.gpu(), self.picture.target()),
            width: self.view.area.width() as usize,
        }
    }

    /// Pixel of a point of the desk.
    fn place(&self, at: DVec3) -> [usize; 2] {
        let at = self.view.to_window(at);
        [at.x as usize, at.y as usize]
    }
}

#[derive(PartialEq)]
struct Pixels {
    bytes: Vec<u8>,
    width: usize,
}

impl Pixels {
    fn at(&self, [x, y]: [usize; 2]) -> [u8; 3] {
        let from = 4 * (y * self.width + x);
        [0, 1, 2].map(|i| self.bytes[from + i])
    }

    /// Writes it where the pictures of tests are left.
    fn keep(&self, name: &str) {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../target/pictures");
        std::fs::create_dir_all(&folder).expect("a folder");
        let file = std::fs::File::create(folder.join(name)).expect("a file");
        let mut encoder = png::Encoder::new(
            std::io::BufWriter::new(file),
            self.width as u32,
            (self.bytes.len() / 4 / self.width) as u32,
        );
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_compression(png::Compression::High);
        let rgb: Vec<u8> = self
            .bytes
            .chunks_exact(4)
            .flat_map(|p| [p[0], p[1], p[2]])
            .collect();
        let mut writer = encoder.write_header().expect("a header");
        writer.write_image_data(&rgb).expect("written");
    }
}

const BLUE: [f32; 4] = [0.012, 0.03, 0.28, 1.0];
const YELLOW: [f32; 4] = [0.85, 0.55, 0.02, 1.0];

fn over(grey: u8) -> [(Rect, u8); 1] {
    [(Rect::EVERYTHING, grey)]
}

/// Point of the canvas on which the lamp's shadow of a brush's ferrule falls.
fn shadow_of(hand: &InHand, scene: &Scene) -> DVec3 {
    let toward = lamp_over(scene, CANVAS).toward.map(f64::from);
    let run = DVec3::new(toward[0], toward[1], toward[2]) / toward[2];
    let at = hand
        .plane
        .to_desk
        .point(hand.brush.point(DVec3::new(0.0, 0.0, 0.006)));
    at - run * at.z
}

#[test]
fn a_shadow_darkens_light_ground_and_lightens_black() {
    let mut rig = RigState::new([500, 400], 3000.0);
    let hands = [InHand::new("round", [0.0, 0.0], 0.0, &rig.scene).lifted(0.02)];
    let at = rig.place(shadow_of(&hands[0], &rig.scene));
    let mut seen = |greys: u8, taken: u8| rig.draw(&hands, &over(greys), &over(taken)).at(at)[1];
    let (white, black) = (seen(240, 240), seen(0, 0));
    assert!(white < 215, "{white}");
    assert!(black > 15, "{black}");
    // Were what lies there taken for light, nothing would be seen on black.
    assert!(seen(0, 240) <= 2, "a fault would pass");
}

#[test]
fn a_shadow_gets_softer_and_farther_off_with_height() {
    let mut rig = RigState::new([500, 360], 1500.0);
    let mut steepest = |lift: f64| {
        let hand = InHand::new("round", [0.0, 0.0], 0.0, &rig.scene).lifted(lift);
        let at = rig.place(shadow_of(&hand, &rig.scene));
        let own = rig.place(hand.plane.to_desk.point(hand.brush.translation));
        let off = at[0].abs_diff(own[0]);
        let pixels = rig.draw(&[hand], &over(240), &over(240));
        let row = |dx: i64| i64::from(pixels.at([(at[0] as i64 + dx) as usize, at[1]])[1]);
        let steps = (0..60).map(|dx| (row(dx + 1) - row(dx)).abs());
        (steps.max().expect("some"), off)
    };
    let ((low, near), (high, far)) = (steepest(0.004), steepest(0.04));
    assert!(2 * low > 3 * high, "{low} {high}");
    assert!(far > near + 20, "{near} {far}");
}

#[test]
fn a_shadow_falls_on_the_raised_palette_where_that_is_and_beside_it_on_the_canvas() {
    let mut rig = RigState::new([600, 400], 2500.0);
    let palette = |scene: &Scene| Desk::of(scene).plane(PALETTE).copied().expect("a palette");
    // The right edge of the palette goes through the middle of the view.
    let own = palette(&rig.scene);
    rig.scene.surfaces[1].pose.position_m = [-own.size_m[0], -0.1, 0.0];
    let hands = [InHand::new("flat", [0.03, 0.0], 0.0, &rig.scene).lifted(0.07)];
    let mut drawn = |height_m: f64| {
        rig.scene.surfaces[1].pose.position_m[2] = height_m;
        rig.draw(&hands, &over(230), &over(230))
    };
    let (even, raised) = (drawn(0.0), drawn(0.03));
    let differ = |from: usize, to: usize| {
        let at = |i: usize| [i % even.width, i / even.width];
        let within = |i: &usize| (from..to).contains(&(i % even.width));
        (0..even.bytes.len() / 4)
            .filter(within)
            .filter(|i| even.at(at(*i))[1].abs_diff(raised.at(at(*i))[1]) > 3)
            .count()
    };
    assert!(differ(0, 299) > 500, "{}", differ(0, 299));
    assert_eq!(
        differ(302, 600),
        0,
        "beside the palette nothing has changed"
    );
}

#[test]
fn a_brush_loaded_beside_shows_two_paints_and_a_clean_one_its_hair() {
    let mut rig = RigState::new([400, 300], 6000.0);
    let hand = || InHand::new("flat", [0.0, 0.0], 0.0, &rig.scene).lifted(0.01);
    let [clean, beside] = [hand(), hand().loaded(BLUE, YELLOW)];
    let mut count = |hand: InHand| {
        let pixels = rig.draw(&[hand], &over(128), &over(128));
        let mut counts = [0; 3];
        for pixel in pixels.bytes.chunks_exact(4) {
            let [r, g, b] = [0, 1, 2].map(|i| i32::from(pixel[i]));
            counts[0] += usize::from(b > r + 40 && b > g + 30);
            counts[1] += usize::from(r > b + 110 && g > b + 70);
            counts[2] += usize::from(r > b + 15 && r < b + 100 && g > b);
        }
        counts
    };
    let ([blue, yellow, _], [no_blue, no_yellow, hair]) = (count(beside), count(clean));
    assert!(blue > 800 && yellow > 800, "{blue} {yellow}");
    assert!(
        no_blue == 0 && no_yellow < 40 && hair > 1500,
        "{no_blue} {no_yellow} {hair}"
    );
}

/// Each brush of the library straight and clean over light ground, pressed and loaded over dark.
#[test]
fn a_sheet_of_all_brushes() {
    let library = &maulstick_brush::file::library::LIBRARY;
    let cell = vec2(108.0, 230.0);
    let size = [cell.x as u32 * library.len() as u32, 2 * cell.y as u32];
    let scale = 2300.0;
    let mut rig = RigState::new(size, scale);
    let rows: [(u8, f64, bool); 2] = [(236, 0.0, false), (12, 0.5, true)];
    let grey = |(row, (grey, ..)): (usize, &(u8, f64, bool))| {
        let from = pos2(0.0, row as f32 * cell.y);
        (
            Rect::from_min_size(from, vec2(size[0] as f32, cell.y)),
            *grey,
        )
    };
    let greys: Vec<(Rect, u8)> = rows.iter().enumerate().map(grey).collect();
    let mut hands = Vec::new();
    for (row, (_, pressure, loaded)) in rows.iter().enumerate() {
        for (column, (kind, _)) in library.iter().enumerate() {
            let at = [
                (f64::from(cell.x) * (column as f64 + 0.60) - 0.5 * f64::from(size[0])) / scale,
                -(f64::from(cell.y) * (row as f64 + 0.82) - 0.5 * f64::from(size[1])) / scale,
            ];
            let hand = InHand::new(kind, at, *pressure, &rig.scene);
            let lift = if *pressure > 0.0 { 0.0 } else { 0.008 };
            let hand = hand.lifted(lift);
            hands.push(if *loaded {
                hand.loaded(BLUE, YELLOW)
            } else {
                hand
            });
        }
    }
    let pixels = rig.draw(&hands, &greys, &greys);
    pixels.keep("brush-3d.png");
    assert!(pixels != rig.draw(&[], &greys, &greys));
}
