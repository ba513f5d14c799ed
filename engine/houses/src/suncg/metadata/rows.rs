//! Rows of a CSV table by column name.

use super::unreadable;
use crate::report::{FileLocation, LoadReport};
use crate::warning_kind::WarningKind;

/// A CSV table; columns are found by name, because later releases add some.
pub(super) struct CsvRows<'a> {
    reader: csv::Reader<&'a [u8]>,
    columns: Vec<Option<usize>>,
}

/// A row: the cells of the requested columns, empty where missing.
pub(super) struct CsvRow<'a> {
    record: &'a csv::StringRecord,
    columns: &'a [Option<usize>],
}

impl CsvRow<'_> {
    /// The cell of the `column`-th requested name.
    pub(super) fn cell(&self, column: usize) -> &str {
        self.columns[column]
            .and_then(|i| self.record.get(i))
            .unwrap_or("")
            .trim()
    }

    /// The same as a number.
    pub(super) fn number<T: std::str::FromStr>(&self, column: usize) -> Option<T> {
        self.cell(column).parse().ok()
    }

    /// The same as three numbers, `"x, y, z"`.
    pub(super) fn triple(&self, column: usize) -> Option<[f64; 3]> {
        let mut numbers = self
            .cell(column)
            .split(',')
            .map(|part| part.trim().parse::<f64>().ok().filter(|x| x.is_finite()));
        Some([numbers.next()??, numbers.next()??, numbers.next()??])
    }
}

impl<'a> CsvRows<'a> {
    /// A table with the columns `names`; the first must exist. `consequence`: what is not known without the table.
    pub(super) fn new(
        text: &'a [u8],
        names: &[&str],
        at: &FileLocation,
        consequence: &str,
        report: &mut LoadReport,
    ) -> Option<Self> {
        Self::read_head(text, names)
            .map_err(|reason| unreadable(at, reason, consequence, report))
            .ok()
    }

    fn read_head(text: &'a [u8], names: &[&str]) -> Result<Self, String> {
        if text.starts_with(b"\xff\xfe") || text.starts_with(b"\xfe\xff") {
            return Err("it is UTF-16; save it as UTF-8".to_owned());
        }
        let mut reader = csv::ReaderBuilder::new().flexible(true).from_reader(text);
        let headers = reader.headers().map_err(crate::plain_parse_error)?.clone();
        let columns: Vec<_> = names
            .iter()
            .map(|name| headers.iter().position(|header| header.trim() == *name))
            .collect();
        if columns.first().is_none_or(Option::is_none) {
            let first = names.first().unwrap_or(&"");
            let found: Vec<String> = headers.iter().take(8).map(shortened).collect();
            return Err(format!(
                "no column {first:?} in {found:?}; cells are parted by commas, and a quote has an end"
            ));
        }
        Ok(Self { reader, columns })
    }

    /// Calls `row` for every row; rows that cannot be read, and those for which it returns an error, are reported.
    pub(super) fn for_each(
        mut self,
        at: &FileLocation,
        report: &mut LoadReport,
        mut row: impl FnMut(&CsvRow<'_>) -> Result<(), &'static str>,
    ) {
        let mut record = csv::StringRecord::new();
        loop {
            if self.reader.position().line().is_multiple_of(4096) {
                dwell_scene::interrupt::unwind_if_cancelled();
            }
            let result = match self.reader.read_record(&mut record) {
                Ok(false) => return,
                Ok(true) => match embedded_newlines(&record) {
                    0 => row(&CsvRow {
                        record: &record,
                        columns: &self.columns,
                    })
                    .map_err(str::to_owned),
                    lines => Err(format!(
                        "a quote opens a cell that goes on over {lines} more lines; the rows there are not read"
                    )),
                },
                Err(error) => Err(crate::plain_parse_error(&error)),
            };
            if let Err(reason) = result {
                let line = record
                    .position()
                    .map_or(0, |position| position.line() as u32);
                report.warn(at.line(line), WarningKind::BadRow { reason });
            }
        }
    }
}

/// Ends of lines in the cells of a row: no cell of these tables has one.
fn embedded_newlines(record: &csv::StringRecord) -> usize {
    record
        .iter()
        .map(|cell| cell.bytes().filter(|byte| *byte == b'\n').count())
        .sum()
}

/// The first 40 characters of a cell, for a message.
fn shortened(cell: &str) -> String {
    cell.chars().take(40).collect()
}
