//! Errors of a model name the node and the field.

use maulstick_brush::gltf;
use proptest::prelude::*;
use serde_json::{Value, json};

use super::model::{Model, glb};

/// The error of a model with a fault.
fn error(spoil: impl FnOnce(&mut Model)) -> String {
    let mut model = Model::round();
    spoil(&mut model);
    refused(&model.glb())
}

/// The error of a file with a fault.
fn error_of(spoil: impl FnOnce(&mut Value, &mut Vec<u8>)) -> String {
    let (mut json, mut bytes) = Model::round().parts();
    spoil(&mut json, &mut bytes);
    refused(&glb(&json, &bytes))
}

fn refused(bytes: &[u8]) -> String {
    gltf::read(bytes).expect_err("a fault").to_string()
}

#[track_caller]
fn says(error: &str, words: &[&str]) {
    for word in words {
        assert!(error.contains(word), "'{word}' is not in: {error}");
    }
}

#[test]
fn the_model_itself_is_good() {
    gltf::read(&Model::round().glb()).expect("no fault");
}

#[test]
fn a_file_that_is_none() {
    for bytes in [
        &b""[..],
        b"no",
        b"{}",
        b"[1, 2]",
        b"\x89PNG\r\n\x1a\n",
        b"{\"asset\": {}}",
    ] {
        says(&refused(bytes), &["not a readable glTF 2.0 file", ".glb"]);
    }
    let mut old = Model::round().glb();
    old[4] = 1;
    says(&refused(&old), &["not a readable glTF 2.0", "version"]);
    let needs = |name: &str| error_of(|json, _| json["extensionsRequired"] = json!([name]));
    says(
        &needs("KHR_draco_mesh_compression"),
        &["extensionsRequired", "draco"],
    );
}

#[test]
fn a_file_that_is_cut_short() {
    let whole = Model::round().glb();
    for length in [4, 11, 12, 20, 1000, whole.len() - 1] {
        says(
            &refused(&whole[..length]),
            &["cut short", &length.to_string()],
        );
    }
    let missing = error_of(|json, bytes| {
        json["buffers"][0]["byteLength"] = json!(bytes.len() + 5);
    });
    says(&missing, &["cut short", "buffer 0"]);
    let mut short = whole.clone();
    short[8..12].copy_from_slice(&4u32.to_le_bytes());
    says(
        &refused(&short),
        &["not a readable glTF 2.0", "length is 4"],
    );
}

#[test]
fn data_in_another_file() {
    let elsewhere = error_of(|json, _| json["buffers"][0]["uri"] = json!("brush.bin"));
    says(&elsewhere, &["brush.bin", ".glb"]);
    let coded = error_of(|json, _| json["buffers"][0]["uri"] = json!("data:;base64,?"));
    says(&coded, &["base64"]);
}

#[test]
fn nothing_to_paint_with() {
    let without = |key: &str| {
        error_of(|json, _| {
            _ = json["nodes"][1]
                .as_object_mut()
                .expect("a node")
                .remove(key)
        })
    };
    says(&without("mesh"), &["no mesh"]);
    says(&without("skin"), &["'Head'", "without a skin", "armature"]);
    let boneless = error_of(|json, _| {
        json["skins"] = json!([{ "joints": [] }]);
    });
    says(&boneless, &["'Head'", "no bones"]);
}

#[test]
fn bones_that_are_no_spines() {
    let branch = error(|model| model.add_spine(1, Some(2)));
    says(&branch, &["spine0.1", "branches", "spine0.2", "added16"]);
    let two = error(|model| {
        model.add_spine(1, None);
        model.add_spine(1, Some(16));
        model.add_spine(1, Some(16));
    });
    says(&two, &["added16", "branches", "one root bone"]);
    says(
        &error(|model| model.add_spine(65, Some(0))),
        &["added16", "65 bones", "64"],
    );
    let many = error(|model| (0..20).for_each(|_| model.add_spine(1, Some(0))));
    says(&many, &["25 spines", "24"]);
    let crowd = error(|model| (0..8).for_each(|_| model.add_spine(64, Some(0))));
    says(&crowd, &["spines is 527", "at most 512 joints"]);
    let short = error(|model| model.bones[3].head = model.bones[2].head);
    says(&short, &["spine0.1", "no length", "follows it"]);
    let last = error(|model| model.bones[3].extras = json!(null));
    says(&last, &["spine0.2", "no length", "length_m"]);
}

#[test]
fn nodes_that_are_no_tree() {
    // Bone i is node i + 2.
    let cycle = error_of(|json, _| {
        json["nodes"][0]["children"] = json!([1]);
        json["nodes"][5]["children"] = json!([2]);
    });
    says(&cycle, &["not a tree", "'ferrule' is its own ancestor"]);
    let own = error_of(|json, _| json["nodes"][5]["children"] = json!([5]));
    says(&own, &["not a tree", "spine0.2", "two parents"]);
    let shared = error_of(|json, _| json["nodes"][5]["children"] = json!([6]));
    says(&shared, &["not a tree", "spine1.0", "two parents"]);
    let alone = error_of(|json, _| {
        json["nodes"][0]["children"] = json!([1]);
        json["nodes"][2]["children"] = json!([2]);
    });
    says(&alone, &["not a tree"]);
}

#[test]
fn vertices_that_nothing_moves() {
    let bare = error(|model| model.weights[13] = vec![(4, 0.0)]);
    says(&bare, &["1 vertices of 'Head'", "no weights", "-6"]);
    // Neutral joints, as Blender's exporter makes them.
    let neutral = error(|model| {
        model.add_spine(1, None);
        model.bones[16].name = "neutral_bone".into();
        model.weights[20] = vec![(16, 1.0)];
        model.weights[21] = vec![(16, 1.0)];
    });
    says(&neutral, &["2 vertices of 'Head'", "no weights"]);
    let unknown = error(|model| model.weights[13] = vec![(40, 1.0)]);
    says(&unknown, &["'Head'", "JOINTS", "bone 40 of 16"]);
    let less = error(|model| model.weights[13] = vec![(4, -0.5)]);
    says(&less, &["'Head'", "WEIGHTS", "-0.5"]);
    let none = error_of(|json, _| {
        let primitive = &mut json["meshes"][0]["primitives"][0];
        primitive["attributes"] = json!({ "POSITION": 0 });
    });
    says(&none, &["60 vertices", "no weights"]);
}

#[test]
fn numbers_that_are_none() {
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let place = error(|model| model.vertices[3][1] = bad);
        says(&place, &["POSITION", "'Head'", "not finite"]);
        let weight = error(|model| model.weights[3][0].1 = bad);
        says(&weight, &["WEIGHTS", "'Head'", "not finite"]);
        let bind = error_of(|json, bytes| {
            let view = json["bufferViews"][4]["byteOffset"].as_u64().expect("it") as usize;
            bytes[view..view + 4].copy_from_slice(&bad.to_le_bytes());
        });
        says(&bind, &["inverse bind", "'Head'", "not finite"]);
    }
    let far = error_of(|json, _| json["nodes"][4]["translation"] = json!([1e39, 0.0, 0.0]));
    // Some builds of the JSON reader refuse such a number themselves.
    if !far.contains("number out of range") {
        says(&far, &["transform", "spine0.1", "not finite"]);
    }
    let flat = error_of(|json, _| json["nodes"][4]["rotation"] = json!([0.0, 0.0, 0.0, 0.0]));
    says(&flat, &["transform", "spine0.1", "not finite"]);
}

#[test]
fn properties_out_of_range_or_misspelt() {
    let of_bone = |extras: Value| error(|model| model.bones[2].extras = extras);
    let of_object = |extras: Value| error(|model| model.object = extras);
    for value in [-1.0, 0.0] {
        says(
            &of_bone(json!({ "stiffness": value })),
            &["'stiffness' of 'spine0.1'", "0.000001"],
        );
    }
    says(
        &of_bone(json!({ "damping": 1.5 })),
        &["'damping' of 'spine0.1' is 1.5", "0 to 1"],
    );
    says(
        &of_bone(json!({ "stifness": 1.0 })),
        &["'stifness' of 'spine0.1'", "'stiffness'"],
    );
    says(
        &of_bone(json!({ "friction": 1.0 })),
        &["'friction' of 'spine0.1'", "on the object"],
    );
    says(
        &of_object(json!({ "frictoin": 1.0 })),
        &["'frictoin' of 'Head'", "'friction'"],
    );
    says(
        &of_object(json!({ "friction": "low" })),
        &["'friction' of 'Head'", "0 to 2"],
    );
    let armature = error(|model| model.armature = json!({ "strip": 9 }));
    says(&armature, &["'strip' of 'Armature'", "'strips'"]);
    let data = error_of(|json, _| json["meshes"][0]["extras"] = json!({ "levels": 9 }));
    says(&data, &["'levels' of 'Tube' is 9", "0 to 3"]);
    let sticks = of_object(json!({ "friction": 0.5, "friction_static": 0.4 }));
    says(&sticks, &["contact.friction_static is 0.4", "0.5 to 2"]);
}

#[test]
fn a_head_that_is_elsewhere_or_of_no_size() {
    let flip = |model: &mut Model| {
        model.bones.iter_mut().for_each(|bone| bone.head[2] *= -1.0);
        model.vertices.iter_mut().for_each(|at| at[2] *= -1.0);
    };
    says(&error(flip), &["-Z of Blender", "spine0.0"]);
    let above = error(|model| model.vertices.iter_mut().for_each(|at| at[2] += 0.03));
    says(&above, &["-Z of Blender", "'Head'"]);
    let large = error(|model| {
        let places = model.vertices.iter_mut().flatten();
        places.for_each(|m| *m *= 1000.0);
    });
    says(
        &large,
        &["distance from the origin", "0 to 500 mm", "metres"],
    );
    let thin = error(|model| model.vertices.iter_mut().for_each(|at| at[1] = 0.0));
    says(&thin, &["thickness is 0 mm", "0.05 to 300"]);
    let posed = error_of(|json, _| json["nodes"][5]["rotation"] = json!([0.0, 0.0, 0.1, 0.995]));
    says(&posed, &["spine0.2", "posed", "Rest Position"]);
}

#[test]
fn lists_that_cannot_be_read() {
    let accessor = |number: usize, key: &str, value: Value| {
        error_of(|json, _| json["accessors"][number][key] = value)
    };
    says(
        &accessor(0, "count", json!(1u64 << 60)),
        &["POSITION", "outside"],
    );
    says(&accessor(0, "count", json!(0)), &["POSITION", "outside"]);
    says(
        &accessor(0, "byteOffset", json!(u64::MAX)),
        &["POSITION", "outside"],
    );
    says(&accessor(0, "type", json!("VEC4")), &["POSITION", "Vec4"]);
    says(
        &accessor(1, "componentType", json!(5126)),
        &["JOINTS", "F32"],
    );
    says(&accessor(2, "count", json!(3)), &["WEIGHTS", "as many"]);
    says(
        &accessor(4, "count", json!(3)),
        &["inverse bind", "missing"],
    );
    let sparse = json!({
        "count": 1,
        "indices": { "bufferView": 3, "componentType": 5123 },
        "values": { "bufferView": 0 },
    });
    says(&accessor(0, "sparse", sparse), &["POSITION", "sparse"]);
    let primitive = |key: &str, value: Value| {
        error_of(|json, _| json["meshes"][0]["primitives"][0][key] = value)
    };
    says(&primitive("mode", json!(1)), &["faces", "Lines"]);
    says(
        &primitive("attributes", json!({ "JOINTS_0": 1 })),
        &["POSITION"],
    );
    let attributes = json!({ "POSITION": 5, "JOINTS_0": 1, "WEIGHTS_0": 2 });
    says(
        &primitive("attributes", attributes),
        &["not a readable glTF 2.0", "no accessor 5"],
    );
    let corner = error_of(|json, bytes| {
        let view = json["bufferViews"][3]["byteOffset"].as_u64().expect("it") as usize;
        bytes[view..view + 2].copy_from_slice(&u16::MAX.to_le_bytes());
    });
    says(&corner, &["faces", "vertex 65535"]);
}

/// A model of few bones and vertices, for quick cases.
fn small() -> Model {
    let mut model = Model::round();
    model.faces.truncate(4);
    model.bones.truncate(7);
    for weights in &mut model.weights {
        *weights = vec![(1 + weights[0].0 % 6, 1.0)];
    }
    model
}

proptest! {
    #[test]
    fn no_mutation_of_a_model_breaks_the_reader(
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..6),
        digits in prop::collection::vec((any::<prop::sample::Index>(), 0u8..10), 0..6),
        length in any::<prop::sample::Index>(),
        cut in prop::bool::weighted(0.2),
        embedded in any::<bool>(),
    ) {
        let model = small();
        let mut bytes = if embedded { model.gltf() } else { model.glb() };
        for (place, byte) in changes {
            let place = place.index(bytes.len());
            bytes[place] = byte;
        }
        // Other numbers in the JSON, which keeps it one.
        let places: Vec<usize> = (20..bytes.len()).filter(|i| bytes[*i].is_ascii_digit()).collect();
        for (place, digit) in digits {
            bytes[places[place.index(places.len())]] = b'0' + digit;
        }
        if cut {
            bytes.truncate(length.index(bytes.len()));
        }
        if let Ok(brush) = gltf::read(&bytes) {
            prop_assert_eq!(brush.check(), Ok(()));
        }
    }

    #[test]
    fn no_bytes_make_the_reader_panic(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        prop_assert!(gltf::read(&bytes).is_err());
        let chunk = [&b"glTF\x02\0\0\0"[..], &(bytes.len() as u32 + 12).to_le_bytes(), &bytes];
        prop_assert!(gltf::read(&chunk.concat()).is_err());
    }
}
