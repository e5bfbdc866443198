//! What tests of panels share.

use std::path::Path;
use std::sync::Arc;

use eframe::egui::{Theme, Ui};
use egui_kittest::{Harness, SnapshotOptions};
use maulstick_optics::PaintLibrary;
use maulstick_paint::PaintingSetup;
use maulstick_types::command::Command;
use maulstick_types::paint::PaintStatus;

use crate::panels::Panel;
use crate::rig::requests::{Order, Orders};
use crate::rig::state::{PaintNode, Studio};
use crate::settings::preferences::Habits;
use crate::widgets::context::Work;
use crate::widgets::notifications::Toasts;

/// Width of the column of panels, points.
const COLUMN: f32 = 300.0;
/// Pixels that may look otherwise on another adapter.
const MOST_FAILED: usize = 40;

/// A studio as it is when a painting begins.
pub(crate) fn studio() -> Studio {
    let library = PaintLibrary::measured().expect("the paints that come with it");
    let mut studio = Studio::new("default", &["main".to_owned()], Arc::new(library));
    studio.lay(PaintingSetup::default().scene());
    studio.paint = Some(PaintNode {
        status: status(),
        heard_ns: 0,
    });
    studio
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
    }
}

/// A paint node with so many steps to undo and to redo.
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
    pub(crate) studio: Studio,
    pub(crate) orders: Orders,
    pub(crate) habits: Habits,
    pub(crate) toasts: Toasts,
}

impl<P: Panel + Default> Bench<P> {
    pub(crate) fn new(studio: Studio) -> Self {
        Self {
            panel: P::default(),
            studio,
            orders: Orders::default(),
            habits: Habits::default(),
            toasts: Toasts::default(),
        }
    }
}

impl<P> Bench<P> {
    /// The commands to the paint node since the last call.
    pub(crate) fn asked(&mut self) -> Vec<Command> {
        let orders = self.orders.take().into_iter();
        let paint = |order| match order {
            Order::Command { node, command } if node == crate::rig::requests::PAINT => command,
            other => panic!("not to the paint node: {other:?}"),
        };
        orders.map(paint).collect()
    }
}

/// A panel in a column as wide as the window's.
pub(crate) fn harness<P: Panel + Default + 'static>(studio: Studio) -> Harness<'static, Bench<P>> {
    built(studio, Theme::Dark, 1.0)
}

fn built<P: Panel + Default + 'static>(
    studio: Studio,
    theme: Theme,
    scale: f32,
) -> Harness<'static, Bench<P>> {
    let show = |ui: &mut Ui, bench: &mut Bench<P>| {
        ui.set_width(COLUMN);
        ui.spacing_mut().slider_width = 120.0;
        let mut work = Work {
            studio: &mut bench.studio,
            orders: &mut bench.orders,
            habits: &mut bench.habits,
            toasts: &mut bench.toasts,
        };
        bench.panel.show(ui, &mut work);
    };
    let mut harness = Harness::builder()
        .with_size([COLUMN + 16.0, 900.0])
        .with_pixels_per_point(scale)
        .with_theme(theme)
        .wgpu()
        .build_ui_state(show, Bench::new(studio));
    harness.run();
    harness
}

/// Compares a panel with its picture, and sees that `fault` makes another one.
pub(crate) fn picture<P: Panel + Default + 'static>(
    name: &str,
    studio: &Studio,
    prepare: impl Fn(&mut Harness<'static, Bench<P>>),
    fault: impl FnOnce(&mut Studio),
) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/snapshots");
    let options = SnapshotOptions::new()
        .output_path(&folder)
        .threshold(1.0)
        .max_failed_pixels(MOST_FAILED);
    let drawn = |studio: Studio, theme: Theme, scale: f32| {
        let mut harness = built::<P>(studio, theme, scale);
        prepare(&mut harness);
        harness.run();
        harness.fit_contents();
        harness
    };
    // Where somebody wants to look at it: both themes, and finer pixels.
    if let Some(place) = std::env::var_os("MAULSTICK_LOOK") {
        for (theme, word) in [(Theme::Dark, "dark"), (Theme::Light, "light")] {
            let mut harness = drawn(studio.clone(), theme, 2.0);
            let image = harness.render().expect("a picture");
            let path = Path::new(&place).join(format!("{name}_{word}.png"));
            image.save(path).expect("saved");
        }
    }
    let mut harness = drawn(studio.clone(), Theme::Dark, 1.0);
    let good = harness.render().expect("a picture");
    harness.snapshot_options(name, &options);
    let path = folder.join(format!("{name}.png"));
    let kept = std::fs::metadata(&path).expect("the picture").len();
    assert!(kept < 60 * 1024, "{} has {kept} bytes", path.display());
    let mut other = studio.clone();
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
