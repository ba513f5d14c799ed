//! Lines, words and numbers of OBJ and MTL text, as bytes: these files are large and nearly all numbers.

/// The lines of `text` with their 1-based numbers, trimmed, comments and empty lines left out.
///
/// A `\` at the end of a line joins it with the next one. Lines end as in files of any system: by `\n`, `\r\n`, or `\r` alone.
pub(super) fn lines(text: &[u8]) -> impl Iterator<Item = (u32, std::borrow::Cow<'_, [u8]>)> {
    let text = crate::json::without_byte_order_mark(text);
    let end = if text.contains(&b'\n') { b'\n' } else { b'\r' };
    let mut raw = text.split(move |&b| b == end).zip(1_u32..);
    std::iter::from_fn(move || {
        loop {
            let (line, number) = raw.next()?;
            if number % 4096 == 0 {
                dwell_scene::interrupt::unwind_if_cancelled();
            }
            let mut line = std::borrow::Cow::Borrowed(line.trim_ascii());
            while line.last() == Some(&b'\\') {
                let joined = line.to_mut();
                joined.pop();
                joined.push(b' ');
                let Some((next, _)) = raw.next() else { break };
                joined.extend_from_slice(next.trim_ascii());
            }
            if !line.is_empty() && line[0] != b'#' {
                return Some((number, line));
            }
        }
    })
}

/// Splits a line into its first word and the rest.
pub(super) fn split_word(line: &[u8]) -> (&[u8], &[u8]) {
    match line.iter().position(u8::is_ascii_whitespace) {
        Some(end) => (&line[..end], line[end..].trim_ascii_start()),
        None => (line, &[]),
    }
}

/// The words of a line.
pub(super) fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    line.split(u8::is_ascii_whitespace)
        .filter(|word| !word.is_empty())
}

/// A decimal number; `None` if the word is none or not finite (`nan`, `-1.#IND`, `1e99`).
pub(super) fn float(word: &[u8]) -> Option<f32> {
    let value: f32 = std::str::from_utf8(word).ok()?.parse().ok()?;
    value.is_finite().then_some(value)
}

/// A whole number.
pub(super) fn integer(word: &[u8]) -> Option<i64> {
    let (negative, digits) = match word.first()? {
        b'-' => (true, &word[1..]),
        b'+' => (false, &word[1..]),
        _ => (false, word),
    };
    if digits.is_empty() || digits.len() > 18 || !digits.iter().all(u8::is_ascii_digit) {
        return None;
    }
    let value = digits
        .iter()
        .fold(0_i64, |value, digit| value * 10 + i64::from(digit - b'0'));
    Some(if negative { -value } else { value })
}

/// The text of a name: trimmed, whatever bytes it holds.
pub(super) fn name(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes.trim_ascii()).into_owned()
}

/// The first 60 characters of a line, for a message.
pub(super) fn shorten(line: &[u8]) -> String {
    let text = String::from_utf8_lossy(line);
    if text.chars().count() > 60 {
        text.chars().take(59).chain(['…']).collect()
    } else {
        text.into_owned()
    }
}
