//! [`Remarks`]: collects remarks for the user of the executable, each only once.

use std::collections::BTreeSet;

use driftworld_text::printable_lines;

/// The subject of a remark. Each kind has its own limit, so that none crowds out another.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum About {
    /// Settings and messages without effect.
    Settings,
    /// Changes to worlds and objects while reading them.
    Worlds,
    /// Refused or dropped messages.
    Refusals,
}

/// Maximum number of remarks of a kind per session: a client that sends garbage in every step must not fill the disk.
const MAX_REMARKS: usize = 100;

/// Remarks not yet taken, and the set of all remarks made so far.
#[derive(Clone, Debug, Default)]
pub(crate) struct Remarks {
    made: BTreeSet<(About, String)>,
    waiting: Vec<String>,
}

impl Remarks {
    /// Makes a remark, unless the same one was made before.
    pub(crate) fn make(&mut self, about: About, remark: &str) {
        self.make_once(about, remark, remark);
    }

    /// Makes a remark, unless one about the same subject was made before.
    pub(crate) fn make_once(&mut self, about: About, thing: &str, remark: &str) {
        let key = (about, thing.to_owned());
        let count = self.made.iter().filter(|(kind, _)| *kind == about).count();
        if count > MAX_REMARKS || self.made.contains(&key) {
            return;
        }
        self.made.insert(key);
        self.waiting.push(if count < MAX_REMARKS {
            // It may contain text from a client.
            printable_lines(remark).into_owned()
        } else {
            match about {
                About::Settings => "further remarks on settings are left out",
                About::Worlds => "further remarks on worlds are left out",
                About::Refusals => "further remarks on refused messages are left out",
            }
            .to_owned()
        });
    }

    /// The remarks since the last call.
    pub(crate) fn take(&mut self) -> Vec<String> {
        std::mem::take(&mut self.waiting)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn remarks_are_unique_and_limited_per_kind() {
        let mut remarks = Remarks::default();
        remarks.make(About::Worlds, "a");
        remarks.make(About::Worlds, "a");
        remarks.make_once(About::Worlds, "a", "b");
        assert_eq!(remarks.take(), ["a"]);
        for number in 0..1000 {
            remarks.make(About::Worlds, &number.to_string());
        }
        let taken = remarks.take();
        assert_eq!(taken.len(), MAX_REMARKS);
        assert_eq!(
            taken.last().map(String::as_str),
            Some("further remarks on worlds are left out")
        );
        remarks.make(About::Worlds, "c");
        remarks.make(About::Refusals, "c");
        assert_eq!(remarks.take(), ["c"], "refusals have their own limit");
    }
}
