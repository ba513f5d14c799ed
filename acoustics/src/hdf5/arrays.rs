//! Arrays of chunks: fixed and extensible.

use super::bytes::{Cursor, FileBytes, Hdf5Result, unsupported};
use super::grid::StoredChunk;

/// Bytes of the checksum behind a block.
const CHECK_SUM: u64 = 4;
/// Largest exponent of a length.
const MOST_BITS: u8 = 40;

/// The form of an entry: its bytes, and whether it states a size and filters.
#[derive(Debug, Clone, Copy)]
pub(super) struct ArrayEntryFormat {
    pub(super) width: usize,
    pub(super) filtered: bool,
}

impl ArrayEntryFormat {
    /// Reads the next entry, at `place`; `None` for a chunk that was never written.
    pub(super) fn read(
        self,
        cursor: &mut Cursor<'_>,
        place: u64,
    ) -> Hdf5Result<Option<StoredChunk>> {
        let mut entry = cursor.sub_cursor(self.width)?;
        let address = entry.address()?;
        let (mut size, mut skipped) = (None, 0);
        if self.filtered {
            size = Some(entry.uint(entry.remaining().saturating_sub(4))?);
            skipped = entry.u32()?;
        }
        Ok(address.map(|address| StoredChunk {
            number: place,
            address,
            size,
            skipped_filters: skipped,
        }))
    }

    /// Reads consecutive entries.
    fn read_entries(
        self,
        cursor: &mut Cursor<'_>,
        places: std::ops::Range<u64>,
        to: &mut Vec<StoredChunk>,
    ) -> Hdf5Result<()> {
        for place in places {
            to.extend(self.read(cursor, place)?);
        }
        Ok(())
    }

    /// Reads entries in pages of a power of two of them, each with a checksum; written pages have a bit set.
    fn read_pages(
        self,
        cursor: &mut Cursor<'_>,
        places: std::ops::Range<u64>,
        page_bits: u8,
        written: &[u8],
        to: &mut Vec<StoredChunk>,
    ) -> Hdf5Result<()> {
        let mut first = places.start;
        for page in 0.. {
            if first >= places.end {
                break;
            }
            let end = places.end.min(first + (1 << page_bits));
            let length = (end - first).saturating_mul(self.width as u64);
            let mut content = cursor.sub_cursor(length.try_into().unwrap_or(usize::MAX))?;
            cursor.skip(CHECK_SUM as usize)?;
            let flags: u8 = written.get(page / 8).copied().unwrap_or(0);
            if flags & (0x80 >> (page % 8)) != 0 {
                self.read_entries(&mut content, first..end, to)?;
            }
            first = end;
        }
        Ok(())
    }
}

/// Returns the entries of a fixed array.
pub(super) fn read_fixed_array(
    source: &FileBytes<'_>,
    address: u64,
) -> Hdf5Result<Vec<StoredChunk>> {
    let mut found = Vec::new();
    let mut header = source.at(address)?;
    header.check_signature(b"FAHD", 0)?;
    let filtered = header.u8()? == 1;
    let width = usize::from(header.u8()?);
    let page_bits = header.u8()?;
    let count = header.length()?;
    let Some(block) = header.address()? else {
        return Ok(found);
    };
    if page_bits > MOST_BITS || count >> MOST_BITS != 0 {
        return unsupported(format!(
            "damaged at byte {address}: an array of {count} chunks"
        ));
    }
    let entry = ArrayEntryFormat { width, filtered };
    let mut cursor = source.at(block)?;
    cursor.check_signature(b"FADB", 0)?;
    cursor.skip(1)?;
    cursor.address()?;
    if count <= 1 << page_bits {
        entry.read_entries(&mut cursor, 0..count, &mut found)?;
    } else {
        let pages = count.div_ceil(1 << page_bits);
        let written = cursor.take(pages.div_ceil(8) as usize)?;
        cursor.skip(CHECK_SUM as usize)?;
        entry.read_pages(&mut cursor, 0..count, page_bits, written, &mut found)?;
    }
    Ok(found)
}

/// An extensible array: some entries in its index block, the others in blocks, whose number and length double in turn from
/// group to group. The blocks of later groups are listed in a block of their own.
struct ExtensibleArray {
    entry: ArrayEntryFormat,
    /// Entries in the index block.
    direct: u64,
    /// Entries of the first block.
    shortest: u64,
    /// Groups whose blocks the index block lists itself, and all groups.
    listed_groups: u32,
    groups: u32,
    page_bits: u8,
    /// Bytes of an address.
    place_width: usize,
}

/// Returns the entries of an extensible array.
pub(super) fn read_extensible_array(
    source: &FileBytes<'_>,
    address: u64,
) -> Hdf5Result<Vec<StoredChunk>> {
    let mut found = Vec::new();
    let mut header = source.at(address)?;
    header.check_signature(b"EAHD", 0)?;
    let filtered = header.u8()? == 1;
    let width = usize::from(header.u8()?);
    let bits = header.u8()?;
    let direct = u64::from(header.u8()?);
    let (shortest, pointers) = (u64::from(header.u8()?), header.u8()?);
    let page_bits = header.u8()?;
    for _ in 0..6 {
        header.length()?;
    }
    let Some(index) = header.address()? else {
        return Ok(found);
    };
    let sound = bits <= MOST_BITS
        && page_bits <= MOST_BITS
        && shortest.is_power_of_two()
        && pointers.is_power_of_two()
        && u32::from(bits) >= shortest.ilog2();
    if !sound {
        return unsupported(format!(
            "damaged at byte {address}: an array without a form"
        ));
    }
    let array = ExtensibleArray {
        entry: ArrayEntryFormat { width, filtered },
        direct,
        shortest,
        listed_groups: 2 * pointers.ilog2(),
        groups: 1 + u32::from(bits) - shortest.ilog2(),
        page_bits,
        place_width: usize::from(bits).div_ceil(8),
    };
    array.read(source, index, &mut found)?;
    Ok(found)
}

impl ExtensibleArray {
    /// Returns the blocks of a group, and the entries of each.
    fn super_block_shape(&self, group: u32) -> (u64, u64) {
        (1 << (group / 2), self.shortest << group.div_ceil(2))
    }

    fn read(
        &self,
        source: &FileBytes<'_>,
        index: u64,
        to: &mut Vec<StoredChunk>,
    ) -> Hdf5Result<()> {
        let mut cursor = source.at(index)?;
        cursor.check_signature(b"EAIB", 0)?;
        cursor.skip(1)?;
        cursor.address()?;
        self.entry.read_entries(&mut cursor, 0..self.direct, to)?;
        let mut first = self.direct;
        for group in 0..self.groups {
            let (blocks, length) = self.super_block_shape(group);
            if group >= self.listed_groups {
                if let Some(list) = cursor.address()? {
                    self.read_secondary_block(source, list, group, first, to)?;
                }
                first += blocks * length;
                continue;
            }
            for _ in 0..blocks {
                if let Some(block) = cursor.address()? {
                    self.read_block(source, block, first..first + length, &[], to)?;
                }
                first += length;
            }
        }
        Ok(())
    }

    /// Reads a block that lists those of a group.
    fn read_secondary_block(
        &self,
        source: &FileBytes<'_>,
        address: u64,
        group: u32,
        first: u64,
        to: &mut Vec<StoredChunk>,
    ) -> Hdf5Result<()> {
        let mut cursor = source.at(address)?;
        cursor.check_signature(b"EASB", 0)?;
        cursor.skip(1)?;
        cursor.address()?;
        cursor.skip(self.place_width)?;
        let (blocks, length) = self.super_block_shape(group);
        let pages = if length > 1 << self.page_bits {
            length >> self.page_bits
        } else {
            0
        };
        let flags = pages.div_ceil(8);
        let all = cursor.take(
            blocks
                .saturating_mul(flags)
                .try_into()
                .unwrap_or(usize::MAX),
        )?;
        for k in 0..blocks {
            let first = first + k * length;
            let written = &all[(k * flags) as usize..][..flags as usize];
            if let Some(block) = cursor.address()? {
                self.read_block(source, block, first..first + length, written, to)?;
            }
        }
        Ok(())
    }

    /// Reads a block of entries; those in pages have a bit for each written page.
    fn read_block(
        &self,
        source: &FileBytes<'_>,
        address: u64,
        places: std::ops::Range<u64>,
        written: &[u8],
        to: &mut Vec<StoredChunk>,
    ) -> Hdf5Result<()> {
        let mut cursor = source.at(address)?;
        cursor.check_signature(b"EADB", 0)?;
        cursor.skip(1)?;
        cursor.address()?;
        cursor.skip(self.place_width)?;
        if places.end - places.start <= 1 << self.page_bits {
            return self.entry.read_entries(&mut cursor, places, to);
        }
        cursor.skip(CHECK_SUM as usize)?;
        self.entry
            .read_pages(&mut cursor, places, self.page_bits, written, to)
    }
}
