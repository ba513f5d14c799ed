//! Measured data against the simulation: residuals, causes, extensions, gain.
//!
//! [`calibrate`] reads a measured [`bundle`], simulates the same situation with the engines, and reports what is left;
//! it names the cause out of the engines' laws and parameters where the data allow it, says so where they do not, and
//! measures the gain on episodes that were held out from all fitting.
//!
//! ```
//! let folder = tempfile::tempdir()?;
//! let hidden = dwell_calibration::example::write(folder.path(), 3)?;
//! let report = dwell_calibration::calibrate(folder.path(), &Default::default(), &mut |_, _| true)?;
//! assert!(matches!(&report.verdict, dwell_calibration::CalibrationVerdict::Named { law, .. } if law == "drag"));
//! println!("{hidden} / {}", report.sentence);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod bundle;
mod error;
pub mod example;
mod experiment;
mod fit;
mod format_number;
mod median;
mod options;
mod progress;
mod report;
pub mod rollout;
mod select;

pub use error::CalibrationError;
pub use options::CalibrationOptions;
pub use progress::StopSignal;
pub use report::{
    CalibrationReport, CalibrationVerdict, CandidateCause, FittedParameter, FoundEffects,
    NamedEffect, NuisanceParameter, Provenance, ResidualPlot,
};
pub use select::{
    ChannelResidual, HeldOutGain, LearnableResidual, RegimeAgreement, ResidualNoiseTest,
    SlowResidual,
};

use bundle::file::BundleKind;
use experiment::{DriveExperiment, Experiment, FlightExperiment, RoomExperiment, ServoExperiment};
use progress::{CallbackProgress, Deadline, ProgressReporter as _};
use std::path::Path;

/// Compares the measured bundle in the folder `path` with its simulation and reports what the simulation lacks.
///
/// `progress` gets a fraction (0 to 1) and the current activity, and answers whether to go on.
///
/// # Errors
/// [`CalibrationError`] for a bundle that cannot be read, options out of range, a situation that cannot be simulated, and
/// [`CalibrationError::Interrupted`] when `progress` answers no.
///
/// # Determinism
/// Equal bundle and options give the same bits for any number of threads.
pub fn calibrate(
    path: &Path,
    options: &CalibrationOptions,
    progress: &mut dyn FnMut(f32, &str) -> bool,
) -> Result<CalibrationReport, CalibrationError> {
    options.check()?;
    let deadline = Deadline::after(options.budget_s, &options.stop);
    let progress = CallbackProgress::with_deadline(progress, deadline);
    progress.stage(0.0, "reading the measured data")?;
    find_missing_causes(&bundle::read(path)?, options, &progress)
}

/// The outcome of a calibration, by the bundle's kind.
#[derive(Clone, Debug, PartialEq)]
pub enum CalibrationOutcome {
    /// The causes that the simulation lacks.
    Causes(Box<CalibrationReport>),
    /// Prediction errors of roll-outs of tosses, with contact parameters by cross-validation.
    ContactStudy(Box<rollout::study::StudyReport>),
}

impl CalibrationOutcome {
    /// The report as one JSON object; its key `html` holds the page.
    pub fn to_json(&self) -> String {
        match self {
            Self::Causes(report) => report.to_json(),
            Self::ContactStudy(report) => report.to_json(),
        }
    }
}

/// As [`calibrate`] for kinds whose causes are named, and as [`rollout::study::run`] for pose trajectories, which are
/// compared with the scores of `peers` too.
///
/// # Errors
/// As those.
pub fn calibrate_any(
    path: &Path,
    options: &CalibrationOptions,
    peers: &[rollout::study::PeerScores],
    progress: &mut dyn FnMut(f32, &str) -> bool,
) -> Result<CalibrationOutcome, CalibrationError> {
    options.check()?;
    let deadline = Deadline::after(options.budget_s, &options.stop);
    let bundle = bundle::read(path)?;
    if bundle.kind() == BundleKind::PoseTrajectory {
        if let Some(budget_s) = options.budget_s {
            let allowed = "none: a study of roll-outs has no verdict before its end";
            let at = bundle.name.clone();
            return Err(CalibrationError::field(at, "budget_s", budget_s, allowed));
        }
        let tracks = rollout::PoseTracks::from_bundle(&bundle)?;
        let settings = rollout::study::StudyOptions {
            seed: options.seed,
            threads: options.threads,
            bootstrap_draws: options.bootstrap_draws,
            ..rollout::study::StudyOptions::default()
        };
        let models = rollout::study::models();
        let mut going_on = |done: f32, what: &str| {
            let goes_on = progress(done, what);
            goes_on && !options.stop.is_raised()
        };
        let report = rollout::study::run(&tracks, &models, peers, &settings, &mut going_on)?;
        return Ok(CalibrationOutcome::ContactStudy(Box::new(report)));
    }
    let progress = CallbackProgress::with_deadline(progress, deadline);
    let report = find_missing_causes(&bundle, options, &progress)?;
    Ok(CalibrationOutcome::Causes(Box::new(report)))
}

/// Reads and checks a measured bundle; answers its kind and how many episodes it has.
///
/// # Errors
/// [`CalibrationError`] names file, line and field.
pub fn check_bundle(path: &Path) -> Result<(BundleKind, usize), CalibrationError> {
    let bundle = bundle::read(path)?;
    Ok((bundle.kind(), bundle.episodes.len()))
}

fn find_missing_causes(
    bundle: &bundle::Bundle,
    options: &CalibrationOptions,
    progress: &CallbackProgress<'_>,
) -> Result<CalibrationReport, CalibrationError> {
    progress.stage(0.05, "building the simulation")?;
    if let (Some(house), false) = (&options.house, bundle.kind() == BundleKind::ImpulseResponse) {
        return Err(CalibrationError::field(
            &bundle.name,
            "house",
            format!("{house:?}"),
            "none: only impulse responses are measured in a house",
        ));
    }
    let mut experiment: Box<dyn Experiment> = match bundle.kind() {
        BundleKind::Trajectory => Box::new(FlightExperiment::new(bundle, options)?),
        BundleKind::Servo => Box::new(ServoExperiment::new(bundle, options)?),
        BundleKind::ImpulseResponse => Box::new(RoomExperiment::new(bundle, options)?),
        BundleKind::Drive => Box::new(DriveExperiment::new(bundle)?),
        BundleKind::PoseTrajectory => {
            return Err(CalibrationError::field(
                bundle.name.clone(),
                "kind",
                format!("{:?}", bundle.kind()),
                "a kind whose causes are named; roll-outs are studied by `examine`",
            ));
        }
    };
    let findings = select::find_causes(experiment.as_mut(), options, progress)?;
    let report = report::build(bundle, experiment.as_ref(), &findings, options.seed);
    progress.stage(1.0, "done")?;
    Ok(report)
}
