//! The everyday word for a colour, by the shares of answers.

use super::cielab::cielab_from_linear;
use crate::csv_table::CsvTable;
use crate::error::SemanticsError;
use dwell_scene::math;
use glam::Vec3;
use std::sync::OnceLock;

/// The words. The eleven basic colour terms of English, and beige.
///
/// # Source
/// B. Berlin and P. Kay, *Basic Color Terms*, University of California Press 1969.
pub(super) const WORDS: [&str; 12] = [
    "black", "white", "gray", "brown", "beige", "red", "orange", "yellow", "green", "blue",
    "purple", "pink",
];

/// A number for each of [`WORDS`].
type Shares = [f32; WORDS.len()];

/// Edge of the survey's cells in CIELAB.
const CELL: f32 = 10.0;
/// Extents of the survey's grid, in cells, and the cell of its first corner.
const SIZE: [usize; 3] = [12, 22, 24];
const FIRST: [i32; 3] = [0, -10, -12];
/// Distance in CIELAB over which the names of things count: the standard deviation of a Gaussian.
const REACH: f32 = 4.0;
/// The number of names of things at a colour that count as much as the survey.
const SURVEY_NAMES: f32 = 2.0;

/// What colours are called: patches on screens by the people of a survey, things in rooms by readers (`assets/colors/README.md`).
struct ColorNamingModel {
    /// The shares of the survey's answers by corner of a cell.
    survey: Vec<Shares>,
    /// Colours of things in CIELAB, and how often each word was given.
    things: Vec<(Vec3, Shares)>,
}

impl ColorNamingModel {
    fn parse(survey: &str, things: &str) -> Result<Self, SemanticsError> {
        let mut naming = Self {
            survey: vec![[0.0; WORDS.len()]; SIZE.iter().product()],
            things: Vec::new(),
        };
        let table = CsvTable::parse("colors/naming_survey.csv", survey)?;
        for row in table.rows() {
            let at = [row.number("l")?, row.number("a")?, row.number("b")?];
            let place = corner(at.map(|x: i32| x / CELL as i32))
                .ok_or_else(|| row.error(format!("{at:?} is outside of the grid")))?;
            for (share, word) in naming.survey[place].iter_mut().zip(WORDS) {
                *share = f32::from(row.number::<u16>(word)?) / 1000.0;
            }
        }
        let table = CsvTable::parse("colors/naming_things.csv", things)?;
        for row in table.rows() {
            let lab = Vec3::new(row.number("l")?, row.number("a")?, row.number("b")?);
            let mut counts = [0.0; WORDS.len()];
            for (count, word) in counts.iter_mut().zip(WORDS) {
                *count = row.number(word)?;
            }
            naming.things.push((lab, counts));
        }
        Ok(naming)
    }

    fn shared() -> &'static Self {
        static NAMING: OnceLock<ColorNamingModel> = OnceLock::new();
        NAMING.get_or_init(|| {
            let survey = include_str!("../../../assets/colors/naming_survey.csv");
            let things = include_str!("../../../assets/colors/naming_things.csv");
            Self::parse(survey, things).expect("the tables are checked by this crate's tests")
        })
    }

    /// The shares of the survey's answers for a colour, linear between the corners of its cell.
    fn survey_shares(&self, lab: Vec3) -> Shares {
        let scaled = lab / CELL;
        let (low, inside) = (scaled.floor(), scaled - scaled.floor());
        let mut shares = [0.0; WORDS.len()];
        for k in 0..8_usize {
            let step = Vec3::from_array(std::array::from_fn(|axis| (k >> axis & 1) as f32));
            let along = step * inside + (Vec3::ONE - step) * (Vec3::ONE - inside);
            let Some(place) = corner((low + step).to_array().map(|x| x as i32)) else {
                continue;
            };
            for (share, own) in shares.iter_mut().zip(self.survey[place]) {
                *share += along.element_product() * own;
            }
        }
        shares
    }

    /// The shares of answers that give each word: a mean of the survey and of the names of things nearby (Nadaraya-Watson).
    fn shares(&self, lab: Vec3) -> Shares {
        let mut sums = self.survey_shares(lab).map(|share| SURVEY_NAMES * share);
        for (at, counts) in &self.things {
            let distance = lab.distance_squared(*at) / (REACH * REACH);
            if distance < 16.0 {
                let weight = math::exp(-0.5 * distance);
                for (sum, count) in sums.iter_mut().zip(counts) {
                    *sum += weight * count;
                }
            }
        }
        let whole: f32 = sums.iter().sum();
        sums.map(|sum| sum / whole)
    }
}

/// The place of a corner of cells in the grid.
fn corner(at: [i32; 3]) -> Option<usize> {
    let mut place = 0;
    for axis in 0..3 {
        let along = usize::try_from(at[axis] - FIRST[axis]).ok();
        place = place * SIZE[axis] + along.filter(|k| *k < SIZE[axis])?;
    }
    Some(place)
}

/// Everyday English words for the colours between two of [`WORDS`].
const BETWEEN: [(&str, [&str; 2]); 29] = [
    ("cream", ["white", "beige"]),
    ("light gray", ["white", "gray"]),
    ("dark gray", ["black", "gray"]),
    ("dark brown", ["black", "brown"]),
    ("dark green", ["black", "green"]),
    ("navy", ["black", "blue"]),
    ("dark purple", ["black", "purple"]),
    ("dark red", ["black", "red"]),
    ("tan", ["beige", "brown"]),
    ("taupe", ["brown", "gray"]),
    ("gray-beige", ["beige", "gray"]),
    ("terracotta", ["brown", "orange"]),
    ("red-orange", ["orange", "red"]),
    ("maroon", ["brown", "red"]),
    ("ochre", ["brown", "yellow"]),
    ("coral", ["orange", "pink"]),
    ("mauve", ["pink", "purple"]),
    ("pale pink", ["pink", "white"]),
    ("salmon", ["beige", "pink"]),
    ("peach", ["beige", "orange"]),
    ("amber", ["orange", "yellow"]),
    ("pale yellow", ["white", "yellow"]),
    ("yellow-green", ["green", "yellow"]),
    ("teal", ["blue", "green"]),
    ("blue-gray", ["blue", "gray"]),
    ("sage", ["gray", "green"]),
    ("pale blue", ["blue", "white"]),
    ("pale green", ["green", "white"]),
    ("violet", ["blue", "purple"]),
];

/// The share of the second word, by that of the first, from which a colour has a word of its own between the two.
///
/// Of 592 things of 29 houses, named by a table without their house: below it the first word is that of most readers for 94.3 %; above
/// it, for a quarter of them, one of the two is for 96.1 %, the first for 60 %.
const DIVIDED: f32 = 0.4;
/// The same between blue and green: readers of descriptions who may use any word call what is above it teal (7 of 7 things of two houses between
/// 0.25 and 0.32 that were told as blue).
const DIVIDED_TEAL: f32 = 0.2;

/// Reads the survey and the names of things ahead of the first colour that is named, which would wait for them.
pub(crate) fn read_tables() {
    ColorNamingModel::shared();
}

/// The places in [`WORDS`] of the words that most and next most answers give to a colour in linear light, each component 0 to 1, of a
/// surface under white light, and the share of the second by that of the first.
///
/// # Source
/// The survey: R. Munroe, *Color Survey Results*, xkcd 2010, as counted by cells of
/// CIELAB in J. Heer and M. Stone, *Color Naming Models for Color Selection, Image Editing and Palette Design*, CHI 2012.
fn most_common(linear: [f32; 3]) -> ([&'static str; 2], f32) {
    let shares = ColorNamingModel::shared().shares(cielab_from_linear(linear));
    let mut order: [usize; WORDS.len()] = std::array::from_fn(|k| k);
    order.sort_by(|p, q| shares[*q].total_cmp(&shares[*p]).then(p.cmp(q)));
    let [first, second, ..] = order;
    (
        [WORDS[first], WORDS[second]],
        shares[second] / shares[first],
    )
}

/// The word of [`WORDS`] that most answers give to a colour in linear light, each component 0 to 1, of a surface under white light.
pub(super) fn basic_word(linear: [f32; 3]) -> &'static str {
    most_common(linear).0[0]
}

/// The word that a speaker gives to a colour: that of most answers, or where answers are divided the word between the two.
pub(super) fn spoken_word(linear: [f32; 3]) -> &'static str {
    let ([first, second], ratio) = most_common(linear);
    let is_between = |pair: &[&str; 2]| pair.contains(&first) && pair.contains(&second);
    let between = BETWEEN.iter().find(|(_, pair)| is_between(pair));
    between
        .filter(|(word, _)| {
            ratio
                >= if *word == "teal" {
                    DIVIDED_TEAL
                } else {
                    DIVIDED
                }
        })
        .map_or(first, |(word, _)| word)
}

/// Distance in CIELAB over which the names of walls and floors count: the standard deviation of a Gaussian.
const SURFACE_REACH: f32 = 2.5;
/// Number of names near a colour from which walls and floors are named by them.
const LEAST_NAMES: f32 = 0.5;

/// Names that readers gave to walls and floors: the colour in CIELAB, the word, and how often.
fn surface_names() -> &'static [(Vec3, &'static str, f32)] {
    static NAMES: OnceLock<Vec<(Vec3, &'static str, f32)>> = OnceLock::new();
    let parse = || -> Result<Vec<(Vec3, &'static str, f32)>, SemanticsError> {
        let text = include_str!("../../../assets/colors/naming_surfaces.csv");
        let table = CsvTable::parse("colors/naming_surfaces.csv", text)?;
        let words = spoken_words();
        let rows = table.rows().map(|row| {
            let lab = Vec3::new(row.number("l")?, row.number("a")?, row.number("b")?);
            let word = row.text("word")?;
            let word = words.iter().find(|known| **known == word);
            let word = word.ok_or_else(|| row.error("no word that is spoken".to_owned()))?;
            Ok((lab, *word, row.number("count")?))
        });
        rows.collect()
    };
    NAMES.get_or_init(|| parse().expect("the tables are checked by this crate's tests"))
}

/// The word that a speaker gives to the colour of a wall or a floor: a tint that nobody names on a vase shows on a wall. By the names of walls and
/// floors nearby, else as of things.
pub(super) fn surface_word(linear: [f32; 3]) -> &'static str {
    let lab = cielab_from_linear(linear);
    let mut sums: Vec<(&'static str, f32)> = Vec::new();
    for (at, word, count) in surface_names() {
        let distance = lab.distance_squared(*at) / (SURFACE_REACH * SURFACE_REACH);
        if distance > 9.0 {
            continue;
        }
        let weight = math::exp(-0.5 * distance) * count;
        match sums.iter_mut().find(|(known, _)| known == word) {
            Some((_, sum)) => *sum += weight,
            None => sums.push((word, weight)),
        }
    }
    let whole: f32 = sums.iter().map(|(_, sum)| sum).sum();
    let most = sums
        .into_iter()
        .max_by(|p, q| p.1.total_cmp(&q.1).then(q.0.cmp(p.0)));
    match most {
        Some((word, _)) if whole >= LEAST_NAMES => word,
        _ => spoken_word(linear),
    }
}

/// All words that speakers use: the basic ones, then those between two.
pub(super) fn spoken_words() -> Vec<&'static str> {
    let between = BETWEEN.iter().map(|(word, _)| *word);
    WORDS.into_iter().chain(between).collect()
}

/// Returns whether people divide on `word` for what is called `known`: one of them lies between the other and a third.
pub fn speakers_disagree(known: &str, word: &str) -> bool {
    let is_part = |between: &str, part: &str| {
        let mut found = BETWEEN.iter().filter(|(name, _)| *name == between);
        found.any(|(_, pair)| pair.contains(&part))
    };
    is_part(known, word) || is_part(word, known)
}
