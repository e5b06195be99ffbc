//! Parses the arguments: our own options, and Unity's, which clients pass to any executable and which are ignored here.

use std::path::PathBuf;
use std::time::Duration;

use driftworld_spec::nearest;

use crate::error::UnityError;
use crate::observation::PictureForm;

/// The string with which the executable identifies itself.
pub const MARK: &str = "driftworld-unity: a stand-in for the L2Explorer executable";

/// The output of `--help`.
pub const HELP: &str = "\
Runs Driftworld's worlds in place of L2Explorer's Unity executable, for clients that speak the ML-Agents protocol.

Usage: driftworld-unity [OPTIONS] [UNITY'S OPTIONS]

A client that was given this file as its executable starts it by itself:
  cp driftworld-unity ~/l2explorer/l2explorer.x86_64
  export L2EXPLORER_APP=~/l2explorer/l2explorer.x86_64 L2EXPLORER_WORKER_ID=0
For a client that waits for a connection (`file_name=None`, the \"editor mode\"), start it by hand, without options.

Options:
  --mlagents-port PORT    where the client listens [default: 5004, the port of the editor mode]
  --host NAME             the client's machine [default: 127.0.0.1]; the connection is not encrypted
  --wait SECONDS          how long to look for a client [default: 60]
  --world FILE            the world until the client resets to one of its own: ours, or a reset file of L2Explorer
  --maps FILE             layouts of predefined maps in place of the built-in ones
  --assets LIB            a library of models, made by `driftworld assets pack`, that worlds may use besides the built-in ones;
                          may be repeated: if two libraries have the same model, the later one is used
  --screenshots DIR       the only folder into which screenshots are written [default: screenshots]
  --record FILE           keep the world and the actions of every episode, for `driftworld replay`; appends to an existing file
  --raw-observations      pictures as floats instead of PNG: depth keeps its fractions, messages are twenty times as long
  -logFile [FILE]         a file for the messages that otherwise go to the terminal; without FILE, or with -, the terminal
  --help, --version

-nographics, -batchmode and Unity's other options are accepted and ignored: no display or graphics card is needed.
Exit codes: 0 the client is done, 1 an error, 2 invalid arguments, 3 no client found.";

/// The request in the arguments.
#[derive(Clone, Debug, PartialEq)]
pub enum Request {
    /// A session with a client.
    Run(Options),
    /// [`HELP`].
    Help,
    /// The version.
    Version,
}

/// Options of a session.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// The client's machine.
    pub host: String,
    /// The client's port.
    pub port: u16,
    /// How long to wait for a client.
    pub wait: Duration,
    /// The initial world; the default world if absent.
    pub world: Option<PathBuf>,
    /// Layouts of predefined maps; the built-in ones if absent.
    pub maps: Option<PathBuf>,
    /// Libraries of models; later ones take precedence.
    pub assets: Vec<PathBuf>,
    /// The folder for screenshots.
    pub screenshots: PathBuf,
    /// The form of images.
    pub pictures: PictureForm,
    /// The file for recorded episodes, if they are recorded.
    pub record: Option<PathBuf>,
    /// The log file; the terminal if absent.
    pub log: Option<PathBuf>,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            host: "127.0.0.1".to_owned(),
            port: 5004,
            wait: Duration::from_mins(1),
            world: None,
            maps: None,
            assets: Vec::new(),
            screenshots: PathBuf::from("screenshots"),
            pictures: PictureForm::Png,
            record: None,
            log: None,
        }
    }
}

/// Our own options.
const OUR_OPTIONS: [&str; 11] = [
    "--assets",
    "--mlagents-port",
    "--host",
    "--wait",
    "--world",
    "--maps",
    "--screenshots",
    "--record",
    "--raw-observations",
    "--help",
    "--version",
];

/// Unity options that clients are known to use, in lower case. They have no effect here.
const UNITY_OPTIONS: [&str; 9] = [
    "-nographics",
    "-batchmode",
    "-quit",
    "-screen-width",
    "-screen-height",
    "-screen-fullscreen",
    "-screen-quality",
    "-force-opengl",
    "-force-vulkan",
];

/// Minimum wait, long enough to reach a running client.
const MIN_WAIT_SECS: f64 = 0.1;
/// Maximum wait: a day.
const MAX_WAIT_SECS: f64 = 86_400.0;

impl Request {
    /// Parses the arguments, without the program's name. Also returns remarks on arguments that have no effect.
    ///
    /// # Errors
    /// [`UnityError::Arguments`] if one of our options has no value, or an invalid one.
    pub fn parse(arguments: &[String]) -> Result<(Self, Vec<String>), UnityError> {
        let mut options = Options::default();
        let mut remarks = Vec::new();
        // A word after one of Unity's options or an unknown option may be its value.
        let mut after_foreign = false;
        let mut rest = arguments.iter().peekable();
        while let Some(argument) = rest.next() {
            let (name, inline) = match argument.split_once('=') {
                Some((name, value)) if name.starts_with("--") => (name, Some(value.to_owned())),
                _ => (argument.as_str(), None),
            };
            let mut value = |expected: &str| {
                let refused =
                    |found: &str| UnityError::Arguments(format!("{name}: found {found}, expected {expected}"));
                let found = match &inline {
                    Some(value) => Some(value),
                    None => match rest.peek() {
                        Some(next) if is_option(next) => return Err(refused(&format!("the option {next}"))),
                        _ => rest.next(),
                    },
                };
                let found = found.filter(|value| !value.is_empty());
                found.cloned().ok_or_else(|| refused("no value"))
            };
            let mut is_foreign = false;
            match name {
                "--help" | "-h" => return Ok((Self::Help, remarks)),
                "--version" | "-V" => return Ok((Self::Version, remarks)),
                "--mlagents-port" => options.port = port(&value("a port")?)?,
                "--host" => options.host = value("the name or address of a machine")?,
                "--wait" => options.wait = wait(&value("a number of seconds")?)?,
                "--world" => options.world = Some(value("a file")?.into()),
                "--assets" => options.assets.push(value("a file")?.into()),
                "--maps" => options.maps = Some(value("a file")?.into()),
                "--screenshots" => options.screenshots = value("a folder")?.into(),
                "--record" => options.record = Some(value("a file")?.into()),
                "--raw-observations" => match &inline {
                    None => options.pictures = PictureForm::Floats,
                    Some(found) => {
                        return Err(UnityError::Arguments(format!(
                            "{name}: found the value {found:?}, expected none"
                        )));
                    }
                },
                other if other.eq_ignore_ascii_case("-logfile") => {
                    // As in Unity: without a file, the log goes to the terminal.
                    let file = rest.next_if(|next| !is_option(next));
                    let file = file.filter(|file| !file.is_empty() && *file != "-");
                    options.log = file.map(PathBuf::from);
                }
                other if other.starts_with('-') => {
                    is_foreign = true;
                    if !UNITY_OPTIONS.contains(&other.to_lowercase().as_str()) {
                        let advice =
                            suggestion(other).map_or_else(String::new, |near| format!("; did you mean {near}?"));
                        remarks.push(format!("{other:?} is not known here and is ignored{advice}"));
                    }
                }
                other if !after_foreign => remarks.push(format!("{other:?} belongs to no option and is ignored")),
                _ => {}
            }
            after_foreign = is_foreign;
        }
        Ok((Self::Run(options), remarks))
    }
}

/// Whether a word is an option rather than the value of the previous one.
fn is_option(word: &str) -> bool {
    word.len() > 1 && word.starts_with('-') && word.parse::<f64>().is_err()
}

/// The option of ours that an unknown word probably means.
fn suggestion(word: &str) -> Option<String> {
    // Most programs call it --port.
    if word.trim_start_matches('-').eq_ignore_ascii_case("port") {
        return Some("--mlagents-port".to_owned());
    }
    nearest(word, OUR_OPTIONS)
}

fn port(text: &str) -> Result<u16, UnityError> {
    let number = text.parse().ok().filter(|port| *port > 0);
    number.ok_or_else(|| {
        UnityError::Arguments(format!(
            "--mlagents-port: found {text:?}, expected a port from 1 to 65535"
        ))
    })
}

fn wait(text: &str) -> Result<Duration, UnityError> {
    let seconds: Option<f64> = text.parse().ok();
    let seconds = seconds.filter(|seconds| (MIN_WAIT_SECS..=MAX_WAIT_SECS).contains(seconds));
    seconds.map(Duration::from_secs_f64).ok_or_else(|| {
        UnityError::Arguments(format!(
            "--wait: found {text:?}, expected seconds from {MIN_WAIT_SECS} to {MAX_WAIT_SECS}"
        ))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<(Request, Vec<String>), UnityError> {
        let words: Vec<String> = text.split_whitespace().map(str::to_owned).collect();
        Request::parse(&words)
    }

    fn options(text: &str) -> (Options, Vec<String>) {
        match parse(text).expect("the arguments are valid") {
            (Request::Run(options), remarks) => (options, remarks),
            (other, _) => panic!("{other:?}"),
        }
    }

    #[test]
    fn port_is_read_among_unity_options() {
        let (found, remarks) = options("-nographics -batchmode --mlagents-port 5007 -logFile a.log");
        assert_eq!(found.port, 5007);
        assert_eq!(found.log, Some(PathBuf::from("a.log")));
        assert!(remarks.is_empty(), "{remarks:?}");
        assert_eq!(options("").0.port, 5004);
    }

    #[test]
    fn log_file_without_a_name_is_the_terminal() {
        for text in [
            "-logfile -",
            "-logFile",
            "-logFile -nographics",
            "-logFile a.log -logFile -batchmode",
        ] {
            let (found, remarks) = options(text);
            assert_eq!(found, Options::default(), "{text}");
            assert!(remarks.is_empty(), "{remarks:?}");
        }
        let (found, _) = options("-logFile --mlagents-port 5007");
        assert_eq!((found.log, found.port), (None, 5007), "the next option is not a file");
        let (empty, _) = Request::parse(&["-logFile".to_owned(), String::new()]).expect("an empty name is accepted");
        assert_eq!(empty, Request::Run(Options::default()));
    }

    #[test]
    fn unknown_options_are_ignored_with_a_remark() {
        let (found, remarks) =
            options("-screen-width 640 -popupwindow --mlagents-scene-name A --screenshot b c d --port 5007");
        assert_eq!(found, Options::default());
        assert_eq!(
            remarks,
            [
                "\"-popupwindow\" is not known here and is ignored",
                "\"--mlagents-scene-name\" is not known here and is ignored",
                "\"--screenshot\" is not known here and is ignored; did you mean --screenshots?",
                "\"c\" belongs to no option and is ignored",
                "\"d\" belongs to no option and is ignored",
                "\"--port\" is not known here and is ignored; did you mean --mlagents-port?",
            ]
        );
    }

    #[test]
    fn own_options_accept_both_value_forms() {
        let (found, _) = options(
            "--screenshots=out --world w.json --wait 2.5 --assets a --raw-observations --maps=m --host ::1 --assets=b",
        );
        let expected = Options {
            host: "::1".to_owned(),
            wait: Duration::from_millis(2500),
            world: Some("w.json".into()),
            maps: Some("m".into()),
            assets: vec!["a".into(), "b".into()],
            screenshots: "out".into(),
            pictures: PictureForm::Floats,
            ..Options::default()
        };
        assert_eq!(found, expected);
    }

    #[test]
    fn invalid_values_are_refused() {
        for row in r#"
--mlagents-port => --mlagents-port: found no value, expected a port
--mlagents-port 65536 => --mlagents-port: found "65536", expected a port from 1 to 65535
--mlagents-port 0 => --mlagents-port: found "0", expected a port from 1 to 65535
--wait NaN => --wait: found "NaN", expected seconds from 0.1 to 86400
--world= => --world: found no value, expected a file
--world --wait 5 => --world: found the option --wait, expected a file
--maps -nographics => --maps: found the option -nographics, expected a file
--wait -1 => --wait: found "-1", expected seconds from 0.1 to 86400
--raw-observations=no => --raw-observations: found the value "no", expected none
--raw-observations= => --raw-observations: found the value "", expected none"#
            .trim()
            .lines()
        {
            let (text, expected) = row.split_once(" => ").expect("a row has two parts");
            let error = parse(text).expect_err("the value is invalid");
            assert_eq!(error.to_string(), expected);
            assert_eq!(error.exit_code(), 2);
        }
    }

    #[test]
    fn value_after_an_equals_sign_may_look_like_an_option() {
        assert_eq!(options("--world=-odd.json").0.world, Some("-odd.json".into()));
        assert_eq!(options("--screenshots -").0.screenshots, PathBuf::from("-"));
    }

    #[test]
    fn help_names_every_option() {
        for option in OUR_OPTIONS {
            assert!(HELP.contains(option), "{option}");
        }
        assert_eq!(parse("--wait 1 -h").expect("help is always available").0, Request::Help);
    }
}
