//! The stages of the flow as compute pipelines. All of them are bound to the window's fields, the step's record, and a record of
//! the call.

use maulstick_gpu::device::Device;

use super::record::{CALL_BYTES, WINDOW_BYTES};

/// Definition of a stage.
pub(crate) struct Kernel {
    /// Name of the entry point.
    pub(crate) name: &'static str,
    source: &'static str,
    /// Number of values read or written per place, each counted once, without those of earlier directions.
    pub(crate) words: u64,
}

macro_rules! stages {
    ($($stage:ident: $name:literal of $file:literal, $words:literal;)*) => {
        /// The stages.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub(crate) enum Stage {
            $($stage,)*
        }

        /// Definitions of the stages, in order.
        pub(crate) static KERNELS: &[Kernel] = &[$(
            Kernel {
                name: $name,
                source: concat!(
                    include_str!("shaders/common/window.wgsl"),
                    include_str!("shaders/common/sums.wgsl"),
                    include_str!("shaders/common/transfer.wgsl"),
                    include_str!("shaders/common/smoothing.wgsl"),
                    include_str!(concat!("shaders/", $file, ".wgsl")),
                ),
                words: $words,
            },
        )*];
    };
}

stages! {
    FindFaces: "find_faces" of "find_domain", 4;
    FindCells: "find_cells" of "find_domain", 7;
    FindFree: "find_free" of "find_domain", 6;
    FindEdges: "find_edges" of "find_domain", 10;
    WeighColumns: "weigh_columns" of "weigh_window", 1;
    AddUp: "add_up" of "add_up", 1;
    ChooseVelocity: "choose_velocity" of "begin_step", 6;
    FindViscosity: "find_viscosity" of "begin_step", 13;
    WeighEdges: "weigh_edges" of "begin_step", 7;
    FindRight: "find_right" of "begin_step", 5;
    FindStencil: "find_stencil" of "find_stencil", 11;
    InvertDiagonal: "invert_diagonal" of "find_stencil", 6;
    FindBulk: "find_bulk" of "find_stencil", 14;
    Coarsen: "coarsen" of "coarsen", 9;
    FindScale: "find_scale" of "coarsen", 3;
    ApplyOperator: "apply_operator" of "apply_operator", 13;
    FindLacking: "find_lacking" of "apply_operator", 9;
    MixPressure: "mix_pressure" of "apply_operator", 4;
    BeginCycle: "begin_cycle" of "cycle", 6;
    LeaveResidual: "leave_residual" of "cycle", 8;
    RestrictResidual: "restrict_residual" of "cycle", 10;
    CycleRest: "cycle_rest" of "cycle", 45;
    ProlongSolution: "prolong_solution" of "cycle", 4;
    RelaxSolution: "relax_solution" of "cycle", 7;
    MultiplyImages: "multiply_images" of "turn_residual", 1;
    TakeShares: "take_shares" of "turn_residual", 3;
    AnswerResidual: "answer_residual" of "turn_residual", 3;
    AddDirections: "add_directions" of "turn_residual", 2;
    WeighLacking: "weigh_lacking" of "free_of_divergence", 8;
    LevelLacking: "level_lacking" of "free_of_divergence", 3;
    MultiplyAnswer: "multiply_answer" of "free_of_divergence", 2;
    TurnDirection: "turn_direction" of "free_of_divergence", 3;
    BendDirection: "bend_direction" of "free_of_divergence", 6;
    FollowDirection: "follow_direction" of "free_of_divergence", 6;
    CorrectFlow: "correct_flow" of "free_of_divergence", 5;
    EndStep: "end_step" of "begin_step", 4;
    FillWindow: "fill_window" of "carry_paint", 4;
    TakeCounts: "take_counts" of "carry_paint", 9;
    AskFaces: "ask_faces" of "carry_paint", 8;
    ShareFaces: "share_faces" of "carry_paint", 6;
    CarryPaint: "carry_paint" of "carry_paint", 3;
    SettleDrops: "settle_drops" of "carry_paint", 6;
}

/// A constant of the shaders with another value: the seeded fault of a test.
pub type Fault = Option<(&'static str, f64)>;

/// The stages on a device.
#[derive(Debug)]
pub(crate) struct Pipelines {
    pub(crate) bindings: wgpu::BindGroupLayout,
    made: Vec<wgpu::ComputePipeline>,
}

impl Pipelines {
    /// Compiles the pipelines.
    pub(crate) fn new(gpu: &Device, fault: Fault) -> Self {
        let entry = |binding, ty, bytes| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty: wgpu::BindingType::Buffer {
                ty,
                has_dynamic_offset: binding == 0,
                min_binding_size: wgpu::BufferSize::new(bytes),
            },
            count: None,
        };
        let storage = wgpu::BufferBindingType::Storage { read_only: false };
        let label = Some("stokes");
        let bindings = gpu
            .device
            .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                label,
                entries: &[
                    entry(0, wgpu::BufferBindingType::Uniform, CALL_BYTES),
                    entry(1, wgpu::BufferBindingType::Uniform, WINDOW_BYTES),
                    entry(2, storage, 4),
                ],
            });
        let layout = gpu
            .device
            .create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label,
                bind_group_layouts: &[Some(&bindings)],
                immediate_size: 0,
            });
        let made = KERNELS
            .iter()
            .map(|kernel| pipeline(gpu, &layout, kernel, fault))
            .collect();
        Self { bindings, made }
    }

    /// The pipeline of a stage.
    pub(crate) fn of(&self, stage: Stage) -> &wgpu::ComputePipeline {
        &self.made[stage as usize]
    }
}

fn pipeline(
    gpu: &Device,
    layout: &wgpu::PipelineLayout,
    kernel: &Kernel,
    fault: Fault,
) -> wgpu::ComputePipeline {
    let label = Some(kernel.name);
    let module = gpu
        .device
        .create_shader_module(wgpu::ShaderModuleDescriptor {
            label,
            source: wgpu::ShaderSource::Wgsl(kernel.source.into()),
        });
    let constants: Vec<(&str, f64)> = fault
        .into_iter()
        .filter(|(name, _)| kernel.source.contains(name))
        .collect();
    gpu.device
        .create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label,
            layout: Some(layout),
            module: &module,
            entry_point: Some(kernel.name),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants: &constants,
                // Each sum writes all values that it adds.
                zero_initialize_workgroup_memory: false,
            },
            cache: None,
        })
}
