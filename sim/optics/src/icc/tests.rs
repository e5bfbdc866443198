use proptest::prelude::*;

use super::*;
use crate::gamut::{Gamut, GamutMapping};

/// Adobe RGB (1998): a wider green, gamma 2.2, as photographers' displays have it.
fn photographers() -> Vec<u8> {
    ColorProfile::new_adobe_rgb().encode().expect("whole")
}

fn encoded(profile: &Profile, working: [f32; 3]) -> [u8; 3] {
    let gamut = Gamut::new(GamutMapping::Soft, profile.from_working());
    let mut bytes = [0; 3];
    profile.encode(&[gamut.map(working)], &mut bytes);
    bytes
}

/// Sum of the bytes by Fletcher's method.
fn checksum(bytes: &[u8]) -> u64 {
    let add = |(a, b): (u32, u32), byte: &u8| {
        let a = (a + u32::from(*byte)) % 65_521;
        (a, (b + a) % 65_521)
    };
    let (a, b) = bytes.iter().fold((1, 0), add);
    u64::from(b) << 16 | u64::from(a)
}

#[test]
fn our_profiles_have_the_same_bytes_everywhere() {
    for (space, length, sum) in [
        (RgbSpace::Srgb, 592, 2_509_267_793),
        (RgbSpace::DisplayP3, 604, 351_495_854),
    ] {
        let profile = Profile::of(space);
        let got = (profile.icc().len(), checksum(profile.icc()));
        println!("{space:?} {got:?}");
        assert_eq!(got, (length, sum));
    }
}

#[test]
fn a_space_read_back_from_its_profile_is_the_same_space() {
    for space in [RgbSpace::Srgb, RgbSpace::DisplayP3] {
        let own = Profile::of(space);
        let read = Profile::read(own.icc().to_vec()).expect("our own");
        let entries = own.from_working.iter().flatten();
        for (one, two) in entries.zip(read.from_working.iter().flatten()) {
            assert!((one - two).abs() < 2e-4, "{one} {two}");
        }
        for working in [
            [0.2, 0.5, 0.1],
            [0.9, 0.02, 0.01],
            [0.0; 3],
            [1.0; 3],
            [0.01, 0.003, 0.4],
        ] {
            let (one, two) = (encoded(&own, working), encoded(&read, working));
            let off = (0..3).map(|i| one[i].abs_diff(two[i])).max();
            assert!(off <= Some(1), "{one:?} {two:?}");
        }
        assert!(own.cube(5).is_none());
    }
    let srgb = encoded(&Profile::of(RgbSpace::Srgb), [0.9, 0.02, 0.01]);
    let wide = encoded(&Profile::of(RgbSpace::DisplayP3), [0.9, 0.02, 0.01]);
    assert!(
        srgb[0].abs_diff(wide[0]) > 5,
        "a fault would pass: {srgb:?} {wide:?}"
    );
}

#[test]
fn a_photographers_display_gets_its_own_numbers() {
    let profile = Profile::read(photographers()).expect("whole");
    // sRGB's green is (144, 255, 60) in Adobe RGB, and half-way grey (127.6 by gamma 2.2) stays grey.
    let mut bytes = [0; 6];
    let green = apply(profile.from_working(), [0.0, 1.0, 0.0]).map(|v| v as f32);
    profile.encode(&[green, [0.217_638; 3]], &mut bytes);
    println!("{bytes:?}");
    let expected = [144, 255, 60, 128, 128, 128];
    let off = |expected: [u8; 6]| (0..6).map(|i| bytes[i].abs_diff(expected[i])).max();
    assert!(off(expected) <= Some(1), "{bytes:?}");
    assert!(
        off([0, 255, 0, 128, 128, 128]) > Some(1),
        "a fault would pass"
    );
    // The cube agrees with the encoding of pictures.
    let cube = profile.cube(33).expect("foreign");
    assert_eq!(
        (cube.len(), cube[0], cube[33 * 33 * 33 - 1]),
        (35_937, [0.0; 3], [1.0; 3])
    );
    assert!(cube[32][0] > 0.99 && cube[32][1] < 0.01, "red is fastest");
}

#[test]
fn sixteen_bits_round_to_eight() {
    let ramp = |i: u32| {
        let [r, g, b] = [i, i * 7 % 1001, i * 13 % 1001];
        [r, g, b].map(|v| v as f32 / 1000.0)
    };
    let linear: Vec<[f32; 3]> = (0..=1000).map(ramp).collect();
    let read = || Profile::read(photographers()).expect("whole");
    for profile in [Profile::of(RgbSpace::Srgb), read()] {
        let (mut eight, mut sixteen) = (vec![0; 3003], vec![0; 3003]);
        profile.encode(&linear, &mut eight);
        profile.encode16(&linear, &mut sixteen);
        let off = |shift: f64| {
            let pair = |(byte, value): (&u8, &u16)| {
                (f64::from(*byte) - f64::from(*value) / 257.0 - shift).abs()
            };
            eight.iter().zip(&sixteen).map(pair).fold(0.0, f64::max)
        };
        println!("{:.3} of a step", off(0.0));
        assert!(off(0.0) < 0.56);
        assert!(off(0.1) > 0.56, "a fault would pass");
        let distinct: std::collections::BTreeSet<_> = sixteen.iter().collect();
        assert!(distinct.len() > 990, "{}", distinct.len());
    }
}

#[test]
fn what_is_no_profile_for_pictures_is_refused_with_its_reason() {
    let read = |bytes: &[u8]| Profile::read(bytes.to_vec()).expect_err("refused");
    let whole = photographers();
    for bytes in [
        &b""[..],
        b"PNG",
        &whole[..100],
        &whole[..whole.len() / 2],
        &[0; 4096],
    ] {
        let error = read(bytes);
        println!("{error}");
        assert!(matches!(error, ProfileError::Damaged(_)), "{error}");
    }
    let grey = ColorProfile::new_gray_with_gamma(2.2)
        .encode()
        .expect("whole");
    assert!(matches!(read(&grey), ProfileError::NotRgb(_)));
    // Primaries that are one colour.
    let mut flat = ColorProfile::new_adobe_rgb();
    (flat.green_colorant, flat.blue_colorant) = (flat.red_colorant, flat.red_colorant);
    assert!(matches!(
        read(&flat.encode().expect("bytes")),
        ProfileError::Damaged(_)
    ));
}

proptest! {
    #[test]
    fn no_mutation_of_a_profile_breaks_the_reader(
        places in prop::collection::vec((0usize..2000, any::<u8>()), 1..8),
        cut in 0usize..2000,
    ) {
        let mut bytes = photographers();
        for (at, value) in places {
            let length = bytes.len();
            bytes[at % length] = value;
        }
        if cut < 400 {
            bytes.truncate(cut);
        }
        if let Ok(profile) = Profile::read(bytes) {
            let [_, _, _] = encoded(&profile, [0.3, 0.2, 0.8]);
        }
    }
}
