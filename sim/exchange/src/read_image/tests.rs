//! Pictures of each kind, with the marks of their colours.

use image::{ImageFormat, Rgb, RgbImage};
use maulstick_num::powf;
use maulstick_optics::colour::RgbSpace;
use maulstick_optics::icc::Profile;

use super::*;

/// Linear light of 128/255.
const MIDDLE: f32 = 0.215_861;

fn read(pixels: impl Into<DynamicImage>, format: ImageFormat) -> Image {
    let mut bytes = Cursor::new(Vec::new());
    let pixels = pixels.into();
    pixels.write_to(&mut bytes, format).expect("written");
    Image::read(&bytes.into_inner()).expect("a picture")
}

fn first(image: &Image, row: usize) -> ([f32; 3], f32) {
    let (mut colours, mut heights) = (Vec::new(), Vec::new());
    image.colours(row, &mut colours);
    image.heights(row, &mut heights);
    assert_eq!(
        (colours.len(), heights.len()),
        (image.size()[0], image.size()[0])
    );
    (colours[0], heights[0][0])
}

fn near(got: [f32; 3], want: [f32; 3], by: f32) -> bool {
    got.iter().zip(want).all(|(a, b)| (a - b).abs() < by)
}

#[test]
fn every_kind_of_pixel_is_read() {
    // Linear light of 128/255 and of half of 65535.
    let (byte, word) = (0.215_861, 0.214_041);
    let grey8 = image::GrayImage::from_pixel(2, 1, image::Luma([128]));
    let grey16 = image::ImageBuffer::from_pixel(2, 1, image::Luma([32_768u16]));
    let rgb16 = image::ImageBuffer::from_pixel(2, 1, Rgb([32_768u16, 0, 65_535]));
    let half = image::RgbaImage::from_pixel(2, 1, image::Rgba([255, 0, 0, 51]));
    let grey_alpha = image::GrayAlphaImage::from_pixel(2, 1, image::LumaA([0, 0]));
    for format in [ImageFormat::Png, ImageFormat::Tiff] {
        let (colour, height) = first(&read(grey8.clone(), format), 0);
        assert!(near(colour, [byte; 3], 1e-5), "{colour:?}");
        assert!(!near(colour, [word; 3], 1e-5), "a fault would pass");
        assert!((height - 128.0 / 255.0).abs() < 1e-5);
        let (colour, height) = first(&read(grey16.clone(), format), 0);
        assert!(near(colour, [word; 3], 1e-5), "{colour:?}");
        assert!((height - 0.5).abs() < 1e-4);
        let (colour, height) = first(&read(rgb16.clone(), format), 0);
        assert!(near(colour, [word, 0.0, 1.0], 1e-5), "{colour:?}");
        assert!((height - 0.1785).abs() < 1e-4, "{height}");
        let (colour, _) = first(&read(half.clone(), format), 0);
        assert!(near(colour, [1.0, 0.8, 0.8], 1e-5), "{colour:?}");
    }
    let clear = first(&read(grey_alpha, ImageFormat::Png), 0);
    assert_eq!(clear, ([1.0; 3], 1.0));
    let jpeg = first(
        &read(RgbImage::from_pixel(9, 9, Rgb([128; 3])), ImageFormat::Jpeg),
        4,
    );
    assert!(near(jpeg.0, [byte; 3], 0.01), "{jpeg:?}");
}

#[test]
fn a_profile_is_obeyed() {
    let with = |space: RgbSpace| {
        let mut bytes = Vec::new();
        let mut info = png::Info::with_size(1, 1);
        info.color_type = png::ColorType::Rgb;
        info.bit_depth = png::BitDepth::Eight;
        info.icc_profile = Some(Profile::of(space).icc().to_vec().into());
        let encoder = png::Encoder::with_info(&mut bytes, info).expect("an encoder");
        let mut writer = encoder.write_header().expect("a header");
        writer.write_image_data(&[117, 251, 76]).expect("a pixel");
        drop(writer);
        first(&Image::read(&bytes).expect("a picture"), 0).0
    };
    // Display P3's (117, 251, 76) is sRGB's green.
    let (wide, own) = (with(RgbSpace::DisplayP3), with(RgbSpace::Srgb));
    println!("{wide:?} {own:?}");
    assert!(near(wide, [0.0, 1.0, 0.0], 0.02), "{wide:?}");
    assert!(!near(own, [0.0, 1.0, 0.0], 0.02), "a fault would pass");
}

#[test]
fn the_top_row_is_the_first_and_slim_pictures_are_read() {
    let mut two = RgbImage::new(1, 2);
    two.put_pixel(0, 0, Rgb([255, 0, 0]));
    let image = read(two, ImageFormat::Png);
    assert_eq!(first(&image, 0).0, [1.0, 0.0, 0.0]);
    assert_eq!(first(&image, 1).0, [0.0; 3]);
    let slim = read(image::GrayImage::new(20_000, 10), ImageFormat::Png);
    assert_eq!(slim.size(), [20_000, 10]);
    assert_eq!(
        read(image::GrayImage::new(1, 1), ImageFormat::Png).size(),
        [1, 1]
    );
}

#[test]
fn what_is_no_picture_says_so() {
    let says = |bytes: &[u8], word: &str| {
        let error = Image::read(bytes).expect_err("no picture").to_string();
        println!("{error}");
        assert!(error.contains(word), "{error}");
    };
    says(b"", "PNG, JPEG, TIFF, OpenEXR, Radiance or OpenRaster");
    says(
        b"not a picture at all",
        "PNG, JPEG, TIFF, OpenEXR, Radiance or OpenRaster",
    );
    says(
        b"GIF89a\x01\0\x01\0",
        "PNG, JPEG, TIFF, OpenEXR, Radiance or OpenRaster",
    );
    let mut whole = Cursor::new(Vec::new());
    let pixels = RgbImage::from_fn(50, 50, |x, y| Rgb([x as u8, y as u8, (x * y) as u8]));
    pixels
        .write_to(&mut whole, ImageFormat::Png)
        .expect("written");
    let whole = whole.into_inner();
    says(
        &whole[..whole.len() / 2],
        "PNG, JPEG, TIFF, OpenEXR, Radiance or OpenRaster",
    );
    let mut wide = Cursor::new(Vec::new());
    let pixels = image::GrayImage::new(20_001, 1);
    pixels
        .write_to(&mut wide, ImageFormat::Png)
        .expect("written");
    says(&wide.into_inner(), "20001×1 pixels is too large");
    let none = Image::open(Path::new("/nowhere/picture.png")).expect_err("none");
    assert!(matches!(none, ImportError::File(_)), "{none}");
}

/// A PNG of one pixel of 8 bits, with chunks before it.
fn png_with(chunks: &[([u8; 4], &[u8])], pixel: [u8; 3]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 1, 1);
    encoder.set_color(png::ColorType::Rgb);
    let mut writer = encoder.write_header().expect("a header");
    for (kind, body) in chunks {
        let kind = png::chunk::ChunkType(*kind);
        writer.write_chunk(kind, body).expect("a chunk");
    }
    writer.write_image_data(&pixel).expect("a pixel");
    drop(writer);
    bytes
}

fn gamma(value: u32) -> [u8; 4] {
    value.to_be_bytes()
}

fn chromaticities(places: [u32; 8]) -> Vec<u8> {
    places
        .iter()
        .flat_map(|place| place.to_be_bytes())
        .collect()
}

/// White, red, green and blue of Display P3 and of sRGB, in the order of cHRM.
const P3: [u32; 8] = [31_270, 32_900, 68_000, 32_000, 26_500, 69_000, 15_000, 6000];
const SRGB: [u32; 8] = [31_270, 32_900, 64_000, 33_000, 30_000, 60_000, 15_000, 6000];
/// sRGB's green in Display P3.
const GREEN: [u8; 3] = [117, 251, 76];

#[test]
fn the_marks_of_a_png_are_obeyed_by_their_precedence() {
    let colour = |chunks: &[([u8; 4], &[u8])], pixel: [u8; 3]| {
        let image = Image::read(&png_with(chunks, pixel)).expect("a picture");
        assert_eq!(image.unused_mark(), None);
        first(&image, 0).0
    };
    let grey = [128; 3];
    let (linear, power) = (gamma(100_000), gamma(55_556));
    let p3 = chromaticities(P3);
    let srgb = chromaticities(SRGB);
    let wide = [0.0, 1.0, 0.0];
    for (chunks, pixel, want) in [
        (&[][..], grey, [MIDDLE; 3]),
        (&[(*b"gAMA", &linear[..])], grey, [128.0 / 255.0; 3]),
        (
            &[(*b"gAMA", &power[..])],
            grey,
            [powf(128.0 / 255.0, 1.8) as f32; 3],
        ),
        (&[(*b"cHRM", &p3[..])], GREEN, wide),
        (&[(*b"cHRM", &srgb[..])], grey, [MIDDLE; 3]),
        (
            &[(*b"gAMA", &linear[..]), (*b"cHRM", &p3[..])],
            [45, 247, 18],
            [0.0, 1.0, 0.0],
        ),
        // sRGB comes before gAMA and cHRM, cICP before sRGB.
        (
            &[
                (*b"sRGB", &[0][..]),
                (*b"gAMA", &linear[..]),
                (*b"cHRM", &p3[..]),
            ],
            grey,
            [MIDDLE; 3],
        ),
        (&[(*b"cICP", &[12, 13, 0, 1][..])], GREEN, wide),
        (
            &[(*b"cICP", &[12, 13, 0, 1][..]), (*b"sRGB", &[0][..])],
            GREEN,
            wide,
        ),
        (&[(*b"cICP", &[1, 8, 0, 1][..])], grey, [128.0 / 255.0; 3]),
        // Numbers of video: white is 235.
        (&[(*b"cICP", &[1, 13, 0, 0][..])], [235; 3], [1.0; 3]),
        (&[(*b"cICP", &[1, 13, 0, 0][..])], [16; 3], [0.0; 3]),
    ] {
        let got = colour(chunks, pixel);
        let marks: Vec<_> = chunks.iter().map(|(kind, _)| kind).collect();
        println!("{marks:?} {got:?}, expected {want:?}");
        assert!(near(got, want, 0.02), "{got:?}");
    }
    assert!(
        !near([MIDDLE; 3], [128.0 / 255.0; 3], 0.02),
        "a fault would pass"
    );
}

/// A profile comes before sRGB's mark, and after cICP.
#[test]
fn a_profile_among_the_marks_of_a_png() {
    let (grey, wide) = ([128; 3], [0.0, 1.0, 0.0]);
    let icc = Profile::of(RgbSpace::DisplayP3).icc().to_vec();
    let profiled = |codes: Option<[u8; 4]>, pixel: [u8; 3]| {
        let mut bytes = Vec::new();
        let mut info = png::Info::with_size(1, 1);
        info.color_type = png::ColorType::Rgb;
        info.icc_profile = Some(icc.clone().into());
        let encoder = png::Encoder::with_info(&mut bytes, info).expect("an encoder");
        let mut writer = encoder.write_header().expect("a header");
        if let Some(codes) = codes {
            let kind = png::chunk::ChunkType(*b"cICP");
            writer.write_chunk(kind, &codes).expect("a chunk");
        }
        writer.write_image_data(&pixel).expect("a pixel");
        drop(writer);
        first(&Image::read(&bytes).expect("a picture"), 0).0
    };
    assert!(near(profiled(None, GREEN), wide, 0.02));
    let by_codes = profiled(Some([1, 8, 0, 1]), grey);
    assert!(near(by_codes, [128.0 / 255.0; 3], 0.01), "{by_codes:?}");
    // Unknown codes leave the colours to the profile, and are reported.
    assert!(near(profiled(Some([3, 3, 0, 1]), GREEN), wide, 0.02));
}

#[test]
fn marks_that_cannot_be_used_are_told_and_the_picture_is_srgb() {
    let no_gamut = chromaticities([31_270, 32_900, 1, 1, 1, 1, 1, 1]);
    let damaged = b"icc\0\0these bytes are not packed";
    for (kind, body, word) in [
        (*b"cICP", &[3, 13, 0, 1][..], "cICP"),
        (*b"gAMA", &[0, 0, 0, 0][..], "gAMA"),
        (*b"cHRM", &no_gamut[..], "cHRM"),
        (*b"iCCP", &damaged[..], "profile"),
    ] {
        let image = Image::read(&png_with(&[(kind, body)], [128; 3])).expect("a picture");
        let told = image.unused_mark().map(ToString::to_string);
        let told = told.unwrap_or_default();
        println!("{told}");
        assert!(told.contains(word), "{told}");
        assert!(near(first(&image, 0).0, [MIDDLE; 3], 1e-4));
    }
    // The standard leaves no other matrix.
    let other = Image::read(&png_with(&[(*b"cICP", &[1, 13, 1, 1])], [128; 3]));
    assert!(
        matches!(other, Err(ImportError::NotAPicture(_))),
        "{other:?}"
    );
}

#[test]
fn a_profile_that_unpacks_to_very_much_is_not_unpacked() {
    let mut bytes = Vec::new();
    let mut info = png::Info::with_size(1, 1);
    info.color_type = png::ColorType::Rgb;
    // Packed these are some 40 KB.
    info.icc_profile = Some(vec![0; 40 << 20].into());
    let encoder = png::Encoder::with_info(&mut bytes, info).expect("an encoder");
    let mut writer = encoder.write_header().expect("a header");
    writer.write_image_data(&[128; 3]).expect("a pixel");
    drop(writer);
    assert!(bytes.len() < 1 << 20);
    let image = Image::read(&bytes).expect("a picture");
    let told = image.unused_mark().map(ToString::to_string);
    assert!(told.is_some_and(|told| told.contains("32 MB")));
}

/// A TIFF of one row: tags that are no more than a number, then pixels.
fn tiff(width: u16, tags: &[(u16, &[u16])], pixels: &[u8]) -> Vec<u8> {
    let mut all: Vec<(u16, u16, u32, Vec<u8>)> = Vec::new();
    let mut add = |tag: u16, words: &[u16]| {
        let bytes = words.iter().flat_map(|word| word.to_le_bytes()).collect();
        all.push((tag, 3, words.len() as u32, bytes));
    };
    for (tag, words) in [(256, width), (257, 1), (259, 1), (278, 1)] {
        add(tag, &[words]);
    }
    tags.iter().for_each(|(tag, words)| add(*tag, words));
    add(279, &[pixels.len() as u16]);
    add(273, &[0]);
    all.sort_by_key(|(tag, ..)| *tag);
    let mut beyond = 8 + 2 + 12 * all.len() + 4;
    let mut file = b"II*\0\x08\0\0\0".to_vec();
    file.extend((all.len() as u16).to_le_bytes());
    let mut long = Vec::new();
    let strips = beyond
        + all
            .iter()
            .map(|(.., bytes)| bytes.len())
            .filter(|n| *n > 4)
            .sum::<usize>();
    for (tag, kind, count, bytes) in all {
        file.extend(tag.to_le_bytes());
        file.extend(kind.to_le_bytes());
        file.extend(count.to_le_bytes());
        let mut value = match tag {
            273 => (strips as u32).to_le_bytes().to_vec(),
            _ if bytes.len() > 4 => {
                let place = (beyond as u32).to_le_bytes().to_vec();
                beyond += bytes.len();
                long.extend(bytes);
                place
            }
            _ => bytes,
        };
        value.resize(4, 0);
        file.extend(value);
    }
    file.extend([0; 4]);
    file.extend(long);
    file.extend(pixels);
    file
}

/// Tags: numbers of a pixel, bits of each, kind of numbers (1 whole, 3 floats), kind of colours.
fn tiff_of(kind: [u16; 4], more: &[(u16, &[u16])], pixels: &[u8]) -> Result<Image, ImportError> {
    let [channels, bits, format, photometric] = kind;
    let (each, formats) = (
        [bits].repeat(channels.into()),
        [format].repeat(channels.into()),
    );
    let row = usize::from(channels) * usize::from(bits);
    let width = (pixels.len() * 8 / row) as u16;
    let mut tags: Vec<(u16, &[u16])> = vec![
        (258, &each),
        (262, std::slice::from_ref(&photometric)),
        (277, std::slice::from_ref(&channels)),
        (339, &formats),
    ];
    tags.extend(more);
    Image::read(&tiff(width, &tags, pixels))
}

#[test]
fn tiffs_of_floats_of_palettes_and_of_few_bits_are_read() {
    let floats = |values: &[f32]| -> Vec<u8> {
        values
            .iter()
            .flat_map(|value| value.to_le_bytes())
            .collect()
    };
    let halves = |values: &[f32]| -> Vec<u8> {
        let halves = values.iter().map(|value| half::f16::from_f32(*value));
        halves.flat_map(|value| value.to_le_bytes()).collect()
    };
    let got = |image: Result<Image, ImportError>| first(&image.expect("a picture"), 0).0;
    let light = [0.25; 3];
    assert_eq!(got(tiff_of([1, 32, 3, 1], &[], &floats(&[0.25]))), light);
    assert_eq!(got(tiff_of([1, 16, 3, 1], &[], &halves(&[0.25]))), light);
    let rgb = got(tiff_of([3, 16, 3, 2], &[], &halves(&[0.25, 0.5, 2.0])));
    assert_eq!(rgb, [0.25, 0.5, 1.0]);
    let doubles: Vec<u8> = [0.25f64; 3].iter().flat_map(|v| v.to_le_bytes()).collect();
    assert_eq!(got(tiff_of([3, 64, 3, 2], &[], &doubles)), light);
    let deep = 0x8080_0000u32.to_le_bytes();
    assert!(near(
        got(tiff_of([1, 32, 1, 1], &[], &deep)),
        [MIDDLE; 3],
        1e-4
    ));
    // Red, then green, then blue of all colours; index 1 is (255, 128, 0).
    let words = [0u16, 65_535, 0, 32_896, 0, 0];
    let orange = [1.0, MIDDLE, 0.0];
    for (bits, index) in [(1, 0b1000_0000), (2, 0b0100_0000), (4, 0x10), (8, 1)] {
        let mut map = vec![0u16; 3 << bits];
        for (colour, pair) in words.chunks_exact(2).enumerate() {
            map[colour << bits..][..2].copy_from_slice(pair);
        }
        let image = tiff_of([1, bits, 1, 3], &[(320, &map)], &[index]);
        assert!(near(got(image), orange, 1e-4), "{bits} bits");
    }
    let missing = tiff_of([1, 8, 1, 3], &[(320, &words)], &[9]).expect_err("no colour 9");
    assert!(missing.to_string().contains("palette"), "{missing}");
    assert!(tiff_of([1, 8, 1, 3], &[], &[1]).is_err(), "no palette");
    // Black is 1 here.
    assert_eq!(got(tiff_of([1, 1, 1, 0], &[], &[0b0111_1111])), [1.0; 3]);
    // Two of three pixels.
    let grey = got(tiff_of([1, 2, 1, 1], &[], &[0b1000_0000]));
    assert!(near(grey, [0.402; 3], 1e-3), "{grey:?}");
    let signed = tiff_of([1, 16, 2, 1], &[], &[1, 0]).expect_err("a sign");
    assert!(matches!(signed, ImportError::Unsupported(_)), "{signed}");
}

#[test]
fn colours_that_were_multiplied_by_their_opacity_are_divided_by_it() {
    let opacity = |kind: u16, pixel: [u8; 4]| {
        let image = tiff_of([4, 8, 1, 2], &[(338, &[kind])], &pixel).expect("a picture");
        first(&image, 0).0
    };
    let share = 128.0 / 255.0;
    let half_red = [1.0, 1.0 - share, 1.0 - share];
    assert!(near(opacity(1, [128, 0, 0, 128]), half_red, 1e-3));
    assert!(near(opacity(2, [255, 0, 0, 128]), half_red, 1e-3));
    assert!(!near(opacity(2, [128, 0, 0, 128]), half_red, 0.1));
    // Clear pixels are invisible, and colours brighter than white are white.
    assert_eq!(opacity(1, [0, 0, 0, 0]), [1.0; 3]);
    assert_eq!(opacity(1, [255, 255, 255, 7]), [1.0; 3]);
    let floats: Vec<u8> = [0.1f32, 0.0, 0.0, 0.5]
        .iter()
        .flat_map(|value| value.to_le_bytes())
        .collect();
    let image = tiff_of([4, 32, 3, 2], &[(338, &[1])], &floats).expect("a picture");
    assert!(near(first(&image, 0).0, [0.6, 0.5, 0.5], 1e-6));
    // A tooth: grey with opacity.
    let image = tiff_of([2, 8, 1, 1], &[(338, &[1])], &[64, 128]).expect("a picture");
    let height = first(&image, 0).1;
    assert!(
        (height - (0.5 * share + 1.0 - share)).abs() < 2e-3,
        "{height}"
    );
}

#[test]
fn a_pixel_that_is_no_number_is_told_with_its_place() {
    for (channels, values) in [
        (1, vec![0.5, f32::NAN]),
        (3, vec![0.5, 0.5, 0.5, 0.1, f32::NAN, 0.2]),
    ] {
        let pixels: Vec<u8> = values
            .iter()
            .flat_map(|value: &f32| value.to_le_bytes())
            .collect();
        let photometric = if channels == 1 { 1 } else { 2 };
        let error = tiff_of([channels, 32, 3, photometric], &[], &pixels).expect_err("NaN");
        assert!(matches!(error, ImportError::NotANumber(1, 0)), "{error}");
    }
    let bright: Vec<u8> = f32::INFINITY.to_le_bytes().repeat(3);
    let image = tiff_of([3, 32, 3, 2], &[], &bright).expect("a highlight");
    assert_eq!(first(&image, 0).0, [1.0; 3]);
}

#[test]
fn open_exr_is_light_by_its_chromaticities() {
    use exr::image::write::WritableImage as _;
    use exr::image::{Image as ExrImage, SpecificChannels};
    use exr::math::Vec2;
    let write = |primaries: Option<[f32; 8]>, pixel: (f32, f32, f32, f32)| {
        let channels = SpecificChannels::rgba(move |_: Vec2<usize>| pixel);
        let mut image = ExrImage::from_channels((2, 1), channels);
        image.attributes.chromaticities = primaries.map(|[wx, wy, rx, ry, gx, gy, bx, by]| {
            exr::meta::attribute::Chromaticities {
                red: Vec2(rx, ry),
                green: Vec2(gx, gy),
                blue: Vec2(bx, by),
                white: Vec2(wx, wy),
            }
        });
        let mut bytes = Cursor::new(Vec::new());
        image.write().to_buffered(&mut bytes).expect("written");
        Image::read(&bytes.into_inner())
    };
    let seen = |image: Result<Image, ImportError>| first(&image.expect("a picture"), 0).0;
    assert_eq!(seen(write(None, (0.25, 0.5, 3.0, 1.0))), [0.25, 0.5, 1.0]);
    assert!(near(
        seen(write(None, (0.1, 0.0, 0.0, 0.5))),
        [0.6, 0.5, 0.5],
        1e-6
    ));
    let p3 = P3.map(|place| place as f32 / 1e5);
    let green = (0.178, 0.965, 0.072, 1.0);
    assert!(near(seen(write(Some(p3), green)), [0.0, 1.0, 0.0], 0.02));
    assert!(!near(seen(write(None, green)), [0.0, 1.0, 0.0], 0.02));
    let nan = write(None, (f32::NAN, 0.0, 0.0, 1.0)).expect_err("NaN");
    assert!(matches!(nan, ImportError::NotANumber(0, 0)), "{nan}");
}
