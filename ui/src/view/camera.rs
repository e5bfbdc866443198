//! The view of the desk from above its middle: desk points to window points and back.

use eframe::egui::{Color32, Pos2, Rect, Vec2, vec2};
use glam::{DVec2, DVec3};
use maulstick_brush::palette_place::{GAP_M, Side, corner_radii, is_on, size_m};
use maulstick_brush::placement::SurfacePlacement;
use maulstick_num::geometry::Rigid;
use maulstick_types::scene::Surface;

use crate::view::quad::Quad;

/// Colour of the desk around the surfaces.
pub const DESK_COLOUR: Color32 = Color32::from_gray(60);
/// Margin above the surfaces, and at the side without a palette, points.
const MARGIN: f32 = 12.0;
/// Margin below the surfaces, points: the bar and the name of the painting lie there, over neither wells nor jars.
const BELOW: f32 = 42.0;
/// Width of the palette that always stays in view, m: its wells and the cleaner, and the part of a board above the
/// canvas that perspective takes.
const SLIVER_M: f64 = 0.0527;
/// So much of its middle, where paint is mixed, shows as well as long as the canvas is not smaller than [`SMALL`], m.
const MIXING_M: f64 = 0.06;
/// Width of a canvas that gives the palette no more room, points.
const SMALL: f64 = 400.0;
/// Height of the eye over the desk by the longer side of the view: a painter before an easel.
const EYE: f64 = 2.5;

/// A view of the desk by an eye over its middle: what lies flat on the desk is seen true to scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// The part of the window that shows the desk, points.
    pub area: Rect,
    /// The point of the desk in its middle, m.
    pub middle: DVec2,
    /// Points a metre of the desk.
    pub scale: f64,
    /// True if right and left are exchanged, as in a mirror.
    pub mirrored: bool,
    /// Width and height that a canvas may fill about the desk's origin, m.
    pub room: DVec2,
}

/// The corners of a surface on the desk, m: lower left, lower right, upper left, upper right.
#[must_use]
pub fn corners(surface: &Surface) -> [DVec3; 4] {
    let pose = Rigid::from(&surface.pose);
    let [width, height] = (size_m(surface) * surface.zoom).to_array();
    [[0.0, 0.0], [width, 0.0], [0.0, height], [width, height]]
        .map(|[x, y]| pose.point(DVec3::new(x, y, 0.0)))
}

impl View {
    /// The view in `area` of a canvas at rest: the canvas fills the view, the palette beside it shows as far as there
    /// is room, but at least its wells and, unless the window is small, a part of its middle, and `rack` points on the
    /// other side are left free. `None` if a surface has no size.
    #[must_use]
    pub fn of(
        area: Rect,
        canvas: &Surface,
        palette: Option<&Surface>,
        side: Side,
        rack: f32,
    ) -> Option<Self> {
        let size = size_m(canvas);
        let board = palette.map_or(DVec2::ZERO, |palette| size_m(palette) * palette.zoom);
        if !(size.min_element() > 0.0 && size.is_finite() && board.is_finite()) {
            return None;
        }
        let gap = if palette.is_some() { GAP_M } else { 0.0 };
        let sliver = board.x.min(SLIVER_M);
        let room = [area.width() - rack - MARGIN, area.height() - MARGIN - BELOW];
        let room = room.map(|points| f64::from(points.max(1.0)));
        let high = size.y.max(board.y);
        let beside = |board: f64| room[0] / (size.x + gap + board);
        let mixing = beside(board.x.min(SLIVER_M + MIXING_M));
        let across = beside(sliver).min(mixing.max(SMALL / size.x));
        let scale = across.min(room[1] / high);
        // The rest of the width shows more of the palette, then lies on both sides alike.
        let left = room[0] / scale - (size.x + gap + sliver);
        let more = left
            .min(board.x - sliver + f64::from(MARGIN) / scale)
            .max(0.0);
        let aside = sliver + more + gap + 0.5 * (left - more).max(0.0);
        // From the middle of the area to that of the canvas, m.
        let half = 0.5 * f64::from(area.width()) / scale;
        let off = aside + 0.5 * size.x - half;
        let down = 0.5 * f64::from(BELOW - MARGIN) / scale;
        let middle = match side {
            Side::Left => DVec2::new(-off, -down),
            Side::Right => DVec2::new(off, -down),
        };
        Some(Self {
            area,
            middle,
            scale,
            mirrored: false,
            room: DVec2::new(size.x + left - more, room[1] / scale),
        })
    }

    /// The view in a mirror that stands upright in the middle of its area; the desk's origin, about which the canvas
    /// lies, is then where the view of the other side's palette has it.
    #[must_use]
    pub fn mirrored(self) -> Self {
        Self {
            mirrored: !self.mirrored,
            middle: DVec2::new(-self.middle.x, self.middle.y),
            ..self
        }
    }

    /// A point of the desk or a way along it as the window has them, and back: right is left in a mirror.
    #[must_use]
    pub fn seen_x(&self, x: f64) -> f64 {
        if self.mirrored { -x } else { x }
    }

    /// The largest view of a single surface in the middle of `area`.
    #[cfg(test)]
    pub(crate) fn fit(area: Rect, surfaces: &[Surface]) -> Option<Self> {
        let [low, _, _, high] = corners(surfaces.first()?).map(DVec3::truncate);
        let room = area.shrink(16.0).size().max(Vec2::splat(1.0));
        let size = (high - low).abs();
        let scale = (f64::from(room.x) / size.x).min(f64::from(room.y) / size.y);
        Some(Self {
            area,
            middle: 0.5 * (low + high),
            scale,
            mirrored: false,
            room: size,
        })
    }

    /// The canvas as large as the view has room for it, upright and flat.
    #[must_use]
    pub fn fitted(&self, canvas: &Surface) -> SurfacePlacement {
        let size = size_m(canvas);
        let zoom = (self.room / size).min_element();
        SurfacePlacement {
            pose: Rigid {
                translation: (-0.5 * zoom * size).extend(0.0),
                ..Rigid::IDENTITY
            },
            zoom,
        }
    }

    /// The canvas with a cell a pixel, about the middle of the desk.
    #[must_use]
    pub fn hundred(&self, canvas: &Surface, pixels_per_point: f32) -> SurfacePlacement {
        let pixel_m = 1.0 / (self.scale * f64::from(pixels_per_point));
        let lie = SurfacePlacement::from(canvas);
        lie.zoomed(DVec3::ZERO, pixel_m / canvas.cell_m / lie.zoom)
    }

    /// A vector of the window as one along the desk, so high over it, m.
    #[must_use]
    pub fn along(&self, way: Vec2, height_m: f64) -> DVec3 {
        DVec3::new(self.seen_x(way.x.into()), -f64::from(way.y), 0.0) / self.scale_at(height_m)
    }

    /// The point of the plane z = 0 under a point of the window, m.
    #[must_use]
    pub fn on_desk(&self, at: Pos2) -> DVec3 {
        self.middle.extend(0.0) + self.along(at - self.area.center(), 0.0)
    }

    /// Pixels of the view, as the window rounds them.
    #[must_use]
    pub fn pixels(&self, pixels_per_point: f32) -> [u32; 2] {
        let round = |at: f32| (at * pixels_per_point).round();
        let (from, to) = (self.area.min, self.area.max);
        [(from.x, to.x), (from.y, to.y)].map(|(from, to)| (round(to) - round(from)).max(0.0) as u32)
    }

    /// Height of the eye over the desk, m.
    fn eye_m(&self) -> f64 {
        EYE * f64::from(self.area.size().max_elem()) / self.scale
    }

    /// Window point of a desk point.
    #[must_use]
    pub fn to_window(&self, desk: DVec3) -> Pos2 {
        let off = (desk.truncate() - self.middle) * self.scale_at(desk.z);
        self.area.center() + vec2(self.seen_x(off.x) as f32, -off.y as f32)
    }

    /// Points a metre so high over the desk.
    #[must_use]
    pub fn scale_at(&self, height_m: f64) -> f64 {
        self.scale / Quad::depth(height_m, self.eye_m())
    }

    /// A surface as the eye sees it, points from the view's upper left.
    #[must_use]
    pub(crate) fn quad(&self, surface: &Surface) -> Quad {
        let half = 0.5 * self.area.size();
        let [corner, right, up, _] = corners(surface).map(|desk| {
            let depth = 1.0 - desk.z / self.eye_m();
            let off = (desk.truncate() - self.middle) * self.scale;
            let x = f64::from(half.x) * depth + self.seen_x(off.x);
            DVec3::new(x, f64::from(half.y) * depth - off.y, depth)
        });
        Quad {
            corner,
            right: right - corner,
            up: up - corner,
        }
    }

    /// The point of a surface's plane under a point of the window, m along its sides; `None` if the eye sees the plane
    /// from its edge there.
    #[must_use]
    pub(crate) fn on_plane(&self, at: Pos2, surface: &Surface) -> Option<DVec3> {
        let to_surface = Rigid::from(&surface.pose).inverse();
        let eye = to_surface.point(self.middle.extend(self.eye_m()));
        let below = to_surface.point(self.on_desk(at));
        let way = below - eye;
        let ahead = -eye.z / way.z;
        (way.z.abs() > 1e-3 * way.length() && ahead > 0.0).then(|| eye + way * ahead)
    }

    /// The point of a surface's plane under a point of the window, m on the desk, and true if inside its edges.
    fn hit(&self, at: Pos2, surface: &Surface) -> Option<(DVec3, bool)> {
        let local = self.on_plane(at, surface)?;
        let own = local.truncate() / surface.zoom;
        let inside = is_on(size_m(surface), corner_radii(surface), own);
        Some((Rigid::from(&surface.pose).point(local), inside))
    }

    /// The part of the window that holds a surface, points.
    #[must_use]
    pub fn covered(&self, surface: &Surface) -> Rect {
        let corners = corners(surface).map(|corner| self.to_window(corner));
        Rect::from_points(&corners)
    }

    /// True if a surface is under a point of the window.
    #[must_use]
    pub fn is_over(&self, at: Pos2, surface: &Surface) -> bool {
        self.hit(at, surface).is_some_and(|(_, inside)| inside)
    }

    /// The desk point under a point of the window, m: on the surface there, the palette before the canvas, otherwise on
    /// the extended plane of the canvas.
    #[must_use]
    pub fn to_desk(&self, at: Pos2, surfaces: &[Surface]) -> DVec3 {
        let mut uppermost: Vec<&Surface> = surfaces.iter().collect();
        uppermost.sort_by_key(|surface| std::cmp::Reverse(surface.id));
        let hits: Vec<(DVec3, bool)> = uppermost
            .iter()
            .filter_map(|surface| self.hit(at, surface))
            .collect();
        let on = hits.iter().find(|(_, inside)| *inside);
        on.or(hits.last())
            .map_or_else(|| self.on_desk(at), |(point, _)| *point)
    }
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
    use maulstick_brush::palette_place::beside;
    use maulstick_brush::placement::placed;
    use maulstick_num::geometry::rotation;
    use maulstick_painting::PaintingSetup;
    use maulstick_types::Pose;

    fn surfaces() -> Vec<Surface> {
        PaintingSetup::default().scene().surfaces
    }

    fn area() -> Rect {
        Rect::from_min_size(pos2(10.0, 20.0), vec2(1280.0, 720.0))
    }

    fn view(surfaces: &[Surface]) -> View {
        View::of(area(), &surfaces[0], surfaces.get(1), Side::Left, 72.0).expect("surfaces")
    }

    fn bounds(view: &View, surface: &Surface) -> Rect {
        Rect::from_points(&corners(surface).map(|corner| view.to_window(corner)))
    }

    #[test]
    fn the_canvas_fills_the_view_and_the_palette_looks_in() {
        let surfaces = surfaces();
        let (canvas, palette) = (&surfaces[0], &surfaces[1]);
        let own = view(&surfaces);
        let shown = bounds(&own, canvas);
        let free = shown.height() - own.area.height() + MARGIN + BELOW;
        assert!(free.abs() < 1e-2, "{shown:?}");
        assert!(
            (own.area.bottom() - shown.bottom() - BELOW).abs() < 1e-2,
            "{shown:?}"
        );
        assert!(shown.right() < own.area.right() - 72.0, "beside the rack");
        let board = bounds(&own, palette);
        assert!(board.right() < shown.left() && board.left() > own.area.left());
        // In a narrow window the wells are still visible.
        let narrow = Rect::from_min_size(pos2(0.0, 0.0), vec2(600.0, 900.0));
        let tight = View::of(narrow, canvas, Some(palette), Side::Left, 72.0).expect("a view");
        let board = bounds(&tight, palette);
        let seen = f64::from(board.right() - narrow.left()) / tight.scale;
        let is_cut = board.left() < narrow.left();
        assert!((0.052..0.07).contains(&seen) && is_cut, "{seen}");
        assert!(bounds(&tight, canvas).right() < 600.0 - 72.0);
    }

    /// Windows with and without panels: the least of the canvas's width, points, and of the palette's that shows, mm.
    #[test]
    fn paint_can_be_mixed_beside_the_canvas_unless_the_window_is_small() {
        let surfaces = surfaces();
        let panels = 72.0 + 362.0;
        for (size, aside, canvas, palette) in [
            ([1280.0, 800.0], 72.0, 700.0, 112.0),
            ([1280.0, 800.0], panels, 540.0, 112.0),
            ([1600.0, 1000.0], panels, 740.0, 112.0),
            ([800.0, 600.0], 72.0, 450.0, 112.0),
            ([800.0, 600.0], 362.0, 340.0, 52.0),
            ([800.0, 600.0], panels, 280.0, 52.0),
        ] {
            let area = Rect::from_min_size(pos2(0.0, 0.0), size.into());
            let view = View::of(area, &surfaces[0], Some(&surfaces[1]), Side::Left, aside);
            let view = view.expect("a view");
            let [own, board] = [0, 1].map(|i| bounds(&view, &surfaces[i]));
            let seen_mm = 1e3 * f64::from(board.right()) / view.scale;
            assert!(
                own.width() >= canvas && seen_mm >= palette,
                "{size:?} beside {aside}: canvas {} points, palette {seen_mm} mm",
                own.width()
            );
        }
    }

    #[test]
    fn for_the_left_hand_it_is_the_other_way_round() {
        let mut surfaces = surfaces();
        let shown = |surfaces: &[Surface], side| {
            let view = View::of(area(), &surfaces[0], Some(&surfaces[1]), side, 72.0);
            let view = view.expect("a view");
            [bounds(&view, &surfaces[0]), bounds(&view, &surfaces[1])]
        };
        let right = shown(&surfaces, Side::Left);
        surfaces[1].pose = beside(&surfaces[0], &surfaces[1], Side::Right);
        let left = shown(&surfaces, Side::Right);
        let middle = area().center().x;
        for (a, b) in right.iter().zip(&left) {
            let off = a.left() - middle + b.right() - middle;
            assert!(off.abs() < 1e-2, "{a:?} {b:?}");
        }
    }

    #[test]
    fn in_a_mirror_right_is_left_and_all_else_is_as_it_was() {
        let surfaces = surfaces();
        let right = View::of(area(), &surfaces[0], Some(&surfaces[1]), Side::Right, 72.0);
        let seen = right.expect("a view").mirrored();
        let board = bounds(&seen, &surfaces[1]);
        let canvas = bounds(&seen, &surfaces[0]);
        assert!(
            board.left() > canvas.right() && canvas.left() > area().left() + 72.0,
            "the palette is at the right, the rack free at the left: {board:?} {canvas:?}"
        );
        let plain = view(&surfaces);
        for at in [DVec3::new(0.03, -0.05, 0.0), DVec3::new(-0.2, 0.1, 0.0)] {
            let off = |view: &View| view.to_window(at) - area().center();
            assert!((off(&plain).x + off(&seen).x).abs() < 1e-3);
            assert!((off(&plain).y - off(&seen).y).abs() < 1e-3);
            assert!((seen.on_desk(seen.to_window(at)) - at).length() < 1e-6);
            assert!(
                (plain.on_desk(seen.to_window(at)) - at).length() > 1e-2,
                "a fault would pass"
            );
        }
    }

    #[test]
    fn fitted_it_fills_its_room_and_at_a_hundred_a_cell_is_a_pixel() {
        let mut surfaces = surfaces();
        surfaces[0].cells = [400, 200];
        let view = view(&surfaces);
        let fitted = placed(&surfaces[0], &view.fitted(&surfaces[0]));
        let shown = bounds(&view, &fitted);
        let room = view.room * view.scale;
        assert!(
            (f64::from(shown.width()) - room.x).abs() < 1e-2,
            "{shown:?} {room}"
        );
        assert!(shown.right() < view.area.right() - 72.0 && shown.left() > view.area.left());
        let hundred = placed(&surfaces[0], &view.hundred(&fitted, 2.0));
        let shown = bounds(&view, &hundred);
        assert!(
            (shown.width() - 200.0).abs() < 1e-2,
            "400 cells at two pixels a point"
        );
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
    }

    #[test]
    fn a_tilted_canvas_is_wider_where_it_is_nearer_and_each_share_of_it_is_where_it_is_drawn() {
        let mut surfaces = surfaces();
        let flat = view(&surfaces).quad(&surfaces[0]);
        assert!((flat.right.z, flat.up.z) == (0.0, 0.0));
        let tilt = rotation(DVec3::X, 0.6);
        surfaces[0].pose.orientation = tilt.to_array();
        for mirrored in [false, true] {
            let view = View {
                mirrored,
                ..view(&surfaces)
            };
            let quad = view.quad(&surfaces[0]);
            let at = |share: [f64; 2]| quad.at(share).expect("before the eye");
            let width = |up: f64| at([0.0, up]).distance(at([1.0, up]));
            assert!(width(1.0) > 1.05 * width(0.0), "its upper edge is raised");
            let size = size_m(&surfaces[0]) * surfaces[0].zoom;
            let pose = Rigid::from(&surfaces[0].pose);
            for share in [[0.0, 0.0], [0.3, 0.8], [1.0, 1.0]] {
                let own = DVec2::from_array(share) * size;
                let seen = view.to_window(pose.point(own.extend(0.0)));
                let drawn = view.area.min + vec2(at(share).x as f32, at(share).y as f32);
                assert!(seen.distance(drawn) < 1e-2, "{share:?}: {seen:?} {drawn:?}");
                let back = view.on_plane(seen, &surfaces[0]).expect("a point");
                assert!((back - own.extend(0.0)).length() < 1e-6, "{share:?}");
            }
        }
    }

    #[test]
    fn a_small_picture_takes_a_coarser_level() {
        assert_eq!(level(1024, 1024.0), 0);
        assert_eq!(level(1024, 500.0), 1);
        assert_eq!(level(1024, 1000.0), 0);
        assert_eq!(level(4096, 500.0), 3);
    }
}
