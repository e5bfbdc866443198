//! Triangulation of the surface within a prism over three columns.
//!
//! The edges of their pairings ([`ColumnPairing`]) form closed loops around the prism, for each end of a column has one edge
//! in either side. Each loop is triangulated. The neighbouring prism has the same edges as opposite half-edges, so both fit.

use super::pairing::ColumnPairing;
use crate::ExchangeError;

/// Place of a vertex: x, y, z in the file's unit.
pub(crate) type Point = [f32; 3];

/// Corner of a facet: place and index of its vertex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Corner {
    /// Place of the vertex.
    pub(crate) at: Point,
    /// Index of the vertex.
    pub(crate) id: u32,
}

/// A column at its place in the file.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlacedColumn<'a> {
    /// Place, x and y.
    pub(super) at: [f32; 2],
    /// Heights of its ends, z.
    pub(super) z: &'a [f32],
    /// Index of the vertex at its lowest end.
    pub(super) first: u32,
}

impl PlacedColumn<'_> {
    pub(super) fn corner(&self, end: usize) -> Corner {
        let [x, y] = self.at;
        Corner {
            at: [x, y, self.z[end]],
            id: self.first + end as u32,
        }
    }
}

/// Side of a prism: the pairing of one of its columns with the next one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Side<'a> {
    /// Edges and caps in it.
    pub(super) pairing: &'a ColumnPairing,
    /// Index of the vertex at its first cusp.
    pub(super) first: u32,
    /// Distance of its cusps from their columns, as a share of the distance to the other one.
    pub(super) reach: f64,
    /// True if the pairing is from the next column to this one.
    pub(super) is_reversed: bool,
}

/// Cusp of a cap between two columns, the pairing's first and second.
pub(super) fn cusp(side: &Side<'_>, cap: usize, [a, b]: [&PlacedColumn<'_>; 2]) -> Corner {
    let id = side.first + cap as u32;
    let cap = side.pairing.caps[cap];
    let (own, other) = if cap.is_second { (b, a) } else { (a, b) };
    let way = |axis: usize| {
        let [from, to] = [own, other].map(|column| f64::from(column.at[axis]));
        (from + side.reach * (to - from)) as f32
    };
    let [low, high] = [cap.end, cap.end + 1].map(|end| f64::from(own.z[end]));
    Corner {
        at: [way(0), way(1), (0.5 * (low + high)) as f32],
        id,
    }
}

/// Receives the facets within prisms.
pub(super) trait FacetSink {
    /// True for prisms that are flat: a wall's, in a vertical plane.
    const IS_WALL: bool;

    fn add_vertex(&mut self, at: Point) -> Corner;

    /// Adds a facet, counterclockwise from outside.
    fn add_facet(&mut self, corners: [Corner; 3]) -> Result<(), ExchangeError>;
}

/// Triangulates the surface within a prism over three columns, counterclockwise from above; `sides` are from the first column
/// to the second and so on round.
pub(super) fn triangulate_prism(
    columns: &[PlacedColumn<'_>; 3],
    sides: &[Side<'_>; 3],
    sink: &mut impl FacetSink,
) -> Result<(), ExchangeError> {
    if columns.iter().all(|column| column.z.len() == 1) {
        return sink.add_facet(columns.map(|column| column.corner(0)));
    }
    for corners in boundary_loops(columns, sides) {
        triangulate_loop(&corners, sink)?;
    }
    Ok(())
}

/// Corner of a loop, and the side whose cusp it is if it is one.
type LoopCorner = (Corner, Option<usize>);

/// Closed loops of half-edges around a prism, with paint to their left as seen from the air.
fn boundary_loops(columns: &[PlacedColumn<'_>; 3], sides: &[Side<'_>; 3]) -> Vec<Vec<LoopCorner>> {
    let counts = columns.each_ref().map(|column| column.z.len());
    let firsts = [0, counts[0], counts[0] + counts[1]];
    let mut next: Vec<(usize, Option<LoopCorner>)> = vec![(usize::MAX, None); counts.iter().sum()];
    for (from, side) in sides.iter().enumerate() {
        let to = (from + 1) % 3;
        let (pairing, reversed) = (side.pairing, side.is_reversed);
        let mut join = |[own, other]: [usize; 2]| {
            let (own, other) = (firsts[from] + own, firsts[to] + other);
            // Half-edges run forth along tops, back along bottoms.
            if (own - firsts[from]).is_multiple_of(2) {
                next[own] = (other, None)
            } else {
                next[other] = (own, None)
            }
        };
        if counts[from] == 1 && counts[to] == 1 {
            join([0, 0]);
        }
        for [a, b] in &pairing.joined {
            join(if reversed { [*b, *a] } else { [*a, *b] });
        }
        let [a, b] = if reversed { [to, from] } else { [from, to] };
        for (number, cap) in pairing.caps.iter().enumerate() {
            let corner = (cusp(side, number, [&columns[a], &columns[b]]), Some(from));
            let is_next = cap.is_second != reversed;
            let low = firsts[if is_next { to } else { from }] + cap.end;
            let is_piece = !cap.end.is_multiple_of(2);
            if is_next == is_piece {
                next[low] = (low + 1, Some(corner))
            } else {
                next[low + 1] = (low, Some(corner))
            }
        }
    }
    let corner = |end: usize| {
        let column = (0..3)
            .rev()
            .find(|column| end >= firsts[*column])
            .unwrap_or(0);
        columns[column].corner(end - firsts[column])
    };
    let mut loops = Vec::new();
    for start in 0..next.len() {
        let (mut corners, mut end) = (Vec::new(), start);
        while let Some((to, cusp)) = next.get(end).copied() {
            next[end].0 = usize::MAX;
            if to == usize::MAX {
                break;
            }
            corners.push((corner(end), None));
            corners.extend(cusp);
            end = to;
        }
        if !corners.is_empty() {
            loops.push(corners);
        }
    }
    loops
}

/// Greatest number of corners between two cusps for which the part of the loop between them is triangulated separately.
const MAX_BETWEEN_CUSPS: usize = 2;

/// Triangulates a loop.
///
/// Between cusps it runs along upper or lower surfaces. With a cusp in each of two sides of the prism, both parts are
/// triangulated separately, so that no facet joins an upper to a lower surface. Other loops get a vertex in their
/// middle. Facets between their corners alone could lie in a side of the prism and share an edge with two facets of the
/// neighbour (an edge of four facets is not manifold), or have no area in a wall, where two of the columns coincide.
fn triangulate_loop<T: FacetSink>(
    corners: &[LoopCorner],
    sink: &mut T,
) -> Result<(), ExchangeError> {
    let is_cusp = |place: &usize| corners[*place].1.is_some();
    let cusps: Vec<usize> = (0..corners.len()).filter(is_cusp).collect();
    let round = |places: std::ops::RangeInclusive<usize>| -> Vec<Corner> {
        let corner = |place: usize| corners[place % corners.len()].0;
        places.map(corner).collect()
    };
    match cusps[..] {
        [] if corners.len() == 3 => fan(&round(0..=2), sink),
        [one, other]
            if !T::IS_WALL
                && corners[one].1 != corners[other].1
                && other - one - 1 <= MAX_BETWEEN_CUSPS
                && corners.len() - (other - one) - 1 <= MAX_BETWEEN_CUSPS =>
        {
            // Around the same cusp, so that upper and lower facets do not cross where the piece is thin.
            fan(&round(one..=other), sink)?;
            let mut back = vec![corners[one].0];
            back.extend(round(other..=one + corners.len() - 1));
            fan(&back, sink)
        }
        _ => {
            let mut around = vec![sink.add_vertex(middle(corners))];
            around.extend(round(0..=corners.len()));
            fan(&around, sink)
        }
    }
}

/// Mean of the corners of a loop.
fn middle(corners: &[LoopCorner]) -> Point {
    [0, 1, 2].map(|axis| {
        let along = corners.iter().map(|(corner, _)| f64::from(corner.at[axis]));
        (along.sum::<f64>() / corners.len() as f64) as f32
    })
}

/// Adds a triangle fan around the first of these corners.
fn fan(corners: &[Corner], sink: &mut impl FacetSink) -> Result<(), ExchangeError> {
    for two in corners.get(1..).unwrap_or_default().windows(2) {
        sink.add_facet([corners[0], two[0], two[1]])?;
    }
    Ok(())
}
