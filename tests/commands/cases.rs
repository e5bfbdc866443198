//! Inputs that failed when they came from outside, as `tests/cases/README.md` lists them: each is read for what it is.

#![allow(clippy::panic, reason = "a test that meets what cannot be fails")]

#[path = "../support/mod.rs"]
mod support;

use std::io::BufReader;

use maulstick_device::{Take, TakeSample};
use maulstick_optics::Reflectance;
use maulstick_types::stylus::StylusPose;
use serde_json::Value;
use support::{Place, fault, has, info};

/// A stroke of 51 mm on a canvas of coarse cells.
const STROKE: [&str; 4] = ["--cell-mm", "0.5", "--load", "Bone Black"];

/// Path of a case.
fn case(name: &str) -> String {
    format!("{}/../tests/cases/{name}", env!("CARGO_MANIFEST_DIR"))
}

fn text(name: &str) -> String {
    std::fs::read_to_string(case(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// What a command prints as JSON.
fn json(place: &Place, args: &[&str]) -> Value {
    serde_json::from_slice(&place.done(args).stdout).expect("JSON")
}

/// Numbers of the rows of a table with points and commas: t, x, y, pressure.
fn rows(table: &str) -> Vec<[f64; 4]> {
    let lines = table.split(['\r', '\n']);
    let of_numbers = lines.filter(|line| line.starts_with(|first: char| first.is_ascii_digit()));
    of_numbers
        .map(|line| {
            let numbers = line.split([',', ' ']).take(4);
            let numbers: Vec<f64> = numbers
                .map(|number| number.parse().expect("a number"))
                .collect();
            numbers.try_into().expect("four columns")
        })
        .collect()
}

/// A table with decimal commas and semicolons, with points and commas.
fn with_points(table: &str) -> String {
    table.replace(',', ".").replace(';', ",")
}

/// Place, m, and pressure of a sample of a pen.
fn contact(sample: &TakeSample) -> ([f64; 2], f64) {
    match &sample.sample.pose {
        StylusPose::Contact {
            point_m: [x, y, _],
            pressure,
            ..
        } => ([*x, *y], *pressure),
        StylusPose::Ferrule { .. } => panic!("no pen: {sample:?}"),
    }
}

/// The picture of a PNG in bytes: its width and its pixels.
fn picture(place: &Place, name: &str) -> (usize, Vec<[u8; 3]>) {
    let file = std::fs::File::open(place.path(name)).expect("a picture");
    let mut reader = png::Decoder::new(BufReader::new(file))
        .read_info()
        .expect("a PNG");
    let mut bytes = vec![0; reader.output_buffer_size().expect("a size")];
    let frame = reader.next_frame(&mut bytes).expect("pixels");
    assert_eq!(frame.color_type, png::ColorType::Rgb, "{name}");
    let pixels = bytes.chunks_exact(3).map(|rgb| [rgb[0], rgb[1], rgb[2]]);
    (frame.width as usize, pixels.collect())
}

/// Asserts the colour of a picture at so many pixels from the left and from above.
fn seen(place: &Place, name: &str, [x, y]: [usize; 2], wanted: [u8; 3]) {
    let (width, pixels) = picture(place, name);
    let got = pixels[y * width + x];
    let differs = got.iter().zip(wanted).map(|(got, rgb)| got.abs_diff(rgb));
    assert!(
        differs.max() <= Some(6),
        "{name} at {x}, {y}: {got:?}, not {wanted:?}"
    );
}

#[test]
fn every_row_of_a_table_of_strokes_is_a_sample_of_the_take() {
    let place = Place::new();
    for (name, strokes, milliseconds) in [
        ("01-jump-50mm.csv", 1, 16),
        ("03-decimal-comma.csv", 1, 304),
        ("03b-decimal-comma-ms.csv", 1, 24),
        ("04-coarse-time.csv", 1, 507),
        ("12-blank-line-strokes.txt", 2, 224),
        ("13-time-restarts.csv", 2, 216),
        ("14-stroke-column.csv", 1, 8),
        ("14b-quoted-header.csv", 1, 8),
        ("19-cr-only.csv", 1, 1592),
    ] {
        place.done(&["take", "import", &case(name), "-o", "x.mcap", "--overwrite"]);
        let take = Take::read(&place.path("x.mcap")).expect("a take");
        let length_ms = take.length_ns() / 1_000_000;
        assert_eq!(length_ms, milliseconds, "{name}");
        let table = if name.starts_with("03") {
            with_points(&text(name))
        } else {
            text(name)
        };
        let rows = rows(&table);
        // Between strokes the pen is lifted, which no row says.
        let said = |sample: &&TakeSample| strokes == 1 || contact(sample).1 > 0.0;
        let samples: Vec<&TakeSample> = take.samples.iter().filter(said).collect();
        assert_eq!(samples.len(), rows.len(), "{name}");
        for (sample, [_, x, y, pressure]) in samples.iter().zip(rows) {
            let ([x_m, y_m], pressed) = contact(sample);
            let near = (x_m - 2.5e-4 * (x - 512.0)).abs() < 1e-9
                && (y_m - 2.5e-4 * (512.0 - y)).abs() < 1e-9
                && (pressed - pressure).abs() < 1e-9;
            assert!(near, "{name}: {sample:?} is not {x}, {y}, {pressure}");
        }
        let lifts = take.samples.windows(2).filter(|two| {
            let [before, after] = [&two[0], &two[1]].map(|sample| contact(sample).1);
            before > 0.0 && after == 0.0
        });
        assert_eq!(lifts.count(), strokes - 1, "{name}");
        for two in take.samples.windows(2) {
            let pause_ns = two[1].time_ns.saturating_sub(two[0].time_ns);
            let pressed = contact(&two[0]).1 > 0.0 && contact(&two[1]).1 > 0.0;
            let most_ns = if pressed { 15_000_000 } else { 200_000_000 };
            assert!((1..=most_ns).contains(&pause_ns), "{name}: {two:?}");
        }
    }
}

#[test]
fn a_fifth_column_without_a_heading_is_refused_with_its_line() {
    let place = Place::new();
    let table = case("14c-stroke-column-no-header.csv");
    let said = fault(&place, &["take", "import", &table, "-o", "x.mcap"], 2);
    has(&said, &["14c-stroke-column-no-header.csv:1\n"]);
    assert!(!place.path("x.mcap").exists());
}

#[test]
fn a_leap_of_fifty_millimetres_is_painted_all_the_way() {
    let place = Place::new();
    place.done(&["take", "import", &case("01-jump-50mm.csv"), "-o", "x.mcap"]);
    let render = ["render", "x.mcap", "-o", "p.png", "--document", "d.maul"];
    place.done(&[&render[..], &STROKE].concat());
    let said = info(&place, "d.maul");
    assert_eq!(said["record"]["strokes"], 1, "{said}");
    assert_eq!(said["ledger"]["quanta_missing"], 0, "{said}");
    assert!(said["ledger"]["accounts_m3"]["canvas"].as_f64() > Some(0.0));
    // From 53 mm left of the middle of 256 mm on.
    let (width, pixels) = picture(&place, "p.png");
    let across_mm = 256.0 / width as f64;
    let row = &pixels[width * (width / 2)..][..width];
    for mm in [-45.0, -35.0, -25.0, -15.0, -8.0] {
        let [red, ..] = row[((mm + 128.0) / across_mm) as usize];
        assert!(red < 128, "{mm} mm from the middle: {red}");
    }
}

#[test]
fn a_recording_without_chunks_in_any_order_or_packed_densely_is_whole() {
    let place = Place::new();
    for (name, others) in [
        ("02-unchunked.mcap", &[][..]),
        ("15-shuffled.mcap", &[]),
        ("20-dense-chunk.mcap", &[("camera", 200)]),
    ] {
        let said = json(&place, &["recording", "info", "--json", &case(name)]);
        assert_eq!(said["damage"], Value::Null, "{name}: {said}");
        let streams = said["streams"].as_array().expect("streams");
        assert_eq!(streams.len(), 1, "{name}: {said}");
        let stream = &streams[0];
        assert_eq!(stream["message"], "StylusSample/1", "{name}");
        assert_eq!(stream["messages"], 200, "{name}: {said}");
        assert_eq!(stream["lost"], 0, "{name}: {said}");
        let foreign = said["foreign"].as_array().expect("topics of others");
        let foreign: Vec<(&str, u64)> = foreign
            .iter()
            .map(|other| {
                let messages = other["messages"].as_u64().expect("a number");
                (other["topic"].as_str().expect("a name"), messages)
            })
            .collect();
        assert_eq!(foreign, others, "{name}");
        let take = json(&place, &["take", "info", "--json", &case(name)]);
        assert_eq!(take["samples"], 200, "{name}: {take}");
        assert_eq!(take["seconds"], 1.592, "{name}: {take}");
    }
}

#[test]
fn a_picture_has_the_colours_that_its_file_says() {
    let place = Place::new();
    place.done(&["take", "import", &case("01-jump-50mm.csv"), "-o", "x.mcap"]);
    let render = ["render", "x.mcap", "-o", "p.png", "--document", "d.maul"];
    place.done(&[&render[..], &STROKE].concat());
    // Near the corners, away from the stroke. What a ground shines at least is some 50 of 255.
    let (above, below, beside) = ([51, 51], [460, 460], [51, 460]);
    let all = |rgb: [u8; 3]| [(above, rgb), (below, rgb), (beside, rgb)];
    for (name, colours) in [
        ("09-linear-gama.png", all([128; 3])),
        ("09b-cicp-p3.png", all([64, 250, 62])),
        ("10-assoc-alpha.tif", all([251, 186, 186])),
        ("18-float-grey.tif", all([128; 3])),
        (
            "18b-palette.tif",
            [
                (above, [236, 197, 54]),
                (below, [48, 60, 198]),
                (beside, [219, 49, 49]),
            ],
        ),
    ] {
        std::fs::copy(place.path("d.maul"), place.path("y.maul")).expect("copied");
        place.done(&[
            "painting",
            "import",
            "y.maul",
            &case(name),
            "--as",
            "ground",
        ]);
        let export = ["painting", "export", "y.maul", "-o", "y.png", "--overwrite"];
        place.done(&[&export[..], &["--format", "png"]].concat());
        for (at, rgb) in colours {
            seen(&place, "y.png", at, rgb);
        }
    }
}

#[test]
fn a_picture_with_what_is_no_number_is_refused_and_the_painting_stays() {
    let place = Place::new();
    place.done(&["take", "import", &case("01-jump-50mm.csv"), "-o", "x.mcap"]);
    let render = ["render", "x.mcap", "-o", "p.png", "--document", "d.maul"];
    place.done(&[&render[..], &STROKE].concat());
    let before = place.bytes("d.maul");
    for purpose in ["ground", "underpainting", "tooth"] {
        let picture = case("11-nan.tif");
        let import = ["painting", "import", "d.maul", &picture, "--as", purpose];
        has(&fault(&place, &import, 2), &["10, 10", "11-nan.tif"]);
        assert!(place.bytes("d.maul") == before, "{purpose}");
    }
}

#[test]
fn a_lamp_shines_the_same_however_its_table_is_written() {
    let place = Place::new();
    let mixed = |lamp: &str| {
        let mix = [
            "colour",
            "mix",
            "--json",
            "Bone Black",
            "--illuminant",
            lamp,
        ];
        json(&place, &mix)["lab"].clone()
    };
    let read = |name: &str, plain: String| {
        std::fs::write(place.path("plain.csv"), plain).expect("written");
        let lab = mixed(&case(name));
        assert_eq!(lab, mixed("plain.csv"), "{name}");
        lab
    };
    let comma = "16-lamp-decimal-comma.csv";
    let warm = read(comma, with_points(&text(comma)));
    let tab = "16b-lamp-tab.txt";
    assert_eq!(read(tab, text(tab).replace('\t', ",")), warm);
    let quoted = "16d-lamp-quoted.csv";
    let flat = read(quoted, text(quoted).replace('"', ""));
    assert_ne!(flat, warm, "another lamp would be seen");
}

#[test]
fn a_ground_that_reads_a_little_above_its_standard_is_white() {
    let name = "16c-ground-1.003.csv";
    let ground = Reflectance::parse(&text(name)).expect("a ground");
    assert_eq!(ground.limited, 36);
    let white = |reading: &f64| (reading - 1.0).abs() < 1e-12;
    assert!(ground.reading.0.iter().all(white), "{ground:?}");
    let place = Place::new();
    place.done(&["take", "import", &case("01-jump-50mm.csv"), "-o", "x.mcap"]);
    let render = ["render", "x.mcap", "-o", "p.png", "--ground", &case(name)];
    place.done(&[&render[..], &STROKE].concat());
    seen(&place, "p.png", [20, 20], [255; 3]);
}

#[test]
fn a_model_whose_name_ends_in_capitals_is_a_brush() {
    let place = Place::new();
    let model = case("17-UPPER.GLB");
    place.done(&["brush", "import", &model, "-o", "own.toml"]);
    let text = String::from_utf8(place.bytes("own.toml")).expect("a file");
    let brush: toml::Table = text.parse().expect("TOML");
    assert_eq!(brush["head"]["length_mm"].as_float(), Some(24.0));
    let chains = brush["spines"]["chain"].as_array().expect("spines");
    assert_eq!(chains.len(), 5);
    for chain in chains {
        assert_eq!(chain["segments_mm"].as_array().map(Vec::len), Some(3));
    }
    place.done(&["take", "import", &case("01-jump-50mm.csv"), "-o", "x.mcap"]);
    let render = ["render", "x.mcap", "-o"];
    for (picture, brush) in [("one.png", &*model), ("two.png", "own.toml")] {
        let args = [picture, "--brush", brush];
        place.done(&[&render[..], &args, &STROKE].concat());
    }
    let [one, two] = ["one.png", "two.png"].map(|name| place.bytes(name));
    support::assert_same(&one, &two, "the model, and the file made of it");
}
