//! A small writer of glTF files as Blender exports them: y up, metres, quadrilaterals cut in two, a
//! vertex of its own for each corner of a face.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Map, Value, json};

/// A bone in Blender's frame, m. All point straight down.
#[derive(Clone, Debug)]
pub(crate) struct Bone {
    pub(crate) name: String,
    pub(crate) parent: Option<usize>,
    pub(crate) head: [f64; 3],
    pub(crate) extras: Value,
}

/// A model in Blender's frame, m.
#[derive(Clone, Debug)]
pub(crate) struct Model {
    pub(crate) bones: Vec<Bone>,
    pub(crate) vertices: Vec<[f32; 3]>,
    pub(crate) weights: Vec<Vec<(u8, f32)>>,
    pub(crate) faces: Vec<Vec<usize>>,
    /// Custom properties of the mesh object and of the armature.
    pub(crate) object: Value,
    pub(crate) armature: Value,
    /// Scale of the armature's object, which is also moved and turned about Blender's z; the model stays where it is.
    pub(crate) scale: f64,
    pub(crate) shift: [f64; 3],
    pub(crate) quarter_turns: u32,
}

pub(crate) const RINGS: [[f64; 2]; 5] = [
    [0.0, 4e-3],
    [-6e-3, 5e-3],
    [-12e-3, 4.5e-3],
    [-18e-3, 3e-3],
    [-24e-3, 1e-3],
];
pub(crate) const AROUND: usize = 12;
pub(crate) const BONE_M: f64 = 8e-3;
pub(crate) const RADIUS_M: f64 = 3e-3;

impl Model {
    /// A round brush: a root bone that carries five spines of three bones, one in the middle and four
    /// around it, in a tube of twelve sides that is closed below.
    pub(crate) fn round() -> Self {
        let mut bones = vec![Bone {
            name: "ferrule".into(),
            parent: None,
            head: [0.0, 0.0, 2e-3],
            extras: Value::Null,
        }];
        for (spine, [x, y]) in [[0, 0], [1, 0], [0, 1], [-1, 0], [0, -1]]
            .iter()
            .enumerate()
        {
            for i in 0..3 {
                let parent = if i == 0 { 0 } else { bones.len() - 1 };
                let mut extras = json!({ "stiffness": 30.0 - 5.0 * f64::from(i), "damping": 0.02 });
                if i == 2 {
                    extras["length_m"] = json!(BONE_M);
                }
                bones.push(Bone {
                    name: format!("spine{spine}.{i}"),
                    parent: Some(parent),
                    head: [
                        f64::from(*x) * RADIUS_M,
                        f64::from(*y) * RADIUS_M,
                        -f64::from(i) * BONE_M,
                    ],
                    extras,
                });
            }
        }
        let mut model = Self {
            bones,
            vertices: Vec::new(),
            weights: Vec::new(),
            faces: Vec::new(),
            object: json!({ "friction": 0.3, "strips": 200, "kind": "modelled", "_RNA_UI": {} }),
            armature: json!({ "cycles": 1, "film_um": 150.0, "friction": 0.9 }),
            scale: 1.0,
            shift: [0.0; 3],
            quarter_turns: 0,
        };
        model.tube();
        model
    }

    fn tube(&mut self) {
        for (ring, [z, radius]) in RINGS.iter().enumerate() {
            for i in 0..AROUND {
                let turn = 2.0 * std::f64::consts::PI * i as f64 / AROUND as f64;
                let (s, c) = maulstick_num::sin_cos(turn);
                self.vertices
                    .push([(radius * c) as f32, (radius * s) as f32, *z as f32]);
                // The spine around the middle that is nearest, and the bone at that height.
                let spine = 1 + (4 * i + AROUND / 2) / AROUND % 4;
                let bone = (1 + 3 * spine + (ring / 2).min(2)) as u8;
                self.weights.push(vec![(bone, 0.75), (1, 0.75)]);
            }
        }
        for ring in 1..RINGS.len() {
            for i in 0..AROUND {
                let next = (i + 1) % AROUND;
                let (above, below) = ((ring - 1) * AROUND, ring * AROUND);
                self.faces
                    .push(vec![above + next, above + i, below + i, below + next]);
            }
        }
        let lowest = (RINGS.len() - 1) * AROUND;
        self.faces
            .push((0..AROUND).rev().map(|i| lowest + i).collect());
    }

    /// Adds a spine: a chain of `joints` bones of a millimetre that begins at a bone.
    pub(crate) fn add_spine(&mut self, joints: usize, mut parent: Option<usize>) {
        for i in 0..joints {
            let mut bone = self.bones[1].clone();
            bone.name = format!("added{}", self.bones.len());
            bone.head = [1e-3, 1e-3, -1e-3 * i as f64];
            bone.extras = json!({ "length_m": 1e-3 });
            bone.parent = parent;
            parent = Some(self.bones.len());
            self.bones.push(bone);
        }
    }

    /// A point of Blender's world in the armature's frame of glTF.
    fn local(&self, at: [f64; 3]) -> [f64; 3] {
        let [mut x, mut y, z] = [0, 1, 2].map(|i| (at[i] - self.shift[i]) / self.scale);
        for _ in 0..self.quarter_turns % 4 {
            (x, y) = (y, -x);
        }
        [x, z, -y]
    }

    /// Its JSON and its buffer.
    pub(crate) fn parts(&self) -> (Value, Vec<u8>) {
        let heads: Vec<[f64; 3]> = self
            .bones
            .iter()
            .map(|bone| self.local(bone.head))
            .collect();
        // Node 0 is the armature, node 1 the mesh.
        let mut nodes = vec![self.armature_node(), Map::new()];
        nodes[1].extend([
            ("name".into(), json!("Head")),
            ("mesh".into(), json!(0)),
            ("skin".into(), json!(0)),
            ("extras".into(), self.object.clone()),
        ]);
        let mut children = vec![Vec::new(); self.bones.len() + 2];
        children[0].push(1);
        for (i, bone) in self.bones.iter().enumerate() {
            children[bone.parent.map_or(0, |parent| parent + 2)].push(i + 2);
            let from = bone.parent.map_or([0.0; 3], |parent| heads[parent]);
            let mut at = [0, 1, 2].map(|axis| heads[i][axis] - from[axis]);
            let mut node = Map::new();
            node.insert("name".into(), json!(bone.name));
            node.insert("extras".into(), bone.extras.clone());
            match bone.parent {
                // Half a turn about x: the y axis points down.
                None => _ = node.insert("rotation".into(), json!([1.0, 0.0, 0.0, 0.0])),
                Some(_) => at = [at[0], -at[1], -at[2]],
            }
            node.insert("translation".into(), json!(at));
            nodes.push(node);
        }
        for (node, children) in nodes.iter_mut().zip(children) {
            if !children.is_empty() {
                node.insert("children".into(), json!(children));
            }
        }
        let mut buffer = Buffer::default();
        let split = self.split();
        let count = split.positions.len();
        let binds: Vec<f32> = heads.iter().flat_map(inverse_bind).collect();
        let positions = split
            .positions
            .iter()
            .flatten()
            .flat_map(|v| v.to_le_bytes());
        buffer.add(positions.collect(), 5126, "VEC3", count);
        buffer.add(split.joints.concat(), 5121, "VEC4", count);
        let weights = split.weights.iter().flatten().flat_map(|v| v.to_le_bytes());
        buffer.add(weights.collect(), 5126, "VEC4", count);
        let faces = split.corners.iter().flat_map(|v| v.to_le_bytes());
        buffer.add(faces.collect(), 5123, "SCALAR", split.corners.len());
        let binds = binds.iter().flat_map(|v| v.to_le_bytes());
        buffer.add(binds.collect(), 5126, "MAT4", self.bones.len());
        let joints: Vec<usize> = (2..self.bones.len() + 2).collect();
        let json = json!({
            "asset": { "version": "2.0" },
            "scene": 0,
            "scenes": [{ "nodes": [0] }],
            "nodes": nodes,
            "meshes": [{ "name": "Tube", "primitives": [{
                "attributes": { "POSITION": 0, "JOINTS_0": 1, "WEIGHTS_0": 2 },
                "indices": 3,
            }] }],
            "skins": [{ "joints": joints, "inverseBindMatrices": 4 }],
            "accessors": buffer.accessors,
            "bufferViews": buffer.views,
            "buffers": [{ "byteLength": buffer.bytes.len() }],
        });
        (json, buffer.bytes)
    }

    fn armature_node(&self) -> Map<String, Value> {
        let [x, y, z] = self.shift;
        // Blender's z is glTF's y.
        let (s, c) =
            maulstick_num::sin_cos(0.25 * std::f64::consts::PI * f64::from(self.quarter_turns));
        let mut node = Map::new();
        node.insert("name".into(), json!("Armature"));
        node.insert("translation".into(), json!([x, z, -y]));
        node.insert("rotation".into(), json!([0.0, s, 0.0, c]));
        node.insert("scale".into(), json!([self.scale, self.scale, self.scale]));
        node.insert("extras".into(), self.armature.clone());
        node
    }

    /// Its faces as triangles: vertices of its own for each face, and the corners.
    fn split(&self) -> Split {
        let mut split = Split::default();
        for face in &self.faces {
            let first = split.positions.len() as u16;
            for vertex in face {
                let at = self.local(self.vertices[*vertex].map(f64::from));
                split.positions.push(at.map(|v| v as f32));
                let tied = &self.weights[*vertex];
                let of = |i: usize| tied.get(i).copied().unwrap_or_default();
                split.joints.push(std::array::from_fn(|i| of(i).0));
                split.weights.push(std::array::from_fn(|i| of(i).1));
            }
            for i in 2..face.len() as u16 {
                split.corners.extend([first, first + i - 1, first + i]);
            }
        }
        split
    }

    pub(crate) fn glb(&self) -> Vec<u8> {
        let (json, bytes) = self.parts();
        glb(&json, &bytes)
    }

    /// As .gltf with its data embedded.
    pub(crate) fn gltf(&self) -> Vec<u8> {
        let (mut json, bytes) = self.parts();
        let coded = STANDARD.encode(bytes);
        json["buffers"][0]["uri"] = json!(format!("data:application/octet-stream;base64,{coded}"));
        serde_json::to_vec(&json).expect("json")
    }
}

/// A .glb of a JSON and a buffer (glTF 2.0, § 4.4).
pub(crate) fn glb(json: &Value, bytes: &[u8]) -> Vec<u8> {
    let padded = |bytes: &[u8], with: u8| {
        let mut bytes = bytes.to_vec();
        bytes.resize(bytes.len().next_multiple_of(4), with);
        bytes
    };
    let json = padded(&serde_json::to_vec(json).expect("json"), b' ');
    let bytes = padded(bytes, 0);
    let word = |value: usize| (value as u32).to_le_bytes();
    let length = 28 + json.len() + bytes.len();
    let header = [*b"glTF", word(2), word(length)].concat();
    let first = [word(json.len()), *b"JSON"].concat();
    let second = [word(bytes.len()), *b"BIN\0"].concat();
    [header, first, json, second, bytes].concat()
}

/// The matrix that undoes half a turn about x and a move, column by column.
fn inverse_bind(head: &[f64; 3]) -> [f32; 16] {
    let mut matrix = [0.0; 16];
    for (axis, sign) in [1.0, -1.0, -1.0].into_iter().enumerate() {
        matrix[5 * axis] = sign as f32;
        matrix[12 + axis] = (-sign * head[axis]) as f32;
    }
    matrix[15] = 1.0;
    matrix
}

/// A mesh as the exporter splits it.
#[derive(Default)]
struct Split {
    positions: Vec<[f32; 3]>,
    joints: Vec<[u8; 4]>,
    weights: Vec<[f32; 4]>,
    corners: Vec<u16>,
}

#[derive(Default)]
struct Buffer {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Buffer {
    fn add(&mut self, bytes: Vec<u8>, component: u32, shape: &str, count: usize) {
        self.views.push(json!({
            "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len(),
        }));
        self.accessors.push(json!({
            "bufferView": self.views.len() - 1, "componentType": component, "type": shape,
            "count": count,
        }));
        if shape == "VEC3" {
            // Validation wants them, reading does not.
            let accessor = self.accessors.last_mut().expect("one");
            accessor["min"] = json!([-1.0, -1.0, -1.0]);
            accessor["max"] = json!([1.0, 1.0, 1.0]);
        }
        self.bytes.extend(bytes);
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
    }
}
