//! Reading with a bound: from regular files only, and no more than memory is meant to hold.
//!
//! A pipe without a writer blocks for ever, a device such as `/dev/zero` never ends, and a few
//! kilobytes of gzip may unpack to gigabytes (DEFLATE packs up to 1032 times, RFC 1951).

use std::fs::File;
use std::io::{self, ErrorKind, Read};
use std::path::Path;

/// Bytes of a model, configuration, checkpoint or weights file, at most.
const TEXT: u64 = 1 << 30;
/// Bytes of a record, at most: some hundred million values.
const RECORD: u64 = 8 << 30;
/// How many times a file may grow by unpacking; numbers as text pack three to ten times.
const GROWS: u64 = 200;
/// Unpacked bytes below which a file may have packed as well as it likes.
const HARMLESS: u64 = 64 << 20;

/// Opens a regular file, and nothing else.
pub(crate) fn open(path: &Path) -> io::Result<File> {
    let found = std::fs::metadata(path)?;
    if found.is_dir() {
        return Err(io::Error::new(ErrorKind::InvalidInput, "it is a folder"));
    }
    if !found.is_file() {
        return Err(io::Error::new(ErrorKind::InvalidInput, "it is a pipe or a device, no file"));
    }
    File::open(path)
}

/// All bytes of a text file.
///
/// # Errors
///
/// If it is no regular file, cannot be read, or is larger than a gigabyte.
pub fn read_regular(path: &Path) -> io::Result<Vec<u8>> {
    bounded(open(path)?, TEXT)
}

/// All bytes of a record.
pub(crate) fn read_record(from: impl Read) -> io::Result<Vec<u8>> {
    bounded(from, RECORD)
}

/// Unpacks gzip, one stream after the other.
pub(crate) fn unpack(bytes: &[u8]) -> io::Result<Vec<u8>> {
    let most = (GROWS * bytes.len() as u64).clamp(HARMLESS, RECORD);
    bounded(flate2::read::MultiGzDecoder::new(bytes), most)
}

fn bounded(from: impl Read, most: u64) -> io::Result<Vec<u8>> {
    let mut bytes = vec![];
    let count = from.take(most + 1).read_to_end(&mut bytes)?;
    if count as u64 > most {
        let said = format!("it holds more than {} MB, which is the most that is read", most >> 20);
        return Err(io::Error::new(ErrorKind::FileTooLarge, said));
    }
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    #[test]
    fn a_bomb_is_not_unpacked_and_a_record_is() {
        let packed = |bytes: &[u8]| {
            let mut to = flate2::write::GzEncoder::new(vec![], flate2::Compression::best());
            to.write_all(bytes).unwrap();
            to.finish().unwrap()
        };
        let bomb = packed(&vec![b'0'; (HARMLESS + 2) as usize]);
        assert!(bomb.len() < 100_000);
        assert_eq!(unpack(&bomb).unwrap_err().kind(), ErrorKind::FileTooLarge);
        let text: String = (0..1000).map(|k| format!("{k},{}\n", f64::from(k).sin())).collect();
        assert_eq!(unpack(&packed(text.as_bytes())).unwrap(), text.as_bytes());
    }

    #[test]
    fn what_never_ends_or_never_begins_is_not_read() {
        assert!(bounded(io::repeat(0), 1 << 20).is_err());
        assert!(open(&std::env::temp_dir()).is_err());
        if cfg!(unix) {
            for device in ["/dev/zero", "/dev/null"] {
                assert!(open(Path::new(device)).is_err());
            }
        }
    }
}
