//! `maulstick completions`: texts about the commands for shells, `man` and docs/commands.md, from their definitions.

mod markdown;

use std::path::{Path, PathBuf};

use clap::Subcommand;
use clap_complete::aot::{Shell, generate};
use maulstick_rig::UserError;

use super::{print_text, say};

pub(crate) use markdown::page;

/// Commands under a heading of the list of all commands.
pub(crate) type Headings = [(&'static str, &'static [&'static str])];

/// Commands of `maulstick completions`.
#[derive(Clone, Debug, Subcommand)]
pub enum CompletionsCommand {
    /// Print the completions for bash
    Bash,
    /// Print the completions for elvish
    Elvish,
    /// Print the completions for fish
    Fish,
    /// Print the completions for PowerShell
    Powershell,
    /// Print the completions for zsh
    Zsh,
    /// Write a manual page for each command
    Man {
        /// Folder to write to
        #[arg(long, value_name = "FOLDER")]
        folder: PathBuf,
    },
    /// Print docs/commands.md
    Markdown,
}

/// Writes the requested pages of a program whose commands have these headings.
///
/// # Errors
/// A [`UserError`] where the pages cannot be written.
pub(crate) fn run(
    wanted: &CompletionsCommand,
    program: clap::Command,
    headings: &Headings,
) -> Result<i32, UserError> {
    let shell = match wanted {
        CompletionsCommand::Bash => Shell::Bash,
        CompletionsCommand::Elvish => Shell::Elvish,
        CompletionsCommand::Fish => Shell::Fish,
        CompletionsCommand::Powershell => Shell::PowerShell,
        CompletionsCommand::Zsh => Shell::Zsh,
        CompletionsCommand::Man { folder } => return write_manual(program, folder),
        CompletionsCommand::Markdown => {
            print_text(&page(&program, headings))?;
            return Ok(0);
        }
    };
    print_text(&completions(program, shell))?;
    Ok(0)
}

fn completions(mut program: clap::Command, shell: Shell) -> String {
    let (name, mut script) = (program.get_name().to_owned(), Vec::new());
    generate(shell, &mut program, name, &mut script);
    String::from_utf8_lossy(&script).into_owned()
}

fn write_manual(program: clap::Command, folder: &Path) -> Result<i32, UserError> {
    std::fs::create_dir_all(folder)
        .and_then(|()| clap_mangen::generate_to(program, folder))
        .map_err(|error| UserError::writing(folder, &error))?;
    let first = folder.join("maulstick.1");
    say!("{}: `man -l` shows it and those beside it", first.display());
    Ok(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn program() -> clap::Command {
        let dry = clap::Command::new("dry").about("Dry the paint");
        let dry = dry.arg(clap::Arg::new("share").long("share").help("Share"));
        let layer = clap::Command::new("layer").about("Change layers");
        clap::Command::new("maulstick").subcommand(layer.subcommand(dry))
    }

    #[test]
    fn completions_of_each_shell_know_the_commands() {
        for shell in [
            Shell::Bash,
            Shell::Elvish,
            Shell::Fish,
            Shell::PowerShell,
            Shell::Zsh,
        ] {
            let script = completions(program(), shell);
            assert!(
                ["layer", "dry", "share"]
                    .iter()
                    .all(|word| script.contains(word)),
                "{script}"
            );
        }
    }

    #[test]
    fn each_command_has_a_manual_page() {
        let folder = tempfile::tempdir().expect("a folder");
        write_manual(program(), &folder.path().join("man1")).expect("written");
        for page in ["maulstick.1", "maulstick-layer.1", "maulstick-layer-dry.1"] {
            assert!(folder.path().join("man1").join(page).exists(), "{page}");
        }
    }
}
