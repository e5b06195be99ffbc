//! The page without a browser: well-formedness, sections, forbidden content, size. `browser.rs` tests how it looks.

#![expect(clippy::unwrap_used, reason = "a test stops at its first surprise")]

use driftworld_report::{Chapter, ChapterOptions, Figure, FigureOptions, Figures, Report, Unit};

use crate::lifetimes::{self, Life};

/// Every tag of a page or a drawing: its name, and whether it is a closing tag.
fn tags(text: &str) -> Vec<(String, bool)> {
    const NEVER_CLOSED: [&str; 6] = ["meta", "link", "br", "wbr", "img", "!DOCTYPE"];
    let mut tags = Vec::new();
    let mut rest = text;
    while let Some(start) = rest.find('<') {
        let end = start + rest[start..].find('>').expect("every tag is closed");
        let tag = &rest[start + 1..end];
        let name: String = tag
            .trim_start_matches('/')
            .chars()
            .take_while(|c| !c.is_whitespace() && *c != '/')
            .collect();
        rest = &rest[end + 1..];
        assert!(
            tag.matches('"').count().is_multiple_of(2),
            "quotes are closed in <{tag}>"
        );
        if name == "style" && !tag.starts_with('/') {
            rest = &rest[rest.find("</style").expect("the style element is closed")..];
        }
        if !NEVER_CLOSED.contains(&name.as_str()) && !tag.ends_with('/') {
            tags.push((name, tag.starts_with('/')));
        }
    }
    tags
}

fn assert_well_formed(text: &str) {
    let mut open: Vec<String> = Vec::new();
    for (name, closes) in tags(text) {
        if closes {
            assert_eq!(open.pop().as_deref(), Some(name.as_str()), "inside {open:?}");
        } else {
            open.push(name);
        }
    }
    assert!(open.is_empty(), "never closed: {open:?}");
}

fn count(text: &str, part: &str) -> usize {
    text.matches(part).count()
}

#[test]
fn page_is_well_formed_and_has_every_section() {
    let page = Life::default().run().page();
    assert_well_formed(&page);
    for title in [
        "Metrics",
        "Curriculum",
        "Learning curves",
        "Evaluations",
        "Against the single-task expert",
        "Raw values",
        "Tasks",
        "Transfer between tasks",
        "How it was computed",
    ] {
        assert!(page.contains(&format!(">{title}</h")), "{title}");
    }
    let position = |part: &str| page.find(part).unwrap_or_else(|| panic!("{part} is on the page"));
    assert!(
        position(">Reached</h3>") < position("<dl class=\"facts\">"),
        "the section Reached comes first"
    );
    assert!(
        page.contains("Average performance at the end (ACC): ")
            && page.contains("In papers: BWT (Lopez-Paz and Ranzato 2017)")
    );
    assert_eq!(count(&page, "<figure>"), 5);
    assert_eq!(count(&page, "<svg class=\"wide\" role=\"img\""), 5);
    assert_eq!(count(&page, "<svg class=\"narrow\" role=\"img\""), 5);
    assert_eq!(
        count(&page, "<svg"),
        count(&page, "</title>") - 1,
        "every drawing has a title, and so does the page"
    );
    assert!(page.contains("Warning: data-log.tsv:7: something &lt;odd&gt;"));
}

/// If tasks have display names, figures and tables use these, and each log name appears once beside them.
#[test]
fn display_names_are_shown_with_the_log_names_beside_them() {
    let life = Life {
        expert: false,
        ..Life::default()
    };
    let scored = life.run();
    let mut options = ChapterOptions::default();
    options.figures.names = [("find_red".to_owned(), "find_objects#red".to_owned())].into();
    let chapters = vec![Chapter::write(&scored.lifetime, &scored.metrics, &options).unwrap()];
    let page = Report {
        chapters,
        ..Report::default()
    };
    let page = page.to_html().unwrap();
    let contexts: Vec<&str> = page
        .match_indices("find_red")
        .map(|(at, _)| &page[at - 60..at + 20])
        .collect();
    assert_eq!(contexts.len(), 1, "the log's own name: {contexts:#?}");
    assert!(page.contains("find_objects#red<small>in the log find_red</small>"));
    let rows = count(&page, "<th scope=\"row\">find_objects#red");
    let columns = count(&page, "<th scope=\"col\">find_<wbr>objects#<wbr>red<wbr></th>");
    assert!(rows == columns + 2 && columns >= 2, "{rows} rows, {columns} columns");
    // A task without a display name keeps its log name.
    assert!(page.contains("<th scope=\"row\">find_blue</th>") && !page.contains("in the log find_blue"));
}

#[test]
fn headings_never_skip_a_level() {
    let page = Life::default().run().page();
    let levels: Vec<usize> = tags(&page)
        .into_iter()
        .filter(|(name, closes)| !closes && name.len() == 2 && name.starts_with('h') && name != "hr")
        .map(|(name, _)| name[1..].parse().unwrap())
        .collect();
    assert_eq!(levels.iter().filter(|level| **level == 1).count(), 1);
    assert_eq!(levels[0], 1);
    assert!(levels.windows(2).all(|pair| pair[1] <= pair[0] + 1), "{levels:?}");
}

#[test]
fn page_loads_no_resources_and_runs_no_scripts() {
    let page = Life::default().run().page();
    let without_namespace = page.replace("xmlns=\"http://www.w3.org/2000/svg\"", "");
    for part in [
        "http:",
        "https:",
        "<script",
        " src=",
        "url(",
        "@import",
        "<iframe",
        " onload",
        "javascript:",
    ] {
        assert!(!without_namespace.contains(part), "{part}");
    }
}

#[test]
fn hostile_names_are_escaped_on_the_page() {
    let hostile = [
        "<script>alert(1)</script>_\"x\" onload=\"y",
        "a&b_</title></svg><b>",
        "\u{202e}evil\u{7}_]]>'",
    ];
    let life = Life {
        tasks: hostile.map(str::to_owned).to_vec(),
        ..Life::default()
    };
    let scored = life.run();
    let page = scored.page();
    assert_well_formed(&page);
    assert!(!page.contains("<script") && !page.contains("<b>a"), "tags are escaped");
    assert!(page.contains("&lt;script&gt;alert(1)&lt;/script&gt;"));
    assert!(page.chars().all(|c| c == '\n' || !c.is_control()) && !page.contains('\u{202e}'));
    let options = FigureOptions::default();
    let figures = Figures::of(&scored.lifetime, "reward", &options).unwrap();
    for figure in Figure::ALL {
        assert_well_formed(&figures.svg(figure).unwrap());
    }
}

#[test]
fn same_lifetime_gives_the_same_bytes() {
    let life = Life::default();
    assert_eq!(life.run().page(), life.run().page());
}

#[test]
fn page_of_several_lifetimes_has_an_index_chapters_and_joint_intervals() {
    let page = lifetimes::page_of_two();
    assert_well_formed(&page);
    for part in [
        "<h1>Two &lt;lives&gt;</h1>",
        "<a href=\"#life-2\">second</a>",
        "id=\"life-2\"",
        "Over all lifetimes",
        "mine against theirs",
        // With two lifetimes of each agent, p is at least 1/3.
        "too few lifetimes",
        "mean reward, evaluations",
        "Student’s t",
        "21 November 2026",
    ] {
        assert!(page.contains(part), "{part}");
    }
    let ids: Vec<&str> = page
        .split(" id=\"")
        .skip(1)
        .map(|rest| rest.split('"').next().unwrap())
        .collect();
    for (index, id) in ids.iter().enumerate() {
        assert!(!ids[..index].contains(id), "{id} occurs twice");
    }
}

#[test]
fn page_without_experts_says_so() {
    let life = Life {
        expert: false,
        ..Life::default()
    };
    let scored = life.run();
    let page = scored.page();
    assert!(page.contains("nothing to compare with") && count(&page, "<figure>") == 4);
    let options = FigureOptions::default();
    assert!(
        !Figures::of(&scored.lifetime, "reward", &options)
            .unwrap()
            .has(Figure::Experts)
    );
}

#[test]
fn figures_in_steps_need_a_log_with_steps() {
    let options = FigureOptions {
        unit: Unit::Steps,
        ..FigureOptions::default()
    };
    let scored = Life::default().run();
    let svg = Figures::of(&scored.lifetime, "reward", &options)
        .unwrap()
        .svg(Figure::Learning)
        .unwrap();
    assert!(svg.contains("step\n</text>"), "the axis is named step");
    let life = Life {
        steps: false,
        ..Life::default()
    };
    let scored = life.run();
    let error = Figures::of(&scored.lifetime, "reward", &options).err().unwrap();
    assert_eq!(error.code(), "report/no-steps");
    let options = FigureOptions {
        distances: Some(vec![None]),
        ..FigureOptions::default()
    };
    let error = Figures::of(&scored.lifetime, "reward", &options).err().unwrap();
    assert_eq!(
        error.to_string(),
        "log first: found 1 distances, expected 8: one for each pair of neighbouring learning blocks, as listed by neighbours()"
    );
}

#[test]
fn few_variants_of_a_task_share_a_panel_and_many_do_not() {
    let panels = |variants: usize| {
        let life = Life {
            tasks: (0..variants).map(|variant| format!("find_{variant}")).collect(),
            rounds: 1,
            ..Life::default()
        };
        let (scored, options) = (life.run(), FigureOptions::default());
        let figures = Figures::of(&scored.lifetime, "reward", &options).unwrap();
        // The name of the axis appears once in each panel.
        count(&figures.svg(Figure::Evaluation).unwrap(), "experience\n</text>")
    };
    assert_eq!([1, 3, 5, 6, 8].map(panels), [1, 1, 1, 6, 8]);
}

/// Number of pixels of a colour below the legend, in the plot itself.
fn ink(figures: &Figures, figure: Figure, color: [u8; 3]) -> usize {
    let bytes = figures.png(figure).unwrap();
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
    let mut rgb = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut rgb).unwrap();
    assert_eq!((info.width, info.color_type), (1920, png::ColorType::Rgb));
    let white = rgb.chunks(3).filter(|pixel| *pixel == [255; 3]).count();
    assert!(white > rgb.len() / 3 / 2, "{figure:?}: the background is white");
    // The title and one line of names are 61 pixels high, at two dots per pixel.
    let plot = &rgb[130 * 1920 * 3..];
    plot.chunks(3).filter(|pixel| *pixel == color).count()
}

#[test]
fn figures_contain_the_colours_of_the_tasks() {
    let scored = Life::default().run();
    let options = FigureOptions::default();
    let figures = Figures::of(&scored.lifetime, "reward", &options).unwrap();
    for figure in Figure::ALL {
        let blue = ink(&figures, figure, [0, 114, 178]);
        assert!(blue > 400, "{figure:?}: {blue} pixels of the first task");
        assert_eq!(ink(&figures, figure, [1, 2, 3]), 0, "no figure uses this colour");
    }
}

#[test]
fn captions_describe_the_preprocessing() {
    let scored = Life::default().run();
    let page = |smoothed: bool| {
        let options = ChapterOptions {
            smoothed,
            ..ChapterOptions::default()
        };
        let chapters = vec![Chapter::write(&scored.lifetime, &scored.metrics, &options).unwrap()];
        let report = Report {
            chapters,
            options: serde_json::json!({ "smoothing_method": if smoothed { "flat" } else { "none" } }),
            ..Report::default()
        };
        report.to_html().unwrap()
    };
    assert!(page(true).contains("after smoothing, scaled to 1…101") && page(true).contains("Learning is smoothed"));
    assert!(!page(false).contains("smoothed") && !page(false).contains("after smoothing"));
    assert!(page(false).contains("Performance scaled to 1…101"));
    assert!(page(true).contains("One lifetime shows what this agent did"));
}

#[test]
fn sleep_blocks_are_counted_consistently_and_mentioned() {
    let life = Life {
        sleeps: true,
        ..Life::default()
    };
    let page = life.run().page();
    assert!(page.contains("<dd>18 (9 asleep)</dd>"), "the facts");
    let blocks = "<td class=\"number\">6</td><td class=\"number\">180</td>";
    assert_eq!(count(&page, blocks), 3, "the table of tasks");
    assert!(page.contains("Sleep blocks are drawn like the others: 9 of learning, 0 of evaluation."));
    assert!(
        page.contains("This lifetime has sleep phases: evaluations while awake are drawn, but do not count towards")
    );
    assert!(!Life::default().run().page().contains("sleep"));
}

#[test]
fn learning_blocks_of_one_experience_are_dots() {
    let life = Life {
        length: 1,
        rounds: 2,
        expert: false,
        evaluated: false,
        ..Life::default()
    };
    let (scored, options) = (life.run(), FigureOptions::default());
    let figures = Figures::of(&scored.lifetime, "reward", &options).unwrap();
    for figure in [Figure::Learning, Figure::Raw] {
        for color in [[0, 114, 178], [230, 159, 0], [0, 158, 115]] {
            let found = ink(&figures, figure, color);
            assert!(found > 60, "{figure:?}: {found} pixels of {color:?}");
        }
    }
}

#[test]
fn short_evaluations_of_a_long_lifetime_have_a_visible_area_in_the_raw_figure() {
    let life = Life {
        length: 9,
        rounds: 100,
        ..Life::default()
    };
    let (scored, options) = (life.run(), FigureOptions::default());
    let figures = Figures::of(&scored.lifetime, "reward", &options).unwrap();
    let svg = figures.svg(Figure::Raw).unwrap();
    let outlines: Vec<&str> = (svg.split("<polygon").skip(1))
        .filter_map(|rest| rest.split("points=\"").nth(1)?.split('"').next())
        .collect();
    assert!(outlines.len() > 900, "{} outlines", outlines.len());
    for outline in outlines {
        let corners: Vec<[i32; 2]> = outline
            .split_whitespace()
            .map(|corner| corner.split_once(',').unwrap())
            .map(|(x, y)| [x.parse().unwrap(), y.parse().unwrap()])
            .collect();
        for side in [0, 1] {
            let ends = || corners.iter().map(|corner| corner[side]);
            assert!(ends().max() > ends().min().map(|least| least + 1), "{outline}");
        }
    }
}

#[test]
fn pages_of_long_lifetimes_and_many_tasks_stay_small() {
    let check = |life: Life, limit: usize| {
        let size = life.run().page().len();
        assert!(size < limit, "{size} bytes");
    };
    check(Life::default(), 500_000);
    check(
        Life {
            length: 4000,
            ..Life::default()
        },
        700_000,
    );
    check(
        Life {
            tasks: (0..40).map(|task| format!("task{task}_x")).collect(),
            rounds: 2,
            length: 10,
            ..Life::default()
        },
        2_500_000,
    );
}

/// Relative luminance, from which contrast is computed (WCAG 2.2).
#[expect(clippy::disallowed_methods, reason = "compared within a tolerance")]
fn luminance(color: &str) -> f64 {
    let digits: String = match color.len() {
        3 => color.chars().flat_map(|digit| [digit, digit]).collect(),
        _ => color.to_owned(),
    };
    let channel = |index: usize| {
        let value = f64::from(u8::from_str_radix(&digits[index..index + 2], 16).unwrap()) / 255.0;
        if value <= 0.04045 {
            value / 12.92
        } else {
            ((value + 0.055) / 1.055).powf(2.4)
        }
    };
    0.2126 * channel(0) + 0.7152 * channel(2) + 0.0722 * channel(4)
}

#[test]
fn text_has_enough_contrast_in_light_and_dark_mode() {
    let style = include_str!("../src/page/style.css");
    let schemes: Vec<&str> = style
        .split(":root{")
        .skip(1)
        .take(2)
        .map(|rest| rest.split('}').next().unwrap())
        .collect();
    for scheme in schemes {
        let color = |name: &str| {
            let found = scheme
                .split(';')
                .find_map(|rule| rule.strip_prefix(&format!("--{name}:#")));
            luminance(found.unwrap_or_else(|| panic!("{name} in {scheme}")))
        };
        for (text, ground) in [
            ("ink", "ground"),
            ("ink", "card"),
            ("faint", "ground"),
            ("faint", "card"),
            ("link", "ground"),
            ("good", "good-soft"),
            ("bad", "bad-soft"),
            ("even", "even-soft"),
            ("warn", "warn-soft"),
        ] {
            let (a, b) = (color(text), color(ground));
            let contrast = (a.max(b) + 0.05) / (a.min(b) + 0.05);
            assert!(contrast >= 4.5, "{text} on {ground}: {contrast:.2} in {scheme}");
        }
    }
}
