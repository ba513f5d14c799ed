//! Patterns of images: stripes, checks and others.

use super::Oklab;
use glam::Vec3;
use serde::{Deserialize, Serialize};

/// Number of bands into which an image is cut along each edge.
const BANDS: usize = 32;
/// Share of the differences of colour that bands explain in stripes and checks.
const EXPLAINED: f32 = 0.6;
/// Share that each direction of bands explains in checks, and at most one of them in stripes.
const ACROSS: f32 = 0.15;
/// The least number of times that bands change from one side of the mean colour to the other.
const CHANGES: usize = 3;

/// How the colours of a surface lie on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SurfacePattern {
    /// In bands side by side.
    Striped,
    /// In bands that cross.
    Checked,
    /// In any other way.
    #[serde(rename = "patterned")]
    Other,
}

impl SurfacePattern {
    /// The name of its predicate.
    pub fn name(self) -> &'static str {
        match self {
            Self::Striped => "striped",
            Self::Checked => "checked",
            Self::Other => "patterned",
        }
    }
}

/// The pattern of shades at places in an image, each 0 to 1 along its edges.
///
/// The shares of the variance of colour that columns and rows explain: those of an analysis of variance in two ways without
/// interaction.
///
/// # Source
/// R. A. Fisher, *Statistical Methods for Research Workers*, 1925, chapters 7 and 8.
pub(super) fn pattern(shades: &[([f32; 2], Oklab)]) -> SurfacePattern {
    let whole = ShadeSums::of(shades.iter().map(|(_, shade)| shade));
    let total = whole.squares - whole.count_times_squared_mean();
    let explained = |axis: usize| {
        let mut bands = [ShadeSums::default(); BANDS];
        for (place, shade) in shades {
            let band = (place[axis] * BANDS as f32) as usize;
            bands[band.min(BANDS - 1)].add(shade);
        }
        let between: f32 = bands.iter().map(ShadeSums::count_times_squared_mean).sum();
        let share = (between - whole.count_times_squared_mean()) / total.max(f32::MIN_POSITIVE);
        // A disc is darker in its middle columns and rows, but does not alternate.
        if side_changes(&bands, &whole) >= CHANGES {
            share
        } else {
            0.0
        }
    };
    let (columns, rows) = (explained(0), explained(1));
    if columns + rows < EXPLAINED {
        SurfacePattern::Other
    } else if columns.min(rows) < ACROSS {
        SurfacePattern::Striped
    } else {
        SurfacePattern::Checked
    }
}

/// Returns how often neighbouring bands lie on different sides of the mean colour, along the line from it to the band farthest from it.
fn side_changes(bands: &[ShadeSums], whole: &ShadeSums) -> usize {
    let mean = whole.mean();
    let filled = bands.iter().filter(|band| band.count > 0.0);
    let apart: Vec<Vec3> = filled.map(|band| band.mean() - mean).collect();
    let lengths = apart
        .iter()
        .max_by(|p, q| p.length_squared().total_cmp(&q.length_squared()));
    let farthest = lengths.copied().unwrap_or(Vec3::ZERO);
    let sides: Vec<bool> = apart.iter().map(|d| d.dot(farthest) > 0.0).collect();
    sides.windows(2).filter(|pair| pair[0] != pair[1]).count()
}

/// Sums over shades.
#[derive(Clone, Copy, Default)]
struct ShadeSums {
    count: f32,
    shade: Vec3,
    squares: f32,
}

impl ShadeSums {
    fn of<'a>(shades: impl Iterator<Item = &'a Oklab>) -> Self {
        let mut sum = Self::default();
        for shade in shades {
            sum.add(shade);
        }
        sum
    }

    fn add(&mut self, shade: &Oklab) {
        self.count += 1.0;
        let shade = Vec3::new(shade.l, shade.a, shade.b);
        self.shade += shade;
        self.squares += shade.length_squared();
    }

    fn mean(&self) -> Vec3 {
        self.shade / self.count.max(1.0)
    }

    /// The square of the mean, as often as there are shades.
    fn count_times_squared_mean(&self) -> f32 {
        self.shade.length_squared() / self.count.max(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The pattern of an image of 32 by 32 places that are red where `is_red`, else white.
    fn found(is_red: impl Fn(usize, usize) -> bool) -> SurfacePattern {
        let shades: Vec<_> = (0..32 * 32)
            .map(|k| {
                let (x, y) = (k % 32, k / 32);
                let srgb = if is_red(x, y) {
                    [0.7, 0.1, 0.1]
                } else {
                    [0.95; 3]
                };
                ([x as f32 / 32.0, y as f32 / 32.0], Oklab::from_srgb(srgb))
            })
            .collect();
        pattern(&shades)
    }

    #[test]
    fn stripes_checks_and_dots_differ() {
        assert_eq!(found(|x, _| x / 4 % 2 == 0), SurfacePattern::Striped);
        assert_eq!(found(|_, y| y % 8 < 3), SurfacePattern::Striped);
        // Threads of both directions over each other, as in gingham.
        assert_eq!(
            found(|x, y| x / 4 % 2 == 0 || y / 4 % 2 == 0),
            SurfacePattern::Checked
        );
        // A chessboard and a disc have no bands.
        assert_eq!(
            found(|x, y| (x / 4 + y / 4) % 2 == 0),
            SurfacePattern::Other
        );
        let square = |x: usize| (x as i32 - 16).pow(2);
        assert_eq!(
            found(|x, y| square(x) + square(y) < 100),
            SurfacePattern::Other
        );
    }
}
