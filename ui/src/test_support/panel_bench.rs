//! A panel in a column of the window, and its snapshot.

use std::path::Path;
use std::sync::Arc;

use eframe::egui::{Theme, Ui};
use egui_kittest::{Harness, SnapshotOptions};
use maulstick_optics::PaintLibrary;
use maulstick_painting::PaintingSetup;
use maulstick_types::command::Command;
use maulstick_types::paint::PaintStatus;
use maulstick_ui_kit::notifications::Notifications;

use maulstick_client::request::Request;
use maulstick_client::state::PaintNode;

use crate::panels::Panel;
use crate::rig::requests::Requests;
use crate::rig::state::RigState;
use crate::settings::preferences::Preferences;
use crate::widgets::context::PanelContext;

/// Width of the column of panels, points.
const COLUMN: f32 = 300.0;
/// Pixels that may look otherwise on another adapter.
const MOST_FAILED: usize = 40;

/// A studio as it is when a painting begins.
pub(crate) fn rig() -> RigState {
    let library = PaintLibrary::measured().expect("the paints that come with it");
    let mut rig = RigState::new("default", &["main".to_owned()], Arc::new(library));
    rig.lay(PaintingSetup::default().scene());
    rig.live.paint = Some(PaintNode {
        status: status(),
        heard_ns: 0,
    });
    rig
}

/// A paint node that has done nothing yet.
pub(crate) fn status() -> PaintStatus {
    PaintStatus {
        journal: 0,
        steps: 0,
        footprint_cells: 0,
        lag_ns: 0,
        longer: 1,
        memory_bytes: 0,
        lost: 0,
        refused: 0,
        baking: 0,
        baked: 0,
        committed: 0,
        undo: 0,
        redo: 0,
        merged: 0,
        kept_bytes: 0,
        fault: String::new(),
        path: String::new(),
        all_committed: true,
        committed_ns: 0,
        blank: true,
        take: false,
        drying: None,
        export: None,
        backend: "cpu".to_owned(),
        history: Vec::new(),
    }
}

/// A paint node with these numbers of steps to undo and to redo.
pub(crate) fn steps(undo: u32, redo: u32) -> PaintStatus {
    PaintStatus {
        undo,
        redo,
        ..status()
    }
}

/// A panel and what it works with.
#[derive(Debug)]
pub(crate) struct Bench<P> {
    pub(crate) panel: P,
    pub(crate) rig: RigState,
    pub(crate) requests: Requests,
    pub(crate) preferences: Preferences,
    pub(crate) notifications: Notifications,
}

impl<P: Panel + Default> Bench<P> {
    pub(crate) fn new(rig: RigState) -> Self {
        Self {
            panel: P::default(),
            rig,
            requests: Requests::default(),
            preferences: Preferences::default(),
            notifications: Notifications::default(),
        }
    }
}

impl<P> Bench<P> {
    /// State that the panel works with.
    pub(crate) fn work(&mut self) -> PanelContext<'_> {
        PanelContext {
            rig: &mut self.rig,
            requests: &mut self.requests,
            preferences: &mut self.preferences,
            notifications: &mut self.notifications,
        }
    }

    /// The commands to the paint node since the last call.
    pub(crate) fn asked(&mut self) -> Vec<Command> {
        let requests = self.requests.take_all().into_iter();
        let paint = |order| match order {
            Request::Command { node, command } if node == maulstick_types::command::PAINT_NODE => {
                command
            }
            other => panic!("not to the paint node: {other:?}"),
        };
        requests.map(paint).collect()
    }
}

/// A panel in a column as wide as the window's.
pub(crate) fn harness<P: Panel + Default + 'static>(rig: RigState) -> Harness<'static, Bench<P>> {
    built(rig, Theme::Dark, 1.0)
}

fn built<P: Panel + Default + 'static>(
    rig: RigState,
    theme: Theme,
    scale: f32,
) -> Harness<'static, Bench<P>> {
    let show = |ui: &mut Ui, bench: &mut Bench<P>| {
        ui.set_width(COLUMN);
        ui.spacing_mut().slider_width = 120.0;
        let mut work = PanelContext {
            rig: &mut bench.rig,
            requests: &mut bench.requests,
            preferences: &mut bench.preferences,
            notifications: &mut bench.notifications,
        };
        bench.panel.show(ui, &mut work);
    };
    let mut harness = Harness::builder()
        .with_size([COLUMN + 16.0, 900.0])
        .with_pixels_per_point(scale)
        .with_theme(theme)
        .wgpu()
        .build_ui_state(show, Bench::new(rig));
    harness.run();
    harness
}

/// Compares a panel with its picture, and sees that `fault` makes another one.
pub(crate) fn picture<P: Panel + Default + 'static>(
    name: &str,
    rig: &RigState,
    prepare: impl Fn(&mut Harness<'static, Bench<P>>),
    fault: impl FnOnce(&mut RigState),
) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/snapshots");
    let options = SnapshotOptions::new()
        .output_path(&folder)
        .threshold(1.0)
        .max_failed_pixels(MOST_FAILED);
    let drawn = |rig: RigState, theme: Theme, scale: f32| {
        let mut harness = built::<P>(rig, theme, scale);
        prepare(&mut harness);
        harness.run();
        harness.fit_contents();
        harness
    };
    // With this variable set, both themes are drawn with finer pixels, to be looked at.
    if let Some(place) = std::env::var_os("MAULSTICK_LOOK") {
        for (theme, word) in [(Theme::Dark, "dark"), (Theme::Light, "light")] {
            let mut harness = drawn(rig.clone(), theme, 2.0);
            let image = harness.render().expect("a picture");
            let path = Path::new(&place).join(format!("{name}_{word}.png"));
            image.save(path).expect("saved");
        }
    }
    let mut harness = drawn(rig.clone(), Theme::Dark, 1.0);
    let good = harness.render().expect("a picture");
    harness.snapshot_options(name, &options);
    let path = folder.join(format!("{name}.png"));
    let kept = std::fs::metadata(&path).expect("the picture").len();
    assert!(kept < 60 * 1024, "{} has {kept} bytes", path.display());
    let mut other = rig.clone();
    fault(&mut other);
    let mut harness = drawn(other, Theme::Dark, 1.0);
    let bad = harness.render().expect("a picture");
    let far = |(one, other): (&u8, &u8)| one.abs_diff(*other) > 32;
    let other = one_by_one(&good, &bad).filter(|pair| far(*pair)).count();
    assert!(
        good.dimensions() != bad.dimensions() || other > 3 * MOST_FAILED,
        "a fault would pass: {other} bytes differ"
    );
}

fn one_by_one<'a>(one: &'a [u8], other: &'a [u8]) -> impl Iterator<Item = (&'a u8, &'a u8)> {
    one.iter().zip(other)
}
