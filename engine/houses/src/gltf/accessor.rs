//! Numbers out of buffers. Every offset comes from the file, so all arithmetic on them is checked.

use ::gltf::json::accessor::{Accessor, ComponentType, Type};
use ::gltf::json::validation::Checked;
use ::gltf::json::{Index, Root};

use super::buffers::Buffers;

/// The elements of an accessor as `N` floats each; integers are normalized when the accessor says so.
///
/// # Errors
/// A sentence when the accessor does not hold such elements.
pub(super) fn floats<const N: usize>(
    json: &Root,
    buffers: &Buffers<'_>,
    index: Index<Accessor>,
) -> Result<Vec<[f32; N]>, String> {
    let accessor = json
        .accessors
        .get(index.value())
        .ok_or("no such accessor")?;
    elements(json, buffers, accessor, N)?
        .map(|element| {
            let mut values = [0.0; N];
            for (value, bytes) in values
                .iter_mut()
                .zip(element.bytes.chunks_exact(element.component.size()))
            {
                *value = element.component_value(bytes, accessor.normalized);
            }
            Ok(values)
        })
        .collect()
}

/// The elements of an accessor as whole numbers.
///
/// # Errors
/// A sentence when the accessor does not hold such elements.
pub(super) fn indices(
    json: &Root,
    buffers: &Buffers<'_>,
    index: Index<Accessor>,
) -> Result<Vec<u32>, String> {
    let accessor = json
        .accessors
        .get(index.value())
        .ok_or("no such accessor")?;
    let component = component(accessor)?;
    if !matches!(
        component,
        ComponentType::U8 | ComponentType::U16 | ComponentType::U32
    ) {
        return Err("indices that are not whole numbers from 0".to_owned());
    }
    let whole = |element: ElementBytes<'_>| {
        element
            .bytes
            .iter()
            .rev()
            .fold(0_u32, |value, byte| value << 8 | u32::from(*byte))
    };
    Ok(elements(json, buffers, accessor, 1)?.map(whole).collect())
}

/// One element's bytes.
struct ElementBytes<'a> {
    bytes: &'a [u8],
    component: ComponentType,
}

impl ElementBytes<'_> {
    fn component_value(&self, bytes: &[u8], normalized: bool) -> f32 {
        let pair = || [bytes[0], bytes[1]];
        let (value, largest) = match self.component {
            ComponentType::I8 => (f32::from(bytes[0] as i8), 127.0),
            ComponentType::U8 => (f32::from(bytes[0]), 255.0),
            ComponentType::I16 => (f32::from(i16::from_le_bytes(pair())), 32_767.0),
            ComponentType::U16 => (f32::from(u16::from_le_bytes(pair())), 65_535.0),
            ComponentType::U32 => (
                u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]) as f32,
                u32::MAX as f32,
            ),
            ComponentType::F32 => {
                return f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
            }
        };
        if normalized {
            (value / largest).max(-1.0)
        } else {
            value
        }
    }
}

fn component(accessor: &Accessor) -> Result<ComponentType, String> {
    match accessor.component_type {
        Checked::Valid(component) => Ok(component.0),
        Checked::Invalid => Err("unknown component type".to_owned()),
    }
}

fn elements<'a>(
    json: &Root,
    buffers: &'a Buffers<'_>,
    accessor: &Accessor,
    components: usize,
) -> Result<impl Iterator<Item = ElementBytes<'a>> + use<'a>, String> {
    let component = component(accessor)?;
    let found = match accessor.type_ {
        Checked::Valid(Type::Scalar) => 1,
        Checked::Valid(Type::Vec2) => 2,
        Checked::Valid(Type::Vec3) => 3,
        Checked::Valid(Type::Vec4) => 4,
        _ => 0,
    };
    if found != components {
        return Err(format!(
            "elements of {found} numbers, expected {components}"
        ));
    }
    if accessor.sparse.is_some() {
        return Err("sparse accessors are not read".to_owned());
    }
    let view = accessor
        .buffer_view
        .and_then(|view| json.buffer_views.get(view.value()))
        .ok_or("no buffer view")?;
    let bytes = buffers
        .view(view)
        .ok_or("its view reaches beyond the buffer")?;
    let size = component.size() * components;
    let stride = view.byte_stride.map_or(size, |stride| stride.0);
    let start = usize::try_from(accessor.byte_offset.map_or(0, |offset| offset.0))
        .map_err(|_| "offset out of range")?;
    let count = usize::try_from(accessor.count.0).map_err(|_| "count out of range")?;
    let fits = |last: usize| {
        let end = last
            .checked_mul(stride)?
            .checked_add(start)?
            .checked_add(size)?;
        (end <= bytes.len() && stride >= size).then_some(())
    };
    if count > 0 && fits(count - 1).is_none() {
        return Err(format!("{count} elements do not fit {} bytes", bytes.len()));
    }
    // The check above holds every slice inside the view.
    Ok((0..count).map(move |k| ElementBytes {
        bytes: &bytes[start + k * stride..start + k * stride + size],
        component,
    }))
}
