//! A painter's session in a real window: a synthetic mouse paints, mixes, dries, takes back, moves the canvas
//! while it paints, and exports.

#[path = "../support/mod.rs"]
mod support;

use std::fs::File;
use std::io::{BufReader, BufWriter};
use std::path::Path;
use std::time::Duration;

use maulstick_bus::typed::Receiver;
use maulstick_bus::{Qos, ZenohBus};
use maulstick_types::scene::{CANVAS, PALETTE, Scene, Surface};
use maulstick_types::stylus::StylusSample;
use maulstick_types::wire::topics::Topics;
use support::display::{CONTROL, Display, RETURN, SHIFT, TAB, over};
use support::{Launcher, PATIENCE, Place, listen, wait_for};

/// Size of the window.
const WIDTH: u16 = 1280;
const HEIGHT: u16 = 800;

/// A painter at a window.
struct Painter {
    display: Display,
    window: u32,
    bus: ZenohBus,
    topics: Topics,
    mouse: Receiver<StylusSample>,
}

fn surface(scene: &Scene, id: u32) -> &Surface {
    let mut surfaces = scene.surfaces.iter();
    surfaces.find(|surface| surface.id == id).expect("there")
}

/// A zigzag about a place, mm.
fn zigzag(x: f64, y: f64, wide: f64, high: f64) -> Vec<[i16; 2]> {
    let at = |i: u32| {
        let t = f64::from(i) / 80.0;
        let across = wide * (2.0 * (4.0 * t).fract() - 1.0).abs() - 0.5 * wide;
        over(x + across, y + high * (t - 0.5))
    };
    (0..=80).map(at).collect()
}

/// A straight way, mm.
fn line(from: [f64; 2], to: [f64; 2]) -> Vec<[i16; 2]> {
    let at = |i: u32| {
        let t = f64::from(i) / 60.0;
        over(
            from[0] + t * (to[0] - from[0]),
            from[1] + t * (to[1] - from[1]),
        )
    };
    (0..=60).map(at).collect()
}

fn is_light(pixel: [u8; 3]) -> bool {
    pixel.iter().all(|channel| *channel > 180)
}

/// Whether a colour is a green.
fn green([red, green, blue]: [u8; 3]) -> bool {
    green > red.saturating_add(12) && green > blue.saturating_add(12)
}

impl Painter {
    fn drag(&mut self, way: &[[i16; 2]]) {
        self.display.drag(way, &mut self.mouse);
    }

    /// The scene, once it is as `wanted`: who joins anew hears it as it is.
    fn scene(&self, what: &str, wanted: impl Fn(&Scene) -> bool) -> Scene {
        let now = || {
            let mut scenes = listen::<Scene>(&self.bus, &self.topics.scene(), Qos::Cached);
            let heard = wait_for(Duration::from_secs(1), || scenes.newest());
            heard.map(|scene| scene.message).filter(&wanted)
        };
        let scene = wait_for(PATIENCE, now);
        if scene.is_none() {
            self.keep_picture("failed.png");
        }
        scene.expect(what)
    }

    fn pixel(&self, [x, y]: [i16; 2]) -> [u8; 3] {
        self.display.pixel(self.window, x, y)
    }

    /// Writes what is seen where it can be looked at.
    fn keep_picture(&self, name: &str) {
        let pixels = self.display.picture(self.window, WIDTH, HEIGHT);
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
        let file = BufWriter::new(File::create(path).expect("created"));
        let mut encoder = png::Encoder::new(file, u32::from(WIDTH), u32::from(HEIGHT));
        encoder.set_color(png::ColorType::Rgb);
        let mut writer = encoder.write_header().expect("a header");
        writer.write_image_data(&pixels.concat()).expect("written");
    }

    /// Waits until a pixel is as `wanted`.
    fn sees(&self, at: [i16; 2], wanted: impl Fn([u8; 3]) -> bool) -> bool {
        let seen = wait_for(PATIENCE, || wanted(self.pixel(at)).then_some(()));
        seen.is_some()
    }

    /// Takes the palette out and cleans the brush on it.
    fn take_the_palette_out(&mut self) {
        self.display.keys(&[u32::from(' ')]);
        let out = self.scene("the palette out", |scene| {
            surface(scene, PALETTE).pose.position_m[0] > -0.1
        });
        let palette = surface(&out, PALETTE);
        let from_middle = palette.pose.position_m[0] + 0.064;
        assert!(from_middle.abs() < 1e-6, "{palette:?}");
        self.drag(&zigzag(28.0, -114.5, 12.0, 10.0));
    }

    /// Mixes yellow, and a little blue into it: green.
    fn mix_green(&mut self) {
        let heap = [-10.0, 40.0];
        for (well, ways) in [(89.6, 2), (-12.8, 1)] {
            self.drag(&zigzag(50.5, well, 10.0, 10.0));
            for _ in 0..ways {
                self.drag(&zigzag(heap[0], heap[1], 30.0, 16.0));
            }
        }
        self.drag(&zigzag(heap[0], heap[1], 30.0, 16.0));
        self.display.point(over(-50.0, -90.0));
        let mixed = wait_for(PATIENCE, || {
            let pixels = self.display.picture(self.window, WIDTH, HEIGHT);
            let greens = pixels.iter().filter(|pixel| green(**pixel)).count();
            (greens > 2000).then_some(greens)
        });
        self.keep_picture("palette.png");
        assert!(mixed.is_some(), "nothing green was mixed");
    }

    fn put_the_palette_back(&self) {
        self.display.keys(&[u32::from(' ')]);
        self.scene("the palette back", |scene| {
            surface(scene, PALETTE).pose.position_m[0] < -0.1
        });
    }

    /// Paints a stroke during which the wheel zooms; the scene after it.
    fn paint_while_the_wheel_zooms(&self) -> Scene {
        let stroke = line([-80.0, 20.0], [0.0, 20.0]);
        self.display.press(1, &stroke[..40]);
        self.display.click_held(4, stroke[39]);
        // Without a wheel's axis a notch is told twice: as its button is pressed, and as it is let go.
        let zoomed = self.scene("a zoom", |scene| surface(scene, CANVAS).zoom > 1.2);
        self.display.release(1, &stroke[40..]);
        zoomed
    }

    /// Moves the canvas with the middle button.
    fn move_the_canvas(&self, zoomed: &Scene) {
        let before = surface(zoomed, CANVAS).pose.position_m;
        self.display.press(2, &line([0.0, -60.0], [10.0, -40.0]));
        self.display.release(2, &[]);
        self.scene("a pan", |scene| {
            surface(scene, CANVAS).pose.position_m[1] > before[1] + 0.015
        });
    }

    /// Shows all of the canvas again.
    fn fit_the_canvas(&self) {
        self.display.keys(&[u32::from('0')]);
        let fitted = self.scene("the whole canvas", |scene| {
            surface(scene, CANVAS).zoom < 1.02
        });
        let [x, y, _] = surface(&fitted, CANVAS).pose.position_m;
        assert!((x - y).abs() < 1e-9, "it lies in the middle");
    }

    /// Dries the canvas, takes that back, and dries it again.
    fn dry(&self) {
        self.display.keys(&[u32::from('d')]);
        self.scene("a dry layer", |scene| scene.layers.len() == 1);
        self.display.keys(&[CONTROL, u32::from('z')]);
        self.scene("the drying taken back", |scene| scene.layers.is_empty());
        self.display.keys(&[CONTROL, SHIFT, u32::from('z')]);
        self.scene("the drying again", |scene| scene.layers.len() == 1);
    }

    fn open_and_close_the_panels(&self) {
        self.display.keys(&[TAB]);
        self.keep_picture("panels.png");
        self.display.keys(&[TAB]);
    }

    /// Exports to the file that the dialog proposes, `path`.
    fn export(&self, path: &Path) {
        self.display.keys(&[CONTROL, u32::from('e')]);
        // The desk is dimmed under a dialog.
        let dimmed = self.sees(over(0.0, -110.0), |pixel| !is_light(pixel));
        assert!(dimmed, "no dialog is shown");
        self.keep_picture("export.png");
        self.display.keys(&[RETURN]);
        let written = wait_for(PATIENCE, || path.is_file().then_some(()));
        self.keep_picture("exported.png");
        assert!(written.is_some(), "nothing is exported");
    }
}

/// Pixels of an exported picture of eight bits, and how many lie in a row.
fn exported(path: &Path) -> (Vec<[u8; 3]>, usize) {
    let mut decoder = png::Decoder::new(BufReader::new(File::open(path).expect("exported")));
    decoder.set_transformations(png::Transformations::STRIP_16 | png::Transformations::EXPAND);
    let mut reader = decoder.read_info().expect("a picture");
    let mut bytes = vec![0; reader.output_buffer_size().expect("a size")];
    let info = reader.next_frame(&mut bytes).expect("whole");
    let channels = info.color_type.samples();
    let pixels = bytes[..info.buffer_size()].chunks_exact(channels);
    (
        pixels.map(|p| [p[0], p[1], p[2]]).collect(),
        info.width as usize,
    )
}

/// The strokes lie where the hand made them, though the canvas was moved, and nothing lies beside them.
fn check_strokes(path: &Path) {
    let (pixels, wide) = exported(path);
    let greens = |y: f64| {
        let row = ((128.0 - y) / 256.0 * wide as f64) as usize;
        let band = &pixels[(row - 40) * wide..(row + 40) * wide];
        band.iter().filter(|pixel| green(**pixel)).count()
    };
    for y in [60.0, 20.0, -45.0] {
        assert!(greens(y) > 500, "{y} mm: {} green cells", greens(y));
    }
    for y in [95.0, -10.0, -90.0] {
        assert_eq!(greens(y), 0, "{y} mm");
    }
}

#[test]
fn a_painter_mixes_paints_dries_takes_back_moves_the_canvas_and_exports() {
    let place = Place::new();
    let display = Display::start();
    let mut command = place.maulstick(&["up", "day.maul"]);
    command.env("DISPLAY", &display.name);
    let mut launcher = Launcher::start(command);
    launcher.wait_says("is up");
    let (bus, topics) = support::join(&place);
    let mut painter = Painter {
        window: display.window("Maulstick"),
        mouse: listen(&bus, &topics.sample("mouse"), Qos::RealTime),
        bus,
        topics,
        display,
    };
    let first = painter.scene("a desk", |_| true);
    assert_eq!(surface(&first, CANVAS).zoom, 1.0);
    let shown = painter.sees(over(0.0, 0.0), is_light);
    assert!(shown, "the canvas is not shown");

    painter.take_the_palette_out();
    painter.mix_green();
    painter.put_the_palette_back();
    painter.drag(&line([-80.0, 60.0], [80.0, 60.0]));
    let zoomed = painter.paint_while_the_wheel_zooms();
    painter.move_the_canvas(&zoomed);
    painter.fit_the_canvas();
    painter.drag(&line([-60.0, -40.0], [70.0, -50.0]));
    painter.keep_picture("painted.png");
    painter.dry();
    painter.open_and_close_the_panels();
    let path = place.path("day.png");
    painter.export(&path);
    check_strokes(&path);

    painter.bus.close();
    painter.display.close(painter.window);
    let code = launcher.wait(PATIENCE).code();
    assert_eq!(code, Some(0), "{}", launcher.said());
}
