//! Steps that are on the device alone, kept until they are settled, so that none is lost with it.

use std::sync::Arc;

use maulstick_brush::{Head, HeadPose};
use maulstick_canvas::window::Window;
use maulstick_model::brush::load::BrushLoad;
use maulstick_model::brush::traits::BrushTraits;
use maulstick_model::interface::{Handling, PaintModel, Step, StepReport, Sweep};

/// A step without window and load.
struct KeptStep {
    before: Option<Arc<HeadPose>>,
    from: Arc<HeadPose>,
    to: Arc<HeadPose>,
    bounds: ([i64; 2], [i64; 2]),
    traits: BrushTraits,
    handling: Handling,
    stain: f32,
    lasting: bool,
    thinner: Option<usize>,
}

/// Steps of one head in one window since these were last settled.
pub(crate) struct KeptSteps {
    pub(crate) head: Head,
    steps: Vec<KeptStep>,
}

impl KeptSteps {
    /// None of a head yet.
    pub(crate) fn of(head: Head) -> Self {
        Self {
            head,
            steps: Vec::new(),
        }
    }

    /// Number of steps.
    pub(crate) fn len(&self) -> usize {
        self.steps.len()
    }

    /// Keeps a step.
    pub(crate) fn keep(&mut self, step: &Step<'_>) {
        self.steps.push(KeptStep {
            before: step.sweep.before.map(|pose| self.shared(pose)),
            from: self.shared(step.sweep.from),
            to: Arc::new(step.sweep.to.clone()),
            bounds: step.bounds,
            traits: step.traits,
            handling: step.handling,
            stain: step.stain,
            lasting: step.lasting,
            thinner: step.thinner,
        });
    }

    /// A pose, shared with the last step where it is the same.
    fn shared(&self, pose: &HeadPose) -> Arc<HeadPose> {
        let last = self.steps.last();
        let last = last.into_iter().flat_map(|last| [&last.to, &last.from]);
        let same = last.into_iter().find(|last| ***last == *pose);
        same.map_or_else(|| Arc::new(pose.clone()), Arc::clone)
    }

    /// Repeats all steps with another model, on the last settled window and load.
    pub(crate) fn replay(
        &self,
        model: &mut dyn PaintModel,
        window: &mut Window,
        load: &mut BrushLoad,
    ) -> StepReport {
        let mut report = StepReport::default();
        for kept in &self.steps {
            let did = model.step(&mut Step {
                window,
                head: &self.head,
                sweep: Sweep {
                    before: kept.before.as_deref(),
                    from: &kept.from,
                    to: &kept.to,
                },
                bounds: kept.bounds,
                load,
                traits: kept.traits,
                handling: kept.handling,
                stain: kept.stain,
                lasting: kept.lasting,
                thinner: kept.thinner,
            });
            report.add(&did);
        }
        report
    }
}
