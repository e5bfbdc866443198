//! The command `maulstick` and the mains of the rig's processes.
//!
//! | module | holds |
//! | --- | --- |
//! | [`cli`] | the command line |
//! | [`commands`] | what its subcommands do |
//! | [`up`] | the supervisor |
//! | [`processes`] | the processes of a rig |
//! | [`page`] | pictures made of patches, pictures and words |
//! | [`plot`] | curves over two axes |
//! | [`destination`] | the display or file that colours go to: profile and gamut |
//! | [`viewing`] | options of light, observer and rule |
//! | [`swatch`] | colours in the terminal |
//! | [`chart`] | the mixing chart, and one mixture by four ways of mixing |
//! | [`sheet`] | the sheet of brushes and their marks |
//! | [`attached`] | attached devices, as the system lists them |
//! | [`backend`] | backend of the paint's steps |
//! | [`cells`] | the side of the cells that pictures are painted with |
//! | [`doctor`] | what of this machine keeps a rig from painting well |
//! | [`document`] | paintings in files |
//! | [`easel`] | a painting at which a script is followed |
//! | [`duration`], [`ground`], [`tooth`] | times, grounds and teeth as a painter names them |
//! | [`kit`] | setup of a take: embedded into it, and extracted from it |
//! | [`lamp`] | changes of the light |
//! | [`memory`] | memory that a command allocates at once |
//! | [`picture`] | pictures that a command reads |
//! | [`outputs`] | files that are written; none replaces one that is read |
//! | [`script`] | a day at the easel, a step after the other |
//! | [`paintings`] | the bundled paintings |
//! | [`panics`] | panics as errors that a user can read |
//! | [`performance`] | setup that `render` and `up --play` share: take, brush, loads, canvas |

pub mod advice;
pub mod attached;
pub mod chart;
pub mod cli;
pub mod commands;
pub mod doctor;
mod figures;
pub mod outputs;
pub mod paintings;
pub mod panics;
pub mod performance;
pub mod processes;
pub mod script;
mod setup;
pub mod sheet;
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
