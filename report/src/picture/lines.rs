//! Breaks texts into lines of a given width: at spaces, and inside unbreakable parts only if necessary.

use driftworld_text::{NO_BREAK, with_blanks};

use super::text_width;

/// Breaks a text into lines of at most this width, at font size `size` in pixels. Lines break at spaces.
/// [Whole](driftworld_text::whole) parts that do not fit into one line are broken after commas, semicolons and colons and before
/// brackets; if a piece still does not fit, between words without numbers; and finally between any words. A single word that is
/// still too wide is cut.
///
/// # Example
/// ```
/// use driftworld_report::picture::text_lines;
/// use driftworld_text::whole;
/// let text = format!("It is {}.", whole("8 × 8 m"));
/// assert_eq!(text_lines(&text, 10.0, 50.0), ["It is", "8 × 8 m."]);
/// ```
pub fn text_lines(text: &str, size: f32, width: f32) -> Vec<String> {
    let fits = |text: &str| text_width(text, size) <= width;
    let mut lines: Vec<String> = Vec::new();
    for piece in pieces(text, &fits) {
        let longer = lines.last().map(|line| format!("{line} {piece}"));
        match (lines.last_mut(), longer) {
            (Some(line), Some(longer)) if fits(&longer) => *line = longer,
            _ => lines.push(cut(&piece, size, width)),
        }
    }
    lines
}

/// The pieces of a text between which lines may break.
fn pieces(text: &str, fits: &dyn Fn(&str) -> bool) -> Vec<String> {
    let mut pieces = vec![text.to_owned()];
    // Rules for where a line may break, from the best to the worst.
    let rules: [fn(&str, char, &str) -> bool; 4] = [
        |_, blank, _| blank == ' ',
        |before, _, end| before.ends_with([',', ';', ':']) || end.starts_with('('),
        |before, _, end| !before.ends_with(is_of_number) && !end.starts_with(is_of_number),
        |_, _, _| true,
    ];
    for (rule_index, may_break) in rules.into_iter().enumerate() {
        let split = pieces.into_iter().flat_map(|piece| {
            if rule_index > 0 && fits(&piece) {
                vec![piece]
            } else {
                split(&piece, may_break)
            }
        });
        pieces = split.collect();
    }
    let pieces = pieces.into_iter().map(|piece| with_blanks(&piece));
    pieces.filter(|piece| !piece.is_empty()).collect()
}

/// Splits a text at the spaces and no-break spaces where `may_break` allows it.
fn split(text: &str, may_break: fn(&str, char, &str) -> bool) -> Vec<String> {
    let mut pieces = Vec::new();
    let mut piece_start = 0;
    for (start, blank) in text.match_indices([' ', NO_BREAK]) {
        let end = start + blank.len();
        let c = if blank == " " { ' ' } else { NO_BREAK };
        if may_break(&text[piece_start..start], c, &text[end..]) {
            pieces.push(text[piece_start..start].to_owned());
            piece_start = end;
        }
    }
    pieces.push(text[piece_start..].to_owned());
    pieces
}

/// Whether a character at the edge of a word belongs to a number or its unit.
fn is_of_number(c: char) -> bool {
    c.is_ascii_digit() || "×%−-+".contains(c)
}

/// The text, truncated if it is too wide.
pub(super) fn cut(text: &str, size: f32, width: f32) -> String {
    if text_width(text, size) <= width {
        return text.to_owned();
    }
    let mut shortened: String = text.to_owned();
    while shortened.pop().is_some() {
        let shorter = format!("{}…", shortened.trim_end());
        if text_width(&shorter, size) <= width {
            return shorter;
        }
    }
    String::new()
}

#[cfg(test)]
mod tests {
    use super::*;
    use driftworld_text::whole;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        /// No word is lost or moved; no line is too wide; and whole parts that fit into a line are not broken.
        #[test]
        fn whole_parts_stay_together(
            facts in prop::collection::vec("[a-z_]{1,12} [0-9]{1,4} (m|s|× [0-9]{1,2} m)( \\([0-9]{1,3}\\))?", 1..8),
            width in 40_u16..500,
        ) {
            let width = f32::from(width);
            let text: Vec<String> = facts.iter().map(|fact| whole(fact)).collect();
            let lines = text_lines(&text.join(", "), 13.0, width);
            prop_assert!(lines.iter().all(|line| text_width(line, 13.0) <= width), "{lines:?}");
            let is_cut = lines.iter().any(|line| line.ends_with('…'));
            prop_assert!(is_cut || lines.join(" ") == facts.join(", "), "{lines:?}");
            for fact in &facts {
                if text_width(&format!("{fact},"), 13.0) <= width {
                    prop_assert!(lines.iter().any(|line| line.contains(fact.as_str())), "{fact}: {lines:?}");
                }
            }
        }
    }

    #[test]
    fn too_wide_parts_break_after_commas_first_and_numbers_that_fit_stay_whole() {
        let text = whole("layout maze 8 × 8, 50 % of dead ends open (maze 8 × 8)");
        let lines = |width| text_lines(&text, 13.0, width);
        assert_eq!(lines(400.0), ["layout maze 8 × 8, 50 % of dead ends open (maze 8 × 8)"]);
        assert_eq!(
            lines(200.0),
            ["layout maze 8 × 8,", "50 % of dead ends open", "(maze 8 × 8)"]
        );
        assert_eq!(
            lines(110.0),
            ["layout maze 8 × 8,", "50 % of dead ends", "open (maze 8 × 8)"]
        );
        assert_eq!(
            lines(90.0),
            ["layout", "maze 8 × 8,", "50 % of dead", "ends open", "(maze 8 × 8)"]
        );
    }
}
