//! What a symbol such as `ms`, `kN` or `Nm` stands for.

use std::f64::consts::PI;

/// A symbol in base units.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Part<'a> {
    /// Base symbols with their powers.
    pub bases: Vec<(&'a str, i32)>,
    /// Scale due to time or angle: numerator and denominator. It is converted.
    pub free: (f64, f64),
    /// Scale due to anything else. It is not, in a unit of one symbol.
    pub scale: f64,
    /// Whether the symbol is in the table.
    pub known: bool,
}

/// A symbol of the table: names, base units, scale of time or angle, other scale, and
/// whether prefixes may stand before its first name.
type Symbol = (&'static [&'static str], &'static [(&'static str, i32)], (f64, f64), f64, Prefix);

#[derive(Debug, Clone, Copy, PartialEq)]
enum Prefix {
    /// `kN`: prefixes may stand before it.
    Takes,
    /// `min`: none may.
    Never,
    /// `ms`: one stands there already.
    Has,
}
use Prefix::{Has, Never, Takes};

const ONE: (f64, f64) = (1.0, 1.0);

#[rustfmt::skip]
const SYMBOLS: &[Symbol] = &[
    // time and angle: converted
    (&["s", "sec", "second", "seconds"], &[("s", 1)], ONE, 1.0, Never),
    (&["ms", "msec", "millisecond", "milliseconds"], &[("s", 1)], (1.0, 1e3), 1.0, Has),
    (&["us", "µs", "μs", "usec"], &[("s", 1)], (1.0, 1e6), 1.0, Has),
    (&["ns"], &[("s", 1)], (1.0, 1e9), 1.0, Has),
    (&["min", "minute", "minutes"], &[("s", 1)], (60.0, 1.0), 1.0, Never),
    (&["h", "hr", "hour", "hours"], &[("s", 1)], (3600.0, 1.0), 1.0, Never),
    (&["rad", "radian", "radians"], &[("rad", 1)], ONE, 1.0, Never),
    (&["mrad"], &[("rad", 1)], (1.0, 1e3), 1.0, Has),
    (&["deg", "°", "degree", "degrees"], &[("rad", 1)], (PI, 180.0), 1.0, Never),
    // everything else: compared only
    (&["rev"], &[("rad", 1)], ONE, 2.0 * PI, Never),
    (&["rpm"], &[("rad", 1), ("s", -1)], ONE, 2.0 * PI / 60.0, Never),
    (&["Hz"], &[("s", -1)], ONE, 1.0, Takes),
    (&["m", "metre", "metres", "meter", "meters"], &[("m", 1)], ONE, 1.0, Takes),
    (&["in", "inch"], &[("m", 1)], ONE, 0.0254, Never),
    (&["ft"], &[("m", 1)], ONE, 0.3048, Never),
    (&["l", "L"], &[("m", 3)], ONE, 1e-3, Takes),
    (&["g"], &[("kg", 1)], ONE, 1e-3, Takes),
    (&["N"], &[("kg", 1), ("m", 1), ("s", -2)], ONE, 1.0, Takes),
    (&["lbf"], &[("kg", 1), ("m", 1), ("s", -2)], ONE, 4.448_221_615_260_5, Never),
    (&["Pa"], &[("kg", 1), ("m", -1), ("s", -2)], ONE, 1.0, Takes),
    (&["hPa"], &[("kg", 1), ("m", -1), ("s", -2)], ONE, 100.0, Has),
    (&["bar"], &[("kg", 1), ("m", -1), ("s", -2)], ONE, 1e5, Takes),
    (&["J"], &[("kg", 1), ("m", 2), ("s", -2)], ONE, 1.0, Takes),
    (&["W"], &[("kg", 1), ("m", 2), ("s", -3)], ONE, 1.0, Takes),
    (&["A"], &[("A", 1)], ONE, 1.0, Takes),
    (&["V", "volt", "volts"], &[("kg", 1), ("m", 2), ("s", -3), ("A", -1)], ONE, 1.0, Takes),
    (&["Ohm", "ohm", "Ω", "Ω"], &[("kg", 1), ("m", 2), ("s", -3), ("A", -2)], ONE, 1.0, Takes),
    (&["S"], &[("kg", -1), ("m", -2), ("s", 3), ("A", 2)], ONE, 1.0, Takes),
    (&["C"], &[("A", 1), ("s", 1)], ONE, 1.0, Takes),
    (&["F"], &[("kg", -1), ("m", -2), ("s", 4), ("A", 2)], ONE, 1.0, Takes),
    (&["H"], &[("kg", 1), ("m", 2), ("s", -2), ("A", -2)], ONE, 1.0, Takes),
    (&["Wb"], &[("kg", 1), ("m", 2), ("s", -2), ("A", -1)], ONE, 1.0, Takes),
    (&["T"], &[("kg", 1), ("s", -2), ("A", -1)], ONE, 1.0, Takes),
    (&["K"], &[("K", 1)], ONE, 1.0, Takes),
    (&["°C", "degC", "℃"], &[("degC", 1)], ONE, 1.0, Never),
    (&["mol"], &[("mol", 1)], ONE, 1.0, Takes),
    (&["%", "percent"], &[], ONE, 0.01, Never),
    (&["dB"], &[("dB", 1)], ONE, 1.0, Never),
];

const PREFIXES: &[(char, f64)] = &[
    ('p', 1e-12),
    ('n', 1e-9),
    ('u', 1e-6),
    ('µ', 1e-6),
    ('μ', 1e-6),
    ('m', 1e-3),
    ('c', 1e-2),
    ('d', 1e-1),
    ('k', 1e3),
    ('M', 1e6),
    ('G', 1e9),
];

/// What the symbol stands for; a symbol nobody knows stands for itself.
pub(super) fn resolve(symbol: &str) -> Vec<Part<'_>> {
    if let Some((part, _)) = known(symbol) {
        return vec![part];
    }
    // `Nm`, `kNm`, `Nms`: the reading with the fewest prefixes, then the fewest factors
    match split(symbol, &mut Vec::new()) {
        Some((_, parts)) => parts,
        None => vec![Part { bases: vec![(symbol, 1)], free: ONE, scale: 1.0, known: false }],
    }
}

/// A symbol of the table, with or without a prefix, and whether it has one.
fn known(symbol: &str) -> Option<(Part<'static>, bool)> {
    let find = |name: &str| SYMBOLS.iter().find(|(names, ..)| names.contains(&name));
    if let Some((_, bases, free, scale, prefix)) = find(symbol) {
        let part = Part { bases: bases.to_vec(), free: *free, scale: *scale, known: true };
        return Some((part, *prefix == Has));
    }
    let (_, factor) = PREFIXES.iter().find(|(prefix, _)| symbol.starts_with(*prefix))?;
    let stem = symbol.get(symbol.chars().next()?.len_utf8()..)?;
    let (_, bases, free, scale, prefix) = find(stem)?;
    // a short name only: `mmetre` is no unit
    if *prefix != Takes || stem.chars().count() > 3 {
        return None;
    }
    let scale = scale * factor;
    Some((Part { bases: bases.to_vec(), free: *free, scale, known: true }, true))
}

/// Splits a run of letters into known symbols, none of them twice: one writes `m2`, not
/// `mm`, and so `Nmm` is N times mm. The score counts prefixes, then symbols.
fn split<'a>(
    symbol: &'a str,
    used: &mut Vec<&'a str>,
) -> Option<((usize, usize), Vec<Part<'static>>)> {
    if symbol.is_empty() {
        return Some(((0, 0), Vec::new()));
    }
    if symbol.chars().count() > 8 {
        return None;
    }
    let mut best: Option<((usize, usize), Vec<Part<'static>>)> = None;
    for (end, c) in symbol.char_indices() {
        let (first, rest) = symbol.split_at(end + c.len_utf8());
        let Some((part, prefixed)) = known(first).filter(|_| !used.contains(&first)) else {
            continue;
        };
        used.push(first);
        let tail = split(rest, used);
        used.pop();
        if let Some(((prefixes, symbols), mut parts)) = tail {
            let score = (prefixes + usize::from(prefixed), symbols + 1);
            if best.as_ref().is_none_or(|(other, _)| score < *other) {
                parts.insert(0, part);
                best = Some((score, parts));
            }
        }
    }
    best
}
