//! The picture on the canvas: where it lies and what it does to colours; and its memory.

use std::path::PathBuf;
use std::time::Duration;

use eframe::egui_wgpu::wgpu;
use maulstick_ui_kit::notifications::Notifications;

use maulstick_client::state::PaintNode;

use super::projection::Projector;
use super::*;
use crate::render::gpu::testing::{draw, gpu, read, target};
use crate::render::surface::tests::{CELLS, look, surface};
use crate::rig::requests::Requests;
use crate::rig::state::RigState;
use crate::settings::preferences::Preferences;
use crate::test_support::panel_bench::{rig, status};

/// Left half black, right half white, twice as high as wide.
fn halves() -> Arc<Slide> {
    let pixels = (0..8 * 16).map(|i| [255 * u8::from(i % 8 >= 4); 3]);
    Arc::new(Slide::of(&Picture::of([8, 16], pixels.collect())))
}

#[test]
fn the_canvas_is_multiplied_where_the_picture_fits_it() {
    let gpu = gpu();
    let surface = surface();
    let size = CELLS;
    let seen = look(&surface, size.map(|side| side as f32), 1.0);
    let grey = wgpu::Color {
        r: 0.5,
        g: 0.25,
        b: 1.0,
        a: 1.0,
    };
    let drawn = |projector: &mut Projector, slide: Option<(&Arc<Slide>, f32)>| {
        let changes = projector.throw(&gpu, slide, &surface, (&seen, 1.0));
        let target = target(&gpu, size);
        draw(&gpu, &target, grey, |pass| projector.draw(pass));
        let bytes = read(&gpu, &target);
        let at = move |x: u32, y: u32| {
            let first = 4 * (y * size[0] + x) as usize;
            [
                bytes[first],
                bytes[first + 1],
                bytes[first + 2],
                bytes[first + 3],
            ]
        };
        (changes, at)
    };
    let (mut projector, slide) = (Projector::new(&gpu), halves());
    let plain = [128, 64, 255, 255];
    let (changes, at) = drawn(&mut projector, None);
    assert!(!changes && at(75, 50) == plain, "{:?}", at(75, 50));
    let (changes, at) = drawn(&mut projector, Some((&slide, 1.0)));
    assert!(changes);
    // 100 cells high it is 50 wide: from 50 to 100 of 150.
    assert_eq!([at(40, 50), at(110, 50), at(95, 50)], [plain; 3]);
    assert_eq!([at(60, 3), at(60, 96)], [[0, 0, 0, 255]; 2]);
    let (changes, at) = drawn(&mut projector, Some((&slide, 0.5)));
    // Half the light, encoded .735.
    let [red, green, blue, _] = at(60, 50);
    assert!(changes && red.abs_diff(94) < 2 && green.abs_diff(47) < 2 && blue.abs_diff(188) < 2);
    let (changes, _) = drawn(&mut projector, Some((&slide, 0.5)));
    assert!(!changes, "nothing has moved");
    let (changes, at) = drawn(&mut projector, Some((&slide, 0.0)));
    assert!(changes && at(60, 50) == plain);
    let (changes, at) = drawn(&mut projector, None);
    assert!(changes && at(60, 50) == plain);
}

struct Desk {
    rig: RigState,
    preferences: Preferences,
    notifications: Notifications,
    requests: Requests,
}

impl Desk {
    fn new() -> Self {
        Self {
            rig: rig(),
            preferences: Preferences::default(),
            notifications: Notifications::default(),
            requests: Requests::default(),
        }
    }

    fn open(&mut self, painting: &str) {
        let mut status = status();
        status.path = painting.to_owned();
        self.rig.live.paint = Some(PaintNode {
            status,
            heard_ns: 0,
        });
    }

    fn work(&mut self) -> PanelContext<'_> {
        PanelContext {
            rig: &mut self.rig,
            requests: &mut self.requests,
            preferences: &mut self.preferences,
            notifications: &mut self.notifications,
        }
    }
}

#[test]
fn each_painting_has_its_own_picture_and_settings_last() {
    let mut desk = Desk::new();
    desk.open("/a.maul");
    assert!(desk.work().tracing().is_none());
    desk.work().trace(Path::new("/one.png"));
    desk.work().tracing_mut().expect("one").strength = 0.25;
    desk.open("/b.maul");
    assert!(desk.work().tracing().is_none());
    desk.work().trace(Path::new("/two.png"));
    desk.work().untrace();
    assert!(desk.work().tracing().is_none());
    desk.open("/a.maul");
    desk.work().trace(Path::new("/three.png"));
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("window.toml");
    desk.preferences.keep(&path).expect("kept");
    desk.preferences = Preferences::read(&path).expect("read");
    let work = desk.work();
    let own = work.tracing().expect("remembered");
    assert_eq!(
        (own.path.clone(), own.strength, own.shown),
        (PathBuf::from("/three.png"), 0.25, true)
    );
    for number in 0..200 {
        desk.open(&format!("/none/{number}.maul"));
        desk.work().trace(Path::new("/one.png"));
    }
    desk.preferences.keep(&path).expect("kept");
    let text = std::fs::read_to_string(&path).expect("read");
    assert_eq!(text.matches("/one.png").count(), 64, "no end of them");
}

#[test]
fn a_sketch_leaves_its_picture_to_no_other_and_an_unknown_painting_has_none() {
    let mut desk = Desk::new();
    desk.open("");
    desk.work().trace(Path::new("/one.png"));
    desk.rig.live.paint = None;
    assert!(desk.work().tracing().is_none(), "which painting is it?");
    desk.open("");
    assert!(desk.work().tracing().is_some());
    desk.work().forget_sketch();
    assert!(desk.work().tracing().is_none());
}

#[test]
fn a_missing_picture_is_told_once() {
    let context = Context::default();
    let (mut desk, mut tracing) = (Desk::new(), TracingPicture::default());
    desk.work().trace(Path::new("/nowhere/sketch.png"));
    let begun = std::time::Instant::now();
    while desk.notifications.shown().is_empty() {
        assert!(tracing.follow(&context, &mut desk.work()).is_none());
        assert!(begun.elapsed() < Duration::from_secs(20), "nothing is told");
        std::thread::yield_now();
    }
    let told = std::mem::take(&mut desk.notifications);
    let what = &told.shown()[0].what;
    assert!(what.contains("/nowhere/sketch.png"), "{what}");
    for _ in 0..10 {
        assert!(tracing.follow(&context, &mut desk.work()).is_none());
    }
    assert!(desk.notifications.shown().is_empty(), "it was told already");
}
