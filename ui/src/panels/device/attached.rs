//! Attached devices that are not in the rig: a click adds one, or a text says what is missing for that.

use eframe::egui::{Frame, RichText, Ui};
use maulstick_device_setup::add::NewDevice;
use maulstick_device_setup::attached::Permission;
use maulstick_device_setup::listing::UnusedDevice;
use maulstick_rig::user_devices::ALLOW_BY_HAND;
use maulstick_ui_kit::rows::note;

use crate::rig::device_order::SetupChange;
use crate::widgets::context::PanelContext;

pub(super) fn show(ui: &mut Ui, work: &mut PanelContext<'_>) {
    ui.horizontal(|ui| {
        ui.label(RichText::new(tr!("Attached")).strong());
        if work.rig.setup.listing.is_none() || work.rig.setup.is_changing {
            ui.weak(tr!("looking…"));
        }
    });
    let unused = work
        .rig
        .setup
        .listing
        .as_ref()
        .map(|listing| listing.unused());
    let Some(unused) = unused else {
        return;
    };
    if unused.is_empty() {
        note(
            ui,
            tr!(
                "No other tablet, 6-DOF mouse or arm is attached. A pen that the system knows paints without any of this."
            ),
        );
    }
    for device in unused {
        Frame::group(ui.style()).show(ui, |ui| {
            ui.set_width(ui.available_width());
            ui.push_id((&device.address, &device.driver), |ui| {
                row(ui, &device, work)
            });
        });
    }
}

fn row(ui: &mut Ui, device: &UnusedDevice, work: &mut PanelContext<'_>) {
    let driver = device.driver;
    ui.label(RichText::new(&device.name).strong());
    ui.small(tr!("driver {driver}", driver));
    if device.permission == Permission::Denied {
        ui.colored_label(
            ui.visuals().warn_fg_color,
            tr!("The system keeps it for root: it has to be allowed once."),
        );
        ui.horizontal(|ui| {
            let hint = tr!("Installs the rule for udev; the system asks for your password");
            if ui.button(tr!("Allow…")).on_hover_text(hint).clicked() {
                work.requests.change_device(SetupChange::Allow);
            }
            let hint = tr!("For a terminal, where the button cannot ask");
            let copy = ui.button(tr!("Copy the command")).on_hover_text(hint);
            if copy.clicked() {
                ui.ctx().copy_text(ALLOW_BY_HAND.to_owned());
            }
        });
        return;
    }
    if let Some(missing) = &device.missing {
        ui.colored_label(ui.visuals().warn_fg_color, missing);
    }
    let name = &device.name;
    let hint = tr!("It moves the brush from now on, and is kept for you");
    if ui
        .button(tr!("Add {name}", name))
        .on_hover_text(hint)
        .clicked()
    {
        let mut new = NewDevice::default();
        if device.address.is_empty() {
            new.driver = Some(driver.to_owned());
        } else {
            new.address = Some(device.address.clone());
        }
        work.requests.change_device(SetupChange::Add(new));
    }
}
