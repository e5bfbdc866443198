//! The overlay without a desk: keys and clicks in, requests out; and snapshots of it.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use eframe::egui::{DroppedFile, Key, Modifiers, Theme, Ui};
use egui_kittest::kittest::Queryable as _;
use egui_kittest::{Harness, SnapshotOptions};
use maulstick_rig::UserError;
use maulstick_types::command::{Command, Detail};
use maulstick_ui_kit::notifications::Notifications;

use maulstick_client::dispatcher::{Outcome, RequestError};
use maulstick_client::request::Request;

use crate::app::overlay::Overlay;
use crate::rig::requests::Requests;
use crate::rig::state::RigState;
use crate::settings::preferences::Preferences;
use crate::test_support::panel_bench::rig;
use crate::widgets::context::PanelContext;

/// Longest wait for background work before a test fails.
const PATIENCE: Duration = Duration::from_secs(60);
/// Pixels that may look otherwise on another adapter.
const MOST_FAILED: usize = 60;

/// A window without a desk.
pub(crate) struct Bench {
    pub overlay: Overlay,
    pub rig: RigState,
    pub requests: Requests,
    pub preferences: Preferences,
    pub notifications: Notifications,
}

impl Bench {
    fn with<T>(&mut self, act: impl FnOnce(&mut Overlay, &mut PanelContext<'_>) -> T) -> T {
        let mut work = PanelContext {
            rig: &mut self.rig,
            requests: &mut self.requests,
            preferences: &mut self.preferences,
            notifications: &mut self.notifications,
        };
        act(&mut self.overlay, &mut work)
    }

    /// Everything that was asked since the last call: the node, and of it.
    pub(crate) fn asked(&mut self) -> Vec<(String, Command)> {
        let requests = self.requests.take_all().into_iter();
        let command = |request| match request {
            Request::Command { node, command } => (node, command),
            other @ Request::Force { .. } => panic!("no command: {other:?}"),
        };
        requests.map(command).collect()
    }

    pub(crate) fn answer(&mut self, asked: &(String, Command), result: Result<Detail, UserError>) {
        let told = Outcome {
            request: Request::Command {
                node: asked.0.clone(),
                command: asked.1.clone(),
            },
            result: result.map_err(RequestError::from),
        };
        self.with(|overlay, work| overlay.on_reply(&told, work));
    }

    /// Words of all notifications.
    pub(crate) fn told(&self) -> String {
        let words = self.notifications.shown().iter();
        let words = words.map(|toast| format!("{} {}", toast.what, toast.help));
        words.collect::<Vec<_>>().join("\n")
    }
}

/// A window of a painter who painted in this folder before.
pub(crate) fn window(folder: Option<&Path>) -> Harness<'static, Bench> {
    let preferences = Preferences {
        recent: folder
            .map(|folder| folder.join("before.maul"))
            .into_iter()
            .collect(),
        has_painted: true,
        ..Preferences::default()
    };
    window_of([900.0, 700.0], rig(), preferences)
}

/// A window of this size, points, of a rig and a painter.
pub(crate) fn window_of(
    size: [f32; 2],
    rig: RigState,
    preferences: Preferences,
) -> Harness<'static, Bench> {
    let bench = Bench {
        overlay: Overlay::default(),
        rig,
        requests: Requests::default(),
        preferences,
        notifications: Notifications::default(),
    };
    let show = |ui: &mut Ui, bench: &mut Bench| {
        let rest = bench.with(|overlay, work| overlay.show(ui, work));
        assert!(rest.is_empty(), "{rest:?}");
    };
    let mut harness = Harness::builder()
        .with_size(size)
        .build_ui_state(show, bench);
    harness.run_steps(2);
    harness
}

/// Presses a key with Ctrl, and with Shift where it is asked for.
pub(crate) fn ctrl(harness: &mut Harness<'_, Bench>, key: Key, more: Modifiers) {
    harness.key_press_modifiers(Modifiers::COMMAND.plus(more), key);
    harness.run_steps(4);
    listed(harness);
}

pub(crate) fn press(harness: &mut Harness<'_, Bench>, key: Key) {
    harness.key_press(key);
    harness.run_steps(3);
}

/// Writes into the control that has this label, in the place of what was there.
pub(crate) fn write(harness: &mut Harness<'_, Bench>, label: &str, text: &str) {
    harness.get_by_label(label).focus();
    harness.run_steps(2);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    harness.run_steps(1);
    harness.get_by_label(label).type_text(text);
    harness.run_steps(2);
    listed(harness);
}

/// Draws until a dialog lists what lies in its folder: nothing moves under a click then.
fn listed(harness: &mut Harness<'_, Bench>) {
    until(harness, |harness| {
        harness.query_by_label("Looking …").is_none()
    });
}

/// Draws until something is so that a thread brings about.
pub(crate) fn until<T>(harness: &mut Harness<'_, T>, is_so: impl Fn(&Harness<'_, T>) -> bool) {
    let end = Instant::now() + PATIENCE;
    while !is_so(harness) {
        assert!(Instant::now() < end, "it does not come");
        harness.step();
        std::thread::yield_now();
    }
    harness.run_steps(2);
}

/// Lets go of files over the window.
pub(crate) fn let_go(harness: &mut Harness<'_, Bench>, paths: &[&Path]) {
    #[derive(Debug)]
    struct Held(PathBuf);
    impl DroppedFile for Held {
        fn path(&self) -> &Path {
            &self.0
        }
        fn bytes(&self) -> Result<Vec<u8>, String> {
            std::fs::read(&self.0).map_err(|error| error.to_string())
        }
    }
    let files = paths
        .iter()
        .map(|path| Arc::new(Held(path.to_path_buf())) as _);
    harness.input_mut().dropped_files = files.collect();
    harness.step();
}

type Seeded<'a, T> = Box<dyn FnOnce(&mut T) + 'a>;

/// Compares what is shown with its picture, and sees that `fault` makes another one.
pub(crate) fn picture<T: 'static>(
    name: &str,
    size: [f32; 2],
    state: impl Fn() -> T,
    show: fn(&mut Ui, &mut T),
    prepare: impl Fn(&mut Harness<'static, T>),
    fault: impl FnOnce(&mut T),
) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/snapshots");
    let options = SnapshotOptions::new()
        .output_path(&folder)
        .threshold(1.0)
        .max_failed_pixels(MOST_FAILED);
    let drawn = |theme: Theme, scale: f32, fault: Option<Seeded<'_, T>>| {
        let mut harness = Harness::builder()
            .with_size(size)
            .with_pixels_per_point(scale)
            .with_theme(theme)
            .wgpu()
            .build_ui_state(show, state());
        harness.run_steps(4);
        prepare(&mut harness);
        if let Some(fault) = fault {
            fault(harness.state_mut());
        }
        harness.run_steps(4);
        harness
    };
    // With this variable set, both themes are drawn with finer pixels, to be looked at.
    if let Some(place) = std::env::var_os("MAULSTICK_LOOK") {
        for (theme, word) in [(Theme::Dark, "dark"), (Theme::Light, "light")] {
            let image = drawn(theme, 2.0, None).render().expect("a picture");
            let path = Path::new(&place).join(format!("{name}_{word}.png"));
            image.save(path).expect("saved");
        }
    }
    let mut harness = drawn(Theme::Dark, 1.0, None);
    let good = harness.render().expect("a picture");
    harness.snapshot_options(name, &options);
    let path = folder.join(format!("{name}.png"));
    let kept = std::fs::metadata(&path).expect("the picture").len();
    assert!(kept < 60 * 1024, "{} has {kept} bytes", path.display());
    let bad = drawn(Theme::Dark, 1.0, Some(Box::new(fault)))
        .render()
        .expect("a picture");
    let far = |(one, other): (&u8, &u8)| one.abs_diff(*other) > 32;
    let other = good
        .iter()
        .zip(bad.iter())
        .filter(|pair| far(*pair))
        .count();
    assert!(
        other > 3 * MOST_FAILED,
        "a fault would pass: {other} bytes differ"
    );
}
