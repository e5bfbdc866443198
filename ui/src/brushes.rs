//! The brushes over the surfaces: shadow, head, ferrule and handle of each.

use std::collections::BTreeMap;

use eframe::egui::{Pos2, Shape};
use maulstick_brush::{Head, HeadPose, Hold};
use maulstick_optics::light::Lamp;
use maulstick_paint::picture::Export;

use crate::brush_shape::{handle_width_m, head_discs, is_wide, sections, shadow};
use crate::draw_brush::{Chain, ChainSlot, DrawBrush, Projection};
use crate::draw_head::{HeadView, ribbons, tones};
use crate::follow::Held;
use crate::gpu::Gpu;
use crate::tint::Tint;
use crate::view::View;

/// Places on the device for a brush.
#[derive(Debug)]
struct Slots {
    shadow: ChainSlot,
    solid: ChainSlot,
}

/// Draws brushes.
#[derive(Debug)]
pub struct Brushes {
    passes: DrawBrush,
    slots: BTreeMap<String, Slots>,
    pose: HeadPose,
    tint: Tint,
}

impl Brushes {
    /// Draws on a device, for the display of `export`.
    #[must_use]
    pub fn new(gpu: &Gpu, export: &Export) -> Self {
        Self {
            passes: DrawBrush::new(gpu),
            slots: BTreeMap::new(),
            pose: HeadPose::default(),
            tint: Tint::new(export),
        }
    }

    /// The shapes of a brush, from the lowest: under `lamp`, in the projection of the surface below it.
    #[must_use]
    pub fn shapes(
        &mut self,
        gpu: &Gpu,
        held: &Held<'_>,
        head: &Head,
        lamp: &Lamp,
        view: &View,
        pixels_per_point: f32,
    ) -> Vec<Shape> {
        let to_window = |local: [f64; 3]| -> Pos2 { view.to_window(held.on_desk(local)) };
        let hold = Hold {
            brush: &held.brush,
            angles: &held.angles,
            per_m: 1.0,
            wetness: held.wetness,
        };
        head.pose(&hold, &mut self.pose);
        let root_m = held.file.radius_m(0.0).max(held.file.half_thickness_m(0.0));
        let sections = sections(&held.brush, handle_width_m(held.file), root_m);
        // The shadow goes from the point of the head to the end of the handle.
        let mut discs = head_discs(&self.pose, head.roots(), is_wide(held.file));
        discs.extend(sections.iter().map(|section| (section.at, section.radius)));
        let projection = Projection {
            view,
            pixels_per_point,
            to_window: &to_window,
            toward: lamp.toward,
        };
        let strips = HeadView {
            to_window: &|local| to_window(local.map(f64::from)),
            scale: view.scale as f32,
            bristle_m: held.file.strips.width_mm as f32 * 1e-3,
            hair: held.file.head.hair,
            tones: tones(held.file.head.hair).map(|tone| self.tint.encoded(tone)),
            toward: lamp.toward,
        };
        let slots = self
            .slots
            .entry(held.name.to_owned())
            .or_insert_with(|| Slots {
                shadow: self.passes.slot(gpu),
                solid: self.passes.slot(gpu),
            });
        let mut shapes = Vec::new();
        let chain = Chain::shadow(&shadow(&discs, lamp.toward), &projection);
        if chain.is_visible() {
            shapes.push(self.passes.cast(gpu, &slots.shadow, &chain).shape(view));
        }
        shapes.push(ribbons(&self.pose, head.strips(), &strips).into());
        let chain = Chain::solid(&sections, &projection).tinted(&self.tint);
        if chain.is_visible() {
            shapes.push(self.passes.solid(gpu, &slots.solid, &chain).shape(view));
        }
        shapes
    }
}
