//! A contact model that the servo evaluates, and its age.

use super::limits::Limits;
use crate::contact::Contact;

/// A model and its age.
#[derive(Clone, Copy, Debug)]
pub(super) struct Active {
    pub(super) contact: Contact,
    pub(super) age_s: f64,
}

impl Active {
    /// Time since the end of its time to live, s; negative before.
    pub(super) fn overdue_s(&self) -> f64 {
        self.age_s - self.contact.time_to_live_s
    }

    /// Share of its force past its time to live, 1 to 0.
    pub(super) fn left(&self, limits: &Limits) -> f64 {
        (1.0 - self.overdue_s().max(0.0) / limits.fade_s).max(0.0)
    }
}
