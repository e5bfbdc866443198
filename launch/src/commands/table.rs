//! Tables in text: columns as wide as their widest cell.

/// Greatest width of a column, characters; longer texts shift the rest of their line.
const WIDEST: usize = 100;

/// Rows with a head; all but the last column are padded.
#[must_use]
pub fn table<const N: usize>(head: [&str; N], rows: &[[String; N]]) -> String {
    let head = head.map(str::to_owned);
    let all = || std::iter::once(&head).chain(rows);
    let wide = |column: usize| all().map(|row| row[column].chars().count()).max();
    let last = N - 1;
    let widths: Vec<usize> = (0..last)
        .map(|column| wide(column).unwrap_or(0).min(WIDEST))
        .collect();
    let line = |row: &[String; N]| {
        let mut line = String::new();
        for (cell, width) in row.iter().zip(&widths) {
            line += &format!("{cell:<width$}  ");
        }
        line += &row[last];
        line.trim_end().to_owned() + "\n"
    };
    all().map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::table;

    #[test]
    fn columns_stand_below_their_heads() {
        let rows = [["a", "1"], ["longer", "22"]].map(|row| row.map(str::to_owned));
        assert_eq!(
            table(["topic", "n"], &rows),
            "topic   n\na       1\nlonger  22\n"
        );
        let long = "x".repeat(100_000);
        let lines = table(["topic", "n"], &[[long.clone(), "1".to_owned()]]);
        assert!(lines.ends_with(&format!("{long}  1\n")) && lines.len() < 101_000);
    }
}
