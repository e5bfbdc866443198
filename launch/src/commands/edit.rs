//! Edits as commands: `maulstick brush load`, `layer dry`, `painting undo` …, each parsed into the edit itself.

use clap::error::ErrorKind;
use clap::{Args as _, FromArgMatches, Subcommand};
use maulstick_painting::edits::{self, CommandForm, common};
use maulstick_rig::UserError;
use maulstick_types::Edit;

use maulstick_painting_setup::surface::ground::GroundFile;

use crate::commands::client::{Client, Target};
use crate::commands::say;

/// Commands that stand beside the groups as well, each with its group.
pub const DAILY: [(&str, &str); 4] = [
    ("load", "brush"),
    ("undo", "painting"),
    ("snapshot", "painting"),
    ("render", "take"),
];

/// Groups of commands that have edits, in the order of their places in [`EditCommand`].
const GROUPS: [&str; 5] = ["brush", "canvas", "layer", "painting", "palette"];
const BRUSH: usize = 0;
const CANVAS: usize = 1;
const LAYER: usize = 2;
const PAINTING: usize = 3;
const PALETTE: usize = 4;
/// Place behind the groups, of the edits in [`DAILY`].
const BESIDE: usize = GROUPS.len();

/// An edit of `maulstick brush`.
pub type BrushEdit = EditCommand<BRUSH>;
/// An edit of `maulstick canvas`.
pub type CanvasEdit = EditCommand<CANVAS>;
/// An edit of `maulstick layer`.
pub type LayerEdit = EditCommand<LAYER>;
/// An edit of `maulstick painting`.
pub type PaintingEdit = EditCommand<PAINTING>;
/// An edit of `maulstick palette`.
pub type PaletteEdit = EditCommand<PALETTE>;
/// A daily edit, beside the groups.
pub type DailyEdit = EditCommand<BESIDE>;

/// An edit of the painting of a running rig, among the commands of its group, or beside the groups if it is daily.
#[derive(Clone, Debug)]
pub struct EditCommand<const GROUP: usize> {
    /// The edit.
    pub edit: Edit,
    target: Target,
}

/// The commands of the edits of a group; another group may have a command of the same name.
fn forms(group: usize) -> impl Iterator<Item = CommandForm> {
    let all = edits::entries().iter().filter_map(|entry| entry.command);
    all.filter(move |form| match GROUPS.get(group) {
        Some(name) => form.group == *name,
        None => DAILY.contains(&(form.name, form.group)),
    })
}

/// Its command, with the help of the edit and the options that select the rig.
fn command(form: &CommandForm) -> clap::Command {
    let own = (form.augment)(clap::Command::new(form.name));
    let (about, long) = (own.get_about().cloned(), own.get_long_about().cloned());
    let both = Target::augment_args(own);
    let both = both.about(about.clone().unwrap_or_default());
    both.long_about(long.or(about).unwrap_or_default())
}

impl<const GROUP: usize> Subcommand for EditCommand<GROUP> {
    fn augment_subcommands(parent: clap::Command) -> clap::Command {
        parent.subcommands(forms(GROUP).map(|form| command(&form)))
    }

    fn augment_subcommands_for_update(parent: clap::Command) -> clap::Command {
        Self::augment_subcommands(parent)
    }

    fn has_subcommand(name: &str) -> bool {
        forms(GROUP).any(|form| form.name == name)
    }
}

impl<const GROUP: usize> FromArgMatches for EditCommand<GROUP> {
    fn from_arg_matches(matches: &clap::ArgMatches) -> Result<Self, clap::Error> {
        let missing = || clap::Error::new(ErrorKind::MissingSubcommand);
        let (name, options) = matches.subcommand().ok_or_else(missing)?;
        let form = forms(GROUP).find(|form| form.name == name);
        Ok(Self {
            edit: (form.ok_or_else(missing)?.read)(options)?,
            target: Target::from_arg_matches(options)?,
        })
    }

    fn update_from_arg_matches(&mut self, matches: &clap::ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

/// Applies an edit to the painting of a running rig, with its file, and prints the result.
///
/// # Errors
/// A [`UserError`] with the refusal of the painting, where no rig runs, and for a file that cannot be read.
pub fn run<const GROUP: usize>(command: &EditCommand<GROUP>) -> Result<i32, UserError> {
    let mut edit = command.edit.clone();
    let known = edits::read(&edit)?;
    known.check_idle()?;
    if let Some(name) = common::ground_name(&edit) {
        edit = with_ground(&name)?;
    }
    let done = Client::command(&command.target, edit)?;
    if let Some(said) = known.reply() {
        say!("{said}{done}");
    }
    Ok(0)
}

/// The edit with the ground of this name, or of a file's reflectances.
fn with_ground(name: &str) -> Result<Edit, UserError> {
    let edit = GroundFile::read(name)?.edit()?;
    edit.ok_or_else(|| {
        UserError::usage("a running rig takes no picture as ground")
            .at(name)
            .help(
                "close it: `maulstick painting import FILE PICTURE --as ground`; or begin with it: \
                 `maulstick up --ground PICTURE`",
            )
    })
}
