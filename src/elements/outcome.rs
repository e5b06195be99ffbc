//! [`ElementsOutcome`]: the elements that variants claim to change, those measured to differ, and contradictions.

use driftworld_env::{Findings, Policy, Proof, Witness};
use driftworld_spec::{Element, Modality, TaskSpec, Variant};
use driftworld_text::joined_or;
use serde::{Deserialize, Serialize};

use super::{ElementsRequest, Optimum};

/// The result of testing a task's variants.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ElementsOutcome {
    /// The task's own name.
    pub task: String,
    /// The base variant that all others were compared with.
    pub base: String,
    /// The learner's modalities; absent if they are those of the worlds.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub modalities: Option<Vec<Modality>>,
    /// Pairs of worlds for each variant.
    pub worlds: u64,
    /// The seed of the worlds.
    pub seed: u64,
    /// Maximum number of steps per episode.
    pub steps: u32,
    /// The variants, in declaration order.
    pub variants: Vec<VariantElements>,
    /// Effects that parameters declare but none of the variants shows.
    #[serde(skip_serializing_if = "Vec::is_empty", default)]
    pub unmeasured: Vec<Unmeasured>,
}

/// Elements that a parameter declares, but that differed in none of the variants that change it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Unmeasured {
    /// The parameter.
    pub parameter: String,
    /// The elements.
    pub elements: Vec<Element>,
    /// The variants.
    pub variants: Vec<String>,
}

/// The claimed and measured changes of a variant.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct VariantElements {
    /// The variant's name.
    pub variant: String,
    /// The parameters in which it differs from the base.
    pub parameters: Vec<String>,
    /// The elements that these parameters claim to affect, in the order of [`Element::WITH_FINE`].
    pub declared: Vec<Element>,
    /// The elements that were measured to differ, in the same order.
    pub measured: Vec<Measured>,
    /// Elements measured but not declared.
    pub contradictions: Vec<Contradiction>,
    /// Parameters that differ without effect: resetting them to the base's values changes nothing.
    pub idle: Vec<String>,
    /// Whether the optimal behaviour changes, for a variant that changes the reward; absent for others, and if the
    /// variants of a probe are compared.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub optimum: Option<Optimum>,
    /// The extent of the test.
    pub proof: Proof,
    /// The verdict.
    pub verdict: Verdict,
}

/// An element that was measured to differ.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    /// The element.
    pub element: Element,
    /// The first case in which it differed.
    pub witness: Witness,
}

/// An element that differs although nothing declares it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Contradiction {
    /// The element.
    pub element: Element,
    /// A sentence that states the claim, where it fails, and what to do.
    pub message: String,
}

/// The experiment's verdict on a variant's claims.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, strum::IntoStaticStr)]
#[serde(rename_all = "lowercase")]
#[strum(serialize_all = "lowercase")]
pub enum Verdict {
    /// Everything measured is declared.
    Sound,
    /// Everything measured is declared, but some parameters have no effect.
    Idle,
    /// Something was measured that is not declared.
    Contradicted,
}

impl Verdict {
    /// The verdict's word.
    pub fn name(self) -> &'static str {
        self.into()
    }
}

impl ElementsOutcome {
    pub(super) fn new(request: &ElementsRequest, task: &str) -> Self {
        Self {
            task: task.to_owned(),
            base: String::new(),
            modalities: request.modalities.clone(),
            worlds: request.worlds,
            seed: request.seed,
            steps: request.steps,
            variants: Vec::new(),
            unmeasured: Vec::new(),
        }
    }

    /// Whether everything measured is declared.
    pub fn is_sound(&self) -> bool {
        self.variants.iter().all(|variant| variant.contradictions.is_empty())
    }

    /// Every contradiction, as a sentence.
    pub fn contradictions(&self) -> impl Iterator<Item = &str> {
        let each = self.variants.iter().flat_map(|variant| &variant.contradictions);
        each.map(|contradiction| contradiction.message.as_str())
    }

    /// Parameters that a variant sets without effect, and elements that a parameter declares but no variant shows, as sentences.
    pub fn warnings(&self) -> impl Iterator<Item = String> {
        self.idle().chain(self.only_declared())
    }

    /// Records the effects that a task's parameters declare but none of its variants shows. Skips variants whose states differ, or
    /// in which nothing differs: they allow no such conclusion.
    pub(super) fn note_unmeasured(&mut self, task: &TaskSpec) {
        for (name, parameter) in task.parameters() {
            let is_relevant = |variant: &&VariantElements| {
                let measured = variant.elements();
                let may_show = variant.parameters.contains(name) && !variant.idle.contains(name);
                may_show && !measured.is_empty() && !measured.contains(&Element::S)
            };
            let relevant: Vec<&VariantElements> = self.variants.iter().filter(is_relevant).collect();
            let differed = |element: &Element| {
                let mut measured = relevant.iter().flat_map(|variant| &variant.measured);
                measured.any(|measured| element.covers(measured.element))
            };
            let elements: Vec<Element> = parameter.affects.iter().copied().filter(|one| !differed(one)).collect();
            if !relevant.is_empty() && !elements.is_empty() {
                self.unmeasured.push(Unmeasured {
                    parameter: name.clone(),
                    elements,
                    variants: relevant.iter().map(|variant| variant.variant.clone()).collect(),
                });
            }
        }
    }

    fn only_declared(&self) -> impl Iterator<Item = String> {
        self.unmeasured.iter().map(|one| {
            let letters: Vec<&str> = one.elements.iter().map(|element| element.letter()).collect();
            format!(
                "{}: {} declares {}, which differed from {} in none of the variants that change it ({}): remove it from \"affects\"; \
                 or, if it shows later or in other worlds, give --steps more than {} and --worlds more than {}",
                self.task,
                one.parameter,
                letters.join(" "),
                self.base,
                one.variants.join(", "),
                self.steps,
                self.worlds,
            )
        })
    }

    fn idle(&self) -> impl Iterator<Item = String> {
        self.variants.iter().flat_map(move |variant| {
            let of = move |name: &String| {
                let (task, base, own) = (&self.task, &self.base, &variant.variant);
                format!(
                    "{task}#{own}: {name} made no difference: with its value in {base}, the same happened in all steps. Nothing reads it, \
                     or it takes effect later: give --steps more than {}",
                    self.steps
                )
            };
            variant.idle.iter().map(of)
        })
    }
}

impl VariantElements {
    pub(super) fn new(base: &Variant, other: &Variant, changed: &[(String, Vec<Element>)], found: Findings) -> Self {
        let claims = |element: &Element| changed.iter().any(|(_, affects)| affects.contains(element));
        let declared: Vec<Element> = Element::WITH_FINE.into_iter().filter(claims).collect();
        let contradicts = |(element, _): &&(Element, Witness)| !declared.iter().any(|own| own.covers(*element));
        let contradiction = |(element, witness): &(Element, Witness)| Contradiction {
            element: *element,
            message: message_of(base, other, changed, *element, witness),
        };
        let contradictions = found
            .differences
            .iter()
            .filter(contradicts)
            .map(contradiction)
            .collect();
        let measured = found.differences.into_iter();
        let mut own = Self {
            variant: other.name().to_owned(),
            parameters: changed.iter().map(|(name, _)| name.clone()).collect(),
            declared,
            measured: measured
                .map(|(element, witness)| Measured { element, witness })
                .collect(),
            contradictions,
            idle: Vec::new(),
            optimum: None,
            proof: found.proof,
            verdict: Verdict::Sound,
        };
        own.judge();
        own
    }

    /// The elements that were measured to differ.
    pub fn elements(&self) -> Vec<Element> {
        self.measured.iter().map(|measured| measured.element).collect()
    }

    pub(super) fn judge(&mut self) {
        self.verdict = match (self.contradictions.is_empty(), self.idle.is_empty()) {
            (false, _) => Verdict::Contradicted,
            (true, false) => Verdict::Idle,
            (true, true) => Verdict::Sound,
        };
    }
}

/// A contradiction as a sentence: where, what was found, what was expected, what to do.
fn message_of(
    base: &Variant,
    other: &Variant,
    changed: &[(String, Vec<Element>)],
    element: Element,
    witness: &Witness,
) -> String {
    let claim = |(name, affects): &(String, Vec<Element>)| {
        let letters: Vec<&str> = affects.iter().map(|element| element.letter()).collect();
        format!("{name} ({})", joined_or(&letters, " ", "nothing"))
    };
    let claims: Vec<String> = changed.iter().map(claim).collect();
    let claims = joined_or(&claims, ", ", "no parameter");
    let (a, b) = (base.name(), other.name());
    format!(
        "{}: found that {} ({}) differs from {a}: {}{} is {} in {a} and {} in {b}; expected no more than {claims} affects; \
         add {:?} to its \"affects\"",
        other.id(),
        element.letter(),
        element.name().replace('_', " "),
        location(witness),
        witness.what,
        witness.a,
        witness.b,
        element.letter(),
    )
}

/// Where a witness occurred: `in world 3, step 17 (expert), `.
fn location(witness: &Witness) -> String {
    let policy = witness.policy.map_or("agent", Policy::name);
    match (witness.world, witness.step) {
        (Some(world), Some(step)) => format!("in world {world}, step {step} ({policy}), "),
        (Some(world), None) => format!("in world {world}, "),
        _ => String::new(),
    }
}
