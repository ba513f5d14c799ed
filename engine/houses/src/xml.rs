//! Bounded parsing of XML: the parser calls itself for every nested element, and takes memory for every node.

use dwell_scene::interrupt;
use roxmltree::{Document, Node, ParsingOptions};

use crate::error::HousesError;
use crate::limits::{MAX_XML_ATTRIBUTES, MAX_XML_DEPTH, MAX_XML_ELEMENTS};
use crate::report::FileLocation;

/// Parses a text.
///
/// # Errors
/// [`HousesError::TooLarge`] for elements nested too deep, and for too many attributes or namespaces, [`HousesError::Syntax`] with
/// the line for what is no XML, or has a document type, or too many nodes.
pub(crate) fn parse<'a>(text: &'a str, at: &FileLocation) -> Result<Document<'a>, HousesError> {
    check(text, at)?;
    let options = ParsingOptions {
        // Elements, and the white space around them.
        nodes_limit: 4 * MAX_XML_ELEMENTS as u32,
        ..ParsingOptions::default()
    };
    Document::parse_with_options(text, options).map_err(|error| HousesError::Syntax {
        at: at.line(error.pos().row),
        message: match error {
            roxmltree::Error::DtdDetected => {
                "XML with a DTD (<!DOCTYPE ...>); allowed is XML without one".to_owned()
            }
            error => error.to_string(),
        },
    })
}

/// Bytes between the places where a [`LineIndex`] knows the line.
const LINE_BLOCK: usize = 4096;

/// The lines of a document's nodes. The parser itself counts all lines from the start of the text at each question.
pub(crate) struct LineIndex {
    /// Line breaks before each block of the text.
    before: Vec<u32>,
}

impl LineIndex {
    pub(crate) fn new(document: &Document<'_>) -> Self {
        let mut breaks = 0;
        let blocks = document.input_text().as_bytes().chunks(LINE_BLOCK);
        let before = blocks.map(|block| {
            interrupt::unwind_if_cancelled();
            let before = breaks;
            breaks += break_count(block);
            before
        });
        Self {
            before: before.collect(),
        }
    }

    /// The 1-based line on which a node of the document begins.
    pub(crate) fn line(&self, node: Node<'_, '_>) -> u32 {
        let start = node.range().start;
        let block = start / LINE_BLOCK;
        let rest = &node.document().input_text().as_bytes()[block * LINE_BLOCK..start];
        1 + self.before.get(block).copied().unwrap_or(0) + break_count(rest)
    }
}

/// The line breaks in a piece of a text; texts have at most 64 MiB.
fn break_count(text: &[u8]) -> u32 {
    text.iter().map(|byte| u32::from(*byte == b'\n')).sum()
}

/// Refuses elements that are nested deeper than is read, and those with more attributes. As long as the text is XML, the counts
/// are exact; what comes after a fault is not parsed.
fn check(text: &str, at: &FileLocation) -> Result<(), HousesError> {
    let mut depth = 0_u64;
    let mut namespaces = 0;
    let mut from = 0;
    for piece in 0_u32.. {
        if piece % 1024 == 0 {
            interrupt::unwind_if_cancelled();
        }
        let Some(start) = text[from..].find('<').map(|at| from + at) else {
            break;
        };
        let rest = &text[start..];
        let skip = |end: &str| rest.find(end).map(|at| at + end.len());
        let length = if rest.starts_with("<!--") {
            skip("-->")
        } else if rest.starts_with("<![CDATA[") {
            skip("]]>")
        } else if rest.starts_with("<?") {
            skip("?>")
        } else if rest.starts_with("</") {
            depth = depth.saturating_sub(1);
            skip(">")
        } else {
            let tag = TagAttributeCounts::read(rest);
            if !rest[..tag.length.unwrap_or(0)].ends_with("/>") {
                depth += u64::from(tag.length.is_some());
            }
            namespaces += tag.namespaces;
            let counts = [
                ("depth of elements", depth, MAX_XML_DEPTH as u64),
                ("count of attributes", tag.attributes, MAX_XML_ATTRIBUTES),
                ("count of namespaces", namespaces, MAX_XML_ATTRIBUTES),
            ];
            for (what, found, allowed) in counts {
                if found > allowed {
                    let line = 1 + text[..start].matches('\n').count();
                    return Err(HousesError::TooLarge {
                        at: at.line(u32::try_from(line).unwrap_or(u32::MAX)),
                        what,
                        found,
                        allowed,
                    });
                }
            }
            tag.length
        };
        // Without an end the text is no XML.
        let Some(length) = length else {
            break;
        };
        from = start + length;
    }
    Ok(())
}

/// The text between `<` and `>`; `>` in quotes ends nothing.
#[derive(Default)]
struct TagAttributeCounts {
    /// Its length in bytes; `None` for a tag without an end.
    length: Option<usize>,
    attributes: u64,
    /// Those of its attributes that declare a namespace.
    namespaces: u64,
}

impl TagAttributeCounts {
    fn read(text: &str) -> Self {
        let mut tag = Self::default();
        let mut quote = None;
        // Where the attribute's name may begin.
        let mut word = 0;
        for (k, byte) in text.bytes().enumerate() {
            match (quote, byte) {
                (None, b'>') => {
                    tag.length = Some(k + 1);
                    break;
                }
                (None, b'"' | b'\'') => quote = Some(byte),
                (None, b'=') => {
                    tag.attributes += 1;
                    tag.namespaces += u64::from(text.as_bytes()[word..].starts_with(b"xmlns"));
                }
                (None, b' ' | b'\t' | b'\r' | b'\n')
                    if text
                        .as_bytes()
                        .get(k + 1)
                        .is_some_and(u8::is_ascii_alphabetic) =>
                {
                    word = k + 1;
                }
                (Some(open), _) if open == byte => {
                    quote = None;
                    word = k + 1;
                }
                _ => {}
            }
        }
        tag
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told(text: &str) -> String {
        let at = FileLocation::file("a.xml");
        parse(text, &at).map(|_| ()).unwrap_err().to_string()
    }

    #[test]
    fn nesting_ends_at_the_cap_and_not_with_the_stack() {
        let nested = |depth: usize| format!("{}{}", "<a>\n".repeat(depth), "</a>".repeat(depth));
        assert!(parse(&nested(MAX_XML_DEPTH), &FileLocation::file("a.xml")).is_ok());
        let found = "a.xml:201: depth of elements 201 is more than the 200 that are read";
        assert_eq!(told(&nested(MAX_XML_DEPTH + 1)), found);
        assert_eq!(told(&"<a>\n".repeat(1_000_000)), found);
        // Brackets in quotes and comments are no tags, and those of empty elements nest nothing.
        let flat = "<a b='>' c=\"/>\"/><!-- <a> --><![CDATA[<a>]]><?a <a>?>".repeat(500);
        assert!(parse(&format!("<b>{flat}</b>"), &FileLocation::file("a.xml")).is_ok());
        let quoted = "<a b='/>'>".repeat(1000);
        assert_eq!(told(&quoted), found.replace(":201:", ":1:"));
    }

    #[test]
    fn nodes_begin_on_the_lines_that_the_parser_counts() {
        let mut text = "<a>".to_owned();
        for k in 0..900 {
            text += &"\n ".repeat(k % 7);
            text += "<b c='\n'/>";
        }
        text += "</a>";
        assert!(text.len() > 3 * LINE_BLOCK);
        let document = parse(&text, &FileLocation::file("a.xml")).unwrap();
        let lines = LineIndex::new(&document);
        for node in document.descendants() {
            let row = document.text_pos_at(node.range().start).row;
            assert_eq!(lines.line(node), row);
        }
    }

    #[test]
    fn attributes_and_namespaces_end_at_the_cap() {
        let of = |count: u64, name: &str| {
            let all: Vec<String> = (0..count).map(|k| format!("{name}{k}=\"=\"")).collect();
            format!("<b>\n<a {}/></b>", all.join(" "))
        };
        assert!(parse(&of(MAX_XML_ATTRIBUTES, "x"), &FileLocation::file("a.xml")).is_ok());
        let found = "a.xml:2: count of attributes 300000 is more than the 128 that are read";
        assert_eq!(told(&of(300_000, "x")), found);
        // Namespaces are those of the whole file.
        let some = of(100, "xmlns:n").replace("=\"=\"", "=\"n\"");
        assert!(
            parse(&some, &FileLocation::file("a.xml")).is_ok(),
            "{}",
            told(&some)
        );
        let twice = some.replace("</b>", &some[4..]);
        let found = "a.xml:2: count of namespaces 200 is more than the 128 that are read";
        assert_eq!(told(&twice), found);
    }

    #[test]
    fn a_document_type_is_refused() {
        let laughs = "<!DOCTYPE a [<!ENTITY b 'cc'>]><a>&b;</a>";
        assert!(
            told(laughs).starts_with("a.xml:1: XML with a DTD (<!DOCTYPE ...>); allowed is"),
            "{}",
            told(laughs)
        );
    }
}
