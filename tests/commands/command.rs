//! The command as its users call it: what it makes, and what it says to bad input.

mod beside;
mod inputs;
mod rigs;
#[path = "../support/mod.rs"]
mod support;

use support::{COARSE, Place, fault, has};

#[test]
fn a_demo_becomes_a_picture_the_same_every_time() {
    let place = Place::new();
    place.done(&["demo", "take", "-o", "demo.mcap"]);
    let loads = [
        "--load",
        "Ultramarine Blue",
        "--load",
        "Yellow Ochre=0.5,Titanium White=0.5",
    ];
    for picture in ["one.png", "two.png"] {
        let mut args = vec![
            "render",
            "demo.mcap",
            "-o",
            picture,
            "--ledger",
            "ledger.json",
        ];
        args.extend(loads);
        args.extend(COARSE);
        place.done(&args);
    }
    support::assert_same(
        &place.bytes("one.png"),
        &place.bytes("two.png"),
        "two renders",
    );
    let ledger: serde_json::Value =
        serde_json::from_slice(&place.bytes("ledger.json")).expect("JSON");
    assert_eq!(ledger["quanta_missing"], 0);
    let sum: f64 = ["tube", "brush", "canvas", "palette", "cleaner"]
        .iter()
        .map(|account| ledger["accounts_m3"][account].as_f64().expect("a number"))
        .sum();
    assert!(sum.abs() < 1e-18, "{sum}");
    assert!(ledger["paints_m3"]["Ultramarine Blue"]["canvas"].as_f64() > Some(0.0));
    // Another load is another picture.
    let other = ["--load", "Bone Black", COARSE[0], COARSE[1]];
    place.done(&[&["render", "demo.mcap", "-o", "three.png"][..], &other].concat());
    assert!(place.bytes("one.png") != place.bytes("three.png"));
}

/// Picture of a take by these options.
fn painted(place: &Place, take: &str, picture: &str, kit: &[&str]) -> Vec<u8> {
    place.done(&[&["render", take, "-o", picture], kit].concat());
    place.bytes(picture)
}

/// Options with a brush in a file of its own, and a canvas of small cost.
const KIT: [&str; 10] = [
    "--brush",
    "own.toml",
    "--size",
    "320x300",
    "--cell-mm",
    "0.5",
    "--illuminant",
    "A",
    "--load",
    "Pyrrole Red",
];

/// Embeds [`KIT`] in `bare.mcap`, as each of some takes.
fn embed(place: &Place, takes: &[&str]) {
    let brush = maulstick_brush::BrushFile::library("filbert").expect("a brush");
    std::fs::write(place.path("own.toml"), brush.to_toml().expect("a file")).expect("written");
    for take in takes {
        place.done(&[&["take", "embed", "bare.mcap", "-o", take], &KIT[..]].concat());
    }
}

#[test]
fn a_take_that_embeds_what_it_is_painted_with_gives_the_same_painting() {
    let place = Place::new();
    // The sweeps of its first seconds begin on the palette beside a small canvas.
    place.short_demo("bare.mcap", 16.0);
    embed(&place, &["whole.mcap", "again.mcap"]);
    let wanted = painted(&place, "bare.mcap", "options.png", &KIT);
    support::assert_same(
        &place.bytes("whole.mcap"),
        &place.bytes("again.mcap"),
        "one take embedded twice",
    );
    std::fs::remove_file(place.path("own.toml")).expect("removed");
    let got = painted(&place, "whole.mcap", "embedded.png", &[]);
    support::assert_same(&wanted, &got, "by options and by what the take embeds");
    assert!(painted(&place, "bare.mcap", "plain.png", &COARSE) != wanted);
    let other = painted(&place, "whole.mcap", "other.png", &["--load", "Bone Black"]);
    assert!(other != wanted, "an option wins over what the take embeds");
    place.done(&[
        "up",
        "--headless",
        "--play",
        "whole.mcap",
        "--rate",
        "max",
        "--snapshot",
        "live.png",
    ]);
    support::assert_same(&wanted, &place.bytes("live.png"), "rendered and live");
    has(
        &String::from_utf8_lossy(&place.done(&["take", "info", "whole.mcap"]).stdout),
        &["embeds", "Pyrrole Red"],
    );
}

#[test]
fn a_picture_as_ground_goes_with_the_take() {
    let place = Place::new();
    place.short_demo("bare.mcap", 3.0);
    let plain = painted(&place, "bare.mcap", "Ground.PNG", &COARSE);
    let paint = ["--load", "Pyrrole Red"];
    let ground = [&["--ground", "Ground.PNG"], &paint[..], &COARSE].concat();
    let wanted = painted(&place, "bare.mcap", "on-picture.png", &ground);
    assert!(wanted != plain);
    let embed = ["take", "embed", "bare.mcap", "-o", "pictured.mcap"];
    place.done(&[&embed[..], &ground].concat());
    std::fs::remove_file(place.path("Ground.PNG")).expect("removed");
    let got = painted(&place, "pictured.mcap", "embedded.png", &[]);
    support::assert_same(
        &wanted,
        &got,
        "on a picture, and on the one that the take embeds",
    );
}

/// The samples of a take whose brush is damaged can be had, and nothing else is painted in its place.
#[test]
fn a_damaged_brush_of_a_take_is_refused() {
    let place = Place::new();
    place.short_demo("bare.mcap", 0.5);
    embed(&place, &["whole.mcap"]);
    let mut bytes = place.bytes("whole.mcap");
    let at = bytes.windows(6).position(|found| found == b"[head]");
    bytes[at.expect("a brush file") + 1] = b'x';
    std::fs::write(place.path("torn.mcap"), bytes).expect("written");
    has(
        &fault(&place, &["render", "torn.mcap", "-o", "p.png"], 2),
        &["torn.mcap", "embeds", "take embed"],
    );
}

#[test]
fn the_canvas_has_the_size_that_is_asked_for() {
    let place = Place::new();
    place.short_demo("demo.mcap", 1.0);
    let pixels = |options: &[&str]| {
        place.done(&[&["render", "demo.mcap", "-o", "p.png"], options].concat());
        let picture = std::fs::File::open(place.path("p.png")).expect("there");
        let reader = png::Decoder::new(std::io::BufReader::new(picture))
            .read_info()
            .expect("a PNG");
        (reader.info().width, reader.info().height)
    };
    assert_eq!(pixels(&["--size", "640x333"]), (640, 333));
    // 256 mm, on cells of a picture and others; those of the settings where they are given.
    assert_eq!(pixels(&[]), (2048, 2048));
    assert_eq!(pixels(&["--cell-mm", "0.5"]), (512, 512));
    let config = place.done(&["up", "--print-config"]).stdout;
    let config = String::from_utf8(config).expect("UTF-8");
    let narrow = config.replace("width_mm = 256", "width_mm = 128");
    std::fs::write(place.path("rig.toml"), narrow).expect("written");
    assert_eq!(pixels(&["--rig", "rig.toml"]), (512, 1024));
    let both = ["--rig", "rig.toml", "--cell-mm", "1"];
    assert_eq!(pixels(&both), (128, 256));
}

#[test]
fn cells_that_cannot_be_are_refused_and_a_painting_keeps_its_own() {
    let place = Place::new();
    place.short_demo("d.mcap", 0.5);
    let commands: [&[&str]; 3] = [
        &["render", "d.mcap", "-o", "p.png"],
        &["up", "--headless"],
        &["take", "embed", "d.mcap", "-o", "p.png"],
    ];
    for command in commands {
        for cell in ["0", "nan", "10", "-0.1", "fine"] {
            let said = fault(&place, &[command, &["--cell-mm", cell]].concat(), 2);
            has(&said, &["--cell-mm", cell, "0.125"]);
            assert!(!place.path("p.png").exists(), "{command:?} {cell}");
        }
    }
    for command in commands {
        let vast = ["--cell-mm", "0.02", "--size", "65536x65536"];
        let said = fault(&place, &[command, &vast[..]].concat(), 2);
        has(
            &said,
            &["65536×65536 cells of 0.02 mm", "--cell-mm", "larger cells"],
        );
    }
    let render = ["render", "d.mcap", "-o", "p.png", "--document", "x.maul"];
    place.done(&[&render[..], &["--cell-mm", "0.5"]].concat());
    place.done(&render);
    assert_eq!(
        support::info(&place, "x.maul")["cells"],
        serde_json::json!([512, 512])
    );
    let other = fault(&place, &[&render[..], &["--cell-mm", "0.25"]].concat(), 2);
    has(&other, &["--cell-mm is for a new painting", "x.maul"]);
}

#[test]
fn a_gpu_that_must_be_there_and_is_not_is_told() {
    let place = Place::new();
    place.short_demo("demo.mcap", 1.0);
    let render = ["render", "demo.mcap", "-o", "p.png", "--backend", "gpu"];
    let render = [&render[..], &COARSE].concat();
    let mut without = place.maulstick(&render);
    for drivers in [
        "VK_DRIVER_FILES",
        "VK_ICD_FILENAMES",
        "__EGL_VENDOR_LIBRARY_FILENAMES",
    ] {
        without.env(drivers, "/nonexistent");
    }
    let output = without.output().expect("started");
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{told}");
    for part in ["by a GPU", "--backend", "Vulkan driver"] {
        assert!(told.contains(part), "{told}");
    }
    assert!(!place.path("p.png").exists());
    place.done(&render);
}

#[test]
fn bad_tables_are_refused_with_their_line() {
    let place = Place::new();
    let import = |rows: &str| {
        std::fs::write(place.path("t.dat"), rows).expect("written");
        let said = fault(&place, &["take", "import", "t.dat", "-o", "t.mcap"], 2);
        assert!(!place.path("t.mcap").exists(), "half-written: {said}");
        said
    };
    has(
        &import("0 1 2 0\n0.1 1 2\n"),
        &["t.dat:2", "3 columns", "pressure", "help:"],
    );
    has(
        &import("0 1 2 0\n0.1 a 2 0\n"),
        &["t.dat:2", "'a' is not a number"],
    );
    has(
        &import("0 1 2 0\n0.1 1 nan 0\n"),
        &["t.dat:2", "not finite"],
    );
    has(
        &import("1 1 2 0\n0.5 1 2 0\n"),
        &["t.dat:2", "time runs backward"],
    );
    has(&import("0 1 2 1.01\n"), &["t.dat:1", "1.01", "0 and 1"]);
    has(&import(""), &["no samples"]);
    has(
        &fault(&place, &["take", "import", "none.dat", "-o", "t.mcap"], 2),
        &["none.dat", "check the path"],
    );
    std::fs::write(place.path("t.dat"), "0 1 2 0\n").expect("written");
    has(
        &fault(&place, &["take", "import", "t.dat", "-o", "no/t.mcap"], 1),
        &["no/t.mcap", "folder"],
    );
}

#[test]
fn bad_takes_are_refused_and_damaged_ones_recovered() {
    let place = Place::new();
    place.done(&["demo", "take", "-o", "demo.mcap"]);
    let whole = place.bytes("demo.mcap");
    std::fs::write(place.path("cut.mcap"), &whole[..whole.len() * 2 / 3]).expect("written");
    let said = fault(&place, &["render", "cut.mcap", "-o", "p.png"], 2);
    has(&said, &["damaged", "cut.mcap", "maulstick take recover"]);
    assert!(!place.path("p.png").exists());
    has(
        &fault(&place, &["up", "--headless", "--play", "cut.mcap"], 2),
        &["damaged"],
    );
    place.done(&["take", "recover", "cut.mcap", "-o", "saved.mcap"]);
    place.done(&[&["render", "saved.mcap", "-o", "p.png"], &COARSE[..]].concat());
    has(
        &fault(&place, &["render", "p.png", "-o", "q.png"], 2),
        &["not an MCAP file"],
    );
    let info = place.done(&["take", "info", "demo.mcap", "--json"]);
    let info: serde_json::Value = serde_json::from_slice(&info.stdout).expect("JSON");
    assert_eq!(info["device"], "demo");
}

#[test]
fn bad_options_are_refused_with_the_nearest_name() {
    let place = Place::new();
    place.short_demo("d.mcap", 0.5);
    let render = |extra: &[&str]| {
        let mut args = vec!["render", "d.mcap", "-o", "p.png"];
        args.extend(extra);
        let said = fault(&place, &args, 2);
        assert!(!place.path("p.png").exists());
        said
    };
    has(
        &render(&["--load", "Colbat Blue"]),
        &["'Colbat Blue'", "'Cobalt Blue'", "--load"],
    );
    has(
        &render(&["--load", "Cobalt Blue=0,Bone Black=0.4"]),
        &["'Cobalt Blue' is '0'"],
    );
    has(&render(&["--brush", "ruond"]), &["'ruond'", "'round'"]);
    has(&render(&["--size", "0x4"]), &["0x4"]);
    has(&render(&["--rig", "none.toml"]), &["none.toml"]);
    let said = fault(&place, &["render", "d.mcap", "-o", "no/p.png"], 1);
    has(&said, &["no/p.png", "cannot write"]);
    has(
        &fault(&place, &["render", "d.mcap", "-o", "."], 1),
        &["cannot write"],
    );
    let row = |name: &str, quantity: &str| {
        let values = ",0.5".repeat(101);
        format!("{name},PX,me,{quantity}{values}\n")
    };
    let names: Vec<String> = (0..65).map(|number| format!("Own {number}")).collect();
    let table: String = names
        .iter()
        .map(|name| row(name, "K") + &row(name, "S"))
        .collect();
    std::fs::write(place.path("own.csv"), table).expect("written");
    let loads = names.iter().flat_map(|name| ["--load", name]);
    let many: Vec<&str> = ["--paints", "own.csv"].into_iter().chain(loads).collect();
    has(&render(&many), &["paint 65", "at most 64"]);
}

#[test]
fn bad_settings_are_refused_with_their_line() {
    let place = Place::new();
    place.short_demo("d.mcap", 0.5);
    let rig = |change: (&str, &str)| {
        let config = place.done(&["up", "--print-config"]);
        let text = String::from_utf8(config.stdout).expect("UTF-8");
        assert!(text.contains(change.0));
        std::fs::write(place.path("rig.toml"), text.replace(change.0, change.1)).expect("written");
        fault(&place, &["up", "--headless", "--rig", "rig.toml"], 2)
    };
    has(
        &rig(("cell_mm = 0.25 ", "cell_m = 0.25 ")),
        &["unknown key 'cell_m'", "'cell_mm'", "rig.toml:12"],
    );
    has(
        &rig(("driver = \"simulated\"", "driver = \"phantom\"")),
        &["driver", "simulated", "rig.toml:32"],
    );
    has(
        &rig(("kind = \"round\"", "kind = \"flatt\"")),
        &["'flatt'", "flat"],
    );
    has(
        &rig(("ground = \"gesso\"", "ground = \"gesoo\"")),
        &["gesoo", "gesso"],
    );
    has(
        &rig(("\"Bone Black\"", "\"Bone Blak\"")),
        &["Bone Blak", "'Bone Black'"],
    );
}

#[test]
fn schemas_and_paints_are_listed() {
    let place = Place::new();
    let schema = place.done(&["schema", "--json"]);
    let schema: serde_json::Value = serde_json::from_slice(&schema.stdout).expect("JSON");
    let messages = schema["messages"].as_array().expect("messages");
    assert!(
        messages
            .iter()
            .any(|message| message["name"] == "StylusSample")
    );
    has(
        &fault(&place, &["schema", "StylusSampel"], 2),
        &["'StylusSample'"],
    );
    let paints = place.done(&["colour", "paints", "--json"]);
    let paints: serde_json::Value = serde_json::from_slice(&paints.stdout).expect("JSON");
    assert_eq!(paints["paints"].as_array().map(Vec::len), Some(28));
}

#[test]
fn the_doctor_has_a_finding_for_each_check_and_an_exit_code() {
    let place = Place::new();
    let said = place.run(&["doctor", "--json"]);
    let findings: serde_json::Value = serde_json::from_slice(&said.stdout).expect("JSON");
    let findings = findings.as_array().expect("findings");
    let named = |check: &str| findings.iter().any(|finding| finding["check"] == check);
    for check in [
        "graphics",
        "display",
        "sockets",
        "disk",
        "device",
        "real time",
    ] {
        assert!(named(check), "{check} is missing in {findings:?}");
    }
    let mut wrong = findings
        .iter()
        .filter(|finding| finding["state"] == "wrong");
    assert_eq!(said.status.code(), Some(i32::from(wrong.next().is_some())));
    for finding in findings {
        let is_ok = finding["state"] == "ok";
        assert_eq!(finding["mend"].is_null(), is_ok, "{finding}");
    }
    // Sockets cannot be where others may write.
    let shared = place
        .maulstick(&["doctor"])
        .env("XDG_RUNTIME_DIR", "/proc")
        .output()
        .expect("started");
    assert_eq!(shared.status.code(), Some(1));
    has(
        &String::from_utf8_lossy(&shared.stdout),
        &["wrong    sockets", "mend: "],
    );
}

#[test]
fn a_faulty_command_is_told_before_a_rig_is_asked() {
    let place = Place::new();
    let name = "b".repeat(65);
    for args in [
        &["brush", "tune", "--brush", &name, "--stiffness", "2"][..],
        &["load", "--brush", &name, "Bone Black"],
        &["brush", "clean", "--brush", &name],
    ] {
        has(&fault(&place, args, 2), &[&name[..20]]);
    }
}

#[test]
fn without_a_rig_nothing_answers_and_says_so() {
    let place = Place::new();
    for args in [
        &["endpoint"][..],
        &["undo"],
        &["load", "Bone Black"],
        &["snapshot", "-o", "p.png"],
    ] {
        let said = fault(&place, args, 1);
        has(
            &said,
            &["no rig called 'studio' is running", "maulstick up"],
        );
    }
}
