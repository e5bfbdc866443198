//! Copies of paintings with another paint model: `maulstick painting convert`.

#[path = "../support/mod.rs"]
mod support;

use support::{COARSE, Place, fault, has, info};

/// Paint model of the canvas, and volume of the paint on it, m³, from balanced books.
fn canvas(place: &Place, file: &str) -> (String, f64) {
    let said = info(place, file);
    let ledger = &said["ledger"];
    assert_eq!(ledger["quanta_missing"], 0, "{said}");
    let model = said["model"].as_str().expect("a name").to_owned();
    let volume = ledger["accounts_m3"]["canvas"].as_f64().expect("a volume");
    (model, volume)
}

#[test]
fn a_copy_is_converted_and_the_painting_stays_as_it_is() {
    let place = Place::new();
    place.short_demo("take.mcap", 2.0);
    let render = ["render", "take.mcap", "--load", "Ultramarine Blue", "-o"];
    let file = ["p.png", "--document", "x.maul", "--model", "dab"];
    place.done(&[&render[..], &file[..], &COARSE[..]].concat());
    let before = place.bytes("x.maul");
    let convert = |from: &'static str, model: &'static str, to: &'static str| {
        ["painting", "convert", from, "--model", model, "-o", to]
    };
    let said = place.done(&convert("x.maul", "impasto", "y.maul")).stdout;
    has(&String::from_utf8_lossy(&said), &["y.maul", "in the mean"]);
    assert_eq!(place.bytes("x.maul"), before);
    place.done(&convert("y.maul", "dab", "z.maul"));
    let (model, all) = canvas(&place, "x.maul");
    assert!(model == "dab" && all > 0.0);
    assert_eq!(canvas(&place, "y.maul"), ("impasto".to_owned(), all));
    assert_eq!(canvas(&place, "z.maul"), ("dab".to_owned(), all));
    let written = std::fs::read_dir(place.path(".")).expect("a folder");
    let names = written.map(|entry| entry.expect("a file").file_name());
    let kept = names.filter(|name| name.to_string_lossy().contains("maul"));
    assert_eq!(kept.count(), 3, "nothing is left beside them");

    for (args, words) in [
        (convert("x.maul", "oil", "v.maul"), ["oil", "impasto"]),
        (
            convert("x.maul", "dab", "v.maul"),
            ["'dab' already", "x.maul"],
        ),
        (
            convert("none.maul", "dab", "v.maul"),
            ["no such file", "none.maul"],
        ),
        (
            convert("take.mcap", "dab", "v.maul"),
            ["not a Maulstick painting", "take.mcap"],
        ),
        (convert("x.maul", "impasto", "y.maul"), ["y.maul", "help:"]),
    ] {
        has(&fault(&place, &args, 2), &words);
    }
    assert!(!place.path("v.maul").exists());
}
