//! Edits as commands of their own: `maulstick load`, `dry`, `undo` …, each parsed into the edit itself.

use clap::error::ErrorKind;
use clap::{Args as _, FromArgMatches, Subcommand};
use maulstick_rig::UserError;
use maulstick_types::edits::{CommandForm, Edit, Ground, GroundSource, commands};

use crate::commands::client::{Client, Target};
use crate::commands::say;
use crate::ground::GroundFile;

/// An edit of the painting of a running rig.
#[derive(Clone, Debug)]
pub struct EditCommand {
    /// The edit.
    pub edit: Edit,
    target: Target,
}

/// Its command, with the help of the edit and the options that say which rig.
fn command(form: &CommandForm) -> clap::Command {
    let own = (form.augment)(clap::Command::new(form.name));
    let (about, long) = (own.get_about().cloned(), own.get_long_about().cloned());
    let both = Target::augment_args(own);
    let both = both.about(about.clone().unwrap_or_default());
    both.long_about(long.or(about).unwrap_or_default())
}

impl Subcommand for EditCommand {
    fn augment_subcommands(cli: clap::Command) -> clap::Command {
        cli.subcommands(commands().iter().map(command))
    }

    fn augment_subcommands_for_update(cli: clap::Command) -> clap::Command {
        Self::augment_subcommands(cli)
    }

    fn has_subcommand(name: &str) -> bool {
        commands().iter().any(|form| form.name == name)
    }
}

impl FromArgMatches for EditCommand {
    fn from_arg_matches(matches: &clap::ArgMatches) -> Result<Self, clap::Error> {
        let missing = || clap::Error::new(ErrorKind::MissingSubcommand);
        let (name, options) = matches.subcommand().ok_or_else(missing)?;
        let forms = commands();
        let form = forms.iter().find(|form| form.name == name);
        let form = form.ok_or_else(missing)?;
        Ok(Self {
            edit: (form.read)(options)?,
            target: Target::from_arg_matches(options)?,
        })
    }

    fn update_from_arg_matches(&mut self, matches: &clap::ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

/// Applies an edit to the painting of a running rig.
///
/// # Errors
/// A [`UserError`] with the refusal of the painting, or where no rig runs.
pub fn run(command: &EditCommand) -> Result<i32, UserError> {
    send(&command.target, command.edit.clone())
}

/// Sends an edit, with the file that it names, and says what it has done.
///
/// # Errors
/// As [`run`], and for a file that cannot be read.
pub(super) fn send(target: &Target, mut edit: Edit) -> Result<i32, UserError> {
    edit.check_idle()?;
    if let Edit::Ground(ground) = &mut edit {
        read_ground(ground)?;
    }
    let said = word(&edit);
    let done = Client::command(target, edit)?;
    if let Some(said) = said {
        say!("{said}{done}");
    }
    Ok(0)
}

/// What a reply is introduced with; `None` for an edit that is done without a word.
fn word(edit: &Edit) -> Option<&'static str> {
    match edit {
        Edit::Dry(dry) if dry.over.is_some() => Some("dries "),
        Edit::Dry(_) => Some("dried: "),
        Edit::StopDrying(_) => Some("the drying is ended"),
        Edit::Wet(_) => Some("wet again: "),
        Edit::Convert(_) => Some("converted: "),
        Edit::Undo(_) => Some("undone: "),
        Edit::Redo(_) => Some("redone: "),
        Edit::LoadFrom(_) => Some("loaded: "),
        _ => None,
    }
}

/// Puts the spectrum of a file in the place of its path.
fn read_ground(edit: &mut Ground) -> Result<(), UserError> {
    let GroundSource::Named { name } = &edit.ground else {
        return Ok(());
    };
    *edit = match GroundFile::read(name)? {
        GroundFile::Named(name) => Ground::named(edit.surface, &name)?,
        GroundFile::Spectrum(csv) => Ground::spectrum(edit.surface, &csv)?,
        GroundFile::Picture(_, name) => {
            return Err(UserError::usage("a running rig takes no picture as ground")
                .at(name)
                .help(
                    "close it: `maulstick painting import FILE PICTURE --as ground`; or begin with it: \
                     `maulstick up --ground PICTURE`",
                ));
        }
    };
    Ok(())
}
