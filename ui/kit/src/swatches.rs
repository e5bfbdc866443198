//! Paints under the light of the scene: masstone, and tint with white.

use std::collections::BTreeMap;
use std::sync::Arc;

use eframe::egui::{Color32, CornerRadius, Rect, Stroke, StrokeKind, Ui, pos2};
use maulstick_appearance::light::{changes_colour, studio_settings};
use maulstick_optics::{
    Blend, Coat, Layer, Paint, PaintLibrary, RuleKind, StudioSettings, Viewing,
};
use maulstick_types::Mixture;
use maulstick_types::scene::Light;

use crate::display_transform::DisplayTransform;

/// Parts of white to one part of paint in a tint.
const TINT: f64 = 10.0;
/// Thickness of the film by which hiding power is judged, m.
const FILM_M: f64 = 50e-6;
/// Greatest number of cached mixtures; above it all are recomputed.
const KEPT: usize = 256;
/// Colour of pure thinner, linear.
const CLEAR: [f32; 3] = [0.75, 0.75, 0.72];

/// Paints, with the light and the display under which they are shown.
#[derive(Clone, Copy, Debug)]
pub struct Showing<'a> {
    /// The paints.
    pub library: &'a Arc<PaintLibrary>,
    /// The light; the default one until a scene is known.
    pub light: Option<&'a Light>,
    /// Colours as the display has to be sent them.
    pub tint: &'a Arc<DisplayTransform>,
}

/// Paints as they look.
#[derive(Debug, Default)]
pub struct Swatches {
    made: Option<Made>,
}

/// Conditions of the cached colours.
#[derive(Debug)]
struct Made {
    library: Arc<PaintLibrary>,
    light: Light,
    tint: Arc<DisplayTransform>,
    viewing: Viewing,
    white: Option<Blend>,
    paints: BTreeMap<String, [Color32; 2]>,
    mixtures: BTreeMap<String, Color32>,
}

impl Swatches {
    /// Masstone and tint of a paint.
    pub fn paint(&mut self, showing: Showing<'_>, paint: &Paint) -> [Color32; 2] {
        let made = self.made_for(showing);
        if let Some(colours) = made.paints.get(&paint.name) {
            return *colours;
        }
        let own = Blend::new(&[(paint, 1.0)]);
        let tinted = made.white.as_ref().map_or_else(
            || own.clone(),
            |white| own.toward(white, TINT / (TINT + 1.0)),
        );
        let colours = [made.colour(&own), made.colour(&tinted)];
        made.paints.insert(paint.name.clone(), colours);
        colours
    }

    /// Colour of a thick layer of a mixture; `None` for paints that the rig lacks.
    pub fn mixture(&mut self, showing: Showing<'_>, mixture: &Mixture) -> Option<Color32> {
        let made = self.made_for(showing);
        let text = mixture.to_string();
        if let Some(colour) = made.mixtures.get(&text) {
            return Some(*colour);
        }
        let colour = made.colour(&Blend::of(&made.library, mixture).ok()?);
        if made.mixtures.len() >= KEPT {
            made.mixtures.clear();
        }
        made.mixtures.insert(text, colour);
        Some(colour)
    }

    fn made_for(&mut self, showing: Showing<'_>) -> &mut Made {
        let light = showing.light.cloned().unwrap_or_default();
        let holds = |made: &Made| {
            Arc::ptr_eq(&made.library, showing.library)
                && Arc::ptr_eq(&made.tint, showing.tint)
                && !changes_colour(&made.light, &light)
        };
        if !self.made.as_ref().is_some_and(holds) {
            self.made = None;
        }
        self.made.get_or_insert_with(|| Made::new(showing, light))
    }
}

impl Made {
    fn new(showing: Showing<'_>, light: Light) -> Self {
        // An invalid light was refused at its source.
        let settings = studio_settings(&light).unwrap_or_default();
        let settings = StudioSettings {
            rule: RuleKind::Reference,
            ..settings
        };
        let viewing = Viewing::new(&settings, showing.library.paints());
        Self {
            white: whitest(showing.library, &viewing),
            library: Arc::clone(showing.library),
            tint: Arc::clone(showing.tint),
            light,
            viewing,
            paints: BTreeMap::new(),
            mixtures: BTreeMap::new(),
        }
    }

    fn colour(&self, blend: &Blend) -> Color32 {
        let is_clear = blend.k.0.iter().chain(&blend.s.0).all(|v| *v == 0.0);
        let linear = if is_clear {
            CLEAR
        } else {
            let seen = self.viewing.coat(blend, &Coat::masstone());
            seen.linear.map(|channel| channel as f32)
        };
        self.tint.colour(linear)
    }
}

/// The lightest paint of a library, for tints.
fn whitest(library: &PaintLibrary, viewing: &Viewing) -> Option<Blend> {
    let paints = library.paints().iter();
    let seen = paints.map(|paint| {
        let blend = Blend::new(&[(paint, 1.0)]);
        (viewing.coat(&blend, &Coat::masstone()).xyz[1], blend)
    });
    let lightest = seen.max_by(|one, other| one.0.total_cmp(&other.0));
    lightest.map(|(_, blend)| blend)
}

/// Hiding power of a thin film of a paint over black and white, 0 to 1, in the middle of the spectrum.
#[must_use]
pub fn covers(paint: &Paint) -> f64 {
    let blend = Blend::new(&[(paint, 1.0)]);
    let over = |ground: f64| {
        let coat = Coat {
            layer: Layer::Film {
                thickness_m: FILM_M,
                thinner: 0.0,
                ground,
            },
            surface: None,
        };
        let nm = [500.0, 550.0, 600.0];
        nm.map(|nm| blend.reflectance_at(nm, &coat))
            .iter()
            .sum::<f64>()
    };
    (over(0.0) / over(1.0).max(1e-9)).clamp(0.0, 1.0)
}

/// Description of a paint for the painter.
#[must_use]
pub fn words(paint: &Paint) -> String {
    if paint.is_thinner() {
        return tr!(
            "{name}\nA clear medium: it thins the paint.",
            name = paint.name
        );
    }
    let cover = match (100.0 * covers(paint)).round() {
        percent if percent >= 80.0 => tr!("opaque ({percent} %)", percent),
        percent if percent >= 65.0 => tr!("half opaque ({percent} %)", percent),
        percent => tr!("transparent ({percent} %)", percent),
    };
    let index = if paint.colour_index.is_empty() {
        tr!("unknown")
    } else {
        &paint.colour_index
    };
    tr!(
        "{name}\nPigment: {index}\nIn a film of 50 µm it is {cover}.\nMeasured by: {source}",
        name = paint.name,
        index,
        cover,
        source = paint.source
    )
}

/// True if the typed text matches a paint's name or colour index.
#[must_use]
pub fn matches(paint: &Paint, typed: &str) -> bool {
    let plain = |text: &str| text.to_lowercase().replace(' ', "");
    let typed = plain(typed);
    plain(&paint.name).contains(&typed) || plain(&paint.colour_index).contains(&typed)
}

/// Draws masstone and tint side by side.
pub fn draw(ui: &Ui, area: Rect, colours: [Color32; 2]) {
    let middle = area.center().x;
    let left = Rect::from_min_max(area.min, pos2(middle, area.max.y));
    let right = Rect::from_min_max(pos2(middle, area.min.y), area.max);
    let [west, east] = [
        CornerRadius {
            nw: 4,
            sw: 4,
            ne: 0,
            se: 0,
        },
        CornerRadius {
            nw: 0,
            sw: 0,
            ne: 4,
            se: 4,
        },
    ];
    ui.painter().rect_filled(left, west, colours[0]);
    ui.painter().rect_filled(right, east, colours[1]);
    let edge = Stroke::new(1.0, ui.visuals().widgets.noninteractive.bg_stroke.color);
    ui.painter()
        .rect_stroke(area, 4.0, edge, StrokeKind::Inside);
}

#[cfg(test)]
mod tests {
    use maulstick_appearance::picture::Export;

    use super::*;

    /// The measured paints, and a display.
    fn studio() -> (Arc<PaintLibrary>, Arc<DisplayTransform>) {
        let library = PaintLibrary::measured().expect("whole");
        let display = DisplayTransform::new(&Export::default());
        (Arc::new(library), Arc::new(display))
    }

    fn under<'a>(
        (library, tint): &'a (Arc<PaintLibrary>, Arc<DisplayTransform>),
        light: Option<&'a Light>,
    ) -> Showing<'a> {
        Showing {
            library,
            light,
            tint,
        }
    }

    #[test]
    fn a_paint_looks_as_it_was_measured_and_lighter_with_white() {
        let studio = studio();
        let mut swatches = Swatches::default();
        let mut look = |name: &str| {
            let paint = studio.0.find(name).expect("known");
            swatches.paint(under(&studio, None), paint)
        };
        let [blue, tint] = look("Ultramarine Blue");
        assert!(
            blue.b() > 2 * blue.g() && tint.b() > 200,
            "{blue:?} {tint:?}"
        );
        assert!(tint.r() > blue.r() + 60, "a tint is lighter");
        let [white, tinted] = look("Titanium White");
        assert_eq!(white, tinted, "white in white is white");
        let [clear, _] = look("Thinner");
        assert!(clear.r() > 150, "{clear:?}");
    }

    #[test]
    fn another_light_gives_other_swatches() {
        let studio = studio();
        let mut swatches = Swatches::default();
        let mixture = Mixture::pure("Cobalt Blue");
        let mut look = |light: Option<&Light>, mixture: &Mixture| {
            swatches.mixture(under(&studio, light), mixture)
        };
        let day = look(None, &mixture).expect("known");
        assert_eq!(look(Some(&Light::default()), &mixture), Some(day));
        let light = Light {
            illuminant: "A".to_owned(),
            ..Light::default()
        };
        let lamp = look(Some(&light), &mixture).expect("known");
        assert_ne!(lamp, day, "a fault would pass");
        assert_eq!(look(Some(&light), &Mixture::pure("x")), None);
    }

    #[test]
    fn a_paint_is_found_by_name_and_index_and_told_in_words() {
        let (library, _) = studio();
        let find = |name: &str| library.find(name).expect("known");
        let white = find("Titanium White");
        for typed in ["titan", "pw6", "PW 6", "um wh", ""] {
            assert!(matches(white, typed), "{typed}");
        }
        assert!(!matches(white, "blue"));
        let (cover, percent) = (words(white), (100.0 * covers(white)).round());
        let opaque = tr!("opaque ({percent} %)", percent);
        assert!(percent >= 80.0 && cover.contains(&opaque), "{cover}");
        let quinacridone = words(find("Quinacridone Magenta"));
        assert!(quinacridone.contains("transparent"), "{quinacridone}");
        assert!(words(find("Thinner")).contains("thins"));
    }
}
