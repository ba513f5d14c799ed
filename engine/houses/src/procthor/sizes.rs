//! Sizes of assets: `asset-database.json`, as the package `procthor` ships it.

use std::collections::BTreeMap;
use std::path::Path;

use glam::Vec3;

use super::file::AssetsFile;
use crate::data_root::DataRoot;
use crate::limits::MAX_TEXT_BYTES;
use crate::report::{FileLocation, LoadReport};
use crate::warning_kind::WarningKind;

/// The file's name.
const FILE: &str = "asset-database.json";
/// Number of folders that are searched: the house's own, and those above.
const FOLDERS: usize = 3;

/// Type and size of each asset.
#[derive(Debug, Default)]
pub(super) struct AssetSizes {
    known: BTreeMap<String, (String, Vec3)>,
}

impl AssetSizes {
    /// Reads the nearest file at or above `folder`; a missing one is no fault, an unreadable one is reported.
    pub(super) fn read_near(folder: &Path, report: &mut LoadReport) -> Self {
        let folder = folder.canonicalize().unwrap_or_default();
        let mut folders = folder.ancestors().take(FOLDERS);
        let Some(folder) = folders.find(|folder| folder.join(FILE).is_file()) else {
            return Self::default();
        };
        // It belongs to the folder that it is in: a link out of there is not followed.
        let text = DataRoot::new(folder)
            .and_then(|root| root.read(FILE, MAX_TEXT_BYTES))
            .map_err(|error| error.reason());
        match text.and_then(|text| Self::read(&text)) {
            Ok(sizes) => sizes,
            Err(reason) => {
                let what = format!("the table of assets is not read: {reason}");
                report.warn(FileLocation::file(FILE), WarningKind::Simplified { what });
                Self::default()
            }
        }
    }

    /// Reads the table; impossible sizes are left out.
    fn read(text: &[u8]) -> Result<Self, String> {
        let file: AssetsFile = crate::json::from_slice(text).map_err(crate::plain_parse_error)?;
        let mut known = BTreeMap::new();
        for (kind, assets) in file {
            for asset in assets {
                let size = asset.bounding_box;
                let size = Vec3::new(size.x, size.y, size.z);
                if size.is_finite() && size.min_element() > 1e-3 && size.max_element() < 20.0 {
                    known.insert(asset.asset_id, (kind.clone(), size));
                }
            }
        }
        Ok(Self { known })
    }

    /// Type, and width, height and depth in m, of an asset.
    pub(super) fn get(&self, asset: &str) -> Option<(&str, Vec3)> {
        let (kind, size) = self.known.get(asset)?;
        Some((kind, *size))
    }
}
