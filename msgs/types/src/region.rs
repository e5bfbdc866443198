//! A rectangle of a surface, as commands name it.

use std::fmt;
use std::str::FromStr;

use crate::values::ValueError;
use crate::wire::define::wire_struct;

/// No region reaches farther than this from its surface's origin, m.
const FARTHEST_M: f64 = 1e4;

wire_struct! {
    /// A rectangle in a surface's frame: origin at the surface's lower left corner, x right, y up. It
    /// holds the cells whose middle lies in it; it may reach beyond the surface.
    #[serde(try_from = "RegionFields")]
    pub struct Region {
        /// Its lower left corner, m.
        pub corner_m: [f64; 2],
        /// Its width and height, m.
        pub size_m: [f64; 2],
    }
}

/// A region as it is decoded.
#[derive(serde::Deserialize)]
struct RegionFields {
    corner_m: [f64; 2],
    size_m: [f64; 2],
}

impl TryFrom<RegionFields> for Region {
    type Error = ValueError;

    fn try_from(fields: RegionFields) -> Result<Self, ValueError> {
        let region = Self {
            corner_m: fields.corner_m,
            size_m: fields.size_m,
        };
        region.check()?;
        Ok(region)
    }
}

impl Region {
    /// Checks that it is finite and not empty.
    ///
    /// # Errors
    /// [`ValueError::Region`].
    pub fn check(&self) -> Result<(), ValueError> {
        let near = self.corner_m.iter().all(|m| m.abs() <= FARTHEST_M);
        let wide = self.size_m.iter().all(|m| *m > 0.0 && *m <= FARTHEST_M);
        if near && wide {
            Ok(())
        } else {
            Err(ValueError::Region(self.to_string()))
        }
    }

    /// The cells of side `cell_m` whose middle lies in it, of a surface of `cells`: the first column and
    /// row, and one past the last. None where there are none.
    #[must_use]
    pub fn cells(&self, cells: [u32; 2], cell_m: f64) -> Option<[[u32; 2]; 2]> {
        let edge = |axis: usize, m: f64| {
            let middle = (m / cell_m - 0.5).ceil();
            middle.clamp(0.0, f64::from(cells[axis])) as u32
        };
        let from = [0, 1].map(|axis| edge(axis, self.corner_m[axis]));
        let to = [0, 1].map(|axis| edge(axis, self.corner_m[axis] + self.size_m[axis]));
        (from[0] < to[0] && from[1] < to[1]).then_some([from, to])
    }
}

impl fmt::Display for Region {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Millimetres without the noise of the last digit.
        let mm = |m: f64| (m * 1e9).round() * 1e-6;
        let ([x, y], [w, h]) = (self.corner_m.map(mm), self.size_m.map(mm));
        write!(f, "{x},{y},{w}x{h} mm")
    }
}

impl FromStr for Region {
    type Err = ValueError;

    /// Reads `X,Y,WxH`, in mm of the surface from its lower left corner.
    fn from_str(text: &str) -> Result<Self, ValueError> {
        let wrong = || ValueError::Region(text.chars().take(40).collect());
        let parts: Vec<&str> = text.trim_end_matches("mm").split(',').collect();
        let [x, y, size] = parts[..] else {
            return Err(wrong());
        };
        let metres = |mm: &str| mm.trim().parse::<f64>().map(|mm| mm * 1e-3);
        let metres = |mm: &str| metres(mm).map_err(|_| wrong());
        let size_mm: [f64; 2] = sides(size).ok_or_else(wrong)?;
        let region = Self {
            corner_m: [metres(x)?, metres(y)?],
            size_m: size_mm.map(|mm| mm * 1e-3),
        };
        region.check()?;
        Ok(region)
    }
}

/// Reads `WxH`; `None` for another text.
#[must_use]
pub fn sides<T: FromStr>(text: &str) -> Option<[T; 2]> {
    let (width, height) = text.split_once(['x', 'X', '×'])?;
    let side = |side: &str| side.trim().parse().ok();
    Some([side(width)?, side(height)?])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_region_holds_the_cells_whose_middle_lies_in_it() {
        let region: Region = "10,20,60x40".parse().expect("a region");
        assert_eq!(region.to_string(), "10,20,60x40 mm");
        assert_eq!(region.to_string().parse(), Ok(region.clone()));
        assert_eq!(
            region.cells([1024, 1024], 2.5e-4),
            Some([[40, 80], [280, 240]])
        );
        assert_eq!(
            region.cells([100, 100], 2.5e-4),
            Some([[40, 80], [100, 100]])
        );
        assert_eq!(region.cells([40, 100], 2.5e-4), None, "beside");
        let part: Region = "0.1,0.1,0.02x9".parse().expect("a region");
        assert_eq!(part.cells([8, 8], 2.5e-4), None, "between two middles");
        let middle: Region = "0.1,0.1,0.05x0.05".parse().expect("a region");
        assert_eq!(middle.cells([8, 8], 2.5e-4), Some([[0, 0], [1, 1]]));
        let around: Region = "-5,-5,100x100".parse().expect("a region");
        assert_eq!(around.cells([8, 9], 2.5e-4), Some([[0, 0], [8, 9]]));
    }

    #[test]
    fn what_is_no_region_is_refused() {
        for text in [
            "",
            "1,2",
            "1,2,3",
            "1,2,0x4",
            "1,2,-3x4",
            "NaN,2,3x4",
            "1,2,infx4",
            "a,2,3x4",
        ] {
            let what = text.parse::<Region>().expect_err(text).to_string();
            assert!(what.contains("X,Y,WxH"), "{what}");
        }
    }
}
