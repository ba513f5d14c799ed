//! English: articles, counts, plurals, adjectives before nouns, lists.

/// Nouns of pairs without a singular of their own: "a pair of scissors".
const PAIRS: [&str; 34] = [
    "binoculars",
    "boots",
    "clippers",
    "crutches",
    "earphones",
    "earrings",
    "glasses",
    "gloves",
    "goggles",
    "headphones",
    "jeans",
    "leggings",
    "mittens",
    "pajamas",
    "pants",
    "pincers",
    "pliers",
    "pyjamas",
    "sandals",
    "scissors",
    "shears",
    "shoes",
    "shorts",
    "skis",
    "slippers",
    "sneakers",
    "socks",
    "spectacles",
    "sunglasses",
    "tights",
    "tongs",
    "trainers",
    "trousers",
    "tweezers",
];
/// Nouns that end like a plural and are none.
const SINGULAR_IN_S: [&str; 5] = ["atlas", "canvas", "christmas", "gas", "lens"];
/// Nouns for groups and amounts of things: adjectives of colour and substance belong to the noun after "of".
pub(crate) const GATHERING_WORDS: [&str; 8] = [
    "bunch", "pair", "piece", "roll", "row", "set", "sheet", "stack",
];

/// The plural of a noun by its ending: "boxes", "knobs", "balconies".
pub fn plural(noun: &str) -> String {
    if let Some((head, rest)) = noun.split_once(" of ") {
        return format!("{} of {rest}", plural(head));
    }
    let stem = noun.strip_suffix('y').filter(|stem| {
        let before = stem.chars().last();
        before.is_some_and(|letter| !"aeiou".contains(letter))
    });
    let hissing = ["s", "x", "z", "ch", "sh"];
    match stem {
        Some(stem) => format!("{stem}ies"),
        None if hissing.iter().any(|end| noun.ends_with(end)) => format!("{noun}es"),
        None => format!("{noun}s"),
    }
}

/// One and several of the things that a name means. Names that are plural already take a counter: "pair of scissors",
/// "set of towels".
pub fn singular_and_plural(name: &str) -> (String, String) {
    let last = name.rsplit(' ').next().unwrap_or_default();
    let is_plural = last.len() > 3
        && last.ends_with('s')
        && !["ss", "us", "is"].iter().any(|end| last.ends_with(end))
        && !SINGULAR_IN_S.contains(&last);
    match name {
        _ if PAIRS.contains(&last) => (format!("pair of {name}"), format!("pairs of {name}")),
        _ if is_plural && !name.contains(" of ") => {
            (format!("set of {name}"), format!("sets of {name}"))
        }
        _ => (name.to_owned(), plural(name)),
    }
}

/// A noun with its adjectives: those of size before all, those of look before what they are seen on: "small brown chair",
/// "large stack of red books", "pair of small black shoes". Either may be empty.
pub fn with_adjectives(size: &str, look: &str, noun: &str) -> String {
    let row = |words: &[&str]| -> String {
        let words: Vec<&str> = words
            .iter()
            .copied()
            .filter(|word| !word.is_empty())
            .collect();
        words.join(" ")
    };
    let Some((head, rest)) = noun.split_once(" of ") else {
        return row(&[size, look, noun]);
    };
    let one = |known: &&&str| {
        head == **known
            || head.strip_suffix('s') == Some(**known)
            || head.strip_suffix("es") == Some(**known)
    };
    match GATHERING_WORDS.iter().find(one) {
        Some(&"pair") => row(&[head, "of", size, look, rest]),
        Some(_) => row(&[size, head, "of", look, rest]),
        None => row(&[size, look, noun]),
    }
}

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
pub fn cardinal(number: usize) -> String {
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
    WORDS
        .get(number)
        .map_or_else(|| ordinal_digits(number), |word| (*word).to_owned())
}

/// "1st", "2nd", "113th".
pub fn ordinal_digits(number: usize) -> String {
    let ending = match (number % 10, number % 100) {
        (_, 11..=13) => "th",
        (1, _) => "st",
        (2, _) => "nd",
        (3, _) => "rd",
        _ => "th",
    };
    format!("{number}{ending}")
}

/// "a chair", "two chairs".
pub fn counted(number: usize, singular: &str, plural: &str) -> String {
    if number == 1 {
        with_article(singular)
    } else {
        format!("{} {plural}", cardinal(number))
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
pub fn copula(number: usize) -> &'static str {
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
        assert_eq!(counted(1, "oak table", "oak tables"), "an oak table");
        assert_eq!(counted(3, "shelf", "shelves"), "three shelves");
        assert_eq!(counted(13, "chair", "chairs"), "13 chairs");
        assert_eq!(
            (ordinal(2), ordinal(21), ordinal(113)),
            ("second".into(), "21st".into(), "113th".into())
        );
        assert_eq!(capitalized("a bed"), "A bed");
    }

    #[test]
    fn plurals_follow_the_ending() {
        let cases = [
            ("knob", "knobs"),
            ("porch", "porches"),
            ("box", "boxes"),
            ("balcony", "balconies"),
            ("tray", "trays"),
            ("bus", "buses"),
        ];
        for (one, several) in cases {
            assert_eq!(plural(one), several);
        }
    }

    #[test]
    fn what_has_no_singular_is_counted_by_pairs_and_sets() {
        let cases = [
            ("scissors", "pair of scissors", "pairs of scissors"),
            (
                "running shoes",
                "pair of running shoes",
                "pairs of running shoes",
            ),
            ("towels", "set of towels", "sets of towels"),
            ("compass", "compass", "compasses"),
            ("lens", "lens", "lenses"),
            ("gadget", "gadget", "gadgets"),
            ("stack of coins", "stack of coins", "stacks of coins"),
        ];
        for (name, one, several) in cases {
            assert_eq!(
                singular_and_plural(name),
                (one.to_owned(), several.to_owned())
            );
        }
    }

    #[test]
    fn adjectives_stand_where_they_are_seen() {
        let cases = [
            (
                ("", "black leather", "pair of shoes"),
                "pair of black leather shoes",
            ),
            (
                ("small", "black", "pairs of shoes"),
                "pairs of small black shoes",
            ),
            (
                ("large", "red", "stack of books"),
                "large stack of red books",
            ),
            (
                ("", "green", "bunches of flowers"),
                "bunches of green flowers",
            ),
            (("", "green", "bottle of beer"), "green bottle of beer"),
            (("small", "brown", "chair"), "small brown chair"),
            (("", "", "pair of shoes"), "pair of shoes"),
        ];
        for ((size, look, noun), text) in cases {
            assert_eq!(with_adjectives(size, look, noun), text);
        }
    }
}
