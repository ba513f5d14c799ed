//! Rows of a CSV table by column name.

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
    /// A table with the columns `names`; the first must exist.
    pub(super) fn new(
        text: &'a [u8],
        names: &[&str],
        at: &FileLocation,
        report: &mut LoadReport,
    ) -> Option<Self> {
        let mut reader = csv::ReaderBuilder::new().flexible(true).from_reader(text);
        let headers = match reader.headers() {
            Ok(headers) => headers.clone(),
            Err(error) => {
                let reason = error.to_string();
                report.warn(at.line(1), WarningKind::BadRow { reason });
                return None;
            }
        };
        let columns: Vec<_> = names
            .iter()
            .map(|name| headers.iter().position(|header| header.trim() == *name))
            .collect();
        if columns.first().is_none_or(Option::is_none) {
            let reason = format!(
                "no column {:?} in {:?}",
                names.first().unwrap_or(&""),
                headers.iter().take(8).collect::<Vec<_>>()
            );
            report.warn(at.line(1), WarningKind::BadRow { reason });
            return None;
        }
        Some(Self { reader, columns })
    }

    /// Calls `row` for every row; rows that cannot be read, and those for which it returns an error, are reported.
    pub(super) fn each(
        mut self,
        at: &FileLocation,
        report: &mut LoadReport,
        mut row: impl FnMut(&CsvRow<'_>) -> Result<(), &'static str>,
    ) {
        let mut record = csv::StringRecord::new();
        loop {
            if self.reader.position().line().is_multiple_of(4096) {
                dwell_scene::interrupt::check();
            }
            let result = match self.reader.read_record(&mut record) {
                Ok(false) => return,
                Ok(true) => row(&CsvRow {
                    record: &record,
                    columns: &self.columns,
                })
                .map_err(str::to_owned),
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
