//! NumPy's `.npz`: a zip archive of `.npy` files, one for each array.

use super::arrays::{Group, MOST, tables as laid_out};
use super::error::{DataError, place};
use super::npy;
use super::table::Table;
use std::io::{Cursor, Read};
use zip::ZipArchive;

/// The records in an `.npz` file; refuses other archives by what they are.
pub(super) fn tables(bytes: &[u8], source: &str) -> Result<Vec<Table>, DataError> {
    let broken = |key: &str, found: String| {
        let mut at = place(source, None, None);
        at.key = (!key.is_empty()).then(|| key.to_owned());
        DataError::Broken { at, found }
    };
    let mut archive =
        ZipArchive::new(Cursor::new(bytes)).map_err(|error| broken("", error.to_string()))?;
    let names: Vec<String> =
        archive.file_names().filter_map(Result::ok).map(|name| name.into_owned()).collect();
    if names.iter().any(|name| name == "xl/workbook.xml" || name == "xl/workbook.bin") {
        let remedy = "in Excel, save the sheet as `CSV UTF-8`; in Python: `pandas.read_excel('record.xlsx').to_csv('record.csv', index=False)`";
        return Err(DataError::of_other_kind(source, "an Excel workbook", remedy));
    }
    if !names.iter().any(|name| name.ends_with(".npy")) {
        let remedy = "unpack it and hand in the record that is in it";
        return Err(DataError::of_other_kind(
            source,
            "a zip archive without any NumPy array",
            remedy,
        ));
    }
    let mut group = Group { second: 1.0, ..Group::default() };
    for k in 0..archive.len() {
        let mut member = archive.by_index(k).map_err(|error| broken("", error.to_string()))?;
        let name = member.name().map_err(|error| broken("", error.to_string()))?.into_owned();
        let Some(key) = name.strip_suffix(".npy") else {
            group.others.push(name);
            continue;
        };
        if member.size() > 8 * MOST {
            let found = format!("{} bytes are more than a record can have", member.size());
            return Err(broken(key, found));
        }
        // not more than was stated, whatever the stream says
        let (mut unpacked, stated) = (Vec::new(), member.size());
        let read = member.by_ref().take(stated.saturating_add(1)).read_to_end(&mut unpacked);
        read.map_err(|error| broken(key, error.to_string()))?;
        if unpacked.len() as u64 != stated || !unpacked.starts_with(npy::MAGIC) {
            return Err(broken(key, "this is no NumPy array".into()));
        }
        let mut at = place(source, None, None);
        at.key = Some(key.to_owned());
        let (arrays, others) = npy::arrays(&unpacked, key, &at)?;
        group.arrays.extend(arrays);
        group.others.extend(others);
    }
    laid_out(group, source)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn other_archives_and_broken_ones_are_refused() {
        let empty = [b"PK\x05\x06".as_slice(), &[0; 18]].concat();
        assert!(matches!(tables(&empty, "f"), Err(DataError::OtherKind { .. })));
        assert!(matches!(tables(b"PK\x03\x04 and no more", "f"), Err(DataError::Broken { .. })));
    }
}
