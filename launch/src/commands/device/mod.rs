//! Commands of devices: attached ones, the painting one, fitting, force.

mod add;
mod allow;
mod choose;
mod fit;
pub mod force;
pub mod force_order;
mod list;
mod remove;
mod rename;

use clap::Subcommand;
use maulstick_rig::UserError;

/// `maulstick device`.
#[derive(Clone, Debug, Subcommand)]
pub enum DeviceCommand {
    /// List attached devices, the drivers that fit, and what is missing
    List(list::ListOptions),
    /// Let the user at this machine use its devices
    ///
    /// It installs the rule for udev, and asks for the password.
    Allow(allow::AllowOptions),
    /// Paint with a device from now on: it is kept for this user, and starts in the running rig
    Add(add::AddOptions),
    /// Paint with a device no more
    Remove(remove::RemoveOptions),
    /// Give a device another name, in your own devices and in the running rig
    Rename(rename::RenameOptions),
    /// Choose the device that paints, its brush and its law of force, while painting
    Use(choose::UseOptions),
    /// Fit a device to the canvas by touching three corners
    Fit(fit::FitOptions),
    /// Show the force of a brush on the hand, by depth and angle; switch the force of a device
    Force(force::ForceOptions),
}

impl DeviceCommand {
    /// True for one that ends its own work at a signal.
    #[must_use]
    pub fn handles_signals(&self) -> bool {
        matches!(self, Self::Fit(_))
    }
}

/// Runs one of these commands.
///
/// # Errors
/// The [`UserError`] of the command.
pub fn run(command: &DeviceCommand) -> Result<i32, UserError> {
    match command {
        DeviceCommand::List(options) => list::run(options),
        DeviceCommand::Allow(options) => allow::run(options),
        DeviceCommand::Add(options) => add::run(options),
        DeviceCommand::Remove(options) => remove::run(options),
        DeviceCommand::Rename(options) => rename::run(options),
        DeviceCommand::Use(options) => choose::run(options),
        DeviceCommand::Fit(options) => fit::run(options),
        DeviceCommand::Force(options) => force::run(options),
    }
}
