//! Tests in pairs of worlds that the variants of a probe differ in the probed element only. The scenario records the result.

use driftworld_generator::Sampler;
use driftworld_spec::{Element, Modality, ProvenVariant, ScenarioProof, Variant};

use super::{Chosen, DesignRequest, Evidence};
use crate::elements::{ElementsOutcome, ElementsRequest, elements_among};
use crate::{Failure, argument, tasks};

/// Number of pairs of worlds tested per variant.
const NUM_WORLDS: u64 = 8;

impl DesignRequest {
    /// Tests the variants of a probe; `None` without a probe, or if nothing is to be tested before writing.
    ///
    /// # Errors
    /// [`Failure`] that lists every variant that also changes something else.
    pub(super) fn prove(&self, chosen: &Chosen) -> Result<Option<ScenarioProof>, Failure> {
        let tested = chosen.evidence.as_ref().filter(|_| self.worlds > 0);
        let Some((picked, Some(element))) = tested.map(Evidence::parts) else {
            return Ok(None);
        };
        let variants: Vec<Variant> = picked.iter().map(|one| one.variant.clone()).collect();
        let Some(base) = variants.first() else { return Ok(None) };
        let modalities_of =
            |variant: &Variant| Ok::<_, Failure>(Sampler::new(variant, 0).world(0)?.agent_params.modalities.clone());
        let own = modalities_of(base)?;
        let mut others = variants.iter().map(modalities_of);
        let are_alike = others.try_fold(true, |alike, other| Ok::<_, Failure>(alike && other? == own))?;
        // If the variants have different modalities, compare each world in its own.
        let compared = self.modalities.clone().or_else(|| are_alike.then(|| own.clone()));
        let modalities = self.modalities.clone().unwrap_or(own);
        let request = ElementsRequest {
            worlds: NUM_WORLDS,
            modalities: compared,
            libraries: self.libraries.clone(),
            ..ElementsRequest::of(base.task().name())
        };
        let found = elements_among(&variants, &request)?;
        let id = |index: usize| {
            chosen
                .variants
                .get(index)
                .map_or_else(String::new, driftworld_curriculum::Choice::id)
        };
        refuse_others(&found, element, &modalities, tasks::split(&id(0)).0)?;
        let proven = found.variants.iter().enumerate().map(|(index, one)| ProvenVariant {
            variant: id(index + 1),
            measured: one.elements(),
        });
        Ok(Some(ScenarioProof {
            element,
            base: id(0),
            modalities,
            worlds: found.worlds,
            seed: found.seed,
            steps: found.variants.iter().map(|one| one.proof.steps).sum(),
            observations: found.variants.iter().map(|one| one.proof.observations).sum(),
            variants: proven.collect(),
        }))
    }
}

/// Refuses a probe whose variants change an element other than the probed one. `task` is the task as it was named.
fn refuse_others(found: &ElementsOutcome, element: Element, images: &[Modality], task: &str) -> Result<(), Failure> {
    let others = found.variants.iter().filter_map(|variant| {
        let other = variant.measured.iter().find(|own| !element.covers(own.element))?;
        Some(format!(
            "{}#{}: found that {} differs from {}, too ({} is {} there and {} here), expected the {} alone",
            found.task,
            variant.variant,
            other.element.letter(),
            found.base,
            other.witness.what,
            other.witness.a,
            other.witness.b,
            element.name(),
        ))
    });
    let others: Vec<String> = others.collect();
    if others.is_empty() {
        return Ok(());
    }
    let images = serde_json::to_string(images)?;
    Err(Failure::input(format!(
        "{}\nthis is for a learner with the images {images}; correct \"affects\" in the task (see driftworld elements {}), name \
         other variants, or choose other images with {}",
        others.join("\n"),
        task,
        argument("modalities")
    )))
}
