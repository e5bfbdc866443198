//! Commands of programs that lie beside `maulstick`.

use std::os::unix::fs::PermissionsExt as _;
use std::process::{Command, Output};

use super::support::{MAULSTICK, Place, has};

/// A place with a copy of the program, and beside it programs that print their arguments.
fn place_with(programs: &[&str]) -> Place {
    let place = Place::new();
    std::fs::copy(MAULSTICK, place.path("maulstick")).expect("copied");
    for name in programs {
        let path = place.path(name);
        std::fs::write(&path, "#!/bin/sh\necho \"$0 $*\"\nexit 7\n").expect("written");
        let may_run = std::fs::Permissions::from_mode(0o755);
        std::fs::set_permissions(&path, may_run).expect("a program");
    }
    place
}

fn run(place: &Place, args: &[&str]) -> Output {
    let program = place.path("maulstick");
    let mut command = Command::new(program);
    command.args(args).output().expect("started")
}

#[test]
fn a_program_beside_gets_its_command_line_and_gives_its_code() {
    let place = place_with(&["maulstick-figures", "maulstick-mine"]);
    for (args, got) in [
        (
            &["brush", "sheet", "-o", "a.png"][..],
            "figures brush sheet -o a.png",
        ),
        (
            &["--overwrite", "colour", "chart", "-o", "b.png"],
            "figures --overwrite colour chart -o b.png",
        ),
        (&["mine", "--deep", "help"], "mine mine --deep help"),
    ] {
        let output = run(&place, args);
        assert_eq!(output.status.code(), Some(7), "{output:?}");
        let said = String::from_utf8_lossy(&output.stdout);
        assert!(said.ends_with(&format!("/maulstick-{got}\n")), "{said}");
    }
}

#[test]
fn a_program_that_is_not_built_is_named_with_how_to_build_it() {
    let place = place_with(&[]);
    for (args, package) in [
        (
            &["painting", "recover", "a.maul", "-o", "b.maul"][..],
            "maulstick-recover",
        ),
        (&["bench", "paint"], "maulstick-bench"),
    ] {
        let output = run(&place, args);
        assert_eq!(output.status.code(), Some(1), "{output:?}");
        let said = String::from_utf8_lossy(&output.stderr);
        has(
            &said,
            &[&args[..1].join(" "), "cargo build --release -p", package],
        );
    }
    let help = run(&place, &["brush", "sheet", "--help"]);
    assert_eq!(help.status.code(), Some(0), "its help is here: {help:?}");
    has(&String::from_utf8_lossy(&help.stdout), &["--output"]);
    let unknown = run(&place, &["mine"]);
    assert_eq!(unknown.status.code(), Some(2), "{unknown:?}");
}
