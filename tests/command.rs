//! The command as its users call it: what it makes, and what it says to bad input.

mod support;

use support::{Place, fault, has};

#[test]
fn a_demo_becomes_a_picture_the_same_every_time() {
    let place = Place::new();
    place.done(&["demo", "-o", "demo.mcap"]);
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
    place.done(&[
        "render",
        "demo.mcap",
        "-o",
        "three.png",
        "--load",
        "Bone Black",
    ]);
    assert!(place.bytes("one.png") != place.bytes("three.png"));
}

#[test]
fn a_take_that_embeds_what_it_is_painted_with_gives_the_same_painting() {
    let place = Place::new();
    place.short_demo("bare.mcap", 4.0);
    let brush = maulstick_brush::BrushFile::library("filbert").expect("a brush");
    std::fs::write(place.path("own.toml"), brush.to_toml().expect("a file")).expect("written");
    let kit = [
        "--brush",
        "own.toml",
        "--size",
        "640x600",
        "--illuminant",
        "A",
        "--load",
        "Pyrrole Red",
    ];
    let paint = |take: &str, picture: &str, kit: &[&str]| {
        place.done(&[&["render", take, "-o", picture], kit].concat());
        place.bytes(picture)
    };
    let wanted = paint("bare.mcap", "options.png", &kit);
    for name in ["whole.mcap", "again.mcap"] {
        place.done(&[&["take", "embed", "bare.mcap", "-o", name], &kit[..]].concat());
    }
    support::assert_same(
        &place.bytes("whole.mcap"),
        &place.bytes("again.mcap"),
        "one take embedded twice",
    );
    std::fs::remove_file(place.path("own.toml")).expect("removed");
    let got = paint("whole.mcap", "embedded.png", &[]);
    support::assert_same(&wanted, &got, "by options and by what the take embeds");
    assert!(paint("bare.mcap", "plain.png", &[]) != wanted);
    let other = paint("whole.mcap", "other.png", &["--load", "Bone Black"]);
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

    // Its brush is damaged: the samples can be had, and nothing else is painted in its place.
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
    place.done(&["render", "demo.mcap", "-o", "p.png", "--size", "640x333"]);
    let picture = std::fs::File::open(place.path("p.png")).expect("there");
    let reader = png::Decoder::new(std::io::BufReader::new(picture))
        .read_info()
        .expect("a PNG");
    assert_eq!((reader.info().width, reader.info().height), (640, 333));
}

#[test]
fn a_gpu_that_must_be_there_and_is_not_is_told() {
    let place = Place::new();
    place.short_demo("demo.mcap", 1.0);
    let render = ["render", "demo.mcap", "-o", "p.png", "--backend", "gpu"];
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
        let said = fault(&place, &["import", "t.dat", "-o", "t.mcap"], 2);
        assert!(!place.path("t.mcap").exists(), "half-written: {said}");
        said
    };
    has(
        &import("0 1 2 0\n0.1 1 2\n"),
        &["t.dat:2", "pressure", "missing", "help:"],
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
        &fault(&place, &["import", "none.dat", "-o", "t.mcap"], 2),
        &["none.dat", "check the path"],
    );
    std::fs::write(place.path("t.dat"), "0 1 2 0\n").expect("written");
    has(
        &fault(&place, &["import", "t.dat", "-o", "no/t.mcap"], 1),
        &["no/t.mcap", "folder"],
    );
}

#[test]
fn bad_takes_are_refused_and_damaged_ones_recovered() {
    let place = Place::new();
    place.done(&["demo", "-o", "demo.mcap"]);
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
    place.done(&["render", "saved.mcap", "-o", "p.png"]);
    has(
        &fault(&place, &["render", "p.png", "-o", "q.png"], 2),
        &["no MCAP file"],
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
        &render(&["--load", "Cobalt Blue=0.5,Bone Black=0.4"]),
        &["sum to 0.9"],
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
    let seventeen = [
        "Titanium White",
        "Hansa Yellow Opaque",
        "Bismuth Vanadate Yellow",
        "Diarylide Yellow",
        "Cadmium Orange",
        "Pyrrole Orange",
        "Cadmium Red Light",
        "Pyrrole Red",
        "Quinacridone Red",
        "Quinacridone Magenta",
        "Dioxazine Purple",
        "Ultramarine Blue",
        "Cobalt Blue",
        "Cerulean Blue",
        "Phthalo Blue Red Shade",
        "Phthalo Green Blue Shade",
        "Bone Black",
    ];
    let loads: Vec<&str> = seventeen
        .iter()
        .flat_map(|paint| ["--load", paint])
        .collect();
    has(&render(&loads), &["paint 17", "at most 16"]);
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
        &["driver", "'simulated'", "rig.toml:31"],
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
    let paints = place.done(&["paints", "--json"]);
    let paints: serde_json::Value = serde_json::from_slice(&paints.stdout).expect("JSON");
    assert_eq!(paints["paints"].as_array().map(Vec::len), Some(28));
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

/// A spine of two joints, and a stroke of three poses: in the air, pressed, dragged.
const SPINE: &str = "lengths_m = [0.01, 0.008]\nstiffness_nm_per_rad = [3e-4, 1e-4]\nmu = 0.25\n";
const POSES: &str = "t,x,y,z,qx,qy,qz,qw\n\
    0,0,0,0.02,0,0,0,1\n\
    0.1,0,0,0.012,0,0.1,0,0.99498743710662\n\
    0.2,0.004,0,0.012,0,0.1,0,0.99498743710662\n";

/// What `brush solve` is asked for.
fn trial(place: &Place, spine: &str, poses: &str) -> [&'static str; 7] {
    std::fs::write(place.path("s.toml"), spine).expect("written");
    std::fs::write(place.path("p.csv"), poses).expect("written");
    [
        "brush", "solve", "--spine", "s.toml", "--poses", "p.csv", "--json",
    ]
}

#[test]
fn a_spine_is_tried_out() {
    let place = Place::new();
    let said = place.done(&trial(&place, SPINE, POSES)).stdout;
    let rows: Vec<serde_json::Value> = String::from_utf8(said)
        .expect("UTF-8")
        .lines()
        .map(|line| serde_json::from_str(line).expect("a line a pose"))
        .collect();
    assert_eq!(rows.len(), 3);
    for row in &rows {
        let number = |value: &serde_json::Value| value.as_f64().expect("a number");
        assert!(number(&row["residual"]) <= 1e-6, "{row}");
        assert!(number(&row["penetration_m"]) <= 1e-6 * 0.018, "{row}");
        assert!(row["iterations"].is_u64() && row["converged"] == true);
        for list in ["joints", "theta", "phi"] {
            assert_eq!(row[list].as_array().map(Vec::len), Some(2), "{list}");
        }
        let energy = &row["energy"];
        let parts = ["spring", "friction", "damping"].map(|part| number(&energy[part]));
        let sum: f64 = parts.iter().sum();
        assert!((sum - number(&energy["total"])).abs() <= 1e-15, "{energy}");
        // The segments keep their lengths.
        let at = |joint: usize, axis: usize| number(&row["joints"][joint][axis]);
        let square: f64 = (0..3).map(|axis| (at(1, axis) - at(0, axis)).powi(2)).sum();
        assert!((square.sqrt() - 0.008).abs() < 1e-12);
    }
    let friction = |row: usize| rows[row]["energy"]["friction"].as_f64();
    assert_eq!(friction(1), Some(0.0), "the first touch has none");
    assert!(friction(2) > Some(0.0));
    let table = place.done(&["brush", "solve", "--spine", "s.toml", "--poses", "p.csv"]);
    assert_eq!(String::from_utf8_lossy(&table.stdout).lines().count(), 5);
}

#[test]
fn bad_spines_are_refused_with_their_field() {
    let place = Place::new();
    let refused = |from: &str, to: &str| {
        assert!(SPINE.contains(from), "{from}");
        fault(&place, &trial(&place, &SPINE.replace(from, to), POSES), 2)
    };
    has(
        &refused("mu = ", "mue = "),
        &["unknown key 'mue'", "'mu'", "s.toml:3"],
    );
    has(&refused("0.008", "0.0"), &["lengths_m[1] is 0", "s.toml"]);
    has(&refused("0.008", "-1.0"), &["lengths_m[1] is -1", "s.toml"]);
    has(
        &refused("1e-4", "-1e-4"),
        &["stiffness_nm_per_rad[1] is -0.0001", "s.toml"],
    );
    has(
        &refused(", 1e-4", ""),
        &["stiffness_nm_per_rad", "2 joints"],
    );
    has(&refused("mu = 0.25", "mu = nan"), &["mu is NaN", "s.toml"]);
    has(
        &refused("mu = 0.25", "damping_nm = [0.0]"),
        &["damping_nm", "2 joints"],
    );
    has(
        &refused("mu = 0.25", "c_eta = 2.0"),
        &["c_eta is 2", "0 to 1"],
    );
    let many = |joints: usize| {
        let list = |value: f64| format!("{:?}", vec![value; joints]);
        let (lengths, stiffness) = (list(0.018 / joints as f64), list(1e-3));
        format!("lengths_m = {lengths}\nstiffness_nm_per_rad = {stiffness}\n")
    };
    place.done(&trial(&place, &many(1), POSES));
    place.done(&trial(&place, &many(64), POSES));
    has(
        &fault(&place, &trial(&place, &many(65), POSES), 2),
        &["lengths_m (number) is 65", "1 to 64"],
    );
}

#[test]
fn bad_poses_are_refused_with_their_line() {
    let place = Place::new();
    let refused = |poses: &str| fault(&place, &trial(&place, SPINE, poses), 2);
    has(&refused(""), &["empty", "p.csv:1", "t,x,y,z,qx,qy,qz,qw"]);
    has(
        &refused("0,0,0,0.02,0,0,0,1\n"),
        &["not the header", "p.csv:1"],
    );
    has(&refused("t,x,y,z,qx,qy,qz,qw\n"), &["no poses", "p.csv:1"]);
    let changed = |from: &str, to: &str| {
        assert!(POSES.contains(from), "{from}");
        refused(&POSES.replace(from, to))
    };
    has(
        &changed("0.2,0.004,", "0.2,nan,"),
        &["x: 'nan' is not finite", "p.csv:4"],
    );
    has(
        &changed("0.2,0.004,", "0.2,a,"),
        &["x: 'a' is not a number", "p.csv:4"],
    );
    has(&changed("0.2,0.004,", "0.2,"), &["7 columns", "p.csv:4"]);
    has(
        &changed("0.2,0.004,", "0.1,0.004,"),
        &["time does not rise", "p.csv:4"],
    );
    has(
        &changed("0,0.1,0,0.99", "0,0.3,0,0.99"),
        &["qx,qy,qz,qw", "p.csv:3", "unit quaternion"],
    );
    trial(&place, SPINE, POSES);
    has(
        &fault(
            &place,
            &["brush", "solve", "--spine", "s.toml", "--poses", "none.csv"],
            2,
        ),
        &["none.csv", "check the path"],
    );
}

#[test]
fn the_librarys_brushes_are_listed() {
    let place = Place::new();
    let brushes = place.done(&["brush", "list", "--json"]);
    let brushes: serde_json::Value = serde_json::from_slice(&brushes.stdout).expect("JSON");
    let brushes = brushes["brushes"].as_array().expect("brushes");
    let round = brushes.iter().find(|brush| brush["name"] == "round");
    let round = round.expect("the round");
    assert_eq!(
        (&round["spines"], &round["joints"]),
        (&7.into(), &21.into())
    );
    for brush in brushes {
        assert!(
            brush["sizes_mm"]
                .as_array()
                .is_some_and(|sizes| !sizes.is_empty())
        );
        assert!(
            brush["about"]
                .as_str()
                .is_some_and(|about| !about.is_empty())
        );
        for key in ["width_mm", "length_mm", "strips"] {
            assert!(brush[key].as_f64() > Some(0.0), "{key}");
        }
    }
    let table = place.done(&["brush", "list"]);
    let lines = String::from_utf8_lossy(&table.stdout).lines().count();
    assert_eq!(lines, brushes.len());
}
