//! Finding a vendor's shared library, and what to do where it cannot be used.

#![allow(unsafe_code, reason = "a shared library runs its initialisers")]

use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use maulstick_rig::UserError;
use maulstick_rig::log::flush;

/// Folders whose files the administrator of the system alone puts there.
const SYSTEM: [&str; 7] = [
    "/lib",
    "/lib64",
    "/usr/lib",
    "/usr/lib64",
    "/usr/local/lib",
    "/usr/local/lib64",
    "/opt",
];

/// Libraries in other folders that the user of this process lets it load.
static ALLOWED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());
/// Libraries of which it was said that they are loaded.
static SAID: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Lets this process load a library that is in no folder of the system, as `--allow-library` asks: settings alone, which
/// may be anybody's, do not.
pub fn allow_library(path: &Path) {
    let mut allowed = ALLOWED.lock().unwrap_or_else(PoisonError::into_inner);
    allowed.push(path.to_owned());
}

/// Checks that a library may be loaded by the path that settings give.
///
/// # Errors
/// A [`UserError`]: the path is relative, nothing is there, or it is in no folder of the system and not allowed.
fn check(path: &Path) -> Result<(), UserError> {
    let refused = |what: &str, help: String| {
        Err(UserError::usage(what)
            .at(path.display().to_string())
            .help(help))
    };
    if !path.is_absolute() {
        let help = "give the whole path from the root, or its name alone, which the system finds";
        return refused("the path of a library is relative", help.to_owned());
    }
    let Ok(real) = path.canonicalize() else {
        let help = "correct `library` in rig.toml, or leave it out";
        return refused("there is no such library", help.to_owned());
    };
    let allowed = ALLOWED.lock().unwrap_or_else(PoisonError::into_inner);
    let is_allowed = allowed
        .iter()
        .any(|own| own == path || own.canonicalize().is_ok_and(|own| own == real));
    if is_allowed || SYSTEM.iter().any(|folder| real.starts_with(folder)) {
        Ok(())
    } else {
        refused(
            "a library outside of the folders of the system is not loaded unasked",
            format!(
                "if you trust it: `maulstick up --allow-library {}`; or install it below /usr/local/lib or /opt",
                path.display()
            ),
        )
    }
}

/// Says once that a library is loaded, before it is: its first act may be its last.
fn say_loading(product: &str, path: &Path) {
    let mut said = SAID.lock().unwrap_or_else(PoisonError::into_inner);
    if !said.iter().any(|own| own == path) {
        said.push(path.to_owned());
        tracing::info!("loading the library of {product}: {}", path.display());
        flush();
    }
}

/// A library as its vendor calls it.
#[derive(Clone, Copy, Debug)]
pub struct VendorLibrary {
    /// The product that has it.
    pub product: &'static str,
    /// Its name, for one that is another.
    pub kind: &'static str,
    /// Names by which the system may have it.
    pub names: [&'static str; 3],
    /// Advice on its installation.
    pub install: &'static str,
    /// Advice where `library` names another one.
    pub correct: &'static str,
}

/// The reason why a library cannot be used.
#[derive(Clone, Debug, PartialEq, Eq)]
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
    /// Result of `open` for the library in the file `asked`, or of the first of its usual names where the system looks for
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
            if !is_name(path) {
                check(path)?;
            }
            say_loading(self.product, path);
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

/// True for the name of a library alone, which the system finds.
fn is_name(library: &Path) -> bool {
    library.file_name() == Some(library.as_os_str())
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
        let says = |said: &str| Unusable::of(Path::new("libfeel.so"), said);
        let tail = "cannot open shared object file: No such file or directory";
        let missing = says(&format!("libfeel.so: {tail}"));
        assert_eq!(missing, Unusable::Missing);
        let needs = says(&format!("libncurses.so.5: {tail}"));
        assert_eq!(needs, Unusable::Needs("libncurses.so.5".to_owned()));
        let narrow = "libfeel.so: wrong ELF class: ELFCLASS32".to_owned();
        assert_eq!(says(&narrow), Unusable::Foreign(narrow));
        let other = "libfeel.so: undefined symbol: something".to_owned();
        assert_eq!(says(&other), Unusable::Other(other));
    }

    #[test]
    fn a_library_in_anybodys_folder_is_loaded_by_consent_alone() {
        let folder = tempfile::tempdir().expect("a folder");
        let own = folder.path().join("libfeel.so");
        std::fs::write(&own, "no library").expect("written");
        let find = |path: &Path| {
            let opened = OURS.find(Some(path), |_| Ok(()));
            opened.map_err(|fault| fault.what)
        };
        let outside = "a library outside of the folders of the system is not loaded unasked";
        assert_eq!(find(&own), Err(outside.to_owned()));
        // A name in a folder of the system does not lead out of it.
        let roundabout = Path::new("/usr/lib/../..").join(own.strip_prefix("/").expect("absolute"));
        assert_eq!(find(&roundabout), Err(outside.to_owned()));
        for relative in ["feel/libfeel.so", "./libfeel.so", "libfeel.so/"] {
            let refused = find(Path::new(relative)).expect_err(relative);
            assert_eq!(refused, "the path of a library is relative");
        }
        assert_eq!(find(Path::new("libfeel.so")), Ok(()));
        allow_library(&own);
        assert_eq!(find(&own), Ok(()));
        let other = folder.path().join("other.so");
        std::fs::write(&other, "no library").expect("written");
        assert_eq!(find(&other), Err(outside.to_owned()));
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
