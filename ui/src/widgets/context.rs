//! State that a panel reads and changes.

use crate::rig::requests::Requests;
use crate::rig::state::RigState;
use crate::settings::preferences::Preferences;
use crate::widgets::notifications::Notifications;

/// The rig as it is, and what the painter makes of it.
#[derive(Debug)]
pub struct PanelContext<'a> {
    /// State of the rig.
    pub rig: &'a mut RigState,
    /// Requests to it.
    pub requests: &'a mut Requests,
    /// Settings that are remembered.
    pub preferences: &'a mut Preferences,
    /// Notifications to the painter.
    pub notifications: &'a mut Notifications,
}
