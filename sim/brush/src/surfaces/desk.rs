//! Surfaces on the desk, and the ferrule's pose from a stylus sample.

use glam::{DVec2, DVec3};
use maulstick_num::geometry::{Rigid, rotation, shortest_arc};
use maulstick_num::sin_cos;
use maulstick_types::scene::{CANVAS, Scene, Surface, WellKind};
use maulstick_types::stylus::{StylusPose, StylusSample};

use crate::palette_place::{corner_radii, is_on};
use crate::solver::HalfSpace;

/// Height of the head's point above the surface under a pen without pressure, m.
pub const HOVER_M: f64 = 5e-3;

/// Difference of heights below which surfaces are level, m.
const EVEN_M: f64 = 1e-6;

/// Geometry of a surface for the brush.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// Number of the surface.
    pub id: u32,
    /// Surface frame to desk frame.
    pub to_desk: Rigid,
    /// Desk lengths per surface length.
    pub zoom: f64,
    /// Width and height in the surface's own lengths, m.
    pub size_m: [f64; 2],
    /// Side of a cell in the surface's own lengths, m.
    pub cell_m: f64,
    /// Radii of its corners in its own lengths, m, in the order of [`corner_radii`].
    pub radii_m: [f64; 4],
}

impl Plane {
    fn of(surface: &Surface) -> Self {
        Self {
            id: surface.id,
            to_desk: Rigid::from(&surface.pose),
            zoom: surface.zoom,
            size_m: surface.cells.map(|cells| f64::from(cells) * surface.cell_m),
            cell_m: surface.cell_m,
            radii_m: corner_radii(surface),
        }
    }

    /// Normal toward the painter, desk frame.
    #[must_use]
    pub fn normal(&self) -> DVec3 {
        self.to_desk.vector(DVec3::Z)
    }

    /// Half space under it, desk frame.
    #[must_use]
    pub fn half_space(&self) -> HalfSpace {
        let normal = self.normal();
        HalfSpace {
            normal,
            offset_m: normal.dot(self.to_desk.translation),
        }
    }

    /// True if a point is over the surface.
    #[must_use]
    pub fn holds(&self, in_desk: DVec3) -> bool {
        let p = self.to_desk.inverse().point(in_desk) / self.zoom;
        is_on(DVec2::from_array(self.size_m), self.radii_m, p.truncate())
    }
}

/// Obstacle to a brush, relative to a surface: convex, so that a joint is outside at least one of its faces. Lengths
/// are the desk's, axes those of the surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Obstacle {
    faces: Vec<HalfSpace>,
}

impl Obstacle {
    /// The half space below z = 0, which continues beyond the surface's edge.
    #[must_use]
    pub fn ground() -> Self {
        Self {
            faces: vec![HalfSpace::SURFACE],
        }
    }

    /// The face that a point is farthest outside of, or least within.
    #[must_use]
    pub fn face_toward(&self, p: DVec3) -> HalfSpace {
        let mut best = self.faces[0];
        for face in &self.faces[1..] {
            if face.gap(p) > best.gap(p) {
                best = *face;
            }
        }
        best
    }

    /// True if a ball overlaps it.
    fn is_near(&self, p: DVec3, radius: f64) -> bool {
        self.face_toward(p).gap(p) < radius
    }

    /// A plane relative to another: the canvas is the half space under it, a palette a board.
    fn of(plane: &Plane, seen_from: &Plane) -> Self {
        let place = seen_from.to_desk.inverse().after(&plane.to_desk);
        let face = |normal: DVec3, through: DVec3| {
            let normal = place.vector(normal);
            HalfSpace {
                normal,
                offset_m: normal.dot(place.point(through)),
            }
        };
        let far = DVec3::new(plane.size_m[0], plane.size_m[1], 0.0) * plane.zoom;
        let mut faces = vec![face(DVec3::Z, DVec3::ZERO)];
        if plane.id != CANVAS {
            faces.push(face(DVec3::NEG_X, DVec3::ZERO));
            faces.push(face(DVec3::NEG_Y, DVec3::ZERO));
            faces.push(face(DVec3::X, far));
            faces.push(face(DVec3::Y, far));
        }
        Self { faces }
    }
}

/// The surfaces of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Desk {
    planes: Vec<Plane>,
    jars: Vec<Jar>,
}

/// A jar of cleaner on a surface, in the surface's own lengths.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Jar {
    surface: u32,
    center_m: DVec2,
    radius_m: f64,
}

impl Desk {
    /// The desk of a scene; the palette is above the canvas.
    #[must_use]
    pub fn of(scene: &Scene) -> Self {
        let mut planes: Vec<Plane> = scene.surfaces.iter().map(Plane::of).collect();
        planes.sort_by_key(|plane| std::cmp::Reverse(plane.id));
        let jars = scene.surfaces.iter().flat_map(|surface| {
            let wells = surface.wells.iter();
            let cleaners = wells.filter(|well| well.kind == WellKind::Cleaner);
            cleaners.map(|well| Jar {
                surface: surface.id,
                center_m: well.center_m.into(),
                radius_m: well.radius_m,
            })
        });
        let jars = jars.collect();
        Self { planes, jars }
    }

    /// True if a point over a surface, in its frame with the desk's lengths, is in a jar of cleaner.
    #[must_use]
    pub fn cleans(&self, plane: &Plane, p: DVec3) -> bool {
        let at = p.truncate() / plane.zoom;
        let mut jars = self.jars.iter().filter(|jar| jar.surface == plane.id);
        jars.any(|jar| at.distance(jar.center_m) < jar.radius_m)
    }

    /// Obstacles to a brush with a head of `head_m` and its ferrule at `ferrule`, in the frame of `surface`: that
    /// surface first, then the others within reach.
    ///
    /// Surfaces in one plane are merged, without an edge between them.
    #[must_use]
    pub fn obstacles(&self, surface: &Plane, ferrule: DVec3, head_m: f64) -> Vec<Obstacle> {
        let same = |plane: &&Plane| {
            let place = surface.to_desk.inverse().after(&plane.to_desk);
            let upright = place.vector(DVec3::Z).z > 1.0 - 1e-9;
            plane.id == surface.id || (upright && place.translation.z.abs() < EVEN_M)
        };
        let own = if self.planes.iter().all(|plane| same(&plane)) {
            Obstacle::ground()
        } else {
            Obstacle::of(surface, surface)
        };
        let others = self.planes.iter().filter(|plane| !same(plane));
        let others = others
            .map(|plane| Obstacle::of(plane, surface))
            .filter(|obstacle| obstacle.is_near(ferrule, 1.1 * head_m));
        std::iter::once(own).chain(others).collect()
    }

    /// Its surfaces, the palette before the canvas.
    #[must_use]
    pub fn planes(&self) -> &[Plane] {
        &self.planes
    }

    /// The surface called `id`.
    #[must_use]
    pub fn plane(&self, id: u32) -> Option<&Plane> {
        self.planes.iter().find(|plane| plane.id == id)
    }

    /// Surfaces that stop a descending point: those below it, and the canvas, whose plane continues.
    pub fn below(&self, in_desk: DVec3) -> impl Iterator<Item = &Plane> {
        let planes = self.planes.iter();
        planes.filter(move |plane| plane.id == CANVAS || plane.holds(in_desk))
    }

    /// The surface under a point: the palette before the canvas, and elsewhere the canvas, whose plane continues.
    #[must_use]
    pub fn under(&self, in_desk: DVec3) -> Option<&Plane> {
        self.planes
            .iter()
            .find(|plane| plane.holds(in_desk))
            .or_else(|| self.plane(CANVAS))
    }
}

/// Orientation of a pen: its axis by two tilts, and its rotation about that axis.
#[must_use]
pub fn pen_orientation(tilt_rad: [f64; 2], twist_rad: f64) -> glam::DQuat {
    let tangent = |angle: f64| {
        let (s, c) = sin_cos(angle);
        s / c
    };
    let axis = DVec3::new(tangent(tilt_rad[0]), tangent(tilt_rad[1]), 1.0).normalize();
    shortest_arc(DVec3::Z, axis) * rotation(DVec3::Z, twist_rad)
}

/// Point that selects the surface: the ferrule of a 6-DOF device, the contact point of a pen.
#[must_use]
pub fn aim(sample: &StylusSample, head_length_m: f64) -> DVec3 {
    match &sample.pose {
        StylusPose::Ferrule { pose } => {
            Rigid::from(pose).point(DVec3::new(0.0, 0.0, -head_length_m))
        }
        StylusPose::Contact { point_m, .. } => DVec3::from_array(*point_m),
    }
}

/// Brush frame to desk frame for a sample. For a pen the ferrule is at contact point + axis · head length · (1 −
/// depth_share · pressure), and [`HOVER_M`] higher without pressure. The contact point is projected onto `surface`
/// (desk frame), because the tablet gives no height.
#[must_use]
pub fn ferrule(
    sample: &StylusSample,
    head_length_m: f64,
    depth_share: f64,
    surface: &HalfSpace,
) -> Rigid {
    match &sample.pose {
        StylusPose::Ferrule { pose } => Rigid::from(pose),
        StylusPose::Contact {
            point_m,
            tilt_rad,
            twist_rad,
            pressure,
        } => {
            let rotation = pen_orientation(*tilt_rad, *twist_rad);
            let axis = rotation * DVec3::Z;
            let hover = if *pressure > 0.0 { 0.0 } else { HOVER_M };
            let normal = surface.normal;
            let point = DVec3::from_array(*point_m);
            let translation = point - normal * surface.gap(point)
                + axis * (head_length_m * (1.0 - depth_share * pressure))
                + normal * hover;
            Rigid {
                rotation,
                translation,
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use maulstick_types::stylus::{DEFAULT_TILT_RAD, axes};

    use super::*;

    fn pen(pressure: f64) -> StylusSample {
        StylusSample {
            senses: axes::POSITION | axes::PRESSURE,
            pose: StylusPose::Contact {
                point_m: [0.01, 0.02, 0.0],
                tilt_rad: DEFAULT_TILT_RAD,
                twist_rad: 0.0,
                pressure,
            },
            ..StylusSample::away()
        }
    }

    #[test]
    fn the_default_tilt_is_30_degrees_toward_the_lower_right() {
        let axis = pen_orientation(DEFAULT_TILT_RAD, 0.4) * DVec3::Z;
        assert!((axis.z - 0.75f64.sqrt()).abs() < 1e-12, "{axis}");
        assert!((axis.x - 0.125f64.sqrt()).abs() < 1e-12 && (axis.x + axis.y).abs() < 1e-12);
    }

    #[test]
    fn a_pen_paints_on_a_raised_board_too() {
        let level = plane(1, 0.0, 0.01).half_space();
        let on = |wall: &HalfSpace| ferrule(&pen(0.5), 0.025, 0.5, wall).translation;
        let raised = on(&level) - on(&HalfSpace::SURFACE);
        assert!((raised - DVec3::Z * 0.01).length() < 1e-15, "{raised}");
    }

    fn plane(id: u32, x: f64, z: f64) -> Plane {
        Plane {
            id,
            to_desk: Rigid {
                translation: DVec3::new(x, 0.0, z),
                ..Rigid::IDENTITY
            },
            zoom: 1.0,
            size_m: [0.1, 0.2],
            cell_m: 2.5e-4,
            radii_m: [0.0; 4],
        }
    }

    #[test]
    fn a_raised_palette_is_a_board_and_an_even_one_is_none() {
        let (canvas, raised) = (plane(CANVAS, 0.0, 0.0), plane(1, -0.15, 0.01));
        let desk = Desk {
            planes: vec![raised, canvas],
            jars: Vec::new(),
        };
        let over_gap = DVec3::new(-0.045, 0.1, 0.02);
        let [own, board] = &desk.obstacles(&canvas, over_gap, 0.03)[..] else {
            panic!("two obstacles");
        };
        assert_eq!(own.face_toward(over_gap).normal, DVec3::Z);
        // Beside the board its edge stops a joint, over it its top.
        let edge = board.face_toward(DVec3::new(-0.045, 0.1, 0.001));
        assert!((edge.normal - DVec3::X).length() < 1e-12);
        assert!((edge.gap(DVec3::new(-0.045, 0.1, 0.001)) - 0.005).abs() < 1e-12);
        let top = board.face_toward(DVec3::new(-0.1, 0.1, 0.02));
        assert!((top.normal - DVec3::Z).length() < 1e-12 && (top.offset_m - 0.01).abs() < 1e-12);
        let far = DVec3::new(0.05, 0.1, 0.02);
        assert_eq!(desk.obstacles(&canvas, far, 0.03).len(), 1, "out of reach");
        let even = Desk {
            planes: vec![plane(1, -0.15, 0.0), canvas],
            jars: Vec::new(),
        };
        assert_eq!(
            even.obstacles(&canvas, over_gap, 0.03),
            [Obstacle::ground()]
        );
    }

    #[test]
    fn pressure_lowers_the_ferrule_along_the_pen() {
        let length = 0.025;
        let at = |pressure: f64| {
            let rigid = ferrule(&pen(pressure), length, 0.5, &HalfSpace::SURFACE);
            rigid.point(DVec3::new(0.0, 0.0, -length))
        };
        let contact = DVec3::new(0.01, 0.02, 0.0);
        assert!((at(0.0) - contact - DVec3::Z * HOVER_M).length() < 1e-12);
        assert!(
            (at(1e-12) - contact).length() < 1e-12,
            "a touch begins at the contact point"
        );
        assert!((at(1.0).z + 0.5 * length * 0.75f64.sqrt()).abs() < 1e-12);
    }
}
