//! The graphics device, and the parts that all passes share.

use eframe::egui_wgpu::wgpu;
use wgpu::util::DeviceExt as _;

/// The graphics device of the window.
#[derive(Clone, Debug)]
pub struct Gpu {
    /// Makes things.
    pub device: wgpu::Device,
    /// Queue of the device.
    pub queue: wgpu::Queue,
    /// Format of the window's pixels.
    pub target: wgpu::TextureFormat,
}

impl Gpu {
    /// A shader.
    #[must_use]
    pub fn shader(&self, name: &str, source: &'static str) -> wgpu::ShaderModule {
        self.device
            .create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some(name),
                source: wgpu::ShaderSource::Wgsl(source.into()),
            })
    }

    /// A uniform of the size of `T`, zero at first.
    #[must_use]
    pub fn uniform<T: bytemuck::Pod>(&self, name: &str) -> wgpu::Buffer {
        self.device
            .create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some(name),
                contents: bytemuck::bytes_of(&T::zeroed()),
                usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            })
    }

    /// A texture of `size` pixels, without finer or coarser copies.
    #[must_use]
    pub fn texture(
        &self,
        name: &str,
        size: [u32; 2],
        format: wgpu::TextureFormat,
        usage: wgpu::TextureUsages,
    ) -> wgpu::Texture {
        self.device.create_texture(&wgpu::TextureDescriptor {
            label: Some(name),
            size: wgpu::Extent3d {
                width: size[0],
                height: size[1],
                depth_or_array_layers: 1,
            },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage,
            view_formats: &[],
        })
    }

    /// The layout of a bind group whose bindings are numbered in order.
    #[must_use]
    pub fn layout(&self, name: &str, bindings: &[wgpu::BindingType]) -> wgpu::BindGroupLayout {
        let entries: Vec<_> = (0u32..)
            .zip(bindings)
            .map(|(binding, ty)| wgpu::BindGroupLayoutEntry {
                binding,
                visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
                ty: *ty,
                count: None,
            })
            .collect();
        self.device
            .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                label: Some(name),
                entries: &entries,
            })
    }

    /// A bind group with its resources in order.
    #[must_use]
    pub fn bind(
        &self,
        layout: &wgpu::BindGroupLayout,
        resources: &[wgpu::BindingResource<'_>],
    ) -> wgpu::BindGroup {
        let entries: Vec<_> = (0u32..)
            .zip(resources)
            .map(|(binding, resource)| wgpu::BindGroupEntry {
                binding,
                resource: resource.clone(),
            })
            .collect();
        self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout,
            entries: &entries,
        })
    }

    /// A pipeline without vertex buffers.
    #[must_use]
    pub fn pipeline(&self, pass: &Pass<'_>) -> wgpu::RenderPipeline {
        let layout = self
            .device
            .create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some(pass.name),
                bind_group_layouts: &[Some(pass.layout)],
                immediate_size: 0,
            });
        let compilation_options = wgpu::PipelineCompilationOptions {
            constants: pass.constants,
            ..Default::default()
        };
        self.device
            .create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some(pass.name),
                layout: Some(&layout),
                vertex: wgpu::VertexState {
                    module: pass.shader,
                    entry_point: Some(pass.vertex),
                    buffers: &[],
                    compilation_options: compilation_options.clone(),
                },
                primitive: wgpu::PrimitiveState {
                    topology: wgpu::PrimitiveTopology::TriangleStrip,
                    ..Default::default()
                },
                depth_stencil: None,
                multisample: wgpu::MultisampleState::default(),
                fragment: Some(wgpu::FragmentState {
                    module: pass.shader,
                    entry_point: Some(pass.fragment),
                    targets: &[Some(wgpu::ColorTargetState {
                        format: pass.target,
                        blend: pass.blend,
                        write_mask: wgpu::ColorWrites::ALL,
                    })],
                    compilation_options,
                }),
                multiview_mask: None,
                cache: None,
            })
    }

    /// The constant of a shader that draws into the window: it encodes where the window's pixels do
    /// not encode by themselves.
    #[must_use]
    pub fn encoding(&self) -> (&'static str, f64) {
        ("encoded", f64::from(u8::from(!self.target.is_srgb())))
    }
}

/// Description of a pipeline.
#[derive(Clone, Copy, Debug)]
pub struct Pass<'a> {
    /// For messages of the driver.
    pub name: &'a str,
    /// The one bind group.
    pub layout: &'a wgpu::BindGroupLayout,
    pub shader: &'a wgpu::ShaderModule,
    pub vertex: &'a str,
    pub fragment: &'a str,
    /// Its overridable constants.
    pub constants: &'a [(&'a str, f64)],
    /// Format of its target.
    pub target: wgpu::TextureFormat,
    /// Blending with the target.
    pub blend: Option<wgpu::BlendState>,
}

/// A uniform buffer as a binding.
pub(crate) const UNIFORM: wgpu::BindingType = wgpu::BindingType::Buffer {
    ty: wgpu::BufferBindingType::Uniform,
    has_dynamic_offset: false,
    min_binding_size: None,
};

/// A texture as a binding.
#[must_use]
pub(crate) fn texture_binding(filterable: Filterable) -> wgpu::BindingType {
    wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float {
            filterable: filterable == Filterable::Yes,
        },
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    }
}

/// A cube of colours, read through a sampler, as a binding.
pub(crate) const CUBE: wgpu::BindingType = wgpu::BindingType::Texture {
    sample_type: wgpu::TextureSampleType::Float { filterable: true },
    view_dimension: wgpu::TextureViewDimension::D3,
    multisampled: false,
};

/// Sampling of a texture: through a sampler or by texel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Filterable {
    Yes,
    /// Texel by texel: floats need not be filterable.
    No,
}

#[cfg(test)]
pub(crate) mod testing {
    use super::*;

    /// A device without a window, whose target, as those of most windows, encodes nothing.
    pub(crate) fn gpu() -> Gpu {
        let mut instance = wgpu::InstanceDescriptor::new_without_display_handle();
        instance.backends = wgpu::Backends::VULKAN;
        let instance = wgpu::Instance::new(instance);
        let adapter = pollster::block_on(instance.request_adapter(&Default::default()))
            .expect("a Vulkan driver: install mesa-vulkan-drivers, as ./test does");
        println!("adapter: {}", adapter.get_info().name);
        let (device, queue) =
            pollster::block_on(adapter.request_device(&Default::default())).expect("a device");
        Gpu {
            device,
            queue,
            target: wgpu::TextureFormat::Rgba8Unorm,
        }
    }

    /// A target of `size` pixels to draw into and read.
    pub(crate) fn target(gpu: &Gpu, size: [u32; 2]) -> wgpu::Texture {
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC;
        gpu.texture("target", size, gpu.target, usage)
    }

    /// Clears a target to `colour` and draws into it.
    pub(crate) fn draw(
        gpu: &Gpu,
        target: &wgpu::Texture,
        colour: wgpu::Color,
        draw: impl FnOnce(&mut wgpu::RenderPass<'_>),
    ) {
        let view = target.create_view(&wgpu::TextureViewDescriptor::default());
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &view,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations {
                        load: wgpu::LoadOp::Clear(colour),
                        store: wgpu::StoreOp::Store,
                    },
                })],
                ..Default::default()
            });
            draw(&mut pass);
        }
        gpu.queue.submit([encoder.finish()]);
    }

    /// The texels of a texture, row after row from the first.
    pub(crate) fn read(gpu: &Gpu, texture: &wgpu::Texture) -> Vec<u8> {
        let size = texture.size();
        let texel = texture
            .format()
            .block_copy_size(None)
            .expect("a plain format");
        let (row, padded) = (
            size.width * texel,
            (size.width * texel).next_multiple_of(256),
        );
        let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("read"),
            size: u64::from(padded * size.height),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        encoder.copy_texture_to_buffer(
            texture.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &buffer,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(padded),
                    rows_per_image: None,
                },
            },
            size,
        );
        gpu.queue.submit([encoder.finish()]);
        buffer
            .slice(..)
            .map_async(wgpu::MapMode::Read, |result| result.expect("mapped"));
        gpu.device
            .poll(wgpu::PollType::wait_indefinitely())
            .expect("drawn");
        let mapped = buffer.slice(..).get_mapped_range().expect("mapped");
        let rows = mapped.chunks_exact(padded as usize);
        rows.flat_map(|bytes| bytes[..row as usize].to_vec())
            .collect()
    }
}
