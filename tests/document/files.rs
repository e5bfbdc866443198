//! Files that commands and rigs write: over none that is not theirs; and files that somebody removes.

#[path = "../support/mod.rs"]
mod support;

use nix::sys::signal::Signal;
use support::{COARSE, Launcher, PATIENCE, Place, account, fault, has, info, signal, wait_for};

#[test]
fn no_command_writes_over_a_file_of_another_kind_unless_it_is_told_to() {
    let place = Place::new();
    place.short_demo("take.mcap", 2.0);
    let [cell, coarse] = COARSE;
    let render = ["render", "take.mcap", cell, coarse, "-o"];
    place.done(&[&render[..], &["p.png", "--document", "x.maul"]].concat());
    std::fs::write(place.path("strokes.txt"), "0 1 2 .5\n0.1 2 2 .5\n").expect("written");
    let load = "Ultramarine Blue";
    let picture = [&render[..], &["list.txt"]].concat();
    let ledger = [&render[..], &["p.png", "--ledger", "list.txt"]].concat();
    let commands: [&[&str]; 7] = [
        &["demo", "take", "-o", "list.txt"],
        &["take", "import", "strokes.txt", "-o", "list.txt"],
        &["take", "recover", "take.mcap", "-o", "list.txt"],
        &[
            "take",
            "embed",
            "take.mcap",
            "-o",
            "list.txt",
            "--load",
            load,
        ],
        &picture,
        &ledger,
        &[
            "painting", "export", "x.maul", "-o", "list.txt", "--format", "png",
        ],
    ];
    for command in commands {
        std::fs::write(place.path("list.txt"), "a shopping list").expect("written");
        let said = fault(&place, command, 1);
        has(&said, &["list.txt", "--overwrite"]);
        assert_eq!(place.bytes("list.txt"), b"a shopping list", "{command:?}");
        place.done(&[command, &["--overwrite"]].concat());
        assert_ne!(place.bytes("list.txt"), b"a shopping list", "{command:?}");
        // What is there now is of its own kind.
        place.done(command);
    }
    let before = place.bytes("x.maul");
    let over = ["render", "take.mcap", "-o", "x.maul", "--overwrite"];
    has(&fault(&place, &over, 1), &["x.maul", "painting"]);
    assert_eq!(place.bytes("x.maul"), before);
}

#[test]
fn a_rig_writes_over_no_file_of_another_kind_unless_its_command_is_told_to() {
    let place = Place::new();
    let mut launcher = Launcher::up(&place, &["x.maul", "--size", "256x256"]);
    launcher.wait_says("painting in");
    for command in [
        &["snapshot", "-o"][..],
        &["painting", "export", "--format", "png", "-o"],
    ] {
        std::fs::write(place.path("list.txt"), "a shopping list").expect("written");
        let command = [command, &["list.txt"]].concat();
        has(&fault(&place, &command, 1), &["list.txt", "--overwrite"]);
        assert_eq!(place.bytes("list.txt"), b"a shopping list");
        let said = place.done(&[&command[..], &["--overwrite"]].concat());
        let said = String::from_utf8_lossy(&said.stdout).into_owned();
        assert!(said.trim_end().ends_with("/list.txt"), "{said}");
        assert!(place.bytes("list.txt").starts_with(b"\x89PNG"));
    }
    for name in ["x.maul", "x.maul-wal"] {
        for more in [&["-o", name][..], &["-o", "p.png", "--ledger", name]] {
            // A name of a painting's journal is none for a file, whoever would write it.
            let status = 1 + i32::from(name.ends_with("-wal"));
            let said = fault(&place, &[&["snapshot"], more].concat(), status);
            has(&said, &[name, "painting"]);
        }
    }
    // Nobody is let in beside the rig.
    has(
        &fault(&place, &["painting", "pack", "x.maul"], 1),
        &["open in another program"],
    );
    launcher.close(&place);
    info(&place, "x.maul");
}

#[test]
fn a_rig_whose_painting_is_removed_goes_on_beside_and_after_a_crash() {
    let place = Place::new();
    let mut launcher = Launcher::up(&place, &["x.maul", "--size", "256x256"]);
    launcher.wait_says("painting in");
    place.done(&["canvas", "fill", "Yellow Ochre", "--um", "40"]);
    for name in ["x.maul", "x.maul-wal"] {
        std::fs::remove_file(place.path(name)).expect("removed");
    }
    launcher.wait_says("continues in");
    let kept = place.path("x-kept.maul").display().to_string();
    launcher.wait_says(&format!("painting in {kept}"));
    place.done(&["canvas", "fill", "Yellow Ochre", "--um", "40"]);
    let before = account(&place, "canvas");
    let pid = place.pid("maulstick-paint").expect("a paint node");
    signal(pid, Signal::SIGKILL);
    launcher.wait_says("is started again");
    let anew = wait_for(PATIENCE, || {
        place.pid("maulstick-paint").filter(|anew| *anew != pid)
    });
    assert!(anew.is_some(), "{}", launcher.said());
    assert_eq!(account(&place, "canvas"), before);
    launcher.close(&place);
    // The first load of the brush and two fills.
    assert_eq!(info(&place, "x-kept.maul")["undo"], 3);
    assert!(!place.path("x.maul").exists());
}

#[test]
fn a_rig_whose_folder_is_removed_says_so() {
    let place = Place::new();
    let mut launcher = Launcher::up(&place, &[]);
    launcher.wait_says("Ctrl-C stops it");
    std::fs::remove_dir_all(place.path("maulstick")).expect("removed");
    launcher.wait_says("was removed: painting goes on");
    launcher.signal(Signal::SIGINT);
    launcher.wait(PATIENCE);
}
