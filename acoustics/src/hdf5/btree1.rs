//! B-trees of version 1: the entries of a group, and addresses of chunks.

use super::bytes::{Cursor, FileBytes, Hdf5Error, Hdf5Result};

/// Calls `each` with every leaf's entry: its key, and its address.
///
/// `kind` is 0 for groups and 1 for chunks, `key` the bytes of a key.
pub(super) fn for_each_entry(
    source: &FileBytes<'_>,
    root: u64,
    kind: u8,
    key: usize,
    each: &mut impl FnMut(Cursor<'_>, u64) -> Hdf5Result<()>,
) -> Hdf5Result<()> {
    // Levels fall from node to child, so that loops end.
    let mut open: Vec<(u64, Option<u8>)> = vec![(root, None)];
    while let Some((address, expected)) = open.pop() {
        let mut node = source.at(address)?;
        let fault = || {
            Hdf5Error(format!(
                "damaged at byte {address}: expected a node of a tree"
            ))
        };
        if node.take(4)? != b"TREE" || node.u8()? != kind {
            return Err(fault());
        }
        let level = node.u8()?;
        if expected.is_some_and(|expected| expected != level) {
            return Err(fault());
        }
        let count = node.u16()?;
        node.address()?;
        node.address()?;
        for _ in 0..count {
            let key = node.sub_cursor(key)?;
            let child = node.defined_address()?;
            match level.checked_sub(1) {
                Some(below) => open.push((child, Some(below))),
                None => each(key, child)?,
            }
        }
    }
    Ok(())
}
