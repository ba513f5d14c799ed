//! The grid from above: its columns, and where one can stand on a storey.

use super::grid::NavGrid;
use crate::ids::LevelId;

/// The columns of a grid from above, in rows along x; all storeys share them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColumnFrame {
    /// Columns along x.
    pub width: usize,
    /// Columns along z.
    pub depth: usize,
    /// The corner of the first column at the lowest x and z, m.
    pub corner: [f32; 2],
    /// Edge of a column, m.
    pub cell_m: f32,
}

impl ColumnFrame {
    /// The number of columns.
    pub fn count(&self) -> usize {
        self.width * self.depth
    }

    /// Returns the coordinates of a point (x, z), m, in columns from the corner.
    pub fn column_coordinates(&self, [x, z]: [f32; 2]) -> [f32; 2] {
        let [x0, z0] = self.corner;
        [(x - x0) / self.cell_m, (z - z0) / self.cell_m]
    }

    /// Returns the number of the column at indices along x and z, if there is one.
    pub fn column(&self, [x, z]: [i64; 2]) -> Option<usize> {
        let (x, z) = (usize::try_from(x).ok()?, usize::try_from(z).ok()?);
        (x < self.width && z < self.depth).then(|| z * self.width + x)
    }

    /// Returns the column that holds a point (x, z), m, if there is one.
    pub fn column_at(&self, point: [f32; 2]) -> Option<usize> {
        // What is not finite is in no column.
        let [x, z] = self.column_coordinates(point).map(f32::floor);
        (x >= 0.0 && z >= 0.0)
            .then(|| self.column([x as i64, z as i64]))
            .flatten()
    }
}

impl NavGrid {
    /// Returns the columns of the grid.
    pub fn column_frame(&self) -> ColumnFrame {
        let frame = &self.ground.frame;
        ColumnFrame {
            width: frame.width,
            depth: frame.depth,
            corner: frame.origin.to_array(),
            cell_m: frame.cell_m,
        }
    }

    /// Returns the storey that a height, m, belongs to; `None` in a house without storeys.
    pub fn storey_at(&self, y: f32) -> Option<LevelId> {
        self.ground.level(y)
    }

    /// Returns whether an agent can stand in the middle of a column on a storey, as in [`NavGrid::occupancy`].
    pub fn is_free(&self, column: usize, level: LevelId) -> bool {
        let count = self.column_frame().count();
        column < count
            && self.layers.cells_of(column).any(|cell| {
                let cell = super::NavCell(cell as u32);
                self.is_walkable(cell) && self.level(cell) == Some(level)
            })
    }
}

#[cfg(test)]
mod tests {
    use crate::navigation::{NavConfig, NavGrid};
    use crate::{House, LevelId, ShoeboxMaterials, State};

    #[test]
    fn a_column_is_free_where_the_occupancy_map_says_so() {
        let house = House::shoebox([3.0, 2.5, 4.0], &ShoeboxMaterials::default()).unwrap();
        let grid = NavGrid::build(&house, &State::new(&house), &NavConfig::default()).unwrap();
        let (columns, level) = (grid.column_frame(), LevelId(0));
        let map = grid.occupancy(level).unwrap();
        assert_eq!(map.free.len(), columns.count());
        for (column, free) in map.free.iter().enumerate() {
            assert_eq!(grid.is_free(column, level), *free == 1, "{column}");
        }
        assert!(!grid.is_free(columns.count(), level) && !grid.is_free(0, LevelId(3)));
        let middle = columns.column_at([1.5, 2.0]).unwrap();
        assert!(grid.is_free(middle, level));
        assert_eq!(grid.storey_at(0.3), Some(level));
        for outside in [[-50.0, 2.0], [1.5, 50.0], [f32::NAN, 2.0], [1e30, 2.0]] {
            assert_eq!(columns.column_at(outside), None);
        }
    }
}
