//! Stages as compute pipelines, each with those buffers of step.wgsl that it uses.

use super::record::RECORD_BYTES;
use crate::device::Device;

/// The buffers, by binding; 0 are the parameters of the step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum Binding {
    /// Poses of the head, by drawing.
    Poses = 1,
    /// The head itself.
    Head,
    /// Segments of the drawn head.
    Segments,
    /// Counts of the window.
    Planes,
    /// The same while they change.
    Other,
    /// Heights under the paint.
    Base,
    /// The load.
    Load,
    /// What is asked of the brush.
    Asks,
    /// The lowest segment of each cell.
    Keys,
    /// The cells in contact.
    Contacts,
    /// Velocities through faces of cells.
    Faces,
    /// Sums of paints, by cell.
    Totals,
    /// Statistics of steps.
    Stats,
    /// Workgroups that a step has planned.
    Groups,
    /// What cells ask for.
    Wants,
    /// The parameters of a blend, a record for each.
    Blend,
}

impl Binding {
    /// How many they are, with that of the step's parameters.
    pub const COUNT: usize = Self::Blend as usize + 1;

    /// Those with room for each cell of the grid.
    pub const OF_GRID: [Self; 5] = [
        Self::Keys,
        Self::Contacts,
        Self::Faces,
        Self::Totals,
        Self::Wants,
    ];

    /// Words that a cell of the grid has in it; 0 of one that has none.
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

    /// True if it holds parameters: one record of them is bound at a time.
    fn is_uniform(self) -> bool {
        self == Self::Blend
    }
}

/// How many workgroups a stage has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Groups {
    /// As many as cover the cells of the grid.
    Grid,
    /// As many as cover the segments, and so the strips and faces.
    Segments,
    /// As many as cover the cells of the grid, or the strips.
    GridAndStrips,
    /// One for each strip.
    Strips,
    /// One.
    One,
    /// As the plan of the step says at this place: none where nothing is touched.
    Planned(u64),
}

/// What a stage is.
pub struct Kernel {
    /// Its name, also that of its entry point.
    pub name: &'static str,
    /// Its WGSL in pieces, after what all stages share.
    pub source: &'static [&'static str],
    /// Its overridable constants.
    pub constants: &'static [(&'static str, f64)],
    /// The buffers that it takes.
    pub bindings: &'static [Binding],
    /// Its workgroups.
    pub groups: Groups,
}

impl Kernel {
    /// Its whole WGSL.
    fn wgsl(&self) -> String {
        SHARED.iter().chain(self.source).copied().collect()
    }

    /// True if it takes the parameters of a blend.
    pub fn blends(&self) -> bool {
        self.bindings.contains(&Binding::Blend)
    }
}

/// WGSL that all stages of steps begin with.
const SHARED: [&str; 3] = [
    include_str!("../shaders/steps/common/step.wgsl"),
    include_str!("../shaders/steps/common/shapes.wgsl"),
    include_str!("../shaders/steps/common/fragments.wgsl"),
];

use Binding as B;

/// The lowest segment of each cell.
pub const RASTERIZER: Kernel = Kernel {
    name: "rasterizer",
    source: &[include_str!("../shaders/steps/rasterizer.wgsl")],
    constants: &[],
    bindings: &[B::Poses, B::Head, B::Segments, B::Asks, B::Keys, B::Stats],
    groups: Groups::Segments,
};

/// A stage on a device.
pub struct Pipeline {
    /// The stage.
    pub kernel: &'static Kernel,
    layout: wgpu::BindGroupLayout,
    /// Its pipeline.
    pub pipeline: wgpu::ComputePipeline,
}

impl Pipeline {
    /// Makes the pipeline.
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
            let storage = (wgpu::BufferBindingType::Storage { read_only }, None);
            let (ty, size) = match binding.is_uniform() {
                true => (wgpu::BufferBindingType::Uniform, size),
                false => storage,
            };
            entry(*binding as u32, ty, size)
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

    /// Its buffers, bound.
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
            let resource = match binding.is_uniform() {
                true => record(buffer(*binding)),
                false => buffer(*binding).as_entire_binding(),
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
