//! Distance between the colours of two worlds' objects.

use driftworld_spec::{Color, World};

use crate::{ColorMeasure, SimilarityError, color_sets_distance};

/// [`color_sets_distance`] between the colours of the objects of two worlds. Objects without a colour of their own, which look
/// like their model, are left out.
pub(super) fn between(a: &World, b: &World, measure: ColorMeasure) -> Result<f64, SimilarityError> {
    let (a, b) = (colors(a), colors(b));
    // In a canonical order of the two, so that the result is symmetric to the last bit.
    let (a, b) = if order(&a).gt(order(&b)) { (b, a) } else { (a, b) };
    color_sets_distance(&a, &b, measure)
}

/// The colours of a world's objects, sorted so that the order of objects does not matter.
fn colors(world: &World) -> Vec<Color> {
    let mut colors: Vec<Color> = world.objects.iter().filter_map(|object| object.color).collect();
    colors.sort_by(|a, b| order(&[*a]).partial_cmp(order(&[*b])).expect("channels are numbers"));
    colors
}

fn order(colors: &[Color]) -> impl Iterator<Item = f64> {
    colors.iter().flat_map(|color| color.0).collect::<Vec<_>>().into_iter()
}
