//! Numbers and images of a GLB by position, for the native form.

use ::gltf::json::{Index, Root};
use dwell_scene::Texture;

use super::accessor;
use super::buffers::Buffers;
use crate::build::decode;
use crate::error::HousesError;
use crate::report::{At, Report};

/// A parsed GLB whose numbers and images are asked for one by one.
pub(crate) struct Geometry<'a> {
    json: Root,
    buffers: Buffers<'a>,
}

impl<'a> Geometry<'a> {
    /// Parses the container; `bytes` hold everything, nothing beside them is read.
    ///
    /// # Errors
    /// [`HousesError::Syntax`] when the bytes are no GLB, [`HousesError::TooLarge`] beyond 2 GiB.
    pub(crate) fn read(bytes: &'a [u8], name: &str) -> Result<Self, HousesError> {
        let at = At::file(name);
        let syntax = |message: String| HousesError::Syntax {
            at: at.clone(),
            message,
        };
        let (json, blob) = super::container::split(bytes).map_err(syntax)?;
        let buffers = Buffers::of_blob(&json, blob, &at, &mut Report::new())?;
        Ok(Self { json, buffers })
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
        let view = image
            .buffer_view
            .and_then(|view| self.json.buffer_views.get(view.value()))
            .ok_or("it has no bytes")?;
        let bytes = self
            .buffers
            .view(view)
            .ok_or("its bytes lie beyond the buffer")?;
        let texture = decode(image.name.as_deref().unwrap_or(""), bytes)?;
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
