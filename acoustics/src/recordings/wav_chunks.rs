//! The chunks of WAV files.

use std::io::{self, Cursor, Read};

/// Largest chunk of the format that is read, bytes; real ones have at most 40.
const MAX_FORMAT_BYTES: u32 = 1024;
/// Bytes of a chunk's name and length.
const CHUNK_HEAD_BYTES: usize = 8;

/// The WAV file of `reader` without the chunks before its samples but the format's, for decoders that know nothing of padding. What
/// is no WAV file, or ends too early, comes as far as it was read.
///
/// A chunk of odd length is followed by a byte of 0 that its length does not count. Some programs leave it out, which does no
/// harm: no name of a chunk begins with 0.
///
/// # Errors
/// Those of `reader`.
///
/// # Source
/// IBM and Microsoft, Multimedia Programming Interface and Data Specifications 1.0 (1991), chapter 2.
pub fn without_other_chunks<R: Read>(mut reader: R) -> io::Result<impl Read> {
    let mut head = Vec::new();
    reader.by_ref().take(12).read_to_end(&mut head)?;
    if !head.ends_with(b"WAVE") {
        return Ok(Cursor::new(head).chain(reader));
    }
    let mut is_padded = false;
    loop {
        let begin = head.len();
        if is_padded {
            reader.by_ref().take(1).read_to_end(&mut head)?;
            if head[begin..] == [0] {
                head.truncate(begin);
            }
        }
        let missing = CHUNK_HEAD_BYTES - (head.len() - begin);
        reader
            .by_ref()
            .take(missing as u64)
            .read_to_end(&mut head)?;
        let Some((name, length)) = head[begin..].split_first_chunk::<4>() else {
            break;
        };
        let Ok(length) = length.try_into().map(u32::from_le_bytes) else {
            break;
        };
        if name == b"data" {
            break;
        }
        let mut content = reader.by_ref().take(length.into());
        if name == b"fmt " && length <= MAX_FORMAT_BYTES {
            content.read_to_end(&mut head)?;
        } else {
            io::copy(&mut content, &mut io::sink())?;
            head.truncate(begin);
        }
        is_padded = length % 2 == 1;
    }
    Ok(Cursor::new(head).chain(reader))
}
