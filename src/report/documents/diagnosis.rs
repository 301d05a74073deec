//! The document `diagnosis.json`: a finding, its sentences, and where it is from.
//!
//! Keys of a finding are those of its fields; sentences are added here. Two runs with one seed differ
//! in `seconds` only, whatever the number of threads, on one kind of processor.

use serde::Serialize;

use crate::diagnose::{Cause, Finding, Withdrawn};
use crate::provenance::Provenance;
use crate::sentences;

/// Version of the form.
const SCHEMA: u32 = 1;

/// Names of the files beside the document.
#[derive(Debug, Clone, Copy)]
pub struct FileNames<'a> {
    /// File of the extended model.
    pub extended_model: &'a str,
    /// File of the page.
    pub report: &'a str,
}

/// A finding as a document.
#[derive(Debug, Serialize)]
pub struct Document<'a> {
    schema: u32,
    #[serde(flatten)]
    finding: StatedFinding<'a>,
    extended_model: &'a str,
    report: &'a str,
    #[serde(flatten)]
    more: serde_json::Map<String, serde_json::Value>,
    provenance: &'a Provenance,
}

/// A cause with its sentence.
#[derive(Debug, Serialize)]
struct StatedCause<'a> {
    sentence: String,
    #[serde(flatten)]
    cause: &'a Cause,
}

/// A cause that was withdrawn, and why.
#[derive(Debug, Serialize)]
struct StatedWithdrawn<'a> {
    reason: String,
    #[serde(flatten)]
    withdrawn: &'a Withdrawn,
}

/// What one record shows on its own.
#[derive(Debug, Serialize)]
struct SingleRecord<'a> {
    record: &'a str,
    cause: StatedCause<'a>,
}

/// A finding whose causes have sentences.
#[derive(Debug)]
struct StatedFinding<'a>(&'a Finding);

impl Serialize for StatedFinding<'_> {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        use serde::ser::{Error, SerializeMap};

        let finding = self.0;
        let value = serde_json::to_value(finding).map_err(S::Error::custom)?;
        let fields = value.as_object().ok_or_else(|| S::Error::custom("a finding is a table"))?;
        let mut map = serializer.serialize_map(None)?;
        for (key, value) in fields {
            match key.as_str() {
                "causes" => {
                    let stated: Vec<StatedCause<'_>> = finding.causes.iter().map(stated).collect();
                    map.serialize_entry(key, &stated)?;
                }
                "withdrawn" => {
                    let stated: Vec<_> = finding.withdrawn.iter().map(stated_withdrawn).collect();
                    map.serialize_entry(key, &stated)?;
                }
                _ => map.serialize_entry(key, value)?,
            }
        }
        if !finding.single_records.is_empty() {
            let singles = finding.single_records.iter();
            let singles: Vec<_> = singles
                .map(|a| SingleRecord { record: &a.record, cause: stated(&a.cause) })
                .collect();
            map.serialize_entry("alone", &singles)?;
        }
        map.serialize_entry("remarks", &sentences::notes(finding))?;
        map.end()
    }
}

fn stated(cause: &Cause) -> StatedCause<'_> {
    StatedCause { sentence: sentences::cause(cause), cause }
}

fn stated_withdrawn(withdrawn: &Withdrawn) -> StatedWithdrawn<'_> {
    StatedWithdrawn { reason: sentences::withdrawn(withdrawn), withdrawn }
}

impl<'a> Document<'a> {
    /// Of a finding, the files beside it, and where it is from.
    pub fn of(finding: &'a Finding, files: FileNames<'a>, provenance: &'a Provenance) -> Self {
        let FileNames { extended_model, report } = files;
        let (schema, finding, more) = (SCHEMA, StatedFinding(finding), serde_json::Map::new());
        Self { schema, finding, extended_model, report, more, provenance }
    }

    /// The same with a further key.
    ///
    /// # Errors
    ///
    /// If the value cannot be a document.
    pub fn with(mut self, key: &str, value: &impl Serialize) -> Result<Self, serde_json::Error> {
        self.more.insert(key.into(), serde_json::to_value(value)?);
        Ok(self)
    }

    /// Its text, with a line break at the end.
    ///
    /// # Errors
    ///
    /// If a number cannot be written, which only happens to keys that are no text.
    pub fn text(&self) -> Result<String, serde_json::Error> {
        Ok(serde_json::to_string_pretty(self)? + "\n")
    }
}

/// A cause as a document: its sentence and its fields.
///
/// # Errors
///
/// As [`Document::text`].
pub fn cause_document(cause: &Cause) -> Result<serde_json::Value, serde_json::Error> {
    serde_json::to_value(stated(cause))
}
