//! Layouts of a column's floats.

use super::{ColumnsError, FLOAT, FloatLayout, push_varint, read_varint, take};
use std::collections::HashMap;

/// Columns with fewer floats than this are not searched for repeated rows.
const MIN_FLOATS: usize = 64;
/// Repetitions below this mean number are not worth back references.
const MIN_REPEATS: usize = 2;
/// Largest deviation of the square of a unit row's length from 1.
const UNIT_TOLERANCE: f32 = 1e-5;
/// Largest deviation of the last component of a unit row from the one computed from the others, in steps of a float.
const MAX_UNIT_STEPS: i32 = 15;

/// Writes floats in the layout that usually packs best.
pub(super) fn write_floats(floats: &[u32], bytes: &mut Vec<u8>) -> FloatLayout {
    for width in FloatLayout::WIDTHS {
        if floats.len() >= MIN_FLOATS && floats.len().is_multiple_of(width) {
            let rows = RowDictionary::of(floats, width);
            let unit = rows.units.is_some();
            if unit || rows.new_row_count(width) * MIN_REPEATS < rows.back.len() {
                rows.write(bytes);
                return FloatLayout::Rows { width, unit };
            }
        }
    }
    let mut sorted = floats.to_vec();
    sorted.sort_unstable();
    sorted.dedup();
    if sorted.len() * MIN_REPEATS < floats.len() {
        bytes.extend(floats.iter().flat_map(|bits| bits.to_le_bytes()));
        return FloatLayout::Plain;
    }
    write_byte_shuffled(floats, bytes);
    FloatLayout::ByteShuffled
}

/// Reads `count` floats that [`write_floats`] wrote.
pub(super) fn read_floats(
    layout: FloatLayout,
    count: usize,
    bytes: &[u8],
) -> Result<Vec<u32>, ColumnsError> {
    match layout {
        FloatLayout::Rows { width, unit } => read_rows(width, unit, count, bytes),
        _ if count.checked_mul(FLOAT) != Some(bytes.len()) => Err(ColumnsError::UnexpectedEnd),
        FloatLayout::ByteShuffled => Ok(read_byte_shuffled(bytes)),
        FloatLayout::Plain => Ok(bytes
            .as_chunks()
            .0
            .iter()
            .map(|four| u32::from_le_bytes(*four))
            .collect()),
    }
}

fn write_byte_shuffled(floats: &[u32], bytes: &mut Vec<u8>) {
    for k in 0..FLOAT {
        bytes.extend(floats.iter().map(|bits| bits.to_le_bytes()[k]));
    }
}

fn read_byte_shuffled(bytes: &[u8]) -> Vec<u32> {
    let count = bytes.len() / FLOAT;
    (0..count)
        .map(|at| u32::from_le_bytes(std::array::from_fn(|k| bytes[k * count + at])))
        .collect()
}

/// Rows of floats of which many repeat: the rotation of an object that touches ten others, the direction of a floor.
struct RowDictionary {
    /// Of each row: 0 for a new one, else the distance back to its first occurrence in new rows.
    back: Vec<u64>,
    /// The new rows, one after the other.
    new: Vec<u32>,
    /// Of each new row, if most are of unit length: the code of its largest component, or 0; of that row, only the other
    /// components are kept in `new`.
    units: Option<Vec<u8>>,
}

impl RowDictionary {
    fn of(floats: &[u32], width: usize) -> Self {
        let mut met: HashMap<&[u32], u64> = HashMap::new();
        let (mut back, mut new) = (Vec::with_capacity(floats.len() / width), Vec::new());
        for row in floats.chunks_exact(width) {
            let next = met.len() as u64;
            let first = *met.entry(row).or_insert(next);
            back.push(if first == next { 0 } else { next - first });
            if first == next {
                new.extend_from_slice(row);
            }
        }
        let codes: Vec<u8> = new
            .chunks_exact(width)
            .map(encode_largest_component)
            .collect();
        let unit = codes.iter().filter(|code| **code > 0).count();
        let units = (unit * 2 > codes.len()).then_some(codes);
        if let Some(codes) = &units {
            let rows = new.chunks_exact(width).zip(codes);
            let kept = |(row, code): (&[u32], &u8)| {
                let left_out = if *code == 0 {
                    width
                } else {
                    usize::from(code & 3)
                };
                let parts = row.iter().enumerate();
                parts
                    .filter(move |(k, _)| *k != left_out)
                    .map(|(_, bits)| *bits)
                    .collect::<Vec<_>>()
            };
            new = rows.flat_map(kept).collect();
        }
        Self { back, new, units }
    }

    fn new_row_count(&self, width: usize) -> usize {
        self.units.as_ref().map_or(self.new.len() / width, Vec::len)
    }

    fn write(&self, bytes: &mut Vec<u8>) {
        for back in &self.back {
            push_varint(bytes, *back);
        }
        bytes.extend(self.units.iter().flatten());
        write_byte_shuffled(&self.new, bytes);
    }
}

fn read_rows(
    width: usize,
    unit: bool,
    count: usize,
    mut bytes: &[u8],
) -> Result<Vec<u32>, ColumnsError> {
    // Each row takes a byte at least.
    let rows = count / width;
    if !count.is_multiple_of(width) || rows > bytes.len() {
        return Err(ColumnsError::UnexpectedEnd);
    }
    let mut back = Vec::with_capacity(rows);
    for _ in 0..rows {
        back.push(read_varint(&mut bytes)?);
    }
    let count_new = back.iter().filter(|back| **back == 0).count();
    let codes = if unit {
        take(&mut bytes, count_new)?
    } else {
        &[]
    };
    let kept = read_byte_shuffled(bytes);
    let mut kept_at = 0;
    let mut next = |wanted: usize| {
        let found = kept
            .get(kept_at..kept_at + wanted)
            .ok_or(ColumnsError::UnexpectedEnd);
        kept_at += wanted;
        found
    };
    let mut new: Vec<u32> = Vec::with_capacity(count_new * width);
    for k in 0..count_new {
        match codes.get(k) {
            None | Some(0) => new.extend_from_slice(next(width)?),
            Some(code) => new.extend(unit_row(*code, next(width - 1)?)?),
        }
    }
    if kept_at * FLOAT != bytes.len() {
        return Err(ColumnsError::TrailingData(
            bytes.len().saturating_sub(kept_at * FLOAT),
        ));
    }
    let (mut floats, mut met) = (Vec::with_capacity(count), 0_usize);
    for back in back {
        let first = match back {
            0 => met,
            _ => usize::try_from(back)
                .ok()
                .and_then(|back| met.checked_sub(back))
                .ok_or(ColumnsError::UnexpectedEnd)?,
        };
        met += usize::from(back == 0);
        floats.extend_from_slice(&new[first * width..(first + 1) * width]);
    }
    Ok(floats)
}

/// Returns the index of the largest component of a row (2 bits), its sign, and its deviation in steps from the value
/// computed from the others, in one byte; 0 for a row that is not of unit length.
fn encode_largest_component(row: &[u32]) -> u8 {
    let size = |k: usize| f32::from_bits(row[k]).abs();
    let largest = (1..row.len()).fold(0, |best, k| if size(k) > size(best) { k } else { best });
    let others = || {
        row.iter()
            .enumerate()
            .filter(|(k, _)| *k != largest)
            .map(|(_, bits)| *bits)
    };
    let Some(expected) = implied_component(others()) else {
        return 0;
    };
    let found = size(largest);
    let steps = (found.to_bits().cast_signed()).wrapping_sub(expected.to_bits().cast_signed());
    let near = (found * found - expected * expected).abs() < UNIT_TOLERANCE
        && steps.abs() <= MAX_UNIT_STEPS;
    if !near {
        return 0;
    }
    let negative = row[largest] >> 31;
    let code = ((steps + MAX_UNIT_STEPS + 1).cast_unsigned() * 2 + negative) * 4 + largest as u32;
    code as u8
}

/// Returns the row of a [`unit_code`].
fn unit_row(code: u8, others: &[u32]) -> Result<impl Iterator<Item = u32>, ColumnsError> {
    let place = "the largest part of a row";
    let refused = ColumnsError::OutOfRange {
        found: code.into(),
        place,
    };
    let (largest, negative) = (usize::from(code & 3), u32::from(code >> 2 & 1));
    let steps = i32::from(code >> 3) - MAX_UNIT_STEPS - 1;
    let expected = implied_component(others.iter().copied());
    let (Some(expected), true) = (expected, largest <= others.len()) else {
        return Err(refused);
    };
    let size = expected
        .to_bits()
        .cast_signed()
        .wrapping_add(steps)
        .cast_unsigned();
    let part = size & 0x7fff_ffff | negative << 31;
    Ok(others[..largest]
        .iter()
        .copied()
        .chain([part])
        .chain(others[largest..].iter().copied())
        .collect::<Vec<_>>()
        .into_iter())
}

/// Returns the last component of a unit row computed from its others.
fn implied_component(others: impl Iterator<Item = u32>) -> Option<f32> {
    let squares = others
        .map(f32::from_bits)
        .fold(0.0, |sum, part| sum + part * part);
    let square = 1.0 - squares;
    (square > 0.0).then(|| square.sqrt())
}
