//! Ferrule and handle: the half of each elliptical tube that faces the viewer, with soft edges.

use eframe::egui::{Mesh, Pos2, Vec2};
use glam::{DVec3, Vec3};
use maulstick_num::sin_cos;
use maulstick_ui_kit::display_transform::DisplayTransform;

use crate::render::brush::geometry::{Material, Section};
use crate::render::view_light::{ViewLight, smoothstep};

/// Width of the soft edge, points.
const SOFT: f32 = 1.0;
/// Heights between which the handle fades, so that it does not hide the painting, and what is left
/// of it above, m.
const FADES_M: [f64; 2] = [0.06, 0.16];
const FADED: f32 = 0.35;
/// Angle of the soldered seam of the ferrule, from +x counterclockwise, and half the seam's width, rad.
const SEAM: f64 = 2.2;
const SEAM_WIDTH: f64 = 0.035;

/// Linear colours of what a brush is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Finish {
    pub nickel: Vec3,
    pub lacquer: Vec3,
}

impl Default for Finish {
    fn default() -> Self {
        Self {
            nickel: Vec3::new(0.66, 0.65, 0.62),
            lacquer: Vec3::new(0.30, 0.035, 0.02),
        }
    }
}

impl Finish {
    /// As a display takes it.
    #[must_use]
    pub(crate) fn tinted(self, tint: &DisplayTransform) -> Self {
        let tinted = |colour: Vec3| Vec3::from_array(tint.linear(colour.to_array()));
        Self {
            nickel: tinted(self.nickel),
            lacquer: tinted(self.lacquer),
        }
    }

    /// The light that a material with the normal `n` sends to the viewer.
    ///
    /// Across a tube all is lit by its surroundings: lamp and window are long, so their streak goes along it however it
    /// leans.
    fn seen(&self, material: Material, n: Vec3, across: &Across) -> Vec3 {
        let (streak, lit) = (n.dot(across.half), n.dot(across.toward).max(0.0));
        let rim = (1.0 - n.dot(across.up).max(0.0)).powi(3);
        match material {
            Material::Wood => {
                let diffuse = self.lacquer * (0.34 + 0.78 * lit);
                let gleam = 0.42 * streak.max(0.0).powi(70) + 0.05 * streak.max(0.0).powi(10);
                diffuse + Vec3::splat(gleam + 0.05 * rim)
            }
            Material::Metal | Material::Groove => {
                // Metal shows the room: a window on the lamp's side in its dark frame, and another
                // across.
                let window = smoothstep(0.84, 0.97, streak);
                let frame = smoothstep(0.30, 0.62, streak) - smoothstep(0.62, 0.86, streak);
                let other = smoothstep(0.55, 0.92, -n.dot(across.beside));
                let room = 0.30 + 0.62 * window - 0.20 * frame + 0.26 * other + 0.10 * rim;
                let dull = if material == Material::Groove {
                    0.5
                } else {
                    1.0
                };
                self.nickel * room * dull
            }
        }
    }
}

/// Directions as they are seen across a tube.
struct Across {
    up: Vec3,
    toward: Vec3,
    half: Vec3,
    /// To the side, from the streak of the lamp.
    beside: Vec3,
}

impl Across {
    fn of(axis: Vec3, sight: &ViewLight<'_>) -> Self {
        let flat = |v: Vec3| (v - axis * v.dot(axis)).normalize_or(axis.any_orthonormal_vector());
        let (up, half) = (flat(sight.up), flat(sight.half()));
        let beside = axis.cross(half);
        Self {
            up,
            toward: flat(sight.toward),
            half,
            // The side of the streak that more is seen of.
            beside: if beside.dot(up) > 0.0 {
                -beside
            } else {
                beside
            },
        }
    }
}

/// Opacity at a height.
fn opacity(height_m: f64) -> f32 {
    let fade = (height_m - FADES_M[0]) / (FADES_M[1] - FADES_M[0]);
    1.0 - (1.0 - FADED) * fade.clamp(0.0, 1.0) as f32
}

/// A ring of points around a section.
struct Ring {
    at: Vec<Vec3>,
    seen: Vec<Pos2>,
    opacity: f32,
}

/// Ferrule and handle as one mesh, the lower parts first.
#[must_use]
pub(crate) fn handle(sections: &[Section], finish: &Finish, sight: &ViewLight<'_>) -> Mesh {
    let mut mesh = Mesh::default();
    let widest = sections
        .iter()
        .map(|s| s.half[0].length())
        .fold(0.0, f64::max);
    let turns = turns(widest as f32 * sight.scale);
    let rings: Vec<Ring> = sections.iter().map(|s| ring(s, &turns, sight)).collect();
    let ends = [sections.first(), sections.last()].map(|end| end.map_or(DVec3::ZERO, |s| s.at));
    let axis = (ends[1] - ends[0]).as_vec3().normalize_or(sight.up);
    let tube = Tube {
        across: Across::of(axis, sight),
        sections,
        rings: &rings,
        turns: &turns,
    };
    for part in 0..sections.len().saturating_sub(1) {
        tube.draw(part, finish, sight, &mut mesh);
    }
    mesh
}

/// Angles around a section, in a number that fits its size, with the seam among them.
fn turns(radius: f32) -> Vec<f64> {
    const FULL: f64 = 2.0 * std::f64::consts::PI;
    let count = (6.0 + 3.0 * radius.max(0.0)).min(40.0) as u32;
    let mut turns: Vec<f64> = (0..count)
        .map(|i| FULL * f64::from(i) / f64::from(count))
        .filter(|turn| (turn - SEAM).abs() > 3.0 * SEAM_WIDTH)
        .collect();
    turns.extend([-2.0, -1.0, 1.0, 2.0].map(|side| SEAM + side * SEAM_WIDTH));
    turns.sort_by(f64::total_cmp);
    turns
}

fn ring(section: &Section, turns: &[f64], sight: &ViewLight<'_>) -> Ring {
    let point = |turn: &f64| {
        let (sin, cos) = sin_cos(*turn);
        (section.at + cos * section.half[0] + sin * section.half[1]).as_vec3()
    };
    let at: Vec<Vec3> = turns.iter().map(point).collect();
    Ring {
        seen: at.iter().map(|p| (sight.to_window)(*p)).collect(),
        opacity: opacity(section.at.z),
        at,
    }
}

/// The rings of a brush, and what is between them.
struct Tube<'a> {
    sections: &'a [Section],
    rings: &'a [Ring],
    turns: &'a [f64],
    across: Across,
}

impl Tube<'_> {
    fn next(&self, turn: usize) -> usize {
        (turn + 1) % self.turns.len()
    }

    /// True if the face of a part between a turn and the next one looks at the viewer.
    fn faces(&self, part: usize, turn: usize, up: Vec3) -> bool {
        let (low, high) = (&self.rings[part].at, &self.rings[part + 1].at);
        let next = self.next(turn);
        let around = low[next] + high[next] - low[turn] - high[turn];
        let along = high[turn] + high[next] - low[turn] - low[next];
        around.cross(along).dot(up) > 0.0
    }

    /// The normal of a ring's point as it belongs to a part: smooth where both sides are of one
    /// material.
    fn normal(&self, part: usize, ring: usize, turn: usize) -> Vec3 {
        let material = self.sections[part].material;
        let same = |other: usize| self.sections[other].material == material;
        let below = if ring > 0 && same(ring - 1) {
            ring - 1
        } else {
            part
        };
        let last = self.rings.len() - 1;
        let above = if ring < last && same(ring) {
            ring + 1
        } else {
            part + 1
        };
        let along = self.rings[above].at[turn] - self.rings[below].at[turn];
        // The ellipse's own tangent: at the handle's end its rings are points.
        let (sin, cos) = sin_cos(self.turns[turn]);
        let [x, y] = self.sections[part].half;
        let around: DVec3 = -sin * x + cos * y;
        around
            .as_vec3()
            .normalize_or_zero()
            .cross(along)
            .normalize_or(Vec3::Z)
    }

    fn draw(&self, part: usize, finish: &Finish, sight: &ViewLight<'_>, mesh: &mut Mesh) {
        let count = self.turns.len();
        let faces: Vec<bool> = (0..count).map(|t| self.faces(part, t, sight.up)).collect();
        let material = self.sections[part].material;
        let metal = material != Material::Wood;
        let mut vertices = vec![None; count];
        let mut vertex = |turn: usize, mesh: &mut Mesh| -> u32 {
            *vertices[turn].get_or_insert_with(|| {
                let first = mesh.vertices.len() as u32;
                let seam = metal && (self.turns[turn] - SEAM).abs() < 1.5 * SEAM_WIDTH;
                for ring in [part, part + 1] {
                    let n = self.normal(part, ring, turn);
                    let shade = if seam { 0.55 } else { 1.0 };
                    let colour = finish.seen(material, n, &self.across) * shade;
                    let own = &self.rings[ring];
                    mesh.colored_vertex(own.seen[turn], sight.vertex(colour, own.opacity));
                }
                first
            })
        };
        for turn in (0..count).filter(|turn| faces[*turn]) {
            let next = self.next(turn);
            let (a, b) = (vertex(turn, mesh), vertex(next, mesh));
            mesh.add_triangle(a, b, a + 1);
            mesh.add_triangle(b, b + 1, a + 1);
            let middle = self.middle(part, turn);
            // The silhouette is where the neighbouring face looks away, and where the tube ends.
            if !faces[next] {
                soften(mesh, [b, b + 1], middle);
            }
            if !faces[(turn + count - 1) % count] {
                soften(mesh, [a, a + 1], middle);
            }
            if part == 0 || !self.faces(part - 1, turn, sight.up) {
                soften(mesh, [a, b], middle);
            }
            if part + 2 >= self.rings.len() || !self.faces(part + 1, turn, sight.up) {
                soften(mesh, [a + 1, b + 1], middle);
            }
        }
    }

    /// The middle of a face in the window.
    fn middle(&self, part: usize, turn: usize) -> Pos2 {
        let next = self.next(turn);
        let corners = [
            self.rings[part].seen[turn],
            self.rings[part].seen[next],
            self.rings[part + 1].seen[turn],
            self.rings[part + 1].seen[next],
        ];
        let sum = corners.iter().fold(Vec2::ZERO, |sum, p| sum + p.to_vec2());
        (0.25 * sum).to_pos2()
    }
}

/// Lets the edge between two vertices fade out on the side away from `inside`.
fn soften(mesh: &mut Mesh, edge: [u32; 2], inside: Pos2) {
    let [a, b] = edge.map(|i| mesh.vertices[i as usize]);
    let along = b.pos - a.pos;
    if along.length() < 1e-3 {
        return;
    }
    let across = along.rot90().normalized() * SOFT;
    let out = if across.dot(a.pos - inside) < 0.0 {
        -across
    } else {
        across
    };
    let first = mesh.vertices.len() as u32;
    for end in [a, b] {
        mesh.colored_vertex(end.pos + out, eframe::egui::Color32::TRANSPARENT);
    }
    mesh.add_triangle(edge[0], edge[1], first);
    mesh.add_triangle(edge[1], first + 1, first);
}

#[cfg(test)]
mod tests {
    use eframe::egui::pos2;
    use maulstick_brush::BrushFile;
    use maulstick_num::geometry::{Rigid, shortest_arc};

    use super::*;
    use crate::render::brush::geometry::sections;

    const SCALE: f32 = 4000.0;

    /// The handle of a flat brush that leans, as vertices: place in mm, red and opacity.
    fn drawn(lean: DVec3, toward: Vec3) -> Vec<([f32; 2], u8, u8)> {
        let brush = Rigid {
            rotation: shortest_arc(DVec3::Z, lean.normalize()),
            translation: DVec3::new(0.0, 0.0, 0.01),
        };
        let file = BrushFile::library("flat").expect("flat");
        let to_window = |p: Vec3| pos2(SCALE * p.x, -SCALE * p.y);
        let sight = ViewLight {
            to_window: &to_window,
            scale: SCALE,
            up: Vec3::Z,
            toward,
            light: 1.0,
        };
        let mesh = handle(&sections(&brush, &file), &Finish::default(), &sight);
        assert!(mesh.is_valid());
        let place = |at: Pos2| [1e3 * at.x / SCALE, -1e3 * at.y / SCALE];
        let vertices = mesh.vertices.iter();
        vertices
            .map(|v| (place(v.pos), v.color.r(), v.color.a()))
            .collect()
    }

    #[test]
    fn a_handle_is_lit_from_the_lamps_side() {
        // It goes up from the middle.
        let lean = DVec3::new(0.0, 1.0, 1.0);
        let side = |toward: Vec3, left: bool| {
            let drawn = drawn(lean, toward);
            let there = |at: &[f32; 2]| at[1] > 60.0 && (at[0] < -1.0) == left && at[0].abs() > 1.0;
            let reds = drawn
                .iter()
                .filter(|(at, _, alpha)| *alpha > 0 && there(at));
            let reds: Vec<f32> = reds
                .map(|(_, red, alpha)| f32::from(*red) / f32::from(*alpha))
                .collect();
            reds.iter().sum::<f32>() / reds.len() as f32
        };
        let [left, right] = [Vec3::new(-0.6, 0.0, 0.8), Vec3::new(0.6, 0.0, 0.8)];
        assert!(
            side(left, true) > 1.1 * side(left, false),
            "{}",
            side(left, true)
        );
        assert!(side(right, true) < side(right, false), "a fault would pass");
    }

    #[test]
    fn a_flat_ferrule_is_as_wide_as_it_is_turned_and_its_edge_is_soft() {
        let width = |lean: DVec3| {
            let drawn = drawn(lean, Vec3::Z);
            let low = drawn
                .iter()
                .filter(|(at, ..)| at[1].abs() < 4.0 && at[0].abs() < 14.0);
            low.map(|(at, ..)| at[0].abs()).fold(0.0, f32::max)
        };
        let wide = width(DVec3::new(0.0, 1.0, 1.0));
        assert!((9.0..13.0).contains(&wide), "{wide}");
        let clear = drawn(DVec3::Z, Vec3::Z)
            .iter()
            .filter(|(_, _, alpha)| *alpha == 0)
            .count();
        assert!(clear > 20, "{clear}");
    }

    #[test]
    fn what_is_high_hides_less() {
        let drawn = drawn(DVec3::Z, Vec3::Z);
        let least = drawn
            .iter()
            .map(|(_, _, alpha)| *alpha)
            .filter(|alpha| *alpha > 0)
            .min();
        assert_eq!(least, Some((255.0 * FADED) as u8));
        assert!(drawn.iter().any(|(_, _, alpha)| *alpha == 255));
    }
}
