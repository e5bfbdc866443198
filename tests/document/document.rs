//! Paintings in files: kept, killed, damaged, and whatever else a file can be.

#[path = "../support/mod.rs"]
mod support;

use std::process::Command;
use std::time::Instant;

use maulstick_bus::Qos;
use maulstick_types::paint::PaintStatus;
use nix::sys::signal::Signal;
use support::{
    COARSE, Launcher, PATIENCE, Place, account, assert_same, fault, has, hear, info, join, listen,
    signal, wait_for,
};

#[test]
fn a_rendered_document_is_the_picture_and_goes_on() {
    let place = Place::new();
    place.short_demo("take.mcap", 4.0);
    let render = |load: &str, more: &[&str]| {
        let render = ["render", "take.mcap", "--load", load];
        let coarse: &[&str] = match more.contains(&"64M") {
            // It has cells of its own.
            true => &[],
            false => &COARSE,
        };
        place.done(&[&render[..], coarse, more].concat());
    };
    let blue = "Ultramarine Blue";
    render(blue, &["-o", "memory.png"]);
    render(blue, &["-o", "file.png", "--document", "ein Bild ä"]);
    assert_same(
        &place.bytes("memory.png"),
        &place.bytes("file.png"),
        "in memory and in a file",
    );
    let before = info(&place, "ein Bild ä");
    assert!(before["undo"].as_u64() > Some(0) && before["pending"] == 0);
    assert_eq!(before["size_cm"][0], 25.6);
    // Little memory, and a second take over the first, with another paint.
    let file = ["--document", "ein Bild ä", "--memory", "64M"];
    let yellow = "Hansa Yellow Opaque";
    render(yellow, &[&["-o", "twice.png"], &file[..]].concat());
    let after = info(&place, "ein Bild ä");
    assert!(after["undo"].as_u64() > before["undo"].as_u64());
    assert_eq!(after["ledger"]["quanta_missing"], 0);
    assert_eq!(after["paints"], serde_json::json!([blue, yellow]));
    assert!(
        !place.path("ein Bild ä-wal").exists(),
        "its journal is folded in"
    );
}

#[test]
fn what_was_done_is_there_after_a_kill_and_can_be_undone() {
    let place = Place::new();
    let mut launcher = Launcher::up(&place, &["x.maul", "--size", "256x256"]);
    launcher.wait_says("painting in");
    place.done(&["load", "Pyrrole Red"]);
    place.done(&["canvas", "fill", "Yellow Ochre", "--um", "40"]);
    place.done(&["layer", "dry", "--layer", "ground colour"]);
    place.done(&[
        "canvas",
        "fill",
        "Titanium White=0.5,Bone Black=0.5",
        "--um",
        "20",
    ]);
    place.done(&["painting", "versions", "--keep", "first"]);
    place.done(&["canvas", "ground", "grey"]);
    let books =
        |names: &[&str]| -> Vec<f64> { names.iter().map(|name| account(&place, name)).collect() };
    const ACCOUNTS: [&str; 4] = ["brush", "canvas", "dry", "cleaner"];
    let before = books(&ACCOUNTS);
    assert!(
        before
            .iter()
            .all(|volume| *volume > 0.0 || *volume == before[3])
    );
    let (bus, topics) = join(&place);
    let mut status = listen::<PaintStatus>(&bus, &topics.paint_status(), Qos::Background);
    let whole = |status: &PaintStatus| status.committed == status.journal && status.undo >= 5;
    hear(&mut status, whole).expect("all is in the file");
    let killed = Instant::now();
    signal(
        place.pid("maulstick-paint").expect("a paint node"),
        Signal::SIGKILL,
    );
    launcher.wait_says("is started again");
    support::drain(&mut status);
    hear(&mut status, |_| true).expect("the painting goes on");
    println!("paints again after {:.2} s", killed.elapsed().as_secs_f64());
    assert_eq!(books(&ACCOUNTS), before, "as it was");
    let undone = |what: &str| {
        let said = place.done(&["undo"]).stdout;
        assert!(String::from_utf8_lossy(&said).contains(what), "{what}");
    };
    undone("ground");
    undone("fill");
    undone("dry");
    assert_eq!(account(&place, "dry"), 0.0);
    place.done(&["painting", "versions", "--return", "first"]);
    assert_eq!(books(&ACCOUNTS), before, "back at the version");
    bus.close();
    launcher.close(&place);
    let there = info(&place, "x.maul");
    assert_eq!(there["versions"][0], "first");
    assert_eq!(there["pending"], 0);
}

/// Paint that dries by the rig's clock, in a rig whose paint node is killed meanwhile.
#[test]
fn a_drying_goes_on_after_a_crash_and_layers_become_wet_again() {
    let place = Place::new();
    let mut launcher = Launcher::up(&place, &["x.maul", "--size", "512x512"]);
    launcher.wait_says("painting in");
    let refused = |args: &[&str], words: &[&str]| has(&fault(&place, args, 2), words);
    refused(&["layer", "dry", "--over", "2s"], &["nothing is wet"]);
    place.done(&["canvas", "fill", "Yellow Ochre", "--um", "40"]);
    let all = account(&place, "canvas");
    place.done(&["layer", "dry", "--region", "0,0,64x128", "--layer", "left"]);
    let half = account(&place, "dry");
    assert!((half / all - 0.5).abs() < 1e-3, "{}", half / all);
    refused(
        &["layer", "dry", "--region", "200,0,9x9"],
        &["holds no cell", "128.0×128.0 mm"],
    );
    place.done(&["layer", "dry", "--over", "4s", "--layer", "slow"]);
    refused(&["layer", "dry", "--over", "4s"], &["--stop"]);
    let (bus, topics) = join(&place);
    let mut status = listen::<PaintStatus>(&bus, &topics.paint_status(), Qos::Background);
    // Thirty ticks a round: some paint has dried by then, and is in the file.
    let begun = hear(&mut status, |_| true).expect("a rig").journal;
    let dries = |status: &PaintStatus| status.committed > begun + 60;
    hear(&mut status, dries).expect("time goes by");
    signal(
        place.pid("maulstick-paint").expect("a paint node"),
        Signal::SIGKILL,
    );
    launcher.wait_says("is started again");
    let is_dry = || (account(&place, "canvas") == 0.0).then_some(());
    wait_for(PATIENCE, is_dry).expect("it goes on to its end");
    assert_eq!(account(&place, "dry"), all);
    place.done(&["layer", "opacity", "slow", "0.5"]);
    refused(
        &["layer", "wet"],
        &["layer 2 (slow) has an opacity", "opacity 2 1"],
    );
    refused(&["layer", "opacity", "sky", "0.5"], &["'sky'", "2 (slow)"]);
    place.done(&["undo"]);
    place.done(&["layer", "wet", "--all"]);
    assert_eq!(
        (account(&place, "canvas"), account(&place, "dry")),
        (all, 0.0)
    );
    place.done(&["undo"]);
    assert_eq!(account(&place, "dry"), all);
    place.write("size.csv", "400,0.2\n700,0.6\n");
    place.done(&["canvas", "ground", "size.csv"]);
    bus.close();
    launcher.close(&place);
    let there = info(&place, "x.maul");
    assert_eq!(there["ledger"]["quanta_missing"], 0);
    assert_eq!(there["layers"][1]["name"], "slow");
}

/// Kills the paint node `rounds` times while a take is played into a painting, each time with the whole
/// rig, and sees that nothing that was committed is lost.
fn kill_at_random(rounds: u32) {
    let place = Place::new();
    place.short_demo("take.mcap", 6.0);
    let mut least = 0;
    for round in 0..rounds {
        let mut launcher = Launcher::up(
            &place,
            &[
                "x.maul",
                "--play",
                "take.mcap",
                "--rate",
                "2",
                "--load",
                "Cobalt Blue",
                "--size",
                "512x512",
                "--cell-mm",
                "0.25",
            ][..if round == 0 { 11 } else { 7 }],
        );
        let (bus, topics) = join(&place);
        let mut status = listen::<PaintStatus>(&bus, &topics.paint_status(), Qos::Background);
        // Somewhere in the take, later from round to round.
        let steps = u64::from(30 + round * 137 % 700);
        let told = hear(&mut status, |told| {
            told.steps > steps && told.committed > least
        });
        let told = told.expect("something is committed");
        signal(launcher.pid(), Signal::SIGSTOP);
        signal(
            place.pid("maulstick-paint").expect("a paint node"),
            Signal::SIGKILL,
        );
        signal(launcher.pid(), Signal::SIGKILL);
        launcher.wait(PATIENCE);
        bus.close();
        place.wait_empty(PATIENCE);
        let there = info(&place, "x.maul");
        let journal = there["journal"].as_u64().expect("a number");
        assert!(
            journal >= told.committed,
            "round {round}: {journal} of {}",
            told.committed
        );
        assert_eq!(there["ledger"]["quanta_missing"], 0, "round {round}");
        assert!(there["undo"].as_u64() > Some(0), "round {round}");
        least = journal;
    }
}

#[test]
fn nothing_committed_is_lost_when_the_rig_is_killed() {
    kill_at_random(3);
}

#[test]
#[ignore = "long: fifty rigs are killed"]
fn nothing_committed_is_lost_when_fifty_rigs_are_killed() {
    kill_at_random(50);
}

#[test]
fn a_take_into_a_painting_begins_again_after_a_crash() {
    let place = Place::new();
    place.short_demo("take.mcap", 4.0);
    let load = ["--load", "Cobalt Blue", "--cell-mm", "0.25"];
    place.done(&[&["render", "take.mcap", "-o", "whole.png"], &load[..]].concat());
    let play = [
        "up",
        "--headless",
        "x.maul",
        "--play",
        "take.mcap",
        "--rate",
        "2",
        "--snapshot",
        "p.png",
    ];
    let mut launcher = Launcher::start(place.maulstick(&[&play, &load[..]].concat()));
    launcher.wait_says("is up");
    let (bus, topics) = join(&place);
    let mut status = listen::<PaintStatus>(&bus, &topics.paint_status(), Qos::Background);
    hear(&mut status, |told| told.steps > 200 && told.committed > 2).expect("painting");
    signal(
        place.pid("maulstick-paint").expect("a paint node"),
        Signal::SIGKILL,
    );
    launcher.wait_says("is started again");
    bus.close();
    assert!(launcher.wait(PATIENCE).success(), "{}", launcher.said());
    assert_same(
        &place.bytes("whole.png"),
        &place.bytes("p.png"),
        "painted once, not twice",
    );
}

/// A file that is no painting.
const LIST: &str = "a shopping list, and much more than sixteen bytes of it";

/// A painting as a program of a later format would write it.
fn of_later_format(painting: &[u8]) -> Vec<u8> {
    let mut newer = painting.to_vec();
    newer[63] = 99;
    newer
}

#[test]
fn what_is_no_painting_is_refused_and_stays_as_it_is() {
    let place = Place::new();
    place.short_demo("take.mcap", 2.0);
    place.write("text.maul", LIST);
    for command in [
        "up --headless text.maul",
        "painting info text.maul",
        "painting pack text.maul",
        "render take.mcap -o p.png --document text.maul",
    ] {
        let args: Vec<&str> = command.split(' ').collect();
        has(
            &fault(&place, &args, 2),
            &["not a Maulstick painting", "text.maul", "help:"],
        );
    }
    assert_same(&place.bytes("text.maul"), LIST.as_bytes(), "the list");
    assert!(!place.path("p.png").exists());
    for (args, words) in [
        (
            &["painting", "info", "none.maul"][..],
            &["no such file", "none.maul"][..],
        ),
        (
            &["up", "--headless", "no/folder/x.maul"],
            &["folder", "x.maul"],
        ),
        (&["up", "--headless", "."], &["not a Maulstick painting"]),
        (
            &["up", "--headless", "y.maul", "--memory", "lots"],
            &["lots", "512M"],
        ),
    ] {
        has(&fault(&place, args, 2), words);
    }
}

#[test]
fn a_painting_of_a_later_format_or_in_parts_is_refused_and_stays_as_it_is() {
    let place = Place::new();
    place.short_demo("take.mcap", 2.0);
    let render = ["render", "take.mcap", "-o", "p.png", "--load", "Bone Black"];
    place.done(&[&render[..], &["--document", "x.maul"]].concat());
    let there = place.bytes("x.maul");
    let again = ["up", "--headless", "x.maul", "--size", "64x64"];
    has(&fault(&place, &again, 2), &["--size", "x.maul"]);
    let newer = of_later_format(&there);
    place.write("newer.maul", &newer);
    has(
        &fault(&place, &["up", "--headless", "newer.maul"], 2),
        &["format 99", "newer"],
    );
    let torn = &there[..there.len() / 2];
    place.write("torn.maul", torn);
    has(
        &fault(&place, &["painting", "info", "torn.maul"], 2),
        &["damaged", "recover"],
    );
    assert_same(&place.bytes("newer.maul"), &newer, "a newer painting");
    assert_eq!(place.bytes("torn.maul").len(), torn.len());
}

#[test]
fn a_painting_is_open_once() {
    let place = Place::new();
    let launcher = Launcher::up(&place, &["x.maul"]);
    let pid = place.pid("maulstick-paint").expect("a paint node");
    for args in [
        &["up", "--headless", "--name", "other", "x.maul"][..],
        &["painting", "info", "x.maul"],
    ] {
        has(
            &fault(&place, args, 1),
            &["open in another program", &pid.to_string(), "x.maul"],
        );
    }
    launcher.close(&place);
    place.done(&["painting", "info", "x.maul"]);
}

#[test]
fn a_full_disk_is_told_and_what_was_written_is_safe() {
    let place = Place::new();
    place.short_demo("take.mcap", 5.0);
    let disk = place.path("disk");
    std::fs::create_dir(&disk).expect("a folder");
    // A file system of its own, in a namespace of its own, too small for the painting.
    let script = "mount -t tmpfs -o size=400k none disk && \
        $0 render take.mcap -o p.png --document disk/x.maul --load 'Cobalt Blue'; echo code $?; \
        $0 painting info disk/x.maul; echo info $?; umount disk";
    let output = Command::new("unshare")
        .args(["--mount", "sh", "-c", script, support::MAULSTICK])
        .current_dir(place.path("."))
        .output();
    let Some(output) = output
        .ok()
        .filter(|output| !String::from_utf8_lossy(&output.stderr).contains("unshare failed"))
    else {
        eprintln!("skipped: no namespaces here");
        return;
    };
    let (said, told) = (
        String::from_utf8_lossy(&output.stdout).into_owned(),
        String::from_utf8_lossy(&output.stderr).into_owned(),
    );
    assert!(
        said.contains("code 1") && told.contains("full"),
        "{said}{told}"
    );
    assert!(said.contains("info 0"), "it opens: {said}{told}");
    assert!(
        place.path("p.png").exists(),
        "the picture is written all the same"
    );
}

#[test]
fn a_frozen_paint_node_is_replaced() {
    let place = Place::new();
    let mut launcher = Launcher::up(&place, &["x.maul"]);
    place.done(&["canvas", "fill", "Yellow Ochre", "--um", "40"]);
    let before = account(&place, "canvas");
    let pid = place.pid("maulstick-paint").expect("a paint node");
    signal(pid, Signal::SIGSTOP);
    launcher.wait_says("is started again");
    let anew = wait_for(PATIENCE, || {
        place.pid("maulstick-paint").filter(|anew| *anew != pid)
    });
    assert!(anew.is_some(), "{}", launcher.said());
    assert_eq!(account(&place, "canvas"), before);
    launcher.close(&place);
}
