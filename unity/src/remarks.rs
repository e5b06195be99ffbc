//! [`Remarks`]: what the user of the executable should know, each thing once. Where it is written is in `journal.rs`.

use std::collections::BTreeSet;

use driftworld_text::printable_lines;

/// What a remark is about. Each kind has room of its own, so that none crowds out another.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum About {
    /// Settings and messages that mean nothing here.
    Settings,
    /// What was made of worlds and objects.
    Worlds,
    /// Messages that were refused, or left out.
    Refusals,
}

/// The most remarks of a kind in a session: who sends rubbish at each step does not fill a disk.
const MOST: usize = 100;

/// Remarks that were not taken yet, and which there have been.
#[derive(Clone, Debug, Default)]
pub(crate) struct Remarks {
    made: BTreeSet<(About, String)>,
    waiting: Vec<String>,
}

impl Remarks {
    /// Makes a remark, unless the same was made before.
    pub(crate) fn make(&mut self, about: About, remark: &str) {
        self.make_once(about, remark, remark);
    }

    /// Makes a remark, unless one on the same thing was made before.
    pub(crate) fn make_once(&mut self, about: About, thing: &str, remark: &str) {
        let key = (about, thing.to_owned());
        let count = self.made.iter().filter(|(kind, _)| *kind == about).count();
        if count > MOST || self.made.contains(&key) {
            return;
        }
        self.made.insert(key);
        self.waiting.push(if count < MOST {
            // What a client sent may stand in it.
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

    /// What has been remarked since the last time.
    pub(crate) fn take(&mut self) -> Vec<String> {
        std::mem::take(&mut self.waiting)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_remark_is_made_once_and_each_kind_has_an_end() {
        let mut remarks = Remarks::default();
        remarks.make(About::Worlds, "a");
        remarks.make(About::Worlds, "a");
        remarks.make_once(About::Worlds, "a", "b");
        assert_eq!(remarks.take(), ["a"]);
        for number in 0..1000 {
            remarks.make(About::Worlds, &number.to_string());
        }
        let taken = remarks.take();
        assert_eq!(taken.len(), MOST);
        assert_eq!(
            taken.last().map(String::as_str),
            Some("further remarks on worlds are left out")
        );
        remarks.make(About::Worlds, "c");
        remarks.make(About::Refusals, "c");
        assert_eq!(remarks.take(), ["c"], "refusals have room of their own");
    }
}
