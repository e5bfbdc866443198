//! What a panel works with.

use crate::rig::requests::Orders;
use crate::rig::state::Studio;
use crate::settings::preferences::Habits;
use crate::widgets::notifications::Toasts;

/// The rig as it is, and what the painter makes of it.
#[derive(Debug)]
pub struct Work<'a> {
    /// What is known of the rig.
    pub studio: &'a mut Studio,
    /// What is asked of it.
    pub orders: &'a mut Orders,
    /// What is remembered.
    pub habits: &'a mut Habits,
    /// What is told.
    pub toasts: &'a mut Toasts,
}
