//! What a panel works with.

use crate::rig::requests::Requests;
use crate::rig::state::RigState;
use crate::settings::preferences::Preferences;
use crate::widgets::notifications::Notifications;

/// The rig as it is, and what the painter makes of it.
#[derive(Debug)]
pub struct PanelContext<'a> {
    /// What is known of the rig.
    pub rig: &'a mut RigState,
    /// What is asked of it.
    pub requests: &'a mut Requests,
    /// What is remembered.
    pub preferences: &'a mut Preferences,
    /// What is told.
    pub notifications: &'a mut Notifications,
}
