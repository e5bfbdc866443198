//! Motions of takes, as `recording replay` and the program of `tools/motions` speak of them.

use std::path::Path;

use clap::Args;
use maulstick_device::{Take, held_brush};
use maulstick_motion::MotionError;
use maulstick_rig::UserError;
use maulstick_types::stylus::StylusPose;

use crate::performance::of_a_brush;

/// Length of the head of a 6-DOF stylus.
#[derive(Args, Clone, Copy, Debug)]
pub struct HeadOptions {
    /// Length of the head that a 6-DOF stylus holds, mm: its point is so far below the ferrule [default: that of the brush
    /// that the take embeds, else of the brush of a new rig]
    #[arg(long, value_name = "MM")]
    head_mm: Option<f64>,
}

/// The head that a take is painted with.
#[derive(Clone, Copy, Debug)]
pub struct HeldHead {
    /// Its length, m.
    pub length_m: f64,
    /// Its width, m.
    pub width_m: f64,
}

impl HeadOptions {
    /// The head for painting a take: its embedded one, or that of a new rig.
    pub fn of(self, take: &Take, path: &Path) -> Result<HeldHead, UserError> {
        let file = held_brush(take, path).map_err(of_a_brush)?;
        let length_m = self.given_m()?.unwrap_or_else(|| file.length_m());
        Ok(HeldHead {
            length_m,
            width_m: 1e-3 * file.head.width_mm,
        })
    }

    /// The length that is given, m.
    pub(crate) fn given_m(self) -> Result<Option<f64>, UserError> {
        let is_wrong = |mm: &f64| !(1.0..=500.0).contains(mm);
        if let Some(mm) = self.head_mm.filter(is_wrong) {
            let what = format!("--head-mm {mm} is not within 1 and 500");
            return Err(UserError::usage(what).help("measure from the ferrule to the point"));
        }
        Ok(self.head_mm.map(|mm| 1e-3 * mm))
    }

    /// The length from [`of`](Self::of); 0 where the take has only pens, which have a point of their own.
    pub fn length_m(self, take: &Take, path: &Path) -> Result<f64, UserError> {
        let is_pen = |pose: &StylusPose| matches!(pose, StylusPose::Contact { .. });
        if take.samples.iter().all(|taken| is_pen(&taken.sample.pose)) {
            return Ok(0.0);
        }
        Ok(self.of(take, path)?.length_m)
    }
}

/// A fault of a motion as the user sees it.
pub fn refused(path: &Path) -> impl Fn(MotionError) -> UserError {
    move |fault| {
        let error = UserError::usage(fault.to_string()).at(path.display().to_string());
        error.help(fault.help())
    }
}

/// Parses `X,Y`, mm.
pub fn parse_place(text: &str) -> Result<[f64; 2], String> {
    let number = |part: &str| part.trim().parse::<f64>().ok().filter(|mm| mm.is_finite());
    text.split_once(',')
        .and_then(|(x, y)| Some([number(x)?, number(y)?]))
        .ok_or_else(|| format!("'{text}' is not a place such as 20,-12.5"))
}
