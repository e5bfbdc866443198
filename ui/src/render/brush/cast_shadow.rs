//! Pass that casts the shadow of a brush on the backdrop.

use bytemuck::{Pod, Zeroable};
use eframe::egui::{PaintCallbackInfo, Pos2, Shape};
use eframe::egui_wgpu::{self, CallbackResources, CallbackTrait, wgpu};
use glam::{DVec3, Vec2};

use crate::render::brush::geometry::{HEAD_DISCS, HEAD_DISCS_WIDE, SHADED_SECTIONS, Shade};
use crate::render::gpu::{Filterable, Gpu, Pass, UNIFORM, texture_binding};
use crate::view::camera::{DESK_COLOUR, View};

/// Nodes of a chain at most, as in the shader.
const NODES: usize = 24;
/// Discs of a narrow and of a wide brush's shadow.
pub(crate) const SHADES: [usize; 2] = [
    HEAD_DISCS + SHADED_SECTIONS,
    HEAD_DISCS_WIDE + SHADED_SECTIONS,
];
/// Softness that keeps an edge from being jagged, pixels.
const EDGE: f32 = 0.7;

/// A board above the desk: its lower left corner, lower right and upper left one in the view, pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Board {
    pub corners: [Vec2; 3],
    /// Radii of its corners, pixels: lower left, lower right, upper left, upper right.
    pub radii: [f32; 4],
}

/// Part of the desk on which a shadow falls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum On {
    All,
    Board(Board),
    /// Outside the board.
    Beside(Board),
}

/// A chain of discs as the shader takes it.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Chain {
    view: [f32; 2],
    corner_of_board: [f32; 2],
    board: [f32; 4],
    shaded: [f32; 4],
    radii: [f32; 4],
    corner: [f32; 4],
    sides: [f32; 4],
    nodes: [[f32; 4]; NODES],
    shades: [[f32; 4]; NODES],
}

/// From the frame of a surface to pixels of the view.
pub(crate) struct Projection<'a> {
    pub view: &'a View,
    /// Pixels a point.
    pub pixels_per_point: f32,
    /// From the surface's frame to the window, points.
    pub to_window: &'a dyn Fn(DVec3) -> Pos2,
}

impl Projection<'_> {
    fn pixels(&self, at: DVec3) -> Vec2 {
        let off = ((self.to_window)(at) - self.view.area.min) * self.pixels_per_point;
        Vec2::new(off.x, off.y)
    }
}

impl Chain {
    /// The shadow of discs, of a narrow or a wide brush.
    #[must_use]
    pub(crate) fn of(shades: &[Shade], projection: &Projection<'_>, on: On) -> Self {
        let per_m = (projection.view.scale * f64::from(projection.pixels_per_point)) as f32;
        let area = projection.view.area.size() * projection.pixels_per_point;
        let mut chain = Self {
            view: area.into(),
            ..Self::zeroed()
        };
        // The shader takes all nodes of its kind of chain: a short one is filled up with its end.
        let mut last = ([0.0; 4], 0.0);
        for i in 0..NODES {
            if let Some(shade) = shades.get(i) {
                let at = projection.pixels(shade.at.extend(0.0));
                let [radius, soft] = [shade.radius, shade.softness].map(|m| m as f32 * per_m);
                last = ([at.x, at.y, radius, soft + EDGE], shade.darkness as f32);
            }
            chain.nodes[i] = last.0;
            chain.shades[i][0] = last.1;
        }
        let chain = chain.bounded();
        match on {
            On::All => chain,
            On::Board(board) => chain.within(&board, 1.0),
            On::Beside(board) => chain.within(&board, -1.0),
        }
    }

    /// Gives the chain the box that holds its discs, along the line from its first node to its last: a slanting chain
    /// would fill little of an upright box.
    fn bounded(mut self) -> Self {
        let place = |disc: &[f32; 4]| Vec2::new(disc[0], disc[1]);
        let (first, last) = (place(&self.nodes[0]), place(&self.nodes[NODES - 1]));
        let ahead = (last - first).normalize_or(Vec2::X);
        let axes = [ahead, ahead.perp()];
        let (mut low, mut high) = ([f32::MAX; 2], [f32::MIN; 2]);
        for disc in &self.nodes {
            let reach = disc[2] + disc[3];
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

    fn within(mut self, board: &Board, shaded: f32) -> Self {
        let [corner, right, up] = board.corners;
        let (right, up) = (right - corner, up - corner);
        let area = right.perp_dot(up);
        if area.abs() < 1.0 {
            return self;
        }
        self.corner_of_board = corner.into();
        self.board = [up.y / area, -up.x / area, -right.y / area, right.x / area];
        self.shaded[0] = shaded;
        self.radii = board.radii;
        self
    }

    /// The least upright box that holds it: first corner, then the one past the last.
    fn upright(&self) -> [[f32; 2]; 2] {
        let end = |i: usize, of: fn(f32, f32) -> f32| {
            self.corner[i] + of(self.sides[i], 0.0) + of(self.sides[i + 2], 0.0)
        };
        [
            [0, 1].map(|i| end(i, f32::min)),
            [0, 1].map(|i| end(i, f32::max)),
        ]
    }

    /// True if any of its box may be in the view.
    #[must_use]
    pub(crate) fn is_visible(&self) -> bool {
        let [low, high] = self.upright();
        (0..2).all(|i| low[i] < self.view[i] && high[i] > 0.0)
    }

    /// True if it may fall on a board.
    #[must_use]
    pub(crate) fn reaches(&self, board: &Board) -> bool {
        let [low, high] = self.upright();
        let [corner, right, up] = board.corners;
        let corners = [corner, right, up, right + up - corner];
        (0..2).all(|i| {
            let least = corners.iter().map(|c| c[i]).fold(f32::MAX, f32::min);
            let most = corners.iter().map(|c| c[i]).fold(f32::MIN, f32::max);
            low[i] < most && high[i] > least
        })
    }
}

#[derive(Clone, Debug)]
pub(crate) struct CastShadow {
    layout: wgpu::BindGroupLayout,
    cast: [wgpu::RenderPipeline; 2],
    bare: wgpu::TextureView,
}

impl CastShadow {
    /// The passes on a device.
    #[must_use]
    pub(crate) fn new(gpu: &Gpu) -> Self {
        let layout = gpu.layout("cast_shadow", &[UNIFORM, texture_binding(Filterable::No)]);
        let shader = gpu.shader("cast_shadow", include_str!("../shaders/cast_shadow.wgsl"));
        let pipeline = |count: usize| {
            gpu.pipeline(&Pass {
                name: "cast_shadow",
                layout: &layout,
                shader: &shader,
                vertex: "cover",
                fragment: "shade",
                constants: &[gpu.encoding(), ("count", count as f64)],
                target: gpu.target,
                blend: Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
            })
        };
        Self {
            cast: SHADES.map(pipeline),
            bare: bare_desk(gpu),
            layout,
        }
    }

    /// A place on the device for one shadow.
    #[must_use]
    pub(crate) fn slot(&self, gpu: &Gpu) -> ShadowSlot {
        ShadowSlot {
            chain: gpu.uniform::<Chain>("shadow"),
            bound: None,
        }
    }

    /// Prepares a chain with this number of discs to be drawn on the backdrop (`desk`; the bare desk without one).
    #[must_use]
    pub(crate) fn cast(
        &self,
        gpu: &Gpu,
        slot: &mut ShadowSlot,
        desk: Option<&wgpu::TextureView>,
        (chain, discs): (&Chain, usize),
    ) -> Drawn {
        let desk = desk.unwrap_or(&self.bare);
        gpu.queue
            .write_buffer(&slot.chain, 0, bytemuck::bytes_of(chain));
        let bound = slot.bound.take().filter(|(on, _)| on == desk);
        let (_, bound) = slot.bound.insert(bound.unwrap_or_else(|| {
            let resources = [
                slot.chain.as_entire_binding(),
                wgpu::BindingResource::TextureView(desk),
            ];
            (desk.clone(), gpu.bind(&self.layout, &resources))
        }));
        Drawn {
            pipeline: self.cast[usize::from(discs > SHADES[0])].clone(),
            bound: bound.clone(),
        }
    }
}

/// A texel of the bare desk.
fn bare_desk(gpu: &Gpu) -> wgpu::TextureView {
    let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
    let format = wgpu::TextureFormat::Rgba8Unorm;
    let texture = gpu.texture("bare desk", [1, 1], format, usage);
    gpu.queue.write_texture(
        texture.as_image_copy(),
        &DESK_COLOUR.to_array(),
        wgpu::TexelCopyBufferLayout::default(),
        wgpu::Extent3d::default(),
    );
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

/// Buffers of a shadow on the device, and the desk that it is bound to.
#[derive(Debug)]
pub(crate) struct ShadowSlot {
    chain: wgpu::Buffer,
    bound: Option<(wgpu::TextureView, wgpu::BindGroup)>,
}

/// A shadow that waits to be drawn into the window.
#[derive(Debug)]
pub(crate) struct Drawn {
    pipeline: wgpu::RenderPipeline,
    bound: wgpu::BindGroup,
}

impl Drawn {
    /// Draws into a pass whose viewport is the view.
    pub(crate) fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.bound, &[]);
        pass.draw(0..4, 0..1);
    }

    /// As a shape of the window that fills the view.
    pub(crate) fn shape(self, view: &View) -> Shape {
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
