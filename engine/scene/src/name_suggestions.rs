//! Suggestions for unknown names.

/// Letters of a name that are compared; longer ones are cut.
const COMPARED: usize = 64;

/// Of the `known` names those nearest to `name`, at most `count`, each once: those with all of its words (`floor_lamp_2` for `lamp`
/// or `lamp_1`: numbers are no words), then by the letters that differ, then by the alphabet.
pub fn nearest_names<'a>(
    name: &str,
    known: impl Iterator<Item = &'a str>,
    count: usize,
) -> Vec<&'a str> {
    let wanted: Vec<&str> = words(name).collect();
    let has_words = |other: &str| {
        !wanted.is_empty()
            && wanted
                .iter()
                .all(|word| words(other).any(|own| own == *word))
    };
    let mut ranked: Vec<(bool, usize, &str)> = known
        .map(|other| (!has_words(other), distance(name, other), other))
        .collect();
    ranked.sort_unstable();
    ranked.dedup();
    ranked
        .into_iter()
        .take(count)
        .map(|(.., name)| name)
        .collect()
}

/// The words of a name, without its numbers.
fn words(name: &str) -> impl Iterator<Item = &str> {
    name.split(['_', ' '])
        .filter(|word| word.chars().any(|letter| !letter.is_ascii_digit()))
}

/// Returns whether at most `letters` letters differ between two names, upper case or not, and more than those are the same.
pub fn is_within_edit_distance(name: &str, known: &str, letters: usize) -> bool {
    known.chars().count() > 2 * letters && distance(name, known) <= letters
}

/// Returns the edit distance of two names (V. I. Levenshtein, 1966).
fn distance(a: &str, b: &str) -> usize {
    let letters = |text: &str| -> Vec<char> {
        let lower = text.chars().flat_map(char::to_lowercase);
        lower.take(COMPARED).collect()
    };
    let (a, b) = (letters(a), letters(b));
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.iter().enumerate() {
        let mut corner = row[0];
        row[0] = i + 1;
        for (j, y) in b.iter().enumerate() {
            let kept = corner + usize::from(x != y);
            corner = row[j + 1];
            row[j + 1] = kept.min(corner + 1).min(row[j] + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_letters_apart_is_near() {
        let known = ["sofa_1", "table_1", "stable", "lamp", "table_1"];
        let kinds = ["tablet", "cake", "dining_table", "safe"];
        assert_eq!(
            nearest_names("table", kinds.into_iter(), 1),
            ["dining_table"]
        );
        let things = ["book_1", "rug_1", "single_bed_1", "bed_frame"];
        assert_eq!(
            nearest_names("bed_2", things.into_iter(), 2),
            ["bed_frame", "single_bed_1"]
        );
        let near = nearest_names("tabel_1", known.into_iter(), 2);
        assert_eq!(near, ["table_1", "stable"]);
        assert_eq!((distance("kitten", "Sitting"), distance("", "abc")), (3, 3));
    }
}
