//! "Did you mean …?": finds the known word most similar to a misspelt one.

use crate::limits::MAX_KEY_BYTES;

/// The end of a message about a misspelt word, `; did you mean "red"?`; empty if no known word is similar.
pub fn did_you_mean<S: AsRef<str>>(word: &str, known: impl IntoIterator<Item = S>) -> String {
    nearest(word, known).map_or_else(String::new, |near| format!("; did you mean {near:?}?"))
}

/// The known word most likely meant by a misspelt one.
pub fn nearest<S: AsRef<str>>(word: &str, known: impl IntoIterator<Item = S>) -> Option<String> {
    // No name is this long, and comparing takes memory proportional to the product of the lengths.
    if word.len() > MAX_KEY_BYTES {
        return None;
    }
    let lower = word.to_lowercase();
    let num_chars = lower.chars().count();
    let near = known.into_iter().filter_map(|candidate| {
        let name = candidate.as_ref();
        let length = name.chars().count();
        // A word of a very different length is not similar.
        if name.len() > MAX_KEY_BYTES || length.abs_diff(num_chars) > 2 + length / 4 {
            return None;
        }
        let distance = strsim::damerau_levenshtein(&lower, &name.to_lowercase());
        (distance < length && distance <= 1 + length / 4).then_some((distance, candidate))
    });
    let nearest = near.min_by_key(|(distance, _)| *distance);
    nearest.map(|(_, candidate)| candidate.as_ref().to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nearest_word_is_found_unless_it_is_too_different() {
        assert_eq!(nearest("bleu", ["blue", "red"]).as_deref(), Some("blue"));
        assert_eq!(
            nearest("maxsteps", ["max_steps", "objects"]).as_deref(),
            Some("max_steps")
        );
        assert_eq!(nearest("zebra", ["blue", "red"]), None);
    }
}
