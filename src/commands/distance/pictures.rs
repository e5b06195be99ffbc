//! `driftworld distance --pictures`: how different two worlds look. What is measured is the library's `picture_distance`.

use crate::picture_distance::{PictureOptions, Views, poses};
use crate::similarity::picture::PictureMeasure;
use crate::spec::World;
use serde_json::json;

use super::super::{Failure, output};
use crate::table::table;

/// Prints how different two worlds look to an agent in them.
pub(super) fn run(names: [&str; 2], worlds: [&World; 2], as_json: bool) -> Result<(), Failure> {
    let options = PictureOptions::default();
    let poses = poses(&worlds, &options)?;
    let (a, b) = (
        Views::new(worlds[0], &poses, &options)?,
        Views::new(worlds[1], &poses, &options)?,
    );
    let oklab = a.distance(&b, PictureMeasure::Oklab)?;
    let structure = a.distance(&b, PictureMeasure::Structure)?;
    let [places, tried] = [poses.len() as u32 / options.headings, options.across * options.across];
    if as_json {
        return output::json(&json!({
            "a": names[0], "b": names[1], "oklab": oklab, "structure": structure, "pictures": poses.len(),
            "places": places, "places_tried": tried, "side": options.side,
        }));
    }
    output::line(format!(
        "{} to {}, by {} pictures of each: {places} of {tried} places where an agent can stand in both, {} directions\n",
        names[0],
        names[1],
        poses.len(),
        options.headings
    ))?;
    let row = |name: &str, value: f64, says: &str| [name.to_owned(), format!("{value:.4}"), says.to_owned()];
    output::line(table(
        ["pictures", "distance", "what it says"],
        vec![
            row(
                "colours",
                oklab,
                "mean difference of pixels in Oklab; black to white is 1",
            ),
            row(
                "structure",
                structure,
                "(1 − SSIM) / 2: edges and shading; 0.5 where nothing is alike",
            ),
        ],
        &[1],
    ))
}
