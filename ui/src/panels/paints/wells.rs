//! Wells of the palette from the top: remove, replace, reorder.

use eframe::egui::{
    Align, Button, Color32, Layout, Rect, Response, Role, Sense, Stroke, Ui, WidgetInfo, vec2,
};
use maulstick_canvas::quantum::SLOTS;
use maulstick_rig::UserError;
use maulstick_types::Mixture;
use maulstick_ui_kit::swatches::{Swatches, draw};

use super::{Carried, SWATCH};
use crate::panels::paints::palette_wells::MOST;
use crate::settings::brush_load::{self, words};
use crate::widgets::context::PanelContext;
use crate::widgets::mixture_field;

/// Width and height of a button with a sign, points.
const SIGN: f32 = 20.0;

#[derive(Debug, Default)]
pub(super) struct WellRows {
    /// The well that the next paint goes into.
    chosen: Option<usize>,
    text: String,
    fault: Option<UserError>,
}

/// Action on a well.
enum Deed {
    Choose,
    Up,
    Down,
    Remove,
    Drop(String),
}

/// Sign on a button: the window's font has none of them.
#[derive(Clone, Copy)]
enum Sign {
    Up,
    Down,
    Cross,
}

impl Sign {
    fn draw(self, ui: &Ui, on: &Response) {
        let colour = if on.enabled() {
            ui.style().interact(on).text_color()
        } else {
            ui.visuals().weak_text_color()
        };
        let at = |x: f32, y: f32| on.rect.center() + vec2(x, y);
        let line = |from, to| {
            ui.painter()
                .line_segment([from, to], Stroke::new(1.3, colour));
        };
        let way = match self {
            Self::Up => -1.0,
            Self::Down => 1.0,
            Self::Cross => {
                line(at(-3.5, -3.5), at(3.5, 3.5));
                line(at(-3.5, 3.5), at(3.5, -3.5));
                return;
            }
        };
        line(at(0.0, -4.5 * way), at(0.0, 4.5 * way));
        line(at(-3.5, way), at(0.0, 4.5 * way));
        line(at(3.5, way), at(0.0, 4.5 * way));
    }
}

impl WellRows {
    /// Puts a mixture into the chosen well, or below the others.
    pub(super) fn put(&mut self, work: &mut PanelContext<'_>, mixture: &Mixture) {
        let mut wells = work.wells();
        match self.chosen.take().filter(|place| *place < wells.len()) {
            Some(place) => wells[place] = mixture.clone(),
            None => wells.push(mixture.clone()),
        }
        work.lay_wells(&wells);
    }

    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        work: &mut PanelContext<'_>,
        swatches: &mut Swatches,
    ) {
        let mut wells = work.wells();
        ui.horizontal(|ui| {
            ui.strong(tr!("On the palette"));
            let paints = work.rig.live.scene.as_ref().map_or(0, |scene| scene.paints.len());
            ui.weak(tr!("{paints} of {slots} paints in this painting", paints, slots = SLOTS)).on_hover_text(tr!("Tubes that this painting has used. It has room for {slots}, its palette for {most} mixtures.", slots = SLOTS, most = MOST));
        });
        self.chosen.take_if(|place| *place >= wells.len());
        let mut asked = None;
        ui.scope(|ui| {
            ui.spacing_mut().item_spacing.y = 1.0;
            for (place, mixture) in wells.iter().enumerate() {
                let colour = swatches.mixture(work.rig.showing(), mixture);
                let colour = colour.unwrap_or(Color32::TRANSPARENT);
                let end = place + 1 == wells.len();
                let chosen = self.chosen == Some(place);
                if let Some(deed) = well(ui, (place, end), mixture, colour, chosen) {
                    asked = Some((place, deed));
                }
            }
        });
        match asked {
            Some((place, Deed::Choose)) => {
                self.chosen = (self.chosen != Some(place)).then_some(place);
            }
            Some((place, Deed::Up)) => {
                wells.swap(place - 1, place);
                work.lay_wells(&wells);
            }
            Some((place, Deed::Down)) => {
                wells.swap(place, place + 1);
                work.lay_wells(&wells);
            }
            Some((place, Deed::Remove)) => {
                wells.remove(place);
                self.chosen = None;
                work.lay_wells(&wells);
            }
            Some((place, Deed::Drop(text))) => {
                if let Ok(mixture) = brush_load::read(&text, &work.rig.library) {
                    wells[place] = mixture;
                    work.lay_wells(&wells);
                }
            }
            None => {}
        }
        if wells.is_empty() {
            ui.label(tr!("No paint lies there. Put some on it with +."));
        }
        self.field(ui, work, wells.len());
    }

    /// A mixture of one's own for a well.
    fn field(&mut self, ui: &mut Ui, work: &mut PanelContext<'_>, count: usize) {
        let hover = tr!("A paint's name, or a mixture such as Cobalt Blue=0.7,Titanium White=0.3");
        let words = (tr!("Mixture"), hover);
        let (shown, enter) = mixture_field::show(ui, words, &mut self.text, &work.rig.library);
        if shown.changed() {
            self.fault = None;
        }
        let words = match self.chosen {
            Some(place) => tr!("Into well {number}", number = place + 1),
            None => tr!("Add to palette").to_owned(),
        };
        let is_room = self.chosen.is_some() || count < MOST;
        let button = ui.add_enabled(is_room && !self.text.trim().is_empty(), Button::new(words));
        let button = if is_room {
            button
        } else {
            button.on_disabled_hover_text(tr!(
                "The palette holds {most} mixtures: choose one to replace, or remove one.",
                most = MOST
            ))
        };
        if button.clicked() || (enter && is_room) {
            match brush_load::read(&self.text, &work.rig.library) {
                Ok(mixture) => {
                    self.put(work, &mixture);
                    self.text.clear();
                }
                Err(fault) => self.fault = Some(fault),
            }
        }
        if let Some(fault) = &self.fault {
            mixture_field::fault(ui, fault);
        }
    }
}

/// A well; returns the action on it.
fn well(
    ui: &mut Ui,
    (place, is_last): (usize, bool),
    mixture: &Mixture,
    colour: Color32,
    is_chosen: bool,
) -> Option<Deed> {
    let name = words(mixture);
    let mut deed = None;
    let row = ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 2.0;
        let size = vec2(0.6 * SWATCH[0], SWATCH[1]);
        let (area, _) = ui.allocate_exact_size(size, Sense::hover());
        draw(ui, Rect::from_center_size(area.center(), size), [colour; 2]);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let mut tool = |ui: &mut Ui, sign: Sign, enabled: bool, said: String, asked: Deed| {
                let blank = Button::new("").min_size(vec2(SIGN, SIGN)).small();
                let button = ui.add_enabled(enabled, blank);
                sign.draw(ui, &button);
                button.widget_info(|| WidgetInfo::labeled(Role::Button, enabled, &said));
                if button.on_hover_text(&said).clicked() {
                    deed = Some(asked);
                }
            };
            let remove = tr!("Remove from the palette: {name}", name);
            tool(ui, Sign::Cross, true, remove, Deed::Remove);
            tool(
                ui,
                Sign::Down,
                !is_last,
                tr!("Down: {name}", name),
                Deed::Down,
            );
            tool(ui, Sign::Up, place > 0, tr!("Up: {name}", name), Deed::Up);
            ui.with_layout(Layout::top_down_justified(Align::Min), |ui| {
                let button = Button::selectable(is_chosen, &name).truncate();
                let shown: Response = ui.add(button);
                let hover = tr!(
                    "Well {number}: {name}\nClick, then choose a tube to replace this paint.",
                    number = place + 1,
                    name
                );
                if shown.on_hover_text(hover).clicked() {
                    deed = Some(Deed::Choose);
                }
            });
        });
    });
    if let Some(carried) = row.response.dnd_release_payload::<Carried>() {
        deed = Some(Deed::Drop(carried.0.clone()));
    }
    deed
}
