//! Text that comes from files, made harmless for HTML, SVG and JSON.
//!
//! A name may hold markup, which is escaped, and controls that change how the text *around* it
//! is read: the bidirectional embeddings, overrides and isolates (Unicode Standard Annex 9,
//! section 2) and the C0 and C1 controls. Those are written out as their code, `[U+202E]`.

/// Whether a character changes the reading of other text, or cannot stand in HTML.
fn acts(c: char) -> bool {
    let breaks_lines = matches!(c, '\n' | '\t');
    let bidirectional = matches!(
        c,
        '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}'
    );
    (c.is_control() && !breaks_lines) || bidirectional || matches!(c, '\u{2028}' | '\u{2029}')
}

/// The text with every acting character written out as its code.
pub fn plain(text: &str) -> String {
    if !text.chars().any(acts) {
        return text.into();
    }
    let written = |c: char| {
        if acts(c) { format!("[U+{:04X}]", u32::from(c)) } else { c.to_string() }
    };
    text.chars().map(written).collect()
}

/// Text as it may stand in HTML and SVG.
pub fn escape(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in plain(text).chars() {
        match c {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            '\'' => safe.push_str("&#39;"),
            c => safe.push(c),
        }
    }
    safe
}

/// A JSON document as it may stand inside a `<script>` element of data: without `<`, which
/// could end it.
pub fn embedded(json: &str) -> String {
    json.replace('<', "\\u003c")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markup_and_acting_characters_are_displayed_not_obeyed() {
        assert_eq!(escape("a<b>&\"'"), "a&lt;b&gt;&amp;&quot;&#39;");
        assert_eq!(escape("x\u{202e}y\u{7}"), "x[U+202E]y[U+0007]");
        // letters that are written from right to left are no control
        assert_eq!(escape("\u{5d0}\u{5d1} \u{b0}"), "\u{5d0}\u{5d1} \u{b0}");
        assert_eq!(embedded("\"</script>\""), "\"\\u003c/script>\"");
    }
}
