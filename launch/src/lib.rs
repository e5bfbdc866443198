//! The command `maulstick` and the mains of the rig's processes.
//!
//! | module | holds |
//! | --- | --- |
//! | [`cli`] | the command line |
//! | [`commands`] | its subcommands |
//! | [`beside`] | commands in programs beside this one |
//! | `advice` | what to do about a fault, in commands |
//! | [`up`] | the supervisor |
//! | [`processes`] | the processes of a rig |
//! | [`page`] | pictures made of patches, pictures and words |
//! | [`plot`] | curves over two axes |
//! | [`swatch`] | colours in the terminal |
//! | [`runtime`] | the tokio runtime of commands that wait for many things at once |
//! | [`panics`] | panics as errors that a user can read |
//!
//! # The rig
//!
//! - One program runs as every process. The launcher starts, watches and ends them, and restarts what fails. A frozen
//!   brush or paint is ended after 4.5 s; one that works or waits for a disk has longer; the launcher's clocks stop
//!   while it is itself stopped. A start that the system refuses is retried after growing pauses.
//! - When paint, brush or player of a take dies, all three restart and the take is played from its start, as fast as
//!   possible up to its earlier position.
//! - Devices can be added and removed in a running rig: the launcher checks the settings with the change, writes them
//!   and starts or ends one daemon. Renaming does both, and keeps the force's state. Brush nodes read priorities and
//!   laws of force when the file changes.
//! - Another painting is checked on another thread; the paint node then ends and starts with other settings, which
//!   counts as no crash. Another file of the same painting needs no new node.
//! - A rig with a window and no file begins a sketch in the user's state folder, a document like any other. The newest
//!   32 within 4 GiB stay; others are removed at a start, after the window has named them. Without a window, or with a
//!   take, a painting is in memory.
//!
//! # Tasks and threads
//!
//! `up`, the recorder and `recording replay` wait on a tokio runtime for processes, signals, messages, orders and times at
//! once. What blocks (a painting that is checked or saved, loads, the keys of a terminal, a recording that is read ahead)
//! is on the runtime's threads for that. The supervisor itself stays on the main thread: the kernel kills a node when the
//! thread that started it ends.
//!
//! # Recordings
//!
//! - `maulstick-recorder` records and replays; with `[record]` a recorder runs in every rig and ends last.
//! - `take from` makes a take of a session, or of a painting's own record: a copy of the painting taken back to its
//!   beginning.
//! - `recording replay --rate max` sends as the brushes have credit; with `--at` it puts a motion down live under the name
//!   `motion`, so it is undone like any stroke.
//! - `topic bridge` serves JSON of watched topics only. `topic graph` reads zenoh's administration space.

pub mod advice;
pub mod beside;
pub mod cli;
pub mod commands;
mod figures;
pub mod panics;
pub mod processes;
pub mod runtime;
pub mod up;

pub use figures::{page, plot, swatch};

use maulstick_rig::UserError;
use maulstick_rig::log::{flush, say};

/// Exit code after Ctrl-C.
pub const EXIT_INTERRUPTED: i32 = 130;

/// Ends the process: with a fault as the user sees it, or with a code.
pub fn finish(result: Result<i32, UserError>) -> ! {
    let code = match result {
        Ok(code) => code,
        Err(fault) => {
            say(&format!("{fault}\n"));
            fault.code
        }
    };
    flush();
    std::process::exit(code)
}
