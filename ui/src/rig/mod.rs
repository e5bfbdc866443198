//! The rig as the window knows it, and requests to it.
//!
//! | module | holds |
//! | --- | --- |
//! | `state` | what is known of the rig; plain data |
//! | `listener` | subscribers that fill it |
//! | [`brushes`] | newest sample and bend of each brush |
//! | `force_history` | force trace of each device, and the device that paints |
//! | `sample_history` | what each device sensed, and how evenly |
//! | `child_process` | a command that runs beside the window |
//! | `device_commands` | `maulstick device`, run by the window |
//! | `device_listing` | what is attached, and settings of the rig's devices |
//! | `health` | events of the other processes |
//! | `thumbnails` | pictures of versions and steps |
//! | `requests` | commands that wait to be sent |
//! | `stroke_barrier` | delays a command until the strokes before it are painted, and tells brushes what is pending |
//! | `carried_paint` | what a brush carries, for its gauge |
//! | `dispatcher` | a queue and a thread for each node |

pub mod brushes;
pub(crate) mod carried_paint;
pub(crate) mod child_process;
pub(crate) mod device_commands;
pub(crate) mod device_listing;
pub(crate) mod dispatcher;
pub(crate) mod force_history;
pub(crate) mod health;
pub(crate) mod listener;
pub(crate) mod requests;
pub(crate) mod sample_history;
pub(crate) mod state;
pub(crate) mod stroke_barrier;
pub(crate) mod thumbnails;
