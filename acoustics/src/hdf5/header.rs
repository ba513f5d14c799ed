//! Object headers: lists of messages, in two versions of the format.

use super::bytes::{Cursor, FileBytes, Hdf5Result, unsupported};
use std::collections::VecDeque;

/// Kinds of messages that are read.
pub(super) mod kind {
    pub(in super::super) const DATASPACE: u16 = 0x01;
    pub(in super::super) const LINK_INFO: u16 = 0x02;
    pub(in super::super) const DATATYPE: u16 = 0x03;
    pub(in super::super) const LINK: u16 = 0x06;
    pub(in super::super) const EXTERNAL_FILES: u16 = 0x07;
    pub(in super::super) const LAYOUT: u16 = 0x08;
    pub(in super::super) const FILTERS: u16 = 0x0b;
    pub(in super::super) const ATTRIBUTE: u16 = 0x0c;
    pub(in super::super) const CONTINUATION: u16 = 0x10;
    pub(in super::super) const SYMBOL_TABLE: u16 = 0x11;
    pub(in super::super) const ATTRIBUTE_INFO: u16 = 0x15;
}

/// Most messages of a header: with more, it has too many attributes, or blocks that refer to each other.
const MOST_MESSAGES: usize = 65_536;

/// A message of a header.
#[derive(Debug, Clone)]
pub(super) struct HeaderMessage<'a> {
    pub(super) kind: u16,
    /// Set if its content is stored elsewhere.
    pub(super) shared: bool,
    content: Cursor<'a>,
}

/// The header of a group or a dataset.
#[derive(Debug)]
pub(super) struct ObjectHeader<'a> {
    messages: Vec<HeaderMessage<'a>>,
}

impl<'a> ObjectHeader<'a> {
    pub(super) fn read(source: &'a FileBytes<'_>, address: u64) -> Hdf5Result<Self> {
        let mut messages = Vec::new();
        let mut cursor = source.at(address)?;
        let mut blocks = VecDeque::new();
        let tracked = if cursor.clone().take(4)? == b"OHDR" {
            cursor.check_signature(b"OHDR", 2)?;
            let flags = cursor.u8()?;
            let times = if flags & 0x20 == 0 { 0 } else { 16 };
            let phases = if flags & 0x10 == 0 { 0 } else { 4 };
            cursor.skip(times + phases)?;
            let size = cursor.uint(1 << (flags & 3))?;
            blocks.push_back(cursor.sub_cursor(as_size(size)?)?);
            Some(flags & 0x04 != 0)
        } else {
            let version = cursor.u8()?;
            if version != 1 {
                return unsupported(format!(
                    "damaged at byte {address}: expected the header of an object"
                ));
            }
            cursor.skip(7)?;
            let size = cursor.u32()?;
            // Messages begin at a multiple of 8 bytes.
            cursor.skip(4)?;
            blocks.push_back(cursor.sub_cursor(size as usize)?);
            None
        };
        let mut count = 0;
        while let Some(mut block) = blocks.pop_front() {
            while let Some(message) = HeaderMessage::next(&mut block, tracked)? {
                count += 1;
                if count > MOST_MESSAGES {
                    return unsupported(format!(
                        "damaged: its header loops, or has more than {MOST_MESSAGES} messages"
                    ));
                }
                if message.kind != kind::CONTINUATION {
                    messages.push(message);
                    continue;
                }
                let mut content = message.content;
                let (place, length) = (content.defined_address()?, content.length()?);
                let mut more = source.block(place, length)?;
                if tracked.is_some() {
                    if more.take(4)? != b"OCHK" {
                        return unsupported(format!(
                            "damaged at byte {place}: expected a block OCHK"
                        ));
                    }
                    // A checksum follows the messages.
                    let length = more.remaining().saturating_sub(4);
                    more = more.sub_cursor(length)?;
                }
                blocks.push_back(more);
            }
        }
        Ok(Self { messages })
    }

    /// Returns the messages of a kind.
    pub(super) fn messages_of_kind(&self, kind: u16) -> impl Iterator<Item = &HeaderMessage<'a>> {
        self.messages
            .iter()
            .filter(move |message| message.kind == kind)
    }

    /// Returns the first message of a kind.
    pub(super) fn first(&self, kind: u16) -> Option<&HeaderMessage<'a>> {
        self.messages_of_kind(kind).next()
    }
}

impl<'a> HeaderMessage<'a> {
    /// Reads the next message of a block; `tracked`: for headers of version 2, whether messages have numbers.
    fn next(block: &mut Cursor<'a>, tracked: Option<bool>) -> Hdf5Result<Option<Self>> {
        let prefix = match tracked {
            None => 8,
            Some(false) => 4,
            Some(true) => 6,
        };
        // The rest of a block of version 2 may be too short for a message.
        if block.remaining() < prefix {
            return Ok(None);
        }
        let kind = if tracked.is_none() {
            block.u16()?
        } else {
            u16::from(block.u8()?)
        };
        let size = usize::from(block.u16()?);
        let flags = block.u8()?;
        block.skip(match tracked {
            None => 3,
            Some(false) => 0,
            Some(true) => 2,
        })?;
        Ok(Some(Self {
            kind,
            shared: flags & 0x02 != 0,
            content: block.sub_cursor(size)?,
        }))
    }

    /// Returns its content.
    pub(super) fn content(&self) -> Hdf5Result<Cursor<'a>> {
        if self.shared {
            return unsupported("it shares its description with another object; not read");
        }
        Ok(self.content.clone())
    }
}

/// Converts a number of bytes.
pub(super) fn as_size(found: u64) -> Hdf5Result<usize> {
    usize::try_from(found).or_else(|_| unsupported(format!("damaged: a size of {found} bytes")))
}
