//! Support for the hidden effects. It shares no code with the engines: its own generator of random numbers, its own
//! integrators, and files written by hand.
#![allow(dead_code, reason = "each test file uses a part")]
#![allow(
    clippy::unwrap_used,
    reason = "a test stops at the first surprise, in its helpers too"
)]

pub(crate) mod shoebox;

use std::fmt::Write as _;
use std::path::Path;

/// Random numbers: `SplitMix64` (G. L. Steele et al., OOPSLA 2014).
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x1234_5678_9abc_def1)
    }

    /// Uniform in 0..1.
    pub(crate) fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub(crate) fn range(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.uniform()
    }

    /// Normal with mean 0 and variance 1, as a sum of twelve uniforms would not be in its tails: by the polar method.
    pub(crate) fn normal(&mut self) -> f64 {
        loop {
            let (x, y) = (self.range(-1.0, 1.0), self.range(-1.0, 1.0));
            let s = x * x + y * y;
            if s > 0.0 && s < 1.0 {
                return x * (-2.0 * s.ln() / s).sqrt();
            }
        }
    }

    /// Student's t with three degrees of freedom and variance 1.
    pub(crate) fn heavy(&mut self) -> f64 {
        let chi2: f64 = (0..3).map(|_| self.normal().powi(2)).sum();
        self.normal() / (chi2 / 3.0).sqrt() / 3.0_f64.sqrt()
    }
}

/// A step of the classical Runge-Kutta method.
pub(crate) fn runge_kutta<const N: usize>(
    now: [f64; N],
    t: f64,
    h: f64,
    rates: &dyn Fn(f64, &[f64; N]) -> [f64; N],
) -> [f64; N] {
    let moved = |k: &[f64; N], h: f64| -> [f64; N] { std::array::from_fn(|i| now[i] + h * k[i]) };
    let a = rates(t, &now);
    let b = rates(t + 0.5 * h, &moved(&a, 0.5 * h));
    let c = rates(t + 0.5 * h, &moved(&b, 0.5 * h));
    let d = rates(t + h, &moved(&c, h));
    std::array::from_fn(|i| now[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]))
}

/// The files of a bundle as text.
pub(crate) struct Files {
    pub(crate) manifest: String,
    pub(crate) episodes: String,
    pub(crate) trajectory: String,
    pub(crate) command: String,
    pub(crate) ir: String,
}

impl Files {
    pub(crate) fn new(manifest: String) -> Self {
        Self {
            manifest,
            episodes: "episode,split_group,conditions\n".into(),
            trajectory: "episode,t_s,entity,channel,value\n".into(),
            command: "episode,t_s,actuator,kind,value\n".into(),
            ir:
                "episode,file,source_x,source_y,source_z,receiver_x,receiver_y,receiver_z,rate_hz\n"
                    .into(),
        }
    }

    pub(crate) fn episode(&mut self, name: &str, group: &str) {
        writeln!(self.episodes, "{name},{group},made up").unwrap();
    }

    pub(crate) fn sample(
        &mut self,
        episode: &str,
        t_s: f64,
        entity: &str,
        channel: &str,
        value: f64,
    ) {
        writeln!(
            self.trajectory,
            "{episode},{t_s:.6},{entity},{channel},{value:.7}"
        )
        .unwrap();
    }

    pub(crate) fn command(&mut self, episode: &str, t_s: f64, actuator: &str, value: f64) {
        writeln!(
            self.command,
            "{episode},{t_s:.6},{actuator},position,{value:.7}"
        )
        .unwrap();
    }

    pub(crate) fn write(&self, folder: &Path) {
        for (name, text) in [
            ("manifest.json", &self.manifest),
            ("episodes.csv", &self.episodes),
            ("trajectory.csv", &self.trajectory),
            ("command.csv", &self.command),
            ("ir.csv", &self.ir),
        ] {
            std::fs::write(folder.join(name), text).unwrap();
        }
    }
}

/// A report's causes, for messages of failed tests.
pub(crate) fn table(report: &dwell_calibration::CalibrationReport) -> String {
    let mut out = format!("{}\n", report.sentence);
    writeln!(
        out,
        "  left: {:?} then {:?}",
        report.remainder_before, report.remainder_after
    )
    .unwrap();
    for c in &report.candidates {
        if c.idle {
            continue;
        }
        write!(out, "  {}: fall of BIC {:.1};", c.id, c.delta_bic).unwrap();
        if let Some(gain) = c.gain {
            let [low, high] = gain.share_interval;
            let [nat_low, nat_high] = gain.log_density_interval;
            write!(
                out,
                " held-out share {:.3} ({low:.3} to {high:.3}), {:.2} nat ({nat_low:.2} to {nat_high:.2});",
                gain.share, gain.log_density
            )
            .unwrap();
        }
        for p in &c.parameters {
            write!(
                out,
                " {} = {:.5} ({:.5} to {:.5})",
                p.name, p.value, p.interval[0], p.interval[1]
            )
            .unwrap();
        }
        writeln!(out, "{}", c.implausible.as_deref().unwrap_or_default()).unwrap();
    }
    out
}
