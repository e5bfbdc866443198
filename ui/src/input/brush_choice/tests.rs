//! Requests of rack, keys and presets.

use maulstick_painting::edits::{Clean, Handle, Load, Tune, Undo};
use maulstick_rig::UserError;
use maulstick_types::command::Detail;
use maulstick_types::values::BrushName;

use maulstick_types::command::PAINT_NODE;

use super::*;
use crate::settings::presets::BeforePreset;
use crate::test_support::context_bench::Bench;

fn defined(bench: &mut Bench) -> Vec<(String, BrushFile)> {
    let commands = bench.commands().into_iter();
    let defined = commands.map(|command| match command {
        Command::Brush(BrushCommand::Define { brush, toml }) => {
            (brush.to_string(), BrushFile::parse(&toml).expect("a brush"))
        }
        other => panic!("{other:?}"),
    });
    defined.collect()
}

fn width(bench: &mut Bench) -> f64 {
    bench.work().in_hand().expect("a brush").head.width_mm
}

#[test]
fn steps_are_those_of_a_painter() {
    let mut width_mm = 1.0;
    let mut way = Vec::new();
    for _ in 0..8 {
        width_mm = next_width_mm(width_mm, true);
        way.push(width_mm);
    }
    assert_eq!(way, [1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0]);
    assert_eq!(next_width_mm(20.0, true), 23.0);
    assert_eq!(next_width_mm(20.0, false), 17.0);
    assert_eq!(next_width_mm(2.3, false), 2.0);
    assert_eq!(next_width_mm(2.3, true), 2.5);
    assert_eq!(next_width_mm(0.5, false), 0.5);
}

#[test]
fn each_brush_can_be_as_wide_as_its_range_says_and_no_wider() {
    for file in library() {
        let range = widths_mm(file);
        for end in [range.start(), range.end()] {
            assert!(file.scaled_to(*end).is_ok(), "{} {end}", file.kind);
        }
        assert!(range.contains(&file.head.width_mm), "{}", file.kind);
        for size in &file.sizes_mm {
            assert!(range.contains(size), "{} {size}: {range:?}", file.kind);
        }
    }
    let knife = of_library("knife").expect("knife");
    assert!(*widths_mm(knife).start() > 1.0, "it would be too thin");
}

#[test]
fn two_steps_count_before_the_brush_has_answered() {
    let mut bench = Bench::new();
    bench.work().step_width(true);
    bench.work().step_width(true);
    let asked = defined(&mut bench);
    let widths: Vec<f64> = asked.iter().map(|(_, file)| file.head.width_mm).collect();
    assert_eq!(widths, [11.5, 13.0]);
    assert!(asked.iter().all(|(brush, _)| brush == "main"));
    assert!(is_of_library(&asked[1].1), "only its width is another");
}

#[test]
fn the_last_width_of_all_is_told() {
    let mut bench = Bench::new();
    let widest = *widths_mm(of_library("round").expect("round")).end();
    bench.work().widen(1e9);
    assert_eq!(width(&mut bench), widest);
    bench.work().step_width(true);
    assert_eq!(defined(&mut bench).len(), 1, "it is as wide as it can be");
    assert_eq!(bench.told().len(), 1);
}

#[test]
fn a_brush_comes_back_at_the_width_it_was_used_at() {
    let mut bench = Bench::new();
    bench.work().step_width(true);
    bench.work().next_brush();
    assert_eq!(bench.work().in_hand().expect("flat").kind, "flat");
    assert_eq!(width(&mut bench), 20.0);
    let round = of_library("round").expect("round");
    bench.work().choose(round);
    assert_eq!(width(&mut bench), 11.5);
    for _ in library() {
        bench.work().next_brush();
    }
    assert_eq!(bench.work().in_hand().expect("round").kind, "round");
    bench.commands();
    bench.work().choose(round);
    assert!(bench.commands().is_empty(), "it is in the hand already");
}

#[test]
fn another_brush_lays_full_paint_and_another_width_what_the_preset_says() {
    let mut bench = Bench::new();
    let limited = BrushHandling {
        most_m: 15e-6,
        ..BrushHandling::normal("main")
    };
    bench.rig.live.scene.as_mut().expect("a scene").handlings = vec![limited];
    bench.preferences.brushes.loading.thinner = 0.7;
    bench.preferences.brushes.mouse.pressure = 0.08;
    bench.preferences.brushes.before_preset = Some(BeforePreset {
        brush: "main".into(),
        pressure: 0.5,
        stiffness: 1.0,
        wetness: 0.0,
    });
    bench.work().step_width(true);
    assert_eq!(defined(&mut bench).len(), 1, "nothing but a width");
    assert_eq!(bench.preferences.brushes.loading.thinner, 0.7);
    bench.work().next_brush();
    let commands = bench.commands();
    let mut handled = commands.iter().filter_map(Command::edit::<Handle>);
    let handled = handled.next().map(BrushHandling::from);
    assert_eq!(handled, Some(BrushHandling::normal("main")));
    let tuned = |command: &Command| command.edit::<Tune>().is_some();
    assert!(commands.iter().any(tuned), "it is as stiff as before");
    assert_eq!(bench.preferences.brushes.loading.thinner, 0.0);
    assert_eq!(
        bench.preferences.brushes.mouse.pressure, 0.5,
        "and pressed as before"
    );
}

#[test]
fn a_brush_that_refuses_keeps_what_it_has_and_one_that_does_takes_up_its_paint() {
    let refused = || Err(UserError::failure("the brush is painting").into());
    let load = || {
        Command::from(Clean {
            brush: BrushName::main(),
        })
    };
    let mut bench = Bench::new();
    bench.work().step_width(true);
    bench.work().then(load());
    let first = bench.requests.take().remove(0);
    bench.work().step_width(true);
    let second = bench.requests.take().remove(0);
    let answer = |request: &Request, result| Outcome {
        request: request.clone(),
        result,
    };
    bench.work().brush_answered(&answer(&first, refused()));
    assert_eq!(width(&mut bench), 13.0, "the newer one was not answered");
    bench.work().brush_answered(&answer(&second, refused()));
    assert_eq!(width(&mut bench), 10.0, "as before");
    assert!(
        bench.requests.take().is_empty(),
        "what waited for it is off"
    );
    bench.work().step_width(true);
    bench.work().then(load());
    let request = bench.requests.take().remove(0);
    let done = answer(&request, Ok(Detail::Nothing));
    bench.work().brush_answered(&done);
    let then = Request::Command {
        node: PAINT_NODE.to_owned(),
        command: load(),
    };
    assert_eq!(bench.requests.take_all(), [then]);
}

#[test]
fn a_brush_on_a_surface_is_not_changed_which_is_told_once() {
    let mut bench = Bench::new();
    bench.work().widen(12.0);
    let define = bench.requests.take().remove(0);
    let clean = Request::of(Clean {
        brush: BrushName::main(),
    });
    assert!(!bench.work().refuses(&clean), "it is lifted");
    assert!(bench.told().is_empty());
    bench.rig.contact = BrushContact::Held;
    for request in [&define, &clean] {
        assert!(bench.work().refuses(request), "{request:?}");
    }
    assert_eq!(width(&mut bench), 10.0, "it keeps what it has");
    bench.work().step_width(true);
    assert!(bench.commands().is_empty());
    let words = "The brush is painting: lift it, and ask again.";
    assert_eq!(bench.told(), [words]);
    let undo = Request::of(Undo { brush: None });
    assert!(!bench.work().refuses(&undo), "it changes no brush");
}

#[test]
fn the_field_of_the_paint_says_what_was_loaded_last_wherever_that_was_asked_for() {
    let mut bench = Bench::new();
    let load = |mixture: &str, brush: &str| Outcome {
        request: Request::of(Command::from(Load {
            mixture: mixture.parse().expect("a mixture"),
            beside: None,
            brush: BrushName::new(brush).expect("a name"),
        })),
        result: Ok(Detail::Nothing),
    };
    bench.work().brush_answered(&load("Bone Black", "other"));
    assert_eq!(bench.preferences.brushes.loading.paint, "", "another brush");
    bench.work().brush_answered(&load("Bone Black", "main"));
    assert_eq!(bench.preferences.brushes.loading.paint, "Bone Black");
    // A load typed in parts and thinned stays as typed.
    bench.preferences.brushes.loading.paint = "2 Bone Black, 2 Titanium White".into();
    bench.preferences.brushes.loading.thinner = 0.5;
    let thinned = "Bone Black=0.25,Titanium White=0.25,Thinner=0.5";
    bench.work().brush_answered(&load(thinned, "main"));
    assert_eq!(bench.preferences.brushes.loading.thinner, 0.5);
    bench.work().brush_answered(&load("Yellow Ochre", "main"));
    let loading = &bench.preferences.brushes.loading;
    assert_eq!(
        (loading.paint.as_str(), loading.thinner),
        ("Yellow Ochre", 0.0)
    );
}

#[test]
fn files_of_ones_own_are_read_or_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("rake.toml");
    let error = read(&path).expect_err("none").to_string();
    assert!(error.contains("rake.toml"), "{error}");
    let text = BrushFile::library_text("flat").expect("flat");
    std::fs::write(&path, text).expect("written");
    assert_eq!(read(&path).expect("a brush").kind, "flat");
    std::fs::write(&path, text.replace("joints = 3", "joints = 0")).expect("written");
    let error = read(&path).expect_err("wrong").to_string();
    assert!(
        error.contains("spines.joints") && error.contains("rake.toml"),
        "{error}"
    );
    let model = folder.path().join("rake.glb");
    std::fs::write(&model, text).expect("written");
    assert!(read(&model).is_err(), "no model");
    std::fs::write(&path, [0xff, 0xfe]).expect("written");
    assert!(read(&path).is_err(), "no text");
}
