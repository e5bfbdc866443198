//! Files that a command writes: none takes the place of one that it reads, nor of another that it writes.

use std::path::{Path, PathBuf};

use maulstick_optics::Illuminant;
use maulstick_rig::Fault;
use maulstick_rig::config::{RigConfig, is_path};
use maulstick_rig::files::check_writable;

/// What the database of a painting has beside it.
const BESIDE: [&str; 3] = ["-wal", "-shm", "-journal"];

/// A file that a command reads or writes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UsedFile {
    /// What it is to the command, with its article.
    pub what: String,
    /// As the user named it.
    pub path: PathBuf,
}

impl UsedFile {
    /// A file by what it is and where.
    pub fn new(what: impl Into<String>, path: impl Into<PathBuf>) -> Self {
        Self {
            what: what.into(),
            path: path.into(),
        }
    }

    /// The same where the file is given; nothing where it is not.
    pub fn given<P: Into<PathBuf>>(what: &str, path: Option<P>) -> Option<Self> {
        path.map(|path| Self::new(what, path))
    }

    /// What a name of a library or of a file means: nothing where it is no file's.
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

    /// A painting's file, and those that may lie beside it.
    pub fn painting(path: &Path) -> impl Iterator<Item = Self> {
        let beside = BESIDE.map(|ending| {
            let mut name = path.as_os_str().to_owned();
            name.push(ending);
            Self::new("what belongs to the painting", name)
        });
        std::iter::once(Self::new("the painting", path)).chain(beside)
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
        .chain(UsedFile::named("the ground", &config.canvas.ground))
        .chain(UsedFile::given("the profile", config.view.file()))
        .chain(hands.map(|hand| UsedFile::new("the take of a hand", hand)))
        .chain(replays.map(|played| UsedFile::new("the recording of a device", played)))
        .collect()
}

/// Sees, before the work that fills them, that outputs are files of their own and can be written.
///
/// # Errors
/// A [`Fault`] where an output is an input or another output, or where it cannot be written.
pub fn check_outputs(outputs: &[UsedFile], inputs: &[UsedFile]) -> Result<(), Fault> {
    check_apart(outputs, inputs)?;
    outputs.iter().try_for_each(|UsedFile { path, .. }| {
        check_writable(path).map_err(|error| Fault::writing(path, &error))
    })
}

/// Sees that no output is an input or another output, wherever links lead.
///
/// # Errors
/// A [`Fault`] where one is.
pub fn check_apart(outputs: &[UsedFile], inputs: &[UsedFile]) -> Result<(), Fault> {
    for (number, output) in outputs.iter().enumerate() {
        let Some(real) = real(&output.path) else {
            continue;
        };
        let is_same = |other: &&UsedFile| self::real(&other.path).as_ref() == Some(&real);
        let what = &output.what;
        let what = match (
            inputs.iter().find(is_same),
            outputs[..number].iter().find(is_same),
        ) {
            (Some(input), _) => format!("{what} would take the place of {}", input.what),
            (None, Some(other)) => format!("{} and {what} would be one file", other.what),
            (None, None) => continue,
        };
        return Err(Fault::usage(what)
            .at(output.path.display().to_string())
            .help(format!("give {} another name", output.what)));
    }
    Ok(())
}

/// Where a name leads, whether the file is there or not; nowhere for devices and pipes, of which nothing
/// is lost.
fn real(path: &Path) -> Option<PathBuf> {
    if let Ok(found) = std::fs::metadata(path) {
        return match found.is_file() {
            true => std::fs::canonicalize(path).ok(),
            false => None,
        };
    }
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
        let check = |outputs: &[UsedFile], inputs: &[UsedFile]| {
            check_outputs(outputs, inputs).map_err(|fault| fault.to_string())
        };
        let wrong = |outputs: &[UsedFile], inputs: &[UsedFile]| {
            check(outputs, inputs).expect_err("refused")
        };
        let text = wrong(&[file("link")], &[file("one")]);
        assert!(text.contains("the link would take the place of the one"));
        assert!(text.contains("-->") && text.contains("help: give the link another name"));
        assert!(wrong(&[file("in/../one")], &[file("link")]).contains("take the place"));
        let twice = wrong(&[file("new"), file("in/../new")], &[]);
        assert!(twice.contains("would be one file"), "{twice}");
        check(&[file("new"), file("newer")], &[file("one")]).expect("files of their own");
        let null = UsedFile::new("the picture", "/dev/null");
        check(&[null.clone(), null.clone()], &[null]).expect("nothing is lost");
        let painting: Vec<_> = UsedFile::painting(&path("a.maul")).collect();
        assert!(wrong(&[file("a.maul-wal")], &painting).contains("belongs to the painting"));
        assert!(!path("new").exists());
    }

    #[test]
    fn only_what_is_a_file_counts_among_the_settings() {
        let mut config = RigConfig::default();
        assert_eq!(named_by(&config), Vec::new());
        config.brush[0].kind = "own.toml".into();
        config.canvas.ground = "linen.csv".into();
        config.light.illuminant = "lamp".into();
        config.view.profile = "screen.icc".into();
        config.paint.paints = Some("mine.csv".into());
        assert_eq!(named_by(&config).len(), 5);
    }
}
