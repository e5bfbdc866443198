//! Surroundings that gloss mirrors, from pictures by latitude and longitude.

use maulstick_optics::light::environment::Panorama;
use maulstick_types::scene::Environment;

use crate::import_error::ImportError;
use crate::read_image::Image;

/// Most bytes of such a picture in memory.
pub const ENVIRONMENT_MEMORY: u64 = 2 << 30;

/// The environment of a picture of the whole surroundings: the middle of it faces the painting. Floats are radiances, up
/// to those of half floats; all other numbers are as they are displayed.
///
/// # Errors
/// [`ImportError`] where the picture is not twice as wide as high, has a radiance that is negative or infinite, or is
/// black before the painting.
pub fn environment(image: &Image, name: &str) -> Result<Environment, ImportError> {
    let [width, height] = image.size();
    let panorama = Panorama::new([width, height]);
    let mut panorama = panorama.ok_or(ImportError::NotPanoramic(width, height))?;
    if let Some([x, y]) = image.first_without_radiance() {
        return Err(ImportError::Radiance(x, y));
    }
    let mut pixels = Vec::with_capacity(width);
    for row in 0..height {
        image.radiance(row, &mut pixels);
        panorama.add(row, &pixels);
    }
    let map = panorama.map().ok_or(ImportError::Black)?;
    Ok(Environment::Picture {
        name: name.to_owned(),
        texels: map.to_bytes(),
    })
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use image::{DynamicImage, ImageFormat, Rgb, Rgb32FImage, RgbImage};
    use maulstick_types::scene::Light;

    use super::*;

    /// The environment of a picture of 64 by 32 pixels whose left half has this light.
    fn of(format: ImageFormat, left: f32) -> Result<Environment, ImportError> {
        let light = |x: u32| if x < 32 { left } else { 0.25 };
        let floats = Rgb32FImage::from_fn(64, 32, |x, _| Rgb([light(x); 3]));
        let pixels = DynamicImage::ImageRgb32F(floats);
        let mut bytes = Cursor::new(Vec::new());
        match format {
            ImageFormat::Png => pixels.to_rgb8().write_to(&mut bytes, format),
            _ => pixels.write_to(&mut bytes, format),
        }
        .expect("written");
        environment(&Image::read(&bytes.into_inner())?, "hall")
    }

    fn exr(left: f32) -> Result<Environment, ImportError> {
        let mut bytes = Cursor::new(Vec::new());
        let light = move |at: exr::prelude::Vec2<usize>| if at.0 < 32 { left } else { 0.25 };
        let channels = exr::prelude::SpecificChannels::rgb(move |at| (light(at), 0.25f32, 0.25f32));
        exr::prelude::WritableImage::write(&exr::prelude::Image::from_channels((64, 32), channels))
            .to_buffered(&mut bytes)
            .expect("written");
        environment(&Image::read(&bytes.into_inner())?, "hall")
    }

    #[test]
    fn pictures_of_light_keep_what_is_brighter_than_white() {
        let white = of(ImageFormat::Hdr, 1.0).expect("a hall");
        let bright = of(ImageFormat::Hdr, 20.0).expect("a hall");
        assert_ne!(white, bright, "light beyond white would be cut off");
        assert_ne!(exr(1.0).expect("a hall"), exr(20.0).expect("a hall"));
        for environment in [white, bright, of(ImageFormat::Png, 1.0).expect("a hall")] {
            assert_eq!(environment.name(), "hall");
            let light = Light {
                environment,
                ..Light::default()
            };
            assert_eq!(light.check(), Ok(()));
        }
    }

    #[test]
    fn a_picture_that_is_no_panorama_is_rejected_with_its_pixel() {
        let wide = RgbImage::from_pixel(40, 32, Rgb([9; 3]));
        let mut bytes = Cursor::new(Vec::new());
        wide.write_to(&mut bytes, ImageFormat::Png)
            .expect("written");
        let wide = Image::read(&bytes.into_inner()).expect("a picture");
        let fault = environment(&wide, "wide");
        assert!(matches!(fault, Err(ImportError::NotPanoramic(40, 32))));
        for bad in [-1.0, f32::INFINITY, f32::NEG_INFINITY] {
            assert!(
                matches!(exr(bad), Err(ImportError::Radiance(0, 0))),
                "{bad}"
            );
        }
        assert!(matches!(exr(f32::NAN), Err(ImportError::NotANumber(0, 0))));
        let mut bytes = Cursor::new(Vec::new());
        let black = RgbImage::new(64, 32);
        black
            .write_to(&mut bytes, ImageFormat::Png)
            .expect("written");
        let black = Image::read(&bytes.into_inner()).expect("a picture");
        assert!(matches!(
            environment(&black, "night"),
            Err(ImportError::Black)
        ));
    }
}
