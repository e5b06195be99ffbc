//! Contact sheets: the agent's view and the map of several variants, with the world and camera chosen that best show what the
//! variants are about.

use driftworld_env::{Agent, Environment, Renderer, Scene, StillAgent};
use driftworld_generator::Sampler;
use driftworld_report::picture::{Drawing, SheetRow, TextLine, sheet, text_lines};
use driftworld_spec::{Modality, MotionModel, Variant, World};
use driftworld_text::capitalized;

use crate::Failure;
use crate::map_drawing::Moves;
use crate::modality;
use crate::sheet_words::{Worlds, alike, below_all, commonest, differences, modality_words, placed};
use crate::subject::{Sight, openness, sight, subjects};
use crate::views::{TURNS, Views, agent_camera};

/// Worlds tried per variant.
const WORLDS: u64 = 4;

/// Seconds for which paths of moving objects are drawn.
const SECONDS: f64 = 5.0;

/// A variant with its caption, and the range of worlds that may be drawn.
#[derive(Clone)]
pub(crate) struct Shown {
    pub(crate) variant: Variant,
    pub(crate) words: String,
    pub(crate) seed: u64,
    /// The first index, and the number of worlds.
    pub(crate) index: u64,
    pub(crate) count: u64,
    pub(crate) worlds: Worlds,
}

impl Shown {
    /// A variant as declared by its task.
    pub(crate) fn declared(variant: Variant, seed: u64) -> Self {
        let words = variant.task().variant_description(variant.name());
        Self {
            words: words.unwrap_or_default().to_owned(),
            variant,
            seed,
            index: 0,
            count: WORLDS,
            worlds: Worlds::Numbered,
        }
    }
}

/// Options of a sheet.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Look {
    /// World index for all variants; chosen if absent.
    pub(crate) index: Option<u64>,
    /// Camera rotation in degrees; chosen if absent.
    pub(crate) turn: Option<f32>,
    /// Height of each picture in pixels.
    pub(crate) size: u32,
    /// Variants per line.
    pub(crate) columns: usize,
}

/// The index of a world among the candidates, and a camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Choice {
    pub(crate) world: u64,
    pub(crate) turn: f32,
}

/// A world with its scene and the objects that a picture should show.
struct Candidate {
    world: World,
    scene: Scene,
    subjects: Vec<usize>,
}

/// A sheet's entry for one variant.
pub(crate) struct Cell {
    pub(crate) row: SheetRow,
    /// Whether its subject is visible.
    #[cfg_attr(not(test), expect(dead_code, reason = "what tests count"))]
    pub(crate) is_seen: bool,
}

/// Draws the sheet. `tick` is called after each variant.
pub(crate) fn contact_sheet(shown: &[Shown], look: Look, tick: &dyn Fn()) -> Result<Drawing, Failure> {
    let (cells, said) = cells(shown, look, tick)?;
    let rows: Vec<SheetRow> = cells.into_iter().map(|cell| cell.row).collect();
    let mut drawing = sheet(&rows, look.columns);
    for line in said {
        for line in text_lines(&line, 13.0, drawing.width as f32 - 24.0) {
            drawing.height += 18;
            let at = [12.0, drawing.height as f32 - 18.0];
            drawing.write(TextLine::new(line, at, 13.0, [110, 116, 124]));
        }
    }
    drawing.height += 4;
    Ok(drawing)
}

/// The entries of the variants, and the notes below them.
pub(crate) fn cells(shown: &[Shown], look: Look, tick: &dyn Fn()) -> Result<(Vec<Cell>, Vec<String>), Failure> {
    let mut renderer = Renderer::default();
    let worlds = shown
        .iter()
        .map(|shown| Candidates::of(shown, look.index))
        .collect::<Result<Vec<_>, Failure>>()?;
    let joint = joint_choice(&mut renderer, &worlds, look)?;
    let choices = worlds
        .iter()
        .map(|candidates| candidates.own_choice(&mut renderer, joint, look))
        .collect::<Result<Vec<_>, Failure>>()?;
    let places: Vec<String> = (shown.iter().zip(&choices))
        .map(|(shown, (choice, _))| placed(shown, *choice, look))
        .collect();
    let usual = commonest(&places);
    let mut cells: Vec<Cell> = Vec::new();
    let mut drawn: Vec<(Choice, Drawing, Drawing)> = Vec::new();
    // Variants whose values other captions show in brackets.
    let mut bases = Vec::new();
    for (number, (shown_here, candidates)) in shown.iter().zip(&worlds).enumerate() {
        let (choice, is_seen) = choices[number];
        let candidate = candidates.at(choice.world);
        let views = Views::new(&candidate.world, look.size, choice.turn);
        let modality = shown_modality(&candidate.world);
        let seen: Drawing = views.seen_in(modality)?.into();
        let map = views.map_with_legend(&ways(&candidate.world)?);
        let base = (0..number).find(|base| shown[*base].variant.task().name() == shown_here.variant.task().name());
        let mut words = vec![shown_here.words.trim().to_owned()];
        if let Some(base) = base {
            let differences = differences(&shown[base].variant, &shown_here.variant);
            if !differences.is_empty() && !bases.contains(&base) {
                bases.push(base);
            }
            words.push(differences);
            let (their_choice, their_view, their_map) = &drawn[base];
            let same = [*their_view == seen, *their_map == map];
            if *their_choice == choice {
                words.push(alike(&shown[base].variant, &shown_here.variant, same));
            }
        }
        words.push(modality_words(modality).to_owned());
        if Some(&places[number]) != usual {
            words.push(capitalized(&places[number]) + ".");
        }
        words.retain(|part| !part.is_empty());
        cells.push(Cell {
            row: SheetRow::new(
                shown_here.variant.id(),
                words.join(" "),
                vec![seen.clone(), map.clone()],
            ),
            is_seen,
        });
        drawn.push((choice, seen, map));
        tick();
    }
    let bases: Vec<String> = bases.into_iter().map(|base| shown[base].variant.id()).collect();
    let said = below_all(&bases, &places, usual.filter(|_| shown.len() > 1));
    Ok((cells, said.into_iter().collect()))
}

/// The modality in which a world is shown: the agent's first in the order colours, depth, segmentation.
fn shown_modality(world: &World) -> Modality {
    let own = &world.agent_params.modalities;
    let first = modality::ALL.into_iter().find(|kind| own.contains(kind));
    first.unwrap_or(Modality::Rgb)
}

/// The candidate worlds of a variant, drawn on demand.
struct Candidates {
    all: Vec<Option<Candidate>>,
}

impl Candidates {
    fn of(shown: &Shown, index: Option<u64>) -> Result<Self, Failure> {
        let sampler = Sampler::new(&shown.variant, shown.seed);
        let draw = |index: u64| -> Result<Candidate, Failure> {
            let world = sampler.world(index)?;
            Ok(Candidate {
                subjects: subjects(&world),
                scene: Environment::new(world.clone()).scene().clone(),
                world,
            })
        };
        if let Some(index) = index {
            return Ok(Self {
                all: vec![Some(draw(index)?)],
            });
        }
        let mut all = vec![Some(draw(shown.index)?)];
        let others = 1..WORLDS.min(shown.count.max(1));
        // A world that cannot be drawn is not shown.
        all.extend(others.map(|place| draw(shown.index + place).ok()));
        Ok(Self { all })
    }

    /// The candidate at an index; wraps around if there are fewer.
    fn at(&self, place: u64) -> &Candidate {
        let found = self.all.get(place as usize % self.all.len());
        let found = found.and_then(Option::as_ref).or_else(|| self.all[0].as_ref());
        found.expect("the first can be drawn")
    }

    fn sight(&self, renderer: &mut Renderer, choice: Choice) -> Result<Sight, Failure> {
        let candidate = self.at(choice.world);
        let camera = agent_camera(&candidate.world, choice.turn);
        sight(renderer, &candidate.scene, &camera, &candidate.subjects)
    }

    /// The joint choice if it shows this variant's subject; else a different camera, else a different world; if no view shows it,
    /// the most open view of the joint world.
    fn own_choice(&self, renderer: &mut Renderer, joint: Choice, look: Look) -> Result<(Choice, bool), Failure> {
        if self.sight(renderer, joint)?.is_enough() {
            return Ok((joint, true));
        }
        let worlds = std::iter::once(joint.world).chain(0..self.all.len() as u64);
        for world in worlds {
            let mut best = (Sight::default(), joint);
            for turn in turns(look) {
                let choice = Choice { world, turn };
                let seen = self.sight(renderer, choice)?;
                if seen > best.0 {
                    best = (seen, choice);
                }
            }
            if best.0.is_enough() {
                return Ok((best.1, true));
            }
        }
        Ok((self.most_open(renderer, joint, look)?, false))
    }

    /// The camera with the most free space; ties go to the joint choice, then to the first.
    fn most_open(&self, renderer: &mut Renderer, joint: Choice, look: Look) -> Result<Choice, Failure> {
        let scene = &self.at(joint.world).scene;
        let mut best = (0.0, joint);
        for turn in std::iter::once(joint.turn).chain(turns(look)) {
            let camera = agent_camera(&self.at(joint.world).world, turn);
            let metres = openness(renderer, scene, &camera)?;
            if metres > best.0 {
                best = (metres, Choice { turn, ..joint });
            }
        }
        Ok(best.1)
    }
}

fn turns(look: Look) -> Vec<f32> {
    look.turn.map_or_else(|| TURNS.to_vec(), |turn| vec![turn])
}

/// The world and camera that show the most variants' subjects, then the most objects, up to three each; ties go to the first.
fn joint_choice(renderer: &mut Renderer, worlds: &[Candidates], look: Look) -> Result<Choice, Failure> {
    let most = worlds.iter().map(|candidates| candidates.all.len()).max().unwrap_or(1) as u64;
    let mut best = (
        (0, 0),
        Choice {
            world: 0,
            turn: look.turn.unwrap_or(0.0),
        },
    );
    for world in 0..most {
        for turn in turns(look) {
            let choice = Choice { world, turn };
            let (mut cells, mut things) = (0, 0);
            for candidates in worlds {
                let seen = candidates.sight(renderer, choice)?;
                cells += u32::from(seen.is_enough());
                things += seen.seen.min(3);
            }
            if (cells, things) > best.0 {
                best = ((cells, things), choice);
            }
            // Two things per entry are enough.
            if cells as usize == worlds.len() && things >= 2 * cells {
                return Ok(best.1);
            }
        }
    }
    Ok(best.1)
}

/// The paths of moving objects while the agent stands still.
pub(crate) fn ways(world: &World) -> Result<Moves, Failure> {
    let mut moves = Moves::none(world);
    let moving: Vec<usize> = (world.objects.iter().enumerate())
        .filter(|(_, object)| object.motion_model != MotionModel::Stationary && object.speed > 0.0)
        .map(|(index, _)| index)
        .collect();
    if moving.is_empty() {
        return Ok(moves);
    }
    let mut environment = Environment::new(world.clone());
    let mut agent = StillAgent;
    agent.begin(0);
    let mut trails: Vec<Vec<[f32; 2]>> = moving
        .iter()
        .map(|index| vec![environment.objects()[*index].position])
        .collect();
    while !environment.ended() && environment.seconds() < SECONDS {
        let action = agent.act(&environment);
        environment.step(action)?;
        for (trail, index) in trails.iter_mut().zip(&moving) {
            let object = &environment.objects()[*index];
            let near =
                |from: &[f32; 2]| (from[0] - object.position[0]).abs() + (from[1] - object.position[1]).abs() < 3.0;
            // An object that was removed and respawned elsewhere has no path in between.
            if object.present && trail.last().is_some_and(near) {
                trail.push(object.position);
            }
        }
    }
    moves.seconds = environment.seconds();
    moves.trails = trails.into_iter().filter(|trail| trail.len() > 1).collect();
    Ok(moves)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use driftworld_spec::TaskSpec;

    use super::*;
    use crate::tasks;

    const LOOK: Look = Look {
        index: None,
        turn: None,
        size: 48,
        columns: 2,
    };

    fn of_task(task: &Arc<TaskSpec>, most: usize) -> Vec<Shown> {
        let variants = task.all_variants().into_iter().take(most);
        variants.map(|variant| Shown::declared(variant, 0)).collect()
    }

    fn seen(task: &Arc<TaskSpec>) -> (usize, usize) {
        let (cells, _) = cells(&of_task(task, 8), LOOK, &|| ()).expect("they can be drawn");
        (cells.iter().filter(|cell| cell.is_seen).count(), cells.len())
    }

    /// Each picture of the built-in tasks shows its subject.
    #[test]
    fn every_cell_of_the_built_in_tasks_shows_its_subject() {
        for name in tasks::built_in_names() {
            let (shown, all) = seen(&tasks::task(name).expect("it is built in"));
            assert_eq!(shown, all, "{name}");
        }
    }

    /// In mazes and rooms, walls hide the subject from the start position in every candidate world: the map shows it.
    #[test]
    fn most_cells_of_the_example_worlds_show_their_subject() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/worlds");
        let (mut shown, mut all) = (0, 0);
        let files = std::fs::read_dir(folder).expect("the examples are there");
        let mut files: Vec<_> = files.map(|entry| entry.expect("it can be read").path()).collect();
        files.sort();
        for path in files.into_iter().step_by(crate::tier::quick_or_full(4, 1)) {
            if path.extension().is_some_and(|ending| ending == "json") {
                let task = tasks::task(&path.display().to_string()).expect("it is a task");
                let (own, of) = seen(&task);
                (shown, all) = (shown + own, all + of);
            }
        }
        assert!(10 * shown >= 6 * all, "{shown} of {all}");
    }

    #[test]
    fn captions_say_what_differs_and_what_looks_the_same() {
        let task = tasks::task("moving_object").expect("it is built in");
        let named = ["wandering", "fast", "modest", "waypoints", "dusk"];
        let shown: Vec<Shown> = named
            .map(|name| Shown::declared(task.variant(name).expect("it is declared"), 0))
            .to_vec();
        let (cells, said) = cells(&shown, LOOK, &|| ()).expect("they can be drawn");
        let mut captions: Vec<String> = cells
            .iter()
            .map(|cell| format!("{}: {}", cell.row.title, cell.row.words))
            .collect();
        captions.extend(said);
        // Shows non-breaking spaces.
        insta::assert_snapshot!(captions.join("\n").replace('\u{a0}', "~"));
    }

    /// If no view shows the subject, no other turn has more free space than the chosen one; and every note on an entry, below
    /// the sheet or in its caption, is true.
    #[test]
    fn blind_cells_have_the_most_open_view_and_are_named() {
        let task = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/worlds/maze.json");
        let shown = of_task(&tasks::task(task).expect("it is a task"), 8);
        let mut renderer = Renderer::default();
        let worlds: Vec<Candidates> = shown
            .iter()
            .map(|shown| Candidates::of(shown, None).expect("they are drawn"))
            .collect();
        let joint = joint_choice(&mut renderer, &worlds, LOOK).expect("they are drawn");
        let (cells, said) = cells(&shown, LOOK, &|| ()).expect("they can be drawn");
        let mut blind = 0;
        for ((candidates, cell), shown) in worlds.iter().zip(&cells).zip(&shown) {
            let (choice, is_seen) = candidates.own_choice(&mut renderer, joint, LOOK).expect("it is drawn");
            let place = capitalized(&placed(shown, choice, LOOK)) + ".";
            let below = format!("ther cells: {}.", placed(shown, choice, LOOK));
            assert_eq!(
                cell.row.words.ends_with(&place),
                !said[0].contains(&below),
                "{}: {said:?}",
                cell.row.words
            );
            if is_seen {
                continue;
            }
            blind += 1;
            let candidate = candidates.at(choice.world);
            let mut open = |turn| {
                let camera = agent_camera(&candidate.world, turn);
                openness(&mut renderer, &candidate.scene, &camera).expect("it is drawn")
            };
            let own = open(choice.turn);
            assert!(TURNS.into_iter().all(|turn| open(turn) <= own), "{}", cell.row.title);
        }
        assert!(blind >= 5, "{blind}");
    }

    /// A variant is shown as its agent sees it.
    #[test]
    fn colour_blind_agents_are_shown_no_colours() {
        let task = tasks::task("moving_object").expect("it is built in");
        let named = ["wandering", "depth_only", "rgb_only"];
        let shown = named.map(|name| Shown::declared(task.variant(name).expect("it is declared"), 0));
        let (cells, _) = cells(&shown, LOOK, &|| ()).expect("they can be drawn");
        for (cell, is_gray) in cells.iter().zip([false, true, false]) {
            let picture = cell.row.pictures[0].to_picture();
            let gray = picture
                .rgb
                .chunks_exact(3)
                .all(|pixel| pixel[0] == pixel[1] && pixel[1] == pixel[2]);
            assert_eq!(gray, is_gray, "{}", cell.row.title);
            assert_eq!(
                cell.row.words.contains("Shown as depth: the agent sees no colours."),
                is_gray
            );
            assert_eq!(
                cell.row.words.contains("Looks the same"),
                cell.row.title.ends_with("rgb_only")
            );
        }
    }

    /// The sheet explains brackets for each task that uses them, and for no other.
    #[test]
    fn brackets_are_explained_where_used() {
        let said = |names: &[&str]| {
            let shown: Vec<Shown> = (names.iter())
                .map(|name| Shown::declared(tasks::variant(name).expect("it is declared"), 0))
                .collect();
            cells(&shown, LOOK, &|| ()).expect("they can be drawn").1.concat()
        };
        let one = said(&["find_objects#blue", "select_object#green", "select_object#red"]);
        assert!(
            one.starts_with("In brackets: the values of select_object#green, the first of its task. "),
            "{one}"
        );
        let two = said(&[
            "find_objects#blue",
            "find_objects#red",
            "get_to_goal#plain",
            "get_to_goal#soft",
        ]);
        let both = "In brackets: the values of find_objects#blue and get_to_goal#plain, each the first of its task. ";
        assert!(two.starts_with(both), "{two}");
        let none = said(&["find_objects#blue", "get_to_goal#plain"]);
        assert!(!none.contains("brackets"), "{none}");
    }

    #[test]
    fn moving_objects_leave_a_path_and_static_ones_none() {
        let world = |name: &str| {
            let variant = tasks::variant(name).expect("it is built in");
            Sampler::new(&variant, 0).world(0).expect("it can be drawn")
        };
        let moves = ways(&world("moving_object#fast")).expect("it runs");
        let length = |trail: &Vec<[f32; 2]>| -> f32 {
            trail
                .windows(2)
                .map(|pair| ((pair[1][0] - pair[0][0]).powi(2) + (pair[1][1] - pair[0][1]).powi(2)).sqrt())
                .sum()
        };
        assert!(!moves.trails.is_empty());
        // Six metres per second, for the given time.
        assert!(
            moves
                .trails
                .iter()
                .all(|trail| length(trail) <= 6.0 * moves.seconds as f32 * 1.01)
        );
        assert!(moves.trails.iter().map(length).fold(0.0, f32::max) > 10.0);
        assert!(ways(&world("find_objects#blue")).expect("it runs").trails.is_empty());
    }
}
