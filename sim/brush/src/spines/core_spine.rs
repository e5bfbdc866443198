//! The core of a head: one spine for the mean of all, which bends as the head does as a whole.
//!
//! Spines that are solved in turn and only repel each other would each give way to a different side where an upright
//! head is pressed down. The core gives way to one side, and bonds hold the segments of the others to where it would
//! carry them.

use glam::{DQuat, DVec3};
use maulstick_num::geometry::{Rigid, shortest_arc};

use crate::energy::bond::Bond;
use crate::spine::{Spine, SpineShape};
use crate::spine_root::SpineRoot;

/// The core, and the pose of the segments of all spines relative to its own.
#[derive(Clone, Debug, PartialEq)]
pub struct Core {
    /// Root and material of the core.
    pub root: SpineRoot,
    /// For each spine and segment: the core's segment beside it, and its own direction at rest in that segment's
    /// frame.
    beside: Vec<Vec<(usize, DVec3)>>,
}

impl Core {
    /// The mean of spines.
    #[must_use]
    pub fn of(roots: &[SpineRoot]) -> Self {
        let joints = roots.iter().map(|root| root.spine.joints()).max();
        let n = joints.unwrap_or(1);
        let count = roots.len().max(1) as f64;
        let rests: Vec<SpineShape> = roots
            .iter()
            .map(|root| root.at_rest(&Rigid::IDENTITY))
            .collect();
        let root = roots.iter().map(|root| root.origin).sum::<DVec3>() / count;
        let mut before = root;
        let segments: Vec<DVec3> = (1..=n)
            .map(|k| {
                let places = roots.iter().zip(&rests).map(|(root, shape)| {
                    let m = root.spine.joints();
                    let place = (k * m) as f64 / n as f64;
                    let i = (place as usize).min(m - 1);
                    let segment = shape.directions[i] * root.spine.lengths_m[i];
                    shape.joint(&root.spine, i) - segment * ((i + 1) as f64 - place)
                });
                let end = places.sum::<DVec3>() / count;
                let segment = end - before;
                before = end;
                segment
            })
            .collect();
        let along = |of: &dyn Fn(&Spine, usize) -> f64| -> Vec<f64> {
            // A joint of a shorter spine stands for several successive ones of the core.
            let share = |root: &SpineRoot, k: usize| {
                let m = root.spine.joints();
                of(&root.spine, k * m / n) * n as f64 / m as f64
            };
            (0..n)
                .map(|k| roots.iter().map(|root| share(root, k)).sum::<f64>() / count)
                .collect()
        };
        let spine = Spine {
            lengths_m: segments.iter().map(|segment| segment.length()).collect(),
            stiffness: along(&|spine, i| spine.stiffness[i]),
            damping: along(&|spine, i| spine.damping[i]),
            rest: Vec::new(),
        };
        let root = SpineRoot::drawn(root, &segments, spine);
        let mut rested = Vec::new();
        frames(&root.at_rest(&Rigid::IDENTITY), &mut rested);
        let beside = roots.iter().zip(&rests).map(|(root, shape)| {
            let m = root.spine.joints();
            let directions = shape.directions.iter().enumerate();
            directions
                .map(|(i, direction)| {
                    let k = (2 * i + 1) * n / (2 * m);
                    (k, rested[k].conjugate() * *direction)
                })
                .collect()
        });
        Self {
            beside: beside.collect(),
            root,
        }
    }

    /// The bonds of spine `number` to a bent core, whose frames are [`frames`]; `share` is their stiffness as a
    /// multiple of the spine's joints'.
    pub fn bonds(
        &self,
        number: usize,
        frames: &[DQuat],
        spine: &Spine,
        share: f64,
        into: &mut Vec<Bond>,
    ) {
        into.clear();
        if share > 0.0 {
            let segments = self.beside[number].iter().zip(&spine.stiffness);
            into.extend(segments.map(|((k, own), stiffness)| Bond {
                toward: frames[*k] * *own,
                stiffness: share * stiffness,
            }));
        }
    }
}

/// The frames of a spine's segments, each rotated from the one before by the shortest arc.
pub fn frames(shape: &SpineShape, into: &mut Vec<DQuat>) {
    into.clear();
    let (mut rotation, mut before) = (shape.frame, shape.base());
    into.extend(shape.directions.iter().map(|direction| {
        rotation = (shortest_arc(before, *direction) * rotation).normalize();
        before = *direction;
        rotation
    }));
}
