//! The README states no measurement that the page on performance lacks.

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

/// Numbers of a README's section on speed that the page on performance lacks.
fn unmeasured(readme: &str) -> Vec<String> {
    let measured = numbers(PERFORMANCE);
    let stated = numbers(below(readme, "\n## How fast\n"));
    assert!(stated.len() >= 5, "too few numbers: {stated:?}");
    stated
        .difference(&measured)
        .map(|number| (*number).to_owned())
        .collect()
}

#[test]
fn readme_numbers_are_measured() {
    assert_eq!(unmeasured(README), Vec::<String>::new());
}

#[test]
fn a_readme_number_that_was_never_measured_is_found() {
    let steps = "23,579";
    assert!(README.contains(steps));
    assert_eq!(unmeasured(&README.replace(steps, "23,580")), ["23,580"]);
}
