//! The rules, each a function from a tree to its breaches.

mod names;
mod shape;
mod totals;
mod words;

use crate::facts::Measured;
use crate::tree::Tree;

/// A rule: its name in the ledger, and what finds its breaches.
pub type Rule = (&'static str, fn(&Tree, &mut Breaches));

/// All rules.
pub const RULES: [Rule; 15] = [
    ("cycles", shape::cycles),
    ("files", shape::files),
    ("folders", shape::folders),
    ("structs", shape::structs),
    ("functions", shape::functions),
    ("impls", shape::impls),
    ("models", names::models),
    ("graphics", names::graphics),
    ("edits", names::edits),
    ("clocks", names::clocks),
    ("layers", names::layers),
    ("parsed-words", words::parsed),
    ("asserted-words", words::asserted),
    ("text-errors", words::errors),
    ("totals", totals::totals),
];

/// A breach of a rule.
#[derive(Debug)]
pub struct Breach {
    /// Its name in the ledger, which survives edits elsewhere in the file.
    pub key: String,
    /// How large it is; 1 for one of several that are counted.
    pub size: usize,
    /// Where and what it is, and what to do about it.
    pub what: String,
}

/// The breaches of a rule.
#[derive(Debug, Default)]
pub struct Breaches(pub Vec<Breach>);

impl Breaches {
    /// The breaches of a rule in a tree.
    #[must_use]
    pub fn of(rule: &Rule, tree: &Tree) -> Self {
        let mut found = Self::default();
        rule.1(tree, &mut found);
        found
    }

    fn add(&mut self, key: &str, size: usize, what: String) {
        let key = key.to_owned();
        self.0.push(Breach { key, size, what });
    }

    /// Adds one of those that are counted for a file.
    fn one(&mut self, file: &str, line: usize, what: &str) {
        self.add(file, 1, format!("{file}:{line}: {what}"));
    }

    /// Adds what is larger than this most.
    fn above(&mut self, most: usize, size: usize, key: &str, what: &str) {
        if size > most {
            self.add(key, size, format!("{key}: {size} {what} (at most {most})"));
        }
    }

    /// Adds those of a file's items that are larger than this most.
    fn items(&mut self, most: usize, file: &str, items: &[Measured], what: &str) {
        for Measured { name, line, size } in items {
            let what = format!("{what} at line {line}: make it several");
            self.above(most, *size, &format!("{file}::{name}"), &what);
        }
    }
}
