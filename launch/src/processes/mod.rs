//! The processes of a rig. One program runs as each of them; the supervisor starts them, and they can
//! be started by hand with `maulstick node`.

mod brush;
mod haptic;
mod hid;
mod paint;
mod player;
mod recorder;
mod ui;

use std::ffi::CString;
use std::path::PathBuf;

use maulstick_bus::RigFolder;
use maulstick_rig::config::{BRUSH_NODE, DeviceSection, RigConfig};
use maulstick_rig::log::log_to_stderr;
use maulstick_rig::{NodeArgs, NodeHandle, UserError};
use nix::sys::prctl::{set_name, set_pdeathsig};
use nix::sys::signal::Signal;

/// Device name of the mouse over the window.
pub const MOUSE: &str = "mouse";
/// The pen over the window, as a device.
pub const PEN: &str = "pen";
/// Device name of the player.
pub const PLAYER: &str = "player";
/// Name of the node that records.
pub const RECORDER: &str = "recorder";

/// A process of a rig, with its options.
#[derive(clap::Subcommand, Debug)]
pub(crate) enum NodeCommand {
    /// Move a brush by the samples of styluses
    Brush(brush::BrushOptions),
    /// Paint the strokes of the brushes
    Paint(paint::PaintOptions),
    /// Drive a force-feedback stylus
    Haptic(haptic::HapticOptions),
    /// Read a pen tablet or a 6-DOF mouse
    Hid(hid::HidOptions),
    /// Play a take as a device
    Player(player::PlayerOptions),
    /// Record what the rig sends, as [record] of rig.toml says
    Recorder(recorder::RecorderOptions),
    /// Show the painting, and lend the mouse as a stylus
    Ui(ui::UiOptions),
}

/// Runs a process of a rig until it is told to stop.
///
/// # Errors
/// A [`UserError`].
pub(crate) fn run(command: &NodeCommand) -> Result<i32, UserError> {
    command.program().name_this_process();
    match command {
        NodeCommand::Brush(options) => brush::run(options),
        NodeCommand::Paint(options) => paint::run(options),
        NodeCommand::Haptic(options) => haptic::run(options),
        NodeCommand::Hid(options) => hid::run(options),
        NodeCommand::Player(options) => player::run(options),
        NodeCommand::Recorder(options) => recorder::run(options),
        NodeCommand::Ui(options) => ui::run(options),
    }
}

impl NodeCommand {
    fn program(&self) -> Program {
        match self {
            Self::Brush(_) => Program::Brush,
            Self::Paint(_) => Program::Paint,
            Self::Haptic(_) => Program::Haptic,
            Self::Hid(_) => Program::Hid,
            Self::Player(_) => Program::Player,
            Self::Recorder(_) => Program::Recorder,
            Self::Ui(_) => Program::Ui,
        }
    }
}

/// Program that a process of a rig runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Program {
    /// Node that simulates one brush.
    Brush,
    /// Node that simulates the paint.
    Paint,
    /// The daemon of a force-feedback stylus.
    Haptic,
    /// The daemon of a pen tablet or a 6-DOF mouse.
    Hid,
    /// The player of a take.
    Player,
    /// Recorder of sessions.
    Recorder,
    /// The painter's window.
    Ui,
}

impl Program {
    /// Its subcommand of `maulstick node`.
    #[must_use]
    pub fn subcommand(self) -> &'static str {
        match self {
            Self::Brush => "brush",
            Self::Paint => "paint",
            Self::Haptic => "haptic",
            Self::Hid => "hid",
            Self::Player => "player",
            Self::Recorder => "recorder",
            Self::Ui => "ui",
        }
    }

    /// Its name in the system's list of processes.
    #[must_use]
    pub fn process_name(self) -> String {
        format!("maulstick-{}", self.subcommand())
    }

    /// `ps` and `top` show a process by this name; the kernel keeps its first 15 bytes.
    fn name_this_process(self) {
        if let Ok(name) = CString::new(self.process_name()) {
            set_name(&name).ok();
        }
    }
}

/// Name of a brush's node.
#[must_use]
pub fn brush_node_name(brush: &str) -> String {
    format!("{BRUSH_NODE}{brush}")
}

/// Options of every node.
#[derive(clap::Args, Clone, Debug)]
pub(crate) struct NodeOptions {
    /// The rig's folder
    #[arg(long, value_name = "FOLDER", conflicts_with = "name")]
    folder: Option<PathBuf>,
    /// The rig's name, for a node that is started by hand
    #[arg(long, value_name = "RIG", default_value = "studio")]
    name: String,
    /// Name of the node in the rig
    #[arg(long, value_name = "NODE")]
    node: Option<String>,
    /// End with the launcher, which holds the standard input open
    #[arg(long, hide = true)]
    guarded: bool,
}

impl NodeOptions {
    /// Joins the rig; when the launcher dies this process gets `orphan`.
    fn join(&self, node: &str, orphan: Signal) -> Result<NodeHandle, UserError> {
        log_to_stderr("info");
        if self.guarded {
            let launcher = nix::unistd::getppid();
            set_pdeathsig(orphan).map_err(|error| UserError::failure(error.to_string()))?;
            if nix::unistd::getppid() != launcher {
                return Err(UserError::failure("the launcher is gone"));
            }
        }
        let folder = match &self.folder {
            Some(folder) => folder.clone(),
            None => RigFolder::join(&self.name)?.0.path().to_owned(),
        };
        let node = self.node.clone().unwrap_or_else(|| node.to_owned());
        NodeHandle::join(&NodeArgs {
            folder,
            node,
            guarded: self.guarded,
        })
    }
}

fn device_named(config: &RigConfig, name: &str) -> Result<DeviceSection, UserError> {
    let devices = config.device.iter();
    let device = devices.clone().find(|device| device.name == name);
    device.cloned().ok_or_else(|| {
        let what = format!("there is no device '{name}' in rig.toml");
        UserError::unknown(what, name, devices.map(|device| device.name.as_str()))
    })
}
