//! A painting as a solid with its colours, in binary glTF (Khronos Group 2021, *glTF 2.0 Specification*).
//!
//! Metres; x right and y up along the surface, z out of it, so that the painting stands and faces a viewer. Colours are
//! those of the paint seen from above, unlit, linear sRGB. Normals of the surface are smooth; walls and bottom have
//! their own vertices.

use std::io::{BufWriter, Write};

use maulstick_painting::Painting;
use serde_json::json;

use crate::ExchangeError;
use crate::solid::{
    Colour, Corner, MeshSink, Point, Solid, SolidFormat, SolidSetup, SolidSize, area_normal,
    normal, unit, write_solid,
};
use crate::surface::{Progress, Steps};

/// Size of a vertex, bytes: place and normal as 3 floats, red, green, blue and alpha as 16 bits.
const VERTEX: u64 = 32;
/// Size of a triangle, bytes: three vertex indices.
const TRIANGLE: u64 = 12;
/// Greatest number of triangles, for a file of at most 4 GiB.
const MAX_TRIANGLES: u64 = u32::MAX as u64 / (VERTEX + TRIANGLE) - 1000;
/// Gloss of oil paint, roughly.
const ROUGHNESS: f64 = 0.4;

/// Writes a surface as a solid with its colours.
///
/// # Errors
/// [`ExchangeError`].
pub fn write_glb(
    painting: &mut Painting,
    surface: u32,
    setup: &SolidSetup,
    to: impl Write,
    progress: Progress<'_>,
) -> Result<SolidSize, ExchangeError> {
    let format = Glb(BufWriter::new(to));
    write_solid(painting, surface, setup, format, progress)
}

/// Binary glTF: header, JSON, vertices of the surface, vertices of walls and bottom, vertex indices of facets.
struct Glb<W: Write>(BufWriter<W>);

impl<W: Write> SolidFormat for Glb<W> {
    const MAX_TRIANGLES: u64 = MAX_TRIANGLES;
    const PASSES: usize = 3;

    fn write(mut self, solid: &Solid<'_>, steps: &mut Steps<'_>) -> Result<(), ExchangeError> {
        write_head(solid, &mut self.0)?;
        let vertices = VertexSink {
            pending: Vec::new(),
            first: 0,
            walls: Vec::new(),
            to: self.0,
        };
        let vertices = solid.triangulate(1.0, true, steps, vertices)?;
        let mut to = vertices.to;
        to.write_all(&vertices.walls)?;
        let mut indices = solid.triangulate(1.0, false, steps, IndexSink(to))?;
        let first = solid.counts.vertices as u32;
        for index in first..first + 3 * solid.counts.wall_facets as u32 {
            indices.0.write_all(&index.to_le_bytes())?;
        }
        Ok(indices.0.flush()?)
    }
}

/// Writes the GLB header, the JSON chunk and the header of the BIN chunk.
fn write_head(solid: &Solid<'_>, to: &mut impl Write) -> Result<(), ExchangeError> {
    let vertices = solid.counts.vertices + 3 * solid.counts.wall_facets;
    let (places, numbers) = (vertices * VERTEX, solid.triangles() * TRIANGLE);
    let size = solid.size(1.0).map(|length| length as f32);
    let attribute = |offset: u32, component: u32, kind: &str| {
        json!({
            "bufferView": 0, "byteOffset": offset, "count": vertices, "componentType": component, "type": kind,
        })
    };
    const FLOAT: u32 = 5126;
    let mut position = attribute(0, FLOAT, "VEC3");
    position["min"] = json!([0.0, 0.0, 0.0]);
    position["max"] = json!(size);
    let mut colour = attribute(24, 5123, "VEC4");
    colour["normalized"] = json!(true);
    let rest = json!({
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "mesh": 0, "name": "painting" }],
        "meshes": [{ "primitives": [{
            "attributes": { "POSITION": 0, "NORMAL": 1, "COLOR_0": 2 }, "indices": 3, "material": 0,
        }] }],
        "materials": [{
            "name": "paint",
            "pbrMetallicRoughness": { "metallicFactor": 0.0, "roughnessFactor": ROUGHNESS },
        }],
        "accessors": [
            position,
            attribute(12, FLOAT, "VEC3"),
            colour,
            { "bufferView": 1, "count": 3 * solid.triangles(), "componentType": 5125, "type": "SCALAR" },
        ],
        "bufferViews": [
            { "buffer": 0, "byteLength": places, "byteStride": VERTEX, "target": 34962 },
            { "buffer": 0, "byteOffset": places, "byteLength": numbers, "target": 34963 },
        ],
        "buffers": [{ "byteLength": places + numbers }],
    });
    // The generator comes first: an export recognises its own files by it.
    let asset = r#""asset":{"generator":"Maulstick","version":"2.0"}"#;
    let rest = rest.to_string();
    let mut json = format!("{{{asset},{}", &rest[1..]).into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let all = 12 + 8 + json.len() as u64 + 8 + places + numbers;
    let Ok(all) = u32::try_from(all) else {
        return Err(ExchangeError::TooManyTriangles {
            triangles: solid.triangles(),
            step: solid.coarser(),
        });
    };
    to.write_all(b"glTF")?;
    to.write_all(&2u32.to_le_bytes())?;
    to.write_all(&all.to_le_bytes())?;
    to.write_all(&(json.len() as u32).to_le_bytes())?;
    to.write_all(b"JSON")?;
    to.write_all(&json)?;
    to.write_all(&((places + numbers) as u32).to_le_bytes())?;
    to.write_all(b"BIN\0")?;
    Ok(())
}

fn vertex(at: Point, normal: Point, colour: Colour) -> [u8; VERTEX as usize] {
    let mut bytes = [0; VERTEX as usize];
    let (floats, channels) = bytes.split_at_mut(24);
    for (bytes, value) in floats.chunks_exact_mut(4).zip(at.iter().chain(&normal)) {
        bytes.copy_from_slice(&value.to_le_bytes());
    }
    let [red, green, blue] = colour;
    for (bytes, value) in channels.chunks_exact_mut(2).zip([red, green, blue, 1.0]) {
        let level = (value.clamp(0.0, 1.0) * 65_535.0 + 0.5) as u16;
        bytes.copy_from_slice(&level.to_le_bytes());
    }
    bytes
}

/// A vertex that may still get facets.
struct PendingVertex {
    at: Point,
    colour: Colour,
    /// Sum of the normals of its facets, weighted by area.
    normal: [f64; 3],
}

/// Writes vertices once they have all their facets.
struct VertexSink<W: Write> {
    pending: Vec<PendingVertex>,
    /// Index of the first pending one.
    first: u32,
    /// Vertices of walls and bottom.
    walls: Vec<u8>,
    to: BufWriter<W>,
}

/// The normal itself; upward for a facet without area.
fn or_up(normal: Point) -> Point {
    match normal {
        [0.0, 0.0, 0.0] => [0.0, 0.0, 1.0],
        normal => normal,
    }
}

impl<W: Write> MeshSink for VertexSink<W> {
    fn add_vertex(&mut self, at: Point, colour: Colour) {
        self.pending.push(PendingVertex {
            at,
            colour,
            normal: [0.0; 3],
        });
    }

    fn add_surface_facet(&mut self, corners: [Corner; 3]) -> Result<(), ExchangeError> {
        let normal = area_normal(&corners.map(|corner| corner.at));
        for corner in corners {
            let pending = &mut self.pending[(corner.id - self.first) as usize];
            let sums = pending.normal.iter_mut().zip(normal);
            sums.for_each(|(sum, part)| *sum += part);
        }
        Ok(())
    }

    fn add_wall_facet(&mut self, corners: [Point; 3], colour: Colour) -> Result<(), ExchangeError> {
        let normal = or_up(normal(&corners));
        for corner in corners {
            self.walls.extend(vertex(corner, normal, colour));
        }
        Ok(())
    }

    fn complete_vertices(&mut self, end: u32) -> Result<(), ExchangeError> {
        let count = (end - self.first) as usize;
        for pending in self.pending.drain(..count) {
            let normal = or_up(unit(pending.normal));
            self.to
                .write_all(&vertex(pending.at, normal, pending.colour))?;
        }
        self.first = end;
        Ok(())
    }
}

/// Writes the vertex indices of the surface's facets.
struct IndexSink<W: Write>(BufWriter<W>);

impl<W: Write> MeshSink for IndexSink<W> {
    fn add_surface_facet(&mut self, corners: [Corner; 3]) -> Result<(), ExchangeError> {
        for corner in corners {
            self.0.write_all(&corner.id.to_le_bytes())?;
        }
        Ok(())
    }

    fn add_wall_facet(
        &mut self,
        _corners: [Point; 3],
        _colour: Colour,
    ) -> Result<(), ExchangeError> {
        Ok(())
    }
}
