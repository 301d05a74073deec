//! MATLAB's `.mat` files of versions 4 to 7: numeric arrays, and structures that hold them.
//!
//! Version 5 (which `-v6` and `-v7` write, the latter with packed variables) after "MAT-File
//! Format", The MathWorks, chapter 1; version 4 after its appendix. A structure with fields
//! such as `u`, `y`, `Ts`, or `InputData`, `OutputData`, `Ts`, `InputName`, `InputUnit` (what
//! an `iddata` object has), is a record; a structure array, or several structures, are
//! several. Files of version 7.3 are HDF5, and are answered with the line that saves them as
//! version 7.

mod element;
mod level4;
mod matrix;

use super::arrays::{Array, Group, Labels, tables as laid_out};
use super::error::{DataError, place};
use super::npy::row_by_row;
use super::remark::Remark;
use super::table::Table;
use super::unit::{Relation, relate};
use element::Bytes;
use matrix::{Content, Variable};

/// How the program says that a `.mat` file cannot be read as it is, and what to do.
const AS_7: &str =
    "in MATLAB: `S = load('record.mat'); save('record7.mat', '-struct', 'S', '-v7')`";

/// Whether a file begins as a `.mat` file does.
pub(super) fn is_one(bytes: &[u8]) -> bool {
    bytes.starts_with(b"MATLAB ") || is_level_5(bytes) || level4::is_one(bytes)
}

fn is_level_5(bytes: &[u8]) -> bool {
    matches!(bytes.get(124..128), Some([0, 1, b'I', b'M'] | [1, 0, b'M', b'I']))
}

/// The records in a `.mat` file.
pub(super) fn tables(bytes: &[u8], source: &str) -> Result<Vec<Table>, DataError> {
    if bytes.starts_with(b"MATLAB 7.3") || matches!(bytes.get(512..516), Some(b"\x89HDF")) {
        return Err(DataError::of_other_kind(source, "a .mat file of version 7.3 (HDF5)", AS_7));
    }
    let broken = |found: String| DataError::Broken { at: place(source, None, None), found };
    let variables = if is_level_5(bytes) {
        let mut own = Bytes::new(&bytes[128..], bytes[126] == b'M');
        let mut found = Vec::new();
        while !own.is_empty() {
            found.extend(matrix::variable(&mut own, 0).map_err(&broken)?);
        }
        found
    } else if level4::is_one(bytes) {
        level4::variables(bytes).map_err(&broken)?
    } else {
        return Err(broken("the header does not say in which byte order it was written".into()));
    };
    records(variables, source)
}

/// Structures are records; where there are none, the arrays are one.
fn records(variables: Vec<Variable>, source: &str) -> Result<Vec<Table>, DataError> {
    let object = variables.iter().find(|v| matches!(v.content, Content::Object));
    let object = object.map(|variable| variable.name.clone());
    let (mut groups, mut plain) = (Vec::new(), Vec::new());
    for variable in variables {
        match variable.content {
            Content::Structures(elements) => {
                let several = elements.len() > 1;
                for (k, fields) in elements.into_iter().enumerate() {
                    let name = match several {
                        true => format!("{}({})", variable.name, k + 1),
                        false => variable.name.clone(),
                    };
                    groups.push(group(name, flattened(fields)));
                }
            }
            content => plain.push(Variable { name: variable.name, content }),
        }
    }
    groups.retain(|group| group.arrays.iter().any(|array| array.values.len() > 1));
    let own = group(String::new(), plain);
    // arrays beside structures are something else, such as gains
    if groups.is_empty() {
        if own.arrays.is_empty()
            && let Some(name) = object
        {
            let mut at = place(source, None, None);
            at.key = Some(name);
            let found = "this is a MATLAB object, whose content the file does not describe".into();
            let remedy = "save a structure of its arrays, for an iddata object `z`: `S = struct('u', z.InputData, 'y', z.OutputData, 'Ts', z.Ts); save('record.mat', '-struct', 'S', '-v7')`";
            return Err(DataError::Choice { at, problem: found, remedy: remedy.into() });
        }
        return laid_out(own, source);
    }
    let names: Vec<String> = groups.iter().map(|group| group.name.clone()).collect();
    let mut tables = Vec::new();
    for group in groups {
        tables.extend(laid_out(group, source)?);
    }
    if names.len() > 1
        && let Some(first) = tables.first_mut()
    {
        first.remarks.push(Remark::Records { names });
    }
    Ok(tables)
}

/// Fields of structures within a structure stand beside the others.
fn flattened(fields: Vec<Variable>) -> Vec<Variable> {
    let mut all = Vec::new();
    for field in fields {
        match field.content {
            Content::Structures(mut inner) if inner.len() == 1 => {
                all.extend(inner.pop().unwrap_or_default());
            }
            content => all.push(Variable { name: field.name, content }),
        }
    }
    all
}

/// Names that toolboxes give to what is known by shorter ones.
fn own_name(name: &str) -> &str {
    match name {
        "InputData" => "u",
        "OutputData" => "y",
        "SamplingInstants" | "Time" | "t" => "time",
        other => other,
    }
}

fn group(name: String, variables: Vec<Variable>) -> Group {
    let mut group = Group { name, records_last: true, second: 1.0, ..Group::default() };
    let has_time = variables.iter().any(|variable| variable.name == "time");
    for variable in variables {
        match variable.content {
            Content::Numbers { shape, values } => {
                let name = match own_name(&variable.name) {
                    "time" if has_time => variable.name.as_str(),
                    name => name,
                };
                let values = if values.is_empty() { values } else { row_by_row(&values, &shape) };
                let unit = String::new();
                group.arrays.push(Array { name: name.to_owned(), unit, shape, values });
            }
            Content::Texts(texts) => {
                let (array, is_name) = match variable.name.as_str() {
                    "InputName" => ("u", true),
                    "OutputName" => ("y", true),
                    "InputUnit" => ("u", false),
                    "OutputUnit" => ("y", false),
                    "TimeUnit" => {
                        if let Some(Relation::Convert(second)) =
                            texts.first().map(|unit| relate(unit, "s"))
                        {
                            group.second = second.factor();
                        }
                        continue;
                    }
                    _ => {
                        group.others.push(variable.name);
                        continue;
                    }
                };
                let labels: &mut Labels = group.labels.entry(array.into()).or_default();
                if is_name { labels.names = texts } else { labels.units = texts }
            }
            _ => group.others.push(variable.name),
        }
    }
    group
}
