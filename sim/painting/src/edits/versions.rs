//! Edits of the versions as options of one command.

use maulstick_types::Edit;
use maulstick_types::values::VersionName;

use super::{Branch, Forget, Keep, ReturnTo};

/// Options that ask for an edit of the versions; of their group one may be given.
#[derive(clap::Args, Clone, Debug)]
pub struct VersionOptions {
    /// Keep the painting as a version of this name
    #[arg(long, value_name = "NAME", group = "act")]
    keep: Option<VersionName>,
    /// Return the painting to a version; this can be undone
    #[arg(long = "return", value_name = "NAME", group = "act")]
    return_to: Option<VersionName>,
    /// Begin version NAME from version FROM, and return the painting to it
    #[arg(long, value_names = ["FROM", "NAME"], num_args = 2, group = "act")]
    branch: Option<Vec<VersionName>>,
    /// Delete a version
    #[arg(long, value_name = "NAME", group = "act")]
    forget: Option<VersionName>,
}

impl VersionOptions {
    /// The requested edit, if any.
    #[must_use]
    pub fn edit(&self) -> Option<Edit> {
        let name = |name: &Option<VersionName>| name.clone();
        let keep = name(&self.keep).map(|name| Keep { name }.into());
        let back = name(&self.return_to).map(|name| ReturnTo { name }.into());
        let forget = name(&self.forget).map(|name| Forget { name }.into());
        let branch = self.branch.as_deref().and_then(|names| match names {
            [from, name] => {
                let (from, name) = (from.clone(), name.clone());
                Some(Branch { from, name }.into())
            }
            _ => None,
        });
        keep.or(back).or(forget).or(branch)
    }
}
