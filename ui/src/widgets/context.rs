//! State that a panel reads and changes.

use maulstick_types::command::Command;
use maulstick_types::values::ValueError;
use maulstick_ui_kit::notifications::Notifications;

use crate::rig::requests::Requests;
use crate::rig::state::RigState;
use crate::settings::preferences::Preferences;

/// The rig as it is, and what the painter makes of it.
#[derive(Debug)]
pub(crate) struct PanelContext<'a> {
    /// State of the rig.
    pub rig: &'a mut RigState,
    pub requests: &'a mut Requests,
    /// Settings that are remembered.
    pub preferences: &'a mut Preferences,
    /// Notifications to the painter.
    pub notifications: &'a mut Notifications,
}

/// Sends an edit; one that cannot be made is rejected with a notification.
pub(crate) fn ask<E: Into<Command>>(
    work: &mut PanelContext<'_>,
    edit: Result<E, ValueError>,
) -> bool {
    match edit {
        Ok(edit) => {
            work.requests.send(edit);
            true
        }
        Err(error) => {
            work.notifications.of(&error.into());
            false
        }
    }
}
