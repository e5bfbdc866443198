//! The command `maulstick` and the mains of the rig's processes.
//!
//! | module | holds |
//! | --- | --- |
//! | [`cli`] | the command line |
//! | [`commands`] | its subcommands |
//! | [`beside`] | commands in programs beside this one |
//! | [`up`] | the supervisor |
//! | [`processes`] | the processes of a rig |
//! | [`page`] | pictures made of patches, pictures and words |
//! | [`plot`] | curves over two axes |
//! | [`destination`] | the display or file for colours: profile and gamut |
//! | [`viewing`] | options of light, observer and rule |
//! | [`swatch`] | colours in the terminal |
//! | [`backend`] | backend of the paint's steps |
//! | [`cells`] | side of a picture's cells |
//! | [`doctor`] | obstacles to good painting on this machine |
//! | [`document`] | paintings in files |
//! | [`easel`] | a painting for the steps of a script |
//! | [`duration`], [`ground`], [`tooth`] | times, grounds and teeth as a painter names them |
//! | [`kit`] | setup of a take: embedded into it, and extracted from it |
//! | [`lamp`] | changes of the light |
//! | [`memory`] | memory allocated by a command at once |
//! | [`picture`] | pictures read by a command |
//! | [`outputs`] | output files, none of which replaces an input |
//! | [`runtime`] | the tokio runtime of commands that wait for several events |
//! | [`script`] | a script: steps of painting, one after the other |
//! | [`paintings`] | the bundled paintings |
//! | [`panics`] | panics as readable errors |
//! | [`performance`] | setup that `render` and `up --play` share: take, brush, loads, canvas |
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
//! `up`, the recorder and `recording replay` wait on a tokio runtime for processes, signals, messages, orders and times
//! at once. Blocking work (checking or saving a painting, loads, the keys of a terminal, reading a recording ahead) is
//! on the runtime's blocking threads. The supervisor itself stays on the main thread: the kernel kills a node when the
//! thread that started it ends. Threads of this crate's own are:
//!
//! - `bridge`, and `viewer` for each viewer of `topic bridge`: sockets that block;
//! - one on which `doctor` tries a real-time priority, which the thread would keep.
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
pub mod doctor;
mod figures;
pub mod outputs;
pub mod paintings;
pub mod panics;
pub mod performance;
pub mod processes;
pub mod runtime;
pub mod script;
mod setup;
pub mod up;

pub use figures::{page, plot, swatch};
pub use setup::{
    backend, cells, destination, document, duration, easel, ground, kit, lamp, memory, picture,
    tooth, viewing,
};

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
