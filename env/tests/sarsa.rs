//! The built-in learner learns and is reproducible bit for bit, and its frozen copies never change.

use driftworld_env::{Agent, Environment, RandomAgent, SarsaAgent};
use driftworld_spec::{Color, Object, Stimulus, World, WorldDraft};

/// A field with blue cubes that pay, at positions that depend on the number.
fn field(number: u64) -> World {
    let mut draft = WorldDraft {
        max_steps: 100,
        ..WorldDraft::default()
    };
    draft.environment_params.map_size = [30.0, 30.0];
    for k in 0..6_u64 {
        let angle = (number * 37 + k * 60) as f64;
        let away = 5.0 + ((number * 5 + k * 3) % 8) as f64;
        let [x, y] = [libm::sin, libm::cos].map(|part| away * part(angle.to_radians()));
        draft.objects.push(Object {
            color: Color::from_name("blue"),
            reward: 100.0,
            reward_once_stimulus: vec![Stimulus::AgentCollide],
            destroy_stimulus: vec![Stimulus::AgentCollide],
            ..Object::new("geometric", [x, y])
        });
    }
    draft.check().expect("the field is a valid world")
}

fn episode(agent: &mut dyn Agent, number: u64, learns: bool) -> f64 {
    let mut environment = Environment::new(field(number));
    agent.begin(number);
    while !environment.ended() {
        let action = agent.act(&environment);
        let step = environment.step(action).expect("the agent's actions are valid");
        if learns {
            agent.learn(&environment, &step);
        }
    }
    environment.episode_return()
}

fn mean(agent: &mut dyn Agent) -> f64 {
    (1000..1020).map(|number| episode(agent, number, false)).sum::<f64>() / 20.0
}

fn trained_agent(episodes: u64) -> SarsaAgent {
    let mut agent = SarsaAgent::new();
    for number in 0..episodes {
        episode(&mut agent, number, true);
    }
    agent
}

#[test]
fn learner_learns_to_find_rewards() {
    let floor = mean(&mut RandomAgent::new(0));
    let before = mean(SarsaAgent::new().frozen().expect("the agent can be copied").as_mut());
    let after = mean(trained_agent(600).frozen().expect("the agent can be copied").as_mut());
    assert!(
        after > 2.0 * floor && after > before + 100.0,
        "before {before}, after {after}, random {floor}"
    );
}

#[test]
fn same_seeds_give_the_same_learner() {
    let [mut first, mut second] = [trained_agent(10), trained_agent(10)];
    for number in 50..60 {
        assert_eq!(episode(&mut first, number, true), episode(&mut second, number, true));
    }
}

#[test]
fn evaluations_do_not_change_copy_or_learner() {
    let (mut evaluated, mut left_alone) = (trained_agent(10), trained_agent(10));
    let mut copy = evaluated.frozen().expect("the agent can be copied");
    let earned = mean(copy.as_mut());
    // This holds even if a caller lets a copy learn.
    episode(copy.as_mut(), 5, true);
    assert_eq!(mean(copy.as_mut()), earned);
    for number in 50..60 {
        assert_eq!(
            episode(&mut evaluated, number, true),
            episode(&mut left_alone, number, true)
        );
    }
}
