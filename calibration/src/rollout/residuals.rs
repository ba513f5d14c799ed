//! Distributions of residuals: by regime and by speed, for several models beside each other.

use super::regime::ContactRegime;
use super::windows::WindowPrediction;
use serde::Serialize;

/// Groups by speed hold equally many windows.
const SPEEDS: usize = 5;
/// Windows below which a group is not shown.
const FEWEST: usize = 10;

/// The kind of residual.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ResidualKind {
    /// Distance, mm.
    Position,
    /// Angle, degrees.
    Rotation,
}

impl ResidualKind {
    fn residual(self, end: &WindowPrediction) -> f64 {
        match self {
            Self::Position => end.deviation.position_mm(),
            Self::Rotation => end.deviation.rotation_deg(),
        }
    }
}

/// Residuals in groups, as they are drawn.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ResidualGroups {
    /// The name of the picture's file, without its ending.
    pub name: String,
    /// The title of the picture.
    pub title: String,
    /// Unit of the residuals.
    pub unit: &'static str,
    /// The groups.
    pub groups: Vec<ResidualGroup>,
}

/// Residuals of one group of windows.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ResidualGroup {
    /// The common property of the windows.
    pub label: String,
    /// Number of windows.
    pub count: usize,
    /// For each model.
    pub models: Vec<Quantiles>,
}

/// The 5, 25, 50, 75 and 95 percent quantiles of the residuals.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Quantiles {
    /// The model.
    pub model: String,
    /// Rising.
    #[serde(rename = "at")]
    pub values: [f64; 5],
}

/// A model's name and its windows; the windows of all models are the same.
pub(crate) type ModelWindows<'a> = (&'a str, &'a [WindowPrediction]);

/// All pictures of the windows that look `horizon` samples ahead: position and rotation, by regime and by speed.
pub(crate) fn all(rows: &[ModelWindows<'_>], horizon: usize) -> Vec<ResidualGroups> {
    // Every model has the same windows in the same order.
    let ahead: Vec<(&str, Vec<&WindowPrediction>)> = rows
        .iter()
        .map(|(name, ends)| {
            (
                *name,
                ends.iter().filter(|end| end.horizon == horizon).collect(),
            )
        })
        .collect();
    let rows = &ahead[..];
    let mut found = Vec::new();
    let which = [
        (ResidualKind::Position, "position", "mm"),
        (ResidualKind::Rotation, "rotation", "degrees"),
    ];
    for (residual, word, unit) in which {
        let mut push = |by: &str, groups: Vec<ResidualGroup>| {
            if groups.len() > 1 {
                found.push(ResidualGroups {
                    name: format!("{word}-by-{by}"),
                    title: format!("error of {word} {horizon} samples ahead, by {by}"),
                    unit,
                    groups,
                });
            }
        };
        let regimes = ContactRegime::ALL.map(|regime| {
            let label = regime.name().to_owned();
            group(rows, residual, label, &|end| end.regime == regime)
        });
        push("regime", regimes.into_iter().flatten().collect());
        push("speed", by_speed(rows, residual));
    }
    found
}

fn by_speed(rows: &[(&str, Vec<&WindowPrediction>)], residual: ResidualKind) -> Vec<ResidualGroup> {
    let Some((_, ends)) = rows.first() else {
        return Vec::new();
    };
    let mut speeds: Vec<f64> = ends.iter().map(|end| end.speed_m_s).collect();
    if speeds.is_empty() {
        return Vec::new();
    }
    speeds.sort_by(f64::total_cmp);
    let edge = |k: usize| speeds[(k * (speeds.len() - 1)) / SPEEDS];
    let groups = (0..SPEEDS).map(|k| {
        let (low, high) = (edge(k), edge(k + 1));
        let inside = |end: &WindowPrediction| {
            (low..high).contains(&end.speed_m_s) || (k + 1 == SPEEDS && end.speed_m_s >= low)
        };
        let label = format!("{low:.2} to {high:.2} m/s");
        group(rows, residual, label, &inside)
    });
    groups.flatten().collect()
}

/// Quantiles of the windows that belong to the group and that diverge in no model.
fn group(
    rows: &[(&str, Vec<&WindowPrediction>)],
    residual: ResidualKind,
    label: String,
    belongs: &dyn Fn(&WindowPrediction) -> bool,
) -> Option<ResidualGroup> {
    let (_, first) = rows.first()?;
    let chosen: Vec<usize> = (0..first.len())
        .filter(|k| belongs(first[*k]))
        .filter(|k| rows.iter().all(|(_, ends)| !ends[*k].diverges))
        .collect();
    (chosen.len() >= FEWEST).then(|| ResidualGroup {
        label,
        count: chosen.len(),
        models: rows
            .iter()
            .map(|(model, ends)| {
                let mut sizes: Vec<f64> =
                    chosen.iter().map(|k| residual.residual(ends[*k])).collect();
                sizes.sort_by(f64::total_cmp);
                let last = (sizes.len() - 1) as f64;
                let at = [0.05, 0.25, 0.5, 0.75, 0.95]
                    .map(|share| sizes[(share * last).round() as usize]);
                Quantiles {
                    model: (*model).to_owned(),
                    values: at,
                }
            })
            .collect(),
    })
}
