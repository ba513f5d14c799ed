//! The report as one page: no network, no script.

use super::data::{CalibrationReport, CalibrationVerdict, CandidateCause, FittedParameter};
use super::page;
use super::svg;
use crate::format_number::{format_number, format_percent};
use crate::select::ChannelResidual;
use std::fmt::Write as _;

pub(super) const STYLE: &str = "\
:root{color-scheme:light dark;--ink:#1c2024;--soft:#5f6b76;--line:#d8dee4;--page:#fdfdfc;--card:#f4f6f8;--before:#c2591a;--after:#1f6fb2;--good:#1a7f4b;--noise:#1f6fb222}\
@media(prefers-color-scheme:dark){:root{--ink:#e6e9ec;--soft:#9aa5b0;--line:#363d45;--page:#15181b;--card:#1e2327;--before:#f0955a;--after:#6cb2ee;--good:#5fcf95;--noise:#6cb2ee22}}\
body{font:16px/1.55 system-ui,sans-serif;color:var(--ink);background:var(--page);max-width:60rem;margin:2.5rem auto;padding:0 1.2rem}\
h1{font-size:1.5rem;margin:0}h2{font-size:1.1rem;margin:2.2rem 0 .6rem}p.soft,td.soft,.soft{color:var(--soft)}\
.verdict{background:var(--card);border-left:5px solid var(--soft);border-radius:6px;padding:1rem 1.3rem;margin:1.4rem 0;font-size:1.08rem}\
.verdict.named{border-color:var(--good)}.verdict.one_of,.verdict.unexplained{border-color:var(--before)}.verdict b{display:block;margin-bottom:.3rem}\
.scroll{overflow-x:auto}table{border-collapse:collapse;width:100%;font-size:.9rem}th{text-align:left;font-weight:600;color:var(--soft)}\
td,th{padding:.42rem .7rem .42rem 0;border-bottom:1px solid var(--line);vertical-align:top}td.n{font-variant-numeric:tabular-nums;white-space:nowrap}\
code{font-size:.86em}svg{width:100%;height:auto;font:11px system-ui,sans-serif}svg text{fill:var(--soft)}.grid{stroke:var(--line)}.noise{fill:var(--noise)}\
path.before,path.after{fill:none;stroke-width:2.4;stroke-linecap:round}path.before{stroke:var(--before)}path.after{stroke:var(--after)}\
line.yes,line.no{stroke-width:2}line.yes{stroke:var(--good)}circle.yes{fill:var(--good)}line.no{stroke:var(--soft)}circle.no{fill:var(--soft)}\
.key i{display:inline-block;width:.7rem;height:.7rem;border-radius:50%;margin:0 .35rem 0 .9rem}";

/// Text that is safe in a page.
pub(crate) fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            other => out.push(other),
        }
    }
    out
}

fn unit_suffix(text: &str) -> String {
    if text == "1" {
        String::new()
    } else {
        format!(" {}", escape(text))
    }
}

fn verdict_heading(verdict: &CalibrationVerdict) -> (&'static str, &'static str) {
    match verdict {
        CalibrationVerdict::NoEffect => ("nothing", "Nothing is missing"),
        CalibrationVerdict::Named { .. } => ("named", "The cause has a name"),
        CalibrationVerdict::OneOf { .. } => ("one_of", "One of several causes"),
        CalibrationVerdict::Unexplained { .. } => ("unexplained", "Something unknown is missing"),
    }
}

impl CalibrationReport {
    /// The report as one page.
    pub fn to_html(&self) -> String {
        let mut out = String::with_capacity(1 << 16);
        let (class, says) = verdict_heading(&self.verdict);
        let lead = format!(
            "Measured against simulated: {} episodes fitted, {} held out from all fitting. Licence of the data: {}.",
            self.fitted_episodes.len(),
            self.held_out_episodes.len(),
            escape(&self.licence)
        );
        out.push_str(&page::page_head(&self.title, &lead));
        let _ = write!(
            out,
            "<div class=\"verdict {class}\"><b>{says}</b>{}</div>",
            escape(&self.sentence)
        );
        self.pictures(&mut out);
        self.table_of_causes(&mut out);
        self.table_of_residuals(&mut out);
        self.write_closing_sections(&mut out);
        out.push_str("</body></html>\n");
        out
    }

    fn pictures(&self, out: &mut String) {
        out.push_str("<h2>What is left between measured and simulated</h2><p class=\"soft key\">");
        out.push_str(
            "<i style=\"background:var(--before)\"></i>only starts, offsets and gains fitted",
        );
        if self.plots.iter().any(|plot| !plot.after.is_empty()) {
            out.push_str("<i style=\"background:var(--after)\"></i>with the cause that was found");
        }
        out.push_str("<i style=\"background:var(--noise)\"></i>noise, two standard deviations</p>");
        for plot in &self.plots {
            let name = format!("what is left in {}", plot.title);
            let _ = write!(
                out,
                "<p>{}</p>{}",
                escape(&plot.title),
                svg::residuals(plot, &name)
            );
        }
    }

    fn table_of_causes(&self, out: &mut String) {
        out.push_str(
            "<h2>Causes that were tried</h2><p class=\"soft\">Each alone: those that gain most to first order were fitted in full. A \
             cause counts when the information criterion (BIC) falls far enough, by more than chance gives the best of the \
             library, and the episodes that no fit has seen get better.</p>",
        );
        out.push_str(&svg::gains(&self.candidates));
        out.push_str(
            "<div class=\"scroll\"><table><tr><th>Cause</th><th>Fitted, 95 % interval</th><th>Fall of BIC</th>\
             <th>Held-out error taken away</th><th></th></tr>",
        );
        for candidate in &self.candidates {
            write_cause_row(out, candidate);
        }
        out.push_str("</table></div>");
    }

    fn table_of_residuals(&self, out: &mut String) {
        out.push_str(
            "<h2>Residuals</h2><div class=\"scroll\"><table><tr><th>Channel</th><th></th><th>Bias</th><th>RMS</th><th>Noise</th>\
             <th>Mean square over noise</th><th>Independent of all numbers</th></tr>",
        );
        for (when, residuals) in [
            ("before", &self.residuals_before),
            ("after", &self.residuals_after),
        ] {
            if when == "after" && !matches!(self.verdict, CalibrationVerdict::Named { .. }) {
                continue;
            }
            for residual in residuals {
                residual_row(out, when, residual);
            }
        }
        out.push_str("</table></div>");
        let told = |r: &crate::select::ResidualNoiseTest| {
            format!(
                "{} (noise alone stays below {})",
                format_number(r.ratio),
                format_number(r.threshold)
            )
        };
        let _ = write!(
            out,
            "<p class=\"soft\">Systematic over random part of what is left: before {}, after {}.</p>",
            told(&self.remainder_before),
            told(&self.remainder_after)
        );
        if let Some(agreement) = &self.agreement {
            let _ = write!(
                out,
                "<p class=\"soft\">Fitted apart where it acts weakly and where it acts strongly: {} and {}, {:.1} standard \
                 deviations apart.</p>",
                format_number(agreement.weak),
                format_number(agreement.strong),
                agreement.z.abs()
            );
        }
    }

    fn write_closing_sections(&self, out: &mut String) {
        if !self.nuisances.is_empty() {
            out.push_str("<h2>Nuisances</h2><div class=\"scroll\"><table>");
            for nuisance in &self.nuisances {
                let _ = write!(
                    out,
                    "<tr><td>{}</td><td class=\"n\">{} &plusmn; {}{}</td></tr>",
                    escape(&nuisance.name),
                    format_number(nuisance.value),
                    format_number(nuisance.sd),
                    unit_suffix(&nuisance.unit)
                );
            }
            out.push_str("</table></div>");
        }
        out.push_str("<h2>How to tell causes apart</h2><ul>");
        for candidate in &self.candidates {
            let _ = write!(
                out,
                "<li><b>{}</b>: {}.</li>",
                escape(&candidate.name),
                escape(&candidate.separating_experiment)
            );
        }
        out.push_str("</ul><h2>Notes</h2><ul>");
        for note in &self.notes {
            let _ = write!(out, "<li>{}</li>", escape(note));
        }
        let found = serde_json::to_string_pretty(&self.found).unwrap_or_default();
        let _ = write!(
            out,
            "</ul><h2>For the simulator</h2><p class=\"soft\">The content of found.json: laws to install and parameters to \
             override.</p><pre><code>{}</code></pre>",
            escape(&found)
        );
    }
}

fn write_cause_row(out: &mut String, candidate: &CandidateCause) {
    let told: Vec<String> = candidate.parameters.iter().map(parameter).collect();
    let gain = candidate.gain.map_or_else(String::new, |gain| {
        let [low, high] = gain.share_interval.map(format_percent);
        format!(
            "{}<br><span class=\"soft\">{low} to {high}</span>",
            format_percent(gain.share)
        )
    });
    if candidate.idle {
        let _ = write!(
            out,
            "<tr><td><b>{}</b><br><span class=\"soft\">{}</span></td><td colspan=\"4\" class=\"soft\">nothing in this data \
             depends on it</td></tr>",
            escape(&candidate.name),
            escape(&candidate.equation)
        );
        return;
    }
    let judgement = match (&candidate.implausible, candidate.passes) {
        (Some(why), true) => format!("fits, but {}", escape(why)),
        (_, true) => "passes".to_owned(),
        (_, false) => "no".to_owned(),
    };
    let _ = write!(
        out,
        "<tr><td><b>{}</b><br><span class=\"soft\">{}</span></td><td class=\"n\">{}</td><td class=\"n\">{}</td>\
         <td class=\"n\">{gain}</td><td>{judgement}</td></tr>",
        escape(&candidate.name),
        escape(&candidate.equation),
        told.join("<br>"),
        format_number(candidate.delta_bic),
    );
}

fn parameter(p: &FittedParameter) -> String {
    let [low, high] = p.interval.map(format_number);
    format!(
        "{} = {}{}<br><span class=\"soft\">{low} to {high}; was {}</span>",
        escape(&p.name),
        format_number(p.value),
        unit_suffix(&p.unit),
        format_number(p.default)
    )
}

fn residual_row(out: &mut String, when: &str, r: &ChannelResidual) {
    let known = if r.noise_known { "" } else { " (estimated)" };
    let unit = unit_suffix(&r.unit);
    let _ = write!(
        out,
        "<tr><td>{}</td><td class=\"soft\">{when}</td><td class=\"n\">{}{unit}</td><td class=\"n\">{}{unit}</td>\
         <td class=\"n\">{}{unit}{known}</td><td class=\"n\">{}</td><td class=\"n\">{:.0} of {}</td></tr>",
        escape(&r.channel),
        format_number(r.bias),
        format_number(r.rms),
        format_number(r.noise_sd),
        format_number(r.chi2_per_count),
        r.effective_count,
        r.count
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_of_strangers_cannot_become_markup() {
        assert_eq!(escape("<script>\"&'"), "&lt;script&gt;&quot;&amp;&#39;");
    }
}
