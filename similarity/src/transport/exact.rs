//! [`optimal_transport`]: exact optimal transport for any costs.

use super::masses::Units;
use super::network_simplex::solve;
use super::plan::{Move, TransportPlan};
use crate::SimilarityError;

/// Maximum number of origins, and of destinations, with mass.
pub const MAX_TRANSPORTED: usize = 4096;

/// The cheapest way to move masses from origins to destinations: min Σ P·C over plans P ≥ 0 with the given row and column sums.
///
/// `from`: `(origins,)` and `to`: `(destinations,)`, masses of at least 0 in any unit, whose sums are equal within 1e-9 of the
/// larger (the difference is taken off the largest mass of the heavier side). `costs`: `(origins, destinations)`, row after row,
/// in any unit, possibly negative. Without any mass the cost is 0.
///
/// The optimum is exact: masses are moved in whole units (2⁻⁶⁰ of the sum) and the dual prices prove it; the cost equals
/// the true optimum within rounding, about 1e-14 of the largest cost times the mass. A metric between masses of sum 1 if the
/// costs are the distances of a metric (Wasserstein-1). Network simplex, see `network_simplex.rs`: time grows like
/// `(origins + destinations)^2` to `^3`.
///
/// # Errors
/// [`SimilarityError::Shape`] unless there are `origins · destinations` costs, [`SimilarityError::BadCost`] for one that is not
/// within ±1e200, [`SimilarityError::BadMass`] for one that is negative or not finite, [`SimilarityError::UnequalMasses`] for
/// sums that differ, [`SimilarityError::TooMany`] above [`MAX_TRANSPORTED`] masses.
///
/// # Example
/// ```
/// use driftworld_similarity::optimal_transport;
/// let plan = optimal_transport(&[3.0, 1.0], &[1.0, 3.0], &[1.0, 4.0, 2.0, 1.0])?;
/// assert_eq!(plan.cost, 10.0);
/// assert_eq!(plan.moves.len(), 3);
/// # Ok::<(), driftworld_similarity::SimilarityError>(())
/// ```
/// Source: Dantzig 1951; strongly feasible trees by Cunningham 1976. Same numbers as `ot.emd2` (POT 0.9), see
/// `tests/oracle/transport.json`.
pub fn optimal_transport(from: &[f64], to: &[f64], costs: &[f64]) -> Result<TransportPlan, SimilarityError> {
    check_costs(from.len(), to.len(), costs)?;
    let units = Units::of(from, to)?;
    let cost = |origin: usize, destination: usize| costs[origin * to.len() + destination];
    let moves = cheapest_moves(&units.from, &units.to, cost)?.into_iter();
    let moves: Vec<Move> = moves
        .map(|(from, to, flow)| Move {
            from,
            to,
            mass: flow as f64 * units.unit,
        })
        .collect();
    let cost = moves.iter().map(|step| step.mass * cost(step.from, step.to));
    // Gives 0, not −0, without any moves.
    let cost = cost.fold(0.0, |sum, cost| sum + cost);
    Ok(TransportPlan { cost, moves })
}

/// Moves units from origins to destinations at minimum cost. Returns origin, destination and units of every move, sorted.
/// Both sides have the same number of units.
pub(crate) fn cheapest_moves(
    from: &[i64],
    to: &[i64],
    cost: impl Fn(usize, usize) -> f64,
) -> Result<Vec<(usize, usize, i64)>, SimilarityError> {
    let (origins, destinations) = (indices_with_mass(from)?, indices_with_mass(to)?);
    if origins.is_empty() {
        return Ok(Vec::new());
    }
    let pick = |units: &[i64], indices: &[usize]| indices.iter().map(|&index| units[index]).collect::<Vec<i64>>();
    let row = |&origin: &usize| destinations.iter().map(move |&destination| (origin, destination));
    let costs: Vec<f64> = origins.iter().flat_map(row).map(|(from, to)| cost(from, to)).collect();
    let found = solve(&pick(from, &origins), &pick(to, &destinations), &costs).into_iter();
    Ok(found
        .map(|(source, sink, units)| (origins[source], destinations[sink], units))
        .collect())
}

/// Refuses a cost matrix of the wrong size, and costs that cannot be added up.
pub(crate) fn check_costs(rows: usize, columns: usize, costs: &[f64]) -> Result<(), SimilarityError> {
    SimilarityError::check_length("costs", costs.len(), rows * columns)?;
    match costs.iter().position(|cost| !(-1e200..=1e200).contains(cost)) {
        Some(index) => Err(SimilarityError::BadCost {
            row: index / columns,
            column: index % columns,
            found: costs[index],
        }),
        None => Ok(()),
    }
}

/// The indices with mass, if there are not too many.
fn indices_with_mass(units: &[i64]) -> Result<Vec<usize>, SimilarityError> {
    let indices: Vec<usize> = (0..units.len()).filter(|&index| units[index] > 0).collect();
    SimilarityError::check_count(indices.len(), MAX_TRANSPORTED)?;
    Ok(indices)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn origins_and_destinations_without_mass_are_ignored() {
        let costs = [3.0, 1.0, 2.0, 9.0, 4.0, 0.5];
        let plan = optimal_transport(&[0.0, 2.0], &[1.0, 0.0, 1.0], &costs).unwrap();
        assert_eq!(plan.cost, 9.5);
        assert!(plan.moves.iter().all(|step| step.from == 1 && step.to != 1));
    }

    #[test]
    fn nothing_to_move_costs_nothing() {
        assert_eq!(optimal_transport(&[], &[], &[]).unwrap().cost, 0.0);
        let plan = optimal_transport(&[0.0], &[0.0, 0.0], &[1.0, 2.0]).unwrap();
        assert_eq!((plan.cost, plan.moves.len()), (0.0, 0));
    }

    #[test]
    fn invalid_problems_are_refused() {
        let code = |from: &[f64], to: &[f64], costs: &[f64]| optimal_transport(from, to, costs).unwrap_err().code();
        assert_eq!(code(&[1.0], &[1.0], &[]), "similarity/shape");
        assert_eq!(code(&[1.0], &[1.0], &[f64::NAN]), "similarity/bad-cost");
        assert_eq!(code(&[1.0], &[2.0], &[1.0]), "similarity/unequal-masses");
        assert_eq!(code(&[-1.0], &[1.0], &[1.0]), "similarity/bad-mass");
        assert_eq!(
            code(&vec![1.0; 4097], &[4097.0], &vec![1.0; 4097]),
            "similarity/too-many"
        );
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        #[test]
        fn all_mass_arrives(
            masses in prop::collection::vec((0.0f64..1.0, 0.0f64..1.0), 1..20),
            numbers in prop::collection::vec(-1.0f64..1.0, 400),
        ) {
            let sum = |side: &[f64]| side.iter().sum::<f64>();
            let (from, to): (Vec<f64>, Vec<f64>) = masses.into_iter().unzip();
            prop_assume!(sum(&from) > 1e-3 && sum(&to) > 1e-3);
            let to: Vec<f64> = to.iter().map(|mass| mass * sum(&from) / sum(&to)).collect();
            let plan = optimal_transport(&from, &to, &numbers[..from.len() * to.len()]).unwrap();
            for (index, mass) in from.iter().enumerate() {
                let sent = plan.moves.iter().filter(|step| step.from == index).map(|step| step.mass);
                prop_assert!((sent.sum::<f64>() - mass).abs() < 1e-12);
            }
            for (index, mass) in to.iter().enumerate() {
                let received = plan.moves.iter().filter(|step| step.to == index).map(|step| step.mass);
                prop_assert!((received.sum::<f64>() - mass).abs() < 1e-12);
            }
        }
    }
}
