//! Walks the sources for sentences, and compares them with the languages.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use eframe::egui::Key;
use maulstick_appearance::ground::GROUNDS;
use maulstick_brush::file::quantities;
use maulstick_canvas::relief::tooth::Tooth;
use maulstick_rig::config::{ACTIONS, FORCES};
use maulstick_types::scene::{self, RULES};
use maulstick_types::values::{self, Quantity};
use maulstick_ui_kit::language::{FILES, Language, all};
use maulstick_window_pen::mouse::grip;

use crate::input::keys::{BINDINGS, HELD};
use crate::settings::brush_library::library;

/// Keys whose names are not the signs on them.
const NAMED_KEYS: [&str; 18] = [
    "Ctrl",
    "Shift",
    "Alt",
    "Space",
    "Tab",
    "Backspace",
    "Escape",
    "Enter",
    "Delete",
    "Insert",
    "Home",
    "End",
    "PageUp",
    "PageDown",
    "Up",
    "Down",
    "Left",
    "Right",
];

/// Hints of the numbers of panels that other crates define; those of the window are among its sentences.
const HELPS: [&str; 28] = [
    values::Share::HELP,
    values::OpacityFactor::HELP,
    values::ThinnerShare::HELP,
    values::FilmThickness::HELP,
    values::FilmLimit::HELP,
    values::StainThickness::HELP,
    values::MarkerFlow::HELP,
    values::Stiffness::HELP,
    values::Wetness::HELP,
    values::Zoom::HELP,
    values::Tilt::HELP,
    values::Turn::HELP,
    values::ForceShare::HELP,
    values::GuidanceShare::HELP,
    scene::Intensity::HELP,
    scene::Exposure::HELP,
    scene::Relief::HELP,
    scene::Softness::HELP,
    scene::Wavelengths::HELP,
    grip::MousePressure::HELP,
    grip::MouseTurn::HELP,
    quantities::HeadWidth::HELP,
    quantities::LoadFilm::HELP,
    quantities::LoadInside::HELP,
    quantities::Unevenness::HELP,
    quantities::Lift::HELP,
    quantities::Opening::HELP,
    quantities::Friction::HELP,
];

/// Use of a sentence: its English, and the names that the macro is given.
#[derive(Debug)]
struct Use {
    english: String,
    names: BTreeSet<String>,
    place: String,
}

/// All Rust sources below a folder, without tests.
fn sources(folder: &Path, found: &mut BTreeMap<String, String>) {
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        let name = path.file_name().expect("a name").to_string_lossy();
        if path.is_dir() {
            if !["tests", "test_support", "language_tests"].contains(&&*name) {
                sources(&path, found);
            }
        } else if name.ends_with(".rs") && name != "tests.rs" {
            let text = std::fs::read_to_string(&path).expect("text");
            let text = text.split("#[cfg(test)]\nmod tests {").next().expect("one");
            let lines = text.lines();
            let code = lines.filter(|line| !line.trim_start().starts_with("//"));
            let code: Vec<&str> = code.collect();
            found.insert(path.display().to_string(), code.join("\n"));
        }
    }
}

/// The text of a literal that begins behind its quote, and the code after it.
fn literal(code: &str) -> (String, &str) {
    let mut text = String::new();
    let mut letters = code.char_indices();
    while let Some((place, letter)) = letters.next() {
        match letter {
            '"' => return (text, &code[place + 1..]),
            '\\' => match letters.next().expect("an escape").1 {
                'n' => text.push('\n'),
                '\n' => {
                    let rest = letters.as_str();
                    let skipped = rest.len() - rest.trim_start().len();
                    letters.by_ref().take(skipped).for_each(drop);
                }
                other => text.push(other),
            },
            letter => text.push(letter),
        }
    }
    panic!("no end: {code}");
}

/// Names of the arguments behind a literal: `, name, other = value)`.
fn names(code: &str) -> BTreeSet<String> {
    let (mut depth, mut in_text) = (0, false);
    let mut parts = vec![String::new()];
    let mut letters = code.chars();
    while let Some(letter) = letters.next() {
        let part = parts.last_mut().expect("one");
        match letter {
            '\\' if in_text => drop(letters.next()),
            '"' => in_text = !in_text,
            _ if in_text => {}
            ')' if depth == 0 => break,
            '(' | '[' | '{' => depth += 1,
            ')' | ']' | '}' => depth -= 1,
            ',' if depth == 0 => parts.push(String::new()),
            _ if depth == 0 => part.push(letter),
            _ => {}
        }
    }
    let names = parts
        .iter()
        .map(|part| part.split('=').next().expect("one").trim());
    names
        .filter(|name| !name.is_empty())
        .map(str::to_owned)
        .collect()
}

fn uses_in(place: &str, code: &str) -> Vec<Use> {
    let mut found = Vec::new();
    for macro_name in ["tr!(", "tr_noop!("] {
        for (at, _) in code.match_indices(macro_name) {
            let is_other = |letter: char| letter.is_alphanumeric() || letter == '_';
            if code[..at].ends_with(is_other) {
                continue;
            }
            let rest = code[at + macro_name.len()..].trim_start();
            let Some(rest) = rest.strip_prefix('"') else {
                continue;
            };
            let (english, rest) = literal(rest);
            let names = match macro_name {
                "tr!(" => names(rest),
                _ => places(&english),
            };
            found.push(Use {
                english,
                names,
                place: place.to_owned(),
            });
        }
    }
    found
}

/// The sources of the window and of its kit.
fn all_sources() -> BTreeMap<String, String> {
    let mut found = BTreeMap::new();
    for folder in ["src", "kit/src"] {
        sources(
            &Path::new(env!("CARGO_MANIFEST_DIR")).join(folder),
            &mut found,
        );
    }
    found
}

fn uses() -> Vec<Use> {
    let found = all_sources();
    let files = found
        .iter()
        .filter(|(place, _)| !place.ends_with("language/mod.rs"));
    let mut uses: Vec<Use> = files
        .flat_map(|(place, code)| uses_in(place, code))
        .collect();
    let language = found
        .iter()
        .find(|(place, _)| place.ends_with("language/mod.rs"));
    let (place, code) = language.expect("the module");
    let code = &code[code.find("fn layer_name").expect("a function")..];
    uses.extend(uses_in(place, code));
    uses
}

/// Names of the places of a sentence.
fn places(text: &str) -> BTreeSet<String> {
    let parts = text.split('{').skip(1);
    parts
        .filter_map(|part| Some(part.split_once('}')?.0.to_owned()))
        .collect()
}

/// Every sentence that a language must have.
fn needed() -> BTreeSet<String> {
    let words = BINDINGS.iter().map(|binding| binding.words);
    let held = HELD.iter().flat_map(|(keys, words)| [*keys, *words]);
    let brushes = library()
        .iter()
        .flat_map(|file| [file.kind.as_str(), file.about.as_str()]);
    let grounds = GROUNDS.iter().map(|(name, _)| *name);
    let tables = words
        .chain(held)
        .chain(brushes)
        .chain(grounds)
        .chain(Tooth::names());
    let settings = FORCES.into_iter().chain(ACTIONS);
    let tables = tables.chain(settings).chain(HELPS).map(str::to_owned);
    tables
        .chain(NAMED_KEYS.map(|key| format!("key|{key}")))
        .chain(uses().into_iter().map(|used| used.english))
        .collect()
}

/// Missing and superfluous sentences of a language.
fn gaps(language: &Language, needed: &BTreeSet<String>) -> Vec<String> {
    // Words that are the same in many languages.
    let keys = Key::ALL.iter().map(|key| format!("key|{}", key.name()));
    let may: BTreeSet<String> = keys.chain(RULES.map(str::to_owned)).collect();
    let lacks = needed.iter().filter(|text| language.of(text).is_none());
    let lacks = lacks.map(|text| format!("lacks {text:?}"));
    let has = language.texts().map(|(english, _)| english);
    let unused = has.filter(|text| !needed.contains(*text) && !may.contains(*text));
    lacks
        .chain(unused.map(|text| format!("unused: {text:?}")))
        .collect()
}

/// Translations whose places are not those of their sentences.
fn misplaced(language: &Language) -> Vec<&str> {
    let wrong = language.texts();
    let wrong = wrong.filter(|(english, text)| places(english) != places(text));
    wrong.map(|(english, _)| english).collect()
}

#[test]
fn each_language_has_every_sentence_of_the_sources_and_no_other() {
    let needed = needed();
    assert!(needed.len() > 600, "{} sentences were found", needed.len());
    assert_eq!(all().len(), FILES.len(), "a file cannot be read");
    for (code, language) in all() {
        assert_eq!(gaps(language, &needed), [""; 0], "{code}");
    }
}

#[test]
fn a_missing_and_a_superfluous_sentence_are_found() {
    let (code, text) = FILES.first().expect("a language");
    let line = "\"Close\" = ";
    assert!(text.contains(line), "{code}");
    let changed = text.replace(line, "\"Shut\" = ");
    let language = Language::read(&changed).expect("read");
    assert_eq!(
        gaps(&language, &needed()),
        ["lacks \"Close\"", "unused: \"Shut\""]
    );
}

#[test]
fn no_sentence_is_in_two_tables_of_a_language() {
    for (code, text) in FILES {
        let lines = text.lines().filter(|line| line.starts_with('"'));
        let language = Language::read(text).expect("read");
        assert_eq!(lines.count(), language.texts().count(), "{code}");
    }
}

#[test]
fn the_places_of_translations_are_those_of_their_sentences() {
    for (code, language) in all() {
        assert_eq!(misplaced(language), [""; 0], "{code}");
    }
    let fault = "name = \"x\"\n[texts.a]\n\"Delete {name}?\" = \"Weg mit {nam}?\"";
    let language = Language::read(fault).expect("read");
    assert_eq!(misplaced(&language), ["Delete {name}?"]);
}

/// Translations into French where a line might break before a sign that belongs to the word.
fn breakable(language: &Language) -> Vec<&str> {
    let signs = [" ;", " :", " ?", " !", " »", " %", "« "];
    let wrong = language.texts();
    let wrong = wrong.filter(|(_, text)| signs.iter().any(|sign| text.contains(sign)));
    wrong.map(|(english, _)| english).collect()
}

#[test]
fn in_french_no_line_breaks_before_a_sign() {
    assert_eq!(breakable(&all()["fr"]), [""; 0]);
    let faults = "name = \"x\"\n[texts.a]\n\"Done!\" = \"Fini !\"\n\"Yes!\" = \"Oui\u{a0}!\"";
    let language = Language::read(faults).expect("read");
    assert_eq!(breakable(&language), ["Done!"]);
}

#[test]
fn each_use_fills_the_places_of_its_sentence() {
    for used in uses() {
        assert_eq!(used.names, places(&used.english), "{}", used.place);
    }
    let fault = uses_in("here", "tr!(\"{a} of {b}\", a, c = f(1, \"x)\"))");
    let [used] = &fault[..] else {
        panic!("{fault:?}");
    };
    assert_ne!(used.names, places(&used.english), "a fault would pass");
}

#[test]
fn no_control_shows_a_sentence_that_is_not_translated() {
    let found = all_sources();
    let bare = |code: &str| -> Vec<String> {
        // Calls that show a literal unchanged.
        let calls = [
            ".label(\"",
            ".weak(\"",
            ".strong(\"",
            ".small(\"",
            ".heading(\"",
            ".button(\"",
            ".small_button(\"",
            "Button::new(\"",
            "RichText::new(\"",
            "on_hover_text(\"",
            "hint_text(\"",
            ".note(\"",
            "CollapsingHeader::new(\"",
            ".collapsing(\"",
            "accessible_name(\"",
            ".text(\"",
            ".help(\"",
        ];
        let starts = calls.iter().flat_map(|call| {
            code.match_indices(call)
                .map(|(at, call)| literal(&code[at + call.len()..]).0)
        });
        let has_word = |text: &String| text.chars().filter(|c| c.is_alphabetic()).count() > 2;
        starts.filter(has_word).collect()
    };
    for (place, code) in &found {
        if place.ends_with("src/lib.rs") || place.contains("/render/") {
            continue;
        }
        let shown = bare(code);
        let hints = ["2 Cobalt Blue, 1 …", "/home/me/brushes/rake.toml"];
        let shown: Vec<&String> = shown
            .iter()
            .filter(|text| !hints.contains(&&***text))
            .collect();
        assert!(shown.is_empty(), "{place}: {shown:?}");
    }
    assert_eq!(
        bare("ui.label(\"Width\");"),
        ["Width"],
        "a fault would pass"
    );
}

#[test]
fn the_range_of_every_slider_and_number_is_that_of_a_type() {
    let bare = |code: &str| {
        let calls = ["Slider::new(", ".range("];
        let ranges = calls.iter().flat_map(|call| code.match_indices(call));
        let given = ranges.map(|(at, call)| code[at + call.len()..].lines().next());
        given
            .flatten()
            .filter(|line| !line.contains("::USUAL"))
            .map(str::to_owned)
            .collect::<Vec<String>>()
    };
    for (place, code) in &all_sources() {
        // A place in a recording is as long as the recording; rows have what their type says.
        if !place.ends_with("transport_bar.rs") && !place.ends_with("kit/src/rows.rs") {
            assert_eq!(bare(code), [""; 0], "{place}");
        }
    }
    assert_eq!(
        bare("Slider::new(&mut um, 0.0..=50.0)"),
        ["&mut um, 0.0..=50.0)"],
        "a fault would pass"
    );
}
