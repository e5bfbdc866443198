//! The separator of a table, and the cells of a line by it.

use csv_core::{ReadFieldResult, Reader, ReaderBuilder};

use crate::number::is_number;

/// Lines by which a separator is chosen.
const CHOSEN_BY: usize = 64;

/// Separator of the cells of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Separator {
    /// `;`, as spreadsheets write that use decimal commas.
    Semicolon,
    /// A tab.
    Tab,
    /// `,`.
    Comma,
    /// Any number of blanks and tabs; there are no empty cells.
    Blanks,
}

impl Separator {
    const fn byte(self) -> u8 {
        match self {
            Self::Semicolon => b';',
            Self::Tab => b'\t',
            Self::Comma => b',',
            Self::Blanks => b' ',
        }
    }

    /// The separator under which most cells of some lines are numbers. Blanks are one where nothing else is, or where they
    /// part a table all of whose cells below the first line are numbers: words have blanks in them.
    pub(crate) fn choose<'a>(lines: impl Iterator<Item = &'a str>) -> Self {
        let lines: Vec<&str> = lines.take(CHOSEN_BY).collect();
        let others =
            [Self::Semicolon, Self::Tab, Self::Comma].map(|one| (one, Score::of(one, &lines)));
        let blanks = (Self::Blanks, Score::of(Self::Blanks, &lines));
        let mut found = others
            .iter()
            .filter(|(_, score)| score.parts)
            .copied()
            .collect::<Vec<_>>();
        if found.is_empty() || (blanks.1.words == 0 && blanks.1.numbers > 0) {
            found.push(blanks);
        }
        // The first of the best.
        let best = found
            .iter()
            .rev()
            .max_by_key(|(_, score)| (score.numbers - score.words, -score.words_above));
        best.map_or(Self::Comma, |(separator, _)| *separator)
    }
}

/// Fit of a separator to some lines.
#[derive(Clone, Copy, Debug, Default)]
struct Score {
    /// It parts a line into cells.
    parts: bool,
    numbers: i64,
    /// Cells below the first line, which may be headings, that are neither numbers nor empty.
    words: i64,
    /// Those of the first line.
    words_above: i64,
}

impl Score {
    fn of(separator: Separator, lines: &[&str]) -> Self {
        let mut score = Self::default();
        let mut cutter = Cutter::new(separator);
        for (number, line) in lines.iter().enumerate() {
            let mut cells = 0;
            let cut = cutter.cut(line, |cell| {
                cells += 1;
                match (cell.is_empty(), is_number(cell)) {
                    (true, _) => {}
                    (_, true) => score.numbers += 1,
                    (_, false) if number > 0 => score.words += 1,
                    (_, false) => score.words_above += 1,
                }
            });
            score.parts |= cut.is_ok() && cells > 1;
        }
        score
    }
}

/// A quote that nothing closes on its line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct OpenQuote;

/// Cuts lines into cells.
pub(crate) struct Cutter {
    separator: Separator,
    reader: Reader,
    line: Vec<u8>,
    cell: Vec<u8>,
}

impl Cutter {
    pub(crate) fn new(separator: Separator) -> Self {
        Self {
            separator,
            reader: ReaderBuilder::new().delimiter(separator.byte()).build(),
            line: Vec::new(),
            cell: Vec::new(),
        }
    }

    /// Hands the cells of a line, which is not blank, to `each`, without blanks around them. Quotes count behind blanks too.
    pub(crate) fn cut(&mut self, line: &str, mut each: impl FnMut(&str)) -> Result<(), OpenQuote> {
        let is_blank =
            |byte: u8| byte == b' ' || (byte == b'\t' && self.separator != Separator::Tab);
        self.line.clear();
        self.line.extend(
            line.trim_matches(|letter: char| u8::try_from(letter).is_ok_and(is_blank))
                .bytes(),
        );
        if self.separator == Separator::Blanks {
            self.line
                .iter_mut()
                .filter(|byte| **byte == b'\t')
                .for_each(|byte| *byte = b' ');
        }
        self.line.push(b'\n');
        self.cell.resize(self.cell.len().max(self.line.len()), 0);
        self.reader.reset();
        let mut rest = self.line.as_slice();
        loop {
            let blanks = rest.iter().take_while(|byte| is_blank(**byte)).count();
            rest = &rest[blanks..];
            let (result, read, written) = self.reader.read_field(rest, &mut self.cell);
            let ReadFieldResult::Field { record_end } = result else {
                return Err(OpenQuote);
            };
            rest = &rest[read..];
            each(String::from_utf8_lossy(&self.cell[..written]).trim());
            if record_end {
                return Ok(());
            }
        }
    }
}
