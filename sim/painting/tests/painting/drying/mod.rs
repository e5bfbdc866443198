//! Paint that dries in part, in places and over time, and is rewetted.

mod easel;

use std::collections::BTreeSet;

use maulstick_appearance::Bakery;
use maulstick_appearance::bands::Banded;
use maulstick_brush::BrushFile;
use maulstick_canvas::planes::TILE_CELLS;
use maulstick_canvas::quantum::{Counts, SLOTS};
use maulstick_painting::edits::{Dry, NameLayer, Opacity, Redo, StopDrying, Undo, Wet};
use maulstick_painting::{LayerError, PaintingSetup, Sequencer};
use maulstick_types::Edit;
use maulstick_types::Region;
use maulstick_types::command::advice::Advice;
use maulstick_types::paint::Entry;
use maulstick_types::scene::CANVAS;
use maulstick_types::values::{LayerName, OpacityFactor, Share, Ticks};
use proptest::prelude::*;

use easel::{
    both, colours, counts, depth, dry, dry_over, farthest, mean_off, painted, sequencer, stroke,
    sum, ticks, wet, wet_cells,
};

use crate::studio::{fill, load};

const CELLS: [u32; 2] = [150, 100];
const CELL_M: f64 = 2.5e-4;

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(12) })]

    /// Film under film of one mixture is one film (Baxter 2004, eq. 7.7). The remaining difference is that a layer
    /// holds whole quanta: where thin paint has a trace of another, one quantum of 1.5 nm of that is in the other film,
    /// a difference of 4e-4 at worst, and 2e-5 in the mean.
    #[test]
    fn drying_any_shares_changes_no_colour_and_loses_no_quantum(
        shares in proptest::collection::vec(0.01f32..=1.0, 1..5),
        part in any::<bool>(),
    ) {
        let mut sequencer = painted();
        let (before, paint) = (colours(&mut sequencer), both(counts(&mut sequencer)));
        for share in &shares {
            let share = *share;
            let region = "5,5,20x10".parse().expect("a region");
            let command = if part { dry(share, "", Some(region)) } else { dry(share, "", None) };
            // All may be dry already.
            sequencer.edit(command).ok();
            prop_assert_eq!(both(counts(&mut sequencer)), paint);
        }
        let after = colours(&mut sequencer);
        let (worst, mean) = (farthest(&before, &after), mean_off(&before, &after));
        println!("worst {worst:e}, mean {mean:e}");
        prop_assert!(worst < 1e-3 && mean < 5e-5, "{worst} {mean}");
        // A fault would be seen: a film of a micrometre.
        sequencer.edit(fill("Bone Black", 1.0)).expect("filled");
        let faulty = mean_off(&before, &colours(&mut sequencer));
        prop_assert!(faulty > 1e-3, "a fault would pass: {faulty}");
    }

    #[test]
    fn what_dried_becomes_wet_as_it_was(shares in proptest::collection::vec(0.01f32..=1.0, 1..5)) {
        let mut sequencer = painted();
        let (cells, colour) = (wet_cells(&mut sequencer), colours(&mut sequencer));
        for share in &shares {
            let share = *share;
            sequencer.edit(dry(share, "", None)).ok();
        }
        prop_assert!(wet_cells(&mut sequencer) != cells);
        sequencer.edit(wet(0, None)).expect("dry");
        prop_assert_eq!(wet_cells(&mut sequencer), cells);
        prop_assert_eq!(colours(&mut sequencer), colour);
        prop_assert_eq!(depth(&sequencer), 0);
        prop_assert!(sequencer.painting().scene().layers.is_empty());
    }
}

#[test]
fn a_region_dries_where_the_middles_of_its_cells_lie_and_nowhere_else() {
    let mut sequencer = painted();
    let before = wet_cells(&mut sequencer);
    let region: Region = "10,5,12.5x7.6".parse().expect("a region");
    let [from, to] = region.cells(CELLS, CELL_M).expect("cells");
    assert_eq!([from, to], [[40, 20], [90, 50]]);
    sequencer.edit(dry(1.0, "sky", Some(region))).expect("wet");
    let after = wet_cells(&mut sequencer);
    for (cell, (before, after)) in before.iter().zip(&after).enumerate() {
        let at = [cell as u32 % CELLS[0], cell as u32 / CELLS[0]];
        let within = (0..2).all(|i| (from[i]..to[i]).contains(&at[i]));
        let expected = if within { [0; SLOTS] } else { *before };
        assert_eq!(*after, expected, "{at:?}");
    }
    let refused = |sequencer: &mut Sequencer, region: &str, word: &str| {
        let region: Region = region.parse().expect("a region");
        let commands = [
            Edit::from(dry(0.5, "", Some(region.clone()))),
            wet(1, Some(region)).into(),
        ];
        let depth = sequencer.painting().history_depth();
        for command in commands {
            let error = sequencer.edit(command).expect_err("refused");
            assert!(error.to_string().contains(word), "{}", error);
        }
        assert_eq!(sequencer.painting().history_depth(), depth);
    };
    refused(&mut sequencer, "40,0,10x10", "holds no cell");
    refused(&mut sequencer, "1,1,0.01x5", "holds no cell");
    let endless = Region {
        corner_m: [0.0, f64::NAN],
        size_m: [1.0, 1.0],
    };
    assert!(sequencer.edit(wet(1, Some(endless))).is_err());
}

#[test]
fn paint_dries_evenly_into_one_layer_over_the_time() {
    let mut sequencer = painted();
    let all = counts(&mut sequencer);
    let (paint, colour) = (both(all), colours(&mut sequencer));
    sequencer.edit(dry_over(5400)).expect("wet");
    ticks(&mut sequencer, 12);
    for tick in 13..=5400u32 {
        sequencer.tick();
        if tick % 600 == 0 && tick < 5400 {
            let [wet, dry] = counts(&mut sequencer);
            assert_eq!(both([wet, dry]), paint);
            let share = sum(&dry) as f64 / sum(&paint) as f64;
            // In rounds of a 32nd of the time.
            let due = f64::from(tick) / 5400.0;
            assert!(
                share <= due && share > due - 1.0 / 32.0 - 1e-3,
                "{tick}: {share} of {due}"
            );
        }
    }
    assert!(!sequencer.painting().is_drying());
    let [wet, dry] = counts(&mut sequencer);
    assert_eq!((sum(&wet), dry), (0, paint));
    assert_eq!(depth(&sequencer), 1, "one link a tile");
    let layers = &sequencer.painting().scene().layers;
    assert_eq!((layers.len(), layers[0].name.as_str()), (1, "slow"));
    let worst = farthest(&colour, &colours(&mut sequencer));
    println!("worst {worst:e}");
    assert!(worst < 1e-5, "{worst}");
    let entries = sequencer.drain_journal();
    let counted = entries.iter().filter_map(|entry| match entry.entry {
        Entry::Tick { count } => Some(count),
        _ => None,
    });
    assert!(counted.eq(1..=5400), "each tick is in the journal");
    sequencer.tick();
    assert!(
        sequencer.drain_journal().is_empty(),
        "nothing dries any more"
    );
}

#[test]
fn a_stroke_meanwhile_is_one_step_and_dries_in_what_is_left() {
    let mut sequencer = painted();
    sequencer.edit(dry_over(600)).expect("wet");
    ticks(&mut sequencer, 300);
    let [_, dry] = counts(&mut sequencer);
    assert!(sum(&dry) > 0);
    let (steps, _) = sequencer.painting().history_depth();
    // Contacts less than .15 s apart, .1 s here, are one stroke; time passes throughout.
    for part in 0..4 {
        stroke(&mut sequencer, 2 + part, 3, 11.0, true);
        ticks(&mut sequencer, 6);
        assert_eq!(
            counts(&mut sequencer)[1],
            dry,
            "nothing dries under the brush"
        );
    }
    assert_eq!(sequencer.painting().history_depth().0, steps + 1);
    let colour = colours(&mut sequencer);
    ticks(&mut sequencer, 300);
    let [wet, _] = counts(&mut sequencer);
    assert_eq!(sum(&wet), 0, "what was laid late is dry in time");
    assert_eq!(sequencer.painting().history_depth().0, steps + 2);
    let worst = farthest(&colour, &colours(&mut sequencer));
    println!("worst {worst:e}, {} links", depth(&sequencer));
    assert!(worst < 1e-5, "{worst}");
    assert_eq!(depth(&sequencer), 2, "another mixture, another link");
    assert_eq!(sequencer.painting().scene().layers.len(), 1);
}

#[test]
fn undo_takes_back_what_dried_since_the_last_step_and_ends_the_drying() {
    let mut sequencer = painted();
    let before = wet_cells(&mut sequencer);
    let undo = Undo { brush: None };
    sequencer.edit(dry_over(600)).expect("wet");
    ticks(&mut sequencer, 200);
    sequencer.edit(load("Bone Black")).expect("loaded");
    stroke(&mut sequencer, 2, 3, 11.0, true);
    ticks(&mut sequencer, 200);
    let late = counts(&mut sequencer);
    assert_eq!(
        sequencer
            .edit(undo.clone())
            .map(|done| done.to_string())
            .as_deref(),
        Ok("drying")
    );
    assert!(!sequencer.painting().is_drying());
    ticks(&mut sequencer, 200);
    assert_eq!(
        sequencer
            .edit(undo.clone())
            .map(|done| done.to_string())
            .as_deref(),
        Ok("round stroke")
    );
    assert_eq!(
        sequencer
            .edit(undo.clone())
            .map(|done| done.to_string())
            .as_deref(),
        Ok("load Bone Black")
    );
    assert_eq!(
        sequencer.edit(undo).map(|done| done.to_string()).as_deref(),
        Ok("drying")
    );
    assert_eq!(wet_cells(&mut sequencer), before);
    assert!(sequencer.painting().scene().layers.is_empty());
    for _ in 0..4 {
        sequencer.edit(Redo { brush: None }).expect("undone");
    }
    assert_eq!(counts(&mut sequencer), late);
    assert_eq!(sequencer.painting().scene().layers.len(), 1);
}

#[test]
fn a_drying_ends_when_it_is_told_to_and_there_is_one_at_a_time() {
    let mut sequencer = painted();
    let stop = StopDrying { surface: CANVAS };
    let none = sequencer.edit(stop.clone()).expect_err("none goes on");
    assert!(none == LayerError::NotDrying.into());
    sequencer.edit(dry_over(600)).expect("wet");
    let other = sequencer.edit(dry_over(60)).expect_err("one goes on");
    assert!(other == LayerError::Drying.into());
    ticks(&mut sequencer, 200);
    let before = counts(&mut sequencer);
    assert!(sum(&before[0]) > 0 && sum(&before[1]) > 0);
    sequencer.edit(stop).expect("it goes on");
    ticks(&mut sequencer, 900);
    assert_eq!(counts(&mut sequencer), before);
    let mut empty = self::sequencer();
    let refused = empty.edit(dry_over(60)).expect_err("bare");
    assert!(refused == LayerError::NothingWet(None).into());
}

/// Two layers, `low` and `high`, and the counts of the lower one.
fn layered() -> (Sequencer, Counts) {
    let mut sequencer = painted();
    let all = both(counts(&mut sequencer));
    let dry = |name: &str| dry(1.0, name, None);
    sequencer.edit(dry("low")).expect("wet");
    sequencer.edit(load("Pyrrole Red")).expect("loaded");
    stroke(&mut sequencer, 2, 3, 11.0, true);
    sequencer.edit(dry("high")).expect("wet");
    (sequencer, all)
}

#[test]
fn an_opacity_is_not_lost_and_layers_are_named() {
    let (mut sequencer, _) = layered();
    let opacity = |layer: &str, opacity: f32| Opacity {
        layer: layer.parse().expect("valid"),
        opacity: OpacityFactor::new(opacity).expect("in range"),
    };
    sequencer.edit(opacity("high", 0.5)).expect("a layer");
    let veiled = sequencer
        .edit(wet(1, None))
        .expect_err("no wet paint is veiled");
    assert!(
        veiled.to_string().contains("high") && veiled.advice() == Advice::FullOpacity { layer: 2 }
    );
    sequencer
        .edit(opacity("2", 1.0))
        .expect("a layer by its number");
    let unknown = sequencer.edit(opacity("sky", 1.0)).expect_err("no layer");
    assert!(
        unknown.to_string().contains("'sky'") && unknown.advice().to_string().contains("2 (high)")
    );
    sequencer.edit(wet(1, None)).expect("no veil");
}

#[test]
fn layers_get_names() {
    let (mut sequencer, _) = layered();
    let names = |sequencer: &Sequencer| -> Vec<String> {
        let layers = &sequencer.painting().scene().layers;
        layers.iter().map(|layer| layer.name.clone()).collect()
    };
    let name = |layer: u32| NameLayer {
        layer,
        name: LayerName::new(" sky ").expect("valid"),
    };
    sequencer.edit(name(1)).expect("a layer");
    assert_eq!(names(&sequencer), ["sky", "high"]);
    sequencer.edit(Undo { brush: None }).expect("a step");
    assert_eq!(names(&sequencer), ["low", "high"]);
    let unknown = sequencer.edit(name(3)).expect_err("no layer");
    assert!(unknown.to_string().contains('3') && unknown.advice().to_string().contains("2 (high)"));
}

#[test]
fn the_newest_layer_becomes_wet_in_a_region() {
    let (mut sequencer, all) = layered();
    let region: Region = "6,6,10x10".parse().expect("a region");
    assert_eq!(
        sequencer
            .edit(wet(1, Some(region)))
            .map(|done| done.to_string())
            .as_deref(),
        Ok("high")
    );
    let layers = |sequencer: &Sequencer| -> BTreeSet<u32> {
        let layers = &sequencer.painting().scene().layers;
        layers.iter().map(|layer| layer.number).collect()
    };
    assert_eq!(layers(&sequencer), BTreeSet::from([1, 2]));
    let [wet_part, dry_part] = counts(&mut sequencer);
    assert!(sum(&wet_part) > 0 && wet_part[..2] == [0, 0] && sum(&dry_part) > sum(&all));
    let painted = wet_cells(&mut sequencer);
    sequencer.edit(wet(1, None)).expect("the rest of it");
    assert_eq!(layers(&sequencer), BTreeSet::from([1]));
    assert_eq!(counts(&mut sequencer)[1], all, "the lower one is dry");
    sequencer.edit(wet(0, None)).expect("all");
    assert_eq!((layers(&sequencer).len(), depth(&sequencer)), (0, 0));
    let nothing = sequencer.edit(wet(0, None)).expect_err("all is wet");
    assert!(nothing == LayerError::NothingDry(None).into());
    for _ in 0..2 {
        sequencer.edit(Undo { brush: None }).expect("done");
    }
    assert_eq!(wet_cells(&mut sequencer), painted);
    assert_eq!(layers(&sequencer), BTreeSet::from([1, 2]));
}
