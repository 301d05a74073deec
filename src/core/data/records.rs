//! Several records in one table: a column `record` says which one a row belongs to.

use super::error::DataError;
use super::remark::Remark;
use super::table::Table;

/// Parts a table where the value of its column `record` changes; the column is gone then.
pub(super) fn of_column(table: Table) -> Result<Vec<Table>, DataError> {
    let Some(column) = table.columns.iter().find(|column| column.name == "record") else {
        return Ok(vec![table]);
    };
    table.check(std::iter::once(column))?;
    let values = column.values.clone();
    if let Some(row) = values.iter().position(|value| value.is_nan()) {
        let at = table.place(column, table.lines[row]);
        return Err(DataError::Text { at, found: String::new() });
    }
    let number = column.number;
    let mut starts = vec![0];
    starts.extend((1..values.len()).filter(|&k| values[k] != values[k - 1]));
    let mut names: Vec<f64> = starts.iter().map(|&k| values[k]).collect();
    let listed = names.iter().map(f64::to_string).collect();
    names.sort_by(f64::total_cmp);
    if let Some(pair) = names.windows(2).find(|pair| pair[0] == pair[1]) {
        let again = starts.iter().rposition(|&k| values[k] == pair[0]).unwrap_or(0);
        let column =
            &table.columns[table.columns.iter().position(|c| c.number == number).unwrap_or(0)];
        let at = table.place(column, table.lines[starts[again]]);
        let problem = format!("record {} goes on after another one", pair[0]);
        let remedy = "put the rows of each record together".into();
        return Err(DataError::Choice { at, problem, remedy });
    }
    let mut parts = Vec::with_capacity(starts.len());
    for (k, &start) in starts.iter().enumerate() {
        let end = starts.get(k + 1).copied().unwrap_or(values.len());
        let mut part = Table {
            source: table.source.clone(),
            header_line: table.header_line,
            columns: Vec::with_capacity(table.columns.len()),
            lines: table.lines[start..end].to_vec(),
            remarks: Vec::new(),
            step: table.step,
            chosen: Vec::new(),
        };
        for column in table.columns.iter().filter(|column| column.number != number) {
            let mut own = column.clone();
            own.values = column.values[start..end].to_vec();
            // the first fault of a column is known, and belongs to the part it is in
            let inside =
                |line: usize| part.lines.first() <= Some(&line) && part.lines.last() >= Some(&line);
            own.fault = own.fault.filter(|fault| inside(fault.line));
            part.columns.push(own);
        }
        parts.push(part);
    }
    if let Some(first) = parts.first_mut() {
        first.remarks.clone_from(&table.remarks);
        if starts.len() > 1 {
            first.remarks.push(Remark::Records { names: listed });
        }
    }
    Ok(parts)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_column_parts_a_table() {
        let text = "record,time,y\n1,0,5\n1,0.1,6\n2,0,7\n2,0.1,8\n2,0.2,9\n";
        let parts = Table::read_all(text.as_bytes(), "f").unwrap();
        assert_eq!(parts.iter().map(Table::rows).collect::<Vec<_>>(), [2, 3]);
        assert_eq!(parts[1].values("y").unwrap(), [7.0, 8.0, 9.0]);
        assert_eq!(parts[0].remarks()[0].to_string(), "2 records in one file: 1, 2");
        assert!(matches!(
            Table::read(text.as_bytes(), "f"),
            Err(DataError::Several { count: 2, .. })
        ));
    }

    #[test]
    fn records_that_are_mixed_or_not_named_are_refused() {
        let mixed = "record,y\n1,5\n2,6\n1,7\n";
        let error = Table::read_all(mixed.as_bytes(), "f").unwrap_err();
        assert!(error.to_string().contains("line 4"), "{error}");
        let unnamed = "record,y\n1,5\n,6\n";
        assert!(matches!(Table::read_all(unnamed.as_bytes(), "f"), Err(DataError::Text { .. })));
    }
}
