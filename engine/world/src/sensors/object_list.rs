//! Sensors that list the contents of a picture.

use super::image::ImageContext;
use dwell_render::{VisibleObject, visible_objects};
use dwell_scene::Entity;

/// Writes a row for every object and agent in the picture, by id; of more than fit those with most pixels. Unused rows are 0.
pub(super) fn write_object_rows<T: Copy + Default, const N: usize>(
    look: &ImageContext<'_>,
    out: &mut [T],
    row: impl Fn(&VisibleObject) -> [T; N],
) {
    let house = look.world.house();
    let width = look.camera.width();
    let mut things = visible_objects(&look.frame.instance, width);
    things.retain(|thing| {
        matches!(
            house.entity(thing.entity),
            Some(Entity::Object(_) | Entity::Agent(_))
        )
    });
    let room = out.len() / N;
    if things.len() > room {
        things.sort_by_key(|thing| (std::cmp::Reverse(thing.pixels), thing.entity));
        things.truncate(room);
        things.sort_by_key(|thing| thing.entity);
    }
    out.fill(T::default());
    for (out, thing) in out.chunks_exact_mut(N).zip(&things) {
        out.copy_from_slice(&row(thing));
    }
}
