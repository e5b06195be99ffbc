//! The pieces that all parts of a page share: numbers, names, external sentences, warnings, and pictures with their text.

use driftworld_text::{rounded, shortened};
use maud::{Markup, PreEscaped, html};

/// The list of warnings, which a reader should see before the numbers.
pub(super) fn warnings(warnings: &[String]) -> Markup {
    /// Maximum number of warnings shown.
    const MAX_WARNINGS: usize = 50;
    html! {
        @if !warnings.is_empty() {
            ul.warnings aria-label="Warnings" {
                @for warning in warnings.iter().take(MAX_WARNINGS) {
                    li { "⚠ Warning: " (calm(warning)) }
                }
                @if warnings.len() > MAX_WARNINGS { li { "⚠ and " (warnings.len() - MAX_WARNINGS) " more warnings" } }
            }
        }
    }
}

/// Inlines an SVG with its alternative text; a class may restrict it to wide or narrow pages.
pub(super) fn described(svg: &str, class: Option<&str>, alt: &str) -> Markup {
    let head = html! { title { (alt) } }.into_string();
    let class = class.map_or(String::new(), |class| format!("class=\"{class}\" "));
    let svg = svg.replacen("<svg ", &format!("<svg {class}role=\"img\" "), 1);
    PreEscaped(match svg.find('>') {
        Some(end) => format!("{}{head}{}", &svg[..=end], &svg[end + 1..]),
        None => svg,
    })
}

/// A name that may be broken between its parts.
pub(super) fn breakable(name: &str) -> Markup {
    html! { @for part in name.split_inclusive(['_', '#', '-']) { (part) wbr; } }
}

/// Sanitises an external sentence: control characters become spaces, and long text is cut. The limit is larger than the one
/// for names.
pub(super) fn calm(text: &str) -> String {
    /// Maximum number of characters shown.
    const MAX_CHARS: usize = 600;
    shortened(text, MAX_CHARS).replace(char::is_control, " ")
}

/// A number in a table: about four digits, with a typographic minus sign.
pub(super) fn number(value: f64) -> String {
    let digits = match value.abs() {
        size if size >= 1e7 => return format!("{value:.3e}").replace('-', "−"),
        size if size >= 1000.0 => 0,
        size if size >= 100.0 => 1,
        size if size >= 10.0 => 2,
        _ => 3,
    };
    rounded(value, digits).replace('-', "−")
}

/// A count with its thousands separated by narrow spaces.
pub(super) fn count(value: usize) -> String {
    let digits = value.to_string();
    let mut text = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push('\u{202f}');
        }
        text.push(digit);
    }
    text
}
