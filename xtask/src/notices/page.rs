//! One page: every work with the numbers of its texts, then each text once.

use std::fmt::Write;

/// A work that is inside.
#[derive(Debug)]
pub(crate) struct IncludedWork {
    /// Name and version, or what it is called.
    pub title: String,
    /// SPDX expression.
    pub licence: String,
    /// Its origin and authors; empty if nobody says.
    pub origin: String,
    /// Its texts, in full.
    pub texts: Vec<String>,
}

const HEAD: &str = "\
Works of others in dwell's extension

Each line names a work, its licence, where it comes from, and in brackets the numbers of its texts, which follow the
list. A text that several works share stands once. Where a licence offers a choice, any one of those offered holds.
";

/// The page as a text file.
pub(crate) fn page(works: &[IncludedWork]) -> String {
    let mut texts: Vec<(String, &str)> = Vec::new();
    let mut page = format!("{HEAD}\n");
    for work in works {
        let mut numbers: Vec<usize> = work
            .texts
            .iter()
            .map(|text| number(&mut texts, text))
            .collect();
        numbers.sort_unstable();
        numbers.dedup();
        let numbers: Vec<String> = numbers.iter().map(ToString::to_string).collect();
        let _ = writeln!(
            page,
            "{} | {} | {} [{}]",
            work.title,
            work.licence,
            work.origin,
            numbers.join(", ")
        );
    }
    for (at, (_, text)) in texts.iter().enumerate() {
        let _ = writeln!(page, "\n{}\n[{}]\n", "=".repeat(80), at + 1);
        for line in text.trim().lines() {
            let _ = writeln!(page, "{}", line.trim_end());
        }
    }
    page
}

/// The number of a text, from 1; the same text with other line breaks or indents has the same number.
fn number<'a>(texts: &mut Vec<(String, &'a str)>, text: &'a str) -> usize {
    let words: Vec<&str> = text.split_whitespace().collect();
    let key = words.join(" ");
    if let Some(at) = texts.iter().position(|(other, _)| *other == key) {
        return at + 1;
    }
    texts.push((key, text));
    texts.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn work(title: &str, texts: &[&str]) -> IncludedWork {
        IncludedWork {
            title: title.to_owned(),
            licence: "MIT".to_owned(),
            origin: "host".to_owned(),
            texts: texts.iter().map(|&text| text.to_owned()).collect(),
        }
    }

    #[test]
    fn a_shared_text_stands_once() {
        let page = page(&[
            work("a 1", &["You may\r\n  do it."]),
            work("b 2", &["Mine too.", "You may do it.\n"]),
        ]);
        assert!(page.contains("a 1 | MIT | host [1]\nb 2 | MIT | host [1, 2]\n"));
        assert_eq!(page.matches("do it.").count(), 1);
        assert!(page.ends_with("[2]\n\nMine too.\n"));
    }
}
