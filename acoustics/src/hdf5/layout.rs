//! Data layouts of variables.

use super::bytes::{Cursor, Hdf5Result, unsupported};

/// The storage of a variable.
#[derive(Debug)]
pub(super) enum StorageLayout<'a> {
    /// In the header.
    Compact(Cursor<'a>),
    /// Contiguous, with this many bytes.
    Contiguous(Option<u64>, u64),
    /// In chunks.
    Chunked(ChunkedStorage),
}

/// Chunks: their shape, and their index.
#[derive(Debug)]
pub(super) struct ChunkedStorage {
    /// Values of a chunk along each axis.
    pub(super) shape: Vec<u64>,
    pub(super) index: ChunkIndex,
    /// Address of the index; `None` where nothing was ever written.
    pub(super) address: Option<u64>,
}

/// The kind of chunk index.
#[derive(Debug, Clone, Copy)]
pub(super) enum ChunkIndex {
    /// A B-tree of version 1.
    Tree1,
    /// One chunk: bytes as stored, if not its full size, and the filters that it skipped.
    Single {
        size: Option<u64>,
        skipped: u32,
    },
    /// Consecutive chunks, in order.
    Implicit,
    Fixed,
    Extensible,
    /// A B-tree of version 2.
    Tree2,
}

impl<'a> StorageLayout<'a> {
    pub(super) fn read(mut cursor: Cursor<'a>) -> Hdf5Result<Self> {
        let version = cursor.u8()?;
        if !(3..=5).contains(&version) {
            return unsupported(format!("a layout of version {version}; read are 3 to 5"));
        }
        match cursor.u8()? {
            0 => {
                let size = usize::from(cursor.u16()?);
                Ok(Self::Compact(cursor.sub_cursor(size)?))
            }
            1 => Ok(Self::Contiguous(cursor.address()?, cursor.length()?)),
            2 if version == 3 => {
                let axes = cursor.u8()?;
                let address = cursor.address()?;
                let shape = (0..axes).map(|_| cursor.u32().map(u64::from)).collect();
                chunked(shape, ChunkIndex::Tree1, address)
            }
            2 => {
                let flags = cursor.u8()?;
                if flags & 0x01 != 0 {
                    return unsupported("chunks at its edges without filters; not read");
                }
                let axes = cursor.u8()?;
                let width = usize::from(cursor.u8()?);
                let shape = (0..axes).map(|_| cursor.uint(width)).collect();
                let index = match cursor.u8()? {
                    1 if flags & 0x02 != 0 => ChunkIndex::Single {
                        size: Some(cursor.length()?),
                        skipped: cursor.u32()?,
                    },
                    1 => ChunkIndex::Single {
                        size: None,
                        skipped: 0,
                    },
                    2 => ChunkIndex::Implicit,
                    // The following fields are repeated in the index's header.
                    3 => cursor.skip(1).map(|()| ChunkIndex::Fixed)?,
                    4 => cursor.skip(5).map(|()| ChunkIndex::Extensible)?,
                    5 => cursor.skip(6).map(|()| ChunkIndex::Tree2)?,
                    other => {
                        return unsupported(format!(
                            "chunks with an index of kind {other}; read are 1 to 5"
                        ));
                    }
                };
                chunked(shape, index, cursor.address()?)
            }
            3 => unsupported(
                "a virtual dataset, whose values stand in other files; only the file itself is read",
            ),
            other => unsupported(format!("a layout of class {other}; read are 0 to 2")),
        }
    }
}

/// The last axis of the stored shape is the bytes of a value.
fn chunked<'a>(
    shape: Hdf5Result<Vec<u64>>,
    index: ChunkIndex,
    address: Option<u64>,
) -> Hdf5Result<StorageLayout<'a>> {
    let mut shape = shape?;
    shape.pop();
    Ok(StorageLayout::Chunked(ChunkedStorage {
        shape,
        index,
        address,
    }))
}
