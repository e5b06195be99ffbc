//! Models in the natural style, compared with the plain ones: the same colliders and similar sizes, distinct shapes, few
//! triangles, and exactly the same trajectories.

use driftworld_env::{Action, Camera, CpuRenderer, Environment, Frame, Scene, asset, asset_in, classes};
use driftworld_spec::{Layout, Looks, Maze, Model, Object, Style, World, WorldDraft};

fn world(objects: Vec<Object>, style: Style) -> World {
    let mut world = WorldDraft::with_objects(objects);
    world.environment_params.looks = Looks::of(style);
    world.environment_params.wall_height = 0.0;
    world.check().expect("the world is valid")
}

fn of_model(class: &str, number: u32, coordinates: [f64; 2]) -> Object {
    let mut object = Object::new(class, coordinates);
    object.model = Model(number.to_string());
    object
}

#[test]
fn natural_models_keep_colliders_and_nearly_keep_sizes() {
    let mut others = 0;
    for (class, models) in classes() {
        for number in 1..=models {
            let model = Model(number.to_string());
            let (plain, natural) = (asset(class, &model), asset_in(Style::Natural, class, &model));
            assert_eq!(plain.collider, natural.collider, "{class} {number}");
            let taller = natural.height / plain.height;
            assert!((0.6..1.5).contains(&taller), "{class} {number}: {taller} times as high");
            let wider = natural.radius / plain.radius;
            assert!((0.4..2.2).contains(&wider), "{class} {number}: {wider} times as wide");
            if std::sync::Arc::ptr_eq(&plain, &natural) {
                continue;
            }
            others += 1;
            let lowest = natural
                .parts
                .iter()
                .flat_map(|part| &part.mesh.corners)
                .map(|corner| corner[2]);
            let lowest = lowest.fold(f32::INFINITY, f32::min);
            assert!((0.0..0.02).contains(&lowest), "{class} {number} stands at {lowest} m");
            let levels: Vec<(usize, f32)> = natural.levels().collect();
            let [(fine, 0.0), (coarse, error)] = levels[..] else {
                panic!("{class} {number} has the levels {levels:?}")
            };
            assert!(
                fine <= 350 && 4 * coarse <= 3 * fine + 20,
                "{class} {number}: {levels:?}"
            );
            assert!(
                error < 0.25 * natural.height.max(natural.radius),
                "{class} {number}: {error} m"
            );
        }
    }
    assert_eq!(others, 49 + 44 + 11 + 6 + 1, "trees, rocks, shrubs, mushrooms, the car");
}

#[test]
fn natural_trees_have_a_few_more_triangles_nearby_and_half_as_many_far_away() {
    let mean = |style: Style, level: usize| {
        let of = |number: u32| {
            let asset = asset_in(style, "tree", &Model(number.to_string()));
            let levels: Vec<(usize, f32)> = asset.levels().collect();
            levels[level.min(levels.len() - 1)].0
        };
        (1..=49).map(of).sum::<usize>() / 49
    };
    let (plain, fine, coarse) = (mean(Style::Plain, 0), mean(Style::Natural, 0), mean(Style::Natural, 1));
    assert!(
        4 * fine <= 5 * plain && 2 * coarse <= plain + 40,
        "{plain}, then {fine} and {coarse}"
    );
}

/// The pixels that a tree covers in an image 84 pixels wide, scaled to fit.
fn silhouette(number: u32) -> Vec<bool> {
    let mut tree = of_model("tree", number, [0.0, 0.0]);
    let asset = asset_in(Style::Natural, "tree", &tree.model);
    tree.scale = f64::from(4.0 / asset.height);
    let mut frame = Frame::new(84, 84);
    let camera = Camera::first_person([0.0, -5.0], 0.0, 2.0, 60.0);
    CpuRenderer::new().render(
        &Scene::from_world(&world(vec![tree], Style::Natural)),
        &camera,
        &mut frame,
    );
    frame.instance.iter().map(|id| *id == 1).collect()
}

#[test]
fn sixteen_kinds_of_trees_have_distinct_outlines() {
    // One of each kind, without those that differ only in colour.
    let kinds = [7, 14, 1, 8, 2, 9, 16, 3, 10, 4, 11, 18, 5, 12, 6, 13];
    let outlines = kinds.map(silhouette);
    for (k, mine) in outlines.iter().enumerate() {
        for (other, theirs) in outlines.iter().enumerate().skip(k + 1) {
            let both = mine.iter().zip(theirs).filter(|(a, b)| **a && **b).count();
            let either = mine.iter().zip(theirs).filter(|(a, b)| **a || **b).count();
            let share = both as f32 / either as f32;
            assert!(
                share < 0.8,
                "trees {} and {}: {share} of their outlines in common",
                kinds[k],
                kinds[other]
            );
        }
    }
}

#[test]
fn levels_of_detail_keep_outlines_at_their_distance() {
    // A coarse level is used where its error is below half a pixel: outlines move by at most a pixel, except for thinner parts.
    for name in [
        "tree 1", "tree 2", "tree 9", "tree 10", "rock 5", "shrub 4", "animal 8", "animal 3",
    ] {
        let (class, number) = name.split_once(' ').expect("there are a class and a number");
        let number: u32 = number.parse().expect("it is a number");
        let model = Model(number.to_string());
        let asset = asset_in(Style::Natural, class, &model);
        let (_, error) = asset.levels().nth(1).expect("there is a coarse level");
        let pixels_per_metre_at_1_m = 42.0 / libm::tanf(30_f32.to_radians());
        let ball = (asset.radius * asset.radius + asset.height * asset.height / 4.0).sqrt();
        let far = 2.0 * pixels_per_metre_at_1_m * error + ball;
        let outline = |metres: f32, side: u32| {
            let world = world(vec![of_model(class, number, [0.0, f64::from(metres)])], Style::Natural);
            let mut frame = Frame::new(side, side);
            let camera = Camera::first_person([0.0, 0.0], 0.0, asset.height / 2.0, 60.0);
            CpuRenderer::new().render(&Scene::from_world(&world), &camera, &mut frame);
            frame.instance.iter().map(|id| *id == 1).collect::<Vec<bool>>()
        };
        // The same view at full detail: a larger image selects the full level; it is sampled at the centre of each pixel.
        let (coarse, large) = (outline(1.02 * far, 84), outline(1.02 * far, 84 * 9));
        let fine = |x: usize, y: usize| large[(9 * y + 4) * 84 * 9 + 9 * x + 4];
        let pixels = |is: &dyn Fn(usize, usize) -> bool, x: usize, y: usize| {
            let near = |k: usize| k.saturating_sub(1)..=(k + 1).min(83);
            near(y).any(|y| near(x).any(|x| is(x, y)))
        };
        let is_coarse = |x: usize, y: usize| coarse[84 * y + x];
        let all = || (0..84).flat_map(|y| (0..84).map(move |x| (x, y)));
        let seen = all().filter(|(x, y)| fine(*x, *y)).count();
        let lost = all()
            .filter(|(x, y)| fine(*x, *y) && !pixels(&is_coarse, *x, *y))
            .count();
        let gained = all()
            .filter(|(x, y)| is_coarse(*x, *y) && !pixels(&fine, *x, *y))
            .count();
        assert!(
            seen > 0 && lost + gained <= seen / 50,
            "{class} {number}: {lost} and {gained} of {seen}"
        );
    }
}

#[test]
fn looks_do_not_change_trajectories() {
    for layout in [
        None,
        Some(Maze {
            seed: Some(3),
            ..Maze::default()
        }),
    ] {
        check_trajectories(layout.as_ref());
    }
}

fn check_trajectories(maze: Option<&Maze>) {
    let objects = || {
        let place = |k: u32| [f64::from(k * 37 % 19) - 9.0, f64::from(k * 53 % 17) + 1.5 - 8.0];
        let of = |(k, class): (u32, &str)| {
            let mut object = of_model(class, k % 5 + 1, place(k + 1));
            object.motion_model = if k % 4 == 3 {
                driftworld_spec::MotionModel::Prey
            } else {
                object.motion_model
            };
            object.speed = 1.5;
            object
        };
        let classes = ["rock", "tree", "shrub", "mushroom"].into_iter().cycle().take(24);
        (0..).zip(classes).map(of).collect::<Vec<Object>>()
    };
    let walk = |style: Style| {
        let layout = maze.cloned().map(|maze| Layout {
            maze: Some(maze),
            ..Layout::default()
        });
        let world = world(objects(), style).edit(|world| world.environment_params.layout = layout);
        let mut environment = Environment::new(world.expect("the world is valid"));
        let mut bits = Vec::new();
        for k in 0..400_u32 {
            let turn = [0.0, 40.0, -20.0, 0.0, 15.0][k as usize / 20 % 5];
            let step = environment.step(Action::Continuous([4.0, turn, 0.0]));
            let step = step.expect("the episode continues");
            let agent = environment.agent();
            bits.extend([agent.position[0], agent.position[1], agent.heading_deg].map(f32::to_bits));
            bits.extend([step.reward.to_bits() as u32, step.events.len() as u32]);
            for item in &environment.scene().items {
                bits.extend([item.position[0], item.position[1], item.heading_deg].map(f32::to_bits));
            }
        }
        (bits, environment.observe().rgb.clone())
    };
    let ((plain, picture), (natural, other_picture)) = (walk(Style::Plain), walk(Style::Natural));
    assert!(plain == natural, "the trajectories are the same");
    assert!(picture != other_picture, "the images differ");
}
