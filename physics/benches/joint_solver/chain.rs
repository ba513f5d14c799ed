//! The benchmark's chains: bars on hinges, each about an axis across or along it.

use glam::{DQuat, DVec3, Vec3};

/// kg/m³.
pub(crate) const DENSITY: f32 = 2000.0;
/// Position of the first hinge, m.
pub(crate) const ORIGIN: Vec3 = Vec3::new(4.0, 4.0, 4.0);
/// Control steps in a second, and physics steps, as in this crate's default.
pub(crate) const CONTROL_HZ: usize = 20;
pub(crate) const PHYSICS_HZ: usize = 120;
/// m/s².
pub(crate) const GRAVITY: f32 = 9.81;

/// A bar along +X with its hinge at the near end.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bar {
    /// m.
    pub(crate) length: f32,
    /// Half of its width, m.
    pub(crate) half: f32,
    pub(crate) axis: Vec3,
}

/// A motor under position control.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Motor {
    /// N·m/rad.
    pub(crate) stiffness: f32,
    /// N·m·s/rad.
    pub(crate) damping: f32,
}

/// Bars on one another's ends.
#[derive(Clone, Debug)]
pub(crate) struct Chain {
    pub(crate) bars: Vec<Bar>,
    pub(crate) motor: Option<Motor>,
    /// rad.
    pub(crate) limits: Option<[f32; 2]>,
    /// Dry friction of each hinge, N·m.
    pub(crate) friction: f32,
    /// Initial hinge angles, rad, and rates, rad/s.
    pub(crate) start: Vec<[f32; 2]>,
    /// Control steps in a second.
    pub(crate) control_hz: usize,
}

impl Chain {
    pub(crate) fn of(bars: Vec<Bar>) -> Self {
        let start = vec![[0.0; 2]; bars.len()];
        Self {
            bars,
            motor: None,
            limits: None,
            friction: 0.0,
            start,
            control_hz: CONTROL_HZ,
        }
    }

    /// Two bars of 0.6 m that swing.
    pub(crate) fn double_pendulum() -> Self {
        let bar = Bar {
            length: 0.6,
            half: 0.03,
            axis: Vec3::Z,
        };
        Self {
            start: vec![[0.3, 0.0], [0.9, 0.0]],
            ..Self::of(vec![bar; 2])
        }
    }

    /// One bar of 0.6 m.
    pub(crate) fn pendulum() -> Self {
        let mut chain = Self::double_pendulum();
        chain.bars.truncate(1);
        chain.start = vec![[0.0; 2]];
        chain
    }

    /// An arm of six joints that stretches level.
    pub(crate) fn arm(motor: Motor) -> Self {
        let bar = |(length, half, axis)| Bar { length, half, axis };
        let bars = [
            (0.15, 0.05, Vec3::Y),
            (0.35, 0.04, Vec3::Z),
            (0.30, 0.035, Vec3::Z),
            (0.12, 0.03, Vec3::X),
            (0.10, 0.025, Vec3::Z),
            (0.08, 0.025, Vec3::X),
        ];
        Self {
            motor: Some(motor),
            ..Self::of(bars.into_iter().map(bar).collect())
        }
    }

    /// `count` bars held by motors, for timing.
    pub(crate) fn held(count: usize) -> Self {
        let bar = |k: usize| Bar {
            length: 0.1,
            half: 0.02,
            axis: if k.is_multiple_of(2) {
                Vec3::Z
            } else {
                Vec3::Y
            },
        };
        Self {
            motor: Some(Motor {
                stiffness: 2000.0,
                damping: 100.0,
            }),
            ..Self::of((0..count).map(bar).collect())
        }
    }

    pub(crate) fn mass_kg(bar: &Bar) -> f64 {
        f64::from(DENSITY * bar.length * 4.0 * bar.half * bar.half)
    }

    /// The position of each bar's hinge at these angles, m, and the bar's orientation.
    pub(crate) fn forward(&self, angles: &[f64]) -> Vec<(DVec3, DQuat)> {
        let (mut at, mut turn) = (ORIGIN.as_dvec3(), DQuat::IDENTITY);
        let mut out = Vec::with_capacity(self.bars.len());
        for (bar, angle) in self.bars.iter().zip(angles) {
            turn *= DQuat::from_axis_angle(bar.axis.as_dvec3(), *angle);
            out.push((at, turn));
            at += turn * DVec3::X * f64::from(bar.length);
        }
        out
    }

    /// The moment of the weight of all that hangs on each hinge, N·m.
    pub(crate) fn loads(&self, angles: &[f64]) -> Vec<f64> {
        let stands = self.forward(angles);
        let load = |k: usize| {
            let (origin, turn) = stands[k];
            let axis = turn * self.bars[k].axis.as_dvec3();
            let moment = |j: usize| {
                let (at, turn) = stands[j];
                let bar = &self.bars[j];
                let arm = at + turn * DVec3::X * (0.5 * f64::from(bar.length)) - origin;
                let weight = DVec3::NEG_Y * (Self::mass_kg(bar) * f64::from(GRAVITY));
                axis.dot(arm.cross(weight))
            };
            (k..self.bars.len()).map(moment).sum()
        };
        (0..self.bars.len()).map(load).collect()
    }
}

/// A chain in one of the solvers. Everything is stepped by the engine's physics rate, 120 Hz with 4 substeps.
pub(crate) trait Solver {
    /// Makes control steps.
    fn steps(&mut self, control_steps: usize);
    /// rad.
    fn angles(&self) -> Vec<f64>;
    /// rad/s.
    fn rates(&self) -> Vec<f64>;
    /// Kinetic and potential energy, J.
    fn energy_j(&self) -> f64;
    /// Returns all state that the next step depends on.
    fn bits(&self) -> Vec<u8>;
    /// Returns another world that continues from this one's snapshot.
    fn restored(&self) -> Box<dyn Solver>;
}
