//! Everything in one command. All stages run, even when one fails; each is timed.

mod stages;

use crate::findings::CheckOutcome;
use crate::{bits, features, layers, licences, py_engine, sizes};
use stages::Stage;
use std::path::Path;
use std::process::Command;
use std::time::Instant;

#[expect(clippy::unnecessary_wraps, reason = "every command has this signature")]
pub(crate) fn run(root: &Path) -> Result<CheckOutcome, String> {
    let mut outcome = CheckOutcome::default();
    for stage in stages::all(root) {
        println!("-- {}", stage.name);
        timed(&mut outcome, stage.name, || run_program(root, &stage));
    }
    let own: [(&str, crate::Command); 6] = [
        ("layers", layers::run),
        ("sizes", sizes::run),
        ("licences", licences::run),
        ("features", features::run),
        ("bits", bits::run),
        ("engine-calls", py_engine::run),
    ];
    for (name, command) in own {
        println!("-- {name}");
        timed(&mut outcome, name, || {
            let result = command(root)?;
            print!("{}", result.report(name));
            Ok(result.passed())
        });
    }
    for note in outcome.notes.drain(..) {
        println!("{note}");
    }
    Ok(outcome)
}

fn timed(outcome: &mut CheckOutcome, name: &str, stage: impl FnOnce() -> Result<bool, String>) {
    let started = Instant::now();
    let verdict = match stage() {
        Ok(true) => "ok",
        Ok(false) => {
            outcome.findings.push(format!("{name} failed"));
            "FAILED"
        }
        Err(why) => {
            outcome.findings.push(format!("{name}: {why}"));
            "FAILED"
        }
    };
    outcome.notes.push(format!(
        "== check/{name}: {verdict}, {:.0} s",
        started.elapsed().as_secs_f64()
    ));
}

fn run_program(root: &Path, stage: &Stage) -> Result<bool, String> {
    if let Some(file) = stage.needs.filter(|file| !root.join(file).is_file()) {
        return Err(format!("{file} is missing"));
    }
    let mut command = Command::new(&stage.program);
    command
        .args(&stage.args)
        .envs(stage.env.iter().copied())
        .current_dir(root);
    let status = command.status().map_err(|error| {
        format!(
            "{} cannot be started ({error}); `make check` makes .venv with it",
            stage.program.display()
        )
    })?;
    Ok(status.success())
}
