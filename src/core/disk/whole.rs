//! Atomic replacement of a file: temporary file in the same folder, fsync, rename.
//!
//! POSIX `rename` replaces the old name by the new file in one step, so a reader, a crash or
//! a full disk meets the whole old file or the whole new one, never a part (Pillai et al.,
//! *All file systems are not created equal*, OSDI 2014: the content is flushed before the
//! rename, the folder after it). Whatever fails, the temporary file is removed again.

use std::ffi::OsString;
use std::fs::{self, File, Metadata, OpenOptions};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Temporary names that are tried before giving up: as many may be left of killed programs.
const TRIES: usize = 100;

/// Writes a file as a whole or not at all: `fill` writes the content; the file at `path` is
/// what it was before until all of it is on the disk. A symbolic link stays one, and what it
/// points to is replaced; what is no regular file (a pipe, a terminal, `/dev/null`) is
/// written to as it stands.
///
/// # Errors
///
/// What the system says, or `fill` returns; no temporary file is left then.
///
/// # Example
///
/// ```
/// use std::io::{Error, Write};
/// use lacuna::file::{write_text, write_whole};
///
/// let path = std::env::temp_dir().join(format!("lacuna-whole-{}.txt", std::process::id()));
/// write_text(&path, "before\n")?;
/// let broken = write_whole(&path, |to| {
///     to.write_all(b"aft")?;
///     Err(Error::other("the disk is full"))
/// });
/// assert!(broken.is_err());
/// assert_eq!(std::fs::read_to_string(&path)?, "before\n");
/// std::fs::remove_file(&path)?;
/// # Ok::<(), std::io::Error>(())
/// ```
pub fn write_whole(
    path: &Path,
    fill: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    let Some((path, before)) = replaced(path)? else {
        let mut to = BufWriter::new(OpenOptions::new().write(true).open(path)?);
        fill(&mut to)?;
        return to.flush();
    };
    let (part, file) = temporary_file(&path)?;
    let written = fill_and_flush(file, fill).and_then(|()| {
        if let Some(before) = before {
            fs::set_permissions(&part, before.permissions())?;
        }
        fs::rename(&part, &path)
    });
    if written.is_err() {
        // what failed is told; that nothing is left beside is all that can be done
        let _ = fs::remove_file(&part);
        return written;
    }
    flush_folder(&path);
    Ok(())
}

/// Whether a file could be written by [`write_whole`]: nothing is left of the try.
///
/// # Errors
///
/// What [`write_whole`] would end with.
pub fn try_write(path: &Path) -> io::Result<()> {
    let Some((path, _)) = replaced(path)? else { return Ok(()) };
    let (part, _) = temporary_file(&path)?;
    fs::remove_file(part)
}

/// The file that a path stands for, and what it was where there is one; `None` for a pipe or a device, which
/// is written to as it stands.
fn replaced(path: &Path) -> io::Result<Option<(PathBuf, Option<Metadata>)>> {
    match fs::metadata(path) {
        Ok(found) if found.is_dir() => Err(ErrorKind::IsADirectory.into()),
        // a file that must not be written to is not replaced either
        Ok(found) if found.is_file() && found.permissions().readonly() => {
            Err(ErrorKind::PermissionDenied.into())
        }
        Ok(found) if found.is_file() => Ok(Some((fs::canonicalize(path)?, Some(found)))),
        Ok(_) => Ok(None),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(Some((path.to_path_buf(), None))),
        Err(error) => Err(error),
    }
}

/// Writes a text as [`write_whole`] does.
///
/// # Errors
///
/// As [`write_whole`].
pub fn write_text(path: &Path, text: &str) -> io::Result<()> {
    write_whole(path, |to| to.write_all(text.as_bytes()))
}

/// What to try where a file could not be written: a sentence that is true of the reason.
pub fn write_hint(error: &io::Error) -> &'static str {
    match error.kind() {
        ErrorKind::StorageFull | ErrorKind::QuotaExceeded | ErrorKind::FileTooLarge => {
            "free space on that disk, or choose a folder on another one"
        }
        ErrorKind::ReadOnlyFilesystem => {
            "that file system is read-only: choose a folder on another one"
        }
        ErrorKind::PermissionDenied => "choose a folder and a file that you may write to",
        ErrorKind::NotADirectory | ErrorKind::IsADirectory | ErrorKind::AlreadyExists => {
            "a file and a folder cannot have one name: choose another one"
        }
        ErrorKind::InvalidInput | ErrorKind::InvalidFilename => {
            "choose a name that a file can have"
        }
        _ => "choose a folder that exists and that you may write to",
    }
}

fn fill_and_flush(
    file: File,
    fill: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    let mut to = BufWriter::new(file);
    fill(&mut to)?;
    to.into_inner().map_err(io::IntoInnerError::into_error)?.sync_all()
}

/// A new file beside another, under a name that nothing has.
fn temporary_file(path: &Path) -> io::Result<(PathBuf, File)> {
    static NEXT: AtomicUsize = AtomicUsize::new(0);
    let name = path
        .file_name()
        .ok_or_else(|| io::Error::new(ErrorKind::InvalidInput, "the path names no file"))?;
    let mut last = None;
    for _ in 0..TRIES {
        let number = NEXT.fetch_add(1, Ordering::Relaxed);
        let mut part = OsString::from(".");
        part.push(name);
        part.push(format!(".{}-{number}.part", std::process::id()));
        let part = path.with_file_name(part);
        match OpenOptions::new().write(true).create_new(true).open(&part) {
            Ok(file) => return Ok((part, file)),
            Err(error) if error.kind() == ErrorKind::AlreadyExists => last = Some(error),
            Err(error) => return Err(error),
        }
    }
    Err(last.unwrap_or_else(|| ErrorKind::AlreadyExists.into()))
}

/// Makes the rename last through a power cut, where a folder can be opened; the file itself is
/// whole without it.
fn flush_folder(path: &Path) {
    if cfg!(unix)
        && let Some(folder) = path.parent()
        && let Ok(folder) =
            File::open(if folder.as_os_str().is_empty() { Path::new(".") } else { folder })
    {
        let _ = folder.sync_all();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A disk with so many bytes left.
    struct Filling<'a> {
        to: &'a mut dyn Write,
        left: usize,
    }

    impl Write for Filling<'_> {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            if self.left == 0 {
                return Err(ErrorKind::StorageFull.into());
            }
            let taken = self.to.write(&bytes[..bytes.len().min(self.left)])?;
            self.left -= taken;
            Ok(taken)
        }

        fn flush(&mut self) -> io::Result<()> {
            self.to.flush()
        }
    }

    fn folder(name: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("lacuna-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        folder
    }

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap();
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
    }

    #[test]
    fn a_disk_that_fills_at_any_byte_leaves_the_old_file_and_nothing_else() {
        let folder = folder("fills");
        let (old, new) = ("old\n".repeat(10), "new and longer\n".repeat(2000));
        let (there, fresh) = (folder.join("a.txt"), folder.join("b.txt"));
        write_text(&there, &old).unwrap();
        for left in (0..new.len()).step_by(997).chain([0, 1, new.len() - 1]) {
            for path in [&there, &fresh] {
                let error = write_whole(path, |to| Filling { to, left }.write_all(new.as_bytes()));
                assert_eq!(error.unwrap_err().kind(), ErrorKind::StorageFull);
            }
            assert_eq!(fs::read_to_string(&there).unwrap(), old);
            assert_eq!(names(&folder), ["a.txt"], "{left}");
        }
        write_whole(&there, |to| Filling { to, left: new.len() }.write_all(new.as_bytes()))
            .unwrap();
        assert_eq!(fs::read_to_string(&there).unwrap(), new);
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn a_try_ends_as_writing_would_and_leaves_nothing() {
        let folder = folder("try");
        try_write(&folder.join("new.txt")).unwrap();
        assert!(names(&folder).is_empty());
        write_text(&folder.join("old.txt"), "old").unwrap();
        try_write(&folder.join("old.txt")).unwrap();
        assert_eq!(names(&folder), ["old.txt"]);
        assert_eq!(fs::read_to_string(folder.join("old.txt")).unwrap(), "old");
        assert!(try_write(&folder).is_err() && try_write(&folder.join("no/such.txt")).is_err());
        if cfg!(unix) {
            // what is written to as it stands needs no room beside it
            try_write(Path::new("/dev/null")).unwrap();
        }
        fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn what_is_no_file_is_no_target() {
        let folder = folder("target");
        assert!(write_text(&folder, "x").is_err());
        assert!(write_text(&folder.join("no/such/f.txt"), "x").is_err());
        assert!(write_text(Path::new(""), "x").is_err());
        assert!(names(&folder).is_empty());
        fs::remove_dir_all(folder).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn links_devices_and_permissions_stay_what_they_are() {
        use std::os::unix::fs::{FileTypeExt, PermissionsExt, symlink};
        let folder = folder("links");
        let (real, link) = (folder.join("real.txt"), folder.join("link.txt"));
        write_text(&real, "old").unwrap();
        fs::set_permissions(&real, fs::Permissions::from_mode(0o640)).unwrap();
        symlink(&real, &link).unwrap();
        write_text(&link, "new").unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read_to_string(&real).unwrap(), "new");
        assert_eq!(fs::metadata(&real).unwrap().permissions().mode() & 0o777, 0o640);
        write_text(Path::new("/dev/null"), "gone").unwrap();
        assert!(fs::metadata("/dev/null").unwrap().file_type().is_char_device());
        fs::remove_dir_all(folder).unwrap();
    }
}
