//! Rules of size and of the dependencies between modules.

use std::collections::{BTreeMap, BTreeSet};

use super::Breaches;
use crate::modules::Crate;
use crate::tree::Tree;

/// Texts of the source files.
fn sources(tree: &Tree) -> impl Iterator<Item = (&String, &String)> {
    let is_source = |path: &str| matches!(path.rsplit('.').next(), Some("rs" | "wgsl" | "py"));
    tree.texts.iter().filter(move |(path, _)| is_source(path))
}

/// Modules that use each other in a circle, but for those around one another; re-exports are followed.
pub(super) fn cycles(tree: &Tree, found: &mut Breaches) {
    for (path, _) in tree.product() {
        let file = path.rsplit('/').next();
        if matches!(file, Some("lib.rs" | "main.rs")) || path.contains("/src/bin/") {
            cycles_of(&Crate::of(tree, path), found);
        }
    }
}

fn cycles_of(modules: &Crate, found: &mut Breaches) {
    let count = modules.0.len();
    let used: Vec<_> = (0..count).map(|module| modules.used_by(module)).collect();
    let reached = |from: usize| {
        let (mut seen, mut open) = (BTreeSet::new(), vec![from]);
        while let Some(module) = open.pop() {
            open.extend(used[module].keys().filter(|other| seen.insert(**other)));
        }
        seen
    };
    let reached: Vec<_> = (0..count).map(reached).collect();
    for (module, others) in reached.iter().enumerate() {
        let in_cycle = |other: &usize| others.contains(other) && reached[*other].contains(&module);
        let size = others.iter().filter(|other| in_cycle(other)).count();
        if let Some((other, line)) = used[module].iter().find(|(other, _)| in_cycle(other)) {
            let (key, other) = (&modules.0[module].name, &modules.0[*other].name);
            let what = format!("by {other} in a cycle of {size}: move what both use below both");
            found.add(key, size, format!("{key}:{line}: {what}"));
        }
    }
}

/// Files that are too long.
pub(super) fn files(tree: &Tree, found: &mut Breaches) {
    for (path, text) in sources(tree) {
        found.above(500, text.lines().count(), path, "lines: one concept a file");
    }
}

/// Folders with too many source files.
pub(super) fn folders(tree: &Tree, found: &mut Breaches) {
    let mut folders = BTreeMap::<&str, usize>::new();
    for (folder, _) in sources(tree).filter_map(|(path, _)| path.rsplit_once('/')) {
        *folders.entry(folder).or_default() += 1;
    }
    for (folder, files) in folders {
        found.above(15, files, folder, "source files: group them in folders");
    }
}

/// Structs with too many fields.
pub(super) fn structs(tree: &Tree, found: &mut Breaches) {
    for (file, facts) in &tree.facts {
        found.items(16, file, &facts.structs, "fields");
    }
}

/// Functions that are too long, but for those whose body is one table.
pub(super) fn functions(tree: &Tree, found: &mut Breaches) {
    for (file, facts) in &tree.facts {
        found.items(60, file, &facts.functions, "lines");
    }
}

/// Types whose own `impl` blocks are in too many files.
pub(super) fn impls(tree: &Tree, found: &mut Breaches) {
    let mut types = BTreeMap::<String, usize>::new();
    for (path, facts) in tree.product() {
        for name in &facts.impls {
            let key = format!("{}: impl {name}", tree.package_of(path));
            *types.entry(key).or_default() += 1;
        }
    }
    for (key, files) in types {
        found.above(6, files, &key, "files: make its parts types of their own");
    }
}
