//! The data set around a scene: its folder, its templates, its names.

use std::collections::BTreeMap;
use std::path::Path;

use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

use super::file::{DatasetFile, Lexicon, SemanticFile, TemplateSection};
use crate::data_root::{DataRoot, parent_folder};
use crate::error::HousesError;
use crate::json;
use crate::limits::{MAX_NODES, MAX_PATTERN_WORDS, MAX_TEXT_BYTES};
use crate::report::{FileLocation, LoadReport};
use crate::warning_kind::WarningKind;

/// Ending of the data set's own file.
const DATASET_ENDING: &str = ".scene_dataset_config.json";
/// Ending of a scene's file.
pub(super) const SCENE_ENDING: &str = ".scene_instance.json";
/// Largest number of folders from the scene up to the data set.
const MOST_STEPS: usize = 4;

/// Kinds of template, with the ending of their files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum TemplateKind {
    Stage,
    Object,
    Articulated,
    /// An articulated object that is a URDF alone.
    Urdf,
}

impl TemplateKind {
    /// The field of the data set's file that lists the folders of such templates.
    fn section_field(self) -> &'static str {
        match self {
            Self::Stage => "stages.paths",
            Self::Object => "objects.paths",
            Self::Articulated | Self::Urdf => "articulated_objects.paths",
        }
    }

    fn ending(self) -> &'static str {
        match self {
            Self::Stage => ".stage_config.json",
            Self::Object => ".object_config.json",
            Self::Articulated => ".ao_config.json",
            Self::Urdf => ".urdf",
        }
    }
}

/// The content of a template, and the folder from which its paths count.
#[derive(Debug, Clone)]
pub(super) struct ResolvedTemplate {
    pub(super) at: FileLocation,
    /// Relative to the root.
    pub(super) folder: String,
    pub(super) attributes: Map<String, Value>,
    /// The file itself, relative to the root; empty without one.
    pub(super) path: String,
}

/// A data set.
#[derive(Debug)]
pub(super) struct Dataset {
    pub(super) root: DataRoot,
    file: DatasetFile,
    /// The data set's file, relative to the root; empty without one.
    path: String,
    /// Files of templates by kind and the name before the ending.
    names: BTreeMap<&'static str, BTreeMap<String, Vec<String>>>,
}

impl Dataset {
    /// The data set of the scene at `path`, and the scene's own path in it. Without a data set's file up to four folders
    /// above, the scene's folder is taken, where templates are looked for by their paths alone.
    ///
    /// # Errors
    /// [`HousesError::Io`], [`HousesError::TooLarge`], and [`HousesError::Syntax`] when the data set's file is no JSON of
    /// that form.
    pub(super) fn find_for_scene(
        path: &Path,
        report: &mut LoadReport,
    ) -> Result<(Self, String), HousesError> {
        let real = path.canonicalize().map_err(HousesError::io(path))?;
        let folder = real.parent().unwrap_or_else(|| Path::new("/"));
        let mut base = (folder.to_owned(), String::new());
        for folder in folder.ancestors().take(1 + MOST_STEPS) {
            let root = DataRoot::new(folder)?;
            let found = root.list_folder("")?;
            if let Some(name) = found
                .into_iter()
                .find(|name| name.ends_with(DATASET_ENDING))
            {
                base = (folder.to_owned(), name);
                break;
            }
        }
        let (folder, config) = base;
        let inside = real.strip_prefix(&folder).unwrap_or(&real);
        let words = inside
            .components()
            .map(|word| word.as_os_str().to_string_lossy());
        let scene = words.collect::<Vec<_>>().join("/");
        let root = DataRoot::new(folder)?;
        let file = if config.is_empty() {
            DatasetFile::default()
        } else {
            read_json(&root, &config)?
        };
        let mut dataset = Self {
            root,
            file,
            path: config,
            names: BTreeMap::new(),
        };
        for kind in [
            TemplateKind::Stage,
            TemplateKind::Object,
            TemplateKind::Articulated,
            TemplateKind::Urdf,
        ] {
            // The paths of articulated objects are those of URDFs too, and reported once.
            let mut again = LoadReport::new();
            let report = if kind == TemplateKind::Urdf {
                &mut again
            } else {
                &mut *report
            };
            let paths = &dataset.section(kind).paths;
            let files = dataset.files(paths, kind.ending(), kind.section_field(), report);
            dataset.names.insert(kind.ending(), files);
        }
        Ok((dataset, scene))
    }

    fn section(&self, kind: TemplateKind) -> &TemplateSection {
        match kind {
            TemplateKind::Stage => &self.file.stages,
            TemplateKind::Object => &self.file.objects,
            TemplateKind::Articulated | TemplateKind::Urdf => &self.file.articulated_objects,
        }
    }

    /// Files that end in `ending` in the folders that `paths` names, by the name before the ending; patterns that are not followed
    /// are reported at `field`.
    fn files(
        &self,
        paths: &BTreeMap<String, Vec<String>>,
        ending: &str,
        field: &str,
        report: &mut LoadReport,
    ) -> BTreeMap<String, Vec<String>> {
        let mut found: BTreeMap<String, Vec<String>> = BTreeMap::new();
        let at = FileLocation::file(&self.path).field(field);
        for pattern in paths.values().flatten() {
            let refused = || WarningKind::PathRefused {
                path: pattern.clone(),
            };
            let folders = self.folders(pattern).unwrap_or_else(|damage| {
                report.warn(at.clone(), damage);
                Vec::new()
            });
            for folder in folders {
                let names = self.root.list_folder(&folder);
                if let Err(HousesError::PathLeavesRoot { .. }) = names {
                    report.warn(at.clone(), refused());
                }
                for name in names.unwrap_or_default() {
                    let path = join(&folder, &name);
                    if let Some(stem) = name.strip_suffix(ending) {
                        found.entry(stem.to_owned()).or_default().push(path);
                    }
                }
            }
        }
        for paths in found.values_mut() {
            paths.sort();
            paths.dedup();
        }
        found
    }

    /// The folders of a pattern: itself, or with `*` every folder of that place, and the place as well, whose files
    /// the star also matches.
    ///
    /// # Errors
    /// The fault of a pattern that is not followed.
    fn folders(&self, pattern: &str) -> Result<Vec<String>, WarningKind> {
        let Ok(clean) = DataRoot::resolve("", pattern) else {
            let path = pattern.to_owned();
            return Err(WarningKind::PathRefused { path });
        };
        let words = clean.split('/').count();
        if words > MAX_PATTERN_WORDS {
            let what = format!(
                "a pattern of {words} folders in each other is not followed; at most {MAX_PATTERN_WORDS} are"
            );
            return Err(WarningKind::Simplified { what });
        }
        let mut folders = vec![String::new()];
        for word in clean.split('/') {
            let mut next = Vec::new();
            for folder in &folders {
                if word.contains('*') {
                    next.push(folder.clone());
                    let names = self
                        .root
                        .list_folder(folder)
                        .unwrap_or_default()
                        .into_iter();
                    next.extend(names.map(|name| join(folder, &name)));
                } else {
                    next.push(join(folder, word));
                }
            }
            if next.len() > MAX_NODES {
                let found = next.len();
                let what = format!(
                    "pattern {pattern:?} is not followed: it means {found} folders; at most {MAX_NODES} are looked into"
                );
                return Err(WarningKind::Simplified { what });
            }
            folders = next;
        }
        Ok(folders)
    }

    /// The template of `name`: one of the data set's own, else the file whose path ends in it.
    pub(super) fn template(
        &self,
        kind: TemplateKind,
        name: &str,
        report: &mut LoadReport,
    ) -> Option<ResolvedTemplate> {
        let section = self.section(kind);
        let own = section
            .configs
            .iter()
            .find(|config| config.template_handle == name);
        let path = match own {
            Some(config) => config.original_file.clone(),
            None => Some(self.path_of(kind, name)?),
        };
        let mut found = ResolvedTemplate {
            at: FileLocation::file(path.as_ref().unwrap_or(&self.path)),
            folder: parent_folder(path.as_ref().unwrap_or(&self.path)).to_owned(),
            attributes: section.default_attributes.clone(),
            path: path.clone().unwrap_or_default(),
        };
        if let Some(path) = path.filter(|path| is_json(path)) {
            match read_json::<Map<String, Value>>(&self.root, &path) {
                Ok(attributes) => found.attributes.extend(attributes),
                Err(error) => {
                    let reason = error.reason();
                    report.warn(
                        found.at.clone(),
                        WarningKind::UnreadableMesh { path, reason },
                    );
                    return None;
                }
            }
        }
        if let Some(config) = own {
            // Paths that the data set's file states count from its folder.
            for (key, value) in &config.attributes {
                if key == "render_asset" || key == "collision_asset" || key == "urdf_filepath" {
                    found.folder = String::new();
                }
                found.attributes.insert(key.clone(), value.clone());
            }
        }
        Some(found)
    }

    fn path_of(&self, kind: TemplateKind, name: &str) -> Option<String> {
        let direct = DataRoot::resolve("", &format!("{name}{}", kind.ending())).ok()?;
        if self.root.exists(&direct) {
            return Some(direct);
        }
        let stem = name.rsplit('/').next().unwrap_or(name);
        let paths = self.names.get(kind.ending())?.get(stem)?;
        let ends = |path: &&String| {
            let stated = path.strip_suffix(kind.ending()).unwrap_or(path);
            stated == name || stated.ends_with(&format!("/{name}"))
        };
        paths.iter().find(ends).or_else(|| paths.first()).cloned()
    }

    /// The rooms of the scene named `scene`, and names by semantic id.
    pub(super) fn semantics(
        &self,
        scene: &str,
        report: &mut LoadReport,
    ) -> (FileLocation, SemanticFile, BTreeMap<i64, String>) {
        let table = &self.file.semantic_scene_descriptor_instances;
        let section: TemplateSection =
            serde_json::from_value(Value::Object(table.clone())).unwrap_or_default();
        let field = "semantic_scene_descriptor_instances.paths";
        let files = self.files(&section.paths, ".semantic_config.json", field, report);
        let path = files.get(scene).and_then(|paths| paths.first()).cloned();
        let mut rooms = SemanticFile::default();
        let mut at = FileLocation::file(&self.path);
        let mut lexicon = section
            .default_attributes
            .get("semantic_descriptor_filename")
            .and_then(Value::as_str)
            .map(str::to_owned);
        let mut folder = String::new();
        if let Some(path) = path {
            at = FileLocation::file(&path);
            parent_folder(&path).clone_into(&mut folder);
            match read_json::<SemanticFile>(&self.root, &path) {
                Ok(file) => {
                    lexicon = file.semantic_descriptor_filename.clone().or(lexicon);
                    rooms = file;
                }
                Err(error) => report.warn(
                    at.clone(),
                    WarningKind::UnreadableTable {
                        path,
                        reason: error.reason(),
                        consequence: "rooms are not known".to_owned(),
                    },
                ),
            }
        }
        let plain = || {
            table
                .values()
                .filter_map(Value::as_str)
                .find(|path| is_json(path))
        };
        let lexicon = lexicon
            .and_then(|path| DataRoot::resolve(&folder, &path).ok())
            .or_else(|| DataRoot::resolve("", plain()?).ok());
        let mut names = BTreeMap::new();
        if let Some(path) = lexicon {
            match read_json::<Lexicon>(&self.root, &path) {
                Ok(file) => {
                    names.extend(file.classes.into_iter().map(|class| (class.id, class.name)));
                }
                Err(error) => {
                    let consequence = "semantic ids have no names".to_owned();
                    let at = FileLocation::file(&path);
                    let damage = if self.root.exists(&path) {
                        let reason = error.reason();
                        WarningKind::UnreadableTable {
                            path,
                            reason,
                            consequence,
                        }
                    } else {
                        WarningKind::MissingTable { path, consequence }
                    };
                    report.warn(at, damage);
                }
            }
        }
        (at, rooms, names)
    }
}

/// The JSON file at a path inside the root.
///
/// # Errors
/// Those of [`DataRoot::read`], and [`HousesError::Syntax`].
pub(super) fn read_json<T: DeserializeOwned>(
    root: &DataRoot,
    path: &str,
) -> Result<T, HousesError> {
    let bytes = root.read(path, MAX_TEXT_BYTES)?;
    json::from_slice(&bytes).map_err(json::syntax(&FileLocation::file(path)))
}

fn is_json(path: &str) -> bool {
    Path::new(path)
        .extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case("json"))
}

fn join(folder: &str, name: &str) -> String {
    if folder.is_empty() {
        name.to_owned()
    } else {
        format!("{folder}/{name}")
    }
}
