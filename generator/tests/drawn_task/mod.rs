//! Random tasks for tests: a few parameters of any type, with requirements, some of them read only under a condition.

/// Deterministic pseudo-random numbers: Vigna's splitmix64.
pub(crate) struct Numbers(pub(crate) u64);

impl Numbers {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number in 0..1.
    pub(crate) fn share(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn below(&mut self, end: usize) -> usize {
        (self.share() * end as f64) as usize
    }

    fn one_of<'a, T>(&mut self, items: &'a [T]) -> &'a T {
        &items[self.below(items.len())]
    }
}

/// A parameter that may be chosen: its name, its declaration, and candidate default values.
type Candidate = (&'static str, &'static str, Vec<&'static str>);

/// The candidates, each terminated by a semicolon. `ends` stands for the two ends of the distribution of a randomized
/// parameter.
const CANDIDATES: &str = r#"
a | "type": "number", "range": [0, 1] | 0 | 0.3 | 0.55 | 1;
wolf_speed | "type": "number", "range": [0, 10] | 0 | 1 | 2.5 | 6;
agent_speed | "type": "number", "range": [0, 10] | 3 | 5 | 9 | 10;
n | "type": "integer", "range": [0, 5] | 0 | 2 | 5;
m | "type": "integer", "range": [-3, 8] | -3 | 1 | 4;
turn | "type": "heading", "range": [0, 360] | 0 | 40 | 200;
arc | "type": "heading", "range": [300, 420] | 300 | 350 | 20;
day | "type": "boolean", "choices": [true, false] | true | false;
sound | "type": "boolean", "choices": [true, false] | true | false;
word | "type": "string", "choices": ["x", "y", "z"] | "x" | "z";
look | "type": "string", "choices": ["tree", "bush", "x", "y"] | "tree" | "y";
good | "type": "color", "choices": ["red", "green", "crimson", "white"] | "red" | "white";
bad | "type": "color", "choices": ["red", "green", "blue"] | "green" | "blue";
pays | "type": "vector", "range": [-10, 10] | [-10, 10] | [2, -4] | [8, 8];
spot | "type": "point", "choices": [[0, 0], [10, 0], [-10, 5], [3, 20]] | [0, 0] | [3, 20];
law | "type": "distribution", "choices": [{ "constant": { "value": 0.2 } }, { "uniform": { "low": 0, "high": 1 } },
    { "normal": { "mean": 0.9, "std": 0.1 } }] | { "constant": { "value": 0.2 } } | { "uniform": { "low": 0, "high": 1 } };
ends |  | 0"#;

fn candidates() -> Vec<Candidate> {
    let row = |row: &'static str| {
        let mut parts = row.split(" | ");
        let mut next = || parts.next().expect("a row has a name, a declaration and values");
        (next(), next(), parts.collect())
    };
    CANDIDATES.trim().split(";\n").map(row).collect()
}

const END: &str = r#""type": "number", "range": [0, 1]"#;

/// A random task as JSON, and the parameters that a search may change.
pub(crate) struct Drawn {
    pub(crate) text: String,
    pub(crate) names: Vec<String>,
}

impl Drawn {
    pub(crate) fn new(numbers: &mut Numbers) -> Self {
        let (all, mut candidates) = (candidates(), Vec::new());
        let num_parameters = 2 + numbers.below(4);
        let mut axes = 0;
        while candidates.len() < num_parameters {
            let candidate = numbers.one_of(&all).clone();
            let more = match candidate.0 {
                "ends" | "pays" => 2,
                _ => usize::from(candidate.1.contains("range") && !candidate.1.contains("integer")),
            };
            if axes + more <= 3 && !candidates.contains(&candidate) {
                candidates.push(candidate);
                axes += more;
            }
        }
        if let Some(index) = candidates.iter().position(|(name, ..)| *name == "ends") {
            let ends: [Candidate; 2] = [
                ("lo", END, vec!["0", "0.1", "0.4"]),
                ("hi", END, vec!["0.4", "0.7", "1"]),
            ];
            candidates.splice(index..=index, ends);
        }
        let names: Vec<&str> = candidates.iter().map(|(name, ..)| *name).collect();
        let require: Vec<String> = (0..=numbers.below(3)).map(|_| requirement(numbers, &names)).collect();
        let guarded = (numbers.below(2) == 0).then(|| *numbers.one_of(&names));
        let (mut parameters, mut here) = (Vec::new(), Vec::new());
        for (name, declaration, values) in &candidates {
            let default = numbers.one_of(values);
            let mut read_if = String::new();
            if guarded == Some(*name) && *name != "lo" && *name != "hi" {
                let others: Vec<&str> = names.iter().copied().filter(|other| other != name).collect();
                read_if = format!(r#", "read_if": {:?}"#, condition(numbers, &others));
            }
            parameters.push(format!(
                r#""{name}": {{ "role": "variant", "affects": ["T"], {declaration}, "default": {default}{read_if} }}"#
            ));
            if numbers.below(2) == 0 {
                here.push(format!(r#""{name}": {}"#, numbers.one_of(values)));
            }
        }
        if names.contains(&"lo") {
            parameters.push(
                r#""drawn": { "role": "randomized", "type": "number", "affects": ["T"],
                    "distribution": { "uniform": { "low": { "param": "lo" }, "high": { "param": "hi" } } } }"#
                    .to_owned(),
            );
        }
        let text = format!(
            r#"{{ "name": "t", "require": {require:?}, "variants": {{ "here": {{ {} }} }}, "parameters": {{
                {} }} }}"#,
            here.join(", "),
            parameters.join(",\n                ")
        );
        Self {
            text,
            names: names.into_iter().map(str::to_owned).collect(),
        }
    }
}

/// A random numeric parameter among the names, with the scale of its values.
fn number(numbers: &mut Numbers, names: &[&str]) -> Option<(String, f64)> {
    let scale = |name: &str| match name {
        "a" | "lo" | "hi" => Some((name.to_owned(), 1.0)),
        "wolf_speed" | "agent_speed" => Some((name.to_owned(), 10.0)),
        "n" => Some((name.to_owned(), 5.0)),
        "m" => Some((name.to_owned(), 8.0)),
        "turn" | "arc" => Some((name.to_owned(), 360.0)),
        "pays" => Some(("pays[0]".to_owned(), 10.0)),
        _ => None,
    };
    let all: Vec<(String, f64)> = names.iter().filter_map(|name| scale(name)).collect();
    (!all.is_empty()).then(|| numbers.one_of(&all).clone())
}

/// A random condition on one parameter.
fn condition(numbers: &mut Numbers, names: &[&str]) -> String {
    if numbers.below(2) == 0
        && let Some((name, scale)) = number(numbers, names)
    {
        let bound = (numbers.share() * 20.0).round() / 20.0 * scale;
        let sign = numbers.one_of(&["<", ">=", ">", "<="]);
        return format!("{name} {sign} {bound}");
    }
    match *numbers.one_of(names) {
        "day" => "day".to_owned(),
        "sound" => "not sound".to_owned(),
        "word" => format!(
            "word {} '{}'",
            numbers.one_of(&["==", "!="]),
            numbers.one_of(&["x", "y"])
        ),
        "look" => format!(
            "look {} '{}'",
            numbers.one_of(&["==", "!="]),
            numbers.one_of(&["tree", "y"])
        ),
        "good" => numbers
            .one_of(&["good != 'red'", "distance(good, 'red') < 0.3"])
            .to_string(),
        "bad" => numbers
            .one_of(&["bad == 'blue'", "distance(bad, 'white') > 0.5"])
            .to_string(),
        "spot" => "spot[0] <= 3".to_owned(),
        "law" => "true".to_owned(),
        other => {
            let (name, scale) = number(numbers, &[other]).expect("all others are numbers");
            // A search, even on a grid, would hit an exact real number only by chance.
            let sign = if matches!(other, "n" | "m") { "!=" } else { "<=" };
            format!("{name} {sign} {}", (scale / 2.0).round())
        }
    }
}

fn requirement(numbers: &mut Numbers, names: &[&str]) -> String {
    let has = |a, b| names.contains(&a) && names.contains(&b);
    let pair = match numbers.below(3) {
        0 if has("good", "bad") => Some(["good != bad", "distance(good, bad) >= 0.2"]),
        0 if has("word", "look") => Some(["word != look", "word == look or word == 'z'"]),
        0 if has("wolf_speed", "agent_speed") => Some(["wolf_speed < agent_speed", "wolf_speed * 1.5 <= agent_speed"]),
        0 if has("n", "m") => Some(["n == m or n > 2", "(n + m) % 2 == 0"]),
        1 if has("day", "sound") => Some(["day == sound", "day != sound"]),
        _ => None,
    };
    if let Some(pair) = pair {
        return numbers.one_of(&pair).to_string();
    }
    let (a, b) = (number(numbers, names), number(numbers, names));
    if let (Some((a, a_scale)), Some((b, b_scale))) = (a, b)
        && a != b
    {
        let bound = (numbers.share() * 20.0).round() / 20.0;
        let (a, b) = (format!("{a} / {a_scale}"), format!("{b} / {b_scale}"));
        match numbers.below(8) {
            0 => return format!("{a} + {b} <= {}", 2.0 * bound),
            1 => return format!("{a} + {b} >= {bound}"),
            2 => return format!("abs({a} - {b}) <= {bound}"),
            3 => return format!("{a} < {b}"),
            4 => return format!("({a}) * {b} <= {bound}"),
            5 => return format!("max({a}, {b}) >= {bound}"),
            _ => {}
        }
    }
    let (one, other) = (condition(numbers, names), condition(numbers, names));
    match numbers.below(4) {
        0 => format!("not ({one} and {other})"),
        1 => one,
        _ => format!("{one} or {other}"),
    }
}
