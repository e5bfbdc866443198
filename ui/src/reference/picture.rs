//! Reference pictures, read and reduced on a thread, so that a huge one neither blocks the window nor fills
//! its memory.

use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::task::Poll;

use eframe::egui::{Color32, ColorImage, Context, TextureHandle, TextureOptions};
use maulstick_exchange::{Image, ImportError, fit_to};
use maulstick_optics::colour::srgb_decode;
use maulstick_ui_kit::background_task::BackgroundTask;

/// Most pixels of the longer side after reduction: every display takes such a texture.
const MOST_SIDE: usize = 2048;
/// Most bytes that a picture may take while it is read: 130 million pixels of a camera.
const MOST_BYTES: u64 = 400 << 20;
/// Pixels around the picked one, either way: the mean of 5 × 5 is taken.
const AROUND: usize = 2;

/// A picture in memory.
#[derive(Clone, Debug)]
pub(crate) struct Picture {
    /// Pixels across and down, after reduction.
    pub size: [usize; 2],
    /// Encoded sRGB, row after row from the top.
    rgb: Arc<[[u8; 3]]>,
}

impl Picture {
    /// Reads a file.
    ///
    /// # Errors
    /// [`ImportError`].
    pub(crate) fn read(path: &Path) -> Result<Self, ImportError> {
        let image = Image::open_within(path, MOST_BYTES)?;
        let own_size = image.size();
        let longer = own_size[0].max(own_size[1]);
        let less = (MOST_SIDE as f64 / longer as f64).min(1.0);
        let size = own_size.map(|side| ((side as f64 * less).round() as usize).max(1));
        let raster = fit_to::colours(&image, size)?;
        let rows = raster.rgb.rchunks_exact(size[0]);
        Ok(Self {
            size,
            rgb: rows.flatten().copied().collect(),
        })
    }

    /// Its pixels, encoded sRGB, row after row from the top.
    #[must_use]
    pub(crate) fn rgb(&self) -> &[[u8; 3]] {
        &self.rgb
    }

    /// One of these pixels, row after row from the top.
    #[cfg(test)]
    pub(crate) fn of(size: [usize; 2], rgb: Vec<[u8; 3]>) -> Self {
        Self {
            size,
            rgb: rgb.into(),
        }
    }

    /// Linear sRGB around a pixel: the mean of those of 5 × 5 that the picture has.
    #[must_use]
    pub(crate) fn mean(&self, [x, y]: [usize; 2]) -> [f64; 3] {
        let range = |at: usize, side: usize| {
            let at = at.min(side - 1);
            at.saturating_sub(AROUND)..(at + AROUND + 1).min(side)
        };
        let (mut sum, mut count) = ([0.0; 3], 0.0);
        for y in range(y, self.size[1]) {
            for x in range(x, self.size[0]) {
                let pixel = self.rgb[y * self.size[0] + x];
                for (sum, byte) in sum.iter_mut().zip(pixel) {
                    *sum += srgb_decode(f64::from(byte) / 255.0);
                }
                count += 1.0;
            }
        }
        sum.map(|sum| sum / count)
    }

    fn texture(&self, context: &Context) -> TextureHandle {
        let pixels = self
            .rgb
            .iter()
            .map(|[r, g, b]| Color32::from_rgb(*r, *g, *b));
        let image = ColorImage::new(self.size, pixels.collect());
        context.load_texture("reference", image, TextureOptions::LINEAR)
    }
}

/// Reason why a picture is not read, and advice, in the language of the window.
#[must_use]
pub(crate) fn unread(error: &ImportError) -> String {
    match error {
        ImportError::File(error) => tr!(
            "It cannot be read: {error}. Check that the file still exists.",
            error
        ),
        ImportError::TooLarge(width, height) | ImportError::Memory(width, height) => tr!(
            "Its {width} × {height} pixels are too many to look at. Make a smaller copy of it.",
            width,
            height
        ),
        ImportError::NotANumber(x, y) => tr!(
            "Its pixel {x}, {y} is no number. Paint over it in the program that made it, and save it again.",
            x,
            y
        ),
        ImportError::NotPanoramic(width, height) => tr!(
            "Its {width} × {height} pixels are not twice as wide as high, as latitude and longitude are.",
            width,
            height
        ),
        ImportError::Radiance(x, y) => tr!(
            "Its pixel {x}, {y} is darker than black or infinitely bright. Save it again without such.",
            x,
            y
        ),
        ImportError::Black => tr!("Its middle, which faces the painting, is black.").to_owned(),
        ImportError::Unsupported(_) => {
            tr!("It is of a kind that is not read. Save it as PNG.").to_owned()
        }
        _ => tr!("It is damaged, or no PNG, JPEG, TIFF, OpenEXR, Radiance or OpenRaster. Take another copy.")
            .to_owned(),
    }
}

/// A pinned picture while it loads.
#[derive(Default)]
pub(crate) enum Pinned {
    #[default]
    Nothing,
    /// It is being read.
    Coming(PathBuf, BackgroundTask<Result<Picture, ImportError>>),
    /// It is here.
    Here(PathBuf, Picture, TextureHandle),
    /// It cannot be shown, and why.
    Failed(PathBuf, String),
}

impl Pinned {
    /// Begins to read a file.
    #[must_use]
    pub(crate) fn read(context: &Context, path: &Path) -> Self {
        let file = path.to_owned();
        let read = move || Picture::read(&file);
        Self::Coming(
            path.to_owned(),
            BackgroundTask::start(context, "reference", read),
        )
    }

    /// A picture that is there.
    #[must_use]
    pub(crate) fn here(context: &Context, path: &Path, picture: Picture) -> Self {
        let texture = picture.texture(context);
        Self::Here(path.to_owned(), picture, texture)
    }

    /// Takes the picture in when it has come.
    pub(crate) fn take_in(&mut self, context: &Context) {
        let Self::Coming(path, task) = self else {
            return;
        };
        let Poll::Ready(found) = task.poll() else {
            return;
        };
        let path = std::mem::take(path);
        *self = match found {
            Some(Ok(picture)) => Self::here(context, &path, picture),
            Some(Err(error)) => Self::Failed(path, unread(&error)),
            None => Self::Failed(
                path,
                tr!("It is damaged. Take another copy of it.").to_owned(),
            ),
        };
    }

    /// The file; `None` if nothing is pinned.
    #[must_use]
    pub(crate) fn path(&self) -> Option<&Path> {
        match self {
            Self::Nothing => None,
            Self::Coming(path, _) | Self::Here(path, ..) | Self::Failed(path, _) => Some(path),
        }
    }
}

impl fmt::Debug for Pinned {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Pinned").field(&self.path()).finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_colour_of_a_place_is_the_mean_of_the_light_around_it() {
        // A chessboard of black and white, and a corner of its own.
        let mut pixels: Vec<[u8; 3]> = (0..400)
            .map(|i| [255 * u8::from((i % 20 + i / 20) % 2 == 0); 3])
            .collect();
        pixels[399] = [255, 0, 0];
        let picture = Picture::of([20, 20], pixels);
        let [grey, ..] = picture.mean([10, 10]);
        // 13 of 25 are white; the mean of the encoded bytes would be .23 in linear light.
        assert!((grey - 0.52).abs() < 1e-9, "{grey}");
        assert!((srgb_decode(0.52) - 0.52).abs() > 0.2, "a fault would pass");
        // In the corner there are 9: 4 black, 4 white, a red one.
        let [red, green, _] = picture.mean([40, 19]);
        assert!((red - 5.0 / 9.0).abs() < 1e-9 && (green - 4.0 / 9.0).abs() < 1e-9);
    }

    #[test]
    fn a_large_picture_becomes_small_and_stays_the_right_way_up() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("large.png");
        let (across, down) = (4100u32, 12u32);
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, across, down);
        encoder.set_color(png::ColorType::Rgb);
        let mut writer = encoder.write_header().expect("a header");
        let row = |y: u32| [[0, 200][usize::from(y < 6)], 0, 0].repeat(across as usize);
        let pixels: Vec<u8> = (0..down).flat_map(row).collect();
        writer.write_image_data(&pixels).expect("written");
        drop(writer);
        std::fs::write(&path, &bytes).expect("written");
        let picture = Picture::read(&path).expect("a picture");
        assert_eq!(picture.size, [2048, 6]);
        assert_eq!(
            [picture.rgb[0], picture.rgb[5 * 2048]],
            [[200, 0, 0], [0; 3]]
        );
        // Refused by what its first bytes say, before any memory is taken for its pixels.
        let mut huge = Vec::new();
        let mut encoder = png::Encoder::new(&mut huge, 30_000, 30_000);
        encoder.set_color(png::ColorType::Rgb);
        let mut writer = encoder.write_header().expect("a header");
        writer
            .write_chunk(png::chunk::IDAT, &[0x78, 0x9c])
            .expect("written");
        drop(writer);
        std::fs::write(&path, &huge).expect("written");
        let error = Picture::read(&path).expect_err("too large");
        let is_too_large = matches!(
            error,
            ImportError::TooLarge(30_000, 30_000) | ImportError::Memory(30_000, 30_000)
        );
        assert!(is_too_large, "{error}");
        std::fs::write(&path, &bytes[..bytes.len() / 2]).expect("written");
        let error = Picture::read(&path).expect_err("damaged");
        assert!(
            !matches!(error, ImportError::File(_) | ImportError::TooLarge(..)),
            "{error}"
        );
        let none = Picture::read(&folder.path().join("none.png"));
        assert!(matches!(none, Err(ImportError::File(_))));
    }
}
