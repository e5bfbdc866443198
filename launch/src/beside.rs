//! Commands in programs beside this one: those of `tools/` and `tests/bench`, which `./run` does not build, and others.
//!
//! As with cargo, `maulstick NAME …` runs the program `maulstick-NAME` that lies beside this one, with its own command line.
//! A program of `tools/` may have commands of several groups, which [`PROGRAMS`] defines.

use std::os::unix::process::CommandExt as _;
use std::path::PathBuf;
use std::process::Command;

use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{ArgMatches, Parser, Subcommand};
use maulstick_rig::UserError;
use maulstick_rig::files::{allow_overwriting, clear_on_signals};
use maulstick_tool_options::{PROGRAMS, Program};

use crate::{EXIT_INTERRUPTED, advice, finish, panics};

/// A program with the commands of [`PROGRAMS`] in their groups.
#[must_use]
pub fn with_commands(program: clap::Command) -> clap::Command {
    let commands = PROGRAMS.iter().flat_map(Program::commands);
    commands.fold(program, |program, command| {
        if program.find_subcommand(command.get_name()).is_none() {
            return program.subcommand(command);
        }
        let own = command.get_subcommands().cloned();
        program.mut_subcommand(command.get_name(), |group| group.subcommands(own))
    })
}

/// Whether a program has a command.
fn has_command(program: &Program, path: &[&str]) -> bool {
    let commands = program.commands();
    let mut found = commands
        .iter()
        .find(|one| path.first() == Some(&one.get_name()));
    for name in path.iter().skip(1) {
        found = found.and_then(|group| group.find_subcommand(name));
    }
    found.is_some_and(|command| !command.has_subcommands())
}

/// Runs the program whose command was given; returns where the command is one of this program.
///
/// # Errors
/// A [`UserError`] where the program cannot be started.
pub fn run_given(matches: &ArgMatches) -> Result<(), UserError> {
    let (mut path, mut innermost) = (Vec::new(), matches);
    while let Some((name, below)) = innermost.subcommand() {
        path.push(name);
        innermost = below;
    }
    let mut programs = PROGRAMS.iter();
    let Some(program) = programs.find(|program| has_command(program, &path)) else {
        return Ok(());
    };
    let line = std::env::args_os().skip(1);
    let error = Command::new(beside(program.package)?).args(line).exec();
    let typed = format!("maulstick {}", path.join(" "));
    Err(if error.kind() == std::io::ErrorKind::NotFound {
        let Program {
            package, folder, ..
        } = program;
        UserError::failure(format!(
            "`{typed}` is a separate program, which is not built"
        ))
        .help(format!(
            "in the folder of the sources: cargo build --release -p {package}; \
             where maulstick is installed: cargo install --path {folder}"
        ))
    } else {
        UserError::failure(format!("`{typed}` cannot be started: {error}"))
    })
}

/// Runs another program for a command that is unknown here; otherwise exits with the error.
///
/// # Errors
/// A [`UserError`] where the program cannot be started.
pub fn run_unknown(error: &clap::Error) -> Result<i32, UserError> {
    let mut line = std::env::args_os().skip(1);
    if let (ErrorKind::InvalidSubcommand, Some(ContextValue::String(name)), Some(first)) = (
        error.kind(),
        error.get(ContextKind::InvalidSubcommand),
        line.next(),
    ) && first == *name.as_str()
        && !name.contains('/')
    {
        let program = beside(&format!("maulstick-{name}"))?;
        if program.is_file() {
            let error = Command::new(&program).arg(name).args(line).exec();
            let what = format!("`maulstick {name}` cannot be started: {error}");
            return Err(UserError::failure(what).at(program.display().to_string()));
        }
    }
    error.exit()
}

/// The program of this name beside this one.
fn beside(name: &str) -> Result<PathBuf, UserError> {
    let own = std::env::current_exe().map_err(|error| UserError::failure(error.to_string()))?;
    Ok(own.with_file_name(name))
}

/// Commands of maulstick in a program of their own
#[derive(Parser, Debug)]
#[command(
    name = "maulstick",
    bin_name = "maulstick",
    version,
    max_term_width = 100
)]
struct ToolLine<C: Subcommand> {
    #[command(subcommand)]
    command: C,
    /// Overwrite an existing file that is not a painting
    #[arg(long, global = true)]
    overwrite: bool,
}

/// Main of a program in `tools/`: reads its command line, and ends the process as `carry_out` says.
pub fn tool<C: Subcommand>(carry_out: impl FnOnce(&C) -> Result<i32, UserError>) -> ! {
    panics::tell();
    let line = ToolLine::<C>::parse();
    if line.overwrite {
        allow_overwriting();
    }
    let done = clear_files_on_signals().and_then(|()| carry_out(&line.command));
    finish(done.map_err(|fault| fault.worded(advice::words)))
}

/// Removes unfinished files when a signal ends this process.
///
/// # Errors
/// A [`UserError`] where signals cannot be watched.
pub fn clear_files_on_signals() -> Result<(), UserError> {
    clear_on_signals(EXIT_INTERRUPTED)
        .map_err(|error| UserError::failure(format!("cannot watch for signals: {error}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_command_is_found_in_the_program_that_has_it_and_no_group_is() {
        let having = |path: &[&str]| -> Vec<&str> {
            let programs = PROGRAMS.iter();
            let having = programs.filter(|program| has_command(program, path));
            having.map(|program| program.package).collect()
        };
        assert_eq!(having(&["take", "cut"]), ["maulstick-motions"]);
        assert_eq!(having(&["colour", "fit"]), ["maulstick-fit"]);
        assert_eq!(having(&["bench"]), ["maulstick-bench"]);
        for path in [&["take"][..], &["take", "render"], &["cut"], &[]] {
            assert!(having(path).is_empty(), "{path:?}");
        }
    }
}
