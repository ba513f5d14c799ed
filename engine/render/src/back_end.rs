//! Rendering back ends: the processor, or a graphics adapter.

use crate::cpu::{CpuRenderer, RenderJob};
use crate::error::RenderError;
use crate::frame::{FrameMut, Preset};
use crate::gpu::{Gpu, GpuRenderer, PendingBatch, VisibilityPath};
use dwell_scene::parallel::Threads;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A rendering back end, as spelled in files and by people: `cpu`; `gpu` for the likely quickest adapter that is not software; or
/// `gpu:NAME` for the first whose name or place on the bus holds `NAME` (`gpu:vulkan/NAME` among those of one interface).
/// `gpu+compute` and `gpu+raster` (or `gpu+raster:NAME`) choose the [`VisibilityPath`]; otherwise the one that a short measurement
/// finds quicker is taken.
///
/// ```
/// use dwell_render::BackEnd;
/// let back_end: BackEnd = "gpu:llvmpipe".parse()?;
/// assert_eq!(back_end, BackEnd::Gpu { name: Some("llvmpipe".into()), path: None });
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
        /// A part of its name; `None` for the likely quickest that is not software.
        name: Option<String>,
        /// The method by which it finds what pixels see first; `None` for the quicker one.
        path: Option<VisibilityPath>,
    },
}

impl std::str::FromStr for BackEnd {
    type Err = RenderError;
    fn from_str(text: &str) -> Result<Self, RenderError> {
        if text == "cpu" {
            return Ok(Self::Cpu);
        }
        let (head, name) = match text.split_once(':') {
            None => (text, None),
            Some((head, name)) => (head, Some(name.trim().to_owned())),
        };
        let (kind, path) = match head.split_once('+') {
            None => (head, None),
            Some((kind, word)) => (kind, Some(word)),
        };
        let found = path.map(|word| {
            VisibilityPath::ALL
                .into_iter()
                .find(|path| path.name() == word)
        });
        match (kind, found) {
            ("gpu", None | Some(Some(_))) if name.as_deref() != Some("") => Ok(Self::Gpu {
                name,
                path: found.flatten(),
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
            Self::Gpu { name, path } => {
                f.write_str("gpu")?;
                if let Some(path) = path {
                    write!(f, "+{}", path.name())?;
                }
                name.as_ref().map_or(Ok(()), |name| write!(f, ":{name}"))
            }
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
    /// A back end for the house of `tables`. An adapter is opened once in a process and shared.
    ///
    /// # Errors
    /// [`RenderError::NoAdapter`], [`RenderError::TooLarge`] or [`RenderError::Driver`] for a graphics adapter.
    pub fn new(back_end: &BackEnd, tables: Arc<CpuRenderer>) -> Result<Self, RenderError> {
        Ok(match back_end {
            BackEnd::Cpu => Self::Cpu(tables),
            BackEnd::Gpu { name, path } => {
                let gpu = Gpu::shared(name.as_deref())?;
                let path = match path {
                    Some(path) => *path,
                    None => gpu.visibility_path_speeds(&tables)?.best(),
                };
                Self::Gpu(Box::new(GpuRenderer::new(gpu, tables, path)?))
            }
        })
    }

    /// Renders views of any worlds over the house.
    ///
    /// # Errors
    /// As [`CpuRenderer::render_batch`] and [`GpuRenderer::render_batch`].
    pub fn render_batch(
        &self,
        jobs: &mut [RenderJob<'_>],
        threads: Threads,
    ) -> Result<(), RenderError> {
        match self {
            Self::Cpu(cpu) => cpu.render_batch(jobs, threads),
            Self::Gpu(gpu) => gpu.render_batch(jobs, threads),
        }
    }

    /// Returns whether [`Self::submit`] takes views of a preset: an adapter does, of those that it has.
    pub fn can_submit(&self, preset: Preset) -> bool {
        matches!(self, Self::Gpu(_)) && preset != Preset::Full
    }

    /// Starts a batch that is rendered while the caller goes on; see [`GpuRenderer::submit`]. `None` if
    /// [`Self::can_submit`] refuses a view.
    ///
    /// # Errors
    /// As [`GpuRenderer::submit`].
    pub fn submit(
        &self,
        jobs: &[RenderJob<'_>],
        threads: Threads,
    ) -> Result<Option<PendingBatch>, RenderError> {
        match self {
            Self::Gpu(gpu) if jobs.iter().all(|job| self.can_submit(job.view.preset)) => {
                gpu.submit(jobs, threads).map(Some)
            }
            _ => Ok(None),
        }
    }

    /// Waits for a batch that [`Self::submit`] has started, and writes its images; see [`GpuRenderer::collect`].
    ///
    /// # Errors
    /// As [`GpuRenderer::collect`]; [`RenderError::OtherRenderer`] for a batch of another renderer.
    pub fn collect(
        &self,
        submitted: PendingBatch,
        frames: &mut [FrameMut<'_>],
        threads: Threads,
    ) -> Result<(), RenderError> {
        match self {
            Self::Gpu(gpu) => gpu.collect(submitted, frames, threads),
            Self::Cpu(_) => Err(RenderError::OtherRenderer),
        }
    }

    /// Returns the back end in words: `cpu`, or the adapter and its path.
    pub fn description(&self) -> String {
        match self {
            Self::Cpu(_) => "cpu".to_owned(),
            Self::Gpu(gpu) => format!("{}, {}", gpu.gpu().adapter(), gpu.visibility_path().name()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn back_ends_survive_text_and_others_are_refused() {
        for text in [
            "cpu",
            "gpu",
            "gpu:H200",
            "gpu+raster",
            "gpu+compute:llvmpipe (x: y)",
        ] {
            let back_end: BackEnd = text.parse().unwrap();
            assert_eq!(back_end.to_string(), text);
            let json = serde_json::to_string(&back_end).unwrap();
            assert_eq!(serde_json::from_str::<BackEnd>(&json).unwrap(), back_end);
        }
        for text in [
            "", "CPU", "cpu:0", "gpu:", "gpu+", "gpu+rays", "cuda", "+raster",
        ] {
            let error = text.parse::<BackEnd>().unwrap_err().to_string();
            assert!(error.contains(&format!("{text:?}")), "{error}");
        }
    }
}
