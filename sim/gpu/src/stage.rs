//! A compute shader and its pipelines, one for each set of constants, made on demand.

use maulstick_optics::Studio;

use crate::device::Device;

/// Number of invocations of a workgroup: long rows run fastest on emulated devices, and all devices have them.
const GROUP: u32 = 256;

/// Definition of a stage.
pub(crate) struct Stage {
    /// Name of the stage and of its entry point.
    pub(crate) name: &'static str,
    /// WGSL source.
    pub(crate) source: &'static str,
    /// Overridable constants.
    pub(crate) constants: fn(&Studio) -> Vec<(&'static str, f64)>,
    /// Number of planes that it computes for a tile.
    pub(crate) planes: fn(&Studio) -> usize,
}

/// A stage on a device.
pub(crate) struct Pipelines {
    /// Definition of the stage.
    pub(crate) stage: &'static Stage,
    module: wgpu::ShaderModule,
    bindings: wgpu::BindGroupLayout,
    layout: wgpu::PipelineLayout,
    made: Vec<(Vec<(&'static str, f64)>, wgpu::ComputePipeline)>,
}

impl Pipelines {
    /// A stage with `inputs` storage buffers and, last, one for its output.
    pub(crate) fn new(gpu: &Device, stage: &'static Stage, inputs: u32) -> Self {
        let entry = |binding, read_only| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Storage { read_only },
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        };
        let entries: Vec<_> = (0..=inputs)
            .map(|binding| entry(binding, binding < inputs))
            .collect();
        let bindings = gpu
            .device
            .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                label: Some(stage.name),
                entries: &entries,
            });
        let layout = gpu
            .device
            .create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some(stage.name),
                bind_group_layouts: &[Some(&bindings)],
                immediate_size: 0,
            });
        let module = gpu
            .device
            .create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some(stage.name),
                source: wgpu::ShaderSource::Wgsl(stage.source.into()),
            });
        Self {
            stage,
            module,
            bindings,
            layout,
            made: Vec::new(),
        }
    }

    fn pipeline(&mut self, gpu: &Device, studio: &Studio) -> &wgpu::ComputePipeline {
        let constants = (self.stage.constants)(studio);
        let place = self.made.iter().position(|(had, _)| *had == constants);
        let place = place.unwrap_or_else(|| {
            let descriptor = wgpu::ComputePipelineDescriptor {
                label: Some(self.stage.name),
                layout: Some(&self.layout),
                module: &self.module,
                entry_point: Some(self.stage.name),
                compilation_options: wgpu::PipelineCompilationOptions {
                    constants: &constants,
                    ..Default::default()
                },
                cache: None,
            };
            let pipeline = gpu.device.create_compute_pipeline(&descriptor);
            self.made.push((constants.clone(), pipeline));
            self.made.len() - 1
        });
        &self.made[place].1
    }

    /// Runs the stage over `tiles` tiles of `cells` cells.
    pub(crate) fn run(
        &mut self,
        gpu: &Device,
        encoder: &mut wgpu::CommandEncoder,
        studio: &Studio,
        buffers: &[&wgpu::Buffer],
        [tiles, cells]: [usize; 2],
    ) {
        let entries: Vec<_> = (0u32..)
            .zip(buffers)
            .map(|(binding, buffer)| wgpu::BindGroupEntry {
                binding,
                resource: buffer.as_entire_binding(),
            })
            .collect();
        let bound = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(self.stage.name),
            layout: &self.bindings,
            entries: &entries,
        });
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some(self.stage.name),
            timestamp_writes: None,
        });
        pass.set_pipeline(self.pipeline(gpu, studio));
        pass.set_bind_group(0, &bound, &[]);
        pass.dispatch_workgroups(cells as u32 / GROUP, tiles as u32, 1);
    }
}
