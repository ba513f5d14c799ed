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
                .ok_or_else(|| row.fault(format!("{at:?} is outside of the grid")))?;
            for (share, word) in naming.survey[place].iter_mut().zip(WORDS) {
                *share = row.number::<f32>(word)? / 1000.0;
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

/// The word that most answers give to a colour in linear light, each component 0 to 1, of a surface under white light.
///
/// # Source
/// The survey: R. Munroe, *Color Survey Results*, xkcd 2010, as counted by cells of
/// CIELAB in J. Heer and M. Stone, *Color Naming Models for Color Selection, Image Editing and Palette Design*, CHI 2012.
pub(super) fn common_word(linear: [f32; 3]) -> &'static str {
    let shares = ColorNamingModel::shared().shares(cielab_from_linear(linear));
    let most = (0..WORDS.len()).max_by(|p, q| shares[*p].total_cmp(&shares[*q]).then(q.cmp(p)));
    most.map_or(WORDS[0], |k| WORDS[k])
}
