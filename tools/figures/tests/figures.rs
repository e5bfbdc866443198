//! Figures on the command line: contents, refusals, and protection of existing files.

#[path = "../../../tests/support/place.rs"]
mod place;

use std::fmt::Write as _;

use place::{Place, fault, has};
use serde_json::Value;

fn json(place: &Place, args: &[&str]) -> Value {
    let mut args = args.to_vec();
    args.push("--json");
    serde_json::from_slice(&place.done(&args).stdout).expect("JSON")
}

fn numbers(value: &Value) -> Vec<f64> {
    let list = value.as_array().expect("a list").iter();
    list.map(|number| number.as_f64().expect("a number"))
        .collect()
}

/// Size and pixels of a PNG.
fn picture(place: &Place, name: &str) -> ([u32; 2], Vec<u8>) {
    let file = std::fs::File::open(place.path(name)).expect("there");
    let mut reader = png::Decoder::new(std::io::BufReader::new(file))
        .read_info()
        .expect("a PNG");
    let mut pixels = vec![0; reader.output_buffer_size().expect("a size")];
    reader.next_frame(&mut pixels).expect("pixels");
    ([reader.info().width, reader.info().height], pixels)
}

/// A paint file of one's own: a white, a grey, a black.
fn own_paints() -> String {
    let mut text = String::from("# mine\n");
    for (name, k, s) in [
        ("Chalk", 0.0001, 1.0),
        ("Slate", 0.3, 0.5),
        ("Soot", 5.0, 0.01),
    ] {
        for (quantity, value) in [("K", k), ("S", s)] {
            let values = format!(",{value}").repeat(101);
            writeln!(text, "{name},PX,me,{quantity}{values}").expect("written");
        }
    }
    text
}

#[test]
fn the_mixing_chart_has_every_pair() {
    let place = Place::new();
    std::fs::write(place.path("paints.csv"), own_paints()).expect("written");
    place.done(&["colour", "chart", "-o", "all.png"]);
    place.done(&["colour", "chart", "-o", "own.png", "--paints", "paints.csv"]);
    place.done(&["colour", "chart", "-o", "bulb.png", "--illuminant", "A"]);
    let (all, pixels) = picture(&place, "all.png");
    let (own, _) = picture(&place, "own.png");
    assert!(all[0] > own[0] && all[1] > own[1] + 25 * 30);
    let mut colours: Vec<&[u8]> = pixels.chunks_exact(3).collect();
    colours.sort_unstable();
    colours.dedup();
    assert!(colours.len() > 2000, "{} colours", colours.len());
    assert!(picture(&place, "bulb.png").1 != pixels, "another light");
}

#[test]
fn four_ways_to_mix_are_compared() {
    let place = Place::new();
    let compared = json(&place, &["colour", "compare", "-o", "four.png"]);
    assert_eq!(compared["from"], "Yellow Ochre");
    let shares = numbers(&compared["shares"]);
    let rows = compared["rows"].as_array().expect("rows");
    assert_eq!(rows.len(), 4);
    let worst = |row: &Value| numbers(&row["delta_e"]).into_iter().fold(0.0, f64::max);
    for row in rows {
        assert_eq!(numbers(&row["delta_e"]).len(), shares.len());
        assert_eq!(row["lab"].as_array().map(Vec::len), Some(shares.len()));
    }
    assert!(worst(&rows[0]) == 0.0 && worst(&rows[1]) < 1.0);
    assert!(worst(&rows[2]) > 3.0 && worst(&rows[3]) > 10.0);
    assert!(picture(&place, "four.png").0[0] > 800);
    let ends = json(
        &place,
        &["colour", "compare", "Pyrrole Red=0.5,Titanium White=0.5"],
    );
    assert_eq!(
        (&ends["from"], &ends["to"]),
        (&"Pyrrole Red".into(), &"Titanium White".into())
    );
    let text = place
        .done(&["colour", "compare", "Green Gold", "Bone Black"])
        .stdout;
    has(
        &String::from_utf8_lossy(&text),
        &["Green Gold to Bone Black", "101 samples", "linear RGB"],
    );
}

#[test]
fn bad_figures_are_refused() {
    let place = Place::new();
    let refused = |args: &[&str], words: &[&str]| has(&fault(&place, args, 2), words);
    refused(&["colour", "chart"], &["--output"]);
    refused(&["colour", "compare", "A", "B", "C"], &["two ends, not 3"]);
    let lost = ["colour", "chart", "-o", "no/chart.png"];
    has(&fault(&place, &lost, 1), &["no/chart.png", "folder"]);
    for command in [["demo", "effects"], ["brush", "sheet"]] {
        let command = [&command[..], &["-o", "p.png", "--cell-mm"]].concat();
        for cell in ["0", "nan", "10", "-0.1", "fine"] {
            refused(
                &[&command[..], &[cell]].concat(),
                &["--cell-mm", cell, "0.125"],
            );
            assert!(!place.path("p.png").exists(), "{command:?} {cell}");
        }
        let fine = [&command[..], &["0.02"]].concat();
        refused(&fine, &["pixels", "--cell-mm", "larger cells"]);
    }
}

#[test]
fn a_figure_is_written_over_no_file_of_another_kind_and_over_none_that_it_reads() {
    let place = Place::new();
    let chart = ["colour", "chart", "-o", "list.txt"];
    std::fs::write(place.path("list.txt"), "a shopping list").expect("written");
    has(&fault(&place, &chart, 1), &["list.txt", "--overwrite"]);
    assert_eq!(place.bytes("list.txt"), b"a shopping list");
    place.done(&[&chart[..], &["--overwrite"]].concat());
    // The existing file is of its own kind.
    place.done(&chart);
    std::fs::write(place.path("own.csv"), own_paints()).expect("written");
    std::fs::write(place.path("lamp.csv"), "nm,power\n380,1\n780,1\n").expect("written");
    for (arguments, words) in [
        (
            &["colour", "chart", "--paints", "own.csv", "-o", "own.csv"][..],
            ["the place of the paints", "own.csv"],
        ),
        (
            &[
                "colour",
                "compare",
                "--illuminant",
                "lamp.csv",
                "-o",
                "lamp.csv",
            ],
            ["the spectrum of the light", "lamp.csv"],
        ),
        (
            &["demo", "fluid-force", "-o", "q.csv", "--plot", "q.csv"],
            ["the table and the plot", "one file"],
        ),
    ] {
        has(&fault(&place, arguments, 2), &words);
    }
    assert_eq!(place.bytes("own.csv"), own_paints().as_bytes());
}
