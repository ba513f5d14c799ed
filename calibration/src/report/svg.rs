//! Small pictures as SVG text.

use super::data::{CandidateCause, ResidualPlot};
use crate::format_number::format_number;
use crate::select::HeldOutGain;
use std::fmt::Write as _;

pub(crate) const WIDTH: f64 = 640.0;
const HEIGHT: f64 = 220.0;
const LEFT: f64 = 64.0;
const RIGHT: f64 = 12.0;
const TOP: f64 = 12.0;
const BOTTOM: f64 = 34.0;

/// A scale from data to the page.
pub(crate) struct AxisScale {
    pub(crate) low: f64,
    pub(crate) high: f64,
    pub(crate) from: f64,
    pub(crate) to: f64,
}

impl AxisScale {
    pub(crate) fn to_pixels(&self, value: f64) -> f64 {
        let span = self.high - self.low;
        let share = if span > 0.0 {
            (value - self.low) / span
        } else {
            0.5
        };
        self.from + share.clamp(-0.02, 1.02) * (self.to - self.from)
    }

    /// Round values on it: 1, 2 or 5 times a power of ten apart.
    pub(crate) fn ticks(&self) -> Vec<f64> {
        let span = self.high - self.low;
        if span <= 0.0 || !span.is_finite() {
            return vec![self.low];
        }
        let rough = span / 5.0;
        let power = 10.0_f64.powf(rough.log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0]
            .iter()
            .map(|f| f * power)
            .find(|s| *s >= rough)
            .unwrap_or(power);
        let first = (self.low / step).ceil() as i64;
        let last = (self.high / step).floor() as i64;
        (first..=last.min(first + 20))
            .map(|k| k as f64 * step)
            .collect()
    }
}

fn frame(x: &AxisScale, y: &AxisScale, x_name: &str, y_name: &str) -> String {
    let mut out = String::new();
    for tick in y.ticks() {
        let at = y.to_pixels(tick);
        let _ = write!(
            out,
            "<line class=\"grid\" x1=\"{:.1}\" y1=\"{at:.1}\" x2=\"{:.1}\" y2=\"{at:.1}\"/><text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>",
            x.from,
            x.to,
            x.from - 6.0,
            at + 4.0,
            format_number(tick)
        );
    }
    for tick in x.ticks() {
        let at = x.to_pixels(tick);
        let _ = write!(
            out,
            "<line class=\"grid\" x1=\"{at:.1}\" y1=\"{:.1}\" x2=\"{at:.1}\" y2=\"{:.1}\"/><text x=\"{at:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>",
            y.from,
            y.to,
            y.from + 15.0,
            format_number(tick)
        );
    }
    let _ = write!(
        out,
        "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{x_name}</text><text x=\"12\" y=\"{:.1}\" transform=\"rotate(-90 12 {:.1})\" text-anchor=\"middle\">{y_name}</text>",
        x.to,
        HEIGHT - 4.0,
        HEIGHT / 2.0,
        HEIGHT / 2.0
    );
    out
}

/// Returns what is left over time: before and after.
pub(super) fn residuals(plot: &ResidualPlot, name: &str) -> String {
    let points = || plot.before.iter().chain(&plot.after);
    let far = |k: usize| points().map(|p| p[k].abs()).fold(0.0, f64::max);
    let low_t = points().map(|p| p[0]).fold(0.0, f64::min);
    let size = far(1).max(2.0 * plot.noise_sd).max(f64::MIN_POSITIVE);
    let x = AxisScale {
        low: low_t,
        high: far(0).max(1e-9),
        from: LEFT,
        to: WIDTH - RIGHT,
    };
    let y = AxisScale {
        low: -size,
        high: size,
        from: HEIGHT - BOTTOM,
        to: TOP,
    };
    let mut out = open(HEIGHT, name);
    let (top, bottom) = (
        y.to_pixels(2.0 * plot.noise_sd),
        y.to_pixels(-2.0 * plot.noise_sd),
    );
    let _ = write!(
        out,
        "<rect class=\"noise\" x=\"{:.1}\" y=\"{top:.1}\" width=\"{:.1}\" height=\"{:.1}\"/>",
        x.from,
        x.to - x.from,
        bottom - top
    );
    out.push_str(&frame(&x, &y, "time, s", &format!("left, {}", plot.unit)));
    for (class, points) in [("before", &plot.before), ("after", &plot.after)] {
        let _ = write!(out, "<path class=\"{class}\" d=\"");
        for [t, r] in points {
            let _ = write!(out, "M{:.1} {:.1}h0", x.to_pixels(*t), y.to_pixels(*r));
        }
        out.push_str("\"/>");
    }
    out.push_str("</svg>");
    out
}

/// The held-out gain of every cause with its interval.
pub(super) fn gains(candidates: &[CandidateCause]) -> String {
    let candidates: Vec<(&CandidateCause, HeldOutGain)> = candidates
        .iter()
        .filter_map(|candidate| Some((candidate, candidate.gain?)))
        .collect();
    let row = 24.0;
    let height = TOP + BOTTOM + row * candidates.len() as f64;
    let (left, right) = (170.0, 30.0);
    let ends = candidates.iter().flat_map(|c| c.1.share_interval);
    let low = ends.fold(-0.05, f64::min).max(-1.0);
    let x = AxisScale {
        low: 100.0 * low,
        high: 100.0,
        from: left,
        to: WIDTH - right,
    };
    let mut out = open(height, "held-out gain of every cause");
    for tick in x.ticks() {
        let at = x.to_pixels(tick);
        let _ = write!(
            out,
            "<line class=\"grid\" x1=\"{at:.1}\" y1=\"{TOP}\" x2=\"{at:.1}\" y2=\"{:.1}\"/><text x=\"{at:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{} %</text>",
            height - BOTTOM,
            height - BOTTOM + 16.0,
            format_number(tick)
        );
    }
    for (k, (candidate, gain)) in candidates.iter().enumerate() {
        let y = TOP + row * (k as f64 + 0.5);
        let class = if candidate.passes { "yes" } else { "no" };
        let [a, b] = gain.share_interval.map(|share| x.to_pixels(100.0 * share));
        let _ = write!(
            out,
            "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{}</text><line class=\"{class}\" x1=\"{a:.1}\" y1=\"{y:.1}\" x2=\"{b:.1}\" y2=\"{y:.1}\"/><circle class=\"{class}\" cx=\"{:.1}\" cy=\"{y:.1}\" r=\"4\"/>",
            left - 10.0,
            y + 4.0,
            super::html::escape(&candidate.id),
            x.to_pixels(100.0 * gain.share)
        );
    }
    out.push_str("</svg>");
    out
}

/// A line through points.
pub(super) struct Curve<'a> {
    /// As CSS names it.
    pub(super) colour: &'a str,
    /// (x, y).
    pub(super) points: Vec<[f64; 2]>,
}

/// Curves from 0 to the end of each axis, each with its unit.
pub(super) fn curves(name: &str, x: (&str, f64), y: (&str, f64), curves: &[Curve<'_>]) -> String {
    let (x_name, x_end) = x;
    let (y_name, y_end) = y;
    let x = AxisScale {
        low: 0.0,
        high: x_end,
        from: LEFT,
        to: WIDTH - RIGHT,
    };
    let y = AxisScale {
        low: 0.0,
        high: y_end,
        from: HEIGHT - BOTTOM,
        to: TOP,
    };
    let mut out = open(HEIGHT, name);
    out.push_str(&frame(&x, &y, x_name, y_name));
    for curve in curves {
        let _ = write!(
            out,
            "<path fill=\"none\" stroke-width=\"2\" style=\"stroke:{}\" d=\"",
            curve.colour
        );
        for (k, [a, b]) in curve.points.iter().enumerate() {
            let pen = if k == 0 { 'M' } else { 'L' };
            let _ = write!(out, "{pen}{:.1} {:.1}", x.to_pixels(*a), y.to_pixels(*b));
        }
        out.push_str("\"/>");
    }
    out.push_str("</svg>");
    out
}

fn open(height: f64, label: &str) -> String {
    format!(
        "<svg viewBox=\"0 0 {WIDTH} {height}\" role=\"img\" aria-label=\"{}\">",
        super::html::escape(label)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        let scale = AxisScale {
            low: -0.013,
            high: 0.021,
            from: 0.0,
            to: 1.0,
        };
        let ticks = scale.ticks();
        assert!(
            ticks.len() >= 3 && ticks.iter().all(|t| (-0.013..=0.021).contains(t)),
            "{ticks:?}"
        );
        assert!(ticks.iter().any(|t| t.abs() < 1e-12));
        assert_eq!(
            AxisScale {
                low: 1.0,
                high: 1.0,
                from: 0.0,
                to: 1.0
            }
            .ticks(),
            [1.0]
        );
    }
}
