//! Recorder and player of a rig: its streams into files, and recordings into a running rig.
//!
//! | module | holds |
//! | --- | --- |
//! | `recording` | [`Recorder`]: streams into a file, or a ring of files, with the painting as it was |
//! | `replay` | [`Player`]: a session painted again, streams sent again, a hand guided along strokes |
//! | [`listener`] | messages of a running rig, whatever they are |
//! | [`session_file`] | a session in a recording: its painting, and what was accepted since |
//! | [`paintings`] | paintings with which sessions begin |
//! | `error` | errors, and their words for a user |
//!
//! Both are tasks on a tokio runtime of the caller, which gets their events over a channel and stops them by their
//! handle. The window and the command line call the same functions; who owns the handle puts events into words.
//!
//! ```no_run
//! use maulstick_recorder::{Player, Recorder, RecorderSettings, ReplaySettings, Ring};
//!
//! # async fn record() -> Result<(), maulstick_recorder::RecorderError> {
//! let runtime = tokio::runtime::Handle::current();
//! let settings = RecorderSettings::default();
//! let ring = Ring::new("session.mcap".as_ref(), settings.division);
//! let mut recorder = Recorder::start(&runtime, "studio", settings, ring);
//! let begun = recorder.events.recv().await;
//! recorder.stop();
//! recorder.ended().await?;
//!
//! let player = Player::start(&runtime, "studio", ReplaySettings::new("session.mcap"));
//! player.ended().await
//! # }
//! ```
//!
//! # Notes
//!
//! - The runtime has to be one of several threads (`new_multi_thread`, one worker is enough): opening and closing a zenoh
//!   session, and questions to a node, block in place.
//! - Waiting is for messages, orders, timers and the stop flag at once. A file is written where its messages arrive: the
//!   queue of the listener holds some seconds of all streams meanwhile. A recording is read, and a painting copied,
//!   on the runtime's threads for blocking work; the crate starts no thread of its own.
//! - A recording of a session holds a copy of the painting's file, taken once the paint's credit covers what was on its
//!   way, or half a second later. Where the journal breaks off (another paint node, a lost entry or state), another file
//!   begins.
//! - A recording whose recorder was killed has no index: [`complete_in`] writes it anew, whole, with a note of its damage.
//! - A player at its fastest rate sends as the brushes have credit.

mod error;
pub mod listener;
pub mod paintings;
mod recording;
mod replay;
pub mod session_file;
mod work;

pub use error::RecorderError;
pub use listener::Listener;
pub use recording::cut_off::{CutOff, complete_in};
pub use recording::event::{Continuation, CopyTrouble, FileSummary, RecorderEvent};
pub use recording::recorder::Recorder;
pub use recording::ring::Ring;
pub use recording::settings::{Division, LEAST_LAST, RecorderSettings};
pub use replay::place::TakePlace;
pub use replay::player::Player;
pub use replay::report::{Guiding, Position, ReplayReport};
pub use replay::settings::{GuideSettings, ReplaySettings};
pub use replay::transport::{Order, RATES};
