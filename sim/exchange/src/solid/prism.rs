//! The surface within a triangle of three columns.
//!
//! The lines between each two of them ([`Strip`]) go round the triangle in closed loops, for each end of a column has one line
//! to either side. Each loop is filled with triangles. So a neighbour, which has the same lines the other way round, fits.

use super::strip::Strip;
use crate::ExchangeError;

/// A place.
pub(crate) type Point = [f32; 3];

/// A corner of a facet: its place, and its number among the vertices.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Corner {
    /// Where it is.
    pub(crate) at: Point,
    /// Its number.
    pub(crate) id: u32,
}

/// A column where it stands.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stand<'a> {
    /// Its place.
    pub(super) at: [f32; 2],
    /// Heights of its ends in the solid.
    pub(super) z: &'a [f32],
    /// Number of the vertex at its lowest end.
    pub(super) first: u32,
}

impl Stand<'_> {
    pub(super) fn corner(&self, end: usize) -> Corner {
        let [x, y] = self.at;
        Corner {
            at: [x, y, self.z[end]],
            id: self.first + end as u32,
        }
    }
}

/// The strip from a column of a triangle to the next one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Side<'a> {
    /// The lines.
    pub(super) strip: &'a Strip,
    /// Number of the vertex at its first cusp.
    pub(super) first: u32,
    /// How far its cusps are from their columns.
    pub(super) reach: f64,
    /// True if the strip is from the next column to this one.
    pub(super) is_reversed: bool,
}

/// Where the cusp of a turn lies on the way between two columns, the strip's first and second.
pub(super) fn cusp(side: &Side<'_>, turn: usize, [a, b]: [&Stand<'_>; 2]) -> Corner {
    let id = side.first + turn as u32;
    let turn = side.strip.turns[turn];
    let (own, other) = if turn.is_second { (b, a) } else { (a, b) };
    let way = |axis: usize| {
        let [from, to] = [own, other].map(|stand| f64::from(stand.at[axis]));
        (from + side.reach * (to - from)) as f32
    };
    let [low, high] = [turn.end, turn.end + 1].map(|end| f64::from(own.z[end]));
    Corner {
        at: [way(0), way(1), (0.5 * (low + high)) as f32],
        id,
    }
}

/// Takes the facets within triangles of columns.
pub(super) trait Take {
    /// True for triangles in a vertical plane.
    const IS_WALL: bool;

    /// One more vertex.
    fn vertex(&mut self, at: Point) -> Corner;

    /// A facet, counterclockwise from outside.
    fn facet(&mut self, corners: [Corner; 3]) -> Result<(), ExchangeError>;
}

/// Hands the facets within a triangle of columns, counterclockwise from above, to `take`; `sides` are from the first to the
/// second and so on round.
pub(super) fn facets(
    stands: &[Stand<'_>; 3],
    sides: &[Side<'_>; 3],
    take: &mut impl Take,
) -> Result<(), ExchangeError> {
    if stands.iter().all(|stand| stand.z.len() == 1) {
        return take.facet(stands.map(|stand| stand.corner(0)));
    }
    for corners in loops(stands, sides) {
        fill(&corners, take)?;
    }
    Ok(())
}

/// A corner on the way round a loop, and the side whose cusp it is if it is one.
type OnLoop = (Corner, Option<usize>);

fn loops(stands: &[Stand<'_>; 3], sides: &[Side<'_>; 3]) -> Vec<Vec<OnLoop>> {
    let counts = stands.each_ref().map(|stand| stand.z.len());
    let firsts = [0, counts[0], counts[0] + counts[1]];
    let mut next: Vec<(usize, Option<OnLoop>)> = vec![(usize::MAX, None); counts.iter().sum()];
    for (from, side) in sides.iter().enumerate() {
        let to = (from + 1) % 3;
        let (strip, reversed) = (side.strip, side.is_reversed);
        let mut join = |[own, other]: [usize; 2]| {
            let (own, other) = (firsts[from] + own, firsts[to] + other);
            // Tops go forth, bottoms back: paint is to the left as seen from the air.
            match (own - firsts[from]).is_multiple_of(2) {
                true => next[own] = (other, None),
                false => next[other] = (own, None),
            }
        };
        if counts[from] == 1 && counts[to] == 1 {
            join([0, 0]);
        }
        for [a, b] in &strip.joins {
            join(if reversed { [*b, *a] } else { [*a, *b] });
        }
        let [a, b] = if reversed { [to, from] } else { [from, to] };
        for (number, turn) in strip.turns.iter().enumerate() {
            let corner = (cusp(side, number, [&stands[a], &stands[b]]), Some(from));
            let is_next = turn.is_second != reversed;
            let low = firsts[if is_next { to } else { from }] + turn.end;
            let is_piece = !turn.end.is_multiple_of(2);
            match is_next == is_piece {
                true => next[low] = (low + 1, Some(corner)),
                false => next[low + 1] = (low, Some(corner)),
            }
        }
    }
    let corner = |end: usize| {
        let column = (0..3)
            .rev()
            .find(|column| end >= firsts[*column])
            .unwrap_or(0);
        stands[column].corner(end - firsts[column])
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

/// Corners of columns between two cusps at most, for the part of the loop between them to be filled by itself.
const BETWEEN_CUSPS: usize = 2;

/// Fills a loop.
///
/// From cusp to cusp it runs along upper or lower sides. With a cusp in each of two sides of the triangle, either part is
/// filled by itself, so that no facet goes from an upper to a lower side. Other loops are filled around a vertex in their
/// middle: facets between their corners alone could lie in a side of the triangle, have an edge that is a neighbour's too,
/// so that four facets share it, or in a wall, where two of the columns stand in one place, have no area.
fn fill<T: Take>(corners: &[OnLoop], take: &mut T) -> Result<(), ExchangeError> {
    let is_cusp = |place: &usize| corners[*place].1.is_some();
    let cusps: Vec<usize> = (0..corners.len()).filter(is_cusp).collect();
    let round = |places: std::ops::RangeInclusive<usize>| -> Vec<Corner> {
        let corner = |place: usize| corners[place % corners.len()].0;
        places.map(corner).collect()
    };
    match cusps[..] {
        [] if corners.len() == 3 => fan(&round(0..=2), take),
        [one, other]
            if !T::IS_WALL
                && corners[one].1 != corners[other].1
                && other - one - 1 <= BETWEEN_CUSPS
                && corners.len() - (other - one) - 1 <= BETWEEN_CUSPS =>
        {
            // Around the same cusp, so that upper and lower facets do not cross where the piece is thin.
            fan(&round(one..=other), take)?;
            let mut back = vec![corners[one].0];
            back.extend(round(other..=one + corners.len() - 1));
            fan(&back, take)
        }
        _ => {
            let mut around = vec![take.vertex(middle(corners))];
            around.extend(round(0..=corners.len()));
            fan(&around, take)
        }
    }
}

fn middle(corners: &[OnLoop]) -> Point {
    [0, 1, 2].map(|axis| {
        let along = corners.iter().map(|(corner, _)| f64::from(corner.at[axis]));
        (along.sum::<f64>() / corners.len() as f64) as f32
    })
}

/// Facets around the first of these corners.
fn fan(corners: &[Corner], take: &mut impl Take) -> Result<(), ExchangeError> {
    for two in corners.get(1..).unwrap_or_default().windows(2) {
        take.facet([corners[0], two[0], two[1]])?;
    }
    Ok(())
}
