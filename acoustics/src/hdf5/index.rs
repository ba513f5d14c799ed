//! Where the chunks of a variable are: six kinds of index.

use super::arrays::{self, Entry};
use super::btree1;
use super::btree2;
use super::bytes::{Cursor, Fault, Read, Source};
use super::grid::{Grid, Stored};
use super::layout::{Chunked, Index};

/// All chunks that an index knows; numbers may be missing.
pub(super) fn chunks(source: &Source<'_>, chunked: &Chunked, grid: &Grid) -> Read<Vec<Stored>> {
    let Some(address) = chunked.address else {
        return Ok(Vec::new());
    };
    let mut found = Vec::new();
    match chunked.index {
        Index::Tree1 => {
            // Size, filters, and where it begins, with an axis for the bytes of a value.
            let key = 8 + 8 * (grid.axes() + 1);
            btree1::entries(source, address, 1, key, &mut |mut key, address| {
                let (size, skipped) = (Some(u64::from(key.u32()?)), key.u32()?);
                let number = grid.number_from(&coordinates(&mut key, grid.axes())?);
                found.extend(number.map(|number| Stored {
                    number,
                    address,
                    size,
                    skipped,
                }));
                Ok(())
            })?;
        }
        Index::Tree2 => {
            let plain = 8 * grid.axes();
            btree2::records(source, address, &mut |mut record| {
                let width = record.remaining().saturating_sub(plain);
                let filtered = width > record.widths.address;
                let stored = Entry { width, filtered }.read(&mut record, 0)?;
                let number = grid.number(&coordinates(&mut record, grid.axes())?);
                let both = stored.zip(number);
                found.extend(both.map(|(stored, number)| Stored { number, ..stored }));
                Ok(())
            })?;
        }
        Index::Single { size, skipped } => found.push(Stored {
            number: 0,
            address,
            size,
            skipped,
        }),
        Index::Implicit => {
            // All are there or none is.
            let length = grid.count.checked_mul(grid.bytes);
            let length = length.ok_or_else(|| Fault("damaged: too many chunks".to_owned()))?;
            source.values(address, length)?;
            found.extend((0..grid.count).map(|number| Stored {
                number,
                address: address + number * grid.bytes,
                size: None,
                skipped: 0,
            }));
        }
        Index::Fixed | Index::Extensible => {
            let entries = if matches!(chunked.index, Index::Fixed) {
                arrays::fixed(source, address)?
            } else {
                arrays::extensible(source, address)?
            };
            found.extend(entries.into_iter().filter_map(|stored| {
                let number = grid.number_in_array(stored.number)?;
                Some(Stored { number, ..stored })
            }));
        }
    }
    Ok(found)
}

fn coordinates(cursor: &mut Cursor<'_>, axes: usize) -> Read<Vec<u64>> {
    (0..axes).map(|_| cursor.uint(8)).collect()
}
