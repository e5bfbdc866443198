//! Errors of a set-up, and their words for a user.

use std::path::PathBuf;

use maulstick_bus::BusError;
use maulstick_rig::UserError;
use maulstick_rig::user_devices::ALLOW_BY_HAND;
use maulstick_types::nearest::choice;

use crate::attached::RULE;

/// Reason why devices could not be set up as asked.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SetupError {
    /// The rig runs, and cannot be joined.
    #[error("the rig runs, but cannot be joined: {0}")]
    Connect(BusError),
    /// An error of a file, a device or the rig.
    #[error("{}", .0.what)]
    Fault(#[from] UserError),
    /// No attached device can be chosen.
    #[error(transparent)]
    Choice(#[from] ChoiceError),
    /// There is no device of a name, and these are the names that there are.
    #[error("there is no device called '{name}'")]
    NoDevice {
        /// The name.
        name: String,
        /// Names of the devices that there are.
        known: Vec<String>,
    },
    /// The user has a device of this name.
    #[error("you have a device called '{name}' already")]
    Taken {
        /// The name.
        name: String,
        /// The file of the user's devices.
        file: PathBuf,
    },
    /// The rig has a device of this name.
    #[error("the rig has a device called '{0}' already")]
    TakenInRig(String),
    /// The rig's device of this name is not the user's.
    #[error("the rig has another device called '{0}'")]
    Other(String),
    /// The device is one of the rig's own settings.
    #[error("'{device}' is a device of the rig's own settings")]
    OfTheRig {
        /// The device.
        device: String,
        /// The task that it was meant for.
        task: Task,
    },
    /// The devices of a file are not written as sections.
    #[error("the devices are not sections [[device]]")]
    NoSections(PathBuf),
    /// Settings without a device of this name.
    #[error("there is no [[device]] called '{name}'")]
    NoSection {
        /// The name.
        name: String,
        /// Names that they have.
        known: Vec<String>,
        /// The file.
        file: PathBuf,
    },
    /// The device moves the canvas.
    #[error("'{device}' moves the canvas itself: there is nothing to fit")]
    MovesCanvas {
        /// The device.
        device: String,
        /// The file of its settings.
        file: PathBuf,
    },
    /// The places that were touched are no corners of the canvas.
    #[error("the three places are no corners of the canvas; nothing is written")]
    NoCorners,
    /// The rule of udev was not installed.
    #[error(transparent)]
    Rule(#[from] RuleError),
    /// A change failed, and so did taking it back.
    #[error("{what}; the rig cannot be set back for '{device}': {why}")]
    NotTakenBack {
        /// The device.
        device: String,
        /// Failure of the change.
        what: Box<Self>,
        /// Failure of taking it back.
        why: Box<Self>,
    },
}

/// Task that a device is meant for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Task {
    /// Another name for it.
    Rename,
    /// Its fit to the canvas.
    Fit,
}

/// Reason why no attached device can be chosen.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ChoiceError {
    /// All of them are the user's.
    #[error("what is attached is yours already")]
    Yours,
    /// None is attached.
    #[error("no device is attached that a driver fits")]
    Nothing,
    /// Address and name of each.
    #[error("several devices are attached: {}", .0.join(", "))]
    Several(Vec<String>),
}

/// Reason why the rule of udev was not installed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RuleError {
    /// The program that asks for the password is missing.
    #[error("pkexec is not installed")]
    NoPkexec,
    /// The password was not given.
    #[error("it was not allowed")]
    Denied,
    /// The shell failed.
    #[error("the rule could not be installed")]
    NotInstalled,
    /// No program could be started.
    #[error("{0}")]
    Spawn(String),
}

impl From<SetupError> for UserError {
    fn from(error: SetupError) -> Self {
        let what = error.to_string();
        let usage = Self::usage(what.clone());
        match error {
            SetupError::Connect(error) => Self { what, ..error.into() },
            SetupError::Fault(fault) => fault,
            SetupError::Choice(choice) => usage.help(match choice {
                ChoiceError::Yours => "`maulstick device use` has it paint",
                ChoiceError::Nothing => {
                    "`maulstick device list` shows what is; `--driver` names one that shows nowhere, as `openhaptics`, `forcedimension`, `openxr` or `inverse3`"
                }
                ChoiceError::Several(_) => "say which: --address",
            }),
            SetupError::NoDevice { known, .. } if known.is_empty() => usage.help(
                "`maulstick device list` shows what is attached, `maulstick device add` adds it",
            ),
            SetupError::NoDevice { name, known } => usage.help(nearest(&name, &known)),
            SetupError::NoSection { name, known, file } => usage
                .at(file.display().to_string())
                .help(nearest(&name, &known)),
            SetupError::Taken { file, .. } => usage.at(file.display().to_string()).help(
                "give this one another name, or remove that one: `maulstick device remove`",
            ),
            SetupError::TakenInRig(_) => usage.help("give this one another name"),
            SetupError::Other(_) => {
                usage.help("give yours another name: `maulstick device rename`")
            }
            SetupError::OfTheRig { device, task } => usage.help(match task {
                Task::Rename => "change its name in the rig.toml that the rig was started with, and start it again".to_owned(),
                Task::Fit => format!("name the file that the rig was started with: `maulstick device fit {device} --rig rig.toml`"),
            }),
            SetupError::NoSections(file) => usage
                .at(file.display().to_string())
                .help("write each as a section of its own"),
            SetupError::MovesCanvas { file, .. } => usage.at(file.display().to_string()),
            SetupError::NoCorners => Self::failure(what).help(
                "its width by height has to fit within 10 %, and its corner to be a right one; begin again",
            ),
            SetupError::Rule(_) => Self::failure(what).at(RULE).help(ALLOW_BY_HAND),
            SetupError::NotTakenBack { device, .. } => Self::failure(what).help(format!(
                "`maulstick device list` shows whether the rig has it: `maulstick device use {device}` puts it there, \
                 `maulstick device remove {device}` takes it out"
            )),
        }
    }
}

fn nearest(name: &str, known: &[String]) -> String {
    choice(name, known.iter().map(String::as_str))
}
