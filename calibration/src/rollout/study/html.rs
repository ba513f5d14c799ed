//! The report of a study as one page: no network, no script.

use super::StudyReport;
use crate::format_number::{format_number, format_percent};
use crate::report::page;
use crate::rollout::html;
use std::fmt::Write as _;

impl StudyReport {
    /// The report as one page.
    pub fn to_html(&self) -> String {
        let count = self.models.first().map_or(0, |m| m.episodes.len());
        let lead = format!(
            "Measured against rolled out: {count} episodes in {} folds; each is scored by parameters that the other folds \
             chose. Licence of the data: {}.",
            self.options.folds,
            page::escape(&self.licence)
        );
        let mut out = page::page_head(&self.title, &lead);
        let _ = write!(
            out,
            "<div class=\"verdict named\"><b>Whole episodes</b>{}</div>",
            page::escape(&self.sentence)
        );
        self.write_whole_episodes(&mut out);
        self.write_fitted_parameters(&mut out);
        self.write_windows(&mut out);
        self.write_peer_comparison(&mut out);
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
            "<h2>Whole episodes</h2><div class=\"scroll\"><table><tr><th>Model</th><th>Position, widths: mean / median / sd\
             </th><th>Rotation, degrees</th><th>e_q</th><th>e_q &lt; 0.05</th></tr>",
        );
        let rows = self.models.iter();
        let ours = rows.map(|m| (m.model.name.to_owned(), m.model.about, &m.summary));
        let peers = self.models.first().map_or(&[][..], |m| &m.against[..]);
        let theirs = peers.iter().map(|p| (p.name.clone(), "peer", &p.summary));
        for (name, about, summary) in ours.chain(theirs) {
            let _ = write!(
                out,
                "<tr><td><b>{}</b><br><span class=\"soft\">{}</span></td>",
                page::escape(&name),
                page::escape(about)
            );
            for spread in [
                &summary.position_widths,
                &summary.rotation_deg,
                &summary.e_q,
            ] {
                let _ = write!(
                    out,
                    "<td class=\"n\">{} / {} / {}</td>",
                    format_number(spread.mean),
                    format_number(spread.median),
                    format_number(spread.sd)
                );
            }
            let _ = write!(
                out,
                "<td class=\"n\">{}</td></tr>",
                format_percent(summary.predicted_share)
            );
        }
        out.push_str("</table></div>");
        for m in &self.models {
            let _ = write!(
                out,
                "<p class=\"soft\">{}: {} episodes whose outcome is not chance, median {} widths and {} degrees.</p>",
                m.model.name,
                m.steady.count,
                format_number(m.steady.position_widths.median),
                format_number(m.steady.rotation_deg.median)
            );
        }
        let curves = |f: fn(&super::MeanDeviation) -> f64| -> Vec<(String, Vec<f64>)> {
            let models = self.models.iter();
            models
                .map(|m| {
                    let values = m.episodes.iter().map(|e| f(&e.score)).collect();
                    (m.model.name.to_owned(), values)
                })
                .collect()
        };
        for (title, unit, most, values) in [
            (
                "Share of episodes by position error",
                "cube widths",
                0.5,
                curves(|s| s.position_widths),
            ),
            (
                "Share of episodes by rotation error",
                "degrees",
                45.0,
                curves(|s| s.rotation_deg),
            ),
        ] {
            let _ = write!(
                out,
                "<p>{title}</p>{}",
                page::cumulative_plot(title, unit, most, &values)
            );
        }
        out.push_str(&page::legend(self.models.iter().map(|m| m.model.name)));
    }

    fn write_fitted_parameters(&self, out: &mut String) {
        out.push_str(
            "<h2>Fitted parameters</h2><div class=\"scroll\"><table><tr><th>Model</th><th>Parameter</th><th>Searched</th>\
             <th>Chosen by the folds</th></tr>",
        );
        for report in &self.models {
            for (k, parameter) in report.model.parameters.iter().enumerate() {
                let chosen: Vec<String> =
                    report.chosen.iter().map(|v| format_number(v[k])).collect();
                let [low, high] = parameter.range.map(format_number);
                let _ = write!(
                    out,
                    "<tr><td>{}</td><td>{}{}</td><td class=\"n\">{low} to {high}</td><td class=\"n\">{}</td></tr>",
                    report.model.name,
                    parameter.name,
                    if parameter.unit == "1" {
                        String::new()
                    } else {
                        format!(", {}", parameter.unit)
                    },
                    chosen.join(", ")
                );
            }
        }
        out.push_str("</table></div>");
    }

    fn write_windows(&self, out: &mut String) {
        let stride = self.options.window_stride;
        let _ = write!(
            out,
            "<h2>Windows</h2><p class=\"soft\">From every {stride}th measured sample, some samples ahead: root mean square \
             (median) of distance in mm and of angle in degrees, by the worst that happens on the way. Diverging windows, whose \
             outcome changes when they start within the tracker's noise ({:.3} mm, {:.3} degrees), stand apart.</p>",
            1e3 * self.noise.position_m,
            self.noise.rotation_rad.to_degrees()
        );
        for report in &self.models {
            html::windows(out, report.model.name, &report.windows);
        }
        html::write_solver_artefacts(out, &self.solver);
        html::residuals(out, &self.residuals);
    }

    fn write_peer_comparison(&self, out: &mut String) {
        if self.models.iter().all(|m| m.against.is_empty()) {
            return;
        }
        out.push_str(
            "<h2>Episode by episode</h2><div class=\"scroll\"><table><tr><th>Model against peer</th><th>Quantity</th>\
             <th>Smaller here in</th><th>Median difference, 95 % interval</th></tr>",
        );
        for report in &self.models {
            for peer in &report.against {
                for (what, paired) in [
                    ("position, widths", &peer.position_widths),
                    ("rotation, degrees", &peer.rotation_deg),
                    ("e_q", &peer.e_q),
                ] {
                    let [low, high] = paired.interval.map(format_number);
                    let _ = write!(
                        out,
                        "<tr><td>{} against {}</td><td>{what}</td><td class=\"n\">{}</td><td class=\"n\">{}, {low} to {high}</td></tr>",
                        report.model.name,
                        page::escape(&peer.name),
                        format_percent(paired.better_share),
                        format_number(paired.median_difference)
                    );
                }
            }
        }
        out.push_str("</table></div>");
    }
}
