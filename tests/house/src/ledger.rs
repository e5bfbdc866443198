//! The ledger of known breaches, which may only become fewer.

use std::collections::BTreeMap;

use anyhow::Result;
use serde::{Deserialize, Serialize};

use crate::rules::{Breach, Breaches, RULES, Rule};
use crate::tree::Tree;

const TAKE_OUT: &str = "take it out: cargo run -p maulstick-house";
const PATH: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/ledger.toml");
const HEAD: &str = "# Known breaches of the rules of the house: how many, or how large. They may \
                    only become fewer.\n# Written by `cargo run -p maulstick-house`.\n\n";
/// An entry that could be less by this part of its size comes down.
const ROOM: usize = 20;

/// How many breaches there are of each rule, or how large they are, by their keys.
#[derive(Clone, Debug, Default, Deserialize, PartialEq, Serialize)]
#[serde(transparent)]
pub struct Ledger(BTreeMap<String, BTreeMap<String, usize>>);

impl Ledger {
    /// Reads it; one that is not there is empty.
    ///
    /// # Errors
    /// Where it is not readable or not a ledger.
    pub fn read() -> Result<Self> {
        match std::fs::read_to_string(PATH) {
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(Self::default()),
            text => Ok(toml::from_str(&text?)?),
        }
    }

    /// Writes it.
    ///
    /// # Errors
    /// Where its file cannot be written.
    pub fn write(&self) -> Result<()> {
        let text = toml::to_string(self)?;
        Ok(std::fs::write(PATH, format!("{HEAD}{text}"))?)
    }

    /// The ledger of a tree as it is.
    #[must_use]
    pub fn of(tree: &Tree) -> Self {
        let mut ledger = Self::default();
        for rule in &RULES {
            for Breach { key, size, .. } in Breaches::of(rule, tree).0 {
                let entries = ledger.0.entry(rule.0.to_owned()).or_default();
                *entries.entry(key).or_default() += size;
            }
        }
        ledger
    }

    /// What is wrong with a tree by a rule: breaches that are not here, and entries that are too large.
    #[must_use]
    pub fn complaints(&self, rule: &Rule, tree: &Tree) -> Vec<String> {
        let (mut now, mut all) = (BTreeMap::<&str, usize>::new(), Vec::new());
        let breaches = Breaches::of(rule, tree).0;
        for Breach { key, size, .. } in &breaches {
            *now.entry(key).or_default() += size;
        }
        for Breach { key, what, .. } in &breaches {
            let known = self.size(rule.0, key);
            if now[&key[..]] > known {
                all.push(format!("{what} (the ledger has {known})"));
            }
        }
        for (key, size) in self.0.get(rule.0).into_iter().flatten() {
            let now = now.get(&key[..]).copied().unwrap_or_default();
            if now + size / ROOM < *size {
                all.push(format!("'{key}' is {now}, not {size}; {TAKE_OUT}"));
            }
        }
        all
    }

    /// Entries that another ledger has not, or has smaller.
    #[must_use]
    pub fn more_than(&self, other: &Self) -> Vec<String> {
        let mut more = Vec::new();
        for (rule, entries) in &self.0 {
            for (key, size) in entries {
                if *size > other.size(rule, key) {
                    more.push(format!("{rule}: {key} = {size}"));
                }
            }
        }
        more
    }

    fn size(&self, rule: &str, key: &str) -> usize {
        let size = self.0.get(rule).and_then(|entries| entries.get(key));
        size.copied().unwrap_or_default()
    }
}
