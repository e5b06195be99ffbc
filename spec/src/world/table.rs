//! The table of fields of a whole world: its places, and the texts by which fields are compared leaf by leaf.

use std::sync::LazyLock;

use serde::Serialize;

use super::fields::{self, Compared, Comparison, FieldPlace, Fields, places_of};
use super::{Disc, EnvironmentParams, Looks, Object, Style, Surface, World, WorldDraft, Zone, ZoneEnd};
use crate::Color;

impl World {
    /// All places of a world, in the order of the table; the places of objects appear once.
    ///
    /// # Example
    /// ```
    /// use driftworld_spec::{ParameterType, World};
    /// let heading = World::places().iter().find(|place| place.pointer == "/objects/*/heading").expect("objects have one");
    /// assert_eq!((heading.kind, heading.field.unit), (Some(ParameterType::Heading), Some("degrees")));
    /// ```
    pub fn places() -> &'static [FieldPlace] {
        static PLACES: LazyLock<Vec<FieldPlace>> = LazyLock::new(places_of::<WorldDraft>);
        &PLACES
    }
}

/// The fields of a world or an object that are compared leaf by leaf: for each comparison, a text with one line of JSON
/// per field, in the order of the table. Equal fields have equal texts.
#[derive(Debug)]
pub struct LeafTexts([Vec<u8>; Comparison::ALL.len()]);

impl Default for LeafTexts {
    fn default() -> Self {
        Self([const { Vec::new() }; Comparison::ALL.len()])
    }
}

impl LeafTexts {
    /// Replaces the texts with those of a world, without its objects.
    pub fn read_world(&mut self, world: &World) {
        self.0.iter_mut().for_each(Vec::clear);
        self.add::<WorldDraft>(world);
        self.add(&world.environment_params);
        self.add(&world.agent_params);
        self.add(&world.rules);
        self.add_zones(&world.environment_params.zones);
        fields::write(
            &EffectiveLooks::of(&world.environment_params),
            &mut self.0[Comparison::CameraAndWeather as usize],
        );
    }

    /// Replaces the texts with those of an object.
    pub fn read_object(&mut self, object: &Object) {
        self.0.iter_mut().for_each(Vec::clear);
        self.add(object);
    }

    fn add<T: Fields>(&mut self, part: &T) {
        for row in T::ROWS {
            if let Compared::Leaves(comparison) = row.field.compared {
                let text = &mut self.0[comparison as usize];
                (row.write)(part, text);
                text.push(b'\n');
            }
        }
    }

    /// Adds the zones to each comparison to which they belong, reduced to the relevant properties.
    fn add_zones(&mut self, zones: &[Zone]) {
        fn shape(zone: &Zone) -> Shape<'_> {
            let disc = zone.disc.as_ref();
            Shape {
                corners: zone
                    .polygon
                    .as_deref()
                    .or_else(|| disc.map(|Disc { center, .. }| std::slice::from_ref(center))),
                radius: disc.map(|disc| disc.radius),
            }
        }
        let moving = zones
            .iter()
            .filter(|zone| zone.speed_factor != 1.0 || zone.teleport.is_some());
        let moving = moving.map(|zone| Moving {
            shape: shape(zone),
            speed_factor: zone.speed_factor,
            teleport: zone.teleport.as_slice(),
        });
        self.add_things(Comparison::Zones, moving);
        let pays = |zone: &&Zone| zone.is_wanted() || zone.is_costly();
        let paying = zones.iter().filter(pays).map(|zone| Paying {
            shape: shape(zone),
            reward_per_second: zone.reward_per_second,
            reward_on_entering: zone.reward_on_entering,
            ends: zone.ends,
        });
        self.add_things(Comparison::ZonePay, paying);
        let seen = zones.iter().filter(|zone| zone.visible).map(|zone| Visible {
            shape: shape(zone),
            color: zone.ground_color(),
        });
        self.add_things(Comparison::ZoneLooks, seen);
    }

    fn add_things(&mut self, comparison: Comparison, things: impl Iterator<Item = impl Serialize>) {
        let things: Vec<_> = things.collect();
        if !things.is_empty() {
            fields::write(&things, &mut self.0[comparison as usize]);
        }
    }

    /// The text of a comparison.
    pub fn of(&self, comparison: Comparison) -> &[u8] {
        &self.0[comparison as usize]
    }
}

/// The looks of a world, reduced to those that have an effect: a property that equals the style's default counts as absent.
#[derive(Serialize)]
struct EffectiveLooks {
    style: Style,
    ground: Option<Surface>,
    ground_scale: f64,
    walls: Option<Surface>,
    wall_scale: f64,
    ceiling: Option<bool>,
    shadows: bool,
    clouds: bool,
    fog_in_depth: bool,
}

impl EffectiveLooks {
    fn of(environment: &EnvironmentParams) -> Self {
        let (style, layout) = (environment.looks.style, environment.layout.as_ref());
        let own = Looks::of(Style::Natural);
        // The plain style ignores the other looks.
        let looks = match style {
            Style::Plain => &own,
            Style::Natural => &environment.looks,
        };
        let has_ceiling = looks.has_ceiling(layout);
        let (ground, walls) = (looks.ground(has_ceiling), looks.walls());
        let unless_default = |surface: Surface, own: Surface| (surface != own).then_some(surface);
        Self {
            style,
            ground: unless_default(ground.surface, own.ground(has_ceiling).surface),
            ground_scale: ground.scale_seen(),
            walls: unless_default(walls.surface, own.walls().surface),
            wall_scale: walls.scale_seen(),
            ceiling: (has_ceiling != own.has_ceiling(layout)).then_some(has_ceiling),
            shadows: looks.has_shadows(),
            // A ceiling hides the clouds.
            clouds: has_ceiling || looks.has_clouds(),
            fog_in_depth: environment.looks.fog_in_depth && environment.fog_distance.is_some(),
        }
    }
}

/// The ground of a zone: the corners of a polygon, or the centre of a disc.
#[derive(Serialize)]
struct Shape<'a> {
    corners: Option<&'a [[f64; 2]]>,
    radius: Option<f64>,
}

/// A zone that affects movement.
#[derive(Serialize)]
struct Moving<'a> {
    shape: Shape<'a>,
    speed_factor: f64,
    teleport: &'a [[f64; 2]],
}

/// A zone that pays or ends an episode.
#[derive(Serialize)]
struct Paying<'a> {
    shape: Shape<'a>,
    reward_per_second: f64,
    reward_on_entering: f64,
    ends: Option<ZoneEnd>,
}

/// A visible zone.
#[derive(Serialize)]
struct Visible<'a> {
    shape: Shape<'a>,
    color: Color,
}
