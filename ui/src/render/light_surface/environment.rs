//! Environment map on the graphics device: its levels above each other in one texture, the sharpest lowest.

use std::sync::Arc;

use eframe::egui_wgpu::wgpu;
use maulstick_optics::light::EnvironmentMap;
use maulstick_optics::light::environment::{LEVELS, side};

use crate::render::gpu::Gpu;

/// Texture of a map.
#[derive(Debug)]
pub(crate) struct EnvironmentTexture {
    texture: wgpu::Texture,
    holds: Option<Arc<EnvironmentMap>>,
}

impl EnvironmentTexture {
    /// A texture without a map yet.
    #[must_use]
    pub(crate) fn new(gpu: &Gpu) -> Self {
        let rows: usize = (0..LEVELS).map(side).sum();
        let size = [side(0), rows].map(|texels| texels as u32);
        let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
        let format = wgpu::TextureFormat::Rgba32Float;
        Self {
            texture: gpu.texture("environment", size, format, usage),
            holds: None,
        }
    }

    #[must_use]
    pub(crate) fn view(&self) -> wgpu::TextureView {
        self.texture.create_view(&Default::default())
    }

    /// Takes a map in; true if it is another one.
    pub(crate) fn take(&mut self, gpu: &Gpu, map: Option<&Arc<EnvironmentMap>>) -> bool {
        let is_known = match (map, &self.holds) {
            (Some(map), Some(held)) => Arc::ptr_eq(map, held) || map == held,
            (map, held) => map.is_none() && held.is_none(),
        };
        if is_known {
            return false;
        }
        self.holds = map.cloned();
        let Some(map) = map else {
            return true;
        };
        let width = side(0);
        let rows = (0..LEVELS).flat_map(|level| map.level(level).chunks(side(level)));
        let texels: Vec<[f32; 4]> = rows
            .flat_map(|row| {
                let row = row.iter().map(|[r, g, b]| [*r, *g, *b, 0.0]);
                row.chain(std::iter::repeat([0.0; 4])).take(width)
            })
            .collect();
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some((width * size_of::<[f32; 4]>()) as u32),
            rows_per_image: None,
        };
        gpu.queue.write_texture(
            self.texture.as_image_copy(),
            bytemuck::cast_slice(&texels),
            layout,
            self.texture.size(),
        );
        true
    }
}
