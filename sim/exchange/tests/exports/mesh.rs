//! Meshes of exported solids, measured.

use std::collections::BTreeMap;

/// A facet: its corners.
pub(crate) type Facet = [[f32; 3]; 3];

/// A facet of an STL: its normal and its corners.
pub(crate) type StlFacet = [[f32; 3]; 4];

/// Facets of a binary STL.
pub(crate) fn stl_facets(file: &[u8]) -> Vec<StlFacet> {
    let facet = |facet: &[u8]| {
        let float = |i: usize| f32::from_le_bytes(facet[4 * i..][..4].try_into().expect("four"));
        [0, 1, 2, 3].map(|corner| [0, 1, 2].map(|axis| float(3 * corner + axis)))
    };
    file[84..].chunks_exact(50).map(facet).collect()
}

/// Facets without their normals.
pub(crate) fn corners(facets: &[StlFacet]) -> Vec<Facet> {
    facets.iter().map(|[_, corners @ ..]| *corners).collect()
}

/// True if each edge has two opposite half-edges.
pub(crate) fn is_watertight(facets: &[Facet]) -> bool {
    let mut edges: BTreeMap<[[u32; 3]; 2], [u32; 2]> = BTreeMap::new();
    for facet in facets {
        let bits = facet.map(|corner| corner.map(f32::to_bits));
        for i in 0..3 {
            let (from, to) = (bits[i], bits[(i + 1) % 3]);
            edges.entry([from.min(to), from.max(to)]).or_default()[usize::from(from > to)] += 1;
        }
    }
    edges.values().all(|runs| *runs == [1, 1])
}

pub(crate) fn cross(u: [f64; 3], v: [f64; 3]) -> [f64; 3] {
    [
        u[1] * v[2] - u[2] * v[1],
        u[2] * v[0] - u[0] * v[2],
        u[0] * v[1] - u[1] * v[0],
    ]
}

pub(crate) fn dot(u: [f64; 3], v: [f64; 3]) -> f64 {
    u[0] * v[0] + u[1] * v[1] + u[2] * v[2]
}

/// Volume by the divergence theorem: less than 0 where normals point inward.
pub(crate) fn volume(facets: &[Facet]) -> f64 {
    let corners = facets.iter().map(|facet| facet.map(|c| c.map(f64::from)));
    corners.map(|[a, b, c]| dot(a, cross(b, c)) / 6.0).sum()
}
