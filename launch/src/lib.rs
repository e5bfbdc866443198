//! The command `maulstick` and the mains of the rig's processes.
//!
//! | module | holds |
//! | --- | --- |
//! | [`cli`] | the command line |
//! | [`commands`] | what its subcommands do |
//! | [`up`] | the supervisor |
//! | [`nodes`] | the mains of the nodes |
//! | [`sheet`] | the sheet of brushes and their marks |
//! | [`performance`] | what `render` and `up --play` share: take, brush, loads, canvas |

pub mod cli;
pub mod commands;
pub mod nodes;
pub mod performance;
pub mod sheet;
pub mod up;

use maulstick_rig::Fault;

/// Exit code after Ctrl-C.
pub const EXIT_INTERRUPTED: i32 = 130;

/// Ends the process: with a fault as the user sees it, or with a code.
pub fn finish(result: Result<i32, Fault>) -> ! {
    match result {
        Ok(code) => std::process::exit(code),
        Err(fault) => {
            eprintln!("{fault}");
            std::process::exit(fault.code);
        }
    }
}
