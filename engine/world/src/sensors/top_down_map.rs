//! The map of an agent's storey from above, of what it has seen so far.

use super::{
    Dtype, ObservationBuffer, ObservedAgent, Sensor, SensorContext, SensorKind, SensorSetup,
    SensorSpec, parse_sensor_settings,
};
use crate::episode::Episode;
use crate::error::WorldError;
use crate::schema;
use crate::sighted_cells::{FREE, OBSTACLE, SightSettings, SightedCells};
use crate::world::World;
use dwell_scene::navigation::{NavConfig, NavGrid};
use dwell_scene::space::Pose;
use dwell_scene::{AgentBody, AgentState, Id, LevelId};
use glam::Vec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

const ABOUT: &str = "The agent's storey from above, cell by cell: 0 not seen yet, 1 free (its middle can stand there), 2 an obstacle or \
                     no floor, 3 the agent itself; what was seen stays as it was when it was last seen; shape (height, width).";

/// The agent's own cell.
const AGENT: u8 = 3;
/// Height above the feet at which the storey is looked up, m: floors lie a little above or below those of their storey.
const ABOVE_FEET_M: f32 = 0.05;

pub(super) const KIND: SensorKind = SensorKind {
    name: "top_down_map",
    about: ABOUT,
    build,
    settings: schema::fields_of::<TopDownMapConfig>,
    image: None,
    goal_part: None,
};

/// The axes of a map. The first row is the furthest ahead, or the furthest to the north.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
enum MapAxes {
    /// The agent is in the middle and looks up the map, to the first row.
    #[default]
    Agent,
    /// The agent is in the middle; up the map is -Z, to the right X: the axes of the world, whose cells the map shows as they are.
    World,
    /// The start of the episode is in the middle, and up the map is where the agent looked then: the frame of `gps` and `compass`.
    Start,
}

/// The settings of a top-down map. It takes in what is seen at the beginning of the episode and after every step, whether or not
/// the map is observed then.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
struct TopDownMapConfig {
    /// The key in the observation; by default the sensor's kind.
    name: Option<String>,
    /// Which agent's map; by default that of the one whom the environment is about.
    agent: Option<u32>,
    /// Its axes: `"agent"` (egocentric, default), `"world"` or `"start"` (both allocentric).
    axes: MapAxes,
    /// Cells across, 1 to 2,048; default 128. The middle is cell (height / 2, width / 2), rounded down.
    width: u32,
    /// Cells down, 1 to 2,048; default 128.
    height: u32,
    /// Edge of a cell, m, 0.02 to 1; default 0.1.
    cell_m: f32,
    /// Space around the middle of a free cell, m, 0 to 2; by default the radius of the agent's body, so that it can walk wherever a cell
    /// is free. With 0 a cell is free where nothing stands.
    radius_m: Option<f32>,
    /// True (default): only what has been seen in this episode is shown. False: the whole storey, as it is.
    fog_of_war: bool,
    /// How far the agent sees, m, above 0 to 100, at most 1,000 cells; default 5.
    range_m: f32,
    /// How wide the agent sees, degrees around straight ahead, above 0 to 360; by default the field of view of its eyes.
    fov_deg: Option<f32>,
    /// Height of its lines of sight above the feet, m, 0 to 10; by default that of its eyes. They are level: it sees over what is lower.
    sight_height_m: Option<f32>,
}

impl Default for TopDownMapConfig {
    fn default() -> Self {
        Self {
            name: None,
            agent: None,
            axes: MapAxes::Agent,
            width: 128,
            height: 128,
            cell_m: 0.1,
            radius_m: None,
            fog_of_war: true,
            range_m: 5.0,
            fov_deg: None,
            sight_height_m: None,
        }
    }
}

impl TopDownMapConfig {
    /// Checks every range.
    fn check(&self) -> Result<(), WorldError> {
        let fault = |field: &'static str, found: String, allowed: &str| {
            Err(WorldError::Config {
                field,
                found,
                allowed: allowed.to_owned(),
            })
        };
        for (field, cells) in [("width", self.width), ("height", self.height)] {
            if !(1..=2048).contains(&cells) {
                return fault(field, cells.to_string(), "1 to 2048 cells");
            }
        }
        let within = |value: f32, low: f32, high: f32| (low..=high).contains(&value);
        if !within(self.cell_m, 0.02, 1.0) {
            return fault("cell_m", self.cell_m.to_string(), "0.02 to 1 m");
        }
        if let Some(radius_m) = self
            .radius_m
            .filter(|radius_m| !within(*radius_m, 0.0, 2.0))
        {
            return fault("radius_m", radius_m.to_string(), "0 to 2 m");
        }
        let furthest_m = (1000.0 * self.cell_m).min(100.0);
        if !(self.range_m > 0.0 && self.range_m <= furthest_m) {
            let allowed = format!("above 0, at most {furthest_m} m: 1000 cells, or 100 m");
            return fault("range_m", self.range_m.to_string(), &allowed);
        }
        if let Some(fov_deg) = self
            .fov_deg
            .filter(|fov_deg| !(*fov_deg > 0.0 && *fov_deg <= 360.0))
        {
            return fault(
                "fov_deg",
                fov_deg.to_string(),
                "above 0, at most 360 degrees",
            );
        }
        match self.sight_height_m {
            Some(height_m) if !within(height_m, 0.0, 10.0) => {
                fault("sight_height_m", height_m.to_string(), "0 to 10 m")
            }
            _ => Ok(()),
        }
    }

    /// The walker for whom cells are free.
    fn walker(&self, body: &AgentBody) -> NavConfig {
        NavConfig {
            cell_m: self.cell_m,
            radius_m: self.radius_m.unwrap_or(body.radius_m),
            height_m: body.height_m,
            step_m: body.step_height_m,
            max_slope_rad: body.max_slope_rad,
            ..NavConfig::default()
        }
    }
}

#[derive(Debug)]
struct TopDownMapSensor {
    of: ObservedAgent,
    config: TopDownMapConfig,
    walker: NavConfig,
    sight: SightSettings,
    /// The storeys as they were after the last step; `None` before the first episode.
    grid: Option<NavGrid>,
    seen: SightedCells,
}

fn build(value: &serde_json::Value, setup: SensorSetup<'_>) -> Result<Box<dyn Sensor>, WorldError> {
    let config: TopDownMapConfig = parse_sensor_settings(value)?;
    config.check()?;
    let agent = setup.agent(config.agent)?;
    let body = &setup.config.agents[agent.index()];
    Ok(Box::new(TopDownMapSensor {
        of: ObservedAgent {
            name: super::key(KIND.name, config.name.clone())?,
            agent,
        },
        walker: config.walker(body),
        sight: SightSettings {
            range_m: config.range_m,
            fov_rad: config.fov_deg.unwrap_or(body.camera_fov_deg).to_radians(),
            height_m: config.sight_height_m,
        },
        config,
        grid: None,
        seen: SightedCells::default(),
    }))
}

impl TopDownMapSensor {
    /// Brings the grid up to date with the world.
    fn update_grid<'a>(
        grid: &'a mut Option<NavGrid>,
        walker: &NavConfig,
        world: &World,
    ) -> Result<&'a mut NavGrid, WorldError> {
        let mut own = match grid.take() {
            Some(own) => own,
            None => NavGrid::clone(&*world.engines().nav_grid_of_config(walker)?),
        };
        own.update(world.house(), world.state())?;
        Ok(grid.insert(own))
    }

    /// Returns what fits only a snapshot of the same settings.
    fn fingerprint(&self) -> String {
        format!("{:?} {:?}", self.walker, self.sight)
    }

    /// Returns the value of a cell of the grid on a storey.
    fn value(&self, grid: &NavGrid, level: LevelId, column: Option<usize>) -> u8 {
        match column {
            Some(column) if self.config.fog_of_war => self.seen.value(level, column),
            None if self.config.fog_of_war => 0,
            Some(column) if grid.is_free(column, level) => FREE,
            _ => OBSTACLE,
        }
    }

    /// Writes all cells of the map in axes of the world.
    fn write_columns(&self, grid: &NavGrid, agent: &AgentState, level: LevelId, out: &mut [u8]) {
        let columns = grid.column_frame();
        let [x, z] = columns
            .column_coordinates([agent.position.x, agent.position.z])
            .map(|middle| middle.floor() as i64);
        let (width, height) = (self.config.width as usize, self.config.height as usize);
        for (cell, out) in out.iter_mut().enumerate() {
            let right = (cell % width) as i64 - (width / 2) as i64;
            let down = (cell / width) as i64 - (height / 2) as i64;
            *out = self.value(
                grid,
                level,
                columns.column([x.saturating_add(right), z.saturating_add(down)]),
            );
        }
        out[height / 2 * width + width / 2] = AGENT;
    }

    /// Writes all cells of the map around `world_from_map`, whose forward axis goes up the map.
    fn write_around(
        &self,
        grid: &NavGrid,
        agent: &AgentState,
        (world_from_map, level): (Pose, LevelId),
        out: &mut [u8],
    ) {
        let columns = grid.column_frame();
        let (width, height) = (self.config.width as usize, self.config.height as usize);
        let cell_m = self.config.cell_m;
        for (cell, out) in out.iter_mut().enumerate() {
            let right = (cell % width) as f32 - (width / 2) as f32;
            let down = (cell / width) as f32 - (height / 2) as f32;
            let in_map = Vec3::new(right * cell_m, 0.0, down * cell_m);
            let point = world_from_map.transform_point(in_map);
            *out = self.value(grid, level, columns.column_at([point.x, point.z]));
        }
        let in_map = world_from_map.inverse().transform_point(agent.position) / cell_m;
        let cell = |offset: f32, size: usize| {
            let index = (size / 2) as f32 + (offset + 0.5).floor();
            (index >= 0.0 && index < size as f32).then_some(index as usize)
        };
        if let (Some(x), Some(z)) = (cell(in_map.x, width), cell(in_map.z, height)) {
            out[z * width + x] = AGENT;
        }
    }
}

impl Sensor for TopDownMapSensor {
    fn spec(&self) -> SensorSpec {
        SensorSpec {
            name: self.of.name.clone(),
            shape: vec![self.config.height as usize, self.config.width as usize],
            dtype: Dtype::Uint8,
            unit: "1",
            low: 0.0,
            high: f64::from(AGENT),
            about: ABOUT,
        }
    }

    fn begin_episode(&mut self, world: &World, _: &Episode) -> Result<(), WorldError> {
        self.forget(world)
    }

    fn advance(&mut self, world: &World) -> Result<(), WorldError> {
        let grid = Self::update_grid(&mut self.grid, &self.walker, world)?;
        if let Some(agent) = world.state().agents.get(self.of.agent)
            && let Some(level) = grid.storey_at(agent.position.y + ABOVE_FEET_M)
            && self.config.fog_of_war
        {
            let hidden = world.house().entity_of_agent(self.of.agent);
            self.seen
                .mark_visible(grid, level, &self.sight, (agent, world.rays(), hidden));
        }
        Ok(())
    }

    fn forget(&mut self, world: &World) -> Result<(), WorldError> {
        self.seen = SightedCells::default();
        self.advance(world)
    }

    fn snapshot(&self) -> Vec<u8> {
        if self.config.fog_of_war {
            self.seen.to_bytes(&self.fingerprint())
        } else {
            Vec::new()
        }
    }

    fn restore(&mut self, world: &World, bytes: &[u8]) -> Result<(), WorldError> {
        let columns = Self::update_grid(&mut self.grid, &self.walker, world)?.column_frame();
        let levels = world.house().levels.len();
        let found = SightedCells::from_bytes(&self.fingerprint(), levels, columns.count(), bytes);
        self.seen = found
            .map_err(|why| WorldError::Snapshot(format!("the sensor {:?}: {why}", self.of.name)))?;
        Ok(())
    }

    fn write_observation(&self, seen: SensorContext<'_>, out: ObservationBuffer<'_>) {
        let (Some(agent), Some(grid), ObservationBuffer::Uint8(out)) =
            (self.of.state(seen), &self.grid, out)
        else {
            return;
        };
        let Some(level) = grid.storey_at(agent.position.y + ABOVE_FEET_M) else {
            return out.fill(0);
        };
        let here = || Pose::from_position_yaw(agent.position, agent.yaw_rad);
        match self.config.axes {
            MapAxes::World => self.write_columns(grid, agent, level, out),
            MapAxes::Agent => self.write_around(grid, agent, (here(), level), out),
            MapAxes::Start => {
                let start = seen.start_pose(self.of.agent);
                self.write_around(grid, agent, (start, level), out);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::WorldConfig;
    use dwell_scene::AgentId;
    use serde_json::json;

    #[test]
    fn a_wrong_setting_is_refused_with_what_is_allowed() {
        let config = WorldConfig::default();
        let setup = SensorSetup {
            config: &config,
            agent: AgentId(0),
        };
        for (settings, told) in [
            (
                json!({"width": 0}),
                "width is 0; allowed is 1 to 2048 cells",
            ),
            (
                json!({"cell_m": 0.02, "range_m": 21.0}),
                "range_m is 21; allowed is above 0, at most 20 m: 1000 cells, or 100 m",
            ),
            (
                json!({"fov_deg": 361.0}),
                "fov_deg is 361; allowed is above 0, at most 360 degrees",
            ),
            (
                json!({"sight_height_m": -1.0}),
                "sight_height_m is -1; allowed is 0 to 10 m",
            ),
        ] {
            assert_eq!(build(&settings, setup).unwrap_err().to_string(), told);
        }
        assert!(build(&json!({"axes": "north"}), setup).is_err());
        let map = build(&json!({"width": 5, "height": 7}), setup).unwrap();
        assert_eq!(map.spec().shape, [7, 5]);
    }
}
