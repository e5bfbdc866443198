//! `maulstick painting open`: another painting in a running rig.

use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::Args;
use maulstick_rig::UserError;
use maulstick_types::command::RigCommand;
use maulstick_types::values::WholePath;

use crate::commands::client::{Client, Target};
use crate::commands::say;

/// Longest wait for a painting to be open: its last journal records may have to be done again.
pub(crate) const LONGEST: Duration = Duration::from_secs(3600);

/// Options of `maulstick painting open`.
#[derive(Args, Clone, Debug)]
pub struct OpenOptions {
    /// Painting
    file: PathBuf,
    /// Discard the current painting if it is in memory only
    #[arg(long)]
    forget: bool,
    #[command(flatten)]
    target: Target,
}

/// An absolute path, independent of the current folder.
///
/// # Errors
/// A [`UserError`] if there is none, or if it is not UTF-8, as messages are.
pub(crate) fn whole(path: &Path) -> Result<WholePath, UserError> {
    let whole = std::path::absolute(path).map_err(|error| UserError::reading(path, &error))?;
    let text = whole.into_os_string().into_string().map_err(|name| {
        UserError::usage("this path is not UTF-8")
            .at(name.display().to_string())
            .help("give the file, or the folder that it is in, another name")
    })?;
    Ok(WholePath::new(text)?)
}

/// Goes on in another painting.
///
/// # Errors
/// A [`UserError`] where it cannot be opened, or where no rig runs.
pub fn run(options: &OpenOptions) -> Result<i32, UserError> {
    let command = RigCommand::Open {
        path: whole(&options.file)?,
        forget: options.forget,
    };
    let done = Client::open(&options.target)?.send_within(command, LONGEST)?;
    say!("{done}");
    Ok(0)
}

#[cfg(test)]
mod tests {
    use std::os::unix::ffi::OsStrExt as _;

    use super::*;

    #[test]
    fn a_path_is_told_as_it_is_or_refused() {
        assert_eq!(whole(Path::new("/a/é.maul")).expect("UTF-8"), "/a/é.maul");
        let odd = Path::new(std::ffi::OsStr::from_bytes(b"/a/\xff.maul"));
        let fault = whole(odd).expect_err("it would be another name");
        assert!(fault.what.contains("UTF-8"), "{}", fault.what);
    }
}
