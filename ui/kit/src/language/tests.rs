//! Languages.

use maulstick_types::paint::StepName;

use super::*;

#[test]
fn places_are_filled_in_the_order_of_the_language() {
    let (paints, slots) = (3, 48);
    assert_eq!(
        tr!("{paints} of {slots} paints", paints, slots),
        "3 of 48 paints"
    );
    assert_eq!(tr!("Delete {name}?", name = "Blue {x}"), "Delete Blue {x}?");
    choose(Some("de"));
    assert_eq!(
        tr!("Delete {name}?", name = "Blue {x}"),
        "Blue {x} löschen?"
    );
    assert_eq!(tr!("theme|Light"), "Hell");
    let stroke = |on_palette| StepName::Stroke {
        kind: "round".into(),
        on_palette,
    };
    assert_eq!(step(&stroke(false)), "Strich: Rund");
    assert_eq!(step(&stroke(true)), "Strich auf der Palette: Rund");
    assert_eq!(step(&StepName::Beginning), "der Anfang");
    assert_eq!((key_name("Delete"), known("Delete")), ("Entf", "Löschen"));
    assert_eq!(key_name("F5"), "F5");
    let load = StepName::Load {
        paints: vec!["Cobalt Blue".into(), "Ivory Black".into()],
    };
    assert_eq!(step(&load), "Laden: Cobalt Blue + Ivory Black");
    let version = "first".to_owned();
    assert_eq!(step(&StepName::Return { version }), "Zurück zu „first“");
    assert_eq!(step(&StepName::Merged { count: 12 }), "12 Schritte");
    let layer = |number, name: &str| Layer {
        number,
        name: name.to_owned(),
        opacity: 1.0,
    };
    assert_eq!(layer_name(&layer(3, "layer 3")), "Schicht 3");
    assert_eq!(layer_name(&layer(4, "layer 3")), "layer 3");
    choose(Some("en"));
    assert_eq!(tr!("theme|Light"), "Light");
    for name in [stroke(false), stroke(true), load, StepName::Unpainted] {
        assert_eq!(step(&name), name.to_string());
    }
}

#[test]
fn the_system_says_which_language_unless_it_is_unknown() {
    let of = |locales: &[&str]| spoken(locales.iter().map(|locale| (*locale).to_owned()));
    assert_eq!(of(&["de-AT", "en"]), "de");
    assert_eq!(of(&["tlh", "de_DE"]), "de");
    assert_eq!(of(&["en-GB", "de"]), "en");
    assert_eq!(of(&["C", "de"]), "en");
    assert_eq!(of(&["tlh"]), "en");
    assert_eq!(of(&[]), "en");
}

#[test]
fn tasks_of_the_window_speak_its_language() {
    choose(Some("de"));
    let context = eframe::egui::Context::default();
    let work = || tr!("this is no folder").to_owned();
    let task = crate::background_task::BackgroundTask::start(&context, "words", work);
    let said = loop {
        if let std::task::Poll::Ready(said) = task.poll() {
            break said;
        }
        std::thread::yield_now();
    };
    assert_eq!(said.as_deref(), Some("das ist kein Ordner"));
    choose(Some("tlh"));
    assert!(chosen().is_none(), "one that is unknown is the system's");
}
