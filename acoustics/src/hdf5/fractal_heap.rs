//! Fractal heaps, which hold links and attributes where there are many.

use super::bytes::{Cursor, FileBytes, Hdf5Error, Hdf5Result, unsupported};

/// A heap: blocks in rows, whose sizes double from row to row.
pub(super) struct FractalHeap {
    id_length: usize,
    /// Bytes of an object's offset, and of its length, in an id.
    offset_width: usize,
    length_width: usize,
    columns: u64,
    first_block: u64,
    largest_block: u64,
    root: Option<u64>,
    /// Rows of the root; it is a block itself when there are none.
    rows: u32,
}

impl FractalHeap {
    pub(super) fn read(source: &FileBytes<'_>, address: u64) -> Hdf5Result<Self> {
        let mut header = source.at(address)?;
        header.check_signature(b"FRHP", 0)?;
        let id_length = usize::from(header.u16()?);
        if header.u16()? != 0 {
            return unsupported("its names or attributes are compressed; not read");
        }
        header.skip(1)?;
        let most_managed = u64::from(header.u32()?);
        // Huge objects, free space, statistics: addresses and lengths alternate twice, then 8 lengths.
        for _ in 0..2 {
            header.length()?;
            header.address()?;
        }
        for _ in 0..8 {
            header.length()?;
        }
        let columns = u64::from(header.u16()?);
        let (first_block, largest_block) = (header.length()?, header.length()?);
        let bits = usize::from(header.u16()?);
        header.skip(2)?;
        let root = header.address()?;
        let rows = u32::from(header.u16()?);
        let sound = columns.is_power_of_two()
            && first_block.is_power_of_two()
            && largest_block.is_power_of_two()
            && (first_block..1 << 32).contains(&largest_block)
            && first_block
                .checked_mul(columns)
                .is_some_and(|x| x < 1 << 48)
            && (1..=64).contains(&bits)
            && rows <= 64;
        if !sound {
            return unsupported(format!("damaged at byte {address}: a heap without a form"));
        }
        let log2 = |x: u64| x.checked_ilog2().unwrap_or(0) as usize;
        Ok(Self {
            id_length,
            offset_width: bits.div_ceil(8),
            length_width: log2(largest_block)
                .div_ceil(8)
                .min(log2(most_managed) / 8 + 1),
            columns,
            first_block,
            largest_block,
            root,
            rows,
        })
    }

    pub(super) fn id_length(&self) -> usize {
        self.id_length
    }

    /// Returns an object; `None` for one that is stored elsewhere because of its size.
    pub(super) fn object<'s>(
        &self,
        source: &'s FileBytes<'_>,
        mut id: Cursor<'_>,
    ) -> Hdf5Result<Option<Cursor<'s>>> {
        let flags = id.u8()?;
        if flags >> 4 != 0 {
            return Ok(None);
        }
        let (offset, length) = (id.uint(self.offset_width)?, id.uint(self.length_width)?);
        let (block, inside) = self.block_of(source, offset)?;
        let start = block.checked_add(inside);
        let start =
            start.ok_or_else(|| Hdf5Error(format!("damaged: an address beyond {block}")))?;
        source.block(start, length).map(Some)
    }

    /// Returns the address of the block that holds an offset of the heap, and the offset in that block.
    fn block_of(&self, source: &FileBytes<'_>, offset: u64) -> Hdf5Result<(u64, u64)> {
        let damaged = || Hdf5Error(format!("damaged: a heap has nothing at {offset}"));
        let mut address = self.root.ok_or_else(damaged)?;
        let (mut rows, mut inside) = (self.rows, offset);
        // Each nested block is smaller than the one that contains it.
        while rows > 0 {
            let (row, begin, size) = self.row_of(inside);
            if row >= rows {
                return Err(damaged());
            }
            let column = (inside - begin) / size;
            let mut block = source.at(address)?;
            block.check_signature(b"FHIB", 0)?;
            block.address()?;
            block.skip(self.offset_width)?;
            let before = u64::from(row) * self.columns + column;
            block.skip(before as usize * block.widths.address)?;
            address = block.defined_address()?;
            inside -= begin + column * size;
            rows = if size <= self.largest_block {
                0
            } else {
                (size.ilog2() + 1).saturating_sub((self.first_block * self.columns).ilog2())
            };
        }
        Ok((address, inside))
    }

    /// Returns the row that holds an offset, the row's offset, and the size of its blocks.
    fn row_of(&self, offset: u64) -> (u32, u64, u64) {
        let first_row = self.first_block * self.columns;
        if offset < first_row {
            return (0, 0, self.first_block);
        }
        let above = offset.ilog2() - first_row.ilog2();
        (above + 1, first_row << above, self.first_block << above)
    }
}
