//! The programs that `check` calls.

use std::path::{Path, PathBuf};

/// One program with its arguments.
pub(crate) struct Stage {
    pub name: &'static str,
    pub program: PathBuf,
    pub args: Vec<&'static str>,
    pub env: Vec<(&'static str, &'static str)>,
}

/// In order; the cheapest first. Python's tools are those of `.venv`.
pub(crate) fn all(root: &Path) -> Vec<Stage> {
    let cargo = || std::env::var_os("CARGO").map_or_else(|| "cargo".into(), PathBuf::from);
    let locked = if std::env::var("CI").as_deref() == Ok("true") {
        "--locked"
    } else {
        "--quiet"
    };
    let python = |name, args: &[&'static str]| Stage {
        name,
        program: root.join(".venv/bin/python"),
        args: args.to_vec(),
        env: vec![("MYPYPATH", "python")],
    };
    let rust = |name, args: &[&'static str], env: &[(&'static str, &'static str)]| Stage {
        name,
        program: cargo(),
        args: args.to_vec(),
        env: env.to_vec(),
    };
    vec![
        rust("rustfmt", &["fmt", "--all", "--check"], &[]),
        rust(
            "clippy",
            &[
                "clippy",
                locked,
                "--workspace",
                "--all-targets",
                "--",
                "-D",
                "warnings",
            ],
            &[],
        ),
        rust(
            "rustdoc",
            &["doc", locked, "--workspace", "--no-deps"],
            &[("RUSTDOCFLAGS", "-D warnings")],
        ),
        python(
            "ruff",
            &[
                "-m",
                "ruff",
                "check",
                "--config",
                "python/pyproject.toml",
                ".",
            ],
        ),
        python(
            "ruff format",
            &[
                "-m",
                "ruff",
                "format",
                "--check",
                "--config",
                "python/pyproject.toml",
                ".",
            ],
        ),
        python(
            "mypy",
            &[
                "-m",
                "mypy",
                "--config-file",
                "python/pyproject.toml",
                "python/dwell",
            ],
        ),
        python(
            "stubtest",
            &[
                "-m",
                "mypy.stubtest",
                "dwell._native",
                "--mypy-config-file",
                "python/pyproject.toml",
            ],
        ),
    ]
}
