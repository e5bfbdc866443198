//! `maulstick demo fluid-force`: the force on a square that is swept through a fluid (Baxter 2004, § 8.9.2).

use std::fmt::Write as _;
use std::io::Write as _;

use indicatif::ProgressBar;
use maulstick_fluid_force::Boundary;
use maulstick_fluid_force::hand::{HandFilter, hand_ticks};
use maulstick_fluid_force::sweep::{Sample, arc_steps, arc_sweep, noise};
use maulstick_rig::UserError;
use maulstick_rig::files::{Kind, write_whole};
use maulstick_tool_options::figures::{Filter, FluidForceOptions};

use maulstick::commands::table::table;
use maulstick::commands::write_picture;
use maulstick::plot::{Axis, Curve, Panel, plot};
use maulstick::say;
use maulstick_painting_setup::outputs::{UsedFile, check_outputs};

const BOUNDARIES: [Boundary; 2] = [Boundary::Staircase, Boundary::Covered];
/// Head of the table; [`Kind::Forces`] knows it.
const HEAD: &str = "grid,boundary,t_s,x_m,y_m,angle_rad,f_drag_n_m,f_perp_n_m,torque_n,\
                    f_drag_filtered_n_m,f_perp_filtered_n_m,torque_filtered_n\n";

/// A sweep on one grid.
struct Sweep {
    cells: usize,
    boundary: Boundary,
    samples: Vec<Sample>,
}

/// Writes the table and the plot, and prints the noise.
///
/// # Errors
/// A [`UserError`] where a file cannot be written.
pub(crate) fn run(options: &FluidForceOptions) -> Result<i32, UserError> {
    let FluidForceOptions {
        output,
        grid: grids,
        filter,
        plot: picture,
    } = options;
    let (filter, picture) = (*filter, picture.as_ref());
    let forces = UsedFile::new("the table", output).of(Kind::Forces);
    let drawn = UsedFile::written("the plot", picture, Kind::Png);
    let outputs: Vec<_> = std::iter::once(forces).chain(drawn).collect();
    check_outputs(&outputs, &[])?;
    let all = grids.iter().flat_map(|cells| {
        let cells = usize::from(*cells);
        BOUNDARIES.map(|boundary| (cells, boundary))
    });
    let all: Vec<_> = all.collect();
    // Steps of a grid take as long as it has cells.
    let size = |cells: usize| (cells * cells) as u64;
    let bar = ProgressBar::new(all.iter().map(|(cells, _)| size(*cells)).sum::<u64>() * 3 / 2);
    let mut sweeps = Vec::new();
    let mut told = Vec::new();
    for (cells, boundary) in all {
        let begun = bar.position();
        let samples = arc_sweep(cells, boundary, |step| {
            bar.set_position(begun + size(cells) * step as u64 / arc_steps() as u64);
        });
        let noise = noise(cells, boundary);
        bar.inc(size(cells) / 2);
        let share = 100.0 * noise.noise_n / noise.drag_n;
        told.push([
            cells.to_string(),
            name(boundary).to_owned(),
            format!("{:.5}", noise.drag_n),
            format!("{share:.2}"),
        ]);
        sweeps.push(Sweep {
            cells,
            boundary,
            samples,
        });
    }
    bar.finish_and_clear();
    write_whole(output, Kind::Forces, |file| {
        file.write_all(HEAD.as_bytes())?;
        sweeps
            .iter()
            .try_for_each(|sweep| file.write_all(rows(sweep, filter).as_bytes()))
    })
    .map_err(|error| UserError::writing(output, &error))?;
    if let Some(path) = picture {
        write_picture(&plot(&panels(&sweeps))?, path)?;
    }
    let head = ["grid", "boundary", "drag N/m", "noise %"];
    for line in table(head, &told).lines() {
        say!("{line}");
    }
    Ok(0)
}

/// Name of a boundary in table and plot.
fn name(boundary: Boundary) -> &'static str {
    match boundary {
        Boundary::Staircase => "staircase",
        Boundary::Covered => "covered",
    }
}

/// Rows of a sweep, one a millisecond.
fn rows(sweep: &Sweep, filter: Filter) -> String {
    let filter = match filter {
        Filter::Period => HandFilter::Period,
        Filter::Dissertation => HandFilter::Dissertation,
    };
    let mut text = String::new();
    for tick in hand_ticks(&sweep.samples, filter) {
        let [x, y] = tick.state.place_m;
        let [drag, across, torque] = tick.raw;
        let [smooth_drag, smooth_across, smooth_torque] = tick.filtered;
        writeln!(
            text,
            "{},{},{:.3},{x:.6},{y:.6},{:.6},{drag:.6e},{across:.6e},{torque:.6e},\
             {smooth_drag:.6e},{smooth_across:.6e},{smooth_torque:.6e}",
            sweep.cells,
            name(sweep.boundary),
            tick.time_s,
            tick.state.angle_rad,
        )
        .ok();
    }
    text
}

/// A part of a sample.
type Part = fn(&Sample) -> f64;

/// Drag and torque by time, a panel for each boundary, a curve for each grid.
fn panels(sweeps: &[Sweep]) -> Vec<Panel> {
    let parts: [(&str, &str, Part); 2] = [
        ("drag", "force along the way there (N/m)", |it| it.drag_n),
        ("torque", "torque (N·m/m)", |it| it.torque_n_m),
    ];
    let mut panels = Vec::new();
    for (part, label, value) in parts {
        let all = || sweeps.iter().flat_map(|sweep| &sweep.samples);
        let range = around_zero(all().map(value));
        for boundary in BOUNDARIES {
            let with = sweeps.iter().filter(|sweep| sweep.boundary == boundary);
            let curve = |sweep: &Sweep| Curve {
                name: format!("{}²", sweep.cells),
                points: (sweep.samples.iter())
                    .map(|it| [it.time_s, value(it)])
                    .collect(),
            };
            panels.push(Panel {
                title: format!("{part}, {} boundary", name(boundary)),
                x: Axis {
                    label: "time (s)".into(),
                    range: [0.0, 4.0],
                },
                y: Axis {
                    label: label.into(),
                    range,
                },
                curves: with.map(curve).collect(),
            });
        }
    }
    panels
}

/// The ends of an axis about 0 that contains all `values`, with a margin.
fn around_zero(values: impl Iterator<Item = f64>) -> [f64; 2] {
    let most = values.fold(0.0, |most: f64, value| most.max(value.abs()));
    let end = if most > 0.0 { 1.05 * most } else { 1.0 };
    [-end, end]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_has_a_row_a_millisecond_and_its_head_is_known() {
        let sweep = Sweep {
            cells: 16,
            boundary: Boundary::Covered,
            samples: arc_sweep(16, Boundary::Covered, |_| {}),
        };
        let text = rows(&sweep, Filter::Period);
        assert_eq!(text.lines().count(), 4000);
        let columns = HEAD.split(',').count();
        assert!(text.lines().all(|line| line.split(',').count() == columns));
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("force.csv");
        std::fs::write(&path, HEAD).expect("written");
        assert!(maulstick_rig::files::gives_way(&path, Kind::Forces));
        let curves = panels(&[sweep])
            .iter()
            .map(|it| it.curves.len())
            .sum::<usize>();
        assert_eq!(curves, 2, "drag and torque");
    }
}
