//! The stages as compute pipelines, each with those buffers of impasto.wgsl that it uses.

use maulstick_impasto::stages::velocity::{EASE, SLIP, SQUISH, STABLE};
use maulstick_model::brush::traits::BrushTraits;
use maulstick_model::transfer::{POOL, SWAP_FILM};

use crate::device::Device;

use super::record::RECORD_BYTES;

/// The buffers, by binding; 0 are the parameters of the step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub(crate) enum Binding {
    Poses = 1,
    Head,
    Segments,
    Planes,
    Other,
    Base,
    Load,
    Asks,
    Keys,
    Contacts,
    Faces,
    Totals,
    Stats,
    Groups,
    Wants,
}

impl Binding {
    /// Words that a cell of the grid has in it; 0 of one that has none.
    pub(crate) fn words_by_cell(self) -> u64 {
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
}

/// How many workgroups a stage has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Groups {
    /// As many as cover the cells of the grid.
    Grid,
    /// As many as cover the segments, and so the strips and faces.
    Segments,
    /// One.
    One,
    /// As the plan of the step says at this place: none where nothing is touched.
    Planned(u64),
}

/// What a stage is.
pub(crate) struct Kernel {
    /// Its name, also that of its entry point.
    pub(crate) name: &'static str,
    source: &'static str,
    constants: &'static [(&'static str, f64)],
    pub(crate) bindings: &'static [Binding],
    pub(crate) groups: Groups,
}

macro_rules! source {
    ($name:literal) => {
        concat!(
            include_str!("../shaders/impasto/common/impasto.wgsl"),
            include_str!("../shaders/impasto/common/shapes.wgsl"),
            include_str!("../shaders/impasto/common/axes.wgsl"),
            include_str!(concat!("../shaders/impasto/", $name, ".wgsl")),
        )
    };
}

use Binding as B;

/// The stage that pushes paint along an axis.
pub(crate) const PUSHES: &str = "advection";

/// The stages of a step, in order.
pub(crate) static KERNELS: [Kernel; 14] = [
    Kernel {
        name: "weigh_films",
        source: source!("weigh_films"),
        constants: &[],
        bindings: &[B::Load, B::Asks, B::Stats],
        groups: Groups::Segments,
    },
    Kernel {
        name: "bound_head",
        source: source!("bound_head"),
        constants: &[],
        bindings: &[B::Poses, B::Head, B::Stats],
        groups: Groups::Segments,
    },
    Kernel {
        name: "weigh_grid",
        source: source!("weigh_grid"),
        constants: &[],
        bindings: &[B::Planes, B::Base, B::Keys, B::Totals, B::Stats],
        groups: Groups::Grid,
    },
    Kernel {
        name: "rasterizer",
        source: source!("rasterizer"),
        constants: &[],
        bindings: &[B::Poses, B::Head, B::Segments, B::Asks, B::Keys, B::Stats],
        groups: Groups::Segments,
    },
    Kernel {
        name: "footprint",
        source: source!("footprint"),
        constants: &[
            ("SQUISH", SQUISH as f64),
            ("STABLE", STABLE as f64),
            ("SLIP", SLIP as f64),
            ("EASE", EASE as f64),
        ],
        bindings: &[
            B::Poses,
            B::Head,
            B::Segments,
            B::Load,
            B::Keys,
            B::Contacts,
            B::Totals,
            B::Stats,
        ],
        groups: Groups::Grid,
    },
    Kernel {
        name: "plan_step",
        source: source!("plan_step"),
        constants: &[],
        bindings: &[B::Load, B::Stats, B::Groups],
        groups: Groups::One,
    },
    Kernel {
        name: "velocity",
        source: source!("velocity"),
        constants: &[],
        bindings: &[B::Contacts, B::Faces],
        groups: Groups::Planned(4),
    },
    Kernel {
        name: PUSHES,
        source: source!("advection"),
        constants: &[("second", 0.0)],
        bindings: &[B::Planes, B::Other, B::Faces, B::Totals, B::Stats],
        groups: Groups::Planned(2),
    },
    Kernel {
        name: PUSHES,
        source: source!("advection"),
        constants: &[("second", 1.0)],
        bindings: &[B::Planes, B::Other, B::Faces, B::Totals, B::Stats],
        groups: Groups::Planned(3),
    },
    Kernel {
        name: "exchange_ask",
        source: source!("exchange_ask"),
        constants: &[("SWAP_FILM", SWAP_FILM as f64), ("POOL", POOL as f64)],
        bindings: &[B::Load, B::Asks, B::Contacts, B::Totals, B::Wants],
        groups: Groups::Planned(0),
    },
    Kernel {
        name: "exchange_apply",
        source: source!("exchange_apply"),
        constants: &[],
        bindings: &[
            B::Planes,
            B::Load,
            B::Asks,
            B::Contacts,
            B::Totals,
            B::Wants,
            B::Stats,
        ],
        groups: Groups::Planned(0),
    },
    Kernel {
        name: "bristle_flow",
        source: source!("bristle_flow"),
        constants: &[],
        bindings: &[B::Head, B::Load, B::Asks],
        groups: Groups::Planned(1),
    },
    seep(&[("second", 0.0), ("HOLDS", BrushTraits::HOLDS)]),
    seep(&[("second", 1.0), ("HOLDS", BrushTraits::HOLDS)]),
];

const fn seep(constants: &'static [(&'static str, f64)]) -> Kernel {
    Kernel {
        name: "seep",
        source: source!("seep"),
        constants,
        bindings: &[B::Head, B::Load],
        groups: Groups::Planned(5),
    }
}

const fn copy(constants: &'static [(&'static str, f64)]) -> Kernel {
    Kernel {
        name: "copy_planes",
        source: source!("copy_planes"),
        constants,
        bindings: &[B::Planes, B::Other],
        groups: Groups::Grid,
    }
}

/// What the advection is measured beside, in as many parts.
pub(crate) static COPIES: [Kernel; 2] = [copy(&[("second", 0.0)]), copy(&[("second", 1.0)])];

/// A stage on a device.
pub(crate) struct Pipeline {
    pub(crate) kernel: &'static Kernel,
    layout: wgpu::BindGroupLayout,
    pub(crate) pipeline: wgpu::ComputePipeline,
}

impl Pipeline {
    /// Makes the pipeline.
    pub(crate) fn new(gpu: &Device, kernel: &'static Kernel) -> Self {
        let entry = |binding, ty, size| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty: wgpu::BindingType::Buffer {
                ty,
                has_dynamic_offset: binding == 0,
                min_binding_size: size,
            },
            count: None,
        };
        let size = wgpu::BufferSize::new(RECORD_BYTES);
        let mut entries = vec![entry(0, wgpu::BufferBindingType::Uniform, size)];
        entries.extend(kernel.bindings.iter().map(|binding| {
            let read_only = binding.read_only();
            entry(
                *binding as u32,
                wgpu::BufferBindingType::Storage { read_only },
                None,
            )
        }));
        let label = Some(kernel.name);
        let layout = gpu
            .device
            .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                label,
                entries: &entries,
            });
        let whole = gpu
            .device
            .create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label,
                bind_group_layouts: &[Some(&layout)],
                immediate_size: 0,
            });
        let module = gpu
            .device
            .create_shader_module(wgpu::ShaderModuleDescriptor {
                label,
                source: wgpu::ShaderSource::Wgsl(kernel.source.into()),
            });
        let pipeline = gpu
            .device
            .create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
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
    pub(crate) fn bind<'a>(
        &self,
        gpu: &Device,
        records: &'a wgpu::Buffer,
        buffer: impl Fn(Binding) -> &'a wgpu::Buffer,
    ) -> wgpu::BindGroup {
        let record = wgpu::BufferBinding {
            buffer: records,
            offset: 0,
            size: wgpu::BufferSize::new(RECORD_BYTES),
        };
        let mut entries = vec![wgpu::BindGroupEntry {
            binding: 0,
            resource: wgpu::BindingResource::Buffer(record),
        }];
        entries.extend(
            self.kernel
                .bindings
                .iter()
                .map(|binding| wgpu::BindGroupEntry {
                    binding: *binding as u32,
                    resource: buffer(*binding).as_entire_binding(),
                }),
        );
        gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(self.kernel.name),
            layout: &self.layout,
            entries: &entries,
        })
    }
}
