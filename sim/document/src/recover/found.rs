//! Rows as a scan finds them, sorted by kind and checked.

use rusqlite::types::{ToSqlOutput, Value as Stored, ValueRef};

use crate::database::Database;
use crate::error::DocumentError;
use crate::scan::{Row, Value};
use crate::schema::Table;
use crate::sum::Sum;

/// A row of a painting's table that matches its checksum.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Found {
    pub(super) table: Table,
    /// The columns between tag and sum, of the kinds that [`Table::columns`] says.
    pub(super) values: Vec<Value>,
}

/// Kind of a row.
#[derive(Debug)]
pub(super) enum Read {
    Whole(Found),
    /// A row that is not what was written; its table and key, as far as they are known.
    Torn(Option<(Table, i64)>),
    /// A row of the schema.
    Schema,
}

impl Found {
    /// A row of these values, whatever stands for its key.
    pub(super) fn of(table: Table, values: Vec<Value>) -> Self {
        Self { table, values }
    }

    /// Tells what a row is.
    pub(super) fn read(row: Row) -> Read {
        let Row { rowid, values, .. } = row;
        let (tag, sum) = match values.as_slice() {
            [Value::Int(tag), .., Value::Int(sum)] => (*tag, *sum),
            [Value::Text(_), _, _, _, _] => return Read::Schema,
            _ => return Read::Torn(None),
        };
        let Some(table) = Table::of(tag) else {
            return Read::Torn(None);
        };
        let columns = table.columns();
        let torn = Read::Torn(Some((table, rowid)));
        if values.len() != columns.len() + 2 {
            return torn;
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
        match fit && found.sum() == sum {
            true => Read::Whole(found),
            false => torn,
        }
    }

    fn sum(&self) -> i64 {
        let add = |sum: Sum, value: &Value| match value {
            Value::Int(number) => sum.int(*number),
            Value::Text(text) => sum.bytes(text.as_bytes()),
            Value::Blob(bytes) => sum.bytes(bytes),
            Value::Null | Value::Real(_) => sum,
        };
        let sum = self.values.iter().fold(Sum::of(self.table), add);
        sum.done()
    }

    /// Writes it, with its checksum, in the place of one with its key.
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
        let all = all.chain([own(self.sum())]);
        database
            .connection
            .prepare_cached(&insert)?
            .execute(rusqlite::params_from_iter(all))?;
        Ok(())
    }

    /// An integer of it.
    pub(super) fn int(&self, column: usize) -> i64 {
        match self.values.get(column) {
            Some(Value::Int(number)) => *number,
            _ => 0,
        }
    }

    /// A text of it.
    pub(super) fn text(&self, column: usize) -> &str {
        match self.values.get(column) {
            Some(Value::Text(text)) => text,
            _ => "",
        }
    }

    /// A blob of it.
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
    use crate::scan::Origin;

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
    fn a_row_is_told_by_its_tag_and_a_wrong_one_by_its_sum() {
        let sum = Sum::of(Table::Load).int(7).bytes(b"paint").done();
        let values = |data: &[u8], sum: i64| {
            let data = Value::Blob(data.to_vec());
            vec![Value::Int(5), Value::Null, data, Value::Int(sum)]
        };
        let Read::Whole(found) = Found::read(row(values(b"paint", sum))) else {
            panic!("it is whole");
        };
        assert_eq!((found.int(0), found.blob(1)), (7, &b"paint"[..]));
        for other in [values(b"pain", sum), values(b"paint", sum ^ 1)] {
            let torn = Found::read(row(other));
            assert!(matches!(torn, Read::Torn(Some((Table::Load, 7)))));
        }
        let mut page = values(b"paint", sum);
        page[0] = Value::Int(3);
        assert!(matches!(
            Found::read(row(page)),
            Read::Torn(Some((Table::Page, 7)))
        ));
        assert!(matches!(
            Found::read(row(vec![Value::Int(99)])),
            Read::Torn(None)
        ));
        let schema = vec![Value::Text("table".into()); 5];
        assert!(matches!(Found::read(row(schema)), Read::Schema));
    }
}
