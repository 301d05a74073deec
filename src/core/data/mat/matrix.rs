//! Variables of a version-5 file: numbers, texts, cells and structures.

use super::super::arrays::MOST;
use super::element::{Bytes, Element, Kind};
use flate2::read::ZlibDecoder;
use std::io::Read;

/// A variable or a field.
#[derive(Debug)]
pub struct Variable {
    pub name: String,
    pub content: Content,
}

/// What a variable holds.
#[derive(Debug)]
pub enum Content {
    /// Numbers, the first index running fastest.
    Numbers { shape: Vec<usize>, values: Vec<f64> },
    /// The lines of a text, or a cell array of texts.
    Texts(Vec<String>),
    /// The fields of each element of a structure array.
    Structures(Vec<Vec<Variable>>),
    /// An object of a class, of which the file does not say how it is made up.
    Object,
    /// Something else: complex or sparse numbers, functions, cells of other things.
    Other,
}

/// Depth to which structures and cells may hold each other.
const DEPTH: usize = 16;

/// The next variable; none where the element holds none.
pub fn variable(bytes: &mut Bytes<'_>, depth: usize) -> Result<Option<Variable>, String> {
    if depth > DEPTH {
        return Err(format!("structures within each other beyond {DEPTH} levels"));
    }
    let element = bytes.element()?;
    match element.kind {
        Kind::Matrix if element.data.is_empty() => Ok(Some(Variable {
            name: String::new(),
            content: Content::Numbers { shape: vec![0, 0], values: vec![] },
        })),
        Kind::Matrix => matrix(&element, depth).map(Some),
        Kind::Compressed if depth == 0 => {
            let mut unpacked = Vec::new();
            let mut packed = ZlibDecoder::new(element.data).take(8 * MOST);
            packed.read_to_end(&mut unpacked).map_err(|error| error.to_string())?;
            let mut inside = Bytes::new(&unpacked, element.is_big());
            // a packed element within a packed one is not written by anybody
            variable(&mut inside, 1)
        }
        _ => Ok(None),
    }
}

fn matrix(element: &Element<'_>, depth: usize) -> Result<Variable, String> {
    let mut inside = element.inside();
    let flags = inside.element()?.numbers();
    let flags = *flags.first().ok_or("a variable without flags")? as u32;
    let (class, is_complex) = (flags & 0xFF, flags & 0x0800 != 0);
    // an opaque object has other parts than all the rest
    if class == 17 {
        let name = inside.element()?.text();
        return Ok(Variable { name, content: Content::Object });
    }
    let dimensions = inside.element()?;
    let shape: Vec<usize> = dimensions.numbers().iter().map(|n| n.max(0.0) as usize).collect();
    let count = shape.iter().try_fold(1_u64, |product, n| product.checked_mul(*n as u64));
    let count = count.filter(|count| *count <= MOST).ok_or("more values than a record can have")?;
    let count = count as usize;
    let name = inside.element()?.text();
    let content = match class {
        1 => cells(&mut inside, count, depth)?,
        2 => structures(&mut inside, count, depth)?,
        3 => {
            // the class of an object of the old kind stands before its fields
            inside.element()?;
            structures(&mut inside, count, depth)?
        }
        4 => Content::Texts(lines(&inside.element()?.text(), &shape)),
        6..=15 if !is_complex => {
            let part = inside.element()?;
            if part.count() != count {
                return Err(format!(
                    "`{name}` has {} values where {count} are stated",
                    part.count()
                ));
            }
            Content::Numbers { shape, values: part.numbers() }
        }
        _ => Content::Other,
    };
    Ok(Variable { name, content })
}

/// The rows of a text, which is stored column by column.
fn lines(text: &str, shape: &[usize]) -> Vec<String> {
    let letters: Vec<char> = text.chars().collect();
    let rows = shape.first().copied().unwrap_or(1);
    if rows <= 1 || !letters.len().is_multiple_of(rows) {
        return vec![text.trim_end().to_owned()];
    }
    let row = |r: usize| letters.iter().skip(r).step_by(rows).collect::<String>();
    (0..rows).map(|r| row(r).trim_end().to_owned()).collect()
}

fn cells(inside: &mut Bytes<'_>, count: usize, depth: usize) -> Result<Content, String> {
    let mut texts = Vec::new();
    let mut other = false;
    for _ in 0..count {
        match variable(inside, depth + 1)?.map(|cell| cell.content) {
            Some(Content::Texts(mut lines)) if lines.len() == 1 => texts.append(&mut lines),
            // an empty unit is an empty array
            Some(Content::Numbers { values, .. }) if values.is_empty() => texts.push(String::new()),
            _ => other = true,
        }
    }
    Ok(if other || count == 0 { Content::Other } else { Content::Texts(texts) })
}

fn structures(inside: &mut Bytes<'_>, count: usize, depth: usize) -> Result<Content, String> {
    let width = inside.element()?.numbers().first().copied().unwrap_or(0.0) as usize;
    let names = inside.element()?;
    if width == 0 {
        return if names.data.is_empty() {
            Ok(Content::Other)
        } else {
            Err("field names of length 0".into())
        };
    }
    let names: Vec<String> = names
        .data
        .chunks(width)
        .map(|name| {
            let end = name.iter().position(|byte| *byte == 0).unwrap_or(name.len());
            String::from_utf8_lossy(&name[..end]).into_owned()
        })
        .collect();
    let mut elements = Vec::new();
    for _ in 0..count {
        let mut fields = Vec::with_capacity(names.len());
        for name in &names {
            if let Some(field) = variable(inside, depth + 1)? {
                fields.push(Variable { name: name.clone(), content: field.content });
            }
        }
        elements.push(fields);
    }
    Ok(Content::Structures(elements))
}
