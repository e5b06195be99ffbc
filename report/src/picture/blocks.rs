//! The image of a curriculum: one row per variant, one bar per stretch of experiences.

use super::{Drawing, FAINT, INK, Level, Rgb, Side, WHITE, corner, middle, round_step, text_width, words};
use crate::figure::task_color;
use driftworld_spec::{Block, BlockKind, Phase, Regime, Scenario};

const ROW: i32 = 40;
const BAR: i32 = 24;
const TOP: i32 = 84;
const WIDTH: i32 = 1200;
/// Height of the font of row names, see `font_size`.
const NAME: f32 = 17.5;
/// Opacity of a bar before deployment.
const EARLY: f32 = 0.3;
const EVALUATION: Rgb = [150, 154, 160];
/// Maximum number of rows; further variants share the last.
const MAX_ROWS: usize = 60;

/// One stretch of experiences of a variant.
struct Stretch {
    row: usize,
    /// The row of its drift's target, and the drift's progress at both ends of the stretch.
    drift: Option<(usize, [f64; 2])>,
    from: f64,
    to: f64,
    kind: BlockKind,
    phase: Phase,
}

/// Draws the blocks of a scenario: learning filled, evaluation grey, blocks before deployment outlined, drifts slanted.
pub fn blocks(scenario: &Scenario) -> Drawing {
    let (rows, stretches) = stretches(scenario);
    let total = scenario.num_experiences().max(1) as f64;
    let longest = rows.iter().map(|row| text_width(row, NAME / 1.24)).fold(0.0, f32::max);
    let left = (32 + longest.ceil() as i32).min(WIDTH / 2);
    let bottom = TOP + ROW * rows.len() as i32;
    let mut picture = Drawing::blank((WIDTH + 28) as u32, (bottom + 56) as u32);
    let x = |experience: f64| left + (f64::from(WIDTH - left) * experience / total).round() as i32;
    let y = |row: f64| TOP + (f64::from(ROW) * (row + 0.5)).round() as i32;
    picture.write(words(&scenario.name, (16, 12), 26.0, INK));
    for (index, (name, color, alpha, height)) in kinds(scenario).into_iter().enumerate() {
        let x = left + index as i32 * 190;
        let [(x0, y0), (x1, y1)] = [(x, 56 - height / 2), (x + 31, 57 + height / 2)];
        fill(&mut picture, &[(x0, y0), (x1, y0), (x1, y1), (x0, y1)], color, alpha);
        picture.write(words(name, (x + 38, 48), 16.5, FAINT));
    }
    for (index, row) in rows.iter().enumerate() {
        let across = y(index as f64);
        picture.line([middle((left, across)), middle((WIDTH, across))], 1.0, [228, 230, 233]);
        let name = words(row, (left - 12, across), f64::from(NAME), INK);
        picture.write(name.anchored(Side::Right, Level::Middle));
    }
    for stretch in &stretches {
        // Stretches too short to see are drawn one pixel wide.
        let (start, end) = (x(stretch.from), x(stretch.to).max(x(stretch.from) + 1));
        let color = task_color(stretch.row);
        let along = |progress: f64| match stretch.drift {
            Some((to, _)) => y(stretch.row as f64 + (to as f64 - stretch.row as f64) * progress),
            None => y(stretch.row as f64),
        };
        let [first, last] = stretch.drift.map_or([0.0, 0.0], |(_, ends)| ends);
        let is_evaluation = stretch.kind == BlockKind::Evaluation;
        let thick = if is_evaluation { BAR / 4 } else { BAR / 2 };
        let (a, b) = (along(first), along(last));
        let shape = [
            (start, a - thick),
            (end, b - thick),
            (end, b + thick),
            (start, a + thick),
        ];
        let (filled, alpha, rim) = match (stretch.kind, stretch.phase) {
            (BlockKind::Evaluation, _) => (EVALUATION, 1.0, None),
            (BlockKind::Learning, Phase::Deployment) => (color, 1.0, Some(WHITE)),
            (BlockKind::Learning, Phase::PreDeployment) => (color, EARLY, Some(color)),
        };
        fill(&mut picture, &shape, filled, alpha);
        if let Some(rim) = rim {
            let around = shape.iter().chain(&shape[..1]).map(|place| middle(*place));
            picture.line(around.collect::<Vec<_>>(), 1.0, rim);
        }
    }
    picture.line([middle((left, bottom)), middle((WIDTH, bottom))], 1.0, INK);
    for tick in ticks(total) {
        let at = x(tick);
        picture.line([middle((at, bottom)), middle((at, bottom + 5))], 1.0, INK);
        let number = words(tick.to_string(), (at, bottom + 8), 15.5, FAINT);
        picture.write(number.anchored(Side::Middle, Level::Top));
    }
    picture.write(words("experiences", (left, bottom + 28), 16.5, FAINT));
    picture
}

fn fill(picture: &mut Drawing, corners: &[(i32, i32)], color: Rgb, alpha: f32) {
    let points: Vec<_> = corners.iter().map(|place| corner(*place)).collect();
    picture.tint(points, color, alpha);
}

/// The legend: name, colour, alpha and height of each kind of bar in a scenario.
fn kinds(scenario: &Scenario) -> Vec<(&'static str, Rgb, f32, i32)> {
    let has = |kind: BlockKind, phase: Option<Phase>| {
        let is = |block: &Block| block.kind == kind && phase.is_none_or(|phase| block.phase == phase);
        scenario.blocks.iter().any(is)
    };
    let mut kinds = Vec::new();
    if has(BlockKind::Learning, Some(Phase::Deployment)) {
        kinds.push(("learning", task_color(0), 1.0, BAR / 2));
    }
    if has(BlockKind::Learning, Some(Phase::PreDeployment)) {
        kinds.push(("before deployment", task_color(0), EARLY, BAR / 2));
    }
    if has(BlockKind::Evaluation, None) {
        kinds.push(("evaluation, frozen", EVALUATION, 1.0, BAR / 4));
    }
    kinds
}

/// The names of the rows, and all stretches.
fn stretches(scenario: &Scenario) -> (Vec<String>, Vec<Stretch>) {
    let mut rows: Vec<String> = Vec::new();
    let mut row_of = |name: String| {
        let known = rows.iter().position(|row| *row == name);
        known.unwrap_or_else(|| {
            if rows.len() < MAX_ROWS {
                rows.push(name);
            } else {
                "others".clone_into(&mut rows[MAX_ROWS - 1]);
            }
            rows.len() - 1
        })
    };
    // Learned variants first, in order of appearance, then those that are only evaluated.
    let regimes = |kind: BlockKind| {
        let blocks = scenario.blocks.iter().filter(move |block| block.kind == kind);
        blocks.flat_map(|block| &block.regimes)
    };
    for regime in regimes(BlockKind::Learning).chain(regimes(BlockKind::Evaluation)) {
        row_of(id(regime));
    }
    let mut stretches = Vec::new();
    let mut position = 0.0;
    for block in &scenario.blocks {
        for regime in &block.regimes {
            let from = position;
            position += f64::from(regime.count);
            let drift = regime.drift.as_ref().map(|drift| {
                let end = format!("{}#{}", regime.task, drift.variant_name());
                (row_of(end), [drift.from, drift.until])
            });
            stretches.push(Stretch {
                row: row_of(id(regime)),
                drift,
                from,
                to: position,
                kind: block.kind,
                phase: block.phase,
            });
        }
    }
    (rows, stretches)
}

fn id(regime: &Regime) -> String {
    format!("{}#{}", regime.task, regime.variant_name())
}

/// Round numbers from 0 to the last experience, at most twelve.
fn ticks(total: f64) -> Vec<f64> {
    let step = round_step(total / 10.0).max(1.0);
    let count = (total / step).floor() as u32;
    (0..=count).map(|tick| f64::from(tick) * step).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_few() {
        assert_eq!(ticks(3.0), [0.0, 1.0, 2.0, 3.0]);
        assert_eq!(ticks(100.0).len(), 11);
        assert_eq!(ticks(190.0)[..3], [0.0, 20.0, 40.0]);
        assert!((1..100_000).all(|total| ticks(f64::from(total)).len() <= 12));
    }

    #[test]
    fn legend_names_only_what_is_drawn() {
        let names = |text: &str| {
            let found = kinds(&Scenario::from_json("s", text).unwrap()).into_iter();
            found.map(|kind| kind.0).collect::<Vec<_>>()
        };
        let block = |kind: &str, phase: &str| {
            format!(r#"{{ "type": "{kind}"{phase}, "regimes": [{{ "task": "t", "variant": "a", "count": 4 }}] }}"#)
        };
        let early = r#", "phase": "pre_deployment""#;
        let all = [block("learning", early), block("evaluation", ""), block("learning", "")];
        let of = |blocks: &[String]| names(&format!(r#"{{ "name": "s", "blocks": [{}] }}"#, blocks.join(", ")));
        assert_eq!(of(&all), ["learning", "before deployment", "evaluation, frozen"]);
        assert_eq!(of(&all[1..]), ["learning", "evaluation, frozen"]);
        assert_eq!(of(&all[2..]), ["learning"]);
    }

    #[test]
    fn drift_leads_to_the_row_of_its_last_variant() {
        let text = r#"{ "name": "s", "blocks": [
            { "type": "learning", "regimes": [{ "task": "t", "variant": "a", "count": 4, "drift": { "to": "a", "values": { "x": 1 }, "name": "b" } }] },
            { "type": "evaluation", "regimes": [{ "task": "t", "variant": "a", "values": { "x": 1 }, "name": "b", "count": 1 }] } ] }"#;
        let (rows, stretches) = stretches(&Scenario::from_json("s", text).unwrap());
        assert_eq!(rows, ["t#a", "t#b"]);
        assert_eq!(stretches[0].drift, Some((1, [0.0, 1.0])));
        assert_eq!((stretches[1].from, stretches[1].to, stretches[1].row), (4.0, 5.0, 1));
    }
}
