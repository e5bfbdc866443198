//! Canvas textures from image files.

use std::path::Path;
use std::sync::Arc;

use maulstick_canvas::relief::tooth_picture::{DEPTH_UM, ToothName, WIDTH_MM};
use maulstick_exchange::{Image, PictureKind, embed};
use maulstick_painting::Painting;
use maulstick_painting::edits::common;
use maulstick_rig::UserError;
use maulstick_types::Edit;

use crate::refusal::refused;
use crate::surface::picture::{no_picture, open_picture};

/// Default depth of a tooth, µm.
pub const DEPTH: f64 = 80.0;

/// A picture that becomes a tooth: white is high. It is repeated beyond its edges.
#[derive(Clone, Debug)]
pub struct ToothPicture {
    image: Arc<Image>,
    file: String,
    width_mm: Option<f64>,
    /// From white to black, µm.
    depth_um: f64,
}

impl ToothPicture {
    /// A picture with a width on the canvas, or that of the canvas, and a depth.
    ///
    /// # Errors
    /// A [`UserError`] for sizes out of range.
    pub fn new(
        image: Image,
        file: &str,
        width_mm: Option<f64>,
        depth_um: f64,
    ) -> Result<Self, UserError> {
        for (what, size, range) in [
            ("mm wide", width_mm, WIDTH_MM),
            ("µm deep", Some(depth_um), DEPTH_UM),
        ] {
            if let Some(size) = size.filter(|size| !range.contains(size)) {
                let (least, most) = (range.start(), range.end());
                return Err(UserError::usage(format!("a tooth {size} {what}"))
                    .help(format!("choose {least} to {most}")));
            }
        }
        Ok(Self {
            image: Arc::new(image),
            file: file.to_owned(),
            width_mm,
            depth_um,
        })
    }

    /// Reads the picture, too; its depth is [`DEPTH`] if absent.
    ///
    /// # Errors
    /// A [`UserError`] where the file is no picture, or for sizes out of range.
    pub fn read(
        file: &str,
        width_mm: Option<f64>,
        depth_um: Option<f64>,
    ) -> Result<Self, UserError> {
        let path = Path::new(file);
        if path.exists() && !PictureKind::is_named(path) {
            return Err(
                UserError::usage("a tooth is made of a picture, and this is none")
                    .at(file)
                    .help("give a PNG, JPEG, TIFF, OpenEXR, Radiance or OpenRaster picture: white is high"),
            );
        }
        Self::new(
            open_picture(path)?,
            file,
            width_mm,
            depth_um.unwrap_or(DEPTH),
        )
    }

    /// Adds it to a painting, and returns the edit that makes it the tooth of the canvas.
    ///
    /// # Errors
    /// A [`UserError`] where the picture is too large for it.
    pub fn embed(&self, painting: &mut Painting) -> Result<Edit, UserError> {
        let canvas = &painting.scene().surfaces[0];
        let cell_m = canvas.cell_m;
        let width_mm = self
            .width_mm
            .unwrap_or(f64::from(canvas.cells[0]) * cell_m * 1e3);
        let bytes = embed::tooth(&self.image, width_mm, cell_m)
            .map_err(|error| no_picture(self.file.as_ref(), &error))?;
        let name = ToothName {
            hash: painting.embed(bytes).map_err(refused)?,
            width_mm,
            depth_um: self.depth_um,
        };
        Ok(common::tooth(name.to_string())?.into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A PNG of one pixel.
    fn swatch() -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, 1, 1);
        encoder.set_color(png::ColorType::Grayscale);
        let mut writer = encoder.write_header().expect("a header");
        writer.write_image_data(&[7]).expect("a pixel");
        writer.finish().expect("whole");
        bytes
    }

    #[test]
    fn what_is_no_tooth_is_told_with_what_to_do() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("linen.csv");
        std::fs::write(&path, "400,0.4\n").expect("written");
        let file = path.display().to_string();
        let weave = folder.path().join("weave.png").display().to_string();
        std::fs::write(&weave, swatch()).expect("written");
        let none = ToothPicture::read("none.png", None, None).expect_err("no file");
        assert!(none.place.as_deref() == Some("none.png") && none.help.is_some());
        for (fault, word) in [
            (ToothPicture::read(&file, None, None), "PNG"),
            (ToothPicture::read(&weave, Some(0.5), None), "1 to 10000"),
            (
                ToothPicture::read(&weave, None, Some(f64::NAN)),
                "1 to 1000",
            ),
        ] {
            let fault = fault.expect_err(word);
            assert!(
                fault.help.as_deref().unwrap_or_default().contains(word),
                "{fault}"
            );
        }
    }
}
