//! Commands in programs beside this one: those of `tools/`, which `./run` does not build, and others.
//!
//! As with cargo, `maulstick NAME …` runs the program `maulstick-NAME` in the same folder, with its own command line. A
//! program of `tools/` may have commands of several groups: each of its commands is listed in [`COMMANDS`], and so in
//! the help of its group.

use std::collections::BTreeSet;
use std::ffi::OsString;
use std::os::unix::process::CommandExt as _;
use std::path::PathBuf;
use std::process::Command;

use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{Arg, ArgMatches, CommandFactory as _, Parser, Subcommand, value_parser};
use maulstick_rig::UserError;
use maulstick_rig::files::{allow_overwriting, clear_on_signals};

use crate::{EXIT_INTERRUPTED, advice, finish, panics};

/// A command of a program in `tools/`.
#[derive(Debug)]
pub struct BesideCommand {
    /// Its group, if it has one, and its name.
    pub path: &'static [&'static str],
    /// Package, and program, that has it.
    pub package: &'static str,
    /// Help in one line.
    pub about: &'static str,
}

const fn command(
    package: &'static str,
    path: &'static [&'static str],
    about: &'static str,
) -> BesideCommand {
    BesideCommand {
        path,
        package,
        about,
    }
}

const BENCH: &str = "maulstick-bench";
const FIGURES: &str = "maulstick-figures";
const FIT: &str = "maulstick-fit";
const MOTIONS: &str = "maulstick-motions";
const RECOVER: &str = "maulstick-recover";

/// Commands of the programs in `tools/`; a test of each program compares its own with them.
pub const COMMANDS: [BesideCommand; 17] = [
    command(
        BENCH,
        &["bench"],
        "Run benchmarks against reference programs",
    ),
    command(
        FIGURES,
        &["brush", "sheet"],
        "Draw each brush and its marks",
    ),
    command(
        FIGURES,
        &["colour", "chart"],
        "Draw the mixing chart of all paints",
    ),
    command(
        FIGURES,
        &["colour", "compare"],
        "Mix one graded mixture in four ways, and compare their colours",
    ),
    command(
        FIGURES,
        &["demo", "effects"],
        "Paint a sheet of the effects of the paint model, with captions",
    ),
    command(
        FIGURES,
        &["demo", "fluid-force"],
        "Sweep a square through a fluid along an arc and write the force on it",
    ),
    command(
        FIT,
        &["colour", "fit"],
        "Fit paints to measured reflectances",
    ),
    command(MOTIONS, &["take", "strokes"], "List the strokes of a take"),
    command(
        MOTIONS,
        &["take", "cut"],
        "Cut a part out of a take, by times or by strokes",
    ),
    command(
        MOTIONS,
        &["take", "join"],
        "Join takes; the brush is lifted between them",
    ),
    command(
        MOTIONS,
        &["take", "scale"],
        "Scale a motion on the surface; pressures and heights above it stay",
    ),
    command(MOTIONS, &["take", "rotate"], "Turn a motion on the surface"),
    command(MOTIONS, &["take", "move"], "Move a motion on the surface"),
    command(
        MOTIONS,
        &["take", "retime"],
        "Make a motion faster or slower",
    ),
    command(MOTIONS, &["take", "mirror"], "Mirror a motion"),
    command(
        MOTIONS,
        &["take", "fill"],
        "Fill an outline with the strokes of an example",
    ),
    command(
        RECOVER,
        &["painting", "recover"],
        "Recover what is intact in a damaged painting",
    ),
];

/// Name of the argument that has the command line of a program.
const LINE: &str = "line";

impl BesideCommand {
    /// The command as typed.
    fn typed(&self) -> String {
        format!("maulstick {}", self.path.join(" "))
    }

    /// Instruction for building the program beside this one.
    fn how_to_build(&self) -> String {
        format!("cargo build --release -p {}", self.package)
    }

    /// Instruction for installing it beside an installed one.
    fn how_to_install(&self) -> String {
        let name = self.package.trim_start_matches("maulstick-");
        let parent = if self.package == BENCH {
            "tests"
        } else {
            "tools"
        };
        format!("cargo install --path {parent}/{name}")
    }

    /// Definition for help and completions, with any arguments.
    fn definition(&self) -> clap::Command {
        let name = self.path.last().copied().unwrap_or_default();
        let line = Arg::new(LINE)
            .num_args(0..)
            .allow_hyphen_values(true)
            .trailing_var_arg(true)
            .hide(true)
            .help("Command line of the program")
            .value_parser(value_parser!(OsString));
        let (typed, build) = (self.typed(), self.how_to_build());
        clap::Command::new(name)
            .about(self.about)
            .disable_help_flag(true)
            .arg(line)
            .after_help(format!("`{typed} --help`; `{build}` builds it"))
    }
}

/// A program with the commands of `tools/` in their groups.
#[must_use]
pub fn with_commands(program: clap::Command) -> clap::Command {
    COMMANDS
        .iter()
        .fold(program, |program, command| match command.path {
            [group, _] => {
                program.mut_subcommand(*group, |group| group.subcommand(command.definition()))
            }
            _ => program.subcommand(command.definition()),
        })
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
    let Some(command) = COMMANDS.iter().find(|command| command.path == path) else {
        return Ok(());
    };
    let line = innermost.get_many::<OsString>(LINE).into_iter().flatten();
    let overwrite = innermost.get_flag("overwrite").then_some("--overwrite");
    let error = Command::new(beside(command.package)?)
        .args(command.path)
        .args(overwrite)
        .args(line)
        .exec();
    let typed = command.typed();
    Err(if error.kind() == std::io::ErrorKind::NotFound {
        let (build, install) = (command.how_to_build(), command.how_to_install());
        UserError::failure(format!(
            "`{typed}` is a separate program, which is not built"
        ))
        .help(format!(
            "in the folder of the sources: {build}; where maulstick is installed: {install}"
        ))
    } else {
        UserError::failure(format!("`{typed}` cannot be started: {error}"))
    })
}

/// Runs another program for a command that is unknown here; otherwise exits with the error.
///
/// # Errors A [`UserError`] where the program cannot be started.
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

/// Command line of a program in `tools/`.
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
/// # Errors A [`UserError`] where signals cannot be watched.
pub fn clear_files_on_signals() -> Result<(), UserError> {
    clear_on_signals(EXIT_INTERRUPTED)
        .map_err(|error| UserError::failure(format!("cannot watch for signals: {error}")))
}

/// Commands of a program in `tools/` with their help, as it defines them.
#[must_use]
pub fn defined<C: Subcommand>() -> BTreeSet<String> {
    let (mut found, mut open) = (
        BTreeSet::new(),
        vec![(String::new(), ToolLine::<C>::command())],
    );
    while let Some((path, command)) = open.pop() {
        if !command.has_subcommands() {
            let about = command.get_about().map(ToString::to_string);
            found.insert(format!("{}: {}", path.trim(), about.unwrap_or_default()));
        }
        let below = command.get_subcommands().cloned();
        open.extend(below.map(|below| (format!("{path} {}", below.get_name()), below)));
    }
    found
}

/// The same, as [`COMMANDS`] lists them.
#[must_use]
pub fn listed(package: &str) -> BTreeSet<String> {
    let own = COMMANDS.iter().filter(|command| command.package == package);
    own.map(|command| format!("{}: {}", command.path.join(" "), command.about))
        .collect()
}
