//! The window's state of the rig, and the painter's requests and notifications.

use maulstick_ui_kit::notifications::Notifications;

use crate::rig::requests::Requests;
use crate::rig::state::RigState;
use crate::settings::preferences::Preferences;
use crate::widgets::context::PanelContext;

/// Data that panels read and change.
#[derive(Debug)]
pub(super) struct Studio {
    /// State of the rig.
    pub(super) rig: RigState,
    pub(super) requests: Requests,
    /// Settings that are remembered.
    pub(super) preferences: Preferences,
    /// Notifications to the painter.
    pub(super) notifications: Notifications,
}

impl Studio {
    /// The same for a panel.
    pub(super) fn context(&mut self) -> PanelContext<'_> {
        PanelContext {
            rig: &mut self.rig,
            requests: &mut self.requests,
            preferences: &mut self.preferences,
            notifications: &mut self.notifications,
        }
    }

    /// True while the panel of the devices is open.
    pub(super) fn shows_devices(&self) -> bool {
        self.preferences.window.panels && self.preferences.is_open("Device")
    }
}
