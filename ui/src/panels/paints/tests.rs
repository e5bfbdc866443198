//! Paints panel: requests of its controls, and its snapshot.

use eframe::egui::Key;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use maulstick_painting::edits::{Load, Wells};
use maulstick_types::Mixture;
use maulstick_types::command::Command;
use maulstick_types::scene::{PALETTE, WellKind};
use maulstick_types::values::BrushName;

use super::*;
use crate::settings::paint_sets::PaintSet;
use crate::test_support::context_bench::{Bench, differ, harness, pictures};

fn panel<'a>(bench: Bench) -> Harness<'a, Bench> {
    let mut harness = harness(PaintsPanel::default(), bench);
    harness.run();
    harness
}

fn write(harness: &mut Harness<'_, Bench>, field: &str, text: &str) {
    harness.get_by_label(field).focus();
    harness.run();
    harness.get_by_label(field).type_text(text);
    harness.run();
}

/// Names of what a command lays in the palette's wells, from the top.
fn laid(harness: &mut Harness<'_, Bench>) -> Vec<String> {
    let commands = harness.state_mut().commands();
    let [command] = &commands[..] else {
        panic!("{commands:?}")
    };
    let Wells { surface, wells } = command.edit().expect("wells");
    assert_eq!(surface, PALETTE);
    let jars: Vec<&WellKind> = wells.iter().rev().take(2).map(|well| &well.kind).collect();
    assert_eq!(jars, [&WellKind::Medium, &WellKind::Cleaner]);
    let paints = wells.iter().filter_map(|well| match &well.kind {
        WellKind::Paint { mixture } => Some(
            PaintSet::of("", std::slice::from_ref(mixture))
                .paints
                .concat(),
        ),
        WellKind::Cleaner | WellKind::Medium => None,
    });
    paints.collect()
}

#[test]
fn a_click_loads_the_brush_with_the_paint() {
    let mut bench = Bench::new();
    bench.preferences.brushes.loading.beside = Some("Bone Black".into());
    let mut harness = panel(bench);
    write(&mut harness, "Search", "pb 28");
    harness.get_by_label("Cobalt Blue").click();
    harness.run();
    let load = Command::from(Load {
        mixture: Mixture::pure("Cobalt Blue"),
        beside: None,
        brush: BrushName::main(),
    });
    assert_eq!(harness.state_mut().commands(), [load]);
    assert_eq!(
        harness.state().preferences.brushes.loading.paint,
        "Cobalt Blue"
    );
    let white = harness.query_by_label("Titanium White to the palette");
    assert!(white.is_none(), "it is not searched for");
}

#[test]
fn what_is_called_by_no_name_is_told() {
    let mut harness = panel(Bench::new());
    write(&mut harness, "Search", "zzz");
    harness.get_by_label_contains("No tube is called so");
}

#[test]
fn paints_go_onto_the_palette_into_a_well_and_off_it() {
    let mut harness = panel(Bench::new());
    let before = harness.state_mut().work().wells().len();
    write(&mut harness, "Search", "cobalt blue");
    harness.get_by_label("Cobalt Blue to the palette").click();
    harness.run();
    let names = laid(&mut harness);
    assert_eq!(
        (names.len(), names[before].as_str()),
        (before + 1, "Cobalt Blue")
    );
    harness.get_by_label("Pyrrole Red").click();
    harness.run();
    harness.get_by_label("Cobalt Blue to the palette").click();
    harness.run();
    let names = laid(&mut harness);
    assert_eq!((names.len(), names[3].as_str()), (before, "Cobalt Blue"));
    harness
        .get_by_label("Remove from the palette: Titanium White")
        .click();
    harness.run();
    let names = laid(&mut harness);
    assert_eq!(
        (names.len(), names[0].as_str()),
        (before - 1, "Hansa Yellow Opaque")
    );
    harness.get_by_label("Down: Titanium White").click();
    harness.run();
    assert_eq!(laid(&mut harness)[1], "Titanium White");
    harness.get_by_label("Up: Cadmium Orange").click();
    harness.run();
    assert_eq!(laid(&mut harness)[1], "Cadmium Orange");
}

#[test]
fn a_tube_is_dragged_into_a_well() {
    let mut harness = panel(Bench::new());
    write(&mut harness, "Search", "cobalt blue");
    let from = harness.get_by_label("Cobalt Blue").rect().center();
    let to = harness.get_by_label("Yellow Ochre").rect().center();
    harness.drag_at(from);
    harness.run();
    harness.hover_at(from + (to - from) * 0.5);
    harness.run();
    harness.hover_at(to);
    harness.run();
    harness.drop_at(to);
    harness.run();
    assert_eq!(laid(&mut harness)[7], "Cobalt Blue");
}

#[test]
fn a_mixture_of_ones_own_lies_on_the_palette() {
    let mut harness = panel(Bench::new());
    write(&mut harness, "Mixture", "Cobalt Blue=0.7,Titanium White=x");
    harness.key_press(Key::Enter);
    harness.run();
    harness.get_by_label_contains("'Titanium White' is 'x'");
    assert!(harness.state_mut().commands().is_empty());
    write(&mut harness, "Mixture", "5");
    harness.get_by_label("Add to palette").click();
    harness.run();
    assert!(
        harness.state_mut().commands().is_empty(),
        "'x5' is no number"
    );
    let mut harness = panel(Bench::new());
    write(
        &mut harness,
        "Mixture",
        "Cobalt Blue=0.7,Titanium White=0.3",
    );
    harness.get_by_label("Add to palette").click();
    harness.run();
    let names = laid(&mut harness);
    assert_eq!(
        names.last().map(String::as_str),
        Some("Cobalt Blue=0.7,Titanium White=0.3")
    );
}

#[test]
fn sets_are_kept_shown_laid_out_renamed_deleted_and_brought_back() {
    let mut harness = panel(Bench::new());
    harness.get_by_label("Save palette as set").click();
    harness.run();
    harness.get_by_label("Give it a name first.");
    write(&mut harness, "Name", "Studio");
    harness.get_by_label("Save palette as set").click();
    harness.run();
    let own = PaintSet {
        name: "Earth".into(),
        paints: vec![
            "Burnt Sienna".into(),
            "Yellow Ochre=0.5,Bone Black=0.5".into(),
        ],
    };
    harness.state_mut().preferences.brushes.paint_sets.push(own);
    assert_eq!(
        harness.state().preferences.brushes.paint_sets[0]
            .paints
            .len(),
        10
    );
    harness.get_by_label("Set").click();
    harness.run();
    harness.get_by_label("Earth").click();
    harness.run();
    assert!(
        harness.query_by_label("Cobalt Blue").is_none(),
        "not of this set"
    );
    harness.get_by_label("Lay out").click();
    harness.run();
    let names = laid(&mut harness);
    assert_eq!(names, ["Burnt Sienna", "Yellow Ochre=0.5,Bone Black=0.5"]);
    write(&mut harness, "Name", "Ground");
    harness.get_by_label("Rename the set").click();
    harness.run();
    assert_eq!(
        harness.state().preferences.brushes.paint_sets[1].name,
        "Ground"
    );
    harness.get_by_label("Delete set").click();
    harness.run();
    assert_eq!(harness.state().preferences.brushes.paint_sets.len(), 1);
    harness.get_by_label("Bring back").click();
    harness.run();
    assert_eq!(
        harness.state().preferences.brushes.paint_sets[1].name,
        "Ground"
    );
}

#[test]
fn a_set_of_paints_that_the_rig_lacks_is_told() {
    let mut bench = Bench::new();
    bench.preferences.brushes.paint_sets.push(PaintSet {
        name: "Old".into(),
        paints: vec!["Lead White".into()],
    });
    let mut panel = PaintsPanel {
        set: Some("Old".into()),
        ..PaintsPanel::default()
    };
    let mut harness = harness(std::mem::take(&mut panel), bench);
    harness.run();
    harness.get_by_label("Lay out").click();
    harness.run();
    assert!(harness.state_mut().commands().is_empty());
    let told = harness.state().told().concat();
    assert!(told.contains("'Lead White'"), "{told}");
}

#[test]
fn a_full_palette_takes_no_more() {
    let mut bench = Bench::new();
    let most = crate::panels::paints::palette_wells::MOST;
    let many = vec![Mixture::pure("Bone Black"); most + 1];
    bench.work().lay_wells(&many);
    assert!(bench.requests.take().is_empty());
    assert!(
        bench.told()[0].contains(&most.to_string()),
        "{:?}",
        bench.told()
    );
    bench.work().lay_wells(&many[1..]);
    assert_eq!(bench.requests.take().len(), 1);
}

#[test]
fn it_looks_as_it_should() {
    let mut shown = panel(Bench::new());
    shown.fit_contents();
    shown.snapshot_options("tubes", &pictures());
    let mut lamp = Bench::new();
    let mut scene = lamp.rig.live.scene.clone().expect("a scene");
    scene.light.illuminant = "A".into();
    lamp.rig.lay(scene);
    let mut lamp = panel(lamp);
    lamp.fit_contents();
    assert!(differ(&mut shown, &mut lamp), "a fault would pass");
}
