//! Faults of the measurement: clocks, scales and frames of what was written down.

use super::cause::{Cause, CauseBinding, FitParameter};

/// A fault of a clock or a tracker.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum MeasurementFault {
    /// Written lengths are so many times the true ones.
    LengthScale,
    /// Written times are so many times the true ones.
    ClockScale,
    /// The tracker's vertical leans, about x and about z.
    FrameTilt,
    /// Each written value is the mean over so long a time around its stamp.
    Smoothing,
    /// Commands, or the encoder, are in another scale.
    CommandScale,
    /// The tracker's forward is not the robot's.
    HeadingOffset,
    /// The tracker's stamps are late: what it writes is older than they say.
    TrackerDelay,
}

/// The size of each fault.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FaultValues {
    pub(crate) length_scale: f64,
    pub(crate) clock_scale: f64,
    /// rad.
    pub(crate) tilt_rad: [f64; 2],
    pub(crate) smoothing_s: f64,
    pub(crate) command_scale: f64,
    pub(crate) heading_offset_rad: f64,
    pub(crate) tracker_delay_s: f64,
}

impl Default for FaultValues {
    fn default() -> Self {
        Self {
            length_scale: 1.0,
            clock_scale: 1.0,
            tilt_rad: [0.0; 2],
            smoothing_s: 0.0,
            command_scale: 1.0,
            heading_offset_rad: 0.0,
            tracker_delay_s: 0.0,
        }
    }
}

/// Scales of lengths and clocks that somebody may have set: a wand of another length, a frame rate of another standard.
const PLAUSIBLE_SCALES: [f64; 2] = [0.9, 1.1];

/// Samples of the true value that a smoothed one is the mean of.
const SMOOTHING_TAPS: usize = 7;

impl FaultValues {
    /// Sets a fault to the values of its cause's parameters.
    pub(crate) fn set(&mut self, fault: MeasurementFault, values: &[f64]) {
        match (fault, values) {
            (MeasurementFault::LengthScale, [scale]) => self.length_scale = *scale,
            (MeasurementFault::ClockScale, [scale]) => self.clock_scale = *scale,
            (MeasurementFault::FrameTilt, [x, z]) => self.tilt_rad = [*x, *z],
            (MeasurementFault::Smoothing, [window]) => self.smoothing_s = *window,
            (MeasurementFault::CommandScale, [scale]) => self.command_scale = *scale,
            (MeasurementFault::HeadingOffset, [angle]) => self.heading_offset_rad = *angle,
            (MeasurementFault::TrackerDelay, [delay]) => self.tracker_delay_s = *delay,
            _ => debug_assert!(false, "{fault:?} has another number of parameters"),
        }
    }

    /// The written value at a stamp of a quantity that truly is `truth` at each time.
    pub(crate) fn sample(&self, t_s: f64, truth: impl Fn(f64) -> f64) -> f64 {
        let t_s = t_s / self.clock_scale - self.tracker_delay_s;
        if self.smoothing_s <= 0.0 {
            return truth(t_s);
        }
        let taps = (0..SMOOTHING_TAPS).map(|k| {
            let share = (k as f64 + 0.5) / SMOOTHING_TAPS as f64 - 0.5;
            truth(t_s + share * self.smoothing_s)
        });
        taps.sum::<f64>() / SMOOTHING_TAPS as f64
    }

    /// The weights of the true x, y and z in the written coordinate of an axis.
    pub(crate) fn axis_weights(&self, axis: usize) -> [f64; 3] {
        let [x, z] = self.tilt_rad;
        let (sx, cx, sz, cz) = (libm::sin(x), libm::cos(x), libm::sin(z), libm::cos(z));
        // Rz(z) Rx(x), by rows.
        let row = match axis {
            0 => [cz, -sz * cx, sz * sx],
            1 => [sz, cz * cx, -cz * sx],
            _ => [0.0, sx, cx],
        };
        row.map(|weight| weight * self.length_scale)
    }
}

/// A parameter of a fault: name, unit, default, bounds, plausible range, probe.
type FaultParameter<'a> = (&'a str, &'a str, f64, [f64; 2], [f64; 2], f64);

/// The cause of a fault.
fn cause(
    fault: MeasurementFault,
    [id, name, equation, experiment]: [&str; 4],
    parameters: &[FaultParameter<'_>],
) -> Cause {
    Cause {
        id: id.into(),
        name: name.into(),
        equation: equation.into(),
        parameters: parameters
            .iter()
            .map(
                |(name, unit, default, bounds, plausible, probe)| FitParameter {
                    name: (*name).into(),
                    unit: (*unit).into(),
                    default: *default,
                    low: bounds[0],
                    high: bounds[1],
                    plausible: *plausible,
                    step: 0.2 * (probe - default).abs(),
                },
            )
            .collect(),
        probes: vec![parameters.iter().map(|p| p.5).collect()],
        separating_experiment: experiment.into(),
        binding: CauseBinding::Measurement(fault),
        fixed: Vec::new(),
    }
}

impl MeasurementFault {
    /// The fault as a cause.
    pub(crate) fn cause(self) -> Cause {
        match self {
            Self::LengthScale => cause(
                self,
                [
                    "length_scale",
                    "another scale of the tracker's lengths",
                    "written = scale times true, in all positions",
                    "measure a known length with the tracker, or time a pendulum of known length",
                ],
                &[("scale", "1", 1.0, [0.5, 2.0], PLAUSIBLE_SCALES, 1.01)],
            ),
            Self::ClockScale => cause(
                self,
                [
                    "clock_scale",
                    "another rate of the tracker's clock",
                    "written time = scale times true time",
                    "record a known clock for ten minutes with the tracker",
                ],
                &[("scale", "1", 1.0, [0.5, 2.0], PLAUSIBLE_SCALES, 1.01)],
            ),
            Self::FrameTilt => cause(
                self,
                [
                    "frame_tilt",
                    "a vertical of the tracker that leans",
                    "written = Rz(about_z) Rx(about_x) true, angles in rad",
                    "hang a plumb line before the tracker, or drop something from rest: it must fall along the written vertical",
                ],
                &[
                    ("about_x_rad", "rad", 0.0, [-0.5, 0.5], [-0.05, 0.05], 0.01),
                    ("about_z_rad", "rad", 0.0, [-0.5, 0.5], [-0.05, 0.05], 0.01),
                ],
            ),
            Self::Smoothing => cause(
                self,
                [
                    "smoothing",
                    "smoothed positions",
                    "written = mean of the true value over a window around the stamp (s)",
                    "switch the tracker's filter off, or record an impact: smoothing rounds it before it happens",
                ],
                &[("window_s", "s", 0.0, [0.0, 0.5], [0.005, 0.2], 0.03)],
            ),
            Self::CommandScale => cause(
                self,
                [
                    "command_scale",
                    "another scale of commands or encoder",
                    "target = scale times command",
                    "hold still at several targets: a wrong scale is wrong in proportion to the target",
                ],
                &[("scale", "1", 1.0, [0.2, 5.0], [0.9, 1.1], 1.02)],
            ),
            Self::HeadingOffset => cause(
                self,
                [
                    "heading_offset",
                    "a tracker whose forward is not the robot's",
                    "written heading = true heading + offset (rad)",
                    "drive straight on and compare the written heading with the written direction of travel",
                ],
                &[("offset_rad", "rad", 0.0, [-0.5, 0.5], [-0.3, 0.3], 0.02)],
            ),
            Self::TrackerDelay => cause(
                self,
                [
                    "tracker_delay",
                    "a tracker whose stamps are late",
                    "written(t) = true(t - delay), delay in s",
                    "start and stop at once: a late tracker shows the start late, and by the same time at any speed",
                ],
                &[("delay_s", "s", 0.0, [-0.5, 0.5], [-0.3, 0.3], 0.03)],
            ),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A scale of lengths and the clock's rate whose square is its inverse bring the same flights: both must be plausible
    /// where one is.
    #[test]
    fn scales_that_flights_do_not_tell_apart_are_plausible_together() {
        let [length, clock] = [MeasurementFault::LengthScale, MeasurementFault::ClockScale]
            .map(|fault| fault.cause().parameters[0].plausible);
        for scale in [0.93_f64, 0.965, 1.035, 1.07] {
            assert!((length[0]..=length[1]).contains(&scale));
            assert!((clock[0]..=clock[1]).contains(&(1.0 / scale.sqrt())));
        }
    }

    #[test]
    fn faults_change_what_is_written_as_they_say() {
        let mut faults = FaultValues::default();
        let truth = |t: f64| t * t;
        assert!((faults.sample(2.0, truth) - 4.0).abs() < 1e-12);
        faults.set(MeasurementFault::ClockScale, &[2.0]);
        assert!((faults.sample(2.0, truth) - 1.0).abs() < 1e-12);
        faults = FaultValues::default();
        faults.set(MeasurementFault::Smoothing, &[0.6]);
        // The mean of t² over a window w is t² + w²/12; seven midpoints give 1 - 1/49 of the second.
        let expected = 4.0 + 0.36 / 12.0 * (1.0 - 1.0 / 49.0);
        assert!((faults.sample(2.0, truth) - expected).abs() < 1e-12);
        faults = FaultValues::default();
        faults.set(MeasurementFault::LengthScale, &[1.5]);
        assert_eq!(faults.axis_weights(1), [0.0, 1.5, 0.0]);
        faults.set(MeasurementFault::FrameTilt, &[0.1, 0.0]);
        // A fall along the true vertical (0, -1, 0) is written with a part along -z.
        let fall = |axis: usize| -faults.axis_weights(axis)[1] / 1.5;
        assert!(
            (fall(2) + libm::sin(0.1)).abs() < 1e-12 && (fall(1) + libm::cos(0.1)).abs() < 1e-12
        );
    }
}
