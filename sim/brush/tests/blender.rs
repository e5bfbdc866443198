//! The real Blender, as its Python package: model, check, export, load, stroke.
//!
//! `./test --long` makes the environment `target/bpy-venv` with the package `bpy`.

mod desk;

use std::path::{Path, PathBuf};
use std::process::Command;

use maulstick_brush::file::sections::Surface;
use maulstick_brush::{BrushFile, BrushModel, gltf};
use maulstick_types::Origin;
use maulstick_types::brush::{Solve, solve_flags};
use maulstick_types::stylus::{DEFAULT_TILT_RAD, StylusPose, StylusSample};

use desk::scene;

const NEEDS_BLENDER: &str = "no target/bpy-venv/bin/python; ./test --long makes it";

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Runs a script in Blender's Python.
fn blender(script: &Path, arguments: &[&Path]) {
    let python = root().join("target/bpy-venv/bin/python");
    let mut command = Command::new(python);
    // Without a cache beside the scripts.
    let output = command.arg("-B").arg(script).args(arguments).output();
    let output = output.expect(NEEDS_BLENDER);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{}: {said}", script.display());
}

/// A fresh folder for the files of a test.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    if folder.exists() {
        std::fs::remove_dir_all(&folder).expect("removed");
    }
    std::fs::create_dir_all(&folder).expect("made");
    folder
}

fn read(path: &Path) -> Result<BrushFile, gltf::GltfError> {
    gltf::read(&std::fs::read(path).expect("written"))
}

/// The round brush of `tools/blender/model_round.py`.
fn round(name: &str) -> BrushFile {
    let path = folder(name).join("round.glb");
    blender(&root().join("tools/blender/model_round.py"), &[&path]);
    read(&path).expect("a brush")
}

fn surface(brush: &BrushFile) -> &Surface {
    brush.surface.as_ref().expect("a skin")
}

/// The greatest difference of two lists of numbers, infinite where one is longer.
fn apart(one: &[f64], other: &[f64]) -> f64 {
    let differences = one.iter().zip(other).map(|(a, b)| (a - b).abs());
    if one.len() == other.len() {
        differences.fold(0.0, f64::max)
    } else {
        f64::INFINITY
    }
}

#[test]
#[ignore = "needs Blender's Python package: ./test --long"]
fn a_model_is_the_brush_that_was_drawn() {
    let brush = round("drawn");
    assert_eq!(brush.kind, "modelled");
    assert_eq!((brush.contact.friction, brush.strips.count), (0.3, 384));
    let chains = &brush.spines.chains;
    let roots = [[0.0, 0.0], [3.0, 0.0], [0.0, 3.0], [-3.0, 0.0], [0.0, -3.0]];
    assert_eq!(chains.len(), roots.len());
    for (spine, (chain, [x, y])) in chains.iter().zip(roots).enumerate() {
        assert!(apart(&chain.root_mm, &[x, y, 0.0]) < 1e-5, "{chain:?}");
        for segment in &chain.segments_mm {
            assert!(apart(segment, &[0.0, 0.0, -8.0]) < 1e-5, "{segment:?}");
            assert!(
                apart(segment, &[0.0, 0.0, -8.001]) > 1e-5,
                "a fault would pass"
            );
        }
        // The middle spine was set to 40 N·mm², the others up as a round's that is 10 mm wide: 190
        // among five, less .55 of it to the point.
        let ei = match spine {
            0 => [40.0; 3],
            _ => [0.0, 1.0, 2.0].map(|i| 38.0 * (1.0 - 0.55 * i / 3.0)),
        };
        let k = [2.0 * ei[0] / 8.0, ei[1] / 8.0, ei[2] / 8.0];
        assert!(apart(&chain.stiffness_n_mm, &k) < 1e-5, "{chain:?}");
        assert!(apart(&chain.damping_n_mm, &k.map(|k| 0.01 * k)) < 1e-7);
    }
    let head = &brush.head;
    // A cubic B-spline through twelve points of a circle runs within it by (2 + cos 30°)/3, and the
    // widest ring lies between smaller ones.
    assert!((9.0..9.56).contains(&head.width_mm), "{}", head.width_mm);
    assert!((head.length_mm - 24.0).abs() < 1e-4);
    assert!((head.profile[2][1] - 1.0).abs() < 1e-5 && head.profile[8][1] < 0.21);
    let skin = surface(&brush);
    assert_eq!(skin.vertices_mm.len(), 60);
    let quads = skin.faces.iter().filter(|face| face.len() == 4).count();
    assert!(quads >= 48, "{quads}");
    // What is widest follows the spine on that side most, and the point that in the middle.
    let follows = |at: [f64; 3]| {
        let vertex = skin.vertices_mm.iter().position(|v| apart(v, &at) < 1e-5);
        let weights = &skin.weights[vertex.expect("a vertex")];
        assert!((weights.iter().map(|(_, share)| share).sum::<f64>() - 1.0).abs() < 1e-9);
        let most = weights.iter().max_by(|a, b| a.1.total_cmp(&b.1));
        most.expect("weights").0
    };
    assert_eq!(follows([5.0, 0.0, -6.0]), 3);
    assert_eq!(follows([0.0, -4.5, -12.0]), 13);
    assert_eq!(follows([1.0, 0.0, -24.0]), 2);
}

/// Segments and vertices of a brush, mm.
fn numbers(brush: &BrushFile) -> Vec<f64> {
    let chains = brush.spines.chains.iter();
    let segments = chains.flat_map(|chain| chain.segments_mm.as_flattened());
    let vertices = surface(brush).vertices_mm.as_flattened();
    segments.chain(vertices).copied().collect()
}

#[test]
#[ignore = "needs Blender's Python package: ./test --long"]
fn the_add_on_and_the_loader_agree_on_what_is_a_brush() {
    let folder = folder("models");
    let script = root().join("sim/brush/tests/blender/models.py");
    blender(&script, &[&root().join("tools/blender"), &folder]);
    let found = std::fs::read_to_string(folder.join("found.json")).expect("written");
    let found: std::collections::BTreeMap<String, Vec<String>> =
        serde_json::from_str(&found).expect("json");
    // Words that both say.
    let faults = [
        ("unweighted", ["2 vertices of 'Head'", "no weights"]),
        ("branching", ["spine1.1", "branches"]),
        ("too_many_joints", ["long.0", "65 bones"]),
        ("too_many_spines", ["25 spines", "24"]),
        ("zero_length", ["spine2.1", "no length"]),
        ("upside_down", ["spine0.0", "does not hang along -Z"]),
        ("much_too_large", ["the head's", "mm, but must be"]),
        (
            "misspelt",
            ["'stifness' of 'spine3.0'", "did you mean 'stiffness'"],
        ),
        ("misplaced", ["'friction' of 'ferrule'", "on the object"]),
        (
            "negative",
            ["'stiffness' of 'spine4.2' is -1", "but must be"],
        ),
        ("slippery", ["friction_static", "friction"]),
        (
            "two_strips_and_a_half",
            ["'strips' of 'Head' is 2.5", "1 to 4096"],
        ),
    ];
    for (name, words) in faults {
        let said = found[name].join("\n");
        let refused = read(&folder.join(format!("{name}.glb")))
            .expect_err(name)
            .to_string();
        for word in words {
            assert!(said.contains(word), "the add-on on {name}: {said}");
            assert!(refused.contains(word), "the loader on {name}: {refused}");
        }
    }
    let mut good: Vec<&String> = found.keys().collect();
    good.retain(|name| faults.iter().all(|(fault, _)| fault != name));
    assert_eq!(good, ["as_blender_writes_it", "in_millimetres"]);
    let reference = round("reference");
    for name in good {
        assert_eq!(found[name], Vec::<String>::new(), "{name}");
        let brush = read(&folder.join(format!("{name}.glb"))).expect(name);
        assert!(
            apart(&numbers(&brush), &numbers(&reference)) < 1e-3,
            "{name}"
        );
        assert_eq!(surface(&brush).faces, surface(&reference).faces, "{name}");
        assert!((brush.head.width_mm - reference.head.width_mm).abs() < 1e-3);
    }
}

/// The solves of a stroke of 30 mm to the right at a pressure, and the greatest force, N.
fn stroke(brush: &BrushFile, pressure: f64) -> (Vec<Solve>, f64) {
    let mut model = BrushModel::new(brush.clone(), 0.5);
    model.set_scene(&scene());
    let origin = Origin {
        source: 1,
        epoch: 1,
    };
    let mut force = 0.0f64;
    let solves = (0..40u64).flat_map(|i| {
        let pose = StylusPose::Contact {
            point_m: [7.5e-4 * i as f64 - 0.015, 0.0, 0.0],
            tilt_rad: DEFAULT_TILT_RAD,
            twist_rad: 0.0,
            pressure,
        };
        let sample = StylusSample {
            pose,
            in_range: true,
            ..StylusSample::away()
        };
        let solves = model.follow(origin, 1_000_000_000 + 8_000_000 * i, &sample);
        force = force.max(model.force_n());
        solves
    });
    (solves.collect(), force)
}

#[test]
#[ignore = "needs Blender's Python package: ./test --long"]
fn it_bends_and_touches_in_a_stroke() {
    let brush = round("stroke");
    let bend = |solve: &Solve| {
        let angles = solve.angles_rad.iter().flatten();
        angles.fold(0.0f32, |most, angle| most.max(angle.abs()))
    };
    let (pressed, force) = stroke(&brush, 0.7);
    assert!(
        pressed.len() > 100,
        "a solve for each cell: {}",
        pressed.len()
    );
    for solve in &pressed {
        assert_eq!(solve.flags & solve_flags::NOT_CONVERGED, 0, "{solve:?}");
        assert_eq!(solve.angles_rad.len(), brush.spines.all_joints());
    }
    let last = pressed.last().expect("solves");
    assert!(!last.contacts.is_empty() && last.stroke == 1);
    assert!(bend(last) > 0.3, "{}", bend(last));
    assert!(force > 0.02 && force < 5.0, "{force} N");
    // A brush held above touches nothing, and a stiffer one pushes more.
    let (above, none) = stroke(&brush, 0.0);
    assert!(above.iter().all(|solve| solve.contacts.is_empty()) && none == 0.0);
    let mut stiff = brush.clone();
    for chain in &mut stiff.spines.chains {
        chain.stiffness_n_mm.iter_mut().for_each(|k| *k *= 2.0);
    }
    assert!(stroke(&stiff, 0.7).1 > 1.5 * force);
}
