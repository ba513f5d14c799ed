//! Chunk indices of a variable: six kinds.

use super::arrays::{self, ArrayEntryFormat};
use super::btree1;
use super::btree2;
use super::bytes::{Cursor, FileBytes, Hdf5Error, Hdf5Result};
use super::grid::{ChunkGrid, StoredChunk};
use super::layout::{ChunkIndex, ChunkedStorage};

/// Returns all chunks of an index; numbers may be missing.
pub(super) fn chunks(
    source: &FileBytes<'_>,
    chunked: &ChunkedStorage,
    grid: &ChunkGrid,
) -> Hdf5Result<Vec<StoredChunk>> {
    let Some(address) = chunked.address else {
        return Ok(Vec::new());
    };
    let mut found = Vec::new();
    match chunked.index {
        ChunkIndex::Tree1 => {
            // Size, filters, and offset, with an axis for the bytes of a value.
            let key = 8 + 8 * (grid.axes() + 1);
            btree1::for_each_entry(source, address, 1, key, &mut |mut key, address| {
                let (size, skipped) = (Some(u64::from(key.u32()?)), key.u32()?);
                let number = grid.chunk_starting_at(&coordinates(&mut key, grid.axes())?);
                found.extend(number.map(|number| StoredChunk {
                    number,
                    address,
                    size,
                    skipped_filters: skipped,
                }));
                Ok(())
            })?;
        }
        ChunkIndex::Tree2 => {
            let plain = 8 * grid.axes();
            btree2::for_each_record(source, address, &mut |mut record| {
                let width = record.remaining().saturating_sub(plain);
                let filtered = width > record.widths.address;
                let stored = ArrayEntryFormat { width, filtered }.read(&mut record, 0)?;
                let number = grid.chunk_index(&coordinates(&mut record, grid.axes())?);
                let both = stored.zip(number);
                found.extend(both.map(|(stored, number)| StoredChunk { number, ..stored }));
                Ok(())
            })?;
        }
        ChunkIndex::Single { size, skipped } => found.push(StoredChunk {
            number: 0,
            address,
            size,
            skipped_filters: skipped,
        }),
        ChunkIndex::Implicit => {
            // All are stored or none is.
            let length = grid.count.checked_mul(grid.bytes);
            let length = length.ok_or_else(|| Hdf5Error("damaged: too many chunks".to_owned()))?;
            source.unbudgeted_bytes(address, length)?;
            found.extend((0..grid.count).map(|number| StoredChunk {
                number,
                address: address + number * grid.bytes,
                size: None,
                skipped_filters: 0,
            }));
        }
        ChunkIndex::Fixed | ChunkIndex::Extensible => {
            let entries = if matches!(chunked.index, ChunkIndex::Fixed) {
                arrays::read_fixed_array(source, address)?
            } else {
                arrays::read_extensible_array(source, address)?
            };
            found.extend(entries.into_iter().filter_map(|stored| {
                let number = grid.chunk_index_in_array(stored.number)?;
                Some(StoredChunk { number, ..stored })
            }));
        }
    }
    Ok(found)
}

fn coordinates(cursor: &mut Cursor<'_>, axes: usize) -> Hdf5Result<Vec<u64>> {
    (0..axes).map(|_| cursor.uint(8)).collect()
}
