//! Facts about this machine that matter to a rig.

use std::collections::BTreeSet;
use std::fs::read_to_string;
use std::os::unix::fs::MetadataExt as _;
use std::path::{Path, PathBuf};

use maulstick_bus::{BusError, RigFolder};
use maulstick_gpu::{AdapterReport, Choice, Device, GpuError};
use maulstick_haptic::servo::servo_thread::take_priority;
use maulstick_rig::UserError;
use maulstick_window_pen::{wayland, xinput};
use nix::sys::resource::{Resource, getrlimit};
use nix::sys::statvfs::statvfs;
use nix::unistd::geteuid;

use maulstick_device_setup::attached::{
    Attached, Permission, Places, events, hid, permission, serial,
};

/// Folder of the kernel's clocks.
pub(super) const CLOCK: &str = "/sys/devices/system/clocksource/clocksource0";
/// Folder of the kernel's processors.
const PROCESSORS: &str = "/sys/devices/system/cpu";

/// The machine.
#[derive(Debug)]
pub(super) struct Facts {
    /// Its graphics.
    pub graphics: Graphics,
    /// Rights of the servo.
    pub real_time: RealTime,
    /// Memory that may be locked, bytes; `None` without a limit.
    pub lockable: Option<u64>,
    /// Devices that a driver fits.
    pub devices: Vec<Attached>,
    /// The kernel's clock; `None` if unknown.
    pub clock: Option<Clock>,
    /// Drivers and governors of the processors' speed; empty if unknown, as in virtual machines.
    pub governors: BTreeSet<Governor>,
    /// Folders that are written to, one a file system.
    pub disks: Vec<Disk>,
    /// Free shared memory, bytes; `None` without `/dev/shm`.
    pub shared: Option<u64>,
    /// Folder of the rigs' sockets.
    pub sockets: Result<PathBuf, BusError>,
    /// Display of the window.
    pub display: Display,
}

/// Graphics.
#[derive(Debug)]
pub(super) struct Graphics {
    /// The adapters, the best first.
    pub adapters: Vec<AdapterReport>,
    /// Name of the one that would compute the paint.
    pub paint: Result<String, GpuError>,
    /// Nodes of graphics processors that the user may not open.
    pub denied: Vec<PathBuf>,
}

/// Rights of the servo.
#[derive(Debug)]
pub(super) struct RealTime {
    /// Refusal of its priority; `None` if it may take it.
    pub refusal: Option<String>,
    /// Highest priority that the user's limits allow.
    pub limit: u64,
}

/// The kernel's clock.
#[derive(Debug)]
pub(super) struct Clock {
    /// The one in use.
    pub current: String,
    /// Names of the available ones, separated by spaces.
    pub available: String,
}

/// Control of a processor's speed.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Governor {
    /// Driver.
    pub driver: String,
    /// Governor.
    pub name: String,
}

/// Free space of a file system.
#[derive(Debug)]
pub(super) struct Disk {
    /// A folder on it.
    pub folder: PathBuf,
    /// Free space for this user, bytes.
    pub free: u64,
}

/// Display of the window.
#[derive(Debug)]
pub(super) struct Display {
    /// Window system that the environment names; `None` without one.
    pub server: Option<&'static str>,
    /// True if it reports pens; an error if it is not reachable.
    pub tells_of_pens: Result<bool, UserError>,
}

impl Facts {
    /// Facts of this machine.
    pub(super) fn of_this_machine() -> Self {
        let devices = Places::here();
        let hid = hid::devices(&devices);
        let mut attached = events::devices(&devices, &hid);
        attached.extend(hid);
        attached.extend(serial::ports(&devices));
        attached.retain(|device| device.driver.is_some());
        Self {
            real_time: real_time(),
            graphics: graphics(),
            lockable: lockable(),
            devices: attached,
            clock: clock(Path::new(CLOCK)),
            governors: governors(Path::new(PROCESSORS)),
            disks: disks(),
            shared: free(Path::new("/dev/shm")),
            sockets: RigFolder::parent_for("studio"),
            display: display(),
        }
    }
}

fn real_time() -> RealTime {
    let tried = std::thread::spawn(|| take_priority().err().map(|error| error.to_string()));
    let refusal = tried.join();
    RealTime {
        refusal: refusal.unwrap_or_else(|_| Some("the attempt panicked".into())),
        limit: getrlimit(Resource::RLIMIT_RTPRIO).map_or(0, |(soft, _)| soft),
    }
}

/// Memory that this user may lock, bytes. Root has no limit.
fn lockable() -> Option<u64> {
    let limit = getrlimit(Resource::RLIMIT_MEMLOCK).map_or(0, |(soft, _)| soft);
    (limit != u64::MAX && !geteuid().is_root()).then_some(limit)
}

fn graphics() -> Graphics {
    let nodes = std::fs::read_dir("/dev/dri")
        .into_iter()
        .flatten()
        .flatten();
    let nodes = nodes.filter(|node| node.file_name().to_string_lossy().starts_with("renderD"));
    let mut denied: Vec<PathBuf> = nodes
        .map(|node| node.path())
        .filter(|node| permission(node) == Permission::Denied)
        .collect();
    denied.sort_unstable();
    Graphics {
        adapters: maulstick_gpu::adapters(),
        paint: Device::open(Choice::Auto).map(|device| device.name().to_owned()),
        denied,
    }
}

/// The clock of a folder of the kernel's.
pub(super) fn clock(folder: &Path) -> Option<Clock> {
    let read = |name: &str| Some(read_to_string(folder.join(name)).ok()?.trim().to_owned());
    Some(Clock {
        current: read("current_clocksource")?,
        available: read("available_clocksource").unwrap_or_default(),
    })
}

/// The governors of a folder of the kernel's.
pub(super) fn governors(folder: &Path) -> BTreeSet<Governor> {
    let processors = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let governor = |processor: std::fs::DirEntry| {
        let folder = processor.path().join("cpufreq");
        let read = |name: &str| Some(read_to_string(folder.join(name)).ok()?.trim().to_owned());
        Some(Governor {
            driver: read("scaling_driver").unwrap_or_default(),
            name: read("scaling_governor")?,
        })
    };
    processors.filter_map(governor).collect()
}

/// The folders of commands and of the window for saving.
fn disks() -> Vec<Disk> {
    let own = directories::UserDirs::new();
    let own = own.map(|own| {
        own.picture_dir()
            .unwrap_or_else(|| own.home_dir())
            .to_owned()
    });
    let mut seen = BTreeSet::new();
    let mut disks = Vec::new();
    for folder in std::env::current_dir().into_iter().chain(own) {
        let system = std::fs::metadata(&folder).map(|folder| folder.dev());
        if let (Ok(system), Some(free)) = (system, free(&folder))
            && seen.insert(system)
        {
            disks.push(Disk { folder, free });
        }
    }
    disks
}

/// Free space for this user on the file system of a folder, bytes.
fn free(folder: &Path) -> Option<u64> {
    let system = statvfs(folder).ok()?;
    Some(system.blocks_available() * system.fragment_size())
}

/// The display, as the window chooses it: Wayland before X11.
fn display() -> Display {
    let is_named = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    let (server, tells_of_pens) = if is_named("WAYLAND_DISPLAY") {
        (Some("Wayland"), wayland::tells_of_pens())
    } else if is_named("DISPLAY") {
        (Some("X11"), xinput::tells_of_pens())
    } else {
        (None, Ok(false))
    };
    Display {
        server,
        tells_of_pens,
    }
}
