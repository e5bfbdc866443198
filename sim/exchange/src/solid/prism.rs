//! The surface within a triangle of three columns.
//!
//! The lines between each two of them ([`Strip`]) go round the triangle in closed loops, for each end of a column has one line
//! to either side. Each loop is filled with triangles. So a neighbour, which has the same lines the other way round, fits.

use super::strip::Strip;

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

/// Hands the facets within a triangle of columns, counterclockwise from above, to `take`; `sides` are from the first to the
/// second and so on round.
pub(super) fn facets<E>(
    stands: &[Stand<'_>; 3],
    sides: &[Side<'_>; 3],
    mut take: impl FnMut([Corner; 3]) -> Result<(), E>,
) -> Result<(), E> {
    if stands.iter().all(|stand| stand.z.len() == 1) {
        return take(stands.map(|stand| stand.corner(0)));
    }
    for corners in loops(stands, sides) {
        fill(&corners, &mut take)?;
    }
    Ok(())
}

/// A corner on the way round a loop, and whether it is a cusp.
type OnLoop = (Corner, bool);

fn loops(stands: &[Stand<'_>; 3], sides: &[Side<'_>; 3]) -> Vec<Vec<OnLoop>> {
    let counts = stands.each_ref().map(|stand| stand.z.len());
    let firsts = [0, counts[0], counts[0] + counts[1]];
    let mut next: Vec<(usize, Option<Corner>)> = vec![(usize::MAX, None); counts.iter().sum()];
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
            let corner = cusp(side, number, [&stands[a], &stands[b]]);
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
            corners.push((corner(end), false));
            corners.extend(cusp.map(|corner| (corner, true)));
            end = to;
        }
        if !corners.is_empty() {
            loops.push(corners);
        }
    }
    loops
}

/// Fills a loop. From cusp to cusp it runs along upper or lower sides; each such part is filled by itself, so that no facet
/// goes from an upper to a lower side.
fn fill<E>(
    corners: &[OnLoop],
    take: &mut impl FnMut([Corner; 3]) -> Result<(), E>,
) -> Result<(), E> {
    let cusps: Vec<usize> = (0..corners.len())
        .filter(|place| corners[*place].1)
        .collect();
    let Some(first) = cusps.first() else {
        return fan(
            &corners
                .iter()
                .map(|(corner, _)| *corner)
                .collect::<Vec<_>>(),
            take,
        );
    };
    let mut part = Vec::new();
    for place in *first..=first + corners.len() {
        let (corner, is_cusp) = corners[place % corners.len()];
        part.push(corner);
        if is_cusp {
            fan(&part, take)?;
            part = vec![corner];
        }
    }
    fan(
        &cusps
            .iter()
            .map(|place| corners[*place].0)
            .collect::<Vec<_>>(),
        take,
    )
}

/// Facets around the first of these corners.
fn fan<E>(
    corners: &[Corner],
    take: &mut impl FnMut([Corner; 3]) -> Result<(), E>,
) -> Result<(), E> {
    for two in corners.get(1..).unwrap_or_default().windows(2) {
        take([corners[0], two[0], two[1]])?;
    }
    Ok(())
}
