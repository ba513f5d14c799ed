//! Checks of Ogg Vorbis headers before `lewton` trusts them.
//!
//! The decoder allocates memory for lengths and counts before it reads the data, so that a file of a hundred bytes could
//! claim terabytes. Layout: Xiph.Org Foundation, Vorbis I specification, sections 3.2.1 (codebooks) and 5 (comments).

use ogg::PacketReader;
use std::io::Cursor;

/// First bytes of the headers that are checked. Audio packets begin with an even byte.
const COMMENTS: &[u8] = b"\x03vorbis";
const SETUP: &[u8] = b"\x05vorbis";

/// Most code words of all codebooks of a stream, and most numbers in their vectors: some 100 MB each when unpacked.
/// Encoders write some 50,000 and 300,000.
const MOST_WORDS: u64 = 1 << 20;
const MOST_NUMBERS: u64 = 1 << 24;
/// The sync pattern of a codebook.
const SYNC: u64 = 0x56_43_42;
/// The longest code word, bits (section 3.2.1).
const LONGEST_WORD: u64 = 32;

/// Checks the headers of every stream in a file.
///
/// # Errors
/// The fault as a sentence: pages that cannot be read, lengths beyond their packet, codebooks above the caps.
pub(super) fn check(bytes: &[u8]) -> Result<(), String> {
    let mut packets = PacketReader::new(Cursor::new(bytes));
    while let Some(packet) = packets.read_packet().map_err(|error| error.to_string())? {
        if let Some(claims) = packet.data.strip_prefix(COMMENTS) {
            comments(claims).ok_or("a comment is longer than its header")?;
        } else if let Some(claims) = packet.data.strip_prefix(SETUP) {
            codebooks(claims)?;
        }
    }
    Ok(())
}

/// Returns `None` where a length exceeds the packet. Each comment has at least its length in it, which bounds their number.
fn comments(bytes: &[u8]) -> Option<()> {
    const LENGTH_BYTES: usize = 4;
    let number = |bytes: &[u8]| bytes.try_into().map(u32::from_le_bytes).ok();
    let (length, rest) = bytes.split_at_checked(LENGTH_BYTES)?;
    let rest = rest.get(number(length)? as usize..)?;
    let (count, mut rest) = rest.split_at_checked(LENGTH_BYTES)?;
    let count = number(count)? as usize;
    if count > rest.len() / LENGTH_BYTES {
        return None;
    }
    for _ in 0..count {
        let (length, text) = rest.split_at_checked(LENGTH_BYTES)?;
        rest = text.get(number(length)? as usize..)?;
    }
    Some(())
}

fn codebooks(bytes: &[u8]) -> Result<(), String> {
    let mut bits = BitReader { bytes, at: 0 };
    let count = 1 + bits.take(8)?;
    let (mut words, mut numbers) = (0, 0);
    for _ in 0..count {
        let book = CodebookSize::read(&mut bits)?;
        words += book.words;
        numbers += book.words * book.dimensions;
        if words > MOST_WORDS || numbers > MOST_NUMBERS {
            let found = format!("{words} words and {numbers} numbers");
            let allowed = format!("{MOST_WORDS} and {MOST_NUMBERS}");
            return Err(format!("codebooks of {found}, allowed {allowed}"));
        }
    }
    Ok(())
}

/// The unpacked size of a codebook.
struct CodebookSize {
    words: u64,
    dimensions: u64,
}

impl CodebookSize {
    /// Reads to the end of a codebook.
    fn read(bits: &mut BitReader) -> Result<Self, String> {
        let sync = bits.take(24)?;
        let dimensions = bits.take(16)?;
        let words = bits.take(24)?;
        if sync != SYNC || dimensions == 0 || words == 0 {
            let found = format!("{words} words of {dimensions} numbers, sync pattern {sync:06x}");
            return Err(format!("a codebook has {found}"));
        }
        if bits.take(1)? == 1 {
            skip_runs(bits, words)?;
        } else {
            skip_lengths(bits, words)?;
        }
        let values = match bits.take(4)? {
            0 => return Ok(Self { words, dimensions }),
            1 => lookup1_values(words, dimensions),
            2 => words * dimensions,
            kind => {
                let found = format!("lookup type {kind}, allowed 0 to 2");
                return Err(format!("a codebook has {found}"));
            }
        };
        // Least value and step, 32 bits each.
        bits.skip(64)?;
        let value_bits = 1 + bits.take(4)?;
        bits.skip(1 + values * value_bits)?;
        Ok(Self { words, dimensions })
    }
}

/// Skips the lengths of code words, each by itself.
fn skip_lengths(bits: &mut BitReader, words: u64) -> Result<(), String> {
    let sparse = bits.take(1)? == 1;
    for _ in 0..words {
        if !sparse || bits.take(1)? == 1 {
            bits.skip(5)?;
        }
    }
    Ok(())
}

/// Skips the lengths of code words as runs: the number of the first length, of the next, and so on.
fn skip_runs(bits: &mut BitReader, words: u64) -> Result<(), String> {
    let (mut done, mut length) = (0, 1 + bits.take(5)?);
    while done < words {
        done += bits.take(u64::BITS - (words - done).leading_zeros())?;
        if done > words || length > LONGEST_WORD {
            let found = format!("{done} words to a length of {length} bits");
            let allowed = format!("{words} to {LONGEST_WORD}");
            return Err(format!("a codebook has {found}, allowed {allowed}"));
        }
        length += 1;
    }
    Ok(())
}

/// Returns the largest number whose power of `dimensions` is at most `words` (section 9.2.3, `lookup1_values`).
fn lookup1_values(words: u64, dimensions: u64) -> u64 {
    let fits = |value: u64| {
        let mut power = 1_u64;
        // From 25 dimensions on the power of 2 is above the 2^24 words that a book can have.
        for _ in 0..dimensions.min(25) {
            power = power.saturating_mul(value);
        }
        power <= words
    };
    let (mut low, mut high) = (1, words + 1);
    while high - low > 1 {
        let middle = low + (high - low) / 2;
        if fits(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// Bits of a packet, the lowest of each byte first (section 2).
struct BitReader<'a> {
    bytes: &'a [u8],
    /// The next bit.
    at: u64,
}

impl BitReader<'_> {
    /// Reads the next `count` bits, 32 at most.
    fn take(&mut self, count: u32) -> Result<u64, String> {
        let mut value = 0;
        for k in 0..count {
            let byte = self.bytes.get((self.at / 8) as usize);
            let byte = byte.ok_or_else(truncated_codebook)?;
            value |= u64::from(byte >> (self.at % 8) & 1) << k;
            self.at += 1;
        }
        Ok(value)
    }

    fn skip(&mut self, count: u64) -> Result<(), String> {
        self.at += count;
        if self.at > 8 * self.bytes.len() as u64 {
            return Err(truncated_codebook());
        }
        Ok(())
    }
}

fn truncated_codebook() -> String {
    "a codebook is longer than its header".to_owned()
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use ogg::{PacketWriteEndInfo, PacketWriter};

    /// A real file's packets: three headers, then sound.
    pub(in super::super) fn packets() -> Vec<Vec<u8>> {
        let file = include_bytes!("../../tests/data/tone.ogg");
        let mut reader = PacketReader::new(Cursor::new(&file[..]));
        let mut packets = Vec::new();
        while let Some(packet) = reader.read_packet().unwrap() {
            packets.push(packet.data);
        }
        assert!(packets[1].starts_with(COMMENTS) && packets[2].starts_with(SETUP));
        packets
    }

    /// A whole file with valid checksums, whose packet `which` is `packet`.
    pub(in super::super) fn file_with(which: usize, packet: Vec<u8>) -> Vec<u8> {
        let mut packets = packets();
        packets[which] = packet;
        let mut bytes = Vec::new();
        let mut writer = PacketWriter::new(&mut bytes);
        let last = packets.len() - 1;
        for (k, packet) in packets.into_iter().enumerate() {
            let end = match k {
                0 | 2 => PacketWriteEndInfo::EndPage,
                k if k == last => PacketWriteEndInfo::EndStream,
                _ => PacketWriteEndInfo::NormalPacket,
            };
            writer
                .write_packet(packet.into(), 1, end, k as u64)
                .unwrap();
        }
        bytes
    }

    fn refusal(bytes: &[u8]) -> String {
        let message = crate::Recording::decode("bell", bytes).unwrap_err();
        message.to_string()
    }

    /// A setup header's codebook, the lowest bits first: (value, bits).
    fn setup_of(fields: &[(u64, u32)]) -> Vec<u8> {
        let mut bits: Vec<bool> = Vec::new();
        for (value, count) in fields {
            bits.extend((0..*count).map(|k| value >> k & 1 == 1));
        }
        let byte = |eight: &[bool]| {
            let bit = |(k, bit): (usize, &bool)| u8::from(*bit) << k;
            eight.iter().enumerate().map(bit).sum::<u8>()
        };
        let mut header = SETUP.to_vec();
        header.extend(bits.chunks(8).map(byte));
        header.extend([0; 64]);
        header
    }

    #[test]
    fn headers_of_real_files_pass() {
        let packets = packets();
        for (which, header) in packets.iter().enumerate().take(3) {
            check(&file_with(which, header.clone())).unwrap();
        }
        let mut bits = BitReader {
            bytes: &packets[2][SETUP.len()..],
            at: 0,
        };
        let count = 1 + bits.take(8).unwrap();
        let mut words = 0;
        for _ in 0..count {
            words += CodebookSize::read(&mut bits).unwrap().words;
        }
        // After the codebooks come the time domain transforms: one, which is 0.
        assert_eq!((bits.take(6), bits.take(16)), (Ok(0), Ok(0)));
        assert!((100..MOST_WORDS / 4).contains(&words), "{words}");
    }

    #[test]
    fn comments_that_claim_more_than_there_is_are_refused() {
        let header = |vendor: u32, count: u32, comment: u32| {
            let mut bytes = COMMENTS.to_vec();
            bytes.extend(vendor.to_le_bytes());
            bytes.extend(b"me");
            bytes.extend(count.to_le_bytes());
            bytes.extend(comment.to_le_bytes());
            bytes.extend(b"A=B\x01");
            bytes
        };
        check(&file_with(1, header(2, 1, 3))).unwrap();
        for (vendor, count, comment) in [
            (u32::MAX, 1, 3),
            (2, u32::MAX, 3),
            (2, 2, 3),
            (2, 1, u32::MAX),
            (2, 1, 5),
        ] {
            let message = refusal(&file_with(1, header(vendor, count, comment)));
            assert!(message.contains("a comment is longer"), "{message}");
        }
        for length in COMMENTS.len()..COMMENTS.len() + 9 {
            refusal(&file_with(1, header(2, 1, 3)[..length].to_vec()));
        }
    }

    /// 16 million words in a run of a few bits, each a vector of 65535 numbers: 4 TB.
    #[test]
    fn codebooks_that_unpack_without_bound_are_refused() {
        let book = |dimensions, words, rest: &[(u64, u32)]| {
            let mut fields = vec![(0, 8), (SYNC, 24), (dimensions, 16), (words, 24)];
            fields.extend_from_slice(rest);
            refusal(&file_with(2, setup_of(&fields)))
        };
        let words = (1 << 24) - 1;
        // Ordered, from length 24 on, all of them; a lookup of type 1 with a value of one bit.
        let run = [(1, 1), (23, 5), (words, 24), (1, 4)];
        let message = book(65_535, words, &run);
        assert!(message.contains("codebooks of 16777215 words"), "{message}");
        let run = [(1, 1), (9, 5), (1_000, 10), (1, 4)];
        let message = book(65_535, 1_000, &run);
        assert!(message.contains("65535000 numbers"), "{message}");
        let message = book(1, 1_000, &[(1, 1), (31, 5), (0, 10), (1_000, 10)]);
        assert!(message.contains("length of 33 bits"), "{message}");
        let message = book(1, 1_000, &[(1, 1), (9, 5), (1_001, 10)]);
        assert!(message.contains("1001 words"), "{message}");
        assert!(book(0, 10, &[]).contains("10 words of 0 numbers"));
        assert!(book(1, 0, &[]).contains("0 words of 1 numbers"));
        assert!(book(1, 1, &[(0, 1), (0, 1), (0, 5), (3, 4)]).contains("type 3"));
        assert!(book(1, 100_000, &[(0, 1)]).contains("longer than its header"));
        let many = [(1, 1), (9, 5), (1_000, 10), (2, 4)];
        assert!(book(9, 1_000, &many).contains("longer than its header"));
    }

    /// By the rule's words: the greatest whole number whose power is not above the words.
    #[test]
    fn values_a_dimension_are_whole_roots() {
        for (words, dimensions, values) in [
            (1_025, 10, 2),
            (1_024, 10, 2),
            (1_023, 10, 1),
            (3_126, 5, 5),
            (3_125, 5, 5),
            (3_124, 5, 4),
            (1, 1, 1),
            ((1 << 24) - 1, 1, (1 << 24) - 1),
            ((1 << 24) - 1, 65_535, 1),
        ] {
            assert_eq!(lookup1_values(words, dimensions), values, "{words}");
        }
    }
}
