//! What to do about something that is wrong: the name that was meant, and advice that each front end has its own words
//! for.

use std::fmt;

use crate::wire::define::wire_enum;

wire_enum! {
    /// Advice with a refusal. A window, a command line and a script say it in their own words, by a table from these
    /// variants; who has none says it as `Display` does.
    #[derive(Eq)]
    pub enum Advice {
        /// Words that hold everywhere.
        Say {
            /// The words.
            help: String,
        },
        /// Stop the drying, or wait for its end.
        StopDrying,
        /// Begin a drying.
        BeginDrying,
        /// Dry wet paint first.
        DryFirst,
        /// Make a layer as opaque as it was laid.
        FullOpacity {
            /// Number of the layer.
            layer: u32,
        },
        /// Look at the list of paints.
        ListPaints,
        /// Undo the newest step of all first.
        UndoNewest,
        /// Take out of a damaged painting what is whole.
        Recover,
        /// Stop the export, or wait for its end.
        StopExport,
        /// Begin an export.
        BeginExport,
        /// See what each format takes.
        ListFormats,
        /// Give another name, or say that the file that is there may go.
        Replace,
        /// Save the painting first, or say that it may go.
        SaveOrForget,
        /// Name a painting's file, or a new one; of a damaged one take out what is whole.
        NamePainting,
        /// Check the path, or begin a painting there.
        BeginPainting,
        /// Start a rig, or name another one.
        StartRig,
        /// Compare with the default settings.
        DefaultSettings,
    }
}

impl Advice {
    /// Advice in words.
    #[must_use]
    pub fn say(help: impl Into<String>) -> Self {
        Self::Say { help: help.into() }
    }
}

impl fmt::Display for Advice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Say { help } => help,
            Self::StopDrying => "wait for its end, or stop it",
            Self::BeginDrying => "begin a drying first",
            Self::DryFirst => "dry wet paint first",
            Self::FullOpacity { layer } => {
                return write!(f, "set the opacity of layer {layer} to 1 first");
            }
            Self::ListPaints => "choose one of the paints of the rig",
            Self::UndoNewest => "undo that first",
            Self::Recover => "recover from the file what is whole",
            Self::StopExport => "wait for its end, or stop it",
            Self::BeginExport => "begin an export first",
            Self::ListFormats => "see what each format takes",
            Self::Replace => "give another name, or say that the one that is there may go",
            Self::SaveOrForget => "save it first, or say that it may go",
            Self::NamePainting => {
                "name the file of a painting, or a new one; of a damaged painting recover what is whole"
            }
            Self::BeginPainting => "check the path, or begin a painting there",
            Self::StartRig => "start one, or name another one",
            Self::DefaultSettings => "compare with the default settings",
        })
    }
}

/// Names of fewer letters are no part of others by design.
const PART: usize = 3;

/// The one of `names` that `name` is a slip of, whatever its case: the likest (Jaro and Winkler) of those in
/// which a third of the letters at most is otherwise (Damerau and Levenshtein, optimal string alignment),
/// or of which one holds the other. None where none is so near.
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

/// Help for a name that is none of `names`: the nearest, if one is near, and all of them.
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
