//! NumPy's `.npy`: one array of numbers, or of records with named fields.
//!
//! Format versions 1 to 3 (NumPy Enhancement Proposal 1): a magic word, a Python literal
//! with the type, order and shape, and the values. Read are whole numbers, floating-point
//! numbers of 16, 32 and 64 bits, truth values, instants and spans of time, in either byte
//! order and in C or Fortran order.

mod descr;

use super::arrays::{Array, Group, MOST, tables as laid_out};
use super::error::{DataError, place};
use super::table::Table;
use crate::fault::Place;
use descr::{Field, Header};

pub(super) const MAGIC: &[u8] = b"\x93NUMPY";

/// The record in an `.npy` file. Columns of a matrix are `column1`, `column2`..; those of an
/// array with named fields have their names.
pub(super) fn tables(bytes: &[u8], source: &str) -> Result<Vec<Table>, DataError> {
    let (arrays, others) = arrays(bytes, "column", &place(source, None, None))?;
    laid_out(Group { arrays, others, second: 1.0, ..Group::default() }, source)
}

/// The arrays in the bytes of an `.npy` file, and the names of those that hold no numbers.
pub(super) fn arrays(
    bytes: &[u8],
    name: &str,
    at: &Place,
) -> Result<(Vec<Array>, Vec<String>), DataError> {
    let broken = |found: &str| DataError::Broken { at: Box::new(at.clone()), found: found.into() };
    let short = || broken("the header is not complete");
    let version = *bytes.get(6).ok_or_else(short)?;
    let (length, start) = match version {
        1 => {
            let two = bytes.get(8..10).ok_or_else(short)?;
            (usize::from(u16::from_le_bytes([two[0], two[1]])), 10)
        }
        2 | 3 => {
            let four = bytes.get(8..12).ok_or_else(short)?;
            (u32::from_le_bytes([four[0], four[1], four[2], four[3]]) as usize, 12)
        }
        _ => return Err(broken(&format!("version {version} of the format is not known"))),
    };
    let head = bytes.get(start..).and_then(|rest| rest.get(..length)).ok_or_else(short)?;
    let data = &bytes[start + length..];
    let head = std::str::from_utf8(head).map_err(|_| broken("the header is no text"))?;
    let header = Header::parse(head).ok_or_else(|| broken("the header cannot be understood"))?;
    let count = header.shape.iter().try_fold(1_u64, |product, n| product.checked_mul(*n as u64));
    let widths = header.fields.iter().map(|field| field.bytes() as u64);
    let width = widths.fold(0_u64, u64::saturating_add);
    if let Some(field) = header.fields.iter().find(|field| field.kind == 'O') {
        let at = Box::new(keyed(at, field));
        let found = "this array holds Python objects (pickled), not numbers".into();
        return Err(DataError::Array { at, found });
    }
    let count = count.filter(|count| *count <= MOST).ok_or_else(|| {
        let found = format!("{} values are more than a record can have", shape(&header.shape));
        DataError::Array { at: Box::new(at.clone()), found }
    })?;
    if count.checked_mul(width) != Some(data.len() as u64) {
        let expected = u128::from(count) * u128::from(width);
        let shape = shape(&header.shape);
        return Err(broken(&format!(
            "{} bytes of values, where {shape} need {expected}",
            data.len()
        )));
    }
    let (mut found, mut others) = (Vec::new(), Vec::new());
    let mut offset = 0_usize;
    for field in &header.fields {
        let own = if field.name.is_empty() { name.to_owned() } else { field.name.clone() };
        let (start, step) = (offset, width as usize);
        offset = offset.saturating_add(field.bytes());
        match field.kind {
            'f' if field.size > 8 => {
                let at = Box::new(keyed(at, field));
                let found =
                    format!("numbers of {} bits are not read: .astype(float)", 8 * field.size);
                return Err(DataError::Array { at, found });
            }
            'c' => {
                let at = Box::new(keyed(at, field));
                return Err(DataError::Array { at, found: "these are complex numbers".into() });
            }
            'f' | 'i' | 'u' | 'b' | 'M' | 'm' => {
                let mut shape = header.shape.clone();
                shape.extend(&field.shape);
                let values = numbers(data, field, start, step, count as usize);
                let values = match header.fortran && shape.len() > 1 && !values.is_empty() {
                    true => row_by_row(&values, &shape),
                    false => values,
                };
                let unit = if field.second.is_some() { "s".into() } else { String::new() };
                found.push(Array { name: own, unit, shape, values });
            }
            _ => others.push(own),
        }
    }
    Ok((found, others))
}

fn keyed(at: &Place, field: &Field) -> Place {
    let key = (!field.name.is_empty()).then(|| field.name.clone()).or_else(|| at.key.clone());
    Place { key, ..at.clone() }
}

fn shape(shape: &[usize]) -> String {
    let parts: Vec<String> = shape.iter().map(usize::to_string).collect();
    if parts.is_empty() { "1".into() } else { parts.join(" x ") }
}

/// The values of one field.
fn numbers(data: &[u8], field: &Field, start: usize, step: usize, count: usize) -> Vec<f64> {
    let each = field.shape.iter().product::<usize>();
    let mut values = Vec::with_capacity(count * each);
    let mut first = None;
    for k in 0..count {
        for j in 0..each {
            let from = start + k * step + j * field.size;
            let value = match field.second {
                None => number(&data[from..from + field.size], field),
                // an instant is told from the first one, in whole ticks, to lose no digits
                Some(second) => {
                    let tick = whole(&data[from..from + field.size], field.big);
                    let zero = if field.kind == 'M' { *first.get_or_insert(tick) } else { 0 };
                    match tick {
                        i64::MIN => f64::NAN,
                        _ => (i128::from(tick) - i128::from(zero)) as f64 * second,
                    }
                }
            };
            values.push(value);
        }
    }
    values
}

fn in_order<const N: usize>(bytes: &[u8], big: bool) -> [u8; N] {
    let mut own = [0; N];
    own.copy_from_slice(bytes);
    if big {
        own.reverse();
    }
    own
}

fn whole(bytes: &[u8], big: bool) -> i64 {
    i64::from_le_bytes(in_order(bytes, big))
}

fn number(bytes: &[u8], field: &Field) -> f64 {
    let big = field.big;
    match (field.kind, field.size) {
        ('f', 8) => f64::from_le_bytes(in_order(bytes, big)),
        ('f', 4) => f32::from_le_bytes(in_order(bytes, big)).into(),
        ('f', 2) => half(u16::from_le_bytes(in_order(bytes, big))),
        ('i', 1) => f64::from(bytes[0] as i8),
        ('i', 2) => i16::from_le_bytes(in_order(bytes, big)).into(),
        ('i', 4) => i32::from_le_bytes(in_order(bytes, big)).into(),
        ('i', 8) => whole(bytes, big) as f64,
        ('u', 2) => u16::from_le_bytes(in_order(bytes, big)).into(),
        ('u', 4) => u32::from_le_bytes(in_order(bytes, big)).into(),
        ('u', 8) => u64::from_le_bytes(in_order(bytes, big)) as f64,
        _ => f64::from(bytes[0]),
    }
}

/// A number of 16 bits (IEEE 754, binary16).
fn half(bits: u16) -> f64 {
    let sign = if bits >> 15 == 1 { -1.0 } else { 1.0 };
    let (exponent, fraction) = (i32::from(bits >> 10 & 0x1F), f64::from(bits & 0x3FF));
    sign * match exponent {
        0 => fraction * 2f64.powi(-24),
        0x1F if fraction == 0.0 => f64::INFINITY,
        0x1F => f64::NAN,
        _ => (1.0 + fraction / 1024.0) * 2f64.powi(exponent - 15),
    }
}

/// Values stored with the first index running fastest, put so that the last one does.
pub(super) fn row_by_row(values: &[f64], shape: &[usize]) -> Vec<f64> {
    let mut steps = vec![1; shape.len()];
    for axis in 1..shape.len() {
        steps[axis] = steps[axis - 1] * shape[axis - 1];
    }
    let mut index = vec![0; shape.len()];
    let mut out = Vec::with_capacity(values.len());
    for _ in 0..values.len() {
        out.push(values[index.iter().zip(&steps).map(|(i, step)| i * step).sum::<usize>()]);
        for axis in (0..shape.len()).rev() {
            index[axis] += 1;
            if index[axis] < shape[axis] {
                break;
            }
            index[axis] = 0;
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(descr: &str, fortran: &str, shape: &str, data: &[u8]) -> Vec<u8> {
        let head =
            format!("{{'descr': {descr}, 'fortran_order': {fortran}, 'shape': {shape}, }}\n");
        let length = (head.len() as u16).to_le_bytes();
        [MAGIC, &[1, 0], &length, head.as_bytes(), data].concat()
    }

    fn values(descr: &str, data: &[u8]) -> Vec<f64> {
        let bytes = file(descr, "False", "(2,)", data);
        arrays(&bytes, "x", &Place::default()).unwrap().0.remove(0).values
    }

    #[test]
    fn every_type_and_both_byte_orders() {
        let doubles = |f: fn(f64) -> [u8; 8]| [f(1.5), f(-2.0)].concat();
        assert_eq!(values("'<f8'", &doubles(f64::to_le_bytes)), [1.5, -2.0]);
        assert_eq!(values("'>f8'", &doubles(f64::to_be_bytes)), [1.5, -2.0]);
        assert_eq!(values("'>i2'", &[0xFF, 0xFE, 0, 3]), [-2.0, 3.0]);
        assert_eq!(values("'|u1'", &[255, 1]), [255.0, 1.0]);
        assert_eq!(values("'|b1'", &[1, 0]), [1.0, 0.0]);
        assert_eq!(values("'<f2'", &[0x00, 0x3E, 0x01, 0x80]), [1.5, -(2f64.powi(-24))]);
        let ticks = [1_700_000_000_000_000_000_i64, 1_700_000_000_020_000_000];
        let bytes: Vec<u8> = ticks.iter().flat_map(|tick| tick.to_le_bytes()).collect();
        assert_eq!(values("'<M8[ns]'", &bytes), [0.0, 0.02]);
    }

    #[test]
    fn fortran_order_and_fields() {
        let bytes = file("'|u1'", "True", "(2, 3)", &[1, 2, 3, 4, 5, 6]);
        let (found, _) = arrays(&bytes, "x", &Place::default()).unwrap();
        assert_eq!(found[0].values, [1.0, 3.0, 5.0, 2.0, 4.0, 6.0]);
        let descr = "[('u', '|u1'), ('name', '<U1'), ('y', '|i1', (2,))]";
        let data = [1, 65, 0, 0, 0, 2, 3, 4, 66, 0, 0, 0, 5, 255];
        let (found, others) =
            arrays(&file(descr, "False", "(2,)", &data), "x", &Place::default()).unwrap();
        assert_eq!(
            (found[0].values.as_slice(), found[1].values.as_slice()),
            (&[1.0, 4.0][..], &[2.0, 3.0, 5.0, -1.0][..])
        );
        assert_eq!((found[1].shape.as_slice(), others), (&[2, 2][..], vec!["name".to_owned()]));
    }

    #[test]
    fn what_cannot_be_read_is_refused() {
        let refused = |bytes: &[u8]| arrays(bytes, "x", &Place::default()).unwrap_err();
        assert!(matches!(refused(&file("'|O'", "False", "(2,)", &[])), DataError::Array { .. }));
        assert!(matches!(
            refused(&file("'<c16'", "False", "(1,)", &[0; 16])),
            DataError::Array { .. }
        ));
        let huge = "(9223372036854775807, 4)";
        assert!(matches!(refused(&file("'<f8'", "False", huge, &[])), DataError::Array { .. }));
        assert!(matches!(
            refused(&file("'<f8'", "False", "(2,)", &[0; 15])),
            DataError::Broken { .. }
        ));
        let good = file("'<f8'", "False", "(1,)", &[0; 8]);
        for end in 0..good.len() {
            assert!(matches!(refused(&good[..end]), DataError::Broken { .. }), "{end}");
        }
    }
}
