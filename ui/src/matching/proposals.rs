//! Rows of proposed mixtures: the distance of each, and its actions.

use eframe::egui::{self, Color32, Role, Sense, StrokeKind, Ui, WidgetInfo, vec2};
use maulstick_painting::edits::common;

use crate::matching::picker::{Match, Matches};
use crate::widgets::context::PanelContext;

/// Shows the results of a search; a spinner while it runs.
pub(crate) fn matches(ui: &mut Ui, found: Option<&Matches>, work: &mut PanelContext<'_>) {
    match found {
        None => {
            ui.horizontal(|ui| {
                ui.spinner();
                ui.weak(tr!("Mixing …"));
            });
        }
        Some(Err(fault)) => {
            ui.label(fault.words());
        }
        Some(Ok(all)) => {
            for found in all {
                proposal(ui, found, work);
            }
        }
    }
}

/// A mixture, its colour difference, and its actions.
fn proposal(ui: &mut Ui, found: &Match, work: &mut PanelContext<'_>) {
    let words = in_parts(found);
    ui.horizontal(|ui| {
        let near = tr!(
            "off by ΔE {distance}",
            distance = format_args!("{:.1}", found.delta_e)
        );
        swatch(ui, found.rgb, &near);
        ui.label(format!("ΔE {:.1}", found.delta_e))
            .on_hover_text(tr!("How far it is from the colour, ΔE₀₀: 1 is hardly seen"));
        let load = ui
            .button(tr!("Load"))
            .on_hover_text(tr!("Load the brush with it"));
        load.widget_info(|| WidgetInfo::labeled(Role::Button, true, tr!("Load {words}", words)));
        if load.clicked() {
            let load = common::load(work.rig.brush_name(), found.mixture.clone(), None);
            crate::widgets::context::ask(work, load);
        }
        let put = ui.button("+").on_hover_text(tr!("Put it on the palette"));
        put.widget_info(|| {
            WidgetInfo::labeled(Role::Button, true, tr!("To the palette: {words}", words))
        });
        if put.clicked() {
            let mut wells = work.wells();
            wells.push(found.mixture.clone());
            work.lay_wells(&wells);
        }
        let copy = ui.button(tr!("Copy")).on_hover_text(tr!("Copy it as text"));
        copy.widget_info(|| WidgetInfo::labeled(Role::Button, true, tr!("Copy {words}", words)));
        if copy.clicked() {
            ui.ctx().copy_text(found.mixture.to_string());
        }
    });
    ui.add(egui::Label::new(&words).wrap());
}

/// A mixture in a painter's words.
fn in_parts(found: &Match) -> String {
    let part = |part: &maulstick_types::mixture::Part| {
        let percent = 100.0 * part.share;
        match percent {
            percent if percent < 1.0 => format!("{} {percent:.2} %", part.paint),
            percent => format!("{} {percent:.0} %", part.paint),
        }
    };
    let parts: Vec<String> = found.mixture.parts.iter().map(part).collect();
    parts.join(", ")
}

/// A colour, encoded sRGB, in the web's notation.
#[must_use]
pub(crate) fn hex([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// A patch of a colour, encoded sRGB.
pub(crate) fn swatch(ui: &mut Ui, [r, g, b]: [u8; 3], label: &str) {
    let (area, response) = ui.allocate_exact_size(vec2(28.0, 18.0), Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, label));
    let edge = ui.visuals().widgets.noninteractive.bg_stroke;
    let painter = ui.painter();
    painter.rect(
        area,
        3.0,
        Color32::from_rgb(r, g, b),
        edge,
        StrokeKind::Inside,
    );
}
