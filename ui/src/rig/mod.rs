//! The rig as the window knows it, and requests to it; what needs no brush and no paint is in `maulstick-client`.
//!
//! | module | holds |
//! | --- | --- |
//! | `state` | what is known of the rig; plain data |
//! | [`brushes`] | newest sample and bend of each brush |
//! | `device_order` | orders to the set-up of devices, and a fit in progress |
//! | `device_setup` | changes and listings of devices, on a thread |
//! | `health` | events of the other processes |
//! | `requests` | commands that wait to be sent |
//! | `carried_paint` | what a brush carries, for its gauge |

pub mod brushes;
pub(crate) mod carried_paint;
pub(crate) mod device_order;
pub(crate) mod device_setup;
pub(crate) mod health;
#[cfg(test)]
mod order_tests;
pub(crate) mod requests;
pub(crate) mod state;
