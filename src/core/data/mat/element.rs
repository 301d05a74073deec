//! Data elements of a version-5 file: a tag with type and length, and the data, padded to
//! eight bytes; four bytes or less stand in the tag itself.

/// What an element holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    Int8,
    Uint8,
    Int16,
    Uint16,
    Int32,
    Uint32,
    Single,
    Double,
    Int64,
    Uint64,
    Matrix,
    Compressed,
    Utf8,
    Utf16,
    Utf32,
}

impl Kind {
    fn of(number: u32) -> Option<Self> {
        Some(match number {
            1 => Self::Int8,
            2 => Self::Uint8,
            3 => Self::Int16,
            4 => Self::Uint16,
            5 => Self::Int32,
            6 => Self::Uint32,
            7 => Self::Single,
            9 => Self::Double,
            12 => Self::Int64,
            13 => Self::Uint64,
            14 => Self::Matrix,
            15 => Self::Compressed,
            16 => Self::Utf8,
            17 => Self::Utf16,
            18 => Self::Utf32,
            _ => return None,
        })
    }

    fn size(self) -> usize {
        match self {
            Self::Int16 | Self::Uint16 | Self::Utf16 => 2,
            Self::Int32 | Self::Uint32 | Self::Single | Self::Utf32 => 4,
            Self::Double | Self::Int64 | Self::Uint64 => 8,
            _ => 1,
        }
    }
}

/// Bytes that are read from the front.
#[derive(Debug, Clone, Copy)]
pub struct Bytes<'a> {
    rest: &'a [u8],
    big: bool,
}

/// One element.
#[derive(Debug, Clone, Copy)]
pub struct Element<'a> {
    pub kind: Kind,
    pub data: &'a [u8],
    big: bool,
}

impl<'a> Bytes<'a> {
    pub fn new(rest: &'a [u8], big: bool) -> Self {
        Self { rest, big }
    }

    pub fn is_empty(&self) -> bool {
        // what pads a file to a whole block is no element
        self.rest.len() < 8 && self.rest.iter().all(|byte| *byte == 0)
    }

    fn take(&mut self, count: usize) -> Result<&'a [u8], String> {
        if count > self.rest.len() {
            return Err(format!("{count} bytes are stated where {} are left", self.rest.len()));
        }
        let (taken, rest) = self.rest.split_at(count);
        self.rest = rest;
        Ok(taken)
    }

    fn word(&mut self) -> Result<u32, String> {
        let four = self.take(4)?;
        let four = [four[0], four[1], four[2], four[3]];
        Ok(if self.big { u32::from_be_bytes(four) } else { u32::from_le_bytes(four) })
    }

    /// The next element.
    pub fn element(&mut self) -> Result<Element<'a>, String> {
        let first = self.word()?;
        let unknown = |number: u32| format!("an element of the unknown type {number}");
        let big = self.big;
        if first >> 16 != 0 {
            let (length, number) = ((first >> 16) as usize, first & 0xFFFF);
            let kind = Kind::of(number).ok_or_else(|| unknown(number))?;
            let four = self.take(4)?;
            let data = four.get(..length).ok_or("a short element of more than four bytes")?;
            return Ok(Element { kind, data, big });
        }
        let length = self.word()? as usize;
        let kind = Kind::of(first).ok_or_else(|| unknown(first))?;
        let data = self.take(length)?;
        if kind != Kind::Compressed {
            let pad = (8 - length % 8) % 8;
            self.rest = self.rest.get(pad..).unwrap_or_default();
        }
        Ok(Element { kind, data, big })
    }
}

impl<'a> Element<'a> {
    /// What is in a matrix.
    pub fn inside(&self) -> Bytes<'a> {
        Bytes::new(self.data, self.big)
    }

    pub fn is_big(&self) -> bool {
        self.big
    }

    /// Its numbers.
    pub fn numbers(&self) -> Vec<f64> {
        let big = self.big;
        macro_rules! all {
            ($type:ty) => {
                self.data
                    .chunks_exact(size_of::<$type>())
                    .map(|bytes| {
                        let mut own = [0; size_of::<$type>()];
                        own.copy_from_slice(bytes);
                        if big {
                            own.reverse();
                        }
                        <$type>::from_le_bytes(own) as f64
                    })
                    .collect()
            };
        }
        match self.kind {
            Kind::Int8 => all!(i8),
            Kind::Int16 => all!(i16),
            Kind::Uint16 | Kind::Utf16 => all!(u16),
            Kind::Int32 => all!(i32),
            Kind::Uint32 | Kind::Utf32 => all!(u32),
            Kind::Single => all!(f32),
            Kind::Double => all!(f64),
            Kind::Int64 => all!(i64),
            Kind::Uint64 => all!(u64),
            _ => all!(u8),
        }
    }

    /// How many numbers it has.
    pub fn count(&self) -> usize {
        self.data.len() / self.kind.size()
    }

    /// Its text.
    pub fn text(&self) -> String {
        match self.kind {
            Kind::Utf8 | Kind::Int8 | Kind::Uint8 => {
                String::from_utf8_lossy(self.data).into_owned()
            }
            Kind::Utf32 => self.codes().filter_map(char::from_u32).collect(),
            _ => {
                let units = self.codes().map(|code| code as u16);
                char::decode_utf16(units).map(|c| c.unwrap_or('\u{FFFD}')).collect()
            }
        }
    }

    fn codes(&self) -> impl Iterator<Item = u32> {
        self.numbers().into_iter().map(|code| code as u32)
    }
}
