//! Handling of brushes and preparation of surfaces: modes, size, piles (Baxter 2004, § 6.4.1, 6.7, 6.8).

use maulstick_canvas::EditError;
use maulstick_canvas::quantum::{CELL_MAX, QUANTUM_M, REFERENCE_CELL_M, UNIT_M};
use maulstick_model::brush::traits::BrushTraits;
use maulstick_model::interface::{Handling, StepReport, Transfer};
use maulstick_optics::THINNER;
use maulstick_types::edits::{Handle, Piles, Size};
use maulstick_types::scene::{BrushHandling, BrushMode, PALETTE, Surface};
use maulstick_types::{Mixture, mixture::Part};

use super::Painting;
use crate::apply::{Applied, Apply};

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
    /// Findings of a step.
    pub(super) fn of(report: &StepReport, cell_m: f64) -> Self {
        if report.wet == 0 || report.footprint_cells == 0 {
            return Self::default();
        }
        let thinner = report.thinner as f64 / report.wet as f64;
        Self {
            film_m: report.wet as f64 / report.footprint_cells as f64 * QUANTUM_M,
            viscosity_m2_s: VISCOSITY_M2_S * maulstick_num::exp(THINNING * thinner),
            contact_m: cell_m * (report.footprint_cells as f64).sqrt(),
        }
    }
}

/// Preparation of a surface for a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Prepared {
    /// Quanta that stay on a cell.
    pub(super) stain: f32,
    /// True if paint that is taken up stays there all the same.
    pub(super) lasting: bool,
    /// True if brushes are filled on it.
    fills: bool,
}

impl Prepared {
    pub(super) fn of(surface: Option<&Surface>) -> Self {
        let stain_m = surface.map_or_else(maulstick_types::scene::default_stain_m, |surface| {
            surface.stain_m
        });
        Self {
            stain: (stain_m / QUANTUM_M) as f32,
            lasting: surface.is_some_and(|surface| surface.piles_last),
            fills: surface.is_some_and(|surface| surface.id == PALETTE),
        }
    }

    /// Traits of a brush on it; one that is stirred is used to take paint up.
    pub(super) fn traits(&self, traits: BrushTraits, transfer: Transfer) -> BrushTraits {
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

/// Handling of a brush, as a step takes it.
pub(super) fn handling_of(handling: Option<&BrushHandling>) -> Handling {
    let Some(handling) = handling else {
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
        painting.brush(&self.brush)?;
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

impl Apply for Size {
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        let stain_m = self.stain.get();
        painting.change_surface(self.surface, |surface| surface.stain_m = stain_m)
    }
}

impl Apply for Piles {
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        painting.change_surface(self.surface, |surface| surface.piles_last = self.last)
    }
}

impl Painting {
    fn change_surface(
        &mut self,
        id: u32,
        change: impl FnOnce(&mut Surface),
    ) -> Result<Applied, EditError> {
        self.surface(id)?;
        let mut surfaces = self.scene.surfaces.iter_mut();
        if let Some(surface) = surfaces.find(|own| own.id == id) {
            change(surface);
        }
        self.scene.version += 1;
        Ok(Applied::Done)
    }

    /// The mean colour of the paint on a brush.
    ///
    /// # Errors
    /// [`EditError`] for an unknown brush, or one that carries nothing.
    pub(super) fn carried_mixture(&mut self, brush: &str) -> Result<Mixture, EditError> {
        self.commit();
        let counts = self.brush(brush)?.load.counts();
        let total: u64 = counts.iter().sum();
        if total == 0 {
            return Err(EditError::EmptyBrush(brush.to_owned()));
        }
        let carried = self.scene.paints.iter().zip(counts);
        let parts = carried
            .filter(|(_, count)| *count > 0)
            .map(|(slot, count)| Part {
                paint: slot.name.clone(),
                share: count as f64 / total as f64,
            });
        Ok(Mixture {
            parts: parts.collect(),
        })
    }

    /// Surface under the brush with this hash of its name.
    #[must_use]
    pub fn under_brush(&self, source: u32) -> UnderBrush {
        let mut brushes = self.brushes.iter();
        let found = brushes.find(|(name, _)| maulstick_types::name_hash(name) == source);
        found.map_or_else(UnderBrush::default, |(_, track)| track.under)
    }

    /// The slot of the thinner, if the painting has one.
    pub(super) fn thinner(&self) -> Option<usize> {
        let mut paints = self.scene.paints.iter();
        paints.position(|slot| slot.name == THINNER)
    }
}
