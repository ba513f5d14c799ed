//! Spelling suggestions for unknown words.

use super::Grammar;

/// The edit distance of two words: insertions, deletions, substitutions, and swaps of adjacent letters.
///
/// # Source
/// F. J. Damerau, Communications of the ACM 7(3), 171 (1964), in the form of optimal string alignment.
fn distance(a: &str, b: &str) -> usize {
    let (a, b): (Vec<char>, Vec<char>) = (a.chars().collect(), b.chars().collect());
    let mut before: Vec<usize> = Vec::new();
    let mut last: Vec<usize> = (0..=b.len()).collect();
    for i in 1..=a.len() {
        let mut row = vec![i];
        for j in 1..=b.len() {
            let change = last[j - 1] + usize::from(a[i - 1] != b[j - 1]);
            let mut best = change.min(last[j] + 1).min(row[j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                best = best.min(before[j - 2] + 1);
            }
            row.push(best);
        }
        before = std::mem::replace(&mut last, row);
    }
    last[b.len()]
}

impl Grammar {
    /// The known words nearest to `word`, the nearest first; at most `most`, none that differs in more than a third of its letters. Of
    /// those equally near the ones that begin alike come first, and nouns and their like before words of rules.
    pub fn nearest_words(&self, word: &str, most: usize) -> Vec<String> {
        let length = word.chars().count();
        // Longer strings are not words.
        if length > 40 {
            return Vec::new();
        }
        let rules = self.productions.words.iter().map(|known| (true, known));
        let known = rules.chain(self.lexicon.entry_words().map(|known| (false, known)));
        let mut found: Vec<(usize, usize, bool, &str)> = known
            .filter(|(_, known)| known.chars().count().abs_diff(length) <= length.div_ceil(3))
            .map(|(of_rule, known)| {
                let pairs = word.chars().zip(known.chars());
                let alike = pairs.take_while(|(a, b)| a == b).count();
                (distance(word, known), usize::MAX - alike, of_rule, known)
            })
            .filter(|(distance, ..)| *distance <= length.div_ceil(3))
            .collect();
        found.sort_unstable();
        let mut words: Vec<String> = Vec::new();
        for (.., word) in found {
            if words.len() < most && !words.iter().any(|known| known == word) {
                words.push(word.to_owned());
            }
        }
        words
    }
}

#[cfg(test)]
mod tests {
    use super::distance;

    #[test]
    fn the_distance_counts_slips_of_the_hand() {
        let cases = [
            ("", "", 0),
            ("chair", "chair", 0),
            ("chiar", "chair", 1),
            ("char", "chair", 1),
            ("sofa", "soda", 1),
            ("ab", "", 2),
        ];
        for (a, b, expected) in cases {
            assert_eq!(
                (distance(a, b), distance(b, a)),
                (expected, expected),
                "{a} {b}"
            );
        }
    }
}
