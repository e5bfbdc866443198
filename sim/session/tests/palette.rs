//! The palette: a brush loads by touching a well, leaves paint in the mixing area, and is cleaned.

use maulstick_brush::BrushFile;
use maulstick_brush::file::library::LIBRARY;
use maulstick_canvas::quantum::QUANTUM_M;
use maulstick_canvas::tile::TileId;
use maulstick_optics::{PaintError, PaintLibrary};
use maulstick_painting::edits::{Load, Wells};
use maulstick_painting::ledger::LedgerReport;
use maulstick_painting::picture::unlit_picture;
use maulstick_painting::setup::wells_of;
use maulstick_painting::{EditError, Painting, PaintingSetup};
use maulstick_session::Offline;
use maulstick_types::Mixture;
use maulstick_types::paint::TILE;
use maulstick_types::scene::{CANVAS, PALETTE, Scene, Surface, Well, WellKind};
use maulstick_types::stylus::{DEFAULT_TILT_RAD, StylusPose, StylusSample};
use maulstick_types::values::BrushName;

/// A brush over a canvas and its palette.
struct Hand {
    offline: Offline,
    time_ns: u64,
}

impl Hand {
    fn new() -> Self {
        Self::with("round")
    }

    /// With a brush of the library.
    fn with(kind: &str) -> Self {
        let setup = PaintingSetup {
            cells: [128, 128],
            ..PaintingSetup::default()
        };
        let library = PaintLibrary::measured().expect("whole");
        let painting = Painting::new(&setup, library).expect("a painting");
        let file = BrushFile::library(kind).expect(kind);
        Self {
            offline: Offline::new(painting, "main", file, 0.5, Vec::new()).expect("set up"),
            time_ns: 1_000_000_000,
        }
    }

    fn scene(&mut self) -> Scene {
        self.offline.painting_mut().scene().clone()
    }

    fn palette(&mut self) -> Surface {
        let surfaces = self.scene().surfaces;
        surfaces
            .into_iter()
            .find(|s| s.id == PALETTE)
            .expect("a palette")
    }

    /// The middle of the well of a paint on the desk, or of the cleaner.
    fn well(&mut self, paint: Option<&str>) -> [f64; 2] {
        let palette = self.palette();
        let holds = |kind: &WellKind| match kind {
            WellKind::Paint { mixture } => paint == Some(mixture.parts[0].paint.as_str()),
            WellKind::Cleaner => paint.is_none(),
            WellKind::Medium => paint == Some("Thinner"),
        };
        let well = palette
            .wells
            .iter()
            .find(|well| holds(&well.kind))
            .expect("a well");
        [0, 1].map(|i| palette.pose.position_m[i] + well.center_m[i])
    }

    fn sample(&mut self, [x, y]: [f64; 2], pressure: f64) {
        let pose = StylusPose::Contact {
            point_m: [x, y, 0.0],
            tilt_rad: DEFAULT_TILT_RAD,
            twist_rad: 0.0,
            pressure,
        };
        let sample = StylusSample {
            pose,
            in_range: true,
            ..StylusSample::away()
        };
        self.time_ns += 5_000_000;
        self.offline.sample(self.time_ns, &sample).expect("painted");
    }

    /// A stroke from one place to another, after a pause in the air.
    fn stroke(&mut self, from: [f64; 2], to: [f64; 2]) {
        for _ in 0..40 {
            self.sample(from, 0.0);
        }
        for i in 0..=60 {
            let t = f64::from(i) / 60.0;
            self.sample([0, 1].map(|a| from[a] + t * (to[a] - from[a])), 0.4);
        }
        self.sample(to, 0.0);
    }

    fn drag_through(&mut self, [x, y]: [f64; 2]) {
        self.stroke([x - 0.004, y], [x + 0.004, y]);
    }

    fn report(&mut self) -> LedgerReport {
        let report = self.offline.painting_mut().report();
        assert_eq!(report.quanta_missing, 0, "{report:#?}");
        report
    }
}

#[test]
fn a_brush_loads_by_touching_paints_and_is_cleaned_by_touching() {
    let mut hand = Hand::new();
    assert!(
        hand.scene().paints.is_empty(),
        "wells take no slot before they are touched"
    );
    let blue = hand.well(Some("Ultramarine Blue"));
    hand.drag_through(blue);
    let names: Vec<String> = hand
        .scene()
        .paints
        .into_iter()
        .map(|slot| slot.name)
        .collect();
    assert_eq!(names, ["Ultramarine Blue"]);
    let loaded = hand.report();
    assert!(loaded.accounts_m3["brush"] > 1e-9, "{loaded:?}");
    hand.stroke([-0.012, 0.0], [0.012, 0.003]);
    let painted = hand.report();
    assert!(painted.accounts_m3["canvas"] > 1e-10, "{painted:?}");
    assert!(painted.accounts_m3["brush"] < loaded.accounts_m3["brush"]);
    let cleaner = hand.well(None);
    hand.drag_through(cleaner);
    let cleaned = hand.report();
    assert_eq!(cleaned.accounts_m3["brush"], 0.0);
    assert!(cleaned.accounts_m3["cleaner"] > 0.0);
}

#[test]
fn every_brush_that_is_set_down_prints_as_if_it_moved_a_little() {
    for (kind, _) in LIBRARY {
        let canvas = |way_m: f64| {
            let mut hand = Hand::with(kind);
            let load = Load {
                mixture: Mixture::pure("Ultramarine Blue"),
                beside: None,
                brush: BrushName::new("main").expect("valid"),
            };
            hand.offline.edit(load).expect("loaded");
            hand.stroke([0.0, 0.0], [way_m, 0.0]);
            hand.report().accounts_m3["canvas"]
        };
        let (printed, moved) = (canvas(0.0), canvas(1e-3));
        println!("{kind}: {:.3}", printed / moved);
        assert!(printed > 0.1 * moved, "{kind}: {printed} of {moved}");
    }
}

/// A press without motion has the effect of one with a small motion.
#[test]
fn a_brush_that_is_set_down_loads_prints_and_is_cleaned() {
    let mut hand = Hand::new();
    let blue = hand.well(Some("Ultramarine Blue"));
    hand.stroke(blue, blue);
    let loaded = hand.report();
    assert!(loaded.accounts_m3["brush"] > 1e-9, "{loaded:?}");
    hand.stroke([0.0, 0.0], [0.0, 0.0]);
    let printed = hand.report();
    assert!(printed.accounts_m3["canvas"] > 1e-11, "{printed:?}");
    let cleaner = hand.well(None);
    hand.stroke(cleaner, cleaner);
    assert_eq!(hand.report().accounts_m3["brush"], 0.0);
}

/// A dip into the medium thins, more of them thin more, and scrubbing in it makes a glaze and no clean brush.
#[test]
fn a_brush_soaks_medium_up_and_keeps_its_paint() {
    let mut hand = Hand::new();
    let [blue, medium] = ["Ultramarine Blue", "Thinner"].map(|paint| hand.well(Some(paint)));
    hand.drag_through(blue);
    let paint = |hand: &mut Hand| hand.report().paints_m3["Ultramarine Blue"]["brush"];
    let share = |hand: &mut Hand| {
        let report = hand.report();
        report.paints_m3["Thinner"]["brush"] / report.accounts_m3["brush"]
    };
    let whole = paint(&mut hand);
    hand.stroke(medium, medium);
    let dipped = share(&mut hand);
    assert!((0.2..0.4).contains(&dipped), "{dipped}");
    hand.stroke(medium, medium);
    let again = share(&mut hand);
    assert!((dipped + 0.05..0.6).contains(&again), "{again}");
    for _ in 0..6 {
        hand.drag_through(medium);
    }
    let scrubbed = share(&mut hand);
    assert!((0.75..0.86).contains(&scrubbed), "{scrubbed}");
    assert!(paint(&mut hand) > 0.1 * whole);
}

#[test]
fn a_well_never_runs_out_and_never_gets_dirty() {
    let mut hand = Hand::new();
    let (white, red) = (
        hand.well(Some("Titanium White")),
        hand.well(Some("Pyrrole Red")),
    );
    hand.drag_through(red);
    for _ in 0..3 {
        hand.drag_through(white);
    }
    // A brush finds the well's own paint there, because the cells under it are renewed.
    let cleaner = hand.well(None);
    hand.drag_through(cleaner);
    hand.drag_through(white);
    let report = hand.report();
    let (own, other) = (
        report.paints_m3["Titanium White"]["brush"],
        report.paints_m3["Pyrrole Red"]["brush"],
    );
    assert!(own > 1e-9 && other < 0.02 * own, "{own} {other}");
}

#[test]
fn the_mixing_area_takes_and_gives_paint() {
    let mut hand = Hand::new();
    let blue = hand.well(Some("Ultramarine Blue"));
    hand.drag_through(blue);
    let middle = [blue[0] + 0.06, blue[1]];
    hand.stroke(middle, [middle[0] + 0.02, middle[1] + 0.004]);
    let one = hand.report().paints_m3["Ultramarine Blue"]["palette"];
    let yellow = hand.well(Some("Hansa Yellow Opaque"));
    hand.drag_through(yellow);
    for _ in 0..3 {
        hand.stroke(middle, [middle[0] + 0.02, middle[1] + 0.004]);
    }
    let report = hand.report();
    assert!(one > 0.0);
    assert!(report.paints_m3["Hansa Yellow Opaque"]["palette"] > 0.0);
}

impl Hand {
    /// Lays other wells on the palette, as a client of the paint node would.
    fn lay(&mut self, wells: Vec<Well>) -> Result<(), EditError> {
        let surface = PALETTE;
        self.offline.edit(Wells::new(surface, wells)?).map(drop)
    }
}

#[test]
fn other_wells_give_other_paint_and_what_was_stirred_in_them_is_scraped_off() {
    let mut hand = Hand::new();
    let blue = hand.well(Some("Ultramarine Blue"));
    hand.drag_through(blue);
    let before = hand.report().paints_m3["Ultramarine Blue"].clone();
    let (steps, _) = hand.offline.painting_mut().history_depth();
    let palette = hand.palette();
    let teal: Mixture = "phthalo green blue shade=0.5,Titanium White=0.5"
        .parse()
        .expect("a mixture");
    let wells = wells_of(&[teal], palette.cells, palette.cell_m);
    hand.lay(wells).expect("wells");
    let palette = hand.palette();
    assert_eq!(palette.wells.len(), 3, "one paint, the cleaner, the medium");
    let WellKind::Paint { mixture } = &palette.wells[0].kind else {
        panic!("a paint")
    };
    assert_eq!(mixture.parts[0].paint, "Phthalo Green Blue Shade");
    let (after_steps, _) = hand.offline.painting_mut().history_depth();
    assert_eq!(after_steps, steps + 1, "scraping is a step");
    let after = &hand.report().paints_m3["Ultramarine Blue"];
    let off = before["palette"] - after["palette"];
    assert!(
        off > 0.0 && off <= before["palette"],
        "{before:?} {after:?}"
    );
    let cleaned = after["cleaner"] - before["cleaner"];
    assert!((cleaned / off - 1.0).abs() < 1e-9, "{before:?} {after:?}");
    let cleaner = hand.well(None);
    hand.drag_through(cleaner);
    let teal = hand.well(Some("Phthalo Green Blue Shade"));
    hand.drag_through(teal);
    let report = hand.report();
    assert!(report.paints_m3["Phthalo Green Blue Shade"]["brush"] > 1e-10);
    let blue = report.paints_m3["Ultramarine Blue"]["brush"];
    assert!(blue < 1e-12, "the old well gives nothing: {blue}");
}

#[test]
fn wells_beside_the_palette_or_of_unknown_paint_are_refused() {
    let mut hand = Hand::new();
    let before = hand.palette();
    let (cells, cell_m) = (before.cells, before.cell_m);
    let unknown = wells_of(&[Mixture::pure("Colbat Blue")], cells, cell_m);
    let error = hand.lay(unknown).expect_err("unknown");
    assert!(
        matches!(error, EditError::Paint(PaintError::Unknown { nearest: Some(near), .. }) if near == "Cobalt Blue")
    );
    let mut beside = wells_of(&[Mixture::pure("Cobalt Blue")], cells, cell_m);
    beside[0].center_m[0] = -1e-3;
    let error = hand.lay(beside).expect_err("beside");
    assert!(
        error.to_string().contains("well 1"),
        "{}",
        error.to_string()
    );
    assert!(
        error.advice().to_string().contains("128×256 mm"),
        "{}",
        error.advice().to_string()
    );
    assert_eq!(hand.palette(), before, "a refused command changes nothing");
}

/// Mean green of the canvas, 0 to 255, over the cells with wet paint, and the volumes on it, m³: of all paint and of
/// the medium.
fn film(hand: &mut Hand) -> (f64, f64, f64) {
    let painting = hand.offline.painting_mut();
    let picture = unlit_picture(painting, CANVAS);
    let store = painting.store(CANVAS).expect("a canvas");
    let (mut sum, mut cells) = (0.0, 0.0);
    for (id, version) in store.iter() {
        let Some(tile) = &version.tile else { continue };
        let wet = tile.wet();
        for at in 0..TILE * TILE {
            // Almost empty edges do not count as film.
            let film: f32 = wet.iter().map(|(_, plane)| plane[at]).sum();
            if f64::from(film) * QUANTUM_M > 5e-6 {
                let (x, y) = (
                    id.x as usize * TILE + at % TILE,
                    id.y as usize * TILE + at / TILE,
                );
                let pixel = (picture.height - 1 - y) * picture.width + x;
                sum += f64::from(picture.rgb[3 * pixel + 1]);
                cells += 1.0;
            }
        }
    }
    assert!(cells > 500.0, "a stroke");
    let report = hand.report();
    let medium = report
        .paints_m3
        .get("Thinner")
        .map_or(0.0, |row| row["canvas"]);
    (sum / cells, report.accounts_m3["canvas"], medium)
}

#[test]
fn the_jar_of_medium_thins_what_the_brush_carries() {
    let share = |hand: &mut Hand| {
        let report = hand.report();
        let of = |paint: &str| report.paints_m3.get(paint).map_or(0.0, |row| row["brush"]);
        of("Thinner") / report.accounts_m3["brush"]
    };
    let (mut hands, mut shares) = (Vec::new(), Vec::new());
    for dips in [0, 4, 8] {
        let mut hand = Hand::new();
        let blue = hand.well(Some("Ultramarine Blue"));
        hand.drag_through(blue);
        let jar = hand.well(Some("Thinner"));
        for _ in 0..dips {
            hand.stroke(jar, jar);
        }
        shares.push(share(&mut hand));
        hand.stroke([-0.012, 0.0], [0.012, 0.003]);
        hands.push(hand);
    }
    assert!(shares[0] == 0.0 && shares[1] > 0.2, "{shares:?}");
    assert!(
        shares[2] > shares[1] + 0.05 && shares[2] < 0.98,
        "{shares:?}"
    );
    let films: Vec<_> = hands.iter_mut().map(film).collect();
    for pair in films.windows(2) {
        let ((_, all, medium), (_, thin, more)) = (pair[0], pair[1]);
        assert!(thin - more < all - medium, "it has less pigment: {films:?}");
    }
    let [dark, light] = [films[0].0, films[2].0];
    assert!(light > dark + 4.0, "the ground shines through: {films:?}");
    // The jar stays pure, and never runs out.
    for hand in &mut hands {
        let jar = hand.well(Some("Thinner"));
        let palette = hand.palette();
        let cell = [0, 1].map(|i| (jar[i] - palette.pose.position_m[i]) / palette.cell_m);
        let store = hand
            .offline
            .painting_mut()
            .store(PALETTE)
            .expect("a palette");
        let id = TileId {
            x: cell[0] as u32 / TILE as u32,
            y: cell[1] as u32 / TILE as u32,
        };
        let at = cell[1] as usize % TILE * TILE + cell[0] as usize % TILE;
        let held = store.version(id).tile.as_ref().map_or(0.0, |tile| {
            tile.wet().iter().map(|(_, plane)| plane[at]).sum::<f32>()
        });
        assert_eq!(held, 0.0);
    }
}
