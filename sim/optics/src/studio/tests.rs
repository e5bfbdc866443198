//! Films on planes beside the plain formula, and paints that look like their names.

use super::*;
use crate::paints::PaintLibrary;

fn studio(names: &[&str]) -> Studio {
    let library = PaintLibrary::measured().expect("whole");
    let mut studio = Studio::daylight();
    for name in names {
        studio.add(library.find(name).expect("known"));
    }
    studio
}

fn shade(studio: &Studio, thickness: [f32; 2], ground: f32) -> [f32; 3] {
    let planes = thickness.map(|d| vec![d; 130]);
    let paints = [(0, planes[0].as_slice()), (1, planes[1].as_slice())];
    let ground = vec![ground; studio.wavelengths()];
    let mut rgb = [const { [0.0f32; 130] }; 3];
    let [r, g, b] = &mut rgb;
    studio.shade(
        &FilmPlanes {
            paints: &paints,
            opacity: 1.0,
            under: Under::Even(&ground),
        },
        [r, g, b],
    );
    assert!(rgb.iter().all(|plane| plane.iter().all(|v| *v == plane[0])));
    rgb.map(|plane| plane[129])
}

#[test]
fn planes_agree_with_the_plain_formula() {
    let studio = studio(&["Ultramarine Blue", "Yellow Ochre"]);
    let ground = vec![0.9f32; studio.wavelengths()];
    for (a, b) in [
        (0.0, 0.0),
        (1e-6, 0.0),
        (2e-5, 1e-5),
        (1e-4, 3e-4),
        (0.0, 5e-3),
    ] {
        let exact = studio.colour(&[(0, a), (1, b)], &ground);
        let got = shade(&studio, [a as f32, b as f32], 0.9);
        for (got, exact) in got.iter().zip(exact) {
            let error = (f64::from(*got) + studio.surface.k1 - exact).abs();
            assert!(error < 3e-6, "{a} {b}: {got} {exact}");
            assert!((error - 3e-5).abs() > 3e-6, "a fault would pass");
        }
    }
}

#[test]
fn paints_look_like_their_names() {
    let studio = studio(&[
        "Ultramarine Blue",
        "Hansa Yellow Opaque",
        "Yellow Ochre",
        "Titanium White",
    ]);
    let black = vec![0.0f32; studio.wavelengths()];
    let opaque = |slot: usize| studio.colour(&[(slot, 0.01)], &black);
    let [r, g, b] = opaque(0);
    assert!(
        b > 2.0 * r && b > 2.0 * g,
        "ultramarine is blue: {r} {g} {b}"
    );
    let [r, g, b] = opaque(1);
    assert!(
        r > 4.0 * b && g > 4.0 * b,
        "hansa yellow is yellow: {r} {g} {b}"
    );
    let lightness = studio.lab(&[(2, 0.01)], &black)[0];
    assert!(
        (lightness - 55.0).abs() < 2.5,
        "yellow ochre's L* is 55, not {lightness}"
    );
    let [r, g, b] = opaque(3);
    assert!(
        r > 0.85 && (r - b).abs() < 0.12 && (r - g).abs() < 0.05,
        "white: {r} {g} {b}"
    );
    let [r, g, b] = studio.colour(&[(0, 0.005), (1, 0.005)], &black);
    assert!(
        g > 1.2 * r && g > 1.2 * b,
        "blue and yellow make green: {r} {g} {b}"
    );
}

/// Thickness planes of the layers of a stack, in metres, from the lowest; of both paints.
fn layers() -> Vec<[Vec<f32>; 2]> {
    let cells = 130;
    let plane = |scale: f32, phase: usize| -> Vec<f32> {
        (0..cells)
            .map(|i| scale * ((i * 7 + phase) % 13) as f32)
            .collect()
    };
    vec![
        [plane(4e-6, 0), plane(0.0, 0)],
        [plane(1e-6, 5), plane(9e-6, 2)],
        [plane(0.0, 0), plane(2e-7, 7)],
        [plane(3e-5, 1), plane(1e-5, 9)],
    ]
}

/// Greatest distance of baked layers under a last wet film from films composed in f64 (Baxter 2004, eq. 7.11), linear
/// sRGB. `fault` scales the opacity given to the planes.
fn off_from_composed(fault: f32) -> f64 {
    let studio = studio(&["Ultramarine Blue", "Titanium White"]);
    let opacity = [1.0f32, 0.5, 1.0, 1.0];
    let ground = vec![0.6f32; studio.wavelengths()];
    let stack = layers();
    let mut baked: Option<Vec<f32>> = None;
    let mut rgb = [const { [0.0f32; 130] }; 3];
    for (number, layer) in stack.iter().enumerate() {
        let paints = [(0, layer[0].as_slice()), (1, layer[1].as_slice())];
        let films = FilmPlanes {
            paints: &paints,
            opacity: opacity[number] * fault,
            under: baked
                .as_ref()
                .map_or(Under::Even(&ground), |planes| Under::Planes(planes)),
        };
        if number + 1 < stack.len() {
            baked = Some(studio.bake(&films, 130));
        } else {
            let [r, g, b] = &mut rgb;
            studio.shade(&films, [r, g, b]);
        }
    }
    let mut worst = 0.0f64;
    for cell in 0..130 {
        let reflectance: Vec<f64> = (0..studio.wavelengths())
            .map(|sample| {
                let mut under = f64::from(ground[sample]);
                for (layer, opacity) in stack.iter().zip(opacity) {
                    let sum = |which: usize| -> f64 {
                        let slot = |slot: usize| {
                            let per_m = f64::from(studio.paint(slot)[sample][which]);
                            per_m * f64::from(layer[slot][cell])
                        };
                        f64::from(opacity) * (slot(0) + slot(1))
                    };
                    under = km::over(km::film(sum(0), sum(1)), under);
                }
                studio.surface.leaving(under)
            })
            .collect();
        let exact = apply(&studio.to_rgb, studio.rule.xyz(&reflectance));
        for (got, exact) in rgb.iter().zip(exact) {
            worst = worst.max((f64::from(got[cell]) - exact).abs());
        }
    }
    worst
}

#[test]
fn baked_layers_are_films_one_over_the_other() {
    let off = off_from_composed(1.0);
    println!("{off:e}");
    assert!(off < 5e-6, "{off:e}");
    let fault = off_from_composed(1.001);
    assert!(fault > 5e-5, "a fault would pass: {fault:e}");
}

#[test]
fn without_adaptation_lamp_light_is_yellow() {
    let library = PaintLibrary::measured().expect("whole");
    let white = |adapted: bool| {
        let settings = StudioSettings {
            light: Illuminant::named("A").expect("known"),
            adapted,
            samples: 8,
            ..StudioSettings::default()
        };
        let studio = Studio::new(&settings, library.paints());
        studio.colour(&[], &vec![1.0; studio.wavelengths()])
    };
    assert!(
        white(true)
            .iter()
            .all(|channel| (channel - 1.0).abs() < 1e-9)
    );
    let [r, g, b] = white(false);
    assert!(r > 1.5 && b < 0.5 && g < r, "{r} {g} {b}");
}
