//! Load of a brush: a paint or mixture, another one beside it, and thinner in both.

use maulstick_optics::{PaintLibrary, THINNER, thinned};
use maulstick_painting::edits::common;
use maulstick_rig::UserError;
use maulstick_types::Mixture;
use maulstick_types::command::Command;
use maulstick_types::values::ThinnerShare;
use serde::{Deserialize, Serialize};

/// Load of a brush.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct BrushLoad {
    /// A mixture such as "Cobalt Blue=0.7,Titanium White=0.3", or a paint.
    pub paint: String,
    /// Load of the other half of the brush; `None` if it is the same.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub beside: Option<String>,
    /// Share of thinner in both, 0 to [`ThinnerShare::MOST`].
    pub thinner: f64,
}

impl BrushLoad {
    /// A mixture of it, thinned.
    fn mixture(&self, text: &str, library: &PaintLibrary) -> Result<Mixture, UserError> {
        let mixture = read(text, library)?;
        Ok(thinned(&mixture, self.share()))
    }

    /// Share of thinner in both.
    #[must_use]
    pub fn share(&self) -> ThinnerShare {
        let most = ThinnerShare::MOST.get();
        ThinnerShare::new(self.thinner.clamp(0.0, most)).unwrap_or_default()
    }

    /// The command that loads a brush so.
    ///
    /// # Errors
    /// A [`UserError`] that quotes what is no mixture of the paints.
    pub fn command(&self, brush: &str, library: &PaintLibrary) -> Result<Command, UserError> {
        let mixture = self.mixture(&self.paint, library)?;
        let beside = self.beside.as_ref();
        let beside = beside.map(|other| self.mixture(other, library));
        Ok(common::load(brush, mixture, beside.transpose()?)?.into())
    }
}

/// A mixture as a painter writes it, of the paints of a library.
///
/// # Errors
/// A [`UserError`] that says what is wrong with it.
pub(crate) fn read(text: &str, library: &PaintLibrary) -> Result<Mixture, UserError> {
    let help =
        tr!("a paint's name, or a mixture by volume such as \"2 Cobalt Blue, 1 Titanium White\"");
    let mixture = text.trim().parse::<Mixture>();
    let mixture = mixture.map_err(|error| UserError::usage(error.to_string()).help(help))?;
    library
        .check(&mixture)
        .map_err(|error| UserError::usage(error.to_string()).help(help))
}

/// A mixture as a painter writes it; [`read`] reads it.
#[must_use]
pub(crate) fn written(mixture: &Mixture) -> String {
    match &mixture.parts[..] {
        [part] => part.paint.clone(),
        _ => mixture.to_string(),
    }
}

/// A mixture as a painter reads it: its paints, with per cent where they are several.
#[must_use]
pub(crate) fn words(mixture: &Mixture) -> String {
    if let [part] = &mixture.parts[..] {
        return part.paint.clone();
    }
    let mut said = 0.0;
    let mut share = 0.0;
    // Each is rounded with what the ones before it left over, so that they make 100.
    let words = mixture.parts.iter().map(|part| {
        share += part.share;
        let percent = (share * 100.0).round() - said;
        said += percent;
        format!("{} {percent} %", part.paint)
    });
    words.collect::<Vec<_>>().join(", ")
}

/// Names of paints that complete the text after the last comma; empty if that is complete or empty.
#[must_use]
pub(crate) fn completions<'a>(text: &str, library: &'a PaintLibrary, most: usize) -> Vec<&'a str> {
    let typed = last_name(text).trim();
    let paints = library.paints().iter();
    let thinner = library.find(THINNER).into_iter();
    let all: Vec<_> = paints.chain(thinner).collect();
    let is_whole = |name: &str| name.eq_ignore_ascii_case(typed);
    if typed.is_empty() || typed.contains('=') || all.iter().any(|paint| is_whole(&paint.name)) {
        return Vec::new();
    }
    let found = all
        .iter()
        .filter(|paint| maulstick_ui_kit::swatches::matches(paint, typed));
    found.map(|paint| paint.name.as_str()).take(most).collect()
}

/// The text with the name that is being typed made whole.
#[must_use]
pub(crate) fn completed(text: &str, name: &str) -> String {
    let typed = last_name(text);
    let space = &typed[..typed.len() - typed.trim_start().len()];
    format!("{}{space}{name}", &text[..text.len() - typed.len()])
}

/// The name after the last comma, without its parts.
fn last_name(text: &str) -> &str {
    let part = text.rsplit(',').next().unwrap_or(text);
    match part.trim_start().split_once(char::is_whitespace) {
        Some((parts, name)) if parts.parse().is_ok_and(f64::is_finite) => name,
        _ => part,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn library() -> PaintLibrary {
        PaintLibrary::measured().expect("whole")
    }

    fn loading(paint: &str, beside: Option<&str>, thinner: f64) -> BrushLoad {
        BrushLoad {
            paint: paint.into(),
            beside: beside.map(str::to_owned),
            thinner,
        }
    }

    #[test]
    fn a_load_is_one_mixture_or_two_and_thinned() {
        let loaded = |loading: BrushLoad| {
            let command = loading.command("main", &library()).expect("paints");
            let Command::Edit(edit) = command else {
                panic!("{command:?}")
            };
            common::loaded(&edit).expect("a load")
        };
        let pure = loaded(loading("cobalt blue", None, 0.0));
        let expected = ("main".to_owned(), Mixture::pure("Cobalt Blue"), None);
        assert_eq!(pure, expected);
        let (_, left, beside) = loaded(loading(
            "Cobalt Blue=0.5,Thinner=0.5",
            Some("Bone Black"),
            0.5,
        ));
        let right = beside.expect("two halves");
        assert_eq!(left.to_string(), "Cobalt Blue=0.25,Thinner=0.75");
        assert_eq!(right.to_string(), "Bone Black=0.5,Thinner=0.5");
        assert_eq!(left.check(), Ok(()));
        assert_eq!(loading("", None, f64::NAN).share(), ThinnerShare::NONE);
        assert_eq!(loading("", None, 7.0).share(), ThinnerShare::MOST);
    }

    #[test]
    fn what_is_no_mixture_is_told_with_help() {
        let error = |paint: &str| {
            let fault = loading(paint, None, 0.0).command("main", &library());
            fault.expect_err(paint)
        };
        for (wrong, quoted) in [
            ("Colbat Blue", "'Cobalt Blue'"),
            ("Cobalt Blue=0", "'0'"),
            ("", ""),
        ] {
            let fault = error(wrong);
            assert!(
                fault.help.is_some() && fault.to_string().contains(quoted),
                "{fault}"
            );
        }
        let beside = loading("Cobalt Blue", Some("x=1"), f64::NAN);
        assert!(beside.command("main", &library()).is_err());
    }

    #[test]
    fn a_name_is_completed_where_it_is_typed() {
        let library = library();
        let names = |text: &str| completions(text, &library, 3);
        assert!(names("ultra").contains(&"Ultramarine Blue"));
        assert!(names("Cobalt Blue=0.5, PW6").contains(&"Titanium White"));
        assert!(names("thin").contains(&THINNER));
        for whole in ["", "Cobalt Blue", "Cobalt Blue=0.5", "Cobalt Blue, "] {
            assert!(names(whole).is_empty(), "{whole}");
        }
        assert_eq!(names("b").len(), 3);
        let text = completed("Cobalt Blue=0.5, tit", "Titanium White");
        assert_eq!(text, "Cobalt Blue=0.5, Titanium White");
        assert_eq!(completed("ul", "Ultramarine Blue"), "Ultramarine Blue");
        assert!(names("2 Cobalt Blue, 1 tit").contains(&"Titanium White"));
        let text = completed("2 Cobalt Blue, 1 tit", "Titanium White");
        assert_eq!(text, "2 Cobalt Blue, 1 Titanium White");
    }
}
