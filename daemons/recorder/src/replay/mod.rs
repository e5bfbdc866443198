//! A recording into a running rig.
//!
//! | module | holds |
//! | --- | --- |
//! | [`settings`], [`report`] | settings of a player, and its reports |
//! | [`player`] | the handle of a player at work |
//! | [`playback`] | transport, orders and reports of what plays |
//! | [`transport`] | pause, seek, step, rate |
//! | [`session`], [`session_painting`] | a session is painted again, in a painting of its own |
//! | [`streams`], [`senders`] | messages of chosen topics are sent again |
//! | [`pacing`] | no faster than brushes follow |
//! | [`driven`] | the device whose hand feels it |
//! | [`consent`] | its consent |
//! | [`guide`] | its strokes guide a hand that paints |
//! | [`place`] | a take elsewhere on the desk |
//! | [`events`] | what is to come |

mod consent;
mod driven;
mod events;
mod guide;
mod pacing;
pub(crate) mod place;
mod playback;
pub(crate) mod player;
pub(crate) mod report;
mod senders;
mod session;
mod session_painting;
pub(crate) mod settings;
mod streams;
pub(crate) mod transport;
