//! Sound files of the user. The house carries them as they are; playback decodes them.

use std::sync::Arc;

use dwell_scene::{IdVec, SoundFile, SoundFileId};

use super::edit_errors::invalid_field;
use super::files::FileAccess;
use crate::data_root::UserFile;
use crate::error::HousesError;

/// Magic numbers of the file formats: WAV, FLAC, Ogg.
const BEGINNINGS: [&[u8]; 3] = [b"RIFF", b"fLaC", b"OggS"];

/// Reads a sound file.
///
/// # Errors
/// [`HousesError::PathLeavesRoot`], [`HousesError::Io`], [`HousesError::TooLarge`] above [`SoundFile::MAX_BYTES`], and
/// [`HousesError::Spec`] for a file of another form.
pub(super) fn read_sound_file(files: &FileAccess, file: &str) -> Result<SoundFile, HousesError> {
    let path = files.resolve_path("file", file)?;
    let UserFile { name, bytes, .. } = UserFile::read(&path, SoundFile::MAX_BYTES)?;
    if !BEGINNINGS.iter().any(|begin| bytes.starts_with(begin)) {
        let begins: Vec<u8> = bytes.iter().copied().take(4).collect();
        let begins = String::from_utf8_lossy(&begins);
        return Err(invalid_field(
            "file",
            format_args!("{file:?}, which begins with {begins:?}"),
            "WAV (\"RIFF\"), FLAC (\"fLaC\") or Ogg Vorbis (\"OggS\")",
        ));
    }
    Ok(SoundFile { name, bytes })
}

/// The id of a sound file: of one with the same name and bytes, else of a new one with a name that was free.
pub(super) fn add_or_find(
    table: &mut IdVec<SoundFileId, Arc<SoundFile>>,
    mut sound: Arc<SoundFile>,
) -> SoundFileId {
    let own = sound.name.clone();
    let (stem, ending) = own.rsplit_once('.').unwrap_or((&own, "sound"));
    let mut number = 1;
    loop {
        let known = table.iter_ids().find(|(_, other)| other.name == sound.name);
        match known {
            None => return table.push(sound),
            Some((id, other)) if *other == sound => return id,
            Some(_) => {}
        }
        number += 1;
        Arc::make_mut(&mut sound).name = format!("{stem}_{number}.{ending}");
    }
}
