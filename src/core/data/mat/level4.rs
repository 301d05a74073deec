//! Version 4 of `.mat` files: full matrices of numbers, one after another.
//!
//! Each has five whole numbers of 32 bits (type, rows, columns, whether there is an imaginary
//! part, length of the name), the name and the values. The type is 1000 M + 100 O + 10 P + T:
//! byte order, 0, kind of number, and 0 for numbers, 1 for text, 2 for a sparse matrix.

use super::super::arrays::MOST;
use super::matrix::{Content, Variable};

struct Head {
    kind: u32,
    /// 0 for numbers, 1 for text, 2 for a sparse matrix.
    matrix: u32,
    is_complex: bool,
    rows: u64,
    columns: u64,
    name: usize,
    big: bool,
}

impl Head {
    fn of(bytes: &[u8]) -> Option<Self> {
        let words: Vec<[u8; 4]> =
            bytes.get(..20)?.chunks_exact(4).map(|w| [w[0], w[1], w[2], w[3]]).collect();
        let little = u32::from_le_bytes(words[0]);
        let big = little >= 5000;
        let word = |k: usize| match big {
            true => u32::from_be_bytes(words[k]),
            false => u32::from_le_bytes(words[k]),
        };
        let [order, zero, kind, matrix] = [1000, 100, 10, 1].map(|place| word(0) / place % 10);
        let fits = order == u32::from(big)
            && zero == 0
            && word(0) < 5000
            && kind <= 5
            && matrix <= 2
            && word(3) <= 1
            && (2..=64).contains(&word(4));
        fits.then(|| Self {
            kind,
            matrix,
            is_complex: word(3) == 1,
            rows: word(1).into(),
            columns: word(2).into(),
            name: word(4) as usize,
            big,
        })
    }

    fn size(&self) -> usize {
        [8, 4, 4, 2, 2, 1][self.kind as usize]
    }
}

/// Whether a file begins as one of version 4 does: its name ends with a zero.
pub fn is_one(bytes: &[u8]) -> bool {
    Head::of(bytes).is_some_and(|head| {
        let name = bytes.get(20..20 + head.name).unwrap_or_default();
        match name.split_last() {
            Some((0, letters)) => {
                let good = |byte: &u8| byte.is_ascii_alphanumeric() || *byte == b'_';
                letters.iter().all(good) && letters[0].is_ascii_alphabetic()
            }
            _ => false,
        }
    })
}

/// The variables of the file.
pub fn variables(mut bytes: &[u8]) -> Result<Vec<Variable>, String> {
    let mut found = Vec::new();
    while !bytes.is_empty() {
        let head = Head::of(bytes).ok_or("the head of a variable cannot be understood")?;
        let short = || "the last variable is not complete".to_string();
        let name = bytes.get(20..20 + head.name).ok_or_else(short)?;
        let name = String::from_utf8_lossy(name).trim_end_matches('\0').to_owned();
        let count = head.rows * head.columns;
        if count > MOST {
            return Err(format!("`{name}` has more values than a record can have"));
        }
        let size = head.size();
        let start = 20 + head.name;
        // an imaginary part follows the real one
        let parts = 1 + usize::from(head.is_complex);
        let length = count as usize * size;
        let real = bytes.get(start..start + length).ok_or_else(short)?;
        let values: Vec<f64> = real.chunks_exact(size).map(|value| number(value, &head)).collect();
        let shape = vec![head.rows as usize, head.columns as usize];
        let content = match (head.matrix, head.is_complex) {
            (1, _) => {
                let letters = values.iter().filter_map(|code| char::from_u32(*code as u32));
                Content::Texts(vec![letters.collect()])
            }
            (0, false) => Content::Numbers { shape, values },
            _ => Content::Other,
        };
        found.push(Variable { name, content });
        bytes = bytes.get(start + parts * length..).ok_or_else(short)?;
    }
    Ok(found)
}

fn number(bytes: &[u8], head: &Head) -> f64 {
    let mut own = [0; 8];
    own[..bytes.len()].copy_from_slice(bytes);
    if head.big {
        own[..bytes.len()].reverse();
    }
    let four = [own[0], own[1], own[2], own[3]];
    match head.kind {
        0 => f64::from_le_bytes(own),
        1 => f32::from_le_bytes(four).into(),
        2 => i32::from_le_bytes(four).into(),
        3 => i16::from_le_bytes([own[0], own[1]]).into(),
        4 => u16::from_le_bytes([own[0], own[1]]).into(),
        _ => own[0].into(),
    }
}
