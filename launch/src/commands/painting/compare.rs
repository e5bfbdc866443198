//! Two versions of a painting side by side, and their difference.

use std::path::Path;

use maulstick_appearance::picture::Picture;
use maulstick_document::DocumentError;
use maulstick_optics::colour::{RgbSpace, apply, delta_e_2000, lab, srgb_decode};
use maulstick_painting::edits::common;
use maulstick_painting::picture::picture;
use maulstick_painting::{NOW, Sequencer};
use maulstick_rig::UserError;
use maulstick_rig::files::Kind;
use maulstick_types::scene::CANVAS;
use maulstick_types::values::VersionName;
use serde_json::json;

use maulstick_painting_setup::document::{read, wrong};
use maulstick_painting_setup::outputs::{UsedFile, check_outputs};
use maulstick_painting_setup::refused;

use crate::commands::{print_json, say, write_picture};

/// Bytes of a cell in two pictures, and in the one that has both and their difference.
const PIXEL_BYTES: u64 = 5 * 3;
/// A difference that is shown as white, ΔE₀₀.
const WHITE: f64 = 20.0;

/// Draws `one`, `other` and their difference, left to right, and prints their distance.
///
/// # Errors
/// A [`UserError`] for an unknown version, or a picture that cannot be written.
pub(super) fn compare(
    path: &Path,
    [one, other]: [&str; 2],
    output: &Path,
    as_json: bool,
) -> Result<i32, UserError> {
    check_outputs(
        &[UsedFile::new("the picture", output).of(Kind::Png)],
        &[UsedFile::painting(path)],
    )?;
    let (document, opened) = read(path)?;
    let mut sequencer = opened.sequencer().map_err(refused)?;
    let cells = sequencer.painting().scene().surfaces[0].cells;
    let cells = u64::from(cells[0]) * u64::from(cells[1]);
    maulstick_painting_setup::memory::check("the comparison", cells * PIXEL_BYTES)?;
    // An open step is finished first.
    sequencer.painting_mut().commit();
    let pictures = [seen(&mut sequencer, one)?, seen(&mut sequencer, other)?];
    if let Some(what) = document.pager().fault() {
        return Err(wrong(path, &DocumentError::Damaged(what.to_owned())));
    }
    let [left, right] = &pictures;
    let (width, height) = (left.width, left.height);
    let mut rgb = vec![0u8; 3 * width * height * 3];
    let (mut sum, mut most, mut changed) = (0.0f64, 0.0f64, 0u64);
    for y in 0..height {
        for x in 0..width {
            let at = (y * width + x) * 3;
            let pixels = [left, right].map(|picture| [0, 1, 2].map(|c| picture.rgb[at + c]));
            let delta = difference(pixels);
            sum += delta;
            most = most.max(delta);
            changed += u64::from(delta > 1.0);
            let parts = [pixels[0], pixels[1], heat(delta)];
            for (part, pixel) in parts.into_iter().enumerate() {
                let to = (y * 3 * width + part * width + x) * 3;
                rgb[to..to + 3].copy_from_slice(&pixel);
            }
        }
    }
    let count = (width * height).max(1) as f64;
    let picture = Picture::srgb(3 * width, height, rgb);
    write_picture(&picture, output)?;
    let (mean, share) = (sum / count, changed as f64 / count);
    if as_json {
        print_json(&json!({
            "one": one, "other": other, "mean_delta_e": mean, "max_delta_e": most,
            "changed_share": share,
        }))?;
    } else {
        say!("{}: {one} | {other} | difference", output.display());
        say!(
            "ΔE00 {mean:.2} in the mean, {most:.1} at most; {:.1} % of the canvas changed",
            100.0 * share
        );
    }
    Ok(0)
}

/// Picture of a version; the painting is restored afterwards.
fn seen(sequencer: &mut Sequencer, version: &str) -> Result<Picture, UserError> {
    let is_now = version == NOW;
    if !is_now {
        let name = VersionName::new(version)?;
        let back = common::return_to(name);
        sequencer.edit(back).map_err(refused)?;
    }
    let seen = picture(sequencer.painting_mut(), CANVAS);
    if !is_now {
        sequencer.edit(common::undo()).map_err(refused)?;
    }
    Ok(seen)
}

/// Difference of two pixels, ΔE₀₀.
fn difference([one, other]: [[u8; 3]; 2]) -> f64 {
    if one == other {
        return 0.0;
    }
    let to_xyz = RgbSpace::Srgb.to_xyz();
    let white = apply(&to_xyz, [1.0; 3]);
    let seen = |pixel: [u8; 3]| {
        let linear = pixel.map(|byte| srgb_decode(f64::from(byte) / 255.0));
        lab(apply(&to_xyz, linear), white)
    };
    delta_e_2000(seen(one), seen(other))
}

/// A difference as a colour: black, blue, orange, white.
fn heat(delta: f64) -> [u8; 3] {
    const STOPS: [[f64; 3]; 4] = [
        [0.0; 3],
        [30.0, 60.0, 170.0],
        [240.0, 140.0, 30.0],
        [255.0; 3],
    ];
    let place = (delta / WHITE).clamp(0.0, 1.0) * 3.0;
    let from = (place as usize).min(2);
    let t = place - from as f64;
    std::array::from_fn(|c| (STOPS[from][c] + (STOPS[from + 1][c] - STOPS[from][c]) * t) as u8)
}
