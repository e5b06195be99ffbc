//! `cargo xtask bench peers`: the peers' scripts and our own bench in one run on one machine, as a table and as a plot.
//! What the scripts measure is their own; each prints lines of a name, `SPS [a, b, c]` and `resets/s [a, b, c]`.

use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;

use crate::error::XtaskError;
use crate::process::{cargo, output};
use crate::workspace::Workspace;

/// Where the plot goes, from the workspace's root.
const PLOT: &str = "docs/images/speed.svg";

/// One bar: who, doing what, how often a second.
#[derive(Debug, Clone, PartialEq)]
struct Bar {
    who: &'static str,
    what: String,
    per_second: f64,
}

/// Measures ViZDoom, MiniWorld, `JAXenstein` where there is a checkout of it, and ourselves, each on one core, prints a table and
/// draws the plot.
pub(crate) fn measure(
    workspace: &Workspace,
    python: &str,
    scripts: &Path,
    jaxenstein: Option<&Path>,
) -> Result<(), XtaskError> {
    let absolute = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let scripts = absolute(scripts);
    let mut vizdoom = Command::new("taskset");
    vizdoom
        .args(["-c", "0", python])
        .arg(scripts.join("peer_vizdoom.py"))
        // It leaves a file where it runs.
        .current_dir(std::env::temp_dir());
    let mut miniworld = Command::new("xvfb-run");
    miniworld
        .args(["-a", "taskset", "-c", "0", python])
        .arg(scripts.join("peer_miniworld.py"));
    let mut bars: Vec<Bar> = bars_of("MiniWorld", "84 × 84, colour", &[], &output(miniworld)?)
        .into_iter()
        .collect();
    let doom = output(vizdoom)?;
    bars.extend(bars_of("ViZDoom", "160 × 120, colour", &["rgb"], &doom));
    bars.extend(bars_of(
        "ViZDoom",
        "160 × 120, colour, depth, labels",
        &["depth+labels"],
        &doom,
    ));
    if let Some(checkout) = jaxenstein {
        let mut mazes = Command::new("taskset");
        mazes
            .args(["-c", "0", python])
            .arg(scripts.join("peer_jaxenstein.py"))
            .arg(checkout);
        bars.extend(bars_of("JAXenstein", "64 × 64, colour, maze", &[], &output(mazes)?));
    }
    bars.extend(our_bars(workspace)?);
    println!("\n| environment | observation | steps a second on one core |\n|---|---|---|");
    for bar in &bars {
        println!("| {} | {} | {} |", bar.who, bar.what, grouped(bar.per_second));
    }
    let path = workspace.root.join(PLOT);
    std::fs::write(&path, plot(&bars)).map_err(|source| XtaskError::File { path, source })
}

fn our_bars(workspace: &Workspace) -> Result<Vec<Bar>, XtaskError> {
    output(cargo(workspace, &["build", "--release", "--quiet"]))?;
    let mut bench = Command::new("taskset");
    bench
        .args(["-c", "0"])
        .arg(workspace.root.join("target/release/driftworld"))
        .args(["bench", "env", "--json"]);
    let text = output(bench)?;
    let figure = |key: &str| {
        let (_, rest) = text.split_once(&format!("\"{key}\":"))?;
        let number: String = rest
            .trim_start()
            .chars()
            .take_while(|letter| letter.is_ascii_digit() || *letter == '.')
            .collect();
        number.parse().ok()
    };
    let bars = [
        (
            "steps_per_second_per_core_160x120_natural",
            "160 × 120, colour, depth, classes",
        ),
        ("steps_per_second_per_core_160x120", "the same, plain"),
        (
            "steps_per_second_per_core_84_natural",
            "84 × 84, colour, depth, classes",
        ),
        ("steps_per_second_per_core_84", "the same, plain"),
        ("steps_per_second_per_core_maze_64_rgb_natural", "64 × 64, colour, maze"),
        ("steps_per_second_per_core_maze_64_rgb", "the same, plain"),
    ];
    let bar = |(key, what): (&str, &str)| {
        figure(key).map(|per_second| Bar {
            who: "Driftworld",
            what: what.to_owned(),
            per_second,
        })
    };
    Ok(bars.into_iter().filter_map(bar).collect())
}

/// The best scenario of a peer: of each the middle of its runs.
fn bars_of(who: &'static str, what: &str, words: &[&str], text: &str) -> Option<Bar> {
    let lines = text
        .lines()
        .filter(|line| words.iter().all(|word| line.split(' ').any(|part| part == *word)));
    let best = lines.filter_map(steps).max_by(f64::total_cmp)?;
    Some(Bar {
        who,
        what: what.to_owned(),
        per_second: best,
    })
}

/// The middle of the numbers behind `SPS`.
fn steps(line: &str) -> Option<f64> {
    let (_, rest) = line.split_once("SPS [")?;
    let (list, _) = rest.split_once(']')?;
    let mut numbers: Vec<f64> = list
        .split(',')
        .filter_map(|number| number.trim().parse().ok())
        .collect();
    numbers.sort_by(f64::total_cmp);
    numbers.get(numbers.len() / 2).copied()
}

/// Horizontal bars on one scale, as SVG.
fn plot(bars: &[Bar]) -> String {
    const LEFT: f64 = 330.0;
    const WIDTH: f64 = 860.0;
    const ROW: f64 = 30.0;
    let most = bars.iter().map(|bar| bar.per_second).fold(1.0, f64::max);
    let height = ROW * bars.len() as f64 + 46.0;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH}\" height=\"{height}\" font-family=\"sans-serif\" font-size=\"13\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n\
         <text x=\"14\" y=\"24\" font-size=\"15\" font-weight=\"bold\" fill=\"#222222\">Steps a second on one core, measured in one run</text>\n"
    );
    for (row, bar) in bars.iter().enumerate() {
        let top = 38.0 + ROW * row as f64;
        let length = (bar.per_second / most * (WIDTH - LEFT - 90.0)).max(1.0);
        let color = if bar.who == "Driftworld" { "#2a6f97" } else { "#a5a58d" };
        let middle = top + 17.0;
        // Writing into a String does not fail.
        let _ = write!(
            svg,
            "<text x=\"{}\" y=\"{middle}\" text-anchor=\"end\" fill=\"#222222\">{}: {}</text>\n\
             <rect x=\"{LEFT}\" y=\"{}\" width=\"{length:.1}\" height=\"20\" fill=\"{color}\"/>\n\
             <text x=\"{:.1}\" y=\"{middle}\" fill=\"#222222\">{}</text>\n",
            LEFT - 8.0,
            bar.who,
            bar.what,
            top + 3.0,
            LEFT + length + 6.0,
            grouped(bar.per_second),
        );
    }
    svg.push_str("</svg>\n");
    svg
}

/// A whole number with commas between its thousands.
fn grouped(number: f64) -> String {
    let digits = format!("{number:.0}");
    let mut text = String::new();
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_peer_is_shown_by_the_best_of_its_scenarios() {
        let text = "vizdoom160x120 basic.cfg rgb SPS [3, 9, 5] resets/s [1]\nvizdoom160x120 maze.cfg rgb SPS [4, 8, 7] resets/s [1]\n\
                    vizdoom160x120 maze.cfg depth+labels SPS [100, 8, 7] resets/s [1]";
        let bar = bars_of("ViZDoom", "colour", &["rgb"], text);
        assert_eq!(bar.map(|bar| bar.per_second), Some(7.0));
        assert_eq!(bars_of("ViZDoom", "colour", &["sound"], text), None);
    }

    #[test]
    fn bars_are_as_long_as_their_numbers() {
        let bar = |who, per_second| Bar {
            who,
            what: "colour".to_owned(),
            per_second,
        };
        let svg = plot(&[bar("ViZDoom", 1_250.0), bar("Driftworld", 2_500.0)]);
        assert!(
            svg.contains("width=\"440.0\"") && svg.contains("width=\"220.0\""),
            "{svg}"
        );
        assert!(svg.contains(">1,250<"), "{svg}");
    }
}
