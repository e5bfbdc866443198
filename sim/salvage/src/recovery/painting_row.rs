//! Rows of a painting's tables, recognised by their tags and checked by their checksums.

use maulstick_document::DocumentError;
use maulstick_document::file::database::Database;
use maulstick_document::tables::checksum::Checksum;
use maulstick_document::tables::schema::Table;
use rusqlite::types::{ToSqlOutput, Value as Stored, ValueRef};

use crate::sqlite::{Row, Value};

/// Row of a painting's table that matches its checksum.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct PaintingRow {
    pub(super) table: Table,
    /// Columns between tag and checksum, of the kinds of [`Table::columns`].
    pub(super) values: Vec<Value>,
}

/// Kind of a row.
#[derive(Debug)]
pub(super) enum RowKind {
    Intact(PaintingRow),
    /// Row with a wrong checksum or shape; its table and key, where known.
    Damaged(Option<(Table, i64)>),
    /// Row of the schema.
    Schema,
}

impl PaintingRow {
    /// Row with these columns.
    pub(super) fn new(table: Table, values: Vec<Value>) -> Self {
        Self { table, values }
    }

    /// Recognises and checks a row.
    pub(super) fn read(row: Row) -> RowKind {
        let Row { rowid, values, .. } = row;
        let (tag, sum) = match values.as_slice() {
            [Value::Int(tag), .., Value::Int(sum)] => (*tag, *sum),
            [Value::Text(_), _, _, _, _] => return RowKind::Schema,
            _ => return RowKind::Damaged(None),
        };
        let Some(table) = Table::of(tag) else {
            return RowKind::Damaged(None);
        };
        let columns = table.columns();
        let damaged = RowKind::Damaged(Some((table, rowid)));
        if values.len() != columns.len() + 2 {
            return damaged;
        }
        let mut values: Vec<Value> = values.into_iter().skip(1).take(columns.len()).collect();
        if columns.starts_with('i')
            && let Some(key @ Value::Null) = values.first_mut()
        {
            *key = Value::Int(rowid);
        }
        let fit = values.iter().zip(columns.chars()).all(|(value, kind)| {
            matches!(
                (value, kind),
                (Value::Int(_), 'i') | (Value::Text(_), 't') | (Value::Blob(_), 'b')
            )
        });
        let found = Self { table, values };
        if fit && found.checksum() == sum {
            RowKind::Intact(found)
        } else {
            damaged
        }
    }

    fn checksum(&self) -> i64 {
        let add = |sum: Checksum, value: &Value| match value {
            Value::Int(number) => sum.int(*number),
            Value::Text(text) => sum.bytes(text.as_bytes()),
            Value::Blob(bytes) => sum.bytes(bytes),
            Value::Null | Value::Real(_) => sum,
        };
        let sum = self.values.iter().fold(Checksum::new(self.table), add);
        sum.finish()
    }

    /// Writes the row, with its checksum; it replaces a row with the same key.
    ///
    /// # Errors
    /// The error of SQLite.
    pub(super) fn write(&self, database: &Database) -> Result<(), DocumentError> {
        let places: Vec<String> = (1..=self.values.len() + 2)
            .map(|at| format!("?{at}"))
            .collect();
        let insert = format!(
            "INSERT OR REPLACE INTO {} VALUES({})",
            self.table.name(),
            places.join(", ")
        );
        let own = |number: i64| ToSqlOutput::Owned(Stored::Integer(number));
        let columns = self.values.iter().map(|value| match value {
            Value::Int(number) => own(*number),
            Value::Real(number) => ToSqlOutput::Owned(Stored::Real(*number)),
            Value::Null => ToSqlOutput::Owned(Stored::Null),
            Value::Text(text) => ToSqlOutput::Borrowed(ValueRef::Text(text.as_bytes())),
            Value::Blob(bytes) => ToSqlOutput::Borrowed(ValueRef::Blob(bytes)),
        });
        let all = [own(self.table as i64)].into_iter().chain(columns);
        let all = all.chain([own(self.checksum())]);
        database
            .connection()
            .prepare_cached(&insert)?
            .execute(rusqlite::params_from_iter(all))?;
        Ok(())
    }

    /// Integer column; 0 if it is of another kind.
    pub(super) fn int(&self, column: usize) -> i64 {
        match self.values.get(column) {
            Some(Value::Int(number)) => *number,
            _ => 0,
        }
    }

    /// Text column; empty if it is of another kind.
    pub(super) fn text(&self, column: usize) -> &str {
        match self.values.get(column) {
            Some(Value::Text(text)) => text,
            _ => "",
        }
    }

    /// Blob column; empty if it is of another kind.
    pub(super) fn blob(&self, column: usize) -> &[u8] {
        match self.values.get(column) {
            Some(Value::Blob(bytes)) => bytes,
            _ => &[],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sqlite::Origin;

    fn row(values: Vec<Value>) -> Row {
        Row {
            rowid: 7,
            values,
            page: 2,
            origin: Origin::Main,
            current: true,
        }
    }

    #[test]
    fn a_row_is_recognised_by_its_tag_and_a_damaged_one_by_its_checksum() {
        let sum = Checksum::new(Table::Load).int(7).bytes(b"paint").finish();
        let values = |data: &[u8], sum: i64| {
            let data = Value::Blob(data.to_vec());
            vec![Value::Int(5), Value::Null, data, Value::Int(sum)]
        };
        let RowKind::Intact(found) = PaintingRow::read(row(values(b"paint", sum))) else {
            panic!("it is intact");
        };
        assert_eq!((found.int(0), found.blob(1)), (7, &b"paint"[..]));
        for other in [values(b"pain", sum), values(b"paint", sum ^ 1)] {
            let damaged = PaintingRow::read(row(other));
            assert!(matches!(damaged, RowKind::Damaged(Some((Table::Load, 7)))));
        }
        let mut page = values(b"paint", sum);
        page[0] = Value::Int(3);
        assert!(matches!(
            PaintingRow::read(row(page)),
            RowKind::Damaged(Some((Table::Page, 7)))
        ));
        assert!(matches!(
            PaintingRow::read(row(vec![Value::Int(99)])),
            RowKind::Damaged(None)
        ));
        let schema = vec![Value::Text("table".into()); 5];
        assert!(matches!(PaintingRow::read(row(schema)), RowKind::Schema));
    }
}
