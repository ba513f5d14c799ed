//! Bending modes of free bars and panels.

use super::{ContactBody, ElasticProperties};
use std::f64::consts::{PI, TAU};

/// Solutions of cosh x cos x = 1, the free bar's equation.
const BAR_ROOTS: [f64; 4] = [
    4.730_040_744_862_704,
    7.853_204_624_095_838,
    10.995_607_838_001_671,
    14.137_165_491_257_464,
];
/// Most modes of a body; the lowest are used.
const MOST_MODES: usize = 40;
/// Most nodal lines across one direction.
const MOST_LINES: u32 = 12;
/// Width over length below which a body bends as a bar.
const BAR_WIDTH: f64 = 0.25;
/// Share of its box below which a body counts as hollow.
const SOLID_FILL: f64 = 0.4;
/// The audible range, Hz.
const AUDIBLE_HZ: (f64, f64) = (20.0, 20_000.0);

/// Returns the frequency of the `n`-th bending mode (from 1 on) of a free bar, Hz.
///
/// # Source
/// Euler and Bernoulli's beam, as in L. Meirovitch, *Fundamentals of Vibrations* (2001), section 8.4:
/// ω = x² / L² √(E I / ρ A), with I / A = h² / 12.
pub fn bar_mode_hz(n: u32, length_m: f64, thickness_m: f64, of: &ElasticProperties) -> f64 {
    let place = n.max(1) as usize - 1;
    let root = BAR_ROOTS.get(place).copied();
    let root = root.unwrap_or((f64::from(n) + 0.5) * PI);
    let speed = (of.young_pa / of.density_kg_m3).sqrt();
    root * root / (TAU * length_m * length_m) * thickness_m / 12.0_f64.sqrt() * speed
}

/// Returns the frequency of the mode of a free rectangular panel with `lines` nodal lines across its edges `sides_m`, Hz; 0
/// for rigid-body modes.
///
/// # Source
/// Kirchhoff's plate in the approximation of G. B. Warburton, *Proc. Inst. Mech. Eng.* 168, 371 (1954), table 1, edges free.
pub fn panel_mode_hz(
    lines: [u32; 2],
    sides_m: [f64; 2],
    thickness_m: f64,
    of: &ElasticProperties,
) -> f64 {
    let [(gx, hx, jx), (gy, hy, jy)] = lines.map(warburton_coefficients);
    let [a, b] = sides_m;
    let across = (a / b) * (a / b);
    let nu = of.poisson;
    let sum = libm::pow(gx, 4.0)
        + libm::pow(gy, 4.0) * across * across
        + 2.0 * across * (nu * hx * hy + (1.0 - nu) * jx * jy);
    let stiffness = of.young_pa / (12.0 * of.density_kg_m3 * (1.0 - nu * nu));
    0.5 * PI / (a * a) * thickness_m * (stiffness * sum).sqrt()
}

/// Returns G, H and J of a direction with `m` nodal lines across it.
fn warburton_coefficients(m: u32) -> (f64, f64, f64) {
    match m {
        0 => (0.0, 0.0, 0.0),
        1 => (0.0, 0.0, 12.0 / (PI * PI)),
        2 => (1.506, 1.248, 5.017),
        _ => {
            let g = f64::from(m) - 0.5;
            let (h, j) = (1.0 - 2.0 / (g * PI), 1.0 + 6.0 / (g * PI));
            (g, g * g * h, g * g * j)
        }
    }
}

/// The simplest bending plate, bar or shell of a body's size, mass and substance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BendingPanel {
    /// Its two longer edges, m, the longest first.
    pub sides_m: [f64; 2],
    /// Thickness of the bending plate or bar, m: the whole when solid, one wall when hollow.
    pub thickness_m: f64,
    /// kg.
    pub mass_kg: f64,
    /// Radiating area, m².
    pub area_m2: f64,
    /// True if it bends along its length alone.
    pub is_bar: bool,
}

/// A mode.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BendingMode {
    /// Hz.
    pub frequency_hz: f64,
    /// Nodal lines across each side.
    pub nodal_lines: [u32; 2],
}

impl BendingPanel {
    /// Returns the representation of `body`.
    ///
    /// The box around it and its mass give the share of the box that the substance fills: below 0.4 it is hollow, with
    /// walls of equal thickness all around, one of which bends.
    pub fn equivalent_to(body: &ContactBody, of: &ElasticProperties) -> Self {
        let mut edges = body.size_m.map(|edge| f64::from(edge).clamp(1e-3, 20.0));
        edges.sort_by(|a, b| b.total_cmp(a));
        let [length, width, height] = edges;
        let mass_kg = f64::from(body.mass_kg).max(1e-4);
        let volume = mass_kg / of.density_kg_m3;
        let hollow = volume < SOLID_FILL * length * width * height;
        let bar = width < BAR_WIDTH * length;
        let surface = 2.0 * (length * width + width * height + height * length);
        let wall = (volume / surface).clamp(1e-4, 0.5 * height);
        let (thickness_m, mass_kg, area_m2) = match (bar, hollow) {
            (true, false) => (height, mass_kg, surface),
            // The radius of gyration of a thin square tube is √2 times that of a solid bar.
            (true, true) => (2.0_f64.sqrt() * height, mass_kg, surface),
            (false, false) => (height, mass_kg, 2.0 * length * width),
            // All walls move together, approximately.
            (false, true) => (wall, mass_kg, surface),
        };
        Self {
            sides_m: [length, width],
            thickness_m,
            mass_kg,
            area_m2,
            is_bar: bar,
        }
    }

    /// Returns its audible modes, the lowest first; at most 40.
    pub fn modes(&self, of: &ElasticProperties) -> Vec<BendingMode> {
        let mut modes = Vec::new();
        if self.is_bar {
            for n in 1..=MOST_LINES {
                let frequency_hz = bar_mode_hz(n, self.sides_m[0], self.thickness_m, of);
                modes.push(BendingMode {
                    frequency_hz,
                    nodal_lines: [n + 1, 0],
                });
            }
        } else {
            for x in 0..=MOST_LINES {
                for y in 0..=MOST_LINES {
                    let lines = [x, y];
                    let frequency_hz = panel_mode_hz(lines, self.sides_m, self.thickness_m, of);
                    modes.push(BendingMode {
                        frequency_hz,
                        nodal_lines: lines,
                    });
                }
            }
        }
        let (low, high) = AUDIBLE_HZ;
        modes.retain(|mode| (low..=high).contains(&mode.frequency_hz));
        modes.sort_by(|a, b| a.frequency_hz.total_cmp(&b.frequency_hz));
        modes.truncate(MOST_MODES);
        modes
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::elastic;

    /// A. W. Leissa, J. Sound Vib. 31, 257 (1973), table C21: completely free plates, ω a² √(ρ h / D), Poisson's ratio 0.3.
    /// Warburton's one-term shapes are stiffer than the plate, and cannot mix (2, 0) with (0, 2) on a square.
    #[test]
    fn free_panels_have_the_exact_solutions_frequencies() {
        let of = ElasticProperties {
            poisson: 0.3,
            ..elastic("steel")
        };
        let (a, h) = (0.5, 0.003);
        let rigidity = of.young_pa * h * h * h / (12.0 * (1.0 - 0.09));
        let unit_hz = (rigidity / (of.density_kg_m3 * h)).sqrt() / (TAU * a * a);
        for (ratio, lines, exact) in [
            (1.0, [1, 1], 13.489),
            (1.0, [2, 1], 35.024),
            (1.5, [1, 1], 20.128),
            (1.5, [2, 0], 21.603),
            (1.5, [2, 1], 46.654),
            (2.5, [2, 0], 21.643),
            (2.5, [1, 1], 33.050),
            (2.5, [3, 0], 60.137),
            (2.5, [2, 1], 71.484),
        ] {
            let found = panel_mode_hz(lines, [a, a / ratio], h, &of) / unit_hz;
            let error = found / exact - 1.0;
            assert!(
                (0.0..0.09).contains(&error),
                "{ratio} {lines:?}: {found} of {exact}"
            );
        }
        for lines in [[0, 0], [1, 0], [0, 1]] {
            assert_eq!(panel_mode_hz(lines, [a, a], h, &of), 0.0);
        }
    }

    /// N. H. Fletcher, T. D. Rossing, The Physics of Musical Instruments (1998), section 2.16: f1 = 1.028 (h / L²) √(E / ρ),
    /// and the ratios 1 : 2.756 : 5.404 : 8.933.
    #[test]
    fn bars_have_the_frequencies_of_euler_and_bernoulli() {
        let of = elastic("steel");
        let lowest = bar_mode_hz(1, 0.3, 0.006, &of);
        let speed = (of.young_pa / of.density_kg_m3).sqrt();
        assert!((lowest / (1.028 * 0.006 / 0.09 * speed) - 1.0).abs() < 1e-3);
        for (n, ratio) in [
            (2, 2.7565),
            (3, 5.4039),
            (4, 8.9330),
            (5, 13.3443),
            (6, 18.638),
        ] {
            let found = bar_mode_hz(n, 0.3, 0.006, &of) / lowest;
            assert!((found / ratio - 1.0).abs() < 1e-4, "{n}: {found}");
        }
        // A narrow panel is a bar, but for the Poisson effect.
        let stiffened = (1.0 - of.poisson * of.poisson).sqrt();
        let panel = panel_mode_hz([2, 0], [0.3, 0.01], 0.006, &of) * stiffened;
        assert!((panel / lowest - 1.0).abs() < 2e-3);
    }

    #[test]
    fn bodies_become_bars_panels_and_shells() {
        let steel = elastic("steel");
        // A ruler, a tray, a pot of 1 mm.
        let ruler = ContactBody {
            mass_kg: 0.3 * 0.03 * 0.002 * 7850.0,
            size_m: [0.03, 0.3, 0.002],
        };
        let panel = BendingPanel::equivalent_to(&ruler, &steel);
        assert!(panel.is_bar && (panel.thickness_m - 0.002).abs() < 1e-9);
        let tray = ContactBody {
            mass_kg: 0.4 * 0.3 * 0.002 * 7850.0,
            size_m: [0.3, 0.002, 0.4],
        };
        let panel = BendingPanel::equivalent_to(&tray, &steel);
        assert!(!panel.is_bar && (panel.mass_kg - f64::from(tray.mass_kg)).abs() < 1e-9);
        let area = 2.0 * (0.3 * 0.3 + 2.0 * 0.3 * 0.2);
        let pot = ContactBody {
            mass_kg: (area * 0.001 * 7850.0) as f32,
            size_m: [0.3, 0.2, 0.3],
        };
        let panel = BendingPanel::equivalent_to(&pot, &steel);
        assert!((panel.thickness_m - 0.001).abs() < 1e-6, "{panel:?}");
        assert!((panel.area_m2 - area).abs() < 1e-6);
        for modes in [
            panel.modes(&steel),
            BendingPanel::equivalent_to(&ruler, &steel).modes(&steel),
        ] {
            assert!(modes.len() >= 5 && modes.len() <= MOST_MODES);
            assert!(modes.is_sorted_by(|a, b| a.frequency_hz <= b.frequency_hz));
        }
        // A die's lowest mode is above hearing.
        let die = ContactBody {
            mass_kg: 0.004,
            size_m: [0.015; 3],
        };
        assert!(
            BendingPanel::equivalent_to(&die, &elastic("plastic"))
                .modes(&elastic("plastic"))
                .len()
                <= 1
        );
    }
}
