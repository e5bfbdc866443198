//! The graphics device, with its errors as values: by default wgpu panics on an uncaptured error, and on a device
//! lost during a wait.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use pollster::block_on;

/// Longest duration of a batch. A driver gives up a hung device after 2 to 10 s.
const PATIENCE: Duration = Duration::from_secs(20);

/// Policy of choosing an adapter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Choice {
    /// Only a real graphics processor: an emulated one is slower than the processor itself.
    #[default]
    Auto,
    /// Any adapter, including an emulated one such as lavapipe.
    Forced,
}

/// Errors of the graphics device.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum GpuError {
    /// No adapter of the requested kind.
    #[error("no suitable graphics adapter: {0}")]
    None(String),
    /// The device was lost, or does not respond.
    #[error("it was lost: {0}")]
    Lost(String),
    /// The device is out of memory.
    #[error("its memory is full")]
    Memory,
    /// A window that needs a larger buffer than the device allows.
    #[error(
        "a window of {}x{}x{} cells needs {} MiB in one piece, and it has at most {}: choose larger cells or a smaller window",
        cells[0], cells[1], cells[2], needs.div_ceil(1 << 20), most >> 20
    )]
    Window {
        /// Number of cells along each axis.
        cells: [usize; 3],
        /// Bytes needed.
        needs: u64,
        /// Bytes allowed.
        most: u64,
    },
    /// A request rejected by the driver.
    #[error("its driver refuses: {0}")]
    Refused(String),
}

/// An open device.
#[derive(Clone, Debug)]
pub struct Device {
    /// Logical device, which creates resources.
    pub device: wgpu::Device,
    /// Queue of submissions, executed in order.
    pub queue: wgpu::Queue,
    info: wgpu::AdapterInfo,
    lost: Arc<Mutex<Option<String>>>,
    stray: Arc<Mutex<Option<GpuError>>>,
}

/// Requested limits: those of nearly every device with compute shaders, with the adapter's own buffer sizes.
fn limits(most: &wgpu::Limits) -> wgpu::Limits {
    let least = wgpu::Limits::downlevel_defaults();
    wgpu::Limits {
        max_storage_buffers_per_shader_stage: 8,
        max_buffer_size: least.max_buffer_size.max(most.max_buffer_size),
        max_storage_buffer_binding_size: least
            .max_storage_buffer_binding_size
            .max(most.max_storage_buffer_binding_size),
        ..least
    }
}

/// Rank of an adapter, the best lowest; `None` where it is unsuitable.
fn rank(info: &wgpu::AdapterInfo, choice: Choice) -> Option<u32> {
    match info.device_type {
        wgpu::DeviceType::DiscreteGpu => Some(0),
        wgpu::DeviceType::IntegratedGpu => Some(1),
        wgpu::DeviceType::VirtualGpu => Some(2),
        wgpu::DeviceType::Other | wgpu::DeviceType::Cpu => (choice == Choice::Forced).then_some(3),
    }
}

/// Groups of backends, in order of preference. OpenGL comes last, because it lists the same adapters again.
const ANY: [wgpu::Backends; 2] = [wgpu::Backends::PRIMARY, wgpu::Backends::GL];

/// Suitable adapters of the backends, the best first.
fn wanted(backends: wgpu::Backends, choice: Choice) -> Vec<wgpu::Adapter> {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = backends;
    // Validating an indirect dispatch costs a dispatch of its own; the sizes are those of `plan_step`.
    descriptor.flags -= wgpu::InstanceFlags::VALIDATION_INDIRECT_CALL;
    let instance = wgpu::Instance::new(descriptor);
    let adapters = block_on(instance.enumerate_adapters(backends)).into_iter();
    let mut wanted: Vec<(u32, wgpu::Adapter)> = adapters
        .filter_map(|adapter| Some((rank(&adapter.get_info(), choice)?, adapter)))
        .collect();
    wanted.sort_by_key(|(rank, _)| *rank);
    wanted.into_iter().map(|(_, adapter)| adapter).collect()
}

/// Description of an adapter of this machine.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AdapterReport {
    /// Name of the adapter.
    pub name: String,
    /// Graphics interface, such as Vulkan.
    pub backend: String,
    /// Name and version of the driver.
    pub driver: String,
    /// True if a processor emulates it.
    pub is_emulated: bool,
}

/// The adapters of this machine, emulated ones too, in the order in which [`Device::open`] tries them.
#[must_use]
pub fn adapters() -> Vec<AdapterReport> {
    let mut found = ANY.into_iter().map(|any| wanted(any, Choice::Forced));
    let found = found.find(|found| !found.is_empty()).unwrap_or_default();
    let report = |adapter: &wgpu::Adapter| {
        let info = adapter.get_info();
        AdapterReport {
            name: info.name,
            backend: format!("{:?}", info.backend),
            driver: format!("{} {}", info.driver, info.driver_info)
                .trim()
                .to_owned(),
            is_emulated: info.device_type == wgpu::DeviceType::Cpu,
        }
    };
    found.iter().map(report).collect()
}

/// True if the kernel lists a graphics processor. Otherwise the drivers would be loaded only to find the emulated
/// adapters; Mesa's layer would also look for a Wayland display, and complain on stderr without a session.
fn has_processor(devices: &Path) -> bool {
    // WSL; NVIDIA's; those of telephones and single-board computers; all others are in `dri`.
    const NODES: [&str; 5] = ["dxg", "nvidia", "mali", "kgsl", "pvr"];
    let holds = |folder: &Path, starts: &[&str]| {
        let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
        let mut names = entries.map(|entry| entry.file_name().to_string_lossy().into_owned());
        names.any(|name| starts.iter().any(|start| name.starts_with(start)))
    };
    !cfg!(target_os = "linux")
        || holds(&devices.join("dri"), &["renderD"])
        || holds(devices, &NODES)
}

fn keep<T>(place: &Mutex<Option<T>>, first: T) {
    let mut held = place.lock().unwrap_or_else(PoisonError::into_inner);
    held.get_or_insert(first);
}

impl From<wgpu::Error> for GpuError {
    fn from(error: wgpu::Error) -> Self {
        match error {
            wgpu::Error::OutOfMemory { .. } => Self::Memory,
            wgpu::Error::Validation { description, .. }
            | wgpu::Error::Internal { description, .. } => Self::Refused(description),
        }
    }
}

impl Device {
    /// Opens the best adapter.
    ///
    /// # Errors
    /// [`GpuError::None`].
    pub fn open(choice: Choice) -> Result<Self, GpuError> {
        let mut refusals = Vec::new();
        let backends: &[wgpu::Backends] = match choice {
            Choice::Auto if !has_processor(Path::new("/dev")) => &[],
            Choice::Auto => &[wgpu::Backends::PRIMARY],
            Choice::Forced => &ANY,
        };
        for backends in backends.iter().copied() {
            for adapter in wanted(backends, choice) {
                match Self::on(&adapter) {
                    Ok(device) => return Ok(device),
                    Err(refusal) => {
                        refusals.push(format!("{}: {refusal}", adapter.get_info().name));
                    }
                }
            }
        }
        if refusals.is_empty() {
            refusals.push(match choice {
                Choice::Auto => "all are emulated by the processor".to_owned(),
                Choice::Forced => "no driver is installed".to_owned(),
            });
        }
        Err(GpuError::None(refusals.join("; ")))
    }

    fn on(adapter: &wgpu::Adapter) -> Result<Self, wgpu::RequestDeviceError> {
        let info = adapter.get_info();
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("maulstick"),
            required_limits: limits(&adapter.limits()),
            ..Default::default()
        };
        let (device, queue) = block_on(adapter.request_device(&descriptor))?;
        let (lost, stray) = (Arc::new(Mutex::new(None)), Arc::new(Mutex::new(None)));
        let on_loss = Arc::clone(&lost);
        device.set_device_lost_callback(move |_, reason| keep(&on_loss, reason));
        let on_error = Arc::clone(&stray);
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            keep(&on_error, GpuError::from(error));
        }));
        Ok(Self {
            device,
            queue,
            info,
            lost,
            stray,
        })
    }

    /// The adapter's name.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.info.name
    }

    /// True if a processor emulates the device.
    #[must_use]
    pub fn is_cpu(&self) -> bool {
        self.info.device_type == wgpu::DeviceType::Cpu
    }

    /// Runs `work` with the device; a device error meanwhile is the result.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn guarded<T>(&self, work: impl FnOnce() -> Result<T, GpuError>) -> Result<T, GpuError> {
        self.check_lost()?;
        let filters = [
            wgpu::ErrorFilter::Validation,
            wgpu::ErrorFilter::OutOfMemory,
            wgpu::ErrorFilter::Internal,
        ];
        let scopes = filters.map(|filter| self.device.push_error_scope(filter));
        let done = work();
        // Scopes pop in reverse order; the last one popped decides.
        let mut fault = None;
        for scope in scopes.into_iter().rev() {
            fault = block_on(scope.pop()).map(GpuError::from).or(fault);
        }
        if done.is_err() || fault.is_some() {
            // A loss is reported only during a poll.
            self.poll(wgpu::PollType::Poll);
        }
        self.check_lost()?;
        let mut stray = self.stray.lock().unwrap_or_else(PoisonError::into_inner);
        match fault.or(stray.take()) {
            Some(fault) => Err(fault),
            None => done,
        }
    }

    /// Waits until the device has finished all submissions.
    ///
    /// # Errors
    /// [`GpuError::Lost`].
    pub fn wait(&self) -> Result<(), GpuError> {
        self.poll(wgpu::PollType::Wait {
            submission_index: None,
            timeout: Some(PATIENCE),
        });
        self.check_lost()
    }

    fn poll(&self, how: wgpu::PollType) {
        match catch_unwind(AssertUnwindSafe(|| self.device.poll(how))) {
            Ok(Ok(_)) => {}
            Ok(Err(error)) => keep(&self.lost, error.to_string()),
            Err(_) => keep(&self.lost, "it broke down at work".to_owned()),
        }
    }

    fn check_lost(&self) -> Result<(), GpuError> {
        let lost = self.lost.lock().unwrap_or_else(PoisonError::into_inner);
        lost.clone()
            .map_or(Ok(()), |reason| Err(GpuError::Lost(reason)))
    }
}

#[cfg(test)]
#[cfg(target_os = "linux")]
mod tests {
    use super::*;

    #[test]
    fn a_processor_is_known_by_its_device() {
        let folder = tempfile::tempdir().expect("a folder");
        let devices = folder.path();
        let with = |node: &str| {
            let path = devices.join(node);
            std::fs::create_dir_all(path.parent().expect("a folder")).expect("made");
            std::fs::write(&path, []).expect("written");
            let found = has_processor(devices);
            std::fs::remove_file(path).expect("removed");
            found
        };
        assert!(!has_processor(devices) && !has_processor(&devices.join("none")));
        for node in ["dri/renderD128", "nvidia0", "nvidiactl", "dxg", "mali0"] {
            assert!(with(node), "{node}");
        }
        // A screen that is drawn by the processor itself.
        for node in ["dri/card0", "null", "fb0"] {
            assert!(!with(node), "{node}");
        }
    }
}
