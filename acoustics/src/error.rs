//! Errors of the acoustics engine.

/// The reason why an acoustic call was refused.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AcousticsError {
    /// A number of a configuration is out of range.
    #[error("{at}: {field} is {found}; allowed are {allowed}")]
    Range {
        /// Name of the number.
        at: &'static str,
        /// The field.
        field: &'static str,
        /// The value found.
        found: String,
        /// The allowed values.
        allowed: &'static str,
    },
    /// A source or receiver whose position is not finite.
    #[error("{what} stands at {found:?}; allowed are coordinates up to 1,000,000 m")]
    Position {
        /// Source or receiver.
        what: &'static str,
        /// The coordinates, m.
        found: [f32; 3],
    },
    /// A source, receiver or microphone whose rotation is none.
    #[error("{what} is turned by {found:?}; allowed are quaternions of length 1")]
    Rotation {
        /// Source, receiver or microphone.
        what: &'static str,
        /// The quaternion, x, y, z, w.
        found: [f32; 4],
    },
    /// Rays of another house than the scene's.
    #[error("the rays belong to house {rays:?}, the acoustic scene to {scene:?}")]
    OtherHouse {
        /// The house of the rays.
        rays: String,
        /// The house of the scene.
        scene: String,
    },
    /// A signal that does not exist.
    #[error("no signal {name:?}; there are {known:?}")]
    UnknownSignal {
        /// The name given.
        name: String,
        /// The names that exist.
        known: Vec<&'static str>,
    },
    /// A sound file that cannot be a source.
    #[error("{name}: {what}: found {found}; allowed: {allowed}")]
    SoundFile {
        /// The file.
        name: String,
        /// The fault.
        what: String,
        /// The value found.
        found: String,
        /// The allowed values.
        allowed: String,
    },
    /// An invalid measurement of a head.
    #[error("the head's responses: {0}")]
    Head(String),
    /// A file that cannot be read as HDF5.
    #[error("{0}")]
    Hdf5(String),
    /// A receiver's head that is unknown to the scene.
    #[error("the receiver wears head {id}, which the scene does not know: add it first")]
    UnknownHead {
        /// Its number.
        id: u64,
    },
    /// A buffer of the wrong length.
    #[error("{at}: expected {expected} samples, found {found}")]
    Buffer {
        /// The buffer.
        at: &'static str,
        /// The length it must have.
        expected: usize,
        /// The length it has.
        found: usize,
    },
    /// Bytes that are no snapshot of this stream.
    #[error("snapshot of a sound stream: {0}")]
    Snapshot(String),
}

/// Refuses `value` unless it lies in `low..=high`.
pub(crate) fn check_range(
    at: &'static str,
    field: &'static str,
    value: f64,
    (low, high): (f64, f64),
    allowed: &'static str,
) -> Result<(), AcousticsError> {
    if (low..=high).contains(&value) {
        return Ok(());
    }
    let found = value.to_string();
    Err(AcousticsError::Range {
        at,
        field,
        found,
        allowed,
    })
}

/// Refuses a point that is not finite.
pub(crate) fn check_finite(what: &'static str, point: glam::Vec3) -> Result<(), AcousticsError> {
    if point.is_finite() && point.abs().max_element() <= 1e6 {
        return Ok(());
    }
    Err(AcousticsError::Position {
        what,
        found: point.to_array(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_say_what_was_found_and_what_is_allowed() {
        let message = check_range("air", "humidity_pct", 120.0, (0.0, 100.0), "0 to 100")
            .unwrap_err()
            .to_string();
        assert_eq!(message, "air: humidity_pct is 120; allowed are 0 to 100");
        let message = check_finite("the source", glam::Vec3::new(f32::NAN, 0.0, 1.0))
            .unwrap_err()
            .to_string();
        assert_eq!(
            message,
            "the source stands at [NaN, 0.0, 1.0]; allowed are coordinates up to 1,000,000 m"
        );
        for (x, is_allowed) in [(1e6, true), (-1e6, true), (1e6_f32.next_up(), false)] {
            let told = check_finite("the source", glam::Vec3::new(x, 0.0, 1.0));
            assert_eq!(told.is_ok(), is_allowed, "{x}");
        }
    }
}
