//! The global heap, which holds texts of any length.

use super::bytes::{FileBytes, Hdf5Result, unsupported};
use super::header::as_size;

/// Returns the first `length` bytes of an object of a collection.
pub(super) fn object<'a>(
    source: &'a FileBytes<'_>,
    address: u64,
    index: u32,
    length: usize,
) -> Hdf5Result<&'a [u8]> {
    let mut collection = source.at(address)?;
    collection.check_signature(b"GCOL", 1)?;
    collection.skip(3)?;
    let size = as_size(collection.length()?)?;
    let begun = 8 + collection.widths.length;
    let mut objects = collection.sub_cursor(size.saturating_sub(begun))?;
    let prefix = 8 + objects.widths.length;
    while objects.remaining() >= prefix {
        let found = u32::from(objects.u16()?);
        objects.skip(6)?;
        let size = as_size(objects.length()?)?;
        // Number 0 is the free space.
        if found == 0 {
            break;
        }
        let mut content = objects.sub_cursor(size)?;
        if found == index {
            return content.take(length);
        }
        objects.align()?;
    }
    unsupported(format!(
        "damaged: text {index} is missing in the heap at byte {address}"
    ))
}
