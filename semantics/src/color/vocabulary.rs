//! Words for colours.

use super::oklab::Oklab;
use crate::csv_table::CsvTable;
use crate::error::SemanticsError;
use serde::{Deserialize, Serialize};
use std::sync::OnceLock;

/// A list of colour words.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ColorVocabulary {
    /// Twelve words of everyday speech: black, white, gray, brown, beige, red, orange, yellow, green, blue, purple,
    /// pink. What text is made of.
    #[default]
    Plain,
    /// The 16 colours of HTML 4.
    Basic,
    /// The 148 named colours of CSS.
    Web,
    /// The 949 names of the xkcd colour survey.
    Xkcd,
}

/// Everyday words and the last words of survey names that count for them.
const HEADS: &[(&str, &[&str])] = &[
    ("gray", &["grey", "gray"]),
    ("brown", &["brown"]),
    (
        "beige",
        &["beige", "tan", "cream", "sand", "ivory", "khaki"],
    ),
    ("red", &["red", "maroon"]),
    ("orange", &["orange", "terracotta"]),
    ("yellow", &["yellow", "gold", "golden", "mustard", "ochre"]),
    ("green", &["green", "olive", "lime"]),
    (
        "blue",
        &[
            "blue",
            "navy",
            "teal",
            "turquoise",
            "cyan",
            "aqua",
            "bluegrey",
            "greyblue",
        ],
    ),
    (
        "purple",
        &["purple", "violet", "lavender", "lilac", "mauve", "indigo"],
    ),
    ("pink", &["pink", "magenta", "rose"]),
];

/// A named colour.
#[derive(Clone, Copy, Debug)]
struct NamedColor {
    name: &'static str,
    srgb: [u8; 3],
    lab: Oklab,
}

fn hex(text: &str) -> Option<[u8; 3]> {
    let digits = text.strip_prefix('#').filter(|digits| digits.len() == 6)?;
    let number = u32::from_str_radix(digits, 16).ok()?;
    let [_, r, g, b] = number.to_be_bytes();
    Some([r, g, b])
}

fn parse(file: &'static str, text: &'static str) -> Result<Vec<NamedColor>, SemanticsError> {
    let table = CsvTable::parse(file, text)?;
    let mut entries: Vec<NamedColor> = Vec::new();
    for row in table.rows() {
        let value = row.text("hex")?;
        let srgb =
            hex(value).ok_or_else(|| row.fault(format!("hex is {value:?}, allowed is #rrggbb")))?;
        let lab = Oklab::from_srgb(srgb.map(|c| f32::from(c) / 255.0));
        entries.push(NamedColor {
            name: row.text("name")?,
            srgb,
            lab,
        });
    }
    Ok(entries)
}

/// Parts of survey names that give a grey a hue.
const TINTS: [&str; 15] = [
    "blu", "green", "purpl", "pink", "red", "orang", "yellow", "brown", "tan", "teal", "violet",
    "rose", "rosy", "olive", "lavender",
];

/// Parts of survey names that make a brown half a yellow.
const GILT: [&str; 3] = ["yellow", "gold", "mustard"];

/// Chroma from which a colour has a hue, so that nobody calls it gray, and from which a pale yellow is no beige. Chosen by
/// looking: a slate-blue sofa has 0.039, a turquoise rug 0.049, concrete and steel up to 0.03; a yellow curtain has 0.121,
/// the survey's tan 0.093, light oak up to 0.09.
const HUED: f32 = 0.035;
const GILDED: f32 = 0.105;
/// Lightness from which a colour of such chroma is no brown either: brown is dark orange. Terracotta lacquer has 0.62, cherry
/// wood 0.54.
const LIT: f32 = 0.57;

/// "Very dark brown" counts for brown. Names of very light colours are left out: people call them after the tint, a room
/// calls them white or beige; and so are tinted greys and yellow browns, which lie between two words.
fn plain_from_survey(survey: &[NamedColor]) -> Vec<NamedColor> {
    let mut plain = Vec::new();
    for entry in survey {
        let last = entry.name.rsplit([' ', '/']).next().unwrap_or_default();
        let word = HEADS.iter().find(|(_, heads)| heads.contains(&last));
        let says = |tints: &[&str]| tints.iter().any(|tint| entry.name.contains(tint));
        let tinted = |word: &str| match word {
            "gray" => says(&TINTS),
            "brown" => says(&GILT),
            _ => false,
        };
        if let Some((name, _)) = word
            && !entry.name.starts_with("very light")
            && !tinted(name)
        {
            plain.push(NamedColor { name, ..*entry });
        }
    }
    plain
}

impl ColorVocabulary {
    /// The vocabulary with so many different colours: 12 plain ones, 16, 139 or 949.
    pub fn of_size(size: usize) -> Option<Self> {
        match size {
            12 => Some(Self::Plain),
            16 => Some(Self::Basic),
            139 => Some(Self::Web),
            949 => Some(Self::Xkcd),
            _ => None,
        }
    }

    /// All lists, from the shortest.
    pub const ALL: [Self; 4] = [Self::Plain, Self::Basic, Self::Web, Self::Xkcd];

    fn entries(self) -> &'static [NamedColor] {
        static TABLES: OnceLock<[Vec<NamedColor>; 4]> = OnceLock::new();
        let tables = TABLES.get_or_init(|| {
            let read = |file, text| {
                parse(file, text).expect("the colour tables are checked by this crate's tests")
            };
            let xkcd = read(
                "colors/xkcd.csv",
                include_str!("../../../assets/colors/xkcd.csv"),
            );
            [
                plain_from_survey(&xkcd),
                read(
                    "colors/basic.csv",
                    include_str!("../../../assets/colors/basic.csv"),
                ),
                read(
                    "colors/web.csv",
                    include_str!("../../../assets/colors/web.csv"),
                ),
                xkcd,
            ]
        });
        &tables[self as usize]
    }

    /// The number of colours in the list; for [`ColorVocabulary::Plain`] the number of survey colours it rests on.
    pub fn len(self) -> usize {
        self.entries().len()
    }

    /// Never: every list has colours.
    pub fn is_empty(self) -> bool {
        self.entries().is_empty()
    }

    /// The words, each once, in file order.
    pub fn words(self) -> Vec<&'static str> {
        let mut words: Vec<&'static str> = Vec::new();
        if self == Self::Plain {
            words.extend(["black", "white"]);
            words.extend(HEADS.iter().map(|(word, _)| *word));
        } else {
            words.extend(self.entries().iter().map(|entry| entry.name));
        }
        words
    }

    /// The sRGB value of a word, 0 to 255; `None` for a word outside the list, and for plain words, which name regions.
    pub fn srgb(self, word: &str) -> Option<[u8; 3]> {
        let found = self.entries().iter().find(|entry| entry.name == word);
        found
            .filter(|_| self != Self::Plain)
            .map(|entry| entry.srgb)
    }

    /// The word for a colour given in linear light, each 0 to 1.
    ///
    /// The nearest entry in `OKLab`, the first of equals. CIEDE2000 is a formula for small differences (it is no metric
    /// and jumps at opposite hues); names lie far apart, and `OKLab` is uniform there and cheap. Plain words: nearly
    /// grey colours are black, gray or white by lightness, the others take the word of the nearest survey colour that is not
    /// of an opposite hue; clear hues are never gray, clear yellows never beige, and
    /// clear light oranges never brown.
    pub fn word(self, linear: [f32; 3]) -> &'static str {
        let color = Oklab::from_linear(linear);
        if self == Self::Plain {
            if color.l < 0.32 && color.chroma() < 0.035 {
                return "black";
            }
            if color.l > 0.89 && color.chroma() < 0.03 {
                return "white";
            }
            if color.chroma() < 0.015 {
                return "gray";
            }
            // A pale colour lies near many others; the word at least keeps to its side of the circle of hues.
            let chroma = color.chroma();
            return nearest(self.entries(), |entry| {
                let (p, q) = (entry.lab, color);
                let excluded = match entry.name {
                    "gray" => chroma >= HUED,
                    "beige" if chroma >= GILDED => true,
                    "brown" if chroma >= GILDED && q.l >= LIT => true,
                    _ => p.a * q.a + p.b * q.b <= 0.0,
                };
                if excluded {
                    f32::INFINITY
                } else {
                    p.distance(q)
                }
            });
        }
        nearest(self.entries(), |entry| entry.lab.distance(color))
    }

    /// The word by Euclid's distance of the sRGB-encoded values, as older engines choose it; for comparisons.
    pub fn word_by_srgb_distance(self, srgb: [f32; 3]) -> &'static str {
        nearest(self.entries(), |entry| {
            let encoded = entry.srgb.map(|c| f32::from(c) / 255.0);
            encoded
                .iter()
                .zip(srgb)
                .map(|(p, q)| (p - q) * (p - q))
                .sum()
        })
    }
}

fn nearest(entries: &'static [NamedColor], distance: impl Fn(&NamedColor) -> f32) -> &'static str {
    let mut best = ("", f32::INFINITY);
    for entry in entries {
        let d = distance(entry);
        if d < best.1 {
            best = (entry.name, d);
        }
    }
    best.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_scene::units::linear_from_srgb;
    use std::collections::BTreeSet;

    fn linear(srgb: [u8; 3]) -> [f32; 3] {
        srgb.map(|c| linear_from_srgb(f32::from(c) / 255.0))
    }

    #[test]
    fn the_lists_have_the_published_lengths() {
        assert_eq!(ColorVocabulary::Basic.len(), 16);
        assert_eq!(ColorVocabulary::Web.len(), 148);
        assert_eq!(ColorVocabulary::Xkcd.len(), 949);
        assert_eq!(ColorVocabulary::Plain.words().len(), 12);
        for list in [
            ColorVocabulary::Basic,
            ColorVocabulary::Web,
            ColorVocabulary::Xkcd,
        ] {
            let unique: BTreeSet<_> = list.words().into_iter().collect();
            assert_eq!(unique.len(), list.len());
        }
    }

    #[test]
    fn every_named_colour_gets_a_name_of_its_own_value() {
        for list in [
            ColorVocabulary::Basic,
            ColorVocabulary::Web,
            ColorVocabulary::Xkcd,
        ] {
            for word in list.words() {
                let srgb = list.srgb(word).unwrap();
                let found = list.word(linear(srgb));
                assert_eq!(list.srgb(found), Some(srgb), "{word} is called {found}");
            }
        }
    }

    #[test]
    fn nearest_agrees_with_a_sorted_list() {
        for k in 0..200_u32 {
            let srgb = [k * 37 % 256, k * 101 % 256, k * 173 % 256].map(|c| c as u8);
            let color = Oklab::from_linear(linear(srgb));
            let mut sorted: Vec<_> = ColorVocabulary::Web
                .words()
                .into_iter()
                .map(|word| {
                    (
                        word,
                        Oklab::from_linear(linear(ColorVocabulary::Web.srgb(word).unwrap())),
                    )
                })
                .map(|(word, lab)| (lab.distance(color), word))
                .collect();
            sorted.sort_by(|p, q| p.0.total_cmp(&q.0));
            assert_eq!(ColorVocabulary::Web.word(linear(srgb)), sorted[0].1);
        }
    }

    /// Everyday colours get the words that the survey's people, or anybody, would say.
    #[test]
    fn everyday_things_get_everyday_words() {
        let cases: &[([u8; 3], &str)] = &[
            ([150, 111, 72], "brown"),
            ([94, 72, 56], "brown"),
            ([96, 62, 42], "brown"),
            ([216, 180, 127], "beige"),
            ([245, 240, 215], "beige"),
            ([255, 255, 255], "white"),
            ([240, 240, 238], "white"),
            ([128, 128, 128], "gray"),
            ([200, 200, 200], "gray"),
            ([20, 20, 22], "black"),
            ([48, 48, 52], "black"),
            ([30, 60, 140], "blue"),
            ([72, 110, 52], "green"),
            ([170, 20, 25], "red"),
            ([240, 220, 60], "yellow"),
            ([240, 130, 20], "orange"),
            // Fronts of a kitchen, a terracotta pot; cherry wood and a loaf stay brown.
            ([190, 112, 82], "orange"),
            ([186, 104, 76], "orange"),
            ([160, 82, 45], "brown"),
            ([178, 118, 62], "brown"),
            ([230, 150, 180], "pink"),
            ([110, 40, 140], "purple"),
            ([236, 228, 212], "white"),
            ([176, 206, 224], "blue"),
            ([206, 194, 172], "beige"),
            // Things of a home: sofa, rug, curtain, pillow.
            ([83, 102, 122], "blue"),
            ([122, 167, 173], "blue"),
            ([223, 192, 96], "yellow"),
            ([186, 138, 44], "yellow"),
            // What stays as it was: brushed steel, concrete, light oak, tan.
            ([140, 150, 160], "gray"),
            ([160, 160, 150], "gray"),
            ([197, 154, 104], "brown"),
            ([209, 178, 111], "beige"),
        ];
        for (srgb, word) in cases {
            assert_eq!(
                ColorVocabulary::Plain.word(linear(*srgb)),
                *word,
                "{srgb:?}"
            );
        }
    }

    #[test]
    fn plain_words_agree_with_the_survey_names_they_come_from() {
        let mut agree = 0;
        let entries = ColorVocabulary::Plain.entries();
        for entry in entries {
            agree += usize::from(ColorVocabulary::Plain.word(linear(entry.srgb)) == entry.name);
        }
        // The rest are greys with a tint that the rule for neutral colours takes.
        assert!(
            agree * 100 >= entries.len() * 96,
            "{agree} of {}",
            entries.len()
        );
    }
}
