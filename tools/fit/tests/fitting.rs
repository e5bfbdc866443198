//! `maulstick colour fit`, from a table of measurements to a paint file.

#[path = "../../../tests/support/place.rs"]
mod place;

use place::{Place, fault, has};

#[test]
fn fit_makes_paints_of_the_example_of_its_guide() {
    let place = Place::new();
    let table = include_str!("../../../docs/examples/measurements.csv");
    std::fs::write(place.path("m.csv"), table).expect("written");
    let said = place.done(&["colour", "fit", "m.csv", "-o", "paints.csv"]);
    let said = String::from_utf8_lossy(&said.stdout).into_owned();
    has(
        &said,
        &[
            "sample",
            "blue and white 1:9",
            "mean",
            "worst",
            "per metre",
            "5 paints from 20 samples",
        ],
    );
    let library = String::from_utf8(place.bytes("paints.csv")).expect("text");
    let library = maulstick_optics::PaintLibrary::parse(&library).expect("a paint file");
    let red = library.find("Pyrrole Red").expect("there");
    assert_eq!(red.colour_index, "PR254");

    let json = place
        .done(&["colour", "fit", "m.csv", "-o", "paints.csv", "--json"])
        .stdout;
    let json: serde_json::Value = serde_json::from_slice(&json).expect("JSON");
    let rows = json["rows"].as_array().expect("rows");
    assert_eq!((rows.len(), &rows[0]["sample"]), (20, &"white".into()));
    assert!(
        rows.iter().all(|row| row["delta_e"].as_f64() < Some(0.7)),
        "{json}"
    );
    assert_eq!(json["warnings"], serde_json::json!([]));
    // Another surface, another fit; a masstone alone gets a warning.
    let other = ["colour", "fit", "m.csv", "-o", "other.csv", "--no-surface"];
    place.done(&other);
    assert!(place.bytes("other.csv") != place.bytes("paints.csv"));
    let without: Vec<&str> = table
        .lines()
        .filter(|line| !line.starts_with("red and"))
        .collect();
    std::fs::write(place.path("m.csv"), without.join("\n")).expect("written");
    let said = place
        .done(&["colour", "fit", "m.csv", "-o", "paints.csv"])
        .stderr;
    has(
        &String::from_utf8_lossy(&said),
        &["warning: 'Pyrrole Red' is ill-determined", "1:10"],
    );
}

#[test]
fn fit_refuses_bad_measurements_with_row_and_column() {
    let place = Place::new();
    let fit = |table: &str, more: &[&str]| {
        std::fs::write(place.path("m.csv"), table).expect("written");
        let mut args = vec!["colour", "fit", "m.csv", "-o", "p.csv"];
        args.extend(more);
        let said = fault(&place, &args, 2);
        assert!(!place.path("p.csv").exists(), "half-written: {said}");
        said
    };
    let head = "sample,Titanium White,Cobalt Blue,400,500,600\nw,1,,0.8,0.9,0.9\n";
    has(
        &fit(&format!("{head}b,0.5,0.5,0.3,1.3,0.2\n"), &[]),
        &["m.csv:3, column 5 (500)", "1.3", "above 1.2", "help:"],
    );
    has(
        &fit(&format!("{head}b,0.5,0.4,0.3,0.3,0.2\n"), &[]),
        &["m.csv:3, column 3 (Cobalt Blue)", "sum to 0.9", "help:"],
    );
    has(
        &fit(&format!("{head}b,0.5,0.5,0.3,,0.2\n"), &[]),
        &["m.csv:3, column 5 (500)", "missing"],
    );
    has(
        &fit(&format!("{head}b,0,1,0.3,0.2,0.2\n"), &[]),
        &["m.csv:3, column 3 (Cobalt Blue)", "singular", "1:10"],
    );
    has(
        &fit(
            &format!("{head}b,0.5,0.5,0.3,0.2,0.2\n"),
            &["--white", "Colbat Blue"],
        ),
        &["'Colbat Blue'", "did you mean 'Cobalt Blue'?"],
    );
    has(
        &fault(&place, &["colour", "fit", "none.csv", "-o", "p.csv"], 2),
        &["none.csv", "check the path"],
    );
    std::fs::write(place.path("m.csv"), head).expect("written");
    has(
        &fault(&place, &["colour", "fit", "m.csv", "-o", "no/p.csv"], 1),
        &["no/p.csv", "folder"],
    );
}

#[test]
fn measurements_are_not_written_over() {
    let place = Place::new();
    std::fs::write(
        place.path("m.csv"),
        include_str!("../../../docs/examples/measurements.csv"),
    )
    .expect("written");
    let said = fault(&place, &["colour", "fit", "m.csv", "-o", "m.csv"], 2);
    has(&said, &["take the place of the measurements", "m.csv"]);
    assert!(place.bytes("m.csv").starts_with(b"#"));
}
