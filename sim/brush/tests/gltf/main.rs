//! Brushes from glTF files that a small writer makes as Blender's exporter does.

mod faults;
mod model;

use maulstick_brush::file::sections::{Layout, Outline, Surface};
use maulstick_brush::{BrushFile, Head, gltf};
use serde_json::json;

use model::{AROUND, BONE_M, Model, RADIUS_M, RINGS};

fn read(model: &Model) -> BrushFile {
    gltf::read(&model.glb()).expect("a brush")
}

fn surface(brush: &BrushFile) -> &Surface {
    brush.surface.as_ref().expect("a skin")
}

/// True if numbers agree to single precision.
fn near(one: &[f64], other: &[f64]) -> bool {
    let close = |(a, b): (&f64, &f64)| (a - b).abs() <= 5.1e-6 * (1.0 + a.abs());
    one.len() == other.len() && one.iter().zip(other).all(close)
}

#[test]
fn spines_stand_and_bend_as_drawn() {
    let brush = read(&Model::round());
    let spines = &brush.spines;
    assert_eq!((spines.layout, spines.chains.len()), (Layout::Chains, 5));
    let radius = 1e3 * RADIUS_M;
    let roots = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];
    let length = 1e3 * BONE_M;
    for (chain, [x, y]) in spines.chains.iter().zip(roots) {
        let root = [x * radius, y * radius, 0.0];
        assert!(near(&chain.root_mm, &root), "{:?}", chain.root_mm);
        assert!(
            !near(&chain.root_mm, &[root[0] + 1e-4, root[1], 0.0]),
            "a fault would pass"
        );
        assert_eq!(chain.segments_mm.len(), 3);
        for segment in &chain.segments_mm {
            assert!(near(segment, &[0.0, 0.0, -length]), "{segment:?}");
        }
        // K = EI/l, doubled at the clamp; EI is 30, 25 and 20 N·mm².
        let stiffness = [2.0 * 30.0, 25.0, 20.0].map(|ei| ei / length);
        assert!(near(&chain.stiffness_n_mm, &stiffness), "{chain:?}");
        assert!(
            !near(&chain.stiffness_n_mm, &stiffness.map(|k| 1.001 * k)),
            "a fault would pass"
        );
        assert!(near(&chain.damping_n_mm, &stiffness.map(|k| 0.02 * k)));
    }
}

#[test]
fn the_skin_is_the_mesh_before_it_was_cut() {
    let model = Model::round();
    let brush = read(&model);
    let skin = surface(&brush);
    assert_eq!((skin.levels, skin.recede_mm), (2, 0.3));
    assert_eq!(skin.vertices_mm.len(), model.vertices.len());
    let quads = skin.faces.iter().filter(|face| face.len() == 4).count();
    assert!(quads >= AROUND * (RINGS.len() - 1), "{quads}");
    // Faces are written ring by ring, so a vertex is known by its place.
    let number = |at: &[f64; 3]| {
        let same = |v: &[f32; 3]| near(&v.map(|m| 1e3 * f64::from(m)), at);
        model.vertices.iter().position(same).expect("a vertex")
    };
    let numbers: Vec<usize> = skin.vertices_mm.iter().map(number).collect();
    let mut whole: Vec<Vec<usize>> = model.faces.clone();
    let turned = |mut face: Vec<usize>| {
        let least = face.iter().enumerate().min_by_key(|(_, v)| **v);
        let least = least.map_or(0, |(i, _)| i);
        face.rotate_left(least);
        face
    };
    whole.truncate(AROUND * (RINGS.len() - 1));
    for (drawn, found) in whole.into_iter().zip(&skin.faces) {
        let found = found.iter().map(|v| numbers[*v]).collect();
        assert_eq!(turned(found), turned(drawn));
    }
    for (tied, number) in skin.weights.iter().zip(&numbers) {
        let [(outer, _), (root, _)] = model.weights[*number][..] else {
            panic!("two bones");
        };
        // The root bone is bone 0 and no joint; both weights were .75.
        let expected = [(usize::from(root) - 1, 0.5), (usize::from(outer) - 1, 0.5)];
        assert_eq!(tied[..], expected);
    }
}

#[test]
fn the_head_is_measured_and_the_rest_is_said() {
    let brush = read(&Model::round());
    let head = &brush.head;
    assert_eq!(head.outline, Outline::Round);
    assert!((head.length_mm - 24.0).abs() < 1e-3, "{}", head.length_mm);
    assert!(
        head.width_mm < 10.0 && head.width_mm > 9.0,
        "{}",
        head.width_mm
    );
    assert!((head.thickness_mm.expect("one") / head.width_mm - 1.0).abs() < 1e-6);
    let share = |place: f64| {
        let after = head.profile.iter().find(|[at, _]| *at >= place);
        after.expect("a place")[1]
    };
    assert_eq!(head.profile.len(), 9);
    for (place, expected) in [(0.0, 0.8), (0.25, 1.0), (0.5, 0.9), (0.75, 0.6), (1.0, 0.2)] {
        assert!(
            (share(place) - expected).abs() < 1e-3,
            "{place}: {}",
            share(place)
        );
    }
    assert_eq!((brush.kind.as_str(), brush.strips.count), ("modelled", 200));
    assert_eq!(
        brush.contact.friction, 0.3,
        "the mesh goes before its armature"
    );
    assert_eq!(brush.contact.friction_static, None, "sticks as it slides");
    assert_eq!(brush.load.film_um, 150.0, "the armature says it");
}

#[test]
fn it_is_as_long_as_its_mesh_or_its_spines() {
    let length = |change: fn(&mut Model)| {
        let mut model = Model::round();
        change(&mut model);
        read(&model).head.length_mm
    };
    let mesh = length(|model| model.vertices.iter_mut().for_each(|at| at[2] *= 1.25));
    assert!((mesh - 30.0).abs() < 1e-4, "{mesh}");
    let spine = length(|model| model.bones[6].extras["length_m"] = json!(12e-3));
    assert!((spine - 28.0).abs() < 1e-4, "{spine}");
}

#[test]
fn what_a_model_does_not_say_is_as_in_a_round_of_its_width() {
    let mut model = Model::round();
    for bone in &mut model.bones {
        let length = bone.extras.get("length_m").cloned();
        bone.extras = length.map_or(json!(null), |m| json!({ "length_m": m }));
    }
    (model.object, model.armature) = (json!(null), json!({ "author": "someone" }));
    let brush = read(&model);
    let round = BrushFile::library("round").expect("round");
    let round = round.scaled_to(brush.head.width_mm).expect("as wide");
    assert_eq!(
        (&brush.strips, &brush.contact, &brush.load),
        (&round.strips, &round.contact, &round.load)
    );
    assert_eq!(brush.spines.volume, round.spines.volume);
    assert_eq!(brush.kind, "Head");
    for chain in &brush.spines.chains {
        let ei = round.spines.bending_stiffness_n_mm2 / 5.0;
        let k = 2.0 * ei / chain.segments_mm[0][2].abs();
        assert!((chain.stiffness_n_mm[0] / k - 1.0).abs() < 1e-9);
        let share = chain.stiffness_n_mm[2] / (0.5 * k);
        let there = 2.0 / 3.0;
        let last = -chain.segments_mm[2][2] / 8.0;
        assert!(
            (share * last - round.stiffness_share(there)).abs() < 1e-2,
            "{share}"
        );
        let damping = chain.damping_n_mm[1] / chain.stiffness_n_mm[1];
        assert!((damping - round.spines.damping).abs() < 1e-12);
    }
}

#[test]
fn a_last_bone_without_length_ends_where_its_vertices_do() {
    let mut model = Model::round();
    model
        .bones
        .iter_mut()
        .for_each(|bone| bone.extras = json!(null));
    for (vertex, weights) in model.weights.iter_mut().enumerate() {
        *weights = vec![(
            1 + 3 * (vertex % 5) as u8 + (vertex / AROUND / 2) as u8,
            1.0,
        )];
    }
    // Vertices that follow the middle spine's last bone, bone 3, go 7 mm beyond its head.
    let deep = 16e-3 + 7e-3;
    for (at, weights) in model.vertices.iter_mut().zip(&model.weights) {
        if weights[0].0 == 3 {
            at[2] = at[2].max(-deep as f32);
        }
    }
    let brush = read(&model);
    let last = brush.spines.chains[0].segments_mm[2];
    assert!(near(&last, &[0.0, 0.0, -7.0]), "{last:?}");
}

#[test]
fn what_follows_the_root_bone_goes_with_the_nearest_spine() {
    let mut model = Model::round();
    for weights in model.weights.iter_mut().take(AROUND) {
        *weights = vec![(0, 1.0)];
    }
    let brush = read(&model);
    let skin = surface(&brush);
    let top = skin.vertices_mm.iter().zip(&skin.weights);
    let mut seen = std::collections::BTreeSet::new();
    for (at, weights) in top.filter(|(at, _)| at[2] == 0.0) {
        let roots = brush.spines.chains.iter().map(|chain| chain.root_mm);
        let away = |root: [f64; 3]| (root[0] - at[0]).abs() + (root[1] - at[1]).abs();
        let distances: Vec<f64> = roots.map(away).collect();
        let nearest = distances.iter().copied().fold(f64::MAX, f64::min);
        assert_eq!((weights.len(), weights[0].0 % 3), (1, 0));
        assert!((distances[weights[0].0 / 3] - nearest).abs() < 1e-3);
        seen.insert(weights[0].0 / 3);
    }
    assert!(seen.len() == 4 && !seen.contains(&0), "{seen:?}");
}

#[test]
fn it_does_not_matter_where_the_armature_stands_nor_how_the_file_is_written() {
    let model = Model::round();
    let brush = read(&model);
    assert_eq!(gltf::read(&model.gltf()).expect("embedded"), brush);
    // Where the mesh hangs in the tree does not matter to a skin.
    let (mut json, bytes) = model.parts();
    json["nodes"][0]["children"] = json!([2]);
    json["nodes"][3]["children"] = json!([4, 1]);
    let hung = gltf::read(&model::glb(&json, &bytes)).expect("hung elsewhere");
    assert_eq!(hung, brush);
    let mut moved = model.clone();
    (moved.scale, moved.shift, moved.quarter_turns) = (0.01, [0.3, -0.2, 0.1], 3);
    let other = read(&moved);
    let flat = |brush: &BrushFile| {
        let chains = brush.spines.chains.iter();
        let mut all: Vec<f64> = chains
            .flat_map(|c| [&[c.root_mm][..], &c.segments_mm].concat())
            .flatten()
            .collect();
        all.extend(surface(brush).vertices_mm.iter().flatten());
        all.push(brush.head.width_mm);
        all
    };
    let apart = |a: &BrushFile, b: &BrushFile| {
        let pairs = flat(a).into_iter().zip(flat(b));
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    };
    // Single precision a third of a metre from the origin.
    assert!(apart(&brush, &other) < 1e-4, "{}", apart(&brush, &other));
    assert_eq!(surface(&brush).faces, surface(&other).faces);
    moved.bones[5].head[0] += 2e-6;
    assert!(apart(&brush, &read(&moved)) > 1e-4, "a fault would pass");
}

#[test]
fn a_mirrored_armature_keeps_the_skin_outside() {
    let (mut json, bytes) = Model::round().parts();
    json["nodes"][0]["scale"] = json!([-1.0, 1.0, 1.0]);
    let brush = gltf::read(&model::glb(&json, &bytes)).expect("mirrored");
    let skin = surface(&brush);
    let at = |v: usize| glam::DVec3::from_array(skin.vertices_mm[v]);
    for face in skin.faces.iter().filter(|face| face.len() == 4) {
        let out = (at(face[2]) - at(face[0])).cross(at(face[3]) - at(face[1]));
        assert!(out.dot(at(face[0]) - glam::DVec3::Z) > 0.0);
    }
}

#[test]
fn a_brush_without_a_root_bone_is_the_same() {
    let model = Model::round();
    let mut free = model.clone();
    free.bones.remove(0);
    for bone in &mut free.bones {
        bone.parent = bone.parent.and_then(|parent| parent.checked_sub(1));
    }
    for weights in free.weights.iter_mut().flatten() {
        weights.0 -= 1;
    }
    assert_eq!(read(&free).surface, read(&model).surface);
}

#[test]
fn a_file_of_it_is_read_back_to_the_same_brush() {
    let brush = read(&Model::round());
    let text = brush.to_toml().expect("text");
    assert_eq!(BrushFile::parse(&text), Ok(brush.clone()));
    let double = brush.scaled_to(2.0 * brush.head.width_mm).expect("scaled");
    assert_eq!(double.check(), Ok(()));
    let head = Head::of(&brush);
    assert_eq!(head.strips(), 200);
}
