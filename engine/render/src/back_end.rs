//! Who renders: the processor, or a graphics adapter.

use crate::cpu::{CpuRenderer, Job};
use crate::error::RenderError;
use crate::gpu::{Gpu, GpuRenderer};
use dwell_scene::parallel::Threads;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Who renders, as files and people say it: `cpu`; `gpu` for the likely quickest adapter that is not software; or
/// `gpu:NAME` for the first whose name holds `NAME`.
///
/// ```
/// use dwell_render::BackEnd;
/// let back_end: BackEnd = "gpu:llvmpipe".parse()?;
/// assert_eq!(back_end, BackEnd::Gpu { name: Some("llvmpipe".into()) });
/// assert_eq!(back_end.to_string(), "gpu:llvmpipe");
/// assert!("opengl".parse::<BackEnd>().is_err());
/// # Ok::<(), dwell_render::RenderError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum BackEnd {
    /// The processor: always there, the same bits everywhere.
    #[default]
    Cpu,
    /// A graphics adapter.
    Gpu {
        /// What its name holds; nothing for the likely quickest that is not software.
        name: Option<String>,
    },
}

impl std::str::FromStr for BackEnd {
    type Err = RenderError;
    fn from_str(text: &str) -> Result<Self, RenderError> {
        match text.split_once(':') {
            None if text == "cpu" => Ok(Self::Cpu),
            None if text == "gpu" => Ok(Self::Gpu { name: None }),
            Some(("gpu", name)) if !name.trim().is_empty() => Ok(Self::Gpu {
                name: Some(name.trim().to_owned()),
            }),
            _ => Err(RenderError::BackEnd {
                found: text.to_owned(),
            }),
        }
    }
}

impl TryFrom<String> for BackEnd {
    type Error = RenderError;
    fn try_from(text: String) -> Result<Self, RenderError> {
        text.parse()
    }
}

impl std::fmt::Display for BackEnd {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Cpu => f.write_str("cpu"),
            Self::Gpu { name: None } => f.write_str("gpu"),
            Self::Gpu { name: Some(name) } => write!(f, "gpu:{name}"),
        }
    }
}

impl From<BackEnd> for String {
    fn from(back_end: BackEnd) -> Self {
        back_end.to_string()
    }
}

/// A back end with the tables of a house.
#[derive(Debug)]
pub enum Renderer {
    /// By the processor.
    Cpu(Arc<CpuRenderer>),
    /// By a graphics adapter.
    Gpu(Box<GpuRenderer>),
}

impl Renderer {
    /// A back end for the house of `tables`. An adapter is opened once in a process, whoever asks for it.
    ///
    /// # Errors
    /// [`RenderError::NoAdapter`], [`RenderError::TooLarge`] or [`RenderError::Driver`] for a graphics adapter.
    pub fn new(back_end: &BackEnd, tables: Arc<CpuRenderer>) -> Result<Self, RenderError> {
        Ok(match back_end {
            BackEnd::Cpu => Self::Cpu(tables),
            BackEnd::Gpu { name } => {
                let gpu = Gpu::shared(name.as_deref())?;
                Self::Gpu(Box::new(GpuRenderer::new(gpu, tables)?))
            }
        })
    }

    /// Renders views of any worlds over the house.
    ///
    /// # Errors
    /// As [`CpuRenderer::render_batch`] and [`GpuRenderer::render_batch`].
    pub fn render_batch(&self, jobs: &mut [Job<'_>], threads: Threads) -> Result<(), RenderError> {
        match self {
            Self::Cpu(cpu) => cpu.render_batch(jobs, threads),
            Self::Gpu(gpu) => gpu.render_batch(jobs, threads),
        }
    }

    /// Who renders, in words: `cpu`, or the adapter.
    pub fn describe(&self) -> String {
        match self {
            Self::Cpu(_) => "cpu".to_owned(),
            Self::Gpu(gpu) => gpu.gpu().adapter().to_string(),
        }
    }
}
