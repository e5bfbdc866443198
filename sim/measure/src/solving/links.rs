//! Links: checks that samples tie every paint to the reference white.
//!
//! K and S are ratios (Baxter 2004, § 7.6): paints that share a sample are tied to each other, and drawdowns of known
//! thickness are tied by the metre. A group of paints without a tie to the white has one undetermined factor, and the
//! fit is singular.

use crate::error::MeasureError;
use crate::measurements::{Layer, Measurements};

/// Checks that each paint has a sample and that all groups are tied to the white. A single paint, for example with only
/// its masstone measured, passes while others are tied: its S is then a guess, of which the fit warns.
///
/// # Errors
/// A paint without a sample, or a group of paints that is not tied, with its line.
pub fn check_links(measured: &Measurements, white: usize) -> Result<(), MeasureError> {
    let paints = measured.paints.len();
    for (place, name) in measured.paints.iter().enumerate() {
        if !measured
            .samples
            .iter()
            .any(|sample| sample.shares[place] > 0.0)
        {
            let (column, _) = measured.headings.paints[place];
            let what = format!("no sample holds '{name}'");
            let help = "measure it alone and mixed with the white, or delete its column";
            return Err(MeasureError::new(what, help)
                .line(measured.heading_line)
                .column(column, name));
        }
    }
    let metre = paints;
    let mut groups = Groups((0..=paints).collect());
    for sample in &measured.samples {
        let mut used = (0..paints).filter(|j| sample.shares[*j] > 0.0);
        let first = used.next().unwrap_or(white);
        for other in used {
            groups.join(first, other);
        }
        if sample.layer != Layer::Opaque {
            groups.join(first, metre);
        }
    }
    let untied: Vec<usize> = (0..paints).filter(|j| !groups.same(*j, white)).collect();
    let alone = |j: usize, groups: &Groups| {
        !groups.same(j, metre) && (0..paints).filter(|other| groups.same(*other, j)).count() == 1
    };
    let none_tied = paints > 1 && untied.len() == paints - 1;
    let Some(lost) = untied
        .iter()
        .copied()
        .find(|j| none_tied || !alone(*j, &groups))
    else {
        return Ok(());
    };
    let names: Vec<String> = (0..paints)
        .filter(|other| groups.same(*other, lost))
        .map(|other| format!("'{}'", measured.paints[other]))
        .collect();
    let white = &measured.paints[white];
    let what = format!(
        "the fit is singular: no sample ties {} to the reference white '{white}'",
        names.join(", ")
    );
    let help = format!("measure a mixture of one of them with '{white}', 1:1 or 1:10");
    let first = measured
        .samples
        .iter()
        .find(|sample| sample.shares[lost] > 0.0);
    Err(MeasureError::new(what, help)
        .line(first.map_or(measured.heading_line, |sample| sample.line))
        .column(measured.headings.paints[lost].0, &measured.paints[lost]))
}

/// Disjoint sets: the parent of each member, a root being its own.
struct Groups(Vec<usize>);

impl Groups {
    fn root(&self, mut member: usize) -> usize {
        while self.0[member] != member {
            member = self.0[member];
        }
        member
    }

    fn join(&mut self, one: usize, other: usize) {
        let (one, other) = (self.root(one), self.root(other));
        self.0[one.max(other)] = one.min(other);
    }

    fn same(&self, one: usize, other: usize) -> bool {
        self.root(one) == self.root(other)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(rows: &str) -> Result<(), MeasureError> {
        let rows: Vec<String> = rows
            .split('/')
            .map(|row| format!("{row},.5,.5,.5"))
            .collect();
        let text = format!("thickness_um,over,W,A,B,400,500,600\n{}\n", rows.join("\n"));
        check_links(&Measurements::parse(&text).expect("good"), 0)
    }

    #[test]
    fn ties_go_through_mixtures_and_through_the_metre() {
        assert_eq!(check(",,1,,/,,.5,.5,/,,,.5,.5"), Ok(()));
        assert_eq!(check(",,1,,/,,.5,.5,/,,,,1"), Ok(()));
        assert_eq!(check("30,.5,1,,/30,.5,,1,/,,,.5,.5"), Ok(()));
    }

    #[test]
    fn what_nothing_ties_is_named() {
        let error = |rows: &str| check(rows).expect_err("singular").to_string();
        assert_eq!(
            error(",,1,,/,,,.5,.5/,,,.4,.6"),
            "line 3, column 4 (A): the fit is singular: no sample ties 'A', 'B' to the reference white 'W'"
        );
        for rows in [",,1,,/,,,1,/,,,,1", "30,.5,,1,/,,1,,/,,.5,,.5"] {
            let error = check(rows).expect_err("singular");
            assert_eq!(error.place.heading, "A");
            assert!(!error.what.contains("'B'"), "{error}");
        }
        assert_eq!(
            error(",,1,,/,,.5,.5,"),
            "line 1, column 5 (B): no sample holds 'B'"
        );
    }
}
