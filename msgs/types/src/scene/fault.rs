//! Faults of a scene's numbers: a program in any language may send one.

use super::{BrushHandling, BrushSet, Layer, PaintSlot, Scene, Surface, Tuning};
use crate::values::{Quantity, Zoom};

/// Cells of a surface each way, more than any has.
const CELLS_MAX: u32 = 1 << 20;

impl Scene {
    /// Fault of the numbers, if there is one: over such a desk no brush could be followed.
    #[must_use]
    pub fn fault(&self) -> Option<&'static str> {
        if let Some(fault) = self.surfaces.iter().find_map(Surface::fault) {
            return Some(fault);
        }
        if self.light.check().is_err() {
            return Some("the light is not finite or out of range");
        }
        let wrong = self.paints.iter().any(PaintSlot::is_wrong)
            || self.tunings.iter().any(Tuning::is_wrong)
            || self.layers.iter().any(Layer::is_wrong)
            || self.handlings.iter().any(BrushHandling::is_wrong)
            || self.sets.iter().any(BrushSet::is_wrong);
        wrong.then_some("a paint, a layer or the use of a brush is not finite or out of range")
    }
}

impl Surface {
    fn fault(&self) -> Option<&'static str> {
        let finite = |values: &[f64]| values.iter().all(|value| value.is_finite());
        let well = |well: &super::Well| finite(&well.center_m) && well.radius_m.is_finite();
        if !self.pose.is_valid() {
            Some("a surface's pose is not finite or its quaternion is not a unit one")
        } else if Zoom::check(self.zoom).is_err() {
            Some("a surface's zoom is out of range")
        } else if !(1e-6..=1.0).contains(&self.cell_m)
            || !self.cells.iter().all(|n| (1..=CELLS_MAX).contains(n))
        {
            Some("a surface's cells are out of range")
        } else if !self.stain_m.is_finite() || !self.wells.iter().all(well) {
            Some("a surface's stain or a well is not finite")
        } else {
            None
        }
    }
}

impl PaintSlot {
    fn is_wrong(&self) -> bool {
        let mut channels = self.masstone.iter().chain(&self.tint);
        !channels.all(|channel| channel.is_finite())
    }
}

impl Tuning {
    fn is_wrong(&self) -> bool {
        let stiff = self.stiffness.is_finite() && self.stiffness > 0.0;
        !(stiff && (0.0..=1.0).contains(&self.wetness))
    }
}

impl Layer {
    fn is_wrong(&self) -> bool {
        !(0.0..=1.0).contains(&self.opacity)
    }
}

impl BrushSet {
    fn is_wrong(&self) -> bool {
        let mut angles = self.angles_rad.as_flattened().iter();
        !angles.all(|angle| angle.is_finite())
    }
}

impl BrushHandling {
    fn is_wrong(&self) -> bool {
        !(self.flow.is_finite() && self.most_m.is_finite())
    }
}
