//! State of the rig as the window knows it: plain data, filled by the [`listener`](crate::rig::listener).

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use maulstick_appearance::picture::Export;
use maulstick_brush::BrushFile;
use maulstick_brush::desk::Desk;
use maulstick_optics::PaintLibrary;
use maulstick_rig::Sketches;
use maulstick_types::command::Command;
use maulstick_types::paint::PaintStatus;
use maulstick_types::scene::{BrushHandling, CANVAS, PALETTE, Scene, Surface, Tuning};
use maulstick_types::stylus::{StylusInfo, StylusStatus};
use maulstick_ui_kit::display_transform::DisplayTransform;
use maulstick_ui_kit::swatches::Showing;

use crate::rig::carried_paint::CarriedPaint;
use crate::rig::device_commands::FitProgress;
use crate::rig::device_listing::DeviceListing;
use crate::rig::force_history::ForceHistory;
use crate::rig::health::RigEvent;
use crate::rig::sample_history::SampleHistory;
use crate::rig::thumbnails::Thumbnails;
use crate::sessions::player::ReplayProgress;
use crate::sessions::recorder::RecordingProgress;

/// A brush of the rig.
#[derive(Clone, Debug, Default)]
pub struct RigBrush {
    /// Name as in `rig.toml`.
    pub name: String,
    /// Its brush file, parsed and as text; `None` until its node has sent it.
    pub file: Option<(BrushFile, String)>,
    /// Start of its node: a brush that is started anew has the file of `rig.toml`.
    pub epoch: u32,
    /// The brush file requested for it; `None` once its node has answered.
    pub asked: Option<BrushFile>,
    /// Command for the paint node once the brush has that file, and when it was asked for, rig clock, ns.
    pub then: Option<(Command, u64)>,
    /// The paint on it; `None` until that is known.
    pub carried: Option<CarriedPaint>,
}

/// An input device of the rig.
#[derive(Clone, Debug, Default)]
pub struct Device {
    /// Description of the stylus; `None` until it was received.
    pub info: Option<StylusInfo>,
    /// Status of the stylus; `None` until it was received.
    pub status: Option<StylusStatus>,
    /// Time of its last message, rig clock, ns.
    pub heard_ns: u64,
    /// Its newest samples.
    pub forces: ForceHistory,
    /// What they sensed.
    pub samples: SampleHistory,
}

/// Last known state of a paint node.
#[derive(Clone, Debug)]
pub struct PaintNode {
    /// Its status.
    pub status: PaintStatus,
    /// Time of its last message, rig clock, ns.
    pub heard_ns: u64,
}

/// Whether a brush is on a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BrushContact {
    /// It is lifted.
    Lifted,
    /// A hand has it on a surface.
    Held,
}

/// The rig as the window knows it.
#[derive(Clone, Debug)]
pub struct RigState {
    /// Name of the rig.
    pub rig: String,
    /// The time of the rig, ns.
    pub now_ns: u64,
    /// The scene on the desk; `None` until the paint node has sent it.
    pub scene: Option<Scene>,
    /// The same as brushes see it.
    pub desk: Option<Desk>,
    /// The paint node; `None` until its status was received.
    pub paint: Option<PaintNode>,
    /// The brushes of the rig, in the order of `rig.toml`.
    pub brushes: Vec<RigBrush>,
    /// Index of the brush that the window's mouse moves and its panels show.
    pub in_hand: usize,
    /// Devices by name.
    pub devices: BTreeMap<String, Device>,
    /// Number of starts of the paint node: each invalidates what was remembered of its painting.
    pub starts: u64,
    /// True while another painting is opened, for which nodes are restarted.
    pub switching: bool,
    /// The nodes that are alive, by name.
    pub nodes: Vec<String>,
    /// What is attached; `None` until it was looked for.
    pub listing: Option<DeviceListing>,
    /// A fit of a device to the canvas in progress.
    pub fit: Option<FitProgress>,
    /// A recording in progress that this window began.
    pub recording: Option<RecordingProgress>,
    /// A replay in progress that this window began.
    pub replay: Option<ReplayProgress>,
    /// Pressure that a pen over the window senses now, 0 to 1; `None` while none is near.
    pub pen_pressure: Option<f64>,
    /// True while a change of a device is not in the listing yet.
    pub changes_devices: bool,
    /// Tiles of the view that have arrived of those that are missing, and those in all.
    pub drawn: [u32; 2],
    /// Whether a hand has the brush of the panels on a surface: it is not changed then.
    pub contact: BrushContact,
    /// The sketches of this user, if the system has a folder for them.
    pub sketches: Option<Sketches>,
    /// The paints of the rig.
    pub library: Arc<PaintLibrary>,
    /// True if the wet paint of the canvas is tinted.
    pub show_wet: bool,
    /// Small pictures of the versions.
    pub thumbnails: Thumbnails,
    /// Colours of the window's own things as its display has to be sent them.
    pub tint: Arc<DisplayTransform>,
    /// Events received and not yet notified.
    pub events: Vec<RigEvent>,
}

impl RigState {
    /// A rig without any message so far.
    #[must_use]
    pub fn new(rig: &str, brushes: &[String], library: Arc<PaintLibrary>) -> Self {
        let brush = |name: &String| RigBrush {
            name: name.clone(),
            ..RigBrush::default()
        };
        Self {
            rig: rig.to_owned(),
            now_ns: 0,
            scene: None,
            desk: None,
            paint: None,
            brushes: brushes.iter().map(brush).collect(),
            in_hand: 0,
            devices: BTreeMap::new(),
            starts: 0,
            switching: false,
            nodes: Vec::new(),
            listing: None,
            fit: None,
            recording: None,
            replay: None,
            pen_pressure: None,
            changes_devices: false,
            drawn: [0; 2],
            contact: BrushContact::Lifted,
            sketches: None,
            library,
            show_wet: false,
            thumbnails: Thumbnails::default(),
            tint: Arc::new(DisplayTransform::new(&Export::default())),
            events: Vec::new(),
        }
    }

    /// Puts a scene on the desk.
    pub fn lay(&mut self, scene: Scene) {
        self.desk = Some(Desk::of(&scene));
        self.scene = Some(scene);
    }

    /// What swatches are shown with.
    #[must_use]
    pub fn showing(&self) -> Showing<'_> {
        Showing {
            library: &self.library,
            light: self.scene.as_ref().map(|scene| &scene.light),
            tint: &self.tint,
        }
    }

    /// True if the painting has no name yet: it is in the file of a sketch.
    #[must_use]
    pub fn is_sketch(&self) -> bool {
        let (Some(sketches), Some(node)) = (&self.sketches, &self.paint) else {
            return false;
        };
        sketches.has(Path::new(&node.status.path))
    }

    /// A surface of the scene.
    #[must_use]
    pub fn surface(&self, id: u32) -> Option<&Surface> {
        let mut surfaces = self.scene.as_ref()?.surfaces.iter();
        surfaces.find(|surface| surface.id == id)
    }

    /// The canvas.
    #[must_use]
    pub fn canvas(&self) -> Option<&Surface> {
        self.surface(CANVAS)
    }

    /// The palette.
    #[must_use]
    pub fn palette(&self) -> Option<&Surface> {
        self.surface(PALETTE)
    }

    /// The brush that the panels are about.
    #[must_use]
    pub fn brush(&self) -> Option<&RigBrush> {
        self.brushes.get(self.in_hand)
    }

    /// Its name; "main" if the rig names none.
    #[must_use]
    pub fn brush_name(&self) -> &str {
        self.brush().map_or("main", |brush| brush.name.as_str())
    }

    /// Handling of that brush.
    #[must_use]
    pub fn handling(&self) -> BrushHandling {
        let name = self.brush_name();
        let mut handlings = self.scene.iter().flat_map(|scene| &scene.handlings);
        let own = handlings.find(|handling| handling.brush == name);
        own.cloned().unwrap_or_else(|| BrushHandling::normal(name))
    }

    /// Stiffness and wetness settings of that brush.
    #[must_use]
    pub fn tuning(&self) -> Tuning {
        let name = self.brush_name();
        let mut tunings = self.scene.iter().flat_map(|scene| &scene.tunings);
        let own = tunings.find(|tuning| tuning.brush == name);
        own.cloned().unwrap_or_else(|| Tuning {
            brush: name.to_owned(),
            stiffness: 1.0,
            wetness: 0.0,
        })
    }
}
