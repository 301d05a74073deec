//! What a call may write to, decided before any work.
//!
//! ```text
//! an output that is an input of the same call      refused, whatever was said
//! an existing file that lacuna wrote, or is empty  replaced
//! an existing table (.csv) of other origin         refused, whatever was said: a measured record
//! any other existing file                          refused without --force
//! a folder that nothing can be written into        refused before the work, not after it
//! ```
//!
//! Who wrote a file is read off the file: pages name their generator, model files and exported sources
//! say in their first lines which command wrote them, exported units in their comment, JSON documents
//! have the keys that lacuna gives them, tables its columns; a generated record has the checksum that `truth.json` beside it states.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};

use flate2::Crc;
use serde_json::Value;

use super::console::Console;
use super::failure::Failure;
use lacuna::export::WRITTEN_BY;
use lacuna::fault::Place;
use lacuna::file::try_write;

/// Bytes at a file's beginning in which it says who wrote it.
const HEAD: u64 = 4096;
/// Tables that lacuna writes, by how their first lines begin.
const TABLES: [&str; 5] = [
    "epoch,loss,rate,best,rolled_back",
    "start,seed,best_epoch",
    "start,steps,epoch,least",
    "case,system,hidden,",
    "case,seconds",
];
/// Keys of which a JSON document of lacuna has one.
const KEYS: [&str; 4] = ["schema", "fingerprint", "format", "encoder"];

/// Refuses a call that would replace what it reads, or what lacuna did not write.
pub fn check(inputs: &[&Path], outputs: &[PathBuf], look: &Console) -> Result<(), Failure> {
    apart(inputs, outputs)?;
    for output in outputs {
        if is_free(output) || ours(output) {
            continue;
        }
        let output_name = output.display();
        if is_table(output) {
            return Err(refused(
                format!("{output_name} exists and holds data that lacuna did not write"),
                "--out",
                "choose another name, or move the file away: a record is never replaced".into(),
            ));
        }
        if !look.force {
            return Err(refused(
                format!("{output_name} exists, and lacuna did not write it"),
                "--out",
                "choose another name or folder, or replace it with --force".into(),
            ));
        }
    }
    outputs.iter().filter(|output| output.as_os_str() != "-").try_for_each(|output| open(output))
}

/// Refuses an output whose folder is a file, or takes no file. A folder that is not there yet is made in the
/// nearest one that is.
fn open(output: &Path) -> Result<(), Failure> {
    let here = |folder: &Path| {
        if folder.as_os_str().is_empty() { PathBuf::from(".") } else { folder.into() }
    };
    // each with what is to be made in it
    let mut folders = output.ancestors().skip(1).map(here).zip(output.ancestors());
    let Some((folder, first)) = folders.find(|(folder, _)| folder.exists()) else { return Ok(()) };
    if !folder.is_dir() {
        let message = format!("{} is a file, and no folder to write into", folder.display());
        return Err(refused(message, "--out", "give --out the name of a folder".into()));
    }
    try_write(first).map_err(|error| cannot_write(output, &error))
}

/// The files of some folders and of folders in these, as inputs.
pub fn files_of(folders: &[PathBuf]) -> Vec<PathBuf> {
    let entries = |folder: &Path| -> Vec<PathBuf> {
        let found = std::fs::read_dir(folder).into_iter().flatten().flatten();
        found.map(|entry| entry.path()).collect()
    };
    let all = folders.iter().flat_map(|folder| entries(folder));
    let inner = |path: PathBuf| if path.is_dir() { entries(&path) } else { vec![path] };
    all.flat_map(inner).collect()
}

/// Refuses a call that would replace what it reads.
pub fn apart(inputs: &[&Path], outputs: &[PathBuf]) -> Result<(), Failure> {
    for output in outputs {
        // a folder of results that is the name of an input is no folder
        let reads = |input: &&&Path| {
            same(input, output) || output.parent().is_some_and(|folder| same(input, folder))
        };
        if let Some(input) = inputs.iter().find(reads) {
            let (output, input) = (output.display(), input.display());
            return Err(refused(
                format!("{output} would replace {input}, which this call reads"),
                "--out",
                "give --out another name: what a call reads is never written to".into(),
            ));
        }
    }
    Ok(())
}

/// The files of a folder, as outputs.
pub fn within(folder: &Path, files: &[&str]) -> Vec<PathBuf> {
    files.iter().map(|file| folder.join(file)).collect()
}

/// All paths of some groups, for [`check`].
pub fn paths<'a>(groups: &[&'a [PathBuf]]) -> Vec<&'a Path> {
    groups.iter().flat_map(|group| group.iter().map(PathBuf::as_path)).collect()
}

/// Refuses records that are counted twice, or a test record that is not kept apart.
pub fn distinct(data: &[PathBuf], apart: &[(&str, &[PathBuf])]) -> Result<(), Failure> {
    for (k, path) in data.iter().enumerate() {
        if data[..k].iter().any(|other| same(other, path)) {
            return Err(refused(
                format!("{} is given twice", path.display()),
                "--data",
                "give each record once: the same evidence does not count twice".into(),
            ));
        }
    }
    for (option, paths) in apart {
        if let Some(path) = paths.iter().find(|path| data.iter().any(|other| same(other, path))) {
            return Err(refused(
                format!("{} is given with --data and with {option}", path.display()),
                option,
                format!("give {option} a record that --data does not use"),
            ));
        }
    }
    Ok(())
}

fn refused(message: String, option: &str, hint: String) -> Failure {
    let place = Place { key: Some(option.into()), ..Place::default() };
    Failure::call_refused(message, place, hint)
}

/// Whether two paths are one file, by whatever links and names, or both stdin.
fn same(a: &Path, b: &Path) -> bool {
    let both_stdin = a == b && a.as_os_str() == "-";
    both_stdin || same_file::is_same_file(a, b).unwrap_or(false)
}

/// Whether nothing is lost where a path is written to.
fn is_free(path: &Path) -> bool {
    match std::fs::metadata(path) {
        // a folder cannot be replaced by a file, and a device keeps nothing
        Ok(found) => !found.is_file() || found.len() == 0,
        Err(_) => true,
    }
}

fn extension(path: &Path) -> String {
    let name = path.file_name().map(|name| name.to_string_lossy().to_lowercase());
    let name = name.unwrap_or_default();
    let name = name.strip_suffix(".gz").unwrap_or(&name);
    name.rsplit_once('.').map_or_else(String::new, |(_, end)| end.to_string())
}

fn is_table(path: &Path) -> bool {
    matches!(extension(path).as_str(), "csv" | "tsv" | "txt" | "dat")
}

/// Whether lacuna wrote a file.
fn ours(path: &Path) -> bool {
    match extension(path).as_str() {
        "html" => {
            head(path).is_some_and(|text| text.contains("name=\"generator\" content=\"lacuna"))
        }
        "json" => is_document(path) || has_our_header(path),
        "c" | "h" | "m" | "py" => head(path).is_some_and(|text| text.contains("`lacuna ")),
        "fmu" => ends_as_ours(path),
        _ if is_table(path) => is_our_table(path) || is_generated(path),
        _ => has_our_header(path),
    }
}

/// The beginning of a file as text.
fn head(path: &Path) -> Option<String> {
    let file = File::open(path).ok()?;
    let packed = path.extension().is_some_and(|end| end.eq_ignore_ascii_case("gz"));
    let mut bytes = vec![];
    if packed {
        let unpacked = flate2::read::MultiGzDecoder::new(BufReader::new(file));
        unpacked.take(HEAD).read_to_end(&mut bytes).ok()?;
    } else {
        file.take(HEAD).read_to_end(&mut bytes).ok()?;
    }
    Some(String::from_utf8_lossy(&bytes).into_owned())
}

/// Whether the comment at the top of a model file names a command of lacuna.
fn has_our_header(path: &Path) -> bool {
    head(path).is_some_and(|text| {
        let comment = text.lines().take_while(|line| line.starts_with('#'));
        comment.into_iter().any(|line| line.contains("`lacuna "))
    })
}

/// Whether a JSON object has a key that documents of lacuna have, or is a model of its own.
fn is_document(path: &Path) -> bool {
    let Ok(file) = File::open(path) else { return false };
    let read: Result<BTreeMap<String, serde::de::IgnoredAny>, _> =
        serde_json::from_reader(BufReader::new(file));
    read.is_ok_and(|entries| {
        KEYS.iter().any(|key| entries.contains_key(*key))
            || entries.contains_key("model") && entries.contains_key("sampling_time")
    })
}

/// Whether a table has columns that only lacuna's have: simulated outputs, or a protocol.
fn is_our_table(path: &Path) -> bool {
    let Some(text) = head(path) else { return false };
    let Some(names) = text.lines().next() else { return false };
    let name = |field: &str| {
        let field = field.trim().trim_matches('"');
        field.split_once(" [").map_or(field, |(name, _)| name).to_string()
    };
    let mut columns = names.split(',').map(name).filter(|name| name != "time").peekable();
    let simulated = columns.peek().is_some() && columns.all(|name| name.ends_with("_hat"));
    let mut columns = names.split(',').map(|field| field.trim_start_matches('"'));
    let vector = columns.all(|name| name.starts_with("input ") || name.starts_with("output "));
    simulated || vector || TABLES.iter().any(|table| names.starts_with(table))
}

/// Whether an exported unit says at its end, where an archive has its comment, who wrote it.
fn ends_as_ours(path: &Path) -> bool {
    std::fs::read(path).is_ok_and(|bytes| bytes.ends_with(WRITTEN_BY.as_bytes()))
}

/// Whether a record is, byte by byte, the one that `truth.json` beside it speaks of.
fn is_generated(path: &Path) -> bool {
    let (Some(name), truth) = (path.file_name(), path.with_file_name("truth.json")) else {
        return false;
    };
    let stated = || {
        let truth: Value = serde_json::from_reader(BufReader::new(File::open(truth).ok()?)).ok()?;
        truth["crc32"][name.to_string_lossy().as_ref()].as_u64()
    };
    stated().is_some_and(|stated| checksum(path).is_some_and(|sum| u64::from(sum) == stated))
}

/// CRC-32 (IEEE 802.3) of a file.
pub fn checksum(path: &Path) -> Option<u32> {
    let mut file = BufReader::new(File::open(path).ok()?);
    let mut sum = Crc::new();
    loop {
        let bytes = file.fill_buf().ok()?;
        if bytes.is_empty() {
            return Some(sum.sum());
        }
        sum.update(bytes);
        let count = bytes.len();
        file.consume(count);
    }
}

/// A file or folder that could not be written, as the end of a command.
pub fn cannot_write(path: &Path, error: &std::io::Error) -> Failure {
    let place = Place { file: Some(path.display().to_string()), ..Place::default() };
    let hint = lacuna::file::write_hint(error);
    Failure::work_at(format!("{}cannot be written ({error})", place.lead()), place, hint.into())
}
