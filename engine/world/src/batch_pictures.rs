//! The pictures of a batch: the views of all worlds over one house in one submission.

use crate::camera_capture::{ImageRequest, OngoingExposure};
use crate::env::Env;
use crate::error::WorldError;
use crate::sensor_requests::RenderedView;
use crate::world::World;
use dwell_render::{PendingBatch, RenderJob, Renderer};
use dwell_scene::parallel::Threads;
use std::sync::Arc;

/// Pictures whose shutter is open or rolls that are taken together: each holds up to 15 copies of its world and 16 of its
/// colours meanwhile.
const MOST_OPEN: usize = 64;

/// A picture to be taken.
struct PictureRequest<'a> {
    /// Index of the environment.
    number: usize,
    /// Index among the environment's pictures.
    place: usize,
    world: &'a World,
    request: ImageRequest,
    picture: &'a mut RenderedView,
}

/// A picture that is being taken.
struct PictureInProgress<'a> {
    number: usize,
    place: usize,
    world: &'a World,
    picture: &'a mut RenderedView,
    take: OngoingExposure,
}

/// Pictures by one renderer.
struct RendererGroup<'a> {
    renderer: Arc<Renderer>,
    orders: Vec<PictureRequest<'a>>,
}

/// Returns the picture orders of environments, with their indices, by renderer.
fn requests_by_renderer<'a>(
    envs: impl Iterator<Item = (usize, &'a mut Env)>,
) -> Result<Vec<RendererGroup<'a>>, WorldError> {
    let mut groups: Vec<RendererGroup<'a>> = Vec::new();
    for (number, env) in envs {
        if env.requests().views.is_empty() {
            continue;
        }
        let (world, requests, results) = env.world_and_image_buffers();
        let renderer = world.engines().image_renderer(&world.config().renderer)?;
        let same = |group: &RendererGroup<'_>| Arc::ptr_eq(&group.renderer, &renderer);
        let group = groups.iter().position(same).unwrap_or(groups.len());
        if group == groups.len() {
            groups.push(RendererGroup {
                renderer,
                orders: Vec::new(),
            });
        }
        let wishes = requests.views.iter().zip(&mut results.images);
        for (place, (wish, picture)) in wishes.enumerate() {
            if world.state().agents.get(wish.eye.agent).is_some() {
                groups[group].orders.push(PictureRequest {
                    number,
                    place,
                    world,
                    request: wish.eye.request(world.state()),
                    picture,
                });
            }
        }
    }
    Ok(groups)
}

/// The first orders, as many as may have an open shutter, and how many have.
fn take_render_batch<'a>(
    orders: &mut impl Iterator<Item = PictureRequest<'a>>,
) -> (Vec<PictureRequest<'a>>, usize) {
    let mut open = 0;
    let mut taken = Vec::new();
    while open < MOST_OPEN
        && let Some(order) = orders.next()
    {
        let optics = order.world.optics(&order.request.mount);
        open += usize::from(!optics.shutter().is_global_instant());
        taken.push(order);
    }
    (taken, open)
}

/// Sets up the cameras of some orders, `open` of them with an open shutter.
fn set_up_cameras(
    (orders, open): (Vec<PictureRequest<'_>>, usize),
    threads: Threads,
) -> Vec<PictureInProgress<'_>> {
    // Worlds are copied for those alone.
    let threads = if open == 0 { Threads::ONE } else { threads };
    let takes = threads.map(orders.len(), |k| {
        let PictureRequest {
            world,
            request,
            picture,
            ..
        } = &orders[k];
        OngoingExposure::new(world, request, !picture.frame.rgb.is_empty())
    });
    let pairs = orders.into_iter().zip(takes);
    pairs
        .map(|(order, take)| {
            order.picture.camera = take.camera();
            PictureInProgress {
                number: order.number,
                place: order.place,
                world: order.world,
                picture: order.picture,
                take,
            }
        })
        .collect()
}

fn jobs<'a>(taking: &'a mut [PictureInProgress<'_>]) -> Vec<RenderJob<'a>> {
    let mut jobs = Vec::with_capacity(taking.len());
    for PictureInProgress {
        world,
        picture,
        take,
        ..
    } in taking
    {
        take.jobs(world, picture.frame.as_mut(), &mut jobs);
    }
    jobs
}

/// Develops the pictures that were exposed.
fn average_exposures<'a>(
    pairs: impl Iterator<Item = (&'a mut OngoingExposure, &'a mut RenderedView)>,
    threads: Threads,
) {
    let mut exposed: Vec<_> = pairs
        .filter(|(take, _)| take.has_multiple_exposures())
        .collect();
    threads.for_each(&mut exposed, |_, (take, picture)| {
        take.average_exposures(&mut picture.frame);
    });
}

/// Takes all pictures that environments order.
pub(crate) fn render_images<'a>(
    envs: impl Iterator<Item = (usize, &'a mut Env)>,
    threads: Threads,
) -> Result<(), WorldError> {
    for RendererGroup { renderer, orders } in requests_by_renderer(envs)? {
        let mut orders = orders.into_iter();
        loop {
            let mut taking = set_up_cameras(take_render_batch(&mut orders), threads);
            if taking.is_empty() {
                break;
            }
            renderer.render_batch(&mut jobs(&mut taking), threads)?;
            let pairs = taking.iter_mut();
            average_exposures(
                pairs.map(|taking| (&mut taking.take, &mut *taking.picture)),
                threads,
            );
        }
    }
    Ok(())
}

/// Pictures that an adapter takes while worlds go on.
#[derive(Debug)]
pub(crate) struct PendingImages {
    renderer: Arc<Renderer>,
    submitted: PendingBatch,
    /// The pictures with the index of their environment and their place there. In the order of their work.
    takes: Vec<(usize, usize, OngoingExposure)>,
}

/// Starts the pictures that environments order. Not those on the processor, which would be busy with them.
pub(crate) fn start_rendering<'a>(
    envs: impl Iterator<Item = (usize, &'a mut Env)>,
    threads: Threads,
) -> Result<Vec<PendingImages>, WorldError> {
    let mut under_way = Vec::new();
    for RendererGroup { renderer, orders } in requests_by_renderer(envs)? {
        // All pictures of an environment, or none.
        let mut presets = orders.iter().map(|order| order.request.preset);
        if !presets.all(|preset| renderer.can_submit(preset)) {
            continue;
        }
        let mut orders = orders.into_iter();
        loop {
            let mut taking = set_up_cameras(take_render_batch(&mut orders), threads);
            if taking.is_empty() {
                break;
            }
            let Some(submitted) = renderer.submit(&jobs(&mut taking), threads)? else {
                break;
            };
            let taken = taking.into_iter().map(|mut taking| {
                taking.take.drop_render_states();
                (taking.number, taking.place, taking.take)
            });
            under_way.push(PendingImages {
                renderer: renderer.clone(),
                submitted,
                takes: taken.collect(),
            });
        }
    }
    Ok(under_way)
}

impl PendingImages {
    /// The environments of these pictures.
    pub(crate) fn env_indices(&self) -> impl Iterator<Item = usize> + '_ {
        self.takes.iter().map(|(number, ..)| *number)
    }

    /// Waits for the pictures and hands them to their environments.
    pub(crate) fn finish(self, envs: &mut [Env], threads: Threads) -> Result<(), WorldError> {
        let Self {
            renderer,
            submitted,
            mut takes,
        } = self;
        let mut pairs = Vec::with_capacity(takes.len());
        let mut taken = takes.iter_mut().peekable();
        for (number, env) in envs.iter_mut().enumerate() {
            for (place, picture) in env.results.images.iter_mut().enumerate() {
                let own = taken.next_if(|(of, at, _)| (*of, *at) == (number, place));
                pairs.extend(own.map(|(_, _, take)| (take, picture)));
            }
        }
        let mut frames = Vec::with_capacity(pairs.len());
        for (take, picture) in &mut pairs {
            take.frames(picture.frame.as_mut(), &mut frames);
        }
        renderer.collect(submitted, &mut frames, threads)?;
        drop(frames);
        average_exposures(pairs.into_iter(), threads);
        Ok(())
    }
}
