//! What may be missing: which effects are looked for, and which parameters may be wrong.

/// The effect of a parameter that has another value.
const PARAMETER: &str = "parameter";

/// What a search for what is missing may name.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Scope {
    /// Only these effects; empty: all.
    pub only: Vec<String>,
    /// Not these.
    pub without: Vec<String>,
    /// Parameters that are right.
    pub fixed: Vec<String>,
}

impl Scope {
    /// Whether an effect may be named.
    pub(crate) fn effect(&self, name: &str) -> bool {
        let listed = |list: &[String]| list.iter().any(|own| own == name);
        (self.only.is_empty() || listed(&self.only)) && !listed(&self.without)
    }

    /// Whether a parameter may be wrong.
    pub(crate) fn parameter(&self, name: &str) -> bool {
        self.effect(PARAMETER) && !self.fixed.iter().any(|own| own == name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_out_is_not_named() {
        let scope = |only: &[&str], without: &[&str]| Scope {
            only: only.iter().map(|s| s.to_string()).collect(),
            without: without.iter().map(|s| s.to_string()).collect(),
            fixed: vec!["mass".into()],
        };
        assert!(scope(&[], &[]).effect("drag") && scope(&[], &[]).parameter("rope"));
        assert!(!scope(&["drag"], &[]).parameter("rope"));
        assert!(!scope(&["drag"], &["drag"]).effect("drag"));
        assert!(!scope(&[], &[]).parameter("mass"));
    }
}
