//! English: articles, counts, lists.

/// `"a"` or `"an"` before `phrase`, by sound.
pub fn article(phrase: &str) -> &'static str {
    let word = phrase.split([' ', '-']).next().unwrap_or_default();
    let lower = word.to_lowercase();
    // Letters spoken one by one take the sound of the first letter's name: a TV, an ATM.
    if word.len() > 1 && word.chars().all(|c| c.is_ascii_uppercase()) {
        return if "AEFHILMNORSX".contains(&word[..1]) {
            "an"
        } else {
            "a"
        };
    }
    let silent_h = ["hour", "honest", "heir", "honour"]
        .iter()
        .any(|start| lower.starts_with(start));
    let spoken_consonant = ["uni", "use", "usu", "ute", "uti", "eu", "one", "once"]
        .iter()
        .any(|start| lower.starts_with(start));
    match lower.chars().next() {
        Some('a' | 'e' | 'i' | 'o' | 'u') if !spoken_consonant => "an",
        _ if silent_h => "an",
        _ => "a",
    }
}

/// `phrase` with its indefinite article.
pub fn with_article(phrase: &str) -> String {
    format!("{} {phrase}", article(phrase))
}

/// A count as a word up to twelve, then as digits.
pub fn count(number: usize) -> String {
    const WORDS: [&str; 13] = [
        "no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten",
        "eleven", "twelve",
    ];
    WORDS
        .get(number)
        .map_or_else(|| number.to_string(), |word| (*word).to_owned())
}

/// "first", "second", ... up to twelfth; then digits with an ending. Counts from 1.
pub fn ordinal(number: usize) -> String {
    const WORDS: [&str; 13] = [
        "zeroth", "first", "second", "third", "fourth", "fifth", "sixth", "seventh", "eighth",
        "ninth", "tenth", "eleventh", "twelfth",
    ];
    let ending = match (number % 10, number % 100) {
        (_, 11..=13) => "th",
        (1, _) => "st",
        (2, _) => "nd",
        (3, _) => "rd",
        _ => "th",
    };
    WORDS
        .get(number)
        .map_or_else(|| format!("{number}{ending}"), |word| (*word).to_owned())
}

/// "a chair", "two chairs"; `adjectives` go between and may be empty.
pub fn counted(number: usize, adjectives: &str, singular: &str, plural: &str) -> String {
    let join = |noun: &str| {
        if adjectives.is_empty() {
            noun.to_owned()
        } else {
            format!("{adjectives} {noun}")
        }
    };
    if number == 1 {
        with_article(&join(singular))
    } else {
        format!("{} {}", count(number), join(plural))
    }
}

/// "a", "a and b", "a, b and c".
pub fn list<S: AsRef<str>>(items: &[S]) -> String {
    match items {
        [] => String::new(),
        [one] => one.as_ref().to_owned(),
        [first @ .., last] => {
            let first: Vec<&str> = first.iter().map(AsRef::as_ref).collect();
            format!("{} and {}", first.join(", "), last.as_ref())
        }
    }
}

/// "is" or "are".
pub fn be(number: usize) -> &'static str {
    if number == 1 { "is" } else { "are" }
}

/// The text with its first letter in upper case.
pub fn capitalized(text: &str) -> String {
    let mut chars = text.chars();
    chars.next().map_or_else(String::new, |first| {
        first.to_uppercase().chain(chars).collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn articles_follow_the_sound() {
        let cases = [
            ("chair", "a"),
            ("orange chair", "an"),
            ("umbrella", "an"),
            ("upholstered sofa", "an"),
            ("unit", "a"),
            ("hour glass", "an"),
            ("TV stand", "a"),
            ("ATM", "an"),
            ("one-seater", "a"),
            ("electric piano", "an"),
            ("used cup", "a"),
            ("WC", "a"),
            ("iron", "an"),
            ("house", "a"),
        ];
        for (phrase, expected) in cases {
            assert_eq!(article(phrase), expected, "{phrase}");
        }
    }

    #[test]
    fn lists_and_counts_read_aloud() {
        assert_eq!(list(&["a bed"]), "a bed");
        assert_eq!(
            list(&["a bed", "two lamps", "a desk"]),
            "a bed, two lamps and a desk"
        );
        assert_eq!(list::<&str>(&[]), "");
        assert_eq!(counted(1, "oak", "table", "tables"), "an oak table");
        assert_eq!(counted(3, "", "shelf", "shelves"), "three shelves");
        assert_eq!(counted(13, "", "chair", "chairs"), "13 chairs");
        assert_eq!(
            (ordinal(2), ordinal(21), ordinal(113)),
            ("second".into(), "21st".into(), "113th".into())
        );
        assert_eq!(capitalized("a bed"), "A bed");
    }
}
