//! Conversion of columns to data.

use super::{ColumnIndex, ColumnsError, FLOAT, FloatLayout, byte, layout, read_varint, take};
use serde::Deserialize;
use serde::de::value::U32Deserializer;
use serde::de::{self, DeserializeSeed, Deserializer, IntoDeserializer, Visitor};

/// Returns the value that [`to_bytes`](super::to_bytes) wrote, of the same type.
///
/// # Errors
/// [`ColumnsError`] for bytes of anything else.
pub fn from_bytes<'de, T: Deserialize<'de>>(bytes: &'de [u8]) -> Result<T, ColumnsError> {
    let mut head = bytes;
    let count = read_varint(&mut head)?;
    // Each column's header has four numbers.
    if count > (head.len() / 4) as u64 {
        return Err(ColumnsError::UnexpectedEnd);
    }
    let mut sizes = Vec::with_capacity(count as usize);
    for _ in 0..count {
        let floats = length(&mut head)?;
        let layout = FloatLayout::from_byte(byte(&mut head)?)?;
        sizes.push((floats, layout, length(&mut head)?, length(&mut head)?));
    }
    let mut columns = Vec::with_capacity(count as usize);
    for (floats, layout, bytes, rest) in sizes {
        columns.push(Column {
            floats: layout::read_floats(layout, floats, take(&mut head, bytes)?)?,
            read: 0,
            rest: take(&mut head, rest)?,
        });
    }
    let mut reader = ColumnarReader {
        names: ColumnIndex::new(),
        columns,
        at: 0,
    };
    let data = T::deserialize(&mut reader)?;
    let left = head.len() + reader.columns.iter().map(Column::left).sum::<usize>();
    if left > 0 {
        return Err(ColumnsError::TrailingData(left));
    }
    Ok(data)
}

fn length(bytes: &mut &[u8]) -> Result<usize, ColumnsError> {
    let found = read_varint(bytes)?;
    let place = "a length";
    usize::try_from(found).map_err(|_| ColumnsError::OutOfRange { found, place })
}

/// The column of one name.
struct Column<'de> {
    /// The bits of floats.
    floats: Vec<u32>,
    /// Number of floats read.
    read: usize,
    rest: &'de [u8],
}

impl Column<'_> {
    fn float(&mut self) -> Result<f32, ColumnsError> {
        let bits = self
            .floats
            .get(self.read)
            .ok_or(ColumnsError::UnexpectedEnd)?;
        self.read += 1;
        Ok(f32::from_bits(*bits))
    }

    /// Returns the number of unread bytes.
    fn left(&self) -> usize {
        (self.floats.len() - self.read) * FLOAT + self.rest.len()
    }
}

struct ColumnarReader<'de> {
    names: ColumnIndex,
    columns: Vec<Column<'de>>,
    /// The current column.
    at: usize,
}

impl<'de> ColumnarReader<'de> {
    fn non_float_bytes(&mut self) -> Result<&mut &'de [u8], ColumnsError> {
        let column = self.columns.get_mut(self.at);
        Ok(&mut column.ok_or(ColumnsError::UnexpectedEnd)?.rest)
    }

    fn byte(&mut self) -> Result<u8, ColumnsError> {
        byte(self.non_float_bytes()?)
    }

    fn read_unsigned(&mut self) -> Result<u64, ColumnsError> {
        read_varint(self.non_float_bytes()?)
    }

    fn signed(&mut self) -> Result<i64, ColumnsError> {
        let number = self.read_unsigned()?;
        Ok((number >> 1).cast_signed() ^ -(number & 1).cast_signed())
    }

    fn length(&mut self) -> Result<usize, ColumnsError> {
        length(self.non_float_bytes()?)
    }

    fn read_bytes(&mut self) -> Result<&'de [u8], ColumnsError> {
        let length = self.length()?;
        take(self.non_float_bytes()?, length)
    }
}

macro_rules! numbers {
    ($($method:ident $read:ident $type:ty, $visit:ident, $place:literal;)*) => {$(
        fn $method<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ColumnsError> {
            let found = self.$read()?;
            let number = <$type>::try_from(found).map_err(|_| ColumnsError::OutOfRange {
                found: found as u64,
                place: $place,
            })?;
            visitor.$visit(number)
        }
    )*};
}

impl<'de> Deserializer<'de> for &mut ColumnarReader<'de> {
    type Error = ColumnsError;

    fn is_human_readable(&self) -> bool {
        false
    }

    numbers! {
        deserialize_i16 signed i16, visit_i16, "a signed number of 16 bits";
        deserialize_i32 signed i32, visit_i32, "a signed number of 32 bits";
        deserialize_i64 signed i64, visit_i64, "a signed number of 64 bits";
        deserialize_u16 read_unsigned u16, visit_u16, "a number of 16 bits";
        deserialize_u32 read_unsigned u32, visit_u32, "a number of 32 bits";
        deserialize_u64 read_unsigned u64, visit_u64, "a number of 64 bits";
    }

    fn deserialize_any<V: Visitor<'de>>(self, _visitor: V) -> Result<V::Value, ColumnsError> {
        Err(ColumnsError::Unsupported(
            "data that is read by asking what it is",
        ))
    }

    fn deserialize_ignored_any<V: Visitor<'de>>(
        self,
        visitor: V,
    ) -> Result<V::Value, ColumnsError> {
        self.deserialize_any(visitor)
    }

    fn deserialize_identifier<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ColumnsError> {
        self.deserialize_any(visitor)
    }

    fn deserialize_bool<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ColumnsError> {
        match self.byte()? {
            0 => visitor.visit_bool(false),
            1 => visitor.visit_bool(true),
            found => Err(ColumnsError::OutOfRange {
                found: found.into(),
                place: "yes or no",
            }),
        }
    }

    fn deserialize_i8<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ColumnsError> {
        visitor.visit_i8(self.byte()?.cast_signed())
    }

    fn deserialize_u8<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ColumnsError> {
        visitor.visit_u8(self.byte()?)
    }

    fn deserialize_u128<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ColumnsError> {
        let (low, high) = (self.read_unsigned()?, self.read_unsigned()?);
        visitor.visit_u128(u128::from(low) | u128::from(high) << 64)
    }

    fn deserialize_f32<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ColumnsError> {
        let column = self.columns.get_mut(self.at);
        let column = column.ok_or(ColumnsError::UnexpectedEnd)?;
        visitor.visit_f32(column.float()?)
    }

    fn deserialize_f64<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ColumnsError> {
        let bytes = take(self.non_float_bytes()?, 8)?;
        let bytes = std::array::from_fn(|k| bytes[k]);
        visitor.visit_f64(f64::from_le_bytes(bytes))
    }

    fn deserialize_char<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ColumnsError> {
        let found = self.read_unsigned()?;
        let letter = u32::try_from(found).ok().and_then(char::from_u32);
        let place = "a letter";
        visitor.visit_char(letter.ok_or(ColumnsError::OutOfRange { found, place })?)
    }

    fn deserialize_str<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ColumnsError> {
        let text = std::str::from_utf8(self.read_bytes()?).map_err(de::Error::custom)?;
        visitor.visit_borrowed_str(text)
    }

    fn deserialize_string<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ColumnsError> {
        self.deserialize_str(visitor)
    }

    fn deserialize_bytes<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ColumnsError> {
        visitor.visit_borrowed_bytes(self.read_bytes()?)
    }

    fn deserialize_byte_buf<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ColumnsError> {
        self.deserialize_bytes(visitor)
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ColumnsError> {
        match self.byte()? {
            0 => visitor.visit_none(),
            1 => visitor.visit_some(self),
            found => Err(ColumnsError::OutOfRange {
                found: found.into(),
                place: "something or nothing",
            }),
        }
    }

    fn deserialize_unit<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ColumnsError> {
        visitor.visit_unit()
    }

    fn deserialize_unit_struct<V: Visitor<'de>>(
        self,
        _name: &'static str,
        visitor: V,
    ) -> Result<V::Value, ColumnsError> {
        visitor.visit_unit()
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        _name: &'static str,
        visitor: V,
    ) -> Result<V::Value, ColumnsError> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ColumnsError> {
        let length = self.length()?;
        visitor.visit_seq(SequenceReader::new(self, length))
    }

    fn deserialize_tuple<V: Visitor<'de>>(
        self,
        length: usize,
        visitor: V,
    ) -> Result<V::Value, ColumnsError> {
        visitor.visit_seq(SequenceReader::new(self, length))
    }

    fn deserialize_tuple_struct<V: Visitor<'de>>(
        self,
        _name: &'static str,
        length: usize,
        visitor: V,
    ) -> Result<V::Value, ColumnsError> {
        visitor.visit_seq(SequenceReader::new(self, length))
    }

    fn deserialize_map<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ColumnsError> {
        let length = self.length()?;
        visitor.visit_map(SequenceReader::new(self, length))
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, ColumnsError> {
        visitor.visit_seq(StructReader {
            outside: self.at,
            reader: self,
            owner: name,
            left: fields.iter(),
        })
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _name: &'static str,
        variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, ColumnsError> {
        visitor.visit_enum(EnumReader {
            reader: self,
            variants,
            chosen: "",
        })
    }
}

/// Reads a sequence.
struct SequenceReader<'a, 'de> {
    reader: &'a mut ColumnarReader<'de>,
    left: usize,
}

impl<'a, 'de> SequenceReader<'a, 'de> {
    fn new(reader: &'a mut ColumnarReader<'de>, left: usize) -> Self {
        Self { reader, left }
    }

    /// No more capacity than this is reserved: a length may be damaged.
    fn capped_len(&self) -> usize {
        self.left.min(1 << 12)
    }
}

impl<'de> de::SeqAccess<'de> for SequenceReader<'_, 'de> {
    type Error = ColumnsError;

    fn next_element_seed<T: DeserializeSeed<'de>>(
        &mut self,
        seed: T,
    ) -> Result<Option<T::Value>, ColumnsError> {
        let Some(left) = self.left.checked_sub(1) else {
            return Ok(None);
        };
        self.left = left;
        seed.deserialize(&mut *self.reader).map(Some)
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.capped_len())
    }
}

impl<'de> de::MapAccess<'de> for SequenceReader<'_, 'de> {
    type Error = ColumnsError;

    fn next_key_seed<K: DeserializeSeed<'de>>(
        &mut self,
        seed: K,
    ) -> Result<Option<K::Value>, ColumnsError> {
        de::SeqAccess::next_element_seed(self, seed)
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(
        &mut self,
        seed: V,
    ) -> Result<V::Value, ColumnsError> {
        seed.deserialize(&mut *self.reader)
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.capped_len())
    }
}

/// Reads a struct with named fields.
struct StructReader<'a, 'de> {
    reader: &'a mut ColumnarReader<'de>,
    owner: &'static str,
    left: std::slice::Iter<'static, &'static str>,
    outside: usize,
}

impl<'de> de::SeqAccess<'de> for StructReader<'_, 'de> {
    type Error = ColumnsError;

    fn next_element_seed<T: DeserializeSeed<'de>>(
        &mut self,
        seed: T,
    ) -> Result<Option<T::Value>, ColumnsError> {
        let Some(name) = self.left.next() else {
            return Ok(None);
        };
        self.reader.at = self.reader.names.column(self.owner, name);
        let value = seed.deserialize(&mut *self.reader);
        self.reader.at = self.outside;
        value.map(Some)
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.left.len())
    }
}

/// Reads an enum.
struct EnumReader<'a, 'de> {
    reader: &'a mut ColumnarReader<'de>,
    variants: &'static [&'static str],
    chosen: &'static str,
}

impl<'de> de::EnumAccess<'de> for EnumReader<'_, 'de> {
    type Error = ColumnsError;
    type Variant = Self;

    fn variant_seed<V: DeserializeSeed<'de>>(
        mut self,
        seed: V,
    ) -> Result<(V::Value, Self), ColumnsError> {
        let found = self.reader.read_unsigned()?;
        let place = "one of its kinds";
        let index = u32::try_from(found).map_err(|_| ColumnsError::OutOfRange { found, place })?;
        let chosen = self.variants.get(index as usize);
        self.chosen = chosen.ok_or(ColumnsError::OutOfRange { found, place })?;
        let index: U32Deserializer<ColumnsError> = index.into_deserializer();
        Ok((seed.deserialize(index)?, self))
    }
}

impl<'de> de::VariantAccess<'de> for EnumReader<'_, 'de> {
    type Error = ColumnsError;

    fn unit_variant(self) -> Result<(), ColumnsError> {
        Ok(())
    }

    fn newtype_variant_seed<T: DeserializeSeed<'de>>(
        self,
        seed: T,
    ) -> Result<T::Value, ColumnsError> {
        seed.deserialize(self.reader)
    }

    fn tuple_variant<V: Visitor<'de>>(
        self,
        length: usize,
        visitor: V,
    ) -> Result<V::Value, ColumnsError> {
        visitor.visit_seq(SequenceReader::new(self.reader, length))
    }

    fn struct_variant<V: Visitor<'de>>(
        self,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, ColumnsError> {
        self.reader.deserialize_struct(self.chosen, fields, visitor)
    }
}
