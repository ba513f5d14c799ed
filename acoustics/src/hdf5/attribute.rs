//! Attributes: texts of a group or a variable.

use super::btree2;
use super::bytes::{Cursor, FileBytes, Hdf5Error, Hdf5Result, unsupported};
use super::datatype::Datatype;
use super::fractal_heap::FractalHeap;
use super::global_heap;
use super::header::{ObjectHeader, kind};
use super::shape::Dataspace;

/// Returns the text of an attribute; `None` where there is no such attribute.
pub(super) fn text(
    source: &FileBytes<'_>,
    header: &ObjectHeader<'_>,
    name: &str,
) -> Hdf5Result<Option<String>> {
    for message in header.messages_of_kind(kind::ATTRIBUTE) {
        if message.shared {
            continue;
        }
        if let Some(found) = text_of(source, message.content()?, name)? {
            return Ok(Some(found));
        }
    }
    let Some(info) = header.first(kind::ATTRIBUTE_INFO) else {
        return Ok(None);
    };
    let mut info = info.content()?;
    info.skip(1)?;
    if info.u8()? & 1 != 0 {
        info.skip(2)?;
    }
    let (Some(heap), Some(tree)) = (info.address()?, info.address()?) else {
        return Ok(None);
    };
    let heap = FractalHeap::read(source, heap)?;
    let mut found = None;
    btree2::for_each_record(source, tree, &mut |mut record| {
        let id = record.sub_cursor(heap.id_length())?;
        // Attributes by name, except those that several objects share.
        if found.is_none()
            && let Some(object) = heap.object(source, id)?
        {
            found = text_of(source, object, name)?;
        }
        Ok(())
    })?;
    Ok(found)
}

/// Returns the text of this attribute if it has that name.
fn text_of(
    source: &FileBytes<'_>,
    mut cursor: Cursor<'_>,
    name: &str,
) -> Hdf5Result<Option<String>> {
    let version = cursor.u8()?;
    if !(1..=3).contains(&version) {
        return unsupported(format!(
            "an attribute of version {version}; read are 1 to 3"
        ));
    }
    let flags = cursor.u8()?;
    let sizes = [cursor.u16()?, cursor.u16()?, cursor.u16()?].map(usize::from);
    if version == 3 {
        cursor.skip(1)?;
    }
    let padded = version == 1;
    let mut part = |size: usize| {
        let part = cursor.sub_cursor(size)?;
        if padded {
            cursor.align()?;
        }
        Ok(part)
    };
    let mut found = part(sizes[0])?;
    let found = found.take(found.remaining())?;
    if found.split(|byte| *byte == 0).next() != Some(name.as_bytes()) {
        return Ok(None);
    }
    let (datatype, dataspace) = (part(sizes[1])?, part(sizes[2])?);
    let fault = |why: &str| Err(Hdf5Error(format!("{name}: {why}")));
    if version > 1 && flags & 3 != 0 {
        return fault("its description is shared with another object; not read");
    }
    let Some(shape) = Dataspace::read(dataspace)? else {
        return Ok(None);
    };
    if shape.count() != Some(1) {
        return fault("expected one text");
    }
    let bytes = match Datatype::read(datatype)? {
        Datatype::Text { size } => cursor.take(size)?,
        Datatype::LongText => {
            let length = cursor.u32()? as usize;
            let (heap, index) = (cursor.address()?, cursor.u32()?);
            match heap {
                Some(heap) if length > 0 => global_heap::object(source, heap, index, length)?,
                _ => &[],
            }
        }
        Datatype::Integer { .. } | Datatype::Float { .. } => {
            return fault("is a number; expected text");
        }
    };
    let text = String::from_utf8_lossy(bytes);
    Ok(Some(text.trim_matches(['\0', ' ']).to_owned()))
}
