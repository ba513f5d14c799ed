//! Boxes: how residuals of several models spread in several groups.

use super::residuals::ResidualGroups;
use crate::format_number::format_number;
use crate::report::page::{COLOURS, escape};
use crate::report::svg::{self, AxisScale};
use std::fmt::Write as _;

const LEFT: f64 = 56.0;
const TOP: f64 = 46.0;
/// The least width of a group: its label must fit.
const GROUP: f64 = 100.0;
const PLOT: f64 = 170.0;
const BOTTOM: f64 = 40.0;
/// Colours and letters of a picture that stands alone, light and dark.
const STYLE: &str = "svg{--soft:#5f6b76;--line:#d8dee4;--before:#c2591a;--after:#1f6fb2;--good:#1a7f4b;font:11px \
    system-ui,sans-serif}@media(prefers-color-scheme:dark){svg{--soft:#9aa5b0;--line:#363d45;--before:#f0955a;\
    --after:#6cb2ee;--good:#5fcf95}}text{fill:var(--soft)}.grid{stroke:var(--line)}";

/// The picture inside a page.
pub(crate) fn picture(residuals: &ResidualGroups) -> String {
    draw_boxes(residuals, "")
}

/// The picture as a file.
pub(crate) fn to_svg_file(residuals: &ResidualGroups) -> String {
    draw_boxes(residuals, &format!("<style>{STYLE}</style>"))
}

fn draw_boxes(residuals: &ResidualGroups, style: &str) -> String {
    let height = TOP + PLOT + BOTTOM;
    let full = svg::WIDTH.max(LEFT + GROUP * residuals.groups.len() as f64);
    let boxes = || residuals.groups.iter().flat_map(|group| &group.models);
    let most = boxes().map(|b| b.values[4]).fold(1e-9, f64::max);
    let y = AxisScale {
        low: 0.0,
        high: most,
        from: TOP + PLOT,
        to: TOP,
    };
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {full} {height}\" role=\"img\" aria-label=\"{}\">{style}",
        escape(&residuals.title)
    );
    for tick in y.ticks() {
        let at = y.to_pixels(tick);
        let _ = write!(
            out,
            "<line class=\"grid\" x1=\"{LEFT}\" y1=\"{at:.1}\" x2=\"{full}\" y2=\"{at:.1}\"/><text x=\"{:.1}\" \
             y=\"{:.1}\" text-anchor=\"end\">{}</text>",
            LEFT - 6.0,
            at + 4.0,
            format_number(tick)
        );
    }
    let middle = TOP + 0.5 * PLOT;
    let _ = write!(
        out,
        "<text x=\"12\" y=\"{middle:.1}\" transform=\"rotate(-90 12 {middle:.1})\" text-anchor=\"middle\">{}</text>",
        escape(residuals.unit)
    );
    let width = (full - LEFT) / residuals.groups.len().max(1) as f64;
    for (k, group) in residuals.groups.iter().enumerate() {
        let from = LEFT + width * k as f64;
        let slot = 0.8 * width / group.models.len().max(1) as f64;
        for (m, (quantiles, colour)) in group.models.iter().zip(COLOURS.iter().cycle()).enumerate()
        {
            let centre = from + 0.1 * width + slot * (m as f64 + 0.5);
            let half = (0.35 * slot).min(14.0);
            let [low, first, median, third, high] =
                quantiles.values.map(|value| y.to_pixels(value));
            let _ = write!(
                out,
                "<g style=\"stroke:{colour};fill:{colour}\"><path d=\"M{centre:.1} {low:.1}V{high:.1}\"/><rect \
                 x=\"{:.1}\" y=\"{third:.1}\" width=\"{:.1}\" height=\"{:.1}\" fill-opacity=\".3\"/><path \
                 stroke-width=\"2\" d=\"M{:.1} {median:.1}h{:.1}\"/></g>",
                centre - half,
                2.0 * half,
                (first - third).max(0.5),
                centre - half,
                2.0 * half
            );
        }
        let at = from + 0.5 * width;
        let _ = write!(
            out,
            "<text x=\"{at:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text><text x=\"{at:.1}\" y=\"{:.1}\" \
             text-anchor=\"middle\">{} windows</text>",
            TOP + PLOT + 16.0,
            escape(&group.label),
            TOP + PLOT + 31.0,
            group.count
        );
    }
    let mut at = LEFT;
    let names = residuals
        .groups
        .first()
        .map_or(&[][..], |group| &group.models);
    for (name, colour) in names.iter().zip(COLOURS.iter().cycle()) {
        let _ = write!(
            out,
            "<rect x=\"{at:.1}\" y=\"8\" width=\"10\" height=\"10\" style=\"fill:{colour}\"/><text x=\"{:.1}\" \
             y=\"17\">{}</text>",
            at + 15.0,
            escape(&name.model)
        );
        at += 36.0 + 6.2 * name.model.chars().count() as f64;
    }
    let _ = write!(
        out,
        "<text x=\"{LEFT}\" y=\"35\">{}; box: the middle half, line: 5 to 95 %</text></svg>",
        escape(&residuals.title)
    );
    out
}
