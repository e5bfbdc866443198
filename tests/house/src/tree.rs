//! Files and packages of the workspace.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use anyhow::{Context, Result};

use crate::facts::{Facts, Module};

/// Folders of the workspace that have sources or documents.
const FOLDERS: [&str; 8] = [
    "daemons", "docs", "launch", "msgs", "sim", "tests", "tools", "ui",
];

/// The workspace, or what a test gives for it. Paths are relative to its root, with `/`.
#[derive(Default)]
pub struct Tree {
    /// Texts of sources, documents and manifests.
    pub(crate) texts: BTreeMap<String, String>,
    /// Facts of the Rust files.
    pub(crate) facts: BTreeMap<String, Facts>,
    /// Rust files that are compiled only for tests.
    pub(crate) tests: BTreeSet<String>,
    /// The packages by their folders.
    pub(crate) packages: BTreeMap<String, Package>,
}

/// A package of the workspace.
pub(crate) struct Package {
    pub(crate) name: String,
    /// Names of the packages that it is built with, tests apart.
    dependencies: BTreeSet<String>,
}

impl Tree {
    /// Reads the workspace.
    ///
    /// # Errors
    /// Where a file is not readable, no Rust or no manifest.
    pub fn read() -> Result<Self> {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let mut texts = BTreeMap::new();
        for folder in FOLDERS.iter().chain([&""]) {
            read_folder(&root, folder, &mut texts)?;
        }
        Self::of(texts)
    }

    /// The tree of these texts by their paths.
    ///
    /// # Errors
    /// Where one is no Rust or no manifest.
    pub fn of(texts: BTreeMap<String, String>) -> Result<Self> {
        let mut tree = Self::default();
        for (path, text) in &texts {
            if path.ends_with(".rs") {
                let facts = Facts::of(text).with_context(|| path.clone())?;
                tree.facts.insert(path.clone(), facts);
            } else if let Some(folder) = path.strip_suffix("/Cargo.toml") {
                let package = manifest(text).with_context(|| path.clone())?;
                tree.packages.insert(folder.to_owned(), package);
            }
        }
        tree.texts = texts;
        tree.find_tests();
        Ok(tree)
    }

    /// Marks files in folders of tests, and those of modules under `cfg(test)`.
    fn find_tests(&mut self) {
        let folders = ["tests", "examples", "benches"];
        let in_folder = |path: &&String| path.split('/').any(|part| folders.contains(&part));
        self.tests = self.facts.keys().filter(in_folder).cloned().collect();
        let mut open: Vec<String> = self.facts.keys().cloned().collect();
        while let Some(path) = open.pop() {
            let whole = self.tests.contains(&path);
            for module in &self.facts[&path].module.modules {
                let file = self.file_of(&path, module).filter(|_| whole || module.test);
                open.extend(file.filter(|file| self.tests.insert(file.clone())));
            }
        }
    }

    /// File of a module that another file declares and does not have.
    pub(crate) fn file_of(&self, file: &str, module: &Module) -> Option<String> {
        let (folder, name) = file.rsplit_once('/').filter(|_| module.elsewhere)?;
        let root = matches!(name, "lib.rs" | "main.rs" | "mod.rs") || folder.ends_with("/bin");
        let own = file.strip_suffix(".rs").filter(|_| !root).unwrap_or(folder);
        let stem = format!("{own}/{}", module.name);
        let mut paths = [format!("{stem}.rs"), format!("{stem}/mod.rs")].into_iter();
        paths.find(|path| self.facts.contains_key(path))
    }

    /// Facts of the files that are no tests.
    pub(crate) fn product(&self) -> impl Iterator<Item = (&String, &Facts)> {
        let is_product = |(path, _): &(&String, _)| !self.tests.contains(*path);
        self.facts.iter().filter(is_product)
    }

    /// Folder of the package that a file belongs to.
    pub(crate) fn package_of(&self, path: &str) -> &str {
        let mut folders = self.packages.keys().filter(|folder| below(path, folder));
        folders.next_back().map_or("", String::as_str)
    }

    /// Folders of a package and of all that it is built with.
    pub(crate) fn built_with(&self, name: &str) -> BTreeSet<&str> {
        let (mut all, mut open) = (BTreeSet::new(), vec![name]);
        while let Some(name) = open.pop() {
            let named = |(_, package): &(_, &Package)| package.name == name;
            if let Some((folder, package)) = self.packages.iter().find(named)
                && all.insert(folder.as_str())
            {
                open.extend(package.dependencies.iter().map(String::as_str));
            }
        }
        all
    }
}

/// Whether a path is below a folder.
pub(crate) fn below(path: &str, folder: &str) -> bool {
    let rest = path.strip_prefix(folder);
    rest.is_some_and(|rest| rest.starts_with('/'))
}

/// Reads the files of a folder and, but for the root, of those in it.
fn read_folder(root: &Path, folder: &str, texts: &mut BTreeMap<String, String>) -> Result<()> {
    let entries = root.join(folder).read_dir();
    for entry in entries.with_context(|| folder.to_owned())? {
        let entry = entry?;
        let path = format!("{folder}/{}", entry.file_name().display());
        let path = path.trim_start_matches('/').to_owned();
        let mut ends = [".rs", ".wgsl", ".py", ".md", "/Cargo.toml"].iter();
        if entry.file_type()?.is_dir() {
            if !folder.is_empty() && !path.ends_with("/target") {
                read_folder(root, &path, texts)?;
            }
        } else if ends.any(|end| path.ends_with(end)) {
            let text = std::fs::read_to_string(entry.path()).with_context(|| path.clone())?;
            texts.insert(path, text);
        }
    }
    Ok(())
}

fn manifest(text: &str) -> Result<Package> {
    let table: toml::Table = text.parse()?;
    let name = table["package"]["name"].as_str();
    let name = name.context("no name")?.to_owned();
    let kinds = ["dependencies", "build-dependencies"].iter();
    let tables = kinds.filter_map(|kind| table.get(*kind)?.as_table());
    let dependencies = tables.flat_map(toml::Table::keys).cloned().collect();
    Ok(Package { name, dependencies })
}
