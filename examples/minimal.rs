//! Sample a world, walk a few steps in it, and save what the agent sees.
#![expect(clippy::print_stdout, reason = "an example prints its results")]

use driftworld::env::{Action, Environment};
use driftworld::{generator, tasks};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let variant = tasks::variant("find_objects#red")?;
    let world = generator::sample(&variant, 7, 0)?;
    println!("world {} has {} objects", &world.hash()[..12], world.objects.len());

    let mut environment = Environment::new(world);
    for _ in 0..10 {
        let step = environment.step(Action::Continuous([5.0, 30.0, 0.0]))?;
        println!("reward {:6.2}  events {:?}", step.reward, step.events);
    }

    let frame = environment.observe();
    let mut encoder = png::Encoder::new(std::fs::File::create("minimal.png")?, frame.width, frame.height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.write_header()?.write_image_data(&frame.rgb)?;
    println!("wrote minimal.png, {} × {} pixels", frame.width, frame.height);
    Ok(())
}
