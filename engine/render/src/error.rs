//! Errors of requests for pictures.

/// A camera, frame or scene that does not fit.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// A number of a camera outside its range.
    #[error("camera: {field} is {found}; allowed is {allowed}")]
    Camera {
        /// The field's name.
        field: &'static str,
        /// The found value.
        found: String,
        /// The allowed values.
        allowed: &'static str,
    },
    /// A view whose pose is not finite or not a rotation.
    #[error(
        "view {view}: world_from_camera is {found}; allowed are finite positions and unit quaternions"
    )]
    Pose {
        /// The position in the list of views or jobs.
        view: usize,
        /// The found value.
        found: String,
    },
    /// A buffer of the wrong length.
    #[error(
        "frame {view}: {channel} has {found} elements; {expected} are needed (height x width x channels)"
    )]
    Length {
        /// The position in the list of frames or jobs.
        view: usize,
        /// The channel's name.
        channel: &'static str,
        /// Its length.
        found: usize,
        /// The length it must have.
        expected: usize,
    },
    /// Not one frame for each view.
    #[error("{frames} frames for {views} views; each view needs one")]
    Count {
        /// Views found.
        views: usize,
        /// Frames found.
        frames: usize,
    },
    /// A frame with other images than were announced when its batch was submitted.
    #[error(
        "frame {view}: {channel} {now} wanted now, unlike when the batch was submitted; batches are collected into frames of the \
         same images",
        now = if *.was_wanted { "is not" } else { "is" }
    )]
    OtherImages {
        /// The position in the list of frames.
        view: usize,
        /// The channel's name.
        channel: &'static str,
        /// True if it was announced.
        was_wanted: bool,
    },
    /// A batch that another renderer was given.
    #[error("this batch was submitted to another renderer; the one that has it collects it")]
    OtherRenderer,
    /// A scene over another house than the renderer's.
    #[error("view {view}: the scene is over another house than this renderer was made for")]
    OtherHouse {
        /// The position in the list of views or jobs.
        view: usize,
    },
    /// A storey that the house does not have.
    #[error("no storey {found}; the house has {count}")]
    Level {
        /// The requested level.
        found: usize,
        /// The number of levels.
        count: usize,
    },
    /// A back end that does not exist.
    #[error(
        "no back end {found:?}; there are cpu, gpu and gpu:NAME (with a part of an adapter's name), and gpu+compute and gpu+raster"
    )]
    BackEnd {
        /// The requested back end.
        found: String,
    },
    /// No graphics adapter that may be used.
    #[error(
        "no graphics adapter {wanted}; found: {found}. Software adapters are taken by name only; `cpu` needs none"
    )]
    NoAdapter {
        /// The requested adapter.
        wanted: String,
        /// The available adapters.
        found: String,
    },
    /// Something that does not fit into an adapter's memory or limits.
    #[error(
        "{what} needs {needed} {unit}; {adapter} allows {allowed}. The `cpu` back end has no such limit"
    )]
    TooLarge {
        /// The picture that is too large, with the house or batch that it belongs to.
        what: String,
        /// Its size.
        needed: u64,
        /// The unit of the sizes.
        unit: &'static str,
        /// The largest size.
        allowed: u64,
        /// The adapter.
        adapter: String,
    },
    /// Images of a house whose memory the system refuses.
    #[error(
        "the images of the house: the {:.1} MiB that a renderer takes for them are not free; take smaller images",
        *.needed as f64 / f64::from(1 << 20)
    )]
    Memory {
        /// The memory, bytes.
        needed: u64,
    },
    /// A view that only the `cpu` back end renders.
    #[error(
        "view {view}: its preset is one of the `cpu` back end; a batch under way allows flat and lit"
    )]
    OnlyCpu {
        /// The position in the list of jobs.
        view: usize,
    },
    /// An adapter, or an interface, that another process opened.
    #[error(
        "{what} was opened before this process was forked, and drivers do not survive that; {instead}"
    )]
    Forked {
        /// The adapter or the interface.
        what: String,
        /// The remedy.
        instead: &'static str,
    },
    /// A graphics driver that failed.
    #[error("{adapter} failed {doing}: {message}")]
    Driver {
        /// The adapter.
        adapter: String,
        /// The operation that failed.
        doing: &'static str,
        /// The driver's message.
        message: String,
    },
    /// A law of cameras on an agent that does not exist.
    #[error("law {law}: target {found:?} is no agent; there are {agents}, counted from 0")]
    LawTarget {
        /// The law's id.
        law: String,
        /// The target that it names.
        found: String,
        /// The number of agents.
        agents: usize,
    },
}
