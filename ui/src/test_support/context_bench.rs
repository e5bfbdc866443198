//! A rig in memory, and a window that shows the rack or a panel.

use std::sync::Arc;

use eframe::egui::{Theme, Ui, Vec2, vec2};
use egui_kittest::{Harness, SnapshotOptions};
use maulstick_brush::BrushFile;
use maulstick_optics::PaintLibrary;
use maulstick_painting::PaintingSetup;
use maulstick_types::command::Command;
use maulstick_ui_kit::notifications::Notifications;

use maulstick_client::request::Request;

use crate::panels::Panel;
use crate::rig::requests::Requests;
use crate::rig::state::RigState;
use crate::settings::preferences::Preferences;
use crate::widgets::context::PanelContext;

/// A rig with a new painting and two brushes, of which the first is the library's round one.
pub(crate) fn rig() -> RigState {
    let library = Arc::new(PaintLibrary::measured().expect("whole"));
    let names = ["main", "other"].map(str::to_owned);
    let mut rig = RigState::new("test", &names, library);
    rig.lay(PaintingSetup::default().scene());
    for (brush, kind) in rig.brushes.iter_mut().zip(["round", "flat"]) {
        let text = BrushFile::library_text(kind).expect(kind);
        let file = BrushFile::library(kind).expect(kind);
        brush.file = Some((file, text.to_owned()));
    }
    rig
}

/// Pixels of a picture that another adapter may draw otherwise.
const FAILED: usize = 40;

/// Context of a panel.
#[derive(Debug)]
pub(crate) struct Bench {
    pub(crate) rig: RigState,
    pub(crate) requests: Requests,
    pub(crate) preferences: Preferences,
    pub(crate) notifications: Notifications,
}

impl Bench {
    pub(crate) fn new() -> Self {
        Self {
            rig: rig(),
            requests: Requests::default(),
            preferences: Preferences::default(),
            notifications: Notifications::default(),
        }
    }

    pub(crate) fn work(&mut self) -> PanelContext<'_> {
        PanelContext {
            rig: &mut self.rig,
            requests: &mut self.requests,
            preferences: &mut self.preferences,
            notifications: &mut self.notifications,
        }
    }

    /// Commands that were asked for since the last call.
    pub(crate) fn commands(&mut self) -> Vec<Command> {
        let requests = self.requests.take_all().into_iter();
        let command = |order| match order {
            Request::Command { command, .. } => Some(command),
            Request::Force { .. } => None,
        };
        requests.filter_map(command).collect()
    }

    /// Texts of the notifications.
    pub(crate) fn told(&self) -> Vec<&str> {
        let notifications = self.notifications.shown().iter();
        notifications.map(|toast| toast.what.as_str()).collect()
    }
}

/// A window that shows `show` on a bench.
pub(crate) fn window<'a>(
    size: Vec2,
    bench: Bench,
    mut show: impl FnMut(&mut Ui, &mut PanelContext<'_>) + 'a,
) -> Harness<'a, Bench> {
    Harness::builder()
        .with_size(size)
        .with_theme(Theme::Dark)
        .with_max_steps(16)
        .wgpu()
        .build_ui_state(
            move |ui, bench: &mut Bench| show(ui, &mut bench.work()),
            bench,
        )
}

/// A window as wide as the column of panels that shows a panel.
pub(crate) fn harness<'a>(mut panel: impl Panel + 'a, bench: Bench) -> Harness<'a, Bench> {
    window(vec2(300.0, 1000.0), bench, move |ui, work| {
        ui.spacing_mut().slider_width = 120.0;
        panel.show(ui, work);
    })
}

/// Folder of the pictures, and the tolerance for other adapters.
pub(crate) fn pictures() -> SnapshotOptions {
    SnapshotOptions::new()
        .threshold(1.0)
        .max_failed_pixels(FAILED)
        .output_path("tests/snapshots")
}

/// True if two windows differ beyond the tolerance of the pictures.
pub(crate) fn differ(one: &mut Harness<'_, Bench>, other: &mut Harness<'_, Bench>) -> bool {
    let (one, other) = (one.render(), other.render());
    let [one, other] = [one, other].map(|drawn| drawn.expect("a picture"));
    let pixels = |raw: &[u8]| raw.chunks_exact(4).map(<[u8]>::to_vec).collect::<Vec<_>>();
    let [one, other] = [pixels(one.as_raw()), pixels(other.as_raw())];
    let apart = one.iter().zip(&other).filter(|(a, b)| a != b).count();
    one.len() != other.len() || apart > FAILED
}
