//! Rules of who may name whom.

use std::collections::BTreeSet;

use super::Breaches;
use crate::facts::Facts;
use crate::tree::{Tree, below};

/// Folder of the registry and of the models, a folder each.
const MODELS: &str = "sim/models";
/// File of a model's entry, below its folder.
const ENTRY: &str = "/src/entry.rs";
const GRAPHICS: &str = "sim/gpu";
/// A model whose name is that of a brush's mode as well, in texts.
const ALSO_A_MODE: &str = "marker";
/// Folder of the edits, one file each.
const EDITS: &str = "sim/painting/src/edits";
/// Folder of the edits' widgets.
const WIDGETS: &str = "ui/src/panels";

/// Names of the models: their folders.
fn model_names(tree: &Tree) -> Vec<&str> {
    let folders = tree
        .texts
        .keys()
        .filter_map(|path| path.strip_suffix(ENTRY));
    let names = folders.filter_map(|folder| folder.strip_prefix(MODELS)?.strip_prefix('/'));
    names.collect()
}

/// Whether a text is a model's name, or has it beside the word "model".
fn names_one(text: &str, models: &[&str]) -> bool {
    let words: Vec<&str> = text.split(|c: char| !c.is_alphanumeric()).collect();
    let named = |word: &&str| *word != ALSO_A_MODE && models.contains(word);
    (words.len() == 1 || words.contains(&"model")) && words.iter().any(named)
}

/// Whether a path's segment names a model.
type Names = fn(&str, &str) -> bool;

/// Adds where a file names models: in texts, and in paths.
fn add(file: &str, facts: &Facts, models: &[&str], is: Names, found: &mut Breaches) {
    let named = |segment: &String| models.iter().any(|model| is(segment, model));
    let mut all = facts.texts.clone();
    all.retain(|(text, _)| names_one(text, models));
    for (path, line) in facts
        .paths()
        .into_iter()
        .filter(|(path, _)| path.iter().any(named))
    {
        all.push((path.join("::"), line));
    }
    for (name, line) in all {
        let what = format!("{name:?} names a model: put it behind its entry in the registry");
        found.one(file, line, &what);
    }
}

/// Models' names outside their folders and the registry; a path names one by its crate.
pub(super) fn models(tree: &Tree, found: &mut Breaches) {
    let models = model_names(tree);
    let is_crate = |name: &str, model: &str| {
        let rest = name.strip_prefix("maulstick_").unwrap_or_default();
        rest.split('_').next() == Some(model)
    };
    for (file, facts) in tree.product() {
        if !below(file, MODELS) && !below(file, GRAPHICS) {
            add(file, facts, &models, is_crate, found);
        }
    }
}

/// Models' names in the graphics crate, and models that it is built with.
pub(super) fn graphics(tree: &Tree, found: &mut Breaches) {
    let models = model_names(tree);
    let has = |name: &str, model: &str| model != ALSO_A_MODE && name.to_lowercase().contains(model);
    for (file, facts) in &tree.facts {
        let is_product = file.contains("/src/") || file.ends_with("/build.rs");
        if below(file, GRAPHICS) && is_product {
            add(file, facts, &models, has, found);
        }
    }
    let package = tree.packages.get(GRAPHICS);
    for other in package.map_or_else(BTreeSet::new, |package| tree.built_with(&package.name)) {
        if below(other, MODELS) {
            let what = format!("it is built with {other}: turn the dependency round");
            found.one(GRAPHICS, 0, &what);
        }
    }
}

/// Edits that files name besides their own and their widgets: each edit once in a file.
pub(super) fn edits(tree: &Tree, found: &mut Breaches) {
    let files = tree.texts.keys().filter(|path| below(path, EDITS));
    // What lies beside their folders serves all of them.
    let depth = EDITS.matches('/').count() + 2;
    let files = files.filter(|path| path.matches('/').count() == depth);
    let names = files.filter_map(|path| path.rsplit('/').next()?.strip_suffix(".rs"));
    let edits: BTreeSet<String> = names.map(|name| name.replace('_', "")).collect();
    let is_type = |name: &str| name.starts_with(char::is_uppercase);
    let is_edit = |name: &str| is_type(name) && edits.contains(&name.to_lowercase());
    for (file, facts) in tree.product() {
        if below(file, WIDGETS) || file.contains("/edits/") {
            continue;
        }
        let mut named = BTreeSet::new();
        for (path, line) in facts.paths() {
            let is_start = |name: &&String| matches!(name.as_str(), "edits" | "Edit");
            let mut names = path.iter().skip_while(|name| !is_start(name));
            let edit = names.find(|name| is_edit(name)).cloned();
            if let Some(edit) = edit.filter(|edit| named.insert(edit.clone())) {
                let what = format!("it names the edit {edit}: do it for all, or there");
                found.one(file, line, &what);
            }
        }
    }
}

/// Processes and clocks in the simulation.
pub(super) fn clocks(tree: &Tree, found: &mut Breaches) {
    let ends = ["Instant::now", "SystemTime::now"];
    for (file, facts) in tree.product().filter(|(file, _)| below(file, "sim")) {
        for (path, line) in facts.paths() {
            let path = path.join("::");
            if path.starts_with("std::process") || ends.iter().any(|end| path.ends_with(end)) {
                let what = format!("{path} in the simulation: take it from messages");
                found.one(file, line, &what);
            }
        }
    }
}

/// Packages of messages that are built with the simulation.
pub(super) fn layers(tree: &Tree, found: &mut Breaches) {
    for (folder, package) in &tree.packages {
        for other in tree.built_with(&package.name) {
            if below(folder, "msgs") && below(other, "sim") {
                let what = format!("it is built with {other}: turn the dependency round");
                found.one(folder, 0, &what);
            }
        }
    }
}
