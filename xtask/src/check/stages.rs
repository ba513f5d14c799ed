//! The programs that `check` calls.

use std::path::{Path, PathBuf};

/// One program with its arguments.
pub(crate) struct Stage {
    pub name: &'static str,
    pub program: PathBuf,
    pub args: Vec<String>,
    pub env: Vec<(&'static str, &'static str)>,
    /// A file without which the program would have nothing to check.
    pub needs: Option<&'static str>,
}

const CONFIG: &str = "python/pyproject.toml";
const STUB: &str = "python/dwell/_native.pyi";
/// Items that stubtest may overlook, each line with its reason; may be absent.
const ALLOWLIST: &str = "python/stubtest-allowlist.txt";

/// In order; the cheapest first. Python's tools are those of `.venv`.
pub(crate) fn all(root: &Path) -> Vec<Stage> {
    let locked = if std::env::var("CI").as_deref() == Ok("true") {
        "--locked"
    } else {
        "--quiet"
    };
    let mut stubtest = format!("-m mypy.stubtest dwell._native --mypy-config-file {CONFIG}");
    if root.join(ALLOWLIST).is_file() {
        stubtest = format!("{stubtest} --allowlist {ALLOWLIST}");
    }
    let mut stages = vec![
        cargo("rustfmt", "fmt --all --check"),
        cargo(
            "clippy",
            &format!("clippy {locked} --workspace --all-targets --all-features -- -D warnings"),
        ),
        cargo("rustdoc", &format!("doc {locked} --workspace --no-deps")),
        python(root, "ruff", &format!("-m ruff check --config {CONFIG} .")),
        python(
            root,
            "ruff format",
            &format!("-m ruff format --check --config {CONFIG} ."),
        ),
        python(
            root,
            "mypy",
            &format!("-m mypy --config-file {CONFIG} python/dwell"),
        ),
        python(root, "stubtest", &stubtest),
        python(root, "generated", "docs/write_generated.py --check"),
    ];
    for stage in &mut stages {
        match stage.name {
            "rustdoc" => stage.env.push(("RUSTDOCFLAGS", "-D warnings")),
            "stubtest" => {
                stage.env.push(("MYPYPATH", "python"));
                stage.needs = Some(STUB);
            }
            _ => {}
        }
    }
    stages
}

fn cargo(name: &'static str, args: &str) -> Stage {
    stage(
        name,
        std::env::var_os("CARGO").map_or_else(|| "cargo".into(), PathBuf::from),
        args,
    )
}

fn python(root: &Path, name: &'static str, args: &str) -> Stage {
    stage(name, root.join(".venv/bin/python"), args)
}

fn stage(name: &'static str, program: PathBuf, args: &str) -> Stage {
    Stage {
        name,
        program,
        args: args.split_whitespace().map(str::to_owned).collect(),
        env: Vec::new(),
        needs: None,
    }
}
