//! Patterns of topics: `*` for one part of a topic, `**` for any number of them.

/// True if a topic, without the rig's prefix, is one that a pattern means.
#[must_use]
pub fn matches(pattern: &str, topic: &str) -> bool {
    let pattern: Vec<&str> = pattern.split('/').collect();
    let topic: Vec<&str> = topic.split('/').collect();
    parts_match(&pattern, &topic)
}

fn parts_match(pattern: &[&str], topic: &[&str]) -> bool {
    match (pattern.split_first(), topic.split_first()) {
        (None, None) => true,
        (Some((&"**", rest)), _) => (0..=topic.len()).any(|from| parts_match(rest, &topic[from..])),
        (Some((part, rest)), Some((own, others))) => {
            (*part == "*" || part == own) && parts_match(rest, others)
        }
        _ => false,
    }
}

/// The parts of a topic for which the `*` of a pattern stand; `None` if the pattern, which has no `**`, does not mean it.
#[must_use]
pub fn parts<'a>(pattern: &str, topic: &'a str) -> Option<Vec<&'a str>> {
    matches(pattern, topic).then(|| {
        let pairs = pattern.split('/').zip(topic.split('/'));
        pairs
            .filter(|(part, _)| *part == "*")
            .map(|(_, own)| own)
            .collect()
    })
}

#[cfg(test)]
mod tests {
    use super::{matches, parts};

    #[test]
    fn a_star_has_a_part() {
        assert_eq!(
            parts("stylus/*/sample", "stylus/pen/sample"),
            Some(vec!["pen"])
        );
        assert_eq!(parts("*/*", "a/b"), Some(vec!["a", "b"]));
        assert_eq!(parts("stylus/*/sample", "stylus/pen/info"), None);
    }

    #[test]
    fn stars_stand_for_parts() {
        for (pattern, fits, others) in [
            ("stylus/*/sample", "stylus/pen/sample", "stylus/pen/info"),
            ("**", "scene", ""),
            ("**/state", "brush/main/state", "brush/main/look"),
            ("brush/**", "brush/main/look", "brushes/main"),
            ("scene", "scene", "scene/a"),
            ("*", "scene", "paint/status"),
        ] {
            assert!(matches(pattern, fits), "{pattern} {fits}");
            assert!(
                pattern == "**" || !matches(pattern, others),
                "{pattern} {others}"
            );
        }
    }
}
