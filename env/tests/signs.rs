//! Text on signs is readable in images of agents' usual size, and is left out where it would flicker.

use driftworld_env::{Camera, CpuRenderer, Frame, Scene};
use driftworld_spec::{Color, Object, World, WorldDraft};

/// Width and height of the agent's images.
const SIDE: u32 = 84;

/// Number of characters of a text, and of squares per character across and down.
const LETTERS: usize = 3;
const COLUMNS: usize = 5;
const ROWS: usize = 7;

/// A sign that faces −y, `metres` ahead of the origin, rotated by `turn` degrees.
fn world(text: &str, metres: f64, turn: f64, color: Option<&str>) -> World {
    let mut sign = Object::new("sign", [0.0, metres]);
    sign.text = Some(text.to_owned());
    sign.heading = 180.0 + turn;
    sign.color = color.map(|name| Color::from_name(name).expect("the value is a colour"));
    let mut world = WorldDraft::with_objects(vec![sign]);
    world.environment_params.wall_height = 0.0;
    world.check().expect("the world is valid")
}

fn picture(world: &World, x: f32, side: u32) -> Frame {
    let mut frame = Frame::new(side, side);
    let camera = Camera::first_person([x, 0.0], 0.0, 1.0, 60.0);
    CpuRenderer::new().render(&Scene::from_world(world), &camera, &mut frame);
    frame
}

fn luminance(frame: &Frame, x: usize, y: usize) -> i32 {
    let at = 3 * (y * frame.width as usize + x);
    frame.rgb[at..at + 3].iter().map(|byte| i32::from(*byte)).sum()
}

/// The board in an image: columns and rows, half-open. The post below it is narrower.
fn board(frame: &Frame) -> [[usize; 2]; 2] {
    let (width, height) = (frame.width as usize, frame.height as usize);
    let in_row = |y: usize| {
        let row = &frame.instance[y * width..(y + 1) * width];
        let (first, last) = (row.iter().position(|id| *id == 1), row.iter().rposition(|id| *id == 1));
        first.zip(last).map(|(first, last)| [first, last + 1])
    };
    let widest = (0..height).filter_map(in_row).max_by_key(|[from, to]| to - from);
    let columns = widest.expect("the sign is in the picture");
    let is_board = |y: &usize| in_row(*y).is_some_and(|[from, to]| 2 * (to - from) > columns[1] - columns[0]);
    let rows: Vec<usize> = (0..height).filter(is_board).collect();
    [columns, [rows[0], rows[rows.len() - 1] + 1]]
}

/// Which squares of each character are darker than halfway between the board and the darkest square.
fn squares(frame: &Frame) -> Vec<Vec<bool>> {
    let [[left, right], [top, bottom]] = board(frame);
    // A margin of one square beside each character, above and below.
    let across = (right - left) as f32 / (LETTERS * (COLUMNS + 1) + 1) as f32;
    let down = (bottom - top) as f32 / (ROWS + 2) as f32;
    let at = |letter: usize, k: usize| {
        let (column, row) = (letter * (COLUMNS + 1) + 1 + k % COLUMNS, 1 + k / COLUMNS);
        let x = left as f32 + across * (column as f32 + 0.5);
        let y = top as f32 + down * (row as f32 + 0.5);
        luminance(frame, x as usize, y as usize)
    };
    let all = || (0..LETTERS).flat_map(|letter| (0..COLUMNS * ROWS).map(move |k| at(letter, k)));
    let middle = i32::midpoint(all().min().unwrap_or(0), all().max().unwrap_or(0));
    let letter = |letter: usize| (0..COLUMNS * ROWS).map(|k| at(letter, k) < middle).collect();
    (0..LETTERS).map(letter).collect()
}

/// All letters and digits in groups of three, one group per sign.
fn texts() -> Vec<String> {
    let letters: Vec<char> = ('A'..='Z').chain('0'..='9').collect();
    letters.chunks(LETTERS).map(|text| text.iter().collect()).collect()
}

#[test]
fn three_letters_are_readable_at_84_pixels_from_a_few_metres() {
    // Reference shapes of the characters from a nearby, large image.
    let templates: Vec<(char, Vec<bool>)> = texts()
        .iter()
        .flat_map(|text| {
            let frame = picture(&world(text, 1.5, 0.0, None), 0.0, 420);
            text.chars().zip(squares(&frame)).collect::<Vec<_>>()
        })
        .collect();
    assert_eq!(templates.len(), 36);
    let read = |squares: &Vec<bool>| {
        let apart = |template: &Vec<bool>| template.iter().zip(squares).filter(|(a, b)| a != b).count();
        let nearest = templates.iter().min_by_key(|(_, template)| apart(template));
        nearest.map(|(letter, _)| *letter)
    };
    for (metres, x, turn) in [
        (2.0, 0.1, 0.0),
        (2.5, -0.2, 8.0),
        (3.0, 0.0, 0.0),
        (3.0, 0.2, -4.0),
        (3.5, 0.1, 0.0),
    ] {
        for text in texts() {
            let frame = picture(&world(&text, metres, turn, None), x, SIDE);
            let found: String = squares(&frame).iter().filter_map(read).collect();
            assert_eq!(found, text, "from {metres} m, {x} m aside, turned by {turn} degrees");
        }
    }
}

#[test]
fn letters_contrast_with_boards_of_every_colour() {
    for color in ["white", "black", "red", "gold", "blue", "grey", "forestgreen", "pink"] {
        let frame = |text: &str| picture(&world(text, 3.0, 0.0, Some(color)), 0.0, SIDE);
        let (written, bare) = (frame("H8X"), frame(" "));
        let pixels = || (0..SIDE as usize).flat_map(|y| (0..SIDE as usize).map(move |x| (x, y)));
        let differences = pixels().map(|(x, y)| (luminance(&written, x, y) - luminance(&bare, x, y)).abs());
        let letters: Vec<i32> = differences.filter(|difference| *difference > 0).collect();
        assert!(letters.len() > 60, "{color}: {} pixels of letters", letters.len());
        assert!(
            letters.iter().all(|difference| *difference > 150),
            "{color}: {:?}",
            letters.iter().min()
        );
        assert_eq!(
            written
                .depth
                .iter()
                .zip(&bare.depth)
                .filter(|(a, b)| (*a - *b).abs() > 0.02)
                .count(),
            0
        );
    }
}

#[test]
fn distant_sign_has_no_letters() {
    let differ = |metres: f64, text: &str| {
        let frame = |text: &str| picture(&world(text, metres, 0.0, None), 0.0, SIDE).rgb;
        frame(text) != frame(" ")
    };
    assert!(differ(3.7, "ABC"), "a square of a letter is more than a pixel");
    assert!(!differ(4.5, "ABC") && !differ(20.0, "ABC"), "at most about a pixel");
    assert!(
        differ(1.9, "ABCDEFGH") && !differ(3.0, "ABCDEFGH"),
        "squares of eight letters are smaller"
    );
}

#[test]
fn signs_have_text_only_in_front_and_other_classes_have_none() {
    let back = |text: &str| picture(&world(text, 3.0, 180.0, None), 0.0, SIDE).rgb;
    assert_eq!(back("ABC"), back(" "));
    let of_class = |text: Option<&str>| {
        let mut object = Object::new("furniture", [0.0, 3.0]);
        object.text = text.map(str::to_owned);
        let world = WorldDraft::with_objects(vec![object]);
        picture(&world.check().expect("the world is valid"), 0.0, SIDE).rgb
    };
    assert_eq!(of_class(Some("SOFA")), of_class(None));
}
