//! Colours of mixtures beside the colorimetry crate, which has its own tables of the CIE at 1 nm.

use colorimetry::colorant::Colorant;
use colorimetry::illuminant::CieIlluminant;
use colorimetry::observer::Observer as PeerObserver;
use colorimetry::spectrum::Spectrum as PeerSpectrum;
use maulstick_optics::spectrum::wavelength;
use maulstick_optics::{
    Blend, Coat, Illuminant, Layer, Observer, PaintLibrary, RuleKind, Spectrum, StudioSettings,
    Viewing,
};

const MIXTURES: [&str; 6] = [
    "Titanium White",
    "Bone Black",
    "Cobalt Blue=0.5,Hansa Yellow Opaque=0.5",
    "Titanium White=0.98,Phthalo Blue Green Shade=0.02",
    "Quinacridone Magenta=0.8,Titanium White=0.2",
    "Burnt Sienna=0.3,Ultramarine Blue=0.2,Titanium White=0.5",
];

/// XYZ (Y = 100) and Lab.
type Colour = [[f64; 3]; 2];

fn peer(reflectance: &Spectrum, observer: PeerObserver, light: CieIlluminant) -> Colour {
    let nm: Vec<f64> = (0..reflectance.0.len()).map(wavelength).collect();
    let spectrum = PeerSpectrum::linear_interpolate(&nm, &reflectance.0).expect("rising");
    let colorant = Colorant::new(spectrum).expect("0 to 1");
    let xyz = observer.rel_xyz(&light, &colorant).xyz().to_array();
    [xyz, observer.lab(&light, &colorant).to_array()]
}

fn own(blend: &Blend, coat: &Coat, observer: Observer, light: &str) -> Colour {
    let settings = StudioSettings {
        light: Illuminant::named(light).expect("known"),
        observer,
        rule: RuleKind::Reference,
        ..StudioSettings::default()
    };
    let seen = Viewing::new(&settings, &[]).coat(blend, coat);
    [seen.xyz.map(|value| 100.0 * value), seen.lab]
}

/// The greatest differences of XYZ and of Lab.
fn off(one: &Colour, two: &Colour) -> [f64; 2] {
    [0, 1].map(|kind| {
        let pairs = one[kind].iter().zip(two[kind]);
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    })
}

#[test]
fn mixtures_have_the_colours_of_the_peer() {
    let library = PaintLibrary::measured().expect("whole");
    let film = Coat {
        layer: Layer::Film {
            thickness_m: 25e-6,
            thinner: 0.0,
            ground: 1.0,
        },
        ..Coat::masstone()
    };
    let mut worst = [0.0f64; 2];
    for mixture in MIXTURES {
        let blend = Blend::of(&library, &mixture.parse().expect("a mixture")).expect("known");
        for coat in [Coat::masstone(), film] {
            for (name, light) in [
                ("A", CieIlluminant::A),
                ("D50", CieIlluminant::D50),
                ("D65", CieIlluminant::D65),
            ] {
                for (observer, other) in [
                    (Observer::Cie1931, PeerObserver::Cie1931),
                    (Observer::Cie1964, PeerObserver::Cie1964),
                ] {
                    let ours = own(&blend, &coat, observer, name);
                    let theirs = peer(&blend.reflectance(&coat), other, light);
                    let off = off(&ours, &theirs);
                    worst = [0, 1].map(|kind| worst[kind].max(off[kind]));
                }
            }
        }
    }
    println!(
        "XYZ differ by at most {:.4}, Lab by {:.4}",
        worst[0], worst[1]
    );
    // The difference between sums at 4 nm and at 1 nm.
    assert!(worst[0] < 0.1 && worst[1] < 0.1, "{worst:?}");
    let blend = Blend::of(&library, &MIXTURES[2].parse().expect("a mixture")).expect("known");
    let coat = Coat::masstone();
    let ours = own(&blend, &coat, Observer::Cie1931, "D65");
    let theirs = peer(
        &blend.reflectance(&coat),
        PeerObserver::Cie1964,
        CieIlluminant::D65,
    );
    let [xyz, lab] = off(&ours, &theirs);
    assert!(xyz > 0.1 && lab > 0.1, "another observer would pass");
}
