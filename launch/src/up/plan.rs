//! Which processes a rig has.

use std::path::PathBuf;

use maulstick_rig::Fault;
use maulstick_rig::config::{Restart, RigConfig};

use crate::commands::bench::beside;
use crate::nodes::brush_node_name;

/// What a process is to the rig.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// The paint node.
    Paint,
    /// A brush node.
    Brush,
    /// A device daemon.
    Device,
    /// The window: closed with success it ends the rig.
    Window,
    /// The player of a take.
    Player,
}

/// A process to start.
#[derive(Clone, Debug)]
pub struct NodeSpec {
    /// Name of its token.
    pub name: String,
    /// What it is.
    pub role: Role,
    /// The program.
    pub program: PathBuf,
    /// Its arguments, besides those that every node gets.
    pub args: Vec<String>,
    /// When it is started again.
    pub restart: Restart,
}

/// A node of the rig.
///
/// # Errors
/// A [`Fault`] where its program is not beside this one.
pub fn node(
    config: &RigConfig,
    name: &str,
    role: Role,
    program: &str,
    args: Vec<String>,
) -> Result<NodeSpec, Fault> {
    let program = beside(program)?;
    if !program.is_file() {
        return Err(
            Fault::failure(format!("the program of node '{name}' is missing"))
                .at(program.display().to_string())
                .help("install the whole rig: cargo install --path launch"),
        );
    }
    // Settings are by the short name: `[node.brush]` holds for every brush.
    let short = name.split('-').next().unwrap_or(name);
    let section = config.node.get(name).or_else(|| config.node.get(short));
    let restart = section.map(|section| section.restart).unwrap_or_default();
    Ok(NodeSpec {
        name: name.to_owned(),
        role,
        program,
        args,
        restart,
    })
}

/// Whether a rig has a window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Window {
    /// One that shows the painting.
    Shown,
    /// None.
    Headless,
}

/// Who moves the brushes of a rig.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hands {
    /// Its devices.
    Devices,
    /// A take, in their place.
    Take,
}

/// The nodes of a rig.
///
/// # Errors
/// A [`Fault`] where a program is missing.
pub fn nodes(config: &RigConfig, window: Window, hands: Hands) -> Result<Vec<NodeSpec>, Fault> {
    let mut nodes = vec![node(
        config,
        "paint",
        Role::Paint,
        "maulstick-paint",
        Vec::new(),
    )?];
    for brush in &config.brush {
        let args = vec!["--brush".to_owned(), brush.name.clone()];
        let name = brush_node_name(&brush.name);
        nodes.push(node(config, &name, Role::Brush, "maulstick-brush", args)?);
    }
    if hands == Hands::Devices {
        for device in &config.device {
            let args = vec!["--device".to_owned(), device.name.clone()];
            let program = match device.is_hid() {
                true => "maulstick-hid",
                false => "maulstick-haptic",
            };
            nodes.push(node(config, &device.name, Role::Device, program, args)?);
        }
    }
    if window == Window::Shown {
        nodes.push(node(
            config,
            "ui",
            Role::Window,
            "maulstick-ui",
            Vec::new(),
        )?);
    }
    Ok(nodes)
}
