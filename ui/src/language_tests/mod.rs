//! Languages of the window.
//!
//! | module | content |
//! | --- | --- |
//! | `sources` | the sentences of the sources, and their translations |
//! | `shown` | the window in each language |

mod shown;
mod sources;

use maulstick_ui_kit::language::{choose, chosen};

use crate::settings::preferences::{Preferences, WindowPreferences};

#[test]
fn the_choice_of_a_language_is_remembered() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("window.toml");
    let preferences = Preferences::of_window(WindowPreferences {
        language: Some("de".to_owned()),
        ..WindowPreferences::default()
    });
    preferences.keep(&path).expect("kept");
    let read = Preferences::read(&path).expect("read");
    choose(read.window.language.as_deref());
    assert_eq!(
        chosen().map(|language| language.name.as_str()),
        Some("Deutsch")
    );
}
