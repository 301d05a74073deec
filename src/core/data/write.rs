//! Records written as CSV, so that what is read again is the same to the last bit.

use super::clock::digits;
use super::error::DataError;
use super::record::{Record, Signal};
use crate::disk::write_whole;
use crate::fault::Place;
use flate2::Compression;
use flate2::write::GzEncoder;
use std::io::{self, Write};
use std::path::Path;

impl Record {
    /// Writes the columns `time [s]`, inputs, outputs; packed by gzip where the path
    /// ends in `.gz`. Values have the shortest digits that read as the same number, a
    /// missing value is an empty cell. The file is there as a whole or, if anything fails, as
    /// it was before.
    ///
    /// # Errors
    ///
    /// A file that cannot be written, a name that cannot stand in a header or stands
    /// there twice, signals of different lengths, an infinite value.
    pub fn write_csv(&self, path: impl AsRef<Path>) -> Result<(), DataError> {
        let path = path.as_ref();
        self.writable()?;
        let written = write_whole(path, |to| {
            if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("gz")) {
                let mut packed = GzEncoder::new(to, Compression::default());
                self.lines_to(&mut packed)?;
                packed.finish()?;
                Ok(())
            } else {
                self.lines_to(to)
            }
        });
        written.map_err(|source| {
            let file = Some(path.display().to_string());
            DataError::Write { at: Box::new(Place { file, ..Place::default() }), source }
        })
    }

    /// Writes as [`Record::write_csv`] does, unpacked, to anything that can be written.
    ///
    /// ```
    /// use lacuna::data::Record;
    ///
    /// let record = Record::new(0.1).output("angle_hat [rad]", vec![0.5, f64::NAN])?;
    /// let mut text = Vec::new();
    /// record.write_csv_to(&mut text)?;
    /// assert_eq!(text, b"time [s],angle_hat [rad]\n0.0,0.5\n0.1,\n");
    /// # Ok::<(), lacuna::data::DataError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// As [`Record::write_csv`].
    pub fn write_csv_to(&self, mut to: impl Write) -> Result<(), DataError> {
        self.writable()?;
        let written = self.lines_to(&mut to).and_then(|()| to.flush());
        written.map_err(|source| DataError::Write { at: Box::default(), source })
    }

    fn writable(&self) -> Result<(), DataError> {
        let expected = self.len();
        for (k, signal) in self.signals().enumerate() {
            let at = || self.at(&signal.name);
            if signal.values.len() != expected {
                return Err(DataError::Length { at: at(), found: signal.values.len(), expected });
            }
            let header = header(signal);
            let reads_back = super::unit::header(&header)
                .is_some_and(|(name, unit)| name == signal.name && unit == signal.unit);
            let fits = !signal.name.is_empty() && signal.name != "time";
            if !(reads_back && fits) || header.contains(char::is_control) {
                return Err(DataError::Header { at: at(), found: header });
            }
            if let Some(first) = self.signals().take(k).position(|s| s.name == signal.name) {
                return Err(DataError::DuplicateColumn { at: at(), first: first + 1 });
            }
            if let Some(row) = signal.values.iter().position(|value| value.is_infinite()) {
                let found = format!("{} at sample {row}", signal.values[row]);
                return Err(DataError::Infinite { at: at(), found });
            }
        }
        Ok(())
    }

    fn lines_to(&self, to: &mut (impl Write + ?Sized)) -> io::Result<()> {
        write!(to, "time [s]")?;
        for signal in self.signals() {
            write!(to, ",{}", in_quotes(&header(signal)))?;
        }
        writeln!(to)?;
        for k in 0..self.len() {
            // 0.3 and not 0.30000000000000004: the time is made of the step, not data
            write!(to, "{:?}", digits(self.time(k), 15))?;
            for signal in self.signals() {
                match signal.values[k] {
                    value if value.is_nan() => write!(to, ",")?,
                    value => write!(to, ",{value:?}")?,
                }
            }
            writeln!(to)?;
        }
        Ok(())
    }
}

fn header(signal: &Signal) -> String {
    if signal.unit.is_empty() {
        signal.name.clone()
    } else {
        format!("{} [{}]", signal.name, signal.unit)
    }
}

fn in_quotes(text: &str) -> String {
    if text.contains([',', ';', '"']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::Table;

    #[test]
    fn odd_names_come_back() {
        let names = ["a,b [N;m]", "say \"u\"", "x y", "ü", "k[1] [m]"];
        let record = names
            .iter()
            .fold(Record::new(1.0), |record, name| record.input(name, vec![1.0, 2.0]).unwrap());
        let mut text = Vec::new();
        record.write_csv_to(&mut text).unwrap();
        let table = Table::read(&text[..], "").unwrap();
        assert_eq!(table.names(), ["time", "a,b", "say \"u\"", "x y", "ü", "k[1]"]);
        assert_eq!(table.columns()[1].unit, "N;m");
    }

    #[test]
    fn what_could_not_be_read_again_is_not_written() {
        let good = Record::new(1.0).input("u", vec![1.0, 2.0]).unwrap();
        let broken: [fn(&mut Record); 5] = [
            |record| record.inputs[0].name = "two\nlines".into(),
            |record| record.inputs[0].name = "time".into(),
            |record| record.inputs[0].values[1] = f64::INFINITY,
            |record| record.outputs = record.inputs.clone(),
            |record| {
                let y = Signal { name: "y".into(), unit: String::new(), values: vec![1.0] };
                record.outputs.push(y);
            },
        ];
        for harm in broken {
            let mut record = good.clone();
            harm(&mut record);
            assert!(record.write_csv_to(io::sink()).is_err());
        }
    }
}
