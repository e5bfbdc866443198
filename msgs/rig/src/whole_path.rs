//! Paths as messages carry them.

use std::path::Path;

use maulstick_types::values::WholePath;

use crate::user_error::UserError;

/// An absolute path, independent of the current folder.
///
/// # Errors
/// A [`UserError`] if there is none, or if it is not UTF-8, as messages are.
pub fn whole_path(path: &Path) -> Result<WholePath, UserError> {
    let whole = std::path::absolute(path).map_err(|error| UserError::reading(path, &error))?;
    let text = whole.into_os_string().into_string().map_err(|name| {
        UserError::usage("this path is not UTF-8")
            .at(name.display().to_string())
            .help("give the file, or the folder that it is in, another name")
    })?;
    Ok(WholePath::new(text)?)
}

#[cfg(test)]
mod tests {
    use std::os::unix::ffi::OsStrExt as _;

    use super::*;

    #[test]
    fn a_path_is_given_as_it_is_or_refused() {
        assert_eq!(
            whole_path(Path::new("/a/é.maul")).expect("UTF-8"),
            "/a/é.maul"
        );
        let odd = Path::new(std::ffi::OsStr::from_bytes(b"/a/\xff.maul"));
        let fault = whole_path(odd).expect_err("it would be another name");
        assert_eq!(fault.place.as_deref(), Some("/a/\u{fffd}.maul"));
    }
}
