//! Checks the message and the code of every error of this crate.

use super::*;
use driftworld_generator::WorldId;
use std::collections::BTreeSet;
use strum::VariantNames;

#[test]
#[expect(clippy::too_many_lines, reason = "one case for each error")]
fn every_error_has_its_message() {
    let steps = |distance, tolerance| Steps {
        distance,
        tolerance,
        count: 3,
        element: None,
    };
    let errors = [
        CurriculumError::NotFrozen {
            block: 2,
            variant: "find_objects#red".into(),
            experience: 45,
            found: "a different action in step 3".into(),
        },
        CurriculumError::NoVariants,
        CurriculumError::BadCount {
            kind: "learning",
            found: 0,
        },
        CurriculumError::BadSeed(9),
        CurriculumError::BadBlocks(0),
        CurriculumError::BadForm {
            form: "alternating",
            variants: 3,
            blocks: Some(4),
            expected: "2 variants".into(),
        },
        CurriculumError::NoSuchPlace { found: 4, last: 3 },
        CurriculumError::HeldOut("t#v".into()),
        CurriculumError::NoWay,
        CurriculumError::DriftBetweenTasks {
            from: "t#v".into(),
            to: "u#v".into(),
        },
        CurriculumError::SeveralTasks {
            a: "t#v".into(),
            b: "u#v".into(),
        },
        CurriculumError::SameName {
            a: "t#v".into(),
            b: "u#v".into(),
            name: "c-v".into(),
        },
        CurriculumError::BadProbe(1),
        CurriculumError::StepsGivenUp {
            anchor: "t#v".into(),
            found: 2,
            wanted: steps(0.002, 0.0001),
            limit: 9,
        },
        CurriculumError::TooFew {
            anchor: "t#v".into(),
            element: "reward",
            found: 1,
            wanted: 4,
        },
        CurriculumError::BadSteps(steps(2.0, 0.1)),
        CurriculumError::TooFewSteps {
            anchor: "t#v".into(),
            found: 2,
            wanted: steps(0.25, 0.01),
            farthest: 0.5,
        },
        CurriculumError::Similarity(SimilarityError::Empty),
        CurriculumError::Generator(GeneratorError::DifferentTasks {
            from: "t#v".into(),
            to: "u#v".into(),
        }),
        CurriculumError::SameLogName {
            a: "a#b_c".into(),
            b: "a#bc".into(),
            name: "a_bc".into(),
        },
        CurriculumError::Unknown {
            block: 1,
            regime: 0,
            task: "t".into(),
            variant: "v".into(),
            reason: "no such task".into(),
        },
        CurriculumError::WorldFile {
            block: 1,
            regime: 0,
            reason: "maps/yard.json: not there".into(),
        },
        CurriculumError::NoSuchExperience { found: 9, total: 9 },
        CurriculumError::OtherRun {
            path: "logs/run".into(),
            place: "/agent".into(),
            found: "\"random\"".into(),
            expected: "\"onrails\"".into(),
        },
        CurriculumError::OtherRow {
            path: "logs/run".into(),
            row: 7,
            found: "experience 9 in block 1-test, t_v {}".into(),
            expected: "experience 7 in block 0-train, t_v {}".into(),
        },
        CurriculumError::NotAlone {
            a: "t#blue".into(),
            b: "t#dusk".into(),
            element: "reward",
            differs: "reward, observation".into(),
        },
        CurriculumError::World {
            block: 1,
            regime: 0,
            experience: 37,
            variant: "t#v..w".into(),
            progress: 0.25,
            source: GeneratorError::TooMany {
                world: WorldId {
                    variant: "t#v".into(),
                    seed: 1,
                    index: 2,
                },
                found: 9,
                limit: 8,
            },
        },
        CurriculumError::Episode {
            block: 1,
            regime: 0,
            experience: 5,
            source: EnvError::Ended,
        },
        CurriculumError::NoEvaluations(2),
        CurriculumError::NoCommonNames {
            found: 0,
            logs: "t_x, t_y".into(),
            matrix: "t#a, t#b".into(),
        },
        CurriculumError::TooFewTransfers {
            forward: 1,
            backward: 0,
        },
        CurriculumError::Relabelling(SimilarityError::MantelCount {
            what: "relabellings",
            found: 0,
            limit: 9,
        }),
        CurriculumError::Recording {
            path: "logs/a/worker-default/0-test/actions.jsonl".into(),
            source: driftworld_env::EnvError::Recording {
                line: 3,
                found: "the end of the file".into(),
                expected: "a line ending".into(),
            },
        },
        CurriculumError::UnreadableRecordings(
            driftworld_files::open(std::path::Path::new("no/such/actions.jsonl"), 1)
                .err()
                .unwrap(),
        ),
        CurriculumError::Recordings {
            path: "logs/a".into(),
            doing: "list this folder",
            source: std::io::Error::other("the disk is gone"),
        },
        CurriculumError::RecordingsLost {
            path: "logs/a/worker-default/0-test/actions.jsonl".into(),
            found: "no file".into(),
            expected: 1234,
        },
        CurriculumError::Log(MetricsError::LogExists("logs/run".into())),
    ];
    let messages: Vec<String> = errors
        .iter()
        .map(|error| format!("{}: {error}", error.code()))
        .collect();
    insta::assert_snapshot!(messages.join("\n"));
    let covered: BTreeSet<&str> = errors.iter().map(CurriculumError::code).collect();
    let all: BTreeSet<&str> = CurriculumError::VARIANTS.iter().copied().collect();
    assert_eq!(covered, all, "every code has a case here");
}
