//! The line of names.

use super::begin::Begin;
use super::fields::{number, quoted};
use super::{Tally, shortened};
use crate::data::error::{DataError, place};
use crate::data::remark::Remark;
use crate::data::table::{CellProblem, Column};
use crate::data::unit;
use std::collections::HashMap;

/// The columns named in the header, whether it ends with separators, and what is said of
/// units in other spellings.
pub(super) fn names(
    begin: &Begin<'_>,
    source: &str,
) -> Result<(Vec<Column>, Tally, Option<Remark>), DataError> {
    let (line, header) = begin.header;
    let mut fields = quoted(header, begin.separator)
        .map_err(|column| DataError::Quote { at: place(source, Some(line), Some(column)) })?;
    let is_number = |field: &str| !matches!(number(field.trim()), Err(CellProblem::Text));
    if fields.iter().all(|field| is_number(field)) {
        let (at, comment) = (place(source, Some(line), None), begin.comment);
        return Err(DataError::NoHeader { at, found: shortened(header.trim()), comment });
    }
    let mut trailing = Tally::default();
    while fields.last().is_some_and(|field| field.trim().is_empty()) {
        fields.pop();
        trailing = Tally { count: 1, first_line: line };
    }
    let mut columns: Vec<Column> = Vec::with_capacity(fields.len());
    let mut known: HashMap<String, usize> = HashMap::with_capacity(fields.len());
    let mut respelt = Vec::new();
    for (k, field) in fields.iter().enumerate() {
        let Some((mut name, mut unit)) = unit::header(field) else {
            let at = place(source, Some(line), Some(k + 1));
            return Err(DataError::Header { at, found: shortened(field.trim()) });
        };
        if unit.is_empty()
            && let Some(other) = unit::spelt(&name)
        {
            respelt.push(field.trim().to_owned());
            (name, unit) = other;
        }
        let below = begin.units.as_ref().and_then(|(_, units)| units.get(k));
        if unit.is_empty()
            && let Some(below) = below
        {
            unit.clone_from(below);
        }
        if !name.is_empty()
            && let Some(first) = known.insert(name.clone(), k + 1)
        {
            let mut at = place(source, Some(line), Some(k + 1));
            at.key = Some(name);
            return Err(DataError::DuplicateColumn { at, first });
        }
        let header = field.trim().to_owned();
        columns.push(Column { name, unit, number: k + 1, header, values: Vec::new(), fault: None });
    }
    let remark = (!respelt.is_empty()).then_some(Remark::UnitsSpelt { columns: respelt });
    Ok((columns, trailing, remark))
}
