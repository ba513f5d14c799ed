//! The report of a series as one page: no network, no script.

use super::ModelComparisonReport;
use crate::format_number::{format_number, format_percent};
use crate::report::page;
use crate::rollout::html;
use std::fmt::Write as _;

impl ModelComparisonReport {
    /// The report as one page.
    pub fn to_html(&self) -> String {
        let count = self.models.first().map_or(0, |m| m.episodes.len());
        let folds = self.models.first().map_or(0, |m| m.chosen.len());
        let lead = format!(
            "Measured against rolled out: {count} episodes in {folds} folds; each is predicted by parameters that the other \
             folds chose. Licence of the data: {}.",
            page::escape(&self.licence)
        );
        let mut out = page::page_head(&self.title, &lead);
        let _ = write!(
            out,
            "<div class=\"verdict named\"><b>Whole episodes</b>{}</div>",
            page::escape(&self.sentence)
        );
        self.write_whole_episodes(&mut out);
        self.parameters(&mut out);
        out.push_str("<h2>Windows</h2><p class=\"soft\">From measured samples some samples ahead: root mean square (median).</p>");
        for outcome in &self.models {
            html::windows(&mut out, outcome.model.name, &outcome.windows);
        }
        html::write_solver_artefacts(&mut out, &self.solver);
        html::residuals(&mut out, &self.residuals);
        let found = serde_json::to_string_pretty(&self.found).unwrap_or_default();
        let _ = writeln!(
            out,
            "<h2>For the simulator</h2><p class=\"soft\">The content of found.json.</p><pre><code>{}</code></pre></body></html>",
            page::escape(&found)
        );
        out
    }

    fn write_whole_episodes(&self, out: &mut String) {
        out.push_str(
            "<h2>Whole episodes</h2><p class=\"soft\">Medians: at the last sample, and of the mean over samples.</p>\
             <div class=\"scroll\"><table><tr><th>Model</th><th>Episodes</th><th>End</th><th>Mean</th><th>Gain</th></tr>",
        );
        for outcome in &self.models {
            for (k, row) in outcome.kinds.iter().enumerate() {
                let name = if k == 0 {
                    format!(
                        "<b>{}</b><br><span class=\"soft\">{}</span>",
                        outcome.model.name,
                        page::escape(outcome.model.about)
                    )
                } else {
                    String::new()
                };
                let gain = outcome.gain.as_ref().filter(|_| k == 0);
                let gain = gain.map_or_else(String::new, |gain| {
                    let [low, high] = gain.interval.map(format_percent);
                    format!(
                        "{} ({low} to {high}) over {}",
                        format_percent(gain.share),
                        gain.over
                    )
                });
                let _ = write!(
                    out,
                    "<tr><td>{name}</td><td>{} {}</td><td class=\"n\">{} mm, {}&deg;</td><td class=\"n\">{} mm, {}&deg;</td>\
                     <td class=\"n\">{gain}</td></tr>",
                    row.count,
                    page::escape(row.kind.as_deref().unwrap_or("in all")),
                    format_number(row.end_mm),
                    format_number(row.end_deg),
                    format_number(row.mean_mm),
                    format_number(row.mean_deg)
                );
            }
        }
        out.push_str("</table></div>");
    }

    fn parameters(&self, out: &mut String) {
        out.push_str(
            "<h2>Fitted parameters</h2><div class=\"scroll\"><table><tr><th>Model</th><th>Parameter</th><th>Searched</th>\
             <th>Chosen by the folds</th></tr>",
        );
        for outcome in &self.models {
            for (k, parameter) in outcome.model.parameters.iter().enumerate() {
                let chosen: Vec<String> = outcome
                    .chosen
                    .iter()
                    .map(|v| format!("{:.5}", v[k]))
                    .collect();
                let [low, high] = parameter.range.map(format_number);
                let _ = write!(
                    out,
                    "<tr><td>{}</td><td>{} ({})</td><td class=\"n\">{low} to {high}</td><td>{}</td></tr>",
                    outcome.model.name,
                    page::escape(&parameter.name),
                    parameter.unit,
                    chosen.join(", ")
                );
            }
        }
        out.push_str("</table></div>");
    }
}
