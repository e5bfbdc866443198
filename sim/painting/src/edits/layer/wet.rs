//! Makes dry layers wet again.

use std::collections::BTreeSet;
use std::fmt;
use std::num::NonZeroU32;
use std::sync::Arc;

use maulstick_types::paint::StepName;
use maulstick_types::scene::CANVAS;
use maulstick_types::values::ValueError;
use maulstick_types::{EditFields, Region};
use serde::de::{Deserialize, Deserializer, Error, Visitor};

use crate::edits::{Applied, Form, PaintingEdit, StepForm, read, words};
use crate::error::{EditError, LayerError};
use crate::painting::Painting;
use crate::painting::desk::Desk;
use crate::painting::surfaces::Changed;

/// Make dry layers wet again
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Wet {
    /// Number of the newest dry layers to make wet; all if absent.
    #[serde(alias = "wet", deserialize_with = "count_or_all")]
    pub layers: Option<u32>,
    /// The part; all of it if absent.
    #[serde(default, deserialize_with = "read::optional")]
    pub region: Option<Region>,
    /// The surface.
    #[serde(default = "read::canvas")]
    pub surface: u32,
}

/// Reads a number above 0, or "all".
struct CountOrAll;

impl Visitor<'_> for CountOrAll {
    type Value = Option<u32>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("how many of the newest layers, or \"all\"")
    }

    fn visit_i64<E: Error>(self, count: i64) -> Result<Option<u32>, E> {
        let layers = u32::try_from(count).ok().and_then(NonZeroU32::new);
        let unexpected = serde::de::Unexpected::Signed(count);
        layers
            .map(|count| Some(count.get()))
            .ok_or_else(|| E::invalid_value(unexpected, &self))
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<Option<u32>, E> {
        match text {
            "all" => Ok(None),
            _ => Err(E::invalid_value(serde::de::Unexpected::Str(text), &self)),
        }
    }
}

fn count_or_all<'de, D: Deserializer<'de>>(from: D) -> Result<Option<u32>, D::Error> {
    if from.is_human_readable() {
        return from.deserialize_any(CountOrAll);
    }
    match Option::<u32>::deserialize(from)? {
        Some(0) => Err(D::Error::custom("no layer is chosen")),
        layers => Ok(layers),
    }
}

impl EditFields for Wet {
    const NAME: &'static str = "wet";
}

impl Form for Wet {
    const STEPS: &'static [StepForm] = &[StepForm::new(
        "wet",
        &["region"],
        "{ wet = 1 }, { wet = \"all\", region = \"10,20,60x40\" }",
    )];
    const ARGUMENTS: Option<&'static [&'static str]> = Some(&["layer", "wet"]);
    #[cfg(feature = "cli")]
    const COMMAND: Option<crate::edits::CommandForm> = Some(crate::edits::CommandForm::of::<
        cli::WetOptions,
    >("wet", "layer"));

    fn example() -> Result<Self, ValueError> {
        Ok(Self {
            layers: Some(1),
            region: None,
            surface: CANVAS,
        })
    }
}

impl PaintingEdit for Wet {
    /// Rewets the newest dry layers of a part in place.
    ///
    /// A cell takes at most its capacity: paint without room, and all under it there, stays dry. A layer that is empty
    /// afterwards is removed from the scene. A layer whose opacity is not 1 is refused, because wet paint has no
    /// opacity.
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        let Painting { bench, clock } = painting;
        let region = self.region.as_ref();
        let (on, part) = bench.desk.surfaces.part(self.surface, region)?;
        bench.close_windows();
        let surface = &bench.desk.surfaces[on];
        let numbers = surface.newest_on(&part, self.layers);
        let Some(least) = numbers.first().copied() else {
            return Err(LayerError::NothingDry(self.region.clone()).into());
        };
        let known = bench.desk.scene.layers.iter();
        let chosen = known.filter(|layer| numbers.contains(&layer.number));
        if let Some(veiled) = chosen.clone().find(|layer| layer.opacity != 1.0) {
            return Err(LayerError::Veiled {
                number: veiled.number,
                name: veiled.name.clone(),
            }
            .into());
        }
        let layers: Vec<String> = chosen.rev().map(|layer| layer.name.clone()).collect();
        let mut full_cells = 0;
        let mut tiles = Changed::new();
        for (id, tile, within) in surface.dried_tiles(&part) {
            if let Some(rewet) = tile.rewet(least, &within, surface.bare.shown.has_sheets()) {
                full_cells += rewet.full_cells;
                tiles.push((id, Arc::new(rewet.tile)));
            }
        }
        if tiles.is_empty() {
            return Err(LayerError::NoRoom(self.region.clone()).into());
        }
        clock.stop(Some(self.surface));
        bench.begin_step(StepName::Wet, None);
        bench.put_changed(on, tiles);
        drop_empty_layers(&mut bench.desk, numbers);
        bench.end_own_step();
        Ok(Applied::Rewet { layers, full_cells })
    }

    fn log_words(&self) -> String {
        let layers = match self.layers {
            None => "all layers".to_owned(),
            Some(1) => "the newest layer".to_owned(),
            Some(count) => format!("the newest {count} layers"),
        };
        let place = words::place(self.surface, self.region.as_ref());
        format!("wet {layers} of the {place}")
    }

    fn reply(&self) -> Option<&'static str> {
        Some("wet again: ")
    }
}

/// Removes those of `numbers` from the scene that are empty on every surface.
pub(super) fn drop_empty_layers(desk: &mut Desk, numbers: BTreeSet<u32>) {
    let mut gone = numbers;
    for (_, version) in desk.surfaces.iter().flat_map(|own| own.store.iter()) {
        let stack = version.tile.as_ref().and_then(|tile| tile.dry());
        let layers = stack.into_iter().flat_map(|stack| stack.layers());
        layers.for_each(|layer| {
            gone.remove(&layer.number);
        });
    }
    if !gone.is_empty() {
        let layers = &mut desk.scene.layers;
        layers.retain(|layer| !gone.contains(&layer.number));
        desk.layers_changed();
    }
}

#[cfg(feature = "cli")]
mod cli {
    use super::{Region, Wet};
    use crate::edits::read;
    use maulstick_types::Edit;

    /// Make dry layers wet again
    #[derive(clap::Args)]
    pub(super) struct WetOptions {
        /// Number of the newest dry layers to make wet
        #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
        layers: u32,
        /// Make all dry layers wet
        #[arg(long, conflicts_with = "layers")]
        all: bool,
        /// Only this rectangle, mm from the lower left corner of the surface
        #[arg(long, value_name = "X,Y,WxH", allow_hyphen_values = true)]
        region: Option<Region>,
        /// Use the palette instead of the canvas
        #[arg(long = "palette", action = clap::ArgAction::SetTrue, value_parser = read::surface())]
        surface: u32,
    }

    impl From<WetOptions> for Edit {
        fn from(options: WetOptions) -> Self {
            Wet {
                layers: (!options.all).then_some(options.layers),
                region: options.region,
                surface: options.surface,
            }
            .into()
        }
    }
}
