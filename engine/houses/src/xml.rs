//! XML text into a document, bounded: the parser calls itself for every nested element, and takes memory for every node.

use roxmltree::{Document, ParsingOptions};

use crate::error::HousesError;
use crate::limits::{MAX_XML_DEPTH, MAX_XML_ELEMENTS};
use crate::report::At;

/// Parses a text.
///
/// # Errors
/// [`HousesError::TooLarge`] for elements nested too deep, [`HousesError::Syntax`] with the line for what is no XML, or has a
/// document type, or too many nodes.
pub(crate) fn parse<'a>(text: &'a str, at: &At) -> Result<Document<'a>, HousesError> {
    if let Some(start) = too_deep(text) {
        let line = text.as_bytes()[..start]
            .split(|byte| *byte == b'\n')
            .count();
        return Err(HousesError::TooLarge {
            at: at.line(u32::try_from(line).unwrap_or(u32::MAX)),
            what: "depth of elements",
            found: MAX_XML_DEPTH as u64 + 1,
            allowed: MAX_XML_DEPTH as u64,
        });
    }
    let options = ParsingOptions {
        // Elements, and the white space around them.
        nodes_limit: 4 * MAX_XML_ELEMENTS as u32,
        ..ParsingOptions::default()
    };
    Document::parse_with_options(text, options).map_err(|error| HousesError::Syntax {
        at: at.line(error.pos().row),
        message: error.to_string(),
    })
}

/// Where the first element begins that is nested deeper than is read. As long as the text is XML, the count is exact; what
/// comes after a fault is not parsed.
fn too_deep(text: &str) -> Option<usize> {
    let mut depth = 0_usize;
    let mut from = 0;
    while let Some(start) = text[from..].find('<').map(|at| from + at) {
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
            let tag = tag(rest);
            if tag.is_some_and(|length| !rest[..length].ends_with("/>")) {
                depth += 1;
            }
            tag
        };
        if depth > MAX_XML_DEPTH {
            return Some(start);
        }
        // Without an end the text is no XML.
        from = start + length?;
    }
    None
}

/// Bytes up to the end of a tag; `>` in quotes ends none.
fn tag(text: &str) -> Option<usize> {
    let mut quote = None;
    for (k, byte) in text.bytes().enumerate() {
        match (quote, byte) {
            (None, b'>') => return Some(k + 1),
            (None, b'"' | b'\'') => quote = Some(byte),
            (Some(open), _) if open == byte => quote = None,
            _ => {}
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told(text: &str) -> String {
        let at = At::file("a.xml");
        parse(text, &at).map(|_| ()).unwrap_err().to_string()
    }

    #[test]
    fn nesting_ends_at_the_cap_and_not_with_the_stack() {
        let nested = |depth: usize| format!("{}{}", "<a>\n".repeat(depth), "</a>".repeat(depth));
        assert!(parse(&nested(MAX_XML_DEPTH), &At::file("a.xml")).is_ok());
        let found = "a.xml:201: depth of elements 201 is more than the 200 that are read";
        assert_eq!(told(&nested(MAX_XML_DEPTH + 1)), found);
        assert_eq!(told(&"<a>\n".repeat(1_000_000)), found);
        // Brackets in quotes and comments are no tags, and those of empty elements nest nothing.
        let flat = "<a b='>' c=\"/>\"/><!-- <a> --><![CDATA[<a>]]><?a <a>?>".repeat(500);
        assert!(parse(&format!("<b>{flat}</b>"), &At::file("a.xml")).is_ok());
        let quoted = "<a b='/>'>".repeat(1000);
        assert_eq!(told(&quoted), found.replace(":201:", ":1:"));
    }

    #[test]
    fn a_document_type_is_refused() {
        let laughs = "<!DOCTYPE a [<!ENTITY b 'cc'>]><a>&b;</a>";
        assert!(
            told(laughs).starts_with("a.xml:1: XML with DTD detected"),
            "{}",
            told(laughs)
        );
    }
}
