//! The bristle strips of a brush's head in space.

use glam::{DQuat, DVec3};
use maulstick_brush::{BrushFile, SpineShape};
use maulstick_num::geometry::{Rigid, shortest_arc};
use maulstick_num::sin_cos;

/// Strips of a head.
const STRIPS: usize = 384;
/// Stations along a strip.
const STATIONS: usize = 9;
/// Turn from strip to strip of a spiral that covers a disc evenly, rad.
const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;

/// Strips in space: planes of coordinates, `station · strips + strip`, station 0 at the ferrule, m.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HeadPose {
    /// Right.
    pub x: Vec<f32>,
    /// Up along the surface.
    pub y: Vec<f32>,
    /// Above the surface.
    pub z: Vec<f32>,
}

/// The head of a brush.
#[derive(Clone, Debug)]
pub struct Head {
    file: BrushFile,
}

impl Head {
    /// The head of a brush file.
    #[must_use]
    pub fn of(file: &BrushFile) -> Self {
        Self { file: file.clone() }
    }

    /// Number of strips.
    #[must_use]
    pub fn strips(&self) -> usize {
        STRIPS
    }

    /// Number of stations along a strip.
    #[must_use]
    pub fn stations(&self) -> usize {
        STATIONS
    }

    /// Whether a state with this many joint angles belongs to this head.
    #[must_use]
    pub fn fits(&self, angles: usize) -> bool {
        angles == self.file.spine().joints()
    }

    /// The strips of a brush at `brush` with the angles of its joints.
    pub fn pose(&self, brush: &Rigid, angles: &[[f32; 2]], into: &mut HeadPose) {
        let spine = self.file.spine();
        let shape = SpineShape::from_angles(brush.translation, brush.rotation, angles);
        for plane in [&mut into.x, &mut into.y, &mut into.z] {
            plane.clear();
        }
        for station in 0..STATIONS {
            let share = station as f64 / (STATIONS - 1) as f64;
            let mut left = share * spine.length_m();
            let mut middle = shape.root;
            let mut turn = DQuat::IDENTITY;
            for (direction, length) in shape.directions.iter().zip(&spine.lengths_m) {
                middle += *direction * left.clamp(0.0, *length);
                if left > 0.0 {
                    turn = shortest_arc(shape.base, *direction);
                }
                left -= length;
            }
            for strip in 0..STRIPS {
                let (sine, cosine) = sin_cos(strip as f64 * GOLDEN_ANGLE);
                let ring = ((strip as f64 + 0.5) / STRIPS as f64).sqrt();
                let across = DVec3::new(cosine, sine, 0.0) * (ring * self.file.radius_m(share));
                let p = middle + turn * (brush.rotation * across);
                into.x.push(p.x as f32);
                into.y.push(p.y as f32);
                into.z.push(p.z.max(0.0) as f32);
            }
        }
    }
}
