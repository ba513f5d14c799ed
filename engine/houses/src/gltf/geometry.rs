//! Numbers and images of a GLB by position, for the native form.

use std::borrow::Cow;

use ::gltf::json::{Index, Root};
use dwell_scene::Texture;

use super::accessor;
use super::buffers::{Buffers, read_library_file};
use crate::data_root::DataRoot;
use crate::error::HousesError;
use crate::import::decode;
use crate::limits::MAX_IMAGE_BYTES;
use crate::report::{FileLocation, LoadReport};

/// A parsed GLB whose numbers and images are read one by one.
pub(crate) struct ParsedGlb<'a> {
    json: Root,
    buffers: Buffers<'a>,
    library: &'a DataRoot,
}

impl<'a> ParsedGlb<'a> {
    /// Parses the container; bytes that it does not hold are in `library`, in files named by their content.
    ///
    /// # Errors
    /// [`HousesError::Syntax`] when the bytes are no GLB or a file of the library is not what its name says,
    /// [`HousesError::TooLarge`] beyond 2 GiB.
    pub(crate) fn read(
        bytes: &'a [u8],
        name: &str,
        library: &'a DataRoot,
    ) -> Result<Self, HousesError> {
        let at = FileLocation::file(name);
        let syntax = |message: String| HousesError::Syntax {
            at: at.clone(),
            message,
        };
        let (json, blob) = super::container::split_glb(bytes).map_err(syntax)?;
        let mut report = LoadReport::new();
        let buffers = Buffers::load_with_library(&json, blob, library, &at, &mut report)?;
        match report.warnings().first() {
            Some(warning) => Err(syntax(warning.kind.to_string())),
            None => Ok(Self {
                json,
                buffers,
                library,
            }),
        }
    }

    /// Returns the number of elements that an accessor states; 0 for one that does not exist.
    pub(crate) fn count(&self, accessor: usize) -> usize {
        let accessor = self.json.accessors.get(accessor);
        let count = accessor.map_or(0, |accessor| accessor.count.0);
        usize::try_from(count).unwrap_or(usize::MAX)
    }

    /// The rows of an accessor.
    ///
    /// # Errors
    /// A sentence when it does not hold such rows.
    pub(crate) fn floats<const N: usize>(&self, accessor: usize) -> Result<Vec<[f32; N]>, String> {
        accessor::floats(&self.json, &self.buffers, index(accessor)?)
    }

    /// The whole numbers of an accessor.
    ///
    /// # Errors
    /// A sentence when it does not hold such numbers.
    pub(crate) fn indices(&self, accessor: usize) -> Result<Vec<u32>, String> {
        accessor::indices(&self.json, &self.buffers, index(accessor)?)
    }

    /// An image, whose size must be `size`.
    ///
    /// # Errors
    /// A sentence when there is no such image.
    pub(crate) fn texture(&self, image: usize, size: [u32; 2]) -> Result<Texture, String> {
        let image = self.json.images.get(image).ok_or("no such image")?;
        let bytes = if let Some(uri) = &image.uri {
            let read = read_library_file(uri, self.library, MAX_IMAGE_BYTES);
            Cow::Owned(read.map_err(|damage| damage.to_string())?)
        } else {
            let view = image
                .buffer_view
                .and_then(|view| self.json.buffer_views.get(view.value()))
                .ok_or("it has no bytes")?;
            let bytes = self.buffers.view(view);
            Cow::Borrowed(bytes.ok_or("its bytes lie beyond the buffer")?)
        };
        let texture = decode(image.name.as_deref().unwrap_or(""), &bytes)?;
        if [texture.width, texture.height] != size {
            return Err(format!(
                "{} by {} pixels, expected {} by {}",
                texture.width, texture.height, size[0], size[1]
            ));
        }
        Ok(texture)
    }
}

fn index<T>(position: usize) -> Result<Index<T>, String> {
    u32::try_from(position)
        .map(Index::new)
        .map_err(|_| "accessor number out of range".to_owned())
}
