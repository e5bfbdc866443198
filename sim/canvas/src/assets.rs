//! Pictures and spectra of a painting's grounds and teeth, by the hash of their bytes.
//!
//! A spectrum is a CSV file of nm,reflectance; the name of a ground that begins with [`SPECTRUM`] refers to one.
//!
//! Pictures are PNG files of two kinds: 8-bit RGB, which is sRGB, and 16-bit grey, which is heights. A name of a ground
//! or a tooth that begins with [`IMAGE`] refers to one.

use std::collections::BTreeMap;
use std::fmt;
use std::io::Cursor;
use std::sync::{Arc, Mutex, PoisonError, Weak};

use sha2::{Digest as _, Sha256};

use crate::error::CanvasError;

/// Prefix of the name of a ground or a tooth that is made from a picture; its hash follows.
pub const IMAGE: &str = "image:";
/// Prefix of the name of a ground that is made from a spectrum; its hash follows.
pub const SPECTRUM: &str = "spectrum:";
/// Signature of a PNG.
const PNG: &[u8] = b"\x89PNG";
/// Greatest number of pixels of a picture: 8192×8192.
pub const MOST_PIXELS: u64 = 1 << 26;
/// Number of digits of a hash: SHA-256, lower-case hexadecimal.
const HASH_DIGITS: usize = 64;

/// A decoded picture, row by row from the lowest.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pixels<T> {
    /// Pixels across, at least 1.
    pub width: usize,
    /// Pixels up, at least 1.
    pub height: usize,
    /// Pixels of the picture.
    pub values: Vec<T>,
}

/// Encoded sRGB.
pub type Colours = Pixels<[u8; 3]>;
/// Heights, 0 the lowest.
pub type Heights = Pixels<u16>;

/// Decoded content of a picture.
#[derive(Clone, Debug)]
enum Decoded {
    Colours(Arc<Colours>),
    Heights(Arc<Heights>),
}

/// A decoded picture, held weakly.
#[derive(Clone, Debug, Default)]
enum CachedImage {
    #[default]
    Nothing,
    Colours(Weak<Colours>),
    Heights(Weak<Heights>),
}

/// Bytes of a picture, and its decoded form.
#[derive(Clone)]
struct Entry {
    bytes: Arc<[u8]>,
    cached: Arc<Mutex<CachedImage>>,
}

/// Pictures and spectra of one painting.
#[derive(Clone, Default)]
pub struct Assets(BTreeMap<String, Entry>);

/// Hash of a picture's bytes: SHA-256, lower-case hexadecimal.
#[must_use]
pub fn hash_of(bytes: &[u8]) -> String {
    let digest = Sha256::digest(bytes);
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Type of a file by its bytes, for documents.
#[must_use]
pub fn kind_of(bytes: &[u8]) -> &'static str {
    if bytes.starts_with(PNG) {
        "picture"
    } else {
        "spectrum"
    }
}

impl Assets {
    /// Adds a picture and returns its hash.
    ///
    /// # Errors
    /// [`CanvasError`] where the bytes are no PNG of the two kinds, or of too many pixels.
    pub fn add(&mut self, bytes: Arc<[u8]>) -> Result<String, CanvasError> {
        let hash = hash_of(&bytes);
        if !self.0.contains_key(&hash) {
            decode(&bytes)?;
            let cached = Arc::default();
            self.0.insert(hash.clone(), Entry { bytes, cached });
        }
        Ok(hash)
    }

    /// Adds a picture or a spectrum of an earlier painting, with its hash.
    pub fn know(&mut self, hash: String, bytes: Arc<[u8]>) {
        let cached = Arc::default();
        self.0.entry(hash).or_insert(Entry { bytes, cached });
    }

    /// True if a picture has this hash.
    #[must_use]
    pub fn holds(&self, hash: &str) -> bool {
        self.0.contains_key(hash)
    }

    /// Hashes and bytes of all pictures, in the order of their hashes.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &Arc<[u8]>)> {
        self.0.iter().map(|(hash, entry)| (&**hash, &entry.bytes))
    }

    /// The bytes of a picture or a spectrum.
    ///
    /// # Errors
    /// [`CanvasError`] if no file has this hash.
    pub fn bytes(&self, hash: &str) -> Result<&Arc<[u8]>, CanvasError> {
        self.entry(hash).map(|entry| &entry.bytes)
    }

    fn entry(&self, hash: &str) -> Result<&Entry, CanvasError> {
        self.0.get(hash).ok_or_else(|| {
            let digits = hash.bytes().all(|c| matches!(c, b'0'..=b'9' | b'a'..=b'f'));
            if digits && hash.len() == HASH_DIGITS {
                CanvasError::NoPicture(hash.to_owned())
            } else {
                CanvasError::NoHash(hash.to_owned())
            }
        })
    }

    /// Decodes a picture, unless somebody still holds what was decoded before.
    fn decoded(&self, hash: &str) -> Result<Decoded, CanvasError> {
        let entry = self.entry(hash)?;
        let mut cached = entry.cached.lock().unwrap_or_else(PoisonError::into_inner);
        let held = match &*cached {
            CachedImage::Nothing => None,
            CachedImage::Colours(colours) => colours.upgrade().map(Decoded::Colours),
            CachedImage::Heights(heights) => heights.upgrade().map(Decoded::Heights),
        };
        if let Some(held) = held {
            return Ok(held);
        }
        let decoded = decode(&entry.bytes)?;
        *cached = match &decoded {
            Decoded::Colours(colours) => CachedImage::Colours(Arc::downgrade(colours)),
            Decoded::Heights(heights) => CachedImage::Heights(Arc::downgrade(heights)),
        };
        Ok(decoded)
    }

    /// Pixels of a picture of colours.
    ///
    /// # Errors
    /// [`CanvasError`] if no file has this hash, or it is one of heights.
    pub fn colours(&self, hash: &str) -> Result<Arc<Colours>, CanvasError> {
        match self.decoded(hash)? {
            Decoded::Colours(colours) => Ok(colours),
            Decoded::Heights(_) => Err(CanvasError::Heights),
        }
    }

    /// Pixels of a picture of heights.
    ///
    /// # Errors
    /// [`CanvasError`] if no file has this hash, or it is one of colours.
    pub fn heights(&self, hash: &str) -> Result<Arc<Heights>, CanvasError> {
        match self.decoded(hash)? {
            Decoded::Heights(heights) => Ok(heights),
            Decoded::Colours(_) => Err(CanvasError::Colours),
        }
    }
}

/// Reads a PNG of either kind.
fn decode(bytes: &[u8]) -> Result<Decoded, CanvasError> {
    let wrong =
        |error: png::DecodingError| CanvasError::Picture(format!("this is no whole PNG: {error}"));
    // Of the pixels' rows alone: what else a file has unpacks to anything.
    let limits = png::Limits { bytes: 1 << 26 };
    let mut decoder = png::Decoder::new_with_limits(Cursor::new(bytes), limits);
    decoder.set_ignore_iccp_chunk(true);
    decoder.set_ignore_text_chunk(true);
    let mut reader = decoder.read_info().map_err(wrong)?;
    let info = reader.info();
    let (width, height) = (info.width as usize, info.height as usize);
    if u64::from(info.width) * u64::from(info.height) > MOST_PIXELS {
        return Err(CanvasError::Picture(format!(
            "a picture of {width}×{height} pixels is too large"
        )));
    }
    let kind = (info.color_type, info.bit_depth);
    let size = reader.output_buffer_size();
    let mut raw = vec![0; size.unwrap_or(0)];
    reader.next_frame(&mut raw).map_err(wrong)?;
    match kind {
        (png::ColorType::Rgb, png::BitDepth::Eight) => {
            let rows = raw.rchunks_exact(3 * width);
            let pixels = rows.flat_map(|row| row.chunks_exact(3));
            let values = pixels.map(|rgb| [rgb[0], rgb[1], rgb[2]]).collect();
            Ok(Decoded::Colours(Arc::new(Pixels {
                width,
                height,
                values,
            })))
        }
        (png::ColorType::Grayscale, png::BitDepth::Sixteen) => {
            let rows = raw.rchunks_exact(2 * width);
            let pixels = rows.flat_map(|row| row.chunks_exact(2));
            let values = pixels.map(|two| u16::from_be_bytes([two[0], two[1]]));
            Ok(Decoded::Heights(Arc::new(Pixels {
                width,
                height,
                values: values.collect(),
            })))
        }
        (colour, depth) => Err(CanvasError::Picture(format!(
            "this PNG is {colour:?} of {} bits a channel",
            depth as u8
        ))),
    }
}

impl fmt::Debug for Assets {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sizes = self.iter().map(|(hash, bytes)| (hash, bytes.len()));
        f.debug_map().entries(sizes).finish()
    }
}

/// Pictures are equal if their hashes are.
impl PartialEq for Assets {
    fn eq(&self, other: &Self) -> bool {
        self.0.keys().eq(other.0.keys())
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// A PNG of these rows from the top.
    pub(crate) fn png_of(
        [width, height]: [u32; 2],
        color: png::ColorType,
        depth: png::BitDepth,
        raw: &[u8],
    ) -> Arc<[u8]> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, width, height);
        encoder.set_color(color);
        encoder.set_depth(depth);
        let mut writer = encoder.write_header().expect("a header");
        writer.write_image_data(raw).expect("pixels");
        writer.finish().expect("whole");
        bytes.into()
    }

    #[test]
    fn pictures_are_known_by_their_hash_and_come_from_the_bottom_up() {
        let mut embedded = Assets::default();
        let rgb = [1, 2, 3, 4, 5, 6];
        let bytes = png_of([1, 2], png::ColorType::Rgb, png::BitDepth::Eight, &rgb);
        let hash = embedded.add(Arc::clone(&bytes)).expect("taken");
        assert_eq!(hash.len(), HASH_DIGITS);
        assert_eq!(embedded.add(bytes).as_ref(), Ok(&hash));
        assert_eq!(embedded.iter().count(), 1);
        let colours = embedded.colours(&hash).expect("colours");
        assert_eq!(colours.values, [[4, 5, 6], [1, 2, 3]]);
        assert!(Arc::ptr_eq(
            &colours,
            &embedded.colours(&hash).expect("held")
        ));
        assert!(embedded.heights(&hash).is_err());
        let grey = png_of(
            [2, 1],
            png::ColorType::Grayscale,
            png::BitDepth::Sixteen,
            &[1, 2, 0xff, 0xff],
        );
        let grey = embedded.add(grey).expect("taken");
        assert_eq!(
            embedded.heights(&grey).expect("heights").values,
            [0x102, 0xffff]
        );
        assert!(embedded.colours(&grey).is_err());
        // Known: SHA-256 of nothing.
        assert!(hash_of(b"").starts_with("e3b0c44298fc1c14"));
    }

    #[test]
    fn what_is_no_such_picture_is_refused() {
        let mut embedded = Assets::default();
        let says = |error: CanvasError, word: &str| {
            assert!(error.to_string().contains(word), "{error}");
        };
        says(embedded.add((*b"GIF89a").into()).expect_err("no"), "PNG");
        let small = png_of(
            [1, 1],
            png::ColorType::Grayscale,
            png::BitDepth::Eight,
            &[7],
        );
        says(embedded.add(Arc::clone(&small)).expect_err("no"), "8 bits");
        let rgb = png_of([9, 9], png::ColorType::Rgb, png::BitDepth::Eight, &[7; 243]);
        let cut = &rgb[..rgb.len() - 30];
        says(embedded.add(cut.into()).expect_err("no"), "PNG");
        says(embedded.colours("12").expect_err("no"), "hash");
        says(
            embedded.colours(&"0".repeat(64)).expect_err("no"),
            "no picture",
        );
        assert_eq!(embedded, Assets::default());
    }
}
