//! The committed CSV tables: commas between fields, semicolons inside a field, no quotes.

use crate::error::SemanticsError;

/// A table with a head line.
pub(crate) struct CsvTable<'a> {
    file: &'static str,
    head: Vec<&'a str>,
    /// Shape (row, column).
    fields: Vec<&'a str>,
}

/// One row of a [`CsvTable`].
pub(crate) struct CsvRecord<'t, 'a> {
    table: &'t CsvTable<'a>,
    index: usize,
}

impl<'a> CsvTable<'a> {
    /// Splits `text`; every row must have as many fields as the head.
    pub(crate) fn parse(file: &'static str, text: &'a str) -> Result<Self, SemanticsError> {
        let mut lines = text.lines();
        let head: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
        let mut fields = Vec::with_capacity(text.len() / 4);
        for (k, line) in lines.enumerate() {
            let before = fields.len();
            fields.extend(line.split(','));
            let found = fields.len() - before;
            if found != head.len() || line.contains('"') {
                let what = format!("{found} fields, allowed are {} without quotes", head.len());
                return Err(SemanticsError::Table {
                    file,
                    line: k + 2,
                    what,
                });
            }
        }
        Ok(Self { file, head, fields })
    }

    /// The rows in file order.
    pub(crate) fn rows(&self) -> impl Iterator<Item = CsvRecord<'_, 'a>> {
        (0..self.fields.len() / self.head.len()).map(|index| CsvRecord { table: self, index })
    }
}

impl<'a> CsvRecord<'_, 'a> {
    /// A fault in this row.
    pub(crate) fn error(&self, what: String) -> SemanticsError {
        SemanticsError::Table {
            file: self.table.file,
            line: self.index + 2,
            what,
        }
    }

    /// The field under `column`.
    pub(crate) fn text(&self, column: &str) -> Result<&'a str, SemanticsError> {
        let place = self.table.head.iter().position(|name| *name == column);
        place
            .map(|k| self.table.fields[self.index * self.table.head.len() + k])
            .ok_or_else(|| self.error(format!("no column {column:?}")))
    }

    /// The parts of the field under `column`, split at semicolons; an empty field has none.
    pub(crate) fn list(&self, column: &str) -> Result<Vec<&'a str>, SemanticsError> {
        Ok(self
            .text(column)?
            .split(';')
            .filter(|part| !part.is_empty())
            .collect())
    }

    /// The number under `column`.
    pub(crate) fn number<N: std::str::FromStr>(&self, column: &str) -> Result<N, SemanticsError> {
        let text = self.text(column)?;
        text.parse()
            .map_err(|_| self.error(format!("{column} is {text:?}, allowed is a number")))
    }

    /// 0 or 1 under `column`.
    pub(crate) fn flag(&self, column: &str) -> Result<bool, SemanticsError> {
        match self.text(column)? {
            "0" => Ok(false),
            "1" => Ok(true),
            other => Err(self.error(format!("{column} is {other:?}, allowed are 0 and 1"))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_read_by_column_and_faults_name_their_line() {
        let table = CsvTable::parse("t.csv", "a,b\n1,x;y\n2,\n").unwrap();
        let rows: Vec<_> = table.rows().collect();
        assert_eq!(rows[0].list("b").unwrap(), ["x", "y"]);
        assert!(rows[1].list("b").unwrap().is_empty());
        assert_eq!(rows[1].number::<u32>("a").unwrap(), 2);
        let message = rows[1].flag("a").unwrap_err().to_string();
        assert_eq!(message, "t.csv line 3: a is \"2\", allowed are 0 and 1");
        assert!(CsvTable::parse("t.csv", "a,b\n1\n").is_err());
    }
}
