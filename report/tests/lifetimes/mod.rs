//! Synthetic lifetimes for the tests of this crate.

use std::collections::BTreeMap;

use driftworld_metrics::{
    BlockSubtype, BlockType, BootstrapOptions, Lifetime, LifetimeMetrics, LogWriter, LoggerInfo, Options, Record,
    ScenarioInfo, Scorer, SteLog, Timestamp, compare_agents, over_repeats, read_log, read_ste_log,
};
use driftworld_report::{Chapter, ChapterOptions, Comparison, Report, neighbours};

/// Settings of a synthetic lifetime in which the tasks take turns; all tasks are evaluated before every learning block.
#[expect(
    clippy::struct_excessive_bools,
    reason = "each turns on one feature that a test is about"
)]
pub(crate) struct Life<'a> {
    pub(crate) name: &'a str,
    pub(crate) tasks: Vec<String>,
    /// Number of learning blocks per task.
    pub(crate) rounds: u64,
    /// Experiences per learning block; an evaluation has a tenth of them, but at least two.
    pub(crate) length: u64,
    /// Whether the first task has an expert.
    pub(crate) expert: bool,
    pub(crate) steps: bool,
    pub(crate) evaluated: bool,
    /// Whether the second half of each learning block is sleep.
    pub(crate) sleeps: bool,
}

impl Default for Life<'_> {
    fn default() -> Self {
        Self {
            name: "first",
            tasks: ["find_red", "find_blue", "goal_plain"].map(str::to_owned).to_vec(),
            rounds: 3,
            length: 60,
            expert: true,
            steps: true,
            evaluated: true,
            sleeps: false,
        }
    }
}

/// A lifetime with its scores.
pub(crate) struct Scored {
    pub(crate) lifetime: Lifetime,
    pub(crate) metrics: LifetimeMetrics,
    pub(crate) options: Options,
}

impl Life<'_> {
    pub(crate) fn run(&self) -> Scored {
        let base = tempfile::tempdir().expect("a temporary folder can be created");
        let dir = base.path().join(self.name);
        self.write(&dir, &self.tasks, self.rounds);
        let log = read_log(&dir).expect("the log was just written");
        let experts: Vec<SteLog> = if self.expert {
            let dir = base.path().join("expert");
            self.write(&dir, &self.tasks[..1], 2);
            vec![read_ste_log(&dir).expect("it has one task")]
        } else {
            Vec::new()
        };
        let options = Options::default();
        let lifetime = Lifetime::prepare(&log, &experts, &options).expect("it has rows");
        let metrics = Scorer::default()
            .judge(&log, &lifetime, &options)
            .expect("it can be scored");
        Scored {
            lifetime,
            metrics,
            options,
        }
    }

    #[expect(clippy::disallowed_methods, reason = "rewards of any kind will do")]
    fn write(&self, dir: &std::path::Path, tasks: &[String], rounds: u64) {
        let columns = if self.steps {
            vec!["reward", "episode_step_count"]
        } else {
            vec!["reward"]
        };
        let info = LoggerInfo::new(columns).expect("the columns have names");
        let mut writer = LogWriter::create(dir, &info, &ScenarioInfo::default()).expect("the folder is new");
        let (mut block, mut experience) = (0, 0);
        for turn in 0..rounds * tasks.len() as u64 {
            let learned = (turn % tasks.len() as u64) as usize;
            let mut rows: Vec<(BlockType, usize, u64)> = Vec::new();
            let evaluated = if self.evaluated { tasks.len() } else { 0 };
            rows.extend((0..evaluated).map(|task| (BlockType::Test, task, (self.length / 10).max(2))));
            rows.push((BlockType::Train, learned, self.length));
            for (kind, task, count) in rows {
                for row in 0..count {
                    let seen = turn as f64
                        + if kind == BlockType::Train {
                            row as f64 / count as f64
                        } else {
                            0.0
                        };
                    let noise = ((experience * 7919 + row * 31) % 101) as f64 / 101.0;
                    let reward = 10.0 * (1.0 - (-seen / 3.0).exp()) + noise + task as f64;
                    let when = Timestamp::from_unix_micros(1_600_000_000_000_000 + experience as i64 * 1000)
                        .expect("the time is valid");
                    let mut record =
                        Record::new(block, experience, kind, &tasks[task], when).with_metric("reward", reward);
                    if self.sleeps && kind == BlockType::Train && row >= count / 2 {
                        record.block_subtype = BlockSubtype::Sleep;
                    }
                    if self.steps {
                        record = record.with_metric("episode_step_count", 50.0 + noise.round());
                    }
                    writer.write(&record).expect("the record is valid");
                    experience += 1;
                }
                if kind == BlockType::Train || task + 1 == tasks.len() {
                    block += 1;
                }
            }
        }
        writer.finish().expect("the file can be written");
    }
}

impl Scored {
    /// A page with this lifetime alone, including distances and a warning.
    pub(crate) fn page(&self) -> String {
        let mut options = ChapterOptions {
            warnings: vec!["data-log.tsv:7: something <odd>".to_owned()],
            distance_note: "Stems: distances made up for a test.".to_owned(),
            ..ChapterOptions::default()
        };
        let pairs = neighbours(&self.lifetime).len();
        options.figures.distances = Some(
            (0..pairs)
                .map(|pair| (pair % 4 != 3).then_some(pair as f64 / 7.0))
                .collect(),
        );
        let chapter = Chapter::write(&self.lifetime, &self.metrics, &options).expect("it can be drawn");
        let report = Report {
            chapters: vec![chapter],
            options: serde_json::to_value(&self.options).expect("options are JSON"),
            ..Report::default()
        };
        report.to_html().expect("there is one lifetime")
    }
}

/// A page with two lifetimes, with intervals over both and a comparison.
pub(crate) fn page_of_two() -> String {
    let lives = ["first", "second"].map(|name| {
        let life = Life {
            name,
            ..Life::default()
        };
        life.run()
    });
    let scores: Vec<LifetimeMetrics> = lives.iter().map(|scored| scored.metrics.clone()).collect();
    let chapter = |scored: &Scored| Chapter::write(&scored.lifetime, &scored.metrics, &ChapterOptions::default());
    let options = BootstrapOptions::default();
    let report = Report {
        title: Some("Two <lives>".to_owned()),
        chapters: (lives.iter().map(chapter).collect::<Result<_, _>>()).expect("the chapters can be drawn"),
        overall: over_repeats(&scores, &options).expect("both were scored with the same options"),
        comparisons: vec![Comparison {
            agent: "mine".to_owned(),
            other: "theirs".to_owned(),
            metrics: compare_agents(&scores, &scores, &options).expect("both were scored with the same options"),
            others_lifetime: None,
            names: BTreeMap::new(),
        }],
        date: Some("21 November 2026".to_owned()),
        ..Report::default()
    };
    report.to_html().expect("there are two lifetimes")
}
