//! Parts of every report's page.

use super::html::STYLE;
use super::svg;
use std::fmt::Write as _;

pub(crate) use super::html::escape;

/// Colours of curves, in order.
pub(crate) const COLOURS: [&str; 4] = [
    "var(--soft)",
    "var(--before)",
    "var(--after)",
    "var(--good)",
];

/// The head of a page, up to and with its title and lead.
pub(crate) fn page_head(title: &str, lead: &str) -> String {
    let title = escape(title);
    format!(
        "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" \
         content=\"width=device-width,initial-scale=1\"><title>Calibration: {title}</title><style>{STYLE}</style></head><body>\
         <h1>{title}</h1><p class=\"soft\">{lead}</p>"
    )
}

/// The share of values below each value, a curve for each row, up to `most`.
pub(crate) fn cumulative_plot(
    title: &str,
    unit: &str,
    most: f64,
    rows: &[(String, Vec<f64>)],
) -> String {
    let curves: Vec<svg::Curve> = rows
        .iter()
        .zip(COLOURS.iter().cycle())
        .map(|((_, values), colour)| {
            let mut sorted = values.clone();
            sorted.sort_by(f64::total_cmp);
            let count = sorted.len().max(1) as f64;
            let steps = sorted.iter().enumerate();
            let points = steps
                .filter(|(_, value)| **value <= most)
                .map(|(k, value)| [*value, 100.0 * (k + 1) as f64 / count])
                .collect();
            svg::Curve { colour, points }
        })
        .collect();
    svg::curves(title, (unit, most), ("percent", 100.0), &curves)
}

/// Returns which colour is which.
pub(crate) fn legend<'a>(names: impl Iterator<Item = &'a str>) -> String {
    let mut out = String::from("<p class=\"soft key\">");
    for (name, colour) in names.zip(COLOURS.iter().cycle()) {
        let _ = write!(out, "<i style=\"background:{colour}\"></i>{}", escape(name));
    }
    out + "</p>"
}
