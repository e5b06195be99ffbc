//! [`Remarks`]: what the user of the executable should know, each thing once. Where it is written is in `journal.rs`.

use std::collections::BTreeSet;

/// Remarks that were not taken yet, and which there have been.
#[derive(Clone, Debug)]
pub(crate) struct Remarks {
    most: usize,
    made: BTreeSet<String>,
    waiting: Vec<String>,
}

impl Remarks {
    /// No remarks yet, and never more than that many: who sends rubbish at each step does not fill a disk.
    pub(crate) fn at_most(most: usize) -> Self {
        Self {
            most,
            made: BTreeSet::new(),
            waiting: Vec::new(),
        }
    }

    /// Makes a remark, unless it was made before.
    pub(crate) fn make(&mut self, remark: String) {
        if self.made.len() > self.most || self.made.contains(&remark) {
            return;
        }
        self.made.insert(remark.clone());
        let is_last = self.made.len() > self.most;
        self.waiting.push(if is_last {
            "further remarks are left out".to_owned()
        } else {
            remark
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
    fn each_remark_is_made_once_and_there_is_an_end() {
        let mut remarks = Remarks::at_most(200);
        remarks.make("a".to_owned());
        remarks.make("a".to_owned());
        assert_eq!(remarks.take(), ["a"]);
        for number in 0..1000 {
            remarks.make(number.to_string());
        }
        let taken = remarks.take();
        assert_eq!(taken.len(), 200);
        assert_eq!(taken.last().map(String::as_str), Some("further remarks are left out"));
        assert!(remarks.take().is_empty());
    }
}
