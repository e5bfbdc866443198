//! The processes of a rig.

use maulstick_rig::config::{DeviceSection, Restart, RigConfig};

use crate::processes::{Program, RECORDER, brush_node_name};

/// Role of a process in the rig.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Node that simulates the paint.
    Paint,
    /// Node that simulates one brush.
    Brush,
    /// Daemon of a device.
    Device,
    /// The window: closed with success it ends the rig.
    Window,
    /// The player of a take.
    Player,
    /// The recorder of the run.
    Recorder,
}

impl Role {
    /// True if the rig can do without it, however it ends.
    #[must_use]
    pub fn is_spare(self) -> bool {
        matches!(self, Self::Device | Self::Recorder)
    }
}

/// A process to start.
#[derive(Clone, Debug)]
pub struct NodeSpec {
    /// Name of its token.
    pub name: String,
    /// Its role.
    pub role: Role,
    /// Program that the process runs.
    pub program: Program,
    /// Its arguments, besides those that every node gets.
    pub args: Vec<String>,
    /// When it is started again.
    pub restart: Restart,
}

/// A node of the rig.
#[must_use]
pub fn node(
    config: &RigConfig,
    name: &str,
    role: Role,
    program: Program,
    args: Vec<String>,
) -> NodeSpec {
    // Settings are by the short name: `[node.brush]` holds for every brush.
    let short = name.split('-').next().unwrap_or(name);
    let section = config.node.get(name).or_else(|| config.node.get(short));
    let restart = section.map(|section| section.restart).unwrap_or_default();
    NodeSpec {
        name: name.to_owned(),
        role,
        program,
        args,
        restart,
    }
}

/// The daemon of a device.
#[must_use]
pub fn device(config: &RigConfig, device: &DeviceSection) -> NodeSpec {
    let mut args = vec!["--device".to_owned(), device.name.clone()];
    let program = if device.is_hid() {
        Program::Hid
    } else {
        Program::Haptic
    };
    if program == Program::Haptic {
        for library in &config.allowed_libraries {
            args.extend(["--allow-library".to_owned(), library.display().to_string()]);
        }
    }
    node(config, &device.name, Role::Device, program, args)
}

/// Presence of a window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Window {
    /// One that shows the painting.
    Shown,
    /// No window.
    Headless,
}

/// Source of the brushes' motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hands {
    /// Devices of the rig.
    Devices,
    /// A take, in their place.
    Take,
}

/// The nodes of a rig.
#[must_use]
pub fn nodes(config: &RigConfig, window: Window, hands: Hands) -> Vec<NodeSpec> {
    let mut nodes = vec![node(
        config,
        "paint",
        Role::Paint,
        Program::Paint,
        Vec::new(),
    )];
    if config.record.is_some() {
        let (role, program) = (Role::Recorder, Program::Recorder);
        nodes.push(node(config, RECORDER, role, program, Vec::new()));
    }
    for brush in &config.brush {
        let args = vec!["--brush".to_owned(), brush.name.clone()];
        let name = brush_node_name(&brush.name);
        nodes.push(node(config, &name, Role::Brush, Program::Brush, args));
    }
    if hands == Hands::Devices {
        nodes.extend(config.device.iter().map(|own| device(config, own)));
    }
    if window == Window::Shown {
        nodes.push(node(config, "ui", Role::Window, Program::Ui, Vec::new()));
    }
    nodes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_user_trusts_is_told_to_devices_with_force_alone() {
        let mut config = RigConfig::default();
        let arm = DeviceSection::new("arm", "openhaptics", "main");
        let trusts = |config: &RigConfig, section: &DeviceSection| {
            let args = device(config, section).args;
            args.windows(2)
                .any(|pair| pair == ["--allow-library", "/home/me/libHD.so"])
        };
        assert!(!trusts(&config, &arm));
        config.allowed_libraries.push("/home/me/libHD.so".into());
        assert!(trusts(&config, &arm));
        assert!(!trusts(&config, &DeviceSection::new("pen", "pen", "main")));
    }
}
