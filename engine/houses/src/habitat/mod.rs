//! Scenes of Habitat: a `scene_instance.json` in its data set, as of `ReplicaCAD` and HSSD.
//!
//! `docs/formats/habitat.md` lists the fields that are read, where they come from, and what is left out.

mod articulated;
mod assets;
mod dataset;
mod file;
mod objects;
mod place;
mod stage;

use std::collections::BTreeMap;
use std::path::Path;

use dwell_scene::parallel::Threads;
use dwell_scene::{House, HouseData, interrupt};
use serde::de::DeserializeOwned;
use serde_json::Value;

use crate::error::HousesError;
use crate::import::{UniqueNames, drop_rooms_without_floor, report_contained_rooms};
use crate::limits::MAX_NODES;
use crate::report::{FileLocation, LoadReport};
use crate::robot::{MaterialNames, Robot};
use crate::warning_kind::WarningKind;
use assets::AssetCache;
use dataset::{Dataset, ResolvedTemplate, SCENE_ENDING, TemplateKind};
use file::{ObjectInstance, SceneFile, Template};

/// Returns whether `path` names a scene of Habitat.
pub(crate) fn recognizes(path: &Path) -> bool {
    path.file_name()
        .is_some_and(|name| name.to_string_lossy().ends_with(SCENE_ENDING))
}

/// Opens a scene. Files are read below the folder of the data set: the nearest one, up to four folders above the scene, that
/// holds a `.scene_dataset_config.json`.
///
/// # Errors
/// [`HousesError::Io`] when the scene cannot be read, [`HousesError::Syntax`] when it or the data set's file is no JSON of
/// that form, [`HousesError::TooLarge`] for more instances than are read, [`HousesError::Empty`] when no triangle is left,
/// [`HousesError::Scene`] when the result breaks a rule of the scene. Everything else is reported.
pub fn open(path: &Path, threads: Threads) -> Result<(House, LoadReport), HousesError> {
    let mut report = LoadReport::new();
    let (dataset, scene_path) = Dataset::find_for_scene(path, &mut report)?;
    let at = FileLocation::file(&scene_path);
    let scene: SceneFile = dataset::read_json(&dataset.root, &scene_path)?;
    let count = scene.object_instances.len() + scene.articulated_object_instances.len();
    if count > MAX_NODES {
        return Err(HousesError::TooLarge {
            at: at.field("object_instances"),
            what: "instance count",
            found: count as u64,
            allowed: MAX_NODES as u64,
        });
    }
    let name = scene_path.rsplit('/').next().unwrap_or(&scene_path);
    let name = name.strip_suffix(SCENE_ENDING).unwrap_or(name).to_owned();
    let (semantic_at, semantics, lexicon) = dataset.semantics(&name, &mut report);
    let regions = stage::regions(semantics, &semantic_at, &mut report);
    let mut reader = HabitatReader {
        dataset,
        threads,
        report: &mut report,
        data: HouseData {
            name,
            source: "habitat".to_owned(),
            ..HouseData::default()
        },
        assets: AssetCache::default(),
        robots: BTreeMap::new(),
        material_names: MaterialNames::default(),
        names: UniqueNames::default(),
        lexicon,
        origin: scene.translation_origin,
    };
    reader.stage(scene.stage_instance, &regions, &at);
    stage::rooms(&mut reader.data, &regions, &semantic_at, reader.report);
    for (k, value) in scene.object_instances.into_iter().enumerate() {
        interrupt::unwind_if_cancelled();
        let at = at.field(format_args!("object_instances[{k}]"));
        if let Some(instance) = reader.instance(value, &at) {
            reader.object(&instance, &at);
        }
    }
    for (k, value) in scene.articulated_object_instances.into_iter().enumerate() {
        interrupt::unwind_if_cancelled();
        let at = at.field(format_args!("articulated_object_instances[{k}]"));
        if let Some(instance) = reader.instance(value, &at) {
            reader.articulated(&instance, &at);
        }
    }
    if scene.default_lighting.is_some_and(|name| !name.is_empty()) {
        let what = "the scene's light set-up is not read".to_owned();
        reader.report.warn(
            at.field("default_lighting"),
            WarningKind::Simplified { what },
        );
    }
    let mut data = reader.data;
    stage::extend_empty_levels(&mut data);
    if data.meshes.iter().all(|mesh| mesh.triangles.is_empty()) {
        return Err(HousesError::empty(&at, &report));
    }
    drop_rooms_without_floor(&mut data, &semantic_at, &mut report);
    let house = House::new(data).map_err(HousesError::scene(&at))?;
    report_contained_rooms(&house, &semantic_at, &mut report);
    Ok((house, report))
}

/// The conversion of a scene into a house.
struct HabitatReader<'a> {
    dataset: Dataset,
    threads: Threads,
    report: &'a mut LoadReport,
    data: HouseData,
    assets: AssetCache,
    robots: BTreeMap<String, Result<Robot, String>>,
    material_names: MaterialNames,
    names: UniqueNames,
    /// Names by semantic id.
    lexicon: BTreeMap<i64, String>,
    /// Origin of the translations of instances that state none.
    origin: Option<String>,
}

impl HabitatReader<'_> {
    fn stage(&mut self, value: Value, regions: &[file::Region], at: &FileLocation) {
        let at = at.field("stage_instance");
        if value.is_null() {
            let consequence = "the scene has no walls and no floors".to_owned();
            return self
                .report
                .warn(at, WarningKind::MissingField { consequence });
        }
        let Some(instance) = self.instance(value, &at) else {
            return;
        };
        let Some(found) = self.template(TemplateKind::Stage, &instance.template_name, &at) else {
            return;
        };
        let Some(template) = self.parse::<Template>(&found) else {
            return;
        };
        let (pose, scale, frame) = match place::placement(&instance, &template) {
            Ok(placement) => placement,
            Err(reason) => return self.report.warn(at, WarningKind::BadTransform { reason }),
        };
        let Some(path) = AssetCache::path(&found, &template.render_asset, self.report) else {
            return;
        };
        let (root, threads) = (&self.dataset.root, self.threads);
        if let Some(pieces) =
            self.assets
                .asset_meshes(root, &path, &mut self.data, threads, self.report)
        {
            let world_from_stage = pose.to_affine() * glam::Affine3A::from_scale(scale) * frame;
            stage::structure(&mut self.data, &pieces, &world_from_stage, regions);
        }
    }

    /// An instance; `None`, reported, when a field is missing or of the wrong kind.
    fn instance(&mut self, value: Value, at: &FileLocation) -> Option<ObjectInstance> {
        serde_json::from_value(value)
            .map_err(|error| {
                let reason = crate::plain_parse_error(&error);
                self.report.warn(at.clone(), WarningKind::BadRow { reason });
            })
            .ok()
    }

    /// The template that an instance names; `None`, reported, when there is none.
    fn template(
        &mut self,
        kind: TemplateKind,
        name: &str,
        at: &FileLocation,
    ) -> Option<ResolvedTemplate> {
        let found = self.dataset.template(kind, name, self.report);
        if found.is_none() {
            let path = format!("{name} (a template)");
            self.report
                .warn(at.clone(), WarningKind::MissingMesh { path });
        }
        found
    }

    /// The attributes of a template; `None`, reported, when one is of the wrong kind.
    fn parse<T: DeserializeOwned>(&mut self, found: &ResolvedTemplate) -> Option<T> {
        serde_json::from_value(Value::Object(found.attributes.clone()))
            .map_err(|error| {
                let reason = crate::plain_parse_error(&error);
                self.report
                    .warn(found.at.clone(), WarningKind::BadRow { reason });
            })
            .ok()
    }
}
