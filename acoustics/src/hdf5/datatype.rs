//! Datatypes of values.

use super::bytes::{Cursor, Hdf5Result, unsupported};

/// The supported datatypes: numbers and text.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Datatype {
    Integer {
        size: usize,
        signed: bool,
        big: bool,
    },
    Float {
        size: usize,
        big: bool,
    },
    /// Text of a fixed number of bytes.
    Text {
        size: usize,
    },
    /// Text in a heap.
    LongText,
}

/// The layout of a float: exponent's place and size, mantissa's place and size, bias, and the sign's place.
const SINGLE: ([u8; 4], u32, u32) = ([23, 8, 0, 23], 127, 31);
const DOUBLE: ([u8; 4], u32, u32) = ([52, 11, 0, 52], 1023, 63);

impl Datatype {
    pub(super) fn read(mut cursor: Cursor<'_>) -> Hdf5Result<Self> {
        let class = cursor.u8()?;
        let bits = cursor.uint(3)? as u32;
        let size = cursor.u32()? as usize;
        let big = bits & 1 != 0;
        match class & 0x0f {
            0 => {
                let (offset, precision) = (cursor.u16()?, usize::from(cursor.u16()?));
                if !matches!(size, 1 | 2 | 4 | 8) || offset != 0 || precision != 8 * size {
                    return unsupported(format!(
                        "integers of {precision} bits in {size} bytes; allowed are 8, 16, 32 and 64 bits"
                    ));
                }
                let signed = bits & 0x08 != 0;
                Ok(Self::Integer { size, signed, big })
            }
            1 => {
                let whole = (cursor.u16()?, usize::from(cursor.u16()?)) == (0, 8 * size);
                let mut parts = [0; 4];
                parts.copy_from_slice(cursor.take(4)?);
                let found = (parts, cursor.u32()?, (bits >> 8) & 0xff);
                let known = (size == 4 && found == SINGLE) || (size == 8 && found == DOUBLE);
                if !known || !whole || bits & 0x40 != 0 {
                    return unsupported(
                        "floats of a form of their own; allowed are IEEE 754's of 32 and 64 bits",
                    );
                }
                Ok(Self::Float { size, big })
            }
            3 => Ok(Self::Text { size }),
            9 if bits & 0x0f == 1 => Ok(Self::LongText),
            _ => unsupported("neither numbers nor text"),
        }
    }

    /// Returns the bytes of a number; `None` for another type.
    pub(super) fn number_size(self) -> Option<usize> {
        match self {
            Self::Integer { size, .. } | Self::Float { size, .. } => Some(size),
            Self::Text { .. } | Self::LongText => None,
        }
    }

    /// Returns a number from its bytes.
    pub(super) fn number(self, bytes: &[u8]) -> f64 {
        let big = matches!(
            self,
            Self::Integer { big: true, .. } | Self::Float { big: true, .. }
        );
        let fold = |value: u64, byte: &u8| (value << 8) | u64::from(*byte);
        let bits = if big {
            bytes.iter().fold(0, fold)
        } else {
            bytes.iter().rev().fold(0, fold)
        };
        match self {
            Self::Float { size: 4, .. } => f64::from(f32::from_bits(bits as u32)),
            Self::Float { .. } => f64::from_bits(bits),
            Self::Integer {
                size, signed: true, ..
            } => {
                let unused = 64 - 8 * size as u32;
                ((bits << unused) as i64 >> unused) as f64
            }
            _ => bits as f64,
        }
    }
}
