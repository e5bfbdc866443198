//! Commands and options of the programs beside `maulstick`, apart from what they do: their mains read them, and help,
//! completions and manuals show them whether or not the programs are built.
//!
//! | module | program |
//! | --- | --- |
//! | [`bench`] | `maulstick-bench` |
//! | [`figures`] | `maulstick-figures` |
//! | [`fit`] | `maulstick-fit` |
//! | [`motions`] | `maulstick-motions` |
//! | [`recover`] | `maulstick-recover` |
//!
//! [`motion`] has the options of motions that `recording replay` has, too.

pub mod bench;
pub mod figures;
pub mod fit;
pub mod motion;
pub mod motions;
pub mod recover;

use clap::{Command, Subcommand};

/// A program beside `maulstick`.
#[derive(Clone, Copy, Debug)]
pub struct Program {
    /// Its package, which is its name.
    pub package: &'static str,
    /// Folder of its sources.
    pub folder: &'static str,
    /// Adds its commands, in their groups, to a command without any.
    define: fn(Command) -> Command,
}

impl Program {
    const fn new<C: Subcommand>(package: &'static str, folder: &'static str) -> Self {
        Self {
            package,
            folder,
            define: C::augment_subcommands,
        }
    }

    /// Its commands, in their groups.
    #[must_use]
    pub fn commands(&self) -> Vec<Command> {
        let all = (self.define)(Command::new("maulstick"));
        all.get_subcommands().cloned().collect()
    }
}

/// All programs.
pub const PROGRAMS: [Program; 5] = [
    Program::new::<bench::BenchGroup>("maulstick-bench", "tests/bench"),
    Program::new::<figures::Figures>("maulstick-figures", "tools/figures"),
    Program::new::<fit::FitGroup>("maulstick-fit", "tools/fit"),
    Program::new::<motions::MotionGroup>("maulstick-motions", "tools/motions"),
    Program::new::<recover::RecoverGroup>("maulstick-recover", "tools/recover"),
];
