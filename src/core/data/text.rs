//! The text of a file in whichever encoding it was written: UTF-8, UTF-16 or Windows-1252.
//!
//! UTF-16 is told by its byte order mark, or by the zero bytes that plain letters have in
//! every other place. What is not UTF-8 and holds no control characters is read as
//! Windows-1252, the superset of Latin-1 that loggers and spreadsheets of Western Europe
//! write (WHATWG Encoding Standard, index windows-1252), and that is said.

use super::error::{DataError, place};
use super::remark::Remark;
use std::borrow::Cow;

/// What stands at the bytes 0x80 to 0x9F; the five that mean nothing are left at 0.
const HIGH: [u16; 32] = [
    0x20AC, 0, 0x201A, 0x0192, 0x201E, 0x2026, 0x2020, 0x2021, 0x02C6, 0x2030, 0x0160, 0x2039,
    0x0152, 0, 0x017D, 0, 0, 0x2018, 0x2019, 0x201C, 0x201D, 0x2022, 0x2013, 0x2014, 0x02DC,
    0x2122, 0x0161, 0x203A, 0x0153, 0, 0x017E, 0x0178,
];

/// The text, and what is to be said about its encoding.
pub(super) fn decode<'a>(
    bytes: &'a [u8],
    source: &str,
) -> Result<(Cow<'a, str>, Option<Remark>), DataError> {
    if let Some((big, from)) = utf16(bytes) {
        let units = bytes[from..].chunks_exact(2).map(|pair| match big {
            true => u16::from_be_bytes([pair[0], pair[1]]),
            false => u16::from_le_bytes([pair[0], pair[1]]),
        });
        let whole = bytes.len().is_multiple_of(2);
        return match char::decode_utf16(units).collect::<Result<String, _>>() {
            Ok(text) if whole => {
                Ok((text.into(), Some(Remark::Encoding { name: "UTF-16", line: 1 })))
            }
            _ => {
                let at = place(source, None, None);
                Err(DataError::NotText { at, byte: bytes.first().copied().unwrap_or_default() })
            }
        };
    }
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    let valid_up_to = match std::str::from_utf8(bytes) {
        Ok(text) => return Ok((text.into(), None)),
        Err(error) => error.valid_up_to(),
    };
    let line_of = |at: usize| {
        let (r, n) = bytes[..at].iter().fold((0, 0), |(r, n), byte| {
            (r + usize::from(*byte == b'\r'), n + usize::from(*byte == b'\n'))
        });
        1 + if n > 0 { n } else { r }
    };
    let mut text = String::with_capacity(bytes.len() + bytes.len() / 8);
    for (k, &byte) in bytes.iter().enumerate() {
        let code = match byte {
            0..0x20 if !matches!(byte, b'\t' | b'\r' | b'\n' | 0x0C) => 0,
            0x7F => 0,
            0x80..0xA0 => HIGH[usize::from(byte) - 0x80],
            _ => u16::from(byte),
        };
        match char::from_u32(code.into()).filter(|_| code != 0) {
            Some(c) => text.push(c),
            None => {
                return Err(DataError::NotText { at: place(source, Some(line_of(k)), None), byte });
            }
        }
    }
    let line = line_of(valid_up_to);
    Ok((text.into(), Some(Remark::Encoding { name: "Windows-1252 (Latin-1)", line })))
}

/// Whether it is big-endian UTF-16, and where the text begins; none where it is not UTF-16.
fn utf16(bytes: &[u8]) -> Option<(bool, usize)> {
    if bytes.starts_with(b"\xFF\xFE") {
        return Some((false, 2));
    }
    if bytes.starts_with(b"\xFE\xFF") {
        return Some((true, 2));
    }
    // numbers and separators are ASCII: every other byte is zero, and no other one is
    let head = &bytes[..bytes.len().min(512) & !1];
    let zeros = |odd: usize| head.iter().skip(odd).step_by(2).filter(|byte| **byte == 0).count();
    let half = head.len() / 2;
    let mostly = |zeros: usize| half >= 4 && 4 * zeros > 3 * half;
    match (zeros(0), zeros(1)) {
        (0, odd) if mostly(odd) => Some((false, 0)),
        (even, 0) if mostly(even) => Some((true, 0)),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_encoding_gives_the_same_text() {
        let text = "winkel [°],kraft [µN]\n1,2\n";
        let little: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
        let big: Vec<u8> = text.encode_utf16().flat_map(u16::to_be_bytes).collect();
        let latin: Vec<u8> = text.chars().map(|c| u8::try_from(c as u32).unwrap()).collect();
        let marked = |mark: &[u8], bytes: &[u8]| [mark, bytes].concat();
        for bytes in [
            text.as_bytes().to_vec(),
            marked(b"\xEF\xBB\xBF", text.as_bytes()),
            little.clone(),
            big.clone(),
            marked(b"\xFF\xFE", &little),
            marked(b"\xFE\xFF", &big),
            latin,
        ] {
            assert_eq!(decode(&bytes, "f").unwrap().0, text);
        }
    }

    #[test]
    fn what_is_no_text_is_refused() {
        for bytes in
            [&b"\xF0\x00\x01\x02abcdefg"[..], b"a,b\n1,\x812\n", b"\xFF\xFEa", b"\xFF\xFE\x00\xD8"]
        {
            assert!(matches!(decode(bytes, "f"), Err(DataError::NotText { .. })), "{bytes:?}");
        }
        let Err(DataError::NotText { at, byte: 1 }) = decode(b"a\n\xE9\n\x01", "f") else {
            panic!()
        };
        assert_eq!(at.line, Some(3));
    }

    #[test]
    fn the_first_line_of_another_encoding_is_said() {
        let (_, remark) = decode(b"time,u\n0,1\n# gr\xF6\xDFe\n", "f").unwrap();
        assert_eq!(remark, Some(Remark::Encoding { name: "Windows-1252 (Latin-1)", line: 3 }));
    }
}
