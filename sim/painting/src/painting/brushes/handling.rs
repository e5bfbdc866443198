//! Handling of brushes and preparation of surfaces: modes, size, piles (Baxter 2004, § 6.4.1, 6.7, 6.8).

use maulstick_canvas::EditError;
use maulstick_canvas::quantum::{CELL_MAX, QUANTUM_M, REFERENCE_CELL_M, UNIT_M};
use maulstick_model::brush::traits::BrushTraits;
use maulstick_model::interface::{Handling, StepReport, Transfer};
use maulstick_types::edits::{Handle, Tune};
use maulstick_types::scene::{BrushHandling, BrushMode, PALETTE, Scene, Surface};

use crate::apply::{Applied, Apply};
use crate::painting::Painting;

/// Share of what a film lacks that comes from inside, and of its surplus that goes there, each time
/// that paint flows in a brush on the palette, on reference cells: there it is filled through and
/// through.
const DIP: f64 = 0.6;
/// Factor on the path length where a brush is filled: it is stirred and turned.
const STIRRED: f32 = 4.0;
/// Kinematic viscosity of oil paint as it comes from the tube, m²/s (Baxter 2004, § 5.2).
const VISCOSITY_M2_S: f64 = 1e-2;
/// ln of the factor on the viscosity of paint that is thinner alone.
const THINNING: f64 = -4.6;

/// Paint under a brush.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct UnderBrush {
    /// Mean thickness of the wet film, m.
    pub film_m: f64,
    /// Its kinematic viscosity, m²/s.
    pub viscosity_m2_s: f64,
    /// Length of the contact: the side of a square as large, m.
    pub contact_m: f64,
}

impl UnderBrush {
    /// Mean findings of so many steps.
    pub(crate) fn mean(report: &StepReport, steps: u32, cell_m: f64) -> Self {
        let mean = |sum: u64| (sum / u64::from(steps.max(1))) as f64;
        let [cells, wet, thinner] = [report.footprint_cells, report.wet, report.thinner].map(mean);
        if wet == 0.0 || cells == 0.0 {
            return Self::default();
        }
        Self {
            film_m: wet / cells * QUANTUM_M,
            viscosity_m2_s: VISCOSITY_M2_S * maulstick_num::exp(THINNING * (thinner / wet)),
            contact_m: cell_m * cells.sqrt(),
        }
    }
}

/// Preparation of a surface for a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Prepared {
    /// Quanta that stay on a cell.
    pub(crate) stain: f32,
    /// True if paint that is taken up stays there all the same.
    pub(crate) lasting: bool,
    /// True if brushes are filled on it.
    fills: bool,
}

impl Prepared {
    pub(crate) fn of(surface: &Surface) -> Self {
        Self {
            stain: (surface.stain_m / QUANTUM_M) as f32,
            lasting: surface.piles_last,
            fills: surface.id == PALETTE,
        }
    }

    /// Traits of a brush on it; one that is stirred is used to take paint up.
    pub(crate) fn traits(&self, traits: BrushTraits, transfer: Transfer) -> BrushTraits {
        let stirred = matches!(transfer, Transfer::Paint | Transfer::Sponge);
        match self.fills && stirred {
            true => BrushTraits {
                refill: 1.0 - maulstick_num::powf(1.0 - DIP, f64::from(traits.cell_per_reference)),
                cell_per_reference: STIRRED * traits.cell_per_reference,
                ..traits
            },
            false => traits,
        }
    }
}

/// Handling of a brush in a scene, as a step takes it.
pub(crate) fn handling_of(scene: &Scene, brush: &str) -> Handling {
    let mut handlings = scene.handlings.iter();
    let Some(handling) = handlings.find(|handling| handling.brush == brush) else {
        return Handling::default();
    };
    let flow = (handling.flow * REFERENCE_CELL_M / UNIT_M) as f32;
    let (push, transfer) = match handling.mode {
        BrushMode::Normal => (true, Transfer::Paint),
        BrushMode::NoPush => (false, Transfer::Paint),
        BrushMode::Sponge => (true, Transfer::Sponge),
        BrushMode::SpongeNoPush => (false, Transfer::Sponge),
        BrushMode::Marker => (false, Transfer::Marker { flow }),
        BrushMode::Sampler => (false, Transfer::Sampler),
        BrushMode::Vacuum => (false, Transfer::Vacuum),
    };
    let most = match handling.most_m > 0.0 {
        true => (handling.most_m / QUANTUM_M) as f32,
        false => CELL_MAX as f32,
    };
    Handling {
        push,
        transfer,
        most,
    }
}

impl Apply for Handle {
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        painting.brushes.at(&self.brush)?;
        let handling = BrushHandling::from(self.clone());
        let handlings = &mut painting.scene.handlings;
        handlings.retain(|other| other.brush != handling.brush);
        if handling != BrushHandling::normal(&handling.brush) {
            handlings.push(handling);
        }
        painting.scene.version += 1;
        Ok(Applied::Done)
    }
}

impl Apply for Tune {
    /// Makes a brush stiffer or softer; who solves it hears of it by the scene.
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        painting.brushes.at(&self.brush)?;
        let tunings = &mut painting.scene.tunings;
        tunings.retain(|other| other.brush != self.brush.as_str());
        tunings.push(self.clone().into());
        painting.scene.version += 1;
        Ok(Applied::Done)
    }
}
