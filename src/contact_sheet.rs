//! Draws contact sheets: the agent's view and the map of several variants, from the world and camera that best show their
//! subjects.

use driftworld_env::{Agent, Environment, Renderer, Scene, StillAgent};
use driftworld_generator::Sampler;
use driftworld_report::picture::{Drawing, SheetRow, TextLine, sheet, text_lines};
use driftworld_spec::{Modality, MotionModel, Variant, World};
use driftworld_text::capitalized;

use crate::Failure;
use crate::map_drawing::Moves;
use crate::modality;
use crate::sheet_words::{Worlds, differences, footer, modality_words, most_frequent, same_looks, viewpoint};
use crate::subject::{Sight, openness, sight, subjects};
use crate::views::{TURNS, Views, agent_camera};

/// Maximum number of worlds tried per variant.
const WORLDS: u64 = 4;

/// Seconds for which paths of moving objects are drawn.
const SECONDS: f64 = 5.0;

/// A variant with its caption, and the range of worlds that may be drawn.
#[derive(Clone)]
pub(crate) struct Item {
    pub(crate) variant: Variant,
    pub(crate) words: String,
    pub(crate) seed: u64,
    /// The first index, and the number of worlds.
    pub(crate) index: u64,
    pub(crate) count: u64,
    pub(crate) worlds: Worlds,
}

impl Item {
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
pub(crate) struct Options {
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
    #[cfg_attr(not(test), expect(dead_code, reason = "only read by tests"))]
    pub(crate) is_seen: bool,
}

/// Draws the sheet. `tick` is called after each variant.
pub(crate) fn contact_sheet(shown: &[Item], look: Options, tick: &dyn Fn()) -> Result<Drawing, Failure> {
    let (cells, notes) = cells(shown, look, tick)?;
    let rows: Vec<SheetRow> = cells.into_iter().map(|cell| cell.row).collect();
    let mut drawing = sheet(&rows, look.columns);
    for line in notes {
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
pub(crate) fn cells(shown: &[Item], look: Options, tick: &dyn Fn()) -> Result<(Vec<Cell>, Vec<String>), Failure> {
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
    let viewpoints: Vec<String> = (shown.iter().zip(&choices))
        .map(|(shown, (choice, _))| viewpoint(shown, *choice, look))
        .collect();
    let most_common = most_frequent(&viewpoints);
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
        let map = views.map_with_legend(&paths(&candidate.world)?);
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
                words.push(same_looks(&shown[base].variant, &shown_here.variant, same));
            }
        }
        words.push(modality_words(modality).to_owned());
        if Some(&viewpoints[number]) != most_common {
            words.push(capitalized(&viewpoints[number]) + ".");
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
    let notes = footer(&bases, &viewpoints, most_common.filter(|_| shown.len() > 1));
    Ok((cells, notes.into_iter().collect()))
}

/// The modality in which a world is shown: the agent's first in the order colours, depth, segmentation.
fn shown_modality(world: &World) -> Modality {
    let own = &world.agent_params.modalities;
    let first = modality::ALL.into_iter().find(|kind| own.contains(kind));
    first.unwrap_or(Modality::Rgb)
}

/// The candidate worlds of a variant, drawn on demand.
struct Candidates {
    /// `None` for a world that cannot be drawn, but never for the first.
    worlds: Vec<Option<Candidate>>,
}

impl Candidates {
    fn of(shown: &Item, index: Option<u64>) -> Result<Self, Failure> {
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
                worlds: vec![Some(draw(index)?)],
            });
        }
        let mut worlds = vec![Some(draw(shown.index)?)];
        let others = 1..WORLDS.min(shown.count.max(1));
        worlds.extend(others.map(|offset| draw(shown.index + offset).ok()));
        Ok(Self { worlds })
    }

    /// The candidate at an index, which wraps around; the first if that one cannot be drawn.
    fn at(&self, index: u64) -> &Candidate {
        let found = self.worlds.get(index as usize % self.worlds.len());
        let found = found.and_then(Option::as_ref).or_else(|| self.worlds[0].as_ref());
        found.expect("the first world can be drawn")
    }

    fn sight(&self, renderer: &mut Renderer, choice: Choice) -> Result<Sight, Failure> {
        let candidate = self.at(choice.world);
        let camera = agent_camera(&candidate.world, choice.turn);
        sight(renderer, &candidate.scene, &camera, &candidate.subjects)
    }

    /// The joint choice if it shows this variant's subject; else another camera in the same world, else another world. If no view
    /// shows the subject: the most open view of the joint world.
    fn own_choice(&self, renderer: &mut Renderer, joint: Choice, look: Options) -> Result<(Choice, bool), Failure> {
        if self.sight(renderer, joint)?.is_enough() {
            return Ok((joint, true));
        }
        let worlds = std::iter::once(joint.world).chain(0..self.worlds.len() as u64);
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
    fn most_open(&self, renderer: &mut Renderer, joint: Choice, look: Options) -> Result<Choice, Failure> {
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

fn turns(look: Options) -> Vec<f32> {
    look.turn.map_or_else(|| TURNS.to_vec(), |turn| vec![turn])
}

/// The world and camera that show the most variants' subjects, then the most objects, up to three each; ties go to the first.
fn joint_choice(renderer: &mut Renderer, worlds: &[Candidates], look: Options) -> Result<Choice, Failure> {
    let num_worlds = worlds.iter().map(|own| own.worlds.len()).max().unwrap_or(1) as u64;
    let mut best = (
        (0, 0),
        Choice {
            world: 0,
            turn: look.turn.unwrap_or(0.0),
        },
    );
    for world in 0..num_worlds {
        for turn in turns(look) {
            let choice = Choice { world, turn };
            let (mut cells, mut objects) = (0, 0);
            for candidates in worlds {
                let seen = candidates.sight(renderer, choice)?;
                cells += u32::from(seen.is_enough());
                objects += seen.seen.min(3);
            }
            if (cells, objects) > best.0 {
                best = ((cells, objects), choice);
            }
            // Two objects per entry are enough.
            if cells as usize == worlds.len() && objects >= 2 * cells {
                return Ok(best.1);
            }
        }
    }
    Ok(best.1)
}

/// The paths of moving objects while the agent stands still.
pub(crate) fn paths(world: &World) -> Result<Moves, Failure> {
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
            let is_near =
                |from: &[f32; 2]| (from[0] - object.position[0]).abs() + (from[1] - object.position[1]).abs() < 3.0;
            // An object that was removed and respawned elsewhere did not move along a path.
            if object.present && trail.last().is_some_and(is_near) {
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

    const LOOK: Options = Options {
        index: None,
        turn: None,
        size: 48,
        columns: 2,
    };

    fn of_task(task: &Arc<TaskSpec>, max: usize) -> Vec<Item> {
        let variants = task.all_variants().into_iter().take(max);
        variants.map(|variant| Item::declared(variant, 0)).collect()
    }

    /// The number of cells that show their subject, and the number of all cells.
    fn count_seen(task: &Arc<TaskSpec>) -> (usize, usize) {
        let (cells, _) = cells(&of_task(task, 8), LOOK, &|| ()).expect("it can be drawn");
        (cells.iter().filter(|cell| cell.is_seen).count(), cells.len())
    }

    #[test]
    fn every_cell_of_the_built_in_tasks_shows_its_subject() {
        for name in tasks::built_in_names() {
            let (seen, total) = count_seen(&tasks::task(name).expect("it is built in"));
            assert_eq!(seen, total, "{name}");
        }
    }

    /// Not every cell shows its subject: in mazes and rooms, walls may hide it in every candidate world. The map shows it.
    #[test]
    fn most_cells_of_the_example_worlds_show_their_subject() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/worlds");
        let (mut seen, mut total) = (0, 0);
        let files = std::fs::read_dir(folder).expect("the examples are committed");
        let mut files: Vec<_> = files.map(|entry| entry.expect("it can be read").path()).collect();
        files.sort();
        for path in files.into_iter().step_by(crate::tier::quick_or_full(4, 1)) {
            if path.extension().is_some_and(|ending| ending == "json") {
                let task = tasks::task(&path.display().to_string()).expect("it is a task");
                let counts = count_seen(&task);
                (seen, total) = (seen + counts.0, total + counts.1);
            }
        }
        assert!(10 * seen >= 6 * total, "{seen} of {total}");
    }

    #[test]
    fn captions_say_what_differs_and_what_looks_the_same() {
        let task = tasks::task("moving_object").expect("it is built in");
        let named = ["wandering", "fast", "modest", "waypoints", "dusk"];
        let shown: Vec<Item> = named
            .map(|name| Item::declared(task.variant(name).expect("it is declared"), 0))
            .to_vec();
        let (cells, notes) = cells(&shown, LOOK, &|| ()).expect("it can be drawn");
        let mut captions: Vec<String> = cells
            .iter()
            .map(|cell| format!("{}: {}", cell.row.title, cell.row.words))
            .collect();
        captions.extend(notes);
        // Shows non-breaking spaces.
        insta::assert_snapshot!(captions.join("\n").replace('\u{a0}', "~"));
    }

    /// If no view shows the subject, the chosen turn has the most free space. The viewpoint of every cell is named either in its
    /// caption or below the sheet.
    #[test]
    fn cells_without_a_visible_subject_have_the_most_open_view() {
        let task = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/worlds/maze.json");
        let shown = of_task(&tasks::task(task).expect("it is a task"), 8);
        let mut renderer = Renderer::default();
        let worlds: Vec<Candidates> = shown
            .iter()
            .map(|shown| Candidates::of(shown, None).expect("they render"))
            .collect();
        let joint = joint_choice(&mut renderer, &worlds, LOOK).expect("they render");
        let (cells, notes) = cells(&shown, LOOK, &|| ()).expect("it can be drawn");
        let mut blind = 0;
        for ((candidates, cell), shown) in worlds.iter().zip(&cells).zip(&shown) {
            let (choice, is_seen) = candidates.own_choice(&mut renderer, joint, LOOK).expect("it renders");
            let sentence = capitalized(&viewpoint(shown, choice, LOOK)) + ".";
            let below = format!("ther cells: {}.", viewpoint(shown, choice, LOOK));
            assert_eq!(
                cell.row.words.ends_with(&sentence),
                !notes[0].contains(&below),
                "{}: {notes:?}",
                cell.row.words
            );
            if is_seen {
                continue;
            }
            blind += 1;
            let candidate = candidates.at(choice.world);
            let mut space = |turn| {
                let camera = agent_camera(&candidate.world, turn);
                openness(&mut renderer, &candidate.scene, &camera).expect("it renders")
            };
            let own = space(choice.turn);
            assert!(TURNS.into_iter().all(|turn| space(turn) <= own), "{}", cell.row.title);
        }
        assert!(blind >= 5, "{blind}");
    }

    /// A variant is shown as its agent sees it.
    #[test]
    fn colour_blind_agents_are_shown_no_colours() {
        let task = tasks::task("moving_object").expect("it is built in");
        let named = ["wandering", "depth_only", "rgb_only"];
        let shown = named.map(|name| Item::declared(task.variant(name).expect("it is declared"), 0));
        let (cells, _) = cells(&shown, LOOK, &|| ()).expect("it can be drawn");
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
        let notes = |names: &[&str]| {
            let shown: Vec<Item> = (names.iter())
                .map(|name| Item::declared(tasks::variant(name).expect("it is declared"), 0))
                .collect();
            cells(&shown, LOOK, &|| ()).expect("it can be drawn").1.concat()
        };
        let one = notes(&["find_objects#blue", "select_object#green", "select_object#red"]);
        assert!(
            one.starts_with("In brackets: the values of select_object#green, the first of its task. "),
            "{one}"
        );
        let two = notes(&[
            "find_objects#blue",
            "find_objects#red",
            "get_to_goal#plain",
            "get_to_goal#soft",
        ]);
        let both = "In brackets: the values of find_objects#blue and get_to_goal#plain, each the first of its task. ";
        assert!(two.starts_with(both), "{two}");
        let none = notes(&["find_objects#blue", "get_to_goal#plain"]);
        assert!(!none.contains("brackets"), "{none}");
    }

    #[test]
    fn moving_objects_leave_a_path_and_static_ones_none() {
        let world = |name: &str| {
            let variant = tasks::variant(name).expect("it is built in");
            Sampler::new(&variant, 0).world(0).expect("it can be drawn")
        };
        let moves = paths(&world("moving_object#fast")).expect("it runs");
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
        assert!(paths(&world("find_objects#blue")).expect("it runs").trails.is_empty());
    }
}
