//! Pictures and ledgers as files, written beside and renamed.

use std::fs::File;
use std::io::{BufWriter, Error, Write as _};
use std::path::{Path, PathBuf};

use maulstick_optics::colour::{SrgbTable, clamp_chromaticity};
use maulstick_types::paint::TILE;

use crate::display::DisplayTile;
use crate::painting::Painting;

/// An sRGB picture, three bytes a pixel from the top row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Pixels across.
    pub width: usize,
    /// Pixels down.
    pub height: usize,
    /// Red, green, blue.
    pub rgb: Vec<u8>,
}

/// The picture of a surface, a pixel a cell.
pub fn picture(painting: &mut Painting, surface: u32) -> Picture {
    painting.commit();
    let Some(store) = painting.store(surface) else {
        return Picture {
            width: 0,
            height: 0,
            rgb: Vec::new(),
        };
    };
    let [width, height] = store.cells().map(|cells| cells as usize);
    let mut rgb = vec![0u8; width * height * 3];
    let table = SrgbTable::default();
    let ground = painting.ground(surface);
    let bare = DisplayTile::of(None, painting.studio(), ground);
    for (id, version) in store.iter() {
        let shown = match &version.tile {
            Some(tile) => &DisplayTile::of(Some(tile), painting.studio(), ground),
            None => &bare,
        };
        let (left, bottom) = (id.x as usize * TILE, id.y as usize * TILE);
        for y in 0..TILE.min(height - bottom) {
            let row = height - 1 - (bottom + y);
            for x in 0..TILE.min(width - left) {
                let cell = y * TILE + x;
                let colour = clamp_chromaticity([0, 1, 2].map(|c| shown.rgb[c][cell]));
                let pixel = &mut rgb[(row * width + left + x) * 3..][..3];
                pixel.copy_from_slice(&colour.map(|channel| table.byte(channel)));
            }
        }
    }
    Picture { width, height, rgb }
}

/// The name under which a file is written before it takes its own.
fn beside(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_os_string();
    name.push(format!(".{}.tmp", std::process::id()));
    path.with_file_name(name)
}

/// Writes a file through `fill`: whole under its name, or not at all.
///
/// # Errors
/// What the file system says; no half-written file is left.
pub fn write_whole(
    path: &Path,
    fill: impl FnOnce(&mut BufWriter<File>) -> Result<(), Error>,
) -> Result<(), Error> {
    let beside = beside(path);
    let write = || {
        let mut file = BufWriter::new(File::create(&beside)?);
        fill(&mut file)?;
        file.flush()?;
        file.get_ref().sync_all()?;
        std::fs::rename(&beside, path)
    };
    write().inspect_err(|_| {
        std::fs::remove_file(&beside).ok();
    })
}

/// Sees, before the work that fills it, whether a file can be written.
///
/// # Errors
/// What the file system says.
pub fn check_writable(path: &Path) -> Result<(), Error> {
    if path.is_dir() {
        return Err(Error::from(std::io::ErrorKind::IsADirectory));
    }
    let beside = beside(path);
    File::create(&beside)?;
    std::fs::remove_file(&beside)
}

impl Picture {
    /// Writes a PNG: 8 bits a channel, marked as sRGB.
    ///
    /// # Errors
    /// As [`write_whole`].
    pub fn write_png(&self, path: &Path) -> Result<(), Error> {
        write_whole(path, |file| {
            let mut encoder = png::Encoder::new(file, self.width as u32, self.height as u32);
            encoder.set_color(png::ColorType::Rgb);
            encoder.set_depth(png::BitDepth::Eight);
            encoder.set_source_srgb(png::SrgbRenderingIntent::RelativeColorimetric);
            encoder.write_header()?.write_image_data(&self.rgb)?;
            Ok(())
        })
    }
}
