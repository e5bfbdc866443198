//! Catmull-Clark subdivision (Catmull and Clark 1978) as stencils: each vertex of the fine mesh is a fixed convex sum
//! of the control vertices, so a deformed head is subdivided by one product.

use std::collections::BTreeMap;

/// A mesh, closed or with boundary edges.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Number of vertices.
    pub vertices: usize,
    /// Faces, counterclockwise from outside.
    pub faces: Vec<Vec<usize>>,
}

/// Weights of control vertices, ordered by vertex number.
pub type Stencil = Vec<(usize, f64)>;

/// A subdivided mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Subdivided {
    /// Faces; after one level all have four corners.
    pub mesh: Mesh,
    /// Stencil of each vertex.
    pub stencils: Vec<Stencil>,
}

/// Weights by vertex number, summed.
#[derive(Clone, Debug, Default)]
struct Sum(BTreeMap<usize, f64>);

impl Sum {
    fn add(mut self, other: &Stencil, share: f64) -> Self {
        for (vertex, own) in other {
            *self.0.entry(*vertex).or_default() += share * own;
        }
        self
    }

    fn mean(of: &[&Stencil]) -> Stencil {
        let share = 1.0 / of.len() as f64;
        let sum = of.iter().fold(Self::default(), |sum, s| sum.add(s, share));
        sum.done()
    }

    fn done(self) -> Stencil {
        self.0.into_iter().collect()
    }
}

/// An edge's ends, the lower number first, and the faces beside it.
type Edges = BTreeMap<(usize, usize), Vec<usize>>;

/// Subdivides `levels` times.
#[must_use]
pub fn subdivide(mesh: &Mesh, levels: usize) -> Subdivided {
    let mut fine = Subdivided {
        mesh: mesh.clone(),
        stencils: (0..mesh.vertices).map(|i| vec![(i, 1.0)]).collect(),
    };
    for _ in 0..levels {
        fine = once(&fine);
    }
    fine
}

fn once(coarse: &Subdivided) -> Subdivided {
    let (mesh, old) = (&coarse.mesh, &coarse.stencils);
    let mut edges = Edges::new();
    for (number, face) in mesh.faces.iter().enumerate() {
        for (a, b) in sides(face) {
            edges.entry((a.min(b), a.max(b))).or_default().push(number);
        }
    }
    let faces: Vec<Stencil> = mesh
        .faces
        .iter()
        .map(|face| Sum::mean(&face.iter().map(|v| &old[*v]).collect::<Vec<_>>()))
        .collect();
    let place = |i: usize| mesh.vertices + faces.len() + i;
    let numbers: BTreeMap<(usize, usize), usize> = edges
        .keys()
        .enumerate()
        .map(|(i, edge)| (*edge, place(i)))
        .collect();
    let mut around = vec![Vec::new(); mesh.vertices];
    for ((a, b), beside) in &edges {
        around[*a].push((*b, &beside[..]));
        around[*b].push((*a, &beside[..]));
    }
    let mut stencils: Vec<Stencil> = (0..mesh.vertices)
        .map(|vertex| moved(vertex, old, &around[vertex], &faces))
        .collect();
    stencils.extend(faces.iter().cloned());
    stencils.extend(edges.iter().map(|((a, b), beside)| match beside[..] {
        [f, g] => Sum::mean(&[&old[*a], &old[*b], &faces[f], &faces[g]]),
        _ => Sum::mean(&[&old[*a], &old[*b]]),
    }));
    let mut fine = Mesh {
        vertices: stencils.len(),
        faces: Vec::new(),
    };
    for (number, face) in mesh.faces.iter().enumerate() {
        let edge = |a: usize, b: usize| numbers[&(a.min(b), a.max(b))];
        for i in 0..face.len() {
            let before = face[(i + face.len() - 1) % face.len()];
            let after = face[(i + 1) % face.len()];
            let own = face[i];
            let center = mesh.vertices + number;
            fine.faces
                .push(vec![own, edge(own, after), center, edge(before, own)]);
        }
    }
    Subdivided {
        mesh: fine,
        stencils,
    }
}

/// The sides of a face.
fn sides(face: &[usize]) -> impl Iterator<Item = (usize, usize)> {
    (0..face.len()).map(|i| (face[i], face[(i + 1) % face.len()]))
}

/// A vertex after one level: (Q + 2R + (n − 3)·S)/n with Q the mean of the n faces' points, R that of the edges'
/// middles, S the vertex; on a border (a + 6S + b)/8. `edges` are the vertex's own: their other end and the faces
/// beside them.
fn moved(
    vertex: usize,
    old: &[Stencil],
    edges: &[(usize, &[usize])],
    faces: &[Stencil],
) -> Stencil {
    let own = &old[vertex];
    let border: Vec<usize> = edges
        .iter()
        .filter(|(_, beside)| beside.len() == 1)
        .map(|(other, _)| *other)
        .collect();
    if let [a, b] = border[..] {
        let sum = Sum::default().add(own, 0.75);
        return sum.add(&old[a], 0.125).add(&old[b], 0.125).done();
    }
    let n = edges.len() as f64;
    if edges.len() < 3 || !border.is_empty() {
        return own.clone();
    }
    let mut sum = Sum::default().add(own, (n - 3.0) / n + 1.0 / n);
    for (other, beside) in edges {
        sum = sum.add(&old[*other], 1.0 / (n * n));
        // Each face lies beside two of the edges.
        for face in *beside {
            sum = sum.add(&faces[*face], 0.5 / (n * n));
        }
    }
    sum.done()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cube() -> Mesh {
        let faces = [
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 4, 6, 2],
            [1, 3, 7, 5],
        ];
        Mesh {
            vertices: 8,
            faces: faces.map(Vec::from).to_vec(),
        }
    }

    fn corner(i: usize) -> [f64; 3] {
        [0, 1, 2].map(|axis| if i >> axis & 1 == 1 { 1.0 } else { -1.0 })
    }

    #[test]
    fn a_cube_becomes_round() {
        let one = subdivide(&cube(), 1);
        assert_eq!((one.mesh.vertices, one.mesh.faces.len()), (26, 24));
        let at = |stencil: &Stencil| {
            stencil.iter().fold([0.0; 3], |sum: [f64; 3], (v, share)| {
                [0, 1, 2].map(|axis| sum[axis] + share * corner(*v)[axis])
            })
        };
        // Catmull and Clark: a corner of a cube of side 2 moves to 5/9 of itself.
        assert!((at(&one.stencils[7])[0] - 5.0 / 9.0).abs() < 1e-12);
        assert!(
            (at(&one.stencils[7])[0] - 0.56).abs() > 1e-3,
            "a fault would pass"
        );
        let fine = subdivide(&cube(), 4);
        let radius = |s: &Stencil| at(s).iter().map(|v| v * v).sum::<f64>().sqrt();
        let radii: Vec<f64> = fine.stencils.iter().map(radius).collect();
        let (low, high) = (
            radii.iter().copied().fold(f64::MAX, f64::min),
            radii.iter().copied().fold(0.0, f64::max),
        );
        assert!(high / low < 1.2, "{low} {high}");
    }

    #[test]
    fn stencils_are_convex_and_borders_stay_borders() {
        let mut open = cube();
        open.faces.pop();
        for mesh in [cube(), open] {
            for stencil in &subdivide(&mesh, 2).stencils {
                let sum: f64 = stencil.iter().map(|(_, share)| share).sum();
                assert!((sum - 1.0).abs() < 1e-12);
                assert!(stencil.iter().all(|(_, share)| *share >= 0.0));
            }
        }
    }

    #[test]
    fn triangles_become_quads() {
        let tetrahedron = Mesh {
            vertices: 4,
            faces: vec![vec![0, 2, 1], vec![0, 1, 3], vec![1, 2, 3], vec![2, 0, 3]],
        };
        let fine = subdivide(&tetrahedron, 1);
        assert_eq!(fine.mesh.faces.len(), 12);
        assert!(fine.mesh.faces.iter().all(|face| face.len() == 4));
    }
}
