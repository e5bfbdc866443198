//! Finding a vendor's shared library, and what to do where it cannot be used.

#![allow(unsafe_code, reason = "a shared library runs its initialisers")]

use std::path::{Path, PathBuf};

use maulstick_rig::UserError;

/// A library as its vendor calls it.
#[derive(Clone, Copy, Debug)]
pub struct VendorLibrary {
    /// The product that has it.
    pub product: &'static str,
    /// What it is, for one that is another.
    pub kind: &'static str,
    /// Names by which the system may have it.
    pub names: [&'static str; 3],
    /// Advice on its installation.
    pub install: &'static str,
    /// Advice where `library` names another one.
    pub correct: &'static str,
}

/// The reason why a library cannot be used.
pub enum Unusable {
    /// No library of this name.
    Missing,
    /// It needs another one that is not there.
    Needs(String),
    /// It is for another machine, or no library.
    Foreign(String),
    /// It has no function of this name.
    Lacks(&'static str),
    /// Error of the system.
    Other(String),
}

impl VendorLibrary {
    /// What `open` makes of the library in the file `asked`, or of the first of its usual names where the system looks for
    /// libraries.
    ///
    /// # Errors
    /// A [`UserError`]: it is missing, it cannot be loaded, or it is another one.
    pub fn find<T>(
        &self,
        asked: Option<&Path>,
        open: impl Fn(&Path) -> Result<T, Unusable>,
    ) -> Result<T, UserError> {
        if let Some(path) = asked {
            if path.components().count() > 1 && !path.exists() {
                return Err(UserError::usage("there is no such library")
                    .at(path.display().to_string())
                    .help("correct `library` in rig.toml, or leave it out"));
            }
            return open(path).map_err(|why| self.fault(why, path));
        }
        let mut broken = None;
        for name in self.names.map(Path::new) {
            match open(name) {
                Ok(library) => return Ok(library),
                Err(Unusable::Missing) => {}
                Err(why) => broken = broken.or(Some((name, why))),
            }
        }
        Err(match broken {
            Some((name, why)) => self.fault(why, name),
            None => UserError::failure(format!(
                "{} is not installed: the system has no {}",
                self.product, self.names[0]
            ))
            .help(self.install),
        })
    }

    fn fault(&self, why: Unusable, name: &Path) -> UserError {
        let product = self.product;
        match why {
            Unusable::Missing => {
                UserError::failure("there is no such library").help(self.install)
            }
            Unusable::Needs(other) => UserError::failure(format!(
                "the library of {product} cannot be loaded: it needs {other}, which is not installed"
            ))
            .help(format!("install the package that has {other}")),
            Unusable::Foreign(said) => {
                UserError::failure(format!("this is no library for this machine ({said})")).help(
                    format!("install {product} for 64-bit {}", std::env::consts::ARCH),
                )
            }
            Unusable::Lacks(function) => UserError::failure(format!(
                "this is no {}: it has no function {function}",
                self.kind
            ))
            .help(self.correct),
            Unusable::Other(said) => {
                UserError::failure(format!("the library of {product} cannot be loaded: {said}"))
                    .help(format!(
                        "see that {product} and the driver of the device are installed completely"
                    ))
            }
        }
        .at(name.display().to_string())
    }
}

impl Unusable {
    /// By what the system's loader says of the library of this name.
    fn of(name: &Path, said: &str) -> Self {
        let name = name.display().to_string();
        let absent = "cannot open shared object file: No such file";
        let foreign = [
            "wrong ELF class",
            "invalid ELF header",
            "file too short",
            "ELF file",
        ];
        match said.split_once(": ") {
            Some((which, rest)) if rest.starts_with(absent) && which == name => Self::Missing,
            Some((which, rest)) if rest.starts_with(absent) => Self::Needs(which.to_owned()),
            _ if foreign.iter().any(|sign| said.contains(sign)) => Self::Foreign(said.to_owned()),
            _ => Self::Other(said.to_owned()),
        }
    }
}

/// Loads a library, which its vendor's users load in the same way.
///
/// # Errors
/// [`Unusable`].
pub fn load(name: &Path) -> Result<libloading::Library, Unusable> {
    // SAFETY: the user names the vendor's library, whose initialisers any of its users runs.
    let loaded = unsafe { libloading::Library::new(PathBuf::from(name)) };
    loaded.map_err(|error| Unusable::of(name, &said(&error)))
}

/// Text of the system loader's error.
fn said(error: &libloading::Error) -> String {
    std::error::Error::source(error).map_or_else(|| error.to_string(), ToString::to_string)
}

#[cfg(test)]
mod tests {
    use super::*;

    const OURS: VendorLibrary = VendorLibrary {
        product: "Feel",
        kind: "library of Feel",
        names: ["libfeel.so", "libfeel.so.2", "libfeel.so.1"],
        install: "buy it",
        correct: "name libfeel.so",
    };

    #[test]
    fn what_the_loader_says_becomes_what_to_do() {
        let says = |said: &str| {
            let name = Path::new("libfeel.so");
            OURS.fault(Unusable::of(name, said), name)
        };
        let tail = "cannot open shared object file: No such file or directory";
        let missing = says(&format!("libfeel.so: {tail}"));
        assert_eq!(missing.what, "there is no such library");
        let needs = says(&format!("libncurses.so.5: {tail}"));
        assert!(needs.what.contains("needs libncurses.so.5"), "{needs}");
        let help = needs.help.expect("help");
        assert!(help.contains("libncurses.so.5"), "{help}");
        let narrow = says("libfeel.so: wrong ELF class: ELFCLASS32");
        let other_machine = "no library for this machine";
        assert!(narrow.what.contains(other_machine), "{narrow}");
        let other = says("libfeel.so: undefined symbol: something");
        let symbol = "undefined symbol: something";
        assert!(other.what.contains(symbol), "{other}");
    }

    #[test]
    fn one_that_is_not_installed_is_told_as_such() {
        let fault = OURS.find(None, load).expect_err("nobody has it");
        assert_eq!(
            fault.what,
            "Feel is not installed: the system has no libfeel.so"
        );
        assert_eq!(fault.help.as_deref(), Some("buy it"));
    }
}
