//! An error as the user sees it.

use std::fmt;

use maulstick_bus::BusError;
use maulstick_types::EditFault;
use maulstick_types::command::advice::Advice;
use maulstick_types::plain;
use maulstick_types::scene::LightError;
use maulstick_types::values::ValueError;

/// Exit code for bad usage and bad input files.
pub const EXIT_USAGE: i32 = 2;
/// Exit code for failures.
pub const EXIT_FAILURE: i32 = 1;

/// An error with its place and advice.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UserError {
    /// The error.
    pub what: String,
    /// A file with its line, or a topic.
    pub place: Option<String>,
    /// Advice, in words that hold everywhere.
    pub help: Option<String>,
    /// Advice for which front ends have their own words.
    pub advice: Option<Advice>,
    /// [`EXIT_USAGE`] or [`EXIT_FAILURE`].
    pub code: i32,
}

impl UserError {
    /// Bad usage or a bad input file.
    #[must_use]
    pub fn usage(what: impl Into<String>) -> Self {
        Self {
            what: what.into(),
            place: None,
            help: None,
            advice: None,
            code: EXIT_USAGE,
        }
    }

    /// A failure.
    #[must_use]
    pub fn failure(what: impl Into<String>) -> Self {
        Self {
            what: what.into(),
            place: None,
            help: None,
            advice: None,
            code: EXIT_FAILURE,
        }
    }

    /// Adds the place.
    #[must_use]
    pub fn at(mut self, place: impl Into<String>) -> Self {
        self.place = Some(place.into());
        self
    }

    /// Adds advice.
    #[must_use]
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self.advice = None;
        self
    }

    /// Says what to do, by an advice that front ends have their own words for.
    #[must_use]
    pub fn advise(self, advice: Advice) -> Self {
        Self {
            advice: Some(advice.clone()),
            ..self.help(advice.to_string())
        }
    }

    /// The same in the words of a front end, where it has its own.
    #[must_use]
    pub fn worded(self, words: impl Fn(&Advice) -> Option<String>) -> Self {
        match self.advice.as_ref().and_then(words) {
            Some(help) => self.help(help),
            None => self,
        }
    }

    /// An input file that cannot be read.
    #[must_use]
    pub fn reading(path: &std::path::Path, error: &std::io::Error) -> Self {
        Self::usage(format!("cannot read the file: {error}")).on_disk(path, error, "check the path")
    }

    /// A file that cannot be written.
    #[must_use]
    pub fn writing(path: &std::path::Path, error: &std::io::Error) -> Self {
        if error.kind() == std::io::ErrorKind::InvalidFilename {
            return Self::usage(error.to_string())
                .at(path.display().to_string())
                .help("give it a name of its own kind");
        }
        Self::failure(format!("cannot write the file: {error}")).on_disk(
            path,
            error,
            "the folder must exist",
        )
    }

    fn on_disk(self, path: &std::path::Path, error: &std::io::Error, not_found: &str) -> Self {
        let help = match error.kind() {
            std::io::ErrorKind::NotFound => not_found,
            std::io::ErrorKind::PermissionDenied => "check the permissions",
            std::io::ErrorKind::StorageFull => "free some space",
            std::io::ErrorKind::AlreadyExists => "give another name",
            std::io::ErrorKind::IsADirectory => "this is a folder: name a file",
            std::io::ErrorKind::InvalidData => "not a UTF-8 text file; check the path",
            _ => "check the path and the disk",
        };
        self.at(path.display().to_string()).help(help)
    }

    /// A name that is not among `names`: the nearest is proposed.
    #[must_use]
    pub fn unknown<'a>(
        what: impl Into<String>,
        name: &str,
        names: impl IntoIterator<Item = &'a str>,
    ) -> Self {
        Self::usage(what).help(maulstick_types::nearest::choice(name, names))
    }
}

impl fmt::Display for UserError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "error: {}", plain(&self.what))?;
        if let Some(place) = &self.place {
            write!(f, "\n  --> {}", plain(place))?;
        }
        if let Some(help) = &self.help {
            write!(f, "\n help: {}", plain(help))?;
        }
        Ok(())
    }
}

impl std::error::Error for UserError {}

impl From<EditFault> for UserError {
    fn from(fault: EditFault) -> Self {
        Self::usage(fault.to_string())
    }
}

impl From<ValueError> for UserError {
    fn from(error: ValueError) -> Self {
        Self::usage(error.to_string())
    }
}

impl From<LightError> for UserError {
    fn from(error: LightError) -> Self {
        Self::usage(error.to_string())
    }
}

impl From<BusError> for UserError {
    fn from(error: BusError) -> Self {
        match error {
            BusError::Open { at, reason } => Self::failure(format!(
                "cannot join the rig: {reason}"
            ))
            .at(at)
            .help(
                "make sure that no other process has this name in the rig, and that its folder is yours",
            ),
            BusError::Silent { at, limit_s } => {
                let what = format!("the rig runs, but nothing connects within {limit_s} s");
                Self::failure(what)
                    .at(at)
                    .help("try again: the machine may be too busy (`maulstick doctor` says with what); otherwise restart the rig")
            }
            BusError::Files { least, .. } => Self::failure(error.to_string()).help(format!(
                "raise the limit first: `ulimit -n {}`",
                least.next_power_of_two().max(1024)
            )),
            BusError::Topic { topic, reason } => Self::failure(reason).at(topic).help(
                "the node was restarted or the rig has stopped: look at the messages of the rig",
            ),
            BusError::NoAnswer { topic, limit_ms } => {
                Self::failure(format!("no answer within {limit_ms} ms"))
                    .at(topic)
                    .help("check that this node is running")
            }
            BusError::Message { topic, source } => Self::failure(source.to_string())
                .at(topic)
                .help("all nodes of a rig must be of the same build"),
            BusError::NoRig(_) => Self::failure(error.to_string()).advise(Advice::StartRig),
            BusError::Folder { reason, help } => Self::failure(reason).help(help),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_quoted_forges_no_line() {
        let fault = UserError::usage("there is no paint called 'x\nerror: all is lost'")
            .at("a\u{1b}[2J.toml:3")
            .help("take\r'y'");
        assert_eq!(
            fault.to_string(),
            "error: there is no paint called 'x\\nerror: all is lost'\n  --> a\\u{1b}[2J.toml:3\n help: take\\r'y'"
        );
    }
}
