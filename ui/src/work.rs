//! What a panel works with.

use crate::habits::Habits;
use crate::orders::Orders;
use crate::studio::Studio;
use crate::toasts::Toasts;

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
