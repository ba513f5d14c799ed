//! Errors of JSON in plain words.

/// Returns the message of a JSON reader in plain words and without the position in a text that nobody wrote.
pub fn plain_json_error(error: &serde_json::Error) -> String {
    let text = dwell_houses::plain_parse_error(error);
    let text = text.split(" at line ").next().unwrap_or_default();
    let Some((found, expected)) = text
        .strip_prefix("invalid type: ")
        .or_else(|| text.strip_prefix("invalid value: "))
        .and_then(|rest| rest.split_once(", expected "))
    else {
        return text.to_owned();
    };
    format!("found {found}, expected {expected}")
}
