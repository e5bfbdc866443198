//! Draws ferrule and handle of a brush, and the shadow of the whole.

use bytemuck::{Pod, Zeroable};
use eframe::egui::{PaintCallbackInfo, Pos2, Shape};
use eframe::egui_wgpu::{self, CallbackResources, CallbackTrait, wgpu};
use glam::Vec2;

use crate::brush_shape::{HEAD_DISCS, Material, SECTIONS, Section, Shade};
use crate::gpu::{Gpu, Pass, UNIFORM};
use crate::tint::Tint;
use crate::view::View;

/// Nodes of a chain at most, as in the shader.
const NODES: usize = 24;
/// Discs of a shadow: those of the head, then those of ferrule and handle.
pub const SHADES: usize = HEAD_DISCS + SECTIONS;
/// Softness that keeps an edge from being jagged, pixels.
const EDGE: f32 = 0.7;
/// Linear colour of nickel and of lacquered wood.
const NICKEL: [f32; 3] = [0.62, 0.62, 0.60];
const LACQUER: [f32; 3] = [0.60, 0.19, 0.05];
/// Heights between which the handle fades, so that it does not hide the painting, and what is left
/// of it above, m.
const FADES_M: [f64; 2] = [0.06, 0.16];
const FADED: f32 = 0.35;

/// A node of a chain.
#[derive(Clone, Copy, Debug, Default)]
struct Node {
    /// x, y, radius; then height or softness, pixels.
    disc: [f32; 4],
    /// Of what begins here; then opacity or darkness.
    colour: [f32; 4],
    /// 1 for metal.
    metal: f32,
}

/// A chain of discs as the shader takes it.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Chain {
    view: [f32; 2],
    _pad: [f32; 2],
    corner: [f32; 4],
    sides: [f32; 4],
    toward: [f32; 4],
    half: [f32; 4],
    nodes: [[f32; 4]; NODES],
    colours: [[f32; 4]; NODES],
    finishes: [[f32; 4]; NODES],
}

/// From the projection of a surface to pixels of the view.
pub struct Projection<'a> {
    /// The view.
    pub view: &'a View,
    /// Pixels a point.
    pub pixels_per_point: f32,
    /// From the surface's projection to the window, points.
    pub to_window: &'a dyn Fn([f64; 3]) -> Pos2,
    /// Unit vector toward the lamp, surface projection.
    pub toward: [f32; 3],
}

impl Projection<'_> {
    fn pixels(&self, at: [f64; 3]) -> [f32; 2] {
        let off = ((self.to_window)(at) - self.view.area.min) * self.pixels_per_point;
        off.into()
    }

    fn pixels_per_m(&self) -> f64 {
        self.view.scale * f64::from(self.pixels_per_point)
    }

    /// A direction of the surface in the view, y downward.
    fn direction(&self, of: [f32; 3]) -> [f32; 4] {
        let far = |v: [f32; 3]| self.pixels(v.map(f64::from));
        let (from, to) = (far([0.0; 3]), far(of));
        let scale = self.pixels_per_m() as f32;
        let (x, y) = ((to[0] - from[0]) / scale, (to[1] - from[1]) / scale);
        let z = (1.0 - x * x - y * y).max(0.0).sqrt();
        [x, y, z, 0.0]
    }
}

impl Chain {
    fn new(projection: &Projection<'_>, nodes: &[Node]) -> Self {
        let toward = projection.direction(projection.toward);
        let [x, y, z, _] = toward;
        let length = (x * x + y * y + (z + 1.0) * (z + 1.0)).sqrt();
        let mut chain = Self {
            view: (projection.view.area.size() * projection.pixels_per_point).into(),
            toward,
            half: [x / length, y / length, (z + 1.0) / length, 0.0],
            ..Self::zeroed()
        };
        // The shader takes all nodes of its kind of chain: a short one goes on where it ends.
        let mut last = Node::default();
        for i in 0..NODES {
            last = nodes.get(i).copied().unwrap_or(last);
            chain.nodes[i] = last.disc;
            chain.colours[i] = last.colour;
            chain.finishes[i] = [last.metal, 0.0, 0.0, 0.0];
        }
        chain
    }

    /// Gives the chain the box that holds its discs with `margin(disc)` around each, along the way
    /// from its first node to its last: a slanting one would fill little of an upright box.
    fn bounded(mut self, margin: impl Fn(&[f32; 4]) -> f32) -> Self {
        let place = |disc: &[f32; 4]| Vec2::new(disc[0], disc[1]);
        let (first, last) = (place(&self.nodes[0]), place(&self.nodes[NODES - 1]));
        let ahead = (last - first).normalize_or(Vec2::X);
        let axes = [ahead, ahead.perp()];
        let (mut low, mut high) = ([f32::MAX; 2], [f32::MIN; 2]);
        for disc in &self.nodes {
            let reach = disc[2] + margin(disc);
            for i in 0..2 {
                let at = place(disc).dot(axes[i]);
                (low[i], high[i]) = (low[i].min(at - reach), high[i].max(at + reach));
            }
        }
        let corner = axes[0] * low[0] + axes[1] * low[1];
        let [along, across] = [0, 1].map(|i| axes[i] * (high[i] - low[i]));
        self.corner = [corner.x, corner.y, 0.0, 0.0];
        self.sides = [along.x, along.y, across.x, across.y];
        self
    }

    /// Ferrule and handle.
    #[must_use]
    pub fn solid(sections: &[Section; SECTIONS], projection: &Projection<'_>) -> Self {
        let scale = projection.pixels_per_m();
        let node = |section: &Section| {
            let [x, y] = projection.pixels(section.at.to_array());
            let ([r, g, b], metal) = match section.material {
                Material::Metal => (NICKEL, 1.0),
                Material::Groove => (NICKEL.map(|channel| 0.35 * channel), 1.0),
                Material::Wood => (LACQUER, 0.0),
            };
            let fade = (section.at.z - FADES_M[0]) / (FADES_M[1] - FADES_M[0]);
            let opacity = 1.0 - (1.0 - FADED) * fade.clamp(0.0, 1.0) as f32;
            let [radius, height] = [section.radius, section.at.z].map(|m| (m * scale) as f32);
            Node {
                disc: [x, y, radius, height],
                colour: [r, g, b, opacity],
                metal,
            }
        };
        Self::new(projection, &sections.each_ref().map(node)).bounded(|_| 1.0)
    }

    /// In colours as the display takes them.
    #[must_use]
    pub fn tinted(mut self, tint: &Tint) -> Self {
        for colour in &mut self.colours {
            let [r, g, b, opacity] = *colour;
            let [r, g, b] = tint.linear([r, g, b]);
            *colour = [r, g, b, opacity];
        }
        self
    }

    /// The shadow of at most [`SHADES`] discs.
    #[must_use]
    pub fn shadow(shades: &[Shade], projection: &Projection<'_>) -> Self {
        let scale = projection.pixels_per_m();
        let node = |shade: &Shade| {
            let [x, y] = projection.pixels(shade.at.extend(0.0).to_array());
            let [radius, softness] = [shade.radius, shade.softness].map(|m| (m * scale) as f32);
            Node {
                disc: [x, y, radius, softness + EDGE],
                colour: [0.0, 0.0, 0.0, shade.darkness as f32],
                metal: 0.0,
            }
        };
        let nodes: Vec<Node> = shades.iter().take(SHADES).map(node).collect();
        Self::new(projection, &nodes).bounded(|disc| disc[3])
    }

    /// Whether any of its box may be in the view.
    #[must_use]
    pub fn is_visible(&self) -> bool {
        (0..2).all(|i| {
            let (a, b) = (self.sides[i], self.sides[i + 2]);
            let low = self.corner[i] + a.min(0.0) + b.min(0.0);
            let high = self.corner[i] + a.max(0.0) + b.max(0.0);
            low < self.view[i] && high > 0.0
        })
    }
}

/// The passes.
#[derive(Clone, Debug)]
pub struct DrawBrush {
    layout: wgpu::BindGroupLayout,
    cast: wgpu::RenderPipeline,
    solid: wgpu::RenderPipeline,
}

impl DrawBrush {
    /// The passes on a device.
    #[must_use]
    pub fn new(gpu: &Gpu) -> Self {
        let layout = gpu.layout("draw_brush", &[UNIFORM]);
        let shader = gpu.shader("draw_brush", include_str!("shaders/draw_brush.wgsl"));
        let pipeline = |fragment: &'static str, count: usize| {
            gpu.pipeline(&Pass {
                name: "draw_brush",
                layout: &layout,
                shader: &shader,
                vertex: "cover",
                fragment,
                constants: &[gpu.encoding(), ("count", count as f64)],
                target: gpu.target,
                blend: Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
            })
        };
        Self {
            cast: pipeline("shadow", SHADES),
            solid: pipeline("solid", SECTIONS),
            layout,
        }
    }

    /// A place on the device for a chain of one brush.
    #[must_use]
    pub fn slot(&self, gpu: &Gpu) -> ChainSlot {
        let chain = gpu.uniform::<Chain>("chain");
        let bound = gpu.bind(&self.layout, &[chain.as_entire_binding()]);
        ChainSlot { chain, bound }
    }

    /// Makes ready to draw what [`Chain::shadow`] made.
    #[must_use]
    pub fn cast(&self, gpu: &Gpu, slot: &ChainSlot, chain: &Chain) -> Drawn {
        slot.drawn(gpu, &self.cast, chain)
    }

    /// Makes ready to draw what [`Chain::solid`] made.
    #[must_use]
    pub fn solid(&self, gpu: &Gpu, slot: &ChainSlot, chain: &Chain) -> Drawn {
        slot.drawn(gpu, &self.solid, chain)
    }
}

/// Where a chain lies on the device.
#[derive(Debug)]
pub struct ChainSlot {
    chain: wgpu::Buffer,
    bound: wgpu::BindGroup,
}

impl ChainSlot {
    fn drawn(&self, gpu: &Gpu, pipeline: &wgpu::RenderPipeline, chain: &Chain) -> Drawn {
        gpu.queue
            .write_buffer(&self.chain, 0, bytemuck::bytes_of(chain));
        Drawn {
            pipeline: pipeline.clone(),
            bound: self.bound.clone(),
        }
    }
}

/// A chain that waits to be drawn into the window.
#[derive(Debug)]
pub struct Drawn {
    pipeline: wgpu::RenderPipeline,
    bound: wgpu::BindGroup,
}

impl Drawn {
    /// Draws into a pass whose viewport is the view.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.bound, &[]);
        pass.draw(0..4, 0..1);
    }

    /// As a shape of the window that fills the view.
    pub fn shape(self, view: &View) -> Shape {
        egui_wgpu::Callback::new_paint_callback(view.area, self).into()
    }
}

impl CallbackTrait for Drawn {
    fn paint(
        &self,
        _info: PaintCallbackInfo,
        pass: &mut wgpu::RenderPass<'static>,
        _resources: &CallbackResources,
    ) {
        self.draw(pass);
    }
}

#[cfg(test)]
mod tests {
    use eframe::egui::{Rect, pos2, vec2};
    use glam::{DVec2, DVec3};
    use maulstick_num::geometry::{Rigid, shortest_arc};

    use super::*;
    use crate::brush_shape::{sections, shadow};
    use crate::gpu::testing::{draw, gpu, read, target};

    const SIDE: u32 = 200;
    const WHITE: wgpu::Color = wgpu::Color::WHITE;

    /// The lightness of a brush that is held upright at the middle of the view, or leans by `lean`
    /// there, one pixel a mm.
    struct Picture {
        lightness: Vec<u8>,
    }

    impl Picture {
        fn of(
            gpu: &Gpu,
            lean: DVec2,
            toward: [f32; 3],
            which: fn(&DrawBrush, &Gpu, &ChainSlot, &[Section; SECTIONS], &Projection<'_>) -> Drawn,
        ) -> Self {
            let view = View {
                area: Rect::from_min_size(pos2(0.0, 0.0), vec2(SIDE as f32, SIDE as f32)),
                middle: DVec2::ZERO,
                scale: 1000.0,
            };
            let to_window = |at: [f64; 3]| view.to_window(DVec3::from_array(at));
            let projection = Projection {
                view: &view,
                pixels_per_point: 1.0,
                to_window: &to_window,
                toward,
            };
            let brush = Rigid {
                rotation: shortest_arc(DVec3::Z, lean.extend(1.0).normalize()),
                translation: DVec3::new(0.0, 0.0, 0.01),
            };
            let passes = DrawBrush::new(gpu);
            let slot = passes.slot(gpu);
            let drawn = which(
                &passes,
                gpu,
                &slot,
                &sections(&brush, 0.02, 0.0082),
                &projection,
            );
            let target = target(gpu, [SIDE; 2]);
            draw(gpu, &target, WHITE, |pass| drawn.draw(pass));
            let bytes = read(gpu, &target);
            Self {
                lightness: bytes.chunks_exact(4).map(|p| p[1]).collect(),
            }
        }

        /// At a place on the desk, mm from the middle.
        fn at(&self, x: i32, y: i32) -> u8 {
            let half = SIDE as i32 / 2;
            self.lightness[((half - y) * SIDE as i32 + half + x) as usize]
        }

        fn mirrored(&self) -> Self {
            let rows = self.lightness.chunks_exact(SIDE as usize);
            Self {
                lightness: rows.flat_map(|row| row.iter().rev().copied()).collect(),
            }
        }

        fn differs(&self, other: &Self) -> u8 {
            let pairs = self.lightness.iter().zip(&other.lightness);
            pairs.map(|(a, b)| a.abs_diff(*b)).max().expect("pixels")
        }
    }

    fn cast(
        passes: &DrawBrush,
        gpu: &Gpu,
        slot: &ChainSlot,
        sections: &[Section; SECTIONS],
        projection: &Projection<'_>,
    ) -> Drawn {
        let discs: Vec<_> = sections.iter().map(|s| (s.at, s.radius)).collect();
        passes.cast(
            gpu,
            slot,
            &Chain::shadow(&shadow(&discs, projection.toward), projection),
        )
    }

    fn solid(
        passes: &DrawBrush,
        gpu: &Gpu,
        slot: &ChainSlot,
        sections: &[Section; SECTIONS],
        projection: &Projection<'_>,
    ) -> Drawn {
        passes.solid(gpu, slot, &Chain::solid(sections, projection))
    }

    const LEFT: [f32; 3] = [-0.6, 0.0, 0.8];
    const RIGHT: [f32; 3] = [0.6, 0.0, 0.8];

    #[test]
    fn the_shadow_lies_on_the_side_away_from_the_lamp() {
        let gpu = gpu();
        let upright = Picture::of(&gpu, DVec2::ZERO, LEFT, cast);
        // The ferrule begins 10 mm above the surface: its shadow 7.5 mm to the right.
        assert!(upright.at(7, 0) < 200, "{}", upright.at(7, 0));
        assert_eq!(upright.at(-20, 0), 255);
        assert!(upright.at(60, 0) > upright.at(7, 0), "it fades");
        // Pixels are mirrored about the middle of the picture, as the brush is.
        let other = Picture::of(&gpu, DVec2::ZERO, RIGHT, cast).mirrored();
        assert!(upright.differs(&other) <= 1, "{}", upright.differs(&other));
        let same = Picture::of(&gpu, DVec2::ZERO, LEFT, cast).mirrored();
        assert!(upright.differs(&same) > 50, "a fault would pass");
    }

    #[test]
    fn the_handle_covers_what_it_must_and_is_lit_from_the_lamps_side() {
        let gpu = gpu();
        let away = Picture::of(&gpu, DVec2::new(0.0, 0.6), LEFT, solid);
        // It goes up from the middle; the ferrule is 14 to 16 mm wide.
        assert!(away.at(0, 20) < 230 && away.at(0, 60) < 230);
        assert_eq!(
            (away.at(0, -20), away.at(14, 20), away.at(-14, 20)),
            (255, 255, 255)
        );
        assert!(away.at(-5, 50) > away.at(5, 50) + 20, "lit from the left");
        let other = Picture::of(&gpu, DVec2::new(0.0, 0.6), RIGHT, solid).mirrored();
        assert!(away.differs(&other) <= 2, "{}", away.differs(&other));
        assert!(away.differs(&away.mirrored()) > 20, "a fault would pass");
        let above = Picture::of(&gpu, DVec2::ZERO, LEFT, solid);
        assert!(
            above.at(0, 0) < 255 && above.at(12, 0) == 255,
            "seen along the handle"
        );
    }

    #[test]
    fn a_brush_beside_the_view_is_not_drawn() {
        let view = View {
            area: Rect::from_min_size(pos2(0.0, 0.0), vec2(100.0, 100.0)),
            middle: DVec2::ZERO,
            scale: 1000.0,
        };
        let to_window = |at: [f64; 3]| view.to_window(DVec3::from_array(at));
        let projection = Projection {
            view: &view,
            pixels_per_point: 1.0,
            to_window: &to_window,
            toward: LEFT,
        };
        let at = |x: f64| Rigid {
            translation: DVec3::new(x, 0.0, 0.01),
            ..Rigid::IDENTITY
        };
        let visible =
            |x: f64| Chain::solid(&sections(&at(x), 0.01, 4e-3), &projection).is_visible();
        assert!(visible(0.0) && visible(0.05) && !visible(0.06));
    }
}
