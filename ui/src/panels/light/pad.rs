//! Pad for the direction of the lamp: the sky over the canvas, seen from above.

use eframe::egui::accesskit::Role;
use eframe::egui::{
    Color32, Pos2, Rect, Sense, Stroke, TextureId, Ui, Vec2, WidgetInfo, pos2, vec2,
};
use maulstick_num::{acos, atan2};
use maulstick_optics::light::LOWEST_LAMP;
use maulstick_ui_kit::arrow_keys::arrow_steps;

/// Side of the pad, points.
const SIDE: f32 = 132.0;
/// Step of the lamp per press of an arrow key, as a share of the pad's radius.
const STEP: f64 = 0.05;

/// Shows the pad with the picture of a ball on it; where the lamp was dragged to.
pub(super) fn show(ui: &mut Ui, ball: TextureId, direction: [f64; 3]) -> Option<[f64; 3]> {
    let (place, response) = ui.allocate_exact_size(vec2(SIDE, SIDE), Sense::click_and_drag());
    response.widget_info(|| WidgetInfo::labeled(Role::Slider, true, tr!("Lamp")));
    let mut moved = None;
    if let Some(at) = response.interact_pointer_pos()
        && (response.dragged() || response.drag_stopped() || response.clicked())
    {
        moved = Some(from_pad(place, at));
    }
    let step = arrow_steps(ui, &response);
    if step != Vec2::ZERO {
        let [x, y] = on_disc(direction);
        let [right, up] = [step.x, -step.y].map(f64::from);
        moved = Some(of_disc([x + STEP * right, y + STEP * up]));
    }
    let painter = ui.painter();
    let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
    painter.image(ball, place.shrink(2.0), whole, Color32::WHITE);
    let rim = if response.has_focus() {
        Stroke::new(2.0, ui.visuals().selection.stroke.color)
    } else {
        ui.visuals().widgets.noninteractive.bg_stroke
    };
    painter.circle_stroke(place.center(), 0.5 * SIDE - 2.0, rim);
    let lamp = to_pad(place, moved.unwrap_or(direction));
    let gold = Color32::from_rgb(255, 214, 110);
    painter.circle(
        lamp,
        6.0,
        gold,
        Stroke::new(1.5, Color32::from_black_alpha(200)),
    );
    if !response.dragged() {
        response.on_hover_text(tr!(
            "Drag the lamp over the canvas, or move it by the arrow keys"
        ));
    }
    moved
}

/// The direction of a place on the disc of radius 1, whose rim is the horizon; no lower than a lamp goes.
fn of_disc([x, y]: [f64; 2]) -> [f64; 3] {
    let across = (x * x + y * y).sqrt();
    let most = (1.0 - LOWEST_LAMP * LOWEST_LAMP).sqrt();
    let shrink = if across > most { most / across } else { 1.0 };
    let tidy = |v: f64| (v * 1e3).round() * 1e-3;
    let [x, y] = [tidy(x * shrink), tidy(y * shrink)];
    let up = (1.0 - x * x - y * y).max(LOWEST_LAMP * LOWEST_LAMP).sqrt();
    [x, y, up]
}

/// The place on the disc of a direction.
fn on_disc([x, y, z]: [f64; 3]) -> [f64; 2] {
    let length = (x * x + y * y + z * z).sqrt();
    if length > 0.0 {
        [x / length, y / length]
    } else {
        [0.0; 2]
    }
}

fn from_pad(place: Rect, at: Pos2) -> [f64; 3] {
    let off = (at - place.center()) / (0.5 * SIDE);
    of_disc([f64::from(off.x), -f64::from(off.y)])
}

fn to_pad(place: Rect, direction: [f64; 3]) -> Pos2 {
    let [x, y] = on_disc(direction);
    place.center() + 0.5 * SIDE * vec2(x as f32, -y as f32)
}

/// Direction of the light, in words.
#[must_use]
pub(super) fn words(direction: [f64; 3]) -> String {
    let [x, y] = on_disc(direction);
    let across = (x * x + y * y).sqrt();
    let height = acos(across.clamp(0.0, 1.0)).to_degrees().round();
    if across < 0.1 {
        return tr!("From straight above").to_owned();
    }
    let eighth = (atan2(y, x) / std::f64::consts::FRAC_PI_4).round();
    match eighth.rem_euclid(8.0) as usize % 8 {
        0 => tr!("From the right, {height}° high", height),
        1 => tr!("From the upper right, {height}° high", height),
        2 => tr!("From above, {height}° high", height),
        3 => tr!("From the upper left, {height}° high", height),
        4 => tr!("From the left, {height}° high", height),
        5 => tr!("From the lower left, {height}° high", height),
        6 => tr!("From below, {height}° high", height),
        _ => tr!("From the lower right, {height}° high", height),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pad_and_direction_are_the_same_place() {
        let place = Rect::from_min_size(pos2(20.0, 30.0), vec2(SIDE, SIDE));
        for at in [pos2(86.0, 96.0), pos2(50.0, 60.0), pos2(120.0, 80.0)] {
            let direction = from_pad(place, at);
            let length: f64 = direction.iter().map(|v| v * v).sum();
            assert!((length - 1.0).abs() < 1e-9);
            assert!((to_pad(place, direction) - at).length() < 0.1, "{at:?}");
        }
        let low = from_pad(place, pos2(500.0, 96.0));
        assert!(low[2] >= LOWEST_LAMP && low[0] > 0.9, "{low:?}");
        assert!(
            to_pad(place, [0.5, 0.5, 0.5]).y < place.center().y,
            "up is up: a fault would pass"
        );
    }

    #[test]
    fn words_say_where_the_light_comes_from() {
        for (direction, text) in [
            ([-0.5, 0.5, 0.7], "From the upper left, 45° high"),
            ([0.01, 0.0, 1.0], "From straight above"),
            ([0.0, -1.0, 0.5], "From below, 27° high"),
            ([-1.0, -0.01, 1.0], "From the left, 45° high"),
            ([1.0, -0.05, 1.0], "From the right, 45° high"),
        ] {
            assert_eq!(words(direction), text);
        }
    }
}
