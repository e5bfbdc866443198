//! Stages as compute pipelines, each with the buffers of step.wgsl that it uses.

use super::record::RECORD_BYTES;
use crate::device::Device;

/// Buffers, by binding; binding 0 is the parameters of the step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum Binding {
    /// Poses of the head, by drawing.
    Poses = 1,
    /// Constant geometry of the head.
    Head,
    /// Segments of the drawn head.
    Segments,
    /// Counts of the window, a plane a paint.
    Planes,
    /// Scratch counts of the window.
    Other,
    /// Heights of the surface under the paint.
    Base,
    /// Load of the brush.
    Load,
    /// Amounts requested from the brush.
    Asks,
    /// Lowest segment of each cell.
    Keys,
    /// Cells in contact.
    Contacts,
    /// Velocities through faces of cells.
    Faces,
    /// Sums of all paints by cell.
    Totals,
    /// Statistics of steps.
    Stats,
    /// Workgroup counts planned by a step.
    Groups,
    /// Amounts requested by cells.
    Wants,
    /// The parameters of a blend, a record for each.
    Blend,
}

impl Binding {
    /// Number of bindings, including that of the step's parameters.
    pub const COUNT: usize = Self::Blend as usize + 1;

    /// Bindings sized by the cells of the grid.
    pub const OF_GRID: [Self; 5] = [
        Self::Keys,
        Self::Contacts,
        Self::Faces,
        Self::Totals,
        Self::Wants,
    ];

    /// Words per cell of the grid in this buffer; 0 if it is not sized by the grid.
    pub fn words_by_cell(self) -> u64 {
        match self {
            Self::Keys | Self::Faces | Self::Wants => 2,
            Self::Contacts => 8,
            Self::Totals => 5,
            _ => 0,
        }
    }

    fn read_only(self) -> bool {
        matches!(self, Self::Poses | Self::Head | Self::Base)
    }

    /// True if it holds parameters, of which one record is bound at a time.
    fn is_uniform(self) -> bool {
        self == Self::Blend
    }
}

/// Number of workgroups of a stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Groups {
    /// Enough to cover the cells of the grid.
    Grid,
    /// Enough to cover the segments, and so the strips and faces.
    Segments,
    /// Enough to cover the cells of the grid, or the strips.
    GridAndStrips,
    /// One for each strip.
    Strips,
    /// One workgroup for the whole dispatch.
    One,
    /// The number planned by the step at this offset: none where nothing is touched.
    Planned(u64),
}

/// Definition of a stage.
pub struct Kernel {
    /// Name of the stage and of its entry point.
    pub name: &'static str,
    /// Pieces of WGSL, after the shared ones.
    pub source: &'static [&'static str],
    /// Overridable constants.
    pub constants: &'static [(&'static str, f64)],
    /// Buffers that it uses.
    pub bindings: &'static [Binding],
    /// Number of its workgroups.
    pub groups: Groups,
}

impl Kernel {
    fn wgsl(&self) -> String {
        SHARED.iter().chain(self.source).copied().collect()
    }

    /// True if it uses the parameters of a blend.
    pub fn blends(&self) -> bool {
        self.bindings.contains(&Binding::Blend)
    }
}

/// WGSL at the beginning of all stages of steps.
const SHARED: [&str; 3] = [
    include_str!("../shaders/steps/common/step.wgsl"),
    include_str!("../shaders/steps/common/shapes.wgsl"),
    include_str!("../shaders/steps/common/fragments.wgsl"),
];

use Binding as B;

/// Rasterizer: the lowest segment of each cell.
pub const RASTERIZER: Kernel = Kernel {
    name: "rasterizer",
    source: &[include_str!("../shaders/steps/rasterizer.wgsl")],
    constants: &[],
    bindings: &[B::Poses, B::Head, B::Segments, B::Asks, B::Keys, B::Stats],
    groups: Groups::Segments,
};

/// A stage on a device.
pub struct Pipeline {
    /// Definition of the stage.
    pub kernel: &'static Kernel,
    layout: wgpu::BindGroupLayout,
    /// Compute pipeline on the device.
    pub pipeline: wgpu::ComputePipeline,
}

impl Pipeline {
    /// Compiles the pipeline of a stage.
    pub fn new(gpu: &Device, kernel: &'static Kernel) -> Self {
        let entry = |binding, ty, size| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty: wgpu::BindingType::Buffer {
                ty,
                has_dynamic_offset: ty == wgpu::BufferBindingType::Uniform,
                min_binding_size: size,
            },
            count: None,
        };
        let size = wgpu::BufferSize::new(RECORD_BYTES);
        let mut entries = vec![entry(0, wgpu::BufferBindingType::Uniform, size)];
        entries.extend(kernel.bindings.iter().map(|binding| {
            let read_only = binding.read_only();
            let storage = wgpu::BufferBindingType::Storage { read_only };
            if binding.is_uniform() {
                entry(*binding as u32, wgpu::BufferBindingType::Uniform, size)
            } else {
                entry(*binding as u32, storage, None)
            }
        }));
        let device = &gpu.device;
        let label = Some(kernel.name);
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label,
            entries: &entries,
        });
        let whole = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label,
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label,
            source: wgpu::ShaderSource::Wgsl(kernel.wgsl().into()),
        });
        let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label,
            layout: Some(&whole),
            module: &module,
            entry_point: Some(kernel.name),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants: kernel.constants,
                ..Default::default()
            },
            cache: None,
        });
        Self {
            kernel,
            layout,
            pipeline,
        }
    }

    /// Bind group of its buffers.
    pub fn bind<'a>(
        &self,
        gpu: &Device,
        records: &'a wgpu::Buffer,
        buffer: impl Fn(Binding) -> &'a wgpu::Buffer,
    ) -> wgpu::BindGroup {
        let record = |buffer| {
            wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                buffer,
                offset: 0,
                size: wgpu::BufferSize::new(RECORD_BYTES),
            })
        };
        let own = self.kernel.bindings.iter().map(|binding| {
            let resource = if binding.is_uniform() {
                record(buffer(*binding))
            } else {
                buffer(*binding).as_entire_binding()
            };
            (*binding as u32, resource)
        });
        let all = std::iter::once((0, record(records))).chain(own);
        let entries: Vec<wgpu::BindGroupEntry<'_>> = all
            .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource })
            .collect();
        gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(self.kernel.name),
            layout: &self.layout,
            entries: &entries,
        })
    }
}
