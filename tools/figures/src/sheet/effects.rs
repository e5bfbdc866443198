//! The seven effects of Baxter 2004, fig. 6.2, and thinned paint.

use maulstick_appearance::picture::Picture;
use maulstick_brush::BrushFile;
use maulstick_optics::PaintLibrary;
use maulstick_painting::edits::common;
use maulstick_rig::UserError;
use maulstick_types::values::Share;

use maulstick_painting_setup::refused;
use maulstick_script::paintings::Board;

use super::gesture::{Gesture, Moment, swell};
use super::marks::stroke;
use super::{BRUSH, DEPTH_SHARE, GAP_MM, Panel, Sheet, library_brush};

/// Size of a panel, mm.
const PANEL_MM: [f64; 2] = [86.0, 48.0];
/// Height of the words over a panel, mm.
const WORDS_MM: f64 = 13.0;
/// Size of the caption's text, mm.
const WORDS_SIZE_MM: f64 = 3.75;

const YELLOW: &str = "Hansa Yellow Opaque";
const BLUE: &str = "Ultramarine Blue=0.6,Titanium White=0.4";
const RED: &str = "Pyrrole Red=0.8,Titanium White=0.2";
const WHITE: &str = "Titanium White";

/// An effect: its name, caption and drawing.
struct Effect {
    name: &'static str,
    words: &'static str,
    /// Paints it on a board.
    paint: fn(PaintLibrary, Board) -> Result<Panel, UserError>,
}

const EFFECTS: [Effect; 8] = [
    Effect {
        name: "bidirectional transfer",
        words: "white, drawn down through wet blue, yellow and red",
        paint: transfer,
    },
    Effect {
        name: "complex loading",
        words: "a flat with another colour on either half of its width",
        paint: loading,
    },
    Effect {
        name: "controlled drying",
        words: "wet by 32, 42, 56, 75 and 100 %, a clean brush down them",
        paint: drying,
    },
    Effect {
        name: "blending",
        words: "wet yellow and blue, brushed into each other on the right",
        paint: blending,
    },
    Effect {
        name: "glazing",
        words: "grey, dried; thinned magenta and green over it",
        paint: glazing,
    },
    Effect {
        name: "impasto",
        words: "six full loads on each other, lit from the left",
        paint: impasto,
    },
    Effect {
        name: "scumbling",
        words: "thick strokes, dried; a wiped white brush over them",
        paint: scumbling,
    },
    Effect {
        name: "thinning",
        words: "the same paint with 0, 40, 70 and 90 % of thinner",
        paint: thinning,
    },
];

/// The sheet, on boards like this; `told` receives each panel's progress.
///
/// # Errors
/// A [`UserError`] where a brush or a paint is refused, or where it would have too many pixels.
pub(crate) fn effects(
    library: &PaintLibrary,
    board: Board,
    mut told: impl FnMut(usize, usize),
) -> Result<Picture, UserError> {
    let [across, up] = PANEL_MM;
    let columns = 2;
    let own = board.model.panels;
    let panels = EFFECTS.len() + own.len();
    let rows = panels.div_ceil(columns);
    let width = GAP_MM + columns as f64 * (across + GAP_MM);
    let height = GAP_MM + rows as f64 * (WORDS_MM + up + GAP_MM);
    let mut sheet = Sheet::new([width, height], board.cell_mm)?;
    let mut done = 0;
    let mut put = |name: &str, words: &str, picture: &Picture| {
        let x = GAP_MM + (done % columns) as f64 * (across + GAP_MM);
        let y = GAP_MM + (done / columns) as f64 * (WORDS_MM + up + GAP_MM);
        sheet.write(name, [x, y + 5.0], 5.5);
        sheet.write(words, [x, y + 10.0], WORDS_SIZE_MM);
        sheet.paste(picture, [x, y + WORDS_MM]);
        done += 1;
        told(done, panels);
    };
    for effect in &EFFECTS {
        let panel = (effect.paint)(library.clone(), board)?;
        put(effect.name, effect.words, &panel.picture());
    }
    for panel in own {
        let picture = (panel.draw)(PANEL_MM, board.cell_mm);
        let picture = picture.map_err(|error| UserError::failure(error.to_string()))?;
        put(panel.name, panel.words, &picture);
    }
    Ok(sheet.page.done())
}

impl Panel {
    fn of(
        kind: &str,
        width_mm: f64,
        (library, board): (PaintLibrary, Board),
    ) -> Result<Self, UserError> {
        Self::new((PANEL_MM, board), "gesso", sized(kind, width_mm)?, library)
    }

    fn take_up(&mut self, name: &str, file: BrushFile) -> Result<(), UserError> {
        let taken = self.offline.take_up(name, file, DEPTH_SHARE);
        taken.map_err(refused)
    }

    fn dry(&mut self, share: f32) -> Result<(), UserError> {
        let dry = common::dry(Share::new(share)?);
        self.offline.edit(dry).map_err(refused)?;
        Ok(())
    }
}

fn sized(kind: &str, width_mm: f64) -> Result<BrushFile, UserError> {
    let sized = library_brush(kind)?.scaled_to(width_mm);
    sized.map_err(|error| UserError::failure(error.to_string()))
}

/// A straight stroke, pressed evenly.
fn line(from: [f64; 2], to: [f64; 2], pressure: f64, twist_deg: f64) -> Gesture {
    let middle = [0, 1].map(|i| 0.5 * (from[i] + to[i]));
    stroke(vec![from, middle, to], 1.4, twist_deg, move |t| {
        0.03 + pressure * swell(t, 0.1)
    })
}

/// A wavy stroke, pressed evenly.
fn wave(points: Vec<[f64; 2]>, pressure: f64, seconds: f64) -> Gesture {
    stroke(points, seconds, 90.0, move |t| {
        0.03 + pressure * swell(t, 0.06)
    })
}

fn transfer(library: PaintLibrary, board: Board) -> Result<Panel, UserError> {
    let mut panel = Panel::of("flat", 8.0, (library, board))?;
    for (row, mixture) in ["Ultramarine Blue", YELLOW, RED].into_iter().enumerate() {
        let y = 40.0 - 15.0 * row as f64;
        for from in [6.0, 80.0, 6.0] {
            panel.load(BRUSH, mixture)?;
            panel.paint(&line([from, y], [86.0 - from, y], 0.4, 90.0))?;
        }
    }
    panel.take_up("round", sized("round", 6.0)?)?;
    for x in [20.0, 45.0, 70.0] {
        panel.load("round", "Titanium White=0.5,Thinner=0.5")?;
        let way = (0..9).map(|i| {
            let side = if i % 2 == 0 { -1.0 } else { 1.0 };
            [x + 7.0 * side, 45.0 - 5.2 * f64::from(i)]
        });
        panel.paint(&wave(way.collect(), 0.45, 3.0))?;
    }
    Ok(panel)
}

fn loading(library: PaintLibrary, board: Board) -> Result<Panel, UserError> {
    let mut panel = Panel::of("flat", 10.0, (library, board))?;
    let pairs = [
        ["Quinacridone Magenta=0.6,Pyrrole Red=0.4", WHITE],
        [BLUE, YELLOW],
        ["Burnt Sienna", "Yellow Ochre=0.5,Titanium White=0.5"],
    ];
    for (row, [left, right]) in pairs.into_iter().enumerate() {
        panel.load_beside(BRUSH, left, Some(right))?;
        let y = 39.0 - 15.0 * row as f64;
        let way = (0..7).map(|i| {
            let side = if i % 2 == 0 { -1.0 } else { 1.0 };
            [8.0 + 11.7 * f64::from(i), y + 2.7 * side]
        });
        panel.paint(&wave(way.collect(), 0.4, 2.4))?;
    }
    Ok(panel)
}

fn drying(library: PaintLibrary, board: Board) -> Result<Panel, UserError> {
    let mut panel = Panel::of("flat", 8.0, (library, board))?;
    // The stripe painted first dries most often: .75⁴ = .32 of it stays wet.
    for stripe in 0..5 {
        if stripe > 0 {
            panel.dry(0.25)?;
        }
        let y = 43.0 - 8.9 * f64::from(stripe);
        panel.load(BRUSH, "Ultramarine Blue=0.8,Titanium White=0.2")?;
        panel.paint(&line([5.0, y], [81.0, y], 0.45, 90.0))?;
        panel.paint(&line([81.0, y], [5.0, y], 0.4, 90.0))?;
    }
    for (i, x) in [15.0, 33.0, 51.0, 69.0].into_iter().enumerate() {
        panel.take_up(&format!("clean-{i}"), sized("filbert", 8.0)?)?;
        panel.paint(&line([x, 48.0], [x, 4.5], 1.0, 0.0))?;
    }
    Ok(panel)
}

fn blending(library: PaintLibrary, board: Board) -> Result<Panel, UserError> {
    let mut panel = Panel::of("flat", 13.0, (library, board))?;
    for (mixture, rows) in [
        ("Ultramarine Blue=0.7,Titanium White=0.3", [18.0, 8.0]),
        (YELLOW, [40.0, 30.0]),
    ] {
        for y in rows {
            for from in [6.0, 80.0] {
                panel.load(BRUSH, mixture)?;
                panel.paint(&line([from, y], [86.0 - from, y], 0.4, 90.0))?;
            }
        }
    }
    panel.take_up("filbert", sized("filbert", 10.0)?)?;
    for pass in 0..2 {
        for i in 0..5 {
            let x = 44.0 + 7.5 * f64::from(i) + 2.5 * f64::from(pass);
            let zigzag = (0..9).map(|turn| {
                let (side, down) = (f64::from(turn % 2), f64::from(turn / 2));
                [x + 0.8 * down, 12.0 + 24.0 * side]
            });
            panel.paint(&wave(zigzag.collect(), 0.45, 4.0))?;
        }
    }
    Ok(panel)
}

fn glazing(library: PaintLibrary, board: Board) -> Result<Panel, UserError> {
    let mut panel = Panel::of("flat", 15.0, (library, board))?;
    let greys = [
        "Bone Black=0.7,Titanium White=0.3",
        "Bone Black=0.2,Titanium White=0.8",
        "Bone Black=0.03,Titanium White=0.97",
    ];
    for (row, grey) in greys.into_iter().enumerate() {
        let y = 38.0 - 14.0 * row as f64;
        panel.load(BRUSH, grey)?;
        panel.paint(&line([6.0, y], [80.0, y], 0.5, 90.0))?;
        panel.paint(&line([80.0, y], [6.0, y], 0.3, 90.0))?;
    }
    panel.dry(1.0)?;
    panel.take_up("glaze", sized("flat", 14.0)?)?;
    let glazes = [
        ("Quinacridone Magenta=0.15,Thinner=0.85", 48.0),
        ("Phthalo Green Blue Shade=0.1,Thinner=0.9", 70.0),
    ];
    for (glaze, x) in glazes {
        for _ in 0..2 {
            panel.load("glaze", glaze)?;
            panel.paint(&line([x, 45.0], [x, 3.0], 0.4, 0.0))?;
        }
    }
    Ok(panel)
}

fn impasto(library: PaintLibrary, board: Board) -> Result<Panel, UserError> {
    let mut panel = Panel::of("bright", 8.0, (library, board))?;
    // Petals around two hearts, each of six loads.
    for (middle, colour) in [
        ([24.0, 24.0], "Hansa Yellow Opaque=0.3,Titanium White=0.7"),
        ([62.0, 24.0], "Quinacridone Magenta=0.2,Titanium White=0.8"),
    ] {
        for petal in 0..7 {
            let angle = std::f64::consts::TAU * f64::from(petal) / 7.0;
            let (sine, cosine) = maulstick_num::sin_cos(angle);
            let at = |radius: f64| [middle[0] + radius * cosine, middle[1] + radius * sine];
            for _ in 0..6 {
                panel.load(BRUSH, colour)?;
                let turned = angle.to_degrees() + 90.0;
                panel.paint(&line(at(7.0), at(17.0), 0.2, turned))?;
            }
        }
        for dab in 0..5 {
            let (sine, cosine) = maulstick_num::sin_cos(1.3 * f64::from(dab));
            let at = [middle[0] + 2.0 * cosine, middle[1] + 2.0 * sine];
            panel.load(BRUSH, "Cadmium Orange")?;
            panel.paint(&line(at, [at[0] + 1.5, at[1] + 1.0], 0.15, 45.0))?;
        }
    }
    Ok(panel)
}

/// Share of its load on a brush that is wiped for scumbling.
const NEARLY_EMPTY: f64 = 0.2;

fn scumbling(library: PaintLibrary, board: Board) -> Result<Panel, UserError> {
    let mut panel = Panel::of("bright", 10.0, (library, board))?;
    for i in 0..14 {
        let (column, row) = (i % 7, i / 7);
        let x = 10.0 + 11.0 * f64::from(column);
        let y = [35.5, 13.0][row as usize];
        panel.load(BRUSH, "Burnt Sienna=0.8,Bone Black=0.2")?;
        panel.paint(&line([x - 2.5, y - 10.0], [x + 2.5, y + 10.0], 0.25, 0.0))?;
    }
    panel.dry(1.0)?;
    panel.take_up("scumble", sized("flat", 13.0)?.wiped(NEARLY_EMPTY))?;
    panel.load("scumble", WHITE)?;
    for y in [40.0, 30.0, 19.0, 9.0] {
        let gesture = Gesture {
            seconds: 0.9,
            hand: Box::new(move |t| Moment {
                at: [44.0 + 38.0 * t, y],
                pressure: 0.02 + 0.05 * swell(t, 0.2),
                tilt_deg: [0.0; 2],
                twist_deg: 90.0,
            }),
        };
        panel.paint(&gesture)?;
    }
    Ok(panel)
}

fn thinning(library: PaintLibrary, board: Board) -> Result<Panel, UserError> {
    let mut panel = Panel::of("round", 8.0, (library, board))?;
    let mixtures = [
        "Ultramarine Blue",
        "Ultramarine Blue=0.6,Thinner=0.4",
        "Ultramarine Blue=0.3,Thinner=0.7",
        "Ultramarine Blue=0.1,Thinner=0.9",
    ];
    for (row, mixture) in mixtures.into_iter().enumerate() {
        let y = 40.5 - 11.0 * row as f64;
        panel.load(BRUSH, mixture)?;
        let way = (0..9).map(|i| {
            let side = if i % 2 == 0 { -1.0 } else { 1.0 };
            [6.0 + 9.2 * f64::from(i), y + 1.5 * side]
        });
        panel.paint(&wave(way.collect(), 0.4, 2.4))?;
    }
    Ok(panel)
}

#[cfg(test)]
mod tests {
    use super::*;
    use maulstick_models::MODELS;

    #[test]
    fn words_end_with_their_panel() {
        let sheet = Sheet::new([10.0, 10.0], 0.125).expect("small");
        let fits = |words: &str| {
            let size = (WORDS_SIZE_MM / sheet.cell_mm) as f32;
            sheet.page.length(words, size) <= sheet.pixels(PANEL_MM[0])
        };
        for effect in &EFFECTS {
            assert!(fits(effect.words), "{}", effect.words);
        }
        for panel in MODELS.iter().flat_map(|entry| entry.panels) {
            assert!(fits(panel.words), "{}", panel.words);
        }
        assert!(!fits(
            "thick strokes, dried; a wiped brush of white over the right half"
        ));
    }
}
