//! File paths, as typed and as shown.

use std::io::{Error, ErrorKind};
use std::path::{Component, Path, PathBuf};
use std::time::{Duration, SystemTime};

use directories::{BaseDirs, UserDirs};
pub(crate) use maulstick_rig::files::ending;
use maulstick_rig::files::first_free;

/// File ending of a painting.
pub(crate) const PAINTING: &str = "maul";

/// Reason why a folder cannot be listed, in words.
#[must_use]
pub(crate) fn unlisted(error: &Error) -> String {
    match error.kind() {
        ErrorKind::NotFound => tr!("there is no such folder").to_owned(),
        ErrorKind::NotADirectory => tr!("this is no folder").to_owned(),
        ErrorKind::PermissionDenied => tr!("this folder is closed to you").to_owned(),
        _ => tr!("the folder cannot be read: {error}", error),
    }
}

/// The folder of the user.
#[must_use]
pub(crate) fn home() -> PathBuf {
    BaseDirs::new().map_or_else(|| PathBuf::from("/"), |dirs| dirs.home_dir().to_owned())
}

/// Default folder for paintings: the folder of pictures, or the home folder.
#[must_use]
pub(crate) fn pictures() -> PathBuf {
    let own = UserDirs::new().and_then(|dirs| dirs.picture_dir().map(Path::to_owned));
    own.filter(|folder| folder.is_dir()).unwrap_or_else(home)
}

/// The user's folder of documents, or the home folder.
#[must_use]
pub(crate) fn documents() -> PathBuf {
    let own = UserDirs::new().and_then(|dirs| dirs.document_dir().map(Path::to_owned));
    own.filter(|folder| folder.is_dir()).unwrap_or_else(home)
}

/// The whole path of a typed one: `~` is the user's folder, and relative paths start there.
#[must_use]
pub(crate) fn whole(typed: &str) -> PathBuf {
    let typed = typed.trim();
    let path = match typed.strip_prefix('~') {
        Some("") => home(),
        Some(rest) if rest.starts_with('/') => home().join(rest.trim_start_matches('/')),
        _ => home().join(typed),
    };
    let mut plain = PathBuf::new();
    for part in path.components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir => {
                plain.pop();
            }
            part => plain.push(part),
        }
    }
    plain
}

/// A path as a painter reads it: the user's folder is `~`.
#[must_use]
pub(crate) fn shown(path: &Path) -> String {
    let home = home();
    match path.strip_prefix(&home) {
        Ok(rest) if home.as_os_str().len() > 1 && rest.as_os_str().is_empty() => "~".to_owned(),
        Ok(rest) if home.as_os_str().len() > 1 => format!("~/{}", rest.display()),
        _ => path.display().to_string(),
    }
}

/// The last part of a path.
#[must_use]
pub(crate) fn name(path: &Path) -> String {
    path.file_name().map_or_else(
        || path.display().to_string(),
        |name| name.to_string_lossy().into_owned(),
    )
}

/// The same path with this ending, unless it has it.
#[must_use]
pub(crate) fn ending_in(path: &Path, wanted: &str) -> PathBuf {
    if ending(path) == wanted {
        path.to_owned()
    } else {
        let mut name = path.file_name().unwrap_or_default().to_os_string();
        name.push(format!(".{wanted}"));
        path.with_file_name(name)
    }
}

/// The first unused name of `stem.ending`, `stem 2.ending`, ….
#[must_use]
pub(crate) fn free(folder: &Path, stem: &str, ending: &str) -> PathBuf {
    let named = |number: u32| match number {
        1 => folder.join(format!("{stem}.{ending}")),
        number => folder.join(format!("{stem} {number}.{ending}")),
    };
    first_free(1, named).1
}

/// Time since the last change, in words.
#[must_use]
pub(crate) fn age(changed: SystemTime, now: SystemTime) -> String {
    let past = now.duration_since(changed).unwrap_or(Duration::ZERO);
    let minutes = past.as_secs() / 60;
    let [hours, days, months, years] =
        [60, 1440, 43_200, 525_600].map(|in_minutes| minutes / in_minutes);
    match minutes {
        0 => tr!("just now").to_owned(),
        1 => tr!("1 minute ago").to_owned(),
        2..=59 => tr!("{minutes} minutes ago", minutes),
        60..=119 => tr!("1 hour ago").to_owned(),
        120..=1439 => tr!("{hours} hours ago", hours),
        1440..=2879 => tr!("1 day ago").to_owned(),
        2880..=43_199 => tr!("{days} days ago", days),
        43_200..=86_399 => tr!("1 month ago").to_owned(),
        86_400..=525_599 => tr!("{months} months ago", months),
        525_600..=1_051_199 => tr!("1 year ago").to_owned(),
        _ => tr!("{years} years ago", years),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_typed_is_a_whole_path() {
        for (typed, path) in [
            ("~", home()),
            ("~/sea.maul", home().join("sea.maul")),
            ("sea.maul", home().join("sea.maul")),
            (" /a/./b/../c.maul ", PathBuf::from("/a/c.maul")),
            ("/../..", PathBuf::from("/")),
            ("~ada", home().join("~ada")),
        ] {
            assert_eq!(whole(typed), path, "{typed}");
        }
        assert_eq!(whole(&shown(&home().join("a/b"))), home().join("a/b"));
        assert_eq!(shown(Path::new("/nowhere/a")), "/nowhere/a");
    }

    #[test]
    fn endings_are_added_once_and_free_names_are_free() {
        let path = |text: &str| PathBuf::from(text);
        assert_eq!(ending_in(&path("/a/sea"), "maul"), path("/a/sea.maul"));
        assert_eq!(ending_in(&path("/a/sea.MAUL"), "maul"), path("/a/sea.MAUL"));
        assert_eq!(
            ending_in(&path("/a/sea 1.5"), "maul"),
            path("/a/sea 1.5.maul")
        );
        let folder = tempfile::tempdir().expect("a folder");
        let first = free(folder.path(), "Painting", "maul");
        assert_eq!(name(&first), "Painting.maul");
        std::fs::write(&first, "").expect("written");
        assert_eq!(
            name(&free(folder.path(), "Painting", "maul")),
            "Painting 2.maul"
        );
    }

    #[test]
    fn ages_are_told_in_words() {
        let now = SystemTime::UNIX_EPOCH + Duration::from_secs(1 << 31);
        for (seconds, words) in [
            (5, "just now"),
            (60, "1 minute ago"),
            (7300, "2 hours ago"),
            (86_400 * 3, "3 days ago"),
            (86_400 * 400, "1 year ago"),
        ] {
            assert_eq!(age(now - Duration::from_secs(seconds), now), words);
        }
        assert_eq!(age(now + Duration::from_secs(9), now), "just now");
    }
}
