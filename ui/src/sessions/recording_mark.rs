//! The red dot while a recording is written, with the time since its beginning. A click ends the recording.

use eframe::egui::{Button, Color32, Response, RichText, Role, Ui, WidgetInfo, vec2};

use crate::dialogs::paths;
use crate::sessions::{SessionOrder, clock};
use crate::widgets::context::PanelContext;

/// Colour of the dot, on dark and on light.
const RED: [Color32; 2] = [
    Color32::from_rgb(255, 84, 84),
    Color32::from_rgb(190, 20, 20),
];

/// Radius of the dot, points.
const DOT: f32 = 4.0;

/// Shows it; `None` if nothing is recorded.
pub(crate) fn show(ui: &mut Ui, work: &mut PanelContext<'_>) -> Option<Response> {
    let recording = work.rig.recording.as_ref()?;
    let elapsed_ns = work.rig.live.now_ns.saturating_sub(recording.begun_ns);
    let [dark, light] = RED;
    let red = if ui.visuals().dark_mode { dark } else { light };
    let words = RichText::new(format!("     {}", clock(elapsed_ns as f64 * 1e-9)));
    let button = Button::new(words.small().color(red))
        .frame_when_inactive(false)
        .small();
    let shown = ui.add(button);
    let dot = shown.rect.left_center() + vec2(2.0 * DOT, 0.0);
    ui.painter().circle_filled(dot, DOT, red);
    shown.widget_info(|| WidgetInfo::labeled(Role::Button, true, tr!("Stop recording")));
    let file = paths::shown(&recording.file);
    let shown = shown.on_hover_text(tr!("Recording into {file}. A click ends it.", file));
    if shown.clicked() {
        work.requests.session(SessionOrder::StopRecording);
    }
    Some(shown)
}
