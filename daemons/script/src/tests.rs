use maulstick_painting::edits::{self, Relight, Undo};
use maulstick_types::scene::Light;

use super::steps::KINDS;
use super::*;

fn read_text(text: &str) -> Result<Script, UserError> {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("day.toml");
    std::fs::write(&path, text).expect("written");
    let linen = folder.path().join("linen.csv");
    std::fs::write(linen, "400,0.5\n700,1.5\n").expect("written");
    std::fs::write(folder.path().join("no.png"), "no picture").expect("written");
    Script::read(&path, &PaintLibrary::measured().expect("whole"))
}

#[test]
fn paints_are_counted_before_any_is_used() {
    let row = |number: usize, quantity: &str| {
        format!("P{number},PX,me,{quantity}{}\n", ",0.5".repeat(101))
    };
    let table: String = (0..=SLOTS)
        .map(|number| row(number, "K") + &row(number, "S"))
        .collect();
    let library = PaintLibrary::parse(&table).expect("paints");
    let text = |paints: usize| {
        let loads: String = (0..paints)
            .map(|number| format!("{{ load = \"P{number}\" }},\n"))
            .collect();
        format!("step = [\n{loads}{{ load = \"P0\" }},\n]\n")
    };
    let read = |paints| Script::parse(&text(paints), "day.toml", Path::new(""), &library);
    read(SLOTS).expect("as many as there is room for");
    let fault = read(SLOTS + 1).expect_err("one too many");
    assert!(fault.what.contains("65"), "{fault}");
    assert!(fault.to_string().contains("day.toml:66"), "{fault}");
}

fn read(steps: &str) -> Result<Script, UserError> {
    read_text(&format!("# a day\nstep = [\n{steps}\n]\n"))
}

#[test]
fn steps_are_read_in_their_order() {
    let steps = "{ brush = \"flat\", size_mm = 20 },\n{ load = \"Bone Black\" },\n{ clean = true },\n\
        { fill = \"Titanium White\", um = 30 },\n{ dry = 0.5, layer = \"sky\" },\n\
        { opacity = 0.3, layer = \"sky\" },\n{ light = { intensity = 2 } },\n{ undo = 2 }";
    let script = read(steps).expect("a script");
    assert_eq!(script.steps.len(), 8);
    assert!(
        matches!(&script.steps[0].1, Act::Brush(name, file, _) if name == "flat" && file.head.width_mm == 20.0)
    );
    assert!(matches!(script.steps[7].1, Act::Undo(2)));
    assert!(script.steps[4].0.ends_with("day.toml:7"));
    let long = "\u{feff}[[step]]\nload = \"Bone Black\"\n\n[[step]]\nundo = 0x2\n";
    let script = read_text(long).expect("a script in its long form");
    assert!(matches!(script.steps[1].1, Act::Undo(2)));
    assert!(
        script.steps[1].0.ends_with("day.toml:5"),
        "{}",
        script.steps[1].0
    );
}

#[test]
fn the_examples_of_the_help_are_right() {
    for kind in KINDS.iter() {
        match read(&format!("{},", kind.form.example)) {
            Ok(_) => {}
            // It names a file that is not here.
            Err(fault) => assert!(fault.what.contains("file"), "{fault}"),
        }
    }
}

/// The error of a script has these words, a place and help.
fn says(fault: Result<Script, UserError>, words: &[&str]) {
    let fault = fault.expect_err(words[0]);
    let text = fault.to_string();
    for word in words {
        assert!(text.contains(word), "{word}: {text}");
    }
    assert!(
        fault.place.is_some_and(|place| place.contains("day.toml")),
        "{text}"
    );
    assert!(fault.help.is_some_and(|help| !help.is_empty()), "{text}");
    assert!(!text.contains("''"), "{text}");
}

#[test]
fn a_fault_has_its_line_the_nearest_name_and_help() {
    for (steps, words) in [
        (
            "{ load = \"Bone Black\" },\n{ dri = 1.0 },",
            &["day.toml:4", "'dri'", "'dry'"][..],
        ),
        (
            "{ load = \"Bone Black\", besides = \"Bone Black\" }",
            &["'besides'", "'beside'"],
        ),
        ("{ load = \"Bone Balck\" }", &["day.toml:3", "'Bone Black'"]),
        ("{ size_mm = 3 }", &["day.toml:3", "does nothing"]),
        ("{}", &["day.toml:3", "does nothing"]),
        (
            "{ dry = 1.0, undo = 1 }",
            &["several things: dry, undo", "brush, take"],
        ),
        (
            "{ fill = \"Bone Black\", layer = \"x\" }",
            &["'layer'", "'fill' takes: um"],
        ),
        (
            "{ clean = true, um = 3 }",
            &["'um' does nothing", "no other key"],
        ),
    ] {
        says(read(steps), words);
    }
}

#[test]
fn a_file_that_is_wrong_is_named_with_the_line_that_names_it() {
    for (steps, words) in [
        (
            "{ take = \"none.mcap\" }",
            &["none.mcap, named at", "day.toml:3", "script's folder"][..],
        ),
        (
            "{ brush = \"none.toml\" }",
            &["none.toml, named at", "day.toml:3", "script's folder"],
        ),
        (
            "{ ground = \"none.csv\" }",
            &["none.csv, named at", "day.toml:3", "script's folder"],
        ),
        (
            "{ tooth = \"none.png\" }",
            &["none.png, named at", "day.toml:3", "script's folder"],
        ),
        (
            "{ light = { illuminant = \"none.csv\" } }",
            &["none.csv, named at", "day.toml:3"],
        ),
        (
            "{ ground = \"linen.csv\" }",
            &["linen.csv:2, named at", "day.toml:3"],
        ),
        (
            "{ tooth = \"no.png\" }",
            &["no.png, named at", "day.toml:3"],
        ),
    ] {
        says(read(steps), words);
    }
}

#[test]
fn a_name_that_is_unknown_is_told_with_the_nearest() {
    for (steps, words) in [
        (
            "{ brush = \"flta\" }",
            &["day.toml:3", "'flat'", "brush list"][..],
        ),
        (
            "{ ground = \"gesoo\" }",
            &["day.toml:3", "'gesoo'", "gesso"],
        ),
        ("{ tooth = \"lines\" }", &["day.toml:3", "'lines'", "linen"]),
        ("{ mode = \"spunge\" }", &["day.toml:3", "'sponge'"]),
        ("{ piles = \"stay\" }", &["day.toml:3", "deplete"]),
        (
            "{ light = { illuminant = \"D66\" } }",
            &["day.toml:3", "'D65'"],
        ),
        (
            "{ light = { intensty = 2 } }",
            &["day.toml:3", "'intensity'"],
        ),
        ("{ load = \"Bone Black=0\" }", &["day.toml:3", "'0'"]),
        ("{ wait = \"5 minutes\" }", &["day.toml:3", "90s"]),
        ("{ dry = 1, region = \"1,2\" }", &["day.toml:3", "X,Y,WxH"]),
    ] {
        says(read(steps), words);
    }
    let far = read("{ fill = \"zzz\" }")
        .expect_err("no paint")
        .to_string();
    assert!(!far.contains("Black"), "{far}");
}

#[test]
fn what_is_out_of_range_says_what_to_choose() {
    for (steps, words) in [
        (
            "{ opacity = 3, layer = \"x\" }",
            &["3", "choose 0 to 1"][..],
        ),
        ("{ dry = 0 }", &["0", "choose above 0"]),
        (
            "{ fill = \"Bone Black\", um = 6000 }",
            &["6000 µm", "choose 1 to 5000"],
        ),
        (
            "{ mode = \"marker\", flow = -1 }",
            &["-1 µm/mm", "choose 0.001"],
        ),
        ("{ stain_um = -2 }", &["-2 µm", "choose 0 to 1000"]),
        ("{ light = { intensity = -1 } }", &["-1", "choose 0 to 100"]),
        (
            "{ light = { direction = [0, 0, -1] } }",
            &["above", "give x, y, z"],
        ),
        (
            "{ brush = \"flat\", depth_share = 5.0 }",
            &["5", "help: choose 0 to 0.9"],
        ),
        (
            "{ brush = \"flat\", size_mm = 3000 }",
            &["3000", "0.1 to 300", "help: "],
        ),
        ("{ wet = 0 }", &["\"all\"", "help: for example { wet = 1 }"]),
        ("{ tooth = \"no.png\", width_mm = 0 }", &["day.toml:3"]),
        ("{ keep = \"\" }", &["blank"]),
        ("{ opacity = 0.5 }", &["layer", "layer = \"sky\""]),
    ] {
        says(read(steps), words);
    }
}

#[test]
fn a_stroke_that_cannot_be_painted_is_told_with_its_point() {
    for (steps, words) in [
        (
            "{ stroke = [] }",
            &["day.toml:3", "no points", "help: a point is [x_mm"][..],
        ),
        (
            "{ stroke = [[1, 2, 0.3], [4, 5]] }",
            &["point 2 has 2 numbers", "[x_mm, y_mm, pressure]"],
        ),
        (
            "{ stroke = [[1, 2, 0.3], [4, 5, 1.5]] }",
            &["a pressure of 1.5 at point 2", "choose 0 to 1"],
        ),
        (
            "{ stroke = [[1e9, 2, 0.3]] }",
            &["point 1 is at", "on the canvas or near it"],
        ),
        (
            "{ stroke = [[1, 2, 0.3]], lean_deg = 90 }",
            &["a lean_deg of 90", "choose 0 to 80"],
        ),
        (
            "{ stroke = [[1, 2, 0.3]],\n speed_mm_s = 0 }",
            &["day.toml:4", "a speed_mm_s of 0", "choose 1 to 2000"],
        ),
        (
            "{ stroke = [[1, 2, 0.3]], turn_deg = 5, twist_deg = 5 }",
            &["both turn the brush", "leave one out"],
        ),
        (
            "{ stroke = [[1, 2, 0.3], [4000, 2, 0.3]], speed_mm_s = 1 }",
            &["a stroke of 3999 s", "up to 600 s"],
        ),
        (
            "{ stroke = [1, 2] }",
            &["'stroke' takes a list of lists of numbers", "{ stroke = [["],
        ),
        (
            "{ stroke = [[1, 2, 0.3]], lean_degs = 5 }",
            &["'lean_degs'", "'lean_deg'"],
        ),
    ] {
        says(read(steps), words);
    }
}

#[test]
fn the_size_of_a_canvas_is_read_or_told() {
    let step = "step = [ { clean = true } ]";
    let script = read_text(&format!("canvas_mm = [200, 160.5]\n{step}")).expect("a script");
    assert_eq!(script.canvas_mm, Some([200.0, 160.5]));
    for (size, words) in [
        (
            "[200]",
            &["day.toml:1", "width and height", "[200, 160]"][..],
        ),
        ("[0, 10]", &["width and height"]),
        ("200", &["'canvas_mm' takes a list of numbers"]),
    ] {
        says(read_text(&format!("canvas_mm = {size}\n{step}")), words);
    }
}

#[test]
fn wrong_types() {
    for (steps, words) in [
        (
            "{ dry = \"all\" }",
            &[
                "day.toml:3",
                "'dry': invalid type: string \"all\", expected a number",
                "{ dry = 0.5",
            ][..],
        ),
        (
            "{ load = 3 }",
            &[
                "'load': invalid type: integer `3`, expected a text",
                "{ load = \"",
            ],
        ),
        (
            "{ brush = \"flat\",\n size_mm = \"big\" }",
            &["day.toml:4", "'size_mm'", "\"big\""],
        ),
        ("{ clean = \"yes\" }", &["'clean' takes true or false"]),
        (
            "{ undo = 1.5 }",
            &["'undo': invalid type: floating point `1.5`"],
        ),
        ("{ undo = -1 }", &["integer `-1`"]),
        ("{ undo = 5000000000 }", &["integer `5000000000`"]),
        (
            "{ take = \"x\", loads = \"Bone Black\" }",
            &["'loads' takes a list of texts"],
        ),
        (
            "{ take = \"x\", loads = [3] }",
            &["'loads' takes a list of texts"],
        ),
    ] {
        says(read(steps), words);
    }
}

#[test]
fn another_kind_of_value_within_a_table_is_told_with_key_and_line() {
    for (steps, words) in [
        (
            "{ light = \"A\" }",
            &["'light' takes a table", "{ light = {"][..],
        ),
        (
            "{ light = { direction = [1, 2] } }",
            &["'direction'", "length 3"],
        ),
        (
            "{ light = { direction = [1, \"up\", 2] } }",
            &["'direction'", "string \"up\""],
        ),
        (
            "{ light = { direction = 1 } }",
            &["'direction'", "integer `1`"],
        ),
        (
            "{ opacity = 1, layer = true }",
            &["'layer'", "boolean `true`"],
        ),
        ("{ fill = 1979-05-27 }", &["'fill'", "expected a text"]),
        (
            "{ dry = \"\"\"all\nof it, as soon as it can be managed at all, by whoever is there, with whatever lies at hand, wherever that may be, and however long it takes to do it all\"\"\" }",
            &["day.toml:3", r#"string "all\nof it"#, "…"],
        ),
    ] {
        says(read(steps), words);
    }
}

#[test]
fn what_would_do_nothing_is_refused() {
    for (steps, words) in [
        ("{ clean = false }", &["does nothing", "leave it out"][..]),
        ("{ undo = 0 }", &["does nothing", "leave it out"]),
        (
            "{ mode = \"sponge\", flow = 3 }",
            &["flow has no effect", "sponge", "marker"],
        ),
        (
            "{ mode = \"sampler\", most_um = 3 }",
            &["most_um has no effect", "sampler"],
        ),
        (
            "{ tooth = \"linen\", width_mm = 30 }",
            &["'width_mm' does nothing", "weave.png"],
        ),
        (
            "{ tooth = \"linen.png\", seed = 3 }",
            &["'seed' does nothing", "leave it out"],
        ),
        ("{ light = {} }", &["changes nothing"]),
        (
            "{ light = { rule = \"reference\", samples = 8 } }",
            &["samples has no effect"],
        ),
        (
            "{ take = \"x\", loads = [] }",
            &["does nothing", "leave it out"],
        ),
        (
            "{ dry = 0.5, over = \"9s\" }",
            &["all wet paint dries", "dry = 1.0"],
        ),
    ] {
        says(read(steps), words);
    }
}

#[test]
fn what_is_no_script_is_told_what_one_is() {
    for (text, words) in [
        ("", &["there are no steps"][..]),
        ("step = []", &["day.toml:1", "there are no steps"]),
        ("steps = []", &["day.toml:1", "'steps'", "only 'step'"]),
        (
            "\n[step]\nload = 1",
            &["day.toml:2", "a list of steps, not a table"],
        ),
        (
            "step = [ \"a\" ]",
            &["day.toml:1", "steps in braces, not the text \"a\""],
        ),
        (
            "step = [\n{ load = \"Bone Black } ]",
            &["day.toml:2", "no TOML"],
        ),
        (
            "step = [\n{ dry = 1.0, dry = 2 } ]",
            &["day.toml:2", "duplicate key"],
        ),
    ] {
        says(read_text(text), words);
        says(read_text(text), &["step = ["]);
    }
}

#[test]
fn a_hundred_thousand_steps_have_their_lines() {
    let steps = "{ clean = true },\n".repeat(100_000);
    let script = read(&steps).expect("a script");
    assert!(script.steps[99_999].0.ends_with("day.toml:100002"));
}

/// Edits that scripts do not have, because they need a pointer, or the script's own text takes their place.
const NOT_IN_SCRIPTS: [&str; 8] = [
    "branch",
    "forget",
    "go_to",
    "name_layer",
    "place",
    "redo",
    "tune",
    "wells",
];

#[test]
fn each_edit_is_read_from_its_step() {
    let mut without = Vec::new();
    for entry in edits::entries() {
        let example = (entry.example)().expect("in range");
        let Some(form) = entry.steps.first() else {
            without.push(entry.name);
            continue;
        };
        // The first of several examples.
        let end = form.example.find(" }, {");
        let end = end.map_or(form.example.len(), |at| at + 2);
        let script = read(&form.example[..end]).expect(form.example);
        match &script.steps[0].1 {
            Act::Edit(edit) => assert_eq!(*edit, example),
            Act::Undo(1) => assert!(example.is::<Undo>()),
            Act::Light(change) => {
                let light = change.on(&Light::default(), None, None).expect("a light");
                let edit: Relight = example.read().expect("a light");
                assert_eq!(light, edit.light);
            }
            act => panic!("{act:?}, not {example:?}"),
        }
    }
    without.sort_unstable();
    assert_eq!(without, NOT_IN_SCRIPTS);
}
