//! Parses keys from a terminal's bytes, and guesses which are held down: a terminal reports presses, but no releases.

/// The meaning of a key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Key {
    Ahead,
    Back,
    Left,
    Right,
    /// Use the object ahead, pick up, put down.
    Interact,
    /// Change the view.
    View,
    /// Restart.
    Restart,
    Quit,
}

impl Key {
    /// Parses the keys in a terminal's bytes; unknown ones are skipped.
    pub(super) fn all(mut bytes: &[u8]) -> Vec<Self> {
        let mut keys = Vec::new();
        while let [first, rest @ ..] = bytes {
            let (key, rest) = match (first, rest) {
                (0x1b, [b'[' | b'O', letter, rest @ ..]) => (Self::of_arrow(*letter), rest),
                (letter, rest) => (Self::of_letter(*letter), rest),
            };
            keys.extend(key);
            bytes = rest;
        }
        keys
    }

    fn of_arrow(letter: u8) -> Option<Self> {
        Some(match letter {
            b'A' => Self::Ahead,
            b'B' => Self::Back,
            b'C' => Self::Right,
            b'D' => Self::Left,
            _ => return None,
        })
    }

    fn of_letter(letter: u8) -> Option<Self> {
        Some(match letter.to_ascii_lowercase() {
            b'w' => Self::Ahead,
            b's' => Self::Back,
            b'a' => Self::Left,
            b'd' => Self::Right,
            b' ' | b'e' => Self::Interact,
            b'v' => Self::View,
            b'r' => Self::Restart,
            // Ctrl-C and Ctrl-D arrive as these bytes.
            b'q' | 0x03 | 0x04 => Self::Quit,
            _ => return None,
        })
    }
}

/// Seconds for which a key counts as held after a press: enough to bridge the gap until the terminal repeats it.
const WALK: f64 = 0.3;
const TURN: f64 = 0.15;

/// The keys held down.
#[derive(Debug, Default)]
pub(super) struct Held {
    /// The last key ahead or back, and the last key left or right, each with the time until which it counts as held.
    along: Option<(Key, f64)>,
    turn: Option<(Key, f64)>,
    interact: bool,
}

impl Held {
    pub(super) fn press(&mut self, key: Key, now: f64) {
        match key {
            Key::Ahead | Key::Back => self.along = Some((key, now + WALK)),
            Key::Left | Key::Right => self.turn = Some((key, now + TURN)),
            Key::Interact => self.interact = true,
            Key::View | Key::Restart | Key::Quit => {}
        }
    }

    /// Shares of the maximum speed and turn rate, and whether to interact, which happens once; `None` if nothing is held.
    pub(super) fn take(&mut self, now: f64) -> Option<(f64, f64, bool)> {
        let held = |key: Option<(Key, f64)>| key.filter(|(_, until)| now < *until).map(|(key, _)| key);
        let (along, turn) = (held(self.along), held(self.turn));
        let interact = std::mem::take(&mut self.interact);
        let share = |key: Option<Key>| match key {
            Some(Key::Ahead | Key::Right) => 1.0,
            Some(Key::Back) => -0.5,
            Some(_) => -1.0,
            None => 0.0,
        };
        (along.is_some() || turn.is_some() || interact).then(|| (share(along), share(turn), interact))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_and_arrows_are_keys_and_others_are_skipped() {
        let check = |bytes: &[u8], expected: &[Key]| assert_eq!(Key::all(bytes), expected, "{bytes:?}");
        check(b"wASd ", &[Key::Ahead, Key::Left, Key::Back, Key::Right, Key::Interact]);
        check(
            b"\x1b[A\x1bOD\x1b[C\x1b[B",
            &[Key::Ahead, Key::Left, Key::Right, Key::Back],
        );
        check(
            b"vRq\x03\x04",
            &[Key::View, Key::Restart, Key::Quit, Key::Quit, Key::Quit],
        );
        check(b"\x1b[Z\xff\x00x", &[]);
        check(b"\x1b", &[]);
        check(b"\x1b[", &[]);
    }

    #[test]
    fn keys_are_held_briefly_and_interaction_happens_once() {
        let mut held = Held::default();
        assert_eq!(held.take(0.0), None);
        held.press(Key::Ahead, 1.0);
        held.press(Key::Left, 1.0);
        held.press(Key::Interact, 1.0);
        assert_eq!(held.take(1.05), Some((1.0, -1.0, true)));
        assert_eq!(held.take(1.1), Some((1.0, -1.0, false)));
        assert_eq!(held.take(1.2), Some((1.0, 0.0, false)), "turning ends first");
        held.press(Key::Back, 1.25);
        assert_eq!(held.take(1.4), Some((-0.5, 0.0, false)));
        assert_eq!(held.take(1.6), None);
    }
}
