//! The desk from straight above: where its points are in the window, and the way back.

use eframe::egui::{Color32, Pos2, Rect, Vec2, vec2};
use glam::{DVec2, DVec3};
use maulstick_num::geometry::Rigid;
use maulstick_types::Pose;
use maulstick_types::scene::{CANVAS, Surface};

/// What lies around the surfaces.
pub const DESK_COLOUR: Color32 = Color32::from_gray(60);
/// Kept free around the surfaces, points.
const MARGIN: f32 = 16.0;

/// An orthographic view of the desk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// The part of the window that shows the desk, points.
    pub area: Rect,
    /// The point of the desk in its middle, m.
    pub middle: DVec2,
    /// Points a metre.
    pub scale: f64,
}

/// The corners of a surface on the desk, m: lower left, lower right, upper left, upper right.
#[must_use]
pub fn corners(surface: &Surface) -> [DVec3; 4] {
    let pose = Rigid::from(&surface.pose);
    let [width, height] = size_m(surface);
    [[0.0, 0.0], [width, 0.0], [0.0, height], [width, height]]
        .map(|[x, y]| pose.point(DVec3::new(x, y, 0.0)))
}

/// Width and height of a surface on the desk, m.
fn size_m(surface: &Surface) -> [f64; 2] {
    surface
        .cells
        .map(|cells| f64::from(cells) * surface.cell_m * surface.zoom)
}

/// The surfaces before the free hand moves them: the canvas unzoomed, its middle in the desk's origin;
/// others as they are.
#[must_use]
pub fn at_rest(surfaces: &[Surface]) -> Vec<Surface> {
    let rest = |surface: &Surface| {
        let mut surface = surface.clone();
        if surface.id == CANVAS {
            surface.zoom = 1.0;
            let [width, height] = size_m(&surface);
            surface.pose = Pose {
                position_m: [-0.5 * width, -0.5 * height, 0.0],
                ..Pose::IDENTITY
            };
        }
        surface
    };
    surfaces.iter().map(rest).collect()
}

/// Whether these are surfaces of the same sizes, wherever they lie.
#[must_use]
pub fn are_alike(some: &[Surface], others: &[Surface]) -> bool {
    let size = |surface: &Surface| (surface.id, surface.cells, surface.cell_m);
    some.iter().map(size).eq(others.iter().map(size))
}

impl View {
    /// The largest view of all `surfaces` in `area`, with a margin; none while there are none.
    #[must_use]
    pub fn fit(area: Rect, surfaces: &[Surface]) -> Option<Self> {
        let points: Vec<DVec2> = surfaces
            .iter()
            .flat_map(corners)
            .map(DVec3::truncate)
            .filter(|point| point.is_finite())
            .collect();
        let first = *points.first()?;
        let low = points.iter().fold(first, |low, point| low.min(*point));
        let high = points.iter().fold(first, |high, point| high.max(*point));
        let size = (high - low).max(DVec2::splat(1e-3));
        let room = area.shrink(MARGIN).size().max(Vec2::splat(1.0));
        let scale = (f64::from(room.x) / size.x).min(f64::from(room.y) / size.y);
        let middle = 0.5 * (low + high);
        Some(Self {
            area,
            middle,
            scale,
        })
    }

    /// Pixels of the view, as the window rounds them.
    #[must_use]
    pub fn pixels(&self, pixels_per_point: f32) -> [u32; 2] {
        let round = |at: f32| (at * pixels_per_point).round();
        let (from, to) = (self.area.min, self.area.max);
        [(from.x, to.x), (from.y, to.y)].map(|(from, to)| (round(to) - round(from)).max(0.0) as u32)
    }

    /// Where a point of the desk is in the window.
    #[must_use]
    pub fn to_window(&self, desk: DVec3) -> Pos2 {
        let off = (desk.truncate() - self.middle) * self.scale;
        self.area.center() + vec2(off.x as f32, -off.y as f32)
    }

    /// The point of the desk under a point of the window, m: on the surface that lies there, the
    /// palette before the canvas, and beside all on the plane of the canvas, which goes on.
    #[must_use]
    pub fn to_desk(&self, at: Pos2, surfaces: &[Surface]) -> DVec3 {
        let off = at - self.area.center();
        let off = DVec2::new(f64::from(off.x), -f64::from(off.y)) / self.scale;
        let below = self.middle + off;
        let mut uppermost: Vec<&Surface> = surfaces.iter().collect();
        uppermost.sort_by_key(|surface| std::cmp::Reverse(surface.id));
        let hits: Vec<(DVec3, bool)> = uppermost
            .iter()
            .filter_map(|surface| hit(below, surface))
            .collect();
        let on = hits.iter().find(|(_, inside)| *inside);
        on.or(hits.last())
            .map_or(below.extend(0.0), |(point, _)| *point)
    }
}

/// Where the vertical through `below` meets the plane of a surface, and whether inside its edges.
fn hit(below: DVec2, surface: &Surface) -> Option<(DVec3, bool)> {
    let to_desk = Rigid::from(&surface.pose);
    let back = to_desk.inverse();
    let (from, along) = (back.point(below.extend(0.0)), back.vector(DVec3::Z));
    if along.z.abs() < 1e-3 {
        return None;
    }
    let local = from - along * (from.z / along.z);
    let [width, height] = size_m(surface);
    let inside = (0.0..width).contains(&local.x) && (0.0..height).contains(&local.y);
    Some((to_desk.point(local), inside))
}

/// The level of detail for `cells` shown over `pixels`: the finest that has at least as many.
#[must_use]
pub fn level(cells: u32, pixels: f32) -> u32 {
    let ratio = cells as f32 / pixels.max(1.0);
    if ratio > 1.0 {
        ratio.log2().floor() as u32
    } else {
        0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use eframe::egui::pos2;
    use maulstick_num::geometry::rotation;
    use maulstick_paint::PaintingSetup;

    fn surfaces() -> Vec<Surface> {
        PaintingSetup::default().scene().surfaces
    }

    fn view(surfaces: &[Surface]) -> View {
        let area = Rect::from_min_size(pos2(10.0, 20.0), vec2(1100.0, 1000.0));
        View::fit(area, surfaces).expect("surfaces")
    }

    #[test]
    fn both_surfaces_fill_the_window_up_to_the_margin() {
        let surfaces = surfaces();
        let view = view(&surfaces);
        let places = surfaces.iter().flat_map(corners).map(|p| view.to_window(p));
        let bounds = Rect::from_points(&places.collect::<Vec<_>>());
        assert!(
            (bounds.left() - view.area.left() - MARGIN).abs() < 1e-3,
            "{bounds:?}"
        );
        assert!((bounds.right() - view.area.right() + MARGIN).abs() < 1e-3);
        assert!((bounds.center() - view.area.center()).length() < 1e-3);
        let corner = |surface: &Surface, i: usize| view.to_window(corners(surface)[i]);
        assert!(
            corner(&surfaces[1], 1).x < corner(&surfaces[0], 0).x,
            "the palette is at the left"
        );
        assert!(
            corner(&surfaces[0], 2).y < corner(&surfaces[0], 0).y,
            "up is up"
        );
    }

    #[test]
    fn a_canvas_that_is_moved_moves_in_the_window() {
        let first = surfaces();
        assert_eq!(at_rest(&first), first, "nobody has moved it yet");
        let mut moved = first.clone();
        moved[0].pose.position_m[0] += 0.05;
        moved[0].zoom = 2.0;
        assert!(are_alike(&first, &moved) && at_rest(&moved) == first);
        let view = view(&at_rest(&moved));
        let corner = |surface: &Surface| view.to_window(corners(surface)[0]).x;
        let right = f64::from(corner(&moved[0]) - corner(&first[0]));
        assert!((right - 0.05 * view.scale).abs() < 0.01, "{right} points");
        moved[0].cells[0] += 1;
        assert!(!are_alike(&first, &moved));
    }

    #[test]
    fn the_window_and_the_desk_are_the_same_place() {
        let mut surfaces = surfaces();
        let tilt = rotation(DVec3::X, 0.3);
        surfaces[1].pose = Pose {
            orientation: tilt.to_array(),
            ..surfaces[1].pose
        };
        let view = view(&surfaces);
        let round = |desk: DVec3| view.to_desk(view.to_window(desk), &surfaces);
        let canvas = DVec3::new(0.03, -0.05, 0.0);
        assert!((round(canvas) - canvas).length() < 1e-6);
        assert!(
            (round(canvas) - canvas * 1.01).length() > 1e-6,
            "a fault would pass"
        );
        let palette = Rigid::from(&surfaces[1].pose).point(DVec3::new(0.05, 0.1, 0.0));
        assert!(palette.z > 0.02 && (round(palette) - palette).length() < 1e-6);
        let beside = DVec3::new(0.2, 0.1, 0.0);
        assert!((round(beside) - beside).length() < 1e-6);
        assert_eq!(View::fit(view.area, &[]), None);
    }

    #[test]
    fn a_small_picture_takes_a_coarser_level() {
        assert_eq!(level(1024, 1024.0), 0);
        assert_eq!(level(1024, 500.0), 1);
        assert_eq!(level(1024, 1000.0), 0);
        assert_eq!(level(4096, 500.0), 3);
    }
}
