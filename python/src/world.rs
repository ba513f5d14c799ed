//! Worlds for Python.

use crate::answers::PyValue;
use crate::arrays;
use crate::batch::PyBatch;
use crate::descriptions::TextArguments;
use crate::engine_call::EngineCall;
use crate::errors::PyFault;
use crate::house::PyHouse;
use crate::json_rows::{AgentPlacementArgument, BodyArgument, SoundArgument, SoundPlaceRow};
use crate::navigation::PyNavigation;
use crate::picture;
use crate::values::JsonArgument;
use crate::world_access::{ActiveGuide, WorldAccess};
use dwell::{DiscreteAction, HandActionRequest, ShortestPathFollower, World, WorldConfig};
use dwell::{PlayRequest, SoundPlace};
use dwell_physics::{AgentControl, AgentPlacement, BodyState};
use dwell_scene::interrupt;
use dwell_scene::parallel::Threads;
use dwell_scene::random::RandomKey;
use dwell_scene::{Address, IdVec, JointCommand, Pose, Velocity};
use glam::{Quat, Vec3};
use numpy::{IntoPyArray, PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use serde_json::json;
use std::sync::{Mutex, TryLockError};

/// A running world with its own state over a shared house.
#[pyclass(name = "World", module = "dwell._native", frozen)]
pub(crate) struct PyWorld {
    source: WorldSource,
    guide: Mutex<ActiveGuide>,
}

/// The owner of a world.
enum WorldSource {
    Own(Box<Mutex<World>>),
    /// In an environment of a batch, which goes on stepping it.
    Env {
        batch: Py<PyBatch>,
        env: usize,
    },
}

impl PyWorld {
    /// Changes the world: completely, whatever signals arrive. A panic on the way leaves it poisoned.
    pub(crate) fn with<T: Send>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&mut WorldAccess<'_>) -> Result<T, PyFault> + Send,
    ) -> PyResult<T> {
        py.engine(|| self.reach(|running| interrupt::uninterruptible(|| work(running))))
    }

    /// Changes the world by work that leaves it as it was when a signal stops it: a long preparation with a change at its end, or a step.
    fn prepare<T: Send>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&mut WorldAccess<'_>) -> Result<T, PyFault> + Send,
    ) -> PyResult<T> {
        // Within the guards: they would take the unwinding for a panic.
        py.engine(|| self.reach(|running| interrupt::catch_interrupt(|| work(running))?))
    }

    /// Reads the world, which may take its time: a signal ends it, and the world is as it was.
    pub(crate) fn read_interruptible<T: Send>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&WorldAccess<'_>) -> Result<T, PyFault> + Send,
    ) -> PyResult<T> {
        py.engine(|| self.reach(|running| interrupt::catch_interrupt(|| work(running))?))
    }

    /// Locks the world for one call, without the GIL.
    fn reach<T>(
        &self,
        work: impl FnOnce(&mut WorldAccess<'_>) -> Result<T, PyFault>,
    ) -> Result<T, PyFault> {
        let mut guide = self.guide.lock().map_err(|_| poisoned_world_fault())?;
        let work = |world: &mut World, strides| {
            let guide = &mut *guide;
            work(&mut WorldAccess {
                world,
                guide,
                strides,
            })
        };
        match &self.source {
            WorldSource::Own(world) => {
                let mut world = world.lock().map_err(|_| poisoned_world_fault())?;
                work(&mut world, IdVec::default())
            }
            WorldSource::Env { batch, env } => {
                let mut batch = batch.get().lock()?;
                let env = batch.env_mut(*env)?;
                let strides = env.step_sizes();
                work(env.world_mut(), strides)
            }
        }
    }
}

fn poisoned_world_fault() -> PyFault {
    PyFault::Usage("a bug of the engine stopped this world; make a new one".to_owned())
}

#[pymethods]
impl PyWorld {
    #[new]
    #[pyo3(signature = (house, config_json="{}", seed=0))]
    fn new(
        py: Python<'_>,
        house: &Bound<'_, PyHouse>,
        config_json: &str,
        seed: u64,
    ) -> PyResult<Self> {
        arrays::init_numpy(py)?;
        let engines = house.get().engines.clone();
        let world = py.engine(|| -> Result<World, PyFault> {
            let config: WorldConfig = dwell::parse_config(config_json).map_err(PyFault::Config)?;
            let mut world = World::new(engines, &config)?;
            world.set_threads(Threads::default());
            world.reset(RandomKey::root(seed))?;
            Ok(world)
        })?;
        Ok(Self {
            source: WorldSource::Own(Box::new(Mutex::new(world))),
            guide: Mutex::default(),
        })
    }

    /// The world of environment `env` of a batch, shared with it.
    #[staticmethod]
    fn of_env(py: Python<'_>, batch: Py<PyBatch>, env: usize) -> PyResult<Self> {
        batch
            .get()
            .with(py, |batch| Ok(batch.env(env).map(|_| ())?))?;
        Ok(Self {
            source: WorldSource::Env { batch, env },
            guide: Mutex::default(),
        })
    }

    fn step(&self, py: Python<'_>, controls: PyReadonlyArray2<'_, f32>) -> PyResult<()> {
        let controls = controls.as_array();
        if controls.ncols() != 4 {
            let message = format!(
                "controls: expected shape (agent, 4), found (_, {})",
                controls.ncols()
            );
            return Err(crate::errors::to_python(PyFault::Config(message)));
        }
        let controls: Vec<AgentControl> = controls
            .rows()
            .into_iter()
            .map(|row| AgentControl {
                forward_m_s: row[0],
                right_m_s: row[1],
                yaw_rate_rad_s: row[2],
                pitch_rate_rad_s: row[3],
                ..AgentControl::default()
            })
            .collect();
        self.prepare(py, |running| Ok(running.world.step_or_stay(&controls)?))
    }

    fn step_fields(&self, py: Python<'_>, controls: JsonArgument) -> PyResult<()> {
        self.prepare(py, |running| {
            let controls: Vec<AgentControl> = controls.read()?;
            Ok(running.world.step_or_stay(&controls)?)
        })
    }

    fn act(&self, py: Python<'_>, agent: usize, action: JsonArgument) -> PyResult<PyValue> {
        self.with(py, |running| {
            let agent = running.agent(agent)?;
            let request: HandActionRequest = action.read()?;
            let outcome = running.world.act_on(agent, &request)?;
            PyValue::of(&running.outcome(&outcome)?)
        })
    }

    fn act_discrete(&self, py: Python<'_>, agent: usize, action: usize) -> PyResult<PyValue> {
        self.with(py, |running| {
            let agent = running.agent(agent)?;
            let last = DiscreteAction::ALL.len() - 1;
            let known = DiscreteAction::ALL.get(action).copied();
            let action = known.ok_or_else(|| {
                PyFault::Config(format!("action {action}; allowed are 0 to {last}"))
            })?;
            let stride = running.step_sizes(agent);
            let outcome = running.world.act_discrete(agent, action, &stride)?;
            PyValue::of(&running.outcome(&outcome)?)
        })
    }

    fn delayed_outcomes(&self, py: Python<'_>) -> PyResult<PyValue> {
        self.read_interruptible(py, |running| {
            let mut notices = Vec::new();
            for notice in running.world.delayed_outcomes() {
                let outcome = running.outcome(&notice.outcome)?;
                let agent = notice.agent.map(|agent| agent.0);
                notices.push(json!({"agent": agent, "outcome": outcome}));
            }
            PyValue::of(&notices)
        })
    }

    fn place_agent(&self, py: Python<'_>, agent: usize, place: JsonArgument) -> PyResult<()> {
        self.with(py, |running| {
            let row: AgentPlacementArgument = place.read()?;
            let placement = AgentPlacement {
                agent: running.agent(agent)?,
                position: row.position.into(),
                yaw_rad: row.yaw_deg.to_radians(),
                pitch_rad: row.pitch_deg.to_radians(),
                velocity: row.linear_m_s.into(),
                yaw_rate_rad_s: row.yaw_rate_rad_s,
                crouched_by_m: row.crouched_by_m,
                wheel_rad_s: row.wheel_rad_s,
            };
            Ok(running.world.set_agents(&[placement])?)
        })
    }

    fn agents(&self, py: Python<'_>) -> PyResult<PyValue> {
        self.read_interruptible(py, |running| {
            PyValue::of(&dwell::effective_agents(running.world))
        })
    }

    fn objects(&self, py: Python<'_>) -> PyResult<PyValue> {
        self.read_interruptible(py, |running| {
            PyValue::of(&dwell::object_states(running.world))
        })
    }

    /// One object, by its name or the sensors' id.
    fn object(&self, py: Python<'_>, named: JsonArgument) -> PyResult<PyValue> {
        self.read_interruptible(py, |running| {
            let id = running.object(&named.read()?)?;
            PyValue::of(&dwell::object_state(running.world, id))
        })
    }

    fn events(&self, py: Python<'_>) -> PyResult<PyValue> {
        self.read_interruptible(py, |running| PyValue::of(running.world.events()))
    }

    fn start_report(&self, py: Python<'_>) -> PyResult<PyValue> {
        self.read_interruptible(py, |running| PyValue::of(running.world.start_report()))
    }

    fn render<'py>(
        &self,
        py: Python<'py>,
        view: JsonArgument,
        channels: Vec<String>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let seen = self.read_interruptible(py, |running| {
            picture::render(running.world, view, &channels)
        })?;
        let images = PyDict::new(py);
        for (channel, observation) in channels.iter().zip(seen) {
            images.set_item(channel, picture::array(py, observation)?)?;
        }
        Ok(images)
    }

    fn listen<'py>(
        &self,
        py: Python<'py>,
        agent: usize,
        samples: usize,
    ) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let heard = self.prepare(py, |running| {
            if samples == 0 || samples > 10 * running.world.config().sound_rate_hz as usize {
                return Err(PyFault::Config(format!(
                    "samples is {samples}; allowed are 1 to ten seconds' worth"
                )));
            }
            let agent = running.agent(agent)?;
            running.world.enable_listeners(&[(agent, samples)])?;
            let mut heard = vec![0.0; 2 * samples];
            for (channel, out) in heard.chunks_exact_mut(samples).enumerate() {
                running.world.newest_samples(agent, channel, out);
            }
            Ok(heard)
        })?;
        heard.into_pyarray(py).reshape([2, samples])
    }

    fn play(&self, py: Python<'_>, sound: JsonArgument) -> PyResult<u64> {
        self.with(py, |running| {
            let row: SoundArgument = sound.read()?;
            let place = match row.at {
                SoundPlaceRow::Position(position) => SoundPlace::Point(position.into()),
                SoundPlaceRow::Object(name) => SoundPlace::Object(running.object(&json!(name))?),
                SoundPlaceRow::Agent(agent) => SoundPlace::Agent(running.agent(agent)?),
            };
            let usual_db = dwell::default_level_db(&row.sound)?;
            let Some(level_db) = row.level_db.or(usual_db) else {
                let message = "level_db is missing; a file does not say how loud it was";
                return Err(PyFault::Config(message.to_owned()));
            };
            let request = PlayRequest {
                sound: row.sound,
                place,
                level_db,
                loops: row.loops,
            };
            running.world.play(request).map_err(PyFault::of_sound)
        })
    }

    fn stop_sound(&self, py: Python<'_>, handle: u64) -> PyResult<()> {
        self.with(py, |running| Ok(running.world.stop_sound(handle)?))
    }

    fn start_sound(&self, py: Python<'_>, handle: u64) -> PyResult<()> {
        self.with(py, |running| Ok(running.world.start_sound(handle)?))
    }

    fn set_sound_level(&self, py: Python<'_>, handle: u64, level_db: f32) -> PyResult<()> {
        self.with(py, |running| {
            Ok(running.world.set_sound_level(handle, level_db)?)
        })
    }

    fn sounds(&self, py: Python<'_>) -> PyResult<PyValue> {
        self.read_interruptible(py, |running| PyValue::of(&running.world.sounds()))
    }

    fn navigation(&self, py: Python<'_>, walker: JsonArgument) -> PyResult<PyNavigation> {
        self.read_interruptible(py, |running| {
            let world = &running.world;
            PyNavigation::build(world.house(), world.state(), walker)
        })
    }

    fn follow(&self, py: Python<'_>, navigation: &Bound<'_, PyNavigation>) -> PyResult<usize> {
        let navigation = navigation.get();
        self.read_interruptible(py, |running| navigation.update_grid(running.world.state()))
    }

    fn merged_events(&self, py: Python<'_>) -> PyResult<PyValue> {
        self.read_interruptible(py, |running| {
            PyValue::of(&running.world.events_beyond_limit())
        })
    }

    fn path(
        &self,
        py: Python<'_>,
        agent: usize,
        goal: [f32; 3],
    ) -> PyResult<Option<Vec<[f32; 3]>>> {
        self.read_interruptible(py, |running| {
            let agent = running.agent(agent)?;
            let state = &running.world.state().agents[agent];
            let grid = running.world.engines().nav_grid(&state.body)?;
            let ends = (
                grid.nearest(state.position, 0.6),
                grid.nearest(Vec3::from_array(goal), 0.6),
            );
            let (Some(start), Some(end)) = ends else {
                return Ok(None);
            };
            let way = grid.path(start, end).map(|way| grid.corners(&way));
            Ok(way.map(|way| {
                way.into_iter()
                    .map(|cell| grid.position(cell).to_array())
                    .collect()
            }))
        })
    }

    fn guide(&self, py: Python<'_>, agent: usize, goal: [f32; 3]) -> PyResult<Option<usize>> {
        self.prepare(py, |running| {
            let id = running.agent(agent)?;
            let bits = goal.map(f32::to_bits);
            let body = running.world.state().agents[id].body;
            if running
                .guide
                .as_ref()
                .is_none_or(|(old, guide)| *old != bits || guide.agent() != id)
            {
                let grid = running.world.engines().nav_grid(&body)?;
                let Some(cell) = grid.nearest(Vec3::from_array(goal), 0.6) else {
                    return Err(PyFault::Config(format!(
                        "nobody can stand within 0.6 m of {goal:?}"
                    )));
                };
                *running.guide = Some((
                    bits,
                    ShortestPathFollower::new(id, grid, &[cell], running.step_sizes(id)),
                ));
            }
            let WorldAccess { world, guide, .. } = running;
            Ok(guide
                .as_mut()
                .and_then(|(_, guide)| guide.next_action(world))
                .map(|action| action as usize))
        })
    }

    fn face(&self, py: Python<'_>, agent: usize, object: &str) -> PyResult<Option<usize>> {
        self.read_interruptible(py, |running| {
            let agent = running.agent(agent)?;
            let object = running.object(&json!(object))?;
            Ok(dwell::action_towards_object(
                running.world,
                agent,
                object,
                &running.step_sizes(agent),
            )
            .map(|action| action as usize))
        })
    }

    fn gaze_target(&self, py: Python<'_>, agent: usize) -> PyResult<Option<String>> {
        self.read_interruptible(py, |running| {
            let target = running.world.object_in_view_centre(running.agent(agent)?);
            Ok(target.map(|object| running.world.house().objects[object].name.clone()))
        })
    }

    fn joints(&self, py: Python<'_>) -> PyResult<PyValue> {
        self.read_interruptible(py, |running| {
            let (house, state) = (running.world.house(), running.world.state());
            let rows: Vec<_> = house
                .joints
                .iter_ids()
                .map(|(id, joint)| {
                    json!({
                        "id": id.0,
                        "name": joint.name,
                        "object": house.objects[joint.object].name,
                        "kind": joint.kind,
                        "limits": state.joint_parameters(house, id).limits,
                        "motor": state.joint_parameters(house, id).servo,
                        "position": state.joint_position[id],
                        "velocity": state.joint_velocity[id],
                        "command": state.joint_command[id],
                    })
                })
                .collect();
            PyValue::of(&rows)
        })
    }

    fn command_joint(&self, py: Python<'_>, joint: u32, kind: &str, value: f32) -> PyResult<()> {
        self.with(py, |running| {
            let command = match kind {
                "off" => JointCommand::Off,
                "position" => JointCommand::Position(value),
                "velocity" => JointCommand::Velocity(value),
                "effort" => JointCommand::Effort(value),
                other => {
                    return Err(PyFault::Config(format!(
                        "kind is {other:?}; allowed are off, position, velocity, effort"
                    )));
                }
            };
            let joint = running.joint(joint)?;
            Ok(running.world.command_joint(joint, command)?)
        })
    }

    fn set_joints(&self, py: Python<'_>, joints: Vec<(u32, f32, f32)>) -> PyResult<()> {
        self.with(py, |running| {
            let joints: Vec<_> = joints
                .into_iter()
                .map(|(joint, position, velocity)| Ok((running.joint(joint)?, position, velocity)))
                .collect::<Result<_, PyFault>>()?;
            Ok(running.world.set_joints(&joints)?)
        })
    }

    fn body(&self, py: Python<'_>, object: &str, part: Option<&str>) -> PyResult<PyValue> {
        self.read_interruptible(py, |running| {
            let id = running.part(object, part)?;
            let state = running.world.state();
            let (pose, velocity) = (state.part_pose[id], state.part_velocity[id]);
            PyValue::of(&json!({
                "position": pose.position.to_array(),
                "rotation": pose.rotation.to_array(),
                "linear_m_s": velocity.linear.to_array(),
                "angular_rad_s": velocity.angular.to_array(),
            }))
        })
    }

    fn set_bodies(&self, py: Python<'_>, bodies: JsonArgument) -> PyResult<()> {
        self.with(py, |running| {
            let rows: Vec<BodyArgument> = bodies.read()?;
            let bodies: Vec<BodyState> = rows
                .iter()
                .map(|row| {
                    Ok(BodyState {
                        part: running.part(&row.object, row.part.as_deref())?,
                        pose: Pose::new(row.position.into(), Quat::from_array(row.rotation)),
                        velocity: Velocity {
                            linear: row.linear_m_s.into(),
                            angular: row.angular_rad_s.into(),
                        },
                    })
                })
                .collect::<Result<_, PyFault>>()?;
            Ok(running.world.set_bodies(&bodies)?)
        })
    }

    fn parameter(&self, py: Python<'_>, address: &str) -> PyResult<PyValue> {
        self.read_interruptible(py, |running| {
            let address: Address = address.parse()?;
            PyValue::of(&running.world.parameter(&address)?)
        })
    }

    fn parameters(&self, py: Python<'_>) -> PyResult<PyValue> {
        self.read_interruptible(py, |running| PyValue::of(&running.world.parameters()))
    }

    fn set_parameters(&self, py: Python<'_>, values: Vec<(String, f64)>) -> PyResult<()> {
        self.with(py, |running| {
            let values: Vec<(Address, f64)> = values
                .iter()
                .map(|(address, value)| Ok((address.parse()?, *value)))
                .collect::<Result<_, PyFault>>()?;
            Ok(running.world.set_parameters(&values)?)
        })
    }

    #[pyo3(signature = (level, options, viewer, agent=None, to=None, since=None))]
    #[expect(clippy::too_many_arguments, reason = "those of the Python function")]
    fn describe(
        &self,
        py: Python<'_>,
        level: &str,
        options: TextArguments<'_>,
        viewer: JsonArgument,
        agent: Option<usize>,
        to: Option<JsonArgument>,
        since: Option<&[u8]>,
    ) -> PyResult<PyValue> {
        self.read_interruptible(py, |running| {
            let listener = running.listener(viewer, agent)?;
            running.describe(level, options, listener, to, since)
        })
    }

    fn snapshot<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let bytes = self.read_interruptible(py, |running| Ok(running.world.snapshot()))?;
        Ok(PyBytes::new(py, &bytes))
    }

    fn restore(&self, py: Python<'_>, snapshot: &[u8]) -> PyResult<()> {
        // A caller that waits for a step of another thread would undo it.
        if let WorldSource::Own(world) = &self.source
            && let Err(TryLockError::WouldBlock) = world.try_lock()
        {
            return Err(crate::errors::to_python(PyFault::Usage(
                "restore: this world is busy in another thread; wait for its step to end"
                    .to_owned(),
            )));
        }
        self.with(py, |running| {
            running.world.restore(snapshot).map_err(PyFault::of_sound)
        })
    }

    fn config(&self, py: Python<'_>) -> PyResult<PyValue> {
        self.with(py, |running| PyValue::of(running.world.config()))
    }

    fn hash(&self, py: Python<'_>) -> PyResult<u64> {
        self.read_interruptible(py, |running| Ok(running.world.hash()))
    }

    #[getter]
    fn time_s(&self, py: Python<'_>) -> PyResult<f64> {
        self.read_interruptible(py, |running| Ok(running.world.state().time_s))
    }

    #[getter]
    fn step_count(&self, py: Python<'_>) -> PyResult<u64> {
        self.read_interruptible(py, |running| Ok(running.world.state().step))
    }
}
