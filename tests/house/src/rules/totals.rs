//! Sizes of the product and of its documents, with their goals.

use super::Breaches;
use crate::tree::{Tree, below};

/// Folders whose Rust lines count, those that `./run` builds and tests apart; with their goals.
const LINES: [(&str, &str, usize); 3] = [
    ("product", "", 145_000),
    ("ui", "ui", 22_000),
    ("launch", "launch", 14_000),
];
/// Ends of the paths of documents whose words count, with their goals.
const WORDS: [(&str, &str, usize); 4] = [
    ("README", "README.md", 700),
    ("ARCHITECTURE", "ARCHITECTURE.md", 2_500),
    ("performance", "docs/performance.md", 1_500),
    ("all documents", ".md", 30_000),
];

/// The document that the program writes.
const GENERATED: &str = "docs/commands.md";

/// Sizes above their goals. A size is given in hundredths of its goal, so that a few lines more are no breach.
pub(super) fn totals(tree: &Tree, found: &mut Breaches) {
    let mut add = |name: &str, size: usize, goal: usize, unit: &str| {
        let key = format!("{name}, goal {goal} {unit}");
        found.above(goal, size.next_multiple_of(goal / 100), &key, unit);
    };
    for (name, folder, goal) in LINES {
        add(name, lines(tree, folder), goal, "lines");
    }
    for (name, end, goal) in WORDS {
        add(name, words(tree, end), goal, "words");
    }
}

fn lines(tree: &Tree, folder: &str) -> usize {
    let packages = tree.built_with("maulstick");
    let files = tree.product().filter(|(path, _)| {
        let within = folder.is_empty() || below(path, folder);
        within && packages.contains(tree.package_of(path))
    });
    files
        .map(|(path, facts)| tree.texts[path].lines().count() - facts.test_lines)
        .sum()
}

fn words(tree: &Tree, end: &str) -> usize {
    let is_document =
        |path: &str| path.ends_with(end) && !below(path, "tests") && path != GENERATED;
    let documents = tree.texts.iter().filter(|(path, _)| is_document(path));
    documents
        .map(|(_, text)| text.split_whitespace().count())
        .sum()
}
