//! The nearest of the known names to one that is not known.

/// Least letters of a name that counts as a part of another.
const PART: usize = 3;

/// The one of `names` that was probably meant by `name`, whatever its case: the most alike (Jaro and Winkler) of those
/// in which at most a third of the letters differs (Damerau and Levenshtein, optimal string alignment), or of which one
/// contains the other. `None` if there is no such name.
#[must_use]
pub fn nearest<'a>(name: &str, names: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let name = name.to_lowercase();
    let near = |other: &str| {
        let other = other.to_lowercase();
        let letters = [name.chars().count(), other.chars().count()];
        let part = letters.iter().all(|count| *count >= PART)
            && (other.contains(&name) || name.contains(&other));
        part || 3 * strsim::osa_distance(&name, &other) <= letters[0].max(letters[1])
    };
    let likeness = |other: &str| strsim::jaro_winkler(&other.to_lowercase(), &name);
    names
        .into_iter()
        .filter(|other| near(other))
        .max_by(|a, b| likeness(a).total_cmp(&likeness(b)))
}

/// Help for a name that is none of `names`: the nearest one, if any is near, and all of them.
#[must_use]
pub fn choice<'a>(name: &str, names: impl IntoIterator<Item = &'a str>) -> String {
    let names: Vec<&str> = names.into_iter().collect();
    if names.is_empty() {
        return "there is none".to_owned();
    }
    let all = names.join(", ");
    match nearest(name, names) {
        Some(nearest) => format!("did you mean '{nearest}'? There are: {all}"),
        None => format!("there are: {all}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NAMES: [&str; 5] = ["Cobalt Blue", "Titanium White", "round", "D50", "D65"];

    #[test]
    fn a_misspelt_name_finds_its_neighbour_and_another_one_none() {
        assert_eq!(nearest("colbat blue", NAMES), Some("Cobalt Blue"));
        assert_eq!(nearest("Ruond", NAMES), Some("round"));
        assert_eq!(nearest("white", NAMES), Some("Titanium White"));
        assert_eq!(nearest("D66", NAMES), Some("D65"));
        for far in ["zzz", "x", "", "sable", "Vantablack", "undo"] {
            assert_eq!(nearest(far, NAMES), None, "{far}");
        }
        assert_eq!(nearest("x", []), None);
    }

    #[test]
    fn all_names_are_told_and_only_a_near_one_is_proposed() {
        assert_eq!(
            choice("fro", ["from", "to"]),
            "did you mean 'from'? There are: from, to"
        );
        assert_eq!(choice("whither", ["from", "to"]), "there are: from, to");
        assert_eq!(choice("whither", []), "there is none");
    }
}
