//! The superblock: field widths and the root group of a file.

use super::bytes::{Cursor, FieldWidths, FileBytes, Hdf5Result, unsupported};

const SIGNATURE: [u8; 8] = *b"\x89HDF\r\n\x1a\n";
/// Largest user block before the superblock: 512 bytes, or a power of two above.
const LONGEST_USER_BLOCK: usize = 1 << 16;

/// The contents of the superblock.
#[derive(Debug, Clone, Copy)]
pub(super) struct Superblock {
    /// Its offset; all addresses count from here.
    pub(super) base_offset: usize,
    pub(super) widths: FieldWidths,
    /// The address of the root group's header.
    pub(super) root: u64,
}

pub(super) fn read(bytes: &[u8]) -> Hdf5Result<Superblock> {
    let starts = std::iter::once(0).chain((9..).map(|k| 1 << k));
    let begins = |start: &usize| {
        bytes
            .get(*start..)
            .is_some_and(|b| b.starts_with(&SIGNATURE))
    };
    let Some(start) = starts
        .take_while(|start| *start <= LONGEST_USER_BLOCK)
        .find(begins)
    else {
        return unsupported("no HDF5, which SOFA files are: found no signature of it");
    };
    // No field of variable width is read before the widths are known.
    let (address, length) = (8, 8);
    let source = FileBytes::new(&bytes[start..], FieldWidths { address, length });
    let mut cursor = source.at(SIGNATURE.len() as u64)?;
    let end = match cursor.u8()? {
        version @ (0 | 1) => {
            cursor.skip(4)?;
            read_widths(&mut cursor)?;
            // The trees' parameters and the flags.
            cursor.skip(if version == 0 { 9 } else { 13 })?;
            // Base, free space; behind the end the driver, and the root's entry, which begins with its name.
            for _ in 0..2 {
                cursor.address()?;
            }
            let end = cursor.defined_address()?;
            for _ in 0..2 {
                cursor.address()?;
            }
            end
        }
        2 | 3 => {
            read_widths(&mut cursor)?;
            cursor.skip(1)?;
            // Base, extension.
            for _ in 0..2 {
                cursor.address()?;
            }
            cursor.defined_address()?
        }
        version => {
            return unsupported(format!(
                "a superblock of version {version}; allowed are 0 to 3"
            ));
        }
    };
    if end > bytes.len() as u64 {
        return unsupported(format!(
            "the file is cut: it has {} bytes and should have {end}",
            bytes.len()
        ));
    }
    Ok(Superblock {
        base_offset: start,
        root: cursor.defined_address()?,
        widths: cursor.widths,
    })
}

fn read_widths(cursor: &mut Cursor<'_>) -> Hdf5Result<()> {
    let (address, length) = (usize::from(cursor.u8()?), usize::from(cursor.u8()?));
    let allowed = [2, 4, 8];
    if !allowed.contains(&address) || !allowed.contains(&length) {
        return unsupported(format!(
            "addresses of {address} and lengths of {length} bytes; allowed are 2, 4 and 8"
        ));
    }
    cursor.widths = FieldWidths { address, length };
    Ok(())
}
