//! The report of a study as one page: no network, no script.

use super::{ModelReport, StudyReport};
use crate::report::page;
use crate::rollout::{HORIZONS, Regime};
use crate::words::{number, percent};
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
        let mut out = page::open(&self.title, &lead);
        let _ = write!(
            out,
            "<div class=\"verdict named\"><b>Whole episodes</b>{}</div>",
            page::escape(&self.sentence)
        );
        self.whole(&mut out);
        self.parameters(&mut out);
        self.ahead(&mut out);
        self.pairs(&mut out);
        let found = serde_json::to_string_pretty(&self.found).unwrap_or_default();
        let _ = writeln!(
            out,
            "<h2>For the simulator</h2><p class=\"soft\">The content of found.json.</p><pre><code>{}</code></pre></body></html>",
            page::escape(&found)
        );
        out
    }

    fn whole(&self, out: &mut String) {
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
                    number(spread.mean),
                    number(spread.median),
                    number(spread.sd)
                );
            }
            let _ = write!(
                out,
                "<td class=\"n\">{}</td></tr>",
                percent(summary.predicted_share)
            );
        }
        out.push_str("</table></div>");
        let curves = |f: fn(&super::Score) -> f64| -> Vec<(String, Vec<f64>)> {
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
                page::shares(title, unit, most, &values)
            );
        }
        out.push_str(&page::key(self.models.iter().map(|m| m.model.name)));
    }

    fn parameters(&self, out: &mut String) {
        out.push_str(
            "<h2>Fitted parameters</h2><div class=\"scroll\"><table><tr><th>Model</th><th>Parameter</th><th>Searched</th>\
             <th>Chosen by the folds</th></tr>",
        );
        for report in &self.models {
            for (k, parameter) in report.model.parameters.iter().enumerate() {
                let chosen: Vec<String> = report.chosen.iter().map(|v| number(v[k])).collect();
                let [low, high] = parameter.range.map(number);
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

    fn ahead(&self, out: &mut String) {
        let stride = self.options.window_stride;
        let _ = write!(
            out,
            "<h2>Windows</h2><p class=\"soft\">From every {stride}th measured sample, some samples ahead: root mean square \
             (median) of distance in mm and of angle in degrees, by the worst that happens on the way.</p>"
        );
        for report in &self.models {
            windows(out, report);
        }
    }

    fn pairs(&self, out: &mut String) {
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
                    let [low, high] = paired.interval.map(number);
                    let _ = write!(
                        out,
                        "<tr><td>{} against {}</td><td>{what}</td><td class=\"n\">{}</td><td class=\"n\">{}, {low} to {high}</td></tr>",
                        report.model.name,
                        page::escape(&peer.name),
                        percent(paired.better_share),
                        number(paired.median_difference)
                    );
                }
            }
        }
        out.push_str("</table></div>");
    }
}

fn windows(out: &mut String, report: &ModelReport) {
    let _ = write!(
        out,
        "<p><b>{}</b></p><div class=\"scroll\"><table><tr><th>Regime</th>",
        report.model.name
    );
    for horizon in HORIZONS {
        let _ = write!(out, "<th>{horizon} ahead</th>");
    }
    out.push_str("</tr>");
    for regime in std::iter::once(None).chain(Regime::ALL.map(Some)) {
        let _ = write!(out, "<tr><td>{}</td>", regime.map_or("all", Regime::word));
        for horizon in HORIZONS {
            let found = report
                .windows
                .iter()
                .find(|w| w.horizon == horizon && w.regime == regime);
            let cell = found.map_or_else(String::new, |w| {
                format!(
                    "{} ({}) mm<br>{} ({})&deg;<br><span class=\"soft\">{} windows</span>",
                    number(w.position_rms_mm),
                    number(w.position_median_mm),
                    number(w.rotation_rms_deg),
                    number(w.rotation_median_deg),
                    w.count
                )
            });
            let _ = write!(out, "<td class=\"n\">{cell}</td>");
        }
        out.push_str("</tr>");
    }
    out.push_str("</table></div>");
}
