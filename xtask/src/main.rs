//! Checks of the project about itself. `cargo xtask` lists the commands.
#![expect(clippy::print_stdout, reason = "a command's report is its output")]

mod bits;
mod check;
mod features;
mod findings;
mod layers;
mod licences;
mod manifests;
mod notices;
mod py_engine;
mod sizes;
mod tree;

use findings::CheckOutcome;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

type Command = fn(&Path) -> Result<CheckOutcome, String>;

/// Name, what it does, the function. Adding a command is one line here.
const COMMANDS: &[(&str, &str, Command)] = &[
    (
        "layers",
        "who may use whom, the walls, and the map in docs/architecture.md",
        layers::run,
    ),
    (
        "sizes",
        "long source files, crate count, wheel size, cold build time",
        sizes::run,
    ),
    (
        "licences",
        "licences, duplicates, git sources, one glam",
        licences::run,
    ),
    (
        "notices",
        "writes the licence texts of everything in the wheel to python/third-party",
        notices::run,
    ),
    (
        "features",
        "tests and extension ask their dependencies for the same features",
        features::run,
    ),
    (
        "bits",
        "no elementary functions of the platform where bits matter",
        bits::run,
    ),
    (
        "engine-calls",
        "every function for Python releases the GIL, maps errors, stops panics and hears signals",
        py_engine::run,
    ),
    (
        "check",
        "all of these with rustfmt, clippy, rustdoc, ruff, mypy and stubtest",
        check::run,
    ),
];

fn main() -> ExitCode {
    let wanted = std::env::args().nth(1).unwrap_or_default();
    let Some((name, _, command)) = COMMANDS.iter().find(|(name, ..)| *name == wanted) else {
        println!("usage: cargo xtask COMMAND");
        for (name, what, _) in COMMANDS {
            println!("  {name:<10} {what}");
        }
        return ExitCode::from(2);
    };
    match command(&root()) {
        Ok(outcome) => {
            print!("{}", outcome.report(name));
            if outcome.passed() {
                ExitCode::SUCCESS
            } else {
                ExitCode::FAILURE
            }
        }
        Err(why) => {
            println!("{name}: cannot be checked: {why}");
            ExitCode::FAILURE
        }
    }
}

/// The repository's root, wherever the command is called from; as cargo says at run time, since checkouts may share a build.
fn root() -> PathBuf {
    let xtask =
        std::env::var_os("CARGO_MANIFEST_DIR").unwrap_or_else(|| env!("CARGO_MANIFEST_DIR").into());
    Path::new(&xtask)
        .parent()
        .expect("xtask lies in the root")
        .to_path_buf()
}
