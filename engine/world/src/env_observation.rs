//! The observations of the agents of an environment.

use crate::camera_capture::ImageRequest;
use crate::env::Env;
use crate::env_agent::EnvAgent;
use crate::error::WorldError;
use crate::sensor_requests::{RenderedImages, SensorRequests};
use crate::sensors::{ObservationBuffer, Sensor, SensorContext, SensorSpec};
use crate::world::World;
use dwell_render::{Camera, Preset};
use dwell_scene::parallel::Threads;

impl Env {
    /// Returns what the sensors give: those of the first agent in order, of the second, and so on. Shape (sensor,).
    pub fn sensor_specs(&self) -> Vec<SensorSpec> {
        self.sensors().map(|(_, sensor)| sensor.spec()).collect()
    }

    /// Returns whose each sensor is, by the agent's place. Shape (sensor,).
    pub fn sensor_agents(&self) -> Vec<usize> {
        let agents = self.agents.iter().enumerate();
        agents
            .flat_map(|(place, agent)| std::iter::repeat_n(place, agent.sensors.len()))
            .collect()
    }

    fn sensors(&self) -> impl Iterator<Item = (&EnvAgent, &dyn Sensor)> {
        self.agents
            .iter()
            .flat_map(|agent| agent.sensors.iter().map(move |sensor| (agent, &**sensor)))
    }

    /// Makes what the first pictures in a house wait for, such as textures and the light of the house, by small pictures of
    /// all views.
    ///
    /// # Errors
    /// [`WorldError::Render`] for a graphics adapter that fails.
    pub fn warm_up(&self, threads: Threads) -> Result<(), WorldError> {
        for view in &self.requests.views {
            let own = view.eye.request(self.world.state());
            let small = ImageRequest {
                camera: Camera::from_fov(8, 8, 90.0)?,
                preset: match own.preset {
                    Preset::Flat => Preset::Flat,
                    Preset::Lit | Preset::Full => Preset::Lit,
                },
                ..own
            };
            self.world.render_image(&small, view.channels, threads)?;
        }
        Ok(())
    }

    /// Samples of sound that were cut off in each agent's latest observation, because they were louder than it can hold. Shape
    /// (agent,).
    pub fn clipped_samples(&self) -> Vec<u64> {
        let of = |agent: &EnvAgent| {
            agent
                .sensors
                .iter()
                .map(|sensor| sensor.clipped_samples())
                .sum()
        };
        self.agents.iter().map(of).collect()
    }

    /// Returns what the sensors ask of the engines.
    pub(crate) fn requests(&self) -> &SensorRequests {
        &self.requests
    }

    /// The world, and the buffers for its pictures, at the same time.
    pub(crate) fn world_and_image_buffers(
        &mut self,
    ) -> (&World, &SensorRequests, &mut RenderedImages) {
        self.results.allocate(&self.requests, &self.world);
        (&self.world, &self.requests, &mut self.results)
    }

    /// Writes the observation of a sensor, by its place among [`Self::sensor_specs`].
    ///
    /// # Errors
    /// [`WorldError::InvalidCall`] for a wrong index or length, or before the first reset.
    pub(crate) fn observe(
        &self,
        index: usize,
        out: ObservationBuffer<'_>,
    ) -> Result<(), WorldError> {
        let found = self.sensors().nth(index);
        let found =
            found.and_then(|(agent, sensor)| Some((agent, sensor, agent.episode.as_ref()?)));
        let Some((agent, sensor, episode)) = found else {
            return Err(WorldError::InvalidCall(format!(
                "observe: no sensor {index}, or no episode has begun"
            )));
        };
        let spec = sensor.spec();
        let length = match &out {
            ObservationBuffer::Uint8(out) => out.len(),
            ObservationBuffer::Float32(out) => out.len(),
            ObservationBuffer::Int32(out) => out.len(),
            ObservationBuffer::Text(_) => spec.len(),
        };
        if length != spec.len() {
            return Err(WorldError::InvalidCall(format!(
                "observe: {} needs a buffer of {} elements, shape {:?}; found {length}",
                spec.name,
                spec.len(),
                spec.shape
            )));
        }
        let key = agent
            .agent_key(self.episode_key)
            .child("sensor")
            .child(spec.name.as_str())
            .child(self.world.state().step);
        sensor.write_observation(
            SensorContext {
                world: &self.world,
                episode,
                start_poses: &self.start_poses,
                reply: agent.task.reply(),
                results: &self.results,
                key,
            },
            out,
        );
        Ok(())
    }
}
