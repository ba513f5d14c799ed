//! Parts of a page that every study of roll-outs has.

use super::box_plot;
use super::residuals::ResidualGroups;
use super::{ContactRegime, HORIZONS, WindowScore};
use crate::format_number::format_number;
use crate::report::page;
use std::fmt::Write as _;

/// Writes the deviations of a model's windows.
pub(crate) fn windows(out: &mut String, model: &str, scores: &[WindowScore]) {
    let _ = write!(
        out,
        "<p><b>{}</b></p><div class=\"scroll\"><table><tr><th>Regime</th>",
        page::escape(model)
    );
    for horizon in HORIZONS {
        let _ = write!(out, "<th>{horizon} ahead</th>");
    }
    out.push_str("</tr>");
    let regimes = std::iter::once(None).chain(ContactRegime::ALL.map(Some));
    let rows = regimes.map(|regime| (regime, false)).chain([(None, true)]);
    for (regime, diverging) in rows {
        let of = |w: &&WindowScore| w.regime == regime && w.diverging == diverging;
        if !scores.iter().any(|w| of(&w)) {
            continue;
        }
        let word = if diverging {
            "diverging"
        } else {
            regime.map_or("all others", ContactRegime::name)
        };
        let _ = write!(out, "<tr><td>{word}</td>");
        for horizon in HORIZONS {
            let found = scores.iter().find(|w| w.horizon == horizon && of(w));
            let cell = found.map_or_else(String::new, |w| {
                format!(
                    "{} ({}) mm<br>{} ({})&deg;<br><span class=\"soft\">{} windows</span>",
                    format_number(w.position_rms_mm),
                    format_number(w.position_median_mm),
                    format_number(w.rotation_rms_deg),
                    format_number(w.rotation_median_deg),
                    w.count
                )
            });
            let _ = write!(out, "<td class=\"n\">{cell}</td>");
        }
        out.push_str("</tr>");
    }
    out.push_str("</table></div>");
}

/// Writes which residuals are the solver's.
pub(crate) fn write_solver_artefacts(out: &mut String, sentences: &[String]) {
    out.push_str("<h2>Steps</h2>");
    for sentence in sentences {
        let _ = write!(out, "<p>{}</p>", page::escape(sentence));
    }
}

/// The pictures.
pub(crate) fn residuals(out: &mut String, residuals: &[ResidualGroups]) {
    out.push_str("<h2>Residuals</h2>");
    for one in residuals {
        let _ = write!(
            out,
            "<p>{}</p>{}",
            page::escape(&one.title),
            box_plot::picture(one)
        );
    }
}
