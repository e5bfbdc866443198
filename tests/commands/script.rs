//! A day at the easel as a script.

#[path = "../support/mod.rs"]
mod support;

use support::{Place, assert_same, fault, has};

const LOAD: &str = "Ultramarine Blue";

fn script(place: &Place, name: &str, steps: &str) {
    place.write(name, format!("step = [\n{steps}\n]\n"));
}

#[test]
fn a_script_of_a_take_is_the_take_and_more_steps_are_more() {
    let place = Place::new();
    // The sweeps of its first seconds begin on the palette beside a small canvas.
    place.short_demo("flower.mcap", 16.0);
    let size = ["--size", "320x300", "--cell-mm", "0.5"];
    let take = ["render", "flower.mcap", "-o", "take.png", "--load", LOAD];
    place.done(&[&take[..], &size].concat());
    let paint = |steps: &str, picture: &str| {
        script(&place, "day.toml", steps);
        place.done(
            &[
                &["render", "--script", "day.toml", "-o", picture],
                &size[..],
            ]
            .concat(),
        );
        place.bytes(picture)
    };
    let painted = format!(
        "{{ brush = \"round\", size_mm = 10 }},\n{{ take = \"flower.mcap\", loads = [\"{LOAD}\"] }},"
    );
    let same = paint(&painted, "script.png");
    assert_same(
        &place.bytes("take.png"),
        &same,
        "a take, and a script of it",
    );
    let glazed = format!(
        "{painted}\n{{ dry = 1.0, layer = \"drawing\" }},\n{{ fill = \"Yellow Ochre\", um = 20 }},"
    );
    let more = paint(&glazed, "more.png");
    assert!(more != same);
    let veiled = paint(
        &format!("{glazed}\n{{ opacity = 0.2, layer = \"drawing\" }},"),
        "veiled.png",
    );
    assert!(veiled != more);
    let undone = paint(&format!("{glazed}\n{{ undo = 2 }},"), "undone.png");
    assert_same(&same, &undone, "the fill and the drying taken back");
    let lamp = paint(
        &format!("{painted}\n{{ light = {{ direction = [1, 0, 0.4] }} }},"),
        "lamp.png",
    );
    assert!(lamp != same);
}

#[test]
fn two_takes_are_two_strokes_in_a_document_and_a_fault_keeps_what_was_painted() {
    let place = Place::new();
    place.short_demo("flower.mcap", 3.0);
    let file = ["--document", "day.maul"];
    script(
        &place,
        "day.toml",
        "{ load = \"Bone Black\" },\n{ take = \"flower.mcap\" },\n{ keep = \"one\" },\n{ opacity = 0.5, layer = \"sky\" },",
    );
    let render = ["render", "--script", "day.toml", "-o", "day.png"];
    let said = fault(&place, &[&render[..], &file].concat(), 2);
    has(&said, &["'sky'", "day.toml:5"]);
    assert!(!place.path("day.png").exists());
    let kept = place
        .done(&["painting", "info", "--json", "day.maul"])
        .stdout;
    let kept: serde_json::Value = serde_json::from_slice(&kept).expect("JSON");
    assert_eq!(kept["versions"][0], "one");
    assert!(kept["undo"].as_u64() >= Some(2), "{kept}");
    assert_eq!(kept["ledger"]["quanta_missing"], 0);
}

#[test]
fn what_is_wrong_is_told_before_anything_is_painted() {
    let place = Place::new();
    script(&place, "day.toml", "{ dyr = 1.0 },");
    let render = ["render", "--script", "day.toml", "-o", "day.png"];
    has(
        &fault(&place, &render, 2),
        &["day.toml:2", "'dyr'", "'dry'"],
    );
    let over = ["render", "--script", "day.toml", "-o", "day.toml"];
    script(&place, "day.toml", "{ fill = \"Bone Black\" },");
    has(
        &fault(&place, &over, 2),
        &["the picture would take the place of the script", "day.toml"],
    );
    has(&fault(&place, &["render", "-o", "day.png"], 2), &["<TAKE>"]);
}

#[test]
fn what_is_refused_is_advised_as_steps() {
    let place = Place::new();
    let render = [
        "render", "--script", "day.toml", "-o", "day.png", "--size", "64x64",
    ];
    let fill = "{ fill = \"Bone Black\" },";
    for (steps, advice) in [
        ("{ wet = 1 },".to_owned(), "{ dry = 1.0 }"),
        (
            format!("{fill}\n{{ stop_drying = true }},"),
            "{ dry = 1.0, over = \"90s\" }",
        ),
        (
            format!("{fill}\n{{ dry = 1.0, over = \"9s\" }},\n{{ dry = 1.0, over = \"9s\" }},"),
            "{ stop_drying = true }",
        ),
    ] {
        script(&place, "day.toml", &steps);
        let said = fault(&place, &render, 2);
        has(&said, &["day.toml:", "help: ", advice]);
        assert!(!said.contains("`maulstick"), "{said}");
    }
}

#[test]
fn a_broken_brush_file_is_told_of_brushes() {
    let place = Place::new();
    let render = ["render", "--script", "day.toml", "-o", "day.png"];
    script(&place, "day.toml", "{ brush = \"own.toml\" },");
    let brush = maulstick_brush::BrushFile::library("round").and_then(|brush| brush.to_toml());
    let brush = brush.expect("a file");
    let line = brush.lines().find(|line| line.starts_with("width_mm"));
    let wide = brush.replace(line.expect("a width"), "width_mm = \"wide\"");
    for text in ["[head\n", &wide] {
        place.write("own.toml", text);
        let said = fault(&place, &render, 2);
        has(&said, &["own.toml:", "named at", "docs/brushes.md"]);
        assert!(!said.contains("print-config"), "{said}");
    }
}

#[test]
fn options_that_do_nothing_beside_a_script_are_refused() {
    let place = Place::new();
    script(&place, "day.toml", "{ fill = \"Bone Black\" },");
    let render = ["render", "--script", "day.toml", "-o", "day.png"];
    for (option, words) in [
        (
            ["--load", "Bone Black"],
            ["--load does nothing", "{ load = \"Bone Black\" }"],
        ),
        (
            ["--memory", "512M"],
            ["--memory does nothing", "--document"],
        ),
        (
            ["--history", "2G"],
            ["--history does nothing", "--document"],
        ),
    ] {
        let said = fault(&place, &[&render[..], &option].concat(), 2);
        has(&said, &words);
        has(&said, &["help: "]);
    }
    let take = ["render", "day.toml", "-o", "day.png"];
    has(&fault(&place, &take, 2), &["day.toml", "--script day.toml"]);
    assert!(!place.path("day.png").exists());
}

#[test]
fn more_steps_than_there_are_cannot_be_taken_back() {
    let place = Place::new();
    let render = [
        "render", "--script", "day.toml", "-o", "day.png", "--size", "64x64",
    ];
    let fills = "{ fill = \"Bone Black\" },\n{ fill = \"Titanium White\" },";
    script(&place, "day.toml", &format!("{fills}\n{{ undo = 9 }},"));
    has(&fault(&place, &render, 2), &["day.toml:4", "{ undo = 2 }"]);
    script(&place, "day.toml", "{ undo = 1 },");
    has(
        &fault(&place, &render, 2),
        &["nothing yet to take back", "day.toml:2", "help: "],
    );
    script(&place, "day.toml", &format!("{fills}\n{{ undo = 2 }},"));
    place.done(&render);
}

#[test]
fn a_tooth_may_be_a_picture_and_goes_with_the_painting() {
    let place = Place::new();
    let picture = std::fs::File::create(place.path("weave.png")).expect("made");
    let mut encoder = png::Encoder::new(picture, 8, 8);
    encoder.set_color(png::ColorType::Grayscale);
    let mut writer = encoder.write_header().expect("a header");
    let stripes: Vec<u8> = (0..64).map(|i| 255 * (i % 2) as u8).collect();
    writer.write_image_data(&stripes).expect("pixels");
    writer.finish().expect("whole");
    let size = ["--size", "128x64", "--cell-mm", "0.25"];
    let film = "{ fill = \"Ultramarine Blue\", um = 20 },";
    let paint = |tooth: &str, more: &[&str]| {
        script(&place, "day.toml", &format!("{tooth}\n{film}"));
        let render = ["render", "--script", "day.toml", "-o", "day.png"];
        place.done(&[&render[..], more].concat());
        place.bytes("day.png")
    };
    let plain = paint("", &size);
    let deep = paint("{ tooth = \"weave.png\", width_mm = 4 },", &size);
    let shallow = paint(
        "{ tooth = \"weave.png\", width_mm = 4, depth_um = 20 },",
        &size,
    );
    assert!(plain != deep && deep != shallow);
    let file = ["--document", "day.maul"];
    let kept = paint(
        "{ tooth = \"weave.png\", width_mm = 4 },",
        &[&size[..], &file].concat(),
    );
    assert_same(&deep, &kept, "in a document");
    std::fs::remove_file(place.path("weave.png")).expect("removed");
    script(&place, "none.toml", "{ light = { intensity = 1.0 } },");
    let again = ["render", "--script", "none.toml", "-o", "again.png"];
    place.done(&[&again[..], &file].concat());
    assert_same(
        &deep,
        &place.bytes("again.png"),
        "opened without the picture",
    );
    let tooth = support::info(&place, "day.maul")["tooth"].clone();
    assert!(
        tooth
            .as_str()
            .is_some_and(|tooth| tooth.starts_with("image:"))
    );
}

#[test]
fn a_script_goes_on_with_the_paints_of_the_document() {
    let place = Place::new();
    let table = maulstick_optics::paints::MEASURED.replace("Bone Black", "Tyrian Purple");
    place.write("own.csv", table);
    script(&place, "day.toml", "{ fill = \"Tyrian Purple\" },");
    let render = ["render", "--script", "day.toml", "-o", "day.png"];
    let file = ["--document", "day.maul"];
    has(
        &fault(&place, &render, 2),
        &["'Tyrian Purple'", "day.toml:2"],
    );
    let own = ["--size", "64x64", "--paints", "own.csv"];
    place.done(&[&render[..], &own, &file].concat());
    place.done(&[&render[..], &file].concat());
}

#[test]
fn nothing_is_said_where_nothing_is_wrong() {
    let place = Place::new();
    script(&place, "day.toml", "{ fill = \"Bone Black\" },");
    let render = [
        "render", "--script", "day.toml", "-o", "day.png", "--size", "64x64",
    ];
    let mut quiet = place.maulstick(&render);
    let output = quiet
        .env_remove("XDG_RUNTIME_DIR")
        .output()
        .expect("started");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    let processor = ["/dev/dri", "/dev/nvidiactl", "/dev/dxg"];
    // Where there is a graphics processor its drivers say what they like.
    if !processor
        .iter()
        .any(|node| std::path::Path::new(node).exists())
    {
        assert_eq!(said, "");
    }
}

/// Volume of an account of a ledger file, m³.
fn account(place: &Place, ledger: &str, name: &str) -> f64 {
    let ledger: serde_json::Value = serde_json::from_slice(&place.bytes(ledger)).expect("a ledger");
    assert_eq!(ledger["quanta_missing"], 0);
    ledger["accounts_m3"][name].as_f64().expect("a volume")
}

/// A canvas of 80×60 mm.
const DRYING_SIZE: [&str; 4] = ["--size", "320x240", "--cell-mm", "0.25"];
/// A drying that takes its time.
const SLOWLY: &str = "{ dry = 1.0, over = \"20s\", layer = \"slow\" },";

/// Carries out steps, with more options; volumes of the wet and the dry paint, m³.
fn dry(place: &Place, steps: &str, more: &[&str]) -> [f64; 2] {
    script(place, "day.toml", steps);
    let render = ["render", "--script", "day.toml", "-o", "day.png"];
    place.done(&[&render[..], &["--ledger", "l.json"], more].concat());
    ["canvas", "dry"].map(|name| account(place, "l.json", name))
}

/// Carries out steps on a new film.
fn dry_film(place: &Place, steps: &str, more: &[&str]) -> [f64; 2] {
    let film = "{ fill = \"Yellow Ochre=0.4,Titanium White=0.6\", um = 40 },";
    let more = [&DRYING_SIZE[..], more].concat();
    dry(place, &format!("{film}\n{steps}"), &more)
}

#[test]
fn paint_dries_in_parts_and_over_time_and_becomes_wet_again() {
    let place = Place::new();
    let film = |steps: &str| dry_film(&place, steps, &[]);
    let slowly = |steps: &str| film(&format!("{SLOWLY}\n{steps}"));
    let [all, none] = film("");
    assert_eq!(none, 0.0);
    let [wet, dry] = film("{ dry = 0.5, region = \"0,0,40x60\" },");
    assert!((dry / all - 0.25).abs() < 1e-3 && (wet + dry - all).abs() < 1e-6 * all);
    let [_, half] = slowly("{ wait = \"10s\" },");
    assert!((half / all - 0.5).abs() < 0.05, "{}", half / all);
    let half_picture = place.bytes("day.png");
    let [_, again] = slowly("{ wait = \"4s\" },\n{ wait = \"6s\" },");
    assert_eq!(half, again);
    assert_same(&half_picture, &place.bytes("day.png"), "one wait and two");
    let stop = "{ wait = \"10s\" },\n{ stop_drying = true },\n{ wait = \"1h\" },";
    assert_eq!(slowly(stop)[1], half);
    assert_eq!(slowly("{ wait = \"20s\" },")[0], 0.0);
    let wet_again = slowly("{ wait = \"20s\" },\n{ wet = \"all\" },");
    assert_eq!(wet_again, [all, 0.0]);
}

#[test]
fn paint_dries_while_a_take_is_played() {
    let place = Place::new();
    place.short_demo("flower.mcap", 3.0);
    let [all, _] = dry_film(&place, "", &[]);
    // The brush is lifted before the take's end.
    let take = "{ dry = 1.0, over = \"1s\" },\n{ load = \"Bone Black\" },\n{ take = \"flower.mcap\" },\n{ wait = \"1s\" },";
    let [wet, dry] = dry_film(&place, take, &[]);
    assert!(wet == 0.0 && dry > 0.5 * all, "{wet} {dry}");
}

#[test]
fn paint_goes_on_drying_in_a_document_that_was_closed_meanwhile() {
    let place = Place::new();
    let file = ["--document", "day.maul"];
    dry_film(&place, &format!("{SLOWLY}\n{{ wait = \"10s\" }},"), &file);
    let [wet, _] = dry(&place, "{ wait = \"10s\" },", &file);
    assert_eq!(wet, 0.0);
    let steps = "{ opacity = 0.5, layer = 1 },\n{ wet = 1 },";
    script(&place, "late.toml", steps);
    let late = ["render", "--script", "late.toml", "-o", "day.png"];
    has(
        &fault(&place, &[&late[..], &file].concat(), 2),
        &[
            "late.toml:3",
            "layer 1 (slow) has an opacity",
            "{ opacity = 1.0, layer = 1 }",
        ],
    );
}

/// A reflectance of a ground.
const GROUND: &str = "nm,reflectance\n400,0.1\n500,0.2\n600,0.6\n700,0.7\n";

/// The picture of a canvas without paint, with more options.
fn bare_canvas(place: &Place, more: &[&str]) -> Vec<u8> {
    script(place, "none.toml", "{ light = { intensity = 1.0 } },");
    let render = ["render", "--script", "none.toml", "-o", "day.png"];
    place.done(&[&render[..], more].concat());
    place.bytes("day.png")
}

#[test]
fn a_ground_may_have_any_reflectance_and_goes_with_the_painting() {
    let place = Place::new();
    place.write("size.csv", GROUND);
    let size = ["--size", "128x64", "--cell-mm", "0.25"];
    let file = ["--document", "day.maul"];
    let plain = bare_canvas(&place, &size);
    let toned = [&size[..], &["--ground", "size.csv"], &file].concat();
    let toned = bare_canvas(&place, &toned);
    assert!(plain != toned, "a ground of its own");
    script(&place, "ground.toml", "{ ground = \"size.csv\" },");
    let script_ground = ["render", "--script", "ground.toml", "-o", "day.png"];
    place.done(&[&script_ground[..], &size].concat());
    assert!(place.bytes("day.png") != plain, "a ground by a step");
    std::fs::remove_file(place.path("size.csv")).expect("removed");
    let opened = bare_canvas(&place, &file);
    assert_same(&toned, &opened, "opened without the file");
    let ground = support::info(&place, "day.maul")["ground"].clone();
    assert!(
        ground
            .as_str()
            .is_some_and(|ground| ground.starts_with("spectrum:"))
    );
    let late = ["render", "--script", "none.toml", "-o", "x.png"];
    let late = [&late[..], &["--ground", "grey"], &file].concat();
    has(&fault(&place, &late, 2), &["--ground", "new painting"]);
}

#[test]
fn a_ground_that_is_no_reflectance_is_refused_wherever_it_is_named() {
    let place = Place::new();
    script(&place, "none.toml", "{ light = { intensity = 1.0 } },");
    script(&place, "bad.toml", "{ ground = \"bad.csv\" },");
    let option = ["render", "--script", "none.toml", "-o", "x.png"];
    let option = [&option[..], &["--ground", "bad.csv"]].concat();
    for (text, line, words) in [
        ("400,0.5\n700,1.5\n", 2, "0 to 1"),
        ("400,0.5\n390,0.5\n", 2, "rise"),
        ("400,0.5\n", 1, "two wavelengths"),
    ] {
        place.write("bad.csv", text);
        let line = format!("bad.csv:{line}");
        for args in [
            &option[..],
            &["render", "--script", "bad.toml", "-o", "x.png"],
            &["canvas", "ground", "bad.csv"],
        ] {
            has(&fault(&place, args, 2), &[&line, words]);
        }
    }
}
