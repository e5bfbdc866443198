//! Brushes over the surfaces: shadows, head, ferrule and handle.

use std::collections::BTreeMap;
use std::sync::Arc;

use eframe::egui::{Pos2, Shape};
use eframe::egui_wgpu::wgpu;
use glam::{DVec3, Vec2, Vec3};
use maulstick_appearance::picture::Export;
use maulstick_brush::desk::{Desk, Plane};
use maulstick_brush::{Head, HeadPose, Hold};
use maulstick_num::geometry::Rigid;
use maulstick_optics::light::Lamp;
use maulstick_types::scene::{CANVAS, PALETTE};
use maulstick_ui_kit::display_transform::DisplayTransform;

use crate::render::brush::bristles::{Bristles, ribbons, tones};
use crate::render::brush::cast_shadow::{Board, CastShadow, Chain, On, Projection, ShadowSlot};
use crate::render::brush::geometry::{
    Section, casters, head_discs, is_wide, sections, shaded_sections, shadow,
};
use crate::render::brush::handle::{Finish, handle};
use crate::render::brush::paint_colour::PaintColour;
use crate::render::gpu::Gpu;
use crate::render::view_light::ViewLight;
use crate::rig::brushes::BrushPose;
use crate::view::camera::View;

/// Surfaces and view under the brushes.
pub struct Below<'a> {
    /// View of the desk in the window.
    pub view: &'a View,
    /// Pixels a point.
    pub pixels_per_point: f32,
    /// The surfaces, on which shadows fall.
    pub desk: &'a Desk,
    /// Desk and surfaces as pixels of the view, where they are drawn.
    pub pixels: Option<&'a wgpu::TextureView>,
}

/// Buffers of a brush that last from frame to frame.
#[derive(Debug, Default)]
struct Kept {
    slots: Vec<ShadowSlot>,
    /// The paint on it, and the same on a head with this number of strips, as the display takes it.
    coat: Option<(Arc<PaintColour>, usize, PaintColour)>,
}

/// Draws brushes.
#[derive(Debug)]
pub struct BrushRenderer {
    passes: CastShadow,
    kept: BTreeMap<String, Kept>,
    pose: HeadPose,
    tint: DisplayTransform,
    finish: Finish,
}

impl BrushRenderer {
    /// Draws on a device, for the display of `export`.
    #[must_use]
    pub fn new(gpu: &Gpu, export: &Export) -> Self {
        let tint = DisplayTransform::new(export);
        Self {
            passes: CastShadow::new(gpu),
            kept: BTreeMap::new(),
            pose: HeadPose::default(),
            finish: Finish::default().tinted(&tint),
            tint,
        }
    }

    /// The shapes of a brush, from the lowest: under `lamp`, in the frame of the surface below it.
    #[must_use]
    pub fn shapes(
        &mut self,
        gpu: &Gpu,
        held: &BrushPose<'_>,
        head: &Head,
        lamp: &Lamp,
        below: &Below<'_>,
    ) -> Vec<Shape> {
        let hold = Hold {
            brush: &held.brush,
            angles: &held.angles,
            per_m: 1.0,
            wetness: held.wetness,
        };
        head.pose(&hold, &mut self.pose);
        let sections = sections(&held.brush, held.file);
        let mut shapes = self.shadows(gpu, held, (head, &sections), lamp, below);
        let to_window =
            |local: Vec3| -> Pos2 { below.view.to_window(held.on_desk(local.as_dvec3().into())) };
        let ferrule = held.plane.to_desk.point(held.brush.translation);
        let scale = below.view.scale_at(ferrule.z);
        let sight = ViewLight {
            to_window: &to_window,
            scale: scale as f32,
            up: held.plane.to_desk.inverse().vector(DVec3::Z).as_vec3(),
            toward: Vec3::from_array(lamp.toward),
            light: lamp.intensity,
        };
        let kept = self.kept.entry(held.name.to_owned()).or_default();
        let bristles = Bristles {
            width_m: held.file.strips.width_mm as f32 * 1e-3,
            taper: held.file.strips.taper as f32,
            hair: held.file.head.hair,
            tones: tones(held.file.head.hair).map(|tone| self.tint.seen(tone)),
            coat: kept
                .tinted(held.coat.as_ref(), &self.tint, head)
                .filter(|coat| coat.strips() == head.strips()),
        };
        shapes.push(ribbons(&self.pose, head.strips(), &bristles, &sight).into());
        shapes.push(handle(&sections, &self.finish, &sight).into());
        shapes
    }

    /// The shadows of a brush on canvas and palette, which is above it.
    fn shadows(
        &mut self,
        gpu: &Gpu,
        held: &BrushPose<'_>,
        (head, sections): (&Head, &[Section]),
        lamp: &Lamp,
        below: &Below<'_>,
    ) -> Vec<Shape> {
        let on_desk = |p: DVec3| held.plane.to_desk.point(p);
        let head = head_discs(&self.pose, head.roots(), is_wide(held.file));
        let toward = DVec3::from_array(lamp.toward.map(f64::from));
        let toward = held.plane.to_desk.vector(toward);
        let board = below
            .desk
            .plane(PALETTE)
            .map(|plane| (plane, board(plane, below)));
        let kept = self.kept.entry(held.name.to_owned()).or_default();
        let mut shapes = Vec::new();
        let mut slots = 0;
        let mut cast = |plane: &Plane, on: On, shapes: &mut Vec<Shape>| {
            let to_plane = plane.to_desk.inverse();
            let there = |p: DVec3| to_plane.point(on_desk(p));
            let sections = held.sections_on(plane, sections);
            let to_window = |p: DVec3| below.view.to_window(plane.to_desk.point(p));
            let projection = Projection {
                view: below.view,
                pixels_per_point: below.pixels_per_point,
                to_window: &to_window,
            };
            for caster in casters(to_plane.vector(toward)) {
                let mut discs: Vec<(DVec3, f64)> = head
                    .iter()
                    .map(|(at, radius)| (there(*at), *radius))
                    .collect();
                discs.extend(shaded_sections(&sections, caster.run()));
                let chain = Chain::of(&shadow(&discs, &caster), &projection, on);
                let reaches = match on {
                    On::Board(board) => chain.reaches(&board),
                    On::All | On::Beside(_) => true,
                };
                if !chain.is_visible() || !reaches {
                    continue;
                }
                let slot = kept.slot(slots, || self.passes.slot(gpu));
                slots += 1;
                let drawn = self
                    .passes
                    .cast(gpu, slot, below.pixels, (&chain, discs.len()));
                shapes.push(drawn.shape(below.view));
            }
        };
        if let Some(canvas) = below.desk.plane(CANVAS) {
            let on = board.map_or(On::All, |(_, board)| On::Beside(board));
            cast(canvas, on, &mut shapes);
        }
        if let Some((palette, board)) = board {
            cast(palette, On::Board(board), &mut shapes);
        }
        shapes
    }
}

impl BrushPose<'_> {
    /// Sections of the handle in the frame of another surface.
    fn sections_on(&self, plane: &Plane, sections: &[Section]) -> Vec<Section> {
        let (to_plane, to_desk) = (plane.to_desk.inverse(), &self.plane.to_desk);
        let there = |section: &Section| Section {
            at: to_plane.point(to_desk.point(section.at)),
            half: section.half.map(|v| to_plane.vector(to_desk.vector(v))),
            ..*section
        };
        sections.iter().map(there).collect()
    }
}

impl Kept {
    /// The slot of a number, at most one more than there are.
    fn slot(&mut self, number: usize, new: impl FnOnce() -> ShadowSlot) -> &mut ShadowSlot {
        if self.slots.len() == number {
            self.slots.push(new());
        }
        &mut self.slots[number]
    }

    /// The paint on the brush as the display takes it.
    fn tinted(
        &mut self,
        coat: Option<&Arc<PaintColour>>,
        tint: &DisplayTransform,
        head: &Head,
    ) -> Option<&PaintColour> {
        let coat = coat?;
        let strips = head.strips();
        let is_kept =
            |(of, on, _): &(Arc<PaintColour>, usize, _)| Arc::ptr_eq(of, coat) && *on == strips;
        if !self.coat.as_ref().is_some_and(is_kept) {
            self.coat = Some((Arc::clone(coat), strips, coat.tinted(tint).on(head)));
        }
        self.coat.as_ref().map(|(_, _, tinted)| tinted)
    }
}

/// Board of a palette in the view.
fn board(plane: &Plane, below: &Below<'_>) -> Board {
    let [width, height] = plane.size_m.map(|side| side * plane.zoom);
    let to_desk: &Rigid = &plane.to_desk;
    let corner = |x: f64, y: f64| {
        let at = below.view.to_window(to_desk.point(DVec3::new(x, y, 0.0)));
        let off = (at - below.view.area.min) * below.pixels_per_point;
        Vec2::new(off.x, off.y)
    };
    let per_m = plane.zoom * below.view.scale * f64::from(below.pixels_per_point);
    Board {
        corners: [corner(0.0, 0.0), corner(width, 0.0), corner(0.0, height)],
        radii: plane.radii_m.map(|radius_m| (radius_m * per_m) as f32),
    }
}

#[cfg(test)]
mod tests;
