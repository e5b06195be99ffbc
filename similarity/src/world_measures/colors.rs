//! How far apart the colours of two worlds' objects are. Which measures of colours there are is in `color/measure.rs`.

use driftworld_spec::{Color, World};

use crate::{ColorMeasure, SimilarityError, color_sets_distance};

/// [`color_sets_distance`] between the colours that the objects of two worlds have. Objects without one, which look as
/// their model does, are left out: they count neither here nor there.
pub(super) fn between(a: &World, b: &World, measure: ColorMeasure) -> Result<f64, SimilarityError> {
    let (a, b) = (colors(a), colors(b));
    // One of both ways, so that it is as far there as back to the last bit.
    let (a, b) = if order(&a).gt(order(&b)) { (b, a) } else { (a, b) };
    color_sets_distance(&a, &b, measure)
}

/// In an order of their own, whatever that of the objects.
fn colors(world: &World) -> Vec<Color> {
    let mut colors: Vec<Color> = world.objects.iter().filter_map(|object| object.color).collect();
    colors.sort_by(|a, b| order(&[*a]).partial_cmp(order(&[*b])).expect("channels are numbers"));
    colors
}

fn order(colors: &[Color]) -> impl Iterator<Item = f64> {
    colors.iter().flat_map(|color| color.0).collect::<Vec<_>>().into_iter()
}
