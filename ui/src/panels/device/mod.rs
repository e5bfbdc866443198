//! Device panel: styluses, their settings and their force; what else is attached.
//!
//! | module | holds |
//! | --- | --- |
//! | `attached` | what is attached and not in the rig |
//! | `settings` | name, brush, force, switches and pressure of a device; its fit to the canvas |
//! | `pressure_curve` | a curve drawn by hand |
//! | `test_page` | what a device senses, and how evenly |
//! | `health` | timing of the force loop |

mod attached;
mod health;
mod pressure_curve;
mod settings;
mod test_page;

#[cfg(test)]
pub(crate) mod tests;

use eframe::egui::{
    Align2, Button, Color32, FontId, Frame, Grid, Response, RichText, Role, Sense, Stroke, Ui,
    WidgetInfo, pos2, vec2,
};
use egui_plot::{HLine, Line, LineStyle, Plot, PlotPoints};
use maulstick_types::haptics::ForceOrder;
use maulstick_types::stylus::{StylusInfo, StylusStatus, Trouble, axes};
use maulstick_types::values::{ForceShare, GuidanceShare};

use maulstick_client::force_history::{KEPT_S, size};
use maulstick_client::state::Device;
use maulstick_ui_kit::language::capitalized;
use maulstick_ui_kit::rows::{Number, Sliders};
use settings::Edits;

use crate::input::keys::Action;
use crate::panels::Panel;
use crate::rig::state::RigState;
use crate::widgets::context::PanelContext;

/// Of the button that switches force off, and of a trouble.
const RED: Color32 = Color32::from_rgb(178, 34, 34);
/// Height of the graph of the force, points.
const GRAPH: f32 = 84.0;
/// Side of the dial, points.
const DIAL: f32 = 64.0;
/// Drivers of the window's own mouse and pens.
const OF_THE_WINDOW: [&str; 2] = ["pointer", "window"];
/// A device that has sent nothing for this time counts as unplugged, ns.
const PRESENT_NS: u64 = 3_000_000_000;

#[derive(Debug, Default)]
pub(crate) struct DevicePanel {
    sliders: Sliders,
    edits: Edits,
    /// The device whose test page is open.
    tested: Option<String>,
}

/// A share of a device's force.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Share {
    /// Of all.
    Strength,
    /// Of guides.
    Guidance,
}

impl Share {
    fn of(self, status: &StylusStatus) -> f64 {
        match self {
            Self::Strength => status.strength,
            Self::Guidance => status.guidance,
        }
    }

    fn order(self, share: f64) -> ForceOrder {
        match self {
            Self::Strength => ForceOrder::Strength { share },
            Self::Guidance => ForceOrder::Guidance { share },
        }
    }

    fn word(self) -> &'static str {
        match self {
            Self::Strength => tr_noop!("Strength"),
            Self::Guidance => tr_noop!("Guidance"),
        }
    }

    fn number(self) -> Number<'static> {
        match self {
            Self::Strength => Number::percent::<ForceShare>(self.word()),
            Self::Guidance => Number::percent::<GuidanceShare>(self.word()),
        }
    }
}

impl Panel for DevicePanel {
    fn title(&self) -> &'static str {
        tr_noop!("Device")
    }

    fn show(&mut self, ui: &mut Ui, work: &mut PanelContext<'_>) {
        let painting = work.rig.live.active_device(work.rig.brush_name());
        let painting = painting.map(|(name, _)| name.to_owned());
        match &painting {
            Some(name) => {
                ui.label(RichText::new(tr!("{device} paints", device = worded(name))).strong())
            }
            None => ui.label(tr!("No pen in range. You are painting with the mouse.")),
        };
        settings::fit(ui, work);
        let is_there = |(name, device): &(&String, &Device)| is_there(work.rig, name, device);
        let mut devices: Vec<(&String, &Device)> =
            work.rig.live.devices.iter().filter(is_there).collect();
        let priority = |device: &Device| device.info.as_ref().map_or(i32::MIN, |it| it.priority);
        devices.sort_by_key(|(name, device)| (-i64::from(priority(device)), (*name).clone()));
        let names: Vec<String> = devices.into_iter().map(|(name, _)| name.clone()).collect();
        for name in names {
            // The description of its axes is long.
            let Some(device) = work.rig.live.devices.remove(&name) else {
                continue;
            };
            Frame::group(ui.style()).show(ui, |ui| {
                ui.set_width(ui.available_width());
                ui.push_id(&name, |ui| self.device(ui, &name, &device, work));
            });
            work.rig.live.devices.insert(name, device);
        }
        attached::show(ui, work);
        let tested = self.tested.take();
        let tested = tested.map(|name| self.renamed(name, work.rig));
        self.tested = tested.filter(|name| test_page::show(ui.ctx(), name, work.rig));
    }
}

impl DevicePanel {
    fn device(&mut self, ui: &mut Ui, name: &str, device: &Device, work: &mut PanelContext<'_>) {
        ui.label(RichText::new(worded(name)).strong());
        if let Some(info) = &device.info {
            ui.label(moves(info, work.rig.brushes.len()))
                .on_hover_text(driven(info));
            if info.senses != 0 {
                ui.small(tr!("Senses {list}", list = senses(info.senses)));
            }
        }
        self.own_settings(ui, name, device, work);
        let Some(status) = &device.status else {
            return;
        };
        if let Some(Trouble { what, help }) = status.trouble() {
            ui.colored_label(ui.visuals().warn_fg_color, what);
            if !help.is_empty() {
                ui.label(capitalized(help));
            }
        }
        if let Some(info) = &device.info
            && info.drives & axes::FORCE != 0
        {
            self.force(ui, name, (device, info, status), work);
        }
    }

    /// The name that a device goes by once the rig has it under another one.
    fn renamed(&self, name: String, rig: &RigState) -> String {
        match &self.edits.renamed {
            Some((from, to)) if *from == name && rig.live.nodes.contains(to) => to.clone(),
            _ => name,
        }
    }

    /// The settings of a device that the painter may change, and its test page.
    fn own_settings(
        &mut self,
        ui: &mut Ui,
        name: &str,
        device: &Device,
        work: &mut PanelContext<'_>,
    ) {
        let listing = work.rig.setup.listing.as_ref();
        let known = listing.and_then(|listing| listing.device(name)).cloned();
        let driver = device.info.as_ref().map(|info| info.driver.as_str());
        match known.filter(|known| known.is_in_rig) {
            Some(known) => {
                // A change begins with the settings as they were listed.
                ui.add_enabled_ui(!work.rig.setup.is_changing, |ui| {
                    settings::buttons(ui, &known, work);
                    settings::show(ui, &known, device, &mut self.edits, work);
                });
            }
            None if driver == Some("window") => {
                settings::window_pen(ui, &mut self.edits.curve, work);
            }
            None => {}
        }
        let hint = tr!("Place, pressure and tilt as they are sensed, and how evenly they come");
        if driver != Some("pointer") && ui.button(tr!("Test…")).on_hover_text(hint).clicked() {
            self.tested = Some(name.to_owned());
        }
    }

    fn force(
        &mut self,
        ui: &mut Ui,
        name: &str,
        (device, info, status): (&Device, &StylusInfo, &StylusStatus),
        work: &mut PanelContext<'_>,
    ) {
        if status.is_on {
            let words = RichText::new(tr!("Force off"))
                .strong()
                .color(Color32::WHITE);
            let button = Button::new(words).fill(RED).min_size(vec2(0.0, 32.0));
            let key = work.preferences.keys.written(ui.ctx(), Action::ForceOff);
            let hint = if key.is_empty() {
                tr!("The device gives no force any more, at once").to_owned()
            } else {
                tr!(
                    "The device gives no force any more, at once ({key}, for all devices)",
                    key
                )
            };
            if wide(ui, button).on_hover_text(hint).clicked() {
                work.requests.force(name, ForceOrder::Off);
            }
        } else {
            let button = Button::new(tr!("Force on")).min_size(vec2(0.0, 32.0));
            let hint = tr!("The device gives force again, from nothing on");
            if wide(ui, button).on_hover_text(hint).clicked() {
                work.requests.force(name, ForceOrder::On);
            }
        }
        self.share(ui, name, (Share::Strength, status), work);
        if status.is_guided {
            self.share(ui, name, (Share::Guidance, status), work);
        }
        if !status.faults.is_empty() {
            ui.colored_label(ui.visuals().error_fg_color, status.faults.join("; "));
            let hint = tr!("Lift the brush first: force comes back from nothing on");
            if ui.button(tr!("Re-arm")).on_hover_text(hint).clicked() {
                work.requests.force(name, ForceOrder::Rearm);
            }
        }
        let now_ns = work.rig.live.now_ns;
        let most_n = if status.cap_n > 0.0 {
            status.cap_n
        } else {
            info.max_force_n
        };
        let force_n = device.forces.force_n(now_ns);
        ui.horizontal(|ui| {
            dial(ui, force_n.unwrap_or_default(), most_n);
            ui.vertical(|ui| numbers(ui, force_n, most_n, status));
        });
        ui.small(tr!("Force over the last 5 s, N"));
        graph(ui, name, device.forces.line(now_ns), most_n);
        health::show(ui, status);
    }

    fn share(
        &mut self,
        ui: &mut Ui,
        name: &str,
        (share, status): (Share, &StylusStatus),
        work: &mut PanelContext<'_>,
    ) {
        let key = format!("{} of {name}", share.word());
        let change = self
            .sliders
            .keyed(ui, &share.number(), &key, share.of(status));
        if let Some(moved) = change.moved {
            work.requests
                .force(name, share.order(moved.clamp(0.0, 1.0)));
        }
    }
}

/// Switches off the force of every device that gives one.
pub(crate) fn force_off(work: &mut PanelContext<'_>) {
    for (name, device) in &work.rig.live.devices {
        let info = device.info.as_ref();
        if info.is_some_and(|info| info.drives & axes::FORCE != 0) {
            work.requests.force(name, ForceOrder::Off);
        }
    }
}

/// False for a device that was there and has left: a driver is known by its process, another program by its messages.
fn is_there(rig: &RigState, name: &str, device: &Device) -> bool {
    let driver = device.info.as_ref().map(|info| info.driver.as_str());
    let is_own = driver.is_some_and(|driver| OF_THE_WINDOW.contains(&driver));
    let is_fitted = rig.setup.fit.as_ref().is_some_and(|fit| fit.device == name);
    let heard = rig.live.now_ns < device.heard_ns.saturating_add(PRESENT_NS);
    !is_fitted && (is_own || heard || rig.live.nodes.iter().any(|node| node == name))
}

/// A button as wide as the panel.
fn wide(ui: &mut Ui, button: Button<'_>) -> Response {
    ui.vertical_centered_justified(|ui| ui.add(button)).inner
}

/// A device as a painter calls it.
fn worded(name: &str) -> String {
    match name {
        "mouse" => tr!("The mouse").to_owned(),
        "pen" => tr!("The pen").to_owned(),
        "player" => tr!("A take").to_owned(),
        _ => name.to_owned(),
    }
}

/// The brush that a device moves, by its name where the rig has several.
fn moves(info: &StylusInfo, brushes: usize) -> String {
    match brushes {
        0 | 1 => tr!("Moves the brush").to_owned(),
        _ => tr!("Moves the brush “{brush}”", brush = info.brush),
    }
}

fn driven(info: &StylusInfo) -> String {
    let driver = &info.driver;
    if info.rate_hz >= 1.0 {
        tr!(
            "Driver “{driver}”, {rate} times a second",
            driver,
            rate = format_args!("{:.0}", info.rate_hz)
        )
    } else {
        tr!("Driver “{driver}”", driver)
    }
}

/// Sensors of a device, in words.
#[must_use]
pub(crate) fn senses(bits: u32) -> String {
    let all = [
        (axes::POSITION, tr!("position")),
        (axes::ORIENTATION, tr!("orientation")),
        (axes::PRESSURE, tr!("pressure")),
        (axes::TILT, tr!("tilt")),
        (axes::TWIST, tr!("twist")),
        (axes::SWITCHES, tr!("switches")),
        (axes::PROXIMITY, tr!("nearness")),
        (axes::FORCE, tr!("force")),
        (axes::VELOCITY, tr!("velocity")),
        (axes::TORQUE, tr!("torque")),
    ];
    let sensed = all.iter().filter(|(bit, _)| bits & bit != 0);
    let words: Vec<&str> = sensed.map(|(_, word)| *word).collect();
    words.join(", ")
}

fn numbers(ui: &mut Ui, force_n: Option<[f64; 3]>, most_n: f64, status: &StylusStatus) {
    let now = match force_n {
        Some(force_n) => format!("{:.2} N", size(force_n)),
        None => tr!("silent").to_owned(),
    };
    let stiffness = tr!(
        "{given} of {asked} N/m",
        given = format_args!("{:.0}", status.stiffness_n_m),
        asked = format_args!("{:.0}", status.asked_n_m)
    );
    let motors = if status.resting {
        tr!(
            "{percent} % hot, resting",
            percent = format_args!("{:.0}", 100.0 * status.motor_temperature)
        )
    } else {
        tr!(
            "{percent} % hot",
            percent = format_args!("{:.0}", 100.0 * status.motor_temperature)
        )
    };
    Grid::new("numbers")
        .num_columns(2)
        .spacing([8.0, 2.0])
        .show(ui, |ui| {
            let rows = [
                (tr!("Force"), now, tr!("On the hand now")),
                (
                    tr!("At most"),
                    format!("{most_n:.1} N"),
                    tr!("As warm as the motors are"),
                ),
                (
                    tr!("Stiffness"),
                    stiffness,
                    tr!("Given, of what the brush asks for"),
                ),
                (
                    tr!("Motor heat"),
                    motors,
                    tr!("The hottest motor; amplifiers rest for want of contact"),
                ),
            ];
            for (name, value, hint) in rows {
                ui.label(name);
                ui.label(value).on_hover_text(hint);
                ui.end_row();
            }
        });
}

/// The force as an arrow along the desk, and as a bar out of it.
fn dial(ui: &mut Ui, force_n: [f64; 3], most_n: f64) {
    let (area, response) = ui.allocate_exact_size(vec2(DIAL + 12.0, DIAL), Sense::hover());
    let words = tr!(
        "Force on the hand: {right} N right, {up} N up, {toward} N toward you",
        right = format_args!("{:.2}", force_n[0]),
        up = format_args!("{:.2}", force_n[1]),
        toward = format_args!("{:.2}", force_n[2])
    );
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, &words));
    response.on_hover_text(&words);
    let (painter, visuals) = (ui.painter(), ui.visuals());
    let faint = Stroke::new(1.0, visuals.widgets.noninteractive.bg_stroke.color);
    let strong = Stroke::new(2.5, visuals.hyperlink_color);
    let radius = 0.5 * DIAL - 2.0;
    let middle = area.left_center() + vec2(0.5 * DIAL, 0.0);
    painter.circle_stroke(middle, radius, faint);
    for across in [vec2(radius, 0.0), vec2(0.0, radius)] {
        painter.line_segment([middle - across, middle + across], faint);
    }
    let share = |n: f64| (n / most_n.max(1e-3)).clamp(-1.0, 1.0) as f32;
    let along = radius * vec2(share(force_n[0]), -share(force_n[1]));
    if along.length() > 1.0 {
        painter.arrow(middle, along, strong);
    } else {
        painter.circle_filled(middle, 2.0, strong.color);
    }
    let (bar, reach) = (area.right() - 3.0, radius * share(force_n[2]));
    let level = area.center().y;
    painter.line_segment(
        [pos2(bar, level - radius), pos2(bar, level + radius)],
        faint,
    );
    painter.line_segment([pos2(bar - 3.0, level), pos2(bar + 3.0, level)], faint);
    let thick = Stroke::new(5.0, strong.color);
    painter.line_segment([pos2(bar, level), pos2(bar, level - reach)], thick);
    if !force_n.iter().all(|n| n.is_finite()) {
        let font = FontId::proportional(12.0);
        painter.text(middle, Align2::CENTER_CENTER, "?", font, RED);
    }
}

/// A plot as wide as there is room, which no pointer moves.
fn still<'a>(ui: &Ui, plot: Plot<'a>) -> Plot<'a> {
    plot.width(ui.available_width())
        .show_x(false)
        .show_y(false)
        .allow_drag(false)
        .allow_zoom(false)
        .allow_scroll(false)
        .allow_boxed_zoom(false)
        .allow_double_click_reset(false)
}

fn graph(ui: &mut Ui, name: &str, line: Vec<[f64; 2]>, most_n: f64) {
    let (colour, faint) = (
        ui.visuals().hyperlink_color,
        ui.visuals().warn_fg_color.gamma_multiply(0.7),
    );
    still(ui, Plot::new(("force", name)))
        .height(GRAPH)
        .include_x(-KEPT_S)
        .include_x(0.0)
        .include_y(0.0)
        .include_y(1.05 * most_n)
        .set_margin_fraction(vec2(0.0, 0.0))
        .show_axes([false, true])
        .show(ui, |plot| {
            let most = HLine::new("at most", most_n).color(faint);
            plot.hline(most.style(LineStyle::dashed_dense()));
            plot.line(Line::new("force", PlotPoints::from(line)).color(colour));
        });
}
