//! Links of a group, by name.

use super::btree1;
use super::btree2;
use super::bytes::{Cursor, FileBytes, Hdf5Result, unsupported};
use super::fractal_heap::FractalHeap;
use super::header::{ObjectHeader, as_size, kind};

/// The target of a link.
enum LinkTarget {
    /// An object of this file, by its header's address.
    Object(u64),
    /// Another name in this file.
    Name,
    /// A name in another file.
    OtherFile,
    /// A user-defined kind.
    Unknown,
}

/// Returns the address of the header of `name`; `None` where the group has no such name.
pub(super) fn find(
    source: &FileBytes<'_>,
    group: &ObjectHeader<'_>,
    name: &str,
) -> Hdf5Result<Option<u64>> {
    let mut found = None;
    if let Some(table) = group.first(kind::SYMBOL_TABLE) {
        found = find_in_symbol_table(source, table.content()?, name)?;
    }
    for message in group.messages_of_kind(kind::LINK) {
        if found.is_none() {
            found = target_if_named(message.content()?, name)?;
        }
    }
    if found.is_none()
        && let Some(info) = group.first(kind::LINK_INFO)
    {
        found = in_heap(source, info.content()?, name)?;
    }
    match found {
        None => Ok(None),
        Some(LinkTarget::Object(address)) => Ok(Some(address)),
        Some(LinkTarget::Name) => {
            unsupported("is a soft link; read is what the file holds under its own name")
        }
        Some(LinkTarget::OtherFile) => {
            unsupported("is a link to another file; only the file itself is read")
        }
        Some(LinkTarget::Unknown) => {
            unsupported("is a link of an unknown kind; only the file itself is read")
        }
    }
}

/// Searches groups of older files: a tree of tables, with names in a heap.
fn find_in_symbol_table(
    source: &FileBytes<'_>,
    mut table: Cursor<'_>,
    name: &str,
) -> Hdf5Result<Option<LinkTarget>> {
    let (tree, heap) = (table.defined_address()?, table.defined_address()?);
    let mut heap = source.at(heap)?;
    heap.check_signature(b"HEAP", 0)?;
    heap.skip(3)?;
    let size = heap.length()?;
    heap.length()?;
    let names = source.unbudgeted_bytes(heap.defined_address()?, size)?;
    let mut found = None;
    btree1::for_each_entry(source, tree, 0, table.widths.length, &mut |_, address| {
        let mut node = source.at(address)?;
        node.check_signature(b"SNOD", 1)?;
        node.skip(1)?;
        for _ in 0..node.u16()? {
            let name_at = as_size(node.address()?.unwrap_or(u64::MAX))?;
            let object = node.address()?;
            let cache = node.u32()?;
            node.skip(20)?;
            let Some(rest) = names.get(name_at..) else {
                return unsupported(format!(
                    "damaged: a name at {name_at} of a heap of {size} bytes"
                ));
            };
            let is_it = rest
                .strip_prefix(name.as_bytes())
                .is_some_and(|rest| rest.first() == Some(&0));
            if is_it {
                found = Some(match (cache, object) {
                    (0 | 1, Some(object)) => LinkTarget::Object(object),
                    (2, _) => LinkTarget::Name,
                    _ => LinkTarget::Unknown,
                });
            }
        }
        Ok(())
    })?;
    Ok(found)
}

/// Searches groups with many links.
fn in_heap(
    source: &FileBytes<'_>,
    mut info: Cursor<'_>,
    name: &str,
) -> Hdf5Result<Option<LinkTarget>> {
    info.skip(1)?;
    if info.u8()? & 1 != 0 {
        info.skip(8)?;
    }
    let (Some(heap), Some(tree)) = (info.address()?, info.address()?) else {
        return Ok(None);
    };
    let heap = FractalHeap::read(source, heap)?;
    let mut found = None;
    btree2::for_each_record(source, tree, &mut |mut record| {
        // The name's hash.
        record.skip(4)?;
        let id = record.sub_cursor(heap.id_length())?;
        if found.is_none()
            && let Some(link) = heap.object(source, id)?
        {
            found = target_if_named(link, name)?;
        }
        Ok(())
    })?;
    Ok(found)
}

/// Returns the target of a link message if it has that name.
fn target_if_named(mut cursor: Cursor<'_>, name: &str) -> Hdf5Result<Option<LinkTarget>> {
    let version = cursor.u8()?;
    if version != 1 {
        return unsupported(format!("a link of version {version}; read is version 1"));
    }
    let flags = cursor.u8()?;
    let class = if flags & 0x08 == 0 { 0 } else { cursor.u8()? };
    if flags & 0x04 != 0 {
        cursor.skip(8)?;
    }
    if flags & 0x10 != 0 {
        cursor.skip(1)?;
    }
    let length = as_size(cursor.uint(1 << (flags & 3))?)?;
    if cursor.take(length)? != name.as_bytes() {
        return Ok(None);
    }
    Ok(Some(match class {
        0 => LinkTarget::Object(cursor.defined_address()?),
        1 => LinkTarget::Name,
        64 => LinkTarget::OtherFile,
        _ => LinkTarget::Unknown,
    }))
}
