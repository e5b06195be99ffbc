//! The distances of Python's tools beside ours, in one run on one core, as a table of ratios. What is measured is said by the script
//! and by `driftworld bench similarity`; environments are compared in `peers.rs`.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::error::XtaskError;
use crate::process::{cargo, output};
use crate::workspace::Workspace;

/// For each of our figures: what the script calls the same job, and how many times as fast ours is meant to be.
const JOBS: [(&str, &str, f64); 5] = [
    ("ciede2000", "scikit-image CIEDE2000", 10.0),
    ("jaccard_50x50", "scipy Jaccard, 50x50 grids", 100.0),
    ("emd_20_points", "POT exact EMD, 20 x 20 points", 5.0),
    ("emd_25x25", "POT exact EMD, 25x25 grids", 3.0),
    ("wasserstein1_256", "scipy Wasserstein-1, 256 samples", 20.0),
];

/// Measures both and prints a table; says so where the script or the Python that it needs is not there.
pub(crate) fn measure(workspace: &Workspace) -> Result<(), XtaskError> {
    let bench = cargo(
        workspace,
        &["run", "--release", "--quiet", "--", "bench", "similarity", "--json"],
    );
    let ours = output(bench)?;
    let script = script(workspace);
    if !script.is_file() {
        println!(
            "\nno peers: {} is not there (DRIFTWORLD_BENCH names its folder)",
            script.display()
        );
        return Ok(());
    }
    let python = std::env::var("DRIFTWORLD_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let mut peer = Command::new("taskset");
    peer.args(["-c", "0", &python])
        .arg(&script)
        .env("OMP_NUM_THREADS", "1")
        .env("OPENBLAS_NUM_THREADS", "1");
    let theirs = match output(peer) {
        Ok(text) => text,
        Err(error) => {
            println!("\nno peers: {error}");
            println!("(DRIFTWORLD_PYTHON names a Python that has numpy, scipy, pot and scikit-image)");
            return Ok(());
        }
    };
    println!("\n| distance | ours, pairs/s | peer, pairs/s | ratio | aim |\n|---|---|---|---|---|");
    for (name, peer, aim) in JOBS {
        let Some((ours, theirs)) = our_figure(&ours, name).zip(their_figure(&theirs, peer)) else {
            println!("| {name} | not found | | | |");
            continue;
        };
        println!(
            "| {name} ({peer}) | {ours:.0} | {theirs:.0} | {:.1} | {aim} |",
            ours / theirs
        );
    }
    Ok(())
}

fn script(workspace: &Workspace) -> PathBuf {
    let folder = std::env::var_os("DRIFTWORLD_BENCH").map_or_else(
        || workspace.root.join("..").join("shared").join("bench"),
        |folder| Path::new(&folder).to_owned(),
    );
    folder.join("peer_similarity.py")
}

/// A number behind its key in a flat JSON object.
fn our_figure(json: &str, key: &str) -> Option<f64> {
    let (_, rest) = json.split_once(&format!("\"{key}\":"))?;
    let number: String = rest
        .trim_start()
        .chars()
        .take_while(|letter| letter.is_ascii_digit() || *letter == '.')
        .collect();
    number.parse().ok()
}

/// The number before `pairs/s` in the line that begins with a name.
fn their_figure(text: &str, name: &str) -> Option<f64> {
    let line = text.lines().find(|line| line.starts_with(name))?;
    let words: Vec<&str> = line.split_whitespace().collect();
    let [.., number, "pairs/s"] = words.as_slice() else {
        return None;
    };
    number.replace(',', "").parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_are_found_in_what_both_print() {
        let ours = "{\n  \"ciede2000\": 40000000.0,\n  \"emd_25x25\": 150.5\n}";
        assert_eq!(our_figure(ours, "ciede2000"), Some(40_000_000.0));
        assert_eq!(our_figure(ours, "emd_25x25"), Some(150.5));
        assert_eq!(our_figure(ours, "jaccard_50x50"), None);
        let theirs = "scipy Jaccard, 50x50 grids                            245,120 pairs/s\n";
        assert_eq!(their_figure(theirs, "scipy Jaccard, 50x50 grids"), Some(245_120.0));
        assert_eq!(their_figure(theirs, "scikit-image CIEDE2000"), None);
    }
}
