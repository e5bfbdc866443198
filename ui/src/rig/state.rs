//! State of the rig as the window knows it.

use std::path::Path;
use std::sync::Arc;

use maulstick_appearance::picture::Export;
use maulstick_brush::BrushFile;
use maulstick_brush::desk::Desk;
use maulstick_client::listener::RigListener;
use maulstick_client::state::LiveRig;
use maulstick_device_setup::listing::DeviceListing;
use maulstick_optics::PaintLibrary;
use maulstick_rig::Sketches;
use maulstick_types::command::Command;
use maulstick_types::scene::{BrushHandling, Tuning};
use maulstick_ui_kit::display_transform::DisplayTransform;
use maulstick_ui_kit::swatches::Showing;

use crate::rig::carried_paint::CarriedPaint;
use crate::rig::device_order::FitProgress;
use crate::sessions::progress::RecordingProgress;
use crate::sessions::progress::ReplayProgress;

/// A brush of the rig.
#[derive(Clone, Debug, Default)]
pub(crate) struct RigBrush {
    /// Name as in `rig.toml`.
    pub name: String,
    /// Its brush file, parsed and as text; `None` until its node has sent it.
    pub file: Option<(BrushFile, String)>,
    /// Start of its node: a brush that is started again has the file of `rig.toml`.
    pub epoch: u32,
    /// The brush file requested for it; `None` once its node has answered.
    pub asked: Option<BrushFile>,
    /// Command for the paint node once the brush has that file, and when it was asked for, rig clock, ns.
    pub then: Option<(Command, u64)>,
    /// The paint on it; `None` until that is known.
    pub carried: Option<CarriedPaint>,
}

/// Contact of a brush with a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum BrushContact {
    Lifted,
    /// A hand has it on a surface.
    Held,
}

impl BrushContact {
    /// The contact of a brush that a hand holds on a surface, or does not.
    #[must_use]
    pub(crate) fn of(is_held: bool) -> Self {
        if is_held { Self::Held } else { Self::Lifted }
    }
}

/// Set-up of the devices, as far as the window shows it.
#[derive(Clone, Debug, Default)]
pub(crate) struct DeviceSetup {
    /// Attached devices; `None` until the first search.
    pub listing: Option<DeviceListing>,
    /// A fit of a device to the canvas in progress.
    pub fit: Option<FitProgress>,
    /// True while a change of a device is not in the listing yet.
    pub is_changing: bool,
}

/// The rig as the window knows it.
#[derive(Clone, Debug)]
pub(crate) struct RigState {
    /// State that its messages report.
    pub live: LiveRig,
    /// The scene on the desk as brushes see it.
    pub desk: Option<Desk>,
    /// The brushes of the rig, in the order of `rig.toml`.
    pub brushes: Vec<RigBrush>,
    /// Index of the brush that the window's mouse moves and its panels show.
    pub in_hand: usize,
    /// True while a hand has the brush of the panels on a surface: it is not changed then.
    pub contact: BrushContact,
    /// Set-up of its devices.
    pub setup: DeviceSetup,
    /// True while another painting is opened, for which nodes are restarted.
    pub switching: bool,
    /// A recording in progress that this window began.
    pub recording: Option<RecordingProgress>,
    /// A replay in progress that this window began.
    pub replay: Option<ReplayProgress>,
    /// Pressure that a pen over the window senses now, 0 to 1; `None` while none is near.
    pub pen_pressure: Option<f64>,
    /// Tiles of the view that have arrived of those that are missing, and those in all.
    pub drawn: [u32; 2],
    /// The sketches of this user, if the system has a folder for them.
    pub sketches: Option<Sketches>,
    /// The paints of the rig.
    pub library: Arc<PaintLibrary>,
    /// True if the wet paint of the canvas is tinted.
    pub show_wet: bool,
    /// Colours of the window's own things as its display has to be sent them.
    pub tint: Arc<DisplayTransform>,
}

impl RigState {
    /// A rig without any message so far.
    #[must_use]
    pub(crate) fn new(rig: &str, brushes: &[String], library: Arc<PaintLibrary>) -> Self {
        let brush = |name: &String| RigBrush {
            name: name.clone(),
            ..RigBrush::default()
        };
        Self {
            live: LiveRig::new(rig),
            desk: None,
            brushes: brushes.iter().map(brush).collect(),
            in_hand: 0,
            contact: BrushContact::Lifted,
            setup: DeviceSetup::default(),
            switching: false,
            recording: None,
            replay: None,
            pen_pressure: None,
            drawn: [0; 2],
            sketches: None,
            library,
            show_wet: false,
            tint: Arc::new(DisplayTransform::new(&Export::default())),
        }
    }

    /// Reads what the messages of the rig say.
    pub(crate) fn drain(&mut self, listener: &mut RigListener, now_ns: u64) {
        if listener.drain(now_ns, &mut self.live) {
            self.desk = self.live.scene.as_ref().map(Desk::of);
        }
        for definition in std::mem::take(&mut self.live.definitions) {
            // The renderer of the brush reports a file that cannot be read.
            let Ok(file) = BrushFile::parse(&definition.toml) else {
                continue;
            };
            let mut brushes = self.brushes.iter_mut();
            if let Some(known) = brushes.find(|known| known.name == definition.brush) {
                known.asked.take_if(|asked| *asked == file);
                (known.file, known.epoch) = (Some((file, definition.toml)), definition.epoch);
            }
        }
    }

    /// Puts a scene on the desk.
    #[cfg(test)]
    pub(crate) fn lay(&mut self, scene: maulstick_types::scene::Scene) {
        self.desk = Some(Desk::of(&scene));
        self.live.scene = Some(scene);
    }

    /// Light and gamut that swatches are shown with.
    #[must_use]
    pub(crate) fn showing(&self) -> Showing<'_> {
        Showing {
            library: &self.library,
            light: self.live.scene.as_ref().map(|scene| &scene.light),
            tint: &self.tint,
        }
    }

    /// True if the painting has no name yet: it is in the file of a sketch.
    #[must_use]
    pub(crate) fn is_sketch(&self) -> bool {
        let (Some(sketches), Some(node)) = (&self.sketches, &self.live.paint) else {
            return false;
        };
        sketches.has(Path::new(&node.status.path))
    }

    /// The brush that the panels are about.
    #[must_use]
    pub(crate) fn brush(&self) -> Option<&RigBrush> {
        self.brushes.get(self.in_hand)
    }

    /// Its name; "main" if the rig names none.
    #[must_use]
    pub(crate) fn brush_name(&self) -> &str {
        self.brush().map_or("main", |brush| brush.name.as_str())
    }

    /// Handling of that brush.
    #[must_use]
    pub(crate) fn handling(&self) -> BrushHandling {
        let name = self.brush_name();
        let mut handlings = self.live.scene.iter().flat_map(|scene| &scene.handlings);
        let own = handlings.find(|handling| handling.brush == name);
        own.cloned().unwrap_or_else(|| BrushHandling::normal(name))
    }

    /// Stiffness and wetness settings of that brush.
    #[must_use]
    pub(crate) fn tuning(&self) -> Tuning {
        let name = self.brush_name();
        let mut tunings = self.live.scene.iter().flat_map(|scene| &scene.tunings);
        let own = tunings.find(|tuning| tuning.brush == name);
        own.cloned().unwrap_or_else(|| Tuning {
            brush: name.to_owned(),
            stiffness: 1.0,
            wetness: 0.0,
        })
    }
}
