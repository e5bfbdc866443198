//! Software of vendors between a device and a program: libraries of OpenHaptics and of Force Dimension, the
//! OpenXR loader, Haply's service.

use std::net::{TcpStream, ToSocketAddrs as _};
use std::path::{Path, PathBuf};
use std::time::Duration;

use maulstick_haptic::drivers::openxr::runtime::LOADER;
use maulstick_haptic::drivers::vendor_library::VendorLibrary;

/// The folders of libraries, besides those that LD_LIBRARY_PATH names.
const FOLDERS: [&str; 5] = [
    "/usr/lib",
    "/usr/lib/x86_64-linux-gnu",
    "/usr/lib64",
    "/usr/local/lib",
    "/usr/local/lib64",
];
/// Where a folder of settings has the manifest of the active OpenXR runtime, as the loader looks for it.
const ACTIVE_RUNTIME: &str = "openxr/1/active_runtime.json";
/// Address of Haply's Inverse Service.
pub const INVERSE_SERVICE: &str = "localhost:10001";
/// Longest wait for a connection to a service of this machine.
const PATIENCE: Duration = Duration::from_millis(300);

/// The folders in which vendors' libraries are looked for.
#[must_use]
pub fn library_folders() -> Vec<PathBuf> {
    let named = std::env::var_os("LD_LIBRARY_PATH").unwrap_or_default();
    let named = std::env::split_paths(&named).filter(|path| path.is_absolute());
    named.chain(FOLDERS.map(PathBuf::from)).collect()
}

/// A vendor's library in the first of `folders` that has it. It is not loaded: OpenHaptics' may ask for the
/// device, and bears no second loading.
#[must_use]
pub fn library(vendor: &VendorLibrary, folders: &[impl AsRef<Path>]) -> Option<PathBuf> {
    let in_folder = |folder: &Path| {
        let paths = vendor.names.map(|name| folder.join(name));
        paths.into_iter().find(|path| path.exists())
    };
    folders.iter().find_map(|folder| in_folder(folder.as_ref()))
}

/// The OpenXR loader of `folders`, where a runtime is the user's or the system's active one: the loader alone serves
/// nothing.
#[must_use]
pub fn openxr_loader(folders: &[impl AsRef<Path>]) -> Option<PathBuf> {
    let named = std::env::var_os("XR_RUNTIME_JSON").map(PathBuf::from);
    let own = directories::BaseDirs::new().map(|dirs| dirs.config_dir().join(ACTIVE_RUNTIME));
    let all = ["/etc/xdg", "/etc", "/usr/local/share", "/usr/share"];
    let all = all.map(|folder| Path::new(folder).join(ACTIVE_RUNTIME));
    let is_active = match named {
        // The loader then looks nowhere else.
        Some(named) => named.exists(),
        None => own.into_iter().chain(all).any(|manifest| manifest.exists()),
    };
    is_active.then(|| library(&LOADER, folders)).flatten()
}

/// True if something listens at an address.
#[must_use]
pub fn listens(address: &str) -> bool {
    let addresses = address.to_socket_addrs().into_iter().flatten();
    let mut addresses = addresses.filter(|address| address.ip().is_loopback());
    addresses.any(|address| TcpStream::connect_timeout(&address, PATIENCE).is_ok())
}
