//! What is asked of `cargo xtask chaos`: how often, from which seed, which kinds of fault.

/// How many processes are killed if nobody says.
const KILLS: u64 = 1000;

/// What is asked for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Options {
    /// How many processes are killed.
    pub(super) kills: u64,
    /// Where chance begins; the clock says if nobody does.
    pub(super) seed: Option<u64>,
    /// The kinds of fault; all of them if none is named.
    pub(super) only: Vec<Kind>,
    /// A sample of each, in about a minute.
    pub(super) is_quick: bool,
}

/// A kind of fault.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Kills,
    Python,
    Syscalls,
    Disk,
    Clock,
    Folders,
    Signals,
}

impl Kind {
    pub(super) const ALL: [Self; 7] = [
        Self::Kills,
        Self::Python,
        Self::Syscalls,
        Self::Disk,
        Self::Clock,
        Self::Folders,
        Self::Signals,
    ];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Kills => "kills",
            Self::Python => "python",
            Self::Syscalls => "syscalls",
            Self::Disk => "disk",
            Self::Clock => "clock",
            Self::Folders => "folders",
            Self::Signals => "signals",
        }
    }

    pub(super) fn about(self) -> &'static str {
        match self {
            Self::Kills => "killed at random moments, 1, 2 and 4 jobs",
            Self::Python => "the same with agents in Python",
            Self::Syscalls => "each system call failing in turn",
            Self::Disk => "a disk with room for so many bytes",
            Self::Clock => "a clock that jumps by years",
            Self::Folders => "the log removed, cut or replaced meanwhile",
            Self::Signals => "told to stop, wherever it is",
        }
    }
}

impl Options {
    /// Reads the words after `chaos`.
    pub(crate) fn parse(words: &[&str]) -> Result<Self, String> {
        let mut options = Self {
            kills: KILLS,
            seed: None,
            only: Vec::new(),
            is_quick: false,
        };
        let mut words = words.iter();
        while let Some(word) = words.next() {
            let mut value = || words.next().ok_or_else(|| format!("found `{word}` without a value"));
            let number = |text: &str| {
                text.parse::<u64>()
                    .map_err(|_| format!("{word}: found `{text}`, expected a whole number"))
            };
            match *word {
                "--quick" => options.is_quick = true,
                "--kills" => options.kills = number(value()?)?,
                "--seed" => options.seed = Some(number(value()?)?),
                "--only" => options.only.push(kind(value()?)?),
                other => return Err(format!("found unknown argument `{other}` of chaos")),
            }
        }
        Ok(options)
    }

    /// How often something is tried: a tenth where it has to be quick.
    pub(super) fn scaled(&self, count: u64) -> u64 {
        if self.is_quick { count.div_ceil(10) } else { count }
    }
}

fn kind(name: &str) -> Result<Kind, String> {
    let known = || Kind::ALL.map(Kind::name).join(", ");
    let found = Kind::ALL.into_iter().find(|kind| kind.name() == name);
    found.ok_or_else(|| format!("--only: found unknown `{name}`, expected one of {}", known()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_are_read() {
        let parse = |words: &str| Options::parse(&words.split_whitespace().collect::<Vec<_>>());
        let none = Options {
            kills: KILLS,
            seed: None,
            only: Vec::new(),
            is_quick: false,
        };
        assert_eq!(parse("").as_ref(), Ok(&none));
        let all = Options {
            kills: 7,
            seed: Some(3),
            only: vec![Kind::Disk, Kind::Clock],
            is_quick: true,
        };
        assert_eq!(parse("--quick --kills 7 --seed 3 --only disk --only clock"), Ok(all));
        let check = |words: &str, part: &str| {
            let complaint = parse(words).unwrap_err();
            assert!(complaint.contains(part), "{words}: {complaint}");
        };
        check("--kills", "`--kills` without a value");
        check("--kills many", "found `many`, expected a whole number");
        check("--only fire", "expected one of kills, python");
        check("--fast", "unknown argument `--fast` of chaos");
    }
}
