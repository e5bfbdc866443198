//! Map of bounded size by name, for records of senders whose number is not limited.

use std::collections::BTreeMap;

/// Largest number of names that are remembered.
const NAMES: usize = 256;

/// Values of the 256 names that were set last.
#[derive(Clone, Debug)]
pub struct Recent<V> {
    values: BTreeMap<String, (u64, V)>,
    sets: u64,
}

impl<V> Default for Recent<V> {
    fn default() -> Self {
        Self {
            values: BTreeMap::new(),
            sets: 0,
        }
    }
}

impl<V> Recent<V> {
    /// Sets the value of a name; of too many names the one that was set longest ago is forgotten.
    pub fn set(&mut self, name: &str, value: V) {
        if self.values.len() >= NAMES && !self.values.contains_key(name) {
            let oldest = self.values.iter().min_by_key(|(_, (set, _))| *set);
            if let Some(oldest) = oldest.map(|(name, _)| name.clone()) {
                self.values.remove(&oldest);
            }
        }
        self.sets += 1;
        self.values.insert(name.to_owned(), (self.sets, value));
    }

    /// The value of a name.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&V> {
        self.values.get(name).map(|(_, value)| value)
    }

    /// The value of a name, to be changed.
    pub fn get_mut(&mut self, name: &str) -> Option<&mut V> {
        self.values.get_mut(name).map(|(_, value)| value)
    }

    /// True if a name has a value.
    #[must_use]
    pub fn has(&self, name: &str) -> bool {
        self.values.contains_key(name)
    }

    /// Forgets a name.
    pub fn remove(&mut self, name: &str) {
        self.values.remove(name);
    }

    /// All names in order, with their values.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &V)> {
        let values = self.values.iter();
        values.map(|(name, (_, value))| (name.as_str(), value))
    }

    /// All values in the order of their names, to be changed.
    pub fn values_mut(&mut self) -> impl Iterator<Item = &mut V> {
        self.values.values_mut().map(|(_, value)| value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_name_set_longest_ago_is_forgotten() {
        let mut recent = Recent::default();
        for name in 0..NAMES {
            recent.set(&format!("{name}"), name);
        }
        recent.set("0", 7);
        recent.set("one more", 8);
        assert_eq!(
            (recent.get("0"), recent.get("one more")),
            (Some(&7), Some(&8))
        );
        assert!(!recent.has("1"));
        assert_eq!(recent.iter().count(), NAMES);
    }
}
