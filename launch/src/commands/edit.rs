//! Edits as commands: `maulstick brush load`, `layer dry`, `painting undo` …, each parsed into the edit itself.

use std::fmt::Debug;
use std::marker::PhantomData;

use clap::error::ErrorKind;
use clap::{Args as _, FromArgMatches, Subcommand};
use maulstick_painting::edits::{CommandForm, Ground, GroundSource, commands};
use maulstick_rig::UserError;
use maulstick_types::Edit;

use crate::commands::client::{Client, Target};
use crate::commands::say;
use crate::ground::GroundFile;

/// Edits of the daily commands, which stand beside the groups as well.
pub const DAILY: [&str; 2] = ["load", "undo"];

/// A list of commands that has edits among them.
pub trait EditGroup: Clone + Debug {
    /// True for an edit of the list.
    fn has(form: &CommandForm) -> bool;
}

macro_rules! groups {
    ($($(#[doc = $doc:literal])+ $group:ident, |$form:ident| $has:expr;)*) => { $(
        $(#[doc = $doc])+
        #[derive(Clone, Debug)]
        pub struct $group;

        impl EditGroup for $group {
            fn has($form: &CommandForm) -> bool {
                $has
            }
        }
    )* };
}

groups! {
    /// `maulstick brush`.
    BrushEdits, |form| form.group == "brush";
    /// `maulstick canvas`.
    CanvasEdits, |form| form.group == "canvas";
    /// `maulstick layer`.
    LayerEdits, |form| form.group == "layer";
    /// `maulstick painting`.
    PaintingEdits, |form| form.group == "painting";
    /// `maulstick palette`.
    PaletteEdits, |form| form.group == "palette";
    /// Beside the groups.
    DailyEdits, |form| DAILY.contains(&form.name);
}

/// The edits of a list.
fn forms<G: EditGroup>() -> impl Iterator<Item = CommandForm> {
    commands().into_iter().filter(G::has)
}

/// An edit of the painting of a running rig.
#[derive(Clone, Debug)]
pub struct EditsOf<G> {
    /// The edit.
    pub edit: Edit,
    target: Target,
    group: PhantomData<G>,
}

/// Its command, with the help of the edit and the options that say which rig.
fn command(form: &CommandForm) -> clap::Command {
    let own = (form.augment)(clap::Command::new(form.name));
    let (about, long) = (own.get_about().cloned(), own.get_long_about().cloned());
    let both = Target::augment_args(own);
    let both = both.about(about.clone().unwrap_or_default());
    both.long_about(long.or(about).unwrap_or_default())
}

impl<G: EditGroup> Subcommand for EditsOf<G> {
    fn augment_subcommands(cli: clap::Command) -> clap::Command {
        cli.subcommands(forms::<G>().map(|form| command(&form)))
    }

    fn augment_subcommands_for_update(cli: clap::Command) -> clap::Command {
        Self::augment_subcommands(cli)
    }

    fn has_subcommand(name: &str) -> bool {
        forms::<G>().any(|form| form.name == name)
    }
}

impl<G: EditGroup> FromArgMatches for EditsOf<G> {
    fn from_arg_matches(matches: &clap::ArgMatches) -> Result<Self, clap::Error> {
        let missing = || clap::Error::new(ErrorKind::MissingSubcommand);
        let (name, options) = matches.subcommand().ok_or_else(missing)?;
        let form = forms::<G>().find(|form| form.name == name);
        Ok(Self {
            edit: (form.ok_or_else(missing)?.read)(options)?,
            target: Target::from_arg_matches(options)?,
            group: PhantomData,
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
pub fn run<G>(command: &EditsOf<G>) -> Result<i32, UserError> {
    send(&command.target, command.edit.clone())
}

/// Sends an edit, with the file that it names, and says what it has done.
///
/// # Errors
/// As [`run`], and for a file that cannot be read.
fn send(target: &Target, mut edit: Edit) -> Result<i32, UserError> {
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
