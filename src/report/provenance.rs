//! Where a result is from: program, command, files with checksums, seed, date.
//!
//! A result of last week can be attributed, and made again, by these alone (FAIR principle R1.2: data
//! have a detailed provenance; Wilkinson et al., Scientific Data 3, 2016). The date stands in the page only,
//! so that the document of the same call is the same but for the seconds that it took.

use std::io::Read;
use std::path::Path;
use std::time::SystemTime;

use serde::Serialize;
use sha2::{Digest, Sha256};

/// A file that was handed in.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct FileUsed {
    /// What it served as: `model`, `data`, `test`.
    pub role: String,
    /// Its path, as it was given.
    pub path: String,
    /// SHA-256 of its bytes, in hexadecimal digits.
    pub sha256: String,
    /// Its size in bytes.
    pub bytes: u64,
}

/// Where a result is from.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize)]
pub struct Provenance {
    /// Program and its version.
    pub program: String,
    /// The command, without what changes no result: the number of threads, the folder of results, how
    /// much is shown.
    pub command: String,
    /// Files that were handed in.
    pub files: Vec<FileUsed>,
    /// Seed of all random numbers.
    pub seed: u64,
    /// When it was made: UTC, to the second, as RFC 3339 writes it. Not part of what is the same from
    /// run to run.
    #[serde(skip)]
    pub date: String,
}

impl Provenance {
    /// Of a program and its command, now.
    pub fn new(program: &str, command: &str, seed: u64) -> Self {
        let date = humantime::format_rfc3339_seconds(SystemTime::now()).to_string();
        let (program, command) = (program.into(), command.into());
        Self { program, command, files: vec![], seed, date }
    }

    /// The same with a file, read once more for its checksum.
    ///
    /// # Errors
    ///
    /// If the file cannot be read.
    pub fn file(mut self, role: &str, path: &Path) -> std::io::Result<Self> {
        let (sha256, bytes) = checksum(std::fs::File::open(path)?)?;
        let path = path.display().to_string();
        self.files.push(FileUsed { role: role.into(), path, sha256, bytes });
        Ok(self)
    }

    /// The same with bytes that the program brings along.
    #[must_use]
    pub fn embedded(mut self, role: &str, name: &str, bytes: &[u8]) -> Self {
        self.files.push(FileUsed {
            role: role.into(),
            path: name.into(),
            sha256: hex(&Sha256::digest(bytes)),
            bytes: bytes.len() as u64,
        });
        self
    }

    /// In lines, without the date: what is the same from run to run, for the head of a file.
    pub fn same(&self) -> Vec<String> {
        let made = format!("{}, seed {}", self.program, self.seed);
        let files = self
            .files
            .iter()
            .map(|file| format!("{}: {}, SHA-256 {}", file.role, file.path, file.sha256));
        [made, self.command.clone()].into_iter().chain(files).collect()
    }

    /// In lines, for a page.
    pub fn lines(&self) -> Vec<String> {
        let files = self.files.iter().map(|file| {
            format!("{}: {}, {} bytes, SHA-256 {}", file.role, file.path, file.bytes, file.sha256)
        });
        let made = format!("{}, {}, seed {}", self.program, self.date, self.seed);
        [made, self.command.clone()].into_iter().chain(files).filter(|l| !l.is_empty()).collect()
    }
}

/// SHA-256 of everything that a reader gives, and how many bytes that were.
fn checksum(mut from: impl Read) -> std::io::Result<(String, u64)> {
    let (mut hash, mut bytes, mut part) = (Sha256::new(), 0, vec![0; 1 << 16]);
    loop {
        match from.read(&mut part)? {
            0 => return Ok((hex(&hash.finalize()), bytes)),
            count => {
                hash.update(&part[..count]);
                bytes += count as u64;
            }
        }
    }
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn checksums_are_those_of_the_standard() {
        // FIPS 180-4, examples: "abc" and the empty text
        let abc = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(checksum(&b"abc"[..]).unwrap(), (abc.into(), 3));
        let none = "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855";
        assert_eq!(checksum(&b""[..]).unwrap(), (none.into(), 0));
        let made =
            Provenance::new("lacuna 1.2.3", "lacuna demo", 7).embedded("data", "a.csv", b"abc");
        assert_eq!(made.files[0].sha256, abc);
        assert!(made.date.ends_with('Z') && made.date.len() == 20, "{}", made.date);
        assert_eq!(made.lines().len(), 3);
        assert!(serde_json::to_value(&made).unwrap().get("date").is_none());
    }
}
