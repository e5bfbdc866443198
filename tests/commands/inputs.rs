//! What a command reads is never written over, nor one output over another.

use crate::support::{Place, fault, has};

/// A command that is refused; the files of the place stay as they are.
fn refused(place: &Place, arguments: &[&str], words: &[&str]) {
    let files = || {
        let folder = std::fs::read_dir(place.path("")).expect("a folder");
        let mut files: Vec<_> = folder
            .flatten()
            .filter_map(|entry| Some((entry.path(), std::fs::read(entry.path()).ok()?)))
            .collect();
        files.sort();
        files
    };
    let before = files();
    let said = fault(place, arguments, 2);
    has(&said, words);
    has(&said, &["-->", "help: "]);
    assert!(files() == before, "{arguments:?} changed files: {said}");
}

/// A place with a file of each kind that a painting is made of.
fn full() -> Place {
    let place = Place::new();
    place.short_demo("t.mcap", 0.5);
    let brush = maulstick_brush::BrushFile::library("flat").expect("a brush");
    let config = place.done(&["up", "--print-config"]).stdout;
    let config = String::from_utf8(config).expect("UTF-8");
    let weave = vec![127; 128];
    let mut png = Vec::new();
    let mut encoder = png::Encoder::new(&mut png, 16, 8);
    encoder.set_color(png::ColorType::Grayscale);
    let mut writer = encoder.write_header().expect("a header");
    writer.write_image_data(&weave).expect("pixels");
    writer.finish().expect("whole");
    let written = |name: &str, bytes: &[u8]| {
        std::fs::write(place.path(name), bytes).expect("written");
    };
    written("own.toml", brush.to_toml().expect("a file").as_bytes());
    written("rig.toml", config.as_bytes());
    written("p.csv", maulstick_optics::paints::MEASURED.as_bytes());
    written("lamp.csv", b"nm,power\n380,1\n780,2\n");
    written("size.csv", b"nm,reflectance\n400,0.1\n700,0.7\n");
    written("weave.png", &png);
    std::os::unix::fs::symlink("own.toml", place.path("link.toml")).expect("a link");
    place
}

#[test]
fn a_render_writes_over_nothing_that_it_reads() {
    let place = full();
    let take = "would take the place of the take";
    let brush = "would take the place of the brush";
    for (arguments, words) in [
        (&["-o", "t.mcap"][..], [take, "t.mcap"]),
        (&["-o", "q.png", "--ledger", "t.mcap"], ["the ledger", take]),
        (
            &["-o", "q.png", "--ledger", "./q.png"],
            ["the picture and the ledger", "one file"],
        ),
        (
            &["-o", "rig.toml", "--rig", "rig.toml"],
            ["the settings", "rig.toml"],
        ),
        (
            &["-o", "p.csv", "--paints", "p.csv"],
            ["the place of the paints", "p.csv"],
        ),
        (
            &["-o", "lamp.csv", "--illuminant", "lamp.csv"],
            ["the spectrum of the light", "lamp.csv"],
        ),
        (
            &["-o", "size.csv", "--ground", "size.csv"],
            ["the place of the ground", "size.csv"],
        ),
        (
            &["-o", "link.toml", "--brush", "own.toml"],
            [brush, "link.toml"],
        ),
        (
            &[
                "-o",
                "q.png",
                "--ledger",
                "own.toml",
                "--brush",
                "link.toml",
            ],
            ["the ledger", brush],
        ),
        (
            &["-o", "new.maul", "--document", "new.maul"],
            ["the place of the painting", "new.maul"],
        ),
        (
            &["-o", "new.maul-wal", "--document", "new.maul"],
            ["may belong to a painting", "new.maul-wal"],
        ),
    ] {
        refused(&place, &[&["render", "t.mcap"], arguments].concat(), &words);
    }
}

#[test]
fn nor_over_what_its_script_names() {
    let place = full();
    for (step, file, what) in [
        ("take = \"t.mcap\"", "t.mcap", "the take at day.toml:2"),
        (
            "brush = \"link.toml\"",
            "own.toml",
            "the brush at day.toml:2",
        ),
        (
            "ground = \"size.csv\"",
            "size.csv",
            "the ground at day.toml:2",
        ),
        (
            "tooth = \"weave.png\"",
            "weave.png",
            "the tooth at day.toml:2",
        ),
        (
            "light = { illuminant = \"lamp.csv\" }",
            "lamp.csv",
            "the spectrum of the light",
        ),
        (
            "light = { environment = \"weave.png\" }",
            "weave.png",
            "the environment",
        ),
    ] {
        let script = format!("step = [\n{{ {step} }},\n]\n");
        std::fs::write(place.path("day.toml"), script).expect("written");
        let render = ["render", "--script", "day.toml", "-o"];
        refused(&place, &[&render[..], &[file]].concat(), &[what, file]);
        let ledger = [&render[..], &["q.png", "--ledger", file]].concat();
        refused(&place, &ledger, &["the ledger", what]);
    }
}

#[test]
fn other_commands_write_over_nothing_that_they_read() {
    let place = full();
    std::fs::write(place.path("one.csv"), "0 1 2 0\n0.1 1 2 0.5\n").expect("written");
    for (arguments, words) in [
        (
            &["take", "import", "one.csv", "-o", "one.csv"][..],
            ["the place of the table", "one.csv"],
        ),
        (
            &[
                "device",
                "force",
                "--brush",
                "own.toml",
                "--plot",
                "link.toml",
            ],
            ["the place of the brush", "link.toml"],
        ),
        (
            &["take", "embed", "t.mcap", "-o", "t.mcap"],
            ["stays as it is", "t.mcap"],
        ),
        (
            &[
                "take", "embed", "t.mcap", "--brush", "own.toml", "-o", "own.toml",
            ],
            ["the place of the brush", "own.toml"],
        ),
        (
            &["take", "recover", "t.mcap", "-o", "./t.mcap"],
            ["the damaged file", "t.mcap"],
        ),
        (
            &["brush", "import", "own.toml", "-o", "link.toml"],
            ["the place of the model", "link.toml"],
        ),
        (
            &[
                "up",
                "--headless",
                "--play",
                "t.mcap",
                "--snapshot",
                "t.mcap",
            ],
            ["the place of the take", "t.mcap"],
        ),
    ] {
        refused(&place, arguments, &words);
    }
}

#[test]
fn options_that_do_nothing_are_refused() {
    let place = Place::new();
    has(
        &fault(&place, &["device", "force", "--stiffness-n-m", "900"], 2),
        &["--stiffness-n-m does nothing", "--model rigid"],
    );
    has(
        &fault(&place, &["device", "force", "--depth-mm", "5..5"], 2),
        &["'5..5'", "FROM must be less than TO"],
    );
    has(
        &fault(&place, &["device", "force", "--angle-deg", "91"], 2),
        &["'91'", "0 to 90"],
    );
    let rows = |depths: &str| {
        let force = [
            "device",
            "force",
            "--json",
            "--angle-deg",
            "0",
            "--depth-mm",
            depths,
        ];
        place.done(&force).stdout
    };
    assert!(rows("5,1,5") == rows("1,5"), "depths rise, each once");
}
