//! What was meant by a misspelt name.

/// The one of `names` that is nearest to `name` (Jaro and Winkler), whatever its case; none of none.
#[must_use]
pub fn nearest<'a>(name: &str, names: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let name = name.to_lowercase();
    let likeness = |other: &str| strsim::jaro_winkler(&other.to_lowercase(), &name);
    names
        .into_iter()
        .max_by(|a, b| likeness(a).total_cmp(&likeness(b)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_misspelt_name_finds_its_neighbour() {
        let names = ["Cobalt Blue", "Titanium White", "round"];
        assert_eq!(nearest("colbat blue", names), Some("Cobalt Blue"));
        assert_eq!(nearest("Ruond", names), Some("round"));
        assert_eq!(nearest("x", []), None);
    }
}
