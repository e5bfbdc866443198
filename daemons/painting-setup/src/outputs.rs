//! Output files of a command: none replaces one of its inputs, nor another output.

use std::path::{Path, PathBuf};

use maulstick_optics::Illuminant;
use maulstick_rig::config::{RigConfig, is_path};
use maulstick_rig::files::{FileId, Kind, check_writable, gives_way, is_companion};
use maulstick_rig::{UserError, whole_path};
use maulstick_types::values::WholePath;
use thiserror::Error;

/// A file that a command reads or writes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UsedFile {
    /// Its role in the command, with its article.
    pub what: String,
    /// As the user named it.
    pub path: PathBuf,
    /// Kind of file that may exist there already, if it is written.
    pub kind: Kind,
}

impl UsedFile {
    /// A file by what it is and where.
    pub fn new(what: impl Into<String>, path: impl Into<PathBuf>) -> Self {
        Self {
            what: what.into(),
            path: path.into(),
            kind: Kind::Own,
        }
    }

    /// This file with its kind, as an output.
    #[must_use]
    pub fn of(self, kind: Kind) -> Self {
        Self { kind, ..self }
    }

    /// A file of a kind that is written, where it is given.
    pub fn written<P: Into<PathBuf>>(what: &str, path: Option<P>, kind: Kind) -> Option<Self> {
        Self::given(what, path).map(|file| file.of(kind))
    }

    /// A file if its path is given; `None` otherwise.
    pub fn given<P: Into<PathBuf>>(what: &str, path: Option<P>) -> Option<Self> {
        path.map(|path| Self::new(what, path))
    }

    /// The file that a name of a library or of a file refers to; `None` if it is no file's.
    #[must_use]
    pub fn named(what: &str, name: &str) -> Option<Self> {
        is_path(name).then(|| Self::new(what, name))
    }

    /// The same of a light, whose file may have any name that is no light's.
    #[must_use]
    pub fn light(name: &str) -> Option<Self> {
        let known = Illuminant::named(name).is_some();
        (!known).then(|| Self::new("the spectrum of the light", name))
    }

    /// A painting's file; SQLite's companion files take no other name.
    pub fn painting(path: &Path) -> Self {
        Self::new("the painting", path)
    }
}

/// The files that a rig's settings name.
#[must_use]
pub fn named_by(config: &RigConfig) -> Vec<UsedFile> {
    let brushes = config.brush.iter();
    let hands = config
        .device
        .iter()
        .filter_map(|device| device.hand.as_ref());
    let replays = config.device.iter();
    let replays = replays.filter_map(|device| device.replay.as_ref());
    brushes
        .filter_map(|brush| UsedFile::named("the brush", &brush.kind))
        .chain(UsedFile::given("the paints", config.paint.paints.as_ref()))
        .chain(UsedFile::light(&config.light.illuminant))
        .chain(UsedFile::named(
            "the environment",
            &config.light.environment,
        ))
        .chain(UsedFile::named("the ground", &config.canvas.ground))
        .chain(UsedFile::given("the profile", config.view.file()))
        .chain(hands.map(|hand| UsedFile::new("the take of a hand", hand)))
        .chain(replays.map(|played| UsedFile::new("the recording of a device", played)))
        .collect()
}

/// Why a file cannot be written.
#[derive(Debug, Error)]
pub enum OutputError {
    /// It is one that is read.
    #[error("{} would take the place of {}", .output.what, .input.what)]
    IsInput {
        /// What is to be written.
        output: UsedFile,
        /// What is read.
        input: UsedFile,
    },
    /// It is another one that is written.
    #[error("{} and {} would be one file", .other.what, .output.what)]
    IsOutput {
        /// What is to be written.
        output: UsedFile,
        /// The other one.
        other: UsedFile,
    },
    /// Its extension is that of a file beside a painting.
    #[error("a file with this extension may belong to a painting")]
    Companion(UsedFile),
    /// The system, or the file that is there, does not allow it.
    #[error("{1}")]
    Unwritable(PathBuf, std::io::Error),
}

impl From<OutputError> for UserError {
    fn from(error: OutputError) -> Self {
        let what = error.to_string();
        match error {
            OutputError::Unwritable(path, error) => Self::writing(&path, &error),
            OutputError::IsInput { output, .. }
            | OutputError::IsOutput { output, .. }
            | OutputError::Companion(output) => Self::usage(what)
                .at(output.path.display().to_string())
                .help(format!("give {} another name", output.what)),
        }
    }
}

/// Sees, before the work that fills them, that outputs are files of their own and can be written.
///
/// # Errors
/// An [`OutputError`] where one is an input or another output, or cannot be written.
pub fn check_outputs(outputs: &[UsedFile], inputs: &[UsedFile]) -> Result<(), OutputError> {
    check_apart(outputs, inputs)?;
    if let Some(output) = outputs.iter().find(|output| is_companion(&output.path)) {
        return Err(OutputError::Companion(output.clone()));
    }
    outputs.iter().try_for_each(|UsedFile { path, kind, .. }| {
        check_writable(path, *kind).map_err(|error| OutputError::Unwritable(path.clone(), error))
    })
}

/// A file that a node writes for a command. Nodes never replace a file of another kind, so with `--overwrite` the node
/// writes beside it, and the command moves the result.
#[derive(Clone, Debug)]
pub struct Relayed {
    to: PathBuf,
    written: PathBuf,
}

impl Relayed {
    /// A file of a kind that [`check_outputs`] has found writable.
    ///
    /// # Errors
    /// A [`UserError`] where the path is not UTF-8, or the current folder is gone.
    pub fn new(path: &Path, kind: Kind) -> Result<Self, UserError> {
        let to = PathBuf::from(whole_path(path)?.as_str());
        let written = if gives_way(&to, kind) {
            to.clone()
        } else {
            let name = to.file_name().unwrap_or_default().to_string_lossy();
            to.with_file_name(format!("{}.new.{name}", std::process::id()))
        };
        Ok(Self { to, written })
    }

    /// The name for the node.
    ///
    /// # Errors
    /// A [`UserError`] where it is not UTF-8.
    pub fn asked(&self) -> Result<WholePath, UserError> {
        whole_path(&self.written)
    }

    /// Renames the file once the node has written it, and puts its name into the node's answer.
    ///
    /// # Errors
    /// A [`UserError`] where it cannot be renamed; it stays beside that name.
    pub fn arrive(&self, said: &str) -> Result<String, UserError> {
        if self.written != self.to {
            std::fs::rename(&self.written, &self.to)
                .map_err(|error| UserError::writing(&self.to, &error))?;
        }
        Ok(said.replace(&*self.asked()?, &self.to.display().to_string()))
    }
}

/// Sees that no output is an input or another output, wherever links lead.
///
/// # Errors
/// An [`OutputError`] where one is.
pub fn check_apart(outputs: &[UsedFile], inputs: &[UsedFile]) -> Result<(), OutputError> {
    for (number, output) in outputs.iter().enumerate() {
        let is_same = |other: &&UsedFile| is_one_file(&output.path, &other.path);
        let output = output.clone();
        if let Some(input) = inputs.iter().find(is_same).cloned() {
            return Err(OutputError::IsInput { output, input });
        }
        if let Some(other) = outputs[..number].iter().find(is_same).cloned() {
            return Err(OutputError::IsOutput { output, other });
        }
    }
    Ok(())
}

/// True if two names lead to one file, whether or not it exists; unlike paths, hard links do.
fn is_one_file(one: &Path, other: &Path) -> bool {
    match [one, other].map(FileId::of) {
        [Ok(one), Ok(other)] => one == other,
        [Err(_), Err(_)] => real(one).is_some_and(|real| self::real(other) == Some(real)),
        _ => false,
    }
}

/// The absolute name of a file that may be absent.
fn real(path: &Path) -> Option<PathBuf> {
    let folder = match path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    };
    Some(std::fs::canonicalize(folder).ok()?.join(path.file_name()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_told_apart_by_where_they_lead() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = |name: &str| folder.path().join(name);
        std::fs::write(path("one"), "1").expect("written");
        std::os::unix::fs::symlink(path("one"), path("link")).expect("a link");
        std::fs::create_dir(path("in")).expect("made");
        let file = |name: &str| UsedFile::new(format!("the {name}"), path(name));
        let wrong = |outputs: &[UsedFile], inputs: &[UsedFile]| {
            check_outputs(outputs, inputs).expect_err("refused")
        };
        let is_input = |error: &OutputError| matches!(error, OutputError::IsInput { .. });
        let fault = wrong(&[file("link")], &[file("one")]);
        assert!(is_input(&fault));
        let fault = UserError::from(fault);
        assert_eq!(fault.place, Some(path("link").display().to_string()));
        assert!(fault.help.is_some_and(|help| help.contains("link")));
        assert!(is_input(&wrong(&[file("in/../one")], &[file("link")])));
        let twice = wrong(&[file("new"), file("in/../new")], &[]);
        assert!(matches!(twice, OutputError::IsOutput { .. }), "{twice}");
        check_outputs(&[file("new"), file("newer")], &[file("one")]).expect("files of their own");
        std::fs::hard_link(path("one"), path("second")).expect("a second name");
        assert!(is_input(&wrong(&[file("second")], &[file("one")])));
        let companion = wrong(&[file("a.maul-wal")], &[]);
        assert!(matches!(companion, OutputError::Companion(_)));
        let null = UsedFile::new("the picture", "/dev/null");
        for unwritable in [null, file("one").of(Kind::Png)] {
            let error = wrong(&[unwritable], &[]);
            assert!(matches!(error, OutputError::Unwritable(..)), "{error}");
        }
        assert!(!path("new").exists());
    }

    #[test]
    fn only_what_is_a_file_counts_among_the_settings() {
        let mut config = RigConfig::default();
        assert_eq!(named_by(&config), Vec::new());
        config.brush[0].kind = "own.toml".into();
        config.canvas.ground = "linen.csv".into();
        config.light.illuminant = "lamp".into();
        config.light.environment = "hall.hdr".into();
        config.view.profile = "screen.icc".into();
        config.paint.paints = Some("mine.csv".into());
        assert_eq!(named_by(&config).len(), 6);
    }
}
