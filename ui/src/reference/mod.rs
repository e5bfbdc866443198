//! A reference picture, pinned beside the canvas: it can be moved, resized and magnified; a click proposes
//! mixtures of its colour there.
//!
//! | module | holds |
//! | --- | --- |
//! | `frame` | where the frame stands, and how large it is |
//! | `picture` | pictures, read and made small |
//! | `settings` | what of it is remembered |

mod frame;
pub(crate) mod picture;
pub(crate) mod settings;

use std::path::Path;

use eframe::egui::{
    self, Color32, Context, CornerRadius, Frame, Id, Key, Modifiers, Pos2, Rect, Response,
    RichText, Role, ScrollArea, Sense, Stroke, StrokeKind, Ui, Vec2, WidgetInfo, Window, pos2,
    vec2,
};
use maulstick_optics::colour::srgb_encode;
use maulstick_ui_kit::arrow_keys::arrow_steps;
use maulstick_ui_kit::rows::{Number, Sliders};

use frame::PictureFrame;
use picture::{Picture, Pinned};
use settings::FrameOpacity;

use crate::dialogs::paths;
use crate::input::keys::Action;
use crate::matching::picker::{Ask, Picker, of_palette};
use crate::matching::proposals::{hex, matches, swatch};
use crate::settings::preferences::Preferences;
use crate::widgets::context::PanelContext;

/// The least size of the frame, points.
const LEAST: [f32; 2] = [220.0, 180.0];
/// Largest magnification of the picture, pixels of the screen for one of the picture.
const CLOSEST: f32 = 16.0;
/// The least height of the picture while mixtures are below it, points.
const LEAST_PICTURE: f32 = 60.0;
/// Step of the cross per press of an arrow key, points.
const STEP: f32 = 8.0;

/// Pan and zoom of the picture in its frame.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Look {
    /// Factor on the size at which all of it is seen.
    zoom: f32,
    /// The point of the picture in the middle of the frame, 0 to 1 each way.
    middle: Pos2,
    /// The point where colours are picked, 0 to 1 each way; `None` before the first pick.
    cross: Option<Pos2>,
}

impl Default for Look {
    fn default() -> Self {
        Self {
            zoom: 1.0,
            middle: pos2(0.5, 0.5),
            cross: None,
        }
    }
}

#[derive(Debug, Default)]
pub(crate) struct Reference {
    sliders: Sliders,
    pinned: Pinned,
    look: Look,
    picker: Picker,
    frame: PictureFrame,
    /// Height of the proposals as they were last drawn, points.
    below: f32,
    /// The colour that was picked, linear sRGB.
    picked: Option<[f64; 3]>,
}

impl Reference {
    /// Pins a picture beside the canvas.
    pub(crate) fn pin(&mut self, context: &Context, path: &Path, preferences: &mut Preferences) {
        *self = Self {
            pinned: Pinned::read(context, path),
            frame: self.frame,
            ..Self::default()
        };
        preferences.reference.path = Some(path.to_owned());
        preferences.reference.shown = true;
    }

    /// Shows or hides the picture; `false` if there is none yet.
    pub(crate) fn toggle(&mut self, preferences: &mut Preferences) -> bool {
        let known = preferences.reference.path.is_some();
        preferences.reference.shown = known && !preferences.reference.shown;
        self.frame = PictureFrame::default();
        known
    }

    /// Shows it, at first beside the palette, which covers this part of the window; what its buttons ask for.
    #[must_use]
    pub(crate) fn show(
        &mut self,
        context: &Context,
        palette: Option<Rect>,
        work: &mut PanelContext<'_>,
    ) -> Option<Action> {
        let preferences = work.preferences.reference.sound();
        let (true, Some(path)) = (preferences.shown, &preferences.path) else {
            return None;
        };
        if self.pinned.path() != Some(path) {
            self.pinned = Pinned::read(context, path);
        }
        self.pinned.take_in(context);
        let (mut open, mut asked) = (true, None);
        let fill = context.global_style().visuals.window_fill;
        let frame = Frame::window(&context.global_style());
        let window = Window::new(paths::name(path))
            .id(Id::unique("reference"))
            .open(&mut open)
            .collapsible(false)
            .frame(frame.fill(fill.gamma_multiply(preferences.opacity)))
            .default_size(preferences.size)
            .min_size(LEAST)
            .resizable(true);
        let window = self.frame.placed(window, context, palette, &preferences);
        let shown = window.show(context, |ui| {
            asked = self.header(ui, work);
            // The picture gives room to the proposals: the frame keeps its size.
            let gap = ui.spacing().item_spacing.y;
            let room = ui.available_size() - vec2(0.0, gap);
            let below = self.below.min(room.y - LEAST_PICTURE).max(0.0);
            let size = vec2(room.x, room.y - below).max(vec2(80.0, LEAST_PICTURE));
            self.picture(ui, size, preferences.opacity, work);
            let list = ScrollArea::vertical()
                .max_height(below)
                .min_scrolled_height(below)
                .auto_shrink(false);
            let list = list.show(ui, |ui| self.proposals(ui, work));
            if list.content_size.y != self.below {
                self.below = list.content_size.y;
                ui.ctx().request_repaint();
            }
        });
        if let Some(shown) = shown {
            self.frame
                .keep(context, shown.response.rect, work.preferences);
        }
        if !open {
            work.preferences.reference.shown = false;
        }
        asked
    }

    fn header(&mut self, ui: &mut Ui, work: &mut PanelContext<'_>) -> Option<Action> {
        let mut asked = None;
        ui.horizontal(|ui| {
            let another = ui
                .button(tr!("Another …"))
                .on_hover_text(tr!("Pin another picture"));
            if another.clicked() {
                asked = Some(Action::Reference);
            }
            if ui
                .button(tr!("Fit"))
                .on_hover_text(tr!("See all of it"))
                .clicked()
            {
                self.look.zoom = 1.0;
                self.look.middle = pos2(0.5, 0.5);
            }
            ui.spacing_mut().slider_width = 60.0;
            let opacity = work.preferences.reference.sound().opacity;
            let label = ui.label(tr!("Opaque"));
            let number = Number::percent::<FrameOpacity>("Opaque").without_digits();
            let (slider, change) = self.sliders.bare(ui, &number, "opaque", opacity.into());
            slider.labelled_by(label.id);
            if let Some(opacity) = change.moved {
                work.preferences.reference.opacity = opacity as f32;
            }
        });
        asked
    }

    /// The picture itself: it follows the pointer and the keys.
    fn picture(&mut self, ui: &mut Ui, room: Vec2, opacity: f32, work: &PanelContext<'_>) {
        let (area, response) = ui.allocate_exact_size(room, Sense::click_and_drag());
        response.widget_info(|| {
            let label = match &self.pinned {
                Pinned::Here(..) => {
                    tr!("Reference picture. Arrow keys move the cross, Enter picks, + and - zoom")
                }
                _ => tr!("Reference picture that is not there yet"),
            };
            WidgetInfo::labeled(Role::Image, true, label)
        });
        let painter = ui.painter_at(area);
        let (picture, texture) = match &self.pinned {
            Pinned::Here(_, picture, texture) => (picture.clone(), texture.id()),
            Pinned::Coming(..) => {
                ui.put(area, egui::Spinner::new());
                return;
            }
            Pinned::Failed(_, words) => {
                let colour = ui.visuals().warn_fg_color;
                let words = RichText::new(tr!("This picture cannot be shown. {words}", words));
                ui.put(area, egui::Label::new(words.color(colour)).wrap());
                return;
            }
            Pinned::Nothing => return,
        };
        let laid = |look: &Look| laid(area, picture.size, look);
        self.move_about(ui, &response, area, laid(&self.look), picture.size);
        let at = laid(&self.look);
        let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
        painter.image(texture, at, whole, Color32::WHITE.gamma_multiply(opacity));
        let picks = response
            .clicked()
            .then(|| response.interact_pointer_pos())
            .flatten();
        if let Some(pointer) = picks {
            let place = (pointer - at.min) / at.size();
            if (0.0..1.0).contains(&place.x) && (0.0..1.0).contains(&place.y) {
                self.look.cross = Some(place.to_pos2());
                self.pick(&picture, work);
            }
        }
        let enter = |input: &egui::InputState| input.key_pressed(Key::Enter);
        if response.has_focus() && ui.input(enter) && picks.is_none() {
            self.look.cross.get_or_insert(self.look.middle);
            self.pick(&picture, work);
        }
        if let Some(cross) = self.look.cross {
            mark(&painter, at.min + cross.to_vec2() * at.size());
        }
        if response.has_focus() {
            let stroke = ui.visuals().selection.stroke;
            painter.rect_stroke(area, CornerRadius::ZERO, stroke, StrokeKind::Inside);
        }
    }

    /// Zooms by the wheel around the pointer, pans by dragging; by keys the cross is moved.
    fn move_about(&mut self, ui: &Ui, response: &Response, area: Rect, at: Rect, size: [usize; 2]) {
        let look = &mut self.look;
        let least = at.width() / look.zoom;
        let closest = (CLOSEST * size[0] as f32 / least.max(1.0)).max(1.0);
        let mut zoom = 1.0;
        if response.dragged() {
            look.middle -= response.drag_delta() / at.size();
        }
        let mut around = area.center();
        if let Some(pointer) = response.hover_pos() {
            let (scroll, pinch) =
                ui.input(|input| (input.smooth_scroll_delta().y, input.zoom_delta()));
            zoom *= maulstick_num::exp(f64::from(scroll) * 0.004) as f32 * pinch;
            around = pointer;
        }
        if response.has_focus() {
            let step = arrow_steps(ui, response);
            if step != Vec2::ZERO {
                let cross = look.cross.unwrap_or(look.middle) + STEP * step / at.size();
                look.cross = Some(cross.clamp(Pos2::ZERO, pos2(0.999, 0.999)));
            }
            let pressed = |key: Key| {
                ui.input_mut(|input| f32::from(u8::from(input.consume_key(Modifiers::NONE, key))))
            };
            let closer = pressed(Key::Plus) + pressed(Key::Equals) - pressed(Key::Minus);
            zoom *= match closer {
                c if c > 0.0 => 1.25,
                c if c < 0.0 => 0.8,
                _ => 1.0,
            };
        }
        if zoom != 1.0 && zoom.is_finite() {
            let next = (look.zoom * zoom).clamp(1.0, closest);
            // The point under the pointer stays there.
            let off = (around - area.center()) / at.size();
            look.middle += off * (1.0 - look.zoom / next);
            look.zoom = next;
        }
        look.middle = look.middle.clamp(Pos2::ZERO, pos2(1.0, 1.0));
        if look.zoom <= 1.0 {
            look.middle = pos2(0.5, 0.5);
        }
    }

    /// Asks for mixtures of the colour under the cross.
    fn pick(&mut self, picture: &Picture, work: &PanelContext<'_>) {
        let (Some(cross), Some(scene)) = (self.look.cross, &work.rig.live.scene) else {
            return;
        };
        let pixel = |at: f32, side: usize| ((at * side as f32) as usize).min(side - 1);
        let linear = picture.mean([
            pixel(cross.x, picture.size[0]),
            pixel(cross.y, picture.size[1]),
        ]);
        self.picked = Some(linear);
        let paints = if work.preferences.reference.all_paints {
            None
        } else {
            of_palette(work.rig.live.palette())
        };
        self.picker.ask(Ask {
            linear,
            paints,
            light: scene.light.clone(),
        });
    }

    /// The picked colour, and the mixtures that come near it.
    fn proposals(&mut self, ui: &mut Ui, work: &mut PanelContext<'_>) {
        let Some(linear) = self.picked else {
            ui.weak(tr!(
                "Click a colour to see mixtures for it. Scroll to zoom."
            ));
            return;
        };
        let bytes = linear.map(|channel| (srgb_encode(channel) * 255.0).round() as u8);
        ui.horizontal(|ui| {
            swatch(ui, bytes, tr!("Picked"));
            ui.label(RichText::new(hex(bytes)).monospace());
            let all = &mut work.preferences.reference.all_paints;
            let choice = ui.checkbox(all, tr!("All paints"));
            let choice = choice.on_hover_text(tr!("Not only those on the palette"));
            if choice.changed()
                && let Pinned::Here(_, picture, _) = &self.pinned
            {
                let picture = picture.clone();
                self.pick(&picture, work);
            }
            if ui
                .button(tr!("Done"))
                .on_hover_text(tr!("Hide the mixtures"))
                .clicked()
            {
                self.picked = None;
                self.look.cross = None;
                self.picker.forget();
            }
        });
        let library = std::sync::Arc::clone(&work.rig.library);
        let found = self.picker.found(ui.ctx(), &library).cloned();
        matches(ui, found.as_ref(), work);
    }
}

/// The mark where colours are picked, visible over light and dark.
fn mark(painter: &egui::Painter, at: Pos2) {
    for (radius, width, colour) in [(7.0, 3.0, Color32::BLACK), (7.0, 1.5, Color32::WHITE)] {
        painter.circle_stroke(at, radius, Stroke::new(width, colour));
    }
}

/// Rectangle of a picture in its area.
fn laid(area: Rect, size: [usize; 2], look: &Look) -> Rect {
    let size = vec2(size[0].max(1) as f32, size[1].max(1) as f32);
    let fit = (area.size() / size).min_elem();
    let size = size * fit * look.zoom;
    Rect::from_min_size(area.center() - look.middle.to_vec2() * size, size)
}

#[cfg(test)]
mod tests;
