//! State on the device after a stage of a step, for tests that compare each stage with its twin.

use bytemuck::pod_collect_to_vec;
use maulstick_model::footprint::contact::Contact;
use maulstick_model::interface::Step;

use maulstick_gpu::device::{Device, GpuError};
use maulstick_gpu::steps::kernels::Binding;
use maulstick_gpu::steps::probing::Probing;

use super::stages::KERNELS;
use super::{Steps, pushed};

/// State after a stage.
#[derive(Clone, Debug)]
pub struct Probe {
    /// Lowest column and row of the window in the step's grid.
    pub from: [usize; 2],
    /// Columns and rows of the grid.
    pub size: [usize; 2],
    /// The cells in contact, row by row; `local` is their place in the grid.
    pub contacts: Vec<Contact>,
    /// Velocities through the right and the upper face of each cell of the grid.
    pub faces: Vec<[f32; 2]>,
}

/// Stages of steps, run separately.
pub struct Prober {
    stages: Probing<Steps>,
}

impl Prober {
    /// The stages on a device.
    ///
    /// # Errors
    /// A [`GpuError`] where the driver rejects the shaders.
    pub fn new(gpu: Device) -> Result<Self, GpuError> {
        let stages = Probing::new(gpu, &KERNELS, Steps)?;
        Ok(Self { stages })
    }

    /// Runs the stages of a step up to the last one called `last`, writes their result to its window and load, and
    /// returns their other results. `None` where the head is beside the surface, or its window is too large.
    ///
    /// # Errors
    /// A [`GpuError`] of the device.
    pub fn run(&mut self, step: &mut Step<'_>, last: &str) -> Result<Option<Probe>, GpuError> {
        let (Some(probed), Some(grid)) = (self.stages.run(step, last)?, pushed(step)) else {
            return Ok(None);
        };
        let (from, size) = (grid.from, grid.size);
        let cells = u64::from(size[0]) * u64::from(size[1]);
        let ranges = [
            (Binding::Contacts, 0, 32 * cells),
            (Binding::Faces, 0, 8 * cells),
        ];
        let (contacts, faces) = self.stages.workspace.read(&ranges, |bytes| {
            let (contacts, faces) = bytes.split_at(32 * cells as usize);
            let contacts: Vec<[u32; 8]> = pod_collect_to_vec(contacts);
            (contacts, pod_collect_to_vec(faces))
        })?;
        let width = step.window.width();
        self.stages.write(probed, step)?;
        let place = |local: usize| {
            let [x, y] = [local % size[0] as usize, local / size[0] as usize];
            (from[1] as usize + y) * width + from[0] as usize + x
        };
        let contacts = contacts.iter().enumerate();
        let contacts = contacts.filter(|(_, words)| words[0] != u32::MAX);
        let contacts = contacts.map(|(local, words)| {
            let value = |word: usize| f32::from_bits(words[word]);
            Contact {
                cell: place(local) as u32,
                local: local as u32,
                texel: words[0],
                cover: value(1),
                moved: [value(2), value(3)],
                depth: value(4).max(0.0),
                fraction: value(5),
                gap: (-value(4)).max(0.0),
            }
        });
        Ok(Some(Probe {
            from: from.map(|cell| cell as usize),
            size: size.map(|cells| cells as usize),
            contacts: contacts.collect(),
            faces,
        }))
    }
}
