//! Handling of brushes: modes, tuning, and the paint under them (Baxter 2004, § 6.7).

use maulstick_canvas::quantum::{CELL_MAX, QUANTUM_M, REFERENCE_CELL_M, UNIT_M};
use maulstick_model::interface::{Handling, StepReport, Transfer};
use maulstick_model::rheology::Rheology;
use maulstick_types::scene::{BrushMode, PALETTE, Scene};

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
    /// Mean of a report over a number of steps, in paint of this rheology.
    pub(crate) fn mean(report: &StepReport, steps: u32, cell_m: f64, rheology: &Rheology) -> Self {
        let mean = |sum: u64| (sum / u64::from(steps.max(1))) as f64;
        let [cells, wet, thinner] = [report.footprint_cells, report.wet, report.thinner].map(mean);
        if wet == 0.0 || cells == 0.0 {
            return Self::default();
        }
        Self {
            film_m: wet / cells * QUANTUM_M,
            viscosity_m2_s: rheology.thinned_m2_s(thinner / wet),
            contact_m: cell_m * cells.sqrt(),
        }
    }
}

/// Handling of a brush on a surface of a scene, as a step takes it. On the palette a brush is not bound: there paints are
/// mixed.
pub(crate) fn handling_of(scene: &Scene, brush: &str, surface: u32) -> Handling {
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
    let most = if handling.most_m > 0.0 && surface != PALETTE {
        (handling.most_m / QUANTUM_M) as f32
    } else {
        CELL_MAX as f32
    };
    Handling {
        push,
        transfer,
        most,
    }
}
