//! What the documents say twice is the same.

use std::collections::BTreeSet;

const README: &str = include_str!("../README.md");
const PERFORMANCE: &str = include_str!("../docs/performance.md");

/// The numbers of a text, as they are written.
fn numbers(text: &str) -> BTreeSet<&str> {
    let part = |c: char| c.is_ascii_digit() || c == '.' || c == ',';
    text.split(|c: char| !part(c))
        .map(|word| word.trim_end_matches(['.', ',']))
        .filter(|word| word.contains(|c: char| c.is_ascii_digit()))
        .collect()
}

/// The part of a text below a heading.
fn below<'a>(text: &'a str, heading: &str) -> &'a str {
    let (_, rest) = text.split_once(heading).expect("a heading");
    rest.split_once("\n## ").map_or(rest, |(part, _)| part)
}

#[test]
fn the_readme_has_the_numbers_of_the_page_on_performance() {
    let said = numbers(below(README, "\n## How fast\n"));
    let measured = numbers(PERFORMANCE);
    assert!(said.len() > 12 && said.contains("23,579"), "{said:?}");
    let unknown: Vec<_> = said.difference(&measured).collect();
    assert!(unknown.is_empty(), "not measured: {unknown:?}");
    assert!(!measured.contains("23,580"), "a fault would pass");
}
