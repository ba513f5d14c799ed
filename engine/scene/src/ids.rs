//! Typed indices and the integer ids that sensors report.
//!
//! Inside the engine every table of a [`House`](crate::House) has its own index type, so that a room can never be
//! looked up with an object's number. Outside (images, observations, files) there is one id space, [`EntityId`].

use serde::{Deserialize, Serialize};
use std::fmt;
use std::marker::PhantomData;
use std::ops::{Index, IndexMut};

/// A typed index into one table.
pub trait Id: Copy + Eq + Ord + fmt::Debug {
    /// The position in the table.
    fn index(self) -> usize;
    /// The id of position `index`.
    fn from_index(index: usize) -> Self;
}

macro_rules! ids {
    ($($(#[$doc:meta])* $name:ident),* $(,)?) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
        #[serde(transparent)]
        pub struct $name(pub u32);

        impl Id for $name {
            fn index(self) -> usize {
                self.0 as usize
            }
            fn from_index(index: usize) -> Self {
                Self(u32::try_from(index).expect("tables are capped far below 2^32 entries when a file is read"))
            }
        }
    )*};
}

ids! {
    /// A storey.
    LevelId,
    /// A room.
    RoomId,
    /// A structure piece: one wall, floor or ceiling.
    StructureId,
    /// An object.
    ObjectId,
    /// A rigid part of an object.
    PartId,
    /// A joint between two parts, or between a part and the house.
    JointId,
    /// A triangle mesh.
    MeshId,
    /// A material.
    MaterialId,
    /// A texture image.
    TextureId,
    /// A sound file that the house carries.
    SoundFileId,
    /// An agent of a world.
    AgentId,
}

/// The id of a thing as sensors and files give it: 0 void, then structure pieces, objects, agents, in file order.
///
/// A part carries its object's id. Never a colour, never a hash.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize,
)]
#[serde(transparent)]
pub struct EntityId(pub i32);

impl EntityId {
    /// Nothing: the id seen by a ray that leaves the house.
    pub const VOID: Self = Self(0);
}

/// The thing that an [`EntityId`] names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Entity {
    /// Nothing.
    Void,
    /// A wall, floor or ceiling piece.
    Structure(StructureId),
    /// An object (any of its parts).
    Object(ObjectId),
    /// An agent.
    Agent(AgentId),
}

/// A `Vec` indexed by a typed id.
#[derive(Clone, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct IdVec<I, T> {
    items: Vec<T>,
    #[serde(skip)]
    id: PhantomData<fn(I) -> I>,
}

impl<I: Id, T> IdVec<I, T> {
    /// An empty table.
    pub const fn new() -> Self {
        Self {
            items: Vec::new(),
            id: PhantomData,
        }
    }

    /// Appends an item and returns its id.
    pub fn push(&mut self, item: T) -> I {
        let id = I::from_index(self.items.len());
        self.items.push(item);
        id
    }

    /// Removes the items from index `count` on.
    pub fn truncate(&mut self, count: usize) {
        self.items.truncate(count);
    }

    /// The number of items.
    pub fn len(&self) -> usize {
        self.items.len()
    }

    /// Returns whether the table is empty.
    pub fn is_empty(&self) -> bool {
        self.items.is_empty()
    }

    /// The item of `id`, if there is one.
    pub fn get(&self, id: I) -> Option<&T> {
        self.items.get(id.index())
    }

    /// The item of `id`, if there is one.
    pub fn get_mut(&mut self, id: I) -> Option<&mut T> {
        self.items.get_mut(id.index())
    }

    /// All ids in order.
    pub fn ids(&self) -> impl DoubleEndedIterator<Item = I> + ExactSizeIterator + use<I, T> {
        (0..self.items.len()).map(I::from_index)
    }

    /// All items with their ids, in order.
    pub fn iter_ids(&self) -> impl DoubleEndedIterator<Item = (I, &T)> + ExactSizeIterator {
        self.items
            .iter()
            .enumerate()
            .map(|(index, item)| (I::from_index(index), item))
    }

    /// All items in order.
    pub fn iter(&self) -> std::slice::Iter<'_, T> {
        self.items.iter()
    }

    /// All items in order.
    pub fn iter_mut(&mut self) -> std::slice::IterMut<'_, T> {
        self.items.iter_mut()
    }

    /// The items as a slice.
    pub fn as_slice(&self) -> &[T] {
        &self.items
    }

    /// The items as a slice.
    pub fn as_mut_slice(&mut self) -> &mut [T] {
        &mut self.items
    }
}

impl<I: Id, T: Clone> IdVec<I, T> {
    /// `len` copies of `item`.
    pub fn filled(item: T, len: usize) -> Self {
        Self {
            items: vec![item; len],
            id: PhantomData,
        }
    }
}

impl<I: Id, T> Default for IdVec<I, T> {
    fn default() -> Self {
        Self::new()
    }
}

impl<I, T: fmt::Debug> fmt::Debug for IdVec<I, T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.items.fmt(f)
    }
}

impl<I: Id, T> FromIterator<T> for IdVec<I, T> {
    fn from_iter<A: IntoIterator<Item = T>>(items: A) -> Self {
        Self {
            items: items.into_iter().collect(),
            id: PhantomData,
        }
    }
}

impl<I: Id, T> From<Vec<T>> for IdVec<I, T> {
    fn from(items: Vec<T>) -> Self {
        Self {
            items,
            id: PhantomData,
        }
    }
}

impl<'a, I: Id, T> IntoIterator for &'a IdVec<I, T> {
    type Item = &'a T;
    type IntoIter = std::slice::Iter<'a, T>;
    fn into_iter(self) -> Self::IntoIter {
        self.items.iter()
    }
}

impl<'a, I: Id, T> IntoIterator for &'a mut IdVec<I, T> {
    type Item = &'a mut T;
    type IntoIter = std::slice::IterMut<'a, T>;
    fn into_iter(self) -> Self::IntoIter {
        self.items.iter_mut()
    }
}

impl<I: Id, T> Index<I> for IdVec<I, T> {
    type Output = T;
    fn index(&self, id: I) -> &T {
        &self.items[id.index()]
    }
}

impl<I: Id, T> IndexMut<I> for IdVec<I, T> {
    fn index_mut(&mut self, id: I) -> &mut T {
        &mut self.items[id.index()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ids_count_from_zero_in_order_of_insertion() {
        let mut rooms: IdVec<RoomId, &str> = IdVec::new();
        let kitchen = rooms.push("kitchen");
        let hall = rooms.push("hall");
        assert_eq!((kitchen, hall), (RoomId(0), RoomId(1)));
        assert_eq!(rooms[hall], "hall");
        assert_eq!(rooms.get(RoomId(2)), None);
        assert_eq!(rooms.ids().collect::<Vec<_>>(), [kitchen, hall]);
    }
}
