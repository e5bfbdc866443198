//! The pressure curve of a pen, drawn by hand: points between which pressure goes in straight lines, and the pressure now.

use eframe::egui::{
    Color32, CornerRadius, Id, Key, Modifiers, Pos2, Rect, Response, Role, Sense, Stroke,
    StrokeKind, Ui, WidgetInfo, pos2, vec2,
};
use maulstick_device::pressure_curve::given;
use maulstick_ui_kit::arrow_keys::arrow_steps;
use maulstick_ui_kit::language::translated;

/// Height of the field, points.
const HEIGHT: f32 = 120.0;
/// Radius of a point, and of where it is caught, points.
const POINT: f32 = 4.0;
const CATCH_RADIUS: f32 = 10.0;
/// Least way between two points along what is sensed.
const MIN_GAP: f64 = 0.02;
/// Points are on a grid of this width, and an arrow key moves one so far.
const GRID: f64 = 0.01;
/// Most points of a curve.
const MAX_POINTS: usize = 32;
/// Time for which a drawn curve is shown before the pen has taken it, s.
const ANSWER_S: f64 = 6.0;

/// Curves that are often wanted, by name.
const PRESETS: [(&str, &[[f64; 2]]); 3] = [
    (
        tr_noop!("Soft"),
        &[[0.0, 0.0], [0.3, 0.5], [0.6, 0.8], [1.0, 1.0]],
    ),
    (tr_noop!("Straight"), &[[0.0, 0.0], [1.0, 1.0]]),
    (
        tr_noop!("Firm"),
        &[[0.0, 0.0], [0.4, 0.2], [0.75, 0.55], [1.0, 1.0]],
    ),
];

/// A curve that is being drawn.
#[derive(Debug, Default)]
pub(super) struct CurveEditor {
    /// The pen, its curve as it is drawn, and the time until which it is shown, s.
    drawn: Option<(String, Vec<[f64; 2]>, f64)>,
}

impl CurveEditor {
    /// Shows the curve of a pen that senses this pressure now; a new one once it is drawn.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        pen: &str,
        actual: &[[f64; 2]],
        sensed: Option<f64>,
    ) -> Option<Vec<[f64; 2]>> {
        let now_s = ui.input(|input| input.time);
        self.drawn
            .take_if(|(own, curve, until_s)| own == pen && (*curve == actual || now_s > *until_s));
        let drawn = self.drawn.as_ref().filter(|(own, ..)| own == pen);
        let mut curve = drawn.map_or_else(|| actual.to_vec(), |(_, curve, _)| curve.clone());
        let before = curve.clone();
        let mut done = field(ui, &mut curve, sensed);
        ui.horizontal(|ui| {
            for (name, points) in PRESETS {
                let is_it = curve == points;
                if ui.selectable_label(is_it, translated(name)).clicked() {
                    curve = points.to_vec();
                    done = true;
                }
            }
        });
        if curve != before || done {
            self.drawn = Some((pen.to_owned(), curve.clone(), now_s + ANSWER_S));
        }
        (done && curve != actual).then_some(curve)
    }
}

/// The field with its points; true once a change is complete.
fn field(ui: &mut Ui, curve: &mut Vec<[f64; 2]>, sensed_now: Option<f64>) -> bool {
    let size = vec2(ui.available_width(), HEIGHT);
    let (area, back) = ui.allocate_exact_size(size, Sense::click());
    back.widget_info(|| WidgetInfo::labeled(Role::Image, true, tr!("Pressure curve")));
    let inner = area.shrink(POINT + 1.0);
    let mut done = false;
    let back = back.on_hover_text(tr!(
        "Across: what the pen senses. Up: what the brush gets. Click adds a point, a double click takes it out."
    ));
    if back.clicked() {
        let at = back.interact_pointer_pos();
        done |= insert(
            curve,
            at.map_or_else(|| widest(curve), |at| from_screen(inner, at)),
        );
    }
    let id = back.id;
    let mut gone = None;
    for place in 1..curve.len().saturating_sub(1) {
        let (response, to) = point(ui, id.with(place), inner, curve[place]);
        let number = place;
        let words = tr!(
            "Point {number}: {sensed} gives {given}",
            number,
            sensed = format_args!("{:.2}", curve[place][0]),
            given = format_args!("{:.2}", curve[place][1])
        );
        response.widget_info(|| WidgetInfo::labeled(Role::Slider, true, &words));
        if let Some(to) = to {
            move_to(curve, place, to);
            done |= !response.dragged();
        }
        done |= response.drag_stopped();
        let delete = |key| ui.input_mut(|input| input.consume_key(Modifiers::NONE, key));
        let deleted = response.has_focus() && (delete(Key::Delete) || delete(Key::Backspace));
        if response.double_clicked() || deleted {
            gone = Some(place);
        }
    }
    if let Some(place) = gone {
        curve.remove(place);
        done = true;
    }
    paint(ui, area, inner, curve, sensed_now);
    done
}

/// A point that can be dragged and led by the arrow keys: its response, and where it is to be.
fn point(ui: &Ui, id: Id, inner: Rect, at: [f64; 2]) -> (Response, Option<[f64; 2]>) {
    let place = to_screen(inner, at);
    let catch = Rect::from_center_size(place, vec2(2.0 * CATCH_RADIUS, 2.0 * CATCH_RADIUS));
    let response = ui.interact(catch, id, Sense::click_and_drag());
    let steps = arrow_steps(ui, &response);
    let to = if response.dragged() {
        response
            .interact_pointer_pos()
            .map(|at| from_screen(inner, at))
    } else {
        (steps != eframe::egui::Vec2::ZERO).then(|| {
            [
                at[0] + GRID * f64::from(steps.x),
                at[1] - GRID * f64::from(steps.y),
            ]
        })
    };
    (response, to)
}

fn to_screen(inner: Rect, [sensed, given]: [f64; 2]) -> Pos2 {
    let across = inner.width() * sensed as f32;
    pos2(
        inner.left() + across,
        inner.bottom() - inner.height() * given as f32,
    )
}

fn from_screen(inner: Rect, at: Pos2) -> [f64; 2] {
    let sensed = (at.x - inner.left()) / inner.width().max(1.0);
    let given = (inner.bottom() - at.y) / inner.height().max(1.0);
    [sensed, given].map(f64::from)
}

/// On the grid, as it is written.
fn on_grid(share: f64) -> f64 {
    (share.clamp(0.0, 1.0) / GRID).round() / GRID.recip()
}

/// Moves a point as far as its neighbours let it: what is given never falls as more is sensed.
fn move_to(curve: &mut [[f64; 2]], place: usize, [sensed, given]: [f64; 2]) {
    let (before, after) = (curve[place - 1], curve[place + 1]);
    let room = [before[0] + MIN_GAP, after[0] - MIN_GAP];
    if room[0] <= room[1] {
        curve[place][0] = on_grid(sensed.clamp(room[0], room[1]));
    }
    curve[place][1] = on_grid(given).clamp(before[1], after[1].max(before[1]));
}

/// The middle of the widest gap, where a click by the keyboard adds a point.
fn widest(curve: &[[f64; 2]]) -> [f64; 2] {
    let gaps = curve.windows(2).map(|pair| (pair[0], pair[1]));
    let gap = gaps.max_by(|(a, b), (c, d)| (b[0] - a[0]).total_cmp(&(d[0] - c[0])));
    let (a, b) = gap.unwrap_or(([0.0; 2], [1.0; 2]));
    [0, 1].map(|i| 0.5 * (a[i] + b[i]))
}

/// Adds a point where there is room for it; true if so.
fn insert(curve: &mut Vec<[f64; 2]>, [sensed, at]: [f64; 2]) -> bool {
    let sensed = on_grid(sensed);
    let place = curve.iter().position(|point| point[0] > sensed);
    let Some(place) = place.filter(|place| *place > 0 && curve.len() < MAX_POINTS) else {
        return false;
    };
    let has_room = sensed - curve[place - 1][0] >= MIN_GAP && curve[place][0] - sensed >= MIN_GAP;
    if has_room {
        curve.insert(place, [sensed, given(curve, sensed)]);
        move_to(curve, place, [sensed, at]);
    }
    has_room
}

fn paint(ui: &Ui, area: Rect, inner: Rect, curve: &[[f64; 2]], sensed_now: Option<f64>) {
    let (painter, visuals) = (ui.painter(), ui.visuals());
    let rounding = CornerRadius::same(3);
    painter.rect(
        area,
        rounding,
        visuals.extreme_bg_color,
        visuals.widgets.noninteractive.bg_stroke,
        StrokeKind::Inside,
    );
    let faint = Stroke::new(1.0, visuals.widgets.noninteractive.bg_stroke.color);
    let corner = |at| to_screen(inner, at);
    painter.line_segment([corner([0.0, 0.0]), corner([1.0, 1.0])], faint);
    let strong = visuals.hyperlink_color;
    let points: Vec<Pos2> = curve.iter().map(|at| to_screen(inner, *at)).collect();
    painter.line(points.clone(), Stroke::new(2.0, strong));
    for (place, at) in points.iter().enumerate() {
        let is_end = place == 0 || place + 1 == points.len();
        let fill = if is_end { faint.color } else { strong };
        painter.circle(*at, POINT, fill, Stroke::new(1.0, visuals.extreme_bg_color));
    }
    if let Some(sensed) = sensed_now {
        let at = to_screen(inner, [sensed, given(curve, sensed)]);
        let now = Stroke::new(1.0, Color32::from_rgb(196, 90, 40));
        painter.line_segment([pos2(at.x, inner.bottom()), at], now);
        painter.line_segment([pos2(inner.left(), at.y), at], now);
        painter.circle_filled(at, POINT, now.color);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_stay_between_their_neighbours() {
        let mut curve = vec![[0.0, 0.0], [1.0, 1.0]];
        assert!(insert(&mut curve, [0.5, 0.204]));
        assert_eq!(curve[1], [0.5, 0.2]);
        assert!(insert(&mut curve, [0.7, 0.1]), "it may not fall");
        assert_eq!(curve[2], [0.7, 0.2]);
        assert!(!insert(&mut curve, [0.505, 0.5]), "there is no room");
        assert!(!insert(&mut curve, [0.0, 0.5]) && !insert(&mut curve, [1.0, 0.5]));
        move_to(&mut curve, 1, [0.9, 0.9]);
        assert_eq!(curve[1], [0.68, 0.2]);
        move_to(&mut curve, 1, [-3.0, -3.0]);
        assert_eq!(curve[1], [0.02, 0.0]);
        // Beside one that is not on the grid it does not fall either.
        let mut curve = vec![[0.0, 0.0], [0.3, 0.333], [0.5, 0.5], [1.0, 1.0]];
        move_to(&mut curve, 2, [0.5, 0.1]);
        assert_eq!(curve[2], [0.5, 0.333]);
        assert_eq!(widest(&curve), [0.75, 0.6665]);
    }
}
