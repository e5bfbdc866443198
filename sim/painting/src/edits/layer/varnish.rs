//! Varnish: a clear film over all that is dry, laid and taken off.

use maulstick_canvas::quantum::QUANTUM_M;
use maulstick_optics::VARNISHES;
use maulstick_types::mixture::Part;
use maulstick_types::paint::StepName;
use maulstick_types::scene::CANVAS;
use maulstick_types::values::ValueError;
use maulstick_types::{EditFields, Mixture, Region};

use super::wet::drop_empty_layers;
use crate::edits::{Applied, Form, PaintingEdit, StepForm, read, words};
use crate::error::{EditError, LayerError};
use crate::painting::Painting;
use crate::painting::optics::slot_of;

/// Thickness of a brushed coat once it is dry, m: chosen by eye, not measured.
const COAT_M: f64 = 15e-6;

/// How a varnish shines, or that it goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
pub enum Finish {
    /// Like glass.
    Gloss,
    /// Half gloss, half matt.
    Satin,
    /// Without highlights.
    Matt,
    /// No varnish: what lies on top is taken off.
    Off,
}

impl Finish {
    /// Its name in commands and scripts.
    fn name(self) -> &'static str {
        match self {
            Self::Gloss => "gloss",
            Self::Satin => "satin",
            Self::Matt => "matt",
            Self::Off => "off",
        }
    }

    /// Its varnishes in equal shares; none to take off.
    fn mixture(self) -> Mixture {
        let [gloss, matt] = VARNISHES.map(|(name, _)| name);
        let names = match self {
            Self::Gloss => &[gloss][..],
            Self::Satin => &[gloss, matt],
            Self::Matt => &[matt],
            Self::Off => &[],
        };
        let part = |name: &&str| Part {
            paint: (*name).to_owned(),
            share: 1.0 / names.len() as f64,
        };
        let parts = names.iter().map(part).collect();
        Mixture { parts }
    }
}

/// Varnish what is dry, or take varnish off
///
/// A coat of 15 µm goes over the canvas and what has dried on it, as a layer of its own; wet paint gets none.
/// Paint laid over it later stays on it.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::Args))]
pub struct Varnish {
    /// How it shines; off: take off the varnish on top
    #[serde(alias = "varnish")]
    pub finish: Finish,
    /// Only this rectangle, mm from the lower left corner of the canvas
    #[serde(default, deserialize_with = "read::optional")]
    #[cfg_attr(
        feature = "cli",
        arg(long, value_name = "X,Y,WxH", allow_hyphen_values = true)
    )]
    pub region: Option<Region>,
}

impl EditFields for Varnish {
    const NAME: &'static str = "varnish";
}

impl Form for Varnish {
    const STEPS: &'static [StepForm] = &[StepForm::new(
        "varnish",
        &["region"],
        "{ varnish = \"satin\", region = \"10,20,60x40\" }, { varnish = \"off\" }",
    )];
    const ARGUMENTS: Option<&'static [&'static str]> =
        Some(&["layer", "varnish", "satin", "--region", "10,20,60x40"]);
    #[cfg(feature = "cli")]
    const COMMAND: Option<crate::edits::CommandForm> =
        Some(crate::edits::CommandForm::of::<Self>("varnish", "layer"));

    fn example() -> Result<Self, ValueError> {
        Ok(Self {
            finish: Finish::Satin,
            region: Some("10,20,60x40".parse()?),
        })
    }
}

impl PaintingEdit for Varnish {
    /// Lays a coat as a dry layer on all cells of a part without wet paint, or takes off what varnish is uppermost there.
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        let Painting { bench, clock } = painting;
        let (on, part) = bench.desk.surfaces.part(CANVAS, self.region.as_ref())?;
        if !bench.desk.surfaces[on].is_of_films() {
            return Err(EditError::Own {
                what: "the canvas's paint model has no clear films, and a varnish is one",
                help: "convert the canvas to impasto first",
            });
        }
        bench.close_windows();
        let step = StepName::Words {
            words: "varnish".to_owned(),
        };
        if self.finish == Finish::Off {
            let scene = &bench.desk.scene;
            let slots = VARNISHES.map(|(name, _)| slot_of(scene, name));
            let slots: Vec<usize> = slots.into_iter().flatten().collect();
            let (tiles, numbers) = bench.desk.surfaces[on].unvarnished(&part, &slots);
            if tiles.is_empty() {
                return Err(LayerError::NoVarnish(self.region.clone()).into());
            }
            clock.stop(Some(CANVAS));
            bench.begin_step(step, None);
            bench.put_taken_off(on, tiles);
            drop_empty_layers(&mut bench.desk, numbers);
            bench.end_own_step();
            return Ok(Applied::Done);
        }
        if !bench.desk.surfaces[on].takes_varnish(&part) {
            return Err(LayerError::AllWet(self.region.clone()).into());
        }
        let slots = bench.desk.slots(&self.finish.mixture())?;
        let quanta = |share: f64| (share * COAT_M / QUANTUM_M).round() as f32;
        let coat: Vec<(usize, f32)> = slots
            .into_iter()
            .map(|(slot, share)| (slot, quanta(share)))
            .collect();
        let number = bench.desk.next_layer();
        let surfaces = &bench.desk.surfaces;
        let (tiles, given) = surfaces[on].varnished(&part, number, &coat, &surfaces.pager);
        clock.stop(Some(CANVAS));
        bench.begin_step(step, None);
        bench.put_changed(on, tiles);
        bench.accounts.ledger.from_tube(&given);
        bench.book(None);
        let name = format!("{} varnish", self.finish.name());
        let layer = bench.desk.add_layer(number, &name);
        bench.end_own_step();
        Ok(Applied::Dried(layer))
    }

    fn log_words(&self) -> String {
        let place = words::place(CANVAS, self.region.as_ref());
        match self.finish {
            Finish::Off => format!("take the varnish off the {place}"),
            finish => format!("{} varnish on the {place}", finish.name()),
        }
    }

    fn reply(&self) -> Option<&'static str> {
        (self.finish != Finish::Off).then_some("varnished: ")
    }
}
