//! `maulstick device use`: which device paints, with what brush and what law of force, changed while painting.

use clap::Args;
use maulstick_rig::UserError;
use maulstick_rig::config::{DeviceSection, FORCES, PEN_PRIORITY};

use super::user_file::{UserFile, is_same, put_in_rig};
use crate::commands::say;
use crate::commands::session::{Session, Target};

/// Options of `maulstick device use`.
#[derive(Args, Clone, Debug)]
pub struct UseOptions {
    /// Name of the device
    device: String,
    /// Brush that it moves from now on
    #[arg(long)]
    brush: Option<String>,
    /// Law of its force
    #[arg(long, value_parser = FORCES)]
    force: Option<String>,
    /// Priority [default: above all others that move its brush]
    #[arg(long, allow_negative_numbers = true)]
    priority: Option<i32>,
    #[command(flatten)]
    target: Target,
}

/// Changes a device.
///
/// # Errors
/// A [`UserError`] where there is no such device, or the change does not fit.
pub(super) fn run(options: &UseOptions) -> Result<i32, UserError> {
    let mut file = UserFile::read()?;
    let name = &options.device;
    let in_rig = match Session::open(&options.target) {
        Ok(session) => session.config()?.device,
        Err(_) => Vec::new(),
    };
    let own = file.device(name).cloned();
    let is_own = own.is_ok();
    // A studio's device is one of the rig alone.
    let running = in_rig.iter().find(|device| device.name == *name);
    let device = own.or_else(|fault| running.cloned().ok_or(fault))?;
    is_same(&device, running)?;
    let brush = options
        .brush
        .clone()
        .unwrap_or_else(|| device.brush.clone());
    let others = file.devices.iter().chain(&in_rig);
    let others = others.filter(|other| other.name != *name && other.brush == brush);
    let highest = others.map(|other| other.priority).max();
    let priority = options
        .priority
        .unwrap_or_else(|| above(highest, device.priority));
    let changed = DeviceSection {
        priority,
        force: options
            .force
            .clone()
            .unwrap_or_else(|| device.force.clone()),
        brush,
        ..device
    };
    let answer = put_in_rig(&options.target, &changed)?;
    if is_own {
        file.put(&changed)?;
    }
    say!(
        "'{name}' moves '{}' with priority {priority}; its force is {}",
        changed.brush,
        changed.force
    );
    if answer.is_none() {
        say!("the rig does not run: `maulstick up` starts it so");
    }
    Ok(0)
}

/// The least priority above the others', the window's pen's among them, that is not below the device's own.
fn above(highest: Option<i32>, own: i32) -> i32 {
    let others = highest.unwrap_or(PEN_PRIORITY).max(PEN_PRIORITY);
    own.max(others.saturating_add(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_used_comes_before_all_others() {
        assert_eq!(above(None, 0), 0);
        assert_eq!(above(Some(10), 0), 11);
        assert_eq!(above(Some(10), 20), 20);
        assert_eq!(above(Some(10), 10), 11);
        assert_eq!(above(Some(-90), -80), PEN_PRIORITY + 1);
    }
}
