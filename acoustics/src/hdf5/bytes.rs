//! The bytes of a file, with bounds: nothing outside is read, and no more of its structure than a budget.

use dwell_scene::interrupt;
use std::cell::Cell;

/// Most bytes of structure (headers, trees, heaps; values not counted) that one query may read. Trees that loop or share
/// their nodes end here.
const MOST_STRUCTURE_BYTES: u64 = 32 << 20;

/// A fault of a file, as a sentence.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Hdf5Error(pub(super) String);

pub(super) type Hdf5Result<T> = Result<T, Hdf5Error>;

/// Refuses with a sentence.
pub(super) fn unsupported<T>(message: impl Into<String>) -> Hdf5Result<T> {
    Err(Hdf5Error(message.into()))
}

/// Sizes of an address and of a length in a file, bytes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FieldWidths {
    pub(super) address: usize,
    pub(super) length: usize,
}

/// A file's bytes from its superblock on, and the remaining budget of structure.
#[derive(Debug)]
pub(super) struct FileBytes<'a> {
    bytes: &'a [u8],
    widths: FieldWidths,
    left: Cell<u64>,
}

impl<'a> FileBytes<'a> {
    pub(super) fn new(bytes: &'a [u8], widths: FieldWidths) -> Self {
        Self {
            bytes,
            widths,
            left: Cell::new(MOST_STRUCTURE_BYTES),
        }
    }

    /// Returns a cursor at an address, up to the end of the file.
    pub(super) fn at(&self, address: u64) -> Hdf5Result<Cursor<'_>> {
        self.block(address, (self.bytes.len() as u64).saturating_sub(address))
    }

    /// Returns a cursor at an address, over `length` bytes.
    pub(super) fn block(&self, address: u64, length: u64) -> Hdf5Result<Cursor<'_>> {
        interrupt::unwind_if_cancelled();
        Ok(Cursor {
            bytes: self.unbudgeted_bytes(address, length)?,
            start: address,
            at: 0,
            widths: self.widths,
            left: &self.left,
        })
    }

    /// Returns the bytes of values, which the budget does not count.
    pub(super) fn unbudgeted_bytes(&self, address: u64, length: u64) -> Hdf5Result<&'a [u8]> {
        let range = || {
            let start = usize::try_from(address).ok()?;
            let end = start.checked_add(usize::try_from(length).ok()?)?;
            self.bytes.get(start..end)
        };
        range().ok_or_else(|| {
            let size = self.bytes.len();
            Hdf5Error(format!(
                "damaged: it points at {length} bytes from byte {address} on, and the file has {size}"
            ))
        })
    }
}

/// A position in a file, from which bytes are read in order.
#[derive(Debug, Clone)]
pub(super) struct Cursor<'a> {
    bytes: &'a [u8],
    /// Offset of `bytes` in the file.
    start: u64,
    at: usize,
    pub(super) widths: FieldWidths,
    left: &'a Cell<u64>,
}

impl<'a> Cursor<'a> {
    /// Returns the offset of the next byte in the file.
    pub(super) fn position(&self) -> u64 {
        self.start + self.at as u64
    }

    /// Returns the number of remaining bytes.
    pub(super) fn remaining(&self) -> usize {
        self.bytes.len() - self.at
    }

    /// Reads `length` bytes as a cursor of their own.
    pub(super) fn sub_cursor(&mut self, length: usize) -> Hdf5Result<Self> {
        let start = self.position();
        Ok(Self {
            bytes: self.take(length)?,
            start,
            at: 0,
            ..*self
        })
    }

    pub(super) fn take(&mut self, length: usize) -> Hdf5Result<&'a [u8]> {
        let Some(taken) = self.bytes[self.at..].get(..length) else {
            return unsupported(format!(
                "damaged at byte {}: expected {length} more bytes, found {}",
                self.position(),
                self.remaining()
            ));
        };
        let Some(left) = self.left.get().checked_sub(length as u64) else {
            return unsupported(format!(
                "damaged: its headers and trees loop, or take more than {MOST_STRUCTURE_BYTES} bytes"
            ));
        };
        self.left.set(left);
        self.at += length;
        Ok(taken)
    }

    pub(super) fn skip(&mut self, length: usize) -> Hdf5Result<()> {
        self.take(length).map(|_| ())
    }

    /// Skips to a multiple of 8 bytes behind the cursor's start.
    pub(super) fn align(&mut self) -> Hdf5Result<()> {
        self.skip(self.at.next_multiple_of(8) - self.at)
    }

    /// Reads an unsigned integer of at most 8 bytes.
    pub(super) fn uint(&mut self, width: usize) -> Hdf5Result<u64> {
        if width > 8 {
            return unsupported(format!(
                "damaged at byte {}: an integer of {width} bytes; allowed are 8",
                self.position()
            ));
        }
        let bytes = self.take(width)?.iter().rev();
        Ok(bytes.fold(0, |value, byte| (value << 8) | u64::from(*byte)))
    }

    pub(super) fn u8(&mut self) -> Hdf5Result<u8> {
        Ok(self.take(1)?[0])
    }

    pub(super) fn u16(&mut self) -> Hdf5Result<u16> {
        Ok(self.uint(2)? as u16)
    }

    pub(super) fn u32(&mut self) -> Hdf5Result<u32> {
        Ok(self.uint(4)? as u32)
    }

    /// Reads a length in the file's width.
    pub(super) fn length(&mut self) -> Hdf5Result<u64> {
        self.uint(self.widths.length)
    }

    /// Reads an address in the file's width; `None` where all bits are set.
    pub(super) fn address(&mut self) -> Hdf5Result<Option<u64>> {
        let width = self.widths.address;
        let found = self.uint(width)?;
        Ok((found != u64::MAX >> (64 - 8 * width)).then_some(found))
    }

    /// Reads an address that must be defined.
    pub(super) fn defined_address(&mut self) -> Hdf5Result<u64> {
        let at = self.position();
        let found = self.address()?;
        found.ok_or_else(|| {
            Hdf5Error(format!(
                "damaged at byte {at}: expected an address, found none"
            ))
        })
    }

    /// Reads a signature and a version.
    pub(super) fn check_signature(&mut self, signature: &[u8; 4], version: u8) -> Hdf5Result<()> {
        let at = self.position();
        let name = String::from_utf8_lossy(signature);
        if self.take(4)? != signature {
            return unsupported(format!("damaged at byte {at}: expected a block {name}"));
        }
        let found = self.u8()?;
        if found != version {
            return unsupported(format!(
                "a block {name} of version {found}; read is version {version}"
            ));
        }
        Ok(())
    }
}
