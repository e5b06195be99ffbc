//! `driftworld doctor`: reports which renderers work on this machine, with hints on what to install.

use std::path::Path;

use crate::env::{AdapterReport, RendererKind, RendererReport};
use clap::Args;
use serde_json::{Value, json};

use super::optional::FEATURES;
use super::output;
use crate::Failure;

/// Report which renderers and features work on this machine.
///
/// Also reports what the others need.
#[derive(Args)]
#[command(after_help = "Examples:
  driftworld doctor
  driftworld doctor --json")]
pub(crate) struct Doctor {
    /// Print the report as JSON.
    #[arg(long)]
    json: bool,
}

impl Doctor {
    pub(crate) fn run(self) -> Result<(), Failure> {
        output::run_to_end_for_exit_code();
        let report = RendererReport::make();
        let missing = missing(&report);
        if self.json {
            return output::json(&as_json(&report, &missing));
        }
        output::print(&as_text(&report, &missing))
    }
}

/// Why there is no graphics adapter, with hints; empty if there is one (a card or a software driver).
fn missing(report: &RendererReport) -> Vec<String> {
    let Some(reason) = &report.no_adapter else {
        return Vec::new();
    };
    let mut missing = vec![reason.clone()];
    if report.has_gpu_feature && cfg!(target_os = "linux") {
        for name in ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"] {
            if let Some(files) = std::env::var_os(name) {
                let files = files.display().to_string();
                missing.push(format!("{name} is set to {files:?}, so only those drivers are used"));
            }
        }
        missing.extend(vulkan_hints(
            &LOADER_FOLDERS.map(Path::new),
            &DRIVER_FOLDERS.map(Path::new),
        ));
    }
    missing
}

/// Folders where Linux keeps the Vulkan loader.
const LOADER_FOLDERS: [&str; 6] = [
    "/usr/lib/x86_64-linux-gnu",
    "/usr/lib/aarch64-linux-gnu",
    "/usr/lib64",
    "/usr/lib",
    "/lib64",
    "/usr/local/lib",
];

/// Folders where Vulkan drivers register with the loader.
const DRIVER_FOLDERS: [&str; 3] = [
    "/usr/share/vulkan/icd.d",
    "/etc/vulkan/icd.d",
    "/usr/local/share/vulkan/icd.d",
];

/// Hints from the folders' contents about why Vulkan has no adapter.
fn vulkan_hints(loaders: &[&Path], drivers: &[&Path]) -> Vec<String> {
    let mut hints = Vec::new();
    if !loaders.iter().any(|folder| folder.join("libvulkan.so.1").exists()) {
        hints.push(
            "found no Vulkan loader (libvulkan.so.1) in the usual folders; on Debian and Ubuntu: apt-get install \
             libvulkan1"
                .to_owned(),
        );
    }
    let holds_driver = |folder: &&Path| {
        let mut files = std::fs::read_dir(folder).into_iter().flatten().flatten();
        files.any(|file| file.path().extension().is_some_and(|end| end == "json"))
    };
    if !drivers.iter().any(holds_driver) {
        hints.push(
            "found no Vulkan driver (a .json file in /usr/share/vulkan/icd.d or /etc/vulkan/icd.d); install your \
             card's driver, or a software one with apt-get install mesa-vulkan-drivers"
                .to_owned(),
        );
    }
    hints
}

fn as_text(report: &RendererReport, missing: &[String]) -> String {
    let mut lines = vec![format!("cpu   works: processor ({})", report.instruction_set)];
    for adapter in &report.adapters {
        lines.push(format!("gpu   {}", adapter_line(adapter)));
    }
    for text in missing {
        lines.push(format!("gpu   missing: {text}"));
    }
    let why = match (report.auto, report.adapters.is_empty()) {
        (RendererKind::Gpu, _) => "a graphics card that works",
        _ if !report.has_gpu_feature => "this build has no GPU renderer",
        (_, true) => "there is no graphics adapter",
        (_, false) => "no GPU works; a software driver is slower than Driftworld's CPU renderer",
    };
    lines.push(format!("auto  uses {}: {why}", report.auto));
    for (title, has) in [("has", true), ("lacks", false)] {
        let names: Vec<&str> = FEATURES.iter().filter(|of| of.1 == has).map(|of| of.0).collect();
        if !names.is_empty() {
            let advice = if has { "" } else { " (build with --features full)" };
            lines.push(format!("build {title} {}{advice}", names.join(", ")));
        }
    }
    lines.join("\n") + "\n"
}

fn adapter_line(adapter: &AdapterReport) -> String {
    let outcome = match &adapter.problem {
        None => "works".to_owned(),
        Some(problem) => format!("does not work: {problem}"),
    };
    let AdapterReport {
        name,
        backend,
        kind,
        driver,
        ..
    } = adapter;
    format!("{outcome}: {name} ({backend}; {kind}; driver {driver})")
}

fn as_json(report: &RendererReport, missing: &[String]) -> Value {
    let adapter = |adapter: &AdapterReport| {
        json!({
            "name": adapter.name,
            "backend": adapter.backend,
            "kind": adapter.kind,
            "driver": adapter.driver,
            "is_software": adapter.is_software,
            "works": adapter.problem.is_none(),
            "problem": adapter.problem,
        })
    };
    json!({
        "features": FEATURES.map(|(name, has)| (name.to_owned(), Value::Bool(has))).into_iter().collect::<serde_json::Map<_, _>>(),
        "cpu": { "works": true, "instruction_set": report.instruction_set },
        "gpu": {
            "in_this_build": report.has_gpu_feature,
            "adapters": report.adapters.iter().map(adapter).collect::<Vec<_>>(),
            "missing": missing,
        },
        "auto": <&str>::from(report.auto),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn report(is_software: bool, problem: Option<&str>) -> RendererReport {
        RendererReport {
            instruction_set: "avx2",
            has_gpu_feature: true,
            adapters: vec![AdapterReport {
                name: "Card 1".to_owned(),
                backend: "vulkan".to_owned(),
                kind: "discrete graphics card".to_owned(),
                driver: "Driver 2".to_owned(),
                is_software,
                problem: problem.map(str::to_owned),
            }],
            no_adapter: None,
            auto: if is_software || problem.is_some() {
                RendererKind::Cpu
            } else {
                RendererKind::Gpu
            },
        }
    }

    #[track_caller]
    fn check(report: &RendererReport, expected: &[&str]) {
        let text = as_text(report, &missing(report));
        for part in expected {
            assert!(text.contains(part), "{part:?} in:\n{text}");
        }
    }

    #[test]
    fn report_names_each_adapter_and_the_choice_of_auto() {
        check(
            &report(false, None),
            &[
                "cpu   works: processor (avx2)",
                "gpu   works: Card 1 (vulkan; discrete graphics card; driver Driver 2)",
                "auto  uses gpu",
            ],
        );
        check(&report(true, None), &["auto  uses cpu: no GPU works"]);
        check(
            &report(false, Some("is lost")),
            &["gpu   does not work: is lost: Card 1", "auto  uses cpu"],
        );
    }

    #[test]
    fn machine_without_vulkan_gets_hints_on_what_to_install() {
        let empty = tempfile::tempdir().expect("a temporary folder can be created");
        let hints = vulkan_hints(&[empty.path()], &[empty.path()]);
        assert!(
            hints[0].contains("libvulkan1") && hints[1].contains("mesa-vulkan-drivers"),
            "{hints:?}"
        );
        for file in ["libvulkan.so.1", "card.json"] {
            std::fs::write(empty.path().join(file), "").expect("the folder is writable");
        }
        assert!(vulkan_hints(&[empty.path()], &[empty.path()]).is_empty());
    }
}
