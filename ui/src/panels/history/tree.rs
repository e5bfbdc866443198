//! Versions as a tree: each below the one it was painted from.

use maulstick_types::scene::NamedVersion;

/// The versions from the top, with the depth of each. One whose parent was deleted begins a new tree.
#[must_use]
pub(super) fn in_order(versions: &[NamedVersion]) -> Vec<(usize, &NamedVersion)> {
    let mut order: Vec<(usize, &NamedVersion)> = Vec::new();
    let known = |name: &str| versions.iter().any(|version| version.name == name);
    for root in versions.iter().filter(|version| !known(&version.parent)) {
        below(versions, root, &mut order);
    }
    // No version is left out, whatever its parents say.
    for version in versions {
        below(versions, version, &mut order);
    }
    order
}

/// Puts a version and all that were painted from it at the end, if it is not there yet.
fn below<'a>(
    versions: &'a [NamedVersion],
    root: &'a NamedVersion,
    order: &mut Vec<(usize, &'a NamedVersion)>,
) {
    let mut waiting = vec![(0, root)];
    while let Some((depth, version)) = waiting.pop() {
        if order.iter().any(|(_, placed)| placed.name == version.name) {
            continue;
        }
        order.push((depth, version));
        let children = versions.iter().rev();
        let children = children.filter(|child| child.parent == version.name);
        waiting.extend(children.map(|child| (depth + 1, child)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn versions(names: &[(&str, &str)]) -> Vec<NamedVersion> {
        let version = |(name, parent): &(&str, &str)| NamedVersion {
            name: (*name).to_owned(),
            parent: (*parent).to_owned(),
            here: false,
        };
        names.iter().map(version).collect()
    }

    fn drawn(names: &[(&str, &str)]) -> Vec<String> {
        let versions = versions(names);
        let order = in_order(&versions).into_iter();
        order
            .map(|(depth, version)| format!("{depth}{}", version.name))
            .collect()
    }

    #[test]
    fn each_version_follows_the_one_that_it_was_painted_from() {
        let names = [
            ("cold", "sketch"),
            ("dark", "cold"),
            ("sketch", ""),
            ("warm", "sketch"),
        ];
        assert_eq!(drawn(&names), ["0sketch", "1cold", "2dark", "1warm"]);
    }

    #[test]
    fn no_version_is_lost_whatever_its_parent_is() {
        assert_eq!(drawn(&[("a", "gone"), ("b", "a")]), ["0a", "1b"]);
        assert_eq!(drawn(&[("a", "b"), ("b", "a")]), ["0a", "1b"]);
        assert_eq!(drawn(&[("a", "a")]), ["0a"]);
        assert!(drawn(&[]).is_empty());
    }
}
