//! Outlines as files: SVG, takes, tables of points.

use std::path::Path;

use kurbo::{Affine, BezPath, PathEl, Point, flatten};
use maulstick_device::Take;
use maulstick_motion::{Outline, strokes};
use maulstick_rig::UserError;
use maulstick_tables::{Fault, HeadingLine, Separator, Table, TableError, decode};
use usvg::tiny_skia_path::PathSegment;
use usvg::{Group, Node, Options, Tree};

use maulstick_tool_options::motion::refused;

/// Length of a CSS pixel, m: 96 an inch.
const PIXEL_M: f64 = 0.0254 / 96.0;
/// Largest distance of a curve from its polygon, m.
const TOLERANCE_M: f64 = 2e-5;
/// Beginning of an MCAP file.
const MCAP: &[u8] = b"\x89MCAP";
/// Largest file that is read, bytes.
const LARGEST: usize = 64 << 20;

/// Closed contours, m.
type Contours = Vec<Vec<[f64; 2]>>;

/// Reads an outline. `head_m` is the length of the 6-DOF stylus's head that drew it, m.
///
/// # Errors
/// A [`UserError`] for a file that cannot be read or encloses nothing.
pub(crate) fn read_outline(path: &Path, head_m: f64) -> Result<Outline, UserError> {
    let bytes = std::fs::read(path).map_err(|error| UserError::reading(path, &error))?;
    let contours = if bytes.starts_with(MCAP) {
        of_take(&Take::read(path)?, head_m)
    } else {
        of_text(&bytes).map_err(|error| {
            let line = error.line().map(|line| format!(":{line}"));
            UserError::usage(error.to_string())
                .at(format!("{}{}", path.display(), line.unwrap_or_default()))
                .help(error.help())
        })?
    };
    Outline::new(&contours).map_err(refused(path))
}

/// Each stroke of a take as a closed line.
fn of_take(take: &Take, head_m: f64) -> Contours {
    let contour = |stroke: &maulstick_motion::Stroke| {
        let path = stroke.path(&take.samples, head_m).into_iter();
        path.map(|[x, y, _]| [x, y]).collect()
    };
    strokes(&take.samples, head_m).iter().map(contour).collect()
}

/// Reason why a file is no outline.
#[derive(Debug, thiserror::Error)]
enum OutlineError {
    /// More than [`LARGEST`].
    #[error("the outline has more than 64 MB")]
    TooLarge,
    /// Bytes that are no text.
    #[error("this is no outline")]
    NoText,
    /// A text that begins as SVG does.
    #[error(transparent)]
    Svg(#[from] usvg::Error),
    /// An SVG file with none.
    #[error("it holds no shape")]
    NoShape,
    /// A table that is none of numbers.
    #[error("{}", .0.what())]
    Table(#[from] TableError),
    /// A line that may be read in two ways.
    #[error("two points on a line, or one with decimal commas?")]
    TwoPoints(usize),
    /// A table of nothing.
    #[error("it has no points")]
    NoPoints,
}

impl OutlineError {
    /// Line of a table, from 1.
    fn line(&self) -> Option<usize> {
        match self {
            Self::Table(error) => Some(error.line),
            Self::TwoPoints(line) => Some(*line),
            _ => None,
        }
    }

    /// Advice to a user.
    fn help(&self) -> &'static str {
        match self {
            Self::TooLarge => "leave out what is no outline",
            Self::NoText => "name an SVG file, a take or a table of x,y",
            Self::Svg(_) | Self::NoShape => "save it as plain SVG with a path or a polygon",
            Self::TwoPoints(_) => "write a point a line, as x;y",
            Self::Table(error) if matches!(error.fault, Fault::TwoReadings { .. }) => {
                error.fault.help()
            }
            Self::Table(_) | Self::NoPoints => {
                "each line is: x,y in mm; or name an SVG file, or a take"
            }
        }
    }
}

fn of_text(bytes: &[u8]) -> Result<Contours, OutlineError> {
    if bytes.len() > LARGEST {
        return Err(OutlineError::TooLarge);
    }
    let text = decode(bytes).map_err(|_| OutlineError::NoText)?;
    let text = text.trim_start_matches('\u{feff}');
    if text.trim_start().starts_with('<') {
        of_svg(text)
    } else {
        of_table(text)
    }
}

/// The shapes of an SVG file. The middle of its page is the middle of the desk, and a CSS pixel is 1/96 inch.
fn of_svg(text: &str) -> Result<Contours, OutlineError> {
    let tree = Tree::from_str(text, &Options::default())?;
    let (width, height) = (
        f64::from(tree.size().width()),
        f64::from(tree.size().height()),
    );
    // y points down on the page.
    let to_desk = Affine::scale_non_uniform(PIXEL_M, -PIXEL_M)
        * Affine::translate((-0.5 * width, -0.5 * height));
    let mut contours = Contours::new();
    shapes(tree.root(), to_desk, &mut contours);
    if contours.is_empty() {
        Err(OutlineError::NoShape)
    } else {
        Ok(contours)
    }
}

fn shapes(group: &Group, to_desk: Affine, contours: &mut Contours) {
    for node in group.children() {
        match node {
            Node::Group(group) => shapes(group, to_desk, contours),
            Node::Path(path) if path.is_visible() => {
                let to_page = path.abs_transform();
                let terms = [
                    to_page.sx, to_page.ky, to_page.kx, to_page.sy, to_page.tx, to_page.ty,
                ];
                let own = to_desk * Affine::new(terms.map(f64::from));
                polygons(&(own * bezier(path.data())), contours);
            }
            Node::Path(_) | Node::Image(_) | Node::Text(_) => {}
        }
    }
}

fn bezier(path: &usvg::tiny_skia_path::Path) -> BezPath {
    let at = |point: usvg::tiny_skia_path::Point| Point::new(point.x.into(), point.y.into());
    let mut curve = BezPath::new();
    for segment in path.segments() {
        match segment {
            PathSegment::MoveTo(to) => curve.move_to(at(to)),
            PathSegment::LineTo(to) => curve.line_to(at(to)),
            PathSegment::QuadTo(by, to) => curve.quad_to(at(by), at(to)),
            PathSegment::CubicTo(one, two, to) => curve.curve_to(at(one), at(two), at(to)),
            PathSegment::Close => curve.close_path(),
        }
    }
    curve
}

/// The closed polygons of a path, within [`TOLERANCE_M`].
fn polygons(path: &BezPath, contours: &mut Contours) {
    let mut contour: Vec<[f64; 2]> = Vec::new();
    flatten(path, TOLERANCE_M, |element| match element {
        PathEl::MoveTo(to) => {
            contours.push(std::mem::take(&mut contour));
            contour.push([to.x, to.y]);
        }
        PathEl::LineTo(to) => contour.push([to.x, to.y]),
        PathEl::QuadTo(..) | PathEl::CurveTo(..) | PathEl::ClosePath => {}
    });
    contours.push(contour);
    contours.retain(|contour| contour.len() > 2);
}

/// A table of x,y in mm from the middle of the desk, y up; an empty line begins another contour.
fn of_table(text: &str) -> Result<Contours, OutlineError> {
    let table = Table::parse(text, HeadingLine::Words)?;
    let mut contours = Contours::new();
    let mut block = None;
    for row in table.rows() {
        // SVG writes points as x,y x,y.
        let is_pair = |cell: &str| cell.contains(',');
        if table.separator() == Separator::Blanks && row.cells().all(is_pair) {
            return Err(OutlineError::TwoPoints(row.line()));
        }
        let point = row.numbers::<2>()?.map(|mm| 1e-3 * mm);
        if block.replace(row.block()) != Some(row.block()) {
            contours.push(Vec::new());
        }
        if let Some(contour) = contours.last_mut() {
            contour.push(point);
        }
    }
    if contours.is_empty() {
        Err(OutlineError::NoPoints)
    } else {
        Ok(contours)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(contour: &[[f64; 2]]) -> f64 {
        let next = contour.iter().cycle().skip(1);
        let twice: f64 = contour
            .iter()
            .zip(next)
            .map(|(a, b)| a[0] * b[1] - a[1] * b[0])
            .sum();
        0.5 * twice.abs()
    }

    #[test]
    fn shapes_of_a_page_lie_about_the_middle_of_the_desk() {
        let page = r#"<svg xmlns="http://www.w3.org/2000/svg" width="100mm" height="60mm" viewBox="0 0 100 60">
            <g transform="translate(10 5)"><polygon points="0,0 20,0 20,10 0,10"/></g>
            <path d="M 90 30 a 20 20 0 1 0 -40 0 a 20 20 0 1 0 40 0 z" fill="none" stroke="black"/>
        </svg>"#;
        let contours = of_svg(page).expect("shapes");
        assert_eq!(contours.len(), 2);
        for (got, wanted) in
            contours[0]
                .iter()
                .zip([[-0.04, 0.025], [-0.02, 0.025], [-0.02, 0.015]])
        {
            for (got, wanted) in got.iter().zip(wanted) {
                assert!((got - wanted).abs() < 1e-7, "{:?}", contours[0]);
            }
        }
        let circle = std::f64::consts::PI * 0.02 * 0.02;
        assert!(
            (area(&contours[1]) / circle - 1.0).abs() < 0.005,
            "{}",
            area(&contours[1])
        );
        assert!(of_svg("<svg xmlns='http://www.w3.org/2000/svg'/>").is_err());
        assert!(of_svg("<html>").is_err());
    }

    #[test]
    fn a_table_has_points_and_says_which_is_none() {
        let contours =
            of_text(b"x,y\n# a leaf\n0,0\n10,0\n10,20\n\n1,1\n2,1\n2,2\n").expect("read");
        assert_eq!(contours.iter().map(Vec::len).collect::<Vec<_>>(), [3, 3]);
        assert_eq!(contours[0][2], [0.01, 0.02]);
        for text in [
            "x;y\r0,5;0\r10;0,25\r10;20\r",
            "\"x\"\t\"y\"\n.5\t0\n10\t.25\n10\t20\n",
        ] {
            let contours = of_text(text.as_bytes()).expect("read");
            assert_eq!(
                contours,
                [[[0.0005, 0.0], [0.01, 0.00025], [0.01, 0.02]]],
                "{text:?}"
            );
        }
        for text in ["0,0\n10\n", "0,0\n10,x\n", "0,0\n1,2,3\n"] {
            let error = of_text(text.as_bytes()).expect_err(text);
            assert_eq!(error.line(), Some(2), "{text:?}");
        }
        let error = of_text(b"x,y\n0,0\n10,0\n1 1\n").expect_err("two separators");
        assert_eq!(error.line(), Some(4));
        let error = of_text(b"10,20 30,40\n").expect_err("two readings");
        assert_eq!(error.line(), Some(1));
        assert!(of_text(b"\xff\xfe").is_err());
    }
}
