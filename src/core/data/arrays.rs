//! Named arrays, as NumPy and MATLAB keep them, laid out as the columns of records.
//!
//! Samples run along the axis whose length most arrays have in common. A vector is a
//! column, a matrix of samples by channels (or channels by samples, which is said) is one
//! column a channel, and a third axis numbers records. Scalars `Ts`, `dt`, `sampling_time`
//! (s) and `fs` (Hz) state the step.

use super::error::{DataError, is_beyond, place};
use super::remark::Remark;
use super::table::{CellFault, CellProblem, Column, Table};
use std::collections::BTreeMap;

/// Values that an array may have.
pub(super) const MOST: u64 = 1 << 31;

/// An array of numbers; `values` row by row, its last index running fastest.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Array {
    pub name: String,
    pub unit: String,
    pub shape: Vec<usize>,
    pub values: Vec<f64>,
}

/// Names and units that a file keeps apart for the channels of an array.
#[derive(Debug, Clone, Default)]
pub(super) struct Labels {
    pub names: Vec<String>,
    pub units: Vec<String>,
}

/// One group of arrays: a file, or a structure in it.
#[derive(Debug, Clone, Default)]
pub(super) struct Group {
    /// Name of the structure, empty for a file.
    pub name: String,
    pub arrays: Vec<Array>,
    pub labels: BTreeMap<String, Labels>,
    /// Whether a third axis stands last, as in MATLAB, or first, as in NumPy.
    pub records_last: bool,
    /// Seconds in the unit of `Ts` and of the time.
    pub second: f64,
    /// Names of what is there and is no array of numbers.
    pub others: Vec<String>,
}

/// What states a step, and whether as a rate.
const STEPS: [(&str, bool); 6] = [
    ("Ts", false),
    ("dt", false),
    ("sampling_time", false),
    ("SamplingInterval", false),
    ("fs", true),
    ("Fs", true),
];

/// The records of a group of arrays.
pub(super) fn tables(group: Group, source: &str) -> Result<Vec<Table>, DataError> {
    let (mut remarks, mut step) = (Vec::new(), None);
    let mut signals: Vec<Array> = Vec::new();
    let mut others = group.others.clone();
    for mut array in group.arrays {
        // axes of length 1 say nothing, but a single sample needs one
        if array.shape.len() < 3 {
            array.shape.retain(|length| *length != 1);
        }
        let stated = STEPS.iter().find(|(name, _)| *name == array.name);
        match (array.values.as_slice(), stated) {
            ([], _) => others.push(array.name),
            (&[value], Some((name, rate))) => {
                let value = if *rate { 1.0 / value } else { value * group.second };
                if !(value > 0.0 && value.is_finite()) {
                    let mut at = place(source, None, None);
                    at.key = Some((*name).into());
                    return Err(DataError::Array { at, found: format!("{value} is no step in s") });
                }
                step = Some(value);
                remarks.push(Remark::Stated { name: (*name).into(), step: value });
            }
            ([_], None) => others.push(array.name),
            _ => signals.push(array),
        }
    }
    let Some(length) = common_length(&signals) else {
        return Err(DataError::NoRows { at: place(source, None, None) });
    };
    let count = records(&signals, length, group.records_last);
    let mut tables: Vec<Table> = (0..count)
        .map(|_| Table {
            source: source.to_owned(),
            header_line: 0,
            columns: Vec::new(),
            lines: (1..=length).collect(),
            remarks: Vec::new(),
            step,
            chosen: Vec::new(),
        })
        .collect();
    for array in signals {
        let labels = group.labels.get(&array.name).cloned().unwrap_or_default();
        let Some(layout) = Layout::of(&array, length, count, group.records_last) else {
            others.push(array.name);
            continue;
        };
        if layout.turned {
            let shape = (layout.channels, length);
            remarks.push(Remark::Turned { array: array.name.clone(), shape });
        }
        for (r, table) in tables.iter_mut().enumerate() {
            for channel in 0..layout.channels {
                let number = table.columns.len() + 1;
                let values: Vec<f64> =
                    (0..length).map(|k| array.values[layout.index(r, k, channel)]).collect();
                let name = labels.names.get(channel).filter(|name| !name.is_empty()).cloned();
                let name = name.unwrap_or_else(|| match layout.channels {
                    1 => array.name.clone(),
                    _ => format!("{}{}", array.name, channel + 1),
                });
                let unit = labels.units.get(channel).unwrap_or(&array.unit).clone();
                table.columns.push(column(name, unit, number, values, group.second));
            }
        }
    }
    if !others.is_empty() {
        others.sort();
        remarks.push(Remark::NotSamples { names: others });
    }
    if count > 1 {
        let names = (1..=count).map(|r| r.to_string()).collect();
        remarks.push(Remark::Records { names });
    }
    for table in &mut tables {
        if let Some((second, first)) = twice(&table.columns) {
            let mut at = place(source, None, None);
            at.key = Some(second);
            return Err(DataError::DuplicateColumn { at, first });
        }
    }
    if let Some(table) = tables.first_mut() {
        table.remarks = remarks;
    }
    Ok(tables)
}

/// A column of numbers; an infinite one is a fault of its row.
pub(super) fn column(
    name: String,
    unit: String,
    number: usize,
    mut values: Vec<f64>,
    second: f64,
) -> Column {
    // the times of a group whose `Ts` is in minutes are in minutes
    if name == "time" && unit.is_empty() && second != 1.0 {
        values.iter_mut().for_each(|value| *value *= second);
    }
    let infinite = values.iter().position(|value| is_beyond(*value));
    let fault = infinite.map(|row| CellFault {
        line: row + 1,
        found: values[row].to_string(),
        problem: CellProblem::Infinite,
    });
    let header = name.clone();
    Column { name, unit, number, header, values, fault }
}

/// The second column of a name, and the number of the first.
pub(super) fn twice(columns: &[Column]) -> Option<(String, usize)> {
    let mut known = BTreeMap::new();
    columns
        .iter()
        .find_map(|column| Some((column.name.clone(), known.insert(&column.name, column.number)?)))
}

/// The length that most arrays have along some axis; of equals, the longest.
fn common_length(arrays: &[Array]) -> Option<usize> {
    let mut votes: BTreeMap<usize, usize> = BTreeMap::new();
    for array in arrays {
        let mut lengths = array.shape.clone();
        lengths.sort_unstable();
        lengths.dedup();
        for length in lengths {
            *votes.entry(length).or_insert(0) += 1;
        }
    }
    votes.into_iter().max_by_key(|(length, votes)| (*votes, *length)).map(|(length, _)| length)
}

/// Number of records: the length of the third axis.
fn records(arrays: &[Array], length: usize, last: bool) -> usize {
    let third = arrays.iter().find_map(|array| match *array.shape.as_slice() {
        [records, samples, _] if !last && samples == length => Some(records),
        [samples, _, records] if last && samples == length => Some(records),
        _ => None,
    });
    third.unwrap_or(1)
}

/// How the values of an array are indexed by record, sample and channel.
struct Layout {
    channels: usize,
    record_step: usize,
    sample_step: usize,
    channel_step: usize,
    turned: bool,
}

impl Layout {
    fn of(array: &Array, length: usize, records: usize, last: bool) -> Option<Self> {
        let plain = |channels, record_step, sample_step, channel_step| Self {
            channels,
            record_step,
            sample_step,
            channel_step,
            turned: false,
        };
        Some(match *array.shape.as_slice() {
            [n] if n == length => plain(1, 0, 1, 0),
            [r, n] if records > 1 && !last && (r, n) == (records, length) => plain(1, n, 1, 0),
            [n, r] if records > 1 && last && (n, r) == (length, records) => plain(1, 1, r, 0),
            [n, m] if n == length => plain(m, 0, m, 1),
            [m, n] if n == length => Self { turned: true, ..plain(m, 0, 1, n) },
            [r, n, m] if !last && (r, n) == (records, length) => plain(m, n * m, m, 1),
            [n, m, r] if last && (n, r) == (length, records) => plain(m, 1, m * r, r),
            _ => return None,
        })
    }

    fn index(&self, record: usize, sample: usize, channel: usize) -> usize {
        record * self.record_step + sample * self.sample_step + channel * self.channel_step
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn array(name: &str, shape: &[usize]) -> Array {
        let count: usize = shape.iter().product();
        let values = (0..count).map(|v| v as f64).collect();
        Array { name: name.into(), unit: String::new(), shape: shape.into(), values }
    }

    fn group(arrays: Vec<Array>) -> Group {
        Group { arrays, second: 1.0, ..Group::default() }
    }

    #[test]
    fn vectors_and_matrices_are_columns() {
        let scalar = Array { values: vec![0.1], ..array("Ts", &[1, 1]) };
        let found =
            tables(group(vec![array("u", &[1, 5]), array("y", &[5, 2]), scalar]), "f").unwrap();
        assert_eq!((found.len(), found[0].step()), (1, Some(0.1)));
        assert_eq!(found[0].names(), ["u", "y1", "y2"]);
        assert_eq!(found[0].values("y2").unwrap(), [1.0, 3.0, 5.0, 7.0, 9.0]);
        let turned = tables(group(vec![array("u", &[5]), array("y", &[2, 5])]), "f").unwrap();
        assert_eq!(turned[0].values("y2").unwrap(), [5.0, 6.0, 7.0, 8.0, 9.0]);
        assert!(turned[0].remarks().iter().any(|remark| remark.to_string().contains("2 x 5")));
    }

    #[test]
    fn a_third_axis_numbers_records() {
        let first = tables(group(vec![array("y", &[2, 5, 3]), array("u", &[2, 5])]), "f").unwrap();
        assert_eq!(first.len(), 2);
        assert_eq!(first[1].values("y3").unwrap(), [17.0, 20.0, 23.0, 26.0, 29.0]);
        assert_eq!(first[1].values("u").unwrap(), [5.0, 6.0, 7.0, 8.0, 9.0]);
        let arrays = vec![array("y", &[5, 3, 2]), array("time", &[5])];
        let last = tables(Group { records_last: true, ..group(arrays) }, "f").unwrap();
        assert_eq!(last[1].values("y2").unwrap(), [3.0, 9.0, 15.0, 21.0, 27.0]);
        assert_eq!(last[1].values("time").unwrap()[4], 4.0);
    }

    #[test]
    fn what_does_not_fit_is_said_and_nothing_is_refused() {
        let arrays =
            vec![array("u", &[6]), array("y", &[6]), array("gains", &[3]), array("a", &[1])];
        let found = tables(group(arrays), "f").unwrap();
        assert_eq!(found[0].names(), ["u", "y"]);
        assert_eq!(found[0].remarks()[0].to_string(), "2 arrays without samples ignored: a, gains");
        assert!(matches!(tables(group(vec![]), "f"), Err(DataError::NoRows { .. })));
    }
}
