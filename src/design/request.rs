//! [`DesignRequest`]: the options for designing a curriculum.

use std::path::PathBuf;

use driftworld_curriculum::Design;
use driftworld_env::Catalogue;
use driftworld_similarity::Method;
use driftworld_spec::{By, Element, Modality, ScenarioForm};

use crate::ordering::OrderRequest;
use crate::{Failure, argument, libraries, within};

/// Maximum number of lifetimes per design.
pub const MAX_LIFETIMES: u64 = 10_000;

/// Maximum number of worlds per regime that are drawn as a check.
pub const MAX_TRIED: u32 = 1_000_000;

/// An order of variants by purpose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DesignOrder {
    /// Small steps: the shortest path from the first; of equally short ones, the one whose largest step is smallest.
    Gradual,
    /// By growing distance from the first: the most different ones come last.
    Outward,
    /// The longest path from the first: neighbours are as different as possible.
    Abrupt,
    /// The shortest path from the first: neighbours are as similar as possible.
    Path,
    /// Greedy: the next variant is always the farthest from all before it.
    Farthest,
    /// In the given order, whatever their distances.
    Named,
}

impl DesignOrder {
    /// The orders by word.
    pub const WORDS: [(&'static str, Self); 6] = [
        ("gradual", Self::Gradual),
        ("outward", Self::Outward),
        ("abrupt", Self::Abrupt),
        ("path", Self::Path),
        ("farthest", Self::Farthest),
        ("named", Self::Named),
    ];

    /// The method for it; `None` for the shortest path, whose method depends on the number of items.
    pub(crate) fn method(self) -> Option<Method> {
        match self {
            Self::Gradual => Some(Method::Gradual),
            Self::Outward => Some(Method::Outward),
            Self::Abrupt => Some(Method::Abrupt),
            Self::Path => None,
            Self::Farthest => Some(Method::Farthest),
            Self::Named => Some(Method::Given),
        }
    }
}

/// The options for designing a curriculum.
#[derive(Clone, Debug, Default)]
pub struct DesignRequest {
    /// Variants, or tasks; a task means all its variants.
    pub tasks: Vec<String>,
    /// The options of the ordering method.
    pub ordering: OrderRequest,
    /// An order by purpose, instead of an ordering method.
    pub order: Option<DesignOrder>,
    /// The measure for ordering variants: by default the one that their task declares, or worlds if there are several tasks.
    /// Probes and steps are measured by parameters.
    pub by: Option<By>,
    /// The element to probe: chooses variants that differ from the start in this element only.
    pub probe: Option<Element>,
    /// The modalities of a probe's learner; by default those of the task's worlds.
    pub modalities: Option<Vec<Modality>>,
    /// Number of variants in the probe; by default all declared ones, and at least 4.
    pub variants: Option<usize>,
    /// Makes a sequence of variants, each at this distance from the one before: in the probed element, or in total.
    pub step_distance: Option<f64>,
    /// Tolerance of each step; default [`DEFAULT_TOLERANCE`](super::DEFAULT_TOLERANCE).
    pub tolerance: Option<f64>,
    /// Number of steps: one fewer than variants; default [`DEFAULT_STEPS`](super::DEFAULT_STEPS).
    pub steps: Option<u32>,
    /// Number of lifetimes. Each has its own worlds and, in the permuted form (then the default), its own order.
    pub lifetimes: Option<u64>,
    /// Variants, or tasks, that are evaluated but never learned.
    pub hold_out: Vec<String>,
    /// Whether to design single-task experts of each lifetime, too.
    pub experts: bool,
    /// Whether to design the reversed, random and contrasting orders of the same variants, too.
    pub controls: bool,
    /// Worlds per regime that are drawn as a check; 0 for none.
    pub worlds: u32,
    /// Asset libraries whose classes the tasks use. Later ones take precedence, built-in ones come last.
    pub libraries: Vec<PathBuf>,
    /// The blocks.
    pub design: Design,
}

impl DesignRequest {
    /// The request for the default curriculum of these variants or tasks.
    pub fn of<S: Into<String>>(tasks: impl IntoIterator<Item = S>) -> Self {
        Self {
            tasks: tasks.into_iter().map(Into::into).collect(),
            worlds: 5,
            ..Self::default()
        }
    }

    /// The form; by default the permuted one for several lifetimes, unless another option determines the order.
    pub(super) fn form(&self) -> Option<ScenarioForm> {
        let is_drawn = self.lifetimes.is_some()
            && self.design.blocks.is_none()
            && self.design.drifting.is_none()
            && self.order_given().is_none();
        self.design.form.or(is_drawn.then_some(ScenarioForm::Permuted))
    }

    /// Whether there are several scenarios, each in its own file.
    pub fn is_of_several(&self) -> bool {
        self.form() == Some(ScenarioForm::Expert) || self.lifetimes.is_some()
    }

    pub(super) fn catalogue(&self) -> Result<Catalogue, Failure> {
        libraries::catalogue(&self.libraries)
    }

    /// Refuses contradictory options; [`design`](super::design) calls it first.
    ///
    /// # Errors
    /// [`Failure::Usage`].
    pub fn check(&self) -> Result<(), Failure> {
        let given = [
            ("variants", self.variants.is_some()),
            ("modalities", self.modalities.is_some()),
            ("probe", self.probe.is_some()),
            ("order", self.order.is_some()),
            ("by", self.by.is_some()),
            ("method", self.ordering.method.is_some()),
            ("end", self.ordering.end.is_some()),
            ("step_distance", self.step_distance.is_some()),
            ("tolerance", self.tolerance.is_some()),
            ("steps", self.steps.is_some()),
            ("lifetimes", self.lifetimes.is_some()),
            ("controls", self.controls),
        ];
        let is_given = |name: &str| given.iter().any(|(known, is_given)| *known == name && *is_given);
        for (one, needed) in [
            ("variants", "probe"),
            ("modalities", "probe"),
            ("tolerance", "step_distance"),
            ("steps", "step_distance"),
        ] {
            if is_given(one) && !is_given(needed) {
                let (one, needed) = (argument(one), argument(needed));
                return Err(Failure::usage(format!("{one}: found without {needed}, expected both")));
            }
        }
        for (one, other) in [
            ("variants", "step_distance"),
            ("order", "method"),
            ("order", "step_distance"),
            ("order", "end"),
            ("by", "probe"),
            ("by", "step_distance"),
            ("step_distance", "method"),
            ("step_distance", "end"),
            ("controls", "lifetimes"),
        ] {
            if is_given(one) && is_given(other) {
                let (one, other) = (argument(one), argument(other));
                return Err(Failure::usage(format!(
                    "{one}: found together with {other}, expected only one of the two"
                )));
            }
        }
        within("lifetimes", self.lifetimes.unwrap_or(1), 1..=MAX_LIFETIMES)?;
        within("worlds", self.worlds.into(), 0..=MAX_TRIED.into())?;
        let [lifetimes, form, controls, drift, experts] =
            ["lifetimes", "form", "controls", "drift", "experts"].map(argument);
        if self.form() == Some(ScenarioForm::Expert) {
            let several = [(self.lifetimes.is_some(), &lifetimes), (self.experts, &experts)];
            if let Some((_, other)) = several.iter().find(|(is_given, _)| *is_given) {
                return Err(Failure::usage(format!(
                    "{other}: found with {form} expert, which has no lifetime, expected the form of a lifetime; leave \
                     {form} out, and {experts} writes the experts of each lifetime"
                )));
            }
        }
        if self.is_of_several() && self.controls {
            return Err(Failure::usage(format!(
                "{controls}: found with several scenarios, expected one; leave out {controls}, or {lifetimes} and \
                 {form} expert"
            )));
        }
        if self.form() == Some(ScenarioForm::Permuted) && self.controls {
            return Err(Failure::usage(format!(
                "{controls}: found with {form} permuted, which has a random order, expected an order that was chosen; \
                 leave one of them out ({lifetimes} of the permuted form control each other)"
            )));
        }
        self.check_permuted()?;
        if self.form() == Some(ScenarioForm::Expert) && self.design.drifting.is_some() {
            return Err(Failure::usage(format!(
                "{drift}: found with {form} expert, which learns one variant alone; leave {drift} out"
            )));
        }
        Ok(())
    }

    /// Refuses an explicit order together with the permuted form, whose order is random.
    fn check_permuted(&self) -> Result<(), Failure> {
        match self
            .order_given()
            .filter(|_| self.form() == Some(ScenarioForm::Permuted))
        {
            None => Ok(()),
            Some(name) => Err(Failure::usage(format!(
                "{}: found with {} permuted, whose order is drawn at random, expected one of the two",
                argument(name),
                argument("form")
            ))),
        }
    }

    /// The name of the first given option that determines the order.
    fn order_given(&self) -> Option<&'static str> {
        // The start of a probe or of steps is the variant that is varied; it does not determine the order.
        let is_varied = self.probe.is_some() || self.step_distance.is_some();
        let ordered = [
            ("order", self.order.is_some()),
            ("method", self.ordering.method.is_some()),
            ("end", self.ordering.end.is_some()),
            ("target_step", self.ordering.target_step.is_some()),
            ("start", self.ordering.start.is_some() && !is_varied),
        ];
        ordered.iter().find(|(_, is_given)| *is_given).map(|(name, _)| *name)
    }
}
