//! Random acts of a painter, and their execution.

use maulstick_types::Edit;

use super::*;

/// Connected places over a surface, some far off, in and beside it, high and low.
pub(super) fn way(
    surface: u32,
    around: [f64; 2],
    spread: f64,
) -> impl Strategy<Value = Vec<Place>> {
    let place = (
        (-spread..spread, -spread..spread),
        0.25..1.15f64,
        (-0.5..0.5f32, -0.5..0.5f32),
        -0.6..0.6f64,
    );
    let place = place.prop_map(move |((x, y), height, bend, turn)| Place {
        surface,
        at_mm: [around[0] + x, around[1] + y],
        height,
        bend: bend.into(),
        turn,
    });
    prop::collection::vec(place, 2..5)
}

/// An act of a painter.
#[derive(Clone, Debug)]
pub(super) enum Act {
    Paint(usize, Vec<Place>),
    NextStroke(usize),
    Load(usize, usize),
    Clean(usize),
    Take(usize, Vec<usize>),
    Redefine(usize, usize),
    Dry(u32, f32),
    Opacity(u32, f32),
    Handle(usize, usize),
    FillWith(usize),
    Scrape(u32),
    Prepare(u32, bool),
    Wells(usize),
    Convert(u32, usize),
    Undo,
    Redo,
    GoTo(u64),
}

pub(super) fn act() -> impl Strategy<Value = Act> {
    let brush = 0..BRUSHES.len();
    let load = 0..MIXTURES.len();
    // The canvas's middle, an edge of it, two wells, the cleaner, the palette's board.
    let somewhere = prop_oneof![
        3 => way(CANVAS, [8.0, 8.0], 4.0),
        1 => way(CANVAS, [15.0, 1.0], 6.0),
        1 => way(PALETTE, [18.0, 42.0], 8.0),
        1 => way(PALETTE, [18.0, 128.0], 8.0),
        1 => way(PALETTE, [114.0, 14.0], 9.0),
        1 => way(PALETTE, [60.0, 60.0], 6.0),
    ];
    prop_oneof![
        8 => (brush.clone(), somewhere).prop_map(|(b, way)| Act::Paint(b, way)),
        2 => brush.clone().prop_map(Act::NextStroke),
        2 => (brush.clone(), load.clone()).prop_map(|(b, l)| Act::Load(b, l)),
        1 => brush.clone().prop_map(Act::Clean),
        1 => (brush.clone(), prop::collection::vec(load, 0..3)).prop_map(|(b, l)| Act::Take(b, l)),
        2 => (brush, prop_oneof![Just(31usize), Just(48), Just(60)])
            .prop_map(|(b, strips)| Act::Redefine(b, strips)),
        2 => (prop_oneof![3 => Just(CANVAS), 1 => Just(PALETTE)], 0.01..1.3f32)
            .prop_map(|(surface, share)| Act::Dry(surface, share.min(1.0))),
        1 => (1..4u32, 0.0..1.0f32).prop_map(|(layer, opacity)| Act::Opacity(layer, opacity)),
        2 => (0..BRUSHES.len(), 0..BrushMode::NAMES.len()).prop_map(|(b, m)| Act::Handle(b, m)),
        1 => (0..BRUSHES.len()).prop_map(Act::FillWith),
        1 => (CANVAS..=PALETTE, any::<bool>()).prop_map(|(s, last)| Act::Prepare(s, last)),
        1 => (CANVAS..=PALETTE).prop_map(Act::Scrape),
        2 => (0..4usize).prop_map(Act::Wells),
        1 => (CANVAS..=PALETTE, 0..3usize).prop_map(|(s, model)| Act::Convert(s, model)),
        3 => Just(Act::Undo),
        2 => Just(Act::Redo),
        1 => (0..12u64).prop_map(Act::GoTo),
    ]
}

pub(super) fn perform(painting: &mut Painting, strokes: &mut [u64; 2], act: &Act) {
    let name = |b: &usize| BrushName::new(BRUSHES[*b]).expect("valid");
    match act {
        Act::Paint(b, places) => paint(painting, BRUSHES[*b], 10.0, strokes[*b], places),
        Act::NextStroke(b) => strokes[*b] += 1,
        Act::Load(b, l) => done(painting, load(BRUSHES[*b], mixture(MIXTURES[*l]))),
        Act::Clean(b) => done(painting, Clean { brush: name(b) }),
        Act::Take(b, loads) => {
            let loads: Vec<Mixture> = loads.iter().map(|l| mixture(MIXTURES[*l])).collect();
            painting.take(BRUSHES[*b], &loads).expect("known");
        }
        Act::Redefine(b, strips) => {
            painting.define_brush(BRUSHES[*b], round(10.0, *strips));
        }
        // There may be nothing to dry, to undo or to redo.
        Act::Dry(surface, share) => drop(painting.apply(dry(*surface, *share, ""))),
        Act::Opacity(layer, opacity) => drop(painting.apply(self::opacity(*layer, *opacity))),
        Act::Handle(b, mode) => {
            let handling = BrushHandling {
                mode: BrushMode::NAMES[*mode].1.clone(),
                flow: 1e-3,
                most_m: [0.0, 4e-5][mode % 2],
                brush: BRUSHES[*b].to_owned(),
            };
            done(painting, Handle::try_from(&handling).expect("in range"));
        }
        // There may be nothing wet.
        Act::Scrape(surface) => drop(painting.apply(Scrape {
            region: None,
            surface: *surface,
        })),
        // It may carry nothing.
        Act::FillWith(b) => drop(painting.apply(Fill {
            paint: FillPaint::Carried { brush: name(b) },
            thickness: FilmThickness::new(2e-5).expect("in range"),
            surface: CANVAS,
        })),
        Act::Prepare(surface, last) => prepare(painting, *surface, *last),
        Act::Wells(count) => move_wells(painting, *count),
        // It may have that model.
        Act::Convert(surface, model) => drop(painting.apply(Convert {
            model: ModelName::new(["impasto", "dab", "marker"][*model]).expect("valid"),
            surface: *surface,
        })),
        Act::GoTo(step) => drop(painting.go_to(*step)),
        Act::Undo => drop(painting.undo(None)),
        Act::Redo => drop(painting.redo(None)),
    }
}

fn done(painting: &mut Painting, edit: impl Into<Edit>) {
    painting
        .apply(edit)
        .map(drop)
        .expect("nothing is in its way");
}

fn prepare(painting: &mut Painting, surface: u32, last: bool) {
    done(painting, Piles { last, surface });
    let stain_m = if last { 0.0 } else { 1e-5 };
    let stain = StainThickness::new(stain_m).expect("in range");
    done(painting, Size { stain, surface });
}

/// Mirrors the wells, or leaves the first of them alone, so that others move or go.
fn move_wells(painting: &mut Painting, count: usize) {
    let palette = painting.scene().surfaces[1].clone();
    let wells = if count == 0 {
        mirrored(&palette.wells, size_m(&palette))
    } else {
        let mixtures = MIXTURES[3 - count..].iter().map(|text| mixture(text));
        let mixtures: Vec<Mixture> = mixtures.collect();
        wells_of(&mixtures, palette.cells, palette.cell_m)
    };
    done(painting, Wells::new(PALETTE, wells).expect("valid"));
}
