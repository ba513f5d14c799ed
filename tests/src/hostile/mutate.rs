//! Mutations: bits, bytes, pieces, numbers, and the tokens of JSON, XML and OBJ.

use dwell_scene::random::RandomStream;

/// Numbers that no field means.
const NUMBERS: [&str; 16] = [
    "-1",
    "0",
    "1e39",
    "-1e39",
    "1e308",
    "1e-45",
    "nan",
    "inf",
    "65536",
    "4294967295",
    "18446744073709551615",
    "-9223372036854775808",
    "0.1",
    "3",
    "1e5",
    "99999999999999999999999",
];
/// Substitutes for any value.
const VALUES: [&str; 12] = [
    "null",
    "true",
    "[]",
    "{}",
    "\"\"",
    "\"x\"",
    "\"../../etc/passwd\"",
    "\"/etc/passwd\"",
    "[[[[]]]]",
    "[null]",
    "{\"a\": 1}",
    "\"\\u0000\"",
];

/// The bytes with one to four changes.
pub fn mutated(bytes: &[u8], random: &mut RandomStream) -> Vec<u8> {
    // Inside of a GLB most changes to the text would end at its stated length.
    if bytes.starts_with(b"glTF")
        && random.below(3) > 0
        && let Some((text, blob)) = halves(bytes)
    {
        return if random.below(3) > 0 {
            joined(&changed(text, random), blob)
        } else {
            joined(text, &changed(blob, random))
        };
    }
    changed(bytes, random)
}

fn changed(bytes: &[u8], random: &mut RandomStream) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    for _ in 0..=random.below(4) {
        change(&mut bytes, random);
    }
    bytes
}

fn change(bytes: &mut Vec<u8>, random: &mut RandomStream) {
    if bytes.is_empty() {
        bytes.extend_from_slice(VALUES[random.below(VALUES.len())].as_bytes());
        return;
    }
    let at = random.below(bytes.len());
    let length = 1 + random.below((bytes.len() - at).min(64));
    match random.below(10) {
        0 => bytes[at] ^= 1 << random.below(8),
        1 => bytes[at] = random.below(256) as u8,
        2 => bytes.truncate(at),
        3 => {
            bytes.drain(at..at + length);
        }
        // A piece again, or in another place.
        4 => {
            let piece = bytes[at..at + length].to_vec();
            let to = random.below(bytes.len());
            bytes.splice(to..to, piece);
        }
        5 => {
            let word = [
                0_u32,
                1,
                u32::MAX,
                0x7F80_0000,
                0x7FC0_0000,
                0x7F7F_FFFF,
                0x8000_0000,
            ][random.below(7)];
            for (k, byte) in word.to_le_bytes().into_iter().enumerate() {
                if let Some(slot) = bytes.get_mut(at + k) {
                    *slot = byte;
                }
            }
        }
        6 | 7 => replace(bytes, at, is_number, NUMBERS[random.below(NUMBERS.len())]),
        8 => replace(bytes, at, is_word, VALUES[random.below(VALUES.len())]),
        // One token in the place of another.
        _ => {
            let other = random.below(bytes.len());
            let (a, b) = (token(bytes, at, is_word), token(bytes, other, is_word));
            if let (Some((start, end)), Some((from, to))) = (a, b) {
                let piece = bytes[from..to].to_vec();
                bytes.splice(start..end, piece);
            }
        }
    }
}

fn is_number(byte: u8) -> bool {
    byte.is_ascii_digit() || matches!(byte, b'.' | b'-' | b'+' | b'e' | b'E')
}

fn is_word(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || matches!(byte, b'.' | b'-' | b'+' | b'_' | b'"')
}

/// The first token from `at` on, within 4 KiB.
fn token(bytes: &[u8], at: usize, is: fn(u8) -> bool) -> Option<(usize, usize)> {
    let window = &bytes[at..bytes.len().min(at + 4096)];
    let start = at + window.iter().position(|byte| is(*byte))?;
    let length = bytes[start..].iter().position(|byte| !is(*byte));
    Some((start, length.map_or(bytes.len(), |length| start + length)))
}

fn replace(bytes: &mut Vec<u8>, at: usize, is: fn(u8) -> bool, text: &str) {
    if let Some((start, end)) = token(bytes, at, is) {
        bytes.splice(start..end, text.bytes());
    }
}

/// The text and the binary chunk of a sound GLB.
fn halves(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let word =
        |at: usize| Some(u32::from_le_bytes(bytes.get(at..at + 4)?.try_into().ok()?) as usize);
    let length = word(12)?;
    let text = bytes.get(20..20 + length)?;
    Some((text, bytes.get(28 + length..).unwrap_or_default()))
}

fn joined(text: &[u8], blob: &[u8]) -> Vec<u8> {
    let mut text = text.to_vec();
    text.resize(text.len().next_multiple_of(4), b' ');
    let mut blob = blob.to_vec();
    blob.resize(blob.len().next_multiple_of(4), 0);
    let word = |x: usize| (x as u32).to_le_bytes();
    let mut bytes = b"glTF".to_vec();
    for part in [
        word(2),
        word(28 + text.len() + blob.len()),
        word(text.len()),
        *b"JSON",
    ] {
        bytes.extend(part);
    }
    bytes.extend(text);
    bytes.extend(word(blob.len()));
    bytes.extend(b"BIN\0");
    bytes.extend(blob);
    bytes
}
