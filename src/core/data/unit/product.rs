//! A unit's text read as a product of symbols with whole powers.

use super::symbols;
use std::collections::BTreeMap;

/// A unit as powers of base symbols, with what scales it: numerator and denominator are
/// due to time and angle and are converted, `scale` is due to everything else.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Product {
    pub powers: BTreeMap<String, i32>,
    pub numerator: f64,
    pub denominator: f64,
    pub scale: f64,
    /// How many symbols were multiplied: 2 for `N mm`.
    pub symbols: usize,
    /// Whether all of them are known.
    pub known: bool,
}

impl Product {
    fn one() -> Self {
        let powers = BTreeMap::new();
        Self { powers, numerator: 1.0, denominator: 1.0, scale: 1.0, symbols: 0, known: true }
    }

    pub fn parse(text: &str) -> Option<Self> {
        let mut product = Self::one();
        if text.trim() == "-" {
            return Some(product);
        }
        let text = text.replace("**", "^");
        let mut reader = Reader { rest: text.trim(), depth: 0 };
        reader.product(&mut product, 1)?;
        reader.rest.is_empty().then_some(product)
    }

    /// Multiplies by bases, a scale of time and angle and another scale, each to `power`.
    fn multiply<'a>(
        &mut self,
        bases: impl Iterator<Item = (&'a str, i32)>,
        free: (f64, f64),
        scale: f64,
        power: i32,
    ) {
        for (base, of_base) in bases {
            let total = self.powers.entry(base.to_owned()).or_insert(0);
            *total = total.saturating_add(of_base.saturating_mul(power));
        }
        self.powers.retain(|_, power| *power != 0);
        let (numerator, denominator) = if power < 0 { (free.1, free.0) } else { free };
        self.numerator *= numerator.powi(power.abs());
        self.denominator *= denominator.powi(power.abs());
        self.scale *= scale.powi(power);
    }
}

/// Reads a product of symbols, numbers and groups from the front of a text.
struct Reader<'a> {
    rest: &'a str,
    depth: usize,
}

impl<'a> Reader<'a> {
    /// Multiplies `into` by what stands up to the end or a closing parenthesis.
    fn product(&mut self, into: &mut Product, sign: i32) -> Option<()> {
        let mut power_sign = sign;
        loop {
            self.rest = self.rest.trim_start_matches([' ', '\t', '*', '·', '⋅', '×', '.']);
            match self.rest.chars().next() {
                None | Some(')') => return Some(()),
                Some('/') => {
                    self.rest = &self.rest[1..];
                    power_sign = -sign;
                    continue;
                }
                Some('(') => self.group(into, power_sign)?,
                Some(c) if c.is_ascii_digit() => {
                    let number = self.take(|c| c.is_ascii_digit() || c == '.');
                    let value: f64 = number.parse().ok().filter(|v| *v > 0.0)?;
                    into.scale *= value.powi(power_sign * self.power()?);
                }
                Some(_) => {
                    let symbol = self.take(|c| {
                        !c.is_ascii_digit()
                            && !c.is_whitespace()
                            && !"*·⋅×./()^-+⁻⁰¹²³⁴⁵⁶⁷⁸⁹".contains(c)
                    });
                    if symbol.is_empty() {
                        return None;
                    }
                    let parts = symbols::resolve(symbol);
                    let power = self.power()?;
                    into.symbols += parts.len();
                    into.known &= parts.iter().all(|part| part.known);
                    // in `kgm2` the power belongs to the metre alone
                    for (k, part) in parts.iter().enumerate() {
                        let power = if k + 1 == parts.len() { power } else { 1 };
                        let bases = part.bases.iter().copied();
                        into.multiply(bases, part.free, part.scale, power_sign * power);
                    }
                }
            }
            power_sign = sign;
        }
    }

    fn group(&mut self, into: &mut Product, sign: i32) -> Option<()> {
        self.depth += 1;
        if self.depth > 8 {
            return None;
        }
        self.rest = &self.rest[1..];
        let mut inner = Product::one();
        self.product(&mut inner, 1)?;
        self.rest = self.rest.strip_prefix(')')?;
        self.depth -= 1;
        let power = sign * self.power()?;
        into.symbols += inner.symbols;
        into.known &= inner.known;
        let bases = inner.powers.iter().map(|(base, power)| (base.as_str(), *power));
        into.multiply(bases, (inner.numerator, inner.denominator), inner.scale, power);
        Some(())
    }

    fn take(&mut self, wanted: impl Fn(char) -> bool) -> &'a str {
        let end = self.rest.find(|c| !wanted(c)).unwrap_or(self.rest.len());
        let (taken, rest) = self.rest.split_at(end);
        self.rest = rest;
        taken
    }

    /// The power behind a factor: `^2`, `^-2`, `^(-2)`, `2`, `-2`, `²`, `⁻²`, or 1.
    fn power(&mut self) -> Option<i32> {
        let caret = self.rest.strip_prefix('^').map(|rest| self.rest = rest).is_some();
        let group = caret && self.rest.strip_prefix('(').map(|rest| self.rest = rest).is_some();
        let raised = self.take(|c| "⁻⁰¹²³⁴⁵⁶⁷⁸⁹".contains(c));
        let digits: String = if raised.is_empty() {
            let signed = self.rest.strip_prefix(['-', '+']).unwrap_or(self.rest);
            if !signed.starts_with(|c: char| c.is_ascii_digit()) {
                return if caret { None } else { Some(1) };
            }
            self.take(|c| c.is_ascii_digit() || "+-".contains(c)).to_owned()
        } else {
            let plain = "-0123456789";
            raised
                .chars()
                .filter_map(|c| "⁻⁰¹²³⁴⁵⁶⁷⁸⁹".chars().position(|r| r == c))
                .filter_map(|i| plain.chars().nth(i))
                .collect()
        };
        if group {
            self.rest = self.rest.strip_prefix(')')?;
        }
        // a power like 0.5 is no whole power: the text is compared instead
        if caret && self.rest.starts_with('.') {
            return None;
        }
        digits.parse().ok().filter(|power: &i32| power.abs() <= 99)
    }
}
