//! Words for colours.

use super::naming;
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
    /// pink.
    Plain,
    /// The plain words, and words for the colours between two of them on which people divide: cream, teal, light gray. What text is
    /// made of.
    #[default]
    Spoken,
    /// The spoken words, as they are used of walls and floors: tints that nobody names on a vase show on a wall.
    Surface,
    /// The 16 colours of HTML 4.
    Basic,
    /// The 148 named colours of CSS.
    Web,
    /// The 949 names of the xkcd colour survey.
    Xkcd,
}

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
            hex(value).ok_or_else(|| row.error(format!("hex is {value:?}, allowed is #rrggbb")))?;
        let lab = Oklab::from_srgb(srgb.map(|c| f32::from(c) / 255.0));
        entries.push(NamedColor {
            name: row.text("name")?,
            srgb,
            lab,
        });
    }
    Ok(entries)
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
    pub const ALL: [Self; 6] = [
        Self::Plain,
        Self::Spoken,
        Self::Surface,
        Self::Basic,
        Self::Web,
        Self::Xkcd,
    ];

    /// The named colours; none for plain and spoken words, which name regions.
    fn entries(self) -> &'static [NamedColor] {
        static TABLES: OnceLock<[Vec<NamedColor>; 6]> = OnceLock::new();
        let tables = TABLES.get_or_init(|| {
            let read = |file, text| {
                parse(file, text).expect("the colour tables are checked by this crate's tests")
            };
            [
                Vec::new(),
                Vec::new(),
                Vec::new(),
                read(
                    "colors/basic.csv",
                    include_str!("../../../assets/colors/basic.csv"),
                ),
                read(
                    "colors/web.csv",
                    include_str!("../../../assets/colors/web.csv"),
                ),
                read(
                    "colors/xkcd.csv",
                    include_str!("../../../assets/colors/xkcd.csv"),
                ),
            ]
        });
        &tables[self as usize]
    }

    /// The words, each once, in file order.
    pub fn words(self) -> Vec<&'static str> {
        match self {
            Self::Plain => naming::WORDS.to_vec(),
            Self::Spoken | Self::Surface => naming::spoken_words(),
            _ => self.entries().iter().map(|entry| entry.name).collect(),
        }
    }

    /// The sRGB value of a word, 0 to 255; `None` for a word outside the list, and for plain and spoken words, which name regions.
    pub fn srgb(self, word: &str) -> Option<[u8; 3]> {
        let mut entries = self.entries().iter();
        let found = entries.find(|entry| entry.name == word);
        found.map(|entry| entry.srgb)
    }

    /// The word for a colour given in linear light, each 0 to 1.
    ///
    /// Plain words: the one that most answers give. Spoken words: the same, or where answers are divided a word between. Else the nearest entry in `OKLab`, the first of equals: CIEDE2000 is a
    /// formula for small differences (it is no metric and jumps at opposite hues), names lie far apart, and `OKLab` is uniform
    /// there and cheap.
    pub fn word(self, linear: [f32; 3]) -> &'static str {
        match self {
            Self::Plain => return naming::basic_word(linear),
            Self::Spoken => return naming::spoken_word(linear),
            Self::Surface => return naming::surface_word(linear),
            _ => {}
        }
        let color = Oklab::from_linear(linear);
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
        for (list, length) in ColorVocabulary::ALL
            .into_iter()
            .zip([12, 41, 41, 16, 148, 949])
        {
            let unique: BTreeSet<_> = list.words().into_iter().collect();
            assert_eq!((list.words().len(), unique.len()), (length, length));
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
            ([255, 255, 255], "white"),
            ([240, 240, 238], "white"),
            ([128, 128, 128], "gray"),
            ([20, 20, 22], "black"),
            ([48, 48, 52], "black"),
            ([30, 60, 140], "blue"),
            ([72, 110, 52], "green"),
            ([170, 20, 25], "red"),
            ([240, 220, 60], "yellow"),
            ([240, 130, 20], "orange"),
            // Fronts of a kitchen, a terracotta pot; a loaf stays brown.
            ([190, 112, 82], "orange"),
            ([186, 104, 76], "orange"),
            ([178, 118, 62], "brown"),
            ([230, 150, 180], "pink"),
            ([122, 167, 173], "blue"),
            ([110, 40, 140], "purple"),
            ([236, 228, 212], "white"),
            ([176, 206, 224], "blue"),
            ([206, 194, 172], "beige"),
            // Things of a home: sofa, rug, curtain, pillow.
            ([83, 102, 122], "blue"),
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
}
