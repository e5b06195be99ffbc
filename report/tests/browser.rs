//! Opens the page in a real browser. It must log no console messages, fit the screen, even on a phone, and draw its figures in the
//! light and in the dark colour scheme. `page.rs` tests the page's text.
//!
//! The browser is Chromium under one of its usual names, or the one that `DRIFTWORLD_BROWSER` names. Without a browser
//! the tests print that they are skipped; with `DRIFTWORLD_REQUIRE_BROWSER=1` they fail.

#![expect(clippy::unwrap_used, reason = "a test stops at its first surprise")]

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use crate::lifetimes::{self, Life};

const NAMES: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];

fn browser() -> Option<PathBuf> {
    if let Some(named) = std::env::var_os("DRIFTWORLD_BROWSER") {
        return Some(PathBuf::from(named));
    }
    let path = std::env::var_os("PATH").unwrap_or_default();
    let found = std::env::split_paths(&path)
        .flat_map(|folder| NAMES.map(|name| folder.join(name)))
        .find(|file| file.is_file());
    let required =
        std::env::var_os("DRIFTWORLD_REQUIRE_BROWSER").is_some_and(|value| value != "0" && !value.is_empty());
    assert!(
        found.is_some() || !required,
        "DRIFTWORLD_REQUIRE_BROWSER=1: found none of {NAMES:?} in PATH; install one, or name one in DRIFTWORLD_BROWSER"
    );
    if found.is_none() {
        // Does not use println!, whose output the test harness hides when a test passes.
        let _ = writeln!(std::io::stderr(), "SKIPPED: no browser in PATH; set DRIFTWORLD_BROWSER");
    }
    found
}

#[derive(Clone, Copy, PartialEq)]
enum Scheme {
    Dark,
    Light,
}

/// A page in a folder of its own, and the browser that opens it.
struct Desk {
    browser: PathBuf,
    folder: tempfile::TempDir,
}

impl Desk {
    fn with(page: &str) -> Option<Self> {
        let desk = Self {
            browser: browser()?,
            folder: tempfile::tempdir().unwrap(),
        };
        desk.put("page.html", page);
        Some(desk)
    }

    fn put(&self, name: &str, text: &str) {
        std::fs::write(self.folder.path().join(name), text).unwrap();
    }

    fn open(&self, name: &str, size: [u32; 2], scheme: Scheme, more: &[&str]) -> Output {
        let output = Command::new(&self.browser)
            .args([
                "--headless=new",
                "--no-sandbox",
                "--disable-dev-shm-usage",
                "--disable-gpu",
                "--hide-scrollbars",
                "--enable-logging=stderr",
            ])
            .args([
                "--allow-file-access-from-files",
                "--virtual-time-budget=3000",
                "--timeout=40000",
            ])
            .arg(format!(
                "--user-data-dir={}",
                self.folder.path().join("profile").display()
            ))
            .arg(format!("--window-size={},{}", size[0], size[1]))
            .arg(format!("--blink-settings=preferredColorScheme={}", scheme as u8))
            .args(more)
            .arg(format!("file://{}", self.folder.path().join(name).display()))
            .output()
            .unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        output
    }

    /// The document after all its scripts have run, and the console messages that the browser logged.
    fn dom(&self, name: &str) -> (String, Vec<String>) {
        let output = self.open(name, [1200, 900], Scheme::Light, &["--dump-dom"]);
        let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
        let console = stderr
            .lines()
            .filter(|line| line.contains(":CONSOLE"))
            .map(str::to_owned);
        (String::from_utf8(output.stdout).unwrap(), console.collect())
    }

    /// A picture of the page: width, and its pixels.
    fn screenshot(&self, name: &str, size: [u32; 2], scheme: Scheme) -> (usize, Vec<[u8; 3]>) {
        let file = self.folder.path().join("shot.png");
        self.open(name, size, scheme, &[&format!("--screenshot={}", file.display())]);
        decode(&file)
    }
}

fn decode(file: &Path) -> (usize, Vec<[u8; 3]>) {
    let bytes = std::fs::read(file).unwrap();
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
    let mut buffer = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut buffer).unwrap();
    let channels = info.color_type.samples();
    let pixels = buffer[..info.buffer_size()]
        .chunks(channels)
        .map(|pixel| [pixel[0], pixel[1], pixel[2]]);
    (info.width as usize, pixels.collect())
}

#[test]
fn page_logs_no_console_messages() {
    let Some(desk) = Desk::with(&Life::default().run().page()) else {
        return;
    };
    let (dom, console) = desk.dom("page.html");
    assert_eq!(console, Vec::<String>::new());
    assert_eq!(dom.matches("<figure>").count(), 5, "all plots are on the page");
    assert!(dom.contains("<h1>first</h1>"));
    // Checks that a script error would be noticed at all.
    desk.put("bad.html", "<!DOCTYPE html><script>missing()</script>");
    assert_eq!(desk.dom("bad.html").1.len(), 1, "a script error is logged");
}

/// Opens the page in frames of several widths, from a phone's to a wide screen's, and records measurements of each.
const MEASURE: &str = r#"<!DOCTYPE html><body><script>
function measure(frame) {
  const page = frame.contentDocument, out = [];
  out.push("wide=" + page.documentElement.scrollWidth);
  const drawings = [...page.querySelectorAll("figure svg")].filter(svg => svg.getBoundingClientRect().width > 0);
  out.push("drawings=" + drawings.length);
  let smallest = 1000;
  for (const svg of drawings) {
    const scale = svg.getBoundingClientRect().width / svg.viewBox.baseVal.width;
    for (const text of svg.querySelectorAll("text")) smallest = Math.min(smallest, parseFloat(text.getAttribute("font-size")) * scale);
  }
  out.push("smallest=" + smallest.toFixed(1));
  const beyond = [...page.querySelectorAll("body *")].filter(part => !part.closest(".scroll, svg, .hidden, thead")
    && part.getBoundingClientRect().right > frame.clientWidth + 0.5);
  // Stacked tables must not need sideways scrolling on a phone, and no verdict may wrap onto a second line.
  const tables = [...page.querySelectorAll(".scroll")].filter(box => box.querySelector(".stacked"));
  const phone = frame.clientWidth < 800;
  out.push("tables=" + tables.length);
  out.push("scrolled=" + tables.filter(box => phone && box.scrollWidth > box.clientWidth).length);
  out.push("broken=" + [...page.querySelectorAll(".verdict")].filter(word => word.getBoundingClientRect().height > 32).length);
  out.push("beyond=" + beyond.map(part => part.tagName).join(","));
  const result = document.createElement("p");
  result.textContent = "MEASURED " + frame.clientWidth + " " + out.join(" ") + " END";
  document.body.append(result);
}
for (const width of [320, 360, 414, 799, 800, 1000, 1400]) {
  const frame = document.createElement("iframe");
  frame.style = "border:0;height:800px;width:" + width + "px";
  frame.onload = () => measure(frame);
  frame.src = "page.html";
  document.body.append(frame);
}
</script></body>"#;

#[test]
fn page_fits_every_screen_width_and_its_text_is_legible() {
    let check = |page: &str, drawings: &str, tables: &str| {
        let Some(desk) = Desk::with(page) else {
            return;
        };
        desk.put("measure.html", MEASURE);
        let (dom, _) = desk.dom("measure.html");
        let found: Vec<&str> = dom
            .split("MEASURED ")
            .skip(2)
            .filter_map(|rest| rest.split(" END").next())
            .collect();
        assert_eq!(found.len(), 7, "{found:?}");
        for line in found {
            let width: f64 = line.split(' ').next().unwrap().parse().unwrap();
            let value = |name: &str| {
                let rest = line.split(&format!("{name}=")).nth(1).unwrap();
                rest.split(' ').next().unwrap().to_owned()
            };
            assert!(value("wide").parse::<f64>().unwrap() <= width, "{line}");
            assert_eq!([value("drawings"), value("tables")], [drawings, tables], "{line}");
            assert_eq!([value("scrolled"), value("broken")], ["0", "0"], "{line}");
            assert_eq!(value("beyond"), "", "{line}");
            assert!(value("smallest").parse::<f64>().unwrap() >= 7.8, "{line}");
        }
    };
    // The quick tier does not check this page by itself: the same lifetime is one of the two on the next page.
    if crate::tier::quick_or_full(false, true) {
        check(&Life::default().run().page(), "5", "1");
    }
    check(&lifetimes::page_of_two(), "10", "4");
    let life = Life {
        name: "a_name_that_is_much_longer_than_any_name_of_a_lifetime_needs_to_be_and_has_no_spaces",
        tasks: (0..12)
            .map(|task| format!("{}_{task}", "verylongtaskname".repeat(3)))
            .collect(),
        rounds: 1,
        ..Life::default()
    };
    check(&life.run().page(), "5", "1");
}

/// Height of the band reserved for each figure, in pixels.
const BAND: u32 = 900;
/// Height of the legend at the top of a figure, in pixels.
const LEGEND: usize = 64;

#[test]
fn figures_are_drawn_in_both_colour_schemes_and_on_a_phone() {
    let Some(desk) = Desk::with(&Life::default().run().page()) else {
        return;
    };
    // Each figure is shown alone in its own band, so that the rest of the page is not counted as its pixels.
    for (name, wide) in [("plots.html", 1200), ("phone.html", 360)] {
        let frame = format!(
            r#"<body style="margin:0"><iframe src="page.html" style="width:{wide}px;height:{}px;border:0"></iframe><script>
            document.querySelector("iframe").onload = ({{ target }}) => {{
              const page = target.contentDocument;
              const plots = [...page.querySelectorAll("figure svg")].filter(svg => svg.getBoundingClientRect().width > 0);
              page.body.replaceChildren(...plots.map(svg => {{
                const band = page.createElement("div");
                band.style = "height:{BAND}px;overflow:hidden";
                svg.style = "width:100%;height:auto";
                band.append(svg);
                return band;
              }}));
            }};
            </script>"#,
            5 * BAND
        );
        desk.put(name, &frame);
    }
    let tasks = |scheme| match scheme {
        Scheme::Light => [[0, 114, 178], [230, 159, 0], [0, 158, 115]],
        Scheme::Dark => [[0x4a, 0x9f, 0xe0], [0xf0, 0xb4, 0x29], [0x2b, 0xc1, 0x96]],
    };
    let pages = [("plots.html", [1200, 5 * BAND]), ("phone.html", [500, 5 * BAND])];
    for (number, scheme) in [Scheme::Light, Scheme::Dark].into_iter().enumerate() {
        // The quick tier checks each scheme and each width once.
        let skipped = crate::tier::quick_or_full(1 - number, 2);
        for (_, (name, size)) in pages.into_iter().enumerate().filter(|(page, _)| *page != skipped) {
            let (width, pixels) = desk.screenshot(name, size, scheme);
            assert_eq!(width, size[0] as usize);
            let ground = pixels[10 * width + 5];
            assert_eq!(
                ground[0] > 128,
                scheme == Scheme::Light,
                "{name}: the background is {ground:?}"
            );
            let band = BAND as usize * width;
            for (figure, rows) in pixels.chunks_exact(band).enumerate() {
                let count = |color: [u8; 3]| rows[LEGEND * width..].iter().filter(|pixel| **pixel == color).count();
                let found: Vec<usize> = tasks(scheme).into_iter().map(count).collect();
                // The comparison with experts shows only the first task.
                let expected = if figure == 3 { 1 } else { 3 };
                assert!(
                    found.iter().filter(|count| **count > 30).count() >= expected,
                    "{name}, figure {figure}: {found:?} pixels of the tasks"
                );
            }
            let other = if scheme == Scheme::Light {
                Scheme::Dark
            } else {
                Scheme::Light
            };
            for color in tasks(other) {
                assert!(!pixels.contains(&color), "{name}: {color:?} is the other scheme's");
            }
        }
    }
}
