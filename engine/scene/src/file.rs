//! Reading of untrusted files, and writing of files and folders.
//!
//! Opening a named pipe waits for a writer, and a device may have no end; so only regular files are read, to a cap. Only
//! regular files are replaced, and a file appears whole or not at all.

use crate::interrupt::{self, CancelPoller};
use std::fs::{self, File, Metadata, OpenOptions, TryLockError};
use std::io::{self, Read as _};
use std::path::{Path, PathBuf};

/// Deepest nesting of JSON, `serde_json`'s own limit.
pub const MAX_JSON_DEPTH: usize = 128;
/// Most drafts of one name at the same time.
const MOST_DRAFTS: usize = 10_000;
/// Bytes of the target's name that a draft's name keeps; names have 255 at most.
const DRAFT_NAME_BYTES: usize = 200;
/// Bytes that are written between checks for cancellation.
const PIECE_BYTES: usize = 1 << 20;

/// The reason why a file was not read.
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    /// The system refuses, or it is no regular file.
    #[error("{0}")]
    Io(#[from] io::Error),
    /// More bytes than allowed.
    #[error("{found} bytes; at most {allowed} are read")]
    TooLarge {
        /// Its size, bytes; of a file that grows, more than are allowed.
        found: u64,
        /// Most bytes that are read.
        allowed: u64,
    },
}

/// Opens a regular file of at most `max_bytes`, without ever blocking.
///
/// The file may still grow while it is read: callers [take](io::Read::take) at most `max_bytes`.
///
/// # Errors
/// [`ReadError::Io`] when the system refuses and for what is no regular file, [`ReadError::TooLarge`].
pub fn open(path: &Path, max_bytes: u64) -> Result<File, ReadError> {
    // Opening a device can have effects, so its type is checked first.
    regular(&fs::metadata(path)?)?;
    let file = open_nonblocking(path)?;
    let meta = file.metadata()?;
    // The path may have been replaced since.
    regular(&meta)?;
    let (found, allowed) = (meta.len(), max_bytes);
    if found > allowed {
        return Err(ReadError::TooLarge { found, allowed });
    }
    Ok(file)
}

/// Reads a regular file of at most `max_bytes`.
///
/// # Errors
/// Those of [`open`].
pub fn read(path: &Path, max_bytes: u64) -> Result<Vec<u8>, ReadError> {
    let file = open(path, max_bytes)?;
    let length = file.metadata()?.len().min(max_bytes);
    let mut bytes = Vec::with_capacity(length as usize + 1);
    // A file that grows while it is read still ends at the cap.
    file.take(max_bytes + 1).read_to_end(&mut bytes)?;
    let found = bytes.len() as u64;
    if found > max_bytes {
        let allowed = max_bytes;
        return Err(ReadError::TooLarge { found, allowed });
    }
    Ok(bytes)
}

/// Writes a file under another name and moves it into place.
///
/// A link is followed where it leads to a regular file, which is replaced.
///
/// # Errors
/// When the system refuses, and where the path is no regular file; it is then left as it is.
pub fn write(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let place = resolve_write_target(path)?;
    let mut draft = StagedPath::file(&place)?;
    write_in_pieces(&mut draft.handle, bytes)?;
    fs::rename(&draft.path, &place)
}

/// Writes all bytes; can be cancelled between pieces: see [`interrupt`].
///
/// # Errors
/// When the system refuses.
pub fn write_in_pieces(to: &mut impl io::Write, bytes: &[u8]) -> io::Result<()> {
    for piece in bytes.chunks(PIECE_BYTES) {
        interrupt::unwind_if_cancelled();
        to.write_all(piece)?;
    }
    Ok(())
}

/// What can be cancelled whenever a number of bytes has passed: for code of others that reads or writes much.
#[derive(Debug)]
pub struct CancellableStream<T> {
    stream: T,
    poller: CancelPoller,
}

impl<T> CancellableStream<T> {
    /// A stream that is passed on.
    pub fn new(stream: T) -> Self {
        Self {
            stream,
            poller: CancelPoller::new(PIECE_BYTES / 16),
        }
    }

    /// Returns the stream.
    pub fn into_inner(self) -> T {
        self.stream
    }
}

impl<T: io::Read> io::Read for CancellableStream<T> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.stream.read(buffer)?;
        self.poller.count_many(count);
        Ok(count)
    }
}

impl<T: io::Write> io::Write for CancellableStream<T> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let count = self.stream.write(bytes)?;
        self.poller.count_many(count);
        Ok(count)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.stream.flush()
    }
}

/// Returns the path that a file written to `path` will have: another one when `path` is a link.
///
/// # Errors
/// When the path is no regular file, or a dangling link.
fn resolve_write_target(path: &Path) -> io::Result<PathBuf> {
    let meta = match fs::symlink_metadata(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(path.to_owned()),
        meta => meta?,
    };
    if !meta.is_symlink() {
        regular(&meta)?;
        return Ok(path.to_owned());
    }
    let real = fs::canonicalize(path).map_err(|error| {
        let what = format!("is a link that leads to no file: {error}");
        io::Error::new(error.kind(), what)
    })?;
    regular(&fs::metadata(&real)?)?;
    Ok(real)
}

/// A file or folder under construction, beside its target. It is removed when dropped before it was moved.
///
/// Its lock shows that its process is alive: a new draft of the same name removes those of processes that were killed.
#[derive(Debug)]
pub struct StagedPath {
    path: PathBuf,
    /// Holds the lock, which the system releases when the process ends.
    handle: File,
}

impl StagedPath {
    /// An empty file beside `place`.
    ///
    /// # Errors
    /// When the system refuses.
    fn file(place: &Path) -> io::Result<Self> {
        let make = |path: &Path| OpenOptions::new().write(true).create_new(true).open(path);
        Self::claim(place, make, |path| fs::remove_file(path))
    }

    /// An empty folder beside `place`; the folders above it are made where they are missing.
    ///
    /// # Errors
    /// When the system refuses.
    pub fn folder(place: &Path) -> io::Result<Self> {
        if let Some(above) = place.parent() {
            fs::create_dir_all(above)?;
        }
        let make = |path: &Path| fs::create_dir(path).and_then(|()| open_nonblocking(path));
        Self::claim(place, make, |path| fs::remove_dir_all(path))
    }

    /// Returns its path.
    pub fn path(&self) -> &Path {
        &self.path
    }

    fn claim(
        place: &Path,
        make: impl Fn(&Path) -> io::Result<File>,
        remove: impl Fn(&Path) -> io::Result<()>,
    ) -> io::Result<Self> {
        for number in 0..MOST_DRAFTS {
            let path = draft_name(place, number);
            let made = match make(&path) {
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
                    // The lock is held until it is removed, so that nobody removes its successor.
                    let Some(held) = lock_abandoned_draft(&path) else {
                        continue;
                    };
                    if remove(&path).is_err() {
                        continue;
                    }
                    drop(held);
                    make(&path)
                }
                made => made,
            };
            match made {
                Ok(handle) => {
                    // Some file systems have no locks; drafts there are never removed.
                    let is_held = matches!(handle.try_lock(), Err(TryLockError::WouldBlock));
                    if !is_held && is_at(&handle, &path) {
                        return Ok(Self { path, handle });
                    }
                }
                // Another process was faster.
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                Err(error) => return Err(error),
            }
        }
        let what = format!("{MOST_DRAFTS} drafts of this name are in the making");
        Err(io::Error::new(io::ErrorKind::AlreadyExists, what))
    }
}

impl Drop for StagedPath {
    fn drop(&mut self) {
        // Once moved into place it is no draft any more, and another one may have its name.
        if is_at(&self.handle, &self.path) {
            let is_folder = self.handle.metadata().is_ok_and(|meta| meta.is_dir());
            let remove = if is_folder {
                fs::remove_dir_all
            } else {
                fs::remove_file
            };
            // An error here has no receiver; the next draft of this name tries again.
            let _ = remove(&self.path);
        }
    }
}

/// The name of a draft: hidden, and never too long.
fn draft_name(place: &Path, number: usize) -> PathBuf {
    let name = place.file_name().unwrap_or_default().to_string_lossy();
    let name = &name[..name.floor_char_boundary(DRAFT_NAME_BYTES)];
    place.with_file_name(format!(".{name}.partial-{number}"))
}

/// Returns the lock of a draft whose process has ended.
fn lock_abandoned_draft(path: &Path) -> Option<File> {
    let meta = fs::symlink_metadata(path).ok()?;
    if !meta.is_file() && !meta.is_dir() {
        return None;
    }
    let handle = open_nonblocking(path).ok()?;
    (handle.try_lock().is_ok() && is_at(&handle, path)).then_some(handle)
}

/// Returns whether a handle is that of the file now at `path`.
#[cfg(unix)]
fn is_at(handle: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt as _;
    let same = |a: Metadata, b: Metadata| (a.dev(), a.ino()) == (b.dev(), b.ino());
    let there = fs::symlink_metadata(path);
    handle
        .metadata()
        .is_ok_and(|own| there.is_ok_and(|there| same(own, there)))
}

#[cfg(not(unix))]
fn is_at(_: &File, path: &Path) -> bool {
    path.exists()
}

/// Opens for reading without blocking: folders, too, and named pipes without a writer.
fn open_nonblocking(path: &Path) -> io::Result<File> {
    let mut options = OpenOptions::new();
    options.read(true);
    #[cfg(unix)]
    {
        use std::os::unix::fs::OpenOptionsExt as _;
        options.custom_flags(libc::O_NONBLOCK);
    }
    #[cfg(windows)]
    {
        use std::os::windows::fs::OpenOptionsExt as _;
        // FILE_FLAG_BACKUP_SEMANTICS: folders can be opened, too.
        options.custom_flags(0x0200_0000);
    }
    options.open(path)
}

/// Refuses anything but a regular file.
fn regular(meta: &Metadata) -> io::Result<()> {
    if meta.is_file() {
        return Ok(());
    }
    let what = format!("is {}, not a regular file", kind(meta));
    Err(io::Error::new(io::ErrorKind::InvalidInput, what))
}

#[cfg(unix)]
fn kind(meta: &Metadata) -> &'static str {
    use std::os::unix::fs::FileTypeExt as _;
    let kind = meta.file_type();
    match kind {
        _ if kind.is_dir() => "a folder",
        _ if kind.is_fifo() => "a named pipe",
        _ if kind.is_socket() => "a socket",
        _ => "a device",
    }
}

#[cfg(not(unix))]
fn kind(meta: &Metadata) -> &'static str {
    if meta.is_dir() {
        "a folder"
    } else {
        "a device"
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::os::unix::fs::symlink;

    fn pipe(path: &Path) {
        let made = std::process::Command::new("mkfifo").arg(path).status();
        assert!(made.is_ok_and(|status| status.success()));
    }

    #[test]
    fn what_is_no_regular_file_is_neither_read_nor_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        pipe(&at("pipe"));
        fs::create_dir(at("folder")).unwrap();
        symlink("/dev/null", at("device")).unwrap();
        symlink("nowhere", at("nowhere-link")).unwrap();
        for (name, said) in [
            ("pipe", "a named pipe"),
            ("folder", "a folder"),
            ("device", "a device"),
        ] {
            let told = read(&at(name), 10).unwrap_err().to_string();
            assert_eq!(told, format!("is {said}, not a regular file"));
            let told = write(&at(name), b"x").unwrap_err().to_string();
            assert_eq!(told, format!("is {said}, not a regular file"));
            assert!(!fs::symlink_metadata(at(name)).unwrap().is_file());
        }
        let told = write(&at("nowhere-link"), b"x").unwrap_err().to_string();
        assert!(told.contains("leads to no file"), "{told}");
        // No draft is left.
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 4);
    }

    #[test]
    fn devices_without_an_end_are_refused() {
        let told = read(Path::new("/dev/zero"), 10).unwrap_err().to_string();
        assert_eq!(told, "is a device, not a regular file");
    }

    #[test]
    fn a_file_above_the_cap_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        write(&path, b"12345").unwrap();
        assert_eq!(read(&path, 5).unwrap(), b"12345");
        let told = read(&path, 4).unwrap_err().to_string();
        assert_eq!(told, "5 bytes; at most 4 are read");
    }

    #[test]
    fn a_link_to_a_file_is_followed_and_stays_a_link() {
        let folder = tempfile::tempdir().unwrap();
        let (path, link) = (folder.path().join("a"), folder.path().join("link"));
        write(&path, b"old").unwrap();
        symlink(&path, &link).unwrap();
        write(&link, b"new").unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(read(&path, 10).unwrap(), b"new");
    }

    #[test]
    fn a_file_stays_as_it_was_where_its_writing_is_stopped() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        write(&path, b"old").unwrap();
        let stopped = interrupt::interruptible(
            || true,
            || {
                std::thread::sleep(2 * interrupt::INTERVAL);
                write(&path, b"new")
            },
        );
        assert!(stopped.is_err());
        assert_eq!(read(&path, 3).unwrap(), b"old");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn what_passes_a_stream_that_can_be_stopped_stays_the_same() {
        let bytes: Vec<u8> = (0..PIECE_BYTES / 4).map(|k| k as u8).collect();
        let mut written = CancellableStream::new(Vec::new());
        io::copy(&mut CancellableStream::new(bytes.as_slice()), &mut written).unwrap();
        assert!(written.into_inner() == bytes);
        let mut pieces = Vec::new();
        write_in_pieces(&mut pieces, &bytes.repeat(9)).unwrap();
        assert!(pieces == bytes.repeat(9));
    }

    #[test]
    fn the_longest_name_that_the_system_allows_can_be_written() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("ä".repeat(127));
        write(&path, b"x").unwrap();
        assert_eq!(read(&path, 1).unwrap(), b"x");
    }

    #[test]
    fn drafts_of_the_living_stay_and_those_of_the_dead_go() {
        let folder = tempfile::tempdir().unwrap();
        let place = folder.path().join("house");
        // The draft of a killed process: nobody holds its lock.
        let left = folder.path().join(".house.partial-0");
        fs::create_dir(&left).unwrap();
        fs::write(left.join("mesh"), "half").unwrap();
        let mine = StagedPath::folder(&place).unwrap();
        assert_eq!(mine.path(), left);
        assert_eq!(fs::read_dir(&left).unwrap().count(), 0);
        let other = StagedPath::folder(&place).unwrap();
        assert_ne!(mine.path(), other.path());
        assert!(mine.path().exists());
        drop((mine, other));
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
        // A folder in the way of a file's draft stays.
        fs::create_dir(&left).unwrap();
        write(&place, b"x").unwrap();
        assert!(place.is_file() && left.is_dir());
    }
}
